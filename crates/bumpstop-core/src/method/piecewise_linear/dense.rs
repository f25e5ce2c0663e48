//! Spectra by the dense eigenproblem of the state matrix: any damping, any number of laws.

use super::coupled::{Coupled, coupled_modes};
use super::rows::set_entry;
use super::secular::Coupling;
use super::spectrum::{Member, Spectrum};
use crate::error::{Error, Result};
use crate::law::{Law, State};
use crate::number::{Complex, LANES};
use crate::problem::Problem;
use faer::linalg::solvers::Solve;
use faer::{Mat, c64};

/// Couples the modes that laws push together and those that matrices of the structure couple.
pub(crate) fn couple<L: Law>(
    spectrum: &mut Spectrum,
    problem: &Problem<L>,
    states: &[State],
) -> Result<()> {
    let modes = coupled_modes(problem, states);
    let coupled = Coupled::of_modes(problem, states, &modes);
    spectrum.members = (modes.iter().enumerate())
        .map(|(group, &mode)| Member {
            mode,
            group,
            weight: 1.0,
        })
        .collect();
    spectrum.groups = modes.len();
    spectrum.combinations = modes.len();
    let damping = problem.system.damping();
    spectrum.group_damping = modes.iter().map(|&mode| damping[mode]).collect();
    spectrum.at_rest = coupled.rest(&coupled.force)?;
    coupled.solve_into(spectrum)
}

/// Spectrum of one law whose modes are too heavily damped for the secular path.
pub(crate) fn set_coupled(spectrum: &mut Spectrum, coupling: &Coupling) -> Result<()> {
    Coupled::by_one(coupling).solve_into(spectrum)
}

/// What is left of a constant force at rest, relative to it, above which there is no rest.
const UNBALANCED: f64 = 1e-9;

impl Coupled {
    /// The position at rest under constant forces; that of no force where nothing pushes, even if
    /// some motion is free.
    pub(crate) fn rest(&self, forces: &Mat<f64>) -> Result<Vec<f64>> {
        let n = self.stiffness.nrows();
        let size = forces.norm_max();
        if size == 0.0 {
            return Ok(vec![0.0; n]);
        }
        let rest = self.stiffness.full_piv_lu().solve(forces);
        let lack = &self.stiffness * &rest - forces;
        // Written so that a lack which is not a number is one too large.
        let balanced = (0..n).all(|i| lack[(i, 0)].abs() <= UNBALANCED * size);
        if !balanced {
            return Err(Error::NoRest);
        }
        Ok((0..n).map(|i| rest[(i, 0)]).collect())
    }

    /// Eigenvalues, shapes and left vectors. Velocities are scaled by a typical frequency so
    /// that the state matrix is balanced; left vectors are rows of the inverse of the right ones.
    fn solve_into(&self, spectrum: &mut Spectrum) -> Result<()> {
        let n = self.stiffness.nrows();
        let scale = (0..n)
            .map(|i| self.stiffness[(i, i)].abs())
            .fold(0.0f64, f64::max)
            .sqrt()
            .max(f64::MIN_POSITIVE);
        let state = Mat::from_fn(2 * n, 2 * n, |r, c| match (r < n, c < n) {
            (true, false) if r + n == c => scale,
            (true, _) => 0.0,
            (false, true) => -self.stiffness[(r - n, c)] / scale,
            (false, false) => -self.damping[(r - n, c - n)],
        });
        let eigen = state.eigen().map_err(|_| Error::Eigenvalues)?;
        let right = eigen.U();
        let inverse = right
            .partial_piv_lu()
            .solve(Mat::<c64>::identity(2 * n, 2 * n));
        let values = eigen.S().column_vector();
        let kept: Vec<usize> = (0..2 * n).filter(|&j| values[j].im >= 0.0).collect();
        spectrum.make_room(kept.len().div_ceil(LANES));
        for (column, &j) in kept.iter().enumerate() {
            let value = values[j];
            let factor = if value.im > 0.0 { 2.0 } else { 1.0 };
            set_entry(&mut spectrum.lambda, column, complex(value));
            for i in 0..n {
                let left = |c: usize| complex(inverse[(j, c)]).scale(factor);
                set_entry(spectrum.shape_mut(i), column, complex(right[(i, j)]));
                set_entry(spectrum.left_position_mut(i), column, left(i));
                let velocity = left(i + n).scale(1.0 / scale);
                set_entry(spectrum.left_velocity_mut(i), column, velocity);
            }
        }
        Ok(())
    }
}

fn complex(z: c64) -> Complex<f64> {
    Complex::new(z.re, z.im)
}
