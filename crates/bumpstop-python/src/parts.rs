//! What a problem is made of, and the eigenproblem.

use crate::core_error;
use bumpstop_core::{law, modes, system};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2, ndarray::Array2};
use pyo3::prelude::*;

type Vector<'py> = Bound<'py, PyArray1<f64>>;
type Matrix<'py> = Bound<'py, PyArray2<f64>>;

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

/// Lowest modes of `K x = omega2 M x`: omega2 (count,) and shapes (n, count).
#[pyfunction]
pub fn symmetric_modes<'py>(
    py: Python<'py>,
    stiffness: PyReadonlyArray2<f64>,
    mass: PyReadonlyArray2<f64>,
    count: usize,
) -> PyResult<(Vector<'py>, Matrix<'py>)> {
    let matrix = |array: &PyReadonlyArray2<f64>| {
        let view = array.as_array();
        modes::Matrix::from_fn(view.nrows(), view.ncols(), |r, c| view[(r, c)])
    };
    let (stiffness, mass) = (matrix(&stiffness), matrix(&mass));
    let found = py
        .detach(|| modes::symmetric_modes(stiffness.as_ref(), mass.as_ref(), count))
        .map_err(core_error)?;
    let shapes = Array2::from_shape_fn((stiffness.nrows(), count), |(r, c)| found.shapes[(r, c)]);
    Ok((found.omega2.into_pyarray(py), shapes.into_pyarray(py)))
}

/// The numbers of an array of any layout.
pub(crate) fn values(array: &PyReadonlyArray1<f64>) -> Vec<f64> {
    array.as_array().iter().copied().collect()
}
