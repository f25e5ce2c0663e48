//! The generalised Zener damper: springs around a dashpot whose force is a power of its speed.
//!
//! A spring K1 stands in a row with a pair side by side: a spring K2, and a spring K3 in a row with
//! the dashpot, `s = C sign(w') |w'|^alpha` for the elongation w of the dashpot. With the elongation u of
//! the whole and u2 of the pair, `F = K1 (u - u2) = K2 u2 + K3 (u2 - w)`: w is the memory, and its rate
//! follows from the force `s = K3 (u2 - w)` of the branch.
//!
//! Source: the device of nonlinear viscous dampers in the manual of code_aster, R5.03.17, there with
//! the force as internal variable.

use super::{Law, Local, LocalMotion, Piece, State};
use crate::error::{Error, Result, check_finite};
use crate::number::Number;
use std::borrow::Cow;

/// What a damper is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Zener {
    /// Stiffness of the spring in a row with all else, in N/m.
    pub in_series: f64,
    /// Stiffness of the spring beside the dashpot's branch, in N/m; it may be zero.
    pub in_parallel: f64,
    /// Stiffness of the spring in a row with the dashpot, in N/m.
    pub in_branch: f64,
    /// Force of the dashpot at 1 m/s, in N (s/m)^exponent.
    pub damping: f64,
    /// Power of the speed, from above 0 to 1.
    pub exponent: f64,
}

/// Springs and a dashpot along one coordinate.
#[derive(Debug, Clone, PartialEq)]
pub struct ZenerDamper {
    rows: [Vec<f64>; 1],
    parts: Zener,
}

/// Elongation of each spring.
struct Springs<T> {
    in_series: T,
    in_parallel: T,
    in_branch: T,
}

impl ZenerDamper {
    /// A damper of the elongation `row . q`.
    ///
    /// # Errors
    /// When a number is not finite or out of its range.
    pub fn new(row: Vec<f64>, parts: Zener) -> Result<Self> {
        check_finite("the damper's row", &row)?;
        for (what, value) in [
            ("the damper's stiffness in series", parts.in_series),
            ("the damper's stiffness in the branch", parts.in_branch),
            ("the damper's damping", parts.damping),
            ("the damper's exponent", parts.exponent),
        ] {
            check_finite(what, &[value])?;
            if value <= 0.0 {
                return Err(Error::NotPositive { what, value });
            }
        }
        for (what, value) in [
            ("the damper's stiffness in parallel", parts.in_parallel),
            ("one less the damper's exponent", 1.0 - parts.exponent),
        ] {
            check_finite(what, &[value])?;
            if value < 0.0 {
                return Err(Error::Negative { what, value });
            }
        }
        Ok(Self { rows: [row], parts })
    }

    /// The springs' elongations: the force is the same above and below the middle.
    fn springs<T: Number>(&self, state: State, position: &Local<T>) -> Springs<T> {
        let Zener {
            in_series,
            in_parallel,
            in_branch,
            ..
        } = self.parts;
        let (whole, dashpot) = (position[0], T::of(state.memory[0]));
        let pull = T::of(in_series) * whole + T::of(in_branch) * dashpot;
        let pair = pull / T::of(in_series + in_parallel + in_branch);
        Springs {
            in_series: whole - pair,
            in_parallel: pair,
            in_branch: pair - dashpot,
        }
    }

    /// Speed of the dashpot under a force of its branch.
    fn speed<T: Number>(&self, force: T) -> T {
        let size = (force.abs() / T::of(self.parts.damping)).power(1.0 / self.parts.exponent);
        force.select_less(T::of(0.0), -size, size)
    }

    fn branch_force<T: Number>(&self, state: State, position: &Local<T>) -> T {
        T::of(self.parts.in_branch) * self.springs(state, position).in_branch
    }
}

impl Law for ZenerDamper {
    fn rows(&self) -> &[Vec<f64>] {
        &self.rows
    }

    fn state_name(&self, _state: State) -> Cow<'static, str> {
        "damping".into()
    }

    /// At the start the dashpot is where it stands without force.
    fn initial_state(&self, _motion: &LocalMotion, _: impl Fn(State) -> LocalMotion) -> State {
        State::FIRST
    }

    fn sampled_state(&self, previous: State, _: &Local<f64>, _: &Local<f64>) -> State {
        previous
    }

    fn force<T: Number>(&self, state: State, position: &Local<T>, _: &Local<T>) -> Local<T> {
        let stretch = self.springs(state, position).in_series;
        let zero = T::of(0.0);
        [-(T::of(self.parts.in_series) * stretch), zero, zero]
    }

    fn is_piecewise_linear(&self) -> bool {
        false
    }

    fn flows(&self) -> bool {
        true
    }

    fn memory_rates(&self, state: State, position: &Local<f64>, _: &Local<f64>) -> [f64; 2] {
        [self.speed(self.branch_force(state, position)), 0.0]
    }

    /// The elongation of the dashpot.
    fn internal_variables(
        &self,
        state: State,
        _position: &Local<f64>,
        _velocity: &Local<f64>,
    ) -> [f64; 2] {
        [state.memory[0], f64::NAN]
    }

    fn piece(&self, _state: State) -> Option<Piece> {
        None
    }

    fn stored<T: Number>(&self, state: State, position: &Local<T>) -> T {
        let springs = self.springs(state, position);
        let energy = |stiffness: f64, x: T| T::of(0.5 * stiffness) * x * x;
        energy(self.parts.in_series, springs.in_series)
            + energy(self.parts.in_parallel, springs.in_parallel)
            + energy(self.parts.in_branch, springs.in_branch)
    }

    fn dissipated_power<T: Number>(&self, state: State, position: &Local<T>, _: &Local<T>) -> T {
        let force = self.branch_force(state, position);
        force * self.speed(force)
    }

    fn distance<T: Number>(&self, position: &Local<T>, velocity: &Local<T>) -> (T, T) {
        (position[0], velocity[0])
    }

    /// No state is linear: there is no stiffest.
    fn stiffest(&self) -> Piece {
        Piece::FREE
    }
}
