//! The classical schemes of one step and of a fixed width.
//!
//! Each carries modal displacements, velocities and accelerations from one end of a step to the
//! other ([`Scheme`], one file a scheme). The forces of the laws are found where they act, so that
//! no law asks for steps of its own ([`laws`]); states switch at the ends of steps. The step is kept
//! as a cubic in time, on which the instant of a switch is found afterwards ([`trace`]).

mod alpha_family;
pub mod devogelaere;
mod elimination;
pub mod exponential;
pub mod generalized_alpha;
pub mod hht;
mod impulses;
mod laws;
pub mod moreau_jean;
pub mod newmark;
mod structure;
mod trace;
pub mod trbdf2;

pub(crate) use alpha_family::{AlphaFamily, Weights};
pub(crate) use laws::{Laws, Pushes, rows};
pub(crate) use structure::{Structure, each_scaled};
pub(crate) use trace::{End, Trace};

pub use generalized_alpha::GeneralizedAlpha;
pub use hht::Hht;
pub use moreau_jean::MoreauJean;
pub use newmark::Newmark;

use super::fixed_step::{Step, check_forces, check_step, check_uncoupled, highest_frequency};
use super::polynomial_steps::Layout;
use super::{Observer, check_memories, check_not_stepped, observe};
use crate::error::{Error, Result};
use crate::history::History;
use crate::law::Law;
use crate::problem::Problem;
use crate::system::ModalSystem;
use std::sync::Arc;
use structure::Modes;

/// How often the observer is asked, in steps.
const STEPS_BETWEEN_OBSERVATIONS: usize = 256;

/// A scheme with its parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SchemeName {
    /// See [`newmark`].
    Newmark(Newmark),
    /// See [`hht`].
    Hht(Hht),
    /// See [`generalized_alpha`].
    GeneralizedAlpha(GeneralizedAlpha),
    /// See [`trbdf2`].
    TrBdf2,
    /// See [`devogelaere`].
    DeVogelaere,
    /// See [`exponential`].
    Exponential,
    /// See [`moreau_jean`].
    MoreauJean(MoreauJean),
}

impl SchemeName {
    /// The method's name.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Newmark(_) => newmark::NAME,
            Self::Hht(_) => hht::NAME,
            Self::GeneralizedAlpha(_) => generalized_alpha::NAME,
            Self::TrBdf2 => trbdf2::NAME,
            Self::DeVogelaere => devogelaere::NAME,
            Self::Exponential => exponential::NAME,
            Self::MoreauJean(_) => moreau_jean::NAME,
        }
    }

    /// Largest stable step, in s, with the laws in their stiffest states; infinite without one.
    pub fn stability_limit<L: Law>(&self, system: &ModalSystem, laws: &[L]) -> f64 {
        match self {
            Self::Newmark(newmark) => newmark.limit() / highest_frequency(system, laws),
            Self::DeVogelaere => devogelaere::stability_limit(system, laws),
            Self::Exponential => exponential::stability_limit(system, laws),
            Self::Hht(_) | Self::GeneralizedAlpha(_) | Self::TrBdf2 | Self::MoreauJean(_) => {
                f64::INFINITY
            }
        }
    }

    /// Refuses parameters out of range.
    ///
    /// # Errors
    /// [`Error::Parameter`]
    pub fn check(&self) -> Result<()> {
        match self {
            Self::Newmark(newmark) => newmark.weights().map(drop),
            Self::Hht(hht) => hht.weights().map(drop),
            Self::GeneralizedAlpha(alpha) => alpha.weights().map(drop),
            Self::MoreauJean(scheme) => scheme.check(),
            Self::TrBdf2 | Self::DeVogelaere | Self::Exponential => Ok(()),
        }
    }

    /// The weights of a scheme of Newmark's family.
    ///
    /// # Errors
    /// [`Error::Parameter`], and [`Error::NotInFamily`] for other schemes.
    pub(crate) fn weights(&self) -> Result<Weights> {
        match self {
            Self::Newmark(newmark) => newmark.weights(),
            Self::Hht(hht) => hht.weights(),
            Self::GeneralizedAlpha(alpha) => alpha.weights(),
            Self::TrBdf2 | Self::DeVogelaere | Self::Exponential | Self::MoreauJean(_) => {
                Err(Error::NotInFamily {
                    method: self.name(),
                })
            }
        }
    }

    /// The angle by which the highest undamped frequency may turn in a step.
    pub(crate) fn largest_turn(&self) -> f64 {
        match self {
            Self::Newmark(newmark) => newmark.limit(),
            _ => f64::INFINITY,
        }
    }

    /// Whether each mode is carried by itself.
    fn goes_mode_by_mode(&self) -> bool {
        matches!(self, Self::DeVogelaere | Self::Exponential)
    }
}

/// Modal displacements, velocities and accelerations at one instant.
#[derive(Debug, Clone)]
pub(crate) struct Motion {
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    pub a: Vec<f64>,
}

/// A scheme for one problem and step.
pub(crate) trait Scheme<L: Law> {
    /// Carries the motion and the laws from the start of a step to its end.
    fn step(&mut self, span: [f64; 2], motion: &mut Motion, laws: &mut Laws<'_, L>) -> Result<()>;
}

/// Runs a problem.
///
/// # Errors
/// See [`Error`].
pub fn simulate<L: Law>(
    problem: &Arc<Problem<L>>,
    scheme: SchemeName,
    step: Step,
    observer: Observer<'_>,
) -> Result<History<L>> {
    let (name, h) = (scheme.name(), step.dt);
    let mut trace = Trace::new(problem, Layout::new(problem), h)?;
    scheme.check()?;
    if !matches!(scheme, SchemeName::MoreauJean(_)) {
        check_forces(name, &problem.laws)?;
    }
    check_memories(name, &problem.laws)?;
    check_not_stepped(name, &problem.laws)?;
    if scheme.goes_mode_by_mode() {
        check_uncoupled(name, &problem.system)?;
    }
    let limit = scheme.stability_limit(&problem.system, &problem.laws);
    check_step(name, step, limit)?;
    trace.know_limit(limit);
    let in_family = |weights: Weights| {
        let modes = Modes::new(problem, weights.matrix(h))?;
        AlphaFamily::new(modes, &problem.laws, weights, h)
    };
    let trace = match scheme {
        SchemeName::Newmark(newmark) => run(in_family(newmark.weights()?)?, trace, observer),
        SchemeName::Hht(hht) => run(in_family(hht.weights()?)?, trace, observer),
        SchemeName::GeneralizedAlpha(alpha) => run(in_family(alpha.weights()?)?, trace, observer),
        SchemeName::MoreauJean(scheme) => moreau_jean::run(problem, scheme, trace, observer),
        SchemeName::TrBdf2 => run(trbdf2::TrBdf2::new(problem, h)?, trace, observer),
        SchemeName::DeVogelaere => run(devogelaere::DeVogelaere::new(problem, h)?, trace, observer),
        SchemeName::Exponential => run(exponential::Exponential::new(problem, h), trace, observer),
    }?;
    let (record, events) = trace.done();
    Ok(History::of_polynomials(problem, name, record, events))
}

/// Refuses a motion that left the range of numbers.
fn finite(motion: &Motion, time: f64) -> Result<()> {
    if motion.q.iter().chain(&motion.v).all(|x| x.is_finite()) {
        Ok(())
    } else {
        Err(Error::Overflow { time })
    }
}

/// Steps from t = 0 to the end.
fn run<'a, L: Law>(
    mut scheme: impl Scheme<L>,
    mut trace: Trace<'a, L>,
    observer: Observer<'_>,
) -> Result<Trace<'a, L>> {
    let mut laws = Laws::new(trace.problem());
    let mut motion = trace.begin(&laws);
    for n in 0..trace.steps() {
        let span = [n, n + 1].map(|n| n as f64 * trace.h());
        if n.is_multiple_of(STEPS_BETWEEN_OBSERVATIONS) {
            observe(observer, span[0])?;
        }
        scheme.step(span, &mut motion, &mut laws)?;
        finite(&motion, span[1])?;
        trace.add(span, &motion, &laws)?;
    }
    Ok(trace)
}
