//! What a run of the full model tells its record: the motion of the kept dofs, and the energies of
//! the whole structure, each from its own power.
//!
//! The work of dampers is integrated by the trapezoidal rule with its correction by the rates of
//! the power at both ends, which makes it one of fourth order (Euler and Maclaurin's formula), that
//! of loads that change by the trapezoidal rule alone; constant loads do what they do along the
//! way.

use super::FullProblem;
use super::structure::part;
use super::system::{add_product, dot};
use crate::law::Law;
use crate::method::one_step::{End, Motion};
use crate::method::polynomial_steps::TOLD;
use crate::sparse::SparseMatrix;

/// The account at the end of a step.
pub(super) struct Account<'a, L> {
    problem: &'a FullProblem<L>,
    h: f64,
    /// Motion of the kept dofs.
    kept: [Vec<f64>; 3],
    damped: f64,
    given: f64,
    powers: Powers,
    /// The accelerations at the start squared, over the mass.
    inertia: f64,
    /// The displacement at the start of the next step.
    before: Vec<f64>,
    /// Room for a product, and for loads.
    room: Vec<f64>,
}

/// Energies and powers at one instant.
#[derive(Debug, Clone, Copy, Default)]
struct Powers {
    kinetic: [f64; 2],
    elastic: [f64; 2],
    /// What dampers take, and the rate of that.
    damping: [f64; 2],
    constant: f64,
    changing: f64,
}

impl<'a, L: Law> Account<'a, L> {
    /// With the motion at t = 0.
    pub(super) fn new(problem: &'a FullProblem<L>, h: f64, motion: &Motion) -> Self {
        let mut account = Self {
            problem,
            h,
            kept: [Vec::new(), Vec::new(), Vec::new()],
            damped: 0.0,
            given: 0.0,
            powers: Powers::default(),
            inertia: 0.0,
            before: motion.q.clone(),
            room: vec![0.0; problem.system.dofs()],
        };
        account.look(0.0, motion);
        account.room.fill(0.0);
        add_product(&problem.system.mass, 1.0, &motion.a, &mut account.room);
        account.inertia = dot(&motion.a, &account.room);
        account
    }

    /// Takes the motion at the end of a step.
    pub(super) fn go_on(&mut self, time: f64, motion: &Motion) {
        let from = self.powers;
        self.look(time, motion);
        let (to, h) = (&self.powers, self.h);
        let correction = h * h / 12.0 * (from.damping[1] - to.damping[1]);
        self.damped += 0.5 * h * (from.damping[0] + to.damping[0]) + correction;
        let way = motion.q.iter().zip(&self.before);
        let constant: f64 = (self.problem.forcing.forces().iter().zip(way))
            .map(|(force, (to, from))| force * (to - from))
            .sum();
        self.given += constant + 0.5 * h * (from.changing + to.changing);
        self.before.copy_from_slice(&motion.q);
    }

    fn look(&mut self, time: f64, motion: &Motion) {
        let Motion { q, v, a } = motion;
        for (to, whole) in self.kept.iter_mut().zip([q, v, a]) {
            part(&self.problem.kept, whole, to);
        }
        let (system, forcing) = (&self.problem.system, &self.problem.forcing);
        let room = &mut self.room;
        let mut product = |matrix: &SparseMatrix, x: &[f64], with: [&[f64]; 2]| {
            room.fill(0.0);
            add_product(matrix, 1.0, x, room);
            with.map(|with| dot(with, room))
        };
        let [kinetic, accelerating] = product(&system.mass, v, [v, a]);
        let [elastic, straining] = product(&system.stiffness, q, [q, v]);
        let [damping, easing] = match &system.damping {
            Some(matrix) => product(matrix, v, [v, a]),
            None => [0.0; 2],
        };
        let constant = dot(forcing.forces(), v);
        let changing = if forcing.varies() {
            forcing.at(time, room);
            dot(room, v) - constant
        } else {
            0.0
        };
        self.powers = Powers {
            kinetic: [0.5 * kinetic, accelerating],
            elastic: [0.5 * elastic, straining],
            damping: [damping, 2.0 * easing],
            constant,
            changing,
        };
    }
}

impl<L: Law> End for Account<'_, L> {
    fn numbers(&self, to: &mut [f64]) {
        let [q, v, _] = &self.kept;
        let energies: [f64; TOLD] = [
            self.powers.kinetic[0],
            self.powers.elastic[0],
            self.damped,
            self.given,
        ];
        let all = q.iter().chain(v).chain(&energies);
        for (to, number) in to.iter_mut().zip(all) {
            *to = *number;
        }
    }

    fn rates(&self, [_, to]: [&mut Vec<f64>; 2]) {
        let [_, v, a] = &self.kept;
        let powers = &self.powers;
        let rates: [f64; TOLD] = [
            powers.kinetic[1],
            powers.elastic[1],
            powers.damping[0],
            powers.constant + powers.changing,
        ];
        to.extend(v.iter().chain(a).chain(&rates));
    }

    fn inertia(&self) -> Option<f64> {
        Some(self.inertia)
    }
}
