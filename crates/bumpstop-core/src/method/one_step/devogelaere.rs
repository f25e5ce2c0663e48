//! The method of de Vogelaere and Fu. Fourth order, explicit but for damping.
//!
//! With accelerations a at the start, a- in the middle of the step before, a+ in the middle and a1
//! at the end:
//! `q+ = q + h v / 2 + h^2 (4 a - a-) / 24`, `q1 = q + h v + h^2 (a + 2 a+) / 6`,
//! `v1 = v + h (a + 4 a+ + a1) / 6`. De Vogelaere's formulas are for forces that velocities do not
//! enter; where they do, the velocity in the middle is Adams and Moulton's of the same points,
//! `v+ = v + h (5 a+ + 8 a - a-) / 24`, and damping is solved for at both.
//!
//! A mode is stable while `3 omega^2 h^2 + 4 c h < 24`: without damping up to `h omega = 2 sqrt(2)`,
//! where a root of the scheme passes -1. Two evaluations of the laws a step. Where a force has a
//! kink or a jump the order is that of any scheme that steps over it.
//!
//! Source: R. de Vogelaere, A method for the numerical integration of differential equations of
//! second order without explicit first derivatives, Journal of Research of the National Bureau of
//! Standards 54, 119-125, 1955.

use super::laws::{Laws, Pushes};
use super::structure::{Inverse, each_scaled, resist};
use super::{Motion, Scheme};
use crate::error::Result;
use crate::law::Law;
use crate::method::fixed_step::{highest_frequency, laws_damping};
use crate::problem::Problem;
use crate::system::ModalSystem;

/// The method's name.
pub const NAME: &str = "devogelaere";

/// Parts of the step by which the acceleration at an end enters the velocity there: at the middle
/// and at the end.
const OWN: [f64; 2] = [5.0 / 24.0, 1.0 / 6.0];

/// Largest stable step, in s, with the laws in their stiffest states.
pub(super) fn stability_limit<L: Law>(system: &ModalSystem, laws: &[L]) -> f64 {
    let modal = system
        .damping()
        .iter()
        .fold(0.0, |most, c| f64::max(most, *c));
    let damping = modal + laws_damping(laws);
    let omega = highest_frequency(system, laws);
    12.0 / (damping + (damping * damping + 18.0 * omega * omega).sqrt())
}

/// The scheme for one problem and step.
pub(super) struct DeVogelaere<'a, L> {
    problem: &'a Problem<L>,
    h: f64,
    stages: [Stage; 2],
    /// Accelerations in the middle of the step before, once there is one.
    past: Option<Vec<f64>>,
    start: [Vec<f64>; 3],
    forces: Vec<f64>,
}

/// The equations at the middle or at the end of a step.
struct Stage {
    inverse: Inverse,
    /// Modal accelerations that unit forces of the laws give.
    kicks: Vec<Vec<f64>>,
    pushes: Pushes,
    own: f64,
}

impl Stage {
    fn new<L: Law>(problem: &Problem<L>, own: f64) -> Result<Self> {
        let inverse = Inverse::new(&problem.system, 1.0, own, 0.0)?;
        let kicks = inverse.of_rows(problem, 1.0);
        let (still, velocity) = (each_scaled(&kicks, 0.0), each_scaled(&kicks, own));
        Ok(Self {
            inverse,
            pushes: Pushes::new(&problem.laws, &still, &velocity),
            kicks,
            own,
        })
    }

    /// Adds to the velocities what the accelerations give that balance the forces, and returns
    /// these in `motion`.
    fn solve<L: Law>(
        &self,
        problem: &Problem<L>,
        time: f64,
        forces: &mut [f64],
        motion: &mut Motion,
        laws: &mut Laws<'_, L>,
    ) -> Result<()> {
        let Motion { q, v, a } = motion;
        problem.forcing.at(time, forces);
        resist(&problem.system, q, v, forces);
        self.inverse.apply(forces, a);
        for (v, a) in v.iter_mut().zip(&*a) {
            *v += self.own * a;
        }
        laws.meet(&self.pushes, time, q, v)?;
        laws.push(&self.kicks, self.own, v);
        laws.push(&self.kicks, 1.0, a);
        Ok(())
    }
}

impl<'a, L: Law> DeVogelaere<'a, L> {
    pub(super) fn new(problem: &'a Problem<L>, h: f64) -> Result<Self> {
        let zeros = || vec![0.0; problem.system.modes()];
        Ok(Self {
            problem,
            h,
            stages: [
                Stage::new(problem, OWN[0] * h)?,
                Stage::new(problem, OWN[1] * h)?,
            ],
            past: None,
            start: [zeros(), zeros(), zeros()],
            forces: zeros(),
        })
    }

    /// Goes to the middle of the step, from the accelerations of the middle before.
    fn half(
        &mut self,
        time: f64,
        past: &[f64],
        motion: &mut Motion,
        laws: &mut Laws<'_, L>,
    ) -> Result<()> {
        let h = self.h;
        let [q, v, a] = &self.start;
        for i in 0..q.len() {
            motion.q[i] = q[i] + 0.5 * h * v[i] + h * h / 24.0 * (4.0 * a[i] - past[i]);
            motion.v[i] = v[i] + h / 24.0 * (8.0 * a[i] - past[i]);
        }
        self.stages[0].solve(self.problem, time, &mut self.forces, motion, laws)
    }

    /// The accelerations half a step before the start: those half a step after it, mirrored.
    fn before(&mut self, time: f64, motion: &mut Motion, laws: &Laws<'_, L>) -> Result<Vec<f64>> {
        let start = self.start[2].clone();
        self.half(time, &start, motion, &mut laws.clone())?;
        let mirrored = start
            .iter()
            .zip(&motion.a)
            .map(|(a, after)| 2.0 * a - after);
        Ok(mirrored.collect())
    }
}

impl<L: Law> Scheme<L> for DeVogelaere<'_, L> {
    fn step(
        &mut self,
        [start, end]: [f64; 2],
        motion: &mut Motion,
        laws: &mut Laws<'_, L>,
    ) -> Result<()> {
        let (h, middle) = (self.h, 0.5 * (start + end));
        let now = [&motion.q, &motion.v, &motion.a];
        for (to, from) in self.start.iter_mut().zip(now) {
            to.copy_from_slice(from);
        }
        let mut past = match self.past.take() {
            Some(past) => past,
            None => self.before(middle, motion, laws)?,
        };
        self.half(middle, &past, motion, laws)?;
        past.copy_from_slice(&motion.a);
        let [q, v, a] = &self.start;
        for i in 0..q.len() {
            motion.q[i] = q[i] + h * v[i] + h * h / 6.0 * (a[i] + 2.0 * past[i]);
            motion.v[i] = v[i] + h / 6.0 * (a[i] + 4.0 * past[i]);
        }
        self.past = Some(past);
        self.stages[1].solve(self.problem, end, &mut self.forces, motion, laws)
    }
}
