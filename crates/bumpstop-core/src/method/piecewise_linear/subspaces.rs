//! The subspaces of fast and of slow motions of a state matrix, where they are far apart.
//!
//! With the matrix in blocks, fast ones first, `X` solves `A_21 + A_22 X - X A_11 - X A_12 X = 0`
//! and `Y` solves `F Y - Y S + A_12 = 0` with `F = A_11 + A_12 X`, `S = A_22 - X A_12` (G. W.
//! Stewart, Error and perturbation bounds for subspaces associated with certain eigenvalue problems,
//! SIAM Review 15 (1973) 727-764). Simple iteration gains as many digits a step as fast motions are
//! faster, and every entry keeps its own: eigenvectors of the whole matrix would be right only to
//! the rounding of its largest.

use super::splitting::{Part, Split, rest_beside, split};
use crate::error::Result;
use faer::linalg::solvers::{PartialPivLu, Solve};
use faer::{Mat, c64};

/// Iterations at most.
const ITERATIONS: usize = 40;

/// Change of a solution, relative to it, that is good enough.
const SHARP: f64 = 1e-15;

/// Iterations after that: small entries follow.
const MORE: usize = 3;

/// One of the subspaces: `A right = right matrix`, `left A = matrix left`, `left right = 1`.
pub(super) struct Subspace {
    pub matrix: Mat<f64>,
    pub right: Mat<f64>,
    pub left: Mat<f64>,
}

/// The fast and the slow one.
pub(super) fn subspaces(matrix: &Mat<f64>, fast: &[usize]) -> Option<[Subspace; 2]> {
    let n = matrix.nrows();
    let slow: Vec<usize> = (0..n).filter(|i| !fast.contains(i)).collect();
    let block = |rows: &[usize], columns: &[usize]| {
        Mat::from_fn(rows.len(), columns.len(), |r, c| {
            matrix[(rows[r], columns[c])]
        })
    };
    let (a11, a12) = (block(fast, fast), block(fast, &slow));
    let (a21, a22) = (block(&slow, fast), block(&slow, &slow));
    let transposed = a11.transpose().to_owned().partial_piv_lu();
    let x = iterated(Mat::zeros(slow.len(), fast.len()), |x: &Mat<f64>| {
        let right = &a21 + &a22 * x - x * &(&a12 * x);
        divided(&right, &transposed)
    })?;
    let f = &a11 + &a12 * &x;
    let s = &a22 - &x * &a12;
    let inverse = f.partial_piv_lu();
    let y = iterated(Mat::zeros(fast.len(), slow.len()), |y: &Mat<f64>| {
        inverse.solve(y * &s - &a12)
    })?;
    let one = |count: usize| Mat::<f64>::identity(count, count);
    let (of_fast, of_slow) = (one(fast.len()) + &y * &x, one(slow.len()) + &x * &y);
    Some([
        Subspace {
            right: placed_rows([fast, &slow], [&one(fast.len()), &x]),
            left: placed_columns([fast, &slow], [&of_fast, &-&y]),
            matrix: f,
        },
        Subspace {
            right: placed_rows([fast, &slow], [&y, &of_slow]),
            left: placed_columns([fast, &slow], [&-&x, &one(slow.len())]),
            matrix: s,
        },
    ])
}

/// The motions of a state matrix under constant forces.
pub(super) struct Motions {
    pub split: Split,
    /// The constant part.
    pub rest: Mat<f64>,
    /// The first columns of slow parts, if forces drive them.
    pub driven: Vec<usize>,
}

impl Subspace {
    /// Its motions as those of the whole, under forces on the whole.
    pub(super) fn motions(
        &self,
        force: &Mat<f64>,
        slow: f64,
        keeps_energy: bool,
    ) -> Result<Motions> {
        let mut own = split(&self.matrix, slow)?;
        if keeps_energy {
            own.keep_energy();
        }
        let force = &self.left * force;
        let driven = own.driven_by(&force);
        // A rigid motion has no stiffness to divide nothing by.
        let rest = if force.norm_max() == 0.0 {
            force
        } else if driven.is_empty() {
            self.matrix.full_piv_lu().solve(-force)
        } else {
            rest_beside(&self.matrix, &force, &own)
        };
        Ok(Motions {
            rest: &self.right * rest,
            driven,
            split: Split {
                right: complex(&self.right) * own.right,
                left: own.left * complex(&self.left),
                parts: own.parts,
            },
        })
    }
}

impl Motions {
    /// Both together.
    pub(super) fn beside(self, other: Self) -> Self {
        let (n, first) = (self.rest.nrows(), self.split.left.nrows());
        let count = first + other.split.left.nrows();
        let (own, second) = (&self.split, &other.split);
        let right = Mat::from_fn(n, count, |i, c| match c.checked_sub(first) {
            Some(c) => second.right[(i, c)],
            None => own.right[(i, c)],
        });
        let left = Mat::from_fn(count, n, |r, i| match r.checked_sub(first) {
            Some(r) => second.left[(r, i)],
            None => own.left[(r, i)],
        });
        let behind = other.split.parts.into_iter().map(|part| Part {
            first: first + part.first,
            ..part
        });
        Self {
            rest: &self.rest + &other.rest,
            driven: (self.driven.into_iter())
                .chain(other.driven.iter().map(|driven| first + driven))
                .collect(),
            split: Split {
                right,
                left,
                parts: self.split.parts.into_iter().chain(behind).collect(),
            },
        }
    }
}

/// The fixed point of an iteration; `None` where it goes elsewhere.
fn iterated(start: Mat<f64>, next: impl Fn(&Mat<f64>) -> Mat<f64>) -> Option<Mat<f64>> {
    let mut present = start;
    for _ in 0..ITERATIONS {
        let found = next(&present);
        let change = (&found - &present).norm_max();
        let is_there = change <= SHARP * found.norm_max();
        present = found;
        if is_there {
            for _ in 0..MORE {
                present = next(&present);
            }
            return present.is_all_finite().then_some(present);
        }
    }
    None
}

/// `M A^-1`, by the factors of the transpose of A.
fn divided(matrix: &Mat<f64>, transposed: &PartialPivLu<f64>) -> Mat<f64> {
    transposed.solve(matrix.transpose()).transpose().to_owned()
}

fn placed_rows(places: [&[usize]; 2], parts: [&Mat<f64>; 2]) -> Mat<f64> {
    let count = places[0].len() + places[1].len();
    let mut whole = Mat::zeros(count, parts[0].ncols());
    for (rows, part) in places.iter().zip(parts) {
        for (from, to) in rows.iter().enumerate() {
            for c in 0..part.ncols() {
                whole[(*to, c)] = part[(from, c)];
            }
        }
    }
    whole
}

fn placed_columns(places: [&[usize]; 2], parts: [&Mat<f64>; 2]) -> Mat<f64> {
    let [first, second] = parts.map(|part| part.transpose().to_owned());
    placed_rows(places, [&first, &second])
        .transpose()
        .to_owned()
}

fn complex(matrix: &Mat<f64>) -> Mat<c64> {
    Mat::from_fn(matrix.nrows(), matrix.ncols(), |r, c| {
        c64::new(matrix[(r, c)], 0.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn far_apart() -> Mat<f64> {
        let entry = |r: usize, c: usize| ((1 + 5 * r + 3 * c + r * c) % 7) as f64 - 3.0;
        Mat::from_fn(6, 6, |r, c| match (r == 1 || r == 4, c == 1 || c == 4) {
            (true, true) => 1e6 * (entry(r, c) + if r == c { 6.0 } else { 0.0 }),
            (false, true) => 1e6 * entry(r, c),
            _ => entry(r, c),
        })
    }

    #[test]
    fn subspaces_are_invariant_and_their_left_ones_the_inverse() {
        let matrix = far_apart();
        let parted = subspaces(&matrix, &[1, 4]).unwrap();
        for (i, one) in parted.iter().enumerate() {
            let moved = &matrix * &one.right - &one.right * &one.matrix;
            assert!(moved.norm_max() < 1e-14 * matrix.norm_max());
            for (j, other) in parted.iter().enumerate() {
                let product = &other.left * &one.right;
                let expected = Mat::from_fn(product.nrows(), product.ncols(), |r, c| {
                    f64::from(u8::from(i == j && r == c))
                });
                assert!((product - expected).norm_max() < 1e-14);
            }
        }
    }

    #[test]
    fn the_slow_one_is_known_to_its_own_rounding() {
        let matrix = far_apart();
        let [_, slow] = subspaces(&matrix, &[1, 4]).unwrap();
        let moved = &matrix * &slow.right - &slow.right * &slow.matrix;
        let rows = [0, 2, 3, 5];
        // Rows of the slow motions sum large entries that cancel, times what is small in them.
        for r in rows {
            for c in 0..4 {
                assert!(moved[(r, c)].abs() < 1e-13 * slow.matrix.norm_max());
            }
        }
    }

    #[test]
    fn what_is_not_far_apart_is_left_together() {
        let matrix = Mat::from_fn(4, 4, |r, c| if r == c { 1.0 } else { 2.0 });
        assert!(subspaces(&matrix, &[0, 1]).is_none());
    }
}
