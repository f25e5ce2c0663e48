//! How what is slow beside a stretch between two knots follows a table: by its integrals.
//!
//! Around s = infinity the series of the inverse is
//!
//! ```text
//! (s^2 + C s + K)^-1 g = sum_m b_m s^-m,   b_2 = g,   b_m = -C b_(m-1) - K b_(m-2),
//! ```
//!
//! or, of exponents, `sum_n X B^n Y g s^-(n+1)`. With the integrals from the start of the phase for
//! the powers of 1/s this is a motion from rest: never more than what the load does meanwhile,
//! where the series around s = 0 is as large as the load's slopes are steep.

use crate::method::piecewise_linear::impedance::Impedance;
use crate::method::piecewise_linear::single_mode::SingleMode;

/// The most that the norm of a generator times the length of a stretch may be: beyond, the series
/// around s = 0 is no larger than the motion.
pub(super) const FARTHEST: f64 = 1.0;

/// Terms below this part of the first one are left out.
const FELT: f64 = 1e-17;

/// Powers of norms beyond this are not made: what they belong to follows its load from rest in
/// another way.
const LARGEST: f64 = 1e250;

/// How many terms of `sum x^n/n!` are felt, x the norm of a generator times a length.
fn felt(turn: f64) -> usize {
    let (mut term, mut count) = (1.0, 1);
    while term > FELT {
        term *= turn / count as f64;
        count += 1;
    }
    count
}

/// How many terms the series needs for a generator of such a norm, over so long a stretch; `None`
/// where it is not to be used.
pub(super) fn terms(norm: f64, length: f64) -> Option<usize> {
    let turn = norm * length;
    let count = (turn <= FARTHEST).then(|| felt(turn))?;
    (norm.powi(count as i32) < LARGEST).then_some(count)
}

/// The `b_m` of a motion by itself under a force, from `b_2` on.
pub(super) fn of_single(motion: &SingleMode, force: f64, count: usize) -> Vec<f64> {
    let mut series = Vec::with_capacity(count);
    let (mut before, mut last) = (0.0, force);
    for _ in 0..count {
        series.push(last);
        let next = -motion.damping * last - motion.omega2 * before;
        (before, last) = (last, next);
    }
    series
}

/// The same of coupled groups.
pub(super) fn of_groups(forces: &[f64], impedance: &Impedance<'_>, count: usize) -> Vec<Vec<f64>> {
    let mut series: Vec<Vec<f64>> = Vec::with_capacity(count);
    let mut before = vec![0.0; forces.len()];
    let mut last = forces.to_vec();
    for _ in 0..count {
        let (damped, held) = (impedance.damped(&last), impedance.held(&before));
        let next = damped.iter().zip(&held).map(|(c, k)| -(c + k)).collect();
        before = std::mem::replace(&mut last, next);
        series.push(before.clone());
    }
    series
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::piecewise_linear::secular::Coupling;

    #[test]
    fn what_is_left_out_is_not_felt() {
        for turn in [0.0, 1e-9, 0.01, 0.3, 1.0, FARTHEST] {
            let count = terms(turn, 1.0).unwrap();
            let rest = (1..=count).fold(1.0, |term, n| term * turn / n as f64);
            assert!(rest <= FELT, "{turn}: {count} {rest:e}");
            assert!(count <= 20);
        }
        assert_eq!(terms(1.01 * FARTHEST, 1.0), None);
        assert_eq!(terms(1e200, 1e-200), None);
    }

    /// From rest under a force of one an oscillator moves by `(1 - cos w t)/w^2`.
    #[test]
    fn an_oscillator_starts_from_rest() {
        let motion = SingleMode::new(4.0, 0.0, 0.0, 10.0);
        let t = 1.1f64;
        let mut coupling = Coupling::default();
        coupling.start(0.0, 0.0);
        coupling.push(4.0, 0.0, 1.0);
        let groups = of_groups(&[1.0], &Impedance::OneLaw(&coupling), 30);
        let alone = of_single(&motion, 1.0, 30);
        let sum = |series: &mut dyn Iterator<Item = f64>| {
            let mut integral = t;
            let terms = series.enumerate().map(|(n, b)| {
                integral *= t / (n + 2) as f64;
                b * integral
            });
            terms.sum::<f64>()
        };
        let expected = (1.0 - (2.0 * t).cos()) / 4.0;
        let found = [
            sum(&mut alone.into_iter()),
            sum(&mut groups.into_iter().map(|b| b[0])),
        ];
        for found in found {
            assert!((found - expected).abs() < 1e-15, "{found} {expected}");
        }
    }
}
