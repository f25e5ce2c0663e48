//! A program outside that is coupled step by step: it is told the motion at the start of a step
//! and answers with the force over it.
//!
//! It is asked once a step, in order, as one that has a state of its own must be. Its answer is
//! the memory of the law's state, so that whatever is read of the run later asks nothing again.

use super::{Law, Local, LocalMotion, Piece, State};
use crate::error::{Result, check_finite, check_length};
use crate::number::Number;
use std::borrow::Cow;
use std::fmt::Debug;
use std::sync::Arc;

/// Somebody who answers once a step.
pub trait Program: Debug + Send + Sync {
    /// The forces in N over the next step, from the local motion at its start.
    fn answer(&self, position: &Local<f64>, velocity: &Local<f64>) -> [f64; 2];
}

/// A law whose force comes from outside, step by step.
#[derive(Debug, Clone)]
pub struct OutsideProgram {
    rows: Vec<Vec<f64>>,
    program: Arc<dyn Program>,
}

impl PartialEq for OutsideProgram {
    fn eq(&self, other: &Self) -> bool {
        self.rows == other.rows && Arc::ptr_eq(&self.program, &other.program)
    }
}

/// A law's memory holds two forces.
const MOST_ROWS: usize = 2;

impl OutsideProgram {
    /// Before the first step.
    const WAITING: State = State::plain(0);
    /// The number of the states in which the program has answered.
    const ANSWERED: u8 = 1;

    /// A program along the coordinates of one or two rows.
    ///
    /// # Errors
    /// When a number is not finite, or there are no rows or more than two.
    pub fn new(rows: Vec<Vec<f64>>, program: Arc<dyn Program>) -> Result<Self> {
        for row in &rows {
            check_finite("a row of the program", row)?;
        }
        if rows.is_empty() || rows.len() > MOST_ROWS {
            check_length("the rows of the program", &vec![0.0; rows.len()], MOST_ROWS)?;
        }
        Ok(Self { rows, program })
    }
}

impl Law for OutsideProgram {
    fn rows(&self) -> &[Vec<f64>] {
        &self.rows
    }

    fn state_name(&self, _state: State) -> Cow<'static, str> {
        "acting".into()
    }

    fn initial_state(&self, _motion: &LocalMotion, _: impl Fn(State) -> LocalMotion) -> State {
        Self::WAITING
    }

    /// A run looks at its start before its first step does: that asks nothing.
    fn sampled_state(
        &self,
        previous: State,
        position: &Local<f64>,
        velocity: &Local<f64>,
    ) -> State {
        let forces = if previous == Self::WAITING {
            [0.0; MOST_ROWS]
        } else {
            self.program.answer(position, velocity)
        };
        State::with_memory(Self::ANSWERED, forces)
    }

    fn force<T: Number>(&self, state: State, _: &Local<T>, _: &Local<T>) -> Local<T> {
        let [first, second] = state.memory.map(T::of);
        [first, second, T::of(0.0)]
    }

    fn is_piecewise_linear(&self) -> bool {
        false
    }

    fn is_stepped(&self) -> bool {
        true
    }

    fn piece(&self, _state: State) -> Option<Piece> {
        None
    }

    fn stored<T: Number>(&self, _state: State, _position: &Local<T>) -> T {
        T::of(0.0)
    }

    /// All that the force takes from the motion.
    fn dissipated_power<T: Number>(&self, state: State, _: &Local<T>, velocity: &Local<T>) -> T {
        let [first, second] = state.memory.map(T::of);
        -(first * velocity[0] + second * velocity[1])
    }

    fn distance<T: Number>(&self, position: &Local<T>, velocity: &Local<T>) -> (T, T) {
        (position[0], velocity[0])
    }

    /// Nothing is known of its stiffness.
    fn stiffest(&self) -> Piece {
        Piece::FREE
    }
}
