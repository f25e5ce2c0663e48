//! How far the motion of a phase may be from the solution of its equations.
//!
//! Exponents, shapes and amplitudes are rounded, so a phase's motion solves its equations with a
//! small force too much, the residual, and starts a little beside the end of the phase before.
//! Both are known numbers. In the energy norm `e^2 = |y'|^2 + y' S y`, with S the symmetric part
//! of the stiffness (moved up where that is not positive), what they do until time t is at most
//! `exp(eta t) (jump + int |residual|)`; where friction slides, the eigenvectors of the motion give
//! a smaller factor. `docs/theory/certificate.md` has the proofs.

mod equations;
mod norm;
mod residual;
mod state_matrix;

use super::PhaseRecord;
use super::projection::COORDINATE;
use crate::error::Result;
use crate::law::{Law, Piece};
use crate::method::piecewise_linear::phase::{Phase, Workspace};
use crate::method::piecewise_linear::polynomial::of_derivative;
use crate::method::piecewise_linear::signal::Signal;
use crate::number::{LANES, Plain};
use crate::problem::Problem;
use crate::rigid::Blow;
use equations::Equations;
use norm::{ErrorNorm, size};
use residual::{Sum, rounding};
use std::ops::Range;

/// Bounds are themselves computed in floating point, from positive terms: this covers it.
const BOUNDS_ROUNDING: f64 = 1.0 + 1e-9;

/// Bounds the error of the motion from switch to switch.
pub(super) struct Defect<'a, L> {
    record: &'a PhaseRecord,
    problem: &'a Problem<L>,
    work: Workspace,
}

impl<'a, L: Law> Defect<'a, L> {
    pub(super) fn new(record: &'a PhaseRecord, problem: &'a Problem<L>) -> Self {
        Self {
            record,
            problem,
            work: Workspace::default(),
        }
    }

    /// The largest bound of any stretch between two switches, at any law in that law's coordinate;
    /// without laws, at any modal coordinate.
    pub(super) fn largest(&mut self) -> Result<f64> {
        let phases = &self.record.phases;
        let mut equations: Vec<Option<Equations>> = Vec::new();
        equations.resize_with(phases.spectra.len(), || None);
        let rows = self.rows();
        let mut largest = 0.0f64;
        let mut first = 0;
        while first < phases.list.len() {
            let phase = phases.list[first];
            let which = &mut equations[phase.spectrum];
            let equations = match which {
                Some(known) => known,
                None => which.insert(Equations::new(self.problem, phases, phase)?),
            };
            let stretch = first..self.next_switch(first);
            first = stretch.end;
            largest = largest.max(self.of_stretch(equations, stretch, &rows));
        }
        Ok(largest)
    }

    /// The rows at which errors are looked at.
    fn rows(&self) -> Vec<Vec<f64>> {
        let laws = &self.problem.laws;
        if laws.is_empty() {
            let modes = self.problem.system.modes();
            let unit = |mode| (0..modes).map(|i| f64::from(u8::from(i == mode))).collect();
            return (0..modes).map(unit).collect();
        }
        laws.iter().flat_map(Law::rows).cloned().collect()
    }

    /// The phase with which the next law switches or is hit. Knots of loads part phases too, and
    /// errors go on over these.
    fn next_switch(&self, first: usize) -> usize {
        let phases = &self.record.phases;
        let goes_on = |number: usize| {
            let [before, phase] = [phases.list[number - 1], phases.list[number]];
            phase.spectrum == before.spectrum
                && phases.states(phase) == phases.states(before)
                && self.blows(number).is_empty()
        };
        let later = first + 1..phases.list.len();
        later.clone().find(|&n| !goes_on(n)).unwrap_or(later.end)
    }

    /// Impulses with which a phase begins.
    fn blows(&self, number: usize) -> &'a [Blow] {
        let blows = &self.record.blows;
        let from = blows.partition_point(|blow| blow.phase < number);
        let until = blows.partition_point(|blow| blow.phase <= number);
        &blows[from..until]
    }

    /// When a phase ends.
    fn end(&self, number: usize) -> f64 {
        let next = self.record.phases.list.get(number + 1);
        next.map_or(self.record.duration, |phase| phase.start)
    }

    fn of_stretch(
        &mut self,
        equations: &Equations,
        stretch: Range<usize>,
        rows: &[Vec<f64>],
    ) -> f64 {
        let list = &self.record.phases.list;
        let whole = self.end(stretch.end - 1) - list[stretch.start].start;
        if whole == 0.0 {
            let [position, _] = self.jump(stretch.start);
            return rows
                .iter()
                .fold(0.0f64, |most, row| most.max(size(row) * size(&position)));
        }
        let norm = ErrorNorm::new(equations, whole);
        let (mut error, mut beside) = (0.0, 0.0);
        for number in stretch {
            let phase = list[number];
            let length = self.end(number) - phase.start;
            let [position, velocity] = self.jump(number);
            error += norm.of_state(&position, &velocity);
            // What is held stays beside its place, and pushes the rest through the stiffness.
            if equations.holds() {
                beside += size(&position);
            }
            error += equations.coupled.stiffness.norm_l2() * beside * length
                + equations.exponential_residual(self.record, phase, length)
                + self.polynomial_residual(equations, phase, length);
        }
        let at_row = |row: &Vec<f64>| norm.rise * error * norm.reach(row) + size(row) * beside;
        BOUNDS_ROUNDING * rows.iter().fold(0.0f64, |most, row| most.max(at_row(row)))
    }

    /// Bound of the integral of the polynomial part's residual over a phase.
    fn polynomial_residual(&self, equations: &Equations, phase: Phase, length: f64) -> f64 {
        let n = equations.views.len();
        let phases = &self.record.phases;
        let mut motion: Vec<Vec<f64>> = Vec::with_capacity(n);
        let mut signal = Signal::default();
        for view in &equations.views {
            let view = std::slice::from_ref(view);
            signal.set::<Plain>(phases, phase, view, &COORDINATE, self.record.duration);
            motion.push(signal.polynomial().to_vec());
        }
        let force = self.force_coefficients(phase);
        let powers = (motion.iter().chain(&force)).fold(0, |most, c| most.max(c.len()));
        let at = |rows: &[Vec<f64>], mode: usize, power: usize| {
            rows[mode].get(power).copied().unwrap_or(0.0)
        };
        let mut total = 0.0;
        for power in 0..powers {
            let (mut left, mut noise) = (vec![0.0; n], vec![0.0; n]);
            for mode in (0..n).filter(|&mode| !equations.solved[mode]) {
                let mut sum = Sum::default();
                for other in 0..n {
                    let rate = (power + 1) as f64 * at(&motion, other, power + 1);
                    sum.add(equations.coupled.stiffness[(mode, other)] * at(&motion, other, power));
                    sum.add(equations.coupled.damping[(mode, other)] * rate);
                }
                let second = ((power + 1) * (power + 2)) as f64;
                sum.add(second * at(&motion, mode, power + 2));
                sum.add(-at(&force, mode, power));
                equations.add_driven(self.record, phase, [mode, power], &mut sum);
                (left[mode], noise[mode]) = (sum.value, rounding(2 * n) * sum.size);
            }
            equations.leave_out_reactions(&mut left);
            total +=
                (size(&left) + size(&noise)) * length.powi(power as i32 + 1) / (power + 1) as f64;
        }
        total
    }

    /// Coefficients in time of the force on each mode: of laws and of loads, harmonics apart.
    fn force_coefficients(&self, phase: Phase) -> Vec<Vec<f64>> {
        let (problem, phases) = (self.problem, &self.record.phases);
        let forcing = &problem.forcing;
        let stride = forcing.stride().max(1);
        let mut force: Vec<Vec<f64>> = (forcing.forces().iter())
            .map(|constant| {
                let mut of_mode = vec![0.0; stride];
                of_mode[0] = *constant;
                of_mode
            })
            .collect();
        for (law, state) in problem.laws.iter().zip(phases.states(phase)) {
            let piece = law.piece(*state).unwrap_or(Piece::FREE);
            for (row, constant) in law.rows().iter().zip(piece.constant) {
                for (of_mode, factor) in force.iter_mut().zip(row) {
                    of_mode[0] += factor * constant;
                }
            }
        }
        let response = phases.spectra[phase.spectrum].response.iter();
        for push in response.flat_map(|response| &response.drives.pushes) {
            let coefficients = &phases.coefficients(phase)[push.channel * stride..][..stride];
            for (of_mode, direction) in force.iter_mut().zip(&push.direction) {
                for (power, to) in of_mode.iter_mut().enumerate() {
                    *to += direction * of_derivative(coefficients, push.order as i32, power);
                }
            }
        }
        force
    }

    /// How far a phase starts from where the one before ends, impulses between the two included:
    /// sizes of position and velocity.
    fn jump(&mut self, number: usize) -> [Vec<f64>; 2] {
        let phases = &self.record.phases;
        let phase = phases.list[number];
        let (problem, work) = (self.problem, &mut self.work);
        let start = self.record.motion_in::<Plain, L>(problem, phase, 0.0, work);
        let (q, mut v) = match number.checked_sub(1) {
            Some(before) => {
                let before = phases.list[before];
                let length = phase.start - before.start;
                let end = self
                    .record
                    .motion_in::<Plain, L>(problem, before, length, work);
                (end.q, end.v)
            }
            None => (problem.displacement.clone(), problem.velocity.clone()),
        };
        for blow in self.blows(number) {
            let row = &self.problem.laws[blow.law].rows()[0];
            for (v, factor) in v.iter_mut().zip(row) {
                *v += factor * blow.impulse;
            }
        }
        let between = |a: &[f64], b: &[f64]| -> Vec<f64> {
            let noise = 2.0 * rounding(4 * LANES);
            (a.iter().zip(b))
                .map(|(a, b)| (a - b).abs() + noise * a.abs().max(b.abs()))
                .collect()
        };
        [between(&start.q, &q), between(&start.v, &v)]
    }
}
