//! How much an error may grow at most, from the eigenvectors of the state matrix.

use super::equations::Equations;
use super::residual::rounding;
use crate::eigen::{GeneralEigen, general_eigen};
use faer::linalg::solvers::Solve;
use faer::{Mat, c64};

/// Eigenvectors nearer to dependence than this tell nothing.
const NEARLY_DEPENDENT: f64 = 1e-9;

/// The matrix A of `x' = A x`, where x holds positions, each times its frequency in the norm, and
/// velocities, all along the axes of the stiffness' symmetric part.
pub(super) struct StateMatrix {
    matrix: Mat<f64>,
    /// The frequencies.
    scales: Vec<f64>,
}

impl StateMatrix {
    /// The free motion of the equations, positions measured in frequencies of these squares.
    pub(super) fn new(equations: &Equations, squares: &[f64]) -> Self {
        let n = squares.len();
        let scales: Vec<f64> = squares.iter().map(|s| s.sqrt()).collect();
        let axes = &equations.directions;
        let turned = |matrix: &Mat<f64>| axes.transpose() * matrix * axes;
        let stiffness = turned(&equations.coupled.stiffness);
        let damping = turned(&equations.coupled.damping);
        let matrix = Mat::from_fn(2 * n, 2 * n, |row, column| match (row < n, column < n) {
            (true, true) => 0.0,
            (true, false) if row == column - n => scales[row],
            (true, false) => 0.0,
            (false, true) => -stiffness[(row - n, column)] / scales[column],
            (false, false) => -damping[(row - n, column - n)],
        });
        Self { matrix, scales }
    }

    /// A bound of `|exp(A t)|` up to a time; `None` where the eigenvectors give none.
    ///
    /// With `V` the computed eigenvectors, `V^-1 A V = Lambda + V^-1 (A V - V Lambda)`, so
    /// amplitudes grow by the fastest exponent and by the size of what the vectors leave.
    /// Motions slower than the time is long have nearly equal exponents; a spring holds them, and
    /// what it pushes is taken back as a disturbance.
    pub(super) fn largest_rise(&self, length: f64) -> Option<f64> {
        let free = vec![0.0; self.scales.len()];
        if let Some(rise) = self.rise(&free, length)
            && rise.is_slow_free
        {
            return Some(rise.bound);
        }
        let spring = 1.0 / (length * length);
        let springs: Vec<f64> = self.scales.iter().map(|scale| spring / scale).collect();
        Some(self.rise(&springs, length)?.bound)
    }

    fn rise(&self, springs: &[f64], length: f64) -> Option<Rise> {
        let n = springs.len();
        let held = Mat::from_fn(2 * n, 2 * n, |row, column| {
            let spring = if row == column + n {
                springs[column]
            } else {
                0.0
            };
            self.matrix[(row, column)] - spring
        });
        let GeneralEigen {
            values: exponents,
            vectors,
        } = general_eigen(&held).ok()?;
        let vectors = with_unit_columns(&vectors);
        let spread = vectors.singular_values().ok()?;
        let (most, computed) = (*spread.first()?, *spread.last()?);
        let least = computed - rounding(2 * n) * most;
        if least.is_nan() || least <= NEARLY_DEPENDENT * most {
            return None;
        }
        let complex = Mat::from_fn(2 * n, 2 * n, |i, j| c64::new(held[(i, j)], 0.0));
        let moved = &complex * &vectors;
        let left = Mat::from_fn(2 * n, 2 * n, |i, j| {
            moved[(i, j)] - vectors[(i, j)] * exponents[j]
        });
        // The rounding of A as it stands here, turned to the axes, and of the products with it.
        let noise = 8.0 * rounding(4 * n) * held.norm_l2() * most;
        let pushed = Mat::from_fn(2 * n, 2 * n, |i, j| match i.checked_sub(n) {
            Some(row) => vectors[(row, j)] * springs[row],
            None => c64::new(0.0, 0.0),
        });
        let disturbed = vectors.partial_piv_lu().solve(&pushed).norm_l2();
        let fastest = exponents.iter().fold(0.0f64, |most, s| most.max(s.re));
        let growth = fastest + (left.norm_l2() + noise) / least + disturbed;
        let slowest = exponents.iter().fold(f64::INFINITY, |m, s| m.min(s.norm()));
        Some(Rise {
            bound: most / least * (growth * length).exp(),
            is_slow_free: slowest * length > 1.0,
        })
    }
}

/// How far amplitudes may grow.
struct Rise {
    bound: f64,
    /// Whether no motion is so slow that it hardly turns back in time.
    is_slow_free: bool,
}

fn with_unit_columns(vectors: &Mat<c64>) -> Mat<c64> {
    let lengths: Vec<f64> = (0..vectors.ncols())
        .map(|j| vectors.col(j).norm_l2())
        .collect();
    Mat::from_fn(vectors.nrows(), vectors.ncols(), |i, j| {
        vectors[(i, j)] / lengths[j]
    })
}
