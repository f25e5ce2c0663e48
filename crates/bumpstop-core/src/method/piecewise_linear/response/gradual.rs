//! Exponents that turn so little over a run that polynomial loads are not small beside them.
//!
//! The series around s = 0 divides by such an exponent once more with each power of the time, and
//! what is left of the large terms is lost in rounding. The response of
//! `z' = B z + sum_k gain_k f_k` from rest, B one exponent or a cluster of them, is a power series
//! in the time since the start of the phase, whose terms `(B t)^n/n!` vanish soon.

use super::parts::{ComplexParts, Parts};
use crate::method::piecewise_linear::cluster::complex;
use crate::method::piecewise_linear::rows::entry;
use crate::method::piecewise_linear::single_mode::Regime;
use crate::method::piecewise_linear::spectrum::Spectrum;
use crate::number::{Complex, LANES};
use faer::linalg::solvers::Solve;
use faer::{Mat, c64};

/// `|B| T` below this is gradual over a run of length T.
const GRADUAL: f64 = 3.0;

/// Powers of the time; `GRADUAL^32/32!` is far below rounding.
pub(crate) const POWERS: usize = 32;

/// Coefficients of a power series of the time.
pub(crate) type Series = [Complex<f64>; POWERS];

/// An exponent or a cluster of them that is gradual.
#[derive(Debug, Clone)]
pub(crate) struct Gradual {
    /// Rows of B.
    generator: Vec<Vec<Complex<f64>>>,
    /// What each channel gives to each column.
    gains: Vec<Vec<Complex<f64>>>,
    /// How the modes take part in each column.
    pub rows: Vec<Vec<Complex<f64>>>,
}

/// Exponents of the coupled groups that are solved together: columns, and the block of them.
struct Block {
    columns: Vec<usize>,
    generator: Mat<c64>,
}

impl Block {
    /// All of a spectrum, without the padding of the lanes, which takes no part in anything.
    fn list(spectrum: &Spectrum) -> Vec<Self> {
        let clusters = spectrum.clusters.iter().map(|cluster| {
            let generator = cluster.own();
            let columns = (cluster.at..cluster.at + generator.nrows()).collect();
            Self { columns, generator }
        });
        let is_there = |j: &usize| {
            let takes_part = |group| entry(spectrum.left_velocity(group), *j).norm2() > 0.0;
            (0..spectrum.groups).any(takes_part) && !spectrum.clusters.iter().any(|c| c.holds(*j))
        };
        let alone = (0..spectrum.coupled_width * LANES).filter(is_there);
        let alone = alone.map(|j| {
            let lambda = entry(&spectrum.lambda, j);
            Self {
                columns: vec![j],
                generator: Mat::from_fn(1, 1, |_, _| c64::new(lambda.re, lambda.im)),
            }
        });
        clusters.chain(alone).collect()
    }

    fn is_gradual(&self, duration: f64) -> bool {
        self.generator.norm_l2() * duration < GRADUAL
    }

    /// What a force on the groups gives to each column.
    fn gains(&self, spectrum: &Spectrum, force: &Parts) -> Vec<Complex<f64>> {
        let gain = |j: &usize| {
            (force.combined.iter().enumerate()).fold(Complex::zero(), |total, (group, p)| {
                entry(spectrum.left_velocity(group), *j).scale_add(*p, total)
            })
        };
        self.columns.iter().map(gain).collect()
    }
}

/// Whether an exponent by itself is gradual over a run.
pub(super) fn is_gradual(lambda: Complex<f64>, duration: f64) -> bool {
    lambda.norm() * duration < GRADUAL
}

impl Gradual {
    /// Those of a spectrum, from the directions of the channels.
    pub(super) fn list(
        directions: &[&[f64]],
        spectrum: &Spectrum,
        modes: usize,
        duration: f64,
    ) -> Vec<Self> {
        if directions.is_empty() {
            return Vec::new();
        }
        let forces: Vec<Parts> = (directions.iter())
            .map(|direction| Parts::of(spectrum, direction))
            .collect();
        let blocks = Block::list(spectrum).into_iter();
        let coupled = blocks
            .filter(|block| block.is_gradual(duration))
            .map(|block| Self::of_block(&block, spectrum, &forces, modes));
        let singles = (0..spectrum.singles.len())
            .filter_map(|single| Self::of_single(single, spectrum, &forces, modes, duration));
        coupled.chain(singles).collect()
    }

    fn of_block(block: &Block, spectrum: &Spectrum, forces: &[Parts], modes: usize) -> Self {
        let row = |j: &usize| {
            let mut row = ComplexParts::zero(spectrum);
            for group in 0..spectrum.groups {
                row.combined[group] = entry(spectrum.shape(group), *j);
            }
            row.modes(spectrum, modes)
        };
        let generator = &block.generator;
        let count = generator.nrows();
        Self {
            generator: (0..count)
                .map(|r| (0..count).map(|c| complex(generator[(r, c)])).collect())
                .collect(),
            gains: forces.iter().map(|p| block.gains(spectrum, p)).collect(),
            rows: block.columns.iter().map(row).collect(),
        }
    }

    fn of_single(
        single: usize,
        spectrum: &Spectrum,
        forces: &[Parts],
        modes: usize,
        duration: f64,
    ) -> Option<Self> {
        let Regime::Oscillating(lambda) = spectrum.singles[single].motion.regime else {
            return None;
        };
        let mut row = ComplexParts::zero(spectrum);
        row.singles[single] = Complex::real(1.0);
        let left = Complex::new(0.0, -1.0 / lambda.im);
        is_gradual(lambda, duration).then(|| Self {
            generator: vec![vec![lambda]],
            gains: (forces.iter())
                .map(|p| vec![left.scale(p.singles[single])])
                .collect(),
            rows: vec![row.modes(spectrum, modes)],
        })
    }

    /// The series of each column, from the coefficients of the channels.
    pub(crate) fn series(&self, coefficients: &[f64], stride: usize) -> Vec<Series> {
        let mut series = vec![[Complex::zero(); POWERS]; self.generator.len()];
        for n in 0..POWERS - 1 {
            for (column, row) in self.generator.iter().enumerate() {
                let mut next = Complex::zero();
                for (factor, other) in row.iter().zip(&series) {
                    next = factor.mul_add(other[n], next);
                }
                if n < stride {
                    for (gains, channel) in self.gains.iter().zip(coefficients.chunks(stride)) {
                        next = gains[column].scale_add(channel[n], next);
                    }
                }
                series[column][n + 1] = next.scale(1.0 / (n + 1) as f64);
            }
        }
        series
    }
}

/// The series of the coupled groups under a force, without what is gradual: each other block
/// follows `f` by `-sum_m B^-(m+1) f^(m)`. `None` where nothing is gradual.
pub(super) fn series_of_others(
    spectrum: &Spectrum,
    force: &Parts,
    orders: usize,
    duration: f64,
) -> Option<Vec<Vec<f64>>> {
    let blocks = Block::list(spectrum);
    if !blocks.iter().any(|block| block.is_gradual(duration)) {
        return None;
    }
    let mut series = vec![vec![0.0; spectrum.groups]; orders];
    for block in blocks.iter().filter(|block| !block.is_gradual(duration)) {
        let gains = block.gains(spectrum, force);
        let mut term = Mat::from_fn(gains.len(), 1, |i, _| c64::new(-gains[i].re, -gains[i].im));
        let inverse = block.generator.full_piv_lu();
        for row in &mut series {
            term = inverse.solve(&term);
            for (group, total) in row.iter_mut().enumerate() {
                for (i, j) in block.columns.iter().enumerate() {
                    let shape = entry(spectrum.shape(group), *j);
                    *total += shape.real_product(complex(term[(i, 0)]));
                }
            }
        }
    }
    Some(series)
}

/// Value and slope of a power series at t.
pub(super) fn value_and_slope(series: &Series, t: f64) -> [Complex<f64>; 2] {
    let (mut value, mut slope) = (Complex::zero(), Complex::zero());
    for (n, c) in series.iter().enumerate().rev() {
        value = value.scale(t) + *c;
        if n > 0 {
            slope = slope.scale(t) + c.scale(n as f64);
        }
    }
    [value, slope]
}
