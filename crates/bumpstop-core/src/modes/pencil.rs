//! The pencil `K - s M` of a sparse eigenproblem: both matrices on one pattern.

use super::factor::{Analysis, Factor};
use crate::error::{Error, Result};
use crate::sparse::SparseMatrix;
use faer::{Mat, MatRef};
use std::sync::Arc;

/// Entries that should be equal may differ by this much of the diagonal, no more.
const ASYMMETRY: f64 = 1e-9;

/// Sparse symmetric K and M on their common pattern.
#[derive(Debug)]
pub struct Pencil {
    starts: Vec<usize>,
    rows: Vec<usize>,
    stiffness: Vec<f64>,
    mass: Vec<f64>,
    analysis: Arc<Analysis>,
}

impl Pencil {
    /// Puts both matrices on one pattern and orders it for factoring.
    ///
    /// # Errors
    /// [`Error::Sizes`], [`Error::NotSymmetric`], [`Error::NegativeMass`], [`Error::Memory`].
    pub fn new(stiffness: &SparseMatrix, mass: &SparseMatrix) -> Result<Self> {
        if stiffness.height != mass.height {
            return Err(Error::Sizes {
                what: "stiffness and mass",
            });
        }
        check_symmetric("the stiffness matrix", stiffness)?;
        check_symmetric("the mass matrix", mass)?;
        let mut starts = vec![0];
        let (mut rows, mut both) = (Vec::new(), (Vec::new(), Vec::new()));
        for column in 0..stiffness.width() {
            for (row, k, m) in merged(stiffness, mass, column) {
                if row == column && m < 0.0 {
                    return Err(Error::NegativeMass { unknown: row });
                }
                rows.push(row);
                both.0.push(k);
                both.1.push(m);
            }
            starts.push(rows.len());
        }
        let analysis = Arc::new(Analysis::new(&starts, &rows)?);
        Ok(Self {
            starts,
            rows,
            stiffness: both.0,
            mass: both.1,
            analysis,
        })
    }

    /// Number of dofs.
    pub fn size(&self) -> usize {
        self.starts.len() - 1
    }

    /// Factors `K - shift M`.
    ///
    /// # Errors
    /// [`Error::Memory`], [`Error::Factorisation`].
    pub fn factored(&self, shift: f64) -> Result<Factor> {
        let entries: Vec<f64> = self
            .stiffness
            .iter()
            .zip(&self.mass)
            .map(|(k, m)| k - shift * m)
            .collect();
        let sizes: Vec<f64> = self
            .diagonal()
            .map(|(k, m)| (k.abs() + shift.abs() * m).max(f64::MIN_POSITIVE))
            .collect();
        Factor::new(&self.analysis, &self.starts, &self.rows, &entries, &sizes)
    }

    /// Stiffness over mass of a dof taken by itself, the median of all dofs: a scale for shifts.
    pub fn scale(&self) -> f64 {
        let mut ratios: Vec<f64> = self
            .diagonal()
            .filter(|&(k, m)| k != 0.0 && m > 0.0)
            .map(|(k, m)| k.abs() / m)
            .collect();
        ratios.sort_by(f64::total_cmp);
        ratios.get(ratios.len() / 2).copied().unwrap_or(1.0)
    }

    /// `M X`.
    pub fn weighted(&self, x: MatRef<f64>) -> Mat<f64> {
        let mut product = Mat::zeros(self.size(), x.ncols());
        for c in 0..x.ncols() {
            for r in 0..self.size() {
                product[(r, c)] = self
                    .entries(r)
                    .map(|i| self.mass[i] * x[(self.rows[i], c)])
                    .sum();
            }
        }
        product
    }

    /// Rayleigh quotient of a column, `x' K x / x' M x`.
    ///
    /// The strain energy of a low mode is a small difference of large terms; they are summed in
    /// twice the working precision, so that the quotient is as good as the shape: its error is
    /// the square of that of the shape (T. Ogita, S. M. Rump, S. Oishi, SIAM J. Sci. Comput. 26
    /// (2005) 1955-1988, algorithm 5.3).
    pub fn quotient(&self, x: MatRef<f64>, column: usize) -> f64 {
        let (mut energy, mut inertia) = (Doubled::default(), Doubled::default());
        for r in 0..self.size() {
            let (mut force, mut momentum) = (Doubled::default(), Doubled::default());
            for i in self.entries(r) {
                let beside = x[(self.rows[i], column)];
                force.add_product(self.stiffness[i], beside);
                momentum.add_product(self.mass[i], beside);
            }
            energy.add_scaled(force, x[(r, column)]);
            inertia.add_scaled(momentum, x[(r, column)]);
        }
        energy.value() / inertia.value()
    }

    fn entries(&self, row: usize) -> std::ops::Range<usize> {
        // Symmetric: a row has the entries of the column of its number.
        self.starts[row]..self.starts[row + 1]
    }

    fn diagonal(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        (0..self.size()).map(|c| {
            let found = self.rows[self.entries(c)].binary_search(&c);
            found.map_or((0.0, 0.0), |i| {
                let i = self.starts[c] + i;
                (self.stiffness[i], self.mass[i])
            })
        })
    }
}

/// A sum kept in two numbers, the second what the first has lost.
#[derive(Debug, Clone, Copy, Default)]
struct Doubled {
    high: f64,
    low: f64,
}

impl Doubled {
    fn add(&mut self, term: f64) {
        let sum = self.high + term;
        let part = sum - self.high;
        self.low += (self.high - (sum - part)) + (term - part);
        self.high = sum;
    }

    fn add_product(&mut self, a: f64, b: f64) {
        let product = a * b;
        self.add(product);
        self.low += a.mul_add(b, -product);
    }

    fn add_scaled(&mut self, sum: Self, factor: f64) {
        let sum = Self {
            high: sum.high + sum.low,
            low: sum.low - ((sum.high + sum.low) - sum.high),
        };
        self.add_product(sum.high, factor);
        self.low += sum.low * factor;
    }

    fn value(self) -> f64 {
        self.high + self.low
    }
}

/// Refuses a matrix that is not its own transpose.
///
/// # Errors
/// [`Error::NotSymmetric`].
pub fn check_symmetric(what: &'static str, matrix: &SparseMatrix) -> Result<()> {
    let mut size = vec![0.0f64; matrix.width()];
    for (column, size) in size.iter_mut().enumerate() {
        *size = matrix.column(column).fold(0.0, |m, (_, v)| m.max(v.abs()));
    }
    // Entries come in the order of the columns: those of a row, too, are met from left to right.
    let mut met = matrix.starts.clone();
    for column in 0..matrix.width() {
        for (row, value) in matrix.column(column) {
            let twin = met[row];
            let matches = twin < matrix.starts[row + 1] && matrix.rows[twin] == column;
            let allowed = ASYMMETRY * size[row].min(size[column]);
            if !matches || (matrix.values[twin] - value).abs() > allowed {
                return Err(Error::NotSymmetric { what, row, column });
            }
            met[row] += 1;
        }
    }
    Ok(())
}

/// The entries of one column of both matrices, by row.
fn merged<'a>(
    stiffness: &'a SparseMatrix,
    mass: &'a SparseMatrix,
    column: usize,
) -> impl Iterator<Item = (usize, f64, f64)> + 'a {
    let mut left = stiffness.column(column).peekable();
    let mut right = mass.column(column).peekable();
    std::iter::from_fn(move || {
        let row = match (left.peek(), right.peek()) {
            (Some(a), Some(b)) => a.0.min(b.0),
            (Some(a), None) => a.0,
            (None, Some(b)) => b.0,
            (None, None) => return None,
        };
        let k = left.next_if(|entry| entry.0 == row).map_or(0.0, |e| e.1);
        let m = right.next_if(|entry| entry.0 == row).map_or(0.0, |e| e.1);
        Some((row, k, m))
    })
}
