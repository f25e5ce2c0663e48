//! A seismic device: a spring whose stiffness falls beyond a threshold, and a damper whose force is
//! a power of speed times elongation.
//!
//! With the elongation x and its speed v the force on the structure is `-(f(x) + g(x, v))` with
//! `f = K2 x + (K1 - K2) x / sqrt(1 + (K1 x / P)^2)` and `g = C |x / S|^alpha v / (v^2 + r^2)^((1 -
//! alpha)/2)`. Beyond the speed r that is `C sign(v) |v x / S|^alpha`; around rest it is a linear
//! damper, for an infinite slope would be a friction that no step follows. Where the elongation
//! changes its sign the damper's force has a cusp: the sign is the state, so that this ends a step.
//!
//! Source: the anti-seismic device of code_aster's manual R5.06.03.

use super::{Affine, Guard, Law, Local, LocalMotion, Piece, State};
use crate::error::{Error, Result, check_finite};
use crate::number::Number;
use std::borrow::Cow;

/// What a device is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Device {
    /// Stiffness K1 at small elongations, in N/m.
    pub first_stiffness: f64,
    /// Stiffness K2 at large ones, in N/m.
    pub second_stiffness: f64,
    /// Force P around which the stiffness changes, in N.
    pub threshold: f64,
    /// Force C of the damper where `|v x / S|` is one, in N.
    pub damping: f64,
    /// Power alpha.
    pub exponent: f64,
    /// Elongation S that the damper's is measured by, in m.
    pub stroke: f64,
    /// Speed r around rest below which the damper is linear, in m/s.
    pub rest_speed: f64,
}

/// A device along one coordinate.
#[derive(Debug, Clone, PartialEq)]
pub struct SeismicDevice {
    rows: [Vec<f64>; 1],
    device: Device,
}

/// Numbers of the states: the signs of the elongation.
const LONG: u8 = 0;
const SHORT: u8 = 1;

impl SeismicDevice {
    /// A device of the elongation `row . q`.
    ///
    /// # Errors
    /// When a number is not finite or out of its range.
    pub fn new(row: Vec<f64>, device: Device) -> Result<Self> {
        check_finite("the device's row", &row)?;
        for (what, value, zero_will_do) in [
            (
                "the device's first stiffness",
                device.first_stiffness,
                false,
            ),
            (
                "the device's second stiffness",
                device.second_stiffness,
                true,
            ),
            ("the device's threshold", device.threshold, false),
            ("the device's damping", device.damping, true),
            ("the device's exponent", device.exponent, false),
            ("the device's stroke", device.stroke, false),
            ("the device's speed at rest", device.rest_speed, false),
        ] {
            check_finite(what, &[value])?;
            if value < 0.0 {
                return Err(Error::Negative { what, value });
            }
            if value == 0.0 && !zero_will_do {
                return Err(Error::NotPositive { what, value });
            }
        }
        Ok(Self {
            rows: [row],
            device,
        })
    }

    /// `sqrt(1 + (K1 x / P)^2)`.
    fn root<T: Number>(&self, x: T) -> T {
        let bent = T::of(self.device.first_stiffness / self.device.threshold) * x;
        (T::of(1.0) + bent * bent).sqrt()
    }

    fn spring<T: Number>(&self, x: T) -> T {
        let Device {
            first_stiffness,
            second_stiffness,
            ..
        } = self.device;
        let stiff = T::of(first_stiffness - second_stiffness) / self.root(x);
        (T::of(second_stiffness) + stiff) * x
    }

    /// The damper's force, on the side that a state has: zero beyond it.
    fn damper<T: Number>(&self, state: State, x: T, v: T) -> T {
        let Device {
            damping,
            exponent,
            stroke,
            rest_speed,
            ..
        } = self.device;
        let zero = T::of(0.0);
        if damping == 0.0 {
            return zero;
        }
        let length = if state.number == LONG { x } else { -x };
        let share = (length.max(zero) / T::of(stroke)).power(exponent);
        let square = v * v + T::of(rest_speed * rest_speed);
        T::of(damping) * share * v / square.power(0.5 * (1.0 - exponent))
    }

    fn side(elongation: f64) -> State {
        State::plain(if elongation < 0.0 { SHORT } else { LONG })
    }
}

impl Law for SeismicDevice {
    const REMEMBERS: bool = false;

    fn rows(&self) -> &[Vec<f64>] {
        &self.rows
    }

    fn state_name(&self, state: State) -> Cow<'static, str> {
        ["long", "short"][state.number as usize].into()
    }

    /// Where the elongation vanishes its first derivative that does not decides.
    fn initial_state(&self, motion: &LocalMotion, _: impl Fn(State) -> LocalMotion) -> State {
        let series = Affine::coordinate(0).series(motion);
        let decisive = series.iter().find(|(value, zero)| value.abs() > *zero);
        Self::side(decisive.map_or(0.0, |(value, _)| *value))
    }

    fn sampled_state(&self, _: State, position: &Local<f64>, _velocity: &Local<f64>) -> State {
        Self::side(position[0])
    }

    fn force<T: Number>(&self, state: State, position: &Local<T>, velocity: &Local<T>) -> Local<T> {
        let (x, v) = (position[0], velocity[0]);
        let zero = T::of(0.0);
        [-(self.spring(x) + self.damper(state, x, v)), zero, zero]
    }

    fn is_piecewise_linear(&self) -> bool {
        false
    }

    fn piece(&self, _state: State) -> Option<Piece> {
        None
    }

    fn guard_count(&self, _state: State) -> usize {
        usize::from(self.device.damping > 0.0)
    }

    fn guard(&self, state: State, _index: usize) -> Guard {
        let sign = if state.number == LONG { 1.0 } else { -1.0 };
        Guard {
            name: "no elongation",
            function: Affine::coordinate(0).times(sign),
        }
    }

    fn next_state(&self, state: State, _: usize, _: impl Fn(State) -> LocalMotion) -> State {
        State::plain(if state.number == LONG { SHORT } else { LONG })
    }

    fn stored<T: Number>(&self, _state: State, position: &Local<T>) -> T {
        let Device {
            first_stiffness,
            second_stiffness,
            threshold,
            ..
        } = self.device;
        let x = position[0];
        // What the root exceeds one by, without a difference of numbers that are nearly equal.
        let bent = T::of(first_stiffness / threshold) * x;
        let excess = bent * bent / (self.root(x) + T::of(1.0));
        let length = threshold / first_stiffness;
        T::of(0.5 * second_stiffness) * x * x
            + T::of((first_stiffness - second_stiffness) * length * length) * excess
    }

    fn dissipated_power<T: Number>(
        &self,
        state: State,
        position: &Local<T>,
        velocity: &Local<T>,
    ) -> T {
        self.damper(state, position[0], velocity[0]) * velocity[0]
    }

    fn distance<T: Number>(&self, position: &Local<T>, velocity: &Local<T>) -> (T, T) {
        (position[0], velocity[0])
    }

    /// No state is linear, but none of the springs is stiffer than the first or the second.
    fn stiffest(&self) -> Piece {
        let mut piece = Piece::FREE;
        piece.stiffness[0][0] = self
            .device
            .first_stiffness
            .max(self.device.second_stiffness);
        piece
    }
}
