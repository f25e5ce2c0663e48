//! What a problem is made of.

use crate::core_error;
use bumpstop_core::{law, system};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;

/// `q'' + (diag(damping) + coupling) q' + (diag(omega2) + circulatory) q = f`, unit modal mass.
#[pyclass(frozen, module = "bumpstop._core")]
pub struct System(pub system::ModalSystem);

#[pymethods]
impl System {
    #[new]
    #[pyo3(signature = (omega2, damping, coupling=None, circulatory=None))]
    fn new(
        omega2: PyReadonlyArray1<f64>,
        damping: PyReadonlyArray1<f64>,
        coupling: Option<PyReadonlyArray2<f64>>,
        circulatory: Option<PyReadonlyArray2<f64>>,
    ) -> PyResult<Self> {
        let build = || {
            let mut system = system::ModalSystem::new(values(&omega2), values(&damping))?;
            if let Some(coupling) = coupling {
                system = system.with_coupling(rows(&coupling))?;
            }
            if let Some(circulatory) = circulatory {
                system = system.with_circulatory(rows(&circulatory))?;
            }
            Ok(Self(system))
        };
        build().map_err(core_error)
    }
}

/// A unilateral spring and damper at distance `d = gap + row . q`.
#[pyclass(frozen, module = "bumpstop._core")]
pub struct Stop(pub law::Stop);

#[pymethods]
impl Stop {
    #[new]
    fn new(row: PyReadonlyArray1<f64>, gap: f64, stiffness: f64, damping: f64) -> PyResult<Self> {
        law::Stop::new(values(&row), gap, stiffness, damping)
            .map(Self)
            .map_err(core_error)
    }
}

/// A law of any kind, as Python hands it over.
#[derive(FromPyObject)]
pub enum LawPart<'py> {
    Stop(PyRef<'py, Stop>),
}

impl LawPart<'_> {
    /// The core's law.
    pub fn law(&self) -> law::AnyLaw {
        match self {
            Self::Stop(stop) => stop.0.clone().into(),
        }
    }
}

/// The numbers of an array of any layout.
pub(crate) fn values(array: &PyReadonlyArray1<f64>) -> Vec<f64> {
    array.as_array().iter().copied().collect()
}

/// The rows of a matrix of any layout.
fn rows(array: &PyReadonlyArray2<f64>) -> Vec<Vec<f64>> {
    let rows = array.as_array();
    rows.outer_iter().map(|row| row.to_vec()).collect()
}
