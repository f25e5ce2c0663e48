//! How local coordinates see the motion of a phase.

use super::cluster::Cluster;
use super::response::Response;
use super::rows::{ComplexBlock, entry, set_entry};
use super::singles::Subject;
use super::spectrum::Spectrum;
use crate::forcing::{Forcing, Moved};
use crate::number::{Complex, Instructions, Lanes, Number};
use std::borrow::Cow;

/// How one local coordinate sees the motion of a phase.
#[derive(Debug, Clone, Default)]
pub(crate) struct View {
    /// Weight of each exponent's amplitude.
    pub exponents: Vec<ComplexBlock>,
    /// Weight of each column of the clusters, one cluster behind the other; these count for
    /// nothing among the exponents.
    pub clusters: Vec<Complex<f64>>,
    /// What it sees of the positions at rest, and of where coordinates are held.
    pub rest: f64,
    /// Weight of each single motion.
    pub singles: Vec<f64>,
    /// The single motions that it sees and that are more than exponentials around a rest.
    pub drifting: Vec<usize>,
    /// Weight of each link of the response to loads that change in time.
    pub links: Vec<f64>,
}

impl View {
    /// Sets the view of `row . q`; `combined` is room for the groups' share of the row.
    #[inline(always)]
    pub(crate) fn set<I: Instructions>(
        &mut self,
        spectrum: &Spectrum,
        row: &[f64],
        combined: &mut Vec<f64>,
    ) {
        combined.clear();
        combined.resize(spectrum.combinations, 0.0);
        spectrum.gather(row, combined);
        self.exponents.clear();
        self.exponents
            .resize(spectrum.lambda.len(), ComplexBlock::ZERO);
        self.rest = 0.0;
        for family in spectrum.families() {
            let weights = family.own(combined);
            for b in 0..family.width() {
                let mut total = Complex::<Lanes<I>>::zero();
                for (shape, weight) in family.shapes().zip(weights) {
                    let weight = Lanes::<I>::of(*weight);
                    total = shape[b].lanes().scale_add(weight, total);
                }
                self.exponents[family.first_block + b].put(total);
            }
        }
        self.clusters.clear();
        let following = spectrum.response.as_ref().map_or(0, |r| r.followers.len());
        for cluster in &spectrum.clusters[..spectrum.clusters.len() - following] {
            for column in cluster.at..cluster.at + cluster.size {
                self.clusters.push(entry(&self.exponents, column));
                set_entry(&mut self.exponents, column, Complex::zero());
            }
        }
        for (position, weight) in spectrum.at_rest.iter().zip(combined.iter()) {
            self.rest += position * weight;
        }
        if let Some(held) = &spectrum.held {
            self.rest += held.along(row);
        }
        self.singles.clear();
        self.drifting.clear();
        if spectrum.is_flight {
            self.set_flight(spectrum, row);
        } else {
            self.see_singles(spectrum, row, combined);
        }
        self.links.clear();
        if let Some(response) = &spectrum.response {
            self.see_loads(response, &spectrum.clusters, row);
        }
    }

    /// How a row sees what moves by itself, one after the other.
    #[inline(always)]
    fn see_singles(&mut self, spectrum: &Spectrum, row: &[f64], combined: &[f64]) {
        for single in &spectrum.singles {
            let weight = match single.subject {
                Subject::Mode(mode) => row[mode],
                Subject::Combination(number) => combined[number],
            };
            self.singles.push(weight);
            for i in 0..single.motion.count() {
                set_entry(&mut self.exponents, single.at + i, Complex::real(weight));
            }
            match single.motion.rest() {
                Some(rest) => self.rest += weight * rest,
                None if weight != 0.0 => self.drifting.push(self.singles.len() - 1),
                None => {}
            }
        }
    }

    /// How a row sees what follows loads that change in time.
    fn see_loads(&mut self, response: &Response, clusters: &[Cluster], row: &[f64]) {
        let seen = |shape: &[Complex<f64>]| {
            (row.iter().zip(shape)).fold(Complex::zero(), |total, (r, z)| z.scale_add(*r, total))
        };
        for link in &response.links {
            let seen = row.iter().zip(&link.row).map(|(r, a)| r * a).sum();
            self.links.push(seen);
        }
        for (harmonic, shape) in response.shapes.iter().enumerate() {
            set_entry(&mut self.exponents, response.at + harmonic, seen(shape));
        }
        for (follower, cluster) in response.following(clusters) {
            self.clusters
                .extend(follower.shapes.iter().map(|shape| seen(shape)));
            let load = std::iter::repeat_n(Complex::zero(), cluster.drives());
            self.clusters.extend(load);
        }
    }

    /// Takes off how far an obstacle has moved.
    pub(crate) fn subtract_motion(&mut self, response: &Response, forcing: &Forcing, of: Moved) {
        for (link, _) in response.motions.iter().filter(|(_, moved)| *moved == of) {
            self.links[*link] -= 1.0;
        }
        for (number, harmonic) in forcing.harmonics().iter().enumerate() {
            let at = response.at + number;
            for (_, motion) in harmonic.motions.iter().filter(|(moved, _)| *moved == of) {
                let seen = entry(&self.exponents, at) - *motion;
                set_entry(&mut self.exponents, at, seen);
            }
        }
    }

    /// The weights of all columns, those of clusters in their places.
    pub(crate) fn whole(&self, clusters: &[Cluster]) -> Cow<'_, [ComplexBlock]> {
        let mut row = Cow::Borrowed(&self.exponents[..]);
        let mut weights = self.clusters.iter();
        for cluster in clusters {
            for (column, weight) in (cluster.at..cluster.at + cluster.size).zip(&mut weights) {
                set_entry(row.to_mut(), column, *weight);
            }
        }
        row
    }
}
