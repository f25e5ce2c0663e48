//! How a motion by itself follows loads.

use crate::method::piecewise_linear::single_mode::{Regime, SingleMode};
use crate::number::Complex;

/// The series of a single motion under a force, from order -2 on.
pub(super) fn series(motion: &SingleMode, force: f64, orders: usize) -> Vec<f64> {
    let (w2, c) = (motion.omega2, motion.damping);
    let mut series = vec![0.0; orders + 2];
    let first = match motion.regime {
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

/// Whether the series of a motion without stiffness, which begins with integrals of the load, is as
/// good as that of one that a damper or a spring holds, under a load that goes on for so long.
pub(super) fn has_series(motion: &SingleMode, length: f64) -> bool {
    match motion.regime {
        Regime::Free => true,
        Regime::Coasting => motion.damping * length > super::block::SLOW,
        _ => false,
    }
}

/// How a single motion follows `Re[force exp(i omega t)]`.
pub(super) fn shape(motion: &SingleMode, omega: f64, force: Complex<f64>) -> Complex<f64> {
    let dynamic = Complex::new(motion.omega2 - omega * omega, omega * motion.damping);
    force * dynamic.recip()
}
