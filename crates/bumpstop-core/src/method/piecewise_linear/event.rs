//! Switching: which guards are watched in a phase, from where they start, and what follows when
//! one reaches zero.

use super::advance::{Crossing, Start};
use super::curved::{Curved, Guards};
use super::held::Held;
use super::phase::{Phase, Phases};
use super::rows::ComplexBlock;
use super::signal::{Instant, Signal};
use super::still::Still;
use crate::history::Event;
use crate::law::{Affine, Guard, Law, LocalMotion, State};
use crate::method::instant::{self, Moment};
use crate::number::{Instructions, Plain};
use crate::problem::Problem;
use crate::rigid::{Contacts, TOUCHING};

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
    /// Those that are no signals, behind the others.
    pub curved: Vec<Curved>,
    pub starts: Vec<Start>,
}

impl Watch {
    /// Sets the signals for a phase that has just begun; `fired` are the guards that have reached
    /// zero at this instant, `contacts` are the rigid stops, `still` those touched without load.
    #[inline(always)]
    pub(crate) fn set<I: Instructions, L: Law>(
        &mut self,
        problem: &Problem<L>,
        phases: &Phases,
        phase: Phase,
        fired: &[(usize, Guard)],
        [q, v]: [&[f64]; 2],
        (contacts, still): (&Contacts, &Still),
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
        self.curved.clear();
        let mut is_curved = false;
        let mut first_view = 0;
        let remaining = problem.duration - phase.start;
        let moves = problem.forcing.varies() && problem.forcing.moved().next().is_some();
        for (index, law) in problem.laws.iter().enumerate() {
            for number in 0..law.guard_count(states[index]) {
                if law.is_curved(states[index], number) {
                    is_curved = true;
                    continue;
                }
                let guard = law.guard(states[index], number);
                let signal = next_signal(&mut self.signals, self.guards.len());
                let function = &guard.function;
                signal.set::<I>(phases, phase, &views[first_view..], function, remaining);
                let margin = still.margin(index, function);
                if margin > 0.0 {
                    signal.raise(margin);
                }
                let before = (fired.iter())
                    .find(|(law, _)| *law == index)
                    .map(|(_, fired)| fired);
                let flat = before.is_some_and(|fired| function.rises_with(&fired.function));
                if flat {
                    signal.start_flat(phases, phase);
                }
                let same = || before.is_some_and(|fired| fired.function.is_multiple_of(function));
                let [value, slope, _] = signal.values_at_start(phases, phase);
                let zero = value <= signal.rounding(0.0) || same();
                let noise = signal.rate_rounding(phases, phase)[0];
                let is_held = phases.spectra[phase.spectrum].held.is_some();
                // The speed of an obstacle, and with it a damper's force, may jump.
                let is_behind = moves && value < -signal.rounding(0.0) && !same();
                let start = if !zero {
                    Start::Positive
                } else if is_behind
                    || has_jumped(problem, states, index, function, moment) && !same()
                {
                    Start::Below
                } else if flat || is_held || slope.abs() > DOUBTFUL * noise {
                    Start::Zero(None)
                } else {
                    Start::Zero(instant::rates(problem, states, index, function, moment))
                };
                let start = if contacts.is_empty() {
                    Some(start)
                } else {
                    contacts.start_of(index, function, signal, phases, phase, start)
                };
                if let Some(start) = start {
                    self.guards.push((index, number));
                    self.starts.push(start);
                }
            }
            first_view += law.rows().len();
        }
        if let Some(held) = &phases.spectra[phase.spectrum].held {
            self.watch_reactions::<I>(held, phases, phase, remaining);
        }
        if is_curved {
            self.watch_curved(problem, phases, phase, fired);
        }
    }

    /// The guards that are no signals.
    #[cold]
    fn watch_curved<L: Law>(
        &mut self,
        problem: &Problem<L>,
        phases: &Phases,
        phase: Phase,
        fired: &[(usize, Guard)],
    ) {
        let spectrum = &phases.spectra[phase.spectrum];
        let states = phases.states(phase);
        let remaining = problem.duration - phase.start;
        let exponentials = vec![ComplexBlock::ONE; spectrum.lambda.len()];
        let at = Instant {
            time: 0.0,
            exponentials: &exponentials,
        };
        let mut first_view = 0;
        for (index, law) in problem.laws.iter().enumerate() {
            let views = &spectrum.views[first_view..];
            for number in 0..law.guard_count(states[index]) {
                if !law.is_curved(states[index], number) {
                    continue;
                }
                let which = [index, number, law.rows().len()];
                let curved = Curved::new(which, phases, phase, views, remaining);
                let start = curved.at(&Guards { problem, states }, phases, phase, &at);
                let has_fired = fired.iter().any(|(law, _)| *law == index);
                let zero = if has_fired { JUST_FIRED } else { 1.0 } * start.rest[0];
                self.starts.push(if start.value > zero {
                    Start::Positive
                } else {
                    Start::Zero(None)
                });
                self.guards.push((index, number));
                self.curved.push(curved);
            }
            first_view += law.rows().len();
        }
    }

    /// Reactions must push.
    fn watch_reactions<I: Instructions>(
        &mut self,
        held: &Held,
        phases: &Phases,
        phase: Phase,
        remaining: f64,
    ) {
        for (law, reaction) in &held.reactions {
            let signal = next_signal(&mut self.signals, self.guards.len());
            reaction.set::<I>(signal, phases, phase, remaining);
            let [value, ..] = signal.values_at_start(phases, phase);
            let rounding = signal.rounding(0.0);
            let start = if value > rounding {
                Start::Positive
            } else if value < -rounding {
                Start::Below
            } else {
                Start::Zero(None)
            };
            self.guards.push((*law, REACTION));
            self.starts.push(start);
        }
    }

    /// The signals in use.
    pub(crate) fn active(&self) -> &[Signal] {
        &self.signals[..self.guards.len() - self.curved.len()]
    }
}

/// A curved guard of a law that has just switched counts as zero below this many times its
/// rounding: the instant of a zero is known to rounding, too.
const JUST_FIRED: f64 = 16.0;

/// Whether a guard that asks for accelerations is below zero by more than rounding: forces of
/// other laws or loads have jumped.
#[inline(always)]
fn has_jumped<L: Law>(
    problem: &Problem<L>,
    states: &[State],
    law: usize,
    function: &Affine,
    moment: Moment<'_>,
) -> bool {
    function.asks_acceleration() && is_below(problem, states, law, function, moment)
}

#[cold]
fn is_below<L: Law>(
    problem: &Problem<L>,
    states: &[State],
    law: usize,
    function: &Affine,
    moment: Moment<'_>,
) -> bool {
    let motion = instant::acting(problem, states, (law, states[law]), moment);
    let (value, zero) = function.value(&motion);
    value < -DOUBTFUL * zero
}

/// The number that the guard of a reaction has instead of a place in its law's list.
pub(crate) const REACTION: usize = usize::MAX;

/// Room for one more signal.
#[inline(always)]
fn next_signal(signals: &mut Vec<Signal>, at: usize) -> &mut Signal {
    if signals.len() == at {
        signals.push(Signal::default());
    }
    &mut signals[at]
}

impl Contacts {
    /// How a guard starts where there are rigid stops: those in touch are at zero. `None` for the
    /// distance of a stop that stays at zero because others hold it there.
    fn start_of(
        &self,
        law: usize,
        function: &Affine,
        signal: &Signal,
        phases: &Phases,
        phase: Phase,
        start: Start,
    ) -> Option<Start> {
        let departs = self
            .departures
            .iter()
            .find(|departure| departure.law == law);
        let [value, ..] = signal.values_at_start(phases, phase);
        match departs {
            Some(_) if signal.stays(TOUCHING * self.size(law)) => None,
            Some(departure) if departure.is_tangent => Some(Start::Tangent),
            Some(_) => Some(Start::Zero(None)),
            None => {
                let jumps =
                    self.jumped_at(phase.start) && function.velocity != Affine::ZERO.velocity;
                let is_below = jumps && value < -signal.rounding(0.0);
                Some(if is_below { Start::Below } else { start })
            }
        }
    }

    /// Takes note of how far the distances of open stops go in a phase up to time t.
    pub(crate) fn see_phase<L: Law>(&mut self, problem: &Problem<L>, watch: &Watch, t: f64) {
        for ((law, number), signal) in watch.guards.iter().zip(&watch.signals) {
            if *number != REACTION && problem.laws[*law].restitution().is_some() {
                self.see(*law, signal.size(t));
            }
        }
    }
}

/// The event that the crossing of a watched guard makes at the end of a phase, and that guard if it
/// is zero there: velocities that jump, be it those of an obstacle, pass guards by.
pub(crate) fn event_of<L: Law>(
    problem: &Problem<L>,
    phases: &Phases,
    phase: Phase,
    watch: &Watch,
    crossing: Crossing,
    [q, v]: [&[f64]; 2],
) -> (Event, Option<Guard>) {
    let (number, index) = watch.guards[crossing.watched];
    let (law, before) = (&problem.laws[number], phases.states(phase)[number]);
    let guard = law.guard(before, index);
    let moment = Moment {
        time: phase.start + crossing.time,
        displacement: q,
        velocity: v,
    };
    let acting = |state| {
        let mut motion = instant::acting(problem, phases.states(phase), (number, state), moment);
        // What the spectrum's rounding may have made counts as zero, too.
        let found = local_motion(problem, phases, phase, number, crossing.time);
        for (zero, rounding) in motion.zero.iter_mut().zip(found.zero) {
            *zero = zero.max(rounding);
        }
        motion
    };
    let event = Event {
        time: phase.start + crossing.time,
        law: number,
        guard: guard.name,
        before,
        after: law.next_state(before, index, acting),
    };
    let passed_by =
        watch.starts[crossing.watched] == Start::Below && !guard.function.asks_acceleration();
    (event, (!passed_by).then_some(guard))
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
