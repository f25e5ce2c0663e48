//! What moves by itself: modes that no acting law sees, and combinations that one law sees alone.

use super::grouping::{Acting, group_forces};
use super::secular::Coupling;
use super::single_mode::SingleMode;
use super::spectrum::{Spectrum, Workbench};
use crate::law::Law;
use crate::problem::Problem;

/// What a single motion is the motion of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Subject {
    /// A mode, less its part in a combination.
    Mode(usize),
    /// A combination that a law pushes alone, by number.
    Combination(usize),
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

impl Spectrum {
    /// A law that pushes a single mode, or a single combination of like ones, only changes its
    /// stiffness and damping.
    pub(super) fn add_lone_combination<L: Law>(
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
        let longest = self.span.longest(problem.duration);
        self.singles.push(Single {
            subject: Subject::Combination(0),
            motion: SingleMode::new(stiffness, damping, force, longest),
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
        let longest = self.span.longest(problem.duration);
        self.singles.push(Single {
            subject: Subject::Combination(0),
            motion: SingleMode::new(stiffness, damping, force, longest),
            at: 0,
            modal_share: 1.0,
            law: None,
        });
    }

    /// Adds the modes, or parts of modes, that no acting law sees.
    #[inline(always)]
    pub(super) fn add_singles<L: Law>(&mut self, problem: &Problem<L>, bench: &mut Workbench) {
        if self.members.is_empty() && self.held.is_none() {
            return self.add_modes(problem);
        }
        if self.groups_are_modes {
            return;
        }
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
            // The part of the mode's force that its groups take.
            pushed[member.mode] += member.weight * totals[member.group];
            whole += usize::from(member.weight.abs() == 1.0);
        }
        if let Some(held) = &self.held {
            held.modes.iter().for_each(|&mode| weights[mode] = 1.0);
        }
        self.singles.reserve_exact(omega2.len() - whole);
        let longest = self.span.longest(problem.duration);
        for mode in 0..omega2.len() {
            if weights[mode].abs() == 1.0 {
                continue;
            }
            let force = forces[mode] - pushed[mode];
            self.singles.push(Single {
                subject: Subject::Mode(mode),
                motion: SingleMode::new(omega2[mode], damping[mode], force, longest),
                at: 0,
                modal_share: 1.0,
                law: None,
            });
        }
    }
}
