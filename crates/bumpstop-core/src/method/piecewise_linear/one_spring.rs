//! Groups that one spring and damper couples: exponents of the secular equation, and vectors made
//! of them.

use super::dense;
use super::grouping::{Acting, group_alike, group_forces, group_modes, static_groups};
use super::rows::Rows;
use super::secular::Coupling;
use super::spectrum::{Secular, Spectrum, Workbench, safe_recip};
use crate::error::Result;
use crate::law::Law;
use crate::number::{Complex, Instructions, LANES, Lanes, Number};
use crate::problem::Problem;

impl Spectrum {
    /// One spring and damper: the secular equation, or the dense problem where it declines.
    #[inline(always)]
    pub(super) fn couple_by_one<I: Instructions, L: Law>(
        &mut self,
        problem: &Problem<L>,
        law: &Acting,
        secular: Secular,
        bench: &mut Workbench,
    ) -> Result<()> {
        let coupling = &mut bench.coupling;
        let modal = problem.forcing.forces();
        self.groups_are_modes = group_modes(problem, law, coupling, &mut self.members);
        if self.groups_are_modes {
            bench.forces.clear();
            bench.forces.extend_from_slice(modal);
        } else {
            group_alike(problem, law, &mut bench.order, coupling, &mut self.members);
            let groups = coupling.omega2.len();
            group_forces(modal, &self.members, groups, &mut bench.forces);
        }
        self.combinations = coupling.omega2.len();
        if self.combinations == 1 {
            self.groups_are_modes = false;
            self.add_lone_combination(problem, law, coupling, bench.forces[0]);
            return Ok(());
        }
        self.groups = self.combinations;
        self.group_damping.extend_from_slice(&coupling.damping);
        self.at_rest.reserve(self.groups);
        let rests = static_groups(coupling, &bench.forces, law.constant, &mut self.at_rest);
        let longest = self.span.longest(problem.duration);
        let reach = longest * longest;
        let is_far = is_far(&self.at_rest, coupling, &bench.forces, law.constant, reach);
        if rests && !is_far && secular == Secular::Try {
            self.is_secular = self.solve_secular::<I>(coupling);
            // Parted phases are for exponents that the secular equation would leave alone.
            if self.span.is_parted && self.slowest_of_groups() * longest < dense::SLOW {
                self.is_secular = false;
            }
        }
        if !self.is_secular {
            dense::set_coupled(self, coupling, &bench.forces, law.constant, longest)?;
        }
        Ok(())
    }

    /// Shapes and left vectors from the roots of the secular equation: with psi_i = phi_i/D_i,
    /// `a = 2 psi'[(lambda + C) y + y'] / (psi' (2 lambda + C) psi)`, C with the stop's damper.
    /// `false` where the secular equation does not apply.
    #[inline(always)]
    fn solve_secular<I: Instructions>(&mut self, coupling: &Coupling) -> bool {
        if !coupling.is_lightly_damped() {
            return false;
        }
        let (exponents, vectors) = self.make_room(self.groups.div_ceil(LANES));
        for (block, to) in exponents.iter_mut().enumerate() {
            let Some(lambda) = coupling.solve_block::<I>(block, vectors) else {
                return false;
            };
            to.put(lambda);
            set_vectors::<I>(coupling, block, lambda, vectors);
        }
        true
    }
}

/// Whether a position at rest lies beyond what the forces can do in a run: the motion, measured
/// from there, would lose its digits.
#[inline(always)]
fn is_far(rest: &[f64], coupling: &Coupling, forces: &[f64], constant: f64, reach: f64) -> bool {
    let (mut farthest, mut largest) = (0.0f64, 0.0f64);
    for (y, (force, phi)) in rest.iter().zip(forces.iter().zip(&coupling.phi)) {
        farthest = farthest.max(y.abs());
        largest = largest.max(force.abs() + (phi * constant).abs());
    }
    farthest > FAR * largest * reach
}

/// A mode of angular frequency w rests at `force/w^2`, here with w times the run's length at a
/// half.
const FAR: f64 = 4.0;

/// Shapes and left vectors at eight roots; the shapes' place holds `1 / D_i`.
#[inline(always)]
fn set_vectors<I: Instructions>(
    coupling: &Coupling,
    block: usize,
    lambda: Complex<Lanes<I>>,
    vectors: &mut Rows,
) {
    let (k, c) = (
        Lanes::<I>::of(coupling.stiffness),
        Lanes::<I>::of(coupling.stop_damping),
    );
    let groups = coupling.omega2.len();
    let two = Lanes::<I>::of(2.0);
    // phi' psi = -1/kappa at a root.
    let kappa = Complex::new(k + c * lambda.re, c * lambda.im);
    let contact = safe_recip(kappa);
    let mut norm = (contact * contact).scale(c);
    let modes = coupling.damping.iter().zip(&coupling.phi);
    for ((damping, phi), row) in modes.zip(vectors.rows_mut(0, groups)) {
        let inverse = row[block].lanes();
        let psi = inverse.scale(Lanes::<I>::of(*phi));
        row[block].put(psi);
        let rate = lambda.scale(two).plus(Lanes::<I>::of(*damping));
        norm = (psi * psi).mul_add(rate, norm);
    }
    let factor = safe_recip(norm).scale(two);
    let push = (contact * factor).scale(c);
    let width = vectors.width();
    let (shapes, left) = vectors.split_rows(groups);
    let (positions, velocities) = left.split_at_mut(left.len() / 2);
    let modes = coupling.damping.iter().zip(&coupling.phi);
    let rows = shapes
        .chunks_exact(width)
        .zip((positions.chunks_exact_mut(width)).zip(velocities.chunks_exact_mut(width)));
    for ((damping, phi), (shape, (position, velocity))) in modes.zip(rows) {
        let psi = shape[block].lanes() * factor;
        let damper = push.scale(Lanes::<I>::of(*phi));
        let with_rate = psi * lambda.plus(Lanes::<I>::of(*damping));
        velocity[block].put(psi);
        position[block].put(with_rate - damper);
    }
}
