//! Complex numbers over any [`Number`].

use super::Number;
use std::ops::{Add, AddAssign, Mul, Neg, Sub};

/// `re + i im`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Complex<T> {
    /// Real part.
    pub re: T,
    /// Imaginary part.
    pub im: T,
}

impl<T: Number> Complex<T> {
    /// `re + i im`.
    #[inline(always)]
    pub fn new(re: T, im: T) -> Self {
        Self { re, im }
    }

    /// A real number.
    #[inline(always)]
    pub fn real(re: T) -> Self {
        Self::new(re, T::of(0.0))
    }

    /// Zero.
    #[inline(always)]
    pub fn zero() -> Self {
        Self::real(T::of(0.0))
    }

    /// Complex conjugate.
    #[inline(always)]
    pub fn conj(self) -> Self {
        Self::new(self.re, -self.im)
    }

    /// Product with a real number.
    #[inline(always)]
    pub fn scale(self, factor: T) -> Self {
        Self::new(self.re * factor, self.im * factor)
    }

    /// Sum with a real number.
    #[inline(always)]
    pub fn plus(self, real: T) -> Self {
        Self::new(self.re + real, self.im)
    }

    /// Squared modulus.
    #[inline(always)]
    pub fn norm2(self) -> T {
        self.re.mul_add(self.re, self.im * self.im)
    }

    /// Modulus (the moduli met here neither overflow nor underflow when squared).
    #[inline(always)]
    pub fn norm(self) -> T {
        self.norm2().sqrt()
    }

    /// `1 / self`.
    #[inline(always)]
    pub fn recip(self) -> Self {
        let inverse = T::of(1.0) / self.norm2();
        Self::new(self.re * inverse, -(self.im * inverse))
    }

    /// `exp(self)`.
    #[inline(always)]
    pub fn exp(self) -> Self {
        self.exp_and_size().0
    }

    /// `exp(self)` and its modulus.
    #[inline(always)]
    pub fn exp_and_size(self) -> (Self, T) {
        let size = self.re.exp();
        let (sin, cos) = self.im.sin_cos();
        (Self::new(size * cos, size * sin), size)
    }

    /// Real part of the product `self * other`.
    #[inline(always)]
    pub fn real_product(self, other: Self) -> T {
        (self.re * other.re).sub_mul(self.im, other.im)
    }

    /// `Re (self other) + term`
    #[inline(always)]
    pub fn add_real_product(self, other: Self, term: T) -> T {
        self.re.mul_add(other.re, term).sub_mul(self.im, other.im)
    }

    /// `self other + term`
    #[inline(always)]
    pub fn mul_add(self, other: Self, term: Self) -> Self {
        Self::new(
            self.re
                .mul_add(other.re, term.re)
                .sub_mul(self.im, other.im),
            self.re
                .mul_add(other.im, self.im.mul_add(other.re, term.im)),
        )
    }

    /// `self factor + term` with a real factor.
    #[inline(always)]
    pub fn scale_add(self, factor: T, term: Self) -> Self {
        Self::new(
            self.re.mul_add(factor, term.re),
            self.im.mul_add(factor, term.im),
        )
    }
}

impl<T: Number> Add for Complex<T> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::new(self.re + other.re, self.im + other.im)
    }
}

impl<T: Number> AddAssign for Complex<T> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<T: Number> Sub for Complex<T> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::new(self.re - other.re, self.im - other.im)
    }
}

impl<T: Number> Mul for Complex<T> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self::new(
            (self.re * other.re).sub_mul(self.im, other.im),
            self.re.mul_add(other.im, self.im * other.re),
        )
    }
}

impl<T: Number> Neg for Complex<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.re, -self.im)
    }
}
