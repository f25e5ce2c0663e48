//! The norms in which errors are followed.

use super::equations::Equations;
use super::state_matrix::StateMatrix;

/// Rises that the energy norm may allow before the vectors of the motion are looked at.
const MODEST_RISE: f64 = 10.0;

/// A norm `e^2 = |y'|^2 + y' H^2 y` of errors, H along the axes of the stiffness' symmetric part,
/// and what it may become from one switch to the next.
pub(super) struct ErrorNorm<'a> {
    equations: &'a Equations,
    /// Squares of H, one an axis.
    squares: Vec<f64>,
    /// The largest norm an error of unit norm may have until the next switch.
    pub rise: f64,
}

impl<'a> ErrorNorm<'a> {
    /// The energy norm, or where that may grow much the norm of amplitudes, if it grows less.
    pub(super) fn new(equations: &'a Equations, length: f64) -> Self {
        let energy = Self::of_energy(equations, length);
        if energy.rise <= MODEST_RISE {
            return energy;
        }
        match Self::of_amplitudes(equations, length) {
            Some(amplitudes) if amplitudes.rise < energy.rise => amplitudes,
            _ => energy,
        }
    }

    /// A stiffness that is not positive is moved up until its least eigenvalue is that of a
    /// motion as slow as the stretch is long, or as unstable as the structure.
    fn of_energy(equations: &'a Equations, length: f64) -> Self {
        let least = (equations.stiffness.iter()).fold(f64::INFINITY, |m, k| m.min(*k));
        let floor = (-least).max(1.0 / (length * length)).min(f64::MAX);
        let shift = (floor - least).max(0.0);
        let softest = (least + shift).sqrt();
        let growth = equations.pumping + shift / softest + equations.circulation(softest);
        Self {
            equations,
            squares: equations.stiffness.iter().map(|k| k + shift).collect(),
            rise: (growth * length).exp(),
        }
    }

    /// The amplitudes along the eigenvectors of the motion grow as their exponents say, whatever
    /// the matrices' symmetry. `None` where the vectors are nearly dependent, or reactions hold.
    fn of_amplitudes(equations: &'a Equations, length: f64) -> Option<Self> {
        if equations.holds() {
            return None;
        }
        let slowest = 1.0 / (length * length);
        let floored = equations.stiffness.iter().map(|k| k.abs().max(slowest));
        let squares: Vec<f64> = floored.collect();
        let matrix = StateMatrix::new(equations, &squares);
        let rise = matrix.largest_rise(length)?;
        Some(Self {
            equations,
            squares,
            rise,
        })
    }

    /// A bound of the norm of a state of which the sizes of position and velocity are known.
    pub(super) fn of_state(&self, position: &[f64], velocity: &[f64]) -> f64 {
        let stiffest = (self.squares.iter()).fold(0.0f64, |m, k| m.max(*k));
        size(velocity) + stiffest.sqrt() * size(position)
    }

    /// The largest `row . y` of a state of unit norm.
    pub(super) fn reach(&self, row: &[f64]) -> f64 {
        let directions = &self.equations.directions;
        let along = |k: usize| -> f64 { (0..row.len()).map(|i| row[i] * directions[(i, k)]).sum() };
        let squares = (0..row.len()).map(|k| along(k).powi(2) / self.squares[k]);
        squares.sum::<f64>().sqrt()
    }
}

/// The length of a vector.
pub(super) fn size(vector: &[f64]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}
