//! What is kept of a run.

use crate::error::{Error, Result, check_length};
use crate::history::Derivative;
use crate::impacts::Impact;
use crate::law::AnyLaw;
use crate::problem::Problem;

/// Something that is kept of each run: one number, or one at each of some instants.
#[derive(Debug, Clone, PartialEq)]
pub enum Quantity {
    /// A linear combination of the modal coordinates.
    Motion {
        /// Its factors.
        row: Vec<f64>,
        /// Which derivative in time.
        derivative: Derivative,
        /// Instants, in s.
        times: Vec<f64>,
    },
    /// What a law sees or does.
    Law {
        /// The law, by number.
        law: usize,
        /// What of it.
        motion: LawMotion,
        /// Instants, in s.
        times: Vec<f64>,
    },
    /// A term of the energy ledger.
    Energy {
        /// The term.
        term: EnergyTerm,
        /// Instants, in s.
        times: Vec<f64>,
    },
    /// An extreme value over the run of one of the three above, whose instants are samples: it is
    /// looked for between those next to the most extreme one.
    Extreme {
        /// What it is of.
        of: Box<Self>,
        /// Which: the largest, the smallest or the largest magnitude.
        pick: Pick,
    },
    /// A number of the impacts of a law; NaN where there is no such impact.
    Impacts {
        /// The law, by number.
        law: usize,
        /// Which of an impact's numbers.
        column: ImpactColumn,
        /// Of which impact.
        pick: Pick,
    },
    /// A number of each of the last impacts of a law, the latest behind; NaN in front where there
    /// are fewer.
    LastImpacts {
        /// The law, by number.
        law: usize,
        /// Which of an impact's numbers.
        column: ImpactColumn,
        /// Of how many.
        count: usize,
    },
    /// The largest force of a law, which its impacts have; NaN where it never pushes.
    LargestForce {
        /// The law, by number.
        law: usize,
    },
    /// How many impacts there are: on one law, or on all.
    ImpactCount {
        /// The law, by number.
        law: Option<usize>,
    },
    /// A number of the whole run.
    OfRun(OfRun),
}

/// What is seen of a law.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LawMotion {
    /// Distance, in m.
    Distance,
    /// Its rate, in m/s.
    Rate,
    /// Force along the first coordinate, in N.
    Force,
}

/// A term of the energy ledger, in J.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)] // as in `energy::Ledger`
pub enum EnergyTerm {
    Kinetic,
    Elastic,
    Stored,
    ModalDissipation,
    LawDissipation,
    LoadWork,
    CirculatoryWork,
    ObstacleWork,
}

/// A number of an impact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)] // as in `impacts::Impact`
pub enum ImpactColumn {
    Start,
    End,
    /// From closing to opening.
    Duration,
    ClosingSpeed,
    OpeningSpeed,
    PeakForce,
    PeakTime,
    Impulse,
    EnergyReturned,
}

/// Which of many numbers; those that are NaN do not count but for [`Pick::Number`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pick {
    /// That of this number, from 0.
    Number(usize),
    /// The largest.
    Largest,
    /// The smallest.
    Smallest,
    /// The largest magnitude.
    Peak,
    /// The last.
    Last,
}

/// A number of the whole run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OfRun {
    /// How often a law switched.
    Events,
    /// Certified cells.
    Steps,
    /// Largest imbalance of energy, relative to the largest energy.
    EnergyResidual,
    /// Bound of the motion's error within a phase, in m.
    MotionError,
    /// Bound of the depth of what was missed, in m.
    MissedPenetration,
}

impl Quantity {
    /// How many numbers it is.
    pub fn width(&self) -> usize {
        match self {
            Self::Motion { times, .. } | Self::Law { times, .. } | Self::Energy { times, .. } => {
                times.len()
            }
            Self::LastImpacts { count, .. } => *count,
            Self::Extreme { .. }
            | Self::Impacts { .. }
            | Self::LargestForce { .. }
            | Self::ImpactCount { .. }
            | Self::OfRun(_) => 1,
        }
    }

    /// The instants of a quantity of time; none of another.
    pub fn times(&self) -> &[f64] {
        match self {
            Self::Motion { times, .. } | Self::Law { times, .. } | Self::Energy { times, .. } => {
                times
            }
            _ => &[],
        }
    }

    pub(super) fn check(&self, problem: &Problem<AnyLaw>) -> Result<()> {
        match self {
            Self::Motion { row, times, .. } => {
                check_length("the row", row, problem.system.modes())?;
                check_times(times, problem.duration)
            }
            Self::Law { law, times, .. } => {
                check_law(*law, problem)?;
                check_times(times, problem.duration)
            }
            Self::Energy { times, .. } => check_times(times, problem.duration),
            Self::Extreme { of, .. } => of.check(problem),
            Self::Impacts { law, .. }
            | Self::LastImpacts { law, .. }
            | Self::LargestForce { law }
            | Self::ImpactCount { law: Some(law) } => check_law(*law, problem),
            Self::ImpactCount { law: None } | Self::OfRun(_) => Ok(()),
        }
    }
}

/// The largest force of all impacts; NaN where none pushes.
pub(super) fn largest_force(impacts: &[Impact]) -> f64 {
    let forces = impacts.iter().map(|impact| impact.peak_force);
    Pick::Largest.of(forces.filter(|force| *force > 0.0))
}

fn check_law(law: usize, problem: &Problem<AnyLaw>) -> Result<()> {
    if law < problem.laws.len() {
        Ok(())
    } else {
        Err(Error::NoLaw { law })
    }
}

fn check_times(times: &[f64], duration: f64) -> Result<()> {
    match times.iter().find(|t| !(0.0..=duration).contains(*t)) {
        None => Ok(()),
        Some(&time) => Err(Error::OutsideRun { time, duration }),
    }
}

impl ImpactColumn {
    /// Whether the states at both ends of an impact tell it.
    pub(super) fn is_of_ends(self) -> bool {
        matches!(
            self,
            Self::Start | Self::End | Self::Duration | Self::ClosingSpeed | Self::OpeningSpeed
        )
    }

    /// Whether it is of the largest force.
    pub(super) fn is_of_peak(self) -> bool {
        matches!(self, Self::PeakForce | Self::PeakTime)
    }

    /// The number of one impact.
    pub(super) fn of(self, impact: &Impact) -> f64 {
        match self {
            Self::Start => impact.start,
            Self::End => impact.end,
            Self::Duration => impact.end - impact.start,
            // A stop that is closed from the start closes with the speed -0.0, which is 0.
            Self::ClosingSpeed => impact.closing_speed + 0.0,
            Self::OpeningSpeed => impact.opening_speed,
            Self::PeakForce => impact.peak_force,
            Self::PeakTime => impact.peak_time,
            Self::Impulse => impact.impulse,
            Self::EnergyReturned => impact.energy_returned,
        }
    }
}

impl Pick {
    /// A value as what is largest where the one that is asked for is.
    pub(super) fn raised(self, value: f64) -> f64 {
        match self {
            Self::Smallest => -value,
            Self::Peak => value.abs(),
            Self::Largest | Self::Number(_) | Self::Last => value,
        }
    }

    /// The one of many; NaN where there is none.
    pub(super) fn of(self, mut values: impl Iterator<Item = f64>) -> f64 {
        if let Self::Number(number) = self {
            return values.nth(number).unwrap_or(f64::NAN);
        }
        let numbers = values.filter(|value| !value.is_nan());
        let found = match self {
            Self::Largest => numbers.reduce(f64::max),
            Self::Smallest => numbers.reduce(f64::min),
            Self::Peak => numbers.map(f64::abs).reduce(f64::max),
            Self::Number(_) | Self::Last => numbers.last(),
        };
        found.unwrap_or(f64::NAN)
    }
}
