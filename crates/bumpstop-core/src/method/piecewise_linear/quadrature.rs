//! The Gauss-Legendre rule of sixteen points, for what has no closed form that keeps its digits.

/// Positive nodes of the rule on `[-1, 1]` and their weights; source: M. Abramowitz, I. A. Stegun,
/// Handbook of Mathematical Functions, 1964, table 25.4.
pub(super) const RULE: [(f64, f64); 8] = [
    (0.095_012_509_837_637_44, 0.189_450_610_455_068_5),
    (0.281_603_550_779_258_9, 0.182_603_415_044_923_58),
    (0.458_016_777_657_227_37, 0.169_156_519_395_002_54),
    (0.617_876_244_402_643_8, 0.149_595_988_816_576_74),
    (0.755_404_408_355_003, 0.124_628_971_255_533_88),
    (0.865_631_202_387_831_8, 0.095_158_511_682_492_79),
    (0.944_575_023_073_232_6, 0.062_253_523_938_647_894),
    (0.989_400_934_991_649_9, 0.027_152_459_411_754_096),
];

/// The most that `|lambda| length` may be over one panel. What the rule leaves of
/// `exp(lambda t)` is below `(|lambda| length)^32 (16!)^4/(33 (32!)^3)` of its largest value: 3e-26
/// here, so that a power of the time beside it does no harm.
pub(super) const LONGEST: f64 = 8.0;

/// Integrals of the values of `f` from `start` to `start + length` by one panel.
pub(crate) fn panel<const N: usize>(
    start: f64,
    length: f64,
    mut f: impl FnMut(f64) -> [f64; N],
) -> [f64; N] {
    let half = 0.5 * length;
    let middle = start + half;
    let mut totals = [0.0; N];
    for (node, weight) in RULE {
        let (before, after) = (f(middle - half * node), f(middle + half * node));
        for (total, (a, b)) in totals.iter_mut().zip(before.into_iter().zip(after)) {
            *total += weight * (a + b);
        }
    }
    totals.map(|total| half * total)
}

/// Integral of `f` from 0 to t, in which no exponent has a modulus above `pace`.
pub(super) fn integral(t: f64, pace: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
    let panels = (pace * t / LONGEST).ceil().max(1.0);
    let length = t / panels;
    let panels = (0..panels as usize).map(|i| panel(i as f64 * length, length, |t| [f(t)])[0]);
    panels.sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rule_integrates_polynomials_up_to_its_degree() {
        for degree in 0..32 {
            let [found] = panel(0.0, 1.0, |x: f64| [x.powi(degree)]);
            let expected = 1.0 / f64::from(degree + 1);
            assert!((found - expected).abs() < 4e-16, "{degree}: {found}");
        }
    }
}
