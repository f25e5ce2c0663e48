//! TR-BDF2: the trapezoidal rule up to `gamma h`, then the backward formula of second order over
//! both parts, `gamma = 2 - sqrt(2)`. Second order, L-stable: any step is stable, and modes far above
//! it are removed.
//!
//! Both stages solve with one matrix, `y = y* + d h y'` with `d = gamma / 2`: of the equations of
//! motion, `v = v* + d h (p - C v - K q + forces)` and `q = q* + d h v`.
//!
//! Source: R. E. Bank et al., Transient simulation of silicon devices and circuits, IEEE
//! Transactions on Electron Devices 32, 1992-2007, 1985; gamma and d of M. E. Hosea, L. F. Shampine,
//! Analysis and implementation of TR-BDF2, Applied Numerical Mathematics 20, 21-37, 1996.

use super::laws::{Laws, Pushes};
use super::structure::{Inverse, each_scaled, resist};
use super::{Motion, Scheme};
use crate::error::Result;
use crate::law::Law;
use crate::problem::Problem;
use std::f64::consts::SQRT_2;

/// The method's name.
pub const NAME: &str = "trbdf2";

/// The part of the step that the first stage goes.
const GAMMA: f64 = 2.0 - SQRT_2;

/// Weights of the middle and of the start in the second stage.
const MIDDLE: f64 = 1.0 / (GAMMA * (2.0 - GAMMA));
const START: f64 = -(1.0 - GAMMA) * (1.0 - GAMMA) / (GAMMA * (2.0 - GAMMA));

/// The scheme for one problem and step.
pub(super) struct TrBdf2<'a, L> {
    problem: &'a Problem<L>,
    h: f64,
    inverse: Inverse,
    /// Modal velocities that unit forces of the laws give in a stage.
    kicks: Vec<Vec<f64>>,
    pushes: Pushes,
    /// The start, and what both stages start from.
    start: [Vec<f64>; 2],
    from: [Vec<f64>; 2],
    forces: Vec<f64>,
}

impl<'a, L: Law> TrBdf2<'a, L> {
    pub(super) fn new(problem: &'a Problem<L>, h: f64) -> Result<Self> {
        let part = 0.5 * GAMMA * h;
        let inverse = Inverse::new(&problem.system, 1.0, part, part * part)?;
        let kicks = inverse.of_rows(problem, part);
        let displacement = each_scaled(&kicks, part);
        let zeros = || vec![0.0; problem.system.modes()];
        Ok(Self {
            problem,
            h,
            inverse,
            pushes: Pushes::new(&problem.laws, &displacement, &kicks),
            kicks,
            start: [zeros(), zeros()],
            from: [zeros(), zeros()],
            forces: zeros(),
        })
    }

    /// Solves a stage that ends at a time.
    fn stage(&mut self, time: f64, motion: &mut Motion, laws: &mut Laws<'_, L>) -> Result<()> {
        let part = 0.5 * GAMMA * self.h;
        let [from_q, from_v] = &self.from;
        let Motion { q, v, a } = motion;
        self.problem.forcing.at(time, &mut self.forces);
        // Without velocities: they are what is solved for.
        v.fill(0.0);
        resist(&self.problem.system, from_q, v, &mut self.forces);
        for (force, from) in self.forces.iter_mut().zip(from_v) {
            *force = from + part * *force;
        }
        self.inverse.apply(&self.forces, v);
        for i in 0..q.len() {
            q[i] = from_q[i] + part * v[i];
        }
        laws.meet(&self.pushes, time, q, v)?;
        laws.push(&self.kicks, 1.0, v);
        for i in 0..q.len() {
            q[i] = from_q[i] + part * v[i];
            a[i] = (v[i] - from_v[i]) / part;
        }
        Ok(())
    }
}

impl<L: Law> Scheme<L> for TrBdf2<'_, L> {
    fn step(
        &mut self,
        [start, end]: [f64; 2],
        motion: &mut Motion,
        laws: &mut Laws<'_, L>,
    ) -> Result<()> {
        let part = 0.5 * GAMMA * self.h;
        for i in 0..motion.q.len() {
            let [q, v, a] = [motion.q[i], motion.v[i], motion.a[i]];
            (self.start[0][i], self.start[1][i]) = (q, v);
            (self.from[0][i], self.from[1][i]) = (q + part * v, v + part * a);
        }
        self.stage(start + GAMMA * self.h, motion, laws)?;
        for i in 0..motion.q.len() {
            self.from[0][i] = MIDDLE * motion.q[i] + START * self.start[0][i];
            self.from[1][i] = MIDDLE * motion.v[i] + START * self.start[1][i];
        }
        self.stage(end, motion, laws)
    }
}
