//! A load that turns as fast as a motion of the structure: neither follows the other.
//!
//! The response of `z' = lambda z + exp(i omega t)` from rest is
//! `R(t) = (exp(i omega t) - exp(lambda t)) / (i omega - lambda)`, which for exponents that are
//! alike over the whole run is a small difference of large numbers. Written as
//! `R(t) = exp(lambda t) int_0^t exp((i omega - lambda) s) ds` it is exact, `t exp(i omega t)`
//! where they coincide.

use super::product::grown;
use crate::number::{Complex, Number};

/// A load and a motion resonate when they turn apart by less than this over the run: at more, the
/// two exponentials lose at most a factor of a few in their difference.
pub(crate) const APART: f64 = 0.7;

/// Whether a harmonic load and an exponent resonate over a run.
pub(crate) fn resonates(omega: f64, lambda: Complex<f64>, duration: f64) -> bool {
    (Complex::new(0.0, omega) - lambda).norm() * duration < APART
}

/// `weight R(t)`
#[derive(Debug, Clone, Copy)]
pub(crate) struct Resonant {
    pub lambda: Complex<f64>,
    pub omega: f64,
    /// Where the load's own exponent stands.
    pub at: usize,
    pub weight: Complex<f64>,
}

impl Resonant {
    /// Real parts of value, slope and curvature.
    pub(crate) fn values(&self, t: f64) -> [f64; 3] {
        let turn = Complex::new(0.0, self.omega);
        let load = turn.scale(t).exp();
        let r = self.response(t);
        let slope = self.lambda * r + load;
        let curvature = self.lambda * slope + turn * load;
        [r, slope, curvature].map(|z| self.weight.real_product(z))
    }

    /// The same with another weight.
    pub(crate) fn with_weight(&self, weight: Complex<f64>) -> Self {
        Self { weight, ..*self }
    }

    pub(crate) fn times(&self, factor: Complex<f64>) -> Self {
        self.with_weight(self.weight * factor)
    }

    /// The rate, `R' = lambda R + exp(i omega t)`: weights of both.
    pub(crate) fn rate(&self) -> [Complex<f64>; 2] {
        [self.weight * self.lambda, self.weight]
    }

    fn response(&self, t: f64) -> Complex<f64> {
        let apart = Complex::new(-self.lambda.re, self.omega - self.lambda.im);
        grown(apart, t) * self.lambda.scale(t).exp()
    }

    /// Bounds of value and slope from 0 to t.
    pub(crate) fn sizes(&self, t: f64) -> [f64; 2] {
        let size = self.weight.norm();
        let response = size * t * self.growth(t);
        [response, self.lambda.norm() * response + size]
    }

    /// Bound of the third derivative from 0 to t.
    pub(crate) fn third(&self, t: f64) -> f64 {
        let modulus = self.lambda.norm();
        let fastest = Number::max(modulus, self.omega);
        let own = modulus * modulus * modulus * t * self.growth(t);
        self.weight.norm() * (own + 3.0 * fastest * fastest)
    }

    fn growth(&self, t: f64) -> f64 {
        Number::max(1.0, Number::exp(self.lambda.re * t))
    }

    /// Integral from 0 to t: as `R' = lambda R + exp(i omega t)`.
    pub(crate) fn integral(&self, t: f64) -> f64 {
        if self.lambda.norm2() == 0.0 {
            return self.integral_of_a_drift(t);
        }
        let load = grown(Complex::new(0.0, self.omega), t);
        let integral = (self.response(t) - load) * self.lambda.recip();
        self.weight.real_product(integral)
    }

    /// Double integral of `exp(i omega t)`: `t^2 (1/2 + z/6 + z^2/24 + ...)`.
    fn integral_of_a_drift(&self, t: f64) -> f64 {
        let turn = Complex::new(0.0, self.omega * t);
        let mut series = Complex::real(1.0);
        for n in (3..=18).rev() {
            series = (turn * series).scale(1.0 / f64::from(n)).plus(1.0);
        }
        self.weight.real_product(series.scale(0.5 * t * t))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Classical Runge-Kutta on `z' = lambda z + exp(i omega t)`.
    fn marched(lambda: Complex<f64>, omega: f64, t: f64) -> Complex<f64> {
        let steps = 4000;
        let h = t / f64::from(steps);
        let rate = |z: Complex<f64>, t: f64| lambda * z + Complex::new(0.0, omega * t).exp();
        let mut z = Complex::zero();
        for n in 0..steps {
            let t = f64::from(n) * h;
            let a = rate(z, t);
            let b = rate(z + a.scale(0.5 * h), t + 0.5 * h);
            let c = rate(z + b.scale(0.5 * h), t + 0.5 * h);
            let d = rate(z + c.scale(h), t + h);
            z += (a + (b + c).scale(2.0) + d).scale(h / 6.0);
        }
        z
    }

    #[test]
    fn it_is_the_response_from_rest() {
        for (re, im, omega) in [
            (0.0, 5.0, 5.0),
            (-0.01, 5.0, 5.02),
            (0.02, 4.9, 5.0),
            (0.0, 0.0, 0.1),
        ] {
            let lambda = Complex::new(re, im);
            let t = 3.0;
            let expected = marched(lambda, omega, t);
            for weight in [Complex::new(1.0, 0.0), Complex::new(0.0, -1.0)] {
                let resonant = Resonant {
                    lambda,
                    omega,
                    at: 0,
                    weight,
                };
                let [value, slope, curvature] = resonant.values(t);
                assert!((value - weight.real_product(expected)).abs() < 1e-10);
                let h = 1e-4;
                let (after, before) = (resonant.values(t + h), resonant.values(t - h));
                assert!(((after[0] - before[0]) / (2.0 * h) - slope).abs() < 1e-5);
                assert!(((after[1] - before[1]) / (2.0 * h) - curvature).abs() < 1e-5);
                let third = (after[2] - before[2]) / (2.0 * h);
                assert!(third.abs() <= resonant.third(t + h));
                let integral = (resonant.integral(t + h) - resonant.integral(t - h)) / (2.0 * h);
                assert!((integral - value).abs() < 1e-6);
                assert_eq!(resonant.integral(0.0), 0.0);
                let [size, rate] = resonant.sizes(t);
                assert!(value.abs() <= size && slope.abs() <= rate);
            }
        }
    }
}
