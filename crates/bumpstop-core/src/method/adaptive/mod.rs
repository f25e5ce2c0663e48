//! Runge-Kutta methods with step control, dense output and located switches.
//!
//! They take every law that makes forces, smooth ones too. While no law switches, the equations
//! are smooth: [`pair`] has the formulas, [`control`] the step. Each step is a polynomial in time,
//! on which the guards of the laws are bounded over the whole step, not only looked at where it
//! ends ([`super::polynomial_steps`]); the first zero ends the step, the law switches, and the next
//! step starts there. The error of the motion is that of the steps, which the tolerance rules.

mod control;
mod pair;
mod stepper;

pub use control::{FINEST, Tolerances};
pub use pair::PairName;

use super::fixed_step::check_forces;
use super::instant::{self, Moment};
use super::polynomial_steps::{
    Crossing, Equations, Layout, PolynomialRecord, Step, Watch, longest_step,
};
use super::{Observer, check_not_stepped, observe};
use crate::error::{Error, Result};
use crate::history::{Event, History};
use crate::law::{Law, Local, LocalMotion, State};
use crate::problem::Problem;
use control::Control;
use pair::Pair;
use std::sync::Arc;
use stepper::Stepper;

/// Switches of each law at one instant after which the run is given up.
const MOST_SWITCHES_AT_ONCE: usize = 32;

/// How often the observer is asked, in steps.
const STEPS_BETWEEN_OBSERVATIONS: usize = 256;

/// The first step turns the highest frequency that is known by this angle.
const FIRST_TURN: f64 = 0.1;

/// Steps below this many times the rounding of the time are too small.
const SMALLEST_STEP: f64 = 16.0 * f64::EPSILON;

/// What is left of a stretch is taken in one step where it is not longer than this many of them.
const LAST_STEP: f64 = 1.1;

/// Runs a problem.
///
/// # Errors
/// See [`Error`].
pub fn simulate<L: Law>(
    problem: &Arc<Problem<L>>,
    pair: PairName,
    tolerances: Tolerances,
    observer: Observer<'_>,
) -> Result<History<L>> {
    let pair = pair.pair();
    tolerances.check()?;
    check_forces(pair.name, &problem.laws)?;
    check_not_stepped(pair.name, &problem.laws)?;
    let mut run = Run::new(problem, pair, tolerances);
    run.advance(observer)?;
    Ok(History::of_polynomials(
        problem, pair.name, run.record, run.events,
    ))
}

/// A run in progress.
struct Run<'a, L> {
    problem: &'a Problem<L>,
    pair: &'static Pair,
    equations: Equations<'a, L>,
    stepper: Stepper,
    control: Control,
    watch: Watch,
    states: Vec<State>,
    time: f64,
    /// The next step to try, in s.
    h: f64,
    /// The longest step, for obstacles that move in harmonics.
    longest: f64,
    record: PolynomialRecord,
    events: Vec<Event>,
    /// Switches since time went on.
    at_once: usize,
}

impl<'a, L: Law> Run<'a, L> {
    fn new(problem: &'a Problem<L>, pair: &'static Pair, tolerances: Tolerances) -> Self {
        let mut states = vec![State::FIRST; problem.laws.len()];
        let start = Moment {
            time: 0.0,
            displacement: &problem.displacement,
            velocity: &problem.velocity,
        };
        instant::initial_states(problem, &mut states, start);
        let mut equations = Equations::new(problem, Layout::new(problem));
        equations.take_states(&states);
        let layout = equations.layout.clone();
        let mut numbers = vec![0.0; layout.size()];
        let modes = layout.modes;
        numbers[..modes].copy_from_slice(&problem.displacement);
        numbers[modes..2 * modes].copy_from_slice(&problem.velocity);
        for (law, state) in states.iter().enumerate() {
            layout.remember(law, *state, &mut numbers);
        }
        Self {
            problem,
            pair,
            control: Control::new(tolerances, first_step(problem), &numbers, &layout),
            stepper: Stepper::new(pair, numbers),
            watch: Watch::new(problem, pair.degree()),
            states,
            time: 0.0,
            h: first_step(problem),
            longest: longest_step(problem),
            record: PolynomialRecord::new(layout, pair.degree()),
            events: Vec::new(),
            at_once: 0,
            equations,
        }
    }

    fn advance(&mut self, observer: Observer<'_>) -> Result<()> {
        let duration = self.problem.duration;
        while self.time < duration {
            // Loads may change their course at a knot.
            let limit = self.equations.loads.turn(self.time).min(duration);
            self.stepper.start(self.time, &mut self.equations);
            while self.time < limit {
                if self
                    .record
                    .steps()
                    .is_multiple_of(STEPS_BETWEEN_OBSERVATIONS)
                {
                    observe(observer, self.time)?;
                }
                let h = self.good_step(limit)?;
                self.finish(h, limit)?;
            }
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
            self.stepper
                .attempt(self.pair, self.time, h, &mut self.equations);
            self.check_answers()?;
            let Stepper { stages, end, .. } = &self.stepper;
            let layout = &self.equations.layout;
            let equations = (self.problem, layout);
            let error = (self.control).error(self.pair, h, stages, end, equations);
            if error <= 1.0 {
                self.h = self.control.accept(self.pair, h, error, &self.stepper.end);
                return Ok(h);
            }
            h = self.control.reject(self.pair, h, error);
            if h < SMALLEST_STEP * self.time.max(left) {
                return Err(Error::SmallStep {
                    time: self.time,
                    step: h,
                });
            }
        }
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

    /// Keeps a step up to the first switch in it, and switches.
    fn finish(&mut self, h: f64, limit: f64) -> Result<()> {
        self.stepper
            .continue_inside(self.pair, self.time, h, &mut self.equations);
        let dense = self.stepper.dense();
        let step = Step {
            time: self.time,
            h,
            dense,
        };
        let Equations { layout, loads, .. } = &self.equations;
        let crossing = (self.watch).first(self.problem, &self.states, layout, loads, step);
        let theta = crossing.map_or(1.0, |crossing| crossing.theta);
        let after = match crossing {
            None if h == limit - self.time => limit,
            _ => self.time + theta * h,
        };
        if after > self.time {
            self.record.count_step();
            self.record.add(self.time, h, after, dense, &self.states)?;
            self.at_once = 0;
        }
        self.time = after;
        match crossing {
            None => self.stepper.go_on(),
            Some(crossing) => {
                self.stepper.stop_at(theta);
                self.switch(crossing)?;
                self.stepper.start(self.time, &mut self.equations);
            }
        }
        Ok(())
    }

    /// Switches a law whose guard has reached zero.
    fn switch(&mut self, crossing: Crossing) -> Result<()> {
        let (problem, law) = (self.problem, crossing.law);
        self.at_once += 1;
        if self.at_once > MOST_SWITCHES_AT_ONCE * problem.laws.len() {
            return Err(Error::EndlessSwitching { time: self.time });
        }
        let layout = &self.equations.layout;
        let numbers = &mut self.stepper.start;
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
        let [position, _] = problem.local(law, self.time, displacement, velocity);
        numbers[layout.dissipated(law)] += which.switch_loss(before, after, &position);
        layout.remember(law, after, numbers);
        self.events.push(Event {
            time: self.time,
            law,
            guard: which.guard(before, crossing.guard).name,
            before,
            after,
        });
        self.states[law] = after;
        self.equations.take_states(&self.states);
        Ok(())
    }
}

/// By how much the accelerations of the equations and of the polynomial that a switch was found on
/// differ: what is smaller counts as zero where the law decides how it goes on.
fn doubt(motion: &LocalMotion, found: &Local<f64>) -> f64 {
    let both = motion.derivatives[2].iter().zip(found);
    both.map(|(a, b)| 2.0 * (a - b).abs()).sum()
}

/// A step that turns the highest frequency of the structure and of the loads by little.
fn first_step<L: Law>(problem: &Problem<L>) -> f64 {
    let loads = problem.forcing.harmonics().iter().map(|h| h.omega);
    let fastest = loads.fold(problem.system.highest_frequency(), f64::max);
    (FIRST_TURN / fastest).min(problem.duration)
}
