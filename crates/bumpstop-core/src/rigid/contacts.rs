//! What happens where rigid stops are touched: impacts, coming to rest, leaving.

use super::directions::Directions;
use super::meeting::{Meeting, Outcome};
use crate::error::{Error, Result};
use crate::history::Event;
use crate::impacts::Impact;
use crate::law::{Law, RigidStop, State, project};
use crate::problem::Problem;

/// A distance below this part of the motion is zero: some times the bound of its rounding.
pub(crate) const TOUCHING: f64 = 5e-14;

/// An impulse of one stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Blow {
    pub law: usize,
    /// The phase that it begins, by number.
    pub phase: usize,
    pub time: f64,
    /// In N s.
    pub impulse: f64,
    /// Rate of the distance before and after, in m/s.
    pub before: f64,
    pub after: f64,
    /// Whether it is an impact, not the end of rebounds too low to be followed.
    pub is_impact: bool,
}

impl Blow {
    /// Energy taken from the structure, in J: the rate is linear in the impulse that grows.
    pub(crate) fn loss(&self) -> f64 {
        -0.5 * self.impulse * (self.before + self.after)
    }

    /// As an impact of no duration and without a finite force.
    pub(crate) fn impact(&self) -> Impact {
        let mut impact = Impact::starting(self.time, -self.before);
        impact.end = self.time;
        impact.opening_speed = self.after;
        impact.impulse = self.impulse;
        impact.see_force(self.time, f64::INFINITY);
        impact.add_work_of_impulse(self.impulse, [self.before, self.after]);
        impact
    }
}

/// Why the stops in touch are looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Cause {
    /// The run starts, another law switches, or loads change their course.
    Other,
    /// A stop is touched.
    Touch(usize),
    /// The reaction of a stop has come down to zero.
    Leave(usize),
}

/// When and why the stops in touch are looked at.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place {
    pub cause: Cause,
    pub time: f64,
    /// The phase that begins, by number.
    pub phase: usize,
}

/// How a stop's distance goes on from zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Departure {
    pub law: usize,
    /// Whether it starts with no speed and no acceleration.
    pub is_tangent: bool,
}

/// The rigid stops of a run.
#[derive(Debug, Default)]
pub(crate) struct Contacts {
    /// The rigid stops, by number of law.
    stops: Vec<usize>,
    /// How far the distance of each has gone, in m.
    sizes: Vec<f64>,
    pub blows: Vec<Blow>,
    /// The stops that were in touch at the last look and are open.
    pub departures: Vec<Departure>,
    /// When velocities jumped last.
    jumped: Option<f64>,
}

impl Contacts {
    /// The rigid stops of a problem, at its start.
    pub(crate) fn new<L: Law>(problem: &Problem<L>) -> Self {
        let mut contacts = Self::default();
        for (number, law) in problem.laws.iter().enumerate() {
            if law.restitution().is_some() {
                contacts.stops.push(number);
            }
        }
        if contacts.is_empty() {
            return contacts;
        }
        let directions = Directions::of(problem, contacts.stops.clone());
        let moved = directions.sizes(&problem.displacement);
        for (stop, size) in contacts.stops.iter().zip(moved) {
            let (gap, _) = problem.laws[*stop].distance(&[0.0; 3], &[0.0; 3]);
            contacts.sizes.push(gap.abs() + size);
        }
        contacts
    }

    /// Whether there are none.
    #[inline(always)]
    pub(crate) fn is_empty(&self) -> bool {
        self.stops.is_empty()
    }

    /// Takes note of how far a stop's distance goes.
    pub(crate) fn see(&mut self, law: usize, size: f64) {
        if let Some(place) = self.stops.iter().position(|stop| *stop == law) {
            self.sizes[place] = self.sizes[place].max(size);
        }
    }

    /// How far the distance of a stop has gone.
    pub(crate) fn size(&self, law: usize) -> f64 {
        let place = self.stops.iter().position(|stop| *stop == law);
        place.map_or(0.0, |place| self.sizes[place])
    }

    /// Whether velocities jumped at a time.
    #[inline(always)]
    pub(crate) fn jumped_at(&self, time: f64) -> bool {
        self.jumped == Some(time)
    }

    /// Forgets the last look.
    pub(crate) fn clear(&mut self) {
        self.departures.clear();
    }

    /// Refuses a start inside a stop.
    ///
    /// # Errors
    /// [`Error::InsideStop`]
    pub(crate) fn check_start<L: Law>(&self, problem: &Problem<L>) -> Result<()> {
        for (&law, size) in self.stops.iter().zip(&self.sizes) {
            let distance = distance(problem, law, &problem.displacement);
            if distance < -TOUCHING * size {
                return Err(Error::InsideStop {
                    law,
                    depth: -distance,
                });
            }
        }
        Ok(())
    }

    /// Lets the stops in touch do their work: velocities jump, states change, events are noted.
    ///
    /// # Errors
    /// [`Error::NoImpactLaw`] where the law of impact has no solution.
    pub(crate) fn meet<L: Law>(
        &mut self,
        problem: &Problem<L>,
        place: Place,
        q: &[f64],
        v: &mut [f64],
        states: &mut [State],
        events: &mut Vec<Event>,
    ) -> Result<()> {
        self.clear();
        let (mut touching, mut sizes) = (Vec::new(), Vec::new());
        for (&law, &size) in self.stops.iter().zip(&self.sizes) {
            let close = || distance(problem, law, q).abs() <= TOUCHING * size;
            if states[law] == RigidStop::RESTING || place.cause == Cause::Touch(law) || close() {
                touching.push(law);
                sizes.push(size);
            }
        }
        if touching.is_empty() {
            return Ok(());
        }
        let meeting = Meeting {
            problem,
            cause: place.cause,
            time: place.time,
            sizes,
            directions: Directions::of(problem, touching),
        };
        for outcome in meeting.run(q, v, states)? {
            self.note(&outcome, place, states, events);
        }
        Ok(())
    }

    /// Keeps what became of one stop.
    fn note(
        &mut self,
        outcome: &Outcome,
        place: Place,
        states: &mut [State],
        events: &mut Vec<Event>,
    ) {
        let law = outcome.law;
        let Place { cause, time, phase } = place;
        let state = &mut states[law];
        let mut now = *state;
        let mut switch = |guard, after| {
            events.push(Event {
                time,
                law,
                guard,
                before: *state,
                after,
            });
            *state = after;
            after
        };
        let blow = |impulse, before, after, is_impact| Blow {
            law,
            phase,
            time,
            impulse,
            before,
            after,
            is_impact,
        };
        let is_struck = outcome.impulse > 0.0;
        if is_struck {
            let rests_at_once = outcome.rests && outcome.after == 0.0;
            let after = if rests_at_once {
                RigidStop::RESTING
            } else {
                RigidStop::OPEN
            };
            now = switch("impact", after);
            let (before, after) = (outcome.before, outcome.after);
            self.blows.push(blow(outcome.impulse, before, after, true));
            self.jumped = Some(time);
        }
        if outcome.end != 0.0 {
            self.blows
                .push(blow(outcome.end, outcome.after, 0.0, false));
        }
        let is_resting = now == RigidStop::RESTING;
        if outcome.rests {
            if !is_resting {
                switch("settling", RigidStop::RESTING);
            }
            return;
        }
        if is_resting {
            switch("leaving", RigidStop::OPEN);
        }
        self.departures.push(Departure {
            law,
            is_tangent: cause == Cause::Leave(law) && !is_struck,
        });
    }
}

fn distance<L: Law>(problem: &Problem<L>, law: usize, displacement: &[f64]) -> f64 {
    let law = &problem.laws[law];
    law.distance(&project(law, displacement), &[0.0; 3]).0
}
