//! The full model.

use crate::core_error;
use crate::history::History;
use crate::parts::{Forcing, LawPart};
use crate::simulate::{Parameters, Reporter, scheme_named, timed};
use crate::sparse::{Columns, matrix, places};
use bumpstop_core::law::AnyLaw;
use bumpstop_core::method::central_difference;
use bumpstop_core::method::fixed_step::Step;
use bumpstop_core::method::full::{self, FullScheme, FullSystem};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// A structure of many dofs, with laws that see some of them.
#[pyclass(frozen, module = "bumpstop._core")]
pub struct FullProblem(full::FullProblem<AnyLaw>);

#[pymethods]
impl FullProblem {
    /// Matrices are mass, damping and stiffness; `start` has the displacement and the velocity as
    /// rows; laws and obstacles, a forcing without forces, are over the kept dofs.
    #[new]
    #[allow(clippy::too_many_arguments)] // mirrors the Python signature
    fn new(
        py: Python<'_>,
        matrices: [Columns<'_>; 3],
        forcing: &Forcing,
        start: PyReadonlyArray2<f64>,
        kept: PyReadonlyArray1<i64>,
        laws: Vec<LawPart<'_>>,
        obstacles: &Forcing,
        duration: f64,
    ) -> PyResult<Self> {
        let [mass, damping, stiffness] = &matrices;
        let mass = matrix("the mass matrix", mass)?;
        let damping = matrix("the damping matrix", damping)?;
        let stiffness = matrix("the stiffness matrix", stiffness)?;
        let row = |number: usize| start.as_array().row(number).to_vec();
        let start = [row(0), row(1)];
        let laws = laws.iter().map(LawPart::law).collect();
        let (forcing, obstacles, kept) = (forcing.0.clone(), obstacles.0.clone(), places(&kept));
        py.detach(|| {
            let system = FullSystem::new(mass, damping, stiffness)?;
            full::FullProblem::new(system, forcing, start, kept, (laws, obstacles), duration)
        })
        .map(Self)
        .map_err(core_error)
    }

    /// Largest stable step of a method, in s; infinite where every step is stable.
    fn stability_limit(
        &self,
        py: Python<'_>,
        method: &str,
        parameters: Parameters,
    ) -> PyResult<f64> {
        let scheme = full_scheme(method, &parameters)?;
        py.detach(|| scheme.stability_limit(&self.0))
            .map_err(core_error)
    }

    /// Integrates; releases the GIL.
    fn simulate(
        &self,
        py: Python<'_>,
        method: &str,
        dt: f64,
        beyond_stability_limit: bool,
        parameters: Parameters,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<History> {
        let scheme = full_scheme(method, &parameters)?;
        let step = Step {
            dt,
            beyond_stability_limit,
        };
        let reporter = Reporter::new(progress, self.0.seen.duration);
        timed(py, reporter, |observer| {
            full::simulate(&self.0, scheme, step, observer)
        })
    }
}

fn full_scheme(method: &str, parameters: &Parameters) -> PyResult<FullScheme> {
    if method == central_difference::NAME {
        return Ok(FullScheme::CentralDifference);
    }
    scheme_named(method, parameters)
        .map(FullScheme::Implicit)
        .ok_or_else(|| PyValueError::new_err(format!("no method '{method}' for a full model")))
}
