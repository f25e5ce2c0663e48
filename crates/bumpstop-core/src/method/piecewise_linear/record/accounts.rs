//! The energy ledger along the phases.

use super::{Motion, PhaseRecord};
use crate::energy::{self, Ledger};
use crate::law::{Law, State};
use crate::method::piecewise_linear::phase::{Phase, Phases, Workspace};
use crate::method::piecewise_linear::works::{Meter, Works};
use crate::number::{Instructions, Vectorised};
use crate::problem::Problem;
use std::cell::OnceCell;

/// Ledgers at the start of every phase and at the end of the run.
#[derive(Debug, Clone)]
pub(super) struct Accounts {
    meters: Vec<Meter>,
    pub(super) ledgers: Vec<Ledger>,
    /// Work of the loads that change in time up to each ledger.
    changing: Vec<f64>,
}

impl PhaseRecord {
    #[inline(always)]
    fn settle<I: Instructions, L: Law>(&self, problem: &Problem<L>) -> Accounts {
        let powers = OnceCell::new();
        let phases = &self.phases;
        let count = phases.list.len();
        let mut accounts = Accounts {
            meters: Vec::with_capacity(phases.spectra.len()),
            ledgers: Vec::with_capacity(count + 1),
            changing: Vec::with_capacity(count + 1),
        };
        for spectrum in &phases.spectra {
            let meter = Meter::new::<I, L>(problem, &powers, spectrum);
            accounts.meters.push(meter);
        }
        let mut work = Workspace::default();
        for (number, phase) in phases.list.iter().enumerate() {
            if number == 0 {
                let mut motion = Motion {
                    q: problem.displacement.clone(),
                    v: problem.velocity.clone(),
                };
                self.strike::<I, L>(problem, 0, &mut motion, &mut work);
                let mut ledger = state_ledger(problem, 0.0, phases.states(*phase), &motion);
                self.add_blows(0, &mut ledger.law_dissipated);
                accounts.ledgers.push(ledger);
                accounts.changing.push(0.0);
            }
            let next = phases.list.get(number + 1);
            let length = phase.length;
            let meter = &accounts.meters[phase.spectrum];
            let mut works = meter.until::<I, L>(problem, phases, *phase, length, &mut work);
            let mut motion = self.motion_in::<I, L>(problem, *phase, length, &mut work);
            if let Some(next) = next {
                add_switch_losses(problem, phases, *phase, *next, &motion, &mut works);
                self.strike::<I, L>(problem, number + 1, &mut motion, &mut work);
                self.add_blows(number + 1, &mut works.laws);
            }
            let after = next.unwrap_or(phase);
            let end = phase.start + length;
            let mut ledger = state_ledger(problem, end, phases.states(*after), &motion);
            accounts.add_works(number, &works, &mut ledger);
            accounts
                .changing
                .push(accounts.changing[number] + works.loads);
            accounts.ledgers.push(ledger);
        }
        accounts
    }

    /// The motion with which a phase begins where impulses begin it.
    #[inline(always)]
    fn strike<I: Instructions, L: Law>(
        &self,
        problem: &Problem<L>,
        phase: usize,
        motion: &mut Motion,
        work: &mut Workspace,
    ) {
        if !self.blows_at(phase).is_empty() {
            *motion = self.motion_in::<I, L>(problem, self.phases.list[phase], 0.0, work);
        }
    }

    /// Adds what the impulses at the start of a phase take.
    fn add_blows(&self, phase: usize, to: &mut [f64]) {
        for blow in self.blows_at(phase) {
            to[blow.law] += blow.loss();
        }
    }
}

impl Accounts {
    /// Adds to a ledger of the state alone what was done up to the start of a phase and since.
    fn add_works(&self, phase: usize, works: &Works, ledger: &mut Ledger) {
        let last = &self.ledgers[phase];
        ledger.load_work += self.changing[phase] + works.loads;
        ledger.modal_dissipation = last.modal_dissipation + works.modal;
        ledger.circulatory_work = last.circulatory_work + works.circulatory;
        ledger.obstacle_work = last.obstacle_work + works.obstacles;
        for (i, total) in ledger.law_dissipated.iter_mut().enumerate() {
            *total = last.law_dissipated[i] + works.laws[i];
        }
    }
}

/// The ledger at each time.
pub(super) struct Ledgers<'a, L> {
    pub(super) record: &'a PhaseRecord,
    pub(super) problem: &'a Problem<L>,
    pub(super) times: &'a [f64],
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
            let meter = &accounts.meters[phase.spectrum];
            let works = meter.until::<I, L>(problem, phases, phase, t, &mut work);
            let motion = record.motion_in::<I, L>(problem, phase, t, &mut work);
            let mut ledger = state_ledger(problem, *time, phases.states(phase), &motion);
            accounts.add_works(number, &works, &mut ledger);
            ledgers.push(ledger);
        }
        ledgers
    }
}

/// The ledgers at the switches.
pub(super) struct Settlement<'a, L> {
    pub(super) record: &'a PhaseRecord,
    pub(super) problem: &'a Problem<L>,
}

impl<L: Law> Vectorised for Settlement<'_, L> {
    type Output = Accounts;
    #[inline(always)]
    fn run<I: Instructions>(self) -> Accounts {
        self.record.settle::<I, L>(self.problem)
    }
}

/// Kinetic, elastic and stored energies and the work of constant loads.
fn state_ledger<L: Law>(
    problem: &Problem<L>,
    time: f64,
    states: &[State],
    motion: &Motion,
) -> Ledger {
    let (kinetic, elastic) = energy::of_structure(problem.system.omega2(), &motion.q, &motion.v);
    Ledger {
        kinetic,
        elastic,
        law_stored: (problem.laws.iter().zip(states).enumerate())
            .map(|(index, (law, state))| {
                let [position, _] = problem.local(index, time, &motion.q, &motion.v);
                law.stored(*state, &position)
            })
            .collect(),
        modal_dissipation: 0.0,
        circulatory_work: 0.0,
        obstacle_work: 0.0,
        law_dissipated: vec![0.0; problem.laws.len()],
        load_work: problem.forcing.work(&problem.displacement, &motion.q),
    }
}

fn add_switch_losses<L: Law>(
    problem: &Problem<L>,
    phases: &Phases,
    before: Phase,
    after: Phase,
    motion: &Motion,
    works: &mut Works,
) {
    let (from, to) = (phases.states(before), phases.states(after));
    for (i, law) in problem.laws.iter().enumerate() {
        if from[i] != to[i] {
            let [position, _] = problem.local(i, after.start, &motion.q, &motion.v);
            works.laws[i] += law.switch_loss(from[i], to[i], &position);
        }
    }
}
