//! Many runs of one problem.

use crate::core_error;
use crate::history::derivative_numbered;
use crate::parts::{Forcing, LawPart, System, values};
use crate::simulate::Reporter;
use bumpstop_core::batch::{
    self as core, EnergyTerm, Failure, ImpactColumn, LawMotion, OfRun, Parameters, Pick, Start,
    StopNumber, StopValues,
};
use bumpstop_core::error::Error;
use bumpstop_core::problem::Problem;
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray2, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

type Column<'py> = PyReadonlyArray1<'py, f64>;
/// The numbers of each run, and the failed ones with their messages.
type Found<'py> = (Bound<'py, PyArray2<f64>>, Vec<(usize, String)>);

/// Something that is kept of each run of a batch.
#[pyclass(frozen, module = "bumpstop._core")]
pub struct Quantity(core::Quantity);

#[pymethods]
impl Quantity {
    /// A derivative (0, 1 or 2) of `row . q` at some instants.
    #[staticmethod]
    #[allow(clippy::needless_pass_by_value)] // what pyo3 converts to
    fn motion(row: Column<'_>, derivative: usize, times: Column<'_>) -> PyResult<Self> {
        Ok(Self(core::Quantity::Motion {
            row: values(&row),
            derivative: derivative_numbered(derivative)?,
            times: values(&times),
        }))
    }

    /// Distance, rate or force of a law at some instants.
    #[staticmethod]
    #[allow(clippy::needless_pass_by_value)] // what pyo3 converts to
    fn law(law: usize, what: &str, times: Column<'_>) -> PyResult<Self> {
        let motion = match what {
            "distance" => LawMotion::Distance,
            "rate" => LawMotion::Rate,
            "force" => LawMotion::Force,
            _ => return Err(unknown("motion of a law", what)),
        };
        let times = values(&times);
        Ok(Self(core::Quantity::Law { law, motion, times }))
    }

    /// A term of the energy ledger at some instants.
    #[staticmethod]
    #[allow(clippy::needless_pass_by_value)] // what pyo3 converts to
    fn energy(term: &str, times: Column<'_>) -> PyResult<Self> {
        let term = match term {
            "kinetic" => EnergyTerm::Kinetic,
            "elastic" => EnergyTerm::Elastic,
            "stored" => EnergyTerm::Stored,
            "dissipated_damping" => EnergyTerm::ModalDissipation,
            "dissipated_stops" => EnergyTerm::LawDissipation,
            "load_work" => EnergyTerm::LoadWork,
            "circulatory_work" => EnergyTerm::CirculatoryWork,
            "obstacle_work" => EnergyTerm::ObstacleWork,
            _ => return Err(unknown("energy", term)),
        };
        let times = values(&times);
        Ok(Self(core::Quantity::Energy { term, times }))
    }

    /// An extreme value of a quantity of time, whose instants are samples.
    #[staticmethod]
    fn extreme(of: &Self, statistic: &str) -> PyResult<Self> {
        if of.0.times().is_empty() {
            return Err(PyValueError::new_err("no samples to look between"));
        }
        let (of, pick) = (Box::new(of.0.clone()), extreme(statistic)?);
        Ok(Self(core::Quantity::Extreme { of, pick }))
    }

    /// A number of one impact, counted from 0, or a statistic of those of all.
    #[staticmethod]
    #[pyo3(signature = (law, column, statistic=None, impact=0))]
    fn impacts(law: usize, column: &str, statistic: Option<&str>, impact: usize) -> PyResult<Self> {
        let pick = match statistic {
            None => Pick::Number(impact),
            Some("last") => Pick::Last,
            Some(other) => extreme(other)?,
        };
        let column = impact_column(column)?;
        Ok(Self(core::Quantity::Impacts { law, column, pick }))
    }

    /// A number of each of the last impacts; NaN in front where there are fewer.
    #[staticmethod]
    fn last_impacts(law: usize, column: &str, count: usize) -> PyResult<Self> {
        let column = impact_column(column)?;
        Ok(Self(core::Quantity::LastImpacts { law, column, count }))
    }

    /// The largest force of a law; NaN where it never pushes.
    #[staticmethod]
    fn largest_force(law: usize) -> Self {
        Self(core::Quantity::LargestForce { law })
    }

    /// How many impacts there are on a law, or on all.
    #[staticmethod]
    #[pyo3(signature = (law=None))]
    fn impact_count(law: Option<usize>) -> Self {
        Self(core::Quantity::ImpactCount { law })
    }

    /// A number of the whole run.
    #[staticmethod]
    fn of_run(name: &str) -> PyResult<Self> {
        let number = match name {
            "events" => OfRun::Events,
            "steps" => OfRun::Steps,
            "energy_residual" => OfRun::EnergyResidual,
            "motion_error" => OfRun::MotionError,
            "missed_penetration" => OfRun::MissedPenetration,
            _ => return Err(unknown("number of a run", name)),
        };
        Ok(Self(core::Quantity::OfRun(number)))
    }
}

fn extreme(statistic: &str) -> PyResult<Pick> {
    Ok(match statistic {
        "maximum" => Pick::Largest,
        "minimum" => Pick::Smallest,
        "peak" => Pick::Peak,
        _ => return Err(unknown("statistic", statistic)),
    })
}

fn impact_column(name: &str) -> PyResult<ImpactColumn> {
    Ok(match name {
        "start" => ImpactColumn::Start,
        "end" => ImpactColumn::End,
        "duration" => ImpactColumn::Duration,
        "closing_speed" => ImpactColumn::ClosingSpeed,
        "opening_speed" => ImpactColumn::OpeningSpeed,
        "peak_force" => ImpactColumn::PeakForce,
        "peak_time" => ImpactColumn::PeakTime,
        "impulse" => ImpactColumn::Impulse,
        "energy_returned" => ImpactColumn::EnergyReturned,
        _ => return Err(unknown("number of an impact", name)),
    })
}

fn unknown(what: &str, name: &str) -> PyErr {
    PyValueError::new_err(format!("no {what} '{name}'"))
}

/// Makes many runs by the exact method, in chains perhaps; releases the GIL. Returns the numbers of
/// each run, (run, number), and those runs that failed with their messages.
#[pyfunction]
#[pyo3(signature = (system, laws, forcing, displacement, velocity, duration, quantities, runs,
                    stops, displacements=None, velocities=None, loads=None, pace=None, chain=1,
                    lanes=false, threads=1, progress=None))]
#[allow(clippy::too_many_arguments)] // mirrors the Python signature
#[allow(clippy::needless_pass_by_value)] // what pyo3 converts to
pub fn batch<'py>(
    py: Python<'py>,
    system: &System,
    laws: Vec<LawPart<'_>>,
    forcing: &Forcing,
    displacement: Column<'_>,
    velocity: Column<'_>,
    duration: f64,
    quantities: Vec<PyRef<'_, Quantity>>,
    runs: usize,
    stops: Vec<(usize, String, Column<'_>)>,
    displacements: Option<(bool, Column<'_>)>,
    velocities: Option<(bool, Column<'_>)>,
    loads: Option<Column<'_>>,
    pace: Option<Column<'_>>,
    chain: usize,
    lanes: bool,
    threads: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Found<'py>> {
    let problem = Problem::new(
        system.0.clone(),
        laws.iter().map(LawPart::law).collect(),
        forcing.0.clone(),
        values(&displacement),
        values(&velocity),
        duration,
    );
    let kept = quantities.iter().map(|quantity| quantity.0.clone());
    let batch = problem.and_then(|problem| core::Batch::new(problem, kept.collect()));
    let batch = batch.map_err(core_error)?;
    let batch = if lanes { batch.in_lanes() } else { batch };
    let parameters = Parameters {
        runs,
        stops: stop_values(&stops)?,
        displacement: start(displacements.as_ref())?,
        velocity: start(velocities.as_ref())?,
        loads: factors(loads.as_ref())?,
        pace: factors(pace.as_ref())?,
        chain,
    };
    let mut found = Array2::zeros((runs, batch.width()));
    let mut reporter = Reporter::new(progress, runs as f64);
    let room = found.as_slice_mut().unwrap_or_default();
    let failures = py.detach(|| {
        let mut told = |done: usize| reporter.report(done as f64);
        batch.run(&parameters, threads, room, &mut told)
    });
    match (failures, reporter.raised) {
        (Ok(failures), _) => Ok((found.into_pyarray(py), messages(&failures))),
        (Err(Error::Interrupted { .. }), Some(raised)) => Err(raised),
        (Err(error), _) => Err(core_error(error)),
    }
}

fn stop_values<'a>(stops: &'a [(usize, String, Column<'_>)]) -> PyResult<Vec<StopValues<'a>>> {
    let each = |(law, name, column): &'a (usize, String, Column<'_>)| {
        let number = match name.as_str() {
            "gap" => StopNumber::Gap,
            "stiffness" => StopNumber::Stiffness,
            "damping" => StopNumber::Damping,
            _ => return Err(unknown("number of a stop", name)),
        };
        Ok(StopValues {
            law: *law,
            number,
            values: column.as_slice()?,
        })
    };
    stops.iter().map(each).collect()
}

fn factors<'a>(given: Option<&'a Column<'_>>) -> PyResult<Option<&'a [f64]>> {
    Ok(given.map(|factors| factors.as_slice()).transpose()?)
}

/// Factors of the problem's own state where the flag is set, else a row of modes for each run.
fn start<'a>(given: Option<&'a (bool, Column<'_>)>) -> PyResult<Start<'a>> {
    Ok(match given {
        None => Start::Same,
        Some((true, factors)) => Start::Scaled(factors.as_slice()?),
        Some((false, rows)) => Start::Given(rows.as_slice()?),
    })
}

fn messages(failures: &[Failure]) -> Vec<(usize, String)> {
    let told = |failure: &Failure| (failure.run, failure.error.to_string());
    failures.iter().map(told).collect()
}
