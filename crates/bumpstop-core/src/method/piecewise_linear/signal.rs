//! A guard along a phase: a polynomial plus exponentials plus special motions.

mod loads;

use super::clustered::Clustered;
use super::jet::{Jet, Jets};
use super::phase::{Phase, Phases};
use super::polynomial::Polynomial;
use super::product::{Factor, Other, grown};
use super::rows::{ComplexBlock, RealBlock, entry, set_entry, spread};
use super::spectrum::Spectrum;
use super::tables::CELLS;
use super::view::View;
use crate::law::{Affine, COORDINATES};
use crate::number::{Complex, Instructions, LANES, Lanes, Number};

/// Bound of the rounding of a sum, in units of the sum of the sizes of its terms.
///
/// With u = eps/2: an exponential is good to 6u (exponential and sine to 2.4u each, their product
/// u), and a complex product adds sqrt(5) u (R. Brent, C. Percival, P. Zimmermann, Math. Comp. 76,
/// 2007). That over half a cell has the powers 2, 3, 4 and 8 with 14.3u, 22.6u, 30.8u and 63.8u;
/// the middle of the eighth cell lies at the product of the last three, good to 122u. The
/// exponential at the left end of the first cell, the amplitude and their products add 11u, the
/// parts of the sum 3u, and each of its terms one more, for which [`Signal::rounding`] allows.
const ROUNDING: f64 = 136.0 * 0.5 * f64::EPSILON;

// There are as many cells as the bound says.
const _: () = assert!(CELLS == 8);

/// Part of a signal that is neither exponential nor polynomial.
#[derive(Debug, Clone, Copy)]
struct Special {
    single: usize,
    of_position: f64,
    of_velocity: f64,
    third: f64,
}

/// Eight exponential terms of a signal.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Terms {
    /// `b`, `b lambda`, `b lambda^2`
    pub of: [ComplexBlock; 3],
    /// `|b|`
    pub size: RealBlock,
}

impl Terms {
    const ZERO: Self = Self {
        of: [ComplexBlock::ZERO; 3],
        size: RealBlock::ZERO,
    };

    /// The terms that are not zero, one bit a lane.
    #[inline(always)]
    fn live<I: Instructions>(&self) -> u8 {
        !self.size.lanes::<I>().less(Lanes::of(f64::MIN_POSITIVE))
    }
}

/// `g(t) = polynomial + Re sum b_j exp(lambda_j t) + specials`.
#[derive(Debug, Clone, Default)]
pub(crate) struct Signal {
    pub terms: Vec<Terms>,
    polynomial: Polynomial,
    specials: Vec<Special>,
    clustered: Clustered,
    remaining: f64,
    /// `sum |b| |lambda|^n`
    totals: [f64; 3],
    growth: Growth,
    /// `Re sum b lambda^n`
    at_start: [f64; 3],
}

/// What grows of a signal.
#[derive(Debug, Clone, Copy, Default)]
struct Growth {
    /// `sum |b| |lambda|^n` over the exponents that grow.
    totals: [f64; 2],
    /// The fastest rate, in 1/s; zero where nothing grows.
    rate: f64,
}

/// Where the walk stands: exponentials at one instant after the start of the phase.
pub(crate) struct Instant<'a> {
    pub time: f64,
    pub exponentials: &'a [ComplexBlock],
}

impl Signal {
    /// An affine function of one law's local coordinates, seen through `views`.
    #[inline(always)]
    pub(crate) fn set<I: Instructions>(
        &mut self,
        phases: &Phases,
        phase: Phase,
        views: &[View],
        function: &Affine,
        remaining: f64,
    ) {
        let spectrum = &phases.spectra[phase.spectrum];
        self.polynomial.start(function.constant);
        self.specials.clear();
        self.remaining = remaining;
        let amplitudes = phases.amplitudes(phase);
        self.terms.resize(amplitudes.len(), Terms::ZERO);
        let zero = Lanes::<I>::of(0.0);
        let (mut totals, mut at_start) = ([zero; 3], [zero; 3]);
        for (b, terms) in self.terms.iter_mut().enumerate() {
            let lambda = spectrum.lambda[b].lanes::<I>();
            let modulus = spectrum.moduli[b].lanes::<I>();
            let value = weights(views, function, lambda, b) * amplitudes[b].lanes();
            let slope = value * lambda;
            let curvature = slope * lambda;
            for (n, of) in [value, slope, curvature].into_iter().enumerate() {
                terms.of[n].put(of);
                at_start[n] += of.re;
            }
            let size = value.norm();
            terms.size.put(size);
            totals[0] += size;
            totals[1] = size.mul_add(modulus, totals[1]);
            totals[2] = size.mul_add(modulus * modulus, totals[2]);
        }
        let [a, b, c] = totals;
        let [d, e, f] = at_start;
        let sums = Lanes::totals([a, b, c, d, e, f, zero, zero]);
        self.totals = [sums[0], sums[1], sums[2]];
        self.at_start = [sums[3], sums[4], sums[5]];
        self.growth = Growth::default();
        if spectrum.growth > 0.0 {
            self.measure_growth(spectrum);
        }
        self.clustered.set(&spectrum.clusters, views, function);
        (self.clustered).add_sizes(phases, phase, &mut self.totals);
        for (coordinate, view) in views.iter().enumerate().take(COORDINATES) {
            if function.sees(coordinate) {
                self.polynomial
                    .add(0, function.position[coordinate] * view.rest);
                self.add_singles(phases, phase, view, function, coordinate);
                if let Some(response) = &spectrum.response {
                    self.add_loads(response, phases, phase, view, function, coordinate);
                }
            }
        }
    }

    #[inline(always)]
    fn add_singles(
        &mut self,
        phases: &Phases,
        phase: Phase,
        view: &View,
        function: &Affine,
        coordinate: usize,
    ) {
        let of_position = function.position[coordinate];
        let of_velocity = function.velocity[coordinate];
        let of_acceleration = function.acceleration[coordinate];
        let spectrum = &phases.spectra[phase.spectrum];
        for &single in &view.drifting {
            let weight = view.singles[single];
            let motion = &spectrum.singles[single].motion;
            let kept = phases.kept(phase, single);
            let (mut position, mut velocity) = (weight * of_position, weight * of_velocity);
            let acceleration = weight * of_acceleration;
            if motion.is_special() {
                // x'' = force - c x' - w2 x
                self.polynomial.add(0, acceleration * motion.force);
                position -= acceleration * motion.omega2;
                velocity -= acceleration * motion.damping;
                let third = position.abs() * motion.special_bound(3, kept, self.remaining)
                    + velocity.abs() * motion.special_bound(4, kept, self.remaining);
                self.specials.push(Special {
                    single,
                    of_position: position,
                    of_velocity: velocity,
                    third,
                });
                self.totals[0] += position.abs() * kept.x.abs() + velocity.abs() * kept.v.abs();
            } else {
                let p = motion.polynomial(kept.x, kept.v);
                let value = position * p[0] + velocity * p[1] + 2.0 * acceleration * p[2];
                self.polynomial.add(0, value);
                (self.polynomial).add(1, position * p[1] + 2.0 * velocity * p[2]);
                self.polynomial.add(2, position * p[2]);
            }
        }
    }

    #[cold]
    fn measure_growth(&mut self, spectrum: &Spectrum) {
        for (terms, (lambda, modulus)) in
            (self.terms.iter()).zip(spectrum.lambda.iter().zip(&spectrum.moduli))
        {
            for lane in 0..LANES {
                if lambda.re[lane] > 0.0 {
                    let size = terms.size.0[lane];
                    self.growth.totals[0] += size;
                    self.growth.totals[1] += size * modulus.0[lane];
                    self.growth.rate = self.growth.rate.max(lambda.re[lane]);
                }
            }
        }
    }

    /// What the growth since the start adds to the rounding, for the given bound of that of a sum.
    #[cold]
    fn rounding_of_growth(&self, sum: f64, t: f64) -> f64 {
        let [size, rate] = self.growth.totals;
        let growth = Number::exp(self.growth.rate * t) - 1.0;
        growth * (sum * size + f64::EPSILON * rate * t)
    }

    /// Coefficients of the polynomial part.
    pub(crate) fn polynomial(&self) -> &[f64] {
        self.polynomial.terms()
    }

    /// Bound of the rounding of a value at time t.
    #[inline(always)]
    pub(crate) fn rounding(&self, t: f64) -> f64 {
        let polynomial = self.polynomial.size(t);
        let sum = ROUNDING + 0.5 * f64::EPSILON * (LANES * self.terms.len()) as f64;
        let mut bound = sum * (self.totals[0] + polynomial) + f64::EPSILON * self.totals[1] * t;
        if self.growth.rate > 0.0 {
            bound += self.rounding_of_growth(sum, t);
        }
        bound
    }

    /// Sum of the sizes of its terms up to time t: how far it may go.
    pub(crate) fn size(&self, t: f64) -> f64 {
        self.totals[0] + self.polynomial.size(t)
    }

    /// Whether it keeps within such a distance of zero, being nothing but a constant and rounding.
    pub(crate) fn stays(&self, distance: f64) -> bool {
        self.specials.is_empty() && self.size(self.remaining) <= distance
    }

    /// The signal's rate.
    pub(crate) fn derivative(&self, phases: &Phases, phase: Phase) -> Self {
        let spectrum = &phases.spectra[phase.spectrum];
        let mut rate = self.clone();
        rate.totals = [0.0; 3];
        rate.at_start = [self.at_start[1], self.at_start[2], 0.0];
        for (b, terms) in rate.terms.iter_mut().enumerate() {
            let [_, slope, curvature] = terms.of;
            terms.of = [slope, curvature, curvature];
            for lane in 0..LANES {
                let j = b * LANES + lane;
                let (lambda, modulus) = (entry(&spectrum.lambda, j), spectrum.moduli[b].0[lane]);
                let [_, _, third] = &mut terms.of;
                let product = entry(std::slice::from_ref(&curvature), lane) * lambda;
                set_entry(std::slice::from_mut(third), lane, product);
                rate.at_start[2] += product.re;
                terms.size.0[lane] *= modulus;
                let mut part = terms.size.0[lane];
                for total in &mut rate.totals {
                    *total += part;
                    part *= modulus;
                }
            }
        }
        rate.polynomial = self.polynomial.derivative();
        rate.growth = Growth::default();
        rate.measure_growth(spectrum);
        rate.clustered = self.clustered.derivative(&spectrum.clusters);
        (rate.clustered).add_sizes(phases, phase, &mut rate.totals);
        for special in &mut rate.specials {
            let single = special.single;
            let motion = &spectrum.singles[single].motion;
            let kept = phases.kept(phase, single);
            // x'' = force - c x' - w2 x
            let velocity = special.of_velocity;
            rate.polynomial.add(0, velocity * motion.force);
            special.of_velocity = special.of_position - motion.damping * velocity;
            special.of_position = -motion.omega2 * velocity;
            let bound = |order| motion.special_bound(order, kept, self.remaining);
            special.third =
                special.of_position.abs() * bound(3) + special.of_velocity.abs() * bound(4);
            rate.totals[0] += special.of_velocity.abs() * kept.v.abs();
        }
        rate
    }

    /// Adds a constant.
    pub(crate) fn raise(&mut self, by: f64) {
        self.polynomial.add(0, by);
    }

    /// Changes the sign.
    pub(crate) fn negate(&mut self) {
        for terms in &mut self.terms {
            for block in &mut terms.of {
                for x in block.re.iter_mut().chain(&mut block.im) {
                    *x = -*x;
                }
            }
        }
        self.polynomial.negate();
        self.at_start = self.at_start.map(|x| -x);
        self.clustered.negate();
        for special in &mut self.specials {
            special.of_position = -special.of_position;
            special.of_velocity = -special.of_velocity;
        }
    }

    /// Integral from the start of the phase to t after it.
    pub(crate) fn integral(&self, phases: &Phases, phase: Phase, t: f64) -> f64 {
        let spectrum = &phases.spectra[phase.spectrum];
        let mut total = self.polynomial.integral(t);
        for (terms, lambda) in self.terms.iter().zip(&spectrum.lambda) {
            for lane in 0..LANES {
                if terms.size.0[lane] > 0.0 {
                    let lambda = entry(std::slice::from_ref(lambda), lane);
                    let b = entry(&terms.of[..1], lane);
                    total += (b * grown(lambda, t)).re;
                }
            }
        }
        for special in &self.specials {
            let motion = &spectrum.singles[special.single].motion;
            let kept = phases.kept(phase, special.single);
            let [x, ..] = motion.special(kept, t);
            total += special.of_position * motion.special_integral(kept, t);
            total += special.of_velocity * (x - kept.x);
        }
        total + self.clustered.integral(phases, phase, t)
    }

    /// The signal as a factor of a product.
    pub(crate) fn factor<'a>(&'a self, phases: &'a Phases, phase: Phase) -> Factor<'a> {
        let paces = self.specials.iter().map(|special| {
            let motion = &phases.spectra[phase.spectrum].singles[special.single].motion;
            motion.omega2.abs().sqrt().max(motion.damping)
        });
        let own = self.clustered.pace(&phases.spectra[phase.spectrum]);
        let has_other = !(self.specials.is_empty() && self.clustered.is_empty());
        let other = has_other.then(|| Other {
            pace: paces.fold(own, f64::max),
            value: Box::new(move |t| {
                let mut values = [0.0; 3];
                self.add_specials(phases, phase, t, &mut values);
                (self.clustered).add_values(phases, phase, t, &mut values);
                values[0]
            }),
        });
        Factor {
            amplitudes: self.terms.iter().map(|terms| terms.of[0]).collect(),
            polynomial: self.polynomial.terms().to_vec(),
            other,
        }
    }

    /// Makes the signal positive just after the start of the phase; tells whether it is so at
    /// the start already.
    pub(crate) fn orient(&mut self, phases: &Phases, phase: Phase) -> bool {
        let values = self.values_at_start(phases, phase);
        let starts = values[0].abs() > self.rounding(0.0);
        let sign = if starts { values[0] } else { values[1] };
        if sign < 0.0 {
            self.negate();
        }
        starts
    }

    /// Bounds of the rounding of slope and curvature at the start of the phase.
    #[inline(always)]
    pub(crate) fn rate_rounding(&self, phases: &Phases, phase: Phase) -> [f64; 2] {
        let mut bounds = [self.totals[1], self.totals[2]];
        for special in &self.specials {
            let motion = &phases.spectra[phase.spectrum].singles[special.single].motion;
            let kept = phases.kept(phase, special.single);
            let [_, v, a, jerk] = motion.special(kept, 0.0).map(f64::abs);
            let (position, velocity) = (special.of_position.abs(), special.of_velocity.abs());
            bounds[0] += position * v + velocity * a;
            bounds[1] += position * a + velocity * jerk.max(motion.damping * a);
        }
        let p = self.polynomial.terms();
        [
            ROUNDING * (bounds[0] + p[1].abs()),
            ROUNDING * (bounds[1] + 2.0 * p[2].abs()),
        ]
    }

    /// A typical angular frequency of the signal's curvature, in rad/s; zero for a polynomial.
    #[inline(always)]
    pub(crate) fn pace(&self, spectrum: &Spectrum) -> f64 {
        let [size, _, bending] = self.totals;
        let mut pace = if size > 0.0 { bending / size } else { 0.0 };
        if let Some(response) = &spectrum.response {
            pace = pace.max(response.pace().powi(2));
        }
        for special in &self.specials {
            pace = pace.max(spectrum.singles[special.single].motion.omega2.abs());
        }
        pace.sqrt()
    }

    /// Takes note that the slope at the start is zero, and what is computed of it rounding.
    pub(crate) fn start_flat(&mut self, phases: &Phases, phase: Phase) {
        let [_, slope, _] = self.values_at_start(phases, phase);
        self.at_start[1] -= slope;
    }

    /// Value and first two derivatives at the start of the phase.
    #[inline(always)]
    pub(crate) fn values_at_start(&self, phases: &Phases, phase: Phase) -> [f64; 3] {
        let mut values = self.at_start;
        self.add_others(phases, phase, 0.0, &mut values);
        values
    }

    /// Value and first two derivatives, all terms summed.
    #[inline(always)]
    pub(crate) fn values<I: Instructions>(
        &self,
        phases: &Phases,
        phase: Phase,
        at: &Instant<'_>,
    ) -> [f64; 3] {
        let mut sums = [Lanes::<I>::of(0.0); 3];
        for (terms, e) in self.terms.iter().zip(at.exponentials) {
            let e = e.lanes::<I>();
            for (sum, of) in sums.iter_mut().zip(&terms.of) {
                *sum = of.lanes().add_real_product(e, *sum);
            }
        }
        let zero = Lanes::<I>::of(0.0);
        let totals = Lanes::totals([sums[0], sums[1], sums[2], zero, zero, zero, zero, zero]);
        let mut values = [totals[0], totals[1], totals[2]];
        self.add_others(phases, phase, at.time, &mut values);
        values
    }

    /// Adds value, slope or curvature, by the order, at up to eight times after the start of the
    /// phase to a list: with a time a lane where that takes fewer exponentials than an exponent a
    /// lane. Both add up in the same order, so that no value depends on the other times.
    #[inline(always)]
    pub(crate) fn sample<I: Instructions>(
        &self,
        order: usize,
        phases: &Phases,
        phase: Phase,
        times: &[f64],
        samples: &mut Vec<f64>,
    ) {
        let mut live = 0;
        for terms in &self.terms {
            live += terms.live::<I>().count_ones() as usize;
        }
        if live >= times.len() * self.terms.len() {
            for time in times {
                samples.push(self.at::<I>(order, phases, phase, *time));
            }
            return;
        }
        let mut lanes = [0.0; LANES];
        lanes[..times.len()].copy_from_slice(times);
        let lanes = Lanes::new(lanes);
        let sums = self.exponentials_over::<I>(order, phases, phase, lanes);
        if self.is_plain() && self.clustered.is_empty() {
            let values = sums + self.polynomial.short_over(lanes)[order];
            samples.extend_from_slice(&values.numbers()[..times.len()]);
            return;
        }
        for (time, sum) in times.iter().zip(sums.numbers()) {
            let mut values = [0.0; 3];
            self.add_others(phases, phase, *time, &mut values);
            samples.push(sum + values[order]);
        }
    }

    /// The sum of the exponentials at eight times, each as [`Signal::at`] gives it.
    #[inline(always)]
    fn exponentials_over<I: Instructions>(
        &self,
        order: usize,
        phases: &Phases,
        phase: Phase,
        times: Lanes<I>,
    ) -> Lanes<I> {
        let mut sums = [Lanes::<I>::of(0.0); LANES];
        let exponents = &phases.spectra[phase.spectrum].lambda;
        for (terms, lambda) in self.terms.iter().zip(exponents) {
            let mut live = terms.live::<I>();
            while live != 0 {
                let lane = live.trailing_zeros() as usize;
                live &= live - 1;
                let exponential = spread::<I>(lambda, lane).scale(times).exp();
                let factor = spread(&terms.of[order], lane);
                sums[lane] = factor.add_real_product(exponential, sums[lane]);
            }
        }
        Lanes::across(sums)
    }

    /// Value, slope or curvature, by the order, `t` after the start of the phase.
    #[inline(always)]
    pub(crate) fn at<I: Instructions>(
        &self,
        order: usize,
        phases: &Phases,
        phase: Phase,
        t: f64,
    ) -> f64 {
        let time = Lanes::<I>::of(t);
        let mut sum = Lanes::<I>::of(0.0);
        let exponents = &phases.spectra[phase.spectrum].lambda;
        for (terms, lambda) in self.terms.iter().zip(exponents) {
            let exponential = lambda.lanes().scale(time).exp();
            sum = (terms.of[order].lanes()).add_real_product(exponential, sum);
        }
        if self.is_plain() && self.clustered.is_empty() {
            let [slow, ..] = self.polynomial.short_over(time)[order].numbers();
            return sum.total() + slow;
        }
        let mut values = [0.0; 3];
        self.add_others(phases, phase, t, &mut values);
        sum.total() + values[order]
    }

    /// All but the exponentials.
    #[inline(always)]
    fn add_others(&self, phases: &Phases, phase: Phase, t: f64, values: &mut [f64; 3]) {
        self.add_slow(phases, phase, t, values);
        if !self.clustered.is_empty() {
            self.clustered.add_values(phases, phase, t, values);
        }
    }

    /// Adds the clusters' parts to jets on cells of the given width from a time on.
    #[inline(always)]
    pub(crate) fn add_clusters(
        &self,
        phases: &Phases,
        phase: Phase,
        time: f64,
        width: f64,
        jets: &mut Jets,
    ) {
        if !self.clustered.is_empty() {
            self.clustered.add_to_jets(phases, phase, time, width, jets);
        }
    }

    /// Adds the clusters' parts to a jet that stands at the left end of a cell.
    #[inline(always)]
    pub(crate) fn add_clusters_after(
        &self,
        phases: &Phases,
        phase: Phase,
        time: f64,
        width: f64,
        jet: &mut Jet,
    ) {
        if !self.clustered.is_empty() {
            self.clustered.add_to_jet(phases, phase, time, width, jet);
        }
    }

    /// What is not exponential of value and first two derivatives at eight times.
    #[inline(always)]
    pub(crate) fn slow_over<I: Instructions>(
        &self,
        phases: &Phases,
        phase: Phase,
        times: Lanes<I>,
    ) -> [Lanes<I>; 3] {
        if self.is_plain() {
            return self.polynomial.short_over(times);
        }
        let mut values = [[0.0; LANES]; 3];
        for (lane, time) in times.numbers().into_iter().enumerate() {
            let mut at = [0.0; 3];
            self.add_slow(phases, phase, time, &mut at);
            for (values, value) in values.iter_mut().zip(at) {
                values[lane] = value;
            }
        }
        let [value, slope, curvature] = values;
        [Lanes::new(value), Lanes::new(slope), Lanes::new(curvature)]
    }

    /// Whether it is a sum of exponentials and a short polynomial, beside clusters.
    #[inline(always)]
    fn is_plain(&self) -> bool {
        self.specials.is_empty() && self.polynomial.is_short()
    }

    /// Bound of the third derivative of what is not exponential, up to t.
    #[inline(always)]
    pub(crate) fn slow_third(&self, t: f64) -> f64 {
        if self.is_plain() {
            return 0.0;
        }
        let mut third = self.polynomial.third(t);
        for special in &self.specials {
            third += special.third;
        }
        third
    }

    /// Polynomial and special parts.
    #[inline(always)]
    pub(crate) fn add_slow(&self, phases: &Phases, phase: Phase, t: f64, values: &mut [f64; 3]) {
        self.polynomial.add_to(t, values);
        self.add_specials(phases, phase, t, values);
    }

    /// Special parts.
    #[inline(always)]
    fn add_specials(&self, phases: &Phases, phase: Phase, t: f64, values: &mut [f64; 3]) {
        for special in &self.specials {
            let motion = &phases.spectra[phase.spectrum].singles[special.single].motion;
            let kept = phases.kept(phase, special.single);
            let [x, v, a, jerk] = motion.special(kept, t);
            for (value, (x, v)) in values.iter_mut().zip([(x, v), (v, a), (a, jerk)]) {
                *value += special.of_position * x + special.of_velocity * v;
            }
        }
    }
}

/// `position . view + velocity . view lambda + acceleration . view lambda^2` for eight exponents.
#[inline(always)]
fn weights<I: Instructions>(
    views: &[View],
    function: &Affine,
    lambda: Complex<Lanes<I>>,
    block: usize,
) -> Complex<Lanes<I>> {
    let mut total = Complex::zero();
    for (coordinate, view) in views.iter().enumerate().take(COORDINATES) {
        if function.sees(coordinate) {
            let view = view.exponents[block].lanes();
            let mut factor = lambda
                .scale(Lanes::<I>::of(function.velocity[coordinate]))
                .plus(Lanes::<I>::of(function.position[coordinate]));
            let acceleration = function.acceleration[coordinate];
            if acceleration != 0.0 {
                factor += (lambda * lambda).scale(Lanes::<I>::of(acceleration));
            }
            total += view * factor;
        }
    }
    total
}
