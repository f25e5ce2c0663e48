//! The spectrum of one combination of law states: every motion of a phase is a constant plus
//! exponentials, and this says which.
//!
//! Modes that the acting laws couple share eigenvalues, shapes and left vectors; the others
//! move by themselves. Modes that are alike (same `omega2`, same damping) and pushed by one law
//! only are split into the combination that it pushes and the rest that it does not see.

use super::cluster::Cluster;
use super::dense;
use super::grouping::{Acting, Acts, group_alike, group_forces, static_groups};
use super::held::{Held, Reaction};
use super::impedance::Impedance;
use super::response::{Drives, Response};
use super::rows::{ComplexBlock, RealBlock, Rows, set_entry};
use super::secular::Coupling;
use super::single_mode::SingleMode;
use super::view::View;
use crate::error::Result;
use crate::law::{Law, State};
use crate::number::{Complex, Instructions, LANES, Lanes, Number};
use crate::problem::Problem;
use std::slice::ChunksExact;

/// A mode's part in a coupled combination.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Member {
    pub mode: usize,
    pub group: usize,
    pub weight: f64,
}

/// What a single motion is the motion of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Subject {
    /// A mode, less its part in a combination.
    Mode(usize),
    /// The only combination that a law pushes.
    Combination,
}

/// Something that moves by itself.
#[derive(Debug, Clone)]
pub(crate) struct Single {
    pub subject: Subject,
    pub motion: SingleMode,
    /// Where its exponents start.
    pub at: usize,
    /// Share of its damping that is modal; the rest belongs to `law`.
    pub modal_share: f64,
    pub law: Option<usize>,
}

/// All that a phase needs to know of the linear system between two switches.
#[derive(Debug, Clone, Default)]
pub(crate) struct Spectrum {
    pub states: Vec<State>,
    /// Exponents, in blocks; the first `coupled_width` belong to the coupled groups. One of each
    /// conjugate pair, or a real one; padding has exponent zero.
    pub lambda: Vec<ComplexBlock>,
    /// Their moduli.
    pub moduli: Vec<RealBlock>,
    /// Number of coupled groups.
    pub groups: usize,
    pub coupled_width: usize,
    /// Shapes and left vectors: see [`Spectrum::shape`].
    vectors: Rows,
    /// Constant part of the groups under constant forces.
    pub at_rest: Vec<f64>,
    /// Part of their velocities that is not of exponents; none where they rest. What drives
    /// clusters gives it to the motion.
    pub rate_at_rest: Vec<f64>,
    /// Exponents that are too near to each other for eigenvectors of their own.
    pub clusters: Vec<Cluster>,
    /// Damping of the groups by the structure alone.
    pub group_damping: Vec<f64>,
    pub members: Vec<Member>,
    /// Number of combinations that members belong to; a lone one is a single, not a group.
    pub combinations: usize,
    pub singles: Vec<Single>,
    /// How each local coordinate sees the motion, in the order of laws and their rows.
    pub views: Vec<View>,
    /// Whether some exponent grows.
    pub grows: bool,
    /// Largest modulus of an exponent.
    pub fastest: f64,
    /// Whether the coupled part came from the secular equation.
    pub is_secular: bool,
    /// Where the exponents of harmonic loads start, behind all others.
    pub forced_at: usize,
    /// What laws hold, where they do.
    pub held: Option<Box<Held>>,
    /// How it follows loads that change in time, where there are such.
    pub response: Option<Box<Response>>,
}

/// Whether the secular equation may be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Secular {
    /// Where it applies.
    Try,
    /// Not after its result has failed the check of a phase.
    Skip,
}

/// Room for making spectra, used again and again.
#[derive(Debug, Clone, Default)]
pub(crate) struct Workbench {
    order: Vec<usize>,
    coupling: Coupling,
    forces: Vec<f64>,
    weights: Vec<f64>,
    pushed: Vec<f64>,
    combined: Vec<f64>,
}

impl Spectrum {
    /// Solves the eigenproblem for the laws in the given states, in the memory of a spectrum that
    /// is no longer needed.
    #[inline(always)]
    pub(crate) fn new<I: Instructions, L: Law>(
        problem: &Problem<L>,
        states: &[State],
        secular: Secular,
        bench: &mut Workbench,
        room: Box<Self>,
    ) -> Result<Box<Self>> {
        let mut spectrum = room.cleared();
        spectrum.states.extend_from_slice(states);
        match Acts::of(problem, states) {
            _ if problem.system.is_coupled() => dense::couple(&mut spectrum, problem, states)?,
            Acts::Nothing => {}
            Acts::One(law) => spectrum.couple_by_one::<I, L>(problem, &law, secular, bench)?,
            Acts::Several => dense::couple(&mut spectrum, problem, states)?,
        }
        spectrum.add_singles(problem, bench);
        spectrum.lay_out_exponents(problem);
        spectrum.measure_exponents::<I>();
        if problem.forcing.varies() {
            spectrum.respond(problem, bench);
        }
        let mut views = std::mem::take(&mut spectrum.views);
        let mut count = 0;
        for (number, law) in problem.laws.iter().enumerate() {
            let first = count;
            for row in law.rows() {
                if views.len() == count {
                    views.push(View::default());
                }
                views[count].set::<I>(&spectrum, row, &mut bench.combined);
                count += 1;
            }
            if let Some(response) = &spectrum.response {
                views[first].subtract_motion(response, &problem.forcing, number);
            }
        }
        views.truncate(count);
        spectrum.views = views;
        if spectrum.held.is_some() {
            let reactions = Reaction::all::<I, L>(problem, &spectrum, &mut bench.combined);
            if let Some(held) = &mut spectrum.held {
                held.reactions = reactions;
            }
        }
        Ok(spectrum)
    }

    /// Whether it is that of the given states: they have its matrices by their numbers, and its
    /// constant forces unless they remember something else.
    #[inline(always)]
    pub(crate) fn serves<L: Law>(&self, problem: &Problem<L>, states: &[State]) -> bool {
        let both = || self.states.iter().zip(states);
        both().all(|(own, other)| own.number == other.number)
            && both().zip(&problem.laws).all(|((own, other), law)| {
                own.memory == other.memory || law.piece(*own) == law.piece(*other)
            })
    }

    /// The memory of a spectrum, for another one.
    #[inline(always)]
    fn cleared(mut self: Box<Self>) -> Box<Self> {
        self.states.clear();
        self.lambda.clear();
        self.moduli.clear();
        self.at_rest.clear();
        self.rate_at_rest.clear();
        self.clusters.clear();
        self.group_damping.clear();
        self.members.clear();
        self.singles.clear();
        (self.groups, self.coupled_width, self.combinations) = (0, 0, 0);
        self.is_secular = false;
        self.held = None;
        self.response = None;
        self
    }

    /// Finds how it follows loads that change in time.
    #[cold]
    fn respond<L: Law>(&mut self, problem: &Problem<L>, bench: &Workbench) {
        let by_one = matches!(Acts::of(problem, &self.states), Acts::One(_));
        let impedance = if self.groups == 0 {
            None
        } else if by_one && !problem.system.is_coupled() {
            Some(Impedance::OneLaw(&bench.coupling))
        } else {
            let coupled = dense::equations(problem, &self.states);
            Some(Impedance::Dense(Box::new(coupled)))
        };
        let forcing = &problem.forcing;
        let drives = Drives::of(problem, &self.states);
        let duration = problem.duration;
        let (response, mut clusters) =
            Response::new(forcing, drives, self, impedance.as_ref(), duration);
        self.response = Some(Box::new(response));
        // Their columns turn by the clusters alone.
        let columns = clusters.last().map_or(0, |last| last.at + last.size);
        let blocks = self.lambda.len().max(columns.div_ceil(LANES));
        self.lambda.resize(blocks, ComplexBlock::ZERO);
        self.moduli.resize(blocks, RealBlock::ZERO);
        self.clusters.append(&mut clusters);
    }

    /// One spring and damper: the secular equation, or the dense problem where it declines.
    #[inline(always)]
    fn couple_by_one<I: Instructions, L: Law>(
        &mut self,
        problem: &Problem<L>,
        law: &Acting,
        secular: Secular,
        bench: &mut Workbench,
    ) -> Result<()> {
        let coupling = &mut bench.coupling;
        group_alike(problem, law, &mut bench.order, coupling, &mut self.members);
        self.combinations = coupling.omega2.len();
        let modal = problem.forcing.forces();
        group_forces(modal, &self.members, self.combinations, &mut bench.forces);
        if self.combinations == 1 {
            self.add_lone_combination(problem, law, coupling, bench.forces[0]);
            return Ok(());
        }
        self.groups = self.combinations;
        self.group_damping.extend_from_slice(&coupling.damping);
        self.at_rest.reserve(self.groups);
        let rests = static_groups(coupling, &bench.forces, law.constant, &mut self.at_rest);
        let reach = problem.duration * problem.duration;
        let is_far = is_far(&self.at_rest, coupling, &bench.forces, law.constant, reach);
        if rests && !is_far && secular == Secular::Try {
            self.is_secular = self.solve_secular::<I>(coupling);
        }
        if !self.is_secular {
            let duration = problem.duration;
            dense::set_coupled(self, coupling, &bench.forces, law.constant, duration)?;
        }
        Ok(())
    }

    /// A modulus that no exponent exceeds, in 1/s.
    pub(crate) fn pace(&self) -> f64 {
        (self.clusters.iter()).fold(self.fastest, |pace, cluster| pace.max(cluster.norm()))
    }

    /// Numbers in its arrays, for the size of its memory.
    pub(crate) fn numbers(&self) -> usize {
        let response = self.response.as_ref().map_or(0, |r| r.numbers());
        let clusters: usize = self.clusters.iter().map(Cluster::numbers).sum();
        let weights = 4 * LANES * self.lambda.len() * (1 + self.views.len());
        self.vectors.numbers() + weights + response + clusters
    }

    /// Makes room for the vectors of the coupled groups, `width` blocks of exponents, all zero.
    pub(crate) fn make_room(&mut self, width: usize) {
        self.make_room_for_exponents(width);
        self.vectors.reset(3 * self.groups, width);
    }

    #[inline(always)]
    fn make_room_for_exponents(&mut self, width: usize) {
        self.coupled_width = width;
        // Singles may add exponents behind.
        self.lambda.clear();
        self.lambda.reserve_exact(width + 1);
        self.lambda.resize(width, ComplexBlock::ZERO);
    }

    /// The shapes of all groups: see [`Spectrum::shape`].
    #[inline(always)]
    pub(crate) fn shapes(&self) -> ChunksExact<'_, ComplexBlock> {
        self.vectors.rows(0, self.groups)
    }

    /// Shape of a group: `y_g = Re sum_j shape_gj z_j`.
    #[inline(always)]
    pub(crate) fn shape(&self, group: usize) -> &[ComplexBlock] {
        self.vectors.row(group)
    }

    #[inline(always)]
    pub(crate) fn shape_mut(&mut self, group: usize) -> &mut [ComplexBlock] {
        self.vectors.row_mut(group)
    }

    /// Left vectors: amplitude = sum over groups of position row y + velocity row y'.
    #[inline(always)]
    pub(crate) fn left_position_mut(&mut self, group: usize) -> &mut [ComplexBlock] {
        self.vectors.row_mut(self.groups + group)
    }

    #[inline(always)]
    pub(crate) fn left_velocity(&self, group: usize) -> &[ComplexBlock] {
        self.vectors.row(2 * self.groups + group)
    }

    #[inline(always)]
    pub(crate) fn left_velocity_mut(&mut self, group: usize) -> &mut [ComplexBlock] {
        self.vectors.row_mut(2 * self.groups + group)
    }

    /// Shapes and left vectors from the roots of the secular equation: with psi_i = phi_i/D_i,
    /// `a = 2 psi'[(lambda + C) y + y'] / (psi' (2 lambda + C) psi)`, C with the stop's damper.
    /// `false` where the secular equation does not apply.
    #[inline(always)]
    fn solve_secular<I: Instructions>(&mut self, coupling: &Coupling) -> bool {
        if !coupling.is_lightly_damped() {
            return false;
        }
        self.make_room_for_exponents(self.groups.div_ceil(LANES));
        // All of them are set below.
        self.vectors.fit(3 * self.groups, self.coupled_width);
        for block in 0..self.coupled_width {
            let lambda = coupling.solve_block::<I>(block, &mut self.vectors);
            let Some(lambda) = lambda else {
                return false;
            };
            self.lambda[block].put(lambda);
            self.set_vectors::<I>(coupling, block, lambda);
        }
        true
    }

    #[inline(always)]
    fn set_vectors<I: Instructions>(
        &mut self,
        coupling: &Coupling,
        block: usize,
        lambda: Complex<Lanes<I>>,
    ) {
        let (k, c) = (
            Lanes::<I>::of(coupling.stiffness),
            Lanes::<I>::of(coupling.stop_damping),
        );
        let two = Lanes::<I>::of(2.0);
        // phi' psi = -1/kappa at a root.
        let kappa = Complex::new(k + c * lambda.re, c * lambda.im);
        let contact = safe_recip(kappa);
        let mut norm = (contact * contact).scale(c);
        let groups = self.groups;
        let modes = coupling.damping.iter().zip(&coupling.phi);
        for ((damping, phi), row) in modes.zip(self.vectors.rows_mut(0, groups)) {
            let inverse = row[block].lanes();
            let psi = inverse.scale(Lanes::<I>::of(*phi));
            row[block].put(psi);
            let rate = lambda.scale(two).plus(Lanes::<I>::of(*damping));
            norm = (psi * psi).mul_add(rate, norm);
        }
        let factor = safe_recip(norm).scale(two);
        let push = (contact * factor).scale(c);
        let (shapes, left) = self.vectors.split_rows(groups);
        let (positions, velocities) = left.split_at_mut(left.len() / 2);
        let width = self.coupled_width;
        let modes = coupling.damping.iter().zip(&coupling.phi);
        let rows = shapes
            .chunks_exact(width)
            .zip((positions.chunks_exact_mut(width)).zip(velocities.chunks_exact_mut(width)));
        for ((damping, phi), (shape, (position, velocity))) in modes.zip(rows) {
            let psi = shape[block].lanes() * factor;
            let damper = push.scale(Lanes::<I>::of(*phi));
            let with_rate = psi * lambda.plus(Lanes::<I>::of(*damping));
            velocity[block].put(psi);
            position[block].put(with_rate - damper);
        }
    }

    /// A law that pushes a single mode, or a single combination of like ones, only changes its
    /// stiffness and damping.
    fn add_lone_combination<L: Law>(
        &mut self,
        problem: &Problem<L>,
        law: &Acting,
        coupling: &Coupling,
        modal_force: f64,
    ) {
        let phi = coupling.phi[0];
        let (modal, added) = (coupling.damping[0], law.damping * phi * phi);
        let force = modal_force + phi * law.constant;
        let stiffness = coupling.omega2[0] + law.stiffness * phi * phi;
        let damping = modal + added;
        self.singles.push(Single {
            subject: Subject::Combination,
            motion: SingleMode::new(stiffness, damping, force, problem.duration),
            at: 0,
            modal_share: if damping > 0.0 { modal / damping } else { 0.0 },
            law: Some(law.law),
        });
    }

    /// A combination that moves by itself though laws hold others: with damping of the structure
    /// alone.
    pub(super) fn add_combination<L: Law>(
        &mut self,
        problem: &Problem<L>,
        stiffness: f64,
        damping: f64,
        force: f64,
    ) {
        self.singles.push(Single {
            subject: Subject::Combination,
            motion: SingleMode::new(stiffness, damping, force, problem.duration),
            at: 0,
            modal_share: 1.0,
            law: None,
        });
    }

    /// Adds the modes, or parts of modes, that no acting law sees.
    #[inline(always)]
    fn add_singles<L: Law>(&mut self, problem: &Problem<L>, bench: &mut Workbench) {
        let (omega2, damping) = (problem.system.omega2(), problem.system.damping());
        let forces = problem.forcing.forces();
        let Workbench {
            forces: totals,
            weights,
            pushed,
            ..
        } = bench;
        group_forces(forces, &self.members, self.combinations, totals);
        weights.clear();
        weights.resize(omega2.len(), 0.0);
        pushed.clear();
        pushed.resize(omega2.len(), 0.0);
        let mut whole = 0;
        for member in &self.members {
            weights[member.mode] = member.weight;
            // The part of the mode's force that its group takes.
            pushed[member.mode] = member.weight * totals[member.group];
            whole += usize::from(member.weight.abs() == 1.0);
        }
        if let Some(held) = &self.held {
            held.modes.iter().for_each(|&mode| weights[mode] = 1.0);
        }
        self.singles.reserve_exact(omega2.len() - whole);
        for mode in 0..omega2.len() {
            if weights[mode].abs() == 1.0 {
                continue;
            }
            let force = forces[mode] - pushed[mode];
            self.singles.push(Single {
                subject: Subject::Mode(mode),
                motion: SingleMode::new(omega2[mode], damping[mode], force, problem.duration),
                at: 0,
                modal_share: 1.0,
                law: None,
            });
        }
    }

    fn lay_out_exponents<L: Law>(&mut self, problem: &Problem<L>) {
        let mut at = self.coupled_width * LANES;
        for single in &mut self.singles {
            single.at = at;
            at += single.motion.exponents().1;
        }
        self.forced_at = at;
        let harmonics = problem.forcing.harmonics();
        at += harmonics.len();
        self.lambda.resize(at.div_ceil(LANES), ComplexBlock::ZERO);
        for (i, harmonic) in harmonics.iter().enumerate() {
            let turn = Complex::new(0.0, harmonic.omega);
            set_entry(&mut self.lambda, self.forced_at + i, turn);
        }
        for single in &self.singles {
            let (exponents, count) = single.motion.exponents();
            for (i, lambda) in exponents.iter().enumerate().take(count) {
                set_entry(&mut self.lambda, single.at + i, *lambda);
            }
        }
    }

    #[inline(always)]
    fn measure_exponents<I: Instructions>(&mut self) {
        self.moduli.reserve_exact(self.lambda.len());
        let zero = Lanes::<I>::of(0.0);
        let (mut fastest, mut growth) = (zero, zero);
        for block in &self.lambda {
            let lambda = block.lanes::<I>();
            let modulus = lambda.norm();
            let mut moduli = RealBlock::ZERO;
            moduli.put(modulus);
            self.moduli.push(moduli);
            fastest = fastest.max(modulus);
            growth = growth.max(lambda.re);
        }
        self.fastest = largest(fastest);
        self.grows = largest(growth) > 0.0;
    }

    /// `exp(lambda t)` for all exponents.
    #[inline(always)]
    pub(crate) fn exponentials<I: Instructions>(&self, t: f64, to: &mut [ComplexBlock]) {
        let t = Lanes::<I>::of(t);
        for (lambda, to) in self.lambda.iter().zip(to) {
            to.put(lambda.lanes().scale(t).exp());
        }
    }

    /// Coordinates of groups: `sum weight q`.
    #[inline(always)]
    pub(crate) fn gather(&self, modal: &[f64], groups: &mut [f64]) {
        groups.fill(0.0);
        for m in &self.members {
            groups[m.group] += m.weight * modal[m.mode];
        }
    }

    /// Amplitudes of the coupled exponents from the groups' state, measured from rest, added to
    /// what is there.
    #[inline(always)]
    pub(crate) fn add_amplitudes<I: Instructions>(
        &self,
        position: &[f64],
        velocity: &[f64],
        to: &mut [ComplexBlock],
    ) {
        let groups = self.groups;
        for (block, to) in to.iter_mut().enumerate().take(self.coupled_width) {
            let mut total = to.lanes::<I>();
            let of_position = self.vectors.rows(groups, groups).zip(position);
            let of_velocity = self.vectors.rows(2 * groups, groups).zip(velocity);
            for ((left, y), (left_rate, rate)) in of_position.zip(of_velocity) {
                total = left[block].lanes().scale_add(Lanes::of(*y), total);
                total = left_rate[block].lanes().scale_add(Lanes::of(*rate), total);
            }
            to.put(total);
        }
    }

    /// `Re sum_j shape_gj z_j` over the coupled exponents, for all groups, and the same of rates.
    #[inline(always)]
    pub(crate) fn group_sums<I: Instructions>(
        &self,
        [z, rate]: [&[ComplexBlock]; 2],
        [to, to_rate]: [&mut [f64]; 2],
    ) {
        let (z, rate) = (&z[..self.coupled_width], &rate[..self.coupled_width]);
        let mut shapes = self.shapes();
        let to = to[..self.groups].chunks_mut(HALF);
        for (to, to_rate) in to.zip(to_rate[..self.groups].chunks_mut(HALF)) {
            let mut sums = [Lanes::<I>::of(0.0); LANES];
            let (positions, velocities) = sums.split_at_mut(HALF);
            let pairs = positions.iter_mut().zip(velocities);
            for ((position, velocity), shape) in pairs.zip(shapes.by_ref().take(to.len())) {
                for (shape, (z, rate)) in shape.iter().zip(z.iter().zip(rate)) {
                    let shape = shape.lanes();
                    *position = shape.add_real_product(z.lanes(), *position);
                    *velocity = shape.add_real_product(rate.lanes(), *velocity);
                }
            }
            let totals = Lanes::totals(sums);
            for (i, (to, to_rate)) in to.iter_mut().zip(to_rate).enumerate() {
                (*to, *to_rate) = (totals[i], totals[HALF + i]);
            }
        }
    }
}

/// Half of the lanes.
const HALF: usize = LANES / 2;

/// Whether a position at rest lies beyond what the forces can do in a run: the motion, measured
/// from there, would lose its digits.
#[inline(always)]
fn is_far(rest: &[f64], coupling: &Coupling, forces: &[f64], constant: f64, reach: f64) -> bool {
    let (mut farthest, mut largest) = (0.0f64, 0.0f64);
    for (y, (force, phi)) in rest.iter().zip(forces.iter().zip(&coupling.phi)) {
        farthest = farthest.max(y.abs());
        largest = largest.max(force.abs() + (phi * constant).abs());
    }
    farthest > FAR * largest * reach
}

/// A mode of angular frequency w rests at `force/w^2`, here with w times the run's length at a
/// half.
const FAR: f64 = 4.0;

/// The largest of eight.
#[inline(always)]
fn largest<I: Instructions>(lanes: Lanes<I>) -> f64 {
    let mut largest = f64::NEG_INFINITY;
    for x in lanes.numbers() {
        if x > largest {
            largest = x;
        }
    }
    largest
}

/// Reciprocal, zero for zero (the padding of the lanes).
#[inline(always)]
fn safe_recip<I: Instructions>(z: Complex<Lanes<I>>) -> Complex<Lanes<I>> {
    let norm = z.norm2();
    let zero = Lanes::<I>::of(0.0);
    let inverse = zero.select_less(norm, Lanes::<I>::of(1.0) / norm, zero);
    z.conj().scale(inverse)
}
