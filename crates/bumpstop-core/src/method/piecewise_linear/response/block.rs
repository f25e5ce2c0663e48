//! Exponents that move together, `z' = B z + Y p`: of the coupled groups one each or a cluster of
//! them, and of motions by themselves.
//!
//! What a block does under a load is measured by its resolvent. A polynomial load is followed by
//! `-sum_m B^-(m+1) Y f^(m)` and a harmonic one by `(i omega - B)^-1 Y p`; where these inverses
//! are large over the length of the run, the motion is a small difference of large ones.

use super::integrals;
use super::orders::Orders;
use super::parts::ComplexParts;
use crate::method::piecewise_linear::cluster::complex;
use crate::method::piecewise_linear::rows::entry;
use crate::method::piecewise_linear::single_mode::{Regime, SingleMode};
use crate::method::piecewise_linear::spectrum::Spectrum;
use crate::number::{Complex, LANES};
use faer::linalg::solvers::Solve;
use faer::{Mat, c64};

/// Exponents with `|lambda| T` below this are slow beside a polynomial that goes on for the time
/// T: its degree makes one division by them after the other.
pub(super) const SLOW: f64 = 3.0;

/// A load and a motion resonate when they turn apart by less than this over the run: at more, the
/// two exponentials lose at most a factor of a few in their difference.
const APART: f64 = 0.7;

/// The columns of a block.
enum Columns {
    /// Of the coupled groups, by number.
    Coupled(Vec<usize>),
    /// Of a single: how its position is seen in them, and what a force on it gives to them.
    Single {
        index: usize,
        shapes: Vec<Complex<f64>>,
        lefts: Vec<Complex<f64>>,
    },
}

/// How long a load goes on as the polynomial that it is.
#[derive(Debug, Clone, Copy)]
pub(super) struct Course {
    /// The run, or a stretch between two knots.
    pub length: f64,
    pub is_table: bool,
}

impl Course {
    /// Exponents whose modulus times the length is below this are slow beside it: a table has one
    /// derivative only.
    fn slow(self) -> f64 {
        if self.is_table {
            integrals::FARTHEST
        } else {
            SLOW
        }
    }
}

/// How a block follows a polynomial.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Way {
    /// By the load's derivatives.
    Derivatives,
    /// By so many of its integrals.
    Integrals(usize),
    /// Bordered by the load.
    FromRest,
}

/// Exponents that move together.
pub(super) struct Block {
    columns: Columns,
    pub generator: Mat<c64>,
    /// Whether its columns are real; else their conjugates belong to the motion too.
    is_real: bool,
}

impl Block {
    /// Those of the coupled groups, without the padding of the lanes, which takes no part in
    /// anything.
    pub(super) fn coupled(spectrum: &Spectrum) -> Vec<Self> {
        let clusters = spectrum.clusters.iter().map(|cluster| {
            let generator = cluster.own();
            let columns = (cluster.at..cluster.at + generator.nrows()).collect();
            Self::of_columns(spectrum, columns, generator)
        });
        let is_there = |j: &usize| {
            let takes_part = |group| spectrum.left_velocity(group, *j).norm2() > 0.0;
            (0..spectrum.groups).any(takes_part) && !spectrum.clusters.iter().any(|c| c.holds(*j))
        };
        let alone = (0..spectrum.coupled_width * LANES).filter(is_there);
        let alone = alone.map(|j| {
            let generator = one_by_one(entry(&spectrum.lambda, j));
            Self::of_columns(spectrum, vec![j], generator)
        });
        clusters.chain(alone).collect()
    }

    fn of_columns(spectrum: &Spectrum, columns: Vec<usize>, generator: Mat<c64>) -> Self {
        let is_real = |j: &usize| {
            let vectors = |g| [spectrum.left_velocity(g, *j), spectrum.shape(g, *j)];
            (0..spectrum.groups).all(|g| vectors(g).iter().all(|z| z.im == 0.0))
        };
        let count = generator.nrows();
        let has_real_generator =
            (0..count * count).all(|i| generator[(i / count, i % count)].im == 0.0);
        Self {
            is_real: has_real_generator && columns.iter().all(is_real),
            columns: Columns::Coupled(columns),
            generator,
        }
    }

    /// That of a motion by itself: its exponent, or position (in the unit that makes the block as
    /// fast as the run) and velocity.
    pub(super) fn single(index: usize, motion: &SingleMode, duration: f64) -> Self {
        if let Regime::Oscillating(lambda) = motion.regime {
            return Self {
                columns: Columns::Single {
                    index,
                    shapes: vec![Complex::real(1.0)],
                    lefts: vec![Complex::new(0.0, -1.0 / lambda.im)],
                },
                generator: one_by_one(lambda),
                is_real: false,
            };
        }
        let unit = motion.omega2.abs().sqrt().max(1.0 / duration);
        let entries = [[0.0, unit], [-motion.omega2 / unit, -motion.damping]];
        Self {
            columns: Columns::Single {
                index,
                shapes: vec![Complex::real(1.0 / unit), Complex::zero()],
                lefts: vec![Complex::zero(), Complex::real(1.0)],
            },
            generator: Mat::from_fn(2, 2, |r, c| c64::new(entries[r][c], 0.0)),
            is_real: true,
        }
    }

    /// The same with all numbers conjugate, if they are not real: half of a load goes with each.
    pub(super) fn sides(&self) -> impl Iterator<Item = Side<'_>> {
        let side = |is_conjugate| Side {
            block: self,
            is_conjugate,
        };
        let conjugate = (!self.is_real).then(|| side(true));
        std::iter::once(side(false)).chain(conjugate)
    }

    /// How it follows a polynomial.
    pub(super) fn way(&self, course: Course) -> Way {
        if resolvent(&self.generator, Complex::zero()) * course.slow() <= course.length {
            return Way::Derivatives;
        }
        let norm = self.generator.norm_l2();
        match integrals::terms(norm, course.length).filter(|_| course.is_table) {
            Some(count) => Way::Integrals(count),
            None => Way::FromRest,
        }
    }

    /// How all modes see each column.
    pub(super) fn shapes(&self, spectrum: &Spectrum, modes: usize) -> Vec<Vec<Complex<f64>>> {
        let mut all = Vec::with_capacity(self.generator.nrows());
        for column in 0..self.generator.nrows() {
            let mut parts = ComplexParts::zero(spectrum);
            match &self.columns {
                Columns::Coupled(columns) => {
                    for group in 0..spectrum.groups {
                        parts.combined[group] = spectrum.shape(group, columns[column]);
                    }
                }
                Columns::Single { index, shapes, .. } => parts.singles[*index] = shapes[column],
            }
            all.push(parts.modes(spectrum, modes));
        }
        all
    }

    /// `Y p`
    pub(super) fn gains(&self, spectrum: &Spectrum, force: &ComplexParts) -> Vec<Complex<f64>> {
        match &self.columns {
            Columns::Coupled(columns) => {
                let gain = |j: &usize| {
                    let forces = force.combined.iter().enumerate().take(spectrum.groups);
                    forces.fold(Complex::zero(), |total, (group, p)| {
                        spectrum.left_velocity(group, *j).mul_add(*p, total)
                    })
                };
                columns.iter().map(gain).collect()
            }
            Columns::Single { index, lefts, .. } => lefts
                .iter()
                .map(|left| *left * force.singles[*index])
                .collect(),
        }
    }

    /// Adds `-sum_m B^-(m+1) Y f^(m)` to what the groups do under a force.
    pub(super) fn add_derivatives(
        &self,
        spectrum: &Spectrum,
        force: &ComplexParts,
        count: usize,
        orders: &mut Orders,
    ) {
        let gains = self.gains(spectrum, force);
        let mut term = Mat::from_fn(gains.len(), 1, |i, _| c64::new(-gains[i].re, -gains[i].im));
        let inverse = self.generator.full_piv_lu();
        for order in 0..count as i32 {
            term = inverse.solve(&term);
            self.add_seen(spectrum, &term, orders.groups(order));
        }
    }

    /// Adds `sum_n B^n Y` times the integrals of a force.
    pub(super) fn add_integrals(
        &self,
        spectrum: &Spectrum,
        force: &ComplexParts,
        count: usize,
        orders: &mut Orders,
    ) {
        let gains = self.gains(spectrum, force);
        let mut term = Mat::from_fn(gains.len(), 1, |i, _| c64::new(gains[i].re, gains[i].im));
        for n in 1..=count as i32 {
            self.add_seen(spectrum, &term, orders.groups(-n));
            term = &self.generator * &term;
        }
    }

    /// Adds what the groups see of its columns.
    fn add_seen(&self, spectrum: &Spectrum, z: &Mat<c64>, groups: &mut [f64]) {
        let Columns::Coupled(columns) = &self.columns else {
            return;
        };
        for (group, total) in groups.iter_mut().enumerate() {
            for (i, j) in columns.iter().enumerate() {
                let shape = spectrum.shape(group, *j);
                *total += shape.real_product(complex(z[(i, 0)]));
            }
        }
    }
}

/// A block, or its conjugate.
#[derive(Clone, Copy)]
pub(super) struct Side<'a> {
    block: &'a Block,
    is_conjugate: bool,
}

impl Side<'_> {
    fn of(&self, z: Complex<f64>) -> Complex<f64> {
        if self.is_conjugate { z.conj() } else { z }
    }

    pub(super) fn generator(&self) -> Mat<c64> {
        let count = self.block.generator.nrows();
        Mat::from_fn(count, count, |r, c| {
            let z = self.of(complex(self.block.generator[(r, c)]));
            c64::new(z.re, z.im)
        })
    }

    /// Whether a harmonic load resonates with it.
    pub(super) fn resonates(&self, omega: f64, duration: f64) -> bool {
        resolvent(&self.generator(), Complex::new(0.0, omega)) * APART > duration
    }

    pub(super) fn shapes(&self, spectrum: &Spectrum, modes: usize) -> Vec<Vec<Complex<f64>>> {
        let mut shapes = self.block.shapes(spectrum, modes);
        for z in shapes.iter_mut().flatten() {
            *z = self.of(*z);
        }
        shapes
    }

    /// What its share of a force gives to each column.
    pub(super) fn gains(&self, spectrum: &Spectrum, force: &ComplexParts) -> Vec<Complex<f64>> {
        let share = if self.block.is_real { 1.0 } else { 0.5 };
        // conj(Y) p = conj(Y conj(p))
        let own = ComplexParts {
            combined: force.combined.iter().map(|p| self.of(*p)).collect(),
            singles: force.singles.iter().map(|p| self.of(*p)).collect(),
        };
        let gains = self.block.gains(spectrum, &own).into_iter();
        gains.map(|z| self.of(z).scale(share)).collect()
    }

    /// `X (i omega - B)^-1 Y p` for all modes.
    pub(super) fn add_harmonic(
        &self,
        spectrum: &Spectrum,
        omega: f64,
        force: &ComplexParts,
        to: &mut [Complex<f64>],
    ) {
        let gains = self.gains(spectrum, force);
        let gains = Mat::from_fn(gains.len(), 1, |i, _| c64::new(gains[i].re, gains[i].im));
        let away = shifted(&self.generator(), Complex::new(0.0, omega));
        let moved = away.full_piv_lu().solve(&gains);
        for (i, row) in self.shapes(spectrum, to.len()).iter().enumerate() {
            for (to, shape) in to.iter_mut().zip(row) {
                *to = shape.mul_add(complex(moved[(i, 0)]), *to);
            }
        }
    }
}

fn one_by_one(z: Complex<f64>) -> Mat<c64> {
    Mat::from_fn(1, 1, |_, _| c64::new(z.re, z.im))
}

/// `s - B`
fn shifted(generator: &Mat<c64>, s: Complex<f64>) -> Mat<c64> {
    let count = generator.nrows();
    Mat::from_fn(count, count, |r, c| {
        let own = if r == c { s } else { Complex::zero() };
        c64::new(own.re, own.im) - generator[(r, c)]
    })
}

/// The norm of `(s - B)^-1`, infinite where there is none.
fn resolvent(generator: &Mat<c64>, s: Complex<f64>) -> f64 {
    let count = generator.nrows();
    let away = shifted(generator, s);
    if count == 1 {
        return 1.0 / complex(away[(0, 0)]).norm();
    }
    let inverse = away.full_piv_lu().solve(Mat::<c64>::identity(count, count));
    let size = inverse.norm_l2();
    if size.is_finite() {
        size
    } else {
        f64::INFINITY
    }
}
