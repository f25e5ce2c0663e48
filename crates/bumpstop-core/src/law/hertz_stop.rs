//! A unilateral stop whose force is a power of its depth, such as that of elastic spheres.
//!
//! With depth e = -d, the distance's other sign, the force is `F = k e^n (1 + lambda e')` while e
//! is positive and the bracket too, and zero else. Hertz's theory has n = 3/2 for bodies that touch
//! in a point. The damping is that of K. H. Hunt, F. R. E. Crossley, Coefficient of restitution
//! interpreted as damping in vibroimpact, Journal of Applied Mechanics 42, 440-445, 1975: it starts
//! at zero with the contact, so that the force does not jump.

use super::{Affine, Guard, Law, Local, LocalMotion, Piece, State};
use crate::error::{Error, Result, check_finite};
use crate::number::Number;
use crate::obstacle::Plane;
use std::borrow::Cow;

/// A power-law contact on a plane, with Hunt and Crossley's damping.
#[derive(Debug, Clone, PartialEq)]
pub struct HertzStop {
    rows: [Vec<f64>; 1],
    obstacle: Plane,
    stiffness: f64,
    exponent: f64,
    hunt_crossley: f64,
}

impl HertzStop {
    /// No contact.
    pub const OPEN: State = State::plain(0);
    /// The stop pushes.
    pub const CLOSED: State = State::plain(1);
    /// Inside the obstacle, but it relaxes more slowly than the structure leaves: no force.
    pub const RELEASED: State = State::plain(2);

    /// A stop whose distance is `gap + row . q`, with stiffness in N/m^exponent and the damping
    /// coefficient lambda in s/m.
    ///
    /// # Errors
    /// When a number is not finite, the stiffness not positive, the exponent below one or the
    /// damping negative.
    pub fn new(
        row: Vec<f64>,
        gap: f64,
        stiffness: f64,
        exponent: f64,
        hunt_crossley: f64,
    ) -> Result<Self> {
        check_finite("the stop's row", &row)?;
        check_finite("the stop's gap", &[gap])?;
        check_finite("the stop's stiffness", &[stiffness])?;
        check_finite("the stop's exponent", &[exponent])?;
        check_finite("the stop's damping", &[hunt_crossley])?;
        if stiffness <= 0.0 {
            return Err(Error::NotPositive {
                what: "the stop's stiffness",
                value: stiffness,
            });
        }
        for (what, value) in [
            ("the stop's exponent less one", exponent - 1.0),
            ("the stop's damping", hunt_crossley),
        ] {
            if value < 0.0 {
                return Err(Error::Negative { what, value });
            }
        }
        Ok(Self {
            rows: [row],
            obstacle: Plane { gap },
            stiffness,
            exponent,
            hunt_crossley,
        })
    }

    /// How deep the structure is inside the obstacle, zero outside.
    fn depth<T: Number>(&self, position: &Local<T>) -> T {
        (-self.obstacle.distance(position)).max(T::of(0.0))
    }

    /// The force without damping. Where it is linear it goes on beyond the surface: steps that
    /// find there that the contact opens see no kink.
    fn elastic<T: Number>(&self, position: &Local<T>) -> T {
        let stiffness = T::of(self.stiffness);
        if self.exponent == 1.0 {
            return -stiffness * self.obstacle.distance(position);
        }
        stiffness * self.depth(position).power(self.exponent)
    }

    /// `1 + lambda e'`, which the elastic force is multiplied by.
    fn bracket<T: Number>(&self, velocity: &Local<T>) -> T {
        T::of(1.0) - T::of(self.hunt_crossley) * self.obstacle.rate(velocity)
    }

    fn distance_guard(&self, name: &'static str, sign: f64) -> Guard {
        let mut function = Affine::coordinate(0);
        function.constant = self.obstacle.gap;
        Guard {
            name,
            function: function.times(sign),
        }
    }

    fn bracket_guard(&self, name: &'static str, sign: f64) -> Guard {
        let mut function = Affine::rate(0).times(-self.hunt_crossley);
        function.constant = 1.0;
        Guard {
            name,
            function: function.times(sign),
        }
    }

    fn stored_inside<T: Number>(&self, position: &Local<T>) -> T {
        let power = self.exponent + 1.0;
        T::of(self.stiffness / power) * self.depth(position).power(power)
    }
}

impl Law for HertzStop {
    const REMEMBERS: bool = false;

    fn rows(&self) -> &[Vec<f64>] {
        &self.rows
    }

    fn state_name(&self, state: State) -> Cow<'static, str> {
        ["open", "closed", "released"][state.number as usize].into()
    }

    fn initial_state(&self, motion: &LocalMotion, _acting: impl Fn(State) -> LocalMotion) -> State {
        let [position, velocity, acceleration, jerk] = &motion.derivatives;
        let distance = self.obstacle.distance(position);
        let derivatives = [distance, velocity[0], acceleration[0], jerk[0]];
        let mut known = derivatives.iter().zip(&motion.zero);
        match known.find(|(value, zero)| value.abs() > **zero) {
            Some((value, _)) if *value < 0.0 => {}
            _ => return Self::OPEN,
        }
        if self.bracket(velocity) < 0.0 {
            Self::RELEASED
        } else {
            Self::CLOSED
        }
    }

    fn sampled_state(
        &self,
        _previous: State,
        position: &Local<f64>,
        velocity: &Local<f64>,
    ) -> State {
        if self.obstacle.distance(position) > 0.0 {
            Self::OPEN
        } else if self.bracket(velocity) >= 0.0 {
            Self::CLOSED
        } else {
            Self::RELEASED
        }
    }

    fn force<T: Number>(&self, state: State, position: &Local<T>, velocity: &Local<T>) -> Local<T> {
        let zero = T::of(0.0);
        let normal = match state {
            Self::CLOSED => self.elastic(position) * self.bracket(velocity).max(zero),
            _ => zero,
        };
        [normal, zero, zero]
    }

    fn is_piecewise_linear(&self) -> bool {
        false
    }

    fn piece(&self, state: State) -> Option<Piece> {
        (state != Self::CLOSED).then_some(Piece::FREE)
    }

    fn guard_count(&self, state: State) -> usize {
        let damped = self.hunt_crossley > 0.0;
        if state == Self::OPEN || !damped { 1 } else { 2 }
    }

    fn guard(&self, state: State, index: usize) -> Guard {
        match (state, index) {
            (Self::OPEN, _) => self.distance_guard("closing", 1.0),
            (_, 0) => self.distance_guard("opening", -1.0),
            (Self::CLOSED, _) => self.bracket_guard("release", 1.0),
            _ => self.bracket_guard("hold", -1.0),
        }
    }

    fn next_state(
        &self,
        state: State,
        guard: usize,
        _acting: impl Fn(State) -> LocalMotion,
    ) -> State {
        match (state, guard) {
            (Self::CLOSED, 1) => Self::RELEASED,
            (Self::CLOSED | Self::RELEASED, 0) => Self::OPEN,
            _ => Self::CLOSED,
        }
    }

    fn stored<T: Number>(&self, state: State, position: &Local<T>) -> T {
        match state {
            Self::CLOSED => self.stored_inside(position),
            _ => T::of(0.0),
        }
    }

    fn dissipated_power<T: Number>(
        &self,
        state: State,
        position: &Local<T>,
        velocity: &Local<T>,
    ) -> T {
        let rate = self.obstacle.rate(velocity);
        match state {
            Self::CLOSED => self.elastic(position) * T::of(self.hunt_crossley) * rate * rate,
            _ => T::of(0.0),
        }
    }

    fn switch_loss(&self, before: State, after: State, position: &Local<f64>) -> f64 {
        match (before, after) {
            (Self::CLOSED, Self::RELEASED) => self.stored_inside(position),
            (Self::RELEASED, Self::CLOSED) => -self.stored_inside(position),
            _ => 0.0,
        }
    }

    fn distance<T: Number>(&self, position: &Local<T>, velocity: &Local<T>) -> (T, T) {
        (
            self.obstacle.distance(position),
            self.obstacle.rate(velocity),
        )
    }

    fn in_contact(&self, state: State) -> bool {
        state != Self::OPEN
    }

    /// No state is linear: there is no stiffest.
    fn stiffest(&self) -> Piece {
        Piece::FREE
    }
}
