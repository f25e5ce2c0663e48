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
#[cfg(all(test, target_arch = "x86_64"))]
pub(crate) use lanes::by_each;
pub use lanes::{
    Block, Instructions, LANES, Lanes, Plain, Vectorised, blocks, dispatch, dot, padded,
};

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A real number of the formulas.
///
/// Every operation is a fixed sequence of IEEE 754 operations, fused where the name says so and
/// nowhere else, so that all implementations agree to the bit on every machine.
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
    /// `self factor + term`, rounded once.
    fn mul_add(self, factor: Self, term: Self) -> Self;
    /// `self - a b`, rounded once.
    fn sub_mul(self, a: Self, b: Self) -> Self;
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
    /// A power of a number that is not negative. No hot loop asks for it.
    fn power(self, exponent: f64) -> Self;
    /// `yes` where `self < other`, else `no`.
    fn select_less(self, other: Self, yes: Self, no: Self) -> Self;
    /// A function that is known by its value and its gradient alone, such as a user's. No hot
    /// loop asks for it.
    fn function<const N: usize>(
        arguments: [Self; N],
        value: impl Fn([f64; N]) -> f64,
        gradient: impl Fn([f64; N]) -> [f64; N],
    ) -> Self;
}

/// A number whose bits can be worked on, for the elementary functions.
pub trait Bits: Number {
    /// The bits that `mask` has too.
    fn and(self, mask: f64) -> Self;
    /// The bits that are in one of the two.
    fn xor(self, other: Self) -> Self;
    /// The bits moved up by `N`.
    fn shift_left<const N: u32>(self) -> Self;
}

impl Number for f64 {
    #[inline(always)]
    fn of(x: f64) -> Self {
        x
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        f64::mul_add(self, factor, term)
    }
    #[inline(always)]
    fn sub_mul(self, a: Self, b: Self) -> Self {
        f64::mul_add(-a, b, self)
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
        elementary::exp(self)
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        elementary::sin_cos(self)
    }
    fn power(self, exponent: f64) -> Self {
        // Not the platform's, so that the bits are the same everywhere.
        libm::pow(self, exponent)
    }
    #[inline(always)]
    fn select_less(self, other: Self, yes: Self, no: Self) -> Self {
        if self < other { yes } else { no }
    }
    #[inline(always)]
    fn function<const N: usize>(
        arguments: [Self; N],
        value: impl Fn([f64; N]) -> f64,
        _: impl Fn([f64; N]) -> [f64; N],
    ) -> Self {
        value(arguments)
    }
}

impl Bits for f64 {
    #[inline(always)]
    fn and(self, mask: f64) -> Self {
        f64::from_bits(self.to_bits() & mask.to_bits())
    }
    #[inline(always)]
    fn xor(self, other: Self) -> Self {
        f64::from_bits(self.to_bits() ^ other.to_bits())
    }
    #[inline(always)]
    fn shift_left<const N: u32>(self) -> Self {
        f64::from_bits(self.to_bits() << N)
    }
}
