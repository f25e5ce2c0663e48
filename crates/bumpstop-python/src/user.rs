//! Laws that Python code answers for: its functions are called where the core asks, and what they
//! raise ends the run.

use crate::core_error;
use crate::parts::values;
use bumpstop_core::law::{self, Answers, Program, Question, Slopes};
use numpy::PyReadonlyArray1;
use pyo3::BoundObject;
use pyo3::exceptions::PyException;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// What one law went wrong with.
#[derive(Debug)]
enum Failure {
    /// In words.
    Told(String),
    /// What is to be raised as it is, such as an interrupt.
    Raised(PyErr),
}

/// The first failure of a law.
#[derive(Debug, Default)]
struct Failures {
    first: Mutex<Option<Failure>>,
}

impl Failures {
    fn any(&self) -> bool {
        self.lock().is_some()
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Option<Failure>> {
        // Nothing panics while it is held.
        self.first.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn keep(&self, failure: Failure) {
        self.lock().get_or_insert(failure);
    }

    /// The exception to raise.
    fn raised(&self) -> Option<PyErr> {
        Some(match self.lock().take()? {
            Failure::Told(words) => crate::CoreError::new_err(words),
            Failure::Raised(error) => error,
        })
    }
}

/// A function of the user's, for messages.
struct Asked<'a> {
    law: &'a str,
    what: &'a str,
    when: String,
}

impl Asked<'_> {
    /// Calls a function that returns so many numbers; not numbers where it could not.
    fn numbers<'py, const N: usize>(
        &self,
        failures: &Failures,
        py: Python<'py>,
        function: &Py<PyAny>,
        arguments: impl IntoPyObject<'py, Target = PyTuple>,
        count: usize,
    ) -> [f64; N] {
        let mut numbers = [f64::NAN; N];
        if failures.any() {
            return numbers;
        }
        match self.called(py, function, arguments, count) {
            Ok(found) => {
                numbers = [0.0; N];
                numbers[..count].copy_from_slice(&found);
            }
            Err(failure) => failures.keep(failure),
        }
        numbers
    }

    fn called<'py>(
        &self,
        py: Python<'py>,
        function: &Py<PyAny>,
        arguments: impl IntoPyObject<'py, Target = PyTuple>,
        count: usize,
    ) -> Result<Vec<f64>, Failure> {
        let Self { law, what, when } = self;
        let arguments =
            (arguments.into_pyobject(py)).map_err(|error| Failure::Raised(error.into()))?;
        let answer = function.bind(py).call1(arguments.into_bound());
        let answer = answer.map_err(|error| self.failure(py, error))?;
        let told = || {
            let found = answer
                .repr()
                .map_or_else(|_| String::new(), |text| text.to_string());
            Failure::Told(format!("the {what} of law '{law}' is {found} {when}"))
        };
        let numbers: Vec<f64> = answer.extract().map_err(|_| told())?;
        if numbers.len() != count || !numbers.iter().all(|x| x.is_finite()) {
            return Err(told());
        }
        Ok(numbers)
    }

    fn failure(&self, py: Python<'_>, error: PyErr) -> Failure {
        if !error.is_instance_of::<PyException>(py) {
            return Failure::Raised(error);
        }
        let Self { law, what, when } = self;
        Failure::Told(format!("the {what} of law '{law}' raised {error} {when}"))
    }
}

/// Functions of Python that answer for a law.
#[derive(Debug)]
struct Functions {
    name: String,
    rows: usize,
    force: Py<PyAny>,
    slopes: Option<Py<PyAny>>,
    memory_rate: Option<Py<PyAny>>,
    failures: Failures,
}

/// Part of a motion by which it is changed for a difference.
const DIFFERENCE: f64 = 6e-6;

impl Functions {
    fn ask<const N: usize>(
        &self,
        what: &str,
        function: &Py<PyAny>,
        question: &Question,
        count: usize,
    ) -> [f64; N] {
        Python::attach(|py| {
            let asked = Asked {
                law: &self.name,
                what,
                when: format!("at t = {:e} s", question.time),
            };
            let [position, velocity] =
                [question.position, question.velocity].map(|local| local[..self.rows].to_vec());
            let arguments = (position, velocity, question.time, question.memory);
            asked.numbers(&self.failures, py, function, arguments, count)
        })
    }

    /// Slopes by central differences.
    fn differences(&self, question: &Question) -> [Slopes; 2] {
        let mut slopes = [Slopes::default(); 2];
        for (order, slopes) in slopes.iter_mut().enumerate() {
            for c in 0..self.rows {
                let moved = |sign: f64| {
                    let mut moved = *question;
                    let number = match order {
                        0 => &mut moved.position[c],
                        _ => &mut moved.velocity[c],
                    };
                    let step = DIFFERENCE * number.abs().max(DIFFERENCE);
                    *number += sign * step;
                    (self.force(&moved), 2.0 * step)
                };
                let ((ahead, width), (back, _)) = (moved(1.0), moved(-1.0));
                let forces = ahead.into_iter().zip(back).take(self.rows);
                for (row, (ahead, back)) in slopes.iter_mut().zip(forces) {
                    row[c] = (ahead - back) / width;
                }
            }
        }
        slopes
    }
}

impl Answers for Functions {
    fn force(&self, question: &Question) -> [f64; 3] {
        self.ask("force", &self.force, question, self.rows)
    }

    fn slopes(&self, question: &Question) -> [Slopes; 2] {
        let Some(function) = &self.slopes else {
            return self.differences(question);
        };
        let count = 2 * self.rows * self.rows;
        let found: [f64; 18] = self.ask("jacobian", function, question, count);
        let rows = self.rows;
        let entry = |order: usize, i: usize, c: usize| {
            let known = i < rows && c < rows;
            if known {
                found[(order * rows + i) * rows + c]
            } else {
                0.0
            }
        };
        let each = |order: usize| -> Slopes {
            std::array::from_fn(|i| std::array::from_fn(|c| entry(order, i, c)))
        };
        [each(0), each(1)]
    }

    fn memory_rate(&self, question: &Question) -> f64 {
        match &self.memory_rate {
            Some(function) => {
                let [rate] = self.ask("memory rate", function, question, 1);
                rate
            }
            None => 0.0,
        }
    }

    fn has_failed(&self) -> bool {
        self.failures.any()
    }
}

/// A law along one to three coordinates that Python functions answer for.
#[pyclass(frozen, module = "bumpstop._core")]
pub struct UserLaw {
    pub law: law::UserLaw,
    functions: Arc<Functions>,
}

#[pymethods]
impl UserLaw {
    /// The functions are called with positions, velocities, time and memory, and return forces,
    /// slopes by positions and then by velocities, row by row, and the rate of the memory.
    #[new]
    #[allow(clippy::needless_pass_by_value)] // what pyo3 converts to
    fn new(
        name: String,
        rows: Vec<PyReadonlyArray1<f64>>,
        force: Py<PyAny>,
        slopes: Option<Py<PyAny>>,
        memory_rate: Option<Py<PyAny>>,
        start: f64,
    ) -> PyResult<Self> {
        let functions = Arc::new(Functions {
            name,
            rows: rows.len(),
            force,
            slopes,
            memory_rate,
            failures: Failures::default(),
        });
        let rows = rows.iter().map(values).collect();
        let law = law::UserLaw::new(rows, functions.clone(), start).map_err(core_error)?;
        Ok(Self { law, functions })
    }
}

impl UserLaw {
    /// What went wrong with it, if anything did.
    pub fn raised(&self) -> Option<PyErr> {
        self.functions.failures.raised()
    }
}

/// A Python function that is asked once a step.
#[derive(Debug)]
struct Stepped {
    name: String,
    rows: usize,
    exchange: Py<PyAny>,
    /// Steps that it has answered for.
    steps: AtomicUsize,
    failures: Failures,
}

impl Program for Stepped {
    fn answer(&self, position: &[f64; 3], velocity: &[f64; 3]) -> [f64; 2] {
        let step = self.steps.fetch_add(1, Ordering::Relaxed);
        Python::attach(|py| {
            let asked = Asked {
                law: &self.name,
                what: "program",
                when: format!("at step {step}"),
            };
            let motions = [position, velocity].map(|local| local[..self.rows].to_vec());
            let [position, velocity] = motions;
            let arguments = (step, position, velocity);
            asked.numbers(&self.failures, py, &self.exchange, arguments, self.rows)
        })
    }
}

/// A program along one or two coordinates that is coupled step by step.
#[pyclass(frozen, module = "bumpstop._core")]
pub struct OutsideProgram {
    pub law: law::OutsideProgram,
    program: Arc<Stepped>,
}

#[pymethods]
impl OutsideProgram {
    /// The function is called with the number of the step, positions and velocities, and returns
    /// forces.
    #[new]
    #[allow(clippy::needless_pass_by_value)] // what pyo3 converts to
    fn new(name: String, rows: Vec<PyReadonlyArray1<f64>>, exchange: Py<PyAny>) -> PyResult<Self> {
        let program = Arc::new(Stepped {
            name,
            rows: rows.len(),
            exchange,
            steps: AtomicUsize::new(0),
            failures: Failures::default(),
        });
        let rows = rows.iter().map(values).collect();
        let law = law::OutsideProgram::new(rows, program.clone()).map_err(core_error)?;
        Ok(Self { law, program })
    }
}

impl OutsideProgram {
    /// What went wrong with it, if anything did.
    pub fn raised(&self) -> Option<PyErr> {
        self.program.failures.raised()
    }
}
