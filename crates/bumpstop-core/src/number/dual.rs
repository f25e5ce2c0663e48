//! Dual numbers: a value and its derivative with respect to one parameter.

use super::Number;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// `value + slope e` with `e^2 = 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual {
    /// The value.
    pub value: f64,
    /// Its derivative.
    pub slope: f64,
}

impl Dual {
    /// The parameter itself, with slope one.
    pub fn variable(value: f64) -> Self {
        Self { value, slope: 1.0 }
    }

    #[inline(always)]
    fn chain(self, value: f64, derivative: f64) -> Self {
        Self {
            value,
            slope: derivative * self.slope,
        }
    }
}

impl Add for Dual {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            slope: self.slope + other.slope,
        }
    }
}

impl Sub for Dual {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Dual {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            slope: self.slope * other.value + self.value * other.slope,
        }
    }
}

impl Div for Dual {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        Self {
            value,
            slope: (self.slope - value * other.slope) / other.value,
        }
    }
}

impl Neg for Dual {
    type Output = Self;
    fn neg(self) -> Self {
        self.chain(-self.value, -1.0)
    }
}

impl AddAssign for Dual {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Dual {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Number for Dual {
    fn of(x: f64) -> Self {
        Self {
            value: x,
            slope: 0.0,
        }
    }
    fn mul_add(self, factor: Self, term: Self) -> Self {
        Self {
            value: self.value.mul_add(factor.value, term.value),
            slope: (self.slope * factor.value + self.value * factor.slope) + term.slope,
        }
    }
    fn sub_mul(self, a: Self, b: Self) -> Self {
        (-a).mul_add(b, self)
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, 0.5 / root)
    }
    fn abs(self) -> Self {
        self.chain(self.value.abs(), self.value.signum())
    }
    fn max(self, other: Self) -> Self {
        if self.value > other.value {
            self
        } else {
            other
        }
    }
    fn exp(self) -> Self {
        let value = Number::exp(self.value);
        self.chain(value, value)
    }
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = Number::sin_cos(self.value);
        (self.chain(sin, cos), self.chain(cos, -sin))
    }
    fn power(self, exponent: f64) -> Self {
        let slope = exponent * self.value.power(exponent - 1.0);
        self.chain(self.value.power(exponent), slope)
    }
    fn select_less(self, other: Self, yes: Self, no: Self) -> Self {
        if self.value < other.value { yes } else { no }
    }
    fn function<const N: usize>(
        arguments: [Self; N],
        value: impl Fn([f64; N]) -> f64,
        gradient: impl Fn([f64; N]) -> [f64; N],
    ) -> Self {
        let at = arguments.map(|argument| argument.value);
        let parts = gradient(at).into_iter().zip(arguments);
        Self {
            value: value(at),
            slope: parts.map(|(part, argument)| part * argument.slope).sum(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_agree_with_calculus() {
        let x = Dual::variable(0.7);
        let y = (x * x + Dual::of(1.0)).sqrt().exp() / x;
        let cube = x.power(3.0) - x * x * x;
        assert!(cube.value.abs() < 1e-15 && cube.slope.abs() < 1e-15);
        let root = (0.7f64 * 0.7 + 1.0).sqrt();
        let expected = root.exp() * (0.7 / root / 0.7 - 1.0 / 0.49);
        assert!((y.slope - expected).abs() < 1e-13);
    }

    #[test]
    fn a_function_told_by_its_gradient_follows_the_chain_rule() {
        let x = Dual::variable(0.7);
        let product = Dual::function([x * x, x.exp()], |[a, b]| a * b, |[a, b]| [b, a]);
        let expected = x * x * x.exp();
        assert!((product.value - expected.value).abs() < 1e-15);
        assert!((product.slope - expected.slope).abs() < 1e-15);
    }
}
