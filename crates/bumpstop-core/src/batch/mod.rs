//! Many runs of one problem by the exact method: what varies are numbers of its stops, its loads
//! and where it starts; what is kept are a few numbers of each run.
//!
//! A run depends on its own numbers alone. No bit of it depends on how many threads there are, on
//! the runs beside it or on their order.

mod parameters;
mod quantity;
mod reading;
mod workers;

pub use parameters::{Parameters, Start, StopNumber, StopValues};
pub use quantity::{EnergyTerm, ImpactColumn, LawMotion, OfRun, Pick, Quantity};
pub use workers::Progress;

use crate::error::{Error, Result};
use crate::law::AnyLaw;
use crate::method::{check_linear, piecewise_linear};
use crate::problem::Problem;
use reading::Reading;
use std::sync::Arc;

/// A problem, and what is kept of each run of it.
#[derive(Debug, Clone)]
pub struct Batch {
    problem: Problem<AnyLaw>,
    quantities: Vec<Quantity>,
    width: usize,
}

/// A run that could not be made.
#[derive(Debug, Clone, PartialEq)]
pub struct Failure {
    /// Its number.
    pub run: usize,
    /// Why.
    pub error: Error,
}

impl Batch {
    /// Checks that the problem can be solved and has what is asked for.
    ///
    /// # Errors
    /// When a law is not piecewise linear, or a quantity is of a law, mode or time that the
    /// problem has not.
    pub fn new(problem: Problem<AnyLaw>, quantities: Vec<Quantity>) -> Result<Self> {
        check_linear(piecewise_linear::NAME, &problem.laws)?;
        for quantity in &quantities {
            quantity.check(&problem)?;
        }
        let width = quantities.iter().map(Quantity::width).sum();
        Ok(Self {
            problem,
            quantities,
            width,
        })
    }

    /// How many numbers are kept of each run.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Makes all runs, on as many threads as are asked for, and returns those that failed, in
    /// order; their numbers are NaN.
    ///
    /// `values` gets a row of [`Batch::width`] numbers for each run. `progress` is told now and
    /// then, on the calling thread, how many runs there are; it answers whether to go on.
    ///
    /// # Errors
    /// When parameters do not fit the problem or there is no room for the numbers;
    /// [`Error::Interrupted`] when `progress` says so.
    pub fn run(
        &self,
        parameters: &Parameters<'_>,
        threads: usize,
        values: &mut [f64],
        progress: Progress<'_>,
    ) -> Result<Vec<Failure>> {
        parameters.check(&self.problem)?;
        if values.len() != parameters.runs * self.width {
            return Err(Error::Length {
                what: "the array of results",
                found: values.len(),
                expected: parameters.runs * self.width,
            });
        }
        workers::run(self, parameters, threads, values, progress)
    }

    /// Makes consecutive runs.
    fn part(
        &self,
        parameters: &Parameters<'_>,
        first: usize,
        values: &mut [f64],
        desk: &mut Desk,
        failures: &mut Vec<Failure>,
    ) {
        for (number, row) in values.chunks_exact_mut(self.width).enumerate() {
            let run = first + number;
            if let Err(error) = self.single(parameters, run, row, desk) {
                row.fill(f64::NAN);
                failures.push(Failure { run, error });
            }
        }
    }

    /// Makes one run as [`crate::method::simulate`] does.
    fn single(
        &self,
        parameters: &Parameters<'_>,
        run: usize,
        row: &mut [f64],
        desk: &mut Desk,
    ) -> Result<()> {
        let problem = Arc::make_mut(&mut desk.problem);
        parameters.set(&self.problem, run, problem)?;
        let history = piecewise_linear::simulate(&desk.problem, &mut |_| true)?;
        let mut reading = Reading::new(&history);
        let mut left = row;
        for quantity in &self.quantities {
            let (own, others) = left.split_at_mut(quantity.width());
            reading.read(quantity, own)?;
            left = others;
        }
        Ok(())
    }
}

/// What a thread works with.
struct Desk {
    /// The problem with the numbers of the present run.
    problem: Arc<Problem<AnyLaw>>,
}

impl Desk {
    fn new(batch: &Batch) -> Self {
        Self {
            problem: Arc::new(batch.problem.clone()),
        }
    }
}
