//! What a march starts from.

use super::memories::flowed;
use crate::forcing::Forcing;
use crate::law::{Law, Local, LocalMotion, State, project};
use crate::problem::Problem;
use crate::system::ModalSystem;

/// A problem whose laws are of one kind: all plain stops, or whatever the problem has.
pub(crate) struct Setting<'a, P> {
    pub system: &'a ModalSystem,
    pub forcing: &'a Forcing,
    /// Modal displacements at t = 0.
    pub displacement: &'a [f64],
    /// Modal velocities at t = 0.
    pub velocity: &'a [f64],
    pub laws: Vec<&'a P>,
    /// Those of the laws at t = 0, if the problem tells them.
    states: &'a [State],
}

impl<'a, P: Law> Setting<'a, P> {
    /// A problem with its laws, seen as what they are.
    pub(super) fn new<L>(problem: &'a Problem<L>, laws: Vec<&'a P>) -> Self {
        Self {
            system: &problem.system,
            forcing: &problem.forcing,
            displacement: &problem.displacement,
            velocity: &problem.velocity,
            laws,
            states: &problem.states,
        }
    }

    /// Local positions and velocities of a law at t = 0.
    pub(crate) fn local_start(&self, law: &P) -> (Local<f64>, Local<f64>) {
        let position = project(law, self.displacement);
        (position, project(law, self.velocity))
    }

    /// Whether some obstacles move.
    pub(super) fn moves(&self) -> bool {
        self.forcing.moved().next().is_some()
    }

    /// The same of a law by its number, from its obstacle.
    fn start_from_obstacle(&self, number: usize) -> [Local<f64>; 2] {
        let (position, velocity) = self.local_start(self.laws[number]);
        (self.forcing).seen_from_obstacle(number, 0.0, [position, velocity])
    }

    /// The memory of a law that flows, after its coordinates have gone along a path between two
    /// times.
    pub(super) fn flowed(
        &self,
        number: usize,
        state: State,
        path: [Local<f64>; 2],
        times: [f64; 2],
    ) -> [f64; 2] {
        let seen = [0, 1].map(|end| {
            let local = [path[end], Local::default()];
            (self.forcing).seen_from_obstacle(number, times[end], local)[0]
        });
        flowed(self.laws[number], state, seen, times[1] - times[0])
    }

    /// The force of a law at t = 0.
    pub(crate) fn first_force(&self, number: usize) -> Local<f64> {
        let [position, velocity] = self.start_from_obstacle(number);
        self.laws[number].force(self.first_state(number), &position, &velocity)
    }

    /// Whether steps are more than those of modes by themselves among laws that stand still.
    pub(super) fn is_special(&self) -> bool {
        self.moves() || self.system.is_coupled() || self.laws.iter().any(|law| law.flows())
    }

    /// The state of a law at t = 0.
    fn first_state(&self, number: usize) -> State {
        let law = self.laws[number];
        let [position, velocity] = self.start_from_obstacle(number);
        let motion = LocalMotion::of(position, velocity);
        let told = self.states.get(number).copied();
        let before = told.unwrap_or_else(|| law.initial_state(&motion, |_| motion));
        law.sampled_state(before, &position, &velocity)
    }

    /// The states of all laws at t = 0.
    pub(super) fn first_states(&self) -> Vec<State> {
        (0..self.laws.len())
            .map(|law| self.first_state(law))
            .collect()
    }
}
