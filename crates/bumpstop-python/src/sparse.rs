//! Sparse matrices: compressed columns as tuples (starts, rows, values).

use crate::core_error;
use crate::modes::{array, dense_matrix};
use bumpstop_core::components;
use bumpstop_core::modes::factor::Factor;
use bumpstop_core::sparse::SparseMatrix;
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2, ndarray::Array2};
use pyo3::prelude::*;

/// Starts, rows and values of a square matrix.
pub type Columns<'py> = (
    PyReadonlyArray1<'py, i64>,
    PyReadonlyArray1<'py, i64>,
    PyReadonlyArray1<'py, f64>,
);

type Indices<'py> = Bound<'py, PyArray1<i64>>;
type Values<'py> = Bound<'py, PyArray1<f64>>;

/// A factored symmetric matrix.
#[pyclass(frozen, module = "bumpstop._core")]
pub struct SparseFactor(Factor);

#[pymethods]
impl SparseFactor {
    #[new]
    fn new(py: Python, starts_rows_values: Columns) -> PyResult<Self> {
        let matrix = matrix("the matrix", &starts_rows_values)?;
        py.detach(|| Factor::of(&matrix))
            .map(Self)
            .map_err(core_error)
    }

    #[getter]
    fn negative_pivots(&self) -> usize {
        self.0.negative
    }

    #[getter]
    fn singular_at(&self) -> Option<usize> {
        self.0.singularity().map(|_| self.0.weakest.unknown)
    }

    #[getter]
    fn weakest_pivot(&self) -> f64 {
        self.0.weakest.ratio
    }

    fn solve<'py>(
        &self,
        py: Python<'py>,
        rhs: PyReadonlyArray2<f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let mut solution = dense_matrix(&rhs);
        py.detach(|| self.0.solved(solution.as_mut()))
            .map_err(core_error)?;
        Ok(array(solution.as_ref()).into_pyarray(py))
    }
}

/// Adds up triplets; those of one place are summed in the order given.
#[pyfunction]
pub fn assemble<'py>(
    py: Python<'py>,
    rows: PyReadonlyArray1<i64>,
    columns: PyReadonlyArray1<i64>,
    values: PyReadonlyArray1<f64>,
    shape: (usize, usize),
) -> PyResult<(Indices<'py>, Indices<'py>, Values<'py>)> {
    let (rows, columns) = (places(&rows), places(&columns));
    let values = crate::parts::values(&values);
    let sum = py
        .detach(|| SparseMatrix::from_triplets(shape, &rows, &columns, &values))
        .map_err(core_error)?;
    Ok((
        numbers(py, sum.starts),
        numbers(py, sum.rows),
        sum.values.into_pyarray(py),
    ))
}

/// The product of a matrix of so many rows with several vectors, (columns, m).
#[pyfunction]
pub fn sparse_product<'py>(
    py: Python<'py>,
    matrix: Columns,
    height: usize,
    vectors: PyReadonlyArray2<f64>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let matrix = SparseMatrix::new(
        "the matrix",
        height,
        places(&matrix.0),
        places(&matrix.1),
        crate::parts::values(&matrix.2),
    )
    .map_err(core_error)?;
    let width = vectors.as_array().ncols();
    let vectors: Vec<f64> = vectors.as_array().iter().copied().collect();
    let product = py
        .detach(|| matrix.product(&vectors, width))
        .map_err(core_error)?;
    let product = Array2::from_shape_vec((height, width), product);
    Ok(product.expect("a product has its size").into_pyarray(py))
}

/// For each vertex of a graph the lowest vertex that it is joined to, (size,).
#[pyfunction]
pub fn component_labels<'py>(
    py: Python<'py>,
    size: usize,
    rows: PyReadonlyArray1<i64>,
    columns: PyReadonlyArray1<i64>,
) -> PyResult<Indices<'py>> {
    let edges = (places(&rows), places(&columns));
    let labels = py
        .detach(|| components::labels(size, &edges.0, &edges.1))
        .map_err(core_error)?;
    Ok(numbers(py, labels))
}

/// A square matrix of the core.
pub(crate) fn matrix(what: &'static str, columns: &Columns) -> PyResult<SparseMatrix> {
    let (starts, rows, entries) = columns;
    let size = places(starts).len().saturating_sub(1);
    SparseMatrix::new(
        what,
        size,
        places(starts),
        places(rows),
        crate::parts::values(entries),
    )
    .map_err(core_error)
}

/// Numbers of rows or columns; negative ones become too large to be any.
pub(crate) fn places(array: &PyReadonlyArray1<i64>) -> Vec<usize> {
    let place = |&number: &i64| usize::try_from(number).unwrap_or(usize::MAX);
    array.as_array().iter().map(place).collect()
}

fn numbers(py: Python<'_>, places: Vec<usize>) -> Indices<'_> {
    let numbers: Vec<i64> = places.into_iter().map(|place| place as i64).collect();
    numbers.into_pyarray(py)
}
