//! Reading the impacts of one law along the phases.

use super::PhaseRecord;
use super::turns::Turns;
use crate::impacts::Impact;
use crate::law::{Affine, Law};
use crate::method::piecewise_linear::advance::Walk;
use crate::method::piecewise_linear::phase::Phase;
use crate::method::piecewise_linear::product::Products;
use crate::method::piecewise_linear::signal::Signal;
use crate::number::{Instructions, Vectorised, dispatch};
use crate::problem::Problem;
use crate::rigid::Blow;

/// Reads the contact of one law along phases.
pub(super) struct ContactReader<'a, L> {
    record: &'a PhaseRecord,
    problem: &'a Problem<L>,
    law: usize,
    reads_forces: bool,
    first_view: usize,
    walk: Walk,
    distance: Signal,
    force: Signal,
}

/// What a law's force depends on while it is in contact.
enum Contact {
    /// A rigid stop that is rested on: the force is its reaction.
    Resting,
    /// The distance alone.
    Spring,
    /// The distance and its rate.
    Damped,
}

impl<L: Law> Vectorised for ContactReader<'_, L> {
    type Output = Vec<Impact>;
    #[inline(always)]
    fn run<I: Instructions>(mut self) -> Vec<Impact> {
        let phases = &self.record.phases;
        let which = &self.problem.laws[self.law];
        let mut impacts = Vec::new();
        let mut current: Option<Impact> = None;
        for phase in &phases.list {
            let contact = which.in_contact(phases.states(*phase)[self.law]);
            if !contact && current.is_none() {
                continue;
            }
            let speed = self.watch_distance::<I>(*phase);
            if contact {
                let impact = current.get_or_insert_with(|| Impact::starting(phase.start, -speed));
                if self.reads_forces {
                    self.add_phase::<I>(*phase, impact);
                }
            } else if let Some(mut impact) = current.take() {
                impact.end = phase.start;
                impact.opening_speed = speed;
                impacts.push(impact);
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
            reads_forces: true,
            first_view: before.iter().map(|l| l.rows().len()).sum(),
            walk,
            distance: Signal::default(),
            force: Signal::default(),
        }
    }

    /// Reads instants and speeds alone.
    pub(super) fn without_forces(self) -> Self {
        Self {
            reads_forces: false,
            ..self
        }
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

    /// Follows the distance along a phase; returns its rate at the start.
    #[inline(always)]
    fn watch_distance<I: Instructions>(&mut self, phase: Phase) -> f64 {
        let phases = &self.record.phases;
        let views = &phases.spectra[phase.spectrum].views[self.first_view..];
        let remaining = self.problem.duration - phase.start;
        let function = Affine::coordinate(0);
        (self.distance).set::<I>(phases, phase, views, &function, remaining);
        self.distance.values_at_start(phases, phase)[1]
    }

    /// Follows the force along a phase; returns what it depends on, where there is one.
    #[inline(always)]
    fn watch_force<I: Instructions>(&mut self, phase: Phase) -> Option<Contact> {
        let phases = &self.record.phases;
        let spectrum = &phases.spectra[phase.spectrum];
        let remaining = self.problem.duration - phase.start;
        let held = spectrum.held.as_ref();
        if let Some(reaction) = held.and_then(|held| held.reaction(self.law)) {
            reaction.set::<I>(&mut self.force, phases, phase, remaining);
            return Some(Contact::Resting);
        }
        let state = phases.states(phase)[self.law];
        let piece = self.problem.laws[self.law].piece(state)?;
        if !piece.acts() {
            return None;
        }
        let mut force = Affine::ZERO;
        force.constant = piece.constant[0];
        force.position[0] = -piece.stiffness[0][0];
        force.velocity[0] = -piece.damping[0][0];
        let views = &spectrum.views[self.first_view..];
        (self.force).set::<I>(phases, phase, views, &force, remaining);
        Some(if piece.damping[0][0] == 0.0 {
            Contact::Spring
        } else {
            Contact::Damped
        })
    }

    /// Adds a phase, along which the distance is [followed](Self::watch_distance), to an impact.
    #[inline(always)]
    fn add_phase<I: Instructions>(&mut self, phase: Phase, impact: &mut Impact) {
        let Some(contact) = self.watch_force::<I>(phase) else {
            return;
        };
        let phases = &self.record.phases;
        impact.impulse += self.force.integral(phases, phase, phase.length);
        let record = self.record;
        let mut turns = |signal| {
            dispatch(Turns {
                record,
                problem: self.problem,
                phase,
                signal,
                walk: &mut self.walk,
            })
        };
        match contact {
            Contact::Resting => {
                let instants = turns(&self.force);
                self.add_peaks::<I>(phase, &instants, impact);
            }
            Contact::Spring => {
                // The force turns where the distance does.
                let instants = turns(&self.distance);
                self.add_peaks::<I>(phase, &instants, impact);
                self.add_spring_work::<I>(phase, &instants, impact);
            }
            Contact::Damped => {
                let (peaks, instants) = (turns(&self.force), turns(&self.distance));
                self.add_peaks::<I>(phase, &peaks, impact);
                self.add_work::<I>(phase, &instants, impact);
            }
        }
    }

    /// Takes note of the force where it turns, and at both ends of a phase.
    #[inline(always)]
    fn add_peaks<I: Instructions>(&self, phase: Phase, turns: &[f64], impact: &mut Impact) {
        for t in with_ends(turns, phase.length) {
            let force = self.force.at::<I>(0, &self.record.phases, phase, t);
            impact.see_force(phase.start + t, force);
        }
    }

    /// Adds the work of a spring, told by the ends of each way: its force is linear between.
    #[inline(always)]
    fn add_spring_work<I: Instructions>(&self, phase: Phase, turns: &[f64], impact: &mut Impact) {
        let phases = &self.record.phases;
        let mut before: Option<[f64; 2]> = None;
        for t in with_ends(turns, phase.length) {
            let force = self.force.at::<I>(0, phases, phase, t);
            let distance = self.distance.at::<I>(0, phases, phase, t);
            if let Some([last_force, last_distance]) = before {
                impact.add_work(0.5 * (force + last_force) * (distance - last_distance));
            }
            before = Some([force, distance]);
        }
    }

    /// Adds the work of any force; between turns of the distance it has one sign.
    #[inline(always)]
    fn add_work<I: Instructions>(&self, phase: Phase, turns: &[f64], impact: &mut Impact) {
        let phases = &self.record.phases;
        let rate = self.distance.derivative(phases, phase);
        let (force, rate) = (self.force.factor(phases, phase), rate.factor(phases, phase));
        let exponents = &phases.spectra[phase.spectrum].lambda;
        let mut before = 0.0;
        for t in with_ends(turns, phase.length).skip(1) {
            let given = Products::new(exponents, t).integral::<I>(&force, &rate);
            impact.add_work(given - before);
            before = given;
        }
    }
}

/// Instants of a phase with its start and its end.
fn with_ends(instants: &[f64], length: f64) -> impl Iterator<Item = f64> {
    let inside = instants.iter().copied();
    std::iter::once(0.0).chain(inside).chain([length])
}
