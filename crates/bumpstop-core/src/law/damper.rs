//! A multilinear damper: a force that follows straight segments of the speed.
//!
//! With the speed v of its elongation the force on the structure is `-f(v)`, where f is continuous
//! and has one slope a segment. The segments are the states.

use super::polyline::{Names, Polyline};
use super::{Affine, Guard, Law, Local, LocalMotion, Piece, Power, State};
use crate::error::{Result, check_finite};
use crate::number::Number;
use std::borrow::Cow;

/// A damper whose constant changes at given speeds.
#[derive(Debug, Clone, PartialEq)]
pub struct Damper {
    rows: [Vec<f64>; 1],
    force: Polyline,
}

impl Damper {
    /// A damper of elongation `row . q` whose constant is `damping[i]` between the speeds
    /// `breaks[i-1]` and `breaks[i]`, in N s/m, with the force `offset` at rest, in N.
    ///
    /// # Errors
    /// When a number is not finite, the breaks do not increase, or there is not one damping
    /// constant more than breaks.
    pub fn new(row: Vec<f64>, breaks: Vec<f64>, damping: &[f64], offset: f64) -> Result<Self> {
        let names = Names {
            breaks: "the damper's breaks",
            slopes: "the damper's damping",
            distance: "the distance between the damper's breaks",
        };
        check_finite("the damper's row", &row)?;
        check_finite("the damper's force at rest", &[offset])?;
        Ok(Self {
            rows: [row],
            force: Polyline::new(breaks, damping, offset, &names)?,
        })
    }

    /// Whether a guard looks at the lower end of its segment.
    fn is_lower(&self, state: State, guard: usize) -> bool {
        state.number > 0 && guard == 0
    }

    /// What it resists with along the line of a state's segment.
    fn resistance(&self, state: State) -> Affine {
        let segment = self.force.segment(state.number);
        let mut force = Affine::rate(0).times(segment.slope);
        force.constant = segment.value_at(0.0);
        force
    }
}

impl Law for Damper {
    const REMEMBERS: bool = false;

    fn rows(&self) -> &[Vec<f64>] {
        &self.rows
    }

    fn state_name(&self, state: State) -> Cow<'static, str> {
        format!("segment {}", state.number + 1).into()
    }

    fn initial_state(&self, motion: &LocalMotion, _acting: impl Fn(State) -> LocalMotion) -> State {
        let speed = std::array::from_fn::<_, 3, _>(|order| {
            (motion.derivatives[order + 1][0], motion.zero[order + 1])
        });
        State::plain(self.force.number_around(&speed))
    }

    #[inline(always)]
    fn sampled_state(
        &self,
        _previous: State,
        _position: &Local<f64>,
        velocity: &Local<f64>,
    ) -> State {
        State::plain(self.force.number_at(velocity[0]))
    }

    #[inline(always)]
    fn force<T: Number>(&self, state: State, _: &Local<T>, velocity: &Local<T>) -> Local<T> {
        let zero = T::of(0.0);
        let segment = self.force.segment(state.number);
        [-segment.value_at(velocity[0]), zero, zero]
    }

    fn piece(&self, state: State) -> Option<Piece> {
        let segment = self.force.segment(state.number);
        let mut piece = Piece::FREE;
        piece.constant[0] = -segment.value_at(0.0);
        piece.damping[0][0] = segment.slope;
        Some(piece)
    }

    fn guard_count(&self, state: State) -> usize {
        let number = state.number as usize;
        usize::from(number > 0) + usize::from(number < self.force.breaks().len())
    }

    fn guard(&self, state: State, index: usize) -> Guard {
        let number = state.number as usize;
        let mut function = Affine::rate(0);
        if self.is_lower(state, index) {
            function.constant = -self.force.breaks()[number - 1];
            return Guard {
                name: "lower end",
                function,
            };
        }
        function.constant = -self.force.breaks()[number];
        Guard {
            name: "upper end",
            function: function.times(-1.0),
        }
    }

    fn next_state(
        &self,
        state: State,
        guard: usize,
        _acting: impl Fn(State) -> LocalMotion,
    ) -> State {
        State::plain(if self.is_lower(state, guard) {
            state.number - 1
        } else {
            state.number + 1
        })
    }

    fn stored<T: Number>(&self, _state: State, _position: &Local<T>) -> T {
        T::of(0.0)
    }

    fn dissipation(&self, state: State) -> Power {
        Power::of(&[(self.resistance(state), Affine::rate(0))])
    }

    #[inline(always)]
    fn distance<T: Number>(&self, position: &Local<T>, velocity: &Local<T>) -> (T, T) {
        (position[0], velocity[0])
    }

    fn stiffest(&self) -> Piece {
        let mut piece = Piece::FREE;
        piece.damping[0][0] = self.force.steepest();
        piece
    }
}
