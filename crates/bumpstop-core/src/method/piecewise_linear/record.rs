//! What an exact run keeps: its phases, from which everything else is read.

use super::advance::{Certificate, Path, Start, Walk};
use super::dissipation::{Dissipated, Dissipation};
use super::phase::{Phase, Phases, Workspace};
use super::rows::ComplexBlock;
use super::signal::{Instant, Signal};
use super::view::View;
use crate::energy::{self, Ledger};
use crate::impacts::Impact;
use crate::law::{COORDINATES, Guard, Law, State, project};
use crate::number::{Instructions, Plain, Vectorised, dispatch};
use crate::problem::Problem;
use std::cell::Cell;
use std::sync::OnceLock;

/// The phases of a run.
#[derive(Debug, Clone)]
pub struct PhaseRecord {
    phases: Phases,
    duration: f64,
    certificate: Certificate,
    accounts: OnceLock<Accounts>,
}

/// Ledgers at the start of every phase and at the end of the run.
#[derive(Debug, Clone)]
struct Accounts {
    forms: Vec<Dissipation>,
    ledgers: Vec<Ledger>,
}

/// Position and velocity of all modes.
struct Motion {
    q: Vec<f64>,
    v: Vec<f64>,
}

/// Phases that are tried one by one before all are searched.
const NEARBY: usize = 4;

impl Drop for PhaseRecord {
    fn drop(&mut self) {
        self.phases.leave();
    }
}

impl PhaseRecord {
    pub(crate) fn new(phases: Phases, duration: f64, certificate: Certificate) -> Self {
        Self {
            phases,
            duration,
            certificate,
            accounts: OnceLock::new(),
        }
    }

    /// Cells that the walk looked at.
    pub fn cells(&self) -> usize {
        self.certificate.cells
    }

    /// Bound of what the walk could have missed for rounding, in m.
    pub fn missed_penetration(&self) -> f64 {
        self.certificate.missed
    }

    /// The number of the phase at a time: the last one that has started.
    pub fn phase_at(&self, time: f64) -> usize {
        self.phases.list.partition_point(|p| p.start <= time).max(1) - 1
    }

    /// The same, looked for from a phase on: times mostly come in order.
    #[inline(always)]
    fn phase_from(&self, number: usize, time: f64) -> usize {
        let list = &self.phases.list;
        for candidate in number..list.len().min(number + NEARBY) {
            let after = list.get(candidate + 1).map_or(f64::INFINITY, |p| p.start);
            if list[candidate].start <= time && time < after {
                return candidate;
            }
        }
        self.phase_at(time)
    }

    /// Shows modal displacement, velocity and law states at each time.
    pub(crate) fn visit(&self, times: &[f64], modes: usize, see: &mut See<'_>) {
        dispatch(Visit {
            record: self,
            times,
            modes,
            see,
        });
    }

    /// A time derivative (0, 1 or 2) of one linear combination of the modal coordinates.
    pub(crate) fn project(&self, row: &[f64], times: &[f64], order: usize) -> Vec<f64> {
        dispatch(Projection {
            record: self,
            row,
            times,
            order,
        })
    }

    /// The energy ledger at each time.
    pub(crate) fn ledgers<L: Law>(&self, problem: &Problem<L>, times: &[f64]) -> Vec<Ledger> {
        dispatch(Ledgers {
            record: self,
            problem,
            times,
        })
    }

    /// Largest imbalance at the switches and at the end, relative to the largest energy.
    pub(crate) fn energy_residual<L: Law>(&self, problem: &Problem<L>) -> f64 {
        energy::residual(self.accounts(problem).ledgers.iter())
    }

    fn accounts<L: Law>(&self, problem: &Problem<L>) -> &Accounts {
        self.accounts.get_or_init(|| {
            dispatch(Settlement {
                record: self,
                problem,
            })
        })
    }

    #[inline(always)]
    fn settle<I: Instructions, L: Law>(&self, problem: &Problem<L>) -> Accounts {
        let mut forms = Vec::with_capacity(self.phases.spectra.len());
        for spectrum in &self.phases.spectra {
            forms.push(Dissipation::new::<I, L>(problem, spectrum));
        }
        let mut work = Workspace::default();
        let mut ledgers: Vec<Ledger> = Vec::with_capacity(self.phases.list.len() + 1);
        let mut motion = Motion {
            q: problem.displacement.clone(),
            v: problem.velocity.clone(),
        };
        let mut before: Option<Phase> = None;
        let mut dissipated = none(problem);
        for phase in &self.phases.list {
            if let Some(before) = before {
                let length = phase.start - before.start;
                let form = &forms[before.spectrum];
                dissipated = form.until::<I>(&self.phases, before, length, &mut work);
                motion = self.motion_in::<I, L>(problem, before, length, &mut work);
                add_switch_losses(
                    problem,
                    &self.phases,
                    before,
                    *phase,
                    &motion,
                    &mut dissipated,
                );
            }
            ledgers.push(next_ledger(
                problem,
                self.phases.states(*phase),
                &motion,
                ledgers.last(),
                &dissipated,
            ));
            before = Some(*phase);
        }
        if let Some(last) = before {
            let length = self.duration - last.start;
            dissipated = forms[last.spectrum].until::<I>(&self.phases, last, length, &mut work);
            motion = self.motion_in::<I, L>(problem, last, length, &mut work);
            let states = self.phases.states(last);
            ledgers.push(next_ledger(
                problem,
                states,
                &motion,
                ledgers.last(),
                &dissipated,
            ));
        }
        Accounts { forms, ledgers }
    }

    #[inline(always)]
    fn motion_in<I: Instructions, L: Law>(
        &self,
        problem: &Problem<L>,
        phase: Phase,
        t: f64,
        work: &mut Workspace,
    ) -> Motion {
        let modes = problem.system.modes();
        let mut motion = Motion {
            q: vec![0.0; modes],
            v: vec![0.0; modes],
        };
        self.phases
            .motion::<I>(phase, t, work, &mut motion.q, &mut motion.v);
        motion
    }

    /// Impacts of one law.
    pub(crate) fn impacts<L: Law>(&self, problem: &Problem<L>, law: usize) -> Vec<Impact> {
        ContactReader::new(self, problem, law).impacts()
    }
}

/// Is shown modal displacement, velocity and law states.
pub(crate) type See<'a> = dyn FnMut(&[f64], &[f64], &[State]) + 'a;

struct Visit<'a, 'b> {
    record: &'a PhaseRecord,
    times: &'a [f64],
    modes: usize,
    see: &'a mut See<'b>,
}

impl Vectorised for Visit<'_, '_> {
    type Output = ();
    #[inline(always)]
    fn run<I: Instructions>(self) {
        let phases = &self.record.phases;
        let mut work = Workspace::default();
        let (mut q, mut v) = (vec![0.0; self.modes], vec![0.0; self.modes]);
        for time in self.times {
            let phase = phases.list[self.record.phase_at(*time)];
            phases.motion::<I>(phase, time - phase.start, &mut work, &mut q, &mut v);
            (self.see)(&q, &v, phases.states(phase));
        }
    }
}

struct Projection<'a> {
    record: &'a PhaseRecord,
    row: &'a [f64],
    times: &'a [f64],
    order: usize,
}

/// Room for reading a linear combination, used again and again.
#[derive(Debug, Default)]
struct Reader {
    view: [View; 1],
    signal: Signal,
    combined: Vec<f64>,
    exponentials: Vec<ComplexBlock>,
}

thread_local! {
    static READER: Cell<Option<Box<Reader>>> = const { Cell::new(None) };
}

/// The local coordinate itself.
const COORDINATE: Guard = Guard {
    name: "coordinate",
    constant: 0.0,
    position: [1.0, 0.0, 0.0],
    velocity: [0.0; COORDINATES],
};

impl Vectorised for Projection<'_> {
    type Output = Vec<f64>;
    #[inline(always)]
    fn run<I: Instructions>(self) -> Vec<f64> {
        let phases = &self.record.phases;
        let mut reader = READER.take().unwrap_or_default();
        let mut present = None;
        let mut values = Vec::with_capacity(self.times.len());
        let mut number = 0;
        for time in self.times {
            number = self.record.phase_from(number, *time);
            let phase = phases.list[number];
            let spectrum = &phases.spectra[phase.spectrum];
            let Reader {
                view,
                signal,
                combined,
                exponentials,
            } = &mut *reader;
            if present != Some(number) {
                view[0].set::<I>(spectrum, self.row, combined);
                signal.set::<I>(phases, phase, view, &COORDINATE, self.record.duration);
                exponentials.resize(spectrum.lambda.len(), ComplexBlock::ZERO);
                present = Some(number);
            }
            let time = time - phase.start;
            spectrum.exponentials::<I>(time, exponentials);
            let at = Instant { time, exponentials };
            values.push(signal.derivative_value::<I>(self.order, phases, phase, &at));
        }
        READER.set(Some(reader));
        values
    }
}

struct Ledgers<'a, L> {
    record: &'a PhaseRecord,
    problem: &'a Problem<L>,
    times: &'a [f64],
}

impl<L: Law> Vectorised for Ledgers<'_, L> {
    type Output = Vec<Ledger>;
    #[inline(always)]
    fn run<I: Instructions>(self) -> Vec<Ledger> {
        let Self {
            record, problem, ..
        } = self;
        let accounts = record.accounts(problem);
        let phases = &record.phases;
        let mut work = Workspace::default();
        let mut ledgers = Vec::with_capacity(self.times.len());
        for time in self.times {
            let number = record.phase_at(*time);
            let phase = phases.list[number];
            let t = time - phase.start;
            let form = &accounts.forms[phase.spectrum];
            let dissipated = form.until::<I>(phases, phase, t, &mut work);
            let motion = record.motion_in::<I, L>(problem, phase, t, &mut work);
            let mut ledger = state_ledger(problem, phases.states(phase), &motion);
            add_dissipated(&mut ledger, &accounts.ledgers[number], &dissipated);
            ledgers.push(ledger);
        }
        ledgers
    }
}

struct Settlement<'a, L> {
    record: &'a PhaseRecord,
    problem: &'a Problem<L>,
}

impl<L: Law> Vectorised for Settlement<'_, L> {
    type Output = Accounts;
    #[inline(always)]
    fn run<I: Instructions>(self) -> Accounts {
        self.record.settle::<I, L>(self.problem)
    }
}

/// Kinetic, elastic and stored energies and work of loads.
fn state_ledger<L: Law>(problem: &Problem<L>, states: &[State], motion: &Motion) -> Ledger {
    let (kinetic, elastic) = energy::of_structure(problem.system.omega2(), &motion.q, &motion.v);
    Ledger {
        kinetic,
        elastic,
        law_stored: (problem.laws.iter().zip(states))
            .map(|(law, state)| law.stored(*state, &project(law, &motion.q)))
            .collect(),
        modal_dissipation: 0.0,
        law_dissipated: vec![0.0; problem.laws.len()],
        load_work: problem.forcing.work(&problem.displacement, &motion.q),
    }
}

fn none<L: Law>(problem: &Problem<L>) -> Dissipated {
    Dissipated {
        modal: 0.0,
        laws: vec![0.0; problem.laws.len()],
    }
}

fn next_ledger<L: Law>(
    problem: &Problem<L>,
    states: &[State],
    motion: &Motion,
    last: Option<&Ledger>,
    dissipated: &Dissipated,
) -> Ledger {
    let mut ledger = state_ledger(problem, states, motion);
    if let Some(last) = last {
        add_dissipated(&mut ledger, last, dissipated);
    }
    ledger
}

fn add_dissipated(ledger: &mut Ledger, last: &Ledger, dissipated: &Dissipated) {
    ledger.modal_dissipation = last.modal_dissipation + dissipated.modal;
    for (i, total) in ledger.law_dissipated.iter_mut().enumerate() {
        *total = last.law_dissipated[i] + dissipated.laws[i];
    }
}

fn add_switch_losses<L: Law>(
    problem: &Problem<L>,
    phases: &Phases,
    before: Phase,
    after: Phase,
    motion: &Motion,
    dissipated: &mut Dissipated,
) {
    let (from, to) = (phases.states(before), phases.states(after));
    for (i, law) in problem.laws.iter().enumerate() {
        if from[i] != to[i] {
            dissipated.laws[i] += law.switch_loss(from[i], to[i], &project(law, &motion.q));
        }
    }
}

/// Reads the contact of one law along phases, once and at leisure: in plain arithmetic, which
/// gives the same bits and compiles once.
struct ContactReader<'a, L> {
    record: &'a PhaseRecord,
    problem: &'a Problem<L>,
    law: usize,
    first_view: usize,
    walk: Walk,
    work: Workspace,
}

impl<'a, L: Law> ContactReader<'a, L> {
    fn new(record: &'a PhaseRecord, problem: &'a Problem<L>, law: usize) -> Self {
        let before = &problem.laws[..law];
        let mut walk = Walk::default();
        walk.start(record.duration);
        Self {
            record,
            problem,
            law,
            first_view: before.iter().map(|l| l.rows().len()).sum(),
            walk,
            work: Workspace::default(),
        }
    }

    fn impacts(&mut self) -> Vec<Impact> {
        let phases = &self.record.phases;
        let which = &self.problem.laws[self.law];
        let mut impacts = Vec::new();
        let mut current: Option<Impact> = None;
        for (number, phase) in phases.list.iter().enumerate() {
            let contact = which.in_contact(phases.states(*phase)[self.law]);
            if contact && current.is_none() {
                let [_, speed, _] = self.at(*phase, 0.0);
                current = Some(Impact::starting(phase.start, -speed));
            }
            if !contact && let Some(mut impact) = current.take() {
                impact.end = phase.start;
                impact.opening_speed = self.at(*phase, 0.0)[1];
                impacts.push(impact);
            }
            if let Some(impact) = &mut current {
                let next = phases.list.get(number + 1);
                let end = next.map_or(self.record.duration, |p| p.start);
                self.add_phase(*phase, end - phase.start, impact);
            }
        }
        impacts.extend(current);
        // A touch of no duration is a switch back and forth at one instant, not an impact.
        impacts.retain(|i| i.end != i.start);
        impacts
    }

    /// Distance, its rate and the force, `t` after the start of a phase.
    fn at(&mut self, phase: Phase, t: f64) -> [f64; 3] {
        let motion = (self.record).motion_in::<Plain, L>(self.problem, phase, t, &mut self.work);
        let law = &self.problem.laws[self.law];
        let (position, velocity) = (project(law, &motion.q), project(law, &motion.v));
        let (distance, rate) = law.distance(&position, &velocity);
        let state = self.record.phases.states(phase)[self.law];
        [distance, rate, law.force(state, &position, &velocity)[0]]
    }

    /// Adds a phase of the given length to an impact.
    fn add_phase(&mut self, phase: Phase, length: f64, impact: &mut Impact) {
        let law = &self.problem.laws[self.law];
        let state = self.record.phases.states(phase)[self.law];
        let Some(piece) = law.piece(state).filter(|p| p.acts()) else {
            return;
        };
        let mut force = Guard {
            name: "force",
            constant: piece.constant[0],
            position: [0.0; COORDINATES],
            velocity: [0.0; COORDINATES],
        };
        force.position[0] = -piece.stiffness[0][0];
        force.velocity[0] = -piece.damping[0][0];
        let mut distance = force;
        (distance.position[0], distance.velocity[0]) = (1.0, 0.0);
        let signal = self.signal(phase, &force);
        impact.impulse += signal.integral(&self.record.phases, phase, length);
        self.add_peaks(phase, length, &signal, impact);
        let signal = self.signal(phase, &distance);
        self.add_work(phase, length, &signal, impact);
    }

    fn signal(&self, phase: Phase, guard: &Guard) -> Signal {
        let mut signal = Signal::default();
        let remaining = self.problem.duration - phase.start;
        let phases = &self.record.phases;
        let views = &phases.spectra[phase.spectrum].views[self.first_view..];
        signal.set::<Plain>(phases, phase, views, guard, remaining);
        signal
    }

    fn add_peaks(&mut self, phase: Phase, length: f64, force: &Signal, impact: &mut Impact) {
        let mut instants = vec![0.0, length];
        instants.extend(self.turning_points(phase, length, force));
        for t in instants {
            let [_, _, force] = self.at(phase, t);
            impact.see_force(phase.start + t, force);
        }
    }

    /// Between turning points of the distance the work has one sign.
    fn add_work(&mut self, phase: Phase, length: f64, distance: &Signal, impact: &mut Impact) {
        let mut instants = vec![0.0];
        instants.extend(self.turning_points(phase, length, distance));
        instants.push(length);
        let given: Vec<f64> = instants.iter().map(|t| self.taken(phase, *t)).collect();
        for pair in given.windows(2) {
            impact.add_work(pair[0] - pair[1]);
        }
    }

    /// Energy in the law, stored or dissipated since the start of the phase.
    fn taken(&mut self, phase: Phase, t: f64) -> f64 {
        let law = &self.problem.laws[self.law];
        let form = &self.record.accounts(self.problem).forms[phase.spectrum];
        let dissipated = form.until::<Plain>(&self.record.phases, phase, t, &mut self.work);
        let motion = (self.record).motion_in::<Plain, L>(self.problem, phase, t, &mut self.work);
        let state = self.record.phases.states(phase)[self.law];
        law.stored(state, &project(law, &motion.q)) + dissipated.laws[self.law]
    }

    /// All zeros of a signal's rate inside a phase, in order.
    fn turning_points(&mut self, phase: Phase, length: f64, signal: &Signal) -> Vec<f64> {
        let phases = &self.record.phases;
        let mut rate = signal.derivative(phases, phase);
        let mut found = Vec::new();
        let mut from = 0.0;
        let mut certificate = Certificate::default();
        let mut start = if rate.orient(phases, phase) {
            Start::Positive
        } else {
            Start::Zero
        };
        let limit = MOST_TURNING_POINTS;
        while found.len() < limit {
            let rates = std::slice::from_ref(&rate);
            let path = Path {
                phases,
                phase,
                signals: rates,
                starts: &[start],
                from,
                limit: length,
            };
            let zero = self.walk.first_zero::<Plain>(path, &mut certificate);
            let Some(zero) = zero else {
                break;
            };
            if zero.time > from {
                found.push(zero.time);
            }
            from = zero.time;
            start = Start::Zero;
            rate.negate();
        }
        found
    }
}

/// Turning points of one contact phase after which the search ends: a resting contact rings
/// for ever at the level of rounding.
const MOST_TURNING_POINTS: usize = 100_000;
