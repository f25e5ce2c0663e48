//! Running a problem.

use crate::core_error;
use crate::history::{History, StateParts};
use crate::parts::{Forcing, LawPart, System, values};
use bumpstop_core::error::{Error, Result};
use bumpstop_core::history;
use bumpstop_core::law::{AnyLaw, State};
use bumpstop_core::method::adaptive::{self, Adaptive, PairName, Resolution, Tolerances};
use bumpstop_core::method::fixed_step::Step;
use bumpstop_core::method::one_step::{
    GeneralizedAlpha, Hht, MoreauJean, Newmark, SchemeName, devogelaere, exponential,
    generalized_alpha, hht, moreau_jean, newmark, trbdf2,
};
use bumpstop_core::method::{self, Method, Observer, central_difference, symplectic_euler};
use bumpstop_core::problem::Problem;
use numpy::PyReadonlyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::collections::HashMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How often progress is told and interrupts are looked for.
const BETWEEN_REPORTS: Duration = Duration::from_millis(100);

/// Parameters of a scheme, by name.
pub(crate) type Parameters = HashMap<String, f64>;

/// Integrates a problem; releases the GIL.
#[pyfunction]
#[pyo3(signature = (system, laws, forcing, displacement, velocity, duration, method, dt=None,
                    beyond_stability_limit=false, tolerances=None, parameters=None, progress=None,
                    exact_flights=true, states=None))]
#[allow(clippy::too_many_arguments)] // mirrors the Python signature
pub fn simulate(
    py: Python<'_>,
    system: &System,
    laws: Vec<LawPart<'_>>,
    forcing: &Forcing,
    displacement: PyReadonlyArray1<f64>,
    velocity: PyReadonlyArray1<f64>,
    duration: f64,
    method: &str,
    dt: Option<f64>,
    beyond_stability_limit: bool,
    tolerances: Option<(f64, Option<f64>)>,
    parameters: Option<Parameters>,
    progress: Option<Py<PyAny>>,
    exact_flights: bool,
    states: Option<Vec<StateParts>>,
) -> PyResult<History> {
    let parameters = parameters.unwrap_or_default();
    let tolerances = tolerances.map(|(relative, absolute)| Tolerances {
        relative,
        absolute,
        exact_flights,
    });
    let method = method_named(method, dt, beyond_stability_limit, tolerances, &parameters)?;
    let problem = Problem::new(
        system.0.clone(),
        laws.iter().map(LawPart::law).collect(),
        forcing.0.clone(),
        values(&displacement),
        values(&velocity),
        duration,
    )
    .and_then(|problem| match states {
        Some(states) => problem.with_states(states.into_iter().map(state).collect()),
        None => Ok(problem),
    })
    .map(Arc::new)
    .map_err(core_error)?;
    let solved = timed(py, Reporter::new(progress, duration), |observer| {
        method::simulate(&problem, method, observer)
    });
    // What Python code went wrong with says more than what the core made of it.
    match laws.iter().find_map(LawPart::raised) {
        Some(raised) => Err(raised),
        None => solved,
    }
}

fn state((number, part, first, second): StateParts) -> State {
    State {
        number,
        part,
        memory: [first, second],
    }
}

/// Runs something without the GIL, with its time, and with what the reporter says.
pub(crate) fn timed(
    py: Python<'_>,
    mut reporter: Reporter,
    run: impl FnOnce(Observer<'_>) -> Result<history::History<AnyLaw>> + Send,
) -> PyResult<History> {
    let (solved, seconds) = py.detach(|| {
        let start = Instant::now();
        let solved = run(&mut |time| reporter.report(time));
        (solved, start.elapsed().as_secs_f64())
    });
    match (solved, reporter.raised) {
        (Ok(history), _) => Ok(History::new(history, seconds)),
        (Err(Error::Interrupted { .. }), Some(raised)) => Err(raised),
        (Err(error), _) => Err(core_error(error)),
    }
}

/// Largest stable step of a fixed-step method, in s; infinite where every step is stable.
#[pyfunction]
#[pyo3(signature = (system, laws, method, parameters=None))]
#[allow(clippy::needless_pass_by_value)] // what pyo3 converts to
pub fn stability_limit(
    system: &System,
    laws: Vec<LawPart<'_>>,
    method: &str,
    parameters: Option<Parameters>,
) -> PyResult<f64> {
    let laws: Vec<_> = laws.iter().map(LawPart::law).collect();
    if let Some(scheme) = scheme_named(method, &parameters.unwrap_or_default()) {
        scheme.check().map_err(core_error)?;
        return Ok(scheme.stability_limit(&system.0, &laws));
    }
    match method {
        symplectic_euler::NAME => Ok(symplectic_euler::stability_limit(&system.0, &laws)),
        central_difference::NAME => Ok(central_difference::stability_limit(&system.0, &laws)),
        _ => Err(PyValueError::new_err(format!(
            "no fixed-step method '{method}'"
        ))),
    }
}

/// The classical scheme of a name, with its usual parameters where none are given.
pub(crate) fn scheme_named(name: &str, parameters: &Parameters) -> Option<SchemeName> {
    let given = |name: &str, usual: f64| parameters.get(name).copied().unwrap_or(usual);
    let scheme = match name {
        newmark::NAME => {
            let usual = Newmark::default();
            SchemeName::Newmark(Newmark {
                beta: given("beta", usual.beta),
                gamma: given("gamma", usual.gamma),
            })
        }
        hht::NAME => SchemeName::Hht(Hht {
            alpha: given("alpha", Hht::default().alpha),
        }),
        generalized_alpha::NAME => {
            let usual = GeneralizedAlpha::default().spectral_radius;
            SchemeName::GeneralizedAlpha(GeneralizedAlpha {
                spectral_radius: given("spectral_radius", usual),
            })
        }
        trbdf2::NAME => SchemeName::TrBdf2,
        devogelaere::NAME => SchemeName::DeVogelaere,
        exponential::NAME => SchemeName::Exponential,
        moreau_jean::NAME => SchemeName::MoreauJean(MoreauJean {
            theta: given("theta", MoreauJean::default().theta),
        }),
        _ => return None,
    };
    Some(scheme)
}

fn method_named(
    name: &str,
    dt: Option<f64>,
    beyond_stability_limit: bool,
    tolerances: Option<Tolerances>,
    parameters: &Parameters,
) -> PyResult<Method> {
    let step = || {
        dt.map(|dt| Step {
            dt,
            beyond_stability_limit,
        })
        .ok_or_else(|| PyValueError::new_err(format!("method '{name}' needs dt")))
    };
    let pair = PairName::ALL.into_iter().find(|pair| pair.name() == name);
    if pair.is_some() || name == adaptive::exponential::NAME {
        let tolerances = tolerances
            .ok_or_else(|| PyValueError::new_err(format!("method '{name}' needs tolerances")))?;
        return Ok(Method::Adaptive(match pair {
            Some(pair) => Adaptive::RungeKutta(pair, tolerances),
            None => Adaptive::Exponential(tolerances),
        }));
    }
    if name == adaptive::central_difference::NAME {
        let mut resolution = Resolution::default();
        if let Some(points) = parameters.get("points_per_period") {
            resolution.points_per_period = *points;
        }
        return Ok(Method::Adaptive(Adaptive::CentralDifference(resolution)));
    }
    if let Some(scheme) = scheme_named(name, parameters) {
        return Ok(Method::OneStep(scheme, step()?));
    }
    match name {
        "exact" => Ok(Method::Exact),
        symplectic_euler::NAME => Ok(Method::SymplecticEuler(step()?)),
        central_difference::NAME => Ok(Method::CentralDifference(step()?)),
        _ => Err(PyValueError::new_err(format!("no method '{name}'"))),
    }
}

/// Tells Python how far a run, or a batch of them, is, and hears Ctrl-C, ten times a second.
pub(crate) struct Reporter {
    progress: Option<Py<PyAny>>,
    whole: f64,
    last: Instant,
    pub(crate) raised: Option<PyErr>,
}

impl Reporter {
    pub(crate) fn new(progress: Option<Py<PyAny>>, whole: f64) -> Self {
        Self {
            progress,
            whole,
            last: Instant::now(),
            raised: None,
        }
    }

    pub(crate) fn report(&mut self, reached: f64) -> bool {
        if self.last.elapsed() < BETWEEN_REPORTS {
            return true;
        }
        self.last = Instant::now();
        let told = Python::attach(|py| {
            py.check_signals()?;
            match &self.progress {
                Some(progress) => progress.call1(py, (reached / self.whole,)).map(drop),
                None => Ok(()),
            }
        });
        self.raised = told.err();
        self.raised.is_none()
    }
}
