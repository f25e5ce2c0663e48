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
use block::Block;
use drives::Push;
use faer::{Mat, c64};
use follower::Load;
use parts::{ComplexParts, Parts};

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
        let blocks = Block::coupled(spectrum);
        let singles = spectrum.singles.iter().enumerate();
        let response = Self {
            stride: forcing.stride(),
            links: Vec::new(),
            at: spectrum.forced_at,
            omegas: forcing.harmonics().iter().map(|h| h.omega).collect(),
            shapes: Vec::new(),
            followers: Vec::new(),
            drives: Drives::default(),
            motions: Vec::new(),
        };
        let mut making = Making {
            spectrum,
            impedance,
            modes: forcing.forces().len(),
            duration,
            has_slow: blocks.iter().any(|block| block.is_slow(duration)),
            blocks,
            singles: singles
                .map(|(index, single)| Block::single(index, &single.motion, duration))
                .collect(),
            next: spectrum.forced_at + forcing.harmonics().len(),
            response,
            clusters: Vec::new(),
        };
        for push in &drives.pushes {
            making.follow_channel(push);
        }
        for (number, amplitude) in drives.harmonics.iter().enumerate() {
            making.follow_harmonic(number, amplitude);
        }
        making.response.drives = drives;
        making.response.add_motions(forcing);
        (making.response, making.clusters)
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

/// A response that is being made.
struct Making<'a> {
    spectrum: &'a Spectrum,
    impedance: Option<&'a Impedance<'a>>,
    modes: usize,
    duration: f64,
    blocks: Vec<Block>,
    /// Whether one of them is slow.
    has_slow: bool,
    singles: Vec<Block>,
    /// Column of the next follower.
    next: usize,
    response: Response,
    clusters: Vec<Cluster>,
}

impl Making<'_> {
    fn follow_channel(&mut self, push: &Push) {
        let (spectrum, duration, stride) = (self.spectrum, self.duration, self.response.stride);
        let parts = Parts::of(spectrum, &push.direction);
        let force = ComplexParts::of_real(&parts);
        let load = Load::channel(push, stride, duration);
        let blocks = std::mem::take(&mut self.blocks);
        for block in blocks.iter().filter(|block| block.is_slow(duration)) {
            self.add_follower(&load, block, &force);
        }
        let groups = self.group_series(&blocks, &parts, &force);
        self.blocks = blocks;
        let mut singles = Vec::with_capacity(self.singles.len());
        let own = std::mem::take(&mut self.singles);
        for ((block, single), force_on_it) in own.iter().zip(&spectrum.singles).zip(&parts.singles)
        {
            let follows = single::has_series(&single.motion, duration) || !block.is_slow(duration);
            singles.push(if follows {
                single::series(&single.motion, *force_on_it, stride)
            } else {
                self.add_follower(&load, block, &force);
                vec![0.0; stride + 2]
            });
        }
        self.singles = own;
        self.add_links(push, &groups, &singles);
    }

    fn add_links(&mut self, push: &Push, groups: &[Vec<f64>], singles: &[Vec<f64>]) {
        let spectrum = self.spectrum;
        for (number, order) in (-2..self.response.stride as i32).enumerate() {
            let zero = vec![0.0; spectrum.combinations];
            let of_groups = usize::try_from(order).ok().and_then(|m| groups.get(m));
            let parts = Parts {
                combined: of_groups.cloned().unwrap_or(zero),
                singles: singles.iter().map(|series| series[number]).collect(),
            };
            let row = parts.modes(spectrum, self.modes);
            // A reaction resists a load even where nothing moves.
            let is_resisted = order == 0 && spectrum.held.is_some();
            if is_resisted || row.iter().any(|x| *x != 0.0) {
                self.response.links.push(Link {
                    channel: push.channel,
                    order: order + push.order as i32,
                    row,
                });
            }
        }
    }

    /// The series of the coupled groups under a force, from order 0 on, without what is slow. By
    /// the structure's own matrices where nothing is, else block by block.
    fn group_series(&self, blocks: &[Block], parts: &Parts, force: &ComplexParts) -> Vec<Vec<f64>> {
        let stride = self.response.stride;
        let whole = self.impedance.filter(|_| !self.has_slow);
        let whole = whole.and_then(|impedance| series(&parts.combined, impedance, stride));
        whole.unwrap_or_else(|| {
            let mut series = vec![vec![0.0; self.spectrum.combinations]; stride];
            for block in blocks.iter().filter(|block| !block.is_slow(self.duration)) {
                block.add_series(self.spectrum, force, &mut series);
            }
            series
        })
    }

    fn follow_harmonic(&mut self, number: usize, amplitude: &[Complex<f64>]) {
        let omega = self.response.omegas[number];
        let force = ComplexParts::of(self.spectrum, amplitude);
        let load = Load::harmonic(number, omega);
        let mut parts = ComplexParts::zero(self.spectrum);
        let mut shape = vec![Complex::zero(); self.modes];
        let blocks = std::mem::take(&mut self.blocks);
        let whole = self.impedance.filter(|_| !self.resonates(&blocks, omega));
        match whole.and_then(|impedance| impedance.harmonic(omega, &force.combined)) {
            Some(combined) => parts.combined = combined,
            None => {
                for block in &blocks {
                    self.add_sides(&load, block, omega, &force, &mut shape);
                }
            }
        }
        self.blocks = blocks;
        let singles = std::mem::take(&mut self.singles);
        for (index, (block, single)) in singles.iter().zip(&self.spectrum.singles).enumerate() {
            if self.resonates(std::slice::from_ref(block), omega) {
                self.add_sides(&load, block, omega, &force, &mut shape);
            } else {
                parts.singles[index] = single::shape(&single.motion, omega, force.singles[index]);
            }
        }
        self.singles = singles;
        for (to, own) in shape.iter_mut().zip(parts.modes(self.spectrum, self.modes)) {
            *to += own;
        }
        self.response.shapes.push(shape);
    }

    fn resonates(&self, blocks: &[Block], omega: f64) -> bool {
        let mut sides = blocks.iter().flat_map(Block::sides);
        sides.any(|side| side.resonates(omega, self.duration))
    }

    /// Adds both sides of a block under a harmonic, as followers where they resonate.
    fn add_sides(
        &mut self,
        load: &Load,
        block: &Block,
        omega: f64,
        force: &ComplexParts,
        shape: &mut [Complex<f64>],
    ) {
        for side in block.sides() {
            if side.resonates(omega, self.duration) {
                let gains = side.gains(self.spectrum, force);
                let shapes = side.shapes(self.spectrum, self.modes);
                self.add(load, &side.generator(), &gains, shapes);
            } else {
                side.add_harmonic(self.spectrum, omega, force, shape);
            }
        }
    }

    fn add_follower(&mut self, load: &Load, block: &Block, force: &ComplexParts) {
        let gains = block.gains(self.spectrum, force);
        let shapes = block.shapes(self.spectrum, self.modes);
        self.add(load, &block.generator, &gains, shapes);
    }

    fn add(
        &mut self,
        load: &Load,
        generator: &Mat<c64>,
        gains: &[Complex<f64>],
        shapes: Vec<Vec<Complex<f64>>>,
    ) {
        let follower = Follower::new(load, generator, gains, shapes, self.next, self.duration);
        if let Some((follower, cluster)) = follower {
            self.next += cluster.size;
            self.clusters.push(cluster);
            self.response.followers.push(follower);
        }
    }
}

/// The series of coupled groups under a force, from order 0 on; `None` where some motion has no
/// stiffness.
fn series(force: &[f64], impedance: &Impedance<'_>, orders: usize) -> Option<Vec<Vec<f64>>> {
    let mut series: Vec<Vec<f64>> = Vec::with_capacity(orders);
    for order in 0..orders {
        let next = match order {
            0 => impedance.rest(force)?,
            _ => {
                let mut right = impedance.damped(&series[order - 1]);
                for (i, right) in right.iter_mut().enumerate() {
                    let before = if order > 1 { series[order - 2][i] } else { 0.0 };
                    *right = -(*right + before);
                }
                impedance.rest(&right)?
            }
        };
        series.push(next);
    }
    Some(series)
}
