//! The laws' states at the start of a run.

use crate::law::{COORDINATES, Law, Local, LocalMotion, Piece, State, project};
use crate::problem::Problem;

/// The laws' states at t = 0, each from the motion that the structure would have without that
/// law. One that is just touched is decided by accelerations, and so by what the others push:
/// they are gone through until nothing changes.
pub(crate) fn states<L: Law>(problem: &Problem<L>) -> Vec<State> {
    let mut states = vec![State::FIRST; problem.laws.len()];
    for _ in 0..problem.laws.len() {
        let mut settled = true;
        for (index, law) in problem.laws.iter().enumerate() {
            let state = law.initial_state(&motion_without(problem, &states, index));
            settled &= state == states[index];
            states[index] = state;
        }
        if settled {
            break;
        }
    }
    states
}

/// The local motion of one law at t = 0 while it does not act, but the others do.
fn motion_without<L: Law>(problem: &Problem<L>, states: &[State], without: usize) -> LocalMotion {
    let (q, v) = (&problem.displacement, &problem.velocity);
    let [forces, force_rates] = problem.forcing.at_start();
    let accelerations: Vec<Term> = (0..q.len())
        .map(|mode| {
            let mut sum = Term::of(forces[mode]);
            sum.add_structure(problem, mode, q, v);
            for (law, state) in others(problem, states, without) {
                let force = law.force(state, &project(law, q), &project(law, v));
                sum.add_law(law, mode, &force);
            }
            sum
        })
        .collect();
    let a: Vec<f64> = accelerations.iter().map(|a| a.value).collect();
    let jerk = |mode: usize| {
        let mut sum = Term::of(force_rates[mode]);
        sum.add_structure(problem, mode, v, &a);
        for (law, state) in others(problem, states, without) {
            let piece = law.piece(state).unwrap_or(Piece::FREE);
            let rate = Piece {
                constant: [0.0; COORDINATES],
                ..piece
            };
            sum.add_law(law, mode, &rate.force(&project(law, v), &project(law, &a)));
        }
        sum
    };
    let mut motion = LocalMotion::default();
    for (coordinate, row) in problem.laws[without].rows().iter().enumerate() {
        for (mode, factor) in row.iter().enumerate().filter(|(_, factor)| **factor != 0.0) {
            let terms = [
                Term::of(q[mode]),
                Term::of(v[mode]),
                accelerations[mode],
                jerk(mode),
            ];
            let zero = |term: Term| 8.0 * f64::EPSILON * (factor * term.size).abs();
            motion.add(
                coordinate,
                terms.map(|term| factor * term.value),
                terms.map(zero),
            );
        }
    }
    motion
}

/// The laws but one, with their states.
fn others<'a, L: Law>(
    problem: &'a Problem<L>,
    states: &'a [State],
    without: usize,
) -> impl Iterator<Item = (&'a L, State)> {
    let all = problem.laws.iter().zip(states).enumerate();
    all.filter(move |(index, _)| *index != without)
        .map(|(_, (law, state))| (law, *state))
}

/// A sum, and the sizes of what was added.
#[derive(Debug, Clone, Copy)]
struct Term {
    value: f64,
    size: f64,
}

impl Term {
    fn of(value: f64) -> Self {
        Self {
            value,
            size: value.abs(),
        }
    }

    fn add(&mut self, part: f64) {
        self.value += part;
        self.size += part.abs();
    }

    /// What the structure does to a mode: the motion and its rate, or those of a higher order.
    fn add_structure<L>(&mut self, problem: &Problem<L>, mode: usize, x: &[f64], rate: &[f64]) {
        let system = &problem.system;
        self.add(-system.omega2()[mode] * x[mode]);
        self.add(-system.damping()[mode] * rate[mode]);
        if let Some(coupling) = system.coupling() {
            self.add(-coupling.product(mode, rate));
        }
        if let Some(circulatory) = system.circulatory() {
            self.add(-circulatory.product(mode, x));
        }
    }

    /// A law's force on a mode.
    fn add_law<L: Law>(&mut self, law: &L, mode: usize, force: &Local<f64>) {
        for (row, force) in law.rows().iter().zip(force) {
            self.add(row[mode] * force);
        }
    }
}
