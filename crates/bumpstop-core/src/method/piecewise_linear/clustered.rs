//! The part of a signal that clusters have in it.

use super::cluster::{Cluster, Columns, NOTHING};
use super::jet::{Jet, Jets};
use super::phase::{Phase, Phases};
use super::quadrature::integral;
use super::spectrum::Spectrum;
use super::tables::CELLS;
use super::view::View;
use crate::law::{Affine, COORDINATES};
use crate::number::{Complex, Number};

/// Derivatives that are followed at the middle of a cell; the next one is bounded.
const FOLLOWED_ORDERS: usize = 9;

/// `row B^n` of each order up to the bounded one.
const ORDERS: usize = FOLLOWED_ORDERS + 1;

/// Blocks whose norm times the reach of a cell is below this are followed, others bounded.
const FOLLOWED: f64 = 1.8;

/// Bound of the rounding of a cluster's value, relative to `|row| |z|`: some fifty products of
/// short rows.
const ROUNDING: f64 = 400.0 * 0.5 * f64::EPSILON;

/// One cluster's part.
#[derive(Debug, Clone, Copy)]
struct Part {
    cluster: usize,
    /// Where its rows start.
    rows: usize,
}

/// `Re sum row . z(t)` over clusters.
#[derive(Debug, Clone, Default)]
pub(crate) struct Clustered {
    parts: Vec<Part>,
    rows: Vec<Complex<f64>>,
}

impl Clustered {
    /// Takes the clusters' parts in a function of the local motion.
    pub(crate) fn set(&mut self, clusters: &[Cluster], views: &[View], function: &Affine) {
        self.parts.clear();
        self.rows.clear();
        let mut first = 0;
        for (number, cluster) in clusters.iter().enumerate() {
            let mut row = NOTHING;
            for (coordinate, view) in views.iter().enumerate().take(COORDINATES) {
                if function.sees(coordinate) {
                    let weights = &view.clusters[first..first + cluster.size];
                    add_weights(cluster, weights, function, coordinate, &mut row);
                }
            }
            first += cluster.size;
            self.add(number, cluster, &row);
        }
    }

    /// Adds a part and the rows of its derivatives.
    fn add(&mut self, number: usize, cluster: &Cluster, row: &Columns) {
        self.parts.push(Part {
            cluster: number,
            rows: self.rows.len(),
        });
        let mut row = *row;
        for _ in 0..ORDERS {
            self.rows.extend_from_slice(&row[..cluster.size]);
            let mut next = NOTHING;
            cluster.row_rate(&row[..cluster.size], &mut next[..cluster.size]);
            row = next;
        }
    }

    fn row(&self, part: Part, cluster: &Cluster, order: usize) -> &[Complex<f64>] {
        &self.rows[part.rows + order * cluster.size..][..cluster.size]
    }

    /// The rate of all of it.
    pub(crate) fn derivative(&self, clusters: &[Cluster]) -> Self {
        let mut rate = Self::default();
        for part in &self.parts {
            let cluster = &clusters[part.cluster];
            let mut row = NOTHING;
            row[..cluster.size].copy_from_slice(self.row(*part, cluster, 1));
            rate.add(part.cluster, cluster, &row);
        }
        rate
    }

    pub(crate) fn negate(&mut self) {
        for entry in &mut self.rows {
            *entry = -*entry;
        }
    }

    /// Each part with its cluster and its motion `t` after the start.
    fn moving<'a>(
        &'a self,
        phases: &'a Phases,
        phase: Phase,
        t: f64,
    ) -> impl Iterator<Item = (Part, &'a Cluster, Columns)> + 'a {
        let spectrum = &phases.spectra[phase.spectrum];
        let amplitudes = phases.amplitudes(phase);
        self.parts.iter().map(move |part| {
            let cluster = &spectrum.clusters[part.cluster];
            let mut z = cluster.columns(amplitudes);
            cluster.advance(t, &mut z);
            (*part, cluster, z)
        })
    }

    /// Adds value and first two derivatives.
    pub(crate) fn add_values(&self, phases: &Phases, phase: Phase, t: f64, to: &mut [f64; 3]) {
        for (part, cluster, z) in self.moving(phases, phase, t) {
            for (order, to) in to.iter_mut().enumerate() {
                *to += real_product(self.row(part, cluster, order), &z);
            }
        }
    }

    /// Adds `|row B^n| |z|` at the start.
    pub(crate) fn add_sizes(&self, phases: &Phases, phase: Phase, to: &mut [f64; 3]) {
        for (part, cluster, z) in self.moving(phases, phase, 0.0) {
            let size = norm(&z);
            for (order, to) in to.iter_mut().enumerate() {
                *to += norm(self.row(part, cluster, order)) * size;
            }
        }
    }

    /// Adds the parts to a jet at time t, valid over `reach` to both sides.
    ///
    /// A followed part has derivatives up to the eighth at the middle, the ninth being at most
    /// `|row B^9| |z| exp(|B| reach)`; a bounded one is at most `|row B^n|` times the size of z at
    /// the left end, carried on by the logarithmic norm.
    pub(crate) fn add_to_jet(
        &self,
        phases: &Phases,
        phase: Phase,
        t: f64,
        reach: f64,
        jet: &mut Jet,
    ) {
        for (part, cluster, z) in self.moving(phases, phase, t) {
            let size = norm(&z);
            let row = |order: usize| self.row(part, cluster, order);
            // Of the parabola, and of slope and curvature times r and r^2.
            let reached = norm(row(0)) + reach * (norm(row(1)) + reach * norm(row(2)));
            jet.rounding += ROUNDING * reached * size;
            if cluster.norm() * reach < FOLLOWED {
                jet.value += real_product(row(0), &z);
                jet.slope += real_product(row(1), &z);
                jet.curvature += real_product(row(2), &z);
                let mut power = 1.0;
                for order in 3..FOLLOWED_ORDERS {
                    jet.third += real_product(row(order), &z).abs() * power;
                    power *= reach / (order - 2) as f64;
                }
                let last = norm(row(FOLLOWED_ORDERS)) * size;
                jet.third += last * power * Number::exp(cluster.norm() * reach);
                continue;
            }
            let mut left = cluster.columns(phases.amplitudes(phase));
            cluster.advance((t - reach).max(0.0), &mut left);
            let largest = norm(&left) * Number::exp(2.0 * reach * cluster.growth().max(0.0));
            for (order, rest) in jet.rest.iter_mut().enumerate() {
                *rest += norm(row(order)) * largest;
            }
        }
    }

    /// Adds the parts to jets on consecutive cells of the given width from a time on.
    #[cold]
    pub(crate) fn add_to_jets(
        &self,
        phases: &Phases,
        phase: Phase,
        time: f64,
        width: f64,
        jets: &mut Jets,
    ) {
        let mut largest = Jet::default();
        for cell in 0..CELLS {
            let mut jet = Jet::default();
            let middle = time + (cell as f64 + 0.5) * width;
            self.add_to_jet(phases, phase, middle, 0.5 * width, &mut jet);
            jets.values[cell] += jet.value;
            jets.slopes[cell] += jet.slope;
            jets.curvatures[cell] += jet.curvature;
            largest.third = largest.third.max(jet.third);
            largest.rounding = largest.rounding.max(jet.rounding);
            for (largest, rest) in largest.rest.iter_mut().zip(jet.rest) {
                *largest = largest.max(rest);
            }
        }
        jets.third += largest.third;
        jets.rounding += largest.rounding;
        for (rest, largest) in jets.rest.iter_mut().zip(largest.rest) {
            *rest += largest;
        }
    }

    #[inline(always)]
    pub(crate) fn is_empty(&self) -> bool {
        self.parts.is_empty()
    }

    /// A modulus that no exponent in it exceeds.
    pub(crate) fn pace(&self, spectrum: &Spectrum) -> f64 {
        (self.parts.iter())
            .map(|part| spectrum.clusters[part.cluster].norm())
            .fold(0.0, f64::max)
    }

    /// Integral of all of it from the start of the phase to t.
    pub(crate) fn integral(&self, phases: &Phases, phase: Phase, t: f64) -> f64 {
        if self.is_empty() {
            return 0.0;
        }
        let pace = self.pace(&phases.spectra[phase.spectrum]);
        integral(t, pace, |t| {
            let mut values = [0.0; 3];
            self.add_values(phases, phase, t, &mut values);
            values[0]
        })
    }
}

/// Adds what one coordinate, its velocity and its acceleration see of a cluster.
fn add_weights(
    cluster: &Cluster,
    weights: &[Complex<f64>],
    function: &Affine,
    coordinate: usize,
    to: &mut Columns,
) {
    let factors = [function.position, function.velocity, function.acceleration];
    let mut row = NOTHING;
    row[..cluster.size].copy_from_slice(weights);
    for factor in factors.map(|factors| factors[coordinate]) {
        for (to, weight) in to.iter_mut().zip(&row).take(cluster.size) {
            *to += weight.scale(factor);
        }
        let mut rate = NOTHING;
        cluster.row_rate(&row[..cluster.size], &mut rate[..cluster.size]);
        row = rate;
    }
}

fn real_product(row: &[Complex<f64>], z: &Columns) -> f64 {
    let mut total = 0.0;
    for (row, z) in row.iter().zip(z) {
        total = row.add_real_product(*z, total);
    }
    total
}

fn norm(row: &[Complex<f64>]) -> f64 {
    row.iter().map(|x| x.norm2()).sum::<f64>().sqrt()
}
