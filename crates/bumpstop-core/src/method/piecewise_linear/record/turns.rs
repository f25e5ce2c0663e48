//! Where a signal turns within a phase.

use super::PhaseRecord;
use crate::law::Law;
use crate::method::piecewise_linear::advance::{Certificate, Path, Start, Walk};
use crate::method::piecewise_linear::curved::{CurvedGuards, Guards};
use crate::method::piecewise_linear::phase::Phase;
use crate::method::piecewise_linear::signal::Signal;
use crate::number::{Instructions, Vectorised};
use crate::problem::Problem;

/// All zeros of a signal's rate inside a phase, in order, in s since its start.
pub(super) struct Turns<'a, L> {
    pub(super) record: &'a PhaseRecord,
    pub(super) problem: &'a Problem<L>,
    pub(super) phase: Phase,
    pub(super) signal: &'a Signal,
    pub(super) walk: &'a mut Walk,
}

/// Turning points of one phase after which the search ends: a resting contact rings for ever at
/// the level of rounding.
const MOST: usize = 100_000;

impl<L: Law> Vectorised for Turns<'_, L> {
    type Output = Vec<f64>;
    #[inline(always)]
    fn run<I: Instructions>(self) -> Vec<f64> {
        let (phases, phase) = (&self.record.phases, self.phase);
        let mut rate = self.signal.derivative(phases, phase);
        let mut found = Vec::new();
        let mut from = 0.0;
        let mut certificate = Certificate::default();
        let mut start = if rate.orient(phases, phase) {
            Start::Positive
        } else {
            Start::Zero(None)
        };
        let functions = Guards {
            problem: self.problem,
            states: phases.states(phase),
        };
        let curved = CurvedGuards {
            list: &[],
            functions: &functions,
        };
        while found.len() < MOST {
            let path = Path {
                phases,
                phase,
                signals: std::slice::from_ref(&rate),
                curved,
                starts: &[start],
                from,
                limit: phase.length,
            };
            let Some(zero) = self.walk.first_zero::<I>(path, &mut certificate) else {
                break;
            };
            if zero.time > from {
                found.push(zero.time);
            }
            from = zero.time;
            start = Start::Zero(None);
            rate.negate();
        }
        found
    }
}
