//! Local laws: small automata that act on the structure at a few points.
//!
//! A law sees the structure through local coordinates, each a row that projects modal
//! displacements. In each of its states it says its force, its stored energy, what it
//! dissipates, and its guards: functions that stay positive while the state lasts. A state may
//! declare itself piecewise linear by handing over a [`Piece`]; the exact method needs nothing
//! else. A law with smooth states says that it has some, and the adaptive methods take it; its
//! memory may follow rate equations, as plasticity and dampers in a row with springs do.

mod affine;
mod any;
mod buckling_stop;
mod cracked_rotor;
mod damper;
mod force_relation;
mod formula;
mod friction_stop;
mod hardening_spring;
mod hertz_stop;
mod outside_program;
mod polyline;
mod rigid_stop;
mod rubbing;
mod seismic_device;
mod shaped_stop;
mod spring;
mod state;
mod stop;
mod user_law;
mod zener_damper;

pub use affine::{Affine, Power};
pub use any::AnyLaw;
pub use buckling_stop::{Buckling, BucklingStop};
pub use cracked_rotor::{CrackedRotor, Periodic};
pub use damper::Damper;
pub use force_relation::ForceRelation;
pub use formula::{Binary, Formula, Operation, Sided, Smooth};
pub use friction_stop::{Friction, FrictionStop, SlidingRule};
pub use hardening_spring::{Hardening, HardeningSpring};
pub use hertz_stop::HertzStop;
pub use outside_program::{OutsideProgram, Program};
pub use rigid_stop::RigidStop;
pub use seismic_device::{Device, SeismicDevice};
pub use shaped_stop::ShapedStop;
pub use spring::Spring;
pub use state::{LocalMotion, State};
pub use stop::Stop;
pub use user_law::{Answers, Question, Slopes, UserLaw};
pub use zener_damper::{Zener, ZenerDamper};

use crate::number::Number;
use std::borrow::Cow;

/// The most local coordinates that a law can have (normal and two tangential ones).
pub const COORDINATES: usize = 3;

/// Local coordinates or forces; those beyond a law's rows are zero.
pub type Local<T> = [T; COORDINATES];

/// A linear state: force = constant - stiffness x - damping x', in local coordinates.
///
/// Stiffness and damping depend on the state's number alone, the constant on its memory too.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// Force at the origin at rest, in N.
    pub constant: Local<f64>,
    /// Stiffness matrix, in N/m.
    pub stiffness: [Local<f64>; COORDINATES],
    /// Damping matrix, in N s/m.
    pub damping: [Local<f64>; COORDINATES],
}

impl Piece {
    /// No force at all.
    pub const FREE: Self = Self {
        constant: [0.0; COORDINATES],
        stiffness: [[0.0; COORDINATES]; COORDINATES],
        damping: [[0.0; COORDINATES]; COORDINATES],
    };

    /// Whether this state acts on the structure.
    pub fn acts(&self) -> bool {
        *self != Self::FREE
    }

    /// The force, in N.
    #[inline(always)]
    pub fn force<T: Number>(&self, position: &Local<T>, velocity: &Local<T>) -> Local<T> {
        let mut force = self.constant.map(T::of);
        for (i, force) in force.iter_mut().enumerate() {
            for j in 0..COORDINATES {
                *force -= T::of(self.stiffness[i][j]) * position[j];
                *force -= T::of(self.damping[i][j]) * velocity[j];
            }
        }
        force
    }

    /// Whether there may be a force along a coordinate.
    #[inline(always)]
    pub fn acts_along(&self, coordinate: usize) -> bool {
        self.constant[coordinate] != 0.0
            || self.stiffness[coordinate] != [0.0; COORDINATES]
            || self.damping[coordinate] != [0.0; COORDINATES]
    }

    /// Whether the force along a coordinate depends on that coordinate alone.
    #[inline(always)]
    pub fn is_own(&self, coordinate: usize) -> bool {
        (0..COORDINATES).all(|other| {
            other == coordinate
                || self.stiffness[coordinate][other] == 0.0
                    && self.damping[coordinate][other] == 0.0
        })
    }
}

/// A local coordinate that a state holds where it is, by whatever reaction that takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constraint {
    /// Which of the law's coordinates.
    pub coordinate: usize,
    /// Where it is held, in m.
    pub position: f64,
}

/// A function of the local motion that is positive while a state lasts.
///
/// Affine guards are all that piecewise-linear laws need; their derivatives and bounds follow
/// from those of the local coordinates. Curved ones (circle, friction cone) are made of these by
/// [`Law::guard_value`], with derivatives and bounds by the arithmetic of enclosures.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Guard {
    /// Name for the list of events.
    pub name: &'static str,
    /// Its value.
    pub function: Affine,
}

impl Guard {
    /// One that stays positive.
    pub const NEVER: Self = Self {
        name: "never",
        function: Affine {
            constant: 1.0,
            ..Affine::ZERO
        },
    };
}

/// A local nonlinearity.
pub trait Law: Clone + Send + Sync {
    /// Whether states have a memory that must be kept. A law whose memory is always zero says no.
    const REMEMBERS: bool = true;

    /// The rows that project modal displacements to local coordinates, each of one entry a mode.
    fn rows(&self) -> &[Vec<f64>];

    /// The name of a state.
    fn state_name(&self, state: State) -> Cow<'static, str>;

    /// The state at the start of a run, from the local motion while the law does not act; `acting`
    /// tells the motion that follows from one of its states.
    fn initial_state(&self, motion: &LocalMotion, acting: impl Fn(State) -> LocalMotion) -> State;

    /// Whether position and velocity decide the state at t = 0, whatever the derivatives beyond
    /// them, which `motion` leaves out.
    fn starts_by_velocity(&self, _motion: &LocalMotion) -> bool {
        false
    }

    /// The state that a fixed-step scheme sees at one sampled instant, after the one that it saw
    /// at the step before; before the first step that is [`State::FIRST`].
    fn sampled_state(&self, previous: State, position: &Local<f64>, velocity: &Local<f64>)
    -> State;

    /// Force on the structure in local coordinates, in N.
    fn force<T: Number>(&self, state: State, position: &Local<T>, velocity: &Local<T>) -> Local<T>;

    /// A force of a state along the normal of its contact and across it, for laws whose coordinates
    /// do not run so.
    #[inline(always)]
    fn on_contact<T: Number>(
        &self,
        _state: State,
        _position: &Local<T>,
        force: &Local<T>,
    ) -> Local<T> {
        *force
    }

    /// The plain stop that the law is, if it is one: what is done at each of many steps has code
    /// of its own for them.
    fn as_stop(&self) -> Option<&Stop> {
        None
    }

    /// Whether every state is linear, so that the exact method takes the law.
    fn is_piecewise_linear(&self) -> bool {
        true
    }

    /// Whether the memory of states follows rate equations. States are then handed to the law with
    /// the memory of the instant; of guards only [`Law::flowing_guard`] sees how it goes on.
    fn flows(&self) -> bool {
        false
    }

    /// The rates of a memory that flows, per s.
    fn memory_rates(
        &self,
        _state: State,
        _position: &Local<f64>,
        _velocity: &Local<f64>,
    ) -> [f64; 2] {
        [0.0; 2]
    }

    /// How large a memory that flows may be in a motion as large as this: a small part of it is no
    /// error. By default a length like the first coordinate.
    fn memory_sizes(&self, position: &Local<f64>) -> [f64; 2] {
        [position[0].abs(); 2]
    }

    /// The internal variables at an instant, in the order in which the law's users know them: what
    /// it remembers, brought up to the motion. Not a number where there is none, as without contact.
    fn internal_variables(
        &self,
        _state: State,
        _position: &Local<f64>,
        _velocity: &Local<f64>,
    ) -> [f64; 2] {
        [f64::NAN; 2]
    }

    /// Whether somebody outside who is asked for forces could not tell one: nothing that was
    /// computed since is of use.
    fn has_failed(&self) -> bool {
        false
    }

    /// The state behind an instant at which velocities jump from one to the other: the same where
    /// guards that are passed by say all of it.
    fn after_jump(&self, state: State, _position: &Local<f64>, _: [&Local<f64>; 2]) -> State {
        state
    }

    /// Whether its states must be sampled once a step, in order, as those of a program outside or
    /// of a rule that is defined from step to step.
    fn is_stepped(&self) -> bool {
        false
    }

    /// The state's matrices where it is linear.
    fn piece(&self, state: State) -> Option<Piece>;

    /// Restitution of a law at whose zero distance the velocities jump. Such a law has the states
    /// and the guard of [`RigidStop`]; `None` for laws that make forces.
    fn restitution(&self) -> Option<f64> {
        None
    }

    /// The part of the motion below which rebounds of a law with restitution end in rest.
    fn resolution(&self) -> f64 {
        0.0
    }

    /// Coefficient of friction of a law with restitution that has a second coordinate along its
    /// obstacle.
    fn rigid_friction(&self) -> f64 {
        0.0
    }

    /// What a state holds where it is; it lasts until the reaction reaches zero.
    fn constraint(&self, _state: State) -> Option<Constraint> {
        None
    }

    /// How many guards a state has. A law of one state has none, and nothing of what follows to say
    /// of switches.
    fn guard_count(&self, _state: State) -> usize {
        0
    }

    /// One of a state's guards.
    fn guard(&self, _state: State, _index: usize) -> Guard {
        Guard::NEVER
    }

    /// Whether a guard is curved: no affine function of the local motion. Its value is then
    /// [`Law::guard_value`], and [`Guard::function`] is not looked at.
    #[inline(always)]
    fn is_curved(&self, _state: State, _index: usize) -> bool {
        false
    }

    /// The value of a guard. From enclosures of the local motion on a cell of time it makes one of
    /// the guard, which is how the exact method sees curved guards.
    fn guard_value<T: Number>(
        &self,
        state: State,
        index: usize,
        position: &Local<T>,
        velocity: &Local<T>,
    ) -> T {
        self.guard(state, index).function.at(position, velocity)
    }

    /// The value of a guard that depends on a memory that flows, in the adaptive methods alone.
    fn flowing_guard<T: Number>(
        &self,
        state: State,
        index: usize,
        position: &Local<T>,
        velocity: &Local<T>,
        _memory: &[T; 2],
    ) -> T {
        self.guard_value(state, index, position, velocity)
    }

    /// The state that follows when a guard has reached zero. `acting` tells the local motion at
    /// that instant if the law goes on in a state, at some cost: accelerations follow its force.
    fn next_state(
        &self,
        state: State,
        _guard: usize,
        _acting: impl Fn(State) -> LocalMotion,
    ) -> State {
        state
    }

    /// Energy stored, in J.
    fn stored<T: Number>(&self, state: State, position: &Local<T>) -> T;

    /// Power dissipated in a linear state, in W; smooth ones have [`Law::dissipated_power`].
    fn dissipation(&self, _state: State) -> Power {
        Power::NONE
    }

    /// Power dissipated in any state, in W.
    #[inline(always)]
    fn dissipated_power<T: Number>(
        &self,
        state: State,
        position: &Local<T>,
        velocity: &Local<T>,
    ) -> T {
        self.dissipation(state).at(position, velocity)
    }

    /// Energy dissipated at the instant of a switch, in J.
    fn switch_loss(&self, _before: State, _after: State, _position: &Local<f64>) -> f64 {
        0.0
    }

    /// Distance from the obstacle and its rate, for laws that have one.
    fn distance<T: Number>(&self, position: &Local<T>, velocity: &Local<T>) -> (T, T);

    /// Whether a state counts as contact in the table of impacts.
    fn in_contact(&self, _state: State) -> bool {
        false
    }

    /// The stiffest linear state, for the stability limits of fixed-step schemes.
    fn stiffest(&self) -> Piece;
}

/// Power of a local force at a local velocity, in W.
pub(crate) fn power(force: &Local<f64>, velocity: &Local<f64>) -> f64 {
    force.iter().zip(velocity).map(|(f, v)| f * v).sum()
}

/// Projects modal to local coordinates.
#[inline(always)]
pub fn project<L: Law>(law: &L, modal: &[f64]) -> Local<f64> {
    let mut local = [0.0; COORDINATES];
    for (coordinate, row) in local.iter_mut().zip(law.rows()) {
        *coordinate = row.iter().zip(modal).map(|(r, q)| r * q).sum();
    }
    local
}
