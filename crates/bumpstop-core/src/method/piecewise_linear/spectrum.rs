//! The spectrum of one combination of law states: every motion of a phase is a constant plus
//! exponentials, and this says which.
//!
//! Modes that the acting laws couple share eigenvalues, shapes and left vectors; the others
//! move by themselves. Modes that are alike (same `omega2`, same damping) and pushed by one law
//! only are split into the combination that it pushes and the rest that it does not see.

use super::cluster::Cluster;
use super::dense;
use super::family::{Family, HALF};
use super::grouping::Acts;
use super::held::{Held, Reaction};
use super::impedance::Impedance;
use super::parts::Parts;
use super::phase::Workspace;
use super::response::{Drives, Response, Times};
use super::rows::{ComplexBlock, RealBlock, Rows, set_entry};
use super::secular::Coupling;
use super::singles::{Single, Subject};
use super::span::{NearlySlow, Span};
use super::view::View;
use crate::error::Result;
use crate::forcing::Moved;
use crate::law::{Law, State};
use crate::number::{Block, Complex, Instructions, LANES, Lanes, Number};
use crate::problem::Problem;
use std::sync::Arc;

/// A mode's part in a coupled combination.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Member {
    pub mode: usize,
    pub group: usize,
    pub weight: f64,
}

/// All that a phase needs to know of the linear system between two switches.
#[derive(Debug, Clone, Default)]
pub(crate) struct Spectrum {
    pub states: Vec<State>,
    /// The phases that it is made for.
    pub span: Span,
    /// What of it would be slow beside parted phases.
    pub(super) nearly_slow: NearlySlow,
    /// Exponents, in blocks; the first `coupled_width` belong to the coupled groups. One of each
    /// conjugate pair, or a real one; padding has exponent zero.
    pub lambda: Vec<ComplexBlock>,
    /// Their moduli.
    pub moduli: Vec<RealBlock>,
    /// Number of coupled groups.
    pub groups: usize,
    pub coupled_width: usize,
    /// Shapes and left vectors: see [`Spectrum::families`].
    pub(super) families: Vec<Family>,
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
    /// Whether it is free flight: see [`super::flight`].
    pub is_flight: bool,
    /// Where each mode rests in free flight.
    pub(super) rests: Vec<Block>,
    /// The modes that have no exponent there.
    pub(super) aside: Vec<usize>,
    /// Whether each mode is a coupled group of its own, all in order.
    pub(super) groups_are_modes: bool,
    /// How each local coordinate sees the motion, in the order of laws and their rows.
    pub views: Vec<View>,
    /// How fast the exponent grows that grows fastest, in 1/s; zero where none does.
    pub growth: f64,
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
    pub(super) order: Vec<usize>,
    pub(super) coupling: Coupling,
    pub(super) forces: Vec<f64>,
    pub(super) weights: Vec<f64>,
    pub(super) pushed: Vec<f64>,
    combined: Vec<f64>,
    pub(super) parts: Parts,
}

impl Workbench {
    /// Forgets the parts of a run that is over.
    pub(crate) fn clear(&mut self) {
        self.parts = Parts::default();
    }

    /// Keeps so many parts.
    #[cfg(test)]
    pub(super) fn keep_parts(&mut self, most: usize) {
        self.parts = Parts::of(most);
    }
}

impl Spectrum {
    /// Solves the eigenproblem for the laws in the given states, in the memory of a spectrum that
    /// is no longer needed.
    #[inline(always)]
    pub(crate) fn new<I: Instructions, L: Law>(
        problem: &Problem<L>,
        states: &[State],
        span: Span,
        secular: Secular,
        bench: &mut Workbench,
        room: Box<Self>,
    ) -> Result<Box<Self>> {
        let mut spectrum = room.cleared();
        spectrum.states.extend_from_slice(states);
        spectrum.span = span;
        match Acts::of(problem, states) {
            _ if problem.system.is_coupled() => {
                spectrum.couple_components(problem, states, secular, bench)?;
            }
            Acts::Nothing => {}
            Acts::One(law) => spectrum.couple_by_one::<I, L>(problem, &law, secular, bench)?,
            Acts::Several => spectrum.couple_components(problem, states, secular, bench)?,
        }
        spectrum.add_singles(problem, bench);
        spectrum.lay_out_exponents(problem);
        spectrum.measure_exponents::<I>();
        spectrum.nearly_slow = NearlySlow::of(&spectrum, problem.duration);
        if problem.forcing.varies() {
            spectrum.respond(problem, bench);
        }
        let mut views = std::mem::take(&mut spectrum.views);
        let mut count = 0;
        for (number, law) in problem.laws.iter().enumerate() {
            for (coordinate, row) in law.rows().iter().enumerate() {
                if views.len() == count {
                    views.push(View::default());
                }
                views[count].set::<I>(&spectrum, row, &mut bench.combined);
                if let Some(response) = &spectrum.response {
                    let moved = Moved {
                        law: number,
                        coordinate,
                    };
                    views[count].subtract_motion(response, &problem.forcing, moved);
                }
                count += 1;
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
    pub(crate) fn serves<L: Law>(
        &self,
        problem: &Problem<L>,
        states: &[State],
        span: Span,
    ) -> bool {
        let both = || self.states.iter().zip(states);
        self.span == span
            && both().all(|(own, other)| own.number == other.number)
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
        (self.is_secular, self.is_flight, self.groups_are_modes) = (false, false, false);
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
            let coupled = dense::equations(problem, self);
            Some(Impedance::Dense(Box::new(coupled)))
        };
        let forcing = &problem.forcing;
        let drives = Drives::of(problem, &self.states);
        let times = Times {
            duration: self.span.longest(problem.duration),
            stretch: self.span.stretch.longest(problem.duration),
        };
        let (response, mut clusters) =
            Response::new(forcing, drives, self, impedance.as_ref(), times);
        self.response = Some(Box::new(response));
        // Their columns turn by the clusters alone.
        let columns = clusters.last().map_or(0, |last| last.at + last.size);
        let blocks = self.lambda.len().max(columns.div_ceil(LANES));
        self.lambda.resize(blocks, ComplexBlock::ZERO);
        self.moduli.resize(blocks, RealBlock::ZERO);
        self.clusters.append(&mut clusters);
    }

    /// A modulus that no exponent exceeds, in 1/s.
    pub(crate) fn pace(&self) -> f64 {
        (self.clusters.iter()).fold(self.fastest, |pace, cluster| pace.max(cluster.norm()))
    }

    /// Numbers in its arrays, for the size of its memory.
    pub(crate) fn numbers(&self) -> usize {
        let response = self.response.as_ref().map_or(0, |r| r.numbers());
        let clusters: usize = self.clusters.iter().map(Cluster::numbers).sum();
        let families = self.families.iter();
        let vectors: usize = families.map(|family| family.vectors.numbers()).sum();
        let weights = 4 * LANES * self.lambda.len() * (1 + self.views.len());
        vectors + weights + response + clusters
    }

    /// Makes room for the vectors of the coupled groups, all of one family with `width` blocks of
    /// exponents. The vectors are shapes, left vectors of positions, and left ones of velocities;
    /// their entries are whatever they were.
    pub(crate) fn make_room(&mut self, width: usize) -> (&mut [ComplexBlock], &mut Rows) {
        self.coupled_width = width;
        // Singles may add exponents behind.
        self.lambda.clear();
        self.lambda.reserve_exact(width + 1);
        self.lambda.resize(width, ComplexBlock::ZERO);
        self.families.truncate(1);
        if self.families.is_empty() {
            self.families.push(Family::default());
        }
        let vectors = self.families[0].fresh(self.groups, width);
        (&mut self.lambda, vectors)
    }

    /// Takes vectors and exponents of the coupled groups, all of one family.
    pub(crate) fn set_family(&mut self, lambda: Vec<ComplexBlock>, vectors: Rows) {
        self.coupled_width = lambda.len();
        self.lambda = lambda;
        self.families.clear();
        self.families.push(Family {
            groups: self.groups,
            vectors: Arc::new(vectors),
            ..Family::default()
        });
    }

    /// Takes exponents and vectors of another one, whose groups are the same.
    pub(super) fn share_exponents(&mut self, other: &Self) {
        self.coupled_width = other.coupled_width;
        self.lambda.clone_from(&other.lambda);
        self.families.clone_from(&other.families);
    }

    /// The groups, by what exponents they share.
    #[inline(always)]
    pub(crate) fn families(&self) -> &[Family] {
        if self.groups == 0 {
            &[]
        } else {
            &self.families
        }
    }

    fn family(&self, group: usize) -> &Family {
        let next = (self.families).partition_point(|family| family.first_group <= group);
        &self.families[next - 1]
    }

    /// The entry of a group's shape, of all exponents.
    pub(crate) fn shape(&self, group: usize, column: usize) -> Complex<f64> {
        let family = self.family(group);
        family.entry(family.shape(group - family.first_group), column)
    }

    /// The entry of a group's left vector of velocities, of all exponents.
    pub(crate) fn left_velocity(&self, group: usize, column: usize) -> Complex<f64> {
        let family = self.family(group);
        family.entry(family.left_velocity(group - family.first_group), column)
    }

    /// Adds the groups, exponents and lone combinations of another one behind its own.
    pub(crate) fn join(&mut self, other: &Self) {
        let (groups, blocks) = (self.combinations, self.coupled_width);
        let shifted = other.members.iter().map(|member| Member {
            group: member.group + groups,
            ..*member
        });
        self.members.extend(shifted);
        self.combinations += other.combinations;
        for single in &other.singles {
            let subject = match single.subject {
                Subject::Combination(number) => Subject::Combination(number + groups),
                mode => mode,
            };
            self.singles.push(Single {
                subject,
                ..single.clone()
            });
        }
        if other.groups == 0 {
            return;
        }
        if self.groups == 0 {
            self.families.clear();
        }
        self.groups += other.groups;
        self.coupled_width += other.coupled_width;
        for family in &other.families {
            self.families.push(Family {
                first_group: family.first_group + groups,
                first_block: family.first_block + blocks,
                ..family.clone()
            });
        }
        self.lambda.extend_from_slice(&other.lambda);
        self.at_rest.extend_from_slice(&other.at_rest);
        if !other.rate_at_rest.is_empty() {
            self.rate_at_rest.resize(groups, 0.0);
            self.rate_at_rest.extend_from_slice(&other.rate_at_rest);
        }
        self.group_damping.extend_from_slice(&other.group_damping);
        for cluster in &other.clusters {
            let mut cluster = cluster.clone();
            cluster.at += blocks * LANES;
            self.clusters.push(cluster);
        }
        self.is_secular |= other.is_secular;
    }

    fn lay_out_exponents<L: Law>(&mut self, problem: &Problem<L>) {
        let mut at = self.coupled_width * LANES;
        for single in &mut self.singles {
            single.at = at;
            at += if self.is_flight {
                1
            } else {
                single.motion.count()
            };
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
        self.growth = largest(growth);
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
        if self.groups_are_modes {
            groups.copy_from_slice(modal);
            return;
        }
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
        for family in self.families() {
            let state = [family.own(position), family.own(velocity)];
            let to = &mut to[family.first_block..][..family.width()];
            let (mut first, width) = (0, family.width());
            while first + TILE <= width {
                family.add_amplitudes::<I, TILE>(state, first, to);
                first += TILE;
            }
            if first + 2 <= width {
                family.add_amplitudes::<I, 2>(state, first, to);
                first += 2;
            }
            if first < width {
                family.add_amplitudes::<I, 1>(state, first, to);
            }
        }
    }

    /// `Re sum_j shape_gj z_j` over the coupled exponents, for all groups, and the same of the
    /// rates: the shapes are read once for both.
    #[inline(always)]
    pub(crate) fn group_sums<I: Instructions>(
        &self,
        [z, rate]: [&[ComplexBlock]; 2],
        [to, to_rate]: [&mut [f64]; 2],
    ) {
        for family in self.families() {
            let turned = [&z[family.blocks()], &rate[family.blocks()]];
            let own = family.first_group..family.first_group + family.groups;
            let to = to[own.clone()].chunks_mut(HALF);
            let mut first = 0;
            for (to, to_rate) in to.zip(to_rate[own].chunks_mut(HALF)) {
                let totals = family.sums::<I>(first, turned);
                for (i, (to, to_rate)) in to.iter_mut().zip(to_rate).enumerate() {
                    (*to, *to_rate) = (totals[i], totals[HALF + i]);
                }
                first += HALF;
            }
        }
    }

    /// `Re sum_j shape_gj z_j` for all groups, of the exponents at four instants, or of their
    /// rates.
    #[inline(always)]
    pub(crate) fn groups_of_four<I: Instructions>(
        &self,
        derivative: usize,
        works: &mut [Workspace; HALF],
    ) {
        for family in self.families() {
            for first in (0..family.groups).step_by(HALF) {
                let [a, b, c, d] = &*works;
                let z = [a, b, c, d].map(|work| &work.turned(derivative)[family.blocks()]);
                let totals = family.four_instants::<I>(first, z);
                let own = family.first_group + first..family.first_group + family.groups;
                for (work, totals) in works.iter_mut().zip(totals) {
                    for (to, total) in work.groups(derivative)[own.clone()].iter_mut().zip(totals) {
                        *to = total;
                    }
                }
            }
        }
    }
}

/// Blocks of exponents that are taken together: their entries lie side by side in memory.
const TILE: usize = 4;

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
pub(super) fn safe_recip<I: Instructions>(z: Complex<Lanes<I>>) -> Complex<Lanes<I>> {
    let norm = z.norm2();
    let zero = Lanes::<I>::of(0.0);
    let inverse = zero.select_less(norm, Lanes::<I>::of(1.0) / norm, zero);
    z.conj().scale(inverse)
}
