//! The method of Hilber, Hughes and Taylor. Second order, stable with any step.
//!
//! Newmark's formulas with equilibrium at a mean of both ends, weighted by `1 + alpha` and `-alpha`,
//! alpha from -1/3 to 0: the more negative, the more high frequencies are damped. With beta =
//! `(1 - alpha)^2 / 4` and gamma = `(1 - 2 alpha) / 2`; alpha = 0 is Newmark's average acceleration.
//! Loads are taken at the instant between, `t + (1 + alpha) h`, which keeps the second order.
//!
//! Sources: H. M. Hilber, T. J. R. Hughes, R. L. Taylor, Improved numerical dissipation for time
//! integration algorithms in structural dynamics, Earthquake Engineering and Structural Dynamics 5,
//! 283-292, 1977; T. J. R. Hughes, The Finite Element Method, 1987, section 9.3.

use super::alpha_family::Weights;
use crate::error::{Error, Result};

/// The method's name.
pub const NAME: &str = "hht";

/// The parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hht {
    /// From -1/3 to 0.
    pub alpha: f64,
}

impl Default for Hht {
    fn default() -> Self {
        Self { alpha: -0.05 }
    }
}

impl Hht {
    pub(crate) fn weights(self) -> Result<Weights> {
        Error::check_parameter("alpha", self.alpha, [-1.0 / 3.0, 0.0])?;
        Ok(Weights {
            alpha_m: 0.0,
            alpha_f: -self.alpha,
            beta: 0.25 * (1.0 - self.alpha).powi(2),
            gamma: 0.5 - self.alpha,
        })
    }
}
