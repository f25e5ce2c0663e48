//! Switching: which guards are watched in a phase, from where they start, and what follows when
//! one reaches zero.

use super::advance::{Crossing, Start};
use super::instant::{self, Moment};
use super::phase::{Phase, Phases};
use super::rows::ComplexBlock;
use super::signal::{Instant, Signal};
use crate::history::Event;
use crate::law::{Affine, Guard, Law, LocalMotion};
use crate::number::{Instructions, Plain};
use crate::problem::Problem;

/// The slope of a guard that starts at zero is asked of the equations of motion where the
/// spectrum's is below this many times its rounding: the errors of the spectrum itself, which on
/// a stiff stop are larger than that, must not decide where the motion goes.
const DOUBTFUL: f64 = 1e6;

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
        [q, v]: [&[f64]; 2],
    ) {
        let states = phases.states(phase);
        let moment = Moment {
            time: phase.start,
            displacement: q,
            velocity: v,
        };
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
                let function = &guard.function;
                signal.set::<I>(phases, phase, &views[first_view..], function, remaining);
                let before = fired
                    .filter(|(law, _)| *law == index)
                    .map(|(_, fired)| fired);
                let flat = before.is_some_and(|fired| function.rises_with(&fired.function));
                if flat {
                    signal.start_flat(phases, phase);
                }
                let same = before.is_some_and(|fired| fired.function.is_multiple_of(function));
                let [value, slope, _] = signal.values_at_start(phases, phase);
                let zero = same || value.abs() <= signal.rounding(0.0) || value < 0.0;
                let noise = signal.rate_rounding(phases, phase)[0];
                self.starts.push(if !zero {
                    Start::Positive
                } else if flat || slope.abs() > DOUBTFUL * noise {
                    Start::Zero(None)
                } else {
                    Start::Zero(instant::rates(problem, states, index, function, moment))
                });
            }
            first_view += law.rows().len();
        }
    }

    /// The signals in use.
    pub(crate) fn active(&self) -> &[Signal] {
        &self.signals[..self.guards.len()]
    }
}

/// The event that the crossing of a watched guard makes at the end of a phase, and that guard.
pub(crate) fn event_of<L: Law>(
    problem: &Problem<L>,
    phases: &Phases,
    phase: Phase,
    watch: &Watch,
    crossing: Crossing,
) -> (Event, Guard) {
    let (number, index) = watch.guards[crossing.watched];
    let (law, before) = (&problem.laws[number], phases.states(phase)[number]);
    let guard = law.guard(before, index);
    let motion = || local_motion(problem, phases, phase, number, crossing.time);
    let event = Event {
        time: phase.start + crossing.time,
        law: number,
        guard: guard.name,
        before,
        after: law.next_state(before, index, motion),
    };
    (event, guard)
}

/// The local motion that a law sees `t` after the start of a phase. Only laws with memory ask
/// for it, so that plain arithmetic, which gives the same bits, does.
#[cold]
fn local_motion<L: Law>(
    problem: &Problem<L>,
    phases: &Phases,
    phase: Phase,
    law: usize,
    t: f64,
) -> LocalMotion {
    let spectrum = &phases.spectra[phase.spectrum];
    let before: usize = problem.laws[..law].iter().map(|l| l.rows().len()).sum();
    let mut exponentials = vec![ComplexBlock::ZERO; spectrum.lambda.len()];
    spectrum.exponentials::<Plain>(t, &mut exponentials);
    let at = Instant {
        time: t,
        exponentials: &exponentials,
    };
    let mut motion = LocalMotion::default();
    for coordinate in 0..problem.laws[law].rows().len() {
        let mut signal = Signal::default();
        let views = &spectrum.views[before..];
        let function = Affine::coordinate(coordinate);
        let remaining = problem.duration - phase.start;
        signal.set::<Plain>(phases, phase, views, &function, remaining);
        let rate = signal.derivative(phases, phase);
        let [x, ..] = signal.values::<Plain>(phases, phase, &at);
        let [v, a, jerk] = rate.values::<Plain>(phases, phase, &at);
        let [_, jerk_rounding] = rate.rate_rounding(phases, phase);
        let [v_rounding, a_rounding] = signal.rate_rounding(phases, phase);
        let rounding = [signal.rounding(t), v_rounding, a_rounding, jerk_rounding];
        motion.add(coordinate, [x, v, a, jerk], rounding);
    }
    motion
}
