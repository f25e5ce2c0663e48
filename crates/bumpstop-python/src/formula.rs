//! Formulas, as Python hands them over: word by word.

use bumpstop_core::law::{Binary, Operation, Sided, Smooth};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// A number, or the name of an operation.
#[derive(FromPyObject)]
pub enum Word {
    Number(f64),
    Name(String),
}

impl Word {
    /// The step of the program.
    pub fn operation(&self) -> PyResult<Operation> {
        match self {
            Self::Number(number) => Ok(Operation::Constant(*number)),
            Self::Name(name) => operation_named(name)
                .ok_or_else(|| PyValueError::new_err(format!("no operation '{name}'"))),
        }
    }
}

fn operation_named(name: &str) -> Option<Operation> {
    Some(match name {
        "x" => Operation::Position,
        "v" => Operation::Velocity,
        "+" => Operation::Binary(Binary::Add),
        "-" => Operation::Binary(Binary::Subtract),
        "*" => Operation::Binary(Binary::Multiply),
        "/" => Operation::Binary(Binary::Divide),
        "**" => Operation::Binary(Binary::Power),
        "atan2" => Operation::Binary(Binary::Atan2),
        "abs" => Operation::Sided(Sided::Abs),
        "sign" => Operation::Sided(Sided::Sign),
        "step" => Operation::Sided(Sided::Step),
        "min" => Operation::Sided(Sided::Min),
        "max" => Operation::Sided(Sided::Max),
        _ => Operation::Smooth(function_named(name)?),
    })
}

fn function_named(name: &str) -> Option<Smooth> {
    Some(match name {
        "negate" => Smooth::Negate,
        "sin" => Smooth::Sin,
        "cos" => Smooth::Cos,
        "tan" => Smooth::Tan,
        "asin" => Smooth::Asin,
        "acos" => Smooth::Acos,
        "atan" => Smooth::Atan,
        "sinh" => Smooth::Sinh,
        "cosh" => Smooth::Cosh,
        "tanh" => Smooth::Tanh,
        "exp" => Smooth::Exp,
        "log" => Smooth::Log,
        "sqrt" => Smooth::Sqrt,
        _ => return None,
    })
}
