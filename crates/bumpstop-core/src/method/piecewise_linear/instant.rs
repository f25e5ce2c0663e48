//! What the equations of motion say of the laws' local motion at one instant, without a spectrum.

use crate::law::{Affine, COORDINATES, Law, Local, LocalMotion, Piece, State, project};
use crate::problem::Problem;

/// The structure's state at an instant.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Moment<'a> {
    /// In s since the start of the run.
    pub time: f64,
    /// Modal displacement and velocity.
    pub displacement: &'a [f64],
    pub velocity: &'a [f64],
}

/// The laws' states at t = 0, each from the motion that the structure would have without that
/// law. One that is just touched is decided by accelerations, and so by what the others push:
/// they are gone through until nothing changes.
pub(crate) fn initial_states<L: Law>(problem: &Problem<L>) -> Vec<State> {
    let moment = Moment {
        time: 0.0,
        displacement: &problem.displacement,
        velocity: &problem.velocity,
    };
    let mut states = vec![State::FIRST; problem.laws.len()];
    for _ in 0..problem.laws.len() {
        let mut settled = true;
        for (index, law) in problem.laws.iter().enumerate() {
            let motion = local_motion(problem, &states, Some(index), index, moment);
            let state = law.initial_state(&motion);
            settled &= state == states[index];
            states[index] = state;
        }
        if settled {
            break;
        }
    }
    states
}

/// Slope and curvature of a function of one law's local motion; zero where they are rounding.
/// `None` for functions of accelerations, whose curvature is a derivative too far.
#[cold]
pub(crate) fn rates<L: Law>(
    problem: &Problem<L>,
    states: &[State],
    law: usize,
    function: &Affine,
    moment: Moment<'_>,
) -> Option<[f64; 2]> {
    if function.acceleration != [0.0; COORDINATES] {
        return None;
    }
    let motion = local_motion(problem, states, None, law, moment);
    let of_order = |order: usize| {
        let (mut value, mut zero) = (0.0, 0.0);
        for i in 0..COORDINATES {
            value += function.position[i] * motion.derivatives[order][i];
            value += function.velocity[i] * motion.derivatives[order + 1][i];
            zero += function.position[i].abs() * motion.zero[order];
            zero += function.velocity[i].abs() * motion.zero[order + 1];
        }
        if value.abs() > zero { value } else { 0.0 }
    };
    Some([of_order(1), of_order(2)])
}

/// The local motion of one law, all laws but `without` acting.
fn local_motion<L: Law>(
    problem: &Problem<L>,
    states: &[State],
    without: Option<usize>,
    of: usize,
    moment: Moment<'_>,
) -> LocalMotion {
    let (q, v) = (moment.displacement, moment.velocity);
    let [forces, force_rates] = problem.forcing.around(moment.time);
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
    for (coordinate, row) in problem.laws[of].rows().iter().enumerate() {
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

/// The laws, without one where that is told, and their states.
fn others<'a, L: Law>(
    problem: &'a Problem<L>,
    states: &'a [State],
    without: Option<usize>,
) -> impl Iterator<Item = (&'a L, State)> {
    let all = problem.laws.iter().zip(states).enumerate();
    all.filter(move |(index, _)| Some(*index) != without)
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
