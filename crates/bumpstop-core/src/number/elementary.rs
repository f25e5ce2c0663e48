//! Exponential, sine and cosine without branches and without the platform's library.
//!
//! Both are good to about one unit in the last place, and being the same few IEEE operations
//! everywhere they give the same bits everywhere. The range reductions follow W. J. Cody and
//! W. Waite, Software Manual for the Elementary Functions, 1980, with fused operations in place
//! of split constants; the polynomials are Taylor's,
//! long enough that what they cut off lies below half a unit in the last place.

use super::Bits;

/// Adding and subtracting it rounds to the nearest whole number.
const ROUND: f64 = 6_755_399_441_055_744.0; // 1.5 * 2^52

/// The same, with the exponent's bias in its low bits.
const ROUND_BIASED: f64 = ROUND + 1023.0;

// The logarithm of two and half pi, as their nearest numbers and what these lack. The product with
// a whole number is subtracted without rounding by the fused operation: what is left is a multiple
// of 2^-53 below one.
const LN2: [f64; 2] = [std::f64::consts::LN_2, 2.319_046_813_846_299_6e-17];
const HALF_PI: [f64; 2] = [std::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17];

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
        x4.mul_add(middle, low)
    } else {
        x4.mul_add(x4.mul_add(four(x, x2, coefficients, 8), middle), low)
    }
}

/// `c[n] + c[n+1] x + (c[n+2] + c[n+3] x) x^2`, without the terms beyond the last coefficient.
#[inline(always)]
fn four<T: Bits, const N: usize>(x: T, x2: T, c: &[f64; N], n: usize) -> T {
    if n + 2 < N {
        two(x, c, n + 2).mul_add(x2, two(x, c, n))
    } else {
        two(x, c, n)
    }
}

/// `c[n] + c[n+1] x`
#[inline(always)]
fn two<T: Bits, const N: usize>(x: T, c: &[f64; N], n: usize) -> T {
    if n + 1 < N {
        x.mul_add(T::of(c[n + 1]), T::of(c[n]))
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
    let shifted = x.mul_add(T::of(std::f64::consts::LOG2_E), T::of(ROUND));
    let whole = shifted - T::of(ROUND);
    let r = x
        .sub_mul(whole, T::of(LN2[0]))
        .sub_mul(whole, T::of(LN2[1]));
    let value = T::of(1.0) + (r * r).mul_add(polynomial(r, &EXP), r);
    // The biased whole number sits in the low bits; moved up it is the power of two.
    let power = (whole + T::of(ROUND_BIASED)).shift_left::<52>();
    let highest = T::of(709.0);
    highest.select_less(x, T::of(f64::INFINITY), value * power)
}

/// Sine and cosine; the reduction is good to 1e-24 up to 8e8 radians.
#[inline(always)]
pub(super) fn sin_cos<T: Bits>(x: T) -> (T, T) {
    let shifted = x.mul_add(T::of(std::f64::consts::FRAC_2_PI), T::of(ROUND));
    let whole = shifted - T::of(ROUND);
    let r = x
        .sub_mul(whole, T::of(HALF_PI[0]))
        .sub_mul(whole, T::of(HALF_PI[1]));
    let z = r * r;
    let sin = r.mul_add(z * polynomial(z, &SIN), r);
    let half = T::of(0.5) * z;
    let one = T::of(1.0) - half;
    let cos = one + (z * z).mul_add(polynomial(z, &COS), (T::of(1.0) - one) - half);
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
