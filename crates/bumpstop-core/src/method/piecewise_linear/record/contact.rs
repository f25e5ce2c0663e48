//! Reading the impacts of one law along the phases.

use super::PhaseRecord;
use crate::dynamics::Moment;
use crate::impacts::Impact;
use crate::law::{Affine, Law};
use crate::method::piecewise_linear::advance::{Certificate, Path, Start, Walk};
use crate::method::piecewise_linear::curved::{CurvedGuards, Guards};
use crate::method::piecewise_linear::held::Reaction;
use crate::method::piecewise_linear::phase::{Phase, Workspace};
use crate::method::piecewise_linear::product::Products;
use crate::method::piecewise_linear::signal::Signal;
use crate::number::Plain;
use crate::problem::Problem;
use crate::rigid::Blow;

/// Reads the contact of one law along phases, once and at leisure: in plain arithmetic, which
/// gives the same bits and compiles once.
pub(super) struct ContactReader<'a, L> {
    record: &'a PhaseRecord,
    problem: &'a Problem<L>,
    law: usize,
    first_view: usize,
    walk: Walk,
    work: Workspace,
}

impl<'a, L: Law> ContactReader<'a, L> {
    pub(super) fn new(record: &'a PhaseRecord, problem: &'a Problem<L>, law: usize) -> Self {
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

    pub(super) fn impacts(&mut self) -> Vec<Impact> {
        let phases = &self.record.phases;
        let which = &self.problem.laws[self.law];
        let mut impacts = Vec::new();
        let mut current: Option<Impact> = None;
        for phase in &phases.list {
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
                self.add_phase(*phase, phase.length, impact);
            }
        }
        impacts.extend(current);
        // A touch of no duration is a switch back and forth at one instant, not an impact.
        impacts.retain(|i| i.end != i.start);
        if which.restitution().is_some() {
            self.add_blows(&mut impacts);
        }
        impacts
    }

    /// Adds the impacts of a rigid stop, which have no duration. Where the structure rests it
    /// neither closes nor opens.
    fn add_blows(&self, impacts: &mut Vec<Impact>) {
        for rest in impacts.iter_mut() {
            rest.closing_speed = 0.0;
            if !rest.end.is_nan() {
                rest.opening_speed = 0.0;
            }
        }
        let own = |blow: &&Blow| blow.law == self.law && blow.is_impact;
        let rests = std::mem::take(impacts);
        impacts.extend(self.record.blows.iter().filter(own).map(Blow::impact));
        // A rest that follows an impact at once stands behind it.
        impacts.extend(rests);
        impacts.sort_by(|a, b| a.start.total_cmp(&b.start));
    }

    /// Distance, its rate and the force, `t` after the start of a phase.
    fn at(&mut self, phase: Phase, t: f64) -> [f64; 3] {
        let motion = (self.record).motion_in::<Plain, L>(self.problem, phase, t, &mut self.work);
        let law = &self.problem.laws[self.law];
        let time = phase.start + t;
        let [position, velocity] = (self.problem).local(self.law, time, &motion.q, &motion.v);
        let (distance, rate) = law.distance(&position, &velocity);
        let states = self.record.phases.states(phase);
        let moment = Moment {
            time,
            displacement: &motion.q,
            velocity: &motion.v,
            states,
        };
        let force = (moment.reaction(self.problem, self.law))
            .unwrap_or_else(|| law.force(states[self.law], &position, &velocity)[0]);
        [distance, rate, force]
    }

    /// Adds a phase in which the structure rests on a rigid stop: no work is done.
    fn add_rest(&mut self, phase: Phase, length: f64, reaction: &Reaction, impact: &mut Impact) {
        let phases = &self.record.phases;
        let mut force = Signal::default();
        let remaining = self.problem.duration - phase.start;
        reaction.set::<Plain>(&mut force, phases, phase, remaining);
        impact.impulse += force.integral(phases, phase, length);
        self.add_peaks(phase, length, &force, impact);
    }

    /// Adds a phase of the given length to an impact.
    fn add_phase(&mut self, phase: Phase, length: f64, impact: &mut Impact) {
        let phases = &self.record.phases;
        let held = phases.spectra[phase.spectrum].held.as_ref();
        if let Some(reaction) = held.and_then(|held| held.reaction(self.law)) {
            self.add_rest(phase, length, reaction, impact);
            return;
        }
        let law = &self.problem.laws[self.law];
        let state = self.record.phases.states(phase)[self.law];
        let Some(piece) = law.piece(state).filter(|p| p.acts()) else {
            return;
        };
        let mut force = Affine::ZERO;
        force.constant = piece.constant[0];
        force.position[0] = -piece.stiffness[0][0];
        force.velocity[0] = -piece.damping[0][0];
        let force = self.signal(phase, &force);
        impact.impulse += force.integral(&self.record.phases, phase, length);
        self.add_peaks(phase, length, &force, impact);
        let distance = self.signal(phase, &Affine::coordinate(0));
        self.add_work(phase, length, [&force, &distance], impact);
    }

    fn signal(&self, phase: Phase, function: &Affine) -> Signal {
        let mut signal = Signal::default();
        let remaining = self.problem.duration - phase.start;
        let phases = &self.record.phases;
        let views = &phases.spectra[phase.spectrum].views[self.first_view..];
        signal.set::<Plain>(phases, phase, views, function, remaining);
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
    fn add_work(
        &mut self,
        phase: Phase,
        length: f64,
        [force, distance]: [&Signal; 2],
        impact: &mut Impact,
    ) {
        let mut instants = self.turning_points(phase, length, distance);
        instants.push(length);
        let phases = &self.record.phases;
        let rate = distance.derivative(phases, phase);
        let (force, rate) = (force.factor(phases, phase), rate.factor(phases, phase));
        let exponents = &phases.spectra[phase.spectrum].lambda;
        let mut before = 0.0;
        for t in instants {
            let given = Products::new(exponents, t).integral::<Plain>(&force, &rate);
            impact.add_work(given - before);
            before = given;
        }
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
            Start::Zero(None)
        };
        let functions = Guards {
            problem: self.problem,
            states: phases.states(phase),
        };
        let curved = CurvedGuards {
            list: &[],
            functions: &functions,
        };
        let limit = MOST_TURNING_POINTS;
        while found.len() < limit {
            let rates = std::slice::from_ref(&rate);
            let path = Path {
                phases,
                phase,
                signals: rates,
                curved,
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
            start = Start::Zero(None);
            rate.negate();
        }
        found
    }
}

/// Turning points of one contact phase after which the search ends: a resting contact rings
/// for ever at the level of rounding.
const MOST_TURNING_POINTS: usize = 100_000;
