//! Modal forces as functions of time that the core integrates exactly.

use crate::error::{Result, check_finite};

/// Modal forces of the loads. Constant ones for now; harmonic, polynomial and tabulated terms
/// join here as further fields, each with its closed-form particular solution.
#[derive(Debug, Clone, PartialEq)]
pub struct Forcing {
    constant: Vec<f64>,
}

impl Forcing {
    /// Forces that do not change, one for each mode, in N per unit modal displacement.
    ///
    /// # Errors
    /// When a force is not finite.
    pub fn constant(forces: Vec<f64>) -> Result<Self> {
        check_finite("force", &forces)?;
        Ok(Self { constant: forces })
    }

    /// The forces at any time.
    pub fn forces(&self) -> &[f64] {
        &self.constant
    }

    /// Work done between two modal displacements, in J.
    pub fn work(&self, from: &[f64], to: &[f64]) -> f64 {
        (self.constant.iter().zip(from).zip(to))
            .map(|((p, a), b)| p * (b - a))
            .sum()
    }
}
