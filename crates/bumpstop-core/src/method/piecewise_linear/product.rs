//! Integrals over time of the product of two signals, such as a force and a velocity.
//!
//! Every work in the energy ledger is one. With `Re z Re w = Re (z w + z conj(w))/2`, a pair of
//! exponentials gives
//!
//! ```text
//! integral of Re (a exp(lambda x)) Re (b exp(mu x)) from 0 to t
//!     = Re [a b E(lambda + mu, t) + conj(a) b E(conj(lambda) + mu, t)] / 2,
//! E(s, t) = (exp(s t) - 1)/s,
//! ```
//!
//! where the sum of two exponents may be zero or nearly so: undamped pairs, and pairs of which one
//! grows as fast as the other dies. Powers of the time beside an exponential follow by parts. What
//! is neither power nor exponential is integrated by quadrature, on panels short against the
//! fastest exponent that is still felt. Each case is good to rounding of the largest of its terms.

use super::quadrature::{LONGEST, RULE, panel};
use super::rows::{ComplexBlock, Rows, entry};
use crate::number::{Complex, Instructions, LANES, Lanes, Number};

/// A signal as a factor of a product: `Re sum a_j exp(lambda_j t)` of the exponents of its phase,
/// a polynomial, and what is neither.
#[derive(Default)]
pub(crate) struct Factor<'a> {
    /// `a_j`, in the order of the exponents; none at all where the factor has no such part.
    pub amplitudes: Vec<ComplexBlock>,
    /// Coefficients of the powers of the time.
    pub polynomial: Vec<f64>,
    pub other: Option<Other<'a>>,
}

/// The part of a signal that is neither exponential nor polynomial.
pub(crate) struct Other<'a> {
    pub value: Box<dyn Fn(f64) -> f64 + 'a>,
    /// A modulus that no exponent in it exceeds, in 1/s.
    pub pace: f64,
}

/// Terms below this part of the largest one are not felt any more.
const FELT: f64 = 1e-18;

impl Factor<'_> {
    /// How many exponentials have a part in it.
    fn exponentials(&self) -> usize {
        let nonzero = |block: &ComplexBlock| {
            (0..LANES)
                .filter(|&lane| block.re[lane] != 0.0 || block.im[lane] != 0.0)
                .count()
        };
        self.amplitudes.iter().map(nonzero).sum()
    }
}

/// Products of the exponentials of a phase, integrated from its start to one instant. They are
/// made when the first product asks for them and serve all others.
pub(crate) struct Products<'a> {
    exponents: &'a [ComplexBlock],
    until: f64,
    /// `E(lambda_j + lambda_k)` and `E(conj(lambda_j) + lambda_k)`, a row for each j.
    together: Rows,
    apart: Rows,
    made: Vec<bool>,
}

impl<'a> Products<'a> {
    /// For the exponents of a phase, `until` after its start.
    pub(crate) fn new(exponents: &'a [ComplexBlock], until: f64) -> Self {
        let (count, width) = (exponents.len() * LANES, exponents.len());
        Self {
            exponents,
            until,
            together: Rows::zeros(count, width),
            apart: Rows::zeros(count, width),
            made: vec![false; count],
        }
    }

    /// Integral of the product of two factors.
    #[inline(always)]
    pub(crate) fn integral<I: Instructions>(&mut self, a: &Factor<'_>, b: &Factor<'_>) -> f64 {
        let t = self.until;
        let mut total = if a.exponentials() <= b.exponentials() {
            self.of_exponentials::<I>(&a.amplitudes, &b.amplitudes)
        } else {
            self.of_exponentials::<I>(&b.amplitudes, &a.amplitudes)
        };
        total += self.with_powers::<I>(&a.amplitudes, &b.polynomial);
        total += self.with_powers::<I>(&b.amplitudes, &a.polynomial);
        total += of_powers(&a.polynomial, &b.polynomial, t);
        if a.other.is_some() || b.other.is_some() {
            total += self.remaining::<I>(a, b);
        }
        total
    }

    #[inline(always)]
    fn of_exponentials<I: Instructions>(&mut self, a: &[ComplexBlock], b: &[ComplexBlock]) -> f64 {
        let mut total = Lanes::<I>::of(0.0);
        if b.is_empty() {
            return 0.0;
        }
        for j in 0..a.len() * LANES {
            let own = entry(a, j);
            if own.re == 0.0 && own.im == 0.0 {
                continue;
            }
            self.make_row::<I>(j);
            let own = spread::<I>(own);
            let rows = self.together.row(j).iter().zip(self.apart.row(j));
            for (b, (together, apart)) in b.iter().zip(rows) {
                let b = b.lanes::<I>();
                total = (own * b).add_real_product(together.lanes(), total);
                total = (own.conj() * b).add_real_product(apart.lanes(), total);
            }
        }
        0.5 * total.total()
    }

    #[inline(always)]
    fn make_row<I: Instructions>(&mut self, j: usize) {
        if self.made[j] {
            return;
        }
        self.made[j] = true;
        let own = spread::<I>(entry(self.exponents, j));
        let rows = (self.together.row_mut(j).iter_mut()).zip(self.apart.row_mut(j));
        for (exponent, (together, apart)) in self.exponents.iter().zip(rows) {
            let exponent = exponent.lanes::<I>();
            together.put(grown_lanes::<I>(own + exponent, self.until));
            apart.put(grown_lanes::<I>(own.conj() + exponent, self.until));
        }
    }

    /// Exponentials times a polynomial.
    #[inline(always)]
    fn with_powers<I: Instructions>(&self, amplitudes: &[ComplexBlock], polynomial: &[f64]) -> f64 {
        let mut total = Lanes::<I>::of(0.0);
        if polynomial.iter().all(|p| *p == 0.0) {
            return 0.0;
        }
        for (exponent, amplitude) in self.exponents.iter().zip(amplitudes) {
            if *amplitude != ComplexBlock::ZERO {
                let part = with_powers::<I>(exponent.lanes(), polynomial, self.until);
                total = amplitude.lanes().add_real_product(part, total);
            }
        }
        total.total()
    }

    /// What the parts of either that have no closed form add.
    #[inline(always)]
    fn remaining<I: Instructions>(&self, a: &Factor<'_>, b: &Factor<'_>) -> f64 {
        let t = self.until;
        let (mut total, mut start) = (0.0, 0.0);
        while start < t {
            let pace = self.pace(a, start) + self.pace(b, start);
            let left = t - start;
            let panels = (pace * left / LONGEST).ceil().max(1.0);
            let length = left / panels;
            let [part] = panel(start, length, |x| {
                let (of_a, rest_of_a) = self.values::<I>(a, x);
                let (of_b, rest_of_b) = self.values::<I>(b, x);
                [rest_of_a * (of_b + rest_of_b) + of_a * rest_of_b]
            });
            total += part;
            start = if panels > 1.0 { start + length } else { t };
        }
        total
    }

    /// Value of what has a closed form, and of what has not.
    #[inline(always)]
    fn values<I: Instructions>(&self, of: &Factor<'_>, t: f64) -> (f64, f64) {
        let mut total = Lanes::<I>::of(0.0);
        let time = Lanes::<I>::of(t);
        for (exponent, amplitude) in self.exponents.iter().zip(&of.amplitudes) {
            let turned = exponent.lanes::<I>().scale(time).exp();
            total = amplitude.lanes().add_real_product(turned, total);
        }
        let closed = power_sum(&of.polynomial, t) + total.total();
        (closed, of.other.as_ref().map_or(0.0, |o| (o.value)(t)))
    }

    /// The largest modulus of the exponents that are felt at time t.
    fn pace(&self, of: &Factor<'_>, t: f64) -> f64 {
        let terms = || {
            let indices = 0..of.amplitudes.len() * LANES;
            indices.map(|j| (entry(self.exponents, j), entry(&of.amplitudes, j).norm()))
        };
        let felt = FELT * terms().map(|(_, size)| size).fold(0.0, f64::max);
        terms()
            .filter(|(lambda, size)| size * Number::exp(lambda.re * t) > felt)
            .map(|(lambda, _)| lambda.norm())
            .fold(of.other.as_ref().map_or(0.0, |o| o.pace), f64::max)
    }
}

/// Integral of the product of two polynomials.
fn of_powers(a: &[f64], b: &[f64], t: f64) -> f64 {
    let mut total = 0.0;
    let mut power = t;
    for (n, p) in a.iter().enumerate() {
        let mut sum = 0.0;
        for (m, q) in b.iter().enumerate().rev() {
            sum = sum * t + q / (n + m + 1) as f64;
        }
        total += p * power * sum;
        power *= t;
    }
    total
}

/// The same complex number in all lanes.
#[inline(always)]
fn spread<I: Instructions>(z: Complex<f64>) -> Complex<Lanes<I>> {
    Complex::new(Lanes::of(z.re), Lanes::of(z.im))
}

/// Modulus of `s t` below which [`grown`] sums a series.
const SHORT: f64 = 0.5;

/// Terms of that series: `SHORT^15/16!` is far below rounding.
const SHORT_TERMS: u32 = 15;

/// Integral of `exp(s x)` from 0 to t, good to rounding of t times the largest exponential.
pub(super) fn grown(s: Complex<f64>, t: f64) -> Complex<f64> {
    let turn = s.scale(t);
    if turn.norm2() < SHORT * SHORT {
        short_series(turn).scale(t)
    } else {
        turn.exp().plus(-1.0) * s.recip()
    }
}

/// The same for eight exponents.
#[inline(always)]
pub(super) fn grown_lanes<I: Instructions>(s: Complex<Lanes<I>>, t: f64) -> Complex<Lanes<I>> {
    let (t, one) = (Lanes::<I>::of(t), Lanes::<I>::of(1.0));
    let turn = s.scale(t);
    let (size, limit) = (turn.norm2(), Lanes::of(SHORT * SHORT));
    let divisor = Complex::new(size.select_less(limit, one, s.re), s.im);
    let closed = turn.exp().plus(-one) * divisor.recip();
    if size.numbers().iter().all(|size| *size >= SHORT * SHORT) {
        return closed;
    }
    let series = short_series(turn).scale(t);
    select_less(size, limit, series, closed)
}

/// `(exp(z) - 1)/z` for small z: `1 + z/2 (1 + z/3 (1 + ...))`.
#[inline(always)]
fn short_series<T: Number>(z: Complex<T>) -> Complex<T> {
    let mut series = Complex::real(T::of(1.0));
    for n in (2..=SHORT_TERMS).rev() {
        let next = (z * series).scale(T::of(1.0 / f64::from(n)));
        series = next.plus(T::of(1.0));
    }
    series
}

/// Integral of `(sum p_n x^n) exp(lambda x)` from 0 to t for eight exponents.
#[inline(always)]
fn with_powers<I: Instructions>(
    lambda: Complex<Lanes<I>>,
    polynomial: &[f64],
    t: f64,
) -> Complex<Lanes<I>> {
    let turn = lambda.scale(Lanes::of(t));
    let (size, limit) = (turn.norm2(), Lanes::of(LONGEST * LONGEST));
    let sizes = size.numbers();
    let is_short = |size: &f64| *size < LONGEST * LONGEST;
    if sizes.iter().all(is_short) {
        return powers_by_quadrature::<I>(lambda, polynomial, t);
    }
    let divisor = Complex::new(
        size.select_less(limit, Lanes::of(1.0), lambda.re),
        lambda.im,
    );
    let by_parts = powers_by_parts::<I>(turn.exp(), divisor, polynomial, t);
    if !sizes.iter().any(is_short) {
        return by_parts;
    }
    let short = powers_by_quadrature::<I>(lambda, polynomial, t);
    select_less(size, limit, short, by_parts)
}

/// One panel of quadrature serves where `|lambda t|` is small.
#[inline(always)]
fn powers_by_quadrature<I: Instructions>(
    lambda: Complex<Lanes<I>>,
    polynomial: &[f64],
    t: f64,
) -> Complex<Lanes<I>> {
    let half = 0.5 * t;
    let mut total = Complex::zero();
    for (node, weight) in RULE {
        for x in [half - half * node, half + half * node] {
            let factor = half * weight * power_sum(polynomial, x);
            let turned = lambda.scale(Lanes::of(x)).exp();
            total = turned.scale_add(Lanes::of(factor), total);
        }
    }
    total
}

/// `lambda I_n = t^n exp(lambda t) - n I_(n-1)`, whose errors shrink while `n < |lambda t|`.
#[inline(always)]
fn powers_by_parts<I: Instructions>(
    end: Complex<Lanes<I>>,
    lambda: Complex<Lanes<I>>,
    polynomial: &[f64],
    t: f64,
) -> Complex<Lanes<I>> {
    let inverse = lambda.recip();
    let mut moment = end.plus(Lanes::of(-1.0)) * inverse;
    let mut total = moment.scale(Lanes::of(polynomial[0]));
    let mut power = 1.0;
    for (n, p) in polynomial.iter().enumerate().skip(1) {
        power *= t;
        let parts = end.scale(Lanes::of(power)) - moment.scale(Lanes::of(n as f64));
        moment = parts * inverse;
        total = moment.scale_add(Lanes::of(*p), total);
    }
    total
}

/// `yes` in the lanes where `a < b`, else `no`.
#[inline(always)]
fn select_less<I: Instructions>(
    a: Lanes<I>,
    b: Lanes<I>,
    yes: Complex<Lanes<I>>,
    no: Complex<Lanes<I>>,
) -> Complex<Lanes<I>> {
    let re = a.select_less(b, yes.re, no.re);
    Complex::new(re, a.select_less(b, yes.im, no.im))
}

/// `sum p_n x^n`
#[inline(always)]
fn power_sum(polynomial: &[f64], x: f64) -> f64 {
    let mut sum = 0.0;
    for p in polynomial.iter().rev() {
        sum = sum * x + p;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::super::rows::set_entry;
    use super::*;
    use crate::number::Plain;
    use proptest::prelude::*;

    /// `Re (amplitude exp(exponent t))`: exponent and amplitude, real and imaginary parts.
    type Term = [f64; 4];

    /// A term is at most `factor t^power exp(growth t)`.
    struct Size {
        growth: f64,
        power: i32,
        factor: f64,
    }

    /// Two sums of exponentials and powers.
    struct Pair {
        exponents: Vec<ComplexBlock>,
        factors: [Factor<'static>; 2],
        sizes: [Vec<Size>; 2],
    }

    impl Pair {
        fn new(terms: [&[Term]; 2], polynomials: [&[f64]; 2]) -> Self {
            let all: Vec<&Term> = terms.into_iter().flatten().collect();
            let blocks = all.len().div_ceil(LANES);
            let mut exponents = vec![ComplexBlock::ZERO; blocks];
            for (j, [re, im, ..]) in all.iter().enumerate() {
                set_entry(&mut exponents, j, Complex::new(*re, *im));
            }
            let own = |number: usize, j: usize| (j < terms[0].len()) == (number == 0);
            let factors = [0, 1].map(|number| {
                let mut amplitudes = vec![ComplexBlock::ZERO; blocks];
                for (j, [.., a, b]) in all.iter().enumerate().filter(|(j, _)| own(number, *j)) {
                    set_entry(&mut amplitudes, j, Complex::new(*a, *b));
                }
                Factor {
                    amplitudes,
                    polynomial: polynomials[number].to_vec(),
                    other: None,
                }
            });
            let sizes = [0, 1].map(|number| {
                let powers = polynomials[number].iter().enumerate().map(|(n, p)| Size {
                    growth: 0.0,
                    power: n as i32,
                    factor: p.abs(),
                });
                let exponentials = terms[number].iter().map(|[re, _, a, b]| Size {
                    growth: *re,
                    power: 0,
                    factor: a.hypot(*b),
                });
                exponentials.chain(powers).collect()
            });
            Self {
                exponents,
                factors,
                sizes,
            }
        }

        fn integral(&self, t: f64) -> f64 {
            let mut products = Products::new(&self.exponents, t);
            products.integral::<Plain>(&self.factors[0], &self.factors[1])
        }

        /// Size of the terms of the integral.
        fn size(&self, t: f64) -> f64 {
            let mut total = 0.0;
            for a in &self.sizes[0] {
                for b in &self.sizes[1] {
                    let growth = ((a.growth + b.growth) * t).max(0.0);
                    let power = t.powi(a.power + b.power + 1);
                    total += a.factor * b.factor * power * Number::exp(growth);
                }
            }
            total
        }
    }

    type Hard = (
        &'static [Term],
        &'static [f64],
        &'static [Term],
        &'static [f64],
        f64,
        f64,
    );

    #[test]
    fn hard_products_are_those_of_120_digits() {
        let powers: &[f64] = &[1.0, -2.0, 0.5, 3.0, -1.5, 0.25, 2.0, -0.75, 0.125];
        // The last number is by mpmath 1.3 with 120 digits.
        let cases: [Hard; 8] = [
            // One grows about as fast as the other dies.
            (
                &[[-35.0, 0.0, 1.3, 0.0]],
                &[],
                &[[35.000_000_001, 0.0, 0.7, 0.0]],
                &[],
                0.4,
                0.364_000_000_072_799_76,
            ),
            // An undamped pair with itself over many periods.
            (
                &[[0.0, 1e4, 1.0, -0.4]],
                &[],
                &[[0.0, 1e4, 0.3, 2.0]],
                &[],
                20.0,
                -5.000_004_399_714_807,
            ),
            // Undamped pairs a hair apart.
            (
                &[[0.0, 500.0, 0.2, 0.9]],
                &[],
                &[[0.0, 500.000_000_1, -1.1, 0.5]],
                &[],
                3.0,
                0.345_805_504_814_741_4,
            ),
            // A growing pair with a dying one of nearly its frequency.
            (
                &[[2.0, 300.0, 1e-3, 2e-3]],
                &[],
                &[[-2.000_000_1, 300.000_01, 40.0, -7.0]],
                &[],
                5.0,
                0.064_895_094_600_784_95,
            ),
            // A lightly damped pair with its own quadrature.
            (
                &[[-1e-9, 77.0, 1.0, 0.0]],
                &[],
                &[[-1e-9, 77.0, 0.0, 1.0]],
                &[],
                2.5,
                -0.003_747_666_339_635_294,
            ),
            // High powers of the time beside slow and fast exponents.
            (
                &[
                    [-1e-7, 1e-6, 2.0, 1.0],
                    [-3.0, 4.0, 1.0, 0.5],
                    [0.0, 900.0, -0.3, 0.8],
                ],
                &[],
                &[],
                powers,
                1.7,
                19.045_442_016_128_246,
            ),
            // On both sides of the turn from quadrature to parts.
            (
                &[
                    [0.0, 7.99, 1.0, 0.0],
                    [0.0, 8.01, 0.0, 1.0],
                    [-8.1, 0.0, 3.0, 0.0],
                    [8.1, 0.0, 1e-3, 0.0],
                ],
                &[0.5, 0.25],
                &[],
                powers,
                1.0,
                1.527_553_670_195_841,
            ),
            // All kinds together.
            (
                &[[-0.5, 120.0, 0.4, -0.2], [0.0, 33.0, 0.1, 0.7]],
                &[2.0, -1.0],
                &[[-0.5, 120.0, -9.0, 3.0], [-40.0, 0.0, 5.0, 0.0]],
                &[0.1, 0.2, 0.3],
                0.9,
                -0.827_819_418_025_509_9,
            ),
        ];
        for (number, (a, p, b, q, t, expected)) in cases.into_iter().enumerate() {
            for pair in [Pair::new([a, b], [p, q]), Pair::new([b, a], [q, p])] {
                let found = pair.integral(t);
                let error = (found - expected).abs() / pair.size(t);
                assert!(error < 2e-16, "case {number}: {found} {expected} {error:e}");
            }
        }
    }

    fn terms() -> impl Strategy<Value = Vec<Term>> {
        let re = prop_oneof![Just(0.0), Just(-2.0), -3.0f64..1.0];
        let im = prop_oneof![Just(0.0), Just(25.0), 0.0f64..40.0];
        let part = -1.0f64..1.0;
        prop::collection::vec((re, im, part.clone(), part), 0..11)
            .prop_map(|all| all.into_iter().map(|(x, y, a, b)| [x, y, a, b]).collect())
    }

    fn powers() -> impl Strategy<Value = Vec<f64>> {
        prop::collection::vec(-1.0f64..1.0, 0..5)
    }

    proptest! {
        #[test]
        fn products_are_what_quadrature_finds(
            a in terms(), p in powers(), b in terms(), q in powers(), t in 0.01f64..2.0,
        ) {
            let pair = Pair::new([&a, &b], [&p, &q]);
            let products = Products::new(&pair.exponents, t);
            let value = |factor: usize, x| products.values::<Plain>(&pair.factors[factor], x).0;
            let count = 64;
            let length = t / f64::from(count);
            let expected: f64 = (0..count)
                .map(|i| panel(f64::from(i) * length, length, |x| [value(0, x) * value(1, x)])[0])
                .sum();
            let (found, size) = (pair.integral(t), pair.size(t));
            prop_assert!((found - expected).abs() <= 4e-15 * size, "{found} {expected} {size}");
        }

        #[test]
        fn what_is_neither_power_nor_exponential_makes_no_difference(
            a in terms(), p in powers(), b in terms(), q in powers(), c in terms(), t in 0.01f64..2.0,
        ) {
            let whole: Vec<Term> = a.iter().chain(&c).copied().collect();
            let expected = Pair::new([&whole, &b], [&p, &q]);
            let mut split = Pair::new([&a, &b], [&p, &q]);
            let value = move |x: f64| {
                let term = |[re, im, a, b]: &Term| {
                    Complex::new(*a, *b).real_product(Complex::new(re * x, im * x).exp())
                };
                c.iter().map(term).sum()
            };
            split.factors[0].other = Some(Other {
                value: Box::new(value),
                pace: 50.0,
            });
            let (expected, size) = (expected.integral(t), expected.size(t));
            let forward = split.integral(t);
            split.factors.swap(0, 1);
            for found in [forward, split.integral(t)] {
                prop_assert!((found - expected).abs() <= 4e-15 * size, "{found} {expected} {size}");
            }
        }
    }
}
