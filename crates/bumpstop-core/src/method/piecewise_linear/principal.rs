//! Principal coordinates of coupled groups, in which the state matrix is well scaled.
//!
//! With the symmetric part of the stiffness on its axes, `V' K V = diag(mu)`, and positions
//! measured in units of `1/sqrt(mu)`, a conservative system has a skew state matrix: eigenvectors
//! are orthonormal, and how far they are from it tells what damping and circulatory forces do.

use super::coupled::Coupled;
use crate::error::{Error, Result};
use faer::{Mat, Side, c64};

/// The state `(s x, x')` with groups `y = V x`.
pub(crate) struct Principal {
    axes: Mat<f64>,
    scales: Vec<f64>,
    /// `z' = A z + b`
    pub state: Mat<f64>,
    pub force: Mat<f64>,
}

impl Principal {
    /// The coordinates for a run of the given length: what is slower is measured by it.
    pub(crate) fn new(coupled: &Coupled, duration: f64) -> Result<Self> {
        let n = coupled.stiffness.nrows();
        let (stiffness, damping) = (&coupled.stiffness, &coupled.damping);
        let symmetric = Mat::from_fn(n, n, |r, c| 0.5 * (stiffness[(r, c)] + stiffness[(c, r)]));
        let skew = Mat::from_fn(n, n, |r, c| 0.5 * (stiffness[(r, c)] - stiffness[(c, r)]));
        let eigen = (symmetric.self_adjoint_eigen(Side::Lower)).map_err(|_| Error::Eigenvalues)?;
        let axes = eigen.U().to_owned();
        let values: Vec<f64> = (0..n).map(|i| eigen.S()[i]).collect();
        let scales: Vec<f64> = (values.iter())
            .map(|mu| mu.abs().sqrt().max(1.0 / duration))
            .collect();
        let turned = |matrix: &Mat<f64>| axes.transpose() * matrix * &axes;
        let (skew, damping) = (turned(&skew), turned(damping));
        let state = Mat::from_fn(2 * n, 2 * n, |r, c| match (r < n, c < n) {
            (true, true) => 0.0,
            (true, false) if r + n == c => scales[r],
            (true, false) => 0.0,
            (false, true) => {
                let own = if r - n == c { values[c] } else { 0.0 };
                -(own + skew[(r - n, c)]) / scales[c]
            }
            (false, false) => -damping[(r - n, c - n)],
        });
        let push = axes.transpose() * &coupled.force;
        let force = Mat::from_fn(2 * n, 1, |r, _| if r < n { 0.0 } else { push[(r - n, 0)] });
        Ok(Self {
            axes,
            scales,
            state,
            force,
        })
    }

    /// Positions of the groups in states, one a column.
    pub(crate) fn positions(&self, states: &Mat<c64>) -> Mat<c64> {
        let n = self.scales.len();
        let scaled = Mat::from_fn(n, states.ncols(), |r, c| states[(r, c)] / self.scales[r]);
        self.complex_axes() * scaled
    }

    /// Velocities of the groups in states.
    pub(crate) fn velocities(&self, states: &Mat<c64>) -> Mat<c64> {
        let n = self.scales.len();
        self.complex_axes() * states.subrows(n, n)
    }

    /// Rows that take positions and velocities of the groups, from rows that take states.
    pub(crate) fn left(&self, rows: &Mat<c64>) -> (Mat<c64>, Mat<c64>) {
        let n = self.scales.len();
        let scaled = Mat::from_fn(rows.nrows(), n, |r, c| rows[(r, c)] * self.scales[c]);
        let axes = self.complex_axes();
        let back = axes.transpose();
        (scaled * back, rows.subcols(n, n) * back)
    }

    fn complex_axes(&self) -> Mat<c64> {
        let n = self.scales.len();
        Mat::from_fn(n, n, |r, c| c64::new(self.axes[(r, c)], 0.0))
    }
}
