//! Number types that the formulas are written for once.
//!
//! Law forces, guards, the secular equation and the evaluation of a phase are generic over
//! [`Number`], so that the same text serves one run (`f64`), many at once ([`Lanes`]) and
//! derivatives with respect to parameters ([`Dual`]).

mod complex;
mod dual;
mod elementary;
mod lanes;

pub use complex::Complex;
pub use dual::Dual;
pub use elementary::{exp, sin_cos};
pub use lanes::{LANES, Lanes, fill, padded, sum};

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A real number of the formulas.
///
/// Every operation is a fixed sequence of IEEE 754 operations without fused multiply-add,
/// so that all implementations agree to the bit on every machine.
pub trait Number:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
{
    /// The constant `x`.
    fn of(x: f64) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// The larger of two.
    fn max(self, other: Self) -> Self;
    /// Exponential.
    fn exp(self) -> Self;
    /// Sine and cosine of an angle in radians.
    fn sin_cos(self) -> (Self, Self);
    /// `yes` where `self < other`, else `no`.
    fn select_less(self, other: Self, yes: Self, no: Self) -> Self;
}

impl Number for f64 {
    #[inline(always)]
    fn of(x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn exp(self) -> Self {
        exp(self)
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        sin_cos(self)
    }
    #[inline(always)]
    fn select_less(self, other: Self, yes: Self, no: Self) -> Self {
        if self < other { yes } else { no }
    }
}
