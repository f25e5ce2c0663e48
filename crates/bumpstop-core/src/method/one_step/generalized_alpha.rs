//! The generalised alpha method of Chung and Hulbert. Second order, stable with any step.
//!
//! A mode whose frequency lies far above the step keeps the part rho of its amplitude in each step,
//! the spectral radius at infinity, and low modes are damped as little as that allows:
//! `alpha_m = (2 rho - 1) / (rho + 1)`, `alpha_f = rho / (rho + 1)`, `beta = (1 - alpha_m + alpha_f)^2 / 4`,
//! `gamma = 1/2 - alpha_m + alpha_f`. rho = 1 damps nothing, rho = 0 removes such modes in a step.
//!
//! Source: J. Chung, G. M. Hulbert, A time integration algorithm for structural dynamics with
//! improved numerical dissipation: the generalized-alpha method, Journal of Applied Mechanics 60,
//! 371-375, 1993. Forces of laws are weighted as those of the structure, at both ends.

use super::alpha_family::Weights;
use crate::error::{Error, Result};

/// The method's name.
pub const NAME: &str = "generalized_alpha";

/// The parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GeneralizedAlpha {
    /// What is left of the highest frequencies after a step, from 0 to 1.
    pub spectral_radius: f64,
}

impl Default for GeneralizedAlpha {
    fn default() -> Self {
        Self {
            spectral_radius: 0.8,
        }
    }
}

impl GeneralizedAlpha {
    pub(crate) fn weights(self) -> Result<Weights> {
        let rho = self.spectral_radius;
        Error::check_parameter("spectral_radius", rho, [0.0, 1.0])?;
        let alpha_m = (2.0 * rho - 1.0) / (rho + 1.0);
        let alpha_f = rho / (rho + 1.0);
        Ok(Weights {
            alpha_m,
            alpha_f,
            beta: 0.25 * (1.0 - alpha_m + alpha_f).powi(2),
            gamma: 0.5 - alpha_m + alpha_f,
        })
    }
}
