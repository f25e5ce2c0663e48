//! The linear complementarity problem `w = M z + q`, `w >= 0`, `z >= 0`, `w . z = 0`.
//!
//! Lemke's algorithm with the lexicographic rule, which ends after finitely many pivots for any
//! M, and with a solution wherever there is one if M is positive semidefinite: R. W. Cottle,
//! J.-S. Pang, R. E. Stone, *The Linear Complementarity Problem*, SIAM 2009, sections 4.4 and 4.9.

use faer::Mat;
use std::cmp::Ordering;

/// Entries of the scaled tableau below this count as zero in the choice of a pivot.
const SMALLEST_PIVOT: f64 = 1e-11;

/// The solution z for a positive semidefinite matrix with a positive diagonal; `None` where there
/// is none.
pub(crate) fn solve(matrix: &Mat<f64>, constant: &[f64]) -> Option<Vec<f64>> {
    let n = constant.len();
    if constant.iter().all(|q| *q >= 0.0) {
        return Some(vec![0.0; n]);
    }
    if n == 1 {
        return Some(vec![-constant[0] / matrix[(0, 0)]]);
    }
    let mut tableau = Tableau::new(matrix, constant);
    let artificial = 2 * n;
    let first = tableau.most_negative();
    let mut left = tableau.pivot(first, artificial);
    // Each basis is met once at most; far more than what small problems take.
    for _ in 0..(200 * n) {
        let entering = if left < n { left + n } else { left - n };
        let row = tableau.leaving(entering, artificial)?;
        left = tableau.pivot(row, entering);
        if left == artificial {
            return Some(tableau.solution());
        }
    }
    None
}

/// Rows `I w - M z - z0 = q`, scaled to a unit diagonal of M; columns w, z, z0, q.
struct Tableau {
    rows: Vec<Vec<f64>>,
    basis: Vec<usize>,
    scale: Vec<f64>,
}

impl Tableau {
    fn new(matrix: &Mat<f64>, constant: &[f64]) -> Self {
        let n = constant.len();
        let scale: Vec<f64> = (0..n).map(|i| 1.0 / matrix[(i, i)].sqrt()).collect();
        let row = |i: usize| {
            let mut row = vec![0.0; 2 * n + 2];
            row[i] = 1.0;
            for j in 0..n {
                row[n + j] = -scale[i] * matrix[(i, j)] * scale[j];
            }
            row[2 * n] = -1.0;
            row[2 * n + 1] = scale[i] * constant[i];
            row
        };
        Self {
            rows: (0..n).map(row).collect(),
            basis: (0..n).collect(),
            scale,
        }
    }

    fn constant(&self, row: usize) -> f64 {
        self.rows[row][2 * self.basis.len() + 1]
    }

    fn most_negative(&self) -> usize {
        let rows = 0..self.basis.len();
        // Of equal ones the last, as the lexicographic order has it.
        let below =
            |a: &usize, b: &usize| (self.constant(*a).total_cmp(&self.constant(*b))).then(b.cmp(a));
        rows.min_by(below).unwrap_or(0)
    }

    /// The row whose variable reaches zero first when another one grows.
    fn leaving(&self, entering: usize, artificial: usize) -> Option<usize> {
        let rows = 0..self.basis.len();
        let falls = |row: &usize| self.rows[*row][entering] > SMALLEST_PIVOT;
        let order = |a: &usize, b: &usize| self.compare(*a, *b, entering, artificial);
        rows.filter(falls).min_by(order)
    }

    /// Order of the ratios, ties broken by the columns of w: those are the inverse of the basis.
    fn compare(&self, a: usize, b: usize, entering: usize, artificial: usize) -> Ordering {
        let ratio = |row: usize, value: f64| value / self.rows[row][entering];
        let (x, y) = (ratio(a, self.constant(a)), ratio(b, self.constant(b)));
        let same = (x - y).abs() <= SMALLEST_PIVOT * x.abs().max(y.abs());
        if !same {
            return x.total_cmp(&y);
        }
        // The way ends where the artificial variable may leave.
        match (self.basis[a] == artificial, self.basis[b] == artificial) {
            (true, false) => return Ordering::Less,
            (false, true) => return Ordering::Greater,
            _ => {}
        }
        (0..self.basis.len())
            .map(|j| ratio(a, self.rows[a][j]).total_cmp(&ratio(b, self.rows[b][j])))
            .find(|order| order.is_ne())
            .unwrap_or(Ordering::Equal)
    }

    /// Exchanges the variable of a row for another; returns the one that left.
    fn pivot(&mut self, row: usize, entering: usize) -> usize {
        let factor = 1.0 / self.rows[row][entering];
        self.rows[row].iter_mut().for_each(|x| *x *= factor);
        let pivot = self.rows[row].clone();
        for (number, other) in self.rows.iter_mut().enumerate() {
            let factor = other[entering];
            if number != row && factor != 0.0 {
                for (x, p) in other.iter_mut().zip(&pivot) {
                    *x -= factor * p;
                }
            }
        }
        std::mem::replace(&mut self.basis[row], entering)
    }

    fn solution(&self) -> Vec<f64> {
        let n = self.basis.len();
        let mut solution = vec![0.0; n];
        for (row, &variable) in self.basis.iter().enumerate() {
            if (n..2 * n).contains(&variable) {
                let own = variable - n;
                solution[own] = (self.scale[own] * self.constant(row)).max(0.0);
            }
        }
        solution
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Semidefinite problems of every rank are solved: M = R R' of few columns, and a
        /// constant that R can reach.
        #[test]
        fn solves_feasible_semidefinite_problems(
            n in 1usize..7, columns in 1usize..7,
            entries in prop::collection::vec(-1.0f64..1.0, 36),
            reached in prop::collection::vec(-1.0f64..1.0, 6),
            above in prop::collection::vec(0.0f64..0.3, 6),
        ) {
            let r = |i: usize, k: usize| entries[6 * i + k];
            let matrix = Mat::from_fn(n, n, |i, j| {
                (0..columns).map(|k| r(i, k) * r(j, k)).sum::<f64>()
            });
            prop_assume!((0..n).all(|i| matrix[(i, i)] > 1e-3));
            let constant: Vec<f64> = (0..n)
                .map(|i| above[i] + (0..columns).map(|k| r(i, k) * reached[k]).sum::<f64>())
                .collect();
            let z = solve(&matrix, &constant);
            prop_assert!(z.is_some());
            let z = z.unwrap_or_default();
            for i in 0..n {
                let w = constant[i] + (0..n).map(|j| matrix[(i, j)] * z[j]).sum::<f64>();
                let size = 1.0 + z.iter().fold(0.0f64, |m, z| m.max(*z));
                prop_assert!(z[i] >= 0.0 && w >= -1e-9 * size, "{i}: z {} w {w}", z[i]);
                prop_assert!((w * z[i]).abs() <= 1e-8 * size * size, "{i}: z {} w {w}", z[i]);
            }
        }
    }

    #[test]
    fn opposite_walls_share_what_one_of_them_needs() {
        let matrix = Mat::from_fn(2, 2, |i, j| if i == j { 2.0 } else { -2.0 });
        assert_eq!(solve(&matrix, &[-3.0, 3.0]), Some(vec![1.5, 0.0]));
    }

    #[test]
    fn walls_that_ask_for_more_than_there_is_are_not_satisfied() {
        let matrix = Mat::from_fn(2, 2, |i, j| if i == j { 1.0 } else { -1.0 });
        assert_eq!(solve(&matrix, &[-2.0, 1.0]), None);
    }
}
