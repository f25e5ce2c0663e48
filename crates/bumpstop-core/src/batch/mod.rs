//! Many runs of one problem by the exact method: what varies are numbers of its stops, its loads
//! and where it starts; what is kept are a few numbers of each run.
//!
//! A run depends on its own numbers alone. No bit of it depends on how many threads there are, on
//! the runs beside it or on their order.

mod chain;
mod lanes;
mod parameters;
mod quantity;
mod reading;
mod workers;

pub use parameters::{Parameters, Start, StopNumber, StopValues};
pub use quantity::{EnergyTerm, ImpactColumn, LawMotion, OfRun, Pick, Quantity};
pub use workers::Progress;

use crate::error::{Error, Result};
use crate::history::History;
use crate::law::AnyLaw;
use crate::method::{check_linear, check_steady, piecewise_linear};
use crate::number::dispatch;
use crate::problem::Problem;
use lanes::{Bench, Common, Part};
use reading::Reading;
use std::sync::Arc;

/// A problem, and what is kept of each run of it.
#[derive(Debug, Clone)]
pub struct Batch {
    problem: Problem<AnyLaw>,
    quantities: Vec<Quantity>,
    width: usize,
    /// What lanes need, where they are asked for and can make the runs.
    common: Option<Box<Common>>,
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
        check_steady(piecewise_linear::NAME, &problem.system)?;
        for quantity in &quantities {
            quantity.check(&problem)?;
        }
        let width = quantities.iter().map(Quantity::width).sum();
        Ok(Self {
            problem,
            quantities,
            width,
            common: None,
        })
    }

    /// The same, eight runs at a time where the problem and what is asked for allow it. Results
    /// differ from those of single runs by rounding, and no event does.
    pub fn in_lanes(mut self) -> Self {
        self.common = Common::of(&self.problem, &self.quantities).map(Box::new);
        self
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
        let mut left = std::mem::take(&mut desk.left);
        left.clear();
        match (&self.common, &mut desk.bench) {
            (Some(common), Some(bench)) => dispatch(Part {
                common,
                problem: &self.problem,
                parameters,
                first,
                values,
                bench,
                left: &mut left,
            }),
            _ => left.extend(0..values.len() / self.width),
        }
        for number in &left {
            let row = &mut values[number * self.width..(number + 1) * self.width];
            failures.extend(self.single(parameters, first + number, row, desk));
        }
        desk.left = left;
    }

    /// Makes one run by itself; returns why where it failed.
    fn single(
        &self,
        parameters: &Parameters<'_>,
        run: usize,
        row: &mut [f64],
        desk: &mut Desk,
    ) -> Option<Failure> {
        let problem = Arc::make_mut(&mut desk.problem);
        let history = (parameters.set(&self.problem, run, problem))
            .and_then(|()| piecewise_linear::simulate(&desk.problem, &mut |_| true));
        let read = history.and_then(|history| self.read(&history, parameters.pace(run), row));
        let error = read.err()?;
        row.fill(f64::NAN);
        Some(Failure { run, error })
    }

    /// Reads what is kept of a run.
    fn read(&self, history: &History<AnyLaw>, pace: f64, row: &mut [f64]) -> Result<()> {
        let mut reading = Reading::new(history, pace);
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
    bench: Option<Bench>,
    /// Runs of a part that are made by themselves, counted from its first.
    left: Vec<usize>,
}

impl Desk {
    fn new(batch: &Batch) -> Self {
        Self {
            problem: Arc::new(batch.problem.clone()),
            bench: batch.common.as_ref().map(|common| common.bench()),
            left: Vec::new(),
        }
    }
}
