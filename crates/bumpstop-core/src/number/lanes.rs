//! Eight numbers side by side.

use super::{Number, exp, sin_cos};
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// How many numbers a [`Lanes`] holds, on every machine, so that sums have one order.
pub const LANES: usize = 8;

/// Eight numbers, each lane a [`Number`] of its own.
///
/// Plain arrays: inside a dispatched function the compiler turns the element-wise loops into
/// the machine's vector instructions, without changing a bit of the result.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct Lanes(pub [f64; LANES]);

impl Lanes {
    /// Reads eight consecutive numbers.
    ///
    /// # Panics
    /// When fewer than eight are there.
    #[inline(always)]
    pub fn load(from: &[f64]) -> Self {
        let from = &from[..LANES];
        Self(std::array::from_fn(|i| from[i]))
    }

    /// Writes the eight numbers.
    ///
    /// # Panics
    /// When there is room for fewer than eight.
    #[inline(always)]
    pub fn store(self, to: &mut [f64]) {
        to[..LANES].copy_from_slice(&self.0);
    }

    /// Sum of the lanes, pairwise, in one fixed order.
    #[inline(always)]
    pub fn total(self) -> f64 {
        let a = self.0;
        ((a[0] + a[4]) + (a[2] + a[6])) + ((a[1] + a[5]) + (a[3] + a[7]))
    }

    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        Self(std::array::from_fn(|i| f(self.0[i])))
    }

    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        Self(std::array::from_fn(|i| f(self.0[i], other.0[i])))
    }
}

/// `length` rounded up to whole lanes.
#[inline(always)]
pub const fn padded(length: usize) -> usize {
    length.div_ceil(LANES) * LANES
}

/// Copies `from` into a fresh vector of whole lanes, the rest filled with `rest`.
pub fn fill(from: &[f64], rest: f64) -> Vec<f64> {
    let mut lanes = vec![rest; padded(from.len())];
    lanes[..from.len()].copy_from_slice(from);
    lanes
}

/// Sum over whole lanes of `term(offset)`, in one fixed order.
#[inline(always)]
pub fn sum(length: usize, mut term: impl FnMut(usize) -> Lanes) -> f64 {
    let mut total = Lanes::of(0.0);
    let mut offset = 0;
    while offset < length {
        total += term(offset);
        offset += LANES;
    }
    total.total()
}

macro_rules! element_wise {
    ($($trait:ident $function:ident $operator:tt),*) => {$(
        impl $trait for Lanes {
            type Output = Self;
            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                self.zip(other, |a, b| a $operator b)
            }
        }
    )*};
}
element_wise!(Add add +, Sub sub -, Mul mul *, Div div /);

impl AddAssign for Lanes {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Lanes {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Neg for Lanes {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|a| -a)
    }
}

impl Number for Lanes {
    #[inline(always)]
    fn of(x: f64) -> Self {
        Self([x; LANES])
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.map(f64::abs)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.zip(other, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn exp(self) -> Self {
        self.map(exp)
    }
    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let both: [(f64, f64); LANES] = std::array::from_fn(|i| sin_cos(self.0[i]));
        (Self(both.map(|p| p.0)), Self(both.map(|p| p.1)))
    }
    #[inline(always)]
    fn select_less(self, other: Self, yes: Self, no: Self) -> Self {
        Self(std::array::from_fn(|i| {
            if self.0[i] < other.0[i] {
                yes.0[i]
            } else {
                no.0[i]
            }
        }))
    }
}
