//! Any of the laws, so that a problem can have several kinds.

use super::{Guard, Law, Local, LocalMotion, Piece, Power, State, Stop};
use crate::number::Number;

/// A law of any kind; each does its own work.
#[derive(Debug, Clone, PartialEq)]
pub enum AnyLaw {
    /// A unilateral spring and damper.
    Stop(Stop),
}

impl From<Stop> for AnyLaw {
    fn from(stop: Stop) -> Self {
        Self::Stop(stop)
    }
}

/// Asks the law inside.
macro_rules! ask {
    ($self:ident, $law:ident => $answer:expr) => {
        match $self {
            Self::Stop($law) => $answer,
        }
    };
}

impl Law for AnyLaw {
    #[inline(always)]
    fn rows(&self) -> &[Vec<f64>] {
        ask!(self, law => law.rows())
    }

    fn state_name(&self, state: State) -> &'static str {
        ask!(self, law => law.state_name(state))
    }

    fn initial_state(&self, motion: &LocalMotion) -> State {
        ask!(self, law => law.initial_state(motion))
    }

    #[inline(always)]
    fn sampled_state(
        &self,
        previous: State,
        position: &Local<f64>,
        velocity: &Local<f64>,
    ) -> State {
        ask!(self, law => law.sampled_state(previous, position, velocity))
    }

    #[inline(always)]
    fn force<T: Number>(&self, state: State, position: &Local<T>, velocity: &Local<T>) -> Local<T> {
        ask!(self, law => law.force(state, position, velocity))
    }

    fn piece(&self, state: State) -> Option<Piece> {
        ask!(self, law => law.piece(state))
    }

    fn guard_count(&self, state: State) -> usize {
        ask!(self, law => law.guard_count(state))
    }

    fn guard(&self, state: State, index: usize) -> Guard {
        ask!(self, law => law.guard(state, index))
    }

    fn next_state(
        &self,
        state: State,
        guard: usize,
        motion: impl FnOnce() -> LocalMotion,
    ) -> State {
        ask!(self, law => law.next_state(state, guard, motion))
    }

    #[inline(always)]
    fn stored<T: Number>(&self, state: State, position: &Local<T>) -> T {
        ask!(self, law => law.stored(state, position))
    }

    fn dissipation(&self, state: State) -> Power {
        ask!(self, law => law.dissipation(state))
    }

    fn switch_loss(&self, before: State, after: State, position: &Local<f64>) -> f64 {
        ask!(self, law => law.switch_loss(before, after, position))
    }

    #[inline(always)]
    fn distance<T: Number>(&self, position: &Local<T>, velocity: &Local<T>) -> (T, T) {
        ask!(self, law => law.distance(position, velocity))
    }

    fn in_contact(&self, state: State) -> bool {
        ask!(self, law => law.in_contact(state))
    }

    fn stiffest(&self) -> Piece {
        ask!(self, law => law.stiffest())
    }
}
