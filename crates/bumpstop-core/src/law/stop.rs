//! A unilateral stop: a spring and a damper behind an obstacle.
//!
//! With distance d and its rate d', the force is `F = max(0, -k d - c d')` while d < 0 and zero
//! else: it pushes, never pulls. With a damper the force reaches zero before the gap opens; the
//! stop is then released, and takes hold again if `-k d - c d'` becomes positive before the gap
//! has opened. The spring energy left at release is dissipated.

use super::{Affine, Guard, Law, Local, LocalMotion, Piece, Power, State};
use crate::error::{Error, Result, check_finite};
use crate::number::Number;
use crate::obstacle::Plane;
use std::borrow::Cow;

/// A unilateral spring and damper on a plane.
#[derive(Debug, Clone, PartialEq)]
pub struct Stop {
    rows: [Vec<f64>; 1],
    obstacle: Plane,
    stiffness: f64,
    damping: f64,
}

impl Stop {
    /// No contact.
    pub const OPEN: State = State::plain(0);
    /// The stop pushes.
    pub const CLOSED: State = State::plain(1);
    /// Inside the obstacle, but the damper holds the spring back: no force.
    pub const RELEASED: State = State::plain(2);

    /// A stop whose distance is `gap + row . q`, with stiffness in N/m and damping in N s/m.
    ///
    /// # Errors
    /// When a number is not finite, the stiffness not positive or the damping negative.
    pub fn new(row: Vec<f64>, gap: f64, stiffness: f64, damping: f64) -> Result<Self> {
        check_finite("the stop's row", &row)?;
        let mut stop = Self {
            rows: [row],
            obstacle: Plane { gap: 0.0 },
            stiffness: 0.0,
            damping: 0.0,
        };
        stop.set_gap(gap)?;
        stop.set_stiffness(stiffness)?;
        stop.set_damping(damping)?;
        Ok(stop)
    }

    /// Takes another gap, in m.
    ///
    /// # Errors
    /// When it is not finite.
    pub fn set_gap(&mut self, gap: f64) -> Result<()> {
        check_finite("the stop's gap", &[gap])?;
        self.obstacle.gap = gap;
        Ok(())
    }

    /// Takes another stiffness, in N/m.
    ///
    /// # Errors
    /// When it is not finite and positive.
    pub fn set_stiffness(&mut self, stiffness: f64) -> Result<()> {
        check_finite("the stop's stiffness", &[stiffness])?;
        if stiffness <= 0.0 {
            return Err(Error::NotPositive {
                what: "the stop's stiffness",
                value: stiffness,
            });
        }
        self.stiffness = stiffness;
        Ok(())
    }

    /// Takes another damping, in N s/m.
    ///
    /// # Errors
    /// When it is not finite or negative.
    pub fn set_damping(&mut self, damping: f64) -> Result<()> {
        check_finite("the stop's damping", &[damping])?;
        if damping < 0.0 {
            return Err(Error::Negative {
                what: "the stop's damping",
                value: damping,
            });
        }
        self.damping = damping;
        Ok(())
    }

    /// Stiffness in N/m.
    pub fn stiffness(&self) -> f64 {
        self.stiffness
    }

    /// Damping in N s/m.
    pub fn damping(&self) -> f64 {
        self.damping
    }

    /// Distance at rest, in m.
    pub fn gap(&self) -> f64 {
        self.obstacle.gap
    }

    /// `-k d - c d'`, the force before it is cut off at zero.
    #[inline(always)]
    fn push<T: Number>(&self, position: &Local<T>, velocity: &Local<T>) -> T {
        let spring = T::of(self.stiffness) * self.obstacle.distance(position);
        if self.damping == 0.0 {
            return -spring;
        }
        only_with_a_damper();
        -(spring + T::of(self.damping) * self.obstacle.rate(velocity))
    }

    /// The rate of [`Self::push`].
    fn push_rate(&self, velocity: &Local<f64>, acceleration: &Local<f64>) -> f64 {
        -(self.stiffness * velocity[0] + self.damping * acceleration[0])
    }

    fn distance_guard(&self, name: &'static str, sign: f64) -> Guard {
        let mut function = Affine::coordinate(0);
        function.constant = self.obstacle.gap;
        Guard {
            name,
            function: function.times(sign),
        }
    }

    /// The push over the stiffness, so that every guard is a length.
    fn push_guard(&self, name: &'static str, sign: f64) -> Guard {
        let mut guard = self.distance_guard(name, -sign);
        guard.function.velocity[0] = -sign * self.damping / self.stiffness;
        guard
    }
}

/// Keeps a branch a branch: the velocity is known later than the position, and a choice between
/// two values would wait for both.
#[cold]
#[inline]
fn only_with_a_damper() {}

/// Whether a state is one of the stop's, which remembers nothing: its number tells.
#[inline(always)]
fn is(state: State, which: State) -> bool {
    state.number == which.number
}

impl Law for Stop {
    const REMEMBERS: bool = false;

    fn rows(&self) -> &[Vec<f64>] {
        &self.rows
    }

    fn state_name(&self, state: State) -> Cow<'static, str> {
        ["open", "closed", "released"][state.number as usize].into()
    }

    fn initial_state(&self, motion: &LocalMotion, _acting: impl Fn(State) -> LocalMotion) -> State {
        let [position, velocity, acceleration, jerk] = &motion.derivatives;
        let zero = &motion.zero;
        let distance = self.obstacle.distance(position);
        let derivatives = [distance, velocity[0], acceleration[0], jerk[0]];
        let decisive = (derivatives.iter().zip(zero)).find(|(value, zero)| value.abs() > **zero);
        match decisive {
            Some((value, _)) if *value < 0.0 => {}
            _ => return Self::OPEN,
        }
        // A force of zero below the wall is about to push or about to pull.
        let push = self.push(position, velocity);
        let pushes = if push.abs() > self.stiffness * zero[0] + self.damping * zero[1] {
            push > 0.0
        } else {
            self.push_rate(velocity, acceleration) > 0.0
        };
        if distance < -zero[0] && !pushes {
            Self::RELEASED
        } else {
            Self::CLOSED
        }
    }

    fn starts_by_velocity(&self, motion: &LocalMotion) -> bool {
        let distance = self.obstacle.distance(motion.position());
        let [at_rest, still, ..] = motion.zero;
        if distance.abs() > at_rest {
            // Only a damper may pull where the stop is pressed in.
            distance > 0.0 || self.damping == 0.0
        } else {
            motion.velocity()[0].abs() > still
        }
    }

    #[inline(always)]
    fn sampled_state(
        &self,
        _previous: State,
        position: &Local<f64>,
        velocity: &Local<f64>,
    ) -> State {
        if self.obstacle.distance(position) > 0.0 {
            Self::OPEN
        } else if self.push(position, velocity) >= 0.0 {
            Self::CLOSED
        } else {
            Self::RELEASED
        }
    }

    #[inline(always)]
    fn force<T: Number>(&self, state: State, position: &Local<T>, velocity: &Local<T>) -> Local<T> {
        let zero = T::of(0.0);
        let normal = if is(state, Self::CLOSED) {
            // Rounding at a switch must not make it pull.
            self.push(position, velocity).max(zero)
        } else {
            zero
        };
        [normal, zero, zero]
    }

    #[inline(always)]
    fn as_stop(&self) -> Option<&Stop> {
        Some(self)
    }

    fn piece(&self, state: State) -> Option<Piece> {
        let mut piece = Piece::FREE;
        if is(state, Self::CLOSED) {
            piece.constant[0] = -self.stiffness * self.obstacle.gap;
            piece.stiffness[0][0] = self.stiffness;
            piece.damping[0][0] = self.damping;
        }
        Some(piece)
    }

    fn guard_count(&self, state: State) -> usize {
        if is(state, Self::RELEASED) { 2 } else { 1 }
    }

    fn guard(&self, state: State, index: usize) -> Guard {
        match (state, index) {
            (Self::OPEN, _) => self.distance_guard("closing", 1.0),
            (Self::CLOSED, _) if self.damping == 0.0 => self.distance_guard("opening", -1.0),
            (Self::CLOSED, _) => self.push_guard("release", 1.0),
            (_, 0) => self.distance_guard("opening", -1.0),
            _ => self.push_guard("hold", -1.0),
        }
    }

    fn next_state(
        &self,
        state: State,
        guard: usize,
        _acting: impl Fn(State) -> LocalMotion,
    ) -> State {
        match (state, guard) {
            (Self::OPEN, _) => Self::CLOSED,
            (Self::CLOSED, _) if self.damping == 0.0 => Self::OPEN,
            (Self::CLOSED, _) => Self::RELEASED,
            (_, 0) => Self::OPEN,
            _ => Self::CLOSED,
        }
    }

    #[inline(always)]
    fn stored<T: Number>(&self, state: State, position: &Local<T>) -> T {
        if is(state, Self::CLOSED) {
            let distance = self.obstacle.distance(position);
            T::of(0.5 * self.stiffness) * distance * distance
        } else {
            T::of(0.0)
        }
    }

    fn dissipation(&self, state: State) -> Power {
        if is(state, Self::CLOSED) {
            Power::of_damper(0, self.damping)
        } else {
            Power::NONE
        }
    }

    fn switch_loss(&self, before: State, after: State, position: &Local<f64>) -> f64 {
        match (before, after) {
            (Self::CLOSED, Self::RELEASED) => self.stored(before, position),
            (Self::RELEASED, Self::CLOSED) => -self.stored(after, position),
            _ => 0.0,
        }
    }

    #[inline(always)]
    fn distance<T: Number>(&self, position: &Local<T>, velocity: &Local<T>) -> (T, T) {
        (
            self.obstacle.distance(position),
            self.obstacle.rate(velocity),
        )
    }

    fn in_contact(&self, state: State) -> bool {
        !is(state, Self::OPEN)
    }

    fn stiffest(&self) -> Piece {
        self.piece(Self::CLOSED).unwrap_or(Piece::FREE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Values that are often zero or within rounding of it.
    fn near_zero() -> impl Strategy<Value = f64> {
        prop_oneof![Just(0.0), -2e-16f64..2e-16, -1.0f64..1.0]
    }

    proptest! {
        #[test]
        fn a_start_told_by_the_velocity_is_that_told_by_all_derivatives(
            [position, velocity, acceleration, jerk] in prop::array::uniform4(near_zero()),
            gap in prop_oneof![Just(0.0), 0.0f64..0.5],
            damping in prop_oneof![Just(0.0), 0.1f64..10.0],
        ) {
            let stop = Stop::new(vec![1.0], gap, 5.0, damping).unwrap();
            let zero = 1e-16;
            let mut early = LocalMotion::of([position, 0.0, 0.0], [velocity, 0.0, 0.0]);
            (early.zero[0], early.zero[1]) = (zero, zero);
            let mut whole = early;
            whole.derivatives[2][0] = acceleration;
            whole.derivatives[3][0] = jerk;
            whole.zero = [zero; 4];
            if stop.starts_by_velocity(&early) {
                let state = stop.initial_state(&whole, |_| whole);
                prop_assert_eq!(stop.initial_state(&early, |_| early), state);
            } else {
                prop_assert!(position + gap <= zero);
            }
        }
    }
}
