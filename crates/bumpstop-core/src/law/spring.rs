//! A multilinear elastic spring: a force that follows straight segments, with a damper beside it.
//!
//! With deformation x the force on the structure is `-(f(x) + c x')`, where f is continuous and
//! has one slope a segment. The segments are the states.

use super::polyline::{Names, Polyline};
use super::{Affine, Guard, Law, Local, LocalMotion, Piece, Power, State};
use crate::error::{Error, Result, check_finite};
use crate::number::Number;
use std::borrow::Cow;

/// An elastic spring whose stiffness changes at given deformations.
#[derive(Debug, Clone, PartialEq)]
pub struct Spring {
    rows: [Vec<f64>; 1],
    force: Polyline,
    damping: f64,
}

impl Spring {
    /// A spring of deformation `row . q` whose stiffness is `stiffness[i]` between `breaks[i-1]`
    /// and `breaks[i]`, in N/m, with the force `preload` at no deformation, in N.
    ///
    /// # Errors
    /// When a number is not finite, the breaks do not increase, there is not one stiffness more
    /// than breaks, or the damping is negative.
    pub fn new(
        row: Vec<f64>,
        breaks: Vec<f64>,
        stiffness: &[f64],
        preload: f64,
        damping: f64,
    ) -> Result<Self> {
        let names = Names {
            breaks: "the spring's breaks",
            slopes: "the spring's stiffness",
            distance: "the distance between the spring's breaks",
        };
        check_finite("the spring's row", &row)?;
        check_finite("the spring's preload", &[preload])?;
        check_finite("the spring's damping", &[damping])?;
        if damping < 0.0 {
            return Err(Error::Negative {
                what: "the spring's damping",
                value: damping,
            });
        }
        Ok(Self {
            rows: [row],
            force: Polyline::new(breaks, stiffness, preload, &names)?,
            damping,
        })
    }

    #[inline(always)]
    fn state_at(&self, deformation: f64) -> State {
        State::plain(self.force.number_at(deformation))
    }

    /// Whether a guard looks at the lower end of its segment.
    fn is_lower(&self, state: State, guard: usize) -> bool {
        state.number > 0 && guard == 0
    }
}

impl Law for Spring {
    const REMEMBERS: bool = false;

    fn rows(&self) -> &[Vec<f64>] {
        &self.rows
    }

    fn state_name(&self, state: State) -> Cow<'static, str> {
        format!("segment {}", state.number + 1).into()
    }

    fn initial_state(&self, motion: &LocalMotion, _acting: impl Fn(State) -> LocalMotion) -> State {
        let deformation = std::array::from_fn::<_, 4, _>(|order| {
            (motion.derivatives[order][0], motion.zero[order])
        });
        State::plain(self.force.number_around(&deformation))
    }

    #[inline(always)]
    fn sampled_state(
        &self,
        _previous: State,
        position: &Local<f64>,
        _velocity: &Local<f64>,
    ) -> State {
        self.state_at(position[0])
    }

    #[inline(always)]
    fn force<T: Number>(&self, state: State, position: &Local<T>, velocity: &Local<T>) -> Local<T> {
        let zero = T::of(0.0);
        let spring = self.force.segment(state.number).value_at(position[0]);
        [-(spring + T::of(self.damping) * velocity[0]), zero, zero]
    }

    fn piece(&self, state: State) -> Option<Piece> {
        let segment = self.force.segment(state.number);
        let mut piece = Piece::FREE;
        piece.constant[0] = -segment.value_at(0.0);
        piece.stiffness[0][0] = segment.slope;
        piece.damping[0][0] = self.damping;
        Some(piece)
    }

    fn guard_count(&self, state: State) -> usize {
        let number = state.number as usize;
        usize::from(number > 0) + usize::from(number < self.force.breaks().len())
    }

    fn guard(&self, state: State, index: usize) -> Guard {
        let number = state.number as usize;
        let mut function = Affine::coordinate(0);
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

    #[inline(always)]
    fn stored<T: Number>(&self, state: State, position: &Local<T>) -> T {
        self.force.segment(state.number).integral_at(position[0])
    }

    fn dissipation(&self, _state: State) -> Power {
        Power::of_damper(0, self.damping)
    }

    fn switch_loss(&self, _before: State, _after: State, _position: &Local<f64>) -> f64 {
        0.0
    }

    #[inline(always)]
    fn distance<T: Number>(&self, position: &Local<T>, velocity: &Local<T>) -> (T, T) {
        (position[0], velocity[0])
    }

    fn in_contact(&self, _state: State) -> bool {
        false
    }

    fn stiffest(&self) -> Piece {
        let mut piece = Piece::FREE;
        piece.stiffness[0][0] = self.force.steepest();
        piece.damping[0][0] = self.damping;
        piece
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spring() -> Spring {
        Spring::new(
            vec![1.0],
            vec![-1.0, 0.5, 2.0],
            &[3.0, 0.0, 2.0, -1.0],
            4.0,
            0.0,
        )
        .unwrap()
    }

    fn force(spring: &Spring, x: f64) -> f64 {
        let position = [x, 0.0, 0.0];
        -spring.force(spring.state_at(x), &position, &[0.0; 3])[0]
    }

    #[test]
    fn the_force_is_continuous_and_follows_the_slopes() {
        let spring = spring();
        for (x, expected) in [
            (-3.0, -2.0),
            (-1.0, 4.0),
            (0.0, 4.0),
            (0.5, 4.0),
            (1.5, 6.0),
            (2.0, 7.0),
            (4.0, 5.0),
        ] {
            assert!((force(&spring, x) - expected).abs() < 1e-14, "at {x}");
        }
    }

    #[test]
    fn the_energy_is_the_integral_of_the_force_from_the_origin() {
        let spring = spring();
        for end in [-3.0, -0.5, 0.0, 0.4, 1.7, 5.0] {
            let n = 200_000;
            let h = end / f64::from(n);
            let midpoints = (0..n).map(|i| force(&spring, (f64::from(i) + 0.5) * h));
            let integral: f64 = midpoints.sum::<f64>() * h;
            let stored = spring.stored(spring.state_at(end), &[end, 0.0, 0.0]);
            assert!((stored - integral).abs() < 1e-8, "up to {end}");
        }
    }

    #[test]
    fn pieces_give_the_force() {
        let spring = spring();
        for x in [-2.0, 0.1, 1.0, 3.0] {
            let state = spring.state_at(x);
            let position = [x, 0.0, 0.0];
            let piece = spring.piece(state).unwrap();
            let linear = piece.force(&position, &[0.0; 3])[0];
            let exact: f64 = spring.force(state, &position, &[0.0; 3])[0];
            assert!((linear - exact).abs() < 1e-14);
        }
    }
}
