//! A rigid stop: an obstacle that does not give way, with a coefficient of restitution.
//!
//! While it is open it does nothing. At an impact the velocities jump; a structure that rests
//! against it is held there by a reaction, which is no function of the local motion: both are the
//! method's work, from [`Law::restitution`] and [`Law::constraint`]. So is friction along it, whose
//! mean over a step a resting state remembers.

use super::{Affine, Constraint, Guard, Law, Local, LocalMotion, Piece, Power, State};
use crate::error::{Error, Result, check_finite, check_length};
use crate::number::Number;
use crate::obstacle::Plane;
use std::borrow::Cow;

/// A rigid plane.
#[derive(Debug, Clone, PartialEq)]
pub struct RigidStop {
    /// Along the normal, and along the obstacle where it rubs.
    rows: Vec<Vec<f64>>,
    obstacle: Plane,
    restitution: f64,
    friction: f64,
    resolution: f64,
}

/// Rebounds lower than this part of the motion are not followed, unless a stop says otherwise.
const RESOLUTION: f64 = 1e-12;

/// The finest resolution: distances below it are lost in rounding.
const FINEST: f64 = 1e-13;

impl RigidStop {
    /// No contact, or the instant of an impact.
    pub const OPEN: State = State::plain(0);
    /// The structure stays at the obstacle.
    pub const RESTING: State = State::plain(1);

    /// A stop whose distance is `gap + row . q` and which gives back `restitution` of the speed.
    ///
    /// # Errors
    /// When a number is not finite or the restitution not from 0 to 1.
    pub fn new(row: Vec<f64>, gap: f64, restitution: f64) -> Result<Self> {
        check_finite("the stop's row", &row)?;
        check_finite("the stop's gap", &[gap])?;
        if !(0.0..=1.0).contains(&restitution) {
            return Err(Error::Restitution { value: restitution });
        }
        Ok(Self {
            rows: vec![row],
            obstacle: Plane { gap },
            restitution,
            friction: 0.0,
            resolution: RESOLUTION,
        })
    }

    /// The same, which rubs along the coordinate `tangent . q` with a coefficient of friction.
    ///
    /// # Errors
    /// When a number is not finite, the coefficient negative, or the tangent of another length.
    pub fn with_friction(mut self, tangent: Vec<f64>, friction: f64) -> Result<Self> {
        check_length("the sliding direction", &tangent, self.rows[0].len())?;
        check_finite("the sliding direction", &tangent)?;
        check_finite("the coefficient of friction", &[friction])?;
        if friction < 0.0 {
            return Err(Error::Negative {
                what: "the coefficient of friction",
                value: friction,
            });
        }
        self.rows.push(tangent);
        self.friction = friction;
        Ok(self)
    }

    /// Resting, with the mean force of friction along the obstacle in the last step, in N.
    pub(crate) fn resting(rubbing: f64) -> State {
        State::with_memory(Self::RESTING.number, [rubbing, 0.0])
    }

    /// The same, at which rebounds lower than another part of the motion end in rest.
    ///
    /// # Errors
    /// When the resolution is not from 1e-13 to 1.
    pub fn with_resolution(mut self, resolution: f64) -> Result<Self> {
        if !(FINEST..=1.0).contains(&resolution) {
            return Err(Error::Resolution { value: resolution });
        }
        self.resolution = resolution;
        Ok(self)
    }
}

impl Law for RigidStop {
    const REMEMBERS: bool = false;

    fn rows(&self) -> &[Vec<f64>] {
        &self.rows
    }

    fn state_name(&self, state: State) -> Cow<'static, str> {
        ["open", "resting"][state.number as usize].into()
    }

    fn restitution(&self) -> Option<f64> {
        Some(self.restitution)
    }

    fn resolution(&self) -> f64 {
        self.resolution
    }

    fn rigid_friction(&self) -> f64 {
        self.friction
    }

    fn constraint(&self, state: State) -> Option<Constraint> {
        self.in_contact(state).then_some(Constraint {
            coordinate: 0,
            position: -self.obstacle.gap,
        })
    }

    fn initial_state(
        &self,
        _motion: &LocalMotion,
        _acting: impl Fn(State) -> LocalMotion,
    ) -> State {
        Self::OPEN
    }

    #[inline(always)]
    fn sampled_state(
        &self,
        _previous: State,
        _position: &Local<f64>,
        _velocity: &Local<f64>,
    ) -> State {
        Self::OPEN
    }

    #[inline(always)]
    fn force<T: Number>(
        &self,
        state: State,
        _position: &Local<T>,
        _velocity: &Local<T>,
    ) -> Local<T> {
        [T::of(0.0), T::of(state.memory[0]), T::of(0.0)]
    }

    fn piece(&self, _state: State) -> Option<Piece> {
        Some(Piece::FREE)
    }

    fn guard_count(&self, state: State) -> usize {
        usize::from(state == Self::OPEN)
    }

    fn guard(&self, _state: State, _index: usize) -> Guard {
        let mut function = Affine::coordinate(0);
        function.constant = self.obstacle.gap;
        Guard {
            name: "impact",
            function,
        }
    }

    fn next_state(
        &self,
        state: State,
        _guard: usize,
        _acting: impl Fn(State) -> LocalMotion,
    ) -> State {
        state
    }

    #[inline(always)]
    fn stored<T: Number>(&self, _state: State, _position: &Local<T>) -> T {
        T::of(0.0)
    }

    fn dissipation(&self, _state: State) -> Power {
        Power::NONE
    }

    fn switch_loss(&self, _before: State, _after: State, _position: &Local<f64>) -> f64 {
        0.0
    }

    #[inline(always)]
    fn distance<T: Number>(&self, position: &Local<T>, velocity: &Local<T>) -> (T, T) {
        (
            self.obstacle.distance(position),
            self.obstacle.rate(velocity),
        )
    }

    fn in_contact(&self, state: State) -> bool {
        state.number == Self::RESTING.number
    }

    fn stiffest(&self) -> Piece {
        Piece::FREE
    }
}
