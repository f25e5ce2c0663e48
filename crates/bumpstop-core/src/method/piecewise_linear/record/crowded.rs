//! Instants that crowd within a phase. Over a short time the sum of all exponentials is a
//! polynomial of low degree to rounding; between some nodes it costs a tenth of the sum.

use crate::method::piecewise_linear::rows::{RealBlock, eight_of, put_eight};
use crate::method::piecewise_linear::spectrum::Spectrum;
use crate::number::{Instructions, LANES, Lanes, Number};
use std::f64::consts::PI;
use std::sync::LazyLock;

/// Nodes of an interval, and terms of its polynomial.
pub(super) const NODES: usize = 16;

/// The fastest exponent times half the length of an interval. The coefficients of `exp(z x)` are
/// `2 I_n(z)`, so that for `|z| <= 1` interpolation misses less than `4 (1/2)^16/16!` of each
/// exponential, 3e-18 (L. N. Trefethen, *Approximation Theory and Approximation Practice*, 2013,
/// theorem 4.2).
const TURN: f64 = 1.0;

/// Instants in an interval from which on its nodes are worth their while.
const CROWD: usize = 3 * NODES;

/// Length of the intervals of a spectrum, in s; zero where its motion is more than exponentials
/// and a position at rest, or hardly costs more than the polynomial.
#[inline(always)]
pub(super) fn interval(spectrum: &Spectrum) -> f64 {
    let dense = spectrum.groups_are_modes && spectrum.groups > NODES;
    if dense && spectrum.clusters.is_empty() && spectrum.response.is_none() {
        2.0 * TURN / spectrum.fastest
    } else {
        0.0
    }
}

/// How many of the first instants, in order, crowd before `until`; none where they are few.
#[inline(always)]
pub(super) fn crowd(times: &[f64], until: f64) -> Option<usize> {
    let last = *times.get(CROWD - 1)?;
    if last >= until || !times[..CROWD].is_sorted() {
        return None;
    }
    let follows = |pair: &&[f64]| pair[0] <= pair[1] && pair[1] < until;
    Some(1 + times.windows(2).take_while(follows).count())
}

/// Polynomials of some numbers over an interval, in the form of Chebyshev's series.
#[derive(Debug, Default)]
pub(super) struct Series {
    middle: f64,
    half: f64,
    /// A row for each term.
    coefficients: Vec<RealBlock>,
    /// Blocks in a row.
    width: usize,
    numbers: usize,
}

impl Series {
    /// Takes an interval and returns its nodes.
    #[inline(always)]
    pub(super) fn set_interval(&mut self, [from, until]: [f64; 2]) -> [f64; NODES] {
        (self.middle, self.half) = (0.5 * (from + until), 0.5 * (until - from));
        std::array::from_fn(|node| self.middle + self.half * cosine(2 * node + 1))
    }

    /// Takes the numbers at the nodes, a row for each.
    #[inline(always)]
    pub(super) fn fit<I: Instructions>(&mut self, rows: &[f64]) {
        self.numbers = rows.len() / NODES;
        self.width = self.numbers.div_ceil(LANES);
        self.coefficients
            .resize(NODES * self.width, RealBlock::ZERO);
        for (term, coefficients) in self.coefficients.chunks_mut(self.width).enumerate() {
            let share = if term == 0 { 1.0 } else { 2.0 } / NODES as f64;
            let weights: [f64; NODES] =
                std::array::from_fn(|node| share * cosine(term * (2 * node + 1)));
            for (block, to) in coefficients.iter_mut().enumerate() {
                let mut sum = Lanes::<I>::of(0.0);
                for (row, weight) in rows.chunks(self.numbers).zip(weights) {
                    let first = block * LANES;
                    let values = eight_of(&row[first..self.numbers.min(first + LANES)]);
                    sum = values.mul_add(Lanes::of(weight), sum);
                }
                to.put(sum);
            }
        }
    }

    /// The numbers at each instant, a row for each.
    #[inline(always)]
    pub(super) fn at<I: Instructions>(&self, instants: &[f64], rows: &mut [f64]) {
        let rows = &mut rows[..instants.len() * self.numbers];
        for (instants, rows) in instants
            .chunks(LANES)
            .zip(rows.chunks_mut(LANES * self.numbers))
        {
            let terms = self.terms::<I>(instants);
            for block in 0..self.width {
                let mut sums = [Lanes::<I>::of(0.0); LANES];
                for (term, of_instants) in terms.iter().enumerate() {
                    let coefficients = self.coefficients[term * self.width + block].lanes();
                    for (sum, factor) in sums.iter_mut().zip(&of_instants.0) {
                        *sum = Lanes::of(*factor).mul_add(coefficients, *sum);
                    }
                }
                for (row, sum) in rows.chunks_mut(self.numbers).zip(sums) {
                    let first = block * LANES;
                    put_eight(sum, &mut row[first..self.numbers.min(first + LANES)]);
                }
            }
        }
    }

    /// `T_n` at up to eight instants, from the lowest to the highest degree.
    #[inline(always)]
    fn terms<I: Instructions>(&self, instants: &[f64]) -> [RealBlock; NODES] {
        let mut since = [self.middle; LANES];
        since[..instants.len()].copy_from_slice(instants);
        let scale = if self.half > 0.0 {
            1.0 / self.half
        } else {
            0.0
        };
        let x = (Lanes::<I>::new(since) - Lanes::of(self.middle)) * Lanes::of(scale);
        let (mut before, mut now) = (Lanes::<I>::of(1.0), x);
        let mut terms = [RealBlock::ONE; NODES];
        for term in &mut terms[1..] {
            term.put(now);
            (before, now) = (now, (x + x).mul_add(now, -before));
        }
        terms
    }
}

/// `cos(n pi/2N)` for N nodes and n over a whole turn.
static COSINES: LazyLock<[f64; 4 * NODES]> =
    LazyLock::new(|| std::array::from_fn(|n| (n as f64 * (PI / (2 * NODES) as f64)).cos()));

/// `cos(n pi/2N)` for N nodes.
#[inline(always)]
fn cosine(n: usize) -> f64 {
    COSINES[n % (4 * NODES)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::forcing::Forcing;
    use crate::history::{Derivative, History};
    use crate::law::Stop;
    use crate::method::piecewise_linear::simulate;
    use crate::number::Plain;
    use crate::problem::Problem;
    use crate::system::ModalSystem;
    use proptest::prelude::*;
    use std::sync::Arc;

    const MODES: usize = 20;

    /// The fastest mode turns by some hundred radians in a phase, and an angle is known to its
    /// rounding.
    const ROUNDING: f64 = 2e-14;

    /// Modes that hammer on a stop, damped.
    fn hammering() -> History<Stop> {
        let omega: Vec<f64> = (1..=MODES).map(|n| 40.0 * (n as f64).powf(1.5)).collect();
        let omega2 = omega.iter().map(|w| w * w).collect();
        let damping = omega.iter().map(|w| 0.02 * w).collect();
        let row: Vec<f64> = (0..MODES).map(|n| (1.3 * n as f64).cos()).collect();
        let stop = Stop::new(row, 0.0, 2e4, 3.0).unwrap();
        let problem = Problem::new(
            ModalSystem::new(omega2, damping).unwrap(),
            vec![stop],
            Forcing::constant(vec![0.0; MODES]).unwrap(),
            vec![0.0; MODES],
            vec![-0.5; MODES],
            0.3,
        );
        simulate(&Arc::new(problem.unwrap()), &mut |_| true).unwrap()
    }

    /// The largest difference between instants together and each by itself, and the largest
    /// motion.
    fn compared(history: &History<Stop>, times: &[f64], derivative: Derivative) -> (f64, f64) {
        let together = history.motion(times, derivative).unwrap();
        let (mut difference, mut largest) = (0.0f64, 0.0f64);
        for (time, row) in times.iter().zip(together.chunks(MODES)) {
            let alone = history.motion(&[*time], derivative).unwrap();
            for (a, b) in row.iter().zip(&alone) {
                difference = difference.max((a - b).abs());
                largest = largest.max(b.abs());
            }
        }
        (difference, largest)
    }

    #[test]
    fn crowded_instants_move_as_single_ones() {
        let history = hammering();
        let times: Vec<f64> = (0..30_000).map(|n| 1e-5 * f64::from(n)).collect();
        for derivative in [Derivative::Displacement, Derivative::Velocity] {
            let (difference, largest) = compared(&history, &times, derivative);
            assert!(difference > 0.0, "nothing was interpolated");
            assert!(difference < ROUNDING * largest, "{difference} of {largest}");
        }
    }

    #[test]
    fn instants_out_of_order_or_equal_are_taken_too() {
        let history = hammering();
        let mut times: Vec<f64> = (0..2000).map(|n| 0.1 + 1e-5 * f64::from(n)).collect();
        times[700..900].reverse();
        times.extend([0.25; 100]);
        let (difference, largest) = compared(&history, &times, Derivative::Displacement);
        assert!(difference < ROUNDING * largest, "{difference} of {largest}");
    }

    proptest! {
        /// Whatever the exponents of an interval are, up to the fastest that it is made for.
        #[test]
        fn a_series_is_its_exponentials(
            polar in prop::collection::vec((0.0..=TURN, 0.0..6.3), 1..30),
            at in prop::collection::vec(-1.0..=1.0, 1..30),
        ) {
            let z: Vec<_> = polar.iter().map(|(r, phi)| (r * f64::cos(*phi), r * f64::sin(*phi))).collect();
            let values = |x: f64| z.iter().map(move |(re, im)| (re * x).exp() * (im * x).cos());
            let mut series = Series::default();
            let nodes = series.set_interval([-1.0, 1.0]);
            let rows: Vec<f64> = nodes.iter().flat_map(|x| values(*x)).collect();
            series.fit::<Plain>(&rows);
            let mut found = vec![0.0; at.len() * z.len()];
            series.at::<Plain>(&at, &mut found);
            for (x, row) in at.iter().zip(found.chunks(z.len())) {
                for (a, b) in row.iter().zip(values(*x)) {
                    prop_assert!((a - b).abs() < 6e-15, "{a} {b}");
                }
            }
        }
    }
}
