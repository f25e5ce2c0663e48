//! How many eigenvalues lie below a number: as many as `K - s M` has negative pivots.
//!
//! This is Sylvester's law of inertia; it holds whatever an iteration has found, and so proves
//! whether it found all (B. N. Parlett, The Symmetric Eigenvalue Problem, section 3.3).

use super::pencil::Pencil;
use crate::error::{Error, Result};

/// So many eigenvalues lie below a point that is none itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Count {
    /// The point, a squared angular frequency.
    pub at: f64,
    /// Number of eigenvalues below it.
    pub below: usize,
}

/// Counts at the first of some points that is not too close to an eigenvalue to tell.
///
/// # Errors
/// [`Error::Singular`] where all are, [`Error::Memory`], [`Error::Factorisation`].
pub fn count(pencil: &Pencil, points: impl IntoIterator<Item = f64>) -> Result<Count> {
    let mut refused = Error::Factorisation;
    for at in points {
        let factor = pencil.factored(at)?;
        let Some(singular) = factor.singularity() else {
            let below = factor.negative;
            return Ok(Count { at, below });
        };
        refused = singular;
    }
    Err(refused)
}

/// Counts inside a gap between eigenvalues.
///
/// # Errors
/// As [`count`].
pub fn count_between(pencil: &Pencil, low: f64, high: f64) -> Result<Count> {
    let parts = [0.5, 0.4, 0.6, 0.3, 0.7];
    count(pencil, parts.map(|part| low + part * (high - low)))
}

/// Counts below a point, or just beyond it, away from `inside`, where it is an eigenvalue.
///
/// # Errors
/// As [`count`].
pub fn count_beyond(pencil: &Pencil, point: f64, inside: f64) -> Result<Count> {
    let size = point.abs().max(1e-6 * (inside - point).abs());
    let away = (point - inside).signum() * size;
    count(
        pencil,
        [1e-9, 1e-8, 1e-7, 1e-6].map(|part| point + part * away),
    )
}
