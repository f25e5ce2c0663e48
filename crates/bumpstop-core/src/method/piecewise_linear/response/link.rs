//! How the modes move with one derivative, or integral, of a load.

use crate::method::piecewise_linear::polynomial::of_derivative;
use std::ops::Range;

/// A vector that a derivative of a channel's function moves the modes along.
#[derive(Debug, Clone)]
pub(crate) struct Link {
    pub channel: usize,
    /// Order of the derivative that pushes.
    pub pushed: usize,
    /// Order of the derivative that moves; integrals of what pushes have lower ones, and are taken
    /// from the start of the phase.
    pub order: i32,
    pub row: Vec<f64>,
}

impl Link {
    /// The powers of the time that the so many-th rate of it has, with so many coefficients of the
    /// channel. What pushes knows nothing of those that it has lost.
    pub(crate) fn powers(&self, rate: usize, coefficients: usize) -> Range<usize> {
        let order = self.order + rate as i32;
        let power = |coefficient: usize| (coefficient as i32 - order).max(0) as usize;
        power(self.pushed)..power(coefficients)
    }

    /// Whether neither it nor its rate moves anything at the start of a phase.
    pub(super) fn starts_from_rest(&self) -> bool {
        self.order + 1 < self.pushed as i32
    }

    /// The coefficient of one of them.
    #[inline(always)]
    pub(crate) fn coefficient(&self, channel: &[f64], rate: usize, power: usize) -> f64 {
        of_derivative(channel, self.order + rate as i32, power)
    }

    /// The value of a rate of it.
    pub(super) fn value(&self, channel: &[f64], rate: usize, t: f64) -> f64 {
        let powers = self.powers(rate, channel.len());
        let lowest = t.powi(powers.start as i32);
        let coefficient = |power| self.coefficient(channel, rate, power);
        (powers.rev()).fold(0.0, |value, power| value * t + coefficient(power)) * lowest
    }
}
