//! Factors of sparse symmetric matrices, definite or not: `A = L B L'` with supernodes, pivots
//! of size one and two chosen inside each supernode.
//!
//! The signs of the pivots are those of the eigenvalues (Sylvester's law of inertia), which is
//! what the [`super::sturm`] counts are made of.

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

/// Where the entries of a factor stand: the same for all matrices of one pattern.
#[derive(Debug)]
pub struct Analysis {
    symbolic: SymbolicCholesky<usize>,
}

impl Analysis {
    /// Orders the unknowns so that little fills in.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub fn new(starts: &[usize], rows: &[usize]) -> Result<Self> {
        let size = starts.len() - 1;
        let pattern = SymbolicSparseColMatRef::new_checked(size, size, starts, None, rows);
        let always = CholeskySymbolicParams {
            // Also where nothing fills in at all, which no threshold of faer's own means.
            supernodal_flop_ratio_threshold: SupernodalThreshold(-1.0),
            ..CholeskySymbolicParams::default()
        };
        factorize_symbolic_cholesky(pattern, Side::Lower, SymmetricOrdering::Amd, always)
            .map(|symbolic| Self { symbolic })
            .map_err(|_| Error::Memory)
    }

    /// Number of entries of a factor.
    pub fn entries(&self) -> usize {
        self.symbolic.len_val()
    }

    fn supernodes(&self) -> &SymbolicSupernodalCholesky<usize> {
        match self.symbolic.raw() {
            SymbolicCholeskyRaw::Supernodal(supernodes) => supernodes,
            SymbolicCholeskyRaw::Simplicial(_) => unreachable!("supernodes are asked for"),
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
        let symbolic = &self.analysis.symbolic;
        let needed = symbolic.solve_in_place_scratch::<f64>(rhs.ncols(), Par::Seq);
        let mut scratch = MemBuffer::try_new(needed).map_err(|_| Error::Memory)?;
        let order = PermRef::new_checked(&self.forward, &self.inverse, self.size());
        IntranodeLbltRef::new(symbolic, &self.values, &self.subdiagonal, order)
            .solve_in_place_with_conj(Conj::No, rhs, Par::Seq, MemStack::new(&mut scratch));
        Ok(())
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
        let supernodes = analysis.supernodes();
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
