//! Instruction sets, and the choice among them at run time.

use super::LANES;

/// What an instruction set must do with eight numbers at once. Comparisons with NaN are false.
///
/// The functions of a set other than [`super::Plain`] may only be reached through [`dispatch`],
/// which has made sure that the machine knows it.
#[allow(missing_docs)] // the names say it
pub trait Instructions: Copy + 'static {
    type Vector: Copy;
    fn splat(x: f64) -> Self::Vector;
    fn load(from: &[f64; LANES]) -> Self::Vector;
    fn store(x: Self::Vector, to: &mut [f64; LANES]);
    fn add(a: Self::Vector, b: Self::Vector) -> Self::Vector;
    fn sub(a: Self::Vector, b: Self::Vector) -> Self::Vector;
    fn mul(a: Self::Vector, b: Self::Vector) -> Self::Vector;
    fn div(a: Self::Vector, b: Self::Vector) -> Self::Vector;
    /// `a b + c`, rounded once.
    fn mul_add(a: Self::Vector, b: Self::Vector, c: Self::Vector) -> Self::Vector;
    /// `c - a b`, rounded once.
    fn sub_mul(c: Self::Vector, a: Self::Vector, b: Self::Vector) -> Self::Vector;
    fn sqrt(a: Self::Vector) -> Self::Vector;
    fn and(a: Self::Vector, b: Self::Vector) -> Self::Vector;
    fn xor(a: Self::Vector, b: Self::Vector) -> Self::Vector;
    /// The difference of the bits taken as whole numbers.
    fn sub_bits(a: Self::Vector, b: Self::Vector) -> Self::Vector;
    fn shift_left<const N: u32>(a: Self::Vector) -> Self::Vector;
    fn select_less(
        a: Self::Vector,
        b: Self::Vector,
        yes: Self::Vector,
        no: Self::Vector,
    ) -> Self::Vector;
    /// One bit a number, set where `a < b`.
    fn less(a: Self::Vector, b: Self::Vector) -> u8;
    /// The sums of eight vectors, each as [`super::Lanes::total`] adds its numbers.
    fn totals(x: [Self::Vector; LANES]) -> Self::Vector;
}

/// Work that is compiled once for each instruction set.
///
/// Everything on its way must be `#[inline(always)]`: only code inside the chosen function is
/// compiled for its instructions.
pub trait Vectorised {
    /// What comes out.
    type Output;
    /// The work, `#[inline(always)]`.
    fn run<I: Instructions>(self) -> Self::Output;
}

/// Runs the work with the best instructions of this machine.
pub fn dispatch<W: Vectorised>(work: W) -> W::Output {
    #[cfg(target_arch = "x86_64")]
    {
        super::x86::dispatch(work)
    }
    #[cfg(not(target_arch = "x86_64"))]
    {
        work.run::<super::Plain>()
    }
}
