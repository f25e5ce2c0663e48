//! Equations in which laws far stiffer than the structure stand apart from it.
//!
//! Added to the stiffness of a floor, that of the structure loses what the floor's rounding covers:
//! as many digits as the floor is stiffer, and the motions that slide along it lose as many. So
//! what the stiff laws feel, `z_1 = N y`, takes the place of as many modes, slow ones first, which
//! leaves the frequencies of the others graded as they are. Then these laws push by the columns of
//! `z_1` alone, and each entry is known to its own rounding.

use super::coupled::Coupled;
use crate::law::{COORDINATES, Local, Piece};
use faer::linalg::solvers::Solve;
use faer::{Mat, c64};

/// How many times stiffer than the structure laws are that stand apart.
pub(crate) const STIFFER: f64 = 1e3;

/// Part of a row that others do not make, relative to its largest entry, below which it is rounding.
const DEPENDENT: f64 = 1e-12;

/// Below this part it is neither rounding nor well apart: nothing is told apart then.
const NEARLY_DEPENDENT: f64 = 1e-3;

/// Part of a row's largest entry that a mode must have to make room for it.
const LARGE_ENOUGH: f64 = 0.1;

/// Sums of constants of this size, relative to their terms, are rounding.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// What is left of a force at rest, relative to it, above which there is no rest.
const UNBALANCED: f64 = 1e-9;

/// `z'' + C z' + K (z - rest) = p` with `y = T z`; the first `felt` coordinates are what stiff laws
/// feel.
#[derive(Debug, Clone)]
pub(crate) struct Stiff {
    pub felt: usize,
    /// T
    pub back: Mat<f64>,
    /// Its inverse.
    pub to: Mat<f64>,
    pub stiffness: Mat<f64>,
    pub damping: Mat<f64>,
    pub force: Mat<f64>,
    pub rest: Mat<f64>,
}

/// How a law acts on groups.
pub(crate) struct Push {
    pub rows: Vec<Vec<f64>>,
    pub piece: Piece,
}

impl Push {
    pub(crate) fn new(rows: impl Iterator<Item = Vec<f64>>, piece: Piece) -> Self {
        Self {
            rows: rows.collect(),
            piece,
        }
    }

    /// The largest entry of the stiffness that it makes.
    pub(crate) fn size(&self) -> f64 {
        let sizes: Vec<f64> = self.rows.iter().map(|row| largest(row)).collect();
        let entries = self.piece.stiffness.iter().zip(&sizes);
        let entries = entries.flat_map(|(row, own)| {
            (row.iter().zip(&sizes)).map(move |(factor, other)| (factor * own * other).abs())
        });
        entries.fold(0.0, f64::max)
    }

    /// Whether its forces depend on a coordinate.
    fn feels(&self, coordinate: usize) -> bool {
        let piece = &self.piece;
        (piece.stiffness.iter().chain(&piece.damping)).any(|row| row[coordinate] != 0.0)
    }

    /// What it would feel where it does not push; zero of what it does not feel.
    fn rest(&self) -> Local<f64> {
        let felt: Vec<usize> = (0..self.rows.len()).filter(|&i| self.feels(i)).collect();
        let count = felt.len();
        let stiffness = Mat::from_fn(count, count, |i, j| self.piece.stiffness[felt[i]][felt[j]]);
        let constant = Mat::from_fn(count, 1, |i, _| self.piece.constant[felt[i]]);
        let solution = stiffness.full_piv_lu().solve(&constant);
        let mut rest = [0.0; COORDINATES];
        if solution.is_all_finite() {
            for (i, &coordinate) in felt.iter().enumerate() {
                rest[coordinate] = solution[(i, 0)];
            }
        }
        rest
    }

    /// Its force where what it feels is given: none where only rounding is left of its terms.
    fn force_at(&self, local: &Local<f64>) -> Local<f64> {
        let mut force = self.piece.constant;
        for (force, row) in force.iter_mut().zip(&self.piece.stiffness) {
            let mut size = force.abs();
            for (factor, x) in row.iter().zip(local) {
                *force -= factor * x;
                size += (factor * x).abs();
            }
            if force.abs() <= ROUNDING * size {
                *force = 0.0;
            }
        }
        force
    }
}

impl Stiff {
    /// Tells stiff laws apart; `None` where their rows are neither well apart nor the same, or
    /// where they feel all motions.
    pub(crate) fn new(soft: &Coupled, pushes: &[&Push]) -> Option<Box<Self>> {
        let n = soft.force.nrows();
        let exchange = Exchange::of(pushes, n)?;
        let felt = exchange.pivots.len();
        if felt == 0 || felt == n {
            return None;
        }
        let (back, to) = exchange.matrices(n);
        let mut stiff = Self {
            felt,
            stiffness: &to * &soft.stiffness * &back,
            damping: &to * &soft.damping * &back,
            force: soft.force.clone(),
            rest: Mat::zeros(n, 1),
            back,
            to,
        };
        stiff.settle(pushes, &exchange);
        let shift = &stiff.stiffness * &stiff.rest;
        stiff.force = &stiff.to * &stiff.force - shift;
        for (push, places) in pushes.iter().zip(&exchange.places) {
            stiff.add(push, places);
        }
        Some(Box::new(stiff))
    }

    /// The places of what is felt in states of positions and velocities.
    pub(crate) fn fast(&self) -> Vec<usize> {
        let n = self.to.nrows();
        (0..self.felt).chain(n..n + self.felt).collect()
    }

    /// Finds where stiff laws would have what they feel, and adds what of their forces is left
    /// there.
    fn settle(&mut self, pushes: &[&Push], exchange: &Exchange) {
        let mut is_set = vec![false; self.felt];
        for (push, places) in pushes.iter().zip(&exchange.places) {
            let local = push.rest();
            for (coordinate, place) in places.iter().enumerate() {
                if let Some(Place::Own(own)) = place
                    && !is_set[*own]
                {
                    is_set[*own] = true;
                    self.rest[(*own, 0)] = local[coordinate];
                }
            }
            let mut there = [0.0; COORDINATES];
            for (x, place) in there.iter_mut().zip(places) {
                if let Some(place) = place {
                    *x = place.value(&self.rest);
                }
            }
            for (row, force) in push.rows.iter().zip(push.force_at(&there)) {
                for (i, factor) in row.iter().enumerate() {
                    self.force[(i, 0)] += factor * force;
                }
            }
        }
    }

    /// Adds the matrices of a law.
    fn add(&mut self, push: &Push, places: &[Option<Place>]) {
        let n = self.to.nrows();
        for (i, row) in push.rows.iter().enumerate() {
            let row = Mat::from_fn(n, 1, |r, _| row[r]);
            let pushed = &self.to * row;
            for (j, place) in places.iter().enumerate() {
                let Some(place) = place else { continue };
                let (k, c) = (push.piece.stiffness[i][j], push.piece.damping[i][j]);
                for (column, factor) in place.entries() {
                    for r in 0..n {
                        self.stiffness[(r, column)] += k * factor * pushed[(r, 0)];
                        self.damping[(r, column)] += c * factor * pushed[(r, 0)];
                    }
                }
            }
        }
    }

    /// `T (K + i omega C - omega^2)^-1 T^-1 p`: what is felt is solved for in units of its
    /// stiffness.
    pub(crate) fn harmonic(&self, omega: f64, forces: &Mat<c64>) -> Mat<c64> {
        let n = self.to.nrows();
        let unit = |i: usize| {
            self.stiffness[(i, i)]
                .abs()
                .max(omega * omega)
                .max(f64::MIN_POSITIVE)
        };
        let dynamic = Mat::from_fn(n, n, |r, c| {
            let inertia = if r == c { omega * omega } else { 0.0 };
            let (k, d) = (self.stiffness[(r, c)], self.damping[(r, c)]);
            c64::new((k - inertia) / unit(c), omega * d / unit(c))
        });
        let right = complex(&self.to) * forces;
        let scaled = dynamic.full_piv_lu().solve(&right);
        complex(&self.back) * Mat::from_fn(n, forces.ncols(), |i, c| scaled[(i, c)] / unit(i))
    }

    /// The position at rest under constant forces beside those of the laws; `None` where some
    /// motion that they push has no stiffness.
    pub(crate) fn rest(&self, forces: &Mat<f64>) -> Option<Vec<f64>> {
        let n = self.to.nrows();
        let right = &self.to * forces;
        let unit = |i: usize| self.stiffness[(i, i)].abs().max(f64::MIN_POSITIVE);
        let scaled = Mat::from_fn(n, n, |r, c| self.stiffness[(r, c)] / unit(c));
        let solution = scaled.full_piv_lu().solve(&right);
        let lack = &scaled * &solution - &right;
        // Written so that a lack which is not a number is one too large.
        let is_balanced = lack.norm_max() <= UNBALANCED * right.norm_max();
        let rest = &self.back * Mat::from_fn(n, 1, |i, _| solution[(i, 0)] / unit(i));
        is_balanced.then(|| (0..n).map(|i| rest[(i, 0)]).collect())
    }
}

/// What a row is made of: it is one of the new coordinates, or a sum of them.
enum Place {
    Own(usize),
    Sum(Vec<f64>),
}

impl Place {
    fn entries(&self) -> Vec<(usize, f64)> {
        match self {
            Self::Own(own) => vec![(*own, 1.0)],
            Self::Sum(factors) => factors.iter().copied().enumerate().collect(),
        }
    }

    fn value(&self, z: &Mat<f64>) -> f64 {
        let entries = self.entries();
        entries.iter().map(|(i, factor)| factor * z[(*i, 0)]).sum()
    }
}

/// Which rows take the place of which modes.
struct Exchange {
    rows: Vec<Vec<f64>>,
    /// The mode that makes room for each.
    pivots: Vec<usize>,
    /// Of each law's coordinates that it feels.
    places: Vec<Vec<Option<Place>>>,
}

impl Exchange {
    /// Gaussian elimination of the rows felt; `None` where some are nearly dependent.
    fn of(pushes: &[&Push], n: usize) -> Option<Self> {
        let mut exchange = Self {
            rows: Vec::new(),
            pivots: Vec::new(),
            places: Vec::new(),
        };
        // Each with the sum of rows that it is.
        let mut eliminated: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
        for push in pushes {
            let mut places = Vec::new();
            for (coordinate, row) in push.rows.iter().enumerate() {
                let is_felt = push.feels(coordinate) && row.iter().any(|x| *x != 0.0);
                places.push(if is_felt {
                    Some(exchange.place(row, &mut eliminated, n)?)
                } else {
                    None
                });
            }
            exchange.places.push(places);
        }
        Some(exchange)
    }

    fn place(
        &mut self,
        row: &[f64],
        eliminated: &mut Vec<(Vec<f64>, Vec<f64>)>,
        n: usize,
    ) -> Option<Place> {
        let (mut left, mut sum) = (row.to_vec(), vec![0.0; self.rows.len()]);
        for (pivot, (other, made_of)) in self.pivots.iter().zip(eliminated.iter()) {
            let factor = left[*pivot] / other[*pivot];
            for (left, x) in left.iter_mut().zip(other) {
                *left -= factor * x;
            }
            left[*pivot] = 0.0;
            for (sum, x) in sum.iter_mut().zip(made_of) {
                *sum += factor * x;
            }
        }
        let most = largest(&left);
        if most <= DEPENDENT * largest(row) {
            return Some(Place::Sum(sum));
        }
        if most < NEARLY_DEPENDENT * largest(row) {
            return None;
        }
        let pivot = (0..n).find(|&mode| left[mode].abs() >= LARGE_ENOUGH * most)?;
        let mut made_of: Vec<f64> = sum.iter().map(|x| -x).collect();
        made_of.push(1.0);
        self.rows.push(row.to_vec());
        self.pivots.push(pivot);
        eliminated.push((left, made_of));
        Some(Place::Own(self.rows.len() - 1))
    }

    /// `y = T z`, and the inverse of T: what is felt first, then the modes that stay.
    fn matrices(&self, n: usize) -> (Mat<f64>, Mat<f64>) {
        let (rows, pivots) = (&self.rows, &self.pivots);
        let felt = rows.len();
        let kept: Vec<usize> = (0..n).filter(|mode| !pivots.contains(mode)).collect();
        let mut to = Mat::zeros(n, n);
        for (i, row) in rows.iter().enumerate() {
            for (mode, factor) in row.iter().enumerate() {
                to[(i, mode)] = *factor;
            }
        }
        for (i, mode) in kept.iter().enumerate() {
            to[(felt + i, *mode)] = 1.0;
        }
        // y_P = N_P^-1 (z_1 - N_K y_K)
        let own = Mat::from_fn(felt, felt, |i, j| rows[i][pivots[j]]);
        let right = Mat::from_fn(felt, n, |i, c| match c.checked_sub(felt) {
            Some(other) => -rows[i][kept[other]],
            None => f64::from(u8::from(i == c)),
        });
        let made = own.full_piv_lu().solve(&right);
        let mut back = Mat::zeros(n, n);
        for (i, mode) in pivots.iter().enumerate() {
            for c in 0..n {
                back[(*mode, c)] = made[(i, c)];
            }
        }
        for (i, mode) in kept.iter().enumerate() {
            back[(*mode, felt + i)] = 1.0;
        }
        (back, to)
    }
}

fn largest(row: &[f64]) -> f64 {
    row.iter().fold(0.0, |most, x| most.max(x.abs()))
}

fn complex(matrix: &Mat<f64>) -> Mat<c64> {
    Mat::from_fn(matrix.nrows(), matrix.ncols(), |r, c| {
        c64::new(matrix[(r, c)], 0.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A floor with friction on four modes, and a second one that feels the same row.
    fn floors() -> (Coupled, Vec<Push>) {
        let rows = [vec![0.3, -0.8, 0.2, 0.5], vec![0.6, 0.1, -0.7, 0.2]];
        let mut slides = Piece::FREE;
        slides.stiffness[0][0] = 4e6;
        slides.stiffness[1][0] = 1e6;
        slides.damping[0][0] = 20.0;
        slides.constant = [4e4, 1e4, 0.0];
        let mut holds = Piece::FREE;
        holds.stiffness[0][0] = 8e6;
        holds.constant[0] = -3.0;
        let twice = rows[0].iter().map(|x| 2.0 * x).collect();
        let pushes = vec![
            Push::new(rows.into_iter(), slides),
            Push::new(std::iter::once(twice), holds),
        ];
        let diagonal =
            |values: [f64; 4]| Mat::from_fn(4, 4, |r, c| if r == c { values[r] } else { 0.0 });
        let soft = Coupled {
            stiffness: diagonal([1.0, 3.0, 5.0, 50.0]),
            damping: diagonal([0.1, 0.2, 0.0, 0.3]),
            force: Mat::from_fn(4, 1, |i, _| i as f64 - 1.5),
            stiff: None,
        };
        (soft, pushes)
    }

    #[test]
    fn the_equations_are_the_same_in_other_coordinates() {
        let (mut whole, pushes) = floors();
        let stiff = Stiff::new(&whole, &pushes.iter().collect::<Vec<_>>()).unwrap();
        for push in &pushes {
            whole.add(push);
        }
        assert_eq!(stiff.felt, 1);
        let close = |a: Mat<f64>, b: Mat<f64>, size: f64| {
            assert!((&a - &b).norm_max() < 1e-14 * size, "{a:?} {b:?}");
        };
        close(&stiff.back * &stiff.to, Mat::identity(4, 4), 1.0);
        close(
            &stiff.to * &whole.stiffness * &stiff.back,
            stiff.stiffness.clone(),
            4e7,
        );
        close(
            &stiff.to * &whole.damping * &stiff.back,
            stiff.damping.clone(),
            20.0,
        );
        let force = &stiff.force + &stiff.stiffness * &stiff.rest;
        close(&stiff.to * &whole.force, force, 1e5);
    }

    #[test]
    fn what_is_not_felt_has_entries_of_the_structure_alone() {
        let (soft, pushes) = floors();
        let stiff = Stiff::new(&soft, &pushes.iter().collect::<Vec<_>>()).unwrap();
        let others = stiff.stiffness.subcols(1, 3);
        assert!(others.norm_max() < 100.0);
        // The first floor is at rest where the second one pushes with what is left.
        assert!((stiff.rest[(0, 0)] - 0.01).abs() < 1e-17);
    }

    #[test]
    fn rows_that_are_nearly_the_same_are_left_together() {
        let (soft, mut pushes) = floors();
        pushes[1].rows[0][2] += 1e-6;
        assert!(Stiff::new(&soft, &pushes.iter().collect::<Vec<_>>()).is_none());
    }
}
