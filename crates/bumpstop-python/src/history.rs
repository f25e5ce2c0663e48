//! Reading a run.

use crate::core_error;
use crate::parts::values;
use bumpstop_core::energy::Ledger;
use bumpstop_core::error::Result;
use bumpstop_core::history::{self, Derivative};
use bumpstop_core::impacts::Impact;
use bumpstop_core::law::{AnyLaw, Law, State};
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray1};
use pyo3::exceptions::{PyIndexError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Mutex;
use std::time::Instant;

/// A law's state: its number, the part of the obstacle and both internal variables.
pub(crate) type StateParts = (u8, u16, f64, f64);

type Column<'py> = Bound<'py, PyArray1<f64>>;
type Term = fn(&Impact) -> f64;

/// What a run leaves behind; it can be sampled anywhere in [0, duration].
#[pyclass(frozen, module = "bumpstop._core")]
pub struct History {
    inner: history::History<AnyLaw>,
    seconds: Mutex<f64>,
}

impl History {
    pub(crate) fn new(inner: history::History<AnyLaw>, seconds: f64) -> Self {
        Self {
            inner,
            seconds: Mutex::new(seconds),
        }
    }

    /// Reads from the core without the GIL and adds the time that it takes.
    fn read<T: Send>(
        &self,
        py: Python<'_>,
        reader: impl FnOnce(&history::History<AnyLaw>) -> T + Send,
    ) -> T {
        let (value, seconds) = py.detach(|| {
            let start = Instant::now();
            let value = reader(&self.inner);
            (value, start.elapsed().as_secs_f64())
        });
        if let Ok(mut total) = self.seconds.lock() {
            *total += seconds;
        }
        value
    }

    fn check_law(&self, law: usize) -> PyResult<()> {
        if law < self.inner.problem().laws.len() {
            Ok(())
        } else {
            Err(PyIndexError::new_err(format!("there is no law {law}")))
        }
    }
}

pub(crate) fn derivative_numbered(number: usize) -> PyResult<Derivative> {
    match number {
        0 => Ok(Derivative::Displacement),
        1 => Ok(Derivative::Velocity),
        2 => Ok(Derivative::Acceleration),
        _ => Err(PyValueError::new_err("derivative must be 0, 1 or 2")),
    }
}

#[pymethods]
impl History {
    #[getter]
    fn method(&self) -> &'static str {
        self.inner.method()
    }

    #[getter]
    fn duration(&self) -> f64 {
        self.inner.problem().duration
    }

    #[getter]
    fn steps(&self) -> usize {
        self.inner.steps()
    }

    #[getter]
    fn event_count(&self) -> usize {
        self.inner.events().len()
    }

    #[getter]
    fn seconds(&self) -> f64 {
        self.seconds.lock().map_or(f64::NAN, |total| *total)
    }

    #[getter]
    fn missed_penetration(&self) -> Option<f64> {
        self.inner.missed_penetration()
    }

    #[getter]
    fn motion_error(&self) -> Option<f64> {
        self.inner.motion_error()
    }

    fn motion<'py>(
        &self,
        py: Python<'py>,
        times: PyReadonlyArray1<f64>,
        derivative: usize,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let derivative = derivative_numbered(derivative)?;
        let times = values(&times);
        let rows = self
            .read(py, |h| h.motion(&times, derivative))
            .map_err(core_error)?;
        let shape = (times.len(), self.inner.problem().system.modes());
        let array = Array2::from_shape_vec(shape, rows);
        Ok(array
            .map_err(|e| PyValueError::new_err(e.to_string()))?
            .into_pyarray(py))
    }

    fn project<'py>(
        &self,
        py: Python<'py>,
        row: PyReadonlyArray1<f64>,
        times: PyReadonlyArray1<f64>,
        derivative: usize,
    ) -> PyResult<Column<'py>> {
        let derivative = derivative_numbered(derivative)?;
        let (row, times) = (values(&row), values(&times));
        let sampled = self.read(py, |h| h.project(&row, &times, derivative));
        Ok(sampled.map_err(core_error)?.into_pyarray(py))
    }

    fn law_motion<'py>(
        &self,
        py: Python<'py>,
        law: usize,
        times: PyReadonlyArray1<f64>,
    ) -> PyResult<(Column<'py>, Column<'py>, Column<'py>)> {
        self.check_law(law)?;
        let times = values(&times);
        let [distance, rate, force] = self
            .read(py, |h| h.law_motion(law, &times))
            .map_err(core_error)?;
        Ok((
            distance.into_pyarray(py),
            rate.into_pyarray(py),
            force.into_pyarray(py),
        ))
    }

    fn law_forces<'py>(
        &self,
        py: Python<'py>,
        law: usize,
        times: PyReadonlyArray1<f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.check_law(law)?;
        let times = values(&times);
        let forces = self
            .read(py, |h| h.law_forces(law, &times))
            .map_err(core_error)?;
        let count = self.inner.problem().laws[law].rows().len();
        let of = |(time, coordinate): (usize, usize)| forces[time][coordinate];
        Ok(Array2::from_shape_fn((times.len(), count), of).into_pyarray(py))
    }

    /// The same along the normal of the contact and across it.
    fn contact_forces<'py>(
        &self,
        py: Python<'py>,
        law: usize,
        times: PyReadonlyArray1<f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.check_law(law)?;
        let times = values(&times);
        let forces = self
            .read(py, |h| h.contact_forces(law, &times))
            .map_err(core_error)?;
        let of = |(time, coordinate): (usize, usize)| forces[time][coordinate];
        Ok(Array2::from_shape_fn((times.len(), 3), of).into_pyarray(py))
    }

    /// The states of all laws at a time: number, part of the obstacle and both internal variables.
    fn states(&self, py: Python<'_>, time: f64) -> PyResult<Vec<StateParts>> {
        let states = self.read(py, |h| h.states(time)).map_err(core_error)?;
        let parts = |s: &State| (s.number, s.part, s.memory[0], s.memory[1]);
        Ok(states.iter().map(parts).collect())
    }

    /// What a law remembers, brought up to the motion at each time; NaN where there is nothing.
    fn internal_variables<'py>(
        &self,
        py: Python<'py>,
        law: usize,
        times: PyReadonlyArray1<f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.check_law(law)?;
        let times = values(&times);
        let found = self
            .read(py, |h| h.internal_variables(law, &times))
            .map_err(core_error)?;
        let of = |(time, variable): (usize, usize)| found[time][variable];
        Ok(Array2::from_shape_fn((times.len(), 2), of).into_pyarray(py))
    }

    fn law_states(
        &self,
        py: Python<'_>,
        law: usize,
        times: PyReadonlyArray1<f64>,
    ) -> PyResult<Vec<String>> {
        self.check_law(law)?;
        let times = values(&times);
        let states = self
            .read(py, |h| h.law_states(law, &times))
            .map_err(core_error)?;
        let name = |state: &_| {
            self.inner.problem().laws[law]
                .state_name(*state)
                .into_owned()
        };
        Ok(states.iter().map(name).collect())
    }

    fn energy<'py>(
        &self,
        py: Python<'py>,
        times: PyReadonlyArray1<f64>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let times = values(&times);
        let ledgers: Result<Vec<Ledger>> = self.read(py, |h| h.energy(&times));
        let ledgers = ledgers.map_err(core_error)?;
        let laws = self.inner.problem().laws.len();
        let dict = PyDict::new(py);
        let column = |term: fn(&Ledger) -> f64| -> Column<'py> {
            ledgers
                .iter()
                .map(term)
                .collect::<Vec<_>>()
                .into_pyarray(py)
        };
        dict.set_item("kinetic", column(|l| l.kinetic))?;
        dict.set_item("elastic", column(|l| l.elastic))?;
        dict.set_item("modal_dissipation", column(|l| l.modal_dissipation))?;
        dict.set_item("load_work", column(|l| l.load_work))?;
        dict.set_item("circulatory_work", column(|l| l.circulatory_work))?;
        dict.set_item("obstacle_work", column(|l| l.obstacle_work))?;
        let table = |term: fn(&Ledger) -> &[f64]| {
            Array2::from_shape_fn((laws, ledgers.len()), |(law, t)| term(&ledgers[t])[law])
                .into_pyarray(py)
        };
        dict.set_item("law_stored", table(|l| &l.law_stored))?;
        dict.set_item("law_dissipated", table(|l| &l.law_dissipated))?;
        Ok(dict)
    }

    fn energy_residual(&self, py: Python<'_>) -> f64 {
        self.read(py, history::History::energy_residual)
    }

    fn events<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let events = self.inner.events();
        let name = |law: usize, state| self.inner.problem().laws[law].state_name(state);
        let dict = PyDict::new(py);
        dict.set_item("time", events.iter().map(|e| e.time).collect::<Vec<_>>())?;
        dict.set_item("law", events.iter().map(|e| e.law).collect::<Vec<_>>())?;
        dict.set_item("guard", events.iter().map(|e| e.guard).collect::<Vec<_>>())?;
        let before: Vec<_> = events.iter().map(|e| name(e.law, e.before)).collect();
        let after: Vec<_> = events.iter().map(|e| name(e.law, e.after)).collect();
        dict.set_item("before", before)?;
        dict.set_item("after", after)?;
        Ok(dict)
    }

    fn impacts<'py>(&self, py: Python<'py>, law: usize) -> PyResult<Bound<'py, PyDict>> {
        self.check_law(law)?;
        let impacts = self.read(py, |h| h.impacts(law));
        let dict = PyDict::new(py);
        let columns: [(&str, Term); 9] = [
            ("start", |i| i.start),
            ("end", |i| i.end),
            ("closing_speed", |i| i.closing_speed),
            ("opening_speed", |i| i.opening_speed),
            ("peak_force", |i| i.peak_force),
            ("peak_time", |i| i.peak_time),
            ("impulse", |i| i.impulse),
            ("energy_absorbed", |i| i.energy_absorbed),
            ("energy_returned", |i| i.energy_returned),
        ];
        for (name, term) in columns {
            let column: Column<'py> = impacts
                .iter()
                .map(term)
                .collect::<Vec<_>>()
                .into_pyarray(py);
            dict.set_item(name, column)?;
        }
        Ok(dict)
    }
}
