//! How the structure follows loads that change in time, one response a spectrum.
//!
//! With `s` for the time derivative the motion under a force `p` is `(s^2 + C s + K)^-1 p`. A load
//! that is a polynomial f of the time along a vector g is followed by another polynomial,
//!
//! ```text
//! sum_m a_m f^(m),   K a_m = -C a_(m-1) - a_(m-2),   K a_0 = g,
//! ```
//!
//! the series of the inverse around s = 0. Where a single motion has no stiffness the series
//! begins with integrals of f (orders -1 and -2), taken from the start of the phase. What is slow
//! beside a stretch between two knots of a table follows it by integrals alone, see [`integrals`]. A
//! harmonic load is followed by `(K + i omega C - omega^2)^-1 g exp(i omega t)`: one more exponent of the
//! phase, the same in all modes. What is left, the state less both at the start of the phase, moves
//! freely. Exponents that are slow beside a polynomial or resonate with a harmonic follow it from
//! rest instead, see [`follower`].

mod block;
mod drives;
mod follower;
mod integrals;
mod link;
mod making;
mod orders;
mod parts;
mod single;
mod stretch;

pub(crate) use drives::Drives;
pub(crate) use follower::{Follower, Leader};
pub(crate) use link::Link;
pub(crate) use stretch::Stretch;

use super::cluster::Cluster;
use super::impedance::Impedance;
use super::phase::{Phase, Phases};
use super::polynomial::of_derivative;
use super::product::Factor;
use super::rows::{ComplexBlock, set_entry};
use super::spectrum::Spectrum;
use crate::forcing::{Forcing, Moved, Onset};
use crate::number::Complex;
use making::Making;

/// So many cells at least lie in the time for which integrals serve: behind it their polynomials,
/// and the bounds of these, grow fast.
const CELLS_OF_INTEGRALS: f64 = 4.0;

/// Lengths that tell what is slow, in s.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Times {
    /// Of the run.
    pub duration: f64,
    /// Of the longest stretch between two knots.
    pub stretch: f64,
}

/// The response of all modes.
#[derive(Debug, Clone)]
pub(crate) struct Response {
    /// Coefficients of each channel.
    pub stride: usize,
    /// The longest time for which integrals of tables serve, in s; infinite where there are none.
    pub reach: f64,
    pub links: Vec<Link>,
    /// Where the exponents of the harmonics begin.
    pub at: usize,
    pub omegas: Vec<f64>,
    /// How the modes follow each harmonic.
    pub shapes: Vec<Vec<Complex<f64>>>,
    /// Those of the spectrum's last clusters.
    pub followers: Vec<Follower>,
    /// What is followed.
    pub drives: Drives,
    /// Links that move no mode: the motions of obstacles.
    pub motions: Vec<(usize, Moved)>,
}

impl Response {
    /// The response of a spectrum whose exponents are known, and the clusters of what follows loads
    /// from rest; `impedance` is that of its groups.
    pub(crate) fn new(
        forcing: &Forcing,
        drives: Drives,
        spectrum: &Spectrum,
        impedance: Option<&Impedance<'_>>,
        times: Times,
    ) -> (Self, Vec<Cluster>) {
        let mut response = Self {
            stride: forcing.stride(),
            reach: f64::INFINITY,
            links: Vec::new(),
            at: spectrum.forced_at,
            omegas: forcing.harmonics().iter().map(|h| h.omega).collect(),
            shapes: Vec::new(),
            followers: Vec::new(),
            drives,
            motions: Vec::new(),
        };
        let clusters = Making::new(&mut response, spectrum, impedance, forcing, times).follow();
        response.add_motions(forcing);
        (response, clusters)
    }

    fn add_motions(&mut self, forcing: &Forcing) {
        for (channel, load) in forcing.channels().iter().enumerate() {
            if let Some(moved) = load.moves {
                self.motions.push((self.links.len(), moved));
                self.links.push(Link {
                    channel,
                    pushed: 0,
                    order: 0,
                    row: vec![0.0; load.direction.len()],
                });
            }
        }
    }

    /// The speed of an obstacle during a phase.
    pub(crate) fn obstacle_rate(
        &self,
        forcing: &Forcing,
        of: Moved,
        phases: &Phases,
        phase: Phase,
    ) -> Factor<'static> {
        let coefficients = phases.coefficients(phase);
        let mut rate = Factor {
            amplitudes: vec![ComplexBlock::ZERO; phases.amplitudes(phase).len()],
            polynomial: vec![0.0; self.stride],
            other: None,
        };
        for (link, _) in self.motions.iter().filter(|(_, moved)| *moved == of) {
            let channel = self.links[*link].channel;
            let channel = &coefficients[channel * self.stride..][..self.stride];
            for (power, to) in rate.polynomial.iter_mut().enumerate() {
                *to += of_derivative(channel, 1, power);
            }
        }
        for (number, harmonic) in forcing.harmonics().iter().enumerate() {
            let own = harmonic.motions.iter().filter(|(moved, _)| *moved == of);
            let amplitude = own.fold(Complex::zero(), |total, (_, motion)| total + *motion);
            let turning = amplitude * Complex::new(0.0, harmonic.omega);
            let unit = phases.unit(phase, self, number);
            set_entry(&mut rate.amplitudes, self.at + number, turning * unit);
        }
        rate
    }

    /// A frequency at which cells are short beside the time for which integrals serve, in rad/s.
    pub(crate) fn pace(&self) -> f64 {
        CELLS_OF_INTEGRALS / self.reach
    }

    /// Numbers in its arrays.
    pub(crate) fn numbers(&self) -> usize {
        let links = self.links.iter().map(|link| link.row.len()).sum::<usize>();
        let followers = self.followers.iter().flat_map(|follower| &follower.shapes);
        let shapes = self.shapes.iter().chain(followers).map(Vec::len);
        links + 2 * shapes.sum::<usize>()
    }

    /// The followers with their clusters, of all those of the spectrum.
    pub(crate) fn following<'a>(
        &'a self,
        clusters: &'a [Cluster],
    ) -> impl Iterator<Item = (&'a Follower, &'a Cluster)> {
        let own = clusters.len() - self.followers.len();
        self.followers.iter().zip(&clusters[own..])
    }

    /// Sets the columns of loads for a phase.
    pub(crate) fn set_loads(&self, clusters: &[Cluster], onset: &Onset, to: &mut [ComplexBlock]) {
        for (follower, cluster) in self.following(clusters) {
            cluster.put(&follower.start(cluster, onset, self.stride), to);
        }
        for (harmonic, unit) in onset.units.iter().enumerate() {
            set_entry(to, self.at + harmonic, *unit);
        }
    }

    /// Takes displacement and velocity of all modes at the start of a phase from a state.
    pub(crate) fn subtract_start(
        &self,
        clusters: &[Cluster],
        onset: &Onset,
        q: &mut [f64],
        v: &mut [f64],
    ) {
        let units = |harmonic: usize| onset.units[harmonic];
        self.add_motion(-1.0, &onset.coefficients, units, 0.0, q, v);
        for (follower, cluster) in self.following(clusters) {
            let columns = follower.start(cluster, onset, self.stride);
            follower.add_motion(cluster, &columns, -1.0, q, v);
        }
    }

    /// Adds displacement and velocity of all modes `t` after the start of a phase: `units` are the
    /// harmonics' exponentials at the start, and `columns` those of all clusters by now.
    pub(crate) fn add_to(
        &self,
        clusters: &[Cluster],
        columns: &[ComplexBlock],
        coefficients: &[f64],
        units: impl Fn(usize) -> Complex<f64>,
        t: f64,
        [q, v]: [&mut [f64]; 2],
    ) {
        self.add_motion(1.0, coefficients, units, t, q, v);
        for (follower, cluster) in self.following(clusters) {
            follower.add_motion(cluster, &cluster.columns(columns), 1.0, q, v);
        }
    }

    /// All but the followers, times `sign`.
    fn add_motion(
        &self,
        sign: f64,
        coefficients: &[f64],
        units: impl Fn(usize) -> Complex<f64>,
        t: f64,
        q: &mut [f64],
        v: &mut [f64],
    ) {
        for link in &self.links {
            if t == 0.0 && link.starts_from_rest() {
                continue;
            }
            let channel = &coefficients[link.channel * self.stride..][..self.stride];
            let value = sign * link.value(channel, 0, t);
            let slope = sign * link.value(channel, 1, t);
            for ((q, v), row) in q.iter_mut().zip(v.iter_mut()).zip(&link.row) {
                *q += row * value;
                *v += row * slope;
            }
        }
        for (number, (shape, omega)) in self.shapes.iter().zip(&self.omegas).enumerate() {
            let turned = units(number) * Complex::new(0.0, omega * t).exp();
            let value = turned.scale(sign);
            let slope = value * Complex::new(0.0, *omega);
            for ((q, v), shape) in q.iter_mut().zip(v.iter_mut()).zip(shape) {
                *q = shape.add_real_product(value, *q);
                *v = shape.add_real_product(slope, *v);
            }
        }
    }
}
