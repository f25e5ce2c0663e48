//! The full model: sparse matrices on the dofs themselves, no modes.
//!
//! What the laws see, and what a run is read from, is a few *kept* dofs: the laws' rows are over
//! these, and the record holds their motion and the energies of the whole. A step costs one solve
//! with a factor that is made once, or, explicit, one product with the stiffness; what the laws do
//! is solved for on their own coordinates ([`super::one_step`]).

mod account;
mod explicit;
mod highest;
mod structure;
mod system;

pub use system::FullSystem;

use super::fixed_step::{Step, check_forces, check_step};
use super::one_step::{AlphaFamily, Laws, Motion, Scheme, SchemeName, Trace, Weights};
use super::polynomial_steps::Layout;
use super::{Observer, central_difference, check_memories, check_not_stepped, observe};
use crate::error::{Error, Place, Result, check_finite, check_length};
use crate::forcing::Forcing;
use crate::history::History;
use crate::law::Law;
use crate::problem::Problem;
use account::Account;
use explicit::CentralDifference;
use std::sync::Arc;
use structure::Body;
use system::add_product;

/// How often the observer is asked, in steps.
const STEPS_BETWEEN_OBSERVATIONS: usize = 16;

/// A structure of many dofs, with laws that see some of them.
#[derive(Debug, Clone)]
pub struct FullProblem<L> {
    /// The linear structure.
    pub system: FullSystem,
    /// Loads on all dofs.
    pub forcing: Forcing,
    /// Displacements at t = 0.
    pub displacement: Vec<f64>,
    /// Velocities at t = 0.
    pub velocity: Vec<f64>,
    /// The numbers of the dofs that are kept.
    pub kept: Vec<usize>,
    /// What is seen on these: laws, motions of their obstacles and the start; its own structure is
    /// free and has no loads.
    pub seen: Arc<Problem<L>>,
}

impl<L: Law> FullProblem<L> {
    /// Puts the parts together; `laws` and `obstacles`, which holds no loads, are over the kept
    /// dofs.
    ///
    /// # Errors
    /// When sizes do not agree, a number is not finite or the duration not positive.
    pub fn new(
        system: FullSystem,
        forcing: Forcing,
        [displacement, velocity]: [Vec<f64>; 2],
        kept: Vec<usize>,
        (laws, obstacles): (Vec<L>, Forcing),
        duration: f64,
    ) -> Result<Self> {
        let dofs = system.dofs();
        check_length("force", forcing.forces(), dofs)?;
        for (what, motion) in [("displacement", &displacement), ("velocity", &velocity)] {
            check_length(what, motion, dofs)?;
            check_finite(what, motion)?;
        }
        if kept.iter().any(|dof| *dof >= dofs) {
            return Err(Error::Sizes {
                what: "the kept dofs and the matrices",
            });
        }
        let part = |whole: &[f64]| kept.iter().map(|dof| whole[*dof]).collect::<Vec<f64>>();
        let free = crate::system::ModalSystem::new(vec![0.0; kept.len()], vec![0.0; kept.len()])?;
        let (q, v) = (part(&displacement), part(&velocity));
        let seen = Arc::new(Problem::new(free, laws, obstacles, q, v, duration)?);
        Ok(Self {
            system,
            forcing,
            displacement,
            velocity,
            kept,
            seen,
        })
    }
}

/// A scheme for the full model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FullScheme {
    /// Newmark's, that of Hilber, Hughes and Taylor, or generalised alpha.
    Implicit(SchemeName),
    /// The central difference, for a diagonal mass matrix; see [`explicit`].
    CentralDifference,
}

impl FullScheme {
    /// The method's name.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Implicit(scheme) => scheme.name(),
            Self::CentralDifference => central_difference::NAME,
        }
    }

    /// Largest stable step, in s, with the laws in their stiffest states; infinite without one.
    ///
    /// # Errors
    /// [`Error::Memory`], [`Error::SingularMass`] and those of the matrices.
    pub fn stability_limit<L: Law>(&self, problem: &FullProblem<L>) -> Result<f64> {
        match self {
            Self::CentralDifference => explicit::stability_limit(problem),
            Self::Implicit(scheme) => {
                let turn = scheme.largest_turn();
                if turn.is_infinite() {
                    return Ok(turn);
                }
                Ok(turn / highest::with_laws(problem)?.sqrt())
            }
        }
    }
}

/// Runs a problem.
///
/// # Errors
/// See [`Error`].
pub fn simulate<L: Law>(
    problem: &FullProblem<L>,
    scheme: FullScheme,
    step: Step,
    observer: Observer<'_>,
) -> Result<History<L>> {
    let (name, seen, h) = (scheme.name(), &problem.seen, step.dt);
    let mut trace = Trace::new(seen, Layout::told(seen), h)?;
    check_forces(name, &seen.laws)?;
    check_memories(name, &seen.laws)?;
    check_not_stepped(name, &seen.laws)?;
    let limit = scheme.stability_limit(problem)?;
    check_step(name, step, limit)?;
    trace.know_limit(limit);
    let trace = match scheme {
        FullScheme::CentralDifference => run(
            problem,
            CentralDifference::new(problem, h)?,
            trace,
            observer,
        ),
        FullScheme::Implicit(scheme) => {
            let weights = scheme.weights()?;
            run(problem, family(problem, weights, h)?, trace, observer)
        }
    }?;
    let (record, events) = trace.done();
    Ok(History::of_polynomials(seen, name, record, events))
}

/// A scheme of Newmark's family, with the matrix of its step factored.
fn family<L: Law>(
    problem: &FullProblem<L>,
    weights: Weights,
    h: f64,
) -> Result<AlphaFamily<Body<'_, L>>> {
    let body = Body::new(problem, weights.matrix(h))?;
    AlphaFamily::new(body, &problem.seen.laws, weights, h)
}

/// Says which dof has most of the kinetic energy of a motion that blew up.
fn placed<L>(error: Error, problem: &FullProblem<L>, motion: &Motion) -> Error {
    let Error::BlowUp { time, ratio, .. } = error else {
        return error;
    };
    let mut momentum = vec![0.0; motion.v.len()];
    add_product(&problem.system.mass, 1.0, &motion.v, &mut momentum);
    let shares = momentum.iter().zip(&motion.v).map(|(p, v)| p * v);
    let most = shares.enumerate().max_by(|(_, a), (_, b)| a.total_cmp(b));
    let place = most.map(|(dof, _)| Place::Dof(dof));
    Error::BlowUp { time, ratio, place }
}

/// Steps from t = 0 to the end.
fn run<'a, L: Law>(
    problem: &FullProblem<L>,
    mut scheme: impl Scheme<L>,
    mut trace: Trace<'a, L>,
    observer: Observer<'_>,
) -> Result<Trace<'a, L>> {
    let mut laws = Laws::new(&problem.seen);
    let mut motion = Motion {
        q: problem.displacement.clone(),
        v: problem.velocity.clone(),
        a: structure::initial_acceleration(problem, &laws)?,
    };
    let mut account = Account::new(problem, trace.h(), &motion);
    trace.begin_at(&account, &laws);
    for n in 0..trace.steps() {
        let span = [n, n + 1].map(|n| n as f64 * trace.h());
        if n.is_multiple_of(STEPS_BETWEEN_OBSERVATIONS) {
            observe(observer, span[0])?;
        }
        scheme.step(span, &mut motion, &mut laws)?;
        if !motion.q.iter().chain(&motion.v).all(|x| x.is_finite()) {
            return Err(Error::Overflow { time: span[1] });
        }
        account.go_on(span[1], &motion);
        (trace.add(span, &account, &laws)).map_err(|error| placed(error, problem, &motion))?;
    }
    Ok(trace)
}
