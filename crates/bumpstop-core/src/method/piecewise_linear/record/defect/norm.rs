//! The norm in which errors are followed.

use super::equations::Equations;

/// The energy norm of one phase.
pub(super) struct EnergyNorm<'a> {
    equations: &'a Equations,
    /// What is added to the stiffness in all directions to make it positive.
    shift: f64,
    /// Rate at which the norm may grow by itself.
    pub growth: f64,
}

impl<'a> EnergyNorm<'a> {
    /// A stiffness that is not positive is moved up until its least eigenvalue is that of a
    /// motion as slow as the phase is long, or as unstable as the structure.
    pub(super) fn new(equations: &'a Equations, length: f64) -> Self {
        let least = (equations.stiffness.iter()).fold(f64::INFINITY, |m, k| m.min(*k));
        let floor = (-least).max(1.0 / (length * length)).min(f64::MAX);
        let shift = (floor - least).max(0.0);
        let softest = (least + shift).sqrt();
        let mut growth = equations.pumping + shift / softest;
        growth += equations.circulation(softest);
        Self {
            equations,
            shift,
            growth,
        }
    }

    /// A bound of the norm of a state of which the sizes of position and velocity are known.
    pub(super) fn of_state(&self, position: &[f64], velocity: &[f64]) -> f64 {
        let stiffest = (self.equations.stiffness.iter()).fold(0.0f64, |m, k| m.max(*k));
        size(velocity) + (stiffest + self.shift).sqrt() * size(position)
    }

    /// The largest `row . y` of a state of unit norm.
    pub(super) fn reach(&self, row: &[f64]) -> f64 {
        let Equations {
            stiffness,
            directions,
            ..
        } = self.equations;
        let along = |k: usize| -> f64 { (0..row.len()).map(|i| row[i] * directions[(i, k)]).sum() };
        let squares = (0..row.len()).map(|k| along(k).powi(2) / (stiffness[k] + self.shift));
        squares.sum::<f64>().sqrt()
    }
}

/// The length of a vector.
pub(super) fn size(vector: &[f64]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}
