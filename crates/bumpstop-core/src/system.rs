//! The linear structure on its modal basis.

use crate::error::{Error, Result, check_finite, check_length};

/// `q'' + (diag(damping) + coupling) q' + diag(omega2) q = forces`, unit modal mass.
///
/// A rigid-body mode has `omega2` exactly zero; a negative one is a physical instability.
#[derive(Debug, Clone, PartialEq)]
pub struct ModalSystem {
    omega2: Vec<f64>,
    damping: Vec<f64>,
    coupling: Option<Coupling>,
}

/// What else multiplies the modal velocities, in rad/s: damping that couples modes, gyroscopic
/// forces. A matrix of any symmetry.
#[derive(Debug, Clone, PartialEq)]
pub struct Coupling {
    rows: Vec<Vec<f64>>,
}

impl Coupling {
    /// The factor of the velocity of mode `column` in the equation of mode `row`.
    pub fn at(&self, row: usize, column: usize) -> f64 {
        self.rows[row][column]
    }

    /// What a velocity gives in the equation of one mode.
    pub fn product(&self, row: usize, velocity: &[f64]) -> f64 {
        (self.rows[row].iter().zip(velocity))
            .map(|(factor, v)| factor * v)
            .sum()
    }

    /// Whether a mode has a part in it.
    pub fn involves(&self, mode: usize) -> bool {
        (self.rows.iter()).any(|row| row[mode] != 0.0) || self.rows[mode].iter().any(|x| *x != 0.0)
    }
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
        Ok(Self {
            omega2,
            damping,
            coupling: None,
        })
    }

    /// The same with velocities coupled by a matrix, one row a mode.
    ///
    /// # Errors
    /// When it is not square of the system's size or a number is not finite.
    pub fn with_coupling(mut self, rows: Vec<Vec<f64>>) -> Result<Self> {
        const WHAT: &str = "the velocity coupling";
        let modes = self.modes();
        if rows.len() != modes {
            return Err(Error::Length {
                what: WHAT,
                found: rows.len(),
                expected: modes,
            });
        }
        for row in &rows {
            check_length(WHAT, row, modes)?;
            check_finite(WHAT, row)?;
        }
        let couples = rows.iter().flatten().any(|factor| *factor != 0.0);
        self.coupling = couples.then_some(Coupling { rows });
        Ok(self)
    }

    /// What couples the modal velocities, if anything does.
    pub fn coupling(&self) -> Option<&Coupling> {
        self.coupling.as_ref()
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
