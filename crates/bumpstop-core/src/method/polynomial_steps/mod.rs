//! Steps as polynomials in time: what is integrated, searched for switches, and kept.
//!
//! Methods that step from one state to the next, by whatever formula, have each step as a
//! polynomial through both its ends ([`dense`]): of modal displacements and velocities, of the
//! memories of laws and of the works of the energy ledger ([`equations`], [`loads`]). The guards of
//! the laws are bounded on it ([`watch`]), and a run is read from what it keeps of them
//! ([`record`], [`contact`]).

mod bernstein;
mod contact;
mod curved;
mod dense;
mod equations;
mod loads;
mod percussion;
mod record;
mod slopes;
mod watch;

pub use record::PolynomialRecord;

pub(crate) use dense::{Dense, cubic_rates, write_cubic};
pub(crate) use equations::{Equations, Layout, TOLD};
pub(crate) use percussion::Percussion;
pub(crate) use slopes::slopes;
pub(crate) use watch::{Crossing, Step, Watch, longest_step};
