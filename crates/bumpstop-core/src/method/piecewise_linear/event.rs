//! Switching: which guards are watched in a phase, from where they start, and what follows when
//! one reaches zero.

use super::advance::Start;
use super::phase::{Phase, Phases};
use super::signal::Signal;
use crate::history::Event;
use crate::law::{COORDINATES, Guard, Law, Local, State};
use crate::number::Instructions;
use crate::problem::Problem;
use crate::system::Coupling;

/// The guards of all laws in their present states.
#[derive(Debug, Default)]
pub(crate) struct Watch {
    /// Law and guard number behind each signal.
    pub guards: Vec<(usize, usize)>,
    pub signals: Vec<Signal>,
    pub starts: Vec<Start>,
}

impl Watch {
    /// Sets the signals for a phase that has just begun; `fired` is the guard that ended the
    /// phase before.
    #[inline(always)]
    pub(crate) fn set<I: Instructions, L: Law>(
        &mut self,
        problem: &Problem<L>,
        phases: &Phases,
        phase: Phase,
        fired: Option<(usize, Guard)>,
    ) {
        let states = phases.states(phase);
        let views = &phases.spectra[phase.spectrum].views;
        self.guards.clear();
        self.starts.clear();
        let mut first_view = 0;
        let remaining = problem.duration - phase.start;
        for (index, law) in problem.laws.iter().enumerate() {
            for number in 0..law.guard_count(states[index]) {
                let guard = law.guard(states[index], number);
                let at = self.guards.len();
                self.guards.push((index, number));
                if self.signals.len() == at {
                    self.signals.push(Signal::default());
                }
                let signal = &mut self.signals[at];
                signal.set::<I>(phases, phase, &views[first_view..], &guard, remaining);
                let same = fired.is_some_and(|(law, f)| law == index && shares_zero(&f, &guard));
                let zero = same || {
                    let [value, ..] = signal.values_at_start(phases, phase);
                    value.abs() <= signal.rounding(0.0) || value < 0.0
                };
                self.starts
                    .push(if zero { Start::Zero } else { Start::Positive });
            }
            first_view += law.rows().len();
        }
    }

    /// The signals in use.
    pub(crate) fn active(&self) -> &[Signal] {
        &self.signals[..self.guards.len()]
    }
}

/// Whether two guards are the same function up to a factor.
fn shares_zero(a: &Guard, b: &Guard) -> bool {
    let flat = |g: &Guard| {
        let mut all = [0.0; 1 + 2 * COORDINATES];
        all[0] = g.constant;
        all[1..=COORDINATES].copy_from_slice(&g.position);
        all[1 + COORDINATES..].copy_from_slice(&g.velocity);
        all
    };
    let (a, b) = (flat(a), flat(b));
    let Some(pivot) = (0..a.len()).rev().find(|&i| a[i] != 0.0) else {
        return false;
    };
    b[pivot] != 0.0 && (0..a.len()).all(|i| a[i] * b[pivot] == b[i] * a[pivot])
}

/// The event that a crossing of watched guard `watched` at `time` makes, and the guard itself.
pub(crate) fn event_of<L: Law>(
    problem: &Problem<L>,
    states: &[State],
    watch: &Watch,
    watched: usize,
    time: f64,
) -> (Event, Guard) {
    let (law, number) = watch.guards[watched];
    let guard = problem.laws[law].guard(states[law], number);
    let event = Event {
        time,
        law,
        guard: guard.name,
        before: states[law],
        after: problem.laws[law].next_state(states[law], number),
    };
    (event, guard)
}

/// The laws' states at t = 0, from the motion that the structure would have without them.
pub(crate) fn initial_states<L: Law>(problem: &Problem<L>) -> Vec<State> {
    let mut states = Vec::with_capacity(problem.laws.len());
    for law in &problem.laws {
        let (motion, sizes) = free_derivatives(problem, law);
        states.push(law.initial_state(&motion, &sizes));
    }
    states
}

/// Local coordinates and their first three derivatives at t = 0 without the laws, and the sizes
/// below which each counts as zero.
fn free_derivatives<L: Law>(problem: &Problem<L>, law: &L) -> ([Local<f64>; 4], [f64; 4]) {
    let (omega2, damping) = (problem.system.omega2(), problem.system.damping());
    let [forces, force_rates] = problem.forcing.at_start();
    let coupled = |mode: usize, position: &[f64], velocity: &[f64]| {
        let part = |matrix: Option<&Coupling>, motion: &[f64]| {
            matrix.map_or(0.0, |matrix| matrix.product(mode, motion))
        };
        part(problem.system.coupling(), velocity) + part(problem.system.circulatory(), position)
    };
    let acceleration = |i: usize| {
        let (q, v) = (problem.displacement[i], problem.velocity[i]);
        forces[i]
            - damping[i] * v
            - omega2[i] * q
            - coupled(i, &problem.displacement, &problem.velocity)
    };
    let accelerations: Vec<f64> = if problem.system.is_coupled() {
        (0..omega2.len()).map(acceleration).collect()
    } else {
        Vec::new()
    };
    let mut motion = [[0.0; COORDINATES]; 4];
    let mut sizes = [0.0; 4];
    for (coordinate, row) in law.rows().iter().enumerate() {
        for i in 0..omega2.len() {
            let (q, v) = (problem.displacement[i], problem.velocity[i]);
            let a = acceleration(i);
            let jerk = force_rates[i]
                - damping[i] * a
                - omega2[i] * v
                - coupled(i, &problem.velocity, &accelerations);
            let derivatives = [q, v, a, jerk];
            for (order, derivative) in derivatives.iter().enumerate() {
                let term = row[i] * derivative;
                motion[order][coordinate] += term;
                sizes[order] += 8.0 * f64::EPSILON * term.abs();
            }
        }
    }
    (motion, sizes)
}
