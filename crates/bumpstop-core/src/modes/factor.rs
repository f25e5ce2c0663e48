//! Factors of sparse symmetric matrices, definite or not: `A = L B L'` with supernodes, pivots
//! of size one and two chosen inside each supernode.
//!
//! The signs of the pivots are those of the eigenvalues (Sylvester's law of inertia), which is
//! what the [`super::sturm`] counts are made of.

use super::dissection::dissection;
use super::elimination::postordered;
use super::graph::Graph;
use super::grouping::{NODE, grouped};
use crate::error::{Error, Result};
use crate::sparse::SparseMatrix;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::perm::PermRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::IntranodeLbltRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky, supernodal::SymbolicSupernodalCholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, MatRef, Par, Side};
use std::sync::Arc;

/// Pivots below this, relative to the diagonal, are rounding.
pub const NEGLIGIBLE: f64 = 1e-13;

/// Factors of more multiplications are worth the time of dissecting the graph of the nodes.
const MUCH_WORK: f64 = 1e9;

/// Factors of more multiplications are worth the longer time of dissecting that of the unknowns.
const VERY_MUCH_WORK: f64 = 1e11;

/// Where the entries of a factor stand: the same for all matrices of one pattern.
#[derive(Debug)]
pub struct Analysis {
    symbolic: SymbolicCholesky<usize>,
}

impl Analysis {
    /// Orders the unknowns so that little fills in: by minimum degree, and where that costs much
    /// by nested dissection, if it is the better of the two. What is dissected is the graph of
    /// groups of unknowns, which is small, or, where this does not help, that of each.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub fn new(starts: &[usize], rows: &[usize]) -> Result<Self> {
        let by_degree = Self::ordered(starts, rows, SymmetricOrdering::Amd)?;
        let work = by_degree.work();
        for (least, largest) in [(MUCH_WORK, NODE), (VERY_MUCH_WORK, 1)] {
            if work < least {
                break;
            }
            let dissected = Self::dissected(starts, rows, largest)?;
            if dissected.work() < work {
                return Ok(dissected);
            }
        }
        Ok(by_degree)
    }

    /// Dissects the graph of groups of up to `largest` unknowns.
    fn dissected(starts: &[usize], rows: &[usize], largest: usize) -> Result<Self> {
        let bounds = grouped(starts, rows, largest);
        let groups = dissection(Graph::of(starts, rows, &bounds));
        let order: Vec<usize> = groups
            .into_iter()
            .flat_map(|group| bounds[group]..bounds[group + 1])
            .collect();
        let order = postordered(starts, rows, &order);
        let mut inverse = vec![0; order.len()];
        for (place, &unknown) in order.iter().enumerate() {
            inverse[unknown] = place;
        }
        let order = PermRef::new_checked(&order, &inverse, inverse.len());
        Self::ordered(starts, rows, SymmetricOrdering::Custom(order))
    }

    fn ordered(
        starts: &[usize],
        rows: &[usize],
        ordering: SymmetricOrdering<usize>,
    ) -> Result<Self> {
        let size = starts.len() - 1;
        let pattern = SymbolicSparseColMatRef::new_checked(size, size, starts, None, rows);
        let always = CholeskySymbolicParams {
            // Also where nothing fills in at all, which no threshold of faer's own means.
            supernodal_flop_ratio_threshold: SupernodalThreshold(-1.0),
            ..CholeskySymbolicParams::default()
        };
        factorize_symbolic_cholesky(pattern, Side::Lower, ordering, always)
            .map(|symbolic| Self { symbolic })
            .map_err(|_| Error::Memory)
    }

    /// Number of multiplications that a factor takes.
    fn work(&self) -> f64 {
        let Some(supernodes) = self.supernodes() else {
            return 0.0;
        };
        let (first, last) = (supernodes.supernode_begin(), supernodes.supernode_end());
        let pattern = supernodes.col_ptr_for_row_idx();
        let work = |s: usize| -> f64 {
            let below = pattern[s + 1] - pattern[s];
            let column = |c: usize| ((last[s] - c + below) as f64).powi(2);
            (first[s]..last[s]).map(column).sum()
        };
        (0..supernodes.n_supernodes()).map(work).sum()
    }

    /// They are always asked for; a matrix without unknowns has none all the same.
    fn supernodes(&self) -> Option<&SymbolicSupernodalCholesky<usize>> {
        match self.symbolic.raw() {
            SymbolicCholeskyRaw::Supernodal(supernodes) => Some(supernodes),
            SymbolicCholeskyRaw::Simplicial(_) => None,
        }
    }
}

/// The smallest pivot, beside the size of the diagonal where it stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeakestPivot {
    /// Number of the unknown.
    pub unknown: usize,
    /// Size of the pivot over that of the diagonal.
    pub ratio: f64,
}

/// What [`Factor::solve_one`] works in.
pub struct Scratch(MemBuffer);

/// A factored symmetric matrix.
#[derive(Debug)]
pub struct Factor {
    analysis: Arc<Analysis>,
    values: Vec<f64>,
    subdiagonal: Vec<f64>,
    forward: Vec<usize>,
    inverse: Vec<usize>,
    /// Number of negative eigenvalues of the matrix.
    pub negative: usize,
    /// The smallest pivot.
    pub weakest: WeakestPivot,
}

impl Factor {
    /// Factors a matrix of the analysed pattern; `sizes` are those of its diagonal.
    ///
    /// # Errors
    /// [`Error::Memory`] where the factor does not fit, [`Error::Factorisation`] where numbers
    /// overflow.
    pub fn new(
        analysis: &Arc<Analysis>,
        starts: &[usize],
        rows: &[usize],
        entries: &[f64],
        sizes: &[f64],
    ) -> Result<Self> {
        let size = starts.len() - 1;
        let symbolic = &analysis.symbolic;
        let pattern = SymbolicSparseColMatRef::new_checked(size, size, starts, None, rows);
        let mut values = zeros(symbolic.len_val())?;
        let mut subdiagonal = vec![0.0; size];
        let (mut forward, mut inverse) = (vec![0; size], vec![0; size]);
        let needed =
            symbolic.factorize_numeric_intranode_lblt_scratch::<f64>(Par::Seq, Default::default());
        let mut scratch = MemBuffer::try_new(needed).map_err(|_| Error::Memory)?;
        symbolic.factorize_numeric_intranode_lblt(
            &mut values,
            &mut subdiagonal,
            &mut forward,
            &mut inverse,
            SparseColMatRef::new(pattern, entries),
            Side::Lower,
            Par::Seq,
            MemStack::new(&mut scratch),
            Default::default(),
        );
        let mut factor = Self {
            analysis: Arc::clone(analysis),
            values,
            subdiagonal,
            forward,
            inverse,
            negative: 0,
            weakest: WeakestPivot {
                unknown: 0,
                ratio: f64::INFINITY,
            },
        };
        factor.read_pivots(sizes)?;
        Ok(factor)
    }

    /// Factors a matrix by itself.
    ///
    /// # Errors
    /// [`Error::NotSymmetric`], [`Error::Memory`], [`Error::Factorisation`].
    pub fn of(matrix: &SparseMatrix) -> Result<Self> {
        super::pencil::check_symmetric("the matrix", matrix)?;
        let analysis = Arc::new(Analysis::new(&matrix.starts, &matrix.rows)?);
        let sizes: Vec<f64> = (0..matrix.width())
            .map(|c| diagonal_size(matrix, c))
            .collect();
        Self::new(
            &analysis,
            &matrix.starts,
            &matrix.rows,
            &matrix.values,
            &sizes,
        )
    }

    /// The error of a matrix in which some pivot is no more than rounding.
    pub fn singularity(&self) -> Option<Error> {
        let WeakestPivot { unknown, ratio } = self.weakest;
        (ratio < NEGLIGIBLE).then_some(Error::Singular { unknown, ratio })
    }

    /// Number of unknowns.
    pub fn size(&self) -> usize {
        self.subdiagonal.len()
    }

    /// Solves for several right-hand sides at once, in place.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub fn solve(&self, rhs: MatMut<f64>) -> Result<()> {
        if self.size() == 0 {
            return Ok(());
        }
        let symbolic = &self.analysis.symbolic;
        let needed = symbolic.solve_in_place_scratch::<f64>(rhs.ncols(), Par::Seq);
        let mut scratch = MemBuffer::try_new(needed).map_err(|_| Error::Memory)?;
        let order = PermRef::new_checked(&self.forward, &self.inverse, self.size());
        IntranodeLbltRef::new(symbolic, &self.values, &self.subdiagonal, order)
            .solve_in_place_with_conj(Conj::No, rhs, Par::Seq, MemStack::new(&mut scratch));
        Ok(())
    }

    /// Memory for solves of one right-hand side.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub fn scratch(&self) -> Result<Scratch> {
        let needed = (self.analysis.symbolic).solve_in_place_scratch::<f64>(1, Par::Seq);
        (MemBuffer::try_new(needed).map(Scratch)).map_err(|_| Error::Memory)
    }

    /// Solves for one right-hand side in place, in memory that was asked for before.
    pub fn solve_one(&self, rhs: &mut [f64], scratch: &mut Scratch) {
        let size = self.size();
        if size == 0 {
            return;
        }
        let order = PermRef::new_checked(&self.forward, &self.inverse, size);
        let rhs = MatMut::from_column_major_slice_mut(rhs, size, 1);
        IntranodeLbltRef::new(
            &self.analysis.symbolic,
            &self.values,
            &self.subdiagonal,
            order,
        )
        .solve_in_place_with_conj(Conj::No, rhs, Par::Seq, MemStack::new(&mut scratch.0));
    }

    /// As [`Factor::solve`], where there is a solution.
    ///
    /// # Errors
    /// [`Error::Singular`], [`Error::Sizes`], [`Error::Memory`].
    pub fn solved(&self, rhs: MatMut<f64>) -> Result<()> {
        if let Some(singular) = self.singularity() {
            return Err(singular);
        }
        if rhs.nrows() != self.size() {
            return Err(Error::Sizes {
                what: "the matrix and the right-hand sides",
            });
        }
        self.solve(rhs)
    }

    fn read_pivots(&mut self, sizes: &[f64]) -> Result<()> {
        let analysis = Arc::clone(&self.analysis);
        let Some(supernodes) = analysis.supernodes() else {
            return Ok(());
        };
        for s in 0..supernodes.n_supernodes() {
            let (first, last) = (
                supernodes.supernode_begin()[s],
                supernodes.supernode_end()[s],
            );
            let entries =
                &self.values[supernodes.col_ptr_for_val()[s]..supernodes.col_ptr_for_val()[s + 1]];
            let height = entries.len() / (last - first).max(1);
            let block = MatRef::from_column_major_slice(entries, height, last - first);
            let (mut negative, mut weakest) = (0, self.weakest);
            let mut j = 0;
            while j < last - first {
                let beside = self.subdiagonal[first + j];
                let (pivots, width) = if beside == 0.0 {
                    ([block[(j, j)]; 2], 1)
                } else {
                    let corner = block[(j + 1, j + 1)];
                    (eigenvalues(block[(j, j)], beside, corner), 2)
                };
                for (i, pivot) in pivots.into_iter().take(width).enumerate() {
                    negative += usize::from(pivot < 0.0);
                    let unknown = self.unknown(first + j + i);
                    let ratio = pivot.abs() / sizes[unknown];
                    if !ratio.is_finite() {
                        return Err(Error::Factorisation);
                    }
                    if ratio < weakest.ratio {
                        weakest = WeakestPivot { unknown, ratio };
                    }
                }
                j += width;
            }
            self.negative += negative;
            self.weakest = weakest;
        }
        Ok(())
    }

    /// The unknown that is eliminated at a place.
    fn unknown(&self, place: usize) -> usize {
        let within = self.forward[place];
        let order = self.analysis.symbolic.perm();
        order.map_or(within, |order| order.arrays().0[within])
    }
}

/// Eigenvalues of a symmetric matrix of two rows.
fn eigenvalues(first: f64, beside: f64, second: f64) -> [f64; 2] {
    let mean = 0.5 * first + 0.5 * second;
    let spread = (0.5 * first - 0.5 * second).hypot(beside);
    [mean - spread, mean + spread]
}

/// Size of the diagonal in a column, or of its largest entry where the diagonal is zero.
fn diagonal_size(matrix: &SparseMatrix, column: usize) -> f64 {
    let on_diagonal = matrix.column(column).find(|&(row, _)| row == column);
    match on_diagonal {
        Some((_, value)) if value != 0.0 => value.abs(),
        _ => matrix
            .column(column)
            .fold(f64::MIN_POSITIVE, |m, (_, value)| m.max(value.abs())),
    }
}

fn zeros(length: usize) -> Result<Vec<f64>> {
    let mut values = Vec::new();
    values
        .try_reserve_exact(length)
        .map_err(|_| Error::Memory)?;
    values.resize(length, 0.0);
    Ok(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The pattern of a grid in space.
    fn grid(side: usize) -> (Vec<usize>, Vec<usize>) {
        let (mut starts, mut rows) = (vec![0], Vec::new());
        let near = |a: usize, b: usize, step: usize| (a / step % side).abs_diff(b / step % side);
        let steps = [1, side, side * side];
        for a in 0..side.pow(3) {
            let reach = a.saturating_sub(side * side)..(a + side * side + 1).min(side.pow(3));
            rows.extend(reach.filter(|&b| steps.iter().map(|&s| near(a, b, s)).sum::<usize>() < 2));
            starts.push(rows.len());
        }
        (starts, rows)
    }

    #[test]
    fn dissection_of_a_grid_saves_work() {
        let (starts, rows) = grid(16);
        let each: Vec<usize> = (0..starts.len()).collect();
        let mut order = dissection(Graph::of(&starts, &rows, &each));
        order.sort_unstable();
        assert!(order.into_iter().eq(0..16 * 16 * 16));
        let by_degree = Analysis::ordered(&starts, &rows, SymmetricOrdering::Amd).unwrap();
        let dissected = Analysis::dissected(&starts, &rows, 1).unwrap();
        let natural = Analysis::ordered(&starts, &rows, SymmetricOrdering::Identity).unwrap();
        assert!(dissected.work() < 0.5 * natural.work());
        assert!(dissected.work() < 1.1 * by_degree.work());
    }

    #[test]
    fn a_matrix_without_unknowns_has_a_factor() {
        let empty = SparseMatrix::from_triplets((0, 0), &[], &[], &[]).unwrap();
        let factor = Factor::of(&empty).unwrap();
        assert_eq!((factor.negative, factor.singularity()), (0, None));
        factor.solved(faer::Mat::zeros(0, 2).as_mut()).unwrap();
    }

    #[test]
    fn solves_and_counts_with_pivots_of_two() {
        // Zeros on the diagonal: no pivot of size one exists.
        let entries = [
            (0, 1, 2.0),
            (1, 0, 2.0),
            (2, 2, 3.0),
            (3, 4, -1.0),
            (4, 3, -1.0),
        ];
        let column =
            |f: fn(&(usize, usize, f64)) -> usize| entries.iter().map(f).collect::<Vec<_>>();
        let values: Vec<f64> = entries.iter().map(|e| e.2).collect();
        let (rows, columns) = (column(|e| e.0), column(|e| e.1));
        let matrix = SparseMatrix::from_triplets((5, 5), &rows, &columns, &values).unwrap();
        let factor = Factor::of(&matrix).unwrap();
        assert_eq!(factor.negative, 2);
        assert_eq!(factor.singularity(), None);
        let mut x = faer::Mat::from_fn(5, 1, |r, _| (r + 1) as f64);
        factor.solved(x.as_mut()).unwrap();
        for (found, expected) in x.col(0).iter().zip([1.0, 0.5, 1.0, -5.0, -4.0]) {
            assert!((found - expected).abs() < 1e-15);
        }
    }
}
