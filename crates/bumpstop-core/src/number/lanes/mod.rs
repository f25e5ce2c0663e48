//! Eight numbers side by side, in the machine's vector registers.

mod instructions;
mod plain;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use instructions::{Instructions, Vectorised, dispatch};
pub use plain::Plain;
#[cfg(all(test, target_arch = "x86_64"))]
pub(crate) use x86::by_each;

use super::{Bits, Number, elementary};
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// How many numbers a [`Lanes`] holds, on every machine, so that sums have one order.
pub const LANES: usize = 8;

/// Eight numbers, each lane a [`Number`] of its own; `I` says by which instructions.
///
/// All instruction sets give the same bits: what is fused is written so, and sums have one order.
#[derive(Clone, Copy)]
pub struct Lanes<I: Instructions>(I::Vector);

impl<I: Instructions> Lanes<I> {
    /// Eight given numbers.
    #[inline(always)]
    pub fn new(numbers: [f64; LANES]) -> Self {
        Self(I::load(&numbers))
    }

    /// One number, and zeros beside it: what a total may start from.
    #[inline(always)]
    pub fn first(number: f64) -> Self {
        let mut numbers = [0.0; LANES];
        numbers[0] = number;
        Self::new(numbers)
    }

    /// The numbers of a block.
    #[inline(always)]
    pub fn of_block(block: &Block) -> Self {
        Self(I::load(block))
    }

    /// Writes a block.
    #[inline(always)]
    pub fn to_block(self, block: &mut Block) {
        I::store(self.0, block);
    }

    /// Eight consecutive numbers.
    ///
    /// # Panics
    /// When fewer than eight are there.
    #[inline(always)]
    pub fn load(from: &[f64]) -> Self {
        Self(I::load(first_eight(from)))
    }

    /// Writes the eight numbers.
    ///
    /// # Panics
    /// When there is room for fewer than eight.
    #[inline(always)]
    pub fn store(self, to: &mut [f64]) {
        I::store(self.0, first_eight_mut(to));
    }

    /// The eight numbers.
    #[inline(always)]
    pub fn numbers(self) -> [f64; LANES] {
        let mut numbers = [0.0; LANES];
        I::store(self.0, &mut numbers);
        numbers
    }

    /// `1/self` to ten digits, in a third of the time of a division; a large number for zero.
    /// For the first steps of iterations.
    #[inline(always)]
    pub fn rough_recip(self) -> Self {
        let one = Self::of(1.0);
        // Bits of 1/x are nearly a constant less those of x: good to a twentieth.
        let sign = Self(I::and(self.0, I::splat(-0.0)));
        let size = self.xor(sign);
        let start = Self(I::sub_bits(I::splat(NEARLY_TWICE_ONE), size.0));
        let lack = one.sub_mul(size, start);
        // Two steps of Newton at once, then one more.
        let square = lack * lack;
        let better = start.mul_add(lack, start);
        let better = better.mul_add(square, better);
        let lack = one.sub_mul(size, better);
        better.mul_add(lack, better).xor(sign)
    }

    /// `1/self` to about an ulp, in half of the time of a division; no number for zero.
    #[inline(always)]
    pub fn recip(self) -> Self {
        let rough = self.rough_recip();
        let lack = Self::of(1.0).sub_mul(self, rough);
        rough.mul_add(lack, rough)
    }

    /// One bit a lane, the lowest for the first, set where `self < other`.
    #[inline(always)]
    pub fn less(self, other: Self) -> u8 {
        I::less(self.0, other.0)
    }

    /// Sum of the lanes, pairwise, in one fixed order.
    #[inline(always)]
    pub fn total(self) -> f64 {
        plain::total(&self.numbers())
    }

    /// The sum of eight vectors, in each lane in the order of [`Lanes::total`].
    #[inline(always)]
    pub fn across(x: [Self; LANES]) -> Self {
        ((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7]))
    }

    /// The sums of eight vectors, each as [`Lanes::total`] gives it.
    #[inline(always)]
    pub fn totals(x: [Self; LANES]) -> [f64; LANES] {
        Self(I::totals([
            x[0].0, x[1].0, x[2].0, x[3].0, x[4].0, x[5].0, x[6].0, x[7].0,
        ]))
        .numbers()
    }
}

/// Its bits less those of x are about those of 1/x, with the error spread evenly.
const NEARLY_TWICE_ONE: f64 = f64::from_bits(0x7fde_6238_22fc_16e6);

#[inline(always)]
fn first_eight(from: &[f64]) -> &[f64; LANES] {
    from.first_chunk().expect("whole lanes")
}

#[inline(always)]
fn first_eight_mut(to: &mut [f64]) -> &mut [f64; LANES] {
    to.first_chunk_mut().expect("whole lanes")
}

/// Eight consecutive numbers of an array: loops over blocks need no checks of bounds.
pub type Block = [f64; LANES];

/// Copies numbers into blocks, the last one filled with zeros.
pub fn blocks(from: &[f64]) -> Vec<Block> {
    let mut blocks = vec![[0.0; LANES]; from.len().div_ceil(LANES)];
    blocks.as_flattened_mut()[..from.len()].copy_from_slice(from);
    blocks
}

/// `length` rounded up to whole lanes.
#[inline(always)]
pub const fn padded(length: usize) -> usize {
    length.div_ceil(LANES) * LANES
}

/// Scalar product of two rows of blocks, in one fixed order.
///
/// Like all loops over lanes it has no closure in it: closures are not always inlined, and only
/// inlined code is compiled for the chosen instructions.
#[inline(always)]
pub fn dot<I: Instructions>(a: &[Block], b: &[Block]) -> f64 {
    let mut total = Lanes::<I>::of(0.0);
    for (a, b) in a.iter().zip(b) {
        total = Lanes::of_block(a).mul_add(Lanes::of_block(b), total);
    }
    total.total()
}

macro_rules! lane_by_lane {
    ($($trait:ident $function:ident),*) => {$(
        impl<I: Instructions> $trait for Lanes<I> {
            type Output = Self;
            #[inline(always)]
            fn $function(self, other: Self) -> Self {
                Self(I::$function(self.0, other.0))
            }
        }
    )*};
}
lane_by_lane!(Add add, Sub sub, Mul mul, Div div);

impl<I: Instructions> AddAssign for Lanes<I> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<I: Instructions> SubAssign for Lanes<I> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<I: Instructions> Neg for Lanes<I> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.xor(Self::of(-0.0))
    }
}

impl<I: Instructions> Number for Lanes<I> {
    #[inline(always)]
    fn of(x: f64) -> Self {
        Self(I::splat(x))
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        Self(I::mul_add(self.0, factor.0, term.0))
    }
    #[inline(always)]
    fn sub_mul(self, a: Self, b: Self) -> Self {
        Self(I::sub_mul(self.0, a.0, b.0))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(I::sqrt(self.0))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.and(f64::from_bits(!(1 << 63)))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        other.select_less(self, self, other)
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
        Self::new(self.numbers().map(|x| x.power(exponent)))
    }
    #[inline(always)]
    fn select_less(self, other: Self, yes: Self, no: Self) -> Self {
        Self(I::select_less(self.0, other.0, yes.0, no.0))
    }
    fn function<const N: usize>(
        arguments: [Self; N],
        value: impl Fn([f64; N]) -> f64,
        _: impl Fn([f64; N]) -> [f64; N],
    ) -> Self {
        let each = arguments.map(Self::numbers);
        Self::new(std::array::from_fn(|lane| {
            value(std::array::from_fn(|n| each[n][lane]))
        }))
    }
}

impl<I: Instructions> Bits for Lanes<I> {
    #[inline(always)]
    fn and(self, mask: f64) -> Self {
        Self(I::and(self.0, I::splat(mask)))
    }
    #[inline(always)]
    fn xor(self, other: Self) -> Self {
        Self(I::xor(self.0, other.0))
    }
    #[inline(always)]
    fn shift_left<const N: u32>(self) -> Self {
        Self(I::shift_left::<N>(self.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    struct Everything([f64; LANES], [f64; LANES]);

    impl Vectorised for Everything {
        type Output = Vec<u64>;
        #[inline(always)]
        fn run<I: Instructions>(self) -> Vec<u64> {
            let (a, b) = (Lanes::<I>::new(self.0), Lanes::<I>::new(self.1));
            let (sin, cos) = (a * Lanes::of(50.0)).sin_cos();
            let results = [
                a + b,
                a - b,
                a * b,
                a / b,
                -a,
                a.abs().sqrt(),
                a.max(b),
                a.exp(),
                a.abs().power(1.5),
                sin,
                cos,
                a.select_less(b, sin, cos),
                Lanes::of((a * b).total()),
                a.rough_recip(),
                a.recip(),
                a.mul_add(b, sin),
                a.sub_mul(b, cos),
                Lanes::new(Lanes::totals([a, b, sin, cos, a * b, -a, b.abs(), a + b])),
                Lanes::of(f64::from(a.less(b))),
            ];
            results
                .iter()
                .flat_map(|r| r.numbers().map(f64::to_bits))
                .collect()
        }
    }

    proptest! {
        #[test]
        fn the_best_instructions_give_the_bits_of_the_plain_ones(
            a in prop::array::uniform8(-20.0f64..20.0), b in prop::array::uniform8(-20.0f64..20.0),
        ) {
            prop_assert_eq!(dispatch(Everything(a, b)), Everything(a, b).run::<Plain>());
        }

        #[test]
        fn reciprocals_are_good(x in prop_oneof![1e-200f64..1e-3, 1e-3f64..1e3, 1e3f64..1e200], negative: bool) {
            let x = if negative { -x } else { x };
            let rough = Lanes::<Plain>::of(x).rough_recip().numbers()[0];
            prop_assert!((rough * x - 1.0).abs() < 1e-10);
            let fine = Lanes::<Plain>::of(x).recip().numbers()[0];
            prop_assert!((fine * x - 1.0).abs() < 2.0 * f64::EPSILON);
        }

        #[test]
        fn lanes_give_the_bits_of_single_numbers(a in prop::array::uniform8(-20.0f64..20.0)) {
            let lanes = Lanes::<Plain>::new(a);
            let (sin, cos) = lanes.sin_cos();
            for (i, x) in a.into_iter().enumerate() {
                prop_assert_eq!(lanes.exp().numbers()[i], Number::exp(x));
                prop_assert_eq!((sin.numbers()[i], cos.numbers()[i]), Number::sin_cos(x));
            }
        }
    }
}
