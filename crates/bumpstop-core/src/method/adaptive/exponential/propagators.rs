//! The exponentials of all modes for one width, and what they make of numbers and forces.

use super::phi::Propagator;
use crate::system::ModalSystem;

/// Stages of a step.
pub(super) const STAGES: usize = 5;

/// The propagators of all modes.
#[derive(Debug, Default)]
pub(super) struct Propagators {
    width: f64,
    modes: Vec<Propagator>,
}

impl Propagators {
    /// Turns to a width.
    pub(super) fn turn(&mut self, width: f64, system: &ModalSystem) {
        if width == self.width {
            return;
        }
        let own = system.omega2().iter().zip(system.damping());
        self.modes.clear();
        (self.modes).extend(own.map(|(w2, c)| Propagator::new(*w2, *c, width)));
        self.width = width;
    }

    /// Goes on from some numbers without forces.
    pub(super) fn carry(&self, from: &[f64], to: &mut [f64]) {
        let count = self.modes.len();
        to.copy_from_slice(&from[..to.len()]);
        let (to_q, to_v) = to[..2 * count].split_at_mut(count);
        for ((mode, q), v) in self.modes.iter().zip(to_q).zip(to_v) {
            let [[qq, qv], [vq, vv]] = mode.motion;
            (*q, *v) = (qq * *q + qv * *v, vq * *q + vv * *v);
        }
    }

    /// Adds the width times phi_k, k from 1 to 3, of a sum of stages.
    pub(super) fn push(
        &self,
        k: usize,
        weights: &[f64; STAGES],
        stages: &[Vec<f64>; STAGES],
        to: &mut [f64],
    ) {
        let sum = |i: usize| -> f64 {
            let both = weights.iter().zip(stages);
            both.map(|(weight, stage)| weight * stage[i]).sum()
        };
        let count = self.modes.len();
        for (i, mode) in self.modes.iter().enumerate() {
            let force = sum(count + i);
            let [q, v] = mode.pushes[k - 1];
            to[i] += q * force;
            to[count + i] += v * force;
        }
        let free = Propagator::free(self.width)[k - 1];
        for (i, to) in to.iter_mut().enumerate().skip(2 * count) {
            *to += free * sum(i);
        }
    }
}
