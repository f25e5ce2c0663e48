//! The linear structure on its modal basis.

use crate::error::{Error, Result, check_finite, check_length};
use crate::rotation::Rotation;

/// `q'' + (diag(damping) + coupling) q' + (diag(omega2) + circulatory) q = forces`, unit modal mass.
///
/// A rigid-body mode has `omega2` exactly zero; a negative one is a physical instability.
#[derive(Debug, Clone, PartialEq)]
pub struct ModalSystem {
    omega2: Vec<f64>,
    damping: Vec<f64>,
    coupling: Option<Coupling>,
    circulatory: Option<Coupling>,
    rotations: Vec<Rotation>,
}

/// What else multiplies the modal velocities (in rad/s: damping that couples modes, gyroscopic
/// forces) or displacements (in rad2/s2: circulatory forces). A matrix of any symmetry.
#[derive(Debug, Clone, PartialEq)]
pub struct Coupling {
    rows: Vec<Vec<f64>>,
}

impl Coupling {
    /// The factor of mode `column` in the equation of mode `row`.
    pub fn at(&self, row: usize, column: usize) -> f64 {
        self.rows[row][column]
    }

    /// What modal velocities, or displacements, give in the equation of one mode.
    pub fn product(&self, row: usize, modal: &[f64]) -> f64 {
        (self.rows[row].iter().zip(modal))
            .map(|(factor, x)| factor * x)
            .sum()
    }

    /// A square matrix of finite numbers; `None` where it couples nothing.
    pub(crate) fn new(
        what: &'static str,
        rows: Vec<Vec<f64>>,
        modes: usize,
    ) -> Result<Option<Self>> {
        if rows.len() != modes {
            return Err(Error::Length {
                what,
                found: rows.len(),
                expected: modes,
            });
        }
        for row in &rows {
            check_length(what, row, modes)?;
            check_finite(what, row)?;
        }
        let couples = rows.iter().flatten().any(|factor| *factor != 0.0);
        Ok(couples.then_some(Self { rows }))
    }

    /// Number of its rows.
    pub fn modes(&self) -> usize {
        self.rows.len()
    }

    /// A bound of what it makes of any vector, over the length of that: Frobenius' norm.
    pub(crate) fn size(&self) -> f64 {
        let squares = self.rows.iter().flatten().map(|factor| factor * factor);
        squares.sum::<f64>().sqrt()
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
            circulatory: None,
            rotations: Vec::new(),
        })
    }

    /// The same with velocities coupled by a matrix, one row a mode.
    ///
    /// # Errors
    /// When it is not square of the system's size or a number is not finite.
    pub fn with_coupling(mut self, rows: Vec<Vec<f64>>) -> Result<Self> {
        self.coupling = Coupling::new("the velocity coupling", rows, self.modes())?;
        Ok(self)
    }

    /// The same with a matrix beside the stiffness, one row a mode: circulatory
    /// forces, such as those of a bearing's cross stiffness.
    ///
    /// # Errors
    /// When it is not square of the system's size or a number is not finite.
    pub fn with_circulatory(mut self, rows: Vec<Vec<f64>>) -> Result<Self> {
        self.circulatory = Coupling::new("the circulatory matrix", rows, self.modes())?;
        Ok(self)
    }

    /// The same with one more shaft whose speed changes.
    ///
    /// # Errors
    /// When it is of other modes.
    pub fn with_rotation(mut self, rotation: Rotation) -> Result<Self> {
        if rotation.modes() != self.modes() {
            return Err(Error::Length {
                what: "a shaft's modes",
                found: rotation.modes(),
                expected: self.modes(),
            });
        }
        self.rotations.push(rotation);
        Ok(self)
    }

    /// Shafts whose speed changes.
    pub fn rotations(&self) -> &[Rotation] {
        &self.rotations
    }

    /// What couples the modal velocities, if anything does.
    pub fn coupling(&self) -> Option<&Coupling> {
        self.coupling.as_ref()
    }

    /// What couples the modal displacements, if anything does.
    pub fn circulatory(&self) -> Option<&Coupling> {
        self.circulatory.as_ref()
    }

    /// Whether anything couples the modes beside the laws.
    pub fn is_coupled(&self) -> bool {
        self.coupling.is_some() || self.circulatory.is_some()
    }

    /// Whether a matrix couples a mode.
    pub fn couples(&self, mode: usize) -> bool {
        let involves =
            |matrix: &Option<Coupling>| matrix.as_ref().is_some_and(|m| m.involves(mode));
        involves(&self.coupling) || involves(&self.circulatory)
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
