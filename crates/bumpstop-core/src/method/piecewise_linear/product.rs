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

use super::quadrature::{LONGEST, panel};
use super::rows::{ComplexBlock, entry, set_entry};
use crate::number::{Complex, Instructions, LANES, Lanes, Number};

/// A signal as a factor of a product: exponentials, a polynomial, and what is neither.
#[derive(Default)]
pub(crate) struct Factor<'a> {
    exponents: Vec<ComplexBlock>,
    amplitudes: Vec<ComplexBlock>,
    count: usize,
    /// Coefficients of the powers of the time.
    polynomial: Vec<f64>,
    other: Option<Other<'a>>,
}

/// The part of a signal that is neither exponential nor polynomial.
struct Other<'a> {
    value: Box<dyn Fn(f64) -> f64 + 'a>,
    /// A modulus that no exponent in it exceeds, in 1/s.
    pace: f64,
}

/// Terms below this part of the largest one are not felt any more.
const FELT: f64 = 1e-18;

impl<'a> Factor<'a> {
    /// A polynomial of the time.
    pub(crate) fn of_polynomial(coefficients: &[f64]) -> Self {
        Self {
            polynomial: coefficients.to_vec(),
            ..Self::default()
        }
    }

    /// Adds `Re (amplitude exp(exponent t))`.
    pub(crate) fn push(&mut self, exponent: Complex<f64>, amplitude: Complex<f64>) {
        if self.count.is_multiple_of(LANES) {
            self.exponents.push(ComplexBlock::ZERO);
            self.amplitudes.push(ComplexBlock::ZERO);
        }
        set_entry(&mut self.exponents, self.count, exponent);
        set_entry(&mut self.amplitudes, self.count, amplitude);
        self.count += 1;
    }

    /// Adds what is neither exponential nor polynomial; no exponent in it has a modulus above
    /// `pace`.
    pub(crate) fn with_other(mut self, pace: f64, value: impl Fn(f64) -> f64 + 'a) -> Self {
        self.other = Some(Other {
            value: Box::new(value),
            pace,
        });
        self
    }

    /// Integral of the product with another factor from 0 to t.
    #[inline(always)]
    pub(crate) fn integral<I: Instructions>(&self, other: &Factor<'_>, t: f64) -> f64 {
        let mut total = self.exponentials_with_exponentials::<I>(other, t);
        total += self.exponentials_with_powers(&other.polynomial, t);
        total += other.exponentials_with_powers(&self.polynomial, t);
        for (n, p) in self.polynomial.iter().enumerate() {
            for (m, q) in other.polynomial.iter().enumerate() {
                total += p * q * t.powi((n + m + 1) as i32) / (n + m + 1) as f64;
            }
        }
        if self.other.is_some() || other.other.is_some() {
            total += self.remaining(other, t);
        }
        total
    }

    #[inline(always)]
    fn exponentials_with_exponentials<I: Instructions>(&self, other: &Factor<'_>, t: f64) -> f64 {
        let length = Lanes::<I>::of(t);
        let mut total = Lanes::<I>::of(0.0);
        for j in 0..self.count {
            let (lambda, a) = (entry(&self.exponents, j), entry(&self.amplitudes, j));
            let [lambda, a] = [lambda, a].map(spread::<I>);
            for (mu, b) in other.exponents.iter().zip(&other.amplitudes) {
                let (mu, b) = (mu.lanes::<I>(), b.lanes::<I>());
                let grown_together = grown(lambda + mu, length);
                let grown_apart = grown(lambda.conj() + mu, length);
                total = (a * b).add_real_product(grown_together, total);
                total = (a.conj() * b).add_real_product(grown_apart, total);
            }
        }
        0.5 * total.total()
    }

    fn exponentials_with_powers(&self, polynomial: &[f64], t: f64) -> f64 {
        let mut total = 0.0;
        if polynomial.iter().all(|p| *p == 0.0) {
            return total;
        }
        for j in 0..self.count {
            let (lambda, a) = (entry(&self.exponents, j), entry(&self.amplitudes, j));
            total += (a * with_powers(lambda, polynomial, t)).re;
        }
        total
    }

    /// Integral of the products in which the remaining part of either has a share.
    fn remaining(&self, other: &Factor<'_>, t: f64) -> f64 {
        let mut total = 0.0;
        let mut start = 0.0;
        while start < t {
            let pace = self.pace(start) + other.pace(start);
            let left = t - start;
            let length = if pace * left > LONGEST {
                // Equal panels, if the pace stays: none is left that is shorter than rounding.
                left / (pace * left / LONGEST).ceil()
            } else {
                left
            };
            let [part] = panel(start, length, |x| {
                let (own, rest) = self.values(x);
                let (others, others_rest) = other.values(x);
                [rest * (others + others_rest) + own * others_rest]
            });
            total += part;
            start = if length < left { start + length } else { t };
        }
        total
    }

    /// Value of what has a closed form, and of what has not.
    fn values(&self, t: f64) -> (f64, f64) {
        let mut closed = power_sum(&self.polynomial, t);
        for j in 0..self.count {
            let turn = entry(&self.exponents, j).scale(t);
            closed += entry(&self.amplitudes, j).real_product(turn.exp());
        }
        (closed, self.other.as_ref().map_or(0.0, |o| (o.value)(t)))
    }

    /// The largest modulus of the exponents that are felt at time t.
    fn pace(&self, t: f64) -> f64 {
        let size = |j: usize| {
            let (lambda, a) = (entry(&self.exponents, j), entry(&self.amplitudes, j));
            a.norm() * Number::exp(lambda.re * t)
        };
        let largest = (0..self.count).map(|j| entry(&self.amplitudes, j).norm());
        let felt = FELT * largest.fold(0.0, f64::max);
        (0..self.count)
            .filter(|&j| size(j) > felt)
            .map(|j| entry(&self.exponents, j).norm())
            .fold(self.other.as_ref().map_or(0.0, |o| o.pace), f64::max)
    }
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
#[inline(always)]
pub(super) fn grown<T: Number>(s: Complex<T>, t: T) -> Complex<T> {
    let turn = s.scale(t);
    let size = turn.norm2();
    // 1 + z/2 (1 + z/3 (1 + ...))
    let mut series = Complex::real(T::of(1.0));
    for n in (2..=SHORT_TERMS).rev() {
        series = (turn * series)
            .scale(T::of(1.0 / f64::from(n)))
            .plus(T::of(1.0));
    }
    let series = series.scale(t);
    let one = T::of(1.0);
    let is_short = size.select_less(T::of(SHORT * SHORT), one, T::of(0.0));
    let denominator = Complex::new(T::of(0.0).select_less(is_short, one, s.re), s.im);
    let closed = turn.exp().plus(-one) * denominator.recip();
    Complex::new(
        T::of(0.0).select_less(is_short, series.re, closed.re),
        T::of(0.0).select_less(is_short, series.im, closed.im),
    )
}

/// `sum p_n x^n`
fn power_sum(polynomial: &[f64], x: f64) -> f64 {
    polynomial.iter().rev().fold(0.0, |sum, p| sum * x + p)
}

/// Integral of `(sum p_n x^n) exp(lambda x)` from 0 to t.
fn with_powers(lambda: Complex<f64>, polynomial: &[f64], t: f64) -> Complex<f64> {
    let turn = lambda.scale(t);
    if turn.norm() < LONGEST {
        let [re, im] = panel(0.0, t, |x| {
            let value = lambda.scale(x).exp().scale(power_sum(polynomial, x));
            [value.re, value.im]
        });
        return Complex::new(re, im);
    }
    // By parts: lambda I_n = t^n exp(lambda t) - n I_(n-1), whose errors shrink while n < |lambda t|.
    let (end, inverse) = (turn.exp(), lambda.recip());
    let mut moment = end.plus(-1.0) * inverse;
    let mut total = moment.scale(polynomial[0]);
    let mut power = 1.0;
    for (n, p) in polynomial.iter().enumerate().skip(1) {
        power *= t;
        moment = (end.scale(power) - moment.scale(n as f64)) * inverse;
        total += moment.scale(*p);
    }
    total
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Plain;
    use proptest::prelude::*;

    /// `Re (amplitude exp(exponent t))`: exponent and amplitude, real and imaginary parts.
    type Term = [f64; 4];

    fn factor(terms: &[Term], polynomial: &[f64]) -> Factor<'static> {
        let mut factor = Factor::of_polynomial(polynomial);
        for [re, im, a, b] in terms {
            factor.push(Complex::new(*re, *im), Complex::new(*a, *b));
        }
        factor
    }

    /// Size of the terms of an integral.
    fn size(a: &Factor<'_>, b: &Factor<'_>, t: f64) -> f64 {
        let terms = |f: &Factor<'_>| {
            let powers = f.polynomial.iter().enumerate();
            let powers = powers.map(|(n, p)| (0.0, p.abs() * t.powi(n as i32)));
            let exponentials =
                (0..f.count).map(|j| (entry(&f.exponents, j).re, entry(&f.amplitudes, j).norm()));
            powers.chain(exponentials).collect::<Vec<_>>()
        };
        let mut total = 0.0;
        for (growth, a) in terms(a) {
            for (more, b) in terms(b) {
                total += a * b * t * Number::exp(((growth + more) * t).max(0.0));
            }
        }
        total
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
            let (a, b) = (factor(a, p), factor(b, q));
            for (a, b) in [(&a, &b), (&b, &a)] {
                let found = a.integral::<Plain>(b, t);
                let error = (found - expected).abs() / size(a, b, t);
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
            let (a, b) = (factor(&a, &p), factor(&b, &q));
            let count = 64;
            let length = t / f64::from(count);
            let expected: f64 = (0..count)
                .map(|i| panel(f64::from(i) * length, length, |x| [a.values(x).0 * b.values(x).0])[0])
                .sum();
            let found = a.integral::<Plain>(&b, t);
            let size = size(&a, &b, t);
            prop_assert!((found - expected).abs() <= 4e-15 * size, "{found} {expected} {size}");
        }

        #[test]
        fn what_is_neither_power_nor_exponential_makes_no_difference(
            a in terms(), p in powers(), b in terms(), q in powers(), c in terms(), t in 0.01f64..2.0,
        ) {
            let whole: Vec<Term> = a.iter().chain(&c).copied().collect();
            let (whole, a) = (factor(&whole, &p), factor(&a, &p));
            let (rest, b) = (factor(&c, &[]), factor(&b, &q));
            let expected = whole.integral::<Plain>(&b, t);
            let split = a.with_other(50.0, |x| rest.values(x).0);
            let size = size(&whole, &b, t);
            for found in [split.integral::<Plain>(&b, t), b.integral::<Plain>(&split, t)] {
                prop_assert!((found - expected).abs() <= 4e-15 * size, "{found} {expected} {size}");
            }
        }
    }
}
