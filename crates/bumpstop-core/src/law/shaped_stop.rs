//! A stop on an obstacle of any shape, which may rub in the plane of contact.
//!
//! The first two local coordinates span the plane of the shape, a third one runs along its axis;
//! `origin` is where the structure at rest stands, seen from the obstacle. Normal to the obstacle
//! the force is that of a [`super::Stop`], `F = max(0, -k d - c d')` while d < 0, with the distance
//! of the shape. Along it, around and along the axis, the structure rubs as [`super::rubbing`]
//! tells: the stretch of the spring is the memory and follows a rate equation; it turns with the
//! point of contact, and is forgotten when that opens.
//!
//! In its sector a polygon is a plane. Well within it no sector is looked for, since all of them meet
//! at the origin.

mod guards;

use super::rubbing::{self, Rub};
use super::{Affine, COORDINATES, Friction, Guard, Law, Local, LocalMotion, Piece, State};
use crate::error::{Error, Result, check_finite};
use crate::number::Number;
use crate::obstacle::Shape;
use guards::{NEARING, Watched};
use std::borrow::Cow;

/// A spring and damper behind an obstacle of any shape, with friction or without.
#[derive(Debug, Clone, PartialEq)]
pub struct ShapedStop {
    rows: Vec<Vec<f64>>,
    origin: [f64; 2],
    shape: Shape,
    stiffness: f64,
    damping: f64,
    friction: Option<Friction>,
}

/// No contact; in a polygon also: well within it.
const OPEN: u8 = 0;
/// No contact, in a sector of a polygon.
const NEAR: u8 = 1;
/// Inside the obstacle, but without force.
const RELEASED: u8 = 2;
/// The obstacle pushes and does not rub.
const CLOSED: u8 = 3;
/// It rubs.
const STICK: u8 = 4;
const SLIP: u8 = 5;

/// A sum below this part of the sizes of its terms counts as zero.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// The structure at the obstacle.
struct Touch<T> {
    distance: T,
    rate: T,
    /// Direction in which the obstacle pushes.
    normal: [T; 2],
    /// Speed around the obstacle and along its axis.
    along: [T; 2],
}

impl ShapedStop {
    /// A stop with two coordinates in the plane of the shape and a third one along its axis, which
    /// may be left out where nothing rubs.
    ///
    /// # Errors
    /// When a number is not finite or out of its range, or there is friction without a damper.
    pub fn new(
        rows: Vec<Vec<f64>>,
        origin: [f64; 2],
        shape: Shape,
        stiffness: f64,
        damping: f64,
        friction: Option<Friction>,
    ) -> Result<Self> {
        let needed = if friction.is_some() { COORDINATES } else { 2 };
        if rows.len() != needed {
            return Err(Error::Length {
                what: "the list of a shaped stop's coordinates",
                found: rows.len(),
                expected: needed,
            });
        }
        for row in &rows {
            check_finite("the stop's row", row)?;
        }
        check_finite("the stop's origin", &origin)?;
        check_finite("the stop's stiffness", &[stiffness])?;
        check_finite("the stop's damping", &[damping])?;
        let mut positive = vec![("the stop's stiffness", stiffness)];
        if let Some(friction) = &friction {
            friction.check()?;
            positive.push(("the tangential damping", friction.damping));
        }
        if let Some((what, value)) = positive.into_iter().find(|(_, value)| *value <= 0.0) {
            return Err(Error::NotPositive { what, value });
        }
        if damping < 0.0 {
            return Err(Error::Negative {
                what: "the stop's damping",
                value: damping,
            });
        }
        Ok(Self {
            rows,
            origin,
            shape,
            stiffness,
            damping,
            friction,
        })
    }

    fn state(number: u8, side: usize, memory: [f64; 2]) -> State {
        State {
            number,
            // A polygon has no more sides than this counts.
            part: side as u16,
            memory,
        }
    }

    /// Where the structure is, seen from the obstacle.
    #[inline(always)]
    fn place<T: Number>(&self, position: &Local<T>) -> [T; 2] {
        let [y, z] = self.origin;
        [T::of(y) + position[0], T::of(z) + position[1]]
    }

    #[inline(always)]
    fn clearance<T: Number>(&self, state: State, position: &Local<T>) -> T {
        (self.shape).clearance(usize::from(state.part), self.place(position))
    }

    #[inline(always)]
    fn touch<T: Number>(&self, state: State, position: &Local<T>, velocity: &Local<T>) -> Touch<T> {
        let (distance, normal) = self.shape.at(usize::from(state.part), self.place(position));
        let [a, b] = normal;
        Touch {
            distance,
            rate: a * velocity[0] + b * velocity[1],
            normal,
            along: [a * velocity[1] - b * velocity[0], velocity[2]],
        }
    }

    /// `-k d - c d'`, the force before it is cut off at zero.
    #[inline(always)]
    fn push<T: Number>(&self, touch: &Touch<T>) -> T {
        -(T::of(self.stiffness) * touch.distance + T::of(self.damping) * touch.rate)
    }

    /// What rubs in a state, if something does.
    fn rub<T: Number>(&self, state: State, touch: &Touch<T>) -> Option<Rub<T>> {
        let friction = self.friction.as_ref()?;
        let stretch = state.memory.map(T::of);
        match state.number {
            STICK => Some(rubbing::stick(friction, stretch, touch.along)),
            SLIP => {
                let push = self.push(touch);
                Some(rubbing::slip(friction, stretch, touch.along, push))
            }
            _ => None,
        }
    }

    /// Where contact begins.
    fn begin(&self, side: usize, acting: impl Fn(State) -> LocalMotion) -> State {
        let Some(friction) = &self.friction else {
            return Self::state(CLOSED, side, [0.0; 2]);
        };
        let sticks = Self::state(STICK, side, [0.0; 2]);
        let motion = acting(sticks);
        let touch = self.touch(sticks, motion.position(), motion.velocity());
        let push = self.push(&touch).max(0.0);
        let left = rubbing::margin(friction, true, [0.0; 2], touch.along, push);
        let number = if left < 0.0 { SLIP } else { STICK };
        Self::state(number, side, [0.0; 2])
    }

    /// Contact with force or without, where the structure is inside the obstacle.
    fn inside(
        &self,
        side: usize,
        motion: &LocalMotion,
        acting: impl Fn(State) -> LocalMotion,
    ) -> State {
        let released = Self::state(RELEASED, side, [0.0; 2]);
        let touch = self.touch(released, motion.position(), motion.velocity());
        let size = motion.zero[0] + ROUNDING * self.shape.size();
        if touch.distance < -size && self.push(&touch) < 0.0 {
            return released;
        }
        self.begin(side, acting)
    }

    /// The first derivatives of the distance, each with the size below which it counts as zero.
    fn series(&self, state: State, motion: &LocalMotion) -> [(f64, f64); 3] {
        let [position, velocity, acceleration, _] = &motion.derivatives;
        let touch = self.touch(state, position, velocity);
        let [a, b] = touch.normal;
        let around = touch.along[0];
        let bent = self.shape.bend(self.place(position)) * around * around;
        let second = a * acceleration[0] + b * acceleration[1] + bent;
        let own = ROUNDING * (self.shape.size() + self.origin[0].hypot(self.origin[1]));
        [
            (touch.distance, motion.zero[0] + own),
            (touch.rate, motion.zero[1]),
            (second, motion.zero[2] + ROUNDING * bent.abs()),
        ]
    }

    /// The state without contact where the structure is.
    fn open(&self, position: &Local<f64>) -> State {
        let place = self.place(position);
        match self.shape.polygon() {
            Some(polygon) if polygon.within(NEARING, place) <= 0.0 => {
                Self::state(NEAR, polygon.sector(place), [0.0; 2])
            }
            _ => State::plain(OPEN),
        }
    }

    /// The state in the next sector of a polygon. In contact the depth may change at a corner.
    fn turned(&self, state: State, ahead: bool) -> State {
        let side = usize::from(state.part);
        let next = (self.shape.polygon()).map_or(side, |polygon| polygon.neighbour(side, ahead));
        Self::state(state.number, next, state.memory)
    }
}

impl Law for ShapedStop {
    fn rows(&self) -> &[Vec<f64>] {
        &self.rows
    }

    fn state_name(&self, state: State) -> Cow<'static, str> {
        let name = ["open", "open", "released", "closed", "stick", "slip"][state.number as usize];
        if self.shape.polygon().is_none() || state.number == OPEN {
            return name.into();
        }
        format!("{name}, side {}", state.part + 1).into()
    }

    fn initial_state(&self, motion: &LocalMotion, acting: impl Fn(State) -> LocalMotion) -> State {
        let side = self.shape.side(self.place(motion.position()));
        let series = self.series(Self::state(OPEN, side, [0.0; 2]), motion);
        let decisive = series.iter().find(|(value, zero)| value.abs() > *zero);
        match decisive {
            Some((value, _)) if *value < 0.0 => self.inside(side, motion, acting),
            _ => self.open(motion.position()),
        }
    }

    fn sampled_state(
        &self,
        previous: State,
        position: &Local<f64>,
        velocity: &Local<f64>,
    ) -> State {
        let place = self.place(position);
        let (distance, _) = self.shape.anywhere(place);
        if distance > 0.0 {
            return self.open(position);
        }
        let here = Self::state(CLOSED, self.shape.side(place), previous.memory);
        let touch = self.touch(here, position, velocity);
        if self.push(&touch) < 0.0 {
            return Self::state(RELEASED, self.shape.side(place), [0.0; 2]);
        }
        here
    }

    /// Beyond its guards a state's force goes on as it is, so that a step past one stays smooth.
    #[inline(always)]
    fn force<T: Number>(&self, state: State, position: &Local<T>, velocity: &Local<T>) -> Local<T> {
        if state.number <= RELEASED {
            return [T::of(0.0); COORDINATES];
        }
        let touch = self.touch(state, position, velocity);
        let push = self.push(&touch);
        let [a, b] = touch.normal;
        let pushed = [push * a, push * b, T::of(0.0)];
        match self.rub(state, &touch) {
            None => pushed,
            Some(Rub {
                force: [around, axial],
                ..
            }) => [pushed[0] - around * b, pushed[1] + around * a, axial],
        }
    }

    #[inline(always)]
    fn on_contact<T: Number>(
        &self,
        state: State,
        position: &Local<T>,
        force: &Local<T>,
    ) -> Local<T> {
        let (_, [a, b]) = self.shape.at(usize::from(state.part), self.place(position));
        let push = (a * force[0] + b * force[1]).max(T::of(0.0));
        [push, a * force[1] - b * force[0], force[2]]
    }

    fn is_piecewise_linear(&self) -> bool {
        false
    }

    fn flows(&self) -> bool {
        self.friction.is_some()
    }

    fn memory_rates(&self, state: State, position: &Local<f64>, velocity: &Local<f64>) -> [f64; 2] {
        let touch = self.touch(state, position, velocity);
        (self.rub(state, &touch)).map_or([0.0; 2], |rub| rub.stretching)
    }

    /// A stretch is measured by how deep the structure is in the obstacle.
    fn memory_sizes(&self, position: &Local<f64>) -> [f64; 2] {
        let (distance, _) = self.shape.anywhere(self.place(position));
        [(-distance).max(0.0); 2]
    }

    fn piece(&self, state: State) -> Option<Piece> {
        (state.number <= RELEASED).then_some(Piece::FREE)
    }

    /// The stretch of what rubs, around the obstacle and along its axis, while there is contact.
    fn internal_variables(
        &self,
        state: State,
        _position: &Local<f64>,
        _velocity: &Local<f64>,
    ) -> [f64; 2] {
        if matches!(state.number, STICK | SLIP) {
            state.memory
        } else {
            [f64::NAN; 2]
        }
    }

    fn guard_count(&self, state: State) -> usize {
        self.watched_count(state)
    }

    fn guard(&self, state: State, index: usize) -> Guard {
        Guard {
            name: self.watched(state, index).name(state),
            function: Affine::ZERO,
        }
    }

    #[inline(always)]
    fn is_curved(&self, _state: State, _index: usize) -> bool {
        true
    }

    fn guard_value<T: Number>(
        &self,
        state: State,
        index: usize,
        position: &Local<T>,
        velocity: &Local<T>,
    ) -> T {
        self.flowing_guard(state, index, position, velocity, &state.memory.map(T::of))
    }

    fn flowing_guard<T: Number>(
        &self,
        state: State,
        index: usize,
        position: &Local<T>,
        velocity: &Local<T>,
        memory: &[T; 2],
    ) -> T {
        self.value_of(
            self.watched(state, index),
            state,
            [position, velocity],
            memory,
        )
    }

    fn next_state(
        &self,
        state: State,
        guard: usize,
        acting: impl Fn(State) -> LocalMotion,
    ) -> State {
        let side = usize::from(state.part);
        match (self.watched(state, guard), state.number) {
            (Watched::Clearance(_), OPEN | NEAR) | (Watched::Push(_), RELEASED) => {
                self.begin(side, acting)
            }
            (Watched::Clearance(_), _) if self.shape.polygon().is_some() => {
                Self::state(NEAR, side, [0.0; 2])
            }
            (Watched::Clearance(_), _) => State::plain(OPEN),
            (Watched::Push(_), _) => Self::state(RELEASED, side, [0.0; 2]),
            (Watched::Margin, STICK) => Self::state(SLIP, side, state.memory),
            (Watched::Margin, _) => Self::state(STICK, side, state.memory),
            (Watched::Within(..), OPEN) => {
                let place = self.place(acting(state).position());
                Self::state(NEAR, self.shape.side(place), [0.0; 2])
            }
            (Watched::Within(..), _) => State::plain(OPEN),
            (Watched::Ray(which), _) => self.turned(state, which == 1),
        }
    }

    fn stored<T: Number>(&self, state: State, position: &Local<T>) -> T {
        if state.number <= RELEASED {
            return T::of(0.0);
        }
        let (distance, _) = self.shape.at(usize::from(state.part), self.place(position));
        let normal = T::of(0.5 * self.stiffness) * distance * distance;
        match &self.friction {
            None => normal,
            Some(friction) => normal + rubbing::stored(friction, state.memory.map(T::of)),
        }
    }

    fn dissipated_power<T: Number>(
        &self,
        state: State,
        position: &Local<T>,
        velocity: &Local<T>,
    ) -> T {
        if state.number <= RELEASED {
            return T::of(0.0);
        }
        let touch = self.touch(state, position, velocity);
        let damped = T::of(self.damping) * touch.rate * touch.rate;
        self.rub(state, &touch)
            .map_or(damped, |rub| damped + rub.power)
    }

    fn switch_loss(&self, before: State, after: State, position: &Local<f64>) -> f64 {
        self.stored(before, position) - self.stored(after, position)
    }

    fn distance<T: Number>(&self, position: &Local<T>, velocity: &Local<T>) -> (T, T) {
        let (distance, [a, b]) = self.shape.anywhere(self.place(position));
        (distance, a * velocity[0] + b * velocity[1])
    }

    fn in_contact(&self, state: State) -> bool {
        state.number >= RELEASED
    }

    /// As stiff in every direction as it is along its normal: a bound.
    fn stiffest(&self) -> Piece {
        let mut piece = Piece::FREE;
        for i in 0..2 {
            piece.stiffness[i][i] = self.stiffness;
            piece.damping[i][i] = self.damping;
        }
        piece
    }
}
