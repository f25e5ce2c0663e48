//! A force that is a formula of the position and the velocity of one coordinate.
//!
//! The force on the structure is `f(x, v)`. What it does at rest is stored, `-∫ f(ξ, 0) dξ` from
//! zero to x; what the velocity adds, `f(x, v) - f(x, 0)`, is dissipated, or given where it pushes
//! along. The sides of the formula are the states, one bit each, so that the force of a state is
//! smooth, and the guards are the straight lines at which a side ends.

use super::formula::{Formula, Sides};
use super::{Affine, Guard, Law, Local, LocalMotion, Piece, State};
use crate::error::{Result, check_finite};
use crate::method::piecewise_linear::quadrature::panel;
use crate::number::Number;
use std::borrow::Cow;

/// A force by a formula.
#[derive(Debug, Clone, PartialEq)]
pub struct ForceRelation {
    rows: [Vec<f64>; 1],
    formula: Formula,
}

/// An integral of the force is taken again on both halves until they agree so well, relative to
/// what was found so far, or are halved so often.
const AGREEMENT: f64 = 1e-13;
const HALVINGS: u32 = 48;
/// How often it is split at kinks.
const STRETCHES: u32 = 16;

impl ForceRelation {
    /// A force along the coordinate `row . q`.
    ///
    /// # Errors
    /// When a number of the row is not finite.
    pub fn new(row: Vec<f64>, formula: Formula) -> Result<Self> {
        check_finite("the row of the force", &row)?;
        Ok(Self {
            rows: [row],
            formula,
        })
    }

    /// The force at a position and a velocity, in N.
    pub fn force_at(&self, x: f64, v: f64) -> f64 {
        self.formula.value(Sides::FREE, [x, v])
    }

    /// The sides that a state holds: those that end at a straight line.
    fn sides(&self, state: State) -> Sides {
        let mut held = 0;
        self.formula
            .turns(state.number, |number, _| held |= 1 << number);
        Sides {
            bits: state.number,
            held,
        }
    }

    /// The sides that it holds whatever the velocity is.
    fn sides_at_rest(&self, state: State) -> Sides {
        let mut held = 0;
        self.formula.turns(state.number, |number, line| {
            held |= u8::from(line.velocity[0] == 0.0) << number;
        });
        Sides {
            bits: state.number,
            held,
        }
    }

    /// The guard of a side by its place among those of a state, and the side's number.
    fn turn(&self, state: State, index: usize) -> Option<(usize, Affine)> {
        let (mut found, mut place) = (None, 0);
        self.formula.turns(state.number, |number, line| {
            if place == index {
                let sign = if state.number >> number & 1 == 1 {
                    1.0
                } else {
                    -1.0
                };
                found = Some((number, line.times(sign)));
            }
            place += 1;
        });
        found
    }

    fn at<T: Number>(&self, sides: Sides, x: T, v: T) -> T {
        T::function(
            [x, v],
            |motion| self.formula.value(sides, motion),
            |motion| self.formula.gradient(sides, motion),
        )
    }

    /// The force at rest, whatever the sides of the motion are.
    fn at_rest(&self, x: f64) -> f64 {
        self.force_at(x, 0.0)
    }

    /// What the force at rest has taken from zero to a position.
    fn energy(&self, x: f64) -> f64 {
        -self.stretch(0.0, x, STRETCHES)
    }

    /// The integral of the force at rest, in stretches on whose sides it stays: a rule does not
    /// see a kink beyond the last of its points.
    fn stretch(&self, from: f64, to: f64, splits: u32) -> f64 {
        let middle = 0.5 * (from + to);
        let inside = |x: f64| (x - from) * (to - x) > 0.0;
        let mut kink = None;
        let bits = self.formula.sides_at(Sides::FREE, [middle, 0.0]);
        self.formula.turns(bits, |_, line| {
            let root = -line.constant / line.position[0];
            if inside(root) {
                kink = Some(root);
            }
        });
        if let Some(kink) = kink.filter(|_| splits > 0) {
            return self.stretch(from, kink, splits - 1) + self.stretch(kink, to, splits - 1);
        }
        let (length, whole) = (to - from, self.panel(from, to - from));
        self.halved(from, length, whole, AGREEMENT * whole.abs(), HALVINGS)
    }

    fn panel(&self, from: f64, length: f64) -> f64 {
        let [integral] = panel(from, length, |x| [self.at_rest(x)]);
        integral
    }

    fn halved(&self, from: f64, length: f64, whole: f64, allowed: f64, halvings: u32) -> f64 {
        let half = 0.5 * length;
        let (first, second) = (self.panel(from, half), self.panel(from + half, half));
        let agrees = (first + second - whole).abs() <= allowed;
        if agrees || halvings == 0 || !whole.is_finite() {
            return first + second;
        }
        self.halved(from, half, first, allowed, halvings - 1)
            + self.halved(from + half, half, second, allowed, halvings - 1)
    }
}

impl Law for ForceRelation {
    const REMEMBERS: bool = false;

    fn rows(&self) -> &[Vec<f64>] {
        &self.rows
    }

    fn state_name(&self, state: State) -> Cow<'static, str> {
        if state.number == 0 {
            "acting".into()
        } else {
            format!("acting, side {}", state.number).into()
        }
    }

    /// Where an argument vanishes its first derivative that does not decides.
    fn initial_state(&self, motion: &LocalMotion, _: impl Fn(State) -> LocalMotion) -> State {
        let at = [motion.position()[0], motion.velocity()[0]];
        let mut bits = self.formula.sides_at(Sides::FREE, at);
        // A side may hang on others that were decided before it.
        for _ in 0..super::formula::SIDES {
            let known = bits;
            self.formula.turns(known, |number, line| {
                let series = line.series(motion);
                let decisive = series.iter().find(|(value, zero)| value.abs() > *zero);
                if let Some((value, _)) = decisive {
                    bits = bits & !(1 << number) | u8::from(*value > 0.0) << number;
                }
            });
            if bits == known {
                break;
            }
        }
        State::plain(bits)
    }

    fn sampled_state(&self, _: State, position: &Local<f64>, velocity: &Local<f64>) -> State {
        let at = [position[0], velocity[0]];
        State::plain(self.formula.sides_at(Sides::FREE, at))
    }

    fn force<T: Number>(&self, state: State, position: &Local<T>, velocity: &Local<T>) -> Local<T> {
        let force = self.at(self.sides(state), position[0], velocity[0]);
        [force, T::of(0.0), T::of(0.0)]
    }

    fn is_piecewise_linear(&self) -> bool {
        false
    }

    fn piece(&self, _state: State) -> Option<Piece> {
        None
    }

    fn guard_count(&self, state: State) -> usize {
        let mut count = 0;
        self.formula.turns(state.number, |_, _| count += 1);
        count
    }

    fn guard(&self, state: State, index: usize) -> Guard {
        let turn = self.turn(state, index);
        turn.map_or(Guard::NEVER, |(_, function)| Guard {
            name: "turn of the formula",
            function,
        })
    }

    fn next_state(
        &self,
        state: State,
        guard: usize,
        acting: impl Fn(State) -> LocalMotion,
    ) -> State {
        let Some((number, _)) = self.turn(state, guard) else {
            return state;
        };
        let mut sides = self.sides(state);
        sides.bits ^= 1 << number;
        let motion = acting(state);
        let at = [motion.position()[0], motion.velocity()[0]];
        State::plain(self.formula.sides_at(sides, at))
    }

    fn stored<T: Number>(&self, _state: State, position: &Local<T>) -> T {
        T::function(
            [position[0]],
            |[x]| self.energy(x),
            |[x]| [-self.at_rest(x)],
        )
    }

    fn dissipated_power<T: Number>(
        &self,
        state: State,
        position: &Local<T>,
        velocity: &Local<T>,
    ) -> T {
        let (x, v) = (position[0], velocity[0]);
        let whole = self.at(self.sides(state), x, v);
        let at_rest = self.at(self.sides_at_rest(state), x, T::of(0.0));
        (at_rest - whole) * v
    }

    fn distance<T: Number>(&self, position: &Local<T>, velocity: &Local<T>) -> (T, T) {
        (position[0], velocity[0])
    }

    /// No state is linear: there is no stiffest.
    fn stiffest(&self) -> Piece {
        Piece::FREE
    }
}
