//! Exponential, sine and cosine without branches and without the platform's library.
//!
//! Both are good to about one unit in the last place, and being the same few IEEE operations
//! everywhere they give the same bits everywhere. The range reductions follow W. J. Cody and
//! W. Waite, Software Manual for the Elementary Functions, 1980; the polynomials are Taylor's,
//! long enough that what they cut off lies below half a unit in the last place.

use super::Bits;

/// Adding and subtracting it rounds to the nearest whole number.
const ROUND: f64 = 6_755_399_441_055_744.0; // 1.5 * 2^52

/// The same, with the exponent's bias in its low bits.
const ROUND_BIASED: f64 = ROUND + 1023.0;

const LN2_HIGH: f64 = f64::from_bits(0x3fe6_2e42_fef0_0000); // 33 bits
const LN2_LOW: f64 = 7.440_617_110_012_397e-11;

/// `1/n!` from n = 2 on.
const EXP: [f64; 12] = [
    1.0 / 2.0,
    1.0 / 6.0,
    1.0 / 24.0,
    1.0 / 120.0,
    1.0 / 720.0,
    1.0 / 5_040.0,
    1.0 / 40_320.0,
    1.0 / 362_880.0,
    1.0 / 3_628_800.0,
    1.0 / 39_916_800.0,
    1.0 / 479_001_600.0,
    1.0 / 6_227_020_800.0,
];

/// `(-1)^n/(2n+1)!` from n = 1 on.
const SIN: [f64; 7] = [
    -1.0 / 6.0,
    1.0 / 120.0,
    -1.0 / 5_040.0,
    1.0 / 362_880.0,
    -1.0 / 39_916_800.0,
    1.0 / 6_227_020_800.0,
    -1.0 / 1_307_674_368_000.0,
];

/// `(-1)^n/(2n)!` from n = 2 on.
const COS: [f64; 7] = [
    1.0 / 24.0,
    -1.0 / 720.0,
    1.0 / 40_320.0,
    -1.0 / 3_628_800.0,
    1.0 / 479_001_600.0,
    -1.0 / 87_178_291_200.0,
    1.0 / 20_922_789_888_000.0,
];

/// A polynomial of at most twelve coefficients by Estrin's rule, whose products do not wait for
/// each other as Horner's do.
#[inline(always)]
fn polynomial<T: Bits, const N: usize>(x: T, coefficients: &[f64; N]) -> T {
    let x2 = x * x;
    let x4 = x2 * x2;
    let low = four(x, x2, coefficients, 0);
    let middle = four(x, x2, coefficients, 4);
    if N <= 8 {
        low + x4 * middle
    } else {
        low + x4 * (middle + x4 * four(x, x2, coefficients, 8))
    }
}

/// `c[n] + c[n+1] x + (c[n+2] + c[n+3] x) x^2`, without the terms beyond the last coefficient.
#[inline(always)]
fn four<T: Bits, const N: usize>(x: T, x2: T, c: &[f64; N], n: usize) -> T {
    if n + 2 < N {
        two(x, c, n) + two(x, c, n + 2) * x2
    } else {
        two(x, c, n)
    }
}

/// `c[n] + c[n+1] x`
#[inline(always)]
fn two<T: Bits, const N: usize>(x: T, c: &[f64; N], n: usize) -> T {
    if n + 1 < N {
        T::of(c[n]) + T::of(c[n + 1]) * x
    } else {
        T::of(c[n])
    }
}

/// Exponential; arguments below -700 give exp(-700), which is zero for every purpose here, and
/// those above 709 infinity.
#[inline(always)]
pub(super) fn exp<T: Bits>(x: T) -> T {
    let lowest = T::of(-700.0);
    let x = x.select_less(lowest, lowest, x);
    let shifted = x * T::of(std::f64::consts::LOG2_E) + T::of(ROUND);
    let whole = shifted - T::of(ROUND);
    let r = (x - whole * T::of(LN2_HIGH)) - whole * T::of(LN2_LOW);
    let value = T::of(1.0) + (r + r * r * polynomial(r, &EXP));
    // The biased whole number sits in the low bits; moved up it is the power of two.
    let power = (whole + T::of(ROUND_BIASED)).shift_left::<52>();
    let highest = T::of(709.0);
    highest.select_less(x, T::of(f64::INFINITY), value * power)
}

// Half pi in three pieces of 24 bits and a remainder: products with whole numbers below 2^29
// are exact.
const HALF_PI: [f64; 4] = [
    f64::from_bits(0x3ff9_21fb_4000_0000),
    f64::from_bits(0x3e74_442d_0000_0000),
    f64::from_bits(0x3cf8_4698_8000_0000),
    f64::from_bits(0x3b78_cc51_701b_839a),
];

/// Sine and cosine; the reduction is exact up to 8e8 radians.
#[inline(always)]
pub(super) fn sin_cos<T: Bits>(x: T) -> (T, T) {
    let shifted = x * T::of(std::f64::consts::FRAC_2_PI) + T::of(ROUND);
    let whole = shifted - T::of(ROUND);
    let r = (((x - whole * T::of(HALF_PI[0])) - whole * T::of(HALF_PI[1]))
        - whole * T::of(HALF_PI[2]))
        - whole * T::of(HALF_PI[3]);
    let z = r * r;
    let sin = r + r * (z * polynomial(z, &SIN));
    let half = T::of(0.5) * z;
    let one = T::of(1.0) - half;
    let cos = one + (((T::of(1.0) - one) - half) + z * z * polynomial(z, &COS));
    // The quadrant is in the low bits of `shifted`: odd ones swap, the second bit changes signs.
    let odd = shifted.shift_left::<63>().xor(T::of(1.0));
    let zero = T::of(0.0);
    let (s, c) = (
        odd.select_less(zero, cos, sin),
        odd.select_less(zero, sin, cos),
    );
    let flip_sin = shifted.shift_left::<62>().and(-0.0);
    let flip_cos = (shifted + T::of(1.0)).shift_left::<62>().and(-0.0);
    (s.xor(flip_sin), c.xor(flip_cos))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn ulps(a: f64, b: f64) -> f64 {
        (a - b).abs() / (b.abs() * f64::EPSILON).max(f64::MIN_POSITIVE)
    }

    proptest! {
        #[test]
        fn exponential_agrees_with_the_platform(x in -690.0f64..700.0) {
            prop_assert!(ulps(exp(x), x.exp()) < 1.5);
        }

        #[test]
        fn sine_and_cosine_agree_with_the_platform(x in -1e6f64..1e6) {
            let (s, c) = sin_cos(x);
            prop_assert!((s - x.sin()).abs() < 1.2 * f64::EPSILON * x.sin().abs() + 1e-24);
            prop_assert!((c - x.cos()).abs() < 1.2 * f64::EPSILON * x.cos().abs() + 1e-24);
        }
    }

    #[test]
    fn special_values_are_exact() {
        assert_eq!(exp(0.0), 1.0);
        assert_eq!(sin_cos(0.0), (0.0, 1.0));
        assert_eq!(exp(1e4), f64::INFINITY);
        assert!(exp(-1e9) < 1e-300);
        assert!(exp(f64::NAN).is_nan() && sin_cos(f64::NAN).0.is_nan());
    }
}
