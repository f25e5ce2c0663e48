//! What varies from run to run.

use crate::error::{Error, Result, check_finite, check_length};
use crate::law::{AnyLaw, Stop};
use crate::problem::Problem;

/// Which number of a stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StopNumber {
    /// Gap, in m.
    Gap,
    /// Stiffness, in N/m.
    Stiffness,
    /// Damping, in N s/m.
    Damping,
}

/// One number of one stop in each run.
#[derive(Debug, Clone, Copy)]
pub struct StopValues<'a> {
    /// The stop, by its number among the laws.
    pub law: usize,
    /// Which number it is.
    pub number: StopNumber,
    /// Its values, one a run.
    pub values: &'a [f64],
}

/// Modal displacements or velocities at the start of each run.
#[derive(Debug, Clone, Copy)]
pub enum Start<'a> {
    /// Those of the problem.
    Same,
    /// Those of the problem times a factor, one a run.
    Scaled(&'a [f64]),
    /// Rows of one number for each mode, one a run.
    Given(&'a [f64]),
}

/// What varies, one value a run.
#[derive(Debug, Clone)]
pub struct Parameters<'a> {
    /// How many runs there are.
    pub runs: usize,
    /// Numbers of stops.
    pub stops: Vec<StopValues<'a>>,
    /// Displacements at the start.
    pub displacement: Start<'a>,
    /// Velocities at the start.
    pub velocity: Start<'a>,
    /// Factors of all loads.
    pub loads: Option<&'a [f64]>,
    /// How many times as fast loads and obstacles move; a run then lasts so many times less long,
    /// and what is kept at given times is kept so many times earlier.
    pub pace: Option<&'a [f64]>,
    /// So many consecutive runs make a chain: each but its first starts from the state in which
    /// the one before it ended. 1 where every run starts by itself.
    pub chain: usize,
}

impl Parameters<'_> {
    /// Checks lengths, and that what varies is there.
    pub(super) fn check(&self, problem: &Problem<AnyLaw>) -> Result<()> {
        let modes = problem.system.modes();
        for stop in &self.stops {
            if !matches!(problem.laws.get(stop.law), Some(AnyLaw::Stop(_))) {
                return Err(Error::NoStop { law: stop.law });
            }
            check_length("a stop's values", stop.values, self.runs)?;
        }
        for start in [self.displacement, self.velocity] {
            match start {
                Start::Same => {}
                Start::Scaled(factors) => check_length("factors of the start", factors, self.runs)?,
                Start::Given(rows) => check_length("the start", rows, self.runs * modes)?,
            }
        }
        for factors in [self.loads, self.pace].into_iter().flatten() {
            check_length("factors of the loads", factors, self.runs)?;
        }
        if self.chain == 0 || !self.runs.is_multiple_of(self.chain) {
            return Err(Error::Length {
                what: "the last chain of runs",
                found: self.runs.checked_rem(self.chain).unwrap_or(0),
                expected: self.chain.max(1),
            });
        }
        Ok(())
    }

    /// Whether runs start where others end.
    pub(super) fn is_chained(&self) -> bool {
        self.chain > 1
    }

    /// How many times as fast loads are in a run.
    pub(super) fn pace(&self, run: usize) -> f64 {
        self.pace.map_or(1.0, |factors| factors[run])
    }

    /// Gap, stiffness and damping of the only law in a run, none of them checked.
    #[inline(always)]
    pub(super) fn stop(&self, run: usize, base: &Stop) -> [f64; 3] {
        let mut numbers = [base.gap(), base.stiffness(), base.damping()];
        for stop in &self.stops {
            numbers[stop.number as usize] = stop.values[run];
        }
        numbers
    }

    /// Sets a problem to the numbers of one run; `base` has those that do not vary.
    pub(super) fn set(
        &self,
        base: &Problem<AnyLaw>,
        run: usize,
        problem: &mut Problem<AnyLaw>,
    ) -> Result<()> {
        for stop in &self.stops {
            if let AnyLaw::Stop(law) = &mut problem.laws[stop.law] {
                let value = stop.values[run];
                match stop.number {
                    StopNumber::Gap => law.set_gap(value)?,
                    StopNumber::Stiffness => law.set_stiffness(value)?,
                    StopNumber::Damping => law.set_damping(value)?,
                }
            }
        }
        self.displacement
            .set(run, &base.displacement, &mut problem.displacement);
        self.velocity
            .set(run, &base.velocity, &mut problem.velocity);
        check_finite("displacement", &problem.displacement)?;
        check_finite("velocity", &problem.velocity)?;
        self.set_loads(base, run, problem)
    }

    fn set_loads(
        &self,
        base: &Problem<AnyLaw>,
        run: usize,
        problem: &mut Problem<AnyLaw>,
    ) -> Result<()> {
        if let Some(factors) = self.loads {
            check_finite("a factor of the loads", &factors[run..=run])?;
            problem.forcing = base.forcing.scaled(factors[run]);
        }
        let Some(factors) = self.pace else {
            return Ok(());
        };
        let pace = factors[run];
        check_finite("the pace of the loads", &[pace])?;
        if pace <= 0.0 {
            return Err(Error::NotPositive {
                what: "the pace of the loads",
                value: pace,
            });
        }
        let own = if self.loads.is_some() {
            &problem.forcing
        } else {
            &base.forcing
        };
        problem.forcing = own.faster(pace);
        problem.duration = base.duration / pace;
        Ok(())
    }
}

impl Start<'_> {
    /// The number of one mode in a run.
    #[inline(always)]
    pub(super) fn of(&self, run: usize, base: &[f64], mode: usize) -> f64 {
        match self {
            Start::Same => base[mode],
            Start::Scaled(factors) => factors[run] * base[mode],
            Start::Given(rows) => rows[run * base.len() + mode],
        }
    }

    pub(super) fn set(&self, run: usize, base: &[f64], to: &mut [f64]) {
        match self {
            Start::Same => {}
            Start::Scaled(factors) => {
                for (to, base) in to.iter_mut().zip(base) {
                    *to = factors[run] * base;
                }
            }
            Start::Given(rows) => {
                to.copy_from_slice(&rows[run * base.len()..(run + 1) * base.len()]);
            }
        }
    }
}
