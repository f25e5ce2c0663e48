//! A law that somebody outside the core wrote: its force is asked for where it is needed.
//!
//! The adaptive methods ask at the stages of their steps, some of which are tried in vain, so that
//! the answer must follow from what is asked alone. The first number of the memory is the law's
//! own, the second is the time, whose rate is one.

use super::{COORDINATES, Law, Local, LocalMotion, Piece, State};
use crate::error::{Result, check_finite, check_length};
use crate::number::Number;
use std::borrow::Cow;
use std::fmt::Debug;
use std::sync::Arc;

/// What a law of somebody else is asked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Question {
    /// Local coordinates and their rates.
    pub position: Local<f64>,
    /// See `position`.
    pub velocity: Local<f64>,
    /// In s since the start of the run.
    pub time: f64,
    /// The law's own variable.
    pub memory: f64,
}

/// Slopes of forces: `[i][j]` is that of force i by coordinate j.
pub type Slopes = [Local<f64>; COORDINATES];

/// Somebody who answers.
pub trait Answers: Debug + Send + Sync {
    /// The force on the structure in local coordinates, in N; not a number where there is none.
    fn force(&self, question: &Question) -> Local<f64>;
    /// How it changes with positions and with velocities.
    fn slopes(&self, question: &Question) -> [Slopes; 2];
    /// The rate of the memory, per s.
    fn memory_rate(&self, question: &Question) -> f64;
    /// Whether it could not answer: nothing is asked any more.
    fn has_failed(&self) -> bool;
}

/// A law that answers from outside.
#[derive(Debug, Clone)]
pub struct UserLaw {
    rows: Vec<Vec<f64>>,
    answers: Arc<dyn Answers>,
    start: f64,
}

impl PartialEq for UserLaw {
    fn eq(&self, other: &Self) -> bool {
        self.rows == other.rows && Arc::ptr_eq(&self.answers, &other.answers)
    }
}

/// Where the time stands in the memory.
const TIME: usize = 1;

impl UserLaw {
    /// A law along the coordinates of one to three rows, whose memory is `start` at t = 0.
    ///
    /// # Errors
    /// When a number is not finite, or there are no rows or more than three.
    pub fn new(rows: Vec<Vec<f64>>, answers: Arc<dyn Answers>, start: f64) -> Result<Self> {
        for row in &rows {
            check_finite("a row of the law", row)?;
        }
        check_finite("the law's memory at the start", &[start])?;
        if rows.is_empty() || rows.len() > COORDINATES {
            check_length("the rows of the law", &vec![0.0; rows.len()], COORDINATES)?;
        }
        Ok(Self {
            rows,
            answers,
            start,
        })
    }

    fn question(state: State, position: Local<f64>, velocity: Local<f64>) -> Question {
        Question {
            position,
            velocity,
            time: state.memory[TIME],
            memory: state.memory[0],
        }
    }
}

/// Position and velocity in a row, and one of them as they were.
fn joined<T: Copy>(position: &Local<T>, velocity: &Local<T>) -> [T; 2 * COORDINATES] {
    std::array::from_fn(|i| {
        if i < COORDINATES {
            position[i]
        } else {
            velocity[i - COORDINATES]
        }
    })
}

fn parted(motion: [f64; 2 * COORDINATES]) -> [Local<f64>; 2] {
    [0, COORDINATES].map(|first| std::array::from_fn(|i| motion[first + i]))
}

impl Law for UserLaw {
    fn rows(&self) -> &[Vec<f64>] {
        &self.rows
    }

    fn state_name(&self, _state: State) -> Cow<'static, str> {
        "acting".into()
    }

    fn initial_state(&self, _motion: &LocalMotion, _: impl Fn(State) -> LocalMotion) -> State {
        State::with_memory(0, [self.start, 0.0])
    }

    fn sampled_state(&self, previous: State, _: &Local<f64>, _: &Local<f64>) -> State {
        previous
    }

    fn force<T: Number>(&self, state: State, position: &Local<T>, velocity: &Local<T>) -> Local<T> {
        let motion = joined(position, velocity);
        let ask = |motion: [f64; 2 * COORDINATES]| {
            let [position, velocity] = parted(motion);
            Self::question(state, position, velocity)
        };
        std::array::from_fn(|i| {
            if i >= self.rows.len() {
                return T::of(0.0);
            }
            T::function(
                motion,
                |motion| self.answers.force(&ask(motion))[i],
                |motion| {
                    let [by_position, by_velocity] = self.answers.slopes(&ask(motion));
                    joined(&by_position[i], &by_velocity[i])
                },
            )
        })
    }

    fn is_piecewise_linear(&self) -> bool {
        false
    }

    fn flows(&self) -> bool {
        true
    }

    fn memory_rates(&self, state: State, position: &Local<f64>, velocity: &Local<f64>) -> [f64; 2] {
        let question = Self::question(state, *position, *velocity);
        [self.answers.memory_rate(&question), 1.0]
    }

    /// The memory may have any unit: it is measured by itself.
    fn memory_sizes(&self, _position: &Local<f64>) -> [f64; 2] {
        [0.0; 2]
    }

    /// What it remembers, without the time.
    fn internal_variables(
        &self,
        state: State,
        _position: &Local<f64>,
        _velocity: &Local<f64>,
    ) -> [f64; 2] {
        [state.memory[0], f64::NAN]
    }

    fn has_failed(&self) -> bool {
        self.answers.has_failed()
    }

    fn piece(&self, _state: State) -> Option<Piece> {
        None
    }

    fn stored<T: Number>(&self, _state: State, _position: &Local<T>) -> T {
        T::of(0.0)
    }

    /// All that the force takes from the motion.
    fn dissipated_power<T: Number>(
        &self,
        state: State,
        position: &Local<T>,
        velocity: &Local<T>,
    ) -> T {
        let force = self.force(state, position, velocity);
        let mut power = T::of(0.0);
        for (force, rate) in force.into_iter().zip(velocity) {
            power -= force * *rate;
        }
        power
    }

    fn distance<T: Number>(&self, position: &Local<T>, velocity: &Local<T>) -> (T, T) {
        (position[0], velocity[0])
    }

    /// Nothing is known of its stiffness.
    fn stiffest(&self) -> Piece {
        Piece::FREE
    }
}
