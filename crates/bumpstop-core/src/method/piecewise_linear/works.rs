//! The works of a phase, each integrated from its own power.
//!
//! What dampers take out is a quadratic form of the rates, see [`super::dissipation`], as long as
//! nothing else drives them. Where something does, loads that change in time, a circulatory matrix
//! or laws that are more than springs and dampers, each power is a sum of products of two signals,
//! whose integrals are in [`super::product`].

use super::dissipation::Dissipation;
use super::phase::{Phase, Phases, Workspace};
use super::product::{Factor, Products};
use super::rows::{ComplexBlock, set_entry};
use super::signal::Signal;
use super::spectrum::Spectrum;
use super::view::View;
use crate::eigen::symmetric_eigen;
use crate::forcing::{Forcing, Moved};
use crate::law::{Affine, COORDINATES, Law, Piece, Power};
use crate::number::{Complex, Instructions};
use crate::problem::Problem;
use crate::system::{Coupling, ModalSystem};
use faer::Mat;
use std::cell::OnceCell;

/// Energies since the start of a phase, in J.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Works {
    /// Taken by the structure's damping.
    pub modal: f64,
    /// Taken by each law.
    pub laws: Vec<f64>,
    /// Given by circulatory forces.
    pub circulatory: f64,
    /// Given by loads that change in time.
    pub loads: f64,
    /// Given by obstacles that move.
    pub obstacles: f64,
}

impl Works {
    /// No works of so many laws.
    pub(crate) fn none(laws: usize) -> Self {
        Self {
            modal: 0.0,
            laws: vec![0.0; laws],
            circulatory: 0.0,
            loads: 0.0,
            obstacles: 0.0,
        }
    }
}

/// The matrices of a structure as sums of rank one, and the loads on it that change in time: what
/// has powers that are products.
#[derive(Debug, Clone)]
pub(crate) struct Powers {
    pub dampers: Vec<Damper>,
    circulations: Vec<Circulation>,
    /// The directions of polynomials and tables, with their numbers.
    channels: Vec<(usize, Vec<f64>)>,
    /// Real and imaginary part of the amplitudes of each harmonic.
    harmonics: Vec<[Vec<f64>; 2]>,
}

/// A damper along a combination of modes.
#[derive(Debug, Clone)]
pub(crate) struct Damper {
    pub constant: f64,
    pub row: Vec<f64>,
}

/// A force `-strength (position . q)` along `rate`.
#[derive(Debug, Clone)]
struct Circulation {
    strength: f64,
    position: Vec<f64>,
    rate: Vec<f64>,
}

impl Powers {
    /// Those of a problem, found when first asked for: plain dampers do not ask.
    pub(crate) fn in_cell<'a, L>(cell: &'a OnceCell<Self>, problem: &Problem<L>) -> &'a Self {
        cell.get_or_init(|| Self::of(&problem.system, &problem.forcing))
    }

    /// Of the damping matrix, whose skew part takes nothing out, of the circulatory one, and of
    /// the loads.
    fn of(system: &ModalSystem, forcing: &Forcing) -> Self {
        let channels = forcing.channels().iter().enumerate();
        let channels = channels.filter(|(_, channel)| channel.moves.is_none());
        let harmonics = forcing.harmonics().iter().map(|harmonic| {
            let part = |of: fn(&Complex<f64>) -> f64| harmonic.amplitude.iter().map(of).collect();
            [part(|z| z.re), part(|z| z.im)]
        });
        Self {
            dampers: dampers(system),
            circulations: system.circulatory().map_or_else(Vec::new, circulations),
            channels: (channels.map(|(number, channel)| (number, channel.direction.clone())))
                .collect(),
            harmonics: harmonics.collect(),
        }
    }
}

/// The dampers of the modes that no matrix couples, and the principal ones of the others.
fn dampers(system: &ModalSystem) -> Vec<Damper> {
    let modes = system.modes();
    let couples = |mode: &usize| system.coupling().is_some_and(|c| c.involves(*mode));
    let (coupled, alone): (Vec<usize>, Vec<usize>) = (0..modes).partition(couples);
    let along = |weights: &[(usize, f64)]| {
        let mut row = vec![0.0; modes];
        for (mode, weight) in weights {
            row[*mode] = *weight;
        }
        row
    };
    let mut dampers: Vec<Damper> = (alone.into_iter())
        .map(|mode| Damper {
            constant: system.damping()[mode],
            row: along(&[(mode, 1.0)]),
        })
        .collect();
    if let Some(coupling) = system.coupling() {
        let symmetric = Mat::from_fn(coupled.len(), coupled.len(), |r, c| {
            let (row, column) = (coupled[r], coupled[c]);
            let own = if r == c { system.damping()[row] } else { 0.0 };
            own + 0.5 * (coupling.at(row, column) + coupling.at(column, row))
        });
        if let Ok(eigen) = symmetric_eigen(&symmetric) {
            dampers.extend((0..coupled.len()).map(|k| {
                let weights = (0..coupled.len()).map(|i| (coupled[i], eigen.vectors[(i, k)]));
                Damper {
                    constant: eigen.values[k],
                    row: along(&weights.collect::<Vec<_>>()),
                }
            }));
        }
    }
    dampers.retain(|damper| damper.constant != 0.0);
    dampers
}

/// The singular parts of a matrix, those of rounding left out.
fn circulations(matrix: &Coupling) -> Vec<Circulation> {
    let modes = matrix.modes();
    let Ok(parts) = Mat::from_fn(modes, modes, |r, c| matrix.at(r, c)).svd() else {
        return Vec::new();
    };
    let column = |of: faer::MatRef<'_, f64>, k: usize| (0..modes).map(|i| of[(i, k)]).collect();
    let felt = |k: &usize| parts.S()[*k] > f64::EPSILON * parts.S()[0];
    (0..modes)
        .filter(felt)
        .map(|k| Circulation {
            strength: parts.S()[k],
            position: column(parts.V(), k),
            rate: column(parts.U(), k),
        })
        .collect()
}

/// How the works of the phases of one spectrum are found.
#[derive(Debug, Clone)]
pub(crate) enum Meter {
    /// All are those of dampers: quadratic forms.
    Forms(Dissipation),
    /// Some are not.
    Products(Sights),
}

/// How a spectrum's motion is seen by the parts of the structure's matrices and by the loads.
#[derive(Debug, Clone)]
pub(crate) struct Sights {
    dampers: Vec<(f64, View)>,
    /// Strength, position and rate.
    circulations: Vec<(f64, View, View)>,
    channels: Vec<(usize, View)>,
    harmonics: Vec<[View; 2]>,
}

impl Meter {
    #[inline(always)]
    pub(crate) fn new<I: Instructions, L: Law>(
        problem: &Problem<L>,
        powers: &OnceCell<Powers>,
        spectrum: &Spectrum,
    ) -> Self {
        if are_dampers(problem, spectrum) {
            return Self::Forms(Dissipation::new::<I, L>(problem, powers, spectrum));
        }
        let powers = Powers::in_cell(powers, problem);
        let mut combined = Vec::new();
        let mut see = |row: &[f64]| {
            let mut view = View::default();
            view.set::<I>(spectrum, row, &mut combined);
            view
        };
        Self::Products(Sights {
            dampers: (powers.dampers.iter())
                .map(|damper| (damper.constant, see(&damper.row)))
                .collect(),
            circulations: (powers.circulations.iter())
                .map(|c| (c.strength, see(&c.position), see(&c.rate)))
                .collect(),
            channels: (powers.channels.iter())
                .map(|(number, row)| (*number, see(row)))
                .collect(),
            harmonics: (powers.harmonics.iter())
                .map(|[re, im]| [see(re), see(im)])
                .collect(),
        })
    }

    /// The works from the start of a phase to `t` after it.
    #[inline(always)]
    pub(crate) fn until<I: Instructions, L: Law>(
        &self,
        problem: &Problem<L>,
        phases: &Phases,
        phase: Phase,
        t: f64,
        work: &mut Workspace,
    ) -> Works {
        match self {
            Self::Forms(dissipation) => dissipation.until::<I>(phases, phase, t, work),
            Self::Products(sights) => sights.until::<I, L>(problem, phases, phase, t),
        }
    }
}

/// Whether all forces but those of loads that do not change are those of springs and dampers.
#[inline(always)]
fn are_dampers<L: Law>(problem: &Problem<L>, spectrum: &Spectrum) -> bool {
    if problem.system.circulatory().is_some() || problem.forcing.varies() {
        return false;
    }
    for (law, state) in problem.laws.iter().zip(&spectrum.states) {
        let piece = law.piece(*state).unwrap_or(Piece::FREE);
        let is_symmetric = (0..COORDINATES)
            .all(|i| (0..i).all(|j| piece.stiffness[i][j] == piece.stiffness[j][i]));
        let products = law.dissipation(*state);
        if !is_symmetric || products.products().iter().any(|p| damper(p).is_none()) {
            return false;
        }
    }
    true
}

/// The coordinate and the constant of a damper, if a product is the power of one.
#[inline(always)]
pub(crate) fn damper((force, rate): &(Affine, Affine)) -> Option<(usize, f64)> {
    let i = (0..COORDINATES).find(|&i| rate.velocity[i] != 0.0)?;
    let is_rate = |function: &Affine| *function == Affine::rate(i).times(function.velocity[i]);
    (is_rate(force) && is_rate(rate)).then(|| (i, force.velocity[i] * rate.velocity[i]))
}

impl Sights {
    #[inline(always)]
    fn until<I: Instructions, L: Law>(
        &self,
        problem: &Problem<L>,
        phases: &Phases,
        phase: Phase,
        t: f64,
    ) -> Works {
        let spectrum = &phases.spectra[phase.spectrum];
        let mut account = Account {
            phases,
            phase,
            t,
            products: Products::new(&spectrum.lambda, t),
        };
        let mut works = Works::none(problem.laws.len());
        for (constant, view) in &self.dampers {
            let rate = account.rate::<I>(view);
            works.modal += constant * account.product::<I>(&rate, &rate);
        }
        for (strength, position, rate) in &self.circulations {
            let position = account.signal::<I>(std::slice::from_ref(position), &POSITION);
            let rate = account.rate::<I>(rate);
            works.circulatory -= strength * account.product::<I>(&position, &rate);
        }
        works.loads = self.work_of_loads::<I>(&mut account, spectrum);
        let mut first_view = 0;
        for (index, law) in problem.laws.iter().enumerate() {
            let power = law.dissipation(phases.states(phase)[index]);
            let views = &spectrum.views[first_view..];
            works.laws[index] = account.power::<I>(views, &power);
            works.obstacles += account.of_obstacle::<I, L>(problem, index, views);
            first_view += law.rows().len();
        }
        works
    }
}

/// The combination that a view sees, as a local coordinate.
const POSITION: Affine = Affine::coordinate(0);
const RATE: Affine = Affine::rate(0);

impl Sights {
    /// A channel is a polynomial over the phase, a harmonic one more exponential.
    #[inline(always)]
    fn work_of_loads<I: Instructions>(
        &self,
        account: &mut Account<'_>,
        spectrum: &Spectrum,
    ) -> f64 {
        let Some(response) = &spectrum.response else {
            return 0.0;
        };
        let mut total = 0.0;
        let coefficients = account.phases.coefficients(account.phase);
        for (channel, view) in &self.channels {
            let from = *channel * response.stride;
            let load = Factor {
                polynomial: coefficients[from..from + response.stride].to_vec(),
                ..Factor::default()
            };
            total += account.work_of::<I>(&load, view);
        }
        for (harmonic, [re, im]) in self.harmonics.iter().enumerate() {
            let unit = account.phases.unit(account.phase, response, harmonic);
            // Re[(a + i b) z] = a Re z + b Re (i z)
            for (view, turned) in [(re, unit), (im, Complex::new(-unit.im, unit.re))] {
                let mut load = Factor {
                    amplitudes: vec![ComplexBlock::ZERO; spectrum.lambda.len()],
                    ..Factor::default()
                };
                set_entry(&mut load.amplitudes, response.at + harmonic, turned);
                total += account.work_of::<I>(&load, view);
            }
        }
        total
    }
}

/// Integrates the powers of a phase up to one instant.
struct Account<'a> {
    phases: &'a Phases,
    phase: Phase,
    t: f64,
    products: Products<'a>,
}

impl Account<'_> {
    #[inline(always)]
    fn signal<I: Instructions>(&self, views: &[View], function: &Affine) -> Signal {
        let mut signal = Signal::default();
        signal.set::<I>(self.phases, self.phase, views, function, self.t);
        signal
    }

    #[inline(always)]
    fn product<I: Instructions>(&mut self, a: &Signal, b: &Signal) -> f64 {
        let (a, b) = (
            a.factor(self.phases, self.phase),
            b.factor(self.phases, self.phase),
        );
        self.products.integral::<I>(&a, &b)
    }

    #[inline(always)]
    fn rate<I: Instructions>(&self, view: &View) -> Signal {
        self.signal::<I>(std::slice::from_ref(view), &RATE)
    }

    /// Work of a load along the combination that a view sees.
    #[inline(always)]
    fn work_of<I: Instructions>(&mut self, load: &Factor<'_>, view: &View) -> f64 {
        let rate = self.rate::<I>(view);
        let rate = rate.factor(self.phases, self.phase);
        self.products.integral::<I>(load, &rate)
    }

    /// Work of the obstacle of a law against the force that it makes.
    #[inline(always)]
    fn of_obstacle<I: Instructions, L: Law>(
        &mut self,
        problem: &Problem<L>,
        law: usize,
        views: &[View],
    ) -> f64 {
        let spectrum = &self.phases.spectra[self.phase.spectrum];
        let Some(response) = &spectrum.response else {
            return 0.0;
        };
        let state = self.phases.states(self.phase)[law];
        let piece = problem.laws[law].piece(state).filter(Piece::acts);
        let Some(piece) = piece else {
            return 0.0;
        };
        let mut work = 0.0;
        for coordinate in 0..problem.laws[law].rows().len() {
            let along = Moved { law, coordinate };
            if !problem.forcing.moved().any(|moved| moved == along) {
                continue;
            }
            let mut force = Affine::ZERO;
            force.constant = piece.constant[coordinate];
            force.position = piece.stiffness[coordinate].map(|k| -k);
            force.velocity = piece.damping[coordinate].map(|c| -c);
            let force = self.signal::<I>(views, &force);
            let rate = response.obstacle_rate(&problem.forcing, along, self.phases, self.phase);
            let force = force.factor(self.phases, self.phase);
            work += self.products.integral::<I>(&force, &rate);
        }
        work
    }

    #[inline(always)]
    fn power<I: Instructions>(&mut self, views: &[View], power: &Power) -> f64 {
        let mut total = 0.0;
        for (force, rate) in power.products() {
            let force = self.signal::<I>(views, force);
            let rate = self.signal::<I>(views, rate);
            total += self.product::<I>(&force, &rate);
        }
        total
    }
}
