//! Exponents that have no eigenvectors of their own: a small block of the motion.
//!
//! Where exponents nearly coincide, their eigenvectors are nearly parallel and the amplitudes
//! along them lose their digits; where they do coincide there may be fewer eigenvectors than
//! exponents (critical damping, the double zero of a rigid motion). What is well determined is the
//! subspace that they span together, on which the motion is `z' = B z`, `z(t) = exp(B t) z(0)`
//! (G. H. Golub, C. F. Van Loan, Matrix Computations, 4th ed., section 7.6).
//!
//! `exp(B t)` is `exp(mean t)` times the exponential of what is left: Taylor's series over a
//! short time, and the exponentials over that time's doublings, which are squared once
//! (N. J. Higham, Functions of Matrices, chapter 10).
//!
//! A block may be *driven*, by what has no position at rest to be measured from or moves as it does:
//! it is bordered by columns that move by themselves, `z' = B z + G u`, `u' = J u`.

use super::rows::{ComplexBlock, entry, set_entry};
use crate::number::Complex;
use faer::{Mat, c64};

/// The most columns of a block, of which the exponents take half and what drives it the others.
pub(crate) const MOST: usize = 64;

/// Room for the columns of a block.
pub(crate) type Columns = [Complex<f64>; MOST];

/// No motion.
pub(crate) const NOTHING: Columns = [Complex { re: 0.0, im: 0.0 }; MOST];

/// Norm of the block times the length of the shortest doubling.
const SHORT: f64 = 0.5;

/// Terms of Taylor's series: `SHORT^16/16!` is far below rounding.
const TAYLOR_TERMS: usize = 16;

/// Most doublings: what is longer is beyond the digits of a time.
const MOST_DOUBLINGS: usize = 52;

/// A block of columns among the exponents of a spectrum.
#[derive(Debug, Clone)]
pub(crate) struct Cluster {
    /// Its first column.
    pub at: usize,
    /// Its number of columns.
    pub size: usize,
    /// What the last columns hold at the start of a phase.
    drive: Vec<Complex<f64>>,
    generator: Vec<Complex<f64>>,
    /// The mean exponent, and the generator without it.
    mean: Complex<f64>,
    spread: Vec<Complex<f64>>,
    /// `exp(spread t)` for the shortest time and its doublings.
    doublings: Vec<Vec<Complex<f64>>>,
    shortest: f64,
    norm: f64,
    growth: f64,
}

/// What drives a block: G, J, and u at the start of a phase.
pub(crate) struct Drive {
    pub gains: Mat<c64>,
    pub generator: Mat<c64>,
    pub values: Vec<Complex<f64>>,
}

impl Drive {
    /// A constant, in a unit that makes its column about as large as those of the block.
    pub(crate) fn constant(force: &Mat<c64>, own: &Mat<c64>, duration: f64) -> Self {
        let unit = own.norm_l2().max(1.0 / duration);
        let size = force.norm_l2().max(f64::MIN_POSITIVE);
        // One factor after the other: together they are infinite where there is no force.
        Self {
            gains: Mat::from_fn(force.nrows(), 1, |r, _| force[(r, 0)] / size * unit),
            generator: Mat::zeros(1, 1),
            values: vec![Complex::real(size / unit)],
        }
    }
}

impl Cluster {
    /// The block of a square generator, whose columns start at `at`, for times up to the duration.
    pub(crate) fn new(at: usize, generator: &Mat<c64>, duration: f64) -> Self {
        let size = generator.nrows();
        let entries = |i: usize| complex(generator[(i / size, i % size)]);
        Self::of_entries(at, size, (0..size * size).map(entries).collect(), duration)
    }

    /// The same, driven.
    pub(crate) fn driven(at: usize, own: &Mat<c64>, drive: Drive, duration: f64) -> Self {
        let count = own.nrows();
        let size = count + drive.values.len();
        let mut generator = Vec::with_capacity(size * size);
        for row in 0..size {
            for column in 0..size {
                let entry = match (row < count, column < count) {
                    (true, true) => own[(row, column)],
                    (true, false) => drive.gains[(row, column - count)],
                    (false, true) => c64::new(0.0, 0.0),
                    (false, false) => drive.generator[(row - count, column - count)],
                };
                generator.push(complex(entry));
            }
        }
        Self {
            drive: drive.values,
            ..Self::of_entries(at, size, generator, duration)
        }
    }

    fn of_entries(at: usize, size: usize, generator: Vec<Complex<f64>>, duration: f64) -> Self {
        let mut trace = Complex::zero();
        for i in 0..size {
            trace += generator[i * size + i];
        }
        let mean = trace.scale(1.0 / size as f64);
        let mut spread = generator.clone();
        for i in 0..size {
            spread[i * size + i] = spread[i * size + i] - mean;
        }
        let (doublings, shortest) = doublings(&spread, size, duration);
        Self {
            at,
            size,
            drive: Vec::new(),
            mean,
            doublings,
            shortest,
            norm: norm(&generator),
            growth: growth(&generator, size),
            generator,
            spread,
        }
    }

    /// `exp(B t) z` in place.
    pub(crate) fn advance(&self, t: f64, z: &mut Columns) {
        let steps = (t / self.shortest).floor();
        let rest = if steps > 0.0 {
            t - steps * self.shortest
        } else {
            t
        };
        taylor(&self.spread, self.size, rest, z);
        let mut bits = steps as u64;
        for doubling in &self.doublings {
            if bits & 1 == 1 {
                let before = *z;
                apply(doubling, self.size, &before, z);
            }
            bits >>= 1;
        }
        let turn = self.mean.scale(t).exp();
        for z in &mut z[..self.size] {
            *z = *z * turn;
        }
    }

    /// Its columns of a row of all exponents.
    pub(crate) fn columns(&self, row: &[ComplexBlock]) -> Columns {
        let mut columns = NOTHING;
        for (i, column) in columns.iter_mut().enumerate().take(self.size) {
            *column = entry(row, self.at + i);
        }
        columns
    }

    /// Puts its columns back.
    pub(crate) fn put(&self, columns: &Columns, row: &mut [ComplexBlock]) {
        for (i, column) in columns.iter().enumerate().take(self.size) {
            set_entry(row, self.at + i, *column);
        }
    }

    /// Sets the columns that drive it.
    pub(crate) fn set_drive(&self, row: &mut [ComplexBlock]) {
        let first = self.at + self.size - self.drive.len();
        for (i, drive) in self.drive.iter().enumerate() {
            set_entry(row, first + i, *drive);
        }
    }

    /// How many of its last columns drive it.
    pub(crate) fn drives(&self) -> usize {
        self.drive.len()
    }

    /// `B z`, what drives it included.
    pub(crate) fn rate(&self, z: &Columns) -> Columns {
        let mut rate = NOTHING;
        apply(&self.generator, self.size, z, &mut rate);
        rate
    }

    /// `row B`
    pub(crate) fn row_rate(&self, row: &[Complex<f64>], to: &mut [Complex<f64>]) {
        for (column, to) in to.iter_mut().enumerate() {
            let mut total = Complex::zero();
            for (factor, entries) in row.iter().zip(self.generator.chunks(self.size)) {
                total = factor.mul_add(entries[column], total);
            }
            *to = total;
        }
    }

    /// The block without the columns that drive it.
    pub(crate) fn own(&self) -> Mat<c64> {
        let count = self.size - self.drive.len();
        Mat::from_fn(count, count, |r, c| {
            let z = self.generator[r * self.size + c];
            c64::new(z.re, z.im)
        })
    }

    /// A bound of `|B z| / |z|`.
    pub(crate) fn norm(&self) -> f64 {
        self.norm
    }

    /// A bound of the rate at which `|z|` can grow, `|z(t)| <= exp(growth t) |z(0)|`.
    pub(crate) fn growth(&self) -> f64 {
        self.growth
    }

    /// Whether a column is one of its.
    pub(crate) fn holds(&self, column: usize) -> bool {
        (self.at..self.at + self.size).contains(&column)
    }

    /// Numbers that it keeps.
    pub(crate) fn numbers(&self) -> usize {
        2 * self.size * self.size * (2 + self.doublings.len())
    }
}

/// `exp(spread t)` for a time short enough for Taylor's series and its doublings up to the
/// duration, and that time; none where the whole duration is short enough.
fn doublings(spread: &[Complex<f64>], size: usize, duration: f64) -> (Vec<Vec<Complex<f64>>>, f64) {
    let norm = norm(spread);
    let mut shortest = duration;
    let mut count = 0;
    while norm * shortest > SHORT && count < MOST_DOUBLINGS {
        shortest *= 0.5;
        count += 1;
    }
    if count == 0 {
        return (Vec::new(), f64::INFINITY);
    }
    let mut doubling = vec![Complex::zero(); size * size];
    for column in 0..size {
        let mut z = NOTHING;
        z[column] = Complex::real(1.0);
        taylor(spread, size, shortest, &mut z);
        for (row, z) in z.iter().enumerate().take(size) {
            doubling[row * size + column] = *z;
        }
    }
    let mut doublings = Vec::with_capacity(count + 1);
    while doublings.len() <= count {
        let next = product(&doubling, &doubling, size);
        doublings.push(std::mem::replace(&mut doubling, next));
    }
    (doublings, shortest)
}

/// `exp(spread t) z` for a short time, by Taylor's series.
fn taylor(spread: &[Complex<f64>], size: usize, t: f64, z: &mut Columns) {
    let mut terms = [*z, NOTHING];
    let [term, next] = &mut terms;
    let (mut term, mut next) = (term, next);
    for order in 1..=TAYLOR_TERMS {
        apply(spread, size, term, next);
        for (z, next) in z.iter_mut().zip(next.iter_mut()).take(size) {
            *next = next.scale(t / order as f64);
            *z += *next;
        }
        std::mem::swap(&mut term, &mut next);
    }
}

/// The product of a matrix with the first columns, in the place of as many others.
fn apply(matrix: &[Complex<f64>], size: usize, z: &Columns, to: &mut Columns) {
    for (to, row) in to.iter_mut().zip(matrix.chunks(size)) {
        *to = Complex::zero();
        for (factor, z) in row.iter().zip(z) {
            *to = factor.mul_add(*z, *to);
        }
    }
}

fn product(a: &[Complex<f64>], b: &[Complex<f64>], size: usize) -> Vec<Complex<f64>> {
    let mut result = Vec::with_capacity(size * size);
    for row in a.chunks(size) {
        for column in 0..size {
            let mut total = Complex::zero();
            for (factor, entries) in row.iter().zip(b.chunks(size)) {
                total = factor.mul_add(entries[column], total);
            }
            result.push(total);
        }
    }
    result
}

/// Frobenius' norm, a bound of the Euclidean one.
fn norm(matrix: &[Complex<f64>]) -> f64 {
    matrix.iter().map(|x| x.norm2()).sum::<f64>().sqrt()
}

/// A bound of the logarithmic norm: Gershgorin's circles of the Hermitian part.
fn growth(matrix: &[Complex<f64>], size: usize) -> f64 {
    let mut largest = f64::NEG_INFINITY;
    for i in 0..size {
        let mut bound = matrix[i * size + i].re;
        for j in (0..size).filter(|&j| j != i) {
            bound += 0.5 * (matrix[i * size + j] + matrix[j * size + i].conj()).norm();
        }
        largest = largest.max(bound);
    }
    largest
}

pub(crate) fn complex(z: c64) -> Complex<f64> {
    Complex::new(z.re, z.im)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drive_gives_the_force_whatever_its_size() {
        let own = Mat::from_fn(2, 2, |r, c| c64::new(30.0 * r as f64 - 2.0, c as f64));
        for size in [0.0, 1e-310, 1e-200, 1.0, 1e200] {
            let force = Mat::from_fn(2, 1, |r, _| c64::new(size * r as f64, size));
            let drive = Drive::constant(&force, &own, 1.0);
            for r in 0..2 {
                let found = drive.gains[(r, 0)] * c64::new(drive.values[0].re, 0.0);
                assert!(
                    (found - force[(r, 0)]).norm() <= 1e-15 * size,
                    "{found} of {size}"
                );
            }
        }
    }
}
