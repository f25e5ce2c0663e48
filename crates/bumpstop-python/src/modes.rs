//! The eigenproblem, dense and sparse.

use crate::core_error;
use crate::sparse::{Columns, matrix};
use bumpstop_core::modes::dense;
use bumpstop_core::modes::pencil::Pencil;
use bumpstop_core::modes::selection::{Selection, selected_modes};
use bumpstop_core::modes::sturm::{self, Count};
use faer::{Mat, MatRef};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray2, ndarray::Array2};
use pyo3::prelude::*;

type Vector<'py> = Bound<'py, PyArray1<f64>>;
type Matrix<'py> = Bound<'py, PyArray2<f64>>;
type Point = (f64, usize);

/// All omega2 (n,) of `K x = omega2 M x` and the `count` lowest shapes (n, count).
#[pyfunction]
pub fn symmetric_modes<'py>(
    py: Python<'py>,
    stiffness: PyReadonlyArray2<f64>,
    mass: PyReadonlyArray2<f64>,
    count: usize,
) -> PyResult<(Vector<'py>, Matrix<'py>)> {
    let (stiffness, mass) = (dense_matrix(&stiffness), dense_matrix(&mass));
    let found = py
        .detach(|| dense::symmetric_modes(stiffness.as_ref(), mass.as_ref(), count))
        .map_err(core_error)?;
    let shapes = array(found.shapes.as_ref()).into_pyarray(py);
    Ok((found.omega2.into_pyarray(py), shapes))
}

/// The lowest modes of sparse matrices, those of a band, or those around a shift: flexible
/// omega2, shapes, and the counts at the ends of a range in which none is missing.
#[pyfunction]
#[pyo3(signature = (stiffness, mass, rigid, *, lowest=None, band=None, around=None))]
pub fn sparse_modes<'py>(
    py: Python<'py>,
    stiffness: Columns<'py>,
    mass: Columns<'py>,
    rigid: PyReadonlyArray2<f64>,
    lowest: Option<usize>,
    band: Option<(f64, f64)>,
    around: Option<(f64, usize)>,
) -> PyResult<(Vector<'py>, Matrix<'py>, Option<Point>, Point)> {
    let selection = match (band, around) {
        (Some((low, high)), _) => Selection::Band { low, high },
        (_, Some((shift, count))) => Selection::Around { shift, count },
        _ => Selection::Lowest(lowest.unwrap_or(0)),
    };
    let stiffness = matrix("the stiffness matrix", &stiffness)?;
    let mass = matrix("the mass matrix", &mass)?;
    let rigid = dense_matrix(&rigid);
    let found = py
        .detach(|| {
            let pencil = Pencil::new(&stiffness, &mass)?;
            drop((stiffness, mass));
            selected_modes(&pencil, rigid.as_ref(), selection)
        })
        .map_err(core_error)?;
    Ok((
        found.modes.omega2.into_pyarray(py),
        array(found.modes.shapes.as_ref()).into_pyarray(py),
        found.low.map(point),
        point(found.high),
    ))
}

/// Number of eigenvalues below the first of some points that is not itself one.
#[pyfunction]
pub fn sturm_count<'py>(
    py: Python<'py>,
    stiffness: Columns<'py>,
    mass: Columns<'py>,
    points: Vec<f64>,
) -> PyResult<Point> {
    let stiffness = matrix("the stiffness matrix", &stiffness)?;
    let mass = matrix("the mass matrix", &mass)?;
    py.detach(|| {
        let pencil = Pencil::new(&stiffness, &mass)?;
        sturm::count(&pencil, points)
    })
    .map(point)
    .map_err(core_error)
}

fn point(count: Count) -> Point {
    (count.at, count.below)
}

/// A matrix of the core from an array of any layout.
pub(crate) fn dense_matrix(array: &PyReadonlyArray2<f64>) -> Mat<f64> {
    let view = array.as_array();
    Mat::from_fn(view.nrows(), view.ncols(), |r, c| view[(r, c)])
}

/// An array from a matrix of the core.
pub(crate) fn array(matrix: MatRef<f64>) -> Array2<f64> {
    Array2::from_shape_fn(matrix.shape(), |(r, c)| matrix[(r, c)])
}
