//! Rigid stops: impacts, rest, and the impulses and reactions that they take.
//!
//! With one row a stop, `u = R v` are the rates of the distances. Impulses `s` change them by
//! `W s`, `W = R R'` (unit modal mass), reactions the accelerations likewise.

mod complementarity;
mod contacts;
mod directions;
mod meeting;

pub(crate) use contacts::{Blow, Cause, Contacts, Place, TOUCHING};
pub(crate) use directions::Directions;
