//! Polynomials on a step, by their Bernstein coefficients.
//!
//! Between 0 and 1 a polynomial lies between the least and the largest of its coefficients, and
//! those of a half of the interval follow from the whole's by averages: that is how its first zero
//! is found without a chance to miss one. Source: G. Farin, Curves and Surfaces for CAGD, 5th
//! edition, 2002, chapters 4 to 6.

/// The highest degree.
pub(crate) const MOST: usize = 10;

/// How often an interval is halved before its ends are taken to tell all: down to rounding.
const HALVINGS: u32 = 52;

/// `sum_i c_i (n over i) theta^i (1 - theta)^(n - i)`
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Bernstein {
    degree: usize,
    c: [f64; MOST + 1],
}

/// n over k.
fn binomial(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |product, i| product * (n - i) as f64 / (i + 1) as f64)
}

impl Bernstein {
    /// The constant.
    pub(crate) fn constant(degree: usize, value: f64) -> Self {
        let mut c = [0.0; MOST + 1];
        c[..=degree].fill(value);
        Self { degree, c }
    }

    /// `theta^up (1 - theta)^down`, of a degree that may be higher than their sum.
    pub(crate) fn product(degree: usize, up: usize, down: usize) -> Self {
        let mut c = [0.0; MOST + 1];
        let from_up = c[up..=degree - down].iter_mut().enumerate();
        for (i, to) in from_up {
            *to = binomial(degree - up - down, i) / binomial(degree, up + i);
        }
        Self { degree, c }
    }

    /// `sum_j a_j theta^j`
    pub(crate) fn of_powers(powers: &[f64]) -> Self {
        let degree = powers.len() - 1;
        let mut sum = Self::constant(degree, 0.0);
        for (power, factor) in powers.iter().enumerate() {
            sum.add(*factor, &Self::product(degree, power, 0));
        }
        sum
    }

    fn coefficients(&self) -> &[f64] {
        &self.c[..=self.degree]
    }

    /// Adds a multiple of another one of the same degree.
    pub(crate) fn add(&mut self, factor: f64, other: &Self) {
        debug_assert_eq!(self.degree, other.degree);
        for (c, other) in self.c.iter_mut().zip(&other.c) {
            *c += factor * other;
        }
    }

    pub(crate) fn degree(&self) -> usize {
        self.degree
    }

    /// Its derivative, as a polynomial of the same degree.
    pub(crate) fn derivative(&self) -> Self {
        let n = self.degree as f64;
        let slope = |i: usize| n * (self.c[i + 1] - self.c[i]);
        let mut c = [0.0; MOST + 1];
        for (i, to) in c[..=self.degree].iter_mut().enumerate() {
            let part = i as f64 / n;
            let before = if i > 0 { part * slope(i - 1) } else { 0.0 };
            let after = if i < self.degree {
                (1.0 - part) * slope(i)
            } else {
                0.0
            };
            *to = before + after;
        }
        Self { c, ..*self }
    }

    /// Its size at most.
    pub(crate) fn size(&self) -> f64 {
        (self.coefficients().iter()).fold(0.0, |size, c| size.max(c.abs()))
    }

    /// The same on both halves of the interval, by de Casteljau's averages.
    pub(crate) fn halves(&self) -> [Self; 2] {
        let (mut left, mut right) = (*self, *self);
        for level in 1..=self.degree {
            for i in 0..=self.degree - level {
                right.c[i] = 0.5 * (right.c[i] + right.c[i + 1]);
            }
            left.c[level] = right.c[0];
        }
        [left, right]
    }

    /// Its value, by de Casteljau's averages, too: as accurate as its coefficients.
    pub(crate) fn at(&self, theta: f64) -> f64 {
        let mut c = self.c;
        for level in 1..=self.degree {
            for i in 0..=self.degree - level {
                c[i] += theta * (c[i + 1] - c[i]);
            }
        }
        c[0]
    }

    /// Where it first goes below `-rounding`: the zero that it passes there, or the end of the
    /// interval's halves up to which it is not below that.
    pub(crate) fn first_fall(&self, rounding: f64) -> Option<f64> {
        debug_assert!(self.c.iter().all(|c| c.is_finite()));
        self.fall(rounding, 0.0, 1.0, HALVINGS)
    }

    fn fall(&self, rounding: f64, left: f64, width: f64, halvings: u32) -> Option<f64> {
        let (c, low) = (self.coefficients(), -rounding);
        if c.iter().all(|c| *c >= low) {
            return None;
        }
        if c[0] < low {
            return Some(left);
        }
        if c.windows(2).all(|pair| pair[1] <= pair[0]) {
            return Some(left + width * self.falling_zero());
        }
        if halvings == 0 {
            return (c[self.degree] < low).then_some(left + width);
        }
        let half = 0.5 * width;
        let [before, after] = self.halves();
        (before.fall(rounding, left, half, halvings - 1))
            .or_else(|| after.fall(rounding, left + half, half, halvings - 1))
    }

    /// The zero of a polynomial that falls from above to below it: Newton's steps inside a
    /// bracket. The left end where that is at zero already.
    fn falling_zero(&self) -> f64 {
        let slope = self.derivative();
        let [mut low, mut high] = [0.0, 1.0];
        if self.c[0] <= 0.0 {
            return 0.0;
        }
        let mut theta = self.c[0] / (self.c[0] - self.c[self.degree]);
        for _ in 0..100 {
            let value = self.at(theta);
            if value > 0.0 {
                low = theta;
            } else {
                high = theta;
            }
            let newton = theta - value / slope.at(theta);
            let next = if newton > low && newton < high {
                newton
            } else {
                0.5 * (low + high)
            };
            if (next - theta).abs() <= f64::EPSILON * theta {
                return next;
            }
            theta = next;
        }
        theta
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn horner(powers: &[f64], x: f64) -> f64 {
        powers.iter().rev().fold(0.0, |sum, c| sum * x + c)
    }

    /// The powers of `factor (x - r_1) (x - r_2) ...`
    fn from_roots(factor: f64, roots: &[f64]) -> Vec<f64> {
        let mut powers = vec![factor];
        for root in roots {
            powers.insert(0, 0.0);
            for i in 0..powers.len() - 1 {
                powers[i] -= root * powers[i + 1];
            }
        }
        powers
    }

    proptest! {
        #[test]
        fn both_forms_agree(powers in proptest::collection::vec(-1.0f64..1.0, 4..=11),
                            theta in 0.0f64..1.0) {
            let polynomial = Bernstein::of_powers(&powers);
            prop_assert!((polynomial.at(theta) - horner(&powers, theta)).abs() < 1e-13);
            let slope: Vec<f64> = (1..powers.len()).map(|i| i as f64 * powers[i]).collect();
            let found = polynomial.derivative().at(theta);
            prop_assert!((found - horner(&slope, theta)).abs() < 1e-11);
            let [left, right] = polynomial.halves();
            prop_assert!((left.at(theta) - horner(&powers, 0.5 * theta)).abs() < 1e-13);
            prop_assert!((right.at(theta) - horner(&powers, 0.5 + 0.5 * theta)).abs() < 1e-13);
        }

        #[test]
        fn the_first_root_is_found(
            mut roots in proptest::collection::vec(0.02f64..0.98, 1..5),
            others in proptest::collection::vec(1.2f64..3.0, 0..4),
        ) {
            roots.sort_by(f64::total_cmp);
            prop_assume!(roots.windows(2).all(|pair| pair[1] - pair[0] > 1e-3));
            let mut all = roots.clone();
            all.extend(&others);
            let sign = if all.len() % 2 == 0 { 1.0 } else { -1.0 };
            let polynomial = Bernstein::of_powers(&from_roots(sign, &all));
            let found = polynomial.first_fall(0.0).unwrap();
            prop_assert!((found - roots[0]).abs() < 1e-9, "{found} {roots:?}");
        }
    }

    #[test]
    fn narrow_dips_are_seen_and_touches_below_rounding_are_not() {
        // (x - 1/3)^2 - depth
        let dip = |depth: f64| Bernstein::of_powers(&[1.0 / 9.0 - depth, -2.0 / 3.0, 1.0, 0.0]);
        let found = dip(1e-12).first_fall(1e-15).unwrap();
        assert!((found - (1.0 / 3.0 - 1e-6)).abs() < 1e-9);
        assert_eq!(dip(0.0).first_fall(1e-15), None);
        assert_eq!(dip(-1e-12).first_fall(1e-15), None);
    }

    #[test]
    fn what_starts_below_falls_at_once() {
        assert_eq!(Bernstein::constant(4, -1.0).first_fall(1e-3), Some(0.0));
        assert_eq!(Bernstein::constant(4, -1.0).first_fall(2.0), None);
    }
}
