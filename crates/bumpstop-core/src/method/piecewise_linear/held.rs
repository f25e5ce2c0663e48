//! Phases in which laws hold local coordinates: the motions that are left, and the reactions.
//!
//! With the held rows R, `R q = d`, the modes are `q = q_c + Z y`: Z an orthonormal basis of the
//! null space of R, `q_c` the least solution. The motions y obey
//! `y'' + Z'C Z y' + Z'K Z y = Z'(p - K q_c)`, and the reactions are
//! `r = (R R')^-1 R (K q + C q' - p)`: affine functions of the motion, as guards are.

use super::coupled::Coupled;
use super::phase::{Phase, Phases};
use super::response::Link;
use super::rows::{entry, set_entry};
use super::signal::Signal;
use super::spectrum::{Member, Spectrum};
use super::view::View;
use crate::law::{Affine, COORDINATES, Law, Local, Piece, State};
use crate::number::{Complex, Instructions};
use crate::problem::Problem;
use crate::rigid::Directions;
use faer::Mat;

/// A diagonal entry of R's triangular factor below this part of the largest means that a row
/// depends on those before.
pub(super) const DEPENDENT: f64 = 1e-6;

/// What is held in a phase.
#[derive(Debug, Clone, Default)]
pub(crate) struct Held {
    /// The modes that take part, and where the held coordinates put them.
    pub modes: Vec<usize>,
    pub offsets: Vec<f64>,
    /// The reactions, by number of law.
    pub reactions: Vec<(usize, Reaction)>,
}

/// How a reaction sees the motion.
#[derive(Debug, Clone, Default)]
pub(crate) struct Reaction {
    /// Views of position and velocity.
    views: [View; 2],
    constant: f64,
}

/// The motions that are left to some modes.
pub(super) struct Left {
    pub held: Held,
    /// Z, one row a mode.
    basis: Mat<f64>,
}

impl Left {
    /// `None` where nothing is held.
    pub(super) fn of<L: Law>(
        problem: &Problem<L>,
        states: &[State],
        modes: &[usize],
    ) -> Option<Self> {
        let held = Directions::held(problem, states);
        if held.rows.is_empty() {
            return None;
        }
        let position = |&law: &usize| {
            let constraint = problem.laws[law].constraint(states[law]);
            constraint.map_or(0.0, |constraint| constraint.position)
        };
        let positions: Vec<f64> = held.laws.iter().map(position).collect();
        let mut at = vec![0.0; problem.system.modes()];
        held.add(&held.impulses(&positions), &mut at);
        let rows = Mat::from_fn(modes.len(), held.rows.len(), |i, row| {
            held.rows[row][modes[i]]
        });
        let factors = rows.col_piv_qr();
        let triangle = factors.R();
        let count = rows.nrows().min(rows.ncols());
        let size = |k: usize| triangle[(k, k)].abs();
        let rank = (0..count)
            .filter(|&k| size(k) > DEPENDENT * size(0))
            .count();
        let all = factors.compute_Q();
        let free = modes.len() - rank;
        Some(Self {
            held: Held {
                modes: modes.to_vec(),
                offsets: modes.iter().map(|&mode| at[mode]).collect(),
                reactions: Vec::new(),
            },
            basis: Mat::from_fn(modes.len(), free, |i, k| all[(i, rank + k)]),
        })
    }

    /// How the modes take part in the motions that are left.
    pub(super) fn members(&self) -> Vec<Member> {
        let mut members = Vec::with_capacity(self.basis.nrows() * self.basis.ncols());
        for group in 0..self.basis.ncols() {
            for (row, &mode) in self.held.modes.iter().enumerate() {
                members.push(Member {
                    mode,
                    group,
                    weight: self.basis[(row, group)],
                });
            }
        }
        members
    }

    /// The equations of the motions that are left.
    pub(super) fn reduce(&self, coupled: &Coupled) -> Coupled {
        let z = &self.basis;
        let n = self.held.offsets.len();
        let at = Mat::from_fn(n, 1, |i, _| self.held.offsets[i]);
        Coupled {
            stiffness: z.transpose() * &coupled.stiffness * z,
            damping: z.transpose() * &coupled.damping * z,
            force: z.transpose() * (&coupled.force - &coupled.stiffness * at),
            stiff: None,
        }
    }
}

impl Held {
    /// Where the held coordinates put the modes, as seen along a row.
    pub(crate) fn along(&self, row: &[f64]) -> f64 {
        let both = self.modes.iter().zip(&self.offsets);
        both.map(|(&mode, offset)| row[mode] * offset).sum()
    }

    /// The reaction of a law.
    pub(crate) fn reaction(&self, law: usize) -> Option<&Reaction> {
        let found = self.reactions.iter().find(|(held, _)| *held == law);
        found.map(|(_, reaction)| reaction)
    }
}

impl Reaction {
    /// How the reactions see the motion of a spectrum that is otherwise ready, by number of law.
    pub(super) fn all<I: Instructions, L: Law>(
        problem: &Problem<L>,
        spectrum: &Spectrum,
        combined: &mut Vec<f64>,
    ) -> Vec<(usize, Self)> {
        let states = &spectrum.states;
        let directions = Directions::held(problem, states);
        let mut reactions = Vec::with_capacity(directions.laws.len());
        for place in 0..directions.laws.len() {
            let mut unit = vec![0.0; directions.laws.len()];
            unit[place] = 1.0;
            // (R R')^-1 R, one row of it
            let mut row = vec![0.0; problem.system.modes()];
            directions.add(&directions.impulses(&unit), &mut row);
            let forces = Resistance::along(problem, states, &row);
            let mut reaction = Self {
                constant: forces.constant,
                ..Self::default()
            };
            reaction.views[0].set::<I>(spectrum, &forces.of_position, combined);
            reaction.views[1].set::<I>(spectrum, &forces.of_velocity, combined);
            reaction.views[0].resist_loads(spectrum, &row);
            reactions.push((directions.laws[place], reaction));
        }
        reactions
    }

    /// The reaction along a phase, in N.
    #[inline(always)]
    pub(crate) fn set<I: Instructions>(
        &self,
        signal: &mut Signal,
        phases: &Phases,
        phase: Phase,
        remaining: f64,
    ) {
        let mut function = Affine::coordinate(0);
        function.velocity[1] = 1.0;
        function.constant = self.constant;
        signal.set::<I>(phases, phase, &self.views, &function, remaining);
    }
}

/// `row . (K q + C q' - p)` without the loads that change in time.
struct Resistance {
    of_position: Vec<f64>,
    of_velocity: Vec<f64>,
    constant: f64,
}

impl Resistance {
    fn along<L: Law>(problem: &Problem<L>, states: &[State], row: &[f64]) -> Self {
        let system = &problem.system;
        let own = |values: &[f64]| values.iter().zip(row).map(|(x, r)| x * r).collect();
        let mut resistance = Self {
            of_position: own(system.omega2()),
            of_velocity: own(system.damping()),
            constant: -dot(row, problem.forcing.forces()),
        };
        let parts = [
            (system.circulatory(), &mut resistance.of_position),
            (system.coupling(), &mut resistance.of_velocity),
        ];
        for (matrix, to) in parts {
            if let Some(matrix) = matrix {
                for (column, to) in to.iter_mut().enumerate() {
                    let factors = row.iter().enumerate();
                    *to += factors.map(|(i, r)| r * matrix.at(i, column)).sum::<f64>();
                }
            }
        }
        for (law, state) in problem.laws.iter().zip(states) {
            if let Some(piece) = law.piece(*state).filter(Piece::acts) {
                resistance.add_law(law.rows(), &piece, row);
            }
        }
        resistance
    }

    fn add_law(&mut self, rows: &[Vec<f64>], piece: &Piece, row: &[f64]) {
        for (i, pushed) in rows.iter().enumerate().take(COORDINATES) {
            let seen = dot(row, pushed);
            self.constant -= seen * piece.constant[i];
            let add = |to: &mut [f64], factors: &Local<f64>| {
                for (felt, factor) in rows.iter().zip(factors) {
                    for (to, r) in to.iter_mut().zip(felt) {
                        *to += seen * factor * r;
                    }
                }
            };
            add(&mut self.of_position, &piece.stiffness[i]);
            add(&mut self.of_velocity, &piece.damping[i]);
        }
    }
}

impl View {
    /// Takes the loads that change in time away, as seen along a row.
    fn resist_loads(&mut self, spectrum: &Spectrum, row: &[f64]) {
        let Some(response) = &spectrum.response else {
            return;
        };
        for (number, amplitude) in response.drives.harmonics.iter().enumerate() {
            let at = response.at + number;
            let pushed = row.iter().zip(amplitude);
            let seen = pushed.fold(Complex::zero(), |sum, (r, p)| p.scale_add(*r, sum));
            let resisted = entry(&self.exponents, at) - seen;
            set_entry(&mut self.exponents, at, resisted);
        }
        for push in &response.drives.pushes {
            let goes_with = |link: &Link| {
                let is_its = link.channel == push.channel && link.pushed == push.order;
                is_its && link.order == push.order as i32
            };
            if let Some(link) = response.links.iter().position(goes_with) {
                self.links[link] -= dot(row, &push.direction);
            }
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
