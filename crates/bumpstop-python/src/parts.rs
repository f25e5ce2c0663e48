//! What a problem is made of.

use crate::core_error;
use bumpstop_core::{law, system};
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;

/// `q'' + C q' + diag(omega2) q = f`, unit modal mass.
#[pyclass(frozen, module = "bumpstop._core")]
pub struct System(pub system::ModalSystem);

#[pymethods]
impl System {
    #[new]
    fn new(omega2: PyReadonlyArray1<f64>, damping: PyReadonlyArray1<f64>) -> PyResult<Self> {
        let system = system::ModalSystem::new(values(&omega2), values(&damping));
        system.map(Self).map_err(core_error)
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

/// The numbers of an array of any layout.
pub(crate) fn values(array: &PyReadonlyArray1<f64>) -> Vec<f64> {
    array.as_array().iter().copied().collect()
}
