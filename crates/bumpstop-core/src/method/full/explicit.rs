//! The central difference on dofs with masses of their own. Second order, explicit.
//!
//! `q1 = q + h v + h^2 a / 2`, then `a1` from the forces at the end of the step, and
//! `v1 = v + h (a + a1) / 2`. Damping of a dof alone is solved for, that which couples dofs sees the
//! velocity `v + h a`, which keeps the second order. The forces of laws see `q1` and, where they
//! damp, the `v1` that they make.
//!
//! A step is stable while `h^2 K + 4 h C < 4 M`: at the limit a root of the scheme passes -1. From
//! the largest eigenvalues k and c of K and C over M, `h = 2 / (c + sqrt(c^2 + k))`.
//!
//! The laws' dampers are solved for and ask for no step to be stable; but with `c h > 2`, c over the
//! mass that they move, one would throw back what it is to stop, so that such a step is refused, too.
//!
//! Source: T. Belytschko, W. K. Liu, B. Moran, Nonlinear Finite Elements for Continua and
//! Structures, 2000, section 6.2.

use super::structure::{part, whole};
use super::system::add_product;
use super::{FullProblem, highest};
use crate::error::Result;
use crate::law::Law;
use crate::method::one_step::{Laws, Motion, Pushes, Scheme, each_scaled, rows};

/// Largest stable step, in s, with the laws in their stiffest states.
///
/// # Errors
/// [`crate::error::Error::CoupledMasses`] and those of [`highest`].
pub(super) fn stability_limit<L: Law>(problem: &FullProblem<L>) -> Result<f64> {
    let system = &problem.system;
    system.lumped()?;
    let damping = match &system.damping {
        Some(damping) => highest::eigenvalue(damping, &system.mass)?,
        None => 0.0,
    };
    let stiffness = highest::with_laws(problem)?;
    let stable = 2.0 / (damping + (damping * damping + stiffness).sqrt());
    Ok(stable.min(2.0 / highest::damping_of_laws(problem)?))
}

/// The scheme for one problem and step.
pub(super) struct CentralDifference<'a, L> {
    problem: &'a FullProblem<L>,
    h: f64,
    /// What a force at the end of a step is divided by, upside down.
    inverse: Vec<f64>,
    /// Damping of each dof alone.
    own: Vec<f64>,
    /// Accelerations that unit forces of the laws give.
    kicks: Vec<Vec<f64>>,
    pushes: Pushes,
    /// The velocity that damping which couples sees.
    ahead: Vec<f64>,
    forces: Vec<f64>,
    seen: [Vec<f64>; 2],
}

impl<'a, L: Law> CentralDifference<'a, L> {
    /// # Errors
    /// [`crate::error::Error::CoupledMasses`]
    pub(super) fn new(problem: &'a FullProblem<L>, h: f64) -> Result<Self> {
        let masses = problem.system.lumped()?;
        let mut own = vec![0.0; masses.len()];
        if let Some(damping) = &problem.system.damping {
            for (column, own) in own.iter_mut().enumerate() {
                let diagonal = damping.column(column).find(|(row, _)| *row == column);
                *own = diagonal.map_or(0.0, |(_, value)| value);
            }
        }
        let inverse: Vec<f64> = (masses.iter().zip(&own))
            .map(|(mass, own)| 1.0 / (mass + 0.5 * h * own))
            .collect();
        let kick = |row: &[f64]| -> Vec<f64> {
            let row = whole(problem, row);
            row.iter().zip(&inverse).map(|(x, i)| x * i).collect()
        };
        let laws = &problem.seen.laws;
        let kicks: Vec<Vec<f64>> = rows(laws).map(kick).collect();
        let mut room = Vec::new();
        let seen: Vec<Vec<f64>> = (kicks.iter())
            .map(|kick| part(&problem.kept, kick, &mut room).to_vec())
            .collect();
        Ok(Self {
            problem,
            h,
            pushes: Pushes::new(laws, &each_scaled(&seen, 0.0), &each_scaled(&seen, 0.5 * h)),
            kicks,
            ahead: vec![0.0; inverse.len()],
            forces: vec![0.0; inverse.len()],
            inverse,
            own,
            seen: [Vec::new(), Vec::new()],
        })
    }
}

impl<L: Law> Scheme<L> for CentralDifference<'_, L> {
    fn step(
        &mut self,
        [_, end]: [f64; 2],
        motion: &mut Motion,
        laws: &mut Laws<'_, L>,
    ) -> Result<()> {
        let FullProblem {
            system,
            forcing,
            kept,
            ..
        } = self.problem;
        let (h, half) = (self.h, 0.5 * self.h);
        let Motion { q, v, a } = motion;
        for i in 0..q.len() {
            q[i] += h * (v[i] + half * a[i]);
            self.ahead[i] = v[i] + h * a[i];
            v[i] += half * a[i];
        }
        forcing.at(end, &mut self.forces);
        add_product(&system.stiffness, -1.0, q, &mut self.forces);
        if let Some(damping) = &system.damping {
            add_product(damping, -1.0, &self.ahead, &mut self.forces);
        }
        for i in 0..q.len() {
            // The dof's own damping sees the middle of the step here, and the rest is solved for.
            let own = self.own[i] * (self.ahead[i] - v[i]);
            a[i] = self.inverse[i] * (self.forces[i] + own);
            self.ahead[i] = v[i] + half * a[i];
        }
        let [seen_q, seen_v] = &mut self.seen;
        let seen = [part(kept, q, seen_q), part(kept, &self.ahead, seen_v)];
        laws.meet(&self.pushes, end, seen[0], seen[1])?;
        laws.push(&self.kicks, 1.0, a);
        for (v, a) in v.iter_mut().zip(&*a) {
            *v += half * a;
        }
        Ok(())
    }
}
