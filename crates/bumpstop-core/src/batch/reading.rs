//! Reading what is kept of one run.

use super::quantity::{EnergyTerm, ImpactColumn, LawMotion, OfRun, Pick, Quantity, largest_force};
use crate::energy::Ledger;
use crate::error::Result;
use crate::history::History;
use crate::impacts::Impact;
use crate::law::AnyLaw;
use std::borrow::Cow;

/// How much closer each look at an extreme value goes, and how many looks there are.
const CLOSER: usize = 16;
const LOOKS: usize = 5;

/// A run that is read. What several quantities ask for is found once.
pub(super) struct Reading<'a> {
    history: &'a History<AnyLaw>,
    /// How many times as fast as the batch the run is.
    pace: f64,
    impacts: Vec<Option<Vec<Impact>>>,
    /// The same, of which instants and speeds alone are known.
    contacts: Vec<Option<Vec<Impact>>>,
}

impl<'a> Reading<'a> {
    pub(super) fn new(history: &'a History<AnyLaw>, pace: f64) -> Self {
        let laws = history.problem().laws.len();
        Self {
            history,
            pace,
            impacts: vec![None; laws],
            contacts: vec![None; laws],
        }
    }

    /// Writes the numbers of one quantity.
    pub(super) fn read(&mut self, quantity: &Quantity, to: &mut [f64]) -> Result<()> {
        match quantity {
            Quantity::Motion { times, .. }
            | Quantity::Law { times, .. }
            | Quantity::Energy { times, .. } => {
                to.copy_from_slice(&self.over_time(quantity, &self.turned_to(times))?);
            }
            Quantity::Extreme { of, pick } => to[0] = self.extreme(of, *pick)?,
            Quantity::Impacts { law, column, pick } => {
                let impacts = self.impacts(*law, *column).iter();
                to[0] = pick.of(impacts.map(|impact| column.of(impact)));
            }
            Quantity::LastImpacts { law, column, count } => {
                let impacts = self.impacts(*law, *column);
                let known = impacts.len().min(*count);
                let (without, with) = to.split_at_mut(count - known);
                without.fill(f64::NAN);
                for (to, impact) in with.iter_mut().zip(&impacts[impacts.len() - known..]) {
                    *to = column.of(impact);
                }
            }
            Quantity::LargestForce { law } => {
                to[0] = largest_force(self.impacts(*law, ImpactColumn::PeakForce));
            }
            Quantity::ImpactCount { law } => to[0] = self.count(*law) as f64,
            Quantity::OfRun(number) => to[0] = number.of(self.history),
        }
        Ok(())
    }

    /// A quantity of time at some instants of the run.
    fn over_time(&self, quantity: &Quantity, times: &[f64]) -> Result<Vec<f64>> {
        match quantity {
            Quantity::Motion {
                row, derivative, ..
            } => self.history.project(row, times, *derivative),
            Quantity::Law { law, motion, .. } => {
                let [distance, rate, force] = self.history.law_motion(*law, times)?;
                Ok(match motion {
                    LawMotion::Distance => distance,
                    LawMotion::Rate => rate,
                    LawMotion::Force => force,
                })
            }
            Quantity::Energy { term, .. } => {
                let ledgers = self.history.energy(times)?;
                Ok(ledgers.iter().map(|ledger| term.of(ledger)).collect())
            }
            _ => unreachable!("of one of the three"),
        }
    }

    /// An extreme value of a quantity of time, found ever closer about the most extreme sample.
    fn extreme(&self, of: &Quantity, pick: Pick) -> Result<f64> {
        let samples = of.times();
        let mut times = self.turned_to(samples).into_owned();
        let mut largest = f64::NEG_INFINITY;
        for _ in 0..=LOOKS {
            let values = self.over_time(of, &times)?;
            let mut best = 0;
            for (number, value) in values.iter().enumerate() {
                if pick.raised(*value) > pick.raised(values[best]) {
                    best = number;
                }
            }
            largest = largest.max(pick.raised(values[best]));
            let low = times[best.saturating_sub(1)];
            let high = times[(best + 1).min(times.len() - 1)];
            times = grid(low, high);
        }
        Ok(if pick == Pick::Smallest {
            -largest
        } else {
            largest
        })
    }

    /// How many impacts there are on one law, or on all.
    fn count(&mut self, law: Option<usize>) -> usize {
        match law {
            Some(law) => self.impacts(law, ImpactColumn::Start).len(),
            None => (0..self.history.problem().laws.len())
                .map(|law| self.impacts(law, ImpactColumn::Start).len())
                .sum(),
        }
    }

    /// The impacts of a law, of which a number is to be read.
    fn impacts(&mut self, law: usize, column: ImpactColumn) -> &[Impact] {
        if column.is_of_ends() && self.impacts[law].is_none() {
            return self.contacts[law].get_or_insert_with(|| self.history.contacts(law));
        }
        self.impacts[law].get_or_insert_with(|| self.history.impacts(law))
    }

    /// Instants of the batch as those of the run, as long as it lasts.
    fn turned_to<'t>(&self, times: &'t [f64]) -> Cow<'t, [f64]> {
        if self.pace == 1.0 {
            return Cow::Borrowed(times);
        }
        let duration = self.history.problem().duration;
        let turned = |time: &f64| (time / self.pace).min(duration);
        Cow::Owned(times.iter().map(turned).collect())
    }
}

/// Equally spread instants, both ends among them.
fn grid(low: f64, high: f64) -> Vec<f64> {
    let step = (high - low) / (2 * CLOSER) as f64;
    let mut times: Vec<f64> = (0..2 * CLOSER).map(|n| low + n as f64 * step).collect();
    times.push(high);
    times
}

impl EnergyTerm {
    fn of(self, ledger: &Ledger) -> f64 {
        match self {
            Self::Kinetic => ledger.kinetic,
            Self::Elastic => ledger.elastic,
            Self::Stored => ledger.law_stored.iter().sum(),
            Self::ModalDissipation => ledger.modal_dissipation,
            Self::LawDissipation => ledger.law_dissipated.iter().sum(),
            Self::LoadWork => ledger.load_work,
            Self::CirculatoryWork => ledger.circulatory_work,
            Self::ObstacleWork => ledger.obstacle_work,
        }
    }
}

impl OfRun {
    fn of(self, history: &History<AnyLaw>) -> f64 {
        match self {
            Self::Events => history.events().len() as f64,
            Self::Steps => history.steps() as f64,
            Self::EnergyResidual => history.energy_residual(),
            Self::MotionError => history.motion_error().unwrap_or(f64::NAN),
            Self::MissedPenetration => history.missed_penetration().unwrap_or(f64::NAN),
        }
    }
}
