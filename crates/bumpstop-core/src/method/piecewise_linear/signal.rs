//! A guard along a phase: a polynomial plus exponentials plus special motions.

use super::jet::Jet;
use super::phase::{Phase, Phases};
use super::spectrum::{Rows, Spectrum, View};
use crate::law::Guard;
use crate::number::{Complex, Instructions, LANES, Lanes, Number};

/// Exponents with `|lambda| r` below this are followed by their Taylor polynomial over a cell of
/// half-width r, faster ones are bounded by their size: both cost about the same here.
const FOLLOWED: f64 = 1.8;

/// Bound of the rounding of a sum, in units of the sum of the sizes of its terms: a product of
/// exponentials carried over at most 32 cells, the exponent times the time, and the summation.
const ROUNDING: f64 = 48.0 * f64::EPSILON;

/// Part of a signal that is neither exponential nor polynomial.
#[derive(Debug, Clone, Copy)]
struct Special {
    single: usize,
    of_position: f64,
    of_velocity: f64,
    third: f64,
}

/// `g(t) = polynomial + Re sum b_j exp(lambda_j t) + specials`.
#[derive(Debug, Clone, Default)]
pub(crate) struct Signal {
    /// `b`, `b lambda`, `b lambda^2`
    terms: [Rows; 3],
    /// `|b|`
    size: Vec<f64>,
    polynomial: [f64; 3],
    specials: Vec<Special>,
    remaining: f64,
    total: f64,
    total_rate: f64,
}

/// Where the walk stands: exponentials at one instant after the start of the phase.
pub(crate) struct Instant<'a> {
    pub time: f64,
    pub exponentials: &'a Rows,
}

impl Signal {
    /// The constant factor free signal `sum position . x + velocity . x'` of one law's local
    /// coordinates, seen through `views`.
    #[inline(always)]
    pub(crate) fn set<I: Instructions>(
        &mut self,
        phases: &Phases,
        phase: Phase,
        views: &[View],
        guard: &Guard,
        remaining: f64,
    ) {
        let spectrum = &phases.spectra[phase.spectrum];
        self.fit(spectrum.exponents());
        self.polynomial = [guard.constant, 0.0, 0.0];
        self.specials.clear();
        self.remaining = remaining;
        let (re, im) = phases.amplitudes(phase);
        for o in (0..spectrum.exponents()).step_by(LANES) {
            let lambda = spectrum.lambda.lanes::<I>(0, o);
            let amplitude = Complex::new(Lanes::<I>::load(&re[o..]), Lanes::<I>::load(&im[o..]));
            let weight = weights(views, guard, lambda, o);
            let b = weight * amplitude;
            let first = b * lambda;
            self.terms[0].put(0, o, b);
            self.terms[1].put(0, o, first);
            self.terms[2].put(0, o, first * lambda);
            b.norm().store(&mut self.size[o..]);
        }
        self.total_rate = 0.0;
        self.total = 0.0;
        for j in 0..spectrum.exponents() {
            let lambda = spectrum.lambda.get(0, j).norm();
            self.total += self.size[j];
            self.total_rate += self.size[j] * lambda;
        }
        for (coordinate, (position, velocity)) in
            guard.position.iter().zip(guard.velocity).enumerate()
        {
            if *position != 0.0 || velocity != 0.0 {
                let view = &views[coordinate];
                self.polynomial[0] += position * view.rest;
                self.add_singles(phases, phase, view, *position, velocity);
            }
        }
    }

    fn fit(&mut self, exponents: usize) {
        if self.size.len() != exponents {
            self.terms = std::array::from_fn(|_| Rows::zeros(1, exponents));
            self.size = vec![0.0; exponents];
        }
    }

    #[inline(always)]
    fn add_singles(
        &mut self,
        phases: &Phases,
        phase: Phase,
        view: &View,
        of_position: f64,
        of_velocity: f64,
    ) {
        let spectrum = &phases.spectra[phase.spectrum];
        for (single, weight) in view.singles.iter().enumerate() {
            if *weight == 0.0 {
                continue;
            }
            let motion = &spectrum.singles[single].motion;
            let (x0, v0) = phases.kept(phase, single);
            let (position, velocity) = (weight * of_position, weight * of_velocity);
            if motion.is_special() {
                let third = position.abs() * motion.special_bound(3, x0, v0, self.remaining)
                    + velocity.abs() * motion.special_bound(4, x0, v0, self.remaining);
                self.specials.push(Special {
                    single,
                    of_position: position,
                    of_velocity: velocity,
                    third,
                });
                self.total += position.abs() * x0.abs() + velocity.abs() * v0.abs();
            } else {
                let p = motion.polynomial(x0, v0);
                self.polynomial[0] += position * p[0] + velocity * p[1];
                self.polynomial[1] += position * p[1] + 2.0 * velocity * p[2];
                self.polynomial[2] += position * p[2];
            }
        }
    }

    /// Bound of the rounding of a value at time t.
    #[inline(always)]
    pub(crate) fn rounding(&self, t: f64) -> f64 {
        let p = self.polynomial;
        let polynomial = p[0].abs() + t * (p[1].abs() + t * p[2].abs());
        ROUNDING * (self.total + polynomial) + f64::EPSILON * self.total_rate * t
    }

    /// The signal's rate.
    pub(crate) fn derivative(&self, phases: &Phases, phase: Phase) -> Self {
        let spectrum = &phases.spectra[phase.spectrum];
        let mut rate = self.clone();
        rate.terms = [
            self.terms[1].clone(),
            self.terms[2].clone(),
            self.terms[2].clone(),
        ];
        rate.total = 0.0;
        rate.total_rate = 0.0;
        for j in 0..self.size.len() {
            let lambda = spectrum.lambda.get(0, j);
            rate.terms[2].set(0, j, self.terms[2].get(0, j) * lambda);
            rate.size[j] *= lambda.norm();
            rate.total += rate.size[j];
            rate.total_rate += rate.size[j] * lambda.norm();
        }
        let p = self.polynomial;
        rate.polynomial = [p[1], 2.0 * p[2], 0.0];
        for special in &mut rate.specials {
            let single = special.single;
            let motion = &spectrum.singles[single].motion;
            let (x0, v0) = phases.kept(phase, single);
            // x'' = force - c x' - w2 x
            let velocity = special.of_velocity;
            rate.polynomial[0] += velocity * motion.force;
            special.of_velocity = special.of_position - motion.damping * velocity;
            special.of_position = -motion.omega2 * velocity;
            let bound = |order| motion.special_bound(order, x0, v0, self.remaining);
            special.third =
                special.of_position.abs() * bound(3) + special.of_velocity.abs() * bound(4);
            rate.total += special.of_velocity.abs() * v0.abs();
        }
        rate
    }

    /// Changes the sign.
    pub(crate) fn negate(&mut self) {
        for terms in &mut self.terms {
            for x in terms.re.iter_mut().chain(&mut terms.im) {
                *x = -*x;
            }
        }
        self.polynomial = self.polynomial.map(|x| -x);
        for special in &mut self.specials {
            special.of_position = -special.of_position;
            special.of_velocity = -special.of_velocity;
        }
    }

    /// Integral from the start of the phase to t after it.
    pub(crate) fn integral(&self, phases: &Phases, phase: Phase, t: f64) -> f64 {
        let spectrum = &phases.spectra[phase.spectrum];
        let p = self.polynomial;
        let mut total = t * (p[0] + t * (p[1] / 2.0 + t * p[2] / 3.0));
        for j in 0..self.size.len() {
            let lambda = spectrum.lambda.get(0, j);
            if self.size[j] > 0.0 {
                total += (self.terms[0].get(0, j) * grown(lambda, t)).re;
            }
        }
        for special in &self.specials {
            let motion = &spectrum.singles[special.single].motion;
            let (x0, v0) = phases.kept(phase, special.single);
            let [x, ..] = motion.special(x0, v0, t);
            total += special.of_position * motion.special_integral(x0, v0, t);
            total += special.of_velocity * (x - x0);
        }
        total
    }

    /// Makes the signal positive just after the start of the phase; tells whether it is so at
    /// the start already.
    pub(crate) fn orient<I: Instructions>(&mut self, phases: &Phases, phase: Phase) -> bool {
        let ones = super::event::ones(self.size.len());
        let at = Instant {
            time: 0.0,
            exponentials: &ones,
        };
        let values = self.values::<I>(phases, phase, &at);
        let starts = values[0].abs() > self.rounding(0.0);
        let sign = if starts { values[0] } else { values[1] };
        if sign < 0.0 {
            self.negate();
        }
        starts
    }

    /// Bounds of the rounding of slope and curvature at the start of the phase.
    #[inline(always)]
    pub(crate) fn rate_rounding(&self, phases: &Phases, phase: Phase, moduli: &[f64]) -> [f64; 2] {
        let mut bounds = [0.0; 2];
        for (size, modulus) in self.size.iter().zip(moduli) {
            bounds[0] += size * modulus;
            bounds[1] += size * modulus * modulus;
        }
        for special in &self.specials {
            let motion = &phases.spectra[phase.spectrum].singles[special.single].motion;
            let (x0, v0) = phases.kept(phase, special.single);
            let [x, v, a] = motion.special(x0, v0, 0.0);
            let sizes = [x.abs(), v.abs(), a.abs(), motion.damping * a.abs()];
            bounds[0] +=
                special.of_position.abs() * sizes[1] + special.of_velocity.abs() * sizes[2];
            bounds[1] +=
                special.of_position.abs() * sizes[2] + special.of_velocity.abs() * sizes[3];
        }
        let p = self.polynomial;
        [
            ROUNDING * (bounds[0] + p[1].abs()),
            ROUNDING * (bounds[1] + 2.0 * p[2].abs()),
        ]
    }

    /// A typical angular frequency of the signal's curvature, in rad/s; zero for a polynomial.
    #[inline(always)]
    pub(crate) fn pace(&self, spectrum: &Spectrum) -> f64 {
        let mut bending = 0.0;
        for (size, j) in self.size.iter().zip(0..) {
            let lambda = spectrum.lambda.get(0, j);
            bending += size * lambda.norm2();
        }
        let special: f64 = (self.specials.iter())
            .map(|s| spectrum.singles[s.single].motion.omega2.abs())
            .fold(0.0, f64::max);
        let own = if self.total > 0.0 {
            bending / self.total
        } else {
            0.0
        };
        own.max(special).sqrt()
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
        for o in (0..self.size.len()).step_by(LANES) {
            let e = at.exponentials.lanes::<I>(0, o);
            for (sum, terms) in sums.iter_mut().zip(&self.terms) {
                *sum += terms.lanes(0, o).real_product(e);
            }
        }
        let mut values = [sums[0].total(), sums[1].total(), sums[2].total()];
        self.add_slow(phases, phase, at.time, &mut values);
        values
    }

    /// The value alone.
    #[inline(always)]
    pub(crate) fn value<I: Instructions>(
        &self,
        phases: &Phases,
        phase: Phase,
        at: &Instant<'_>,
    ) -> f64 {
        let mut sum = Lanes::<I>::of(0.0);
        for o in (0..self.size.len()).step_by(LANES) {
            sum += self.terms[0]
                .lanes(0, o)
                .real_product(at.exponentials.lanes(0, o));
        }
        let mut values = [sum.total(), 0.0, 0.0];
        self.add_slow(phases, phase, at.time, &mut values);
        values[0]
    }

    /// Polynomial and special parts.
    #[inline(always)]
    fn add_slow(&self, phases: &Phases, phase: Phase, t: f64, values: &mut [f64; 3]) {
        let p = self.polynomial;
        values[0] += p[0] + t * (p[1] + t * p[2]);
        values[1] += p[1] + 2.0 * t * p[2];
        values[2] += 2.0 * p[2];
        for special in &self.specials {
            let motion = &phases.spectra[phase.spectrum].singles[special.single].motion;
            let (x0, v0) = phases.kept(phase, special.single);
            let [x, v, a] = motion.special(x0, v0, t);
            let jerk = -motion.damping * a - motion.omega2 * v;
            for (value, (x, v)) in values.iter_mut().zip([(x, v), (v, a), (a, jerk)]) {
                *value += special.of_position * x + special.of_velocity * v;
            }
        }
    }

    /// The jet at `at`, valid over `reach` to both sides (or to the right alone). `sizes` bounds
    /// the moduli of the exponentials there.
    #[inline(always)]
    pub(crate) fn jet<I: Instructions>(
        &self,
        phases: &Phases,
        phase: Phase,
        at: &Instant<'_>,
        sizes: &[f64],
        moduli: &[f64],
        reach: f64,
    ) -> Jet {
        let limit = Lanes::<I>::of(FOLLOWED / reach);
        let (one, zero) = (Lanes::<I>::of(1.0), Lanes::<I>::of(0.0));
        let mut sums = [zero; 3];
        let mut third = zero;
        let mut rest = [zero; 3];
        for o in (0..self.size.len()).step_by(LANES) {
            let modulus = Lanes::<I>::load(&moduli[o..]);
            let slow = modulus.select_less(limit, one, zero);
            let e = at.exponentials.lanes(0, o);
            for (sum, terms) in sums.iter_mut().zip(&self.terms) {
                *sum += slow * terms.lanes(0, o).real_product(e);
            }
            let size = Lanes::<I>::load(&self.size[o..]) * Lanes::<I>::load(&sizes[o..]);
            let fast = (one - slow) * size;
            rest[0] += fast;
            rest[1] += fast * modulus;
            rest[2] += fast * modulus * modulus;
            third += slow * size * modulus * modulus * modulus;
        }
        let mut values = [sums[0].total(), sums[1].total(), sums[2].total()];
        self.add_slow(phases, phase, at.time, &mut values);
        let specials: f64 = self.specials.iter().map(|s| s.third).sum();
        Jet {
            value: values[0],
            slope: values[1],
            curvature: values[2],
            third: third.total() + specials,
            rest: [rest[0].total(), rest[1].total(), rest[2].total()],
            rounding: self.rounding(at.time + reach),
        }
    }
}

/// Integral of `exp(lambda s)` from 0 to t.
fn grown(lambda: Complex<f64>, t: f64) -> Complex<f64> {
    let turn = lambda.scale(t);
    if turn.norm2() > 1e-2 {
        return turn.exp().plus(-1.0) * lambda.recip();
    }
    // t (1 + z/2 (1 + z/3 (1 + ...)))
    let mut series = Complex::real(1.0);
    for n in (2..=10).rev() {
        series = (turn * series).scale(1.0 / f64::from(n)).plus(1.0);
    }
    series.scale(t)
}

/// `position . view + velocity . view lambda` for eight exponents.
#[inline(always)]
fn weights<I: Instructions>(
    views: &[View],
    guard: &Guard,
    lambda: Complex<Lanes<I>>,
    offset: usize,
) -> Complex<Lanes<I>> {
    let mut total = Complex::zero();
    let factors = guard.position.iter().zip(guard.velocity);
    for ((position, velocity), view) in factors.zip(views) {
        if *position != 0.0 || velocity != 0.0 {
            let view = view.exponents.lanes(0, offset);
            let factor = lambda
                .scale(Lanes::<I>::of(velocity))
                .plus(Lanes::<I>::of(*position));
            total += view * factor;
        }
    }
    total
}
