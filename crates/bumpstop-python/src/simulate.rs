//! Running a problem.

use crate::core_error;
use crate::history::History;
use crate::parts::{Forcing, LawPart, System, values};
use bumpstop_core::error::Error;
use bumpstop_core::method::adaptive::{PairName, Tolerances};
use bumpstop_core::method::fixed_step::Step;
use bumpstop_core::method::{self, Method, central_difference, symplectic_euler};
use bumpstop_core::problem::Problem;
use numpy::PyReadonlyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How often progress is told and interrupts are looked for.
const BETWEEN_REPORTS: Duration = Duration::from_millis(100);

/// Integrates a problem; releases the GIL.
#[pyfunction]
#[pyo3(signature = (system, laws, forcing, displacement, velocity, duration, method, dt=None,
                    beyond_stability_limit=false, tolerances=None, progress=None))]
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
    progress: Option<Py<PyAny>>,
) -> PyResult<History> {
    let method = method_named(method, dt, beyond_stability_limit, tolerances)?;
    let problem = Problem::new(
        system.0.clone(),
        laws.iter().map(LawPart::law).collect(),
        forcing.0.clone(),
        values(&displacement),
        values(&velocity),
        duration,
    )
    .map(Arc::new)
    .map_err(core_error)?;
    let mut reporter = Reporter::new(progress, duration);
    let (solved, seconds) = py.detach(|| {
        let start = Instant::now();
        let solved = method::simulate(&problem, method, &mut |time| reporter.report(time));
        (solved, start.elapsed().as_secs_f64())
    });
    match (solved, reporter.raised) {
        (Ok(history), _) => Ok(History::new(history, seconds)),
        (Err(Error::Interrupted { .. }), Some(raised)) => Err(raised),
        (Err(error), _) => Err(core_error(error)),
    }
}

/// Largest stable step of a fixed-step method, in s.
#[pyfunction]
pub fn stability_limit(system: &System, laws: Vec<LawPart<'_>>, method: &str) -> PyResult<f64> {
    let laws: Vec<_> = laws.iter().map(LawPart::law).collect();
    match method {
        symplectic_euler::NAME => Ok(symplectic_euler::stability_limit(&system.0, &laws)),
        central_difference::NAME => Ok(central_difference::stability_limit(&system.0, &laws)),
        _ => Err(PyValueError::new_err(format!(
            "no fixed-step method '{method}'"
        ))),
    }
}

fn method_named(
    name: &str,
    dt: Option<f64>,
    beyond_stability_limit: bool,
    tolerances: Option<(f64, Option<f64>)>,
) -> PyResult<Method> {
    let step = || {
        dt.map(|dt| Step {
            dt,
            beyond_stability_limit,
        })
        .ok_or_else(|| PyValueError::new_err(format!("method '{name}' needs dt")))
    };
    let adaptive = PairName::ALL.into_iter().find(|pair| pair.name() == name);
    if let Some(pair) = adaptive {
        let (relative, absolute) = tolerances
            .ok_or_else(|| PyValueError::new_err(format!("method '{name}' needs tolerances")))?;
        return Ok(Method::Adaptive(pair, Tolerances { relative, absolute }));
    }
    match name {
        "exact" => Ok(Method::Exact),
        symplectic_euler::NAME => Ok(Method::SymplecticEuler(step()?)),
        central_difference::NAME => Ok(Method::CentralDifference(step()?)),
        _ => Err(PyValueError::new_err(format!("no method '{name}'"))),
    }
}

/// Tells Python how far the run is, and hears Ctrl-C, ten times a second.
struct Reporter {
    progress: Option<Py<PyAny>>,
    duration: f64,
    last: Instant,
    raised: Option<PyErr>,
}

impl Reporter {
    fn new(progress: Option<Py<PyAny>>, duration: f64) -> Self {
        Self {
            progress,
            duration,
            last: Instant::now(),
            raised: None,
        }
    }

    fn report(&mut self, time: f64) -> bool {
        if self.last.elapsed() < BETWEEN_REPORTS {
            return true;
        }
        self.last = Instant::now();
        let told = Python::attach(|py| {
            py.check_signals()?;
            match &self.progress {
                Some(progress) => progress.call1(py, (time / self.duration,)).map(drop),
                None => Ok(()),
            }
        });
        self.raised = told.err();
        self.raised.is_none()
    }
}
