//! Small linear systems, solved without memory of their own.

/// Solves `matrix x = right` in place, the matrix by rows: Gaussian elimination with partial
/// pivoting. A singular matrix gives numbers that are not finite.
pub(super) fn solve(matrix: &mut [f64], right: &mut [f64]) {
    let n = right.len();
    for column in 0..n {
        let size = |row: usize| matrix[row * n + column].abs();
        let pivot = (column..n).max_by(|a, b| size(*a).total_cmp(&size(*b)));
        if let Some(pivot) = pivot.filter(|pivot| *pivot != column) {
            for k in 0..n {
                matrix.swap(pivot * n + k, column * n + k);
            }
            right.swap(pivot, column);
        }
        for row in column + 1..n {
            let factor = matrix[row * n + column] / matrix[column * n + column];
            for k in column..n {
                matrix[row * n + k] -= factor * matrix[column * n + k];
            }
            right[row] -= factor * right[column];
        }
    }
    for row in (0..n).rev() {
        let known: f64 = (row + 1..n).map(|k| matrix[row * n + k] * right[k]).sum();
        right[row] = (right[row] - known) / matrix[row * n + row];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_system_that_needs_pivots_is_solved() {
        let matrix = [0.0, 2.0, -1.0, 3.0, 0.5, 4.0, 1.0, -7.0, 2.0];
        let x = [0.3, -1.2, 2.5];
        let mut right: Vec<f64> = (matrix.chunks(3))
            .map(|row| row.iter().zip(x).map(|(a, x)| a * x).sum())
            .collect();
        solve(&mut matrix.clone(), &mut right);
        for (found, x) in right.iter().zip(x) {
            assert!((found - x).abs() < 1e-14);
        }
    }
}
