//! How far the motion of a phase may be from the solution of its equations.
//!
//! Exponents, shapes and amplitudes are rounded, so a phase's motion solves its equations with a
//! small force too much, the residual, and starts a little beside the end of the phase before.
//! Both are known numbers. In the energy norm `e^2 = |y'|^2 + y' S y`, with S the symmetric part
//! of the stiffness (moved up where that is not positive), what they do until time t is at most
//! `exp(eta t) (jump + int |residual|)`: `docs/theory/certificate.md` has the proof.

mod equations;
mod norm;
mod residual;

use super::PhaseRecord;
use super::projection::COORDINATE;
use crate::error::Result;
use crate::law::{Law, Piece};
use crate::method::piecewise_linear::phase::{Phase, Workspace};
use crate::method::piecewise_linear::polynomial::of_derivative;
use crate::method::piecewise_linear::signal::Signal;
use crate::number::{LANES, Plain};
use crate::problem::Problem;
use equations::Equations;
use norm::{EnergyNorm, size};
use residual::{Sum, rounding};

/// Bounds are themselves computed in floating point, from positive terms: this covers it.
const BOUNDS_ROUNDING: f64 = 1.0 + 1e-9;

/// Bounds the error of the motion phase by phase.
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

    /// The largest bound of any phase at any law, in that law's coordinate.
    pub(super) fn largest(&mut self) -> Result<f64> {
        let phases = &self.record.phases;
        let mut equations: Vec<Option<Equations>> = Vec::new();
        equations.resize_with(phases.spectra.len(), || None);
        let mut largest = 0.0f64;
        for (number, phase) in phases.list.iter().enumerate() {
            let which = &mut equations[phase.spectrum];
            let equations = match which {
                Some(known) => known,
                None => which.insert(Equations::new(self.problem, phases, *phase)?),
            };
            largest = largest.max(self.of_phase(equations, number));
        }
        Ok(largest)
    }

    fn of_phase(&mut self, equations: &Equations, number: usize) -> f64 {
        let phases = &self.record.phases;
        let phase = phases.list[number];
        let next = phases.list.get(number + 1);
        let length = next.map_or(self.record.duration, |p| p.start) - phase.start;
        if length == 0.0 {
            return 0.0;
        }
        let norm = EnergyNorm::new(equations, length);
        let pushed = equations.exponential_residual(self.record, phase, length)
            + self.polynomial_residual(equations, phase, length);
        let [position, velocity] = self.jump(number);
        // What is held stays beside its place, and pushes the rest through the stiffness.
        let beside = if equations.holds() {
            size(&position)
        } else {
            0.0
        };
        let pushed = pushed + equations.coupled.stiffness.norm_l2() * beside * length;
        let jump = norm.of_state(&position, &velocity);
        let error = (norm.growth * length).exp() * (jump + pushed);
        let laws = self.problem.laws.iter().flat_map(Law::rows);
        let at_row = |row: &Vec<f64>| error * norm.reach(row) + size(row) * beside;
        BOUNDS_ROUNDING * laws.fold(0.0f64, |most, row| most.max(at_row(row)))
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
        for blow in self.record.blows.iter().filter(|b| b.phase == number) {
            let row = &problem.laws[blow.law].rows()[0];
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
