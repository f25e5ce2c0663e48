//! The coupled parts of a spectrum: each is solved by the way that costs least, and kept for
//! spectra that differ elsewhere.

use super::dense;
use super::grouping::Acting;
use super::held::Left;
use super::partition::{Component, Groups};
use super::rows::ComplexBlock;
use super::several::{Neighbour, Springs};
use super::span::Span;
use super::spectrum::{Secular, Spectrum, Workbench, safe_recip};
use crate::error::Result;
use crate::law::{Law, State};
use crate::number::{Instructions, Vectorised, dispatch};
use crate::problem::Problem;

/// Parts that are kept for further spectra of a run, at most.
const MOST_KEPT: usize = 256;

/// Parts that were solved in a run, the latest used last. Their vectors are shared with the
/// spectra made of them.
#[derive(Debug, Clone)]
pub(crate) struct Parts {
    kept: Vec<Kept>,
    most: usize,
}

impl Default for Parts {
    fn default() -> Self {
        Self::of(MOST_KEPT)
    }
}

#[derive(Debug, Clone)]
struct Kept {
    /// Its modes: without laws they alone tell it from others.
    modes: Vec<usize>,
    /// The laws that act, with their states.
    laws: Vec<(usize, State)>,
    part: Spectrum,
}

impl Kept {
    /// Whether its laws are in states of the same numbers, in phases as long: its exponents and
    /// vectors serve.
    fn has_matrices_of(&self, laws: &[(usize, State)], span: Span) -> bool {
        let same = |((a, own), (b, other)): (&(usize, State), &(usize, State))| {
            a == b && own.number == other.number
        };
        let as_long = self.part.span.is_parted == span.is_parted;
        as_long && self.laws.len() == laws.len() && self.laws.iter().zip(laws).all(same)
    }
}

impl Parts {
    /// Room for so many.
    pub(crate) fn of(most: usize) -> Self {
        Self {
            kept: Vec::new(),
            most,
        }
    }

    /// A part that is the very one.
    fn find<L: Law>(
        &mut self,
        problem: &Problem<L>,
        modes: &[usize],
        laws: &[(usize, State)],
        (span, secular): (Span, Secular),
    ) -> Option<&Spectrum> {
        let forces = |(law, state): (usize, State)| problem.laws[law].piece(state);
        let serves = |kept: &Kept| {
            let both = || kept.laws.iter().zip(laws);
            kept.modes == modes
                && kept.has_matrices_of(laws, span)
                && both().all(|(own, other)| own == other || forces(*own) == forces(*other))
                && (secular == Secular::Try || !kept.part.is_secular)
        };
        let found = self.kept.iter().rposition(serves)?;
        self.kept[found..].rotate_left(1);
        self.kept.last().map(|kept| &kept.part)
    }

    /// A part of several springs that differs in constant forces at most.
    fn find_alike(&self, laws: &[(usize, State)], span: Span) -> Option<&Spectrum> {
        let alike = |kept: &&Kept| kept.part.is_secular && kept.has_matrices_of(laws, span);
        self.kept.iter().rev().find(alike).map(|kept| &kept.part)
    }

    /// A part without one of several springs, and the number of that spring.
    fn find_lesser(
        &self,
        laws: &[(usize, State)],
        springs: &[Acting],
        span: Span,
    ) -> Option<(&Spectrum, usize)> {
        for (place, (law, _)) in laws.iter().enumerate() {
            let mut own = (0..springs.len()).filter(|&spring| springs[spring].law == *law);
            let others = [&laws[..place], &laws[place + 1..]].concat();
            if let (Some(spring), None) = (own.next(), own.next())
                && let Some(part) = self.find_alike(&others, span)
            {
                return Some((part, spring));
            }
        }
        None
    }

    /// Keeps a part; the one that has not been used for longest goes where there are too many.
    fn keep(&mut self, modes: &[usize], laws: &[(usize, State)], part: Spectrum) {
        if self.kept.len() >= self.most {
            self.kept.remove(0);
        }
        self.kept.push(Kept {
            modes: modes.to_vec(),
            laws: laws.to_vec(),
            part,
        });
    }
}

impl Spectrum {
    /// Couples what several laws, or matrices of the structure, join: each component by itself.
    #[cold]
    pub(super) fn couple_components<L: Law>(
        &mut self,
        problem: &Problem<L>,
        states: &[State],
        secular: Secular,
        bench: &mut Workbench,
    ) -> Result<()> {
        let mut alone = Vec::new();
        let how = (self.span, secular);
        for component in Component::all(problem, states)? {
            if let Some(left) = Left::of(problem, states, &component.modes) {
                let groups = Groups::of_modes(&problem.system, &component.modes);
                return dense::couple_left(self, problem, states, left, &groups);
            }
            let laws: Vec<_> = component.laws.iter().map(|&l| (l, states[l])).collect();
            let modes = &component.modes;
            if bench.parts.find(problem, modes, &laws, how).is_none() {
                let part = Self::of_component(problem, states, &component, how, bench)?;
                bench.parts.keep(modes, &laws, part);
            }
            if let Some(part) = bench.parts.find(problem, modes, &laws, how) {
                match part.groups {
                    // Combinations that are alone have numbers behind all groups.
                    0 => alone.push(part.clone()),
                    _ => self.join(part),
                }
            }
        }
        for part in &alone {
            self.join(part);
        }
        Ok(())
    }

    /// The coupled groups of one component, by the way that costs least.
    fn of_component<L: Law>(
        problem: &Problem<L>,
        states: &[State],
        component: &Component,
        (span, secular): (Span, Secular),
        bench: &mut Workbench,
    ) -> Result<Self> {
        let mut part = Self {
            span,
            ..Self::default()
        };
        let groups = Groups::of(problem, states, component);
        if !problem.system.is_coupled() {
            let springs = Acting::springs(problem, states, &component.laws);
            match springs.as_deref() {
                Some([law]) => {
                    dispatch(CoupleByOne {
                        part: &mut part,
                        problem,
                        law,
                        secular,
                        bench,
                    })?;
                    return Ok(part);
                }
                Some(springs) if secular == Secular::Try => {
                    let laws: Vec<_> = component.laws.iter().map(|&l| (l, states[l])).collect();
                    // Of one spring only: a dense problem would hold the other law too.
                    let is_single = |law| springs.iter().filter(|s| s.law == law).count() == 1;
                    if let [first, _] = laws[..]
                        && is_single(first.0)
                    {
                        Self::prepare_one(problem, states, first, (span, secular), bench)?;
                    }
                    let alike = bench.parts.find_alike(&laws, span);
                    let lesser = bench.parts.find_lesser(&laws, springs, span);
                    let part = Self::of_springs(problem, springs, &groups, span, alike, lesser);
                    if let Some(part) = part {
                        return Ok(part);
                    }
                }
                _ => {}
            }
        }
        dense::couple(&mut part, problem, states, &groups)?;
        Ok(part)
    }

    /// Makes sure that the part of one of two laws is kept: it costs little, and both together are
    /// found from it.
    fn prepare_one<L: Law>(
        problem: &Problem<L>,
        states: &[State],
        law: (usize, State),
        how: (Span, Secular),
        bench: &mut Workbench,
    ) -> Result<()> {
        let alone = Component::of_law(problem, states, law.0);
        let modes = &alone.modes;
        if bench.parts.find(problem, modes, &[law], how).is_none() {
            let part = Self::of_component(problem, states, &alone, how, bench)?;
            bench.parts.keep(modes, &[law], part);
        }
        Ok(())
    }

    /// Groups that several springs and dampers couple, with the exponents and vectors of a part
    /// that differs in constant forces at most, or found from those of one that lacks a spring, if
    /// there is one. `None` where their equations do not tell the exponents, or nothing rests.
    fn of_springs<L: Law>(
        problem: &Problem<L>,
        laws: &[Acting],
        groups: &Groups,
        span: Span,
        alike: Option<&Self>,
        lesser: Option<(&Self, usize)>,
    ) -> Option<Self> {
        let rows: Vec<Vec<f64>> = laws
            .iter()
            .map(|law| groups.row(law.row(problem)))
            .collect();
        let mut force = groups.row(problem.forcing.forces());
        for (law, row) in laws.iter().zip(&rows) {
            for (force, factor) in force.iter_mut().zip(row) {
                *force += factor * law.constant;
            }
        }
        let springs = Springs::new(
            &groups.omega2,
            &groups.damping,
            &rows,
            laws.iter().map(|law| law.stiffness).collect(),
            laws.iter().map(|law| law.damping).collect(),
        );
        let slow = dense::SLOW / span.longest(problem.duration);
        let mut part = Self {
            span,
            members: groups.members.clone(),
            groups: groups.len(),
            combinations: groups.len(),
            group_damping: groups.damping.clone(),
            is_secular: true,
            ..Self::default()
        };
        match alike {
            Some(alike) => part.share_exponents(alike),
            None => {
                let neighbour = lesser
                    .filter(|(part, _)| part.groups > 0 && part.members == groups.members)
                    .map(|(part, spring)| Neighbour {
                        lambda: &part.lambda,
                        family: &part.families()[0],
                        spring,
                    });
                let (lambda, vectors) = springs.solve(slow, neighbour)?;
                part.set_family(lambda, vectors);
                // Written so that what is no number is too far off.
                let is_exact = dispatch(Recall { part: &part }) <= FORGOTTEN * part.groups as f64;
                if !is_exact {
                    return None;
                }
            }
        }
        part.at_rest = part.rest_of(&springs, &force)?;
        Some(part)
    }

    /// The position at rest under constant forces, by the sum over exponents and what that lacks.
    fn rest_of(&self, springs: &Springs, forces: &[f64]) -> Option<Vec<f64>> {
        let mut rest = vec![0.0; forces.len()];
        let size = |forces: &[f64]| forces.iter().fold(0.0f64, |size, p| size.max(p.abs()));
        if size(forces) == 0.0 {
            return Some(rest);
        }
        let mut lack = forces.to_vec();
        for _ in 0..REST_ROUNDS {
            dispatch(Yield {
                part: self,
                forces: &lack,
                rest: &mut rest,
            });
            lack = springs.lack(forces, &rest);
        }
        // Written so that a lack which is no number is one too large.
        let balanced = size(&lack) <= UNBALANCED * size(forces);
        balanced.then_some(rest)
    }
}

/// How far velocities may be from themselves, relative to them and for each group, once they are
/// told by amplitudes: springs that push nearly alike lose digits in the forces between them, and
/// a dense problem does not.
const FORGOTTEN: f64 = 1e-14;

/// Rounds after which a position at rest is good to rounding.
const REST_ROUNDS: usize = 3;

/// What is left of a constant force at rest, relative to it, above which there is no rest.
const UNBALANCED: f64 = 1e-10;

/// Adds `-sum_j shape_j l_j p / lambda_j`, where constant forces move the groups.
struct Yield<'a> {
    part: &'a Spectrum,
    forces: &'a [f64],
    rest: &'a mut [f64],
}

impl Vectorised for Yield<'_> {
    type Output = ();
    #[inline(always)]
    fn run<I: Instructions>(self) {
        let part = self.part;
        let mut z = vec![ComplexBlock::ZERO; part.coupled_width];
        let mut moved = vec![0.0; part.groups];
        part.add_amplitudes::<I>(&moved, self.forces, &mut z);
        for (z, lambda) in z.iter_mut().zip(&part.lambda) {
            let along = -(z.lanes::<I>() * safe_recip(lambda.lanes()));
            z.put(along);
        }
        let mut rate = vec![0.0; part.groups];
        part.group_sums::<I>([&z, &z], [&mut moved, &mut rate]);
        for (rest, moved) in self.rest.iter_mut().zip(&moved) {
            *rest += moved;
        }
    }
}

/// How far velocities of one, in all groups, are from themselves once they are told by amplitudes.
struct Recall<'a> {
    part: &'a Spectrum,
}

impl Vectorised for Recall<'_> {
    type Output = f64;
    #[inline(always)]
    fn run<I: Instructions>(self) -> f64 {
        let part = self.part;
        let mut z = vec![ComplexBlock::ZERO; part.coupled_width];
        let (mut moved, mut rate) = (vec![0.0; part.groups], vec![1.0; part.groups]);
        part.add_amplitudes::<I>(&moved, &rate, &mut z);
        for (z, lambda) in z.iter_mut().zip(&part.lambda) {
            z.put(z.lanes::<I>() * lambda.lanes());
        }
        part.group_sums::<I>([&z, &z], [&mut rate, &mut moved]);
        (rate.iter()).fold(0.0f64, |worst, rate| worst.max((rate - 1.0).abs()))
    }
}

struct CoupleByOne<'a, L> {
    part: &'a mut Spectrum,
    problem: &'a Problem<L>,
    law: &'a Acting,
    secular: Secular,
    bench: &'a mut Workbench,
}

impl<L: Law> Vectorised for CoupleByOne<'_, L> {
    type Output = Result<()>;
    #[inline(always)]
    fn run<I: Instructions>(self) -> Result<()> {
        (self.part).couple_by_one::<I, L>(self.problem, self.law, self.secular, self.bench)
    }
}
