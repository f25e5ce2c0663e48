//! Block Lanczos on `(K - s M)^-1 M`: the eigenvalues nearest to the shift s come first.
//!
//! With theta = 1/(omega^2 - s), the operator is symmetric in the inner product of M. Every new
//! block is made orthogonal to the whole basis, twice, so that no eigenvalue is found again by
//! rounding; when the basis is full it is cut back to the best approximations ("thick restart").
//! A block of several vectors finds as many equal eigenvalues at once, and passes over the factor
//! once for all of them.
//!
//! T. Ericsson and A. Ruhe, Math. Comp. 35 (1980) 1251-1268; K. Wu and H. Simon, SIAM J. Matrix
//! Anal. Appl. 22 (2000) 602-616; R. G. Grimes, J. G. Lewis and H. D. Simon, SIAM J. Matrix
//! Anal. Appl. 15 (1994) 228-272.

use super::factor::Factor;
use super::pencil::Pencil;
use crate::eigen::{SymmetricEigen, symmetric_eigen};
use crate::error::{Error, Result};
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatRef, Par};

/// Vectors that go through the factor together.
const BLOCK: usize = 8;

/// A pair has converged when its residual is below this part of theta: the bound on the
/// relative error of `omega^2 - s`.
pub const TOLERANCE: f64 = 1e-13;

/// A column that loses more than this to the basis was made of rounding.
const LOST: f64 = 0.5;

/// Blocks without convergence before giving up, beside those that the basis holds.
const PATIENCE: usize = 300;

/// Which eigenvalues are wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wanted {
    /// So many nearest below the shift and so many nearest above it.
    Sides {
        /// Number below.
        below: usize,
        /// Number above.
        above: usize,
    },
    /// So many nearest to it on either side.
    Nearest(usize),
}

impl Wanted {
    /// How many they are.
    pub fn count(self) -> usize {
        match self {
            Self::Sides { below, above } => below + above,
            Self::Nearest(count) => count,
        }
    }

    /// Numbers of the wanted ones, and `extra` more on each side, of ascending thetas.
    fn among(self, theta: &[f64], extra: usize) -> Vec<usize> {
        let negative = theta.iter().take_while(|&&t| t < 0.0).count();
        let size = theta.len();
        match self {
            Self::Sides { below, above } => {
                let low = if below == 0 {
                    0
                } else {
                    (below + extra).min(negative)
                };
                let high = if above == 0 {
                    0
                } else {
                    (above + extra).min(size - negative)
                };
                (0..low).chain(size - high..size).collect()
            }
            Self::Nearest(count) => {
                let mut order: Vec<usize> = (0..size).collect();
                order.sort_by(|&a, &b| theta[b].abs().total_cmp(&theta[a].abs()));
                order.truncate(count + extra);
                order.sort_unstable();
                order
            }
        }
    }
}

/// Approximate eigenpairs of the operator, in ascending theta.
struct Ritz {
    theta: Vec<f64>,
    vectors: Mat<f64>,
    residual: Vec<f64>,
}

/// The growing basis and the operator's projection on it.
pub struct Lanczos<'a> {
    pencil: &'a Pencil,
    factor: &'a Factor,
    /// M-orthonormal vectors that everything is kept orthogonal to.
    fixed: MatRef<'a, f64>,
    fixed_weighted: Mat<f64>,
    /// `done` vectors that the operator has been applied to, and then `ready` new ones.
    basis: Mat<f64>,
    done: usize,
    ready: usize,
    /// M times the new vectors.
    weighted: Mat<f64>,
    /// The operator on the first `done` vectors.
    projected: Mat<f64>,
    /// What the operator makes of these in the direction of the new ones.
    coupling: Mat<f64>,
    random: Random,
}

impl<'a> Lanczos<'a> {
    /// Starts from fixed vectors, orthogonal to `fixed`.
    ///
    /// # Errors
    /// [`Error::NegativeMass`], [`Error::Memory`].
    pub fn new(pencil: &'a Pencil, factor: &'a Factor, fixed: MatRef<'a, f64>) -> Result<Self> {
        let mut lanczos = Self {
            pencil,
            factor,
            fixed,
            fixed_weighted: pencil.weighted(fixed),
            basis: Mat::new(),
            done: 0,
            ready: 0,
            weighted: Mat::new(),
            projected: Mat::new(),
            coupling: Mat::new(),
            random: Random(fixed.ncols() as u64),
        };
        lanczos.reserve(4 * BLOCK);
        lanczos.start_anew()?;
        Ok(lanczos)
    }

    /// Goes on until the wanted pairs have converged; there may be fewer where all are found.
    ///
    /// # Errors
    /// [`Error::Eigenvalues`] where they do not converge.
    pub fn converge(&mut self, wanted: Wanted) -> Result<()> {
        let most = self.most_vectors(wanted);
        self.reserve(most + BLOCK);
        for _ in 0..PATIENCE + most / BLOCK {
            if self.done > wanted.count() || self.ready == 0 {
                let ritz = self.ritz()?;
                if self.ready == 0 || self.has_converged(&ritz, wanted) {
                    return Ok(());
                }
                if self.done + self.ready > most {
                    self.restart(ritz, wanted);
                }
            }
            self.step()?;
        }
        Err(Error::Eigenvalues)
    }

    /// Number of dofs.
    pub fn size(&self) -> usize {
        self.pencil.size()
    }

    /// Whether the basis holds everything that the operator can reach.
    pub fn is_complete(&self) -> bool {
        self.ready == 0
    }

    /// Thetas known to a relative `tolerance`, ascending.
    ///
    /// # Errors
    /// [`Error::Eigenvalues`].
    pub fn known(&self, tolerance: f64) -> Result<Vec<f64>> {
        let ritz = self.ritz()?;
        let pairs = ritz.theta.iter().zip(&ritz.residual);
        let known = pairs.filter(|&(theta, residual)| *residual <= tolerance * theta.abs());
        Ok(known.map(|(&theta, _)| theta).collect())
    }

    /// The wanted eigenvectors, M-orthonormal, in ascending theta.
    ///
    /// # Errors
    /// [`Error::Eigenvalues`].
    pub fn vectors(&self, wanted: Wanted) -> Result<Mat<f64>> {
        let ritz = self.ritz()?;
        let chosen = wanted.among(&ritz.theta, 0);
        Ok(self.combined(&ritz.vectors, &chosen))
    }

    /// Room to find the wanted pairs without many restarts.
    fn most_vectors(&self, wanted: Wanted) -> usize {
        let count = wanted.count();
        let room = (2 * count).max(count + 8 * BLOCK);
        room.min(self.pencil.size() - self.fixed.ncols())
    }

    fn reserve(&mut self, capacity: usize) {
        if capacity > self.basis.ncols() {
            self.basis
                .resize_with(self.pencil.size(), capacity, |_, _| 0.0);
        }
    }

    fn has_converged(&self, ritz: &Ritz, wanted: Wanted) -> bool {
        let chosen = wanted.among(&ritz.theta, 0);
        let done = |&i: &usize| ritz.residual[i] <= TOLERANCE * ritz.theta[i].abs();
        chosen.len() == wanted.count() && chosen.iter().all(done)
    }

    /// Eigenpairs of the projection (Rayleigh and Ritz).
    fn ritz(&self) -> Result<Ritz> {
        let projected = self.projected.as_ref();
        let symmetric = Mat::from_fn(self.done, self.done, |r, c| {
            0.5 * (projected[(r, c)] + projected[(c, r)])
        });
        let SymmetricEigen { values, vectors } = symmetric_eigen(&symmetric)?;
        let outside = &self.coupling * &vectors;
        Ok(Ritz {
            theta: values,
            residual: (0..self.done).map(|c| outside.col(c).norm_l2()).collect(),
            vectors,
        })
    }

    /// Keeps the best approximations as the basis; the new block stays.
    fn restart(&mut self, ritz: Ritz, wanted: Wanted) {
        let kept = wanted.among(&ritz.theta, 2 * BLOCK);
        let combined = self.combined(&ritz.vectors, &kept);
        let chosen = columns(&ritz.vectors, &kept);
        self.coupling = &self.coupling * &chosen;
        let new = self.basis.subcols(self.done, self.ready).to_owned();
        let (count, ready) = (kept.len(), self.ready);
        self.basis.subcols_mut(0, count).copy_from(&combined);
        self.basis.subcols_mut(count, ready).copy_from(&new);
        self.projected = Mat::from_fn(
            count,
            count,
            |r, c| {
                if r == c { ritz.theta[kept[r]] } else { 0.0 }
            },
        );
        self.done = count;
    }

    /// Applies the operator to the new block, and makes the next one of what is left.
    fn step(&mut self) -> Result<()> {
        let mut image = std::mem::replace(&mut self.weighted, Mat::new());
        self.factor.solve(image.as_mut())?;
        let (before, after) = (self.done, self.done + self.ready);
        self.done = after;
        let (along, next) = self.appended(image)?;
        let (old, coupling) = (
            std::mem::replace(&mut self.projected, Mat::new()),
            &self.coupling,
        );
        self.projected = Mat::from_fn(after, after, |r, c| match (r < before, c < before) {
            (true, true) => old[(r, c)],
            (false, true) => coupling[(r - before, c)],
            (_, false) => along[(r, c - before)],
        });
        self.coupling = Mat::from_fn(self.ready, after, |r, c| {
            if c < before {
                0.0
            } else {
                next[(r, c - before)]
            }
        });
        if self.ready == 0 {
            // The basis is closed under the operator: what is left is orthogonal to it.
            self.start_anew()?;
        }
        Ok(())
    }

    /// Makes a new block of fixed random vectors; an empty one where nothing is left.
    fn start_anew(&mut self) -> Result<()> {
        let taken = self.fixed.ncols() + self.done;
        let left = self.pencil.size().saturating_sub(taken);
        let random = &mut self.random;
        let noise = Mat::from_fn(self.pencil.size(), BLOCK.min(left), |_, _| random.next());
        let mut smooth = self.pencil.weighted(noise.as_ref());
        self.factor.solve(smooth.as_mut())?;
        self.appended(smooth)?;
        self.coupling = Mat::zeros(self.ready, self.done);
        Ok(())
    }

    /// Puts the part of a block that the basis does not span behind it, M-orthonormal.
    ///
    /// Returns how much of the block is along the basis and how much along its new vectors.
    fn appended(&mut self, mut block: Mat<f64>) -> Result<(Mat<f64>, Mat<f64>)> {
        let width = block.ncols();
        let mut along = Mat::zeros(self.done, width);
        let mut next = Mat::identity(width, width);
        let mut weighted = self.pencil.weighted(block.as_ref());
        let whole = norms(&block, &weighted)?;
        for round in 0..3 {
            self.remove_fixed(&mut block);
            along += self.remove_basis(&mut block, &weighted) * &next;
            weighted = self.pencil.weighted(block.as_ref());
            // What rounding leaves of a column is only known to be nothing in the second round:
            // a vector of unit length that loses most of it.
            let least = if round == 0 {
                whole.iter().map(|norm| 1e-15 * norm).collect()
            } else {
                vec![LOST; block.ncols()]
            };
            next = orthonormalised(&mut block, &mut weighted, &least)? * next;
        }
        self.ready = block.ncols();
        self.reserve(self.done + self.ready);
        self.basis
            .subcols_mut(self.done, self.ready)
            .copy_from(&block);
        self.weighted = weighted;
        Ok((along, next))
    }

    fn remove_fixed(&self, block: &mut Mat<f64>) {
        let along = self.fixed_weighted.transpose() * &*block;
        matmul(
            block.as_mut(),
            Accum::Add,
            self.fixed,
            &along,
            -1.0,
            Par::Seq,
        );
    }

    fn remove_basis(&self, block: &mut Mat<f64>, weighted: &Mat<f64>) -> Mat<f64> {
        let basis = self.basis.subcols(0, self.done);
        let along = basis.transpose() * weighted;
        matmul(block.as_mut(), Accum::Add, basis, &along, -1.0, Par::Seq);
        along
    }

    fn combined(&self, vectors: &Mat<f64>, chosen: &[usize]) -> Mat<f64> {
        self.basis.subcols(0, self.done) * columns(vectors, chosen)
    }
}

fn columns(matrix: &Mat<f64>, chosen: &[usize]) -> Mat<f64> {
    Mat::from_fn(matrix.nrows(), chosen.len(), |r, c| matrix[(r, chosen[c])])
}

/// Lengths of columns in the norm of M.
fn norms(block: &Mat<f64>, weighted: &Mat<f64>) -> Result<Vec<f64>> {
    (0..block.ncols())
        .map(|c| norm(block, weighted, c))
        .collect()
}

fn norm(block: &Mat<f64>, weighted: &Mat<f64>, column: usize) -> Result<f64> {
    let (block, weighted) = (block.col(column), weighted.col(column));
    let square = block.transpose() * weighted;
    if !square.is_finite() {
        return Err(Error::Factorisation);
    }
    if square < -1e-9 * block.norm_l2() * weighted.norm_l2() {
        return Err(Error::IndefiniteMass);
    }
    Ok(square.max(0.0).sqrt())
}

/// Makes columns M-orthonormal one after the other, and drops those that are left shorter than
/// `least`; returns the old columns along the new.
fn orthonormalised(
    block: &mut Mat<f64>,
    weighted: &mut Mat<f64>,
    least: &[f64],
) -> Result<Mat<f64>> {
    let width = block.ncols();
    let mut along = Mat::zeros(width, width);
    let mut kept = 0;
    for c in 0..width {
        for k in 0..kept {
            let part = weighted.col(k).transpose() * block.col(c);
            along[(k, c)] = part;
            subtract(block, k, c, part);
            subtract(weighted, k, c, part);
        }
        let length = norm(block, weighted, c)?;
        if length <= least[c] {
            continue;
        }
        along[(kept, c)] = length;
        for matrix in [&mut *block, &mut *weighted] {
            for r in 0..matrix.nrows() {
                matrix[(r, kept)] = matrix[(r, c)] / length;
            }
        }
        kept += 1;
    }
    block.truncate(block.nrows(), kept);
    weighted.truncate(weighted.nrows(), kept);
    along.truncate(kept, width);
    Ok(along)
}

fn subtract(matrix: &mut Mat<f64>, from: usize, column: usize, factor: f64) {
    for r in 0..matrix.nrows() {
        let part = factor * matrix[(r, from)];
        matrix[(r, column)] -= part;
    }
}

/// Numbers from -1 to 1 that are the same in every run (G. L. Steele, D. Lea, C. H. Flood,
/// OOPSLA 2014: SplitMix64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}
