//! Python bindings of the core: convert, release the GIL, call, convert back.

mod batch;
mod formula;
mod full;
mod history;
mod modes;
mod parts;
mod simulate;
mod sparse;
mod user;

use bumpstop_core::error::{Error, Place};
use pyo3::exceptions::PyException;
use pyo3::prelude::*;

pyo3::create_exception!(
    bumpstop._core,
    CoreError,
    PyException,
    "The core refused its input or could not finish; the message says why."
);

/// The core's error as a Python exception.
pub(crate) fn core_error(error: Error) -> PyErr {
    let raised = CoreError::new_err(error.to_string());
    if let Error::BlowUp {
        place: Some(Place::Dof(dof)),
        ..
    } = error
    {
        // An exception takes any attribute; without this one the message is poorer.
        let _ = Python::attach(|py| raised.value(py).setattr("dof", dof));
    }
    raised
}

/// The compiled core of bumpstop.
#[pymodule]
fn _core(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("CoreError", module.py().get_type::<CoreError>())?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<parts::System>()?;
    module.add_class::<parts::Stop>()?;
    module.add_class::<parts::FrictionStop>()?;
    module.add_class::<parts::Spring>()?;
    module.add_class::<parts::Forcing>()?;
    module.add_class::<parts::Damper>()?;
    module.add_class::<parts::ForceRelation>()?;
    module.add_class::<parts::RigidStop>()?;
    module.add_class::<parts::HertzStop>()?;
    module.add_class::<parts::ZenerDamper>()?;
    module.add_class::<parts::CrackedRotor>()?;
    module.add_class::<parts::Course>()?;
    module.add_class::<parts::Shape>()?;
    module.add_class::<parts::ShapedStop>()?;
    module.add_class::<full::FullProblem>()?;
    module.add_class::<parts::SeismicDevice>()?;
    module.add_class::<parts::HardeningSpring>()?;
    module.add_class::<parts::BucklingStop>()?;
    module.add_class::<user::UserLaw>()?;
    module.add_class::<user::OutsideProgram>()?;
    module.add_class::<history::History>()?;
    module.add_class::<batch::Quantity>()?;
    module.add_class::<sparse::SparseFactor>()?;
    module.add_function(wrap_pyfunction!(modes::symmetric_modes, module)?)?;
    module.add_function(wrap_pyfunction!(modes::sparse_modes, module)?)?;
    module.add_function(wrap_pyfunction!(modes::sturm_count, module)?)?;
    module.add_function(wrap_pyfunction!(sparse::assemble, module)?)?;
    module.add_function(wrap_pyfunction!(sparse::sparse_product, module)?)?;
    module.add_function(wrap_pyfunction!(sparse::component_labels, module)?)?;
    module.add_function(wrap_pyfunction!(simulate::simulate, module)?)?;
    module.add_function(wrap_pyfunction!(simulate::stability_limit, module)?)?;
    module.add_function(wrap_pyfunction!(batch::batch, module)?)?;
    Ok(())
}
