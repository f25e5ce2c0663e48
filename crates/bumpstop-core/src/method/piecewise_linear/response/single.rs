//! How a motion by itself follows loads.

use super::gradual::is_gradual;
use crate::method::piecewise_linear::resonance::resonates;
use crate::method::piecewise_linear::single_mode::{Regime, SingleMode};
use crate::number::Complex;

/// The series of a single motion under a force, from order -2 on; zero for one that is followed by
/// a power series of the time.
pub(super) fn series(motion: &SingleMode, force: f64, orders: usize, duration: f64) -> Vec<f64> {
    let (w2, c) = (motion.omega2, motion.damping);
    let mut series = vec![0.0; orders + 2];
    let first = match motion.regime {
        Regime::Slow => return series,
        Regime::Oscillating(lambda) if is_gradual(lambda, duration) => return series,
        Regime::Free => {
            series[0] = force;
            return series;
        }
        Regime::Coasting => 1,
        _ => 2,
    };
    let lowest = if first == 1 { c } else { w2 };
    for n in first..series.len() {
        let mut right = if n == first { force } else { 0.0 };
        if first == 1 {
            right -= series[n - 1];
        } else {
            right -= c * series[n - 1] + series[n - 2];
        }
        series[n] = right / lowest;
    }
    series
}

/// An exponent that a load resonates with.
pub(super) struct Partner {
    pub lambda: Complex<f64>,
    pub weight: Complex<f64>,
}

/// How a single motion follows `Re[force exp(i omega t)]`, less the part of an exponent that it
/// resonates with.
pub(super) fn shape(
    motion: &SingleMode,
    omega: f64,
    force: Complex<f64>,
    duration: f64,
) -> (Complex<f64>, Option<Partner>) {
    let turn = Complex::new(0.0, omega);
    let (w2, c) = (motion.omega2, motion.damping);
    match motion.regime {
        Regime::Slow if is_slow(omega, duration) => (Complex::zero(), None),
        Regime::Oscillating(lambda) if resonates(omega, lambda, duration) => {
            let weight = force * Complex::new(0.0, -0.5 / lambda.im);
            let conjugate = (turn - lambda.conj()).recip();
            (-(weight * conjugate), Some(Partner { lambda, weight }))
        }
        Regime::Coasting if is_slow(omega, duration) => {
            let weight = force.scale(1.0 / c);
            let fast = (turn.plus(c)).recip();
            (
                -(weight * fast),
                Some(Partner {
                    lambda: Complex::zero(),
                    weight,
                }),
            )
        }
        _ => {
            let dynamic = Complex::new(w2 - omega * omega, omega * c);
            (force * dynamic.recip(), None)
        }
    }
}

/// Whether a harmonic is so slow that a motion without stiffness must not be measured against it.
pub(crate) fn is_slow(omega: f64, duration: f64) -> bool {
    resonates(omega, Complex::zero(), duration)
}
