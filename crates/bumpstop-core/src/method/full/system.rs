//! Mass, damping and stiffness on the dofs of a structure.

use crate::error::{Error, Result};
use crate::modes::pencil::check_symmetric;
use crate::sparse::SparseMatrix;

/// `M x'' + C x' + K x = forces`, all three symmetric.
#[derive(Debug, Clone)]
pub struct FullSystem {
    pub(super) mass: SparseMatrix,
    /// `None` where nothing damps.
    pub(super) damping: Option<SparseMatrix>,
    pub(super) stiffness: SparseMatrix,
}

impl FullSystem {
    /// Takes the matrices; in kg, N s/m and N/m for displacements.
    ///
    /// # Errors
    /// [`Error::Sizes`], [`Error::NotSymmetric`].
    pub fn new(mass: SparseMatrix, damping: SparseMatrix, stiffness: SparseMatrix) -> Result<Self> {
        let all = [
            ("the mass matrix", &mass),
            ("the damping matrix", &damping),
            ("the stiffness matrix", &stiffness),
        ];
        for (what, matrix) in all {
            if matrix.height != mass.height || matrix.width() != mass.height {
                return Err(Error::Sizes {
                    what: "mass, damping and stiffness",
                });
            }
            check_symmetric(what, matrix)?;
        }
        let damped = damping.values.iter().any(|c| *c != 0.0);
        Ok(Self {
            mass,
            damping: damped.then_some(damping),
            stiffness,
        })
    }

    /// Number of dofs.
    pub fn dofs(&self) -> usize {
        self.mass.height
    }

    /// The masses, where no two dofs share one.
    pub(super) fn lumped(&self) -> Result<Vec<f64>> {
        let mut masses = vec![0.0; self.dofs()];
        for (column, mass) in masses.iter_mut().enumerate() {
            for (row, value) in self.mass.column(column).filter(|(_, value)| *value != 0.0) {
                if row != column {
                    return Err(Error::CoupledMasses);
                }
                *mass = value;
            }
            if *mass <= 0.0 {
                return Err(Error::SingularMass);
            }
        }
        Ok(masses)
    }

    /// `mass M + damping C + stiffness K`.
    pub(super) fn sum(&self, [mass, damping, stiffness]: [f64; 3]) -> Result<SparseMatrix> {
        let parts = [
            (mass, Some(&self.mass)),
            (damping, self.damping.as_ref()),
            (stiffness, Some(&self.stiffness)),
        ];
        let (mut rows, mut columns, mut values) = (Vec::new(), Vec::new(), Vec::new());
        for (factor, matrix) in parts {
            let Some(matrix) = matrix else { continue };
            for column in 0..matrix.width() {
                for (row, value) in matrix.column(column) {
                    rows.push(row);
                    columns.push(column);
                    values.push(factor * value);
                }
            }
        }
        SparseMatrix::from_triplets((self.dofs(), self.dofs()), &rows, &columns, &values)
    }
}

/// Adds `factor A x`, A symmetric.
pub(super) fn add_product(matrix: &SparseMatrix, factor: f64, x: &[f64], to: &mut [f64]) {
    for (column, to) in to.iter_mut().enumerate() {
        let row: f64 = (matrix.column(column))
            .map(|(place, value)| value * x[place])
            .sum();
        *to += factor * row;
    }
}

/// `x . y`
pub(super) fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}
