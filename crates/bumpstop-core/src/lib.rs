//! The numbers of bumpstop.
//!
//! A structure is a [`system::ModalSystem`]; the few places where it is not linear are
//! [`law`]s, small automata that act through projected coordinates; a [`method`] carries both
//! through time and leaves a [`history::History`] behind, which can be sampled anywhere and
//! keeps the energy ledger. Nothing here knows nodes, units or files.

pub mod batch;
pub mod components;
mod dynamics;
mod eigen;
pub mod energy;
pub mod error;
pub mod forcing;
pub mod history;
pub mod impacts;
pub mod law;
pub mod method;
pub mod modes;
pub mod number;
pub mod obstacle;
pub mod problem;
mod rigid;
pub mod rotation;
pub mod sparse;
pub mod system;
