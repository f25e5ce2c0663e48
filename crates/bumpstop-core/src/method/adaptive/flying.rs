//! Flights: from the last contact that opens to the next one in closed form.
//!
//! What keeps these problems from the exact method are laws that are smooth in contact. Where
//! none of them acts, and all that does is linear, the exact method carries the motion to the next
//! switch, whose guards it bounds whatever their shape. Contacts that push are stepped through,
//! linear ones too: the smooth ones set the pace there.

use super::stepping::Stepping;
use super::{Adaptive, FINEST, Run, Tolerances, first_step};
use crate::error::Result;
use crate::law::{Law, Piece, State};
use crate::method::piecewise_linear::{Flights, Takeoff};
use crate::method::{check_steady, scale};
use crate::problem::Problem;

/// Instants of a flight at which a formula sees how large its numbers are.
const LOOKS: usize = 8;

/// Part of a run's first step, or of the flight, that is tried where one ends. Forces of contacts
/// may begin with any power of time, of which an estimate of the error sees little: the step must
/// be short there.
const LANDING: f64 = 0.01;

/// Part of the relative tolerance that contacts between flights are given.
const SHARPER: f64 = 0.1;

/// Part of a run's first step that none is shorter than after a flight, however short that was.
const SHORTEST: f64 = 1e-9;

/// The flights of a run, if a method takes any: where every law is piecewise linear the exact
/// method takes the whole run, and others are there to be compared with it.
pub(super) fn flights<L: Law>(problem: &Problem<L>, method: Adaptive) -> Option<Flights<'_, L>> {
    let (Adaptive::RungeKutta(_, tolerances) | Adaptive::Exponential(tolerances)) = method else {
        return None;
    };
    let Tolerances { exact_flights, .. } = tolerances;
    let is_smooth = problem.laws.iter().any(|law| !law.is_piecewise_linear());
    let is_fit = check_steady("", &problem.system).is_ok() && scale::check(problem).is_ok();
    // What pushes in its first state, which of contacts is the open one, does in all of them.
    let is_free = (problem.laws.iter()).all(|law| lets_fly(law, State::FIRST));
    (exact_flights && is_smooth && is_fit && is_free).then(|| Flights::new(problem))
}

/// The method with a finer tolerance: what flights save is spent on contacts, in which all of the
/// error is made then.
pub(super) fn sharpened(method: Adaptive) -> Adaptive {
    let sharper = |tolerances: Tolerances| Tolerances {
        relative: (SHARPER * tolerances.relative).max(FINEST),
        ..tolerances
    };
    match method {
        Adaptive::RungeKutta(pair, tolerances) => Adaptive::RungeKutta(pair, sharper(tolerances)),
        Adaptive::Exponential(tolerances) => Adaptive::Exponential(sharper(tolerances)),
        other @ Adaptive::CentralDifference(_) => other,
    }
}

/// Whether a state of a law is none of a contact that pushes, and linear.
fn lets_fly<L: Law>(law: &L, state: State) -> bool {
    match law.piece(state) {
        None => false,
        Some(Piece::FREE) => true,
        Some(_) => law.is_piecewise_linear() && !law.flows() && !law.in_contact(state),
    }
}

impl<L: Law, S: Stepping<L>> Run<'_, L, S> {
    /// Whether the motion may go on in a flight.
    pub(super) fn may_fly(&self) -> bool {
        let laws = self.problem.laws.iter().zip(&self.states);
        self.flights.is_some() && laws.into_iter().all(|(law, state)| lets_fly(law, *state))
    }

    /// Flies to the next switch or up to a limit, if nothing keeps the motion from it; returns
    /// whether it has.
    pub(super) fn fly(&mut self, limit: f64) -> Result<bool> {
        if !self.may_fly() {
            return Ok(false);
        }
        let Some(flights) = &mut self.flights else {
            return Ok(false);
        };
        let layout = &self.equations.layout;
        let modes = layout.modes;
        let start = self.stepping.numbers();
        let [displacement, velocity] = layout.motion(start);
        // Nothing flows in a flight: what laws remember stays.
        let remembered = self.states.iter().enumerate();
        let states: Vec<State> = remembered
            .map(|(law, state)| layout.state(law, *state, start))
            .collect();
        let takeoff = Takeoff {
            time: self.time,
            states: &states,
            fired: &self.fired,
            displacement,
            velocity,
        };
        let Some(flight) = flights.fly(takeoff, limit)? else {
            return Ok(false);
        };
        let goes_on = flight.end > self.time;
        if !goes_on && flight.switch.is_none() {
            return Ok(false);
        }
        if goes_on {
            let span = [self.time, flight.end];
            self.record
                .add_flight(span, flight.number, start, &self.states)?;
            self.record.count_step();
            self.at_once = 0;
            self.fired.clear();
            layout.add_works(&flight.works, start);
        }
        let [q, v] = &flight.motion;
        start[..modes].copy_from_slice(q);
        start[modes..2 * modes].copy_from_slice(v);
        if goes_on {
            let looks = (0..LOOKS).map(|look| look as f64 / LOOKS as f64);
            let sizes = looks.fold(vec![0.0f64; 2 * modes], |mut sizes, part| {
                let motion = flights.motion(flight.number, part);
                for (size, x) in sizes.iter_mut().zip(motion) {
                    *size = size.max(x.abs());
                }
                sizes
            });
            self.stepping.see(&sizes);
            self.land(sizes, flight.end - self.time);
        }
        self.time = flight.end;
        self.check_growth()?;
        if let Some((event, zero)) = flight.switch {
            self.take(event, zero)?;
        }
        Ok(true)
    }

    /// Goes on with a short step, and takes note of what the motion at the end of a flight was
    /// summed of: its phases, and the instant, are known to the rounding of the flight's length.
    fn land(&mut self, mut sizes: Vec<f64>, length: f64) {
        let (displacements, velocities) = sizes.split_at_mut(self.equations.layout.modes);
        let omega2 = self.problem.system.omega2();
        for ((q, v), omega2) in displacements.iter_mut().zip(velocities).zip(omega2) {
            (*q, *v) = (*q + length * *v, *v + length * omega2.abs() * *q);
        }
        self.landed = sizes;
        let first = first_step(self.problem);
        let landing = LANDING * first.min(length);
        self.h = self.h.min(landing).max(SHORTEST * first);
    }
}
