//! The equations of all modes between two switches.

use super::residual::{Class, ClusterResidual, Residual, Sum};
use crate::eigen::{symmetric_eigen, symmetric_eigenvalues};
use crate::error::Result;
use crate::law::{Law, State};
use crate::method::piecewise_linear::coupled::Coupled;
use crate::method::piecewise_linear::held::DEPENDENT;
use crate::method::piecewise_linear::partition::Groups;
use crate::method::piecewise_linear::phase::{Phase, Phases};
use crate::method::piecewise_linear::record::PhaseRecord;
use crate::method::piecewise_linear::rows::entry;
use crate::method::piecewise_linear::spectrum::Spectrum;
use crate::method::piecewise_linear::view::View;
use crate::number::{Complex, Plain};
use crate::problem::Problem;
use crate::rigid::Directions;
use faer::Mat;

/// The equations of all modes in one combination of law states, and what the exponents of the
/// spectrum leave of them.
pub(super) struct Equations {
    pub coupled: Coupled,
    /// Eigenvalues and vectors of the symmetric part of the stiffness.
    pub stiffness: Vec<f64>,
    pub directions: Mat<f64>,
    /// Growth rate that the symmetric part of the damping may cause.
    pub pumping: f64,
    /// How each mode sees the exponents.
    pub views: Vec<View>,
    /// Modes with a closed form of their own, which leaves no residual.
    pub solved: Vec<bool>,
    classes: Vec<Class>,
    /// What reactions can push, where coordinates are held: the rows of their directions.
    held: Option<Mat<f64>>,
    clusters: Vec<ClusterResidual>,
}

impl Equations {
    /// The equations of the phases that share a phase's spectrum.
    pub(super) fn new<L: Law>(problem: &Problem<L>, phases: &Phases, phase: Phase) -> Result<Self> {
        let modes: Vec<usize> = (0..problem.system.modes()).collect();
        let coupled = Coupled::of_groups(
            problem,
            phases.states(phase),
            &Groups::of_modes(&problem.system, &modes),
        );
        let spectrum = &phases.spectra[phase.spectrum];
        let n = modes.len();
        let symmetric =
            |matrix: &Mat<f64>| Mat::from_fn(n, n, |r, c| 0.5 * (matrix[(r, c)] + matrix[(c, r)]));
        let eigen = symmetric_eigen(&symmetric(&coupled.stiffness))?;
        let dampers = symmetric_eigenvalues(&symmetric(&coupled.damping))?;
        let views = unit_views(spectrum, n);
        let solved: Vec<bool> = views.iter().map(|v| is_solved(spectrum, v)).collect();
        let held = held_directions(problem, phases.states(phase));
        let residual = Residual {
            coupled: &coupled,
            solved: &solved,
            held: held.as_ref(),
        };
        let clusters = residual.clusters(spectrum, &views);
        Ok(Self {
            classes: residual.classes(problem, spectrum, &views, &clusters),
            clusters,
            stiffness: eigen.values,
            directions: eigen.vectors,
            pumping: dampers.iter().fold(0.0f64, |most, c| most.max(-c)),
            coupled,
            views,
            solved,
            held,
        })
    }

    /// Whether something is held where it is.
    pub(super) fn holds(&self) -> bool {
        self.held.is_some()
    }

    /// Takes from a residual what reactions push: they are whatever it takes.
    pub(super) fn leave_out_reactions(&self, residual: &mut [f64]) {
        let Some(held) = &self.held else { return };
        let mut whole: Vec<Complex<f64>> = residual.iter().map(|r| Complex::new(*r, 0.0)).collect();
        leave_out(held, &mut whole);
        for (to, from) in residual.iter_mut().zip(&whole) {
            *to = from.re;
        }
    }

    /// Growth rate that the skew part of the stiffness may cause, the softest motion having this
    /// frequency.
    pub(super) fn circulation(&self, softest: f64) -> f64 {
        let stiffness = &self.coupled.stiffness;
        let n = stiffness.nrows();
        let skew = |r: usize, c: usize| 0.5 * (stiffness[(r, c)] - stiffness[(c, r)]);
        let squares: f64 = (0..n * n).map(|i| skew(i / n, i % n).powi(2)).sum();
        squares.sqrt() / softest
    }

    /// Adds what the polynomials that drive clusters leave of a mode's equation, at a power of the
    /// time.
    pub(super) fn add_driven(
        &self,
        record: &PhaseRecord,
        phase: Phase,
        [mode, power]: [usize; 2],
        sum: &mut Sum,
    ) {
        let amplitudes = record.phases.amplitudes(phase);
        let clusters = &record.phases.spectra[phase.spectrum].clusters;
        for (cluster, residual) in clusters.iter().zip(&self.clusters) {
            if residual.turns || cluster.drives() == 0 {
                continue;
            }
            let mut z = cluster.columns(amplitudes);
            for n in 1..=power {
                z = cluster.rate(&z).map(|rate| rate.scale(1.0 / n as f64));
            }
            let drive = &z[cluster.size - cluster.drives()..cluster.size];
            for (factor, z) in residual.driving[mode].iter().zip(drive) {
                sum.add(factor.real_product(*z));
            }
        }
    }

    /// Bound of the integral of the exponentials' residual over a phase.
    pub(super) fn exponential_residual(
        &self,
        record: &PhaseRecord,
        phase: Phase,
        length: f64,
    ) -> f64 {
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
        let spectrum = &record.phases.spectra[phase.spectrum];
        for (cluster, residual) in spectrum.clusters.iter().zip(&self.clusters) {
            let z = cluster.columns(amplitudes);
            let size = z.iter().map(|z| z.norm2()).sum::<f64>().sqrt();
            let growth = cluster.growth().max(0.0);
            total += residual.moving * size * lasting(growth, length);
        }
        total
    }
}

/// An orthonormal basis of the directions in which reactions push; `None` where nothing is held.
fn held_directions<L: Law>(problem: &Problem<L>, states: &[State]) -> Option<Mat<f64>> {
    let held = Directions::held(problem, states);
    if held.rows.is_empty() {
        return None;
    }
    let modes = problem.system.modes();
    let rows = Mat::from_fn(modes, held.rows.len(), |i, k| held.rows[k][i]);
    let factors = rows.col_piv_qr();
    let triangle = factors.R();
    let count = modes.min(held.rows.len());
    let rank = (0..count)
        .filter(|&k| triangle[(k, k)].abs() > DEPENDENT * triangle[(0, 0)].abs())
        .count();
    let all = factors.compute_Q();
    Some(Mat::from_fn(modes, rank, |i, k| all[(i, k)]))
}

/// Takes from a vector its part in the span of orthonormal columns.
pub(super) fn leave_out(columns: &Mat<f64>, vector: &mut [Complex<f64>]) {
    for k in 0..columns.ncols() {
        let mut along = Complex::zero();
        for (i, x) in vector.iter().enumerate() {
            along += x.scale(columns[(i, k)]);
        }
        for (i, x) in vector.iter_mut().enumerate() {
            *x += along.scale(-columns[(i, k)]);
        }
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
