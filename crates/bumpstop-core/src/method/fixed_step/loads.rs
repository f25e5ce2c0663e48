//! Loads that change in time, step by step.

use crate::forcing::Forcing;
use crate::number::{Block, blocks};

/// Modal forces, each times its gain.
pub(crate) struct ChangingLoads<'a> {
    forcing: &'a Forcing,
    dt: f64,
    gain: &'a [f64],
    step: usize,
    forces: Vec<Block>,
}

impl<'a> ChangingLoads<'a> {
    /// The modal forces of a problem, each times its gain.
    pub(crate) fn new(forcing: &'a Forcing, dt: f64, gain: &'a [f64]) -> Self {
        Self {
            forcing,
            dt,
            gain,
            step: 0,
            forces: blocks(gain),
        }
    }

    /// Those of the next step, the first one at t = 0.
    pub(crate) fn next(&mut self) -> &[Block] {
        let forces = &mut self.forces.as_flattened_mut()[..self.gain.len()];
        self.forcing.at(self.step as f64 * self.dt, forces);
        for (force, gain) in forces.iter_mut().zip(self.gain) {
            *force *= gain;
        }
        self.step += 1;
        &self.forces
    }
}
