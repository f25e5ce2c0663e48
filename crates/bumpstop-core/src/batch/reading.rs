//! Reading what is kept of one run.

use super::quantity::{EnergyTerm, ImpactColumn, LawMotion, OfRun, Quantity};
use crate::energy::Ledger;
use crate::error::Result;
use crate::history::History;
use crate::impacts::Impact;
use crate::law::AnyLaw;
use std::borrow::Cow;

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
            Quantity::Motion {
                row,
                derivative,
                times,
            } => {
                let times = self.turned_to(times);
                to.copy_from_slice(&self.history.project(row, &times, *derivative)?);
            }
            Quantity::Law { law, motion, times } => {
                let times = self.turned_to(times);
                let [distance, rate, force] = self.history.law_motion(*law, &times)?;
                to.copy_from_slice(match motion {
                    LawMotion::Distance => &distance,
                    LawMotion::Rate => &rate,
                    LawMotion::Force => &force,
                });
            }
            Quantity::Energy { term, times } => {
                let times = self.turned_to(times);
                for (to, ledger) in to.iter_mut().zip(self.history.energy(&times)?) {
                    *to = term.of(&ledger);
                }
            }
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
            Quantity::ImpactCount { law } => to[0] = self.count(*law) as f64,
            Quantity::OfRun(number) => to[0] = number.of(self.history),
        }
        Ok(())
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
