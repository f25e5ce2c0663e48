//! Chains: runs one after the other, each from the state in which the last one ended.

use super::{Batch, Desk, Failure, Parameters};
use crate::error::Result;
use crate::history::Derivative;
use crate::method::piecewise_linear;
use std::sync::Arc;

/// Displacement and velocity of all modes.
type State = [Vec<f64>; 2];

impl Batch {
    /// Makes the runs of a chain, as long as `goes_on` answers so after each. One that fails is
    /// left out: the next starts where the last good one ended.
    pub(super) fn chain(
        &self,
        parameters: &Parameters<'_>,
        first: usize,
        values: &mut [f64],
        desk: &mut Desk,
        goes_on: &mut dyn FnMut() -> bool,
    ) -> Vec<Failure> {
        let mut failures = Vec::new();
        let mut state = None;
        for (number, row) in values.chunks_mut(self.width).enumerate() {
            let run = first + number;
            match self.link(parameters, run, row, desk, state.as_ref()) {
                Ok(end) => state = Some(end),
                Err(error) => {
                    row.fill(f64::NAN);
                    failures.push(Failure { run, error });
                }
            }
            if !goes_on() {
                break;
            }
        }
        failures
    }

    /// Makes one run from a state, or from its own where there is none; returns how it ends.
    fn link(
        &self,
        parameters: &Parameters<'_>,
        run: usize,
        row: &mut [f64],
        desk: &mut Desk,
        state: Option<&State>,
    ) -> Result<State> {
        let problem = Arc::make_mut(&mut desk.problem);
        let [displacement, velocity] = [&self.problem.displacement, &self.problem.velocity];
        problem.displacement.copy_from_slice(displacement);
        problem.velocity.copy_from_slice(velocity);
        parameters.set(&self.problem, run, problem)?;
        if let Some([displacement, velocity]) = state {
            problem.displacement.copy_from_slice(displacement);
            problem.velocity.copy_from_slice(velocity);
        }
        let history = piecewise_linear::simulate(&desk.problem, &mut |_| true)?;
        self.read(&history, parameters.pace(run), row)?;
        let end = [history.problem().duration];
        Ok([
            history.motion(&end, Derivative::Displacement)?,
            history.motion(&end, Derivative::Velocity)?,
        ])
    }
}
