//! Exponential, sine and cosine without branches and without the platform's library.
//!
//! Both are good to about one unit in the last place, and being the same few IEEE operations
//! everywhere they give the same bits everywhere. The range reductions follow Cody and Waite,
//! Software Manual for the Elementary Functions, 1980; the polynomials are Taylor's, long
//! enough that what they cut off lies below half a unit in the last place.

/// Adding and subtracting it rounds to the nearest whole number.
const ROUND: f64 = 6_755_399_441_055_744.0; // 1.5 * 2^52

const LN2_HIGH: f64 = f64::from_bits(0x3fe6_2e42_fef0_0000); // 33 bits
const LN2_LOW: f64 = 7.440_617_110_012_397e-11;

/// Exponential; arguments below -700 give exp(-700), which is zero for every purpose here.
#[inline(always)]
pub fn exp(x: f64) -> f64 {
    let x = if x < -700.0 { -700.0 } else { x };
    let shifted = x * std::f64::consts::LOG2_E + ROUND;
    let whole = shifted - ROUND;
    let r = (x - whole * LN2_HIGH) - whole * LN2_LOW;
    let mut p = 1.0 / 6_227_020_800.0;
    p = p * r + 1.0 / 479_001_600.0;
    p = p * r + 1.0 / 39_916_800.0;
    p = p * r + 1.0 / 3_628_800.0;
    p = p * r + 1.0 / 362_880.0;
    p = p * r + 1.0 / 40_320.0;
    p = p * r + 1.0 / 5_040.0;
    p = p * r + 1.0 / 720.0;
    p = p * r + 1.0 / 120.0;
    p = p * r + 1.0 / 24.0;
    p = p * r + 1.0 / 6.0;
    p = p * r + 0.5;
    let value = 1.0 + (r + r * r * p);
    // The whole number sits in the low bits of `shifted`; it goes into the exponent.
    let power = f64::from_bits((shifted.to_bits().wrapping_add(1023)) << 52);
    if x > 709.0 { f64::INFINITY } else { value * power }
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
pub fn sin_cos(x: f64) -> (f64, f64) {
    let shifted = x * std::f64::consts::FRAC_2_PI + ROUND;
    let whole = shifted - ROUND;
    let quadrant = shifted.to_bits();
    let r = (((x - whole * HALF_PI[0]) - whole * HALF_PI[1]) - whole * HALF_PI[2])
        - whole * HALF_PI[3];
    let z = r * r;
    let mut s = -1.0 / 1_307_674_368_000.0;
    s = s * z + 1.0 / 6_227_020_800.0;
    s = s * z - 1.0 / 39_916_800.0;
    s = s * z + 1.0 / 362_880.0;
    s = s * z - 1.0 / 5_040.0;
    s = s * z + 1.0 / 120.0;
    s = s * z - 1.0 / 6.0;
    let sin = r + r * (z * s);
    let mut c = 1.0 / 20_922_789_888_000.0;
    c = c * z - 1.0 / 87_178_291_200.0;
    c = c * z + 1.0 / 479_001_600.0;
    c = c * z - 1.0 / 3_628_800.0;
    c = c * z + 1.0 / 40_320.0;
    c = c * z - 1.0 / 720.0;
    c = c * z + 1.0 / 24.0;
    let half = 0.5 * z;
    let one = 1.0 - half;
    let cos = one + (((1.0 - one) - half) + z * z * c);
    let odd = quadrant & 1 == 1;
    let (s, c) = if odd { (cos, sin) } else { (sin, cos) };
    let sign_of_sin = (quadrant & 2) << 62;
    let sign_of_cos = (quadrant.wrapping_add(1) & 2) << 62;
    (
        f64::from_bits(s.to_bits() ^ sign_of_sin),
        f64::from_bits(c.to_bits() ^ sign_of_cos),
    )
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
