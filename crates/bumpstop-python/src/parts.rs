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

/// A stop that rubs along the coordinate `tangent . q`.
#[pyclass(frozen, module = "bumpstop._core")]
pub struct FrictionStop(pub law::FrictionStop);

#[pymethods]
impl FrictionStop {
    #[new]
    fn new(
        normal: PyRef<'_, Stop>,
        tangent: PyReadonlyArray1<f64>,
        static_coefficient: f64,
        dynamic_coefficient: f64,
        stiffness: f64,
        damping: f64,
    ) -> PyResult<Self> {
        let friction = law::Friction {
            static_coefficient,
            dynamic_coefficient,
            stiffness,
            damping,
        };
        law::FrictionStop::new(normal.0.clone(), values(&tangent), friction)
            .map(Self)
            .map_err(core_error)
    }
}

/// A multilinear elastic spring of deformation `row . q`.
#[pyclass(frozen, module = "bumpstop._core")]
pub struct Spring(pub law::Spring);

#[pymethods]
impl Spring {
    #[new]
    fn new(
        row: PyReadonlyArray1<f64>,
        breaks: PyReadonlyArray1<f64>,
        stiffness: PyReadonlyArray1<f64>,
        preload: f64,
        damping: f64,
    ) -> PyResult<Self> {
        let (breaks, stiffness) = (values(&breaks), values(&stiffness));
        law::Spring::new(values(&row), breaks, &stiffness, preload, damping)
            .map(Self)
            .map_err(core_error)
    }
}

/// A law of any kind, as Python hands it over.
#[derive(FromPyObject)]
pub enum LawPart<'py> {
    Stop(PyRef<'py, Stop>),
    FrictionStop(PyRef<'py, FrictionStop>),
    Spring(PyRef<'py, Spring>),
}

impl LawPart<'_> {
    /// The core's law.
    pub fn law(&self) -> law::AnyLaw {
        match self {
            Self::Stop(law) => law.0.clone().into(),
            Self::FrictionStop(law) => law.0.clone().into(),
            Self::Spring(law) => law.0.clone().into(),
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
