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
//! begins with integrals of f (orders -1 and -2), taken from the start of the phase. A harmonic
//! load is followed by `(K + i omega C - omega^2)^-1 g exp(i omega t)`: one more exponent of the
//! phase, the same in all modes. What is left, the state less both at the start of the phase, moves
//! freely. Exponents that are slow beside a polynomial or resonate with a harmonic follow it from
//! rest instead, see [`follower`].

mod block;
mod drives;
mod follower;
mod making;
mod parts;
mod single;

pub(crate) use drives::Drives;
pub(crate) use follower::{Follower, Leader};

use super::cluster::Cluster;
use super::impedance::Impedance;
use super::phase::{Phase, Phases};
use super::polynomial::{derivative_at, of_derivative};
use super::product::Factor;
use super::rows::{ComplexBlock, set_entry};
use super::spectrum::Spectrum;
use crate::forcing::{Forcing, Onset};
use crate::number::Complex;
use making::Making;

/// A vector that a derivative of a channel's function moves the modes along.
#[derive(Debug, Clone)]
pub(crate) struct Link {
    pub channel: usize,
    /// Order of the derivative; integrals are negative.
    pub order: i32,
    pub row: Vec<f64>,
}

/// The response of all modes.
#[derive(Debug, Clone)]
pub(crate) struct Response {
    /// Coefficients of each channel.
    pub stride: usize,
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
    /// Links that move no mode: the motions of obstacles, with the numbers of their laws.
    pub motions: Vec<(usize, usize)>,
}

impl Response {
    /// The response of a spectrum whose exponents are known, and the clusters of what follows loads
    /// from rest; `impedance` is that of its groups.
    pub(crate) fn new(
        forcing: &Forcing,
        drives: Drives,
        spectrum: &Spectrum,
        impedance: Option<&Impedance<'_>>,
        duration: f64,
    ) -> (Self, Vec<Cluster>) {
        let mut response = Self {
            stride: forcing.stride(),
            links: Vec::new(),
            at: spectrum.forced_at,
            omegas: forcing.harmonics().iter().map(|h| h.omega).collect(),
            shapes: Vec::new(),
            followers: Vec::new(),
            drives,
            motions: Vec::new(),
        };
        let clusters = Making::new(&mut response, spectrum, impedance, forcing, duration).follow();
        response.add_motions(forcing);
        (response, clusters)
    }

    fn add_motions(&mut self, forcing: &Forcing) {
        for (channel, load) in forcing.channels().iter().enumerate() {
            if let Some(law) = load.moves {
                self.motions.push((self.links.len(), law));
                self.links.push(Link {
                    channel,
                    order: 0,
                    row: vec![0.0; load.direction.len()],
                });
            }
        }
    }

    /// The speed of a law's obstacle during a phase.
    pub(crate) fn obstacle_rate(
        &self,
        forcing: &Forcing,
        law: usize,
        phases: &Phases,
        phase: Phase,
    ) -> Factor<'static> {
        let coefficients = phases.coefficients(phase);
        let mut rate = Factor {
            amplitudes: vec![ComplexBlock::ZERO; phases.amplitudes(phase).len()],
            polynomial: vec![0.0; self.stride],
            other: None,
        };
        for (link, _) in self.motions.iter().filter(|(_, moved)| *moved == law) {
            let channel = self.links[*link].channel;
            let channel = &coefficients[channel * self.stride..][..self.stride];
            for (power, to) in rate.polynomial.iter_mut().enumerate() {
                *to += of_derivative(channel, 1, power);
            }
        }
        for (number, harmonic) in forcing.harmonics().iter().enumerate() {
            let own = harmonic.motions.iter().filter(|(moved, _)| *moved == law);
            let amplitude = own.fold(Complex::zero(), |total, (_, motion)| total + *motion);
            let turning = amplitude * Complex::new(0.0, harmonic.omega);
            let unit = phases.unit(phase, self, number);
            set_entry(&mut rate.amplitudes, self.at + number, turning * unit);
        }
        rate
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
            let channel = &coefficients[link.channel * self.stride..][..self.stride];
            let value = sign * derivative_at(channel, link.order, t);
            let slope = sign * derivative_at(channel, link.order + 1, t);
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
