//! How a spectrum's motion follows each load: by series, by shapes, or from rest.

use super::block::{Block, Course, Way};
use super::drives::Push;
use super::follower::{Follower, Load};
use super::orders::Orders;
use super::parts::{ComplexParts, Parts};
use super::{Link, Response, Times, integrals, single};
use crate::forcing::{Forcing, History};
use crate::method::piecewise_linear::cluster::Cluster;
use crate::method::piecewise_linear::impedance::Impedance;
use crate::method::piecewise_linear::spectrum::Spectrum;
use crate::number::Complex;
use faer::{Mat, c64};

/// A response that is being made.
pub(super) struct Making<'a> {
    spectrum: &'a Spectrum,
    impedance: Option<&'a Impedance<'a>>,
    forcing: &'a Forcing,
    modes: usize,
    times: Times,
    blocks: Vec<Block>,
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
        forcing: &'a Forcing,
        times: Times,
    ) -> Self {
        let singles = spectrum.singles.iter().enumerate();
        Self {
            spectrum,
            impedance,
            forcing,
            modes: forcing.forces().len(),
            times,
            blocks: Block::coupled(spectrum),
            singles: singles
                .map(|(index, single)| Block::single(index, &single.motion, times.duration))
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
        let (spectrum, stride) = (self.spectrum, self.response.stride);
        let course = self.course(push);
        let parts = Parts::of(spectrum, &push.direction);
        let force = ComplexParts::of_real(&parts);
        let load = Load::channel(push, stride, course.length);
        let mut orders = Orders::new(spectrum);
        let blocks = std::mem::take(&mut self.blocks);
        self.follow_groups(&blocks, course, &load, (&parts, &force), &mut orders);
        self.blocks = blocks;
        let own = std::mem::take(&mut self.singles);
        for (index, (block, single)) in own.iter().zip(&spectrum.singles).enumerate() {
            let (motion, pushed) = (&single.motion, parts.singles[index]);
            let way = if single::has_series(motion, course.length) {
                Way::Derivatives
            } else {
                block.way(course)
            };
            match way {
                Way::Derivatives => {
                    let series = single::series(motion, pushed, stride);
                    orders.set_single(index, -2.., &series);
                }
                Way::Integrals(count) => {
                    let series = integrals::of_single(motion, pushed, count);
                    orders.set_single(index, below(-2), &series);
                    self.reach(course);
                }
                Way::FromRest => self.add_follower(&load, block, &force, course.length),
            }
        }
        self.singles = own;
        self.add_links(push, orders);
    }

    /// How long the function of a push is a polynomial.
    fn course(&self, push: &Push) -> Course {
        let history = &self.forcing.channels()[push.channel].history;
        let is_table = matches!(history, History::Table(_));
        Course {
            length: if is_table {
                self.times.stretch
            } else {
                self.times.duration
            },
            is_table,
        }
    }

    /// Notes that integrals serve as long as a course goes on.
    fn reach(&mut self, course: Course) {
        self.response.reach = self.response.reach.min(course.length);
    }

    /// Lets the coupled groups follow a force: by the structure's own matrices where all blocks
    /// follow it in one way, else block by block.
    fn follow_groups(
        &mut self,
        blocks: &[Block],
        course: Course,
        load: &Load,
        (parts, force): (&Parts, &ComplexParts),
        orders: &mut Orders,
    ) {
        let (spectrum, stride) = (self.spectrum, self.response.stride);
        let forces = &parts.combined[..spectrum.groups];
        let ways: Vec<Way> = blocks.iter().map(|block| block.way(course)).collect();
        let most = ways.iter().map(|way| match way {
            Way::Integrals(count) => *count,
            _ => 0,
        });
        let most = most.max().unwrap_or(0);
        if most > 0 {
            self.reach(course);
        }
        if let Some(impedance) = self.impedance {
            if ways.iter().all(|way| *way == Way::Derivatives) {
                if let Some(series) = series(forces, impedance, stride) {
                    return orders.set_groups(0.., &series);
                }
            } else if ways.iter().all(|way| matches!(way, Way::Integrals(_))) {
                let series = integrals::of_groups(forces, impedance, most);
                return orders.set_groups(below(-2), &series);
            }
        }
        for (block, way) in blocks.iter().zip(ways) {
            match way {
                Way::Derivatives => block.add_derivatives(spectrum, force, stride, orders),
                Way::Integrals(_) => block.add_integrals(spectrum, force, most, orders),
                Way::FromRest => self.add_follower(load, block, force, course.length),
            }
        }
    }

    fn add_links(&mut self, push: &Push, orders: Orders) {
        let spectrum = self.spectrum;
        for (order, parts) in orders.all() {
            let row = parts.modes(spectrum, self.modes);
            // A reaction resists a load even where nothing moves.
            let is_resisted = order == 0 && spectrum.held.is_some();
            if is_resisted || row.iter().any(|x| *x != 0.0) {
                self.response.links.push(Link {
                    channel: push.channel,
                    pushed: push.order,
                    order: order + push.order as i32,
                    row,
                });
            }
        }
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
        sides.any(|side| side.resonates(omega, self.times.duration))
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
            if side.resonates(omega, self.times.duration) {
                let gains = side.gains(self.spectrum, force);
                let shapes = side.shapes(self.spectrum, self.modes);
                let duration = self.times.duration;
                self.add(load, &side.generator(), &gains, shapes, duration);
            } else {
                side.add_harmonic(self.spectrum, omega, force, shape);
            }
        }
    }

    fn add_follower(&mut self, load: &Load, block: &Block, force: &ComplexParts, length: f64) {
        let gains = block.gains(self.spectrum, force);
        let shapes = block.shapes(self.spectrum, self.modes);
        self.add(load, &block.generator, &gains, shapes, length);
    }

    fn add(
        &mut self,
        load: &Load,
        generator: &Mat<c64>,
        gains: &[Complex<f64>],
        shapes: Vec<Vec<Complex<f64>>>,
        length: f64,
    ) {
        let follower = Follower::new(load, generator, gains, shapes, self.next, length);
        if let Some((follower, cluster)) = follower {
            self.next += cluster.size;
            self.clusters.push(cluster);
            self.response.followers.push(follower);
        }
    }
}

/// This order and all below it.
fn below(order: i32) -> impl Iterator<Item = i32> {
    (i32::MIN..=order).rev()
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
