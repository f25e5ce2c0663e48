//! How far the motion of a phase may be from the solution of its equations.
//!
//! Exponents, shapes and amplitudes are rounded, so a phase's motion solves its equations with a
//! small force too much, the residual, and starts a little beside the end of the phase before.
//! Both are known numbers. In the energy norm `e^2 = |y'|^2 + y' S y`, with S the symmetric part
//! of the stiffness (moved up where that is not positive), what they do until time t is at most
//! `exp(eta t) (jump + int |residual|)`: `docs/theory/certificate.md` has the proof.

use super::PhaseRecord;
use super::projection::COORDINATE;
use crate::error::{Error, Result};
use crate::law::Law;
use crate::method::piecewise_linear::coupled::Coupled;
use crate::method::piecewise_linear::phase::{Phase, Workspace};
use crate::method::piecewise_linear::rows::entry;
use crate::method::piecewise_linear::signal::Signal;
use crate::method::piecewise_linear::spectrum::Spectrum;
use crate::method::piecewise_linear::view::View;
use crate::number::{Complex, LANES, Plain};
use crate::problem::Problem;
use faer::{Mat, Side};

/// Rounding of a sum of n products, each of up to three factors, relative to their sizes.
fn rounding(terms: usize) -> f64 {
    (terms as f64 + 8.0) * 0.5 * f64::EPSILON
}

/// Bounds are themselves computed in floating point, from positive terms: this covers it.
const BOUNDS_ROUNDING: f64 = 1.0 + 1e-9;

/// The equations of all modes in one combination of law states, and what the exponents of the
/// spectrum leave of them.
struct Equations {
    coupled: Coupled,
    /// Eigenvalues and vectors of the symmetric part of the stiffness.
    stiffness: Vec<f64>,
    directions: Mat<f64>,
    /// Growth rate that the symmetric part of the damping may cause.
    pumping: f64,
    /// How each mode sees the exponents.
    views: Vec<View>,
    classes: Vec<Class>,
}

/// Exponents that are equal, and the residual of each at unit amplitude.
struct Class {
    exponent: Complex<f64>,
    members: Vec<(usize, Vec<Complex<f64>>)>,
    /// Rounding of the residuals, one a member.
    roundings: Vec<f64>,
}

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
                None => which.insert(self.equations(*phase)?),
            };
            largest = largest.max(self.of_phase(equations, number));
        }
        Ok(largest)
    }

    fn equations(&self, phase: Phase) -> Result<Equations> {
        let modes: Vec<usize> = (0..self.problem.system.modes()).collect();
        let phases = &self.record.phases;
        let coupled = Coupled::of_modes(self.problem, phases.states(phase), &modes);
        let spectrum = &phases.spectra[phase.spectrum];
        let n = modes.len();
        let symmetric =
            |matrix: &Mat<f64>| Mat::from_fn(n, n, |r, c| 0.5 * (matrix[(r, c)] + matrix[(c, r)]));
        let eigen = symmetric(&coupled.stiffness)
            .self_adjoint_eigen(Side::Lower)
            .map_err(|_| Error::Eigenvalues)?;
        let dampers = symmetric(&coupled.damping)
            .self_adjoint_eigenvalues(Side::Lower)
            .map_err(|_| Error::Eigenvalues)?;
        let views = unit_views(spectrum, n);
        Ok(Equations {
            classes: classes(spectrum, &coupled, &views),
            stiffness: (0..n).map(|k| eigen.S()[k]).collect(),
            directions: eigen.U().to_owned(),
            pumping: dampers.iter().fold(0.0f64, |most, c| most.max(-c)),
            coupled,
            views,
        })
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
            + equations.polynomial_residual(self.record, phase, length);
        let error = (norm.growth * length).exp() * (self.jump(&norm, number) + pushed);
        let laws = self.problem.laws.iter().flat_map(Law::rows);
        let reach = laws.fold(0.0f64, |most, row| most.max(norm.reach(row)));
        BOUNDS_ROUNDING * error * reach
    }

    /// How far a phase starts from where the one before ends.
    fn jump(&mut self, norm: &EnergyNorm<'_>, number: usize) -> f64 {
        let phases = &self.record.phases;
        let phase = phases.list[number];
        let (problem, work) = (self.problem, &mut self.work);
        let start = self.record.motion_in::<Plain, L>(problem, phase, 0.0, work);
        let (q, v) = match number.checked_sub(1) {
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
        let between = |a: &[f64], b: &[f64]| -> Vec<f64> {
            let noise = 2.0 * rounding(4 * LANES);
            (a.iter().zip(b))
                .map(|(a, b)| (a - b).abs() + noise * a.abs().max(b.abs()))
                .collect()
        };
        norm.of_state(&between(&start.q, &q), &between(&start.v, &v))
    }
}

/// The energy norm of one phase.
struct EnergyNorm<'a> {
    equations: &'a Equations,
    /// What is added to the stiffness in all directions to make it positive.
    shift: f64,
    /// Rate at which the norm may grow by itself.
    growth: f64,
}

impl<'a> EnergyNorm<'a> {
    /// A stiffness that is not positive is moved up until its least eigenvalue is that of a
    /// motion as slow as the phase is long, or as unstable as the structure.
    fn new(equations: &'a Equations, length: f64) -> Self {
        let least = (equations.stiffness.iter()).fold(f64::INFINITY, |m, k| m.min(*k));
        let floor = (-least).max(1.0 / (length * length)).min(f64::MAX);
        let shift = (floor - least).max(0.0);
        let softest = (least + shift).sqrt();
        let mut growth = equations.pumping + shift / softest;
        growth += equations.circulation(softest);
        Self {
            equations,
            shift,
            growth,
        }
    }

    /// A bound of the norm of a state of which the sizes of position and velocity are known.
    fn of_state(&self, position: &[f64], velocity: &[f64]) -> f64 {
        let stiffest = (self.equations.stiffness.iter()).fold(0.0f64, |m, k| m.max(*k));
        norm(velocity) + (stiffest + self.shift).sqrt() * norm(position)
    }

    /// The largest `row . y` of a state of unit norm.
    fn reach(&self, row: &[f64]) -> f64 {
        let Equations {
            stiffness,
            directions,
            ..
        } = self.equations;
        let along = |k: usize| -> f64 { (0..row.len()).map(|i| row[i] * directions[(i, k)]).sum() };
        let squares = (0..row.len()).map(|k| along(k).powi(2) / (stiffness[k] + self.shift));
        squares.sum::<f64>().sqrt()
    }
}

impl Equations {
    /// Growth rate that the skew part of the stiffness may cause, the softest motion having this
    /// frequency.
    fn circulation(&self, softest: f64) -> f64 {
        let stiffness = &self.coupled.stiffness;
        let n = stiffness.nrows();
        let skew = |r: usize, c: usize| 0.5 * (stiffness[(r, c)] - stiffness[(c, r)]);
        let squares: f64 = (0..n * n).map(|i| skew(i / n, i % n).powi(2)).sum();
        squares.sqrt() / softest
    }

    /// Bound of the integral of the exponentials' residual over a phase.
    fn exponential_residual(&self, record: &PhaseRecord, phase: Phase, length: f64) -> f64 {
        let amplitudes = record.phases.amplitudes(phase);
        let mut total = 0.0;
        for class in &self.classes {
            let mut residual = vec![Complex::zero(); self.views.len()];
            let mut noise = 0.0;
            for ((exponent, unit), rounding) in class.members.iter().zip(&class.roundings) {
                let amplitude = entry(amplitudes, *exponent);
                noise += rounding * amplitude.norm();
                for (residual, unit) in residual.iter_mut().zip(unit) {
                    *residual += *unit * amplitude;
                }
            }
            let size: f64 = residual.iter().map(|r| r.norm2()).sum::<f64>().sqrt();
            total += (size + noise) * lasting(class.exponent.re, length);
        }
        total
    }

    /// The same of the polynomial part and the constant forces.
    fn polynomial_residual(&self, record: &PhaseRecord, phase: Phase, length: f64) -> f64 {
        let n = self.views.len();
        let spectrum = &record.phases.spectra[phase.spectrum];
        let mut position: Vec<[f64; 3]> = Vec::with_capacity(n);
        let mut force: Vec<f64> = (0..n).map(|i| self.coupled.force[(i, 0)]).collect();
        let mut signal = Signal::default();
        for (view, force) in self.views.iter().zip(&mut force) {
            let view = std::slice::from_ref(view);
            signal.set::<Plain>(&record.phases, phase, view, &COORDINATE, record.duration);
            position.push(signal.polynomial());
            // Motions that are neither exponentials nor polynomials carry their forces.
            for (single, weight) in spectrum.singles.iter().zip(&view[0].singles) {
                if single.motion.is_special() {
                    *force -= weight * single.motion.force;
                }
            }
        }
        let mut total = 0.0;
        for power in 0..3 {
            let mut squares = 0.0;
            for i in 0..n {
                let (mut residual, mut size) = (0.0, 0.0);
                let mut add = |term: f64| {
                    residual += term;
                    size += term.abs();
                };
                for (k, p) in position.iter().enumerate() {
                    add(self.coupled.stiffness[(i, k)] * p[power]);
                    if power < 2 {
                        let rate = (power + 1) as f64 * p[power + 1];
                        add(self.coupled.damping[(i, k)] * rate);
                    }
                }
                if power == 0 {
                    add(2.0 * position[i][2]);
                    add(-force[i]);
                }
                squares += (residual.abs() + rounding(2 * n) * size).powi(2);
            }
            total += squares.sqrt() * length.powi(power as i32 + 1) / (power + 1) as f64;
        }
        total
    }
}

/// Integral of `exp(growth t)` over a phase, or a bound of it.
fn lasting(growth: f64, length: f64) -> f64 {
    if growth < 0.0 {
        length.min(1.0 / -growth)
    } else {
        length * (growth * length).exp()
    }
}

fn norm(vector: &[f64]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// How each mode sees a spectrum.
fn unit_views(spectrum: &Spectrum, modes: usize) -> Vec<View> {
    let mut combined = Vec::new();
    let mut row = vec![0.0; modes];
    let mut views = Vec::with_capacity(modes);
    for mode in 0..modes {
        row.fill(0.0);
        row[mode] = 1.0;
        let mut view = View::default();
        view.set::<Plain>(spectrum, &row, &mut combined);
        views.push(view);
    }
    views
}

/// The residuals `(lambda^2 + lambda C + K) psi` of all exponents, equal ones together: those of
/// modes that are alike cancel only in their sum.
fn classes(spectrum: &Spectrum, coupled: &Coupled, views: &[View]) -> Vec<Class> {
    let mut classes: Vec<Class> = Vec::new();
    for exponent in 0..spectrum.lambda.len() * LANES {
        let lambda = entry(&spectrum.lambda, exponent);
        let shape: Vec<Complex<f64>> = (views.iter())
            .map(|view| entry(&view.exponents, exponent))
            .collect();
        if shape.iter().all(|psi| psi.norm2() == 0.0) {
            continue;
        }
        let (residual, rounding) = residual_of(coupled, lambda, &shape);
        let member = (exponent, residual);
        match classes.iter_mut().find(|class| class.exponent == lambda) {
            Some(class) => {
                class.members.push(member);
                class.roundings.push(rounding);
            }
            None => classes.push(Class {
                exponent: lambda,
                members: vec![member],
                roundings: vec![rounding],
            }),
        }
    }
    classes
}

/// The residual of one exponent at unit amplitude, and a bound of its own rounding.
fn residual_of(
    coupled: &Coupled,
    lambda: Complex<f64>,
    shape: &[Complex<f64>],
) -> (Vec<Complex<f64>>, f64) {
    let (square, modulus) = (lambda * lambda, lambda.norm());
    let mut residual = Vec::with_capacity(shape.len());
    let mut squares = 0.0;
    for (i, own) in shape.iter().enumerate() {
        let mut total = square * *own;
        let mut size = modulus * modulus * own.norm();
        for (k, psi) in shape.iter().enumerate() {
            let (stiffness, damping) = (coupled.stiffness[(i, k)], coupled.damping[(i, k)]);
            total += *psi * lambda.scale(damping).plus(stiffness);
            size += (stiffness.abs() + modulus * damping.abs()) * psi.norm();
        }
        squares += (rounding(2 * shape.len()) * size).powi(2);
        residual.push(total);
    }
    (residual, squares.sqrt())
}
