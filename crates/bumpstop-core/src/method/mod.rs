//! Methods: how a problem is carried through time. One file a method.

pub mod adaptive;
pub mod central_difference;
pub mod fixed_step;
pub mod full;
pub(crate) mod instant;
pub mod one_step;
pub mod piecewise_linear;
pub mod polynomial_steps;
mod scale;
pub mod symplectic_euler;

use crate::error::{Error, Result};
use crate::history::History;
use crate::law::{Law, State};
use crate::problem::Problem;
use crate::system::ModalSystem;
use std::sync::Arc;

/// A method and its options.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Method {
    /// Closed-form phases between located events; no step.
    Exact,
    /// Semi-implicit Euler, first order.
    SymplecticEuler(fixed_step::Step),
    /// Central difference, second order.
    CentralDifference(fixed_step::Step),
    /// A classical scheme of one step.
    OneStep(one_step::SchemeName, fixed_step::Step),
    /// A method whose steps follow the motion, with located switches.
    Adaptive(adaptive::Adaptive),
}

impl Method {
    /// The method's name.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::SymplecticEuler(_) => "symplectic_euler",
            Self::CentralDifference(_) => "central_difference",
            Self::OneStep(scheme, _) => scheme.name(),
            Self::Adaptive(method) => method.name(),
        }
    }
}

/// Is told the time reached now and then; answers whether to go on.
pub type Observer<'a> = &'a mut dyn FnMut(f64) -> bool;

/// Carries a problem from t = 0 to its duration.
///
/// # Errors
/// See [`Error`]; the observer's refusal gives [`Error::Interrupted`].
pub fn simulate<L: Law>(
    problem: &Arc<Problem<L>>,
    method: Method,
    observer: Observer<'_>,
) -> Result<History<L>> {
    if !matches!(method, Method::Adaptive(_)) {
        check_steady(method.name(), &problem.system)?;
    }
    match method {
        Method::Exact => {
            check_rigid_friction(method.name(), &problem.laws)?;
            scale::check(problem)?;
            piecewise_linear::simulate(problem, observer)
        }
        Method::SymplecticEuler(step) => symplectic_euler::simulate(problem, step, observer),
        Method::CentralDifference(step) => central_difference::simulate(problem, step, observer),
        Method::OneStep(scheme, step) => one_step::simulate(problem, scheme, step, observer),
        Method::Adaptive(method) => adaptive::simulate(problem, method, observer),
    }
}

/// Refuses shafts whose speed changes, for methods whose matrices must not.
pub(crate) fn check_steady(method: &'static str, system: &ModalSystem) -> Result<()> {
    if system.rotations().is_empty() {
        Ok(())
    } else {
        Err(Error::SpeedChanges { method })
    }
}

/// Refuses laws with smooth states, for methods that go by matrices.
pub(crate) fn check_linear<L: Law>(method: &'static str, laws: &[L]) -> Result<()> {
    match laws.iter().position(|law| !law.is_piecewise_linear()) {
        Some(law) => Err(Error::Smooth { method, law }),
        None => Ok(()),
    }
}

/// Refuses rigid stops that rub: at an impact the exact method knows normal impulses alone.
fn check_rigid_friction<L: Law>(method: &'static str, laws: &[L]) -> Result<()> {
    match laws.iter().position(|law| law.rigid_friction() > 0.0) {
        Some(law) => Err(Error::RigidFriction { method, law }),
        None => Ok(()),
    }
}

/// Refuses laws whose memory follows rate equations: the schemes are for equations of motion.
pub(crate) fn check_memories<L: Law>(method: &'static str, laws: &[L]) -> Result<()> {
    match laws.iter().position(Law::flows) {
        Some(law) => Err(Error::FlowingMemory { method, law }),
        None => Ok(()),
    }
}

/// Refuses laws whose memory follows rate equations and rules when they switch: steps see switches
/// at their ends alone.
pub(crate) fn check_flows<L: Law>(method: &'static str, laws: &[L]) -> Result<()> {
    let ruled = |law: &L| law.flows() && law.guard_count(State::FIRST) > 0;
    match laws.iter().position(ruled) {
        Some(law) => Err(Error::FlowingMemory { method, law }),
        None => Ok(()),
    }
}

/// Refuses laws that must be asked once a step, for methods that ask more often.
pub(crate) fn check_not_stepped<L: Law>(method: &'static str, laws: &[L]) -> Result<()> {
    match laws.iter().position(Law::is_stepped) {
        Some(law) => Err(Error::Stepped { method, law }),
        None => Ok(()),
    }
}

/// Asks the observer; its refusal becomes an error.
pub(crate) fn observe(observer: &mut dyn FnMut(f64) -> bool, time: f64) -> Result<()> {
    if observer(time) {
        Ok(())
    } else {
        Err(Error::Interrupted { time })
    }
}
