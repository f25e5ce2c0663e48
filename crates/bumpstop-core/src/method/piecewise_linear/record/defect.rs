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
use crate::law::{Law, Piece};
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
    /// Modes with a closed form of their own, which leaves no residual.
    solved: Vec<bool>,
    classes: Vec<Class>,
    /// Residual of each motion that resonates with a load, and its growth rate.
    resonances: Vec<(f64, f64)>,
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
        let solved: Vec<bool> = views.iter().map(|v| is_solved(spectrum, v)).collect();
        let residual = Residual {
            coupled: &coupled,
            solved: &solved,
        };
        Ok(Equations {
            classes: residual.classes(self.problem, spectrum, &views),
            resonances: residual.resonances(spectrum),
            stiffness: (0..n).map(|k| eigen.S()[k]).collect(),
            directions: eigen.U().to_owned(),
            pumping: dampers.iter().fold(0.0f64, |most, c| most.max(-c)),
            coupled,
            views,
            solved,
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
            + self.polynomial_residual(equations, phase, length);
        let error = (norm.growth * length).exp() * (self.jump(&norm, number) + pushed);
        let laws = self.problem.laws.iter().flat_map(Law::rows);
        let reach = laws.fold(0.0f64, |most, row| most.max(norm.reach(row)));
        BOUNDS_ROUNDING * error * reach
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
            let mut squares = 0.0;
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
                squares += (sum.value.abs() + rounding(2 * n) * sum.size).powi(2);
            }
            total += squares.sqrt() * length.powi(power as i32 + 1) / (power + 1) as f64;
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
        let coefficients = phases.coefficients(phase).chunks(stride);
        for (channel, coefficients) in forcing.channels().iter().zip(coefficients) {
            for (of_mode, direction) in force.iter_mut().zip(&channel.direction) {
                for (to, coefficient) in of_mode.iter_mut().zip(coefficients) {
                    *to += direction * coefficient;
                }
            }
        }
        force
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
        for (size, growth) in &self.resonances {
            // What grows from rest under a load of size one has at most reached t by then.
            total += size * length * lasting(*growth, length);
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

/// Whether a mode's motion, or part of it, has a closed form of its own.
fn is_solved(spectrum: &Spectrum, view: &View) -> bool {
    let singles = spectrum.singles.iter().zip(&view.singles);
    singles
        .into_iter()
        .any(|(single, weight)| *weight != 0.0 && single.motion.is_special())
}

/// A sum and the sizes of what was added.
#[derive(Debug, Clone, Copy, Default)]
struct Sum {
    value: f64,
    size: f64,
}

impl Sum {
    fn add(&mut self, term: f64) {
        self.value += term;
        self.size += term.abs();
    }
}

/// A residual at unit amplitude, and a bound of the rounding with which it is computed.
struct Rounded {
    vector: Vec<Complex<f64>>,
    rounding: f64,
}

impl Rounded {
    fn norm(&self) -> f64 {
        self.rounding + (self.vector.iter()).map(|r| r.norm2()).sum::<f64>().sqrt()
    }
}

/// Puts motions into the equations.
struct Residual<'a> {
    coupled: &'a Coupled,
    solved: &'a [bool],
}

impl Residual<'_> {
    /// The residuals of all exponents, equal ones together: those of modes that are alike cancel
    /// only in their sum.
    fn classes<L: Law>(
        &self,
        problem: &Problem<L>,
        spectrum: &Spectrum,
        views: &[View],
    ) -> Vec<Class> {
        let mut classes: Vec<Class> = Vec::new();
        for exponent in 0..spectrum.lambda.len() * LANES {
            let lambda = entry(&spectrum.lambda, exponent);
            let shape: Vec<Complex<f64>> = (views.iter())
                .map(|view| entry(&view.exponents, exponent))
                .collect();
            let harmonic = (spectrum.response.as_ref())
                .and_then(|response| exponent.checked_sub(response.at))
                .filter(|number| *number < problem.forcing.harmonics().len());
            if harmonic.is_none() && shape.iter().all(|psi| psi.norm2() == 0.0) {
                continue;
            }
            let mut residual = self.of_exponent(lambda, &shape);
            if let Some(harmonic) = harmonic {
                self.take_load(problem, spectrum, harmonic, &mut residual);
            }
            let Rounded { vector, rounding } = residual;
            let class = match classes.iter_mut().find(|class| class.exponent == lambda) {
                Some(class) => class,
                None => {
                    classes.push(Class {
                        exponent: lambda,
                        members: Vec::new(),
                        roundings: Vec::new(),
                    });
                    classes.last_mut().expect("just pushed")
                }
            };
            class.members.push((exponent, vector));
            class.roundings.push(rounding);
        }
        classes
    }

    /// `(lambda^2 + lambda C + K) psi`
    fn of_exponent(&self, lambda: Complex<f64>, shape: &[Complex<f64>]) -> Rounded {
        let (square, modulus) = (lambda * lambda, lambda.norm());
        let Coupled {
            stiffness, damping, ..
        } = self.coupled;
        let mut vector = Vec::with_capacity(shape.len());
        let mut squares = 0.0;
        for (i, own) in shape.iter().enumerate() {
            if self.solved[i] {
                vector.push(Complex::zero());
                continue;
            }
            let mut total = square * *own;
            let mut size = modulus * modulus * own.norm();
            for (k, psi) in shape.iter().enumerate() {
                let (stiffness, damping) = (stiffness[(i, k)], damping[(i, k)]);
                total += *psi * lambda.scale(damping).plus(stiffness);
                size += (stiffness.abs() + modulus * damping.abs()) * psi.norm();
            }
            squares += (rounding(2 * shape.len()) * size).powi(2);
            vector.push(total);
        }
        Rounded {
            vector,
            rounding: squares.sqrt(),
        }
    }

    /// Takes a harmonic load, and what drives the motions that resonate with it, from the
    /// residual of its exponent.
    fn take_load<L: Law>(
        &self,
        problem: &Problem<L>,
        spectrum: &Spectrum,
        number: usize,
        residual: &mut Rounded,
    ) {
        let harmonic = &problem.forcing.harmonics()[number];
        let turn = Complex::new(0.0, harmonic.omega);
        let (mut size, modes) = (0.0, residual.vector.len());
        let resonances = spectrum.response.iter().flat_map(|r| &r.resonances);
        let resonances: Vec<_> = resonances.filter(|r| r.harmonic == number).collect();
        for i in (0..modes).filter(|&i| !self.solved[i]) {
            let mut add = |term: Complex<f64>| {
                residual.vector[i] += term;
                size += term.norm();
            };
            add(harmonic.amplitude[i].scale(-1.0));
            for resonance in &resonances {
                add(resonance.row[i] * (resonance.lambda + turn));
                for (k, row) in resonance.row.iter().enumerate() {
                    add(row.scale(self.coupled.damping[(i, k)]));
                }
            }
        }
        residual.rounding += rounding(2 * modes) * size;
    }

    /// Residuals of what resonates with a load, each with its growth rate.
    fn resonances(&self, spectrum: &Spectrum) -> Vec<(f64, f64)> {
        let resonances = spectrum.response.iter().flat_map(|r| &r.resonances);
        let each = resonances.map(|resonance| {
            let residual = self.of_exponent(resonance.lambda, &resonance.row);
            (residual.norm(), resonance.lambda.re)
        });
        each.collect()
    }
}
