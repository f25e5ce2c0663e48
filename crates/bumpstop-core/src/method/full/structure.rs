//! The full model as what carries the laws: sparse products, and one factor for all steps.

use super::FullProblem;
use super::system::add_product;
use crate::error::{Error, Result};
use crate::law::Law;
use crate::method::one_step::{Laws, Structure, rows};
use crate::modes::factor::{Factor, Scratch};

/// A structure with the factor of a step's matrix.
pub(super) struct Body<'a, L> {
    problem: &'a FullProblem<L>,
    factor: Factor,
    scratch: Scratch,
    /// Forces of the laws on the kept dofs.
    kept: Vec<f64>,
}

impl<'a, L: Law> Body<'a, L> {
    /// With the matrix `mass M + damping C + stiffness K`.
    ///
    /// # Errors
    /// [`Error::SingularStep`], [`Error::Memory`], [`Error::Factorisation`].
    pub(super) fn new(problem: &'a FullProblem<L>, factors: [f64; 3]) -> Result<Self> {
        let factor = Factor::of(&problem.system.sum(factors)?)?;
        if factor.singularity().is_some() {
            return Err(Error::SingularStep);
        }
        Ok(Self {
            problem,
            scratch: factor.scratch()?,
            factor,
            kept: vec![0.0; problem.kept.len()],
        })
    }
}

impl<L: Law> Structure<L> for Body<'_, L> {
    fn size(&self) -> usize {
        self.problem.system.dofs()
    }

    fn load(&self, time: f64, to: &mut [f64]) {
        self.problem.forcing.at(time, to);
    }

    fn resist(&self, q: &[f64], v: &[f64], to: &mut [f64]) {
        let system = &self.problem.system;
        add_product(&system.stiffness, -1.0, q, to);
        if let Some(damping) = &system.damping {
            add_product(damping, -1.0, v, to);
        }
    }

    fn resist_inertia(&self, factor: f64, a: &[f64], to: &mut [f64]) {
        if factor != 0.0 {
            add_product(&self.problem.system.mass, -factor, a, to);
        }
    }

    fn solve(&mut self, forces: &[f64], to: &mut [f64]) -> Result<()> {
        to.copy_from_slice(forces);
        self.factor.solve_one(to, &mut self.scratch);
        Ok(())
    }

    fn add_laws(&mut self, laws: &Laws<'_, L>, factor: f64, to: &mut [f64]) {
        if factor == 0.0 {
            return;
        }
        self.kept.fill(0.0);
        laws.add_forces(factor, &mut self.kept);
        add_at(&self.problem.kept, &self.kept, to);
    }

    fn kicks(&mut self, factor: f64) -> Result<Vec<Vec<f64>>> {
        let mut kicks = Vec::new();
        for row in rows(&self.problem.seen.laws) {
            let mut kick = whole(self.problem, row);
            self.factor.solve_one(&mut kick, &mut self.scratch);
            for x in &mut kick {
                *x *= factor;
            }
            kicks.push(kick);
        }
        Ok(kicks)
    }

    fn seen<'b>(&self, whole: &'b [f64], room: &'b mut Vec<f64>) -> &'b [f64] {
        part(&self.problem.kept, whole, room)
    }
}

/// What is kept of all dofs.
pub(super) fn part<'b>(kept: &[usize], whole: &[f64], room: &'b mut Vec<f64>) -> &'b [f64] {
    room.clear();
    room.extend(kept.iter().map(|dof| whole[*dof]));
    room
}

/// A vector on the kept dofs as one on all.
pub(super) fn whole<L: Law>(problem: &FullProblem<L>, part: &[f64]) -> Vec<f64> {
    let mut whole = vec![0.0; problem.system.dofs()];
    add_at(&problem.kept, part, &mut whole);
    whole
}

fn add_at(kept: &[usize], part: &[f64], to: &mut [f64]) {
    for (dof, x) in kept.iter().zip(part) {
        to[*dof] += x;
    }
}

/// The acceleration that loads, laws and structure give at t = 0.
///
/// # Errors
/// [`Error::SingularMass`], [`Error::Memory`].
pub(super) fn initial_acceleration<L: Law>(
    problem: &FullProblem<L>,
    laws: &Laws<'_, L>,
) -> Result<Vec<f64>> {
    let mut body = Body::new(problem, [1.0, 0.0, 0.0]).map_err(|error| match error {
        Error::SingularStep => Error::SingularMass,
        other => other,
    })?;
    let mut forces = vec![0.0; problem.system.dofs()];
    body.load(0.0, &mut forces);
    body.add_laws(laws, 1.0, &mut forces);
    body.resist(&problem.displacement, &problem.velocity, &mut forces);
    let mut acceleration = vec![0.0; forces.len()];
    body.solve(&forces, &mut acceleration)?;
    Ok(acceleration)
}
