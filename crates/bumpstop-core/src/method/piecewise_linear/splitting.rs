//! A state matrix split into exponents and clusters of them.
//!
//! Eigenvectors are taken as they come as long as they are well apart. Those that are nearly
//! parallel are joined to a cluster, which is described by an orthonormal basis of the subspace
//! that it spans: well determined where the single vectors are not. The basis is made sharp by
//! inverse subspace iteration (G. H. Golub, C. F. Van Loan, Matrix Computations, 4th ed.,
//! sections 7.3 and 7.6). Left vectors are the rows of the inverse of all of them together.

use super::cluster::MOST;
use crate::eigen::{GeneralEigen, general_eigen};
use crate::error::Result;
use faer::linalg::solvers::Solve;
use faer::{Mat, Scale, c64};

/// Unit vectors whose product is larger than this are nearly parallel.
const PARALLEL: f64 = 1.0 - 1e-5;

/// Only exponents nearer to each other than this part of their size are tried for that.
const NEAR: f64 = 0.1;

/// Distance, as a part of their size, at which other exponents join a cluster.
const CLOSE: f64 = 1e-3;

/// Sizes of left vectors (of unit right ones) above which so many digits are lost that exponents
/// are joined.
const LARGEST_CONDITION: f64 = 1e3;

/// Subspace iterations; with exponents well apart two or three suffice.
const ITERATIONS: usize = 100;

/// Part of a vector beside others below which it is made of them.
const DEPENDENT: f64 = 1e-12;

/// Residual of a subspace, relative to the matrix, that is as good as rounding.
const SHARP: f64 = 4.0 * f64::EPSILON;

/// One exponent, or a cluster, by its columns.
#[derive(Debug, Clone)]
pub(crate) struct Part {
    pub first: usize,
    pub generator: Mat<c64>,
    /// Whether its columns are real; else their conjugates belong to the motion too.
    pub is_real: bool,
    pub is_slow: bool,
}

impl Part {
    /// How many times the real part of it counts: a complex one stands for its conjugate, too.
    pub(crate) fn sides(&self) -> f64 {
        if self.is_real { 1.0 } else { 2.0 }
    }
}

/// `A X = X B` and `Y A = B Y`, `Y X = 1`, for one of each conjugate pair of parts.
#[derive(Debug, Clone)]
pub(crate) struct Split {
    pub right: Mat<c64>,
    pub left: Mat<c64>,
    pub parts: Vec<Part>,
}

/// Eigenvalues and which of them belong together.
struct Sets {
    values: Vec<c64>,
    vectors: Mat<c64>,
    conjugate: Vec<usize>,
    label: Vec<usize>,
    slow: f64,
}

/// Part of an exponent that rounding may make of nothing.
const NOTHING: f64 = 1e-11;

impl Split {
    /// The motions that are slow: one part, or several where one cannot hold them all.
    pub(crate) fn slow(&self) -> impl Iterator<Item = &Part> {
        self.parts.iter().filter(|part| part.is_slow)
    }

    /// The first columns of the slow parts, where there are forces to drive them.
    pub(crate) fn driven_by(&self, forces: &Mat<f64>) -> Vec<usize> {
        let slow = self.slow().filter(|_| forces.norm_max() > 0.0);
        slow.map(|part| part.first).collect()
    }

    /// Takes growth and decay away that are rounding: where energy is conserved, the exponents of
    /// oscillations have no real part, and over ten thousand impacts that of rounding would be felt.
    pub(crate) fn keep_energy(&mut self) {
        for part in &mut self.parts {
            let is_alone = part.generator.nrows() == 1;
            let lambda = &mut part.generator[(0, 0)];
            if is_alone && lambda.re.abs() < NOTHING * lambda.im.abs() {
                lambda.re = 0.0;
            }
        }
    }
}

/// The constant part of the motion `x' = A x + p` beside slow exponents, which the forces drive:
/// with these moved away from zero, `A - kappa X Y`, the matrix has an inverse.
///
/// The rounding of `kappa X Y` is as large as the fastest exponent makes it. Where the part is
/// far away, since a slow exponent has a neighbour that is not, the motion would jump by it at
/// each start of a phase. So the lack of the equations themselves, `A x + p` without the slow
/// exponents' part of p, is solved for once more.
pub(crate) fn rest_beside(matrix: &Mat<f64>, force: &Mat<f64>, split: &Split) -> Mat<f64> {
    let n = matrix.nrows();
    let mut projection = Mat::<f64>::zeros(n, n);
    for part in split.slow() {
        let count = part.generator.nrows();
        let right = split.right.subcols(part.first, count);
        let left = split.left.subrows(part.first, count);
        let own = right * left;
        projection += Mat::from_fn(n, n, |r, c| part.sides() * own[(r, c)].re);
    }
    let other = force - &projection * force;
    let moved = matrix - Scale(matrix.norm_max()) * projection;
    let inverse = moved.full_piv_lu();
    let mut rest = inverse.solve(-&other);
    for _ in 0..REFINEMENTS {
        let lack = matrix * &rest + &other;
        rest -= inverse.solve(&lack);
    }
    rest
}

/// Refinements of a rest: the first leaves rounding of the equations, the second what that of the
/// first has left.
const REFINEMENTS: usize = 2;

/// Splits a real matrix; exponents below `slow` belong together.
pub(crate) fn split(matrix: &Mat<f64>, slow: f64) -> Result<Split> {
    let mut sets = Sets::new(matrix, slow)?;
    sets.join_parallel();
    loop {
        sets.join_close();
        let members = sets.members();
        let bases: Vec<Mat<c64>> = (members.iter())
            .map(|set| sets.basis(matrix, set))
            .collect();
        let right = side_by_side(&bases, matrix.nrows());
        let left = right
            .partial_piv_lu()
            .solve(Mat::<c64>::identity(matrix.nrows(), matrix.nrows()));
        if !sets.join_ill_conditioned(&members, &left) {
            return Ok(sets.collect(matrix, &members, &right, &left));
        }
    }
}

impl Sets {
    fn new(matrix: &Mat<f64>, slow: f64) -> Result<Self> {
        let GeneralEigen {
            values,
            mut vectors,
        } = general_eigen(matrix)?;
        let count = matrix.nrows();
        for j in 0..count {
            let size = vectors.col(j).norm_l2();
            for i in 0..count {
                vectors[(i, j)] /= size;
            }
        }
        let mut sets = Self {
            label: (0..count).collect(),
            conjugate: conjugates(&values),
            values,
            vectors,
            slow,
        };
        let is_slow: Vec<usize> = (0..count).filter(|&j| sets.is_slow(j)).collect();
        for pair in is_slow.windows(2) {
            sets.join(pair[0], pair[1]);
        }
        Ok(sets)
    }

    fn is_slow(&self, j: usize) -> bool {
        self.values[j].norm() < self.slow
    }

    /// Joins two exponents and their conjugates, if there is room in a block for them; tells
    /// whether it has.
    fn join(&mut self, a: usize, b: usize) -> bool {
        if self.label[a] == self.label[b] || self.size_together(a, b) > MOST / 2 {
            return false;
        }
        for (a, b) in [(a, b), (self.conjugate[a], self.conjugate[b])] {
            let (from, to) = (self.label[a], self.label[b]);
            for label in &mut self.label {
                if *label == from {
                    *label = to;
                }
            }
        }
        true
    }

    fn join_parallel(&mut self) {
        for a in 0..self.values.len() {
            for b in 0..a {
                let apart = (self.values[a] - self.values[b]).norm();
                let size = self.values[a].norm().max(self.values[b].norm());
                if apart > NEAR * size || self.label[a] == self.label[b] {
                    continue;
                }
                let product = self.vectors.col(a).adjoint() * self.vectors.col(b);
                // Written so that vectors which are no numbers are joined.
                let are_apart = product.norm() < PARALLEL;
                if !are_apart {
                    self.join(a, b);
                }
            }
        }
    }

    /// Joins what lies so close to a cluster that its subspace could not be told from the
    /// cluster's.
    fn join_close(&mut self) {
        let mut joined = true;
        while joined {
            joined = false;
            for a in 0..self.values.len() {
                if self.size_of(a) == 1 {
                    continue;
                }
                for b in 0..self.values.len() {
                    let apart = (self.values[a] - self.values[b]).norm();
                    if apart < CLOSE * self.values[a].norm().max(self.slow) {
                        joined |= self.join(a, b);
                    }
                }
            }
        }
    }

    /// Joins sets whose left vectors are too large with what is nearest to them; tells whether
    /// there were some.
    fn join_ill_conditioned(&mut self, members: &[Vec<usize>], left: &Mat<c64>) -> bool {
        let mut joined = false;
        let mut row = 0;
        for set in members {
            let rows = row..row + set.len();
            row = rows.end;
            let worst = rows.map(|r| left.row(r).norm_l2()).fold(0.0, f64::max);
            let is_joined = self.size_of(set[0]) != set.len();
            if worst < LARGEST_CONDITION || is_joined {
                continue;
            }
            let label = self.label[set[0]];
            let other = nearest(&self.values, self.mean(set), |j| self.label[j] != label);
            if let Some(other) = other {
                joined |= self.join(set[0], other);
            }
        }
        joined
    }

    /// How many exponents are in one set after two have been joined, and their conjugates: all
    /// of them where a set meets a conjugate one.
    fn size_together(&self, a: usize, b: usize) -> usize {
        let own = [self.label[a], self.label[b]];
        let conjugate = [a, b].map(|j| self.label[self.conjugate[j]]);
        let meet = own.iter().any(|label| conjugate.contains(label));
        let joins = |label: &&usize| own.contains(label) || meet && conjugate.contains(label);
        self.label.iter().filter(joins).count()
    }

    /// How many exponents are in the set of one.
    fn size_of(&self, j: usize) -> usize {
        self.label.iter().filter(|l| **l == self.label[j]).count()
    }

    fn mean(&self, set: &[usize]) -> c64 {
        let total: c64 = set.iter().map(|&j| self.values[j]).sum();
        total / set.len() as f64
    }

    /// The exponents of each set.
    fn members(&self) -> Vec<Vec<usize>> {
        let mut members = vec![Vec::new(); self.values.len()];
        for (j, label) in self.label.iter().enumerate() {
            members[*label].push(j);
        }
        members.retain(|set| !set.is_empty());
        members
    }

    fn is_real(&self, set: &[usize]) -> bool {
        self.label[set[0]] == self.label[self.conjugate[set[0]]]
    }

    /// Columns that span the subspace of a set, real ones where the set is.
    fn basis(&self, matrix: &Mat<f64>, set: &[usize]) -> Mat<c64> {
        let n = matrix.nrows();
        let vector = |j: usize, i: usize| self.vectors[(i, j)];
        if set.len() == 1 && is_finite(&self.vectors, set[0]) {
            return Mat::from_fn(n, 1, |i, _| vector(set[0], i));
        }
        let is_real = self.is_real(set);
        let start = Mat::from_fn(n, set.len(), |i, c| {
            let j = set[c];
            if !is_real {
                vector(j, i)
            } else if self.values[j].im < 0.0 {
                c64::new(vector(j, i).im, 0.0)
            } else {
                c64::new(vector(j, i).re, 0.0)
            }
        });
        let shift = self.shift(set);
        sharpen(matrix, &start, shift)
    }

    /// A point off the mean of a set by a small part of the way to the nearest exponent outside:
    /// on the mean itself the vectors of a defective set could not be told from each other.
    fn shift(&self, set: &[usize]) -> c64 {
        let mean = self.mean(set);
        let label = self.label[set[0]];
        let outside = nearest(&self.values, mean, |j| self.label[j] != label);
        let gap = outside.map_or(mean.norm(), |j| (self.values[j] - mean).norm());
        let shift = mean + c64::new(0.05 * gap, 0.0);
        if self.is_real(set) {
            c64::new(shift.re, 0.0)
        } else {
            shift
        }
    }

    /// What is kept: the real parts, and of the others those above the axis.
    fn collect(
        &self,
        matrix: &Mat<f64>,
        members: &[Vec<usize>],
        right: &Mat<c64>,
        left: &Mat<c64>,
    ) -> Split {
        let n = matrix.nrows();
        let (mut columns, mut parts) = (Vec::new(), Vec::new());
        let mut at = 0;
        for set in members {
            let own = at..at + set.len();
            at = own.end;
            let is_real = self.is_real(set);
            if !is_real && self.mean(set).im < 0.0 {
                continue;
            }
            let generator = if set.len() == 1 {
                Mat::from_fn(1, 1, |_, _| self.values[set[0]])
            } else {
                generator(matrix, right, left, own.start, set.len(), is_real)
            };
            parts.push(Part {
                first: columns.len(),
                generator,
                is_real,
                is_slow: set.iter().any(|&j| self.is_slow(j)),
            });
            columns.extend(own);
        }
        Split {
            right: Mat::from_fn(n, columns.len(), |i, c| right[(i, columns[c])]),
            left: Mat::from_fn(columns.len(), n, |r, i| left[(columns[r], i)]),
            parts,
        }
    }
}

/// `Y A X` of one part.
fn generator(
    matrix: &Mat<f64>,
    right: &Mat<c64>,
    left: &Mat<c64>,
    first: usize,
    count: usize,
    is_real: bool,
) -> Mat<c64> {
    let n = matrix.nrows();
    let mut moved = Mat::<c64>::zeros(n, count);
    for c in 0..count {
        for j in 0..n {
            let factor = right[(j, first + c)];
            for i in 0..n {
                moved[(i, c)] += matrix[(i, j)] * factor;
            }
        }
    }
    let mut generator = left.subrows(first, count) * &moved;
    if is_real {
        for r in 0..count {
            for c in 0..count {
                generator[(r, c)].im = 0.0;
            }
        }
    }
    generator
}

/// An orthonormal basis of the invariant subspace near the span of the start, by inverse
/// iteration around the shift; the sharpest that was seen.
fn sharpen(matrix: &Mat<f64>, start: &Mat<c64>, shift: c64) -> Mat<c64> {
    let n = matrix.nrows();
    let count = start.ncols();
    let (mut best, is_spanned) = orthonormal(start);
    if count == n {
        return best;
    }
    let whole = Mat::from_fn(n, n, |r, c| c64::new(matrix[(r, c)], 0.0));
    let shifted = Mat::from_fn(n, n, |r, c| {
        whole[(r, c)] - if r == c { shift } else { c64::new(0.0, 0.0) }
    });
    let inverse = shifted.partial_piv_lu();
    let size = matrix.norm_l2();
    let lack = |basis: &Mat<c64>| {
        let moved = &whole * basis;
        (&moved - basis * (basis.adjoint() * &moved)).norm_l2() / size
    };
    let mut present = best.clone();
    let mut least = if is_spanned {
        lack(&best)
    } else {
        f64::INFINITY
    };
    for _ in 0..ITERATIONS {
        if least <= SHARP * (n as f64).sqrt() {
            break;
        }
        (present, _) = orthonormal(&inverse.solve(&present));
        let found = lack(&present);
        if found < least {
            (least, best) = (found, present.clone());
        }
    }
    best
}

/// Whether an eigenvector was found: of a wholly defective matrix some are not.
fn is_finite(vectors: &Mat<c64>, j: usize) -> bool {
    vectors.col(j).norm_l2().is_finite()
}

/// Entries of a vector in no direction in particular, the same ones in every run.
fn anything(i: usize, j: usize) -> f64 {
    ((1 + i * 19 + j * 29 + i * j) % 31) as f64 / 15.0 - 1.0
}

/// The conjugate of each eigenvalue of a real matrix, by number.
fn conjugates(values: &[c64]) -> Vec<usize> {
    let mut conjugates: Vec<usize> = (0..values.len()).collect();
    for j in 0..values.len() {
        if values[j].im == 0.0 || conjugates[j] != j {
            continue;
        }
        let is_free = |k: usize| k != j && values[k].im != 0.0 && conjugates[k] == k;
        if let Some(k) = nearest(values, values[j].conj(), is_free) {
            (conjugates[j], conjugates[k]) = (k, j);
        }
    }
    conjugates
}

/// Orthonormal columns that span the given ones, by Gram and Schmidt, twice for each. Those that
/// depend on others are replaced by any directions; tells whether there are none of them.
fn orthonormal(columns: &Mat<c64>) -> (Mat<c64>, bool) {
    let (n, count) = (columns.nrows(), columns.ncols());
    let mut basis = Mat::<c64>::zeros(n, count);
    let mut filled = 0;
    for j in 0..count {
        filled += usize::from(add_column(&mut basis, filled, |i| columns[(i, j)]));
    }
    let is_spanned = filled == count;
    for j in 0..n {
        if filled < count {
            let column = |i: usize| c64::new(anything(i, j), 0.0);
            filled += usize::from(add_column(&mut basis, filled, column));
        }
    }
    (basis, is_spanned)
}

/// Adds the part of a vector that is orthogonal to the first columns of a basis behind these, if
/// there is enough of it.
fn add_column(basis: &mut Mat<c64>, filled: usize, vector: impl Fn(usize) -> c64) -> bool {
    let n = basis.nrows();
    let mut column = Mat::from_fn(n, 1, |i, _| vector(i));
    let size = column.norm_l2();
    for _ in 0..2 {
        let before = basis.subcols(0, filled);
        column = &column - before * (before.adjoint() * &column);
    }
    let left = column.norm_l2();
    // Written so that a vector which is no number has nothing left.
    let has_enough = left > DEPENDENT * size;
    if has_enough {
        for i in 0..n {
            basis[(i, filled)] = column[(i, 0)] / left;
        }
    }
    has_enough
}

/// The eigenvalue nearest to a point, of those that may be taken.
fn nearest(values: &[c64], to: c64, may: impl Fn(usize) -> bool) -> Option<usize> {
    let distance = |j: &usize| (values[*j] - to).norm();
    (0..values.len())
        .filter(|&j| may(j))
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))
}

fn side_by_side(bases: &[Mat<c64>], rows: usize) -> Mat<c64> {
    let mut whole = Mat::zeros(rows, rows);
    let mut column = 0;
    for basis in bases {
        for c in 0..basis.ncols() {
            for i in 0..rows {
                whole[(i, column)] = basis[(i, c)];
            }
            column += 1;
        }
    }
    whole
}
