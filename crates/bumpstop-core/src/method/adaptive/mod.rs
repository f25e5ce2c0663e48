//! Methods with step control, dense output and located switches.
//!
//! They take every law that makes forces, smooth ones too. While no law switches, the equations
//! are smooth: a formula ([`stepping`]) takes a step and says how wide it may be. Runge-Kutta pairs
//! ([`pair`]) and their exponential kin ([`exponential`]) go by a tolerance ([`control`]), the central
//! difference by the frequency that the motion shows ([`central_difference`]). Each step is one or
//! more polynomials in time, on which the guards of the laws are bounded over the whole step, not
//! only looked at where it ends ([`super::polynomial_steps`]); the first zero ends the step, the law
//! switches, and the next step starts there. The error of the motion is that of the steps.

pub mod central_difference;
mod control;
pub mod exponential;
mod flying;
mod pair;
mod pieces;
mod runge_kutta;
mod stepping;

pub use central_difference::Resolution;
pub use control::{FINEST, Tolerances};
pub use pair::PairName;

use super::fixed_step::check_forces;
use super::instant::{self, Moment};
use super::piecewise_linear::Flights;
use super::polynomial_steps::{
    Crossing, Equations, Layout, PolynomialRecord, Step, Watch, longest_step,
};
use super::{Observer, check_not_stepped, observe};
use crate::energy::{self, Growth};
use crate::error::{Error, Result};
use crate::history::{Event, History};
use crate::law::{Guard, Law, Local, LocalMotion, State};
use crate::problem::Problem;
use crate::system::Coupling;
use central_difference::CentralDifference;
use exponential::Exponential;
use runge_kutta::RungeKutta;
use std::sync::Arc;
use stepping::{Attempt, Stepping};

/// Switches of each law at one instant after which the run is given up.
const MOST_SWITCHES_AT_ONCE: usize = 32;

/// How often the observer is asked, in steps.
const STEPS_BETWEEN_OBSERVATIONS: usize = 256;

/// How often the energies are looked at, in steps.
const STEPS_BETWEEN_LOOKS: usize = 16;

/// The first step turns the highest frequency of the structure and of the loads by this angle.
const FIRST_TURN: f64 = 0.1;

/// The first step, and one behind a switch, is no longer than this part of the shortest time in
/// which the linear laws answer. An estimate of the error speaks of short steps: of longer ones it
/// may vanish, as that of `rk32` does where the step is the time constant of a damper.
const ANSWERED: f64 = 0.5;

/// Part of the first step that smooth laws leave. What these answer tells of an instant only, and may
/// be without bounds there, as at the rest of a damper with a power of the speed below one.
const LEFT_BY_SMOOTH_LAWS: f64 = 1e-6;

/// So many times its rounding a guard is below zero at a switch that it has been passed by: the
/// speed of an obstacle has jumped.
const PASSED_BY: f64 = 1e6;

/// Steps below this many times the rounding of the time are too small.
const SMALLEST_STEP: f64 = 16.0 * f64::EPSILON;

/// What is left of a stretch is taken in one step where it is not longer than this many of them.
const LAST_STEP: f64 = 1.1;

/// A method whose steps follow the motion, with what rules them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Adaptive {
    /// A pair of Runge-Kutta formulas.
    RungeKutta(PairName, Tolerances),
    /// The exponential pair, see [`exponential`].
    Exponential(Tolerances),
    /// See [`central_difference`].
    CentralDifference(Resolution),
}

impl Adaptive {
    /// The method's name.
    pub fn name(&self) -> &'static str {
        match self {
            Self::RungeKutta(pair, _) => pair.name(),
            Self::Exponential(_) => exponential::NAME,
            Self::CentralDifference(_) => central_difference::NAME,
        }
    }

    fn check(&self) -> Result<()> {
        match self {
            Self::RungeKutta(_, tolerances) | Self::Exponential(tolerances) => tolerances.check(),
            Self::CentralDifference(resolution) => resolution.check(),
        }
    }
}

/// Runs a problem.
///
/// # Errors
/// See [`Error`].
pub fn simulate<L: Law>(
    problem: &Arc<Problem<L>>,
    method: Adaptive,
    observer: Observer<'_>,
) -> Result<History<L>> {
    let name = method.name();
    method.check()?;
    check_forces(name, &problem.laws)?;
    check_not_stepped(name, &problem.laws)?;
    let (states, equations, numbers) = start(problem);
    let first = first_step(problem);
    let flights = flying::flights(problem, method);
    let method = if flights.is_some() {
        flying::sharpened(method)
    } else {
        method
    };
    let (record, events) = match method {
        Adaptive::RungeKutta(pair, tolerances) => {
            let formula = RungeKutta::new(pair.pair(), tolerances, first, numbers, &equations);
            Run::new(formula, states, equations, flights).advance(observer)
        }
        Adaptive::Exponential(tolerances) => {
            let formula = Exponential::new(tolerances, first, numbers, &equations);
            Run::new(formula, states, equations, flights).advance(observer)
        }
        Adaptive::CentralDifference(resolution) => {
            let formula = CentralDifference::new(resolution, numbers, &equations);
            Run::new(formula, states, equations, flights).advance(observer)
        }
    }?;
    Ok(History::of_polynomials(problem, name, record, events))
}

/// The laws' states, the equations in them, and the numbers at t = 0.
fn start<L: Law>(problem: &Problem<L>) -> (Vec<State>, Equations<'_, L>, Vec<f64>) {
    let mut states = vec![State::FIRST; problem.laws.len()];
    let start = Moment {
        time: 0.0,
        displacement: &problem.displacement,
        velocity: &problem.velocity,
    };
    instant::initial_states(problem, &mut states, start);
    let mut equations = Equations::new(problem, Layout::new(problem));
    equations.take_states(&states);
    let layout = &equations.layout;
    let mut numbers = vec![0.0; layout.size()];
    let modes = layout.modes;
    numbers[..modes].copy_from_slice(&problem.displacement);
    numbers[modes..2 * modes].copy_from_slice(&problem.velocity);
    for (law, state) in states.iter().enumerate() {
        layout.remember(law, *state, &mut numbers);
    }
    (states, equations, numbers)
}

/// A run in progress.
struct Run<'a, L, S> {
    problem: &'a Problem<L>,
    equations: Equations<'a, L>,
    stepping: S,
    watch: Watch,
    states: Vec<State>,
    time: f64,
    /// The next step to try, in s.
    h: f64,
    /// The longest step, for obstacles that move in harmonics.
    longest: f64,
    growth: Growth,
    record: PolynomialRecord,
    /// What carries the motion where nothing smooth acts, if that is wanted.
    flights: Option<Flights<'a, L>>,
    /// Sizes of displacements and velocities in the flight that has just ended, one behind the
    /// other; empty where none has.
    landed: Vec<f64>,
    /// Stretches of time that were gone so far, steps and flights.
    stretches: usize,
    events: Vec<Event>,
    /// The laws that have switched at the present instant, each with the guard that was zero.
    fired: Vec<(usize, Guard)>,
    /// Switches since time went on.
    at_once: usize,
}

impl<'a, L: Law, S: Stepping<L>> Run<'a, L, S> {
    fn new(
        mut stepping: S,
        states: Vec<State>,
        mut equations: Equations<'a, L>,
        flights: Option<Flights<'a, L>>,
    ) -> Self {
        equations.turn(0.0);
        let (problem, degree) = (equations.problem, stepping.degree());
        let h = begun_step(&equations, stepping.numbers());
        let layout = &equations.layout;
        Self {
            problem,
            watch: Watch::new(problem, degree),
            growth: Growth::new(&layout.ledger(problem, 0.0, &states, stepping.numbers())),
            record: PolynomialRecord::new(layout.clone(), degree),
            stepping,
            states,
            time: 0.0,
            h,
            longest: longest_step(problem),
            flights,
            landed: Vec::new(),
            stretches: 0,
            events: Vec::new(),
            fired: Vec::new(),
            at_once: 0,
            equations,
        }
    }

    fn advance(mut self, observer: Observer<'_>) -> Result<(PolynomialRecord, Vec<Event>)> {
        let duration = self.problem.duration;
        observe(observer, self.time)?;
        while self.time < duration {
            // Loads may change their course at a knot.
            let limit = self.equations.turn(self.time).min(duration);
            self.pass_corner()?;
            if self.fly(limit)? {
                self.look(observer)?;
                continue;
            }
            self.stepping.start(self.time, &mut self.equations);
            while self.time < limit {
                let h = self.good_step(limit)?;
                let has_switched = self.finish(h, limit)?;
                self.look(observer)?;
                if has_switched && self.may_fly() {
                    break;
                }
            }
        }
        if let Some(flights) = self.flights {
            self.record.keep_flights(flights.record());
        }
        Ok((self.record, self.events))
    }

    /// Lets laws go on where the speed of an obstacle may have jumped.
    fn pass_corner(&mut self) -> Result<()> {
        let problem = self.problem;
        if self.time == 0.0 || problem.forcing.moved().next().is_none() {
            return Ok(());
        }
        let [q, v] = self.equations.layout.motion(self.stepping.numbers());
        let moment = Moment {
            time: self.time,
            displacement: q,
            velocity: v,
        };
        for event in instant::after_jump(problem, &self.states, v, moment) {
            self.take(event, None)?;
        }
        Ok(())
    }

    /// Looks after a run now and then.
    fn look(&mut self, observer: &mut dyn FnMut(f64) -> bool) -> Result<()> {
        let is_over = self.time >= self.problem.duration;
        if self.stretches.is_multiple_of(STEPS_BETWEEN_LOOKS) || is_over {
            self.check_growth()?;
        }
        self.stretches += 1;
        if self.stretches.is_multiple_of(STEPS_BETWEEN_OBSERVATIONS) {
            observe(observer, self.time)?;
        }
        Ok(())
    }

    /// Tries steps until one is good enough; returns its width.
    fn good_step(&mut self, limit: f64) -> Result<f64> {
        let left = limit - self.time;
        let mut h = self.h.min(self.longest);
        loop {
            if LAST_STEP * h >= left {
                h = left;
            }
            let attempt = (self.stepping).attempt(self.time, h, &mut self.equations);
            self.check_answers()?;
            match attempt {
                Attempt::Good(next) => {
                    self.h = next;
                    return Ok(h);
                }
                Attempt::Again(width) => h = width,
            }
            if h < SMALLEST_STEP * self.time.max(left) {
                return Err(Error::SmallStep {
                    time: self.time,
                    step: h,
                });
            }
        }
    }

    /// Refuses a motion that blows up.
    fn check_growth(&mut self) -> Result<()> {
        let (layout, numbers) = (&self.equations.layout, self.stepping.numbers());
        let ledger = layout.ledger(self.problem, self.time, &self.states, numbers);
        let Some(ratio) = self.growth.sees(&ledger) else {
            return Ok(());
        };
        let [q, v] = layout.motion(numbers);
        let omega2 = self.problem.system.omega2();
        Err(Error::RanAway {
            time: self.time,
            ratio,
            mode: energy::largest_share(omega2, q, v),
        })
    }

    /// Gives up where somebody outside could not tell a force.
    fn check_answers(&self) -> Result<()> {
        match self.problem.laws.iter().position(Law::has_failed) {
            Some(law) => Err(Error::NoAnswer {
                law,
                time: self.time,
            }),
            None => Ok(()),
        }
    }

    /// Keeps a step up to the first switch in it, and switches; returns whether there was one.
    fn finish(&mut self, h: f64, limit: f64) -> Result<bool> {
        let start = self.time;
        self.stepping.follow(start, h, &mut self.equations);
        let count = self.stepping.pieces().count();
        let width = h / count as f64;
        for piece in 0..count {
            let begun = start + piece as f64 * width;
            let dense = self.stepping.pieces().dense(piece);
            let step = Step {
                time: begun,
                h: width,
                dense,
                rounded: &self.landed,
            };
            let Equations { layout, loads, .. } = &self.equations;
            let crossing = (self.watch).first(self.problem, &self.states, layout, loads, step);
            let after = match crossing {
                None if piece + 1 < count => begun + width,
                None if h == limit - start => limit,
                None => start + h,
                Some(crossing) => begun + crossing.theta * width,
            };
            if after > self.time {
                self.record
                    .add(self.time, width, after, dense, &self.states)?;
                self.at_once = 0;
                self.fired.clear();
                self.landed.clear();
            }
            self.time = after;
            if let Some(crossing) = crossing {
                self.count_step(start);
                self.stepping.stop_at(piece, crossing.theta);
                self.switch(crossing)?;
                self.stepping.start(self.time, &mut self.equations);
                return Ok(true);
            }
        }
        self.count_step(start);
        self.stepping.go_on();
        Ok(false)
    }

    /// Counts a step that time went on in.
    fn count_step(&mut self, start: f64) {
        if self.time > start {
            self.record.count_step();
        }
    }

    /// Switches a law whose guard has reached zero.
    fn switch(&mut self, crossing: Crossing) -> Result<()> {
        let (problem, law) = (self.problem, crossing.law);
        let layout = &self.equations.layout;
        let numbers = self.stepping.numbers();
        let before = layout.state(law, self.states[law], numbers);
        let [displacement, velocity] = layout.motion(numbers);
        let moment = Moment {
            time: self.time,
            displacement,
            velocity,
        };
        let which = &problem.laws[law];
        let states = &self.states;
        let acting = |state| instant::acting(problem, states, (law, state), moment);
        let doubt = doubt(&acting(before), &crossing.acceleration);
        let acting = |state| {
            let mut motion = acting(state);
            motion.zero[2] = motion.zero[2].max(doubt);
            motion
        };
        let after = which.next_state(before, crossing.guard, acting);
        let guard = which.guard(before, crossing.guard);
        let event = Event {
            time: self.time,
            law,
            guard: guard.name,
            before,
            after,
        };
        let (value, zero) = guard.function.value(&acting(before));
        let passed_by = value < -PASSED_BY * zero && !guard.function.asks_acceleration();
        self.take(event, (!passed_by).then_some(guard))
    }

    /// Takes note of a switch, with its guard if that is zero, and lets its law go on in the state
    /// that follows.
    fn take(&mut self, event: Event, zero: Option<Guard>) -> Result<()> {
        let (problem, law) = (self.problem, event.law);
        self.at_once += 1;
        if self.at_once > MOST_SWITCHES_AT_ONCE * problem.laws.len() {
            return Err(Error::EndlessSwitching { time: self.time });
        }
        let layout = &self.equations.layout;
        let numbers = self.stepping.numbers();
        let [displacement, velocity] = layout.motion(numbers);
        let [position, _] = problem.local(law, self.time, displacement, velocity);
        numbers[layout.dissipated(law)] +=
            problem.laws[law].switch_loss(event.before, event.after, &position);
        layout.remember(law, event.after, numbers);
        self.events.push(event);
        self.fired.retain(|(fired, _)| *fired != law);
        self.fired.extend(zero.map(|guard| (law, guard)));
        self.states[law] = event.after;
        self.equations.take_states(&self.states);
        self.h = (self.h).min(answered_step(self.equations.linear_answers()));
        Ok(())
    }
}

/// By how much the accelerations of the equations and of the polynomial that a switch was found on
/// differ: what is smaller counts as zero where the law decides how it goes on.
fn doubt(motion: &LocalMotion, found: &Local<f64>) -> f64 {
    let both = motion.derivatives[2].iter().zip(found);
    both.map(|(a, b)| 2.0 * (a - b).abs()).sum()
}

/// A step in which structure and loads do little: frequencies turn, and dampings slow, by it.
fn first_step<L: Law>(problem: &Problem<L>) -> f64 {
    let Problem {
        system, forcing, ..
    } = problem;
    let loads = forcing.harmonics().iter().map(|h| h.omega);
    let coupling = system.coupling().map_or(0.0, Coupling::size);
    let damping = system
        .damping()
        .iter()
        .fold(coupling, |c, d| c.max(d.abs()));
    let fastest = loads.fold(system.highest_frequency().max(damping), f64::max);
    (FIRST_TURN / fastest).min(problem.duration)
}

/// A step in which structure, loads and laws do little, from t = 0 on.
fn begun_step<L: Law>(equations: &Equations<'_, L>, numbers: &[f64]) -> f64 {
    let first = first_step(equations.problem);
    let smooth = answered_step(equations.answers(0.0, numbers)).max(LEFT_BY_SMOOTH_LAWS * first);
    first
        .min(answered_step(equations.linear_answers()))
        .min(smooth)
}

/// A step in which laws that answer with such a stiffness and damping do so but in part.
fn answered_step([stiffness, damping]: [f64; 2]) -> f64 {
    ANSWERED / stiffness.sqrt().max(damping)
}
