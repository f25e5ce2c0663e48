//! The highest frequency of sparse matrices, from above and certain.
//!
//! Power iteration finds it from below; that nothing lies above a little more than what it found
//! is then told by the inertia of `A - s M`, all of whose pivots must be negative (Sylvester's law).

use super::FullProblem;
use super::system::{add_product, dot};
use crate::error::{Error, Result};
use crate::law::{COORDINATES, Law, Local, Piece};
use crate::modes::factor::Factor;
use crate::modes::pencil::Pencil;
use crate::sparse::SparseMatrix;

/// Power iterations.
const ITERATIONS: usize = 100;

/// How much is put on top of what was found, and again until it is certain.
const MARGIN: f64 = 1.005;

/// How often that is tried.
const TRIALS: i32 = 200;

/// A number above the largest eigenvalue of `A x = s M x`, by half a percent as a rule.
///
/// # Errors
/// [`Error::SingularMass`], [`Error::Uncertain`] and those of the factors.
pub(super) fn eigenvalue(matrix: &SparseMatrix, mass: &SparseMatrix) -> Result<f64> {
    let below = from_below(matrix, mass)?;
    if below <= 0.0 {
        return Ok(0.0);
    }
    let pencil = Pencil::new(matrix, mass)?;
    let mut trial = below;
    for _ in 0..TRIALS {
        trial *= MARGIN;
        if pencil.factored(trial)?.negative == pencil.size() {
            return Ok(trial);
        }
    }
    Err(Error::Uncertain {
        told: pencil.size(),
        low: below,
        high: trial,
    })
}

/// Rayleigh's quotient of the vector that the power method arrives at.
fn from_below(matrix: &SparseMatrix, mass: &SparseMatrix) -> Result<f64> {
    let factor = Factor::of(mass)?;
    if factor.singularity().is_some() {
        return Err(Error::SingularMass);
    }
    let mut scratch = factor.scratch()?;
    let size = mass.height;
    // Parts of the golden ratio: the same in every run, and nearly orthogonal to nothing.
    let mut x: Vec<f64> = (0..size)
        .map(|i| (0.618_033_988_749_895 * (i + 1) as f64).fract() - 0.5)
        .collect();
    let (mut ax, mut mx) = (vec![0.0; size], vec![0.0; size]);
    let mut quotient = 0.0;
    for _ in 0..ITERATIONS {
        ax.fill(0.0);
        mx.fill(0.0);
        add_product(matrix, 1.0, &x, &mut ax);
        add_product(mass, 1.0, &x, &mut mx);
        let length = dot(&x, &mx);
        if length <= 0.0 {
            return Ok(quotient);
        }
        quotient = dot(&x, &ax) / length;
        let scale = length.sqrt().recip();
        for (x, ax) in x.iter_mut().zip(&ax) {
            *x = scale * ax;
        }
        factor.solve_one(&mut x, &mut scratch);
    }
    Ok(quotient)
}

/// That of the structure with all laws in their stiffest states, from above: the largest
/// eigenvalue of a sum is at most the sum of the largest.
///
/// # Errors
/// As [`eigenvalue`].
pub(super) fn with_laws<L: Law>(problem: &FullProblem<L>) -> Result<f64> {
    let own = eigenvalue(&problem.system.stiffness, &problem.system.mass)?;
    Ok(own + of_laws(problem, |piece| &piece.stiffness)?)
}

/// That of the dampers of all laws in their stiffest states over the mass, from above.
///
/// # Errors
/// [`Error::Memory`]
pub(super) fn damping_of_laws<L: Law>(problem: &FullProblem<L>) -> Result<f64> {
    of_laws(problem, |piece| &piece.damping)
}

/// What the laws' own matrices add to an eigenvalue.
fn of_laws<L: Law>(
    problem: &FullProblem<L>,
    matrix: fn(&Piece) -> &[Local<f64>; COORDINATES],
) -> Result<f64> {
    let factor = Factor::of(&problem.system.mass)?;
    let mut scratch = factor.scratch()?;
    let mut total = 0.0;
    for law in &problem.seen.laws {
        let piece = law.stiffest();
        for (coordinate, row) in law.rows().iter().enumerate() {
            let row = super::structure::whole(problem, row);
            let mut moved = row.clone();
            factor.solve_one(&mut moved, &mut scratch);
            total += matrix(&piece)[coordinate][coordinate] * dot(&row, &moved);
        }
    }
    Ok(total)
}
