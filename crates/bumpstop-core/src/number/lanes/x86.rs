//! AVX2 and AVX-512.
#![allow(unsafe_code)] // the intrinsics; each block says why it is sound

use super::instructions::{Instructions, Vectorised};
use super::{LANES, Plain};
use std::arch::x86_64::*;

/// Runs the work with the widest instructions that this machine has.
///
/// Where the build is for machines that know them anyway (`-C target-cpu=native`), the work is
/// compiled for those alone: the same bits from a build in a third of the time.
#[inline]
pub(super) fn dispatch<W: Vectorised>(work: W) -> W::Output {
    if cfg!(all(target_feature = "avx512f", target_feature = "avx512dq")) || has_avx512() {
        // SAFETY: both features were just detected, or the whole build asks for them.
        unsafe { work.run_with_avx512() }
    } else if cfg!(all(target_feature = "avx2", target_feature = "fma")) || has_avx2() {
        // SAFETY: both features were just detected, or the whole build asks for them.
        unsafe { work.run_with_avx2() }
    } else {
        work.run::<Plain>()
    }
}

fn has_avx512() -> bool {
    is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512dq")
}

fn has_avx2() -> bool {
    is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma")
}

/// What some work gives with plain arithmetic and with each set of instructions that this machine
/// has.
#[cfg(test)]
pub(crate) fn by_each<W: Vectorised>(work: impl Fn() -> W) -> Vec<W::Output> {
    let mut found = vec![work().run::<Plain>()];
    if has_avx2() {
        // SAFETY: both features were just detected.
        found.push(unsafe { work().run_with_avx2() });
    }
    if has_avx512() {
        // SAFETY: both features were just detected.
        found.push(unsafe { work().run_with_avx512() });
    }
    found
}

/// Work behind a function for each set of instructions.
///
/// A trait's methods are compiled beside the type that they work on, and so side by side with
/// those of other work; free functions would all be compiled in one unit, one after another.
trait Compiled: Vectorised + Sized {
    #[target_feature(enable = "avx512f,avx512dq")]
    unsafe fn run_with_avx512(self) -> Self::Output {
        self.run::<Avx512>()
    }

    #[target_feature(enable = "avx2,fma")]
    unsafe fn run_with_avx2(self) -> Self::Output {
        self.run::<Avx2>()
    }
}

impl<W: Vectorised> Compiled for W {}

/// `a b + c` lane by lane, rounded once; `None` where the machine has no instruction for it.
pub(super) fn fused(a: [f64; LANES], b: [f64; LANES], c: [f64; LANES]) -> Option<[f64; LANES]> {
    // SAFETY: the feature is detected first.
    is_x86_feature_detected!("fma").then(|| unsafe { with_fma(a, b, c) })
}

#[target_feature(enable = "fma")]
fn with_fma(a: [f64; LANES], b: [f64; LANES], c: [f64; LANES]) -> [f64; LANES] {
    std::array::from_fn(|i| a[i].mul_add(b[i], c[i]))
}

/// One register of eight numbers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Avx512;

/// Two registers of four numbers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Avx2;

/// A function made of one intrinsic. Private to this file, `Avx512` and `Avx2` can only be named
/// by [`dispatch`], which has detected their features.
macro_rules! wide {
    ($($function:ident($($argument:ident),*) = $intrinsic:ident;)*) => {$(
        #[inline(always)]
        fn $function($($argument: Self::Vector),*) -> Self::Vector {
            // SAFETY: reached through `dispatch` alone, after AVX-512 was detected.
            unsafe { $intrinsic($($argument),*) }
        }
    )*};
}

impl Instructions for Avx512 {
    type Vector = __m512d;

    wide! {
        add(a, b) = _mm512_add_pd;
        sub(a, b) = _mm512_sub_pd;
        mul(a, b) = _mm512_mul_pd;
        div(a, b) = _mm512_div_pd;
        mul_add(a, b, c) = _mm512_fmadd_pd;
        sqrt(a) = _mm512_sqrt_pd;
        and(a, b) = _mm512_and_pd;
        xor(a, b) = _mm512_xor_pd;
    }

    #[inline(always)]
    fn splat(x: f64) -> Self::Vector {
        // SAFETY: as above.
        unsafe { _mm512_set1_pd(x) }
    }
    #[inline(always)]
    fn load(from: &[f64; LANES]) -> Self::Vector {
        // SAFETY: as above; the array holds the eight numbers that are read, at any alignment.
        unsafe { _mm512_loadu_pd(from.as_ptr()) }
    }
    #[inline(always)]
    fn store(x: Self::Vector, to: &mut [f64; LANES]) {
        // SAFETY: as above; the array has room for the eight numbers, at any alignment.
        unsafe { _mm512_storeu_pd(to.as_mut_ptr(), x) }
    }
    #[inline(always)]
    fn sub_bits(a: Self::Vector, b: Self::Vector) -> Self::Vector {
        // SAFETY: as above.
        unsafe {
            _mm512_castsi512_pd(_mm512_sub_epi64(
                _mm512_castpd_si512(a),
                _mm512_castpd_si512(b),
            ))
        }
    }
    #[inline(always)]
    fn shift_left<const N: u32>(a: Self::Vector) -> Self::Vector {
        // SAFETY: as above.
        unsafe { _mm512_castsi512_pd(_mm512_slli_epi64::<N>(_mm512_castpd_si512(a))) }
    }
    #[inline(always)]
    fn select_less(
        a: Self::Vector,
        b: Self::Vector,
        yes: Self::Vector,
        no: Self::Vector,
    ) -> Self::Vector {
        // SAFETY: as above.
        unsafe { _mm512_mask_blend_pd(_mm512_cmp_pd_mask::<_CMP_LT_OQ>(a, b), no, yes) }
    }
    #[inline(always)]
    fn sub_mul(c: Self::Vector, a: Self::Vector, b: Self::Vector) -> Self::Vector {
        // SAFETY: as above.
        unsafe { _mm512_fnmadd_pd(a, b, c) }
    }
    #[inline(always)]
    fn less(a: Self::Vector, b: Self::Vector) -> u8 {
        // SAFETY: as above.
        unsafe { _mm512_cmp_pd_mask::<_CMP_LT_OQ>(a, b) }
    }
    #[inline(always)]
    fn totals(x: [Self::Vector; LANES]) -> Self::Vector {
        // SAFETY: as above.
        unsafe {
            // Numbers 0..4 plus 4..8 of two vectors, then pairs, then single ones.
            let ab = halves_of(x[0], x[2]);
            let cd = halves_of(x[4], x[6]);
            let ef = halves_of(x[1], x[3]);
            let gh = halves_of(x[5], x[7]);
            let even = quarters_of(ab, cd);
            let odd = quarters_of(ef, gh);
            _mm512_add_pd(_mm512_unpacklo_pd(even, odd), _mm512_unpackhi_pd(even, odd))
        }
    }
}

/// `[a0 + a4, .., a3 + a7, b0 + b4, .., b3 + b7]`
#[inline(always)]
unsafe fn halves_of(a: __m512d, b: __m512d) -> __m512d {
    // SAFETY: reached through `Avx512::totals` alone.
    unsafe {
        _mm512_add_pd(
            _mm512_shuffle_f64x2::<0b01_00_01_00>(a, b),
            _mm512_shuffle_f64x2::<0b11_10_11_10>(a, b),
        )
    }
}

/// Of `[a, a', b, b']` and `[c, c', d, d']`, each a pair: `[a + a', b + b', c + c', d + d']`.
#[inline(always)]
unsafe fn quarters_of(ab: __m512d, cd: __m512d) -> __m512d {
    // SAFETY: reached through `Avx512::totals` alone.
    unsafe {
        _mm512_add_pd(
            _mm512_shuffle_f64x2::<0b10_00_10_00>(ab, cd),
            _mm512_shuffle_f64x2::<0b11_01_11_01>(ab, cd),
        )
    }
}

/// A function made of one intrinsic for each half.
macro_rules! halves {
    ($($function:ident($($argument:ident),*) = $intrinsic:ident;)*) => {$(
        #[inline(always)]
        fn $function($($argument: Self::Vector),*) -> Self::Vector {
            // SAFETY: reached through `dispatch` alone, after AVX2 was detected.
            unsafe { [$intrinsic($($argument[0]),*), $intrinsic($($argument[1]),*)] }
        }
    )*};
}

impl Instructions for Avx2 {
    type Vector = [__m256d; 2];

    halves! {
        add(a, b) = _mm256_add_pd;
        sub(a, b) = _mm256_sub_pd;
        mul(a, b) = _mm256_mul_pd;
        div(a, b) = _mm256_div_pd;
        mul_add(a, b, c) = _mm256_fmadd_pd;
        sqrt(a) = _mm256_sqrt_pd;
        and(a, b) = _mm256_and_pd;
        xor(a, b) = _mm256_xor_pd;
    }

    #[inline(always)]
    fn splat(x: f64) -> Self::Vector {
        // SAFETY: as above.
        unsafe { [_mm256_set1_pd(x); 2] }
    }
    #[inline(always)]
    fn load(from: &[f64; LANES]) -> Self::Vector {
        let (low, high) = from.split_at(LANES / 2);
        // SAFETY: as above; each half of the array holds the four numbers that are read.
        unsafe {
            [
                _mm256_loadu_pd(low.as_ptr()),
                _mm256_loadu_pd(high.as_ptr()),
            ]
        }
    }
    #[inline(always)]
    fn store(x: Self::Vector, to: &mut [f64; LANES]) {
        let (low, high) = to.split_at_mut(LANES / 2);
        // SAFETY: as above; each half of the array has room for four numbers.
        unsafe {
            _mm256_storeu_pd(low.as_mut_ptr(), x[0]);
            _mm256_storeu_pd(high.as_mut_ptr(), x[1]);
        }
    }
    #[inline(always)]
    fn sub_bits(a: Self::Vector, b: Self::Vector) -> Self::Vector {
        // SAFETY: as above.
        let half = |i: usize| unsafe {
            let difference = _mm256_sub_epi64(_mm256_castpd_si256(a[i]), _mm256_castpd_si256(b[i]));
            _mm256_castsi256_pd(difference)
        };
        [half(0), half(1)]
    }
    #[inline(always)]
    fn shift_left<const N: u32>(a: Self::Vector) -> Self::Vector {
        // SAFETY: as above.
        let shift = |x: __m256d| unsafe {
            let count = _mm_cvtsi32_si128(N as i32);
            _mm256_castsi256_pd(_mm256_sll_epi64(_mm256_castpd_si256(x), count))
        };
        [shift(a[0]), shift(a[1])]
    }
    #[inline(always)]
    fn select_less(
        a: Self::Vector,
        b: Self::Vector,
        yes: Self::Vector,
        no: Self::Vector,
    ) -> Self::Vector {
        // SAFETY: as above.
        let half = |i: usize| unsafe {
            _mm256_blendv_pd(no[i], yes[i], _mm256_cmp_pd::<_CMP_LT_OQ>(a[i], b[i]))
        };
        [half(0), half(1)]
    }
    #[inline(always)]
    fn sub_mul(c: Self::Vector, a: Self::Vector, b: Self::Vector) -> Self::Vector {
        // SAFETY: as above.
        let half = |i: usize| unsafe { _mm256_fnmadd_pd(a[i], b[i], c[i]) };
        [half(0), half(1)]
    }
    #[inline(always)]
    fn less(a: Self::Vector, b: Self::Vector) -> u8 {
        // SAFETY: as above.
        let half =
            |i: usize| unsafe { _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LT_OQ>(a[i], b[i])) };
        (half(0) | half(1) << (LANES / 2)) as u8
    }
    #[inline(always)]
    fn totals(x: [Self::Vector; LANES]) -> Self::Vector {
        // SAFETY: as above.
        unsafe {
            [
                four_totals([x[0], x[1], x[2], x[3]]),
                four_totals([x[4], x[5], x[6], x[7]]),
            ]
        }
    }
}

/// The sums of four vectors.
#[inline(always)]
unsafe fn four_totals(x: [[__m256d; 2]; 4]) -> __m256d {
    // SAFETY: reached through `Avx2::totals` alone.
    unsafe {
        let half = |x: [__m256d; 2]| _mm256_add_pd(x[0], x[1]);
        let quarter = |a: __m256d, b: __m256d| {
            _mm256_add_pd(
                _mm256_permute2f128_pd::<0x20>(a, b),
                _mm256_permute2f128_pd::<0x31>(a, b),
            )
        };
        let even = quarter(half(x[0]), half(x[2]));
        let odd = quarter(half(x[1]), half(x[3]));
        _mm256_add_pd(_mm256_unpacklo_pd(even, odd), _mm256_unpackhi_pd(even, odd))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::{Lanes, Number};

    struct Mix([f64; LANES]);

    impl Vectorised for Mix {
        type Output = [u64; LANES];
        #[inline(always)]
        fn run<I: Instructions>(self) -> [u64; LANES] {
            let x = Lanes::<I>::new(self.0);
            let (sin, cos) = x.sin_cos();
            let mixed = (sin * cos - x / cos).select_less(x.exp(), -x.sqrt(), x.abs());
            let fused = mixed.max(sin).mul_add(cos, x).sub_mul(sin, cos);
            let rough = fused.rough_recip() + Lanes::of(f64::from(sin.less(cos)));
            Lanes::totals([x, sin, cos, mixed, fused, -x, cos, rough]).map(f64::to_bits)
        }
    }

    #[test]
    fn avx2_gives_the_bits_of_plain_arithmetic() {
        if !(is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma")) {
            return;
        }
        let numbers = [0.0, -1.5, 2.25, 1e-9, 300.0, -0.1, 17.0, 1e6];
        // SAFETY: both features were just detected.
        let found = unsafe { Mix(numbers).run_with_avx2() };
        assert_eq!(found, Mix(numbers).run::<Plain>());
    }
}
