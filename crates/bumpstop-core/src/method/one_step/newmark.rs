//! Newmark's method. Second order with gamma = 1/2, else first.
//!
//! beta = 1/4 and gamma = 1/2, the average acceleration, is stable with any step and conserves the
//! energy of a linear structure. With `2 beta >= gamma >= 1/2` any step is stable; with a smaller
//! beta those up to `1 / (omega sqrt(gamma / 2 - beta))`; with gamma below 1/2 none. beta = 0 is the
//! central difference, explicit but for dampers.
//!
//! Sources: N. M. Newmark, A method of computation for structural dynamics, Journal of the
//! Engineering Mechanics Division 85, 67-94, 1959; T. J. R. Hughes, The Finite Element Method, 1987,
//! section 9.1.

use super::alpha_family::Weights;
use crate::error::{Error, Result};

/// The method's name.
pub const NAME: &str = "newmark";

/// The two parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Newmark {
    /// Weight of the end's acceleration in the displacement.
    pub beta: f64,
    /// Weight of the end's acceleration in the velocity.
    pub gamma: f64,
}

impl Default for Newmark {
    fn default() -> Self {
        Self {
            beta: 0.25,
            gamma: 0.5,
        }
    }
}

impl Newmark {
    pub(crate) fn weights(self) -> Result<Weights> {
        Error::check_parameter("beta", self.beta, [0.0, 1.0])?;
        Error::check_parameter("gamma", self.gamma, [0.5, 1.0])?;
        Ok(Weights {
            alpha_m: 0.0,
            alpha_f: 0.0,
            beta: self.beta,
            gamma: self.gamma,
        })
    }

    /// Largest stable step of an undamped mode, times its angular frequency; damping raises it.
    pub(crate) fn limit(self) -> f64 {
        let lack = 0.5 * self.gamma - self.beta;
        if lack > 0.0 {
            1.0 / lack.sqrt()
        } else {
            f64::INFINITY
        }
    }
}
