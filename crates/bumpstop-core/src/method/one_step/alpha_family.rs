//! Newmark's formulas with equilibrium at a weighted mean of both ends of the step.
//!
//! `q1 = q + h v + h^2 ((1/2 - beta) a + beta a1)` and `v1 = v + h ((1 - gamma) a + gamma a1)`, with
//! `(1 - alpha_m) a1 + alpha_m a = (1 - alpha_f) r1 + alpha_f r`: r are the forces of structure and
//! laws at both ends, and loads are those of the instant between. The schemes of the family are
//! told apart by these four numbers.

use super::laws::{Laws, Pushes};
use super::structure::{Structure, each_scaled};
use super::{Motion, Scheme};
use crate::error::Result;
use crate::law::Law;

/// What makes a scheme of the family.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Weights {
    /// Part of the start in the inertia.
    pub alpha_m: f64,
    /// Part of the start in all forces.
    pub alpha_f: f64,
    pub beta: f64,
    pub gamma: f64,
}

impl Weights {
    /// What mass, damping and stiffness are multiplied by in the matrix of a step.
    pub(crate) fn matrix(self, h: f64) -> [f64; 3] {
        let after = 1.0 - self.alpha_f;
        [
            1.0 - self.alpha_m,
            after * self.gamma * h,
            after * self.beta * h * h,
        ]
    }
}

/// A scheme of the family, for one structure and step.
pub(crate) struct AlphaFamily<S> {
    structure: S,
    weights: Weights,
    h: f64,
    /// Accelerations that unit forces of the laws give.
    kicks: Vec<Vec<f64>>,
    pushes: Pushes,
    /// The mean of both ends, then the end without the laws' forces there.
    mean: [Vec<f64>; 2],
    forces: Vec<f64>,
    /// What the laws see of the end.
    seen: [Vec<f64>; 2],
}

impl<S> AlphaFamily<S> {
    /// The scheme, with a structure whose matrix is that of [`Weights::matrix`].
    ///
    /// # Errors
    /// [`crate::error::Error::Memory`]
    pub(crate) fn new<L: Law>(
        mut structure: S,
        laws: &[L],
        weights: Weights,
        h: f64,
    ) -> Result<Self>
    where
        S: Structure<L>,
    {
        let kicks = structure.kicks(1.0 - weights.alpha_f)?;
        let [gain_q, gain_v] = gains(weights, h);
        let mut room = Vec::new();
        let seen: Vec<Vec<f64>> = (kicks.iter())
            .map(|kick| structure.seen(kick, &mut room).to_vec())
            .collect();
        let pushes = Pushes::new(
            laws,
            &each_scaled(&seen, gain_q),
            &each_scaled(&seen, gain_v),
        );
        let zeros = || vec![0.0; structure.size()];
        Ok(Self {
            weights,
            h,
            pushes,
            kicks,
            mean: [zeros(), zeros()],
            forces: zeros(),
            seen: [Vec::new(), Vec::new()],
            structure,
        })
    }
}

/// What the accelerations at the end add to the motion.
fn gains(Weights { beta, gamma, .. }: Weights, h: f64) -> [f64; 2] {
    [beta * h * h, gamma * h]
}

impl<L: Law, S: Structure<L>> Scheme<L> for AlphaFamily<S> {
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
        let [gain_q, gain_v] = gains(self.weights, h);
        let structure = &mut self.structure;
        structure.load(alpha_f * start + after * end, &mut self.forces);
        structure.add_laws(laws, alpha_f, &mut self.forces);
        let Motion { q, v, a } = motion;
        structure.resist_inertia(alpha_m, a, &mut self.forces);
        let [mean_q, mean_v] = &mut self.mean;
        for i in 0..q.len() {
            let [q0, v0] = [q[i], v[i]];
            q[i] += h * v[i] + h * h * (0.5 - beta) * a[i];
            v[i] += h * (1.0 - gamma) * a[i];
            mean_q[i] = after * q[i] + alpha_f * q0;
            mean_v[i] = after * v[i] + alpha_f * v0;
        }
        structure.resist(mean_q, mean_v, &mut self.forces);
        structure.solve(&self.forces, a)?;
        let [free_q, free_v] = &mut self.mean;
        for i in 0..q.len() {
            free_q[i] = q[i] + gain_q * a[i];
            free_v[i] = v[i] + gain_v * a[i];
        }
        let [seen_q, seen_v] = &mut self.seen;
        let seen = [
            structure.seen(free_q, seen_q),
            structure.seen(free_v, seen_v),
        ];
        laws.meet(&self.pushes, end, seen[0], seen[1])?;
        laws.push(&self.kicks, 1.0, a);
        for i in 0..q.len() {
            q[i] += gain_q * a[i];
            v[i] += gain_v * a[i];
        }
        Ok(())
    }
}
