//! The energy ledger along the phases.

use super::{Motion, PhaseRecord};
use crate::energy::{self, Ledger};
use crate::law::{Law, State, project};
use crate::method::piecewise_linear::dissipation::{Dissipated, Dissipation};
use crate::method::piecewise_linear::phase::{Phase, Phases, Workspace};
use crate::number::{Instructions, Vectorised};
use crate::problem::Problem;

/// Ledgers at the start of every phase and at the end of the run.
#[derive(Debug, Clone)]
pub(super) struct Accounts {
    pub(super) forms: Vec<Dissipation>,
    pub(super) ledgers: Vec<Ledger>,
}

impl PhaseRecord {
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
