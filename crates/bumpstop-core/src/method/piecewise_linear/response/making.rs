//! How a spectrum's motion follows each load: by series, by shapes, or from rest.

use super::block::Block;
use super::drives::Push;
use super::follower::{Follower, Load};
use super::parts::{ComplexParts, Parts};
use super::{Link, Response, single};
use crate::forcing::Forcing;
use crate::method::piecewise_linear::cluster::Cluster;
use crate::method::piecewise_linear::impedance::Impedance;
use crate::method::piecewise_linear::spectrum::Spectrum;
use crate::number::Complex;
use faer::{Mat, c64};

/// A response that is being made.
pub(super) struct Making<'a> {
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
    response: &'a mut Response,
    clusters: Vec<Cluster>,
}

impl<'a> Making<'a> {
    pub(super) fn new(
        response: &'a mut Response,
        spectrum: &'a Spectrum,
        impedance: Option<&'a Impedance<'a>>,
        forcing: &Forcing,
        duration: f64,
    ) -> Self {
        let blocks = Block::coupled(spectrum);
        let singles = spectrum.singles.iter().enumerate();
        Self {
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
        }
    }

    /// Follows all that drives the spectrum; returns the clusters of what does so from rest.
    pub(super) fn follow(mut self) -> Vec<Cluster> {
        let drives = std::mem::take(&mut self.response.drives);
        for push in &drives.pushes {
            self.follow_channel(push);
        }
        for (number, amplitude) in drives.harmonics.iter().enumerate() {
            self.follow_harmonic(number, amplitude);
        }
        self.response.drives = drives;
        self.clusters
    }

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
            let of_groups = usize::try_from(order).ok().and_then(|m| groups.get(m));
            let mut combined = of_groups.cloned().unwrap_or_default();
            // Combinations that are alone have numbers behind the groups.
            combined.resize(spectrum.combinations, 0.0);
            let parts = Parts {
                combined,
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
        let (stride, groups) = (self.response.stride, self.spectrum.groups);
        let forces = &parts.combined[..groups];
        let whole = self.impedance.filter(|_| !self.has_slow);
        let whole = whole.and_then(|impedance| series(forces, impedance, stride));
        whole.unwrap_or_else(|| {
            let mut series = vec![vec![0.0; groups]; stride];
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
        let forces = &force.combined[..self.spectrum.groups];
        match whole.and_then(|impedance| impedance.harmonic(omega, forces)) {
            Some(groups) => parts.combined[..groups.len()].copy_from_slice(&groups),
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
