//! Principal coordinates of coupled groups, in which the state matrix is well scaled.
//!
//! With the symmetric part of the stiffness on its axes, `V' K V = diag(mu)`, and positions
//! measured in units of `1/sqrt(mu)`, a conservative system has a skew state matrix: eigenvectors
//! are orthonormal, and how far they are from it tells what damping and circulatory forces do.

use super::coupled::Coupled;
use super::stiff::Stiff;
use crate::eigen::{SymmetricEigen, symmetric_eigen, symmetric_eigenvalues};
use crate::error::Result;
use faer::{Mat, c64};

/// The least eigenvalue of a stiffness scaled to a diagonal of ones for which the groups' own
/// coordinates are kept: axes of the stiffness are good to rounding of its largest eigenvalue,
/// which is the square of what the state matrix has, and slow motions would feel it.
const WELL_SCALED: f64 = 1e-6;

/// How far apart squared frequencies are, relative to the larger one, whose eigenvectors need no
/// axes to be told from each other.
const APART: f64 = 1e-5;

/// The state `(s x, x')` with groups `y = V x`.
pub(crate) struct Principal {
    axes: Mat<f64>,
    /// The inverse of the axes, where it is not their transpose.
    inverse: Option<Mat<f64>>,
    scales: Vec<f64>,
    /// `z' = A z + b`
    pub state: Mat<f64>,
    pub force: Mat<f64>,
}

impl Principal {
    /// The coordinates for a run of the given length: what is slower is measured by it.
    pub(crate) fn new(coupled: &Coupled, duration: f64) -> Result<Self> {
        let n = coupled.stiffness.nrows();
        let (axes, stiffness) = if is_well_scaled(&coupled.stiffness)? {
            (Mat::identity(n, n), coupled.stiffness.clone())
        } else {
            on_axes(&coupled.stiffness)?
        };
        let damping = axes.transpose() * &coupled.damping * &axes;
        let force = axes.transpose() * &coupled.force;
        let own = Own {
            stiffness: &stiffness,
            damping: &damping,
            force: &force,
        };
        Ok(own.principal(axes, None, duration))
    }

    /// The coordinates in which stiff laws stand apart.
    pub(crate) fn apart(stiff: &Stiff, duration: f64) -> Self {
        let own = Own {
            stiffness: &stiff.stiffness,
            damping: &stiff.damping,
            force: &stiff.force,
        };
        own.principal(stiff.back.clone(), Some(stiff.to.clone()), duration)
    }

    /// Positions of the groups in states, one a column.
    pub(crate) fn positions(&self, states: &Mat<c64>) -> Mat<c64> {
        let n = self.scales.len();
        let scaled = Mat::from_fn(n, states.ncols(), |r, c| states[(r, c)] / self.scales[r]);
        self.complex_axes() * scaled
    }

    /// Positions and velocities of the groups in one state.
    pub(crate) fn motion(&self, state: &Mat<f64>) -> [Mat<f64>; 2] {
        let n = self.scales.len();
        let scaled = Mat::from_fn(n, 1, |r, _| state[(r, 0)] / self.scales[r]);
        [&self.axes * scaled, &self.axes * state.subrows(n, n)]
    }

    /// Rows that take positions and velocities of the groups, from rows that take states.
    pub(crate) fn left(&self, rows: &Mat<c64>) -> (Mat<c64>, Mat<c64>) {
        let n = self.scales.len();
        let scaled = Mat::from_fn(rows.nrows(), n, |r, c| rows[(r, c)] * self.scales[c]);
        let inverse = self.complex_inverse();
        (scaled * &inverse, rows.subcols(n, n) * &inverse)
    }

    fn complex_axes(&self) -> Mat<c64> {
        let n = self.scales.len();
        Mat::from_fn(n, n, |r, c| c64::new(self.axes[(r, c)], 0.0))
    }

    fn complex_inverse(&self) -> Mat<c64> {
        let n = self.scales.len();
        Mat::from_fn(n, n, |r, c| match &self.inverse {
            Some(inverse) => c64::new(inverse[(r, c)], 0.0),
            None => c64::new(self.axes[(c, r)], 0.0),
        })
    }
}

/// The equations along coordinates of their own.
struct Own<'a> {
    stiffness: &'a Mat<f64>,
    damping: &'a Mat<f64>,
    force: &'a Mat<f64>,
}

impl Own<'_> {
    fn principal(&self, axes: Mat<f64>, inverse: Option<Mat<f64>>, duration: f64) -> Principal {
        let n = axes.nrows();
        let (stiffness, damping, push) = (self.stiffness, self.damping, self.force);
        let scales: Vec<f64> = (0..n)
            .map(|i| stiffness[(i, i)].abs().sqrt().max(1.0 / duration))
            .collect();
        let state = Mat::from_fn(2 * n, 2 * n, |r, c| match (r < n, c < n) {
            (true, true) => 0.0,
            (true, false) if r + n == c => scales[r],
            (true, false) => 0.0,
            (false, true) => -stiffness[(r - n, c)] / scales[c],
            (false, false) => -damping[(r - n, c - n)],
        });
        let force = Mat::from_fn(2 * n, 1, |r, _| if r < n { 0.0 } else { push[(r - n, 0)] });
        Principal {
            axes,
            inverse,
            scales,
            state,
            force,
        }
    }
}

/// Whether the groups' own coordinates serve: moderate springs between them, and squared
/// frequencies apart from each other.
fn is_well_scaled(stiffness: &Mat<f64>) -> Result<bool> {
    let n = stiffness.nrows();
    if (0..n).any(|i| stiffness[(i, i)] <= 0.0) {
        return Ok(false);
    }
    let values = |unit: fn(f64) -> f64| {
        let symmetric = Mat::from_fn(n, n, |r, c| {
            let size = unit(stiffness[(r, r)]) * unit(stiffness[(c, c)]);
            0.5 * (stiffness[(r, c)] + stiffness[(c, r)]) / size
        });
        symmetric_eigenvalues(&symmetric)
    };
    let [scaled, squares] = [values(f64::sqrt)?, values(|_| 1.0)?];
    let apart = |pair: &[f64]| pair[1] - pair[0] > APART * pair[1];
    Ok(scaled.iter().all(|value| *value > WELL_SCALED) && squares.windows(2).all(apart))
}

/// The axes of the symmetric part, and the stiffness along them.
fn on_axes(stiffness: &Mat<f64>) -> Result<(Mat<f64>, Mat<f64>)> {
    let n = stiffness.nrows();
    let symmetric = Mat::from_fn(n, n, |r, c| 0.5 * (stiffness[(r, c)] + stiffness[(c, r)]));
    let skew = Mat::from_fn(n, n, |r, c| 0.5 * (stiffness[(r, c)] - stiffness[(c, r)]));
    let SymmetricEigen {
        values,
        vectors: axes,
    } = symmetric_eigen(&symmetric)?;
    let mut turned = axes.transpose() * skew * &axes;
    for i in 0..n {
        turned[(i, i)] += values[i];
    }
    Ok((axes, turned))
}
