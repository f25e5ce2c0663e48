//! Newmark's formulas with equilibrium at a weighted mean of both ends of the step.
//!
//! `q1 = q + h v + h^2 ((1/2 - beta) a + beta a1)` and `v1 = v + h ((1 - gamma) a + gamma a1)`, with
//! `(1 - alpha_m) a1 + alpha_m a = (1 - alpha_f) r1 + alpha_f r`: r are the forces of structure and
//! laws at both ends, and loads are those of the instant between. The schemes of the family are
//! told apart by these four numbers.

use super::laws::{Laws, Pushes};
use super::structure::{Inverse, each_scaled, resist};
use super::{Motion, Scheme};
use crate::error::Result;
use crate::law::Law;
use crate::problem::Problem;

/// What makes a scheme of the family.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Weights {
    /// Part of the start in the inertia.
    pub alpha_m: f64,
    /// Part of the start in all forces.
    pub alpha_f: f64,
    pub beta: f64,
    pub gamma: f64,
}

/// A scheme of the family, for one problem and step.
pub(super) struct AlphaFamily<'a, L> {
    problem: &'a Problem<L>,
    weights: Weights,
    h: f64,
    inverse: Inverse,
    /// Modal accelerations that unit forces of the laws give.
    kicks: Vec<Vec<f64>>,
    pushes: Pushes,
    /// The mean of both ends, then the end without the laws' forces there.
    mean: [Vec<f64>; 2],
    forces: Vec<f64>,
}

impl<'a, L: Law> AlphaFamily<'a, L> {
    pub(super) fn new(problem: &'a Problem<L>, weights: Weights, h: f64) -> Result<Self> {
        let Weights {
            alpha_m,
            alpha_f,
            beta,
            gamma,
        } = weights;
        let after = 1.0 - alpha_f;
        let system = &problem.system;
        let (damping, stiffness) = (after * gamma * h, after * beta * h * h);
        let inverse = Inverse::new(system, 1.0 - alpha_m, damping, stiffness)?;
        let kicks = inverse.of_rows(problem, after);
        let displacement = each_scaled(&kicks, beta * h * h);
        let velocity = each_scaled(&kicks, gamma * h);
        let zeros = || vec![0.0; system.modes()];
        Ok(Self {
            problem,
            weights,
            h,
            inverse,
            pushes: Pushes::new(&problem.laws, &displacement, &velocity),
            kicks,
            mean: [zeros(), zeros()],
            forces: zeros(),
        })
    }

    /// What the accelerations at the end add to the motion.
    fn gains(&self) -> [f64; 2] {
        let Weights { beta, gamma, .. } = self.weights;
        [beta * self.h * self.h, gamma * self.h]
    }
}

impl<L: Law> Scheme<L> for AlphaFamily<'_, L> {
    fn step(
        &mut self,
        [start, end]: [f64; 2],
        motion: &mut Motion,
        laws: &mut Laws<'_, L>,
    ) -> Result<()> {
        let Weights {
            alpha_m,
            alpha_f,
            beta,
            gamma,
        } = self.weights;
        let (h, after) = (self.h, 1.0 - alpha_f);
        let between = alpha_f * start + after * end;
        self.problem.forcing.at(between, &mut self.forces);
        laws.add_forces(alpha_f, &mut self.forces);
        let [gain_q, gain_v] = self.gains();
        let Motion { q, v, a } = motion;
        let [mean_q, mean_v] = &mut self.mean;
        for i in 0..q.len() {
            let [q0, v0] = [q[i], v[i]];
            q[i] += h * v[i] + h * h * (0.5 - beta) * a[i];
            v[i] += h * (1.0 - gamma) * a[i];
            mean_q[i] = after * q[i] + alpha_f * q0;
            mean_v[i] = after * v[i] + alpha_f * v0;
            self.forces[i] -= alpha_m * a[i];
        }
        resist(&self.problem.system, mean_q, mean_v, &mut self.forces);
        self.inverse.apply(&self.forces, a);
        let [free_q, free_v] = &mut self.mean;
        for i in 0..q.len() {
            free_q[i] = q[i] + gain_q * a[i];
            free_v[i] = v[i] + gain_v * a[i];
        }
        laws.meet(&self.pushes, end, free_q, free_v)?;
        laws.push(&self.kicks, 1.0, a);
        for i in 0..q.len() {
            q[i] += gain_q * a[i];
            v[i] += gain_v * a[i];
        }
        Ok(())
    }
}
