//! What the structure does to a step: its resistance, and the inverse that a step solves with.

use super::laws::{Laws, rows};
use crate::error::{Error, Result};
use crate::law::Law;
use crate::problem::Problem;
use crate::system::ModalSystem;
use faer::Mat;

/// What carries the laws, for schemes that solve with one matrix in every step.
pub(crate) trait Structure<L: Law> {
    /// How many numbers a displacement has.
    fn size(&self) -> usize;

    /// The forces of the loads at a time.
    fn load(&self, time: f64, to: &mut [f64]);

    /// Takes `C v + K q` off forces.
    fn resist(&self, q: &[f64], v: &[f64], to: &mut [f64]);

    /// Takes `factor M a` off forces.
    fn resist_inertia(&self, factor: f64, a: &[f64], to: &mut [f64]);

    /// Solves with the matrix of the step.
    ///
    /// # Errors
    /// [`Error::Memory`]
    fn solve(&mut self, forces: &[f64], to: &mut [f64]) -> Result<()>;

    /// Adds the forces of the laws, times a factor.
    fn add_laws(&mut self, laws: &Laws<'_, L>, factor: f64, to: &mut [f64]);

    /// What the matrix of the step makes of a unit force along each coordinate of the laws, times
    /// a factor.
    ///
    /// # Errors
    /// [`Error::Memory`]
    fn kicks(&mut self, factor: f64) -> Result<Vec<Vec<f64>>>;

    /// The part of a displacement that the laws see.
    fn seen<'b>(&self, whole: &'b [f64], room: &'b mut Vec<f64>) -> &'b [f64];
}

/// Modes, with the inverse of a step.
pub(super) struct Modes<'a, L> {
    problem: &'a Problem<L>,
    inverse: Inverse,
}

impl<'a, L: Law> Modes<'a, L> {
    /// # Errors
    /// [`Error::SingularStep`]
    pub(super) fn new(
        problem: &'a Problem<L>,
        [unit, damping, stiffness]: [f64; 3],
    ) -> Result<Self> {
        let inverse = Inverse::new(&problem.system, unit, damping, stiffness)?;
        Ok(Self { problem, inverse })
    }
}

impl<L: Law> Structure<L> for Modes<'_, L> {
    fn size(&self) -> usize {
        self.problem.system.modes()
    }

    fn load(&self, time: f64, to: &mut [f64]) {
        self.problem.forcing.at(time, to);
    }

    fn resist(&self, q: &[f64], v: &[f64], to: &mut [f64]) {
        resist(&self.problem.system, q, v, to);
    }

    fn resist_inertia(&self, factor: f64, a: &[f64], to: &mut [f64]) {
        for (to, a) in to.iter_mut().zip(a) {
            *to -= factor * a;
        }
    }

    fn solve(&mut self, forces: &[f64], to: &mut [f64]) -> Result<()> {
        self.inverse.apply(forces, to);
        Ok(())
    }

    fn add_laws(&mut self, laws: &Laws<'_, L>, factor: f64, to: &mut [f64]) {
        laws.add_forces(factor, to);
    }

    fn kicks(&mut self, factor: f64) -> Result<Vec<Vec<f64>>> {
        Ok(self.inverse.of_rows(self.problem, factor))
    }

    fn seen<'b>(&self, whole: &'b [f64], _: &'b mut Vec<f64>) -> &'b [f64] {
        whole
    }
}

/// Takes `C v + K q` off modal forces.
pub(super) fn resist(system: &ModalSystem, q: &[f64], v: &[f64], to: &mut [f64]) {
    let own = system.omega2().iter().zip(system.damping());
    for ((to, (w2, c)), (q, v)) in to.iter_mut().zip(own).zip(q.iter().zip(v)) {
        *to -= w2 * q + c * v;
    }
    for (matrix, motion) in [(system.coupling(), v), (system.circulatory(), q)] {
        if let Some(matrix) = matrix {
            for (mode, to) in to.iter_mut().enumerate() {
                *to -= matrix.product(mode, motion);
            }
        }
    }
}

/// The inverse of `unit + damping C + stiffness K`: a number a mode where nothing couples them.
#[derive(Debug)]
pub(super) enum Inverse {
    Diagonal(Vec<f64>),
    /// By rows.
    Full(Vec<f64>),
}

impl Inverse {
    /// # Errors
    /// [`Error::SingularStep`] where there is none.
    pub(super) fn new(
        system: &ModalSystem,
        unit: f64,
        damping: f64,
        stiffness: f64,
    ) -> Result<Self> {
        let own = system.omega2().iter().zip(system.damping());
        let diagonal = own.map(|(w2, c)| unit + damping * c + stiffness * w2);
        let inverse = if system.is_coupled() {
            let diagonal: Vec<f64> = diagonal.collect();
            let modes = diagonal.len();
            let entry = |i: usize, j: usize| {
                let at =
                    |matrix: Option<&crate::system::Coupling>| matrix.map_or(0.0, |m| m.at(i, j));
                let coupled =
                    damping * at(system.coupling()) + stiffness * at(system.circulatory());
                coupled + if i == j { diagonal[i] } else { 0.0 }
            };
            let lu = Mat::from_fn(modes, modes, entry).partial_piv_lu();
            let inverse = faer::linalg::solvers::DenseSolveCore::inverse(&lu);
            let places = (0..modes).flat_map(|i| (0..modes).map(move |j| (i, j)));
            Self::Full(places.map(|place| inverse[place]).collect())
        } else {
            Self::Diagonal(diagonal.map(f64::recip).collect())
        };
        let (Self::Diagonal(numbers) | Self::Full(numbers)) = &inverse;
        if numbers.iter().all(|x| x.is_finite()) {
            Ok(inverse)
        } else {
            Err(Error::SingularStep)
        }
    }

    /// Multiplies by it.
    pub(super) fn apply(&self, from: &[f64], to: &mut [f64]) {
        match self {
            Self::Diagonal(numbers) => {
                for ((to, x), factor) in to.iter_mut().zip(from).zip(numbers) {
                    *to = factor * x;
                }
            }
            Self::Full(numbers) => {
                for (to, row) in to.iter_mut().zip(numbers.chunks_exact(from.len())) {
                    *to = row.iter().zip(from).map(|(a, x)| a * x).sum();
                }
            }
        }
    }

    /// What it makes of unit forces along the laws' coordinates, times a factor.
    pub(super) fn of_rows<L: Law>(&self, problem: &Problem<L>, factor: f64) -> Vec<Vec<f64>> {
        let made = |row: &[f64]| {
            let mut made = vec![0.0; row.len()];
            self.apply(row, &mut made);
            scaled(&made, factor)
        };
        rows(&problem.laws).map(made).collect()
    }
}

/// A vector times a factor.
pub(super) fn scaled(vector: &[f64], factor: f64) -> Vec<f64> {
    vector.iter().map(|x| factor * x).collect()
}

/// Each of some vectors times a factor.
pub(crate) fn each_scaled(vectors: &[Vec<f64>], factor: f64) -> Vec<Vec<f64>> {
    vectors
        .iter()
        .map(|vector| scaled(vector, factor))
        .collect()
}
