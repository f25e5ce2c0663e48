//! Natural modes of small structures: the dense symmetric eigenproblem `K x = omega^2 M x`.

use super::Modes;
use crate::eigen::{SymmetricEigen, symmetric_eigen};
use crate::error::{Error, Result};
use faer::{Mat, MatRef, Side, prelude::*};

/// The dense matrix type of this module.
pub type Matrix = Mat<f64>;

/// All eigenvalues of `K x = omega^2 M x`, K symmetric, M symmetric positive definite, and the
/// `count` lowest shapes, the component of largest magnitude of each positive.
///
/// The problem is turned over, `M x = theta (K + sigma M) x` with `theta = 1/(omega^2 + sigma)`,
/// so that the low modes are the large eigenvalues and keep full relative accuracy however
/// stiff the highest mode is (Parlett, The Symmetric Eigenvalue Problem, section 15.9).
///
/// # Errors
/// [`Error::Sizes`], [`Error::SingularMass`], [`Error::TooManyModes`], [`Error::Eigenvalues`],
/// [`Error::Factorisation`] where a number is not finite.
pub fn symmetric_modes(stiffness: MatRef<f64>, mass: MatRef<f64>, count: usize) -> Result<Modes> {
    let size = stiffness.nrows();
    if [stiffness.ncols(), mass.nrows(), mass.ncols()] != [size; 3] {
        return Err(Error::Sizes {
            what: "stiffness and mass",
        });
    }
    if count > size {
        return Err(Error::TooManyModes {
            asked: count,
            available: size,
        });
    }
    let direct = generalised(stiffness, mass)?.ok_or(Error::SingularMass)?;
    let shift = shift_for(&direct.0);
    let shifted = stiffness + Scale(shift) * mass;
    let turned = generalised(mass, shifted.as_ref())?;
    let (omega2, shapes) = match turned {
        Some((theta, shapes)) => low_modes(&theta, &shapes, shift, count),
        None => (direct.0, direct.1.subcols(0, count).to_owned()),
    };
    let shapes = normalised(shapes, mass);
    if omega2.iter().any(|w| w.is_nan()) || !shapes.is_all_finite() {
        return Err(Error::Factorisation);
    }
    Ok(Modes { omega2, shapes })
}

/// Eigenpairs of `A x = lambda B x` in ascending order; `None` where B is not positive definite.
fn generalised(a: MatRef<f64>, b: MatRef<f64>) -> Result<Option<(Vec<f64>, Mat<f64>)>> {
    let Ok(factor) = b.llt(Side::Lower) else {
        return Ok(None);
    };
    let lower = factor.L();
    let mut half = a.to_owned();
    lower.solve_lower_triangular_in_place(half.as_mut());
    let mut reduced = half.transpose().to_owned();
    lower.solve_lower_triangular_in_place(reduced.as_mut());
    let symmetric = Scale(0.5) * (&reduced + reduced.transpose());
    let SymmetricEigen {
        values,
        vectors: mut shapes,
    } = symmetric_eigen(&symmetric)?;
    lower
        .transpose()
        .solve_upper_triangular_in_place(shapes.as_mut());
    Ok(Some((values, shapes)))
}

/// A shift of the size of the lowest elastic eigenvalue keeps K + shift M well conditioned.
fn shift_for(omega2: &[f64]) -> f64 {
    let largest = omega2.iter().fold(0.0f64, |m, w| m.max(w.abs()));
    let threshold = 1e-10 * largest;
    let elastic = omega2.iter().copied().find(|&w| w > threshold);
    if omega2.first().is_some_and(|&w| w > threshold) {
        0.0
    } else {
        elastic.unwrap_or(1.0)
    }
}

fn low_modes(theta: &[f64], shapes: &Mat<f64>, shift: f64, count: usize) -> (Vec<f64>, Mat<f64>) {
    let size = theta.len();
    let omega2 = theta.iter().rev().map(|t| 1.0 / t - shift).collect();
    let low = Mat::from_fn(size, count, |r, c| shapes[(r, size - 1 - c)]);
    (omega2, low)
}

fn normalised(mut shapes: Mat<f64>, mass: MatRef<f64>) -> Mat<f64> {
    let weighted = mass * &shapes;
    for c in 0..shapes.ncols() {
        let modal_mass: f64 = (0..shapes.nrows())
            .map(|r| shapes[(r, c)] * weighted[(r, c)])
            .sum();
        let largest = (0..shapes.nrows())
            .map(|r| shapes[(r, c)])
            .fold(0.0f64, |m, x| {
                if x.abs() > m.abs() * (1.0 + 1e-9) {
                    x
                } else {
                    m
                }
            });
        let factor = largest.signum() / modal_mass.sqrt();
        for r in 0..shapes.nrows() {
            shapes[(r, c)] *= factor;
        }
    }
    shapes
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A fixed-free chain of n equal masses and springs: omega_j = 2 sin((2j-1) pi / (4n+2)).
    #[test]
    fn spring_chain_agrees_with_closed_form() {
        let n = 12;
        let stiffness = Mat::from_fn(n, n, |r, c| match r.abs_diff(c) {
            0 if r == n - 1 => 1.0,
            0 => 2.0,
            1 => -1.0,
            _ => 0.0,
        });
        let mass = Mat::<f64>::identity(n, n);
        let modes = symmetric_modes(stiffness.as_ref(), mass.as_ref(), n).unwrap();
        for (j, w2) in modes.omega2.iter().enumerate() {
            let angle = (2 * j + 1) as f64 * std::f64::consts::PI / (4 * n + 2) as f64;
            let expected = (2.0 * angle.sin()).powi(2);
            assert!((w2 - expected).abs() < 1e-13 * expected.max(0.1));
        }
    }

    #[test]
    fn low_modes_stay_accurate_beside_a_very_stiff_one() {
        let stiffness = Mat::from_fn(2, 2, |r, c| if r == c { 1e14 + 1.0 } else { -1e14 });
        let mass = Mat::<f64>::identity(2, 2);
        let modes = symmetric_modes(stiffness.as_ref(), mass.as_ref(), 1).unwrap();
        // 1e14 + 1 is stored to 1/64 only; the shift must not lose more than that.
        assert!((modes.omega2[0] - 1.0).abs() < 0.05);
    }

    #[test]
    fn refuses_what_has_no_modes() {
        let stiffness = Mat::<f64>::identity(2, 2);
        let mass = Mat::from_fn(2, 2, |r, c| if r == 0 && c == 0 { 1.0 } else { 0.0 });
        let refused = symmetric_modes(stiffness.as_ref(), mass.as_ref(), 1);
        assert_eq!(refused.unwrap_err(), Error::SingularMass);
        let refused = symmetric_modes(stiffness.as_ref(), mass.as_ref().subcols(0, 1), 1);
        assert!(matches!(refused, Err(Error::Sizes { .. })));
        let unknown = Scale(f64::NAN) * &stiffness;
        let refused = symmetric_modes(unknown.as_ref(), stiffness.as_ref(), 1);
        assert_eq!(refused.unwrap_err(), Error::Factorisation);
        let refused = symmetric_modes(stiffness.as_ref(), stiffness.as_ref(), 3);
        assert!(matches!(refused, Err(Error::TooManyModes { asked: 3, .. })));
    }
}
