//! The linear structure on its modal basis.

use crate::error::{Error, Result, check_finite, check_length};

/// `q'' + diag(damping) q' + diag(omega2) q = forces`, unit modal mass.
///
/// A rigid-body mode has `omega2` exactly zero; a negative one is a physical instability.
#[derive(Debug, Clone, PartialEq)]
pub struct ModalSystem {
    omega2: Vec<f64>,
    damping: Vec<f64>,
}

impl ModalSystem {
    /// A system of `omega2.len()` modes, `omega2` in rad2/s2, `damping` (2 xi omega) in rad/s.
    ///
    /// # Errors
    /// When lengths differ, a number is not finite or a damping is negative.
    pub fn new(omega2: Vec<f64>, damping: Vec<f64>) -> Result<Self> {
        check_length("damping", &damping, omega2.len())?;
        check_finite("omega2", &omega2)?;
        check_finite("damping", &damping)?;
        if let Some(&value) = damping.iter().find(|&&c| c < 0.0) {
            return Err(Error::Negative {
                what: "modal damping",
                value,
            });
        }
        Ok(Self { omega2, damping })
    }

    /// Number of modes.
    pub fn modes(&self) -> usize {
        self.omega2.len()
    }

    /// Squared angular frequencies, in rad2/s2.
    pub fn omega2(&self) -> &[f64] {
        &self.omega2
    }

    /// Damping 2 xi omega of each mode, in rad/s.
    pub fn damping(&self) -> &[f64] {
        &self.damping
    }

    /// Highest angular frequency of the structure alone, in rad/s.
    pub fn highest_frequency(&self) -> f64 {
        self.omega2.iter().fold(0.0f64, |m, w| m.max(*w)).sqrt()
    }
}
