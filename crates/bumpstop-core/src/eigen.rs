//! Eigenvalues of matrices of any norm.
//!
//! From 128 rows on faer divides and conquers (J. J. M. Cuppen, Numer. Math. 36 (1981) 177-195),
//! and leaves out what couples the halves below a tolerance that is relative to the matrix or to
//! one, whichever is larger: a matrix of norm 1e-8 comes out with half of its digits, and one of
//! norm 1e15 suffers too; eigenvectors of general matrices of norm 1e-16 are lost altogether. So
//! every matrix is solved at a norm of about one, as LAPACK's `dsyevd` does it. The factor is a
//! power of two: it rounds nothing.

use crate::error::{Error, Result};
use faer::{Mat, Scale, Side, c64};

/// Eigenvalues in ascending order, and orthonormal eigenvectors.
pub(crate) struct SymmetricEigen {
    pub values: Vec<f64>,
    /// One a column.
    pub vectors: Mat<f64>,
}

/// Eigenvalues and vectors of a symmetric matrix, of which the lower half is read.
///
/// # Errors
/// [`Error::Eigenvalues`] where they do not converge.
pub(crate) fn symmetric_eigen(matrix: &Mat<f64>) -> Result<SymmetricEigen> {
    let norm = power_of_two(matrix);
    let eigen = (Scale(1.0 / norm) * matrix)
        .self_adjoint_eigen(Side::Lower)
        .map_err(|_| Error::Eigenvalues)?;
    let values = eigen.S().column_vector().iter();
    Ok(SymmetricEigen {
        values: values.map(|value| norm * value).collect(),
        vectors: eigen.U().to_owned(),
    })
}

/// The eigenvalues alone, in ascending order.
///
/// # Errors
/// [`Error::Eigenvalues`] where they do not converge.
pub(crate) fn symmetric_eigenvalues(matrix: &Mat<f64>) -> Result<Vec<f64>> {
    let norm = power_of_two(matrix);
    let mut values = (Scale(1.0 / norm) * matrix)
        .self_adjoint_eigenvalues(Side::Lower)
        .map_err(|_| Error::Eigenvalues)?;
    for value in &mut values {
        *value *= norm;
    }
    Ok(values)
}

/// Eigenvalues of a general matrix, and eigenvectors of any length.
pub(crate) struct GeneralEigen {
    pub values: Vec<c64>,
    /// One a column.
    pub vectors: Mat<c64>,
}

/// Eigenvalues and vectors of a general matrix.
///
/// # Errors
/// [`Error::Eigenvalues`] where they do not converge.
pub(crate) fn general_eigen(matrix: &Mat<f64>) -> Result<GeneralEigen> {
    let norm = power_of_two(matrix);
    let eigen = (Scale(1.0 / norm) * matrix)
        .eigen()
        .map_err(|_| Error::Eigenvalues)?;
    let values = eigen.S().column_vector().iter();
    Ok(GeneralEigen {
        values: (values.map(|value| c64::new(norm * value.re, norm * value.im))).collect(),
        vectors: eigen.U().to_owned(),
    })
}

/// The power of two next below the largest entry; one where there is none.
fn power_of_two(matrix: &Mat<f64>) -> f64 {
    let exponent = matrix.norm_max().to_bits() & f64::INFINITY.to_bits();
    let power = f64::from_bits(exponent);
    if power.is_normal() { power } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// `min(i, j)`, the flexibility of a chain of springs that is held at one end: eigenvalues
    /// `1 / (2 sin(a))^2` with `a = (2 k - 1) pi / (4 n + 2)`, vectors `sin(2 a i)`.
    fn flexibility(size: usize, norm: f64) -> Mat<f64> {
        Mat::from_fn(size, size, |r, c| norm * (r.min(c) + 1) as f64)
    }

    fn angle(size: usize, from_the_top: usize) -> f64 {
        (2 * from_the_top + 1) as f64 * PI / (4 * size + 2) as f64
    }

    fn check(size: usize, exponent: i32) {
        let norm = 2.0f64.powi(exponent);
        let matrix = flexibility(size, norm);
        let found = symmetric_eigen(&matrix).unwrap();
        let alone = symmetric_eigenvalues(&matrix).unwrap();
        let highest = norm / (2.0 * angle(size, 0).sin()).powi(2);
        for k in 0..size {
            let expected = norm / (2.0 * angle(size, k).sin()).powi(2);
            for value in [found.values[size - 1 - k], alone[size - 1 - k]] {
                // What rounding of the matrix makes of eigenvalues.
                assert!(
                    (value - expected).abs() < 1e-14 * highest,
                    "{size} {exponent} {k}"
                );
            }
        }
        let unit = found.vectors.transpose() * &found.vectors;
        assert!((unit - Mat::<f64>::identity(size, size)).norm_max() < 1e-13);
        // The highest are far apart from each other: so are their vectors.
        for k in 0..size.min(4) {
            let length = ((2 * size + 1) as f64 / 4.0).sqrt();
            let shape = |i: usize| (2.0 * angle(size, k) * (i + 1) as f64).sin() / length;
            let sign = found.vectors[(size - 1, size - 1 - k)] * shape(size - 1);
            for i in 0..size {
                let value = found.vectors[(i, size - 1 - k)] * sign.signum();
                assert!((value - shape(i)).abs() < 1e-13, "{size} {exponent} {k}");
            }
        }
    }

    #[test]
    fn agrees_with_closed_forms_at_every_norm() {
        for exponent in [-60, -31, -8, 0, 8, 31, 60] {
            check(130, exponent);
        }
    }

    #[test]
    fn agrees_with_closed_forms_at_every_size() {
        for (size, exponent) in [
            (1, 60),
            (2, -60),
            (127, -60),
            (128, 60),
            (200, -60),
            (600, 60),
        ] {
            check(size, exponent);
        }
    }

    /// A ring in which each moves the next: the eigenvalues are the roots of one.
    #[test]
    fn general_matrices_of_every_norm() {
        let size = 40;
        for exponent in [-90, -60, 0, 60] {
            let norm = 2.0f64.powi(exponent);
            let ring = Mat::from_fn(size, size, |r, c| {
                norm * f64::from(u8::from((c + 1) % size == r))
            });
            let found = general_eigen(&ring).unwrap();
            for (k, value) in found.values.iter().enumerate() {
                assert!((value.norm() - norm).abs() < 1e-14 * norm);
                let turns = value.arg() / (2.0 * PI) * size as f64;
                assert!((turns - turns.round()).abs() < 1e-12);
                for i in 0..size {
                    let before = found.vectors[((i + size - 1) % size, k)];
                    let turned = found.vectors[(i, k)] * value / norm;
                    assert!((before - turned).norm() < 1e-13, "{exponent} {k}");
                }
            }
        }
    }

    #[test]
    fn the_norm_changes_no_bit() {
        let one = symmetric_eigen(&flexibility(150, 1.0)).unwrap();
        let other = symmetric_eigen(&flexibility(150, 2.0f64.powi(-900))).unwrap();
        assert_eq!(one.vectors, other.vectors);
        for (one, other) in one.values.iter().zip(&other.values) {
            assert_eq!(*one, other * 2.0f64.powi(900));
        }
    }

    #[test]
    fn the_largest_and_the_least_numbers() {
        for value in [0.0, 5e-324, f64::MIN_POSITIVE, f64::MAX] {
            let found = symmetric_eigen(&Mat::full(1, 1, value)).unwrap();
            assert_eq!(found.values, [value]);
        }
    }
}
