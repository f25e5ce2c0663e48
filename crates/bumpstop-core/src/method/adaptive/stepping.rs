//! What the run of an adaptive method asks of its formula.

use super::pieces::Pieces;
use crate::law::Law;
use crate::method::polynomial_steps::Equations;

/// What became of a step that was tried.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Attempt {
    /// It is good, and the next may be as wide as this, in s.
    Good(f64),
    /// It must be tried again with this width, in s.
    Again(f64),
}

/// A formula of one step, with the numbers at the start of the step.
pub(super) trait Stepping<L: Law> {
    /// Degree in time of the polynomials that the steps are made of.
    fn degree(&self) -> usize;

    /// The numbers at the start of the step.
    fn numbers(&mut self) -> &mut Vec<f64>;

    /// Starts anew from these: they, the states of laws or the loads have changed.
    fn start(&mut self, time: f64, equations: &mut Equations<'_, L>);

    /// Sees displacements and velocities, one behind the other, that the motion has had elsewhere.
    fn see(&mut self, _motion: &[f64]) {}

    /// Tries a step of width h from a time on.
    fn attempt(&mut self, time: f64, h: f64, equations: &mut Equations<'_, L>) -> Attempt;

    /// Follows the motion inside a good step.
    fn follow(&mut self, time: f64, h: f64, equations: &mut Equations<'_, L>);

    /// The polynomials across the step that was followed.
    fn pieces(&self) -> &Pieces;

    /// Goes on from the end of the step.
    fn go_on(&mut self);

    /// Goes on from the part theta of a piece of the step.
    fn stop_at(&mut self, piece: usize, theta: f64);
}
