//! The polynomial part of a signal.

use crate::number::{Instructions, Lanes, Number};

/// `sum c_n t^n`, t since the start of the phase. Mostly of degree two at most.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Polynomial {
    /// At least three.
    coefficients: Vec<f64>,
}

impl Default for Polynomial {
    fn default() -> Self {
        Self {
            coefficients: vec![0.0; 3],
        }
    }
}

impl Polynomial {
    /// Turns it into a constant.
    #[inline(always)]
    pub(crate) fn start(&mut self, constant: f64) {
        self.coefficients.truncate(3);
        if let Some(short) = self.coefficients.first_chunk_mut() {
            *short = [constant, 0.0, 0.0];
        }
    }

    /// Adds `value t^power`.
    #[inline(always)]
    pub(crate) fn add(&mut self, power: usize, value: f64) {
        if power >= self.coefficients.len() {
            self.coefficients.resize(power + 1, 0.0);
        }
        self.coefficients[power] += value;
    }

    /// All coefficients.
    #[inline(always)]
    pub(crate) fn terms(&self) -> &[f64] {
        &self.coefficients
    }

    /// The first three, which most have alone, and the others.
    #[inline(always)]
    fn parts(&self) -> ([f64; 3], &[f64]) {
        let (short, long) = self.coefficients.split_at(3);
        ([short[0], short[1], short[2]], long)
    }

    /// Adds value, slope and curvature at t.
    #[inline(always)]
    pub(crate) fn add_to(&self, t: f64, values: &mut [f64; 3]) {
        let (c, long) = self.parts();
        values[0] += c[0] + t * (c[1] + t * c[2]);
        values[1] += c[1] + 2.0 * t * c[2];
        values[2] += 2.0 * c[2];
        if !long.is_empty() {
            add_long_part(long, t, values);
        }
    }

    /// Whether it is of degree two at most.
    #[inline(always)]
    pub(crate) fn is_short(&self) -> bool {
        self.coefficients.len() == 3
    }

    /// Values, slopes and curvatures of the part of degree two at eight times.
    #[inline(always)]
    pub(crate) fn short_over<I: Instructions>(&self, times: Lanes<I>) -> [Lanes<I>; 3] {
        let (c, _) = self.parts();
        let (constant, slope) = (Lanes::of(c[0]), Lanes::of(c[1]));
        let bend = Lanes::<I>::of(c[2]);
        let twice = bend + bend;
        [
            bend.mul_add(times, slope).mul_add(times, constant),
            twice.mul_add(times, slope),
            twice,
        ]
    }

    /// `sum |c_n| t^n`
    #[inline(always)]
    pub(crate) fn size(&self, t: f64) -> f64 {
        let (c, long) = self.parts();
        let short = c[0].abs() + t * (c[1].abs() + t * c[2].abs());
        if long.is_empty() {
            return short;
        }
        short + t * t * t * long.iter().rev().fold(0.0, |size, c| size * t + c.abs())
    }

    /// Bound of the third derivative from 0 to t.
    #[inline(always)]
    pub(crate) fn third(&self, t: f64) -> f64 {
        let (_, long) = self.parts();
        let terms = long.iter().enumerate().rev();
        terms.fold(0.0, |bound, (n, c)| {
            let n = (n + 3) as f64;
            bound * t + n * (n - 1.0) * (n - 2.0) * c.abs()
        })
    }

    pub(crate) fn derivative(&self) -> Self {
        let mut rate = Self::default();
        for (n, c) in self.coefficients.iter().enumerate().skip(1) {
            rate.add(n - 1, n as f64 * c);
        }
        rate
    }

    /// Integral from 0 to t.
    pub(crate) fn integral(&self, t: f64) -> f64 {
        let terms = self.coefficients.iter().enumerate().rev();
        terms.fold(0.0, |total, (n, c)| t * (total + c / (n + 1) as f64))
    }

    pub(crate) fn negate(&mut self) {
        for c in &mut self.coefficients {
            *c = -*c;
        }
    }
}

/// Adds value, slope and curvature of `t^3 sum c_n t^n`.
fn add_long_part(coefficients: &[f64], t: f64, values: &mut [f64; 3]) {
    let (mut value, mut slope, mut curvature) = (0.0, 0.0, 0.0);
    for (n, c) in coefficients.iter().enumerate().rev() {
        let n = (n + 3) as f64;
        value = value * t + c;
        slope = slope * t + n * c;
        curvature = curvature * t + n * (n - 1.0) * c;
    }
    values[0] += value * t * t * t;
    values[1] += slope * t * t;
    values[2] += curvature * t;
}

/// The coefficient that `t^power` has in the derivative of the given order of a polynomial; a
/// negative order is an integral from 0.
#[inline(always)]
pub(crate) fn of_derivative(coefficients: &[f64], order: i32, power: usize) -> f64 {
    let Ok(from) = usize::try_from(power as i32 + order) else {
        return 0.0;
    };
    let Some(c) = coefficients.get(from) else {
        return 0.0;
    };
    if order >= 0 {
        c * (FACTORIALS[from] / FACTORIALS[power])
    } else {
        c / (FACTORIALS[power] / FACTORIALS[from])
    }
}

/// `n!` for all powers that integrals of loads have.
const FACTORIALS: [f64; 64] = {
    let mut factorials = [1.0; 64];
    let mut n = 1;
    while n < factorials.len() {
        factorials[n] = factorials[n - 1] * n as f64;
        n += 1;
    }
    factorials
};

/// The derivative of the given order of a polynomial at t.
#[inline(always)]
pub(crate) fn derivative_at(coefficients: &[f64], order: i32, t: f64) -> f64 {
    let length = coefficients.len() as i32 - order;
    (0..length.max(0) as usize).rev().fold(0.0, |value, power| {
        value * t + of_derivative(coefficients, order, power)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_and_integrals_are_those_of_powers() {
        let mut p = Polynomial::default();
        p.start(2.0);
        for (power, value) in [(1, -1.0), (2, 0.5), (3, 4.0), (7, -3.0)] {
            p.add(power, value);
        }
        let t = 0.7f64;
        let mut values = [0.0; 3];
        p.add_to(t, &mut values);
        let expected = [
            2.0 - t + 0.5 * t * t + 4.0 * t.powi(3) - 3.0 * t.powi(7),
            -1.0 + t + 12.0 * t * t - 21.0 * t.powi(6),
            1.0 + 24.0 * t - 126.0 * t.powi(5),
        ];
        for (a, b) in values.iter().zip(expected) {
            assert!((a - b).abs() < 1e-14 * b.abs());
        }
        let mut rate = [0.0; 3];
        p.derivative().add_to(t, &mut rate);
        assert!((rate[0] - expected[1]).abs() < 1e-13);
        assert!((rate[1] - expected[2]).abs() < 1e-13);
        let integral = 2.0 * t - 0.5 * t * t + t.powi(3) / 6.0 + t.powi(4) - 0.375 * t.powi(8);
        assert!((p.integral(t) - integral).abs() < 1e-14);
        assert!(p.third(t) >= (24.0 - 630.0 * t.powi(4)).abs());
        for order in -2..=4 {
            let mut of = p.clone();
            for _ in 0..order {
                of = of.derivative();
            }
            let mut direct = [0.0; 3];
            of.add_to(t, &mut direct);
            if order >= 0 {
                let found = derivative_at(p.terms(), order, t);
                assert!((found - direct[0]).abs() < 1e-12, "{order}");
            }
        }
        assert!((derivative_at(p.terms(), -1, t) - integral).abs() < 1e-14);
        assert_eq!(of_derivative(&[6.0], -2, 2), 3.0);
    }
}
