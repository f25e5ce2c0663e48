//! Accelerations and reactions at one instant, from the equation of motion.

use crate::law::{Law, State};
use crate::problem::Problem;
use crate::rigid::Directions;

/// The motion at one instant, with the states of the laws.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Moment<'a> {
    pub time: f64,
    pub displacement: &'a [f64],
    pub velocity: &'a [f64],
    pub states: &'a [State],
}

impl Moment<'_> {
    /// Modal accelerations without the reactions of what is held.
    pub(crate) fn free_acceleration<L: Law>(&self, problem: &Problem<L>) -> Vec<f64> {
        let (q, v) = (self.displacement, self.velocity);
        let mut forces = vec![0.0; q.len()];
        problem.forcing.at(self.time, &mut forces);
        for (index, (law, state)) in problem.laws.iter().zip(self.states).enumerate() {
            let [position, rate] = problem.local(index, self.time, q, v);
            let force = law.force(*state, &position, &rate);
            for (row, f) in law.rows().iter().zip(force) {
                for (total, r) in forces.iter_mut().zip(row) {
                    *total += r * f;
                }
            }
        }
        let system = &problem.system;
        let inner = (system.omega2().iter().zip(q)).zip(system.damping().iter().zip(v));
        for (force, ((w2, q), (c, v))) in forces.iter_mut().zip(inner) {
            *force -= w2 * q + c * v;
        }
        for (matrix, motion) in [(system.coupling(), v), (system.circulatory(), q)] {
            if let Some(matrix) = matrix {
                for (mode, force) in forces.iter_mut().enumerate() {
                    *force -= matrix.product(mode, motion);
                }
            }
        }
        for rotation in system.rotations() {
            let turning = rotation.around(self.time);
            for (force, parts) in forces.iter_mut().zip(turning.forces(self.time, [q, v])) {
                *force += parts.sum();
            }
        }
        forces
    }

    /// Modal accelerations.
    pub(crate) fn acceleration<L: Law>(&self, problem: &Problem<L>) -> Vec<f64> {
        let mut acceleration = self.free_acceleration(problem);
        let held = Directions::held(problem, self.states);
        let reactions = held.reactions(&acceleration);
        held.add(&reactions, &mut acceleration);
        acceleration
    }

    /// The reaction of a law that holds its coordinate, in N; `None` for one that does not.
    pub(crate) fn reaction<L: Law>(&self, problem: &Problem<L>, law: usize) -> Option<f64> {
        problem.laws[law].constraint(self.states[law])?;
        let held = Directions::held(problem, self.states);
        let reactions = held.reactions(&self.free_acceleration(problem));
        let place = held.laws.iter().position(|held| *held == law)?;
        Some(reactions[place])
    }
}
