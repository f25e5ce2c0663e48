//! What is kept of runs in lanes.

use crate::batch::quantity::{ImpactColumn, LawMotion, OfRun, Pick, Quantity};
use crate::history::Derivative;

/// What is read at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Item {
    /// A linear combination, or its rate.
    Motion { row: usize, is_rate: bool },
    /// The distance, or its rate.
    Distance { is_rate: bool },
    /// The stop's force.
    Force,
}

/// An instant, and what is read there, each with the number of its result.
#[derive(Debug, Clone)]
pub(super) struct Sample {
    pub time: f64,
    pub items: Vec<(Item, usize)>,
}

/// What is read of the impacts, once all are known.
#[derive(Debug, Clone, Copy)]
pub(super) enum OfImpacts {
    /// A number of one or several of them.
    Number(ImpactColumn, Pick),
    /// How many there are.
    Count,
    /// How often the stop switched.
    Events,
    /// The largest force.
    LargestForce,
}

/// All that is read.
#[derive(Debug, Clone, Default)]
pub(super) struct Plan {
    /// How many numbers.
    pub width: usize,
    /// Linear combinations of the modal coordinates.
    pub rows: Vec<Vec<f64>>,
    /// In order of time.
    pub samples: Vec<Sample>,
    /// Whether the peaks of impacts are looked for.
    pub needs_peaks: bool,
    /// Each with the number of its result.
    pub of_impacts: Vec<(OfImpacts, usize)>,
}

impl Plan {
    /// `None` where something is asked for that is not read in lanes.
    pub(super) fn new(quantities: &[Quantity]) -> Option<Self> {
        let mut plan = Self::default();
        for quantity in quantities {
            plan.add(quantity)?;
            plan.width += quantity.width();
        }
        plan.samples.sort_by(|a, b| a.time.total_cmp(&b.time));
        Some(plan)
    }

    fn add(&mut self, quantity: &Quantity) -> Option<()> {
        match quantity {
            Quantity::Motion {
                row,
                derivative,
                times,
            } => {
                let is_rate = rate(*derivative)?;
                let row = self.row(row);
                self.sample(Item::Motion { row, is_rate }, times);
            }
            Quantity::Law { motion, times, .. } => {
                let item = match motion {
                    LawMotion::Distance => Item::Distance { is_rate: false },
                    LawMotion::Rate => Item::Distance { is_rate: true },
                    LawMotion::Force => Item::Force,
                };
                self.sample(item, times);
            }
            Quantity::Impacts { column, pick, .. }
                if column.is_of_ends() || column.is_of_peak() =>
            {
                self.needs_peaks |= column.is_of_peak();
                self.count(OfImpacts::Number(*column, *pick));
            }
            Quantity::LargestForce { .. } => {
                self.needs_peaks = true;
                self.count(OfImpacts::LargestForce);
            }
            Quantity::ImpactCount { .. } => self.count(OfImpacts::Count),
            Quantity::OfRun(OfRun::Events) => self.count(OfImpacts::Events),
            Quantity::Extreme { .. }
            | Quantity::Impacts { .. }
            | Quantity::LastImpacts { .. }
            | Quantity::OfRun(_)
            | Quantity::Energy { .. } => return None,
        }
        Some(())
    }

    fn count(&mut self, what: OfImpacts) {
        self.of_impacts.push((what, self.width));
    }

    /// The number of a row, which is kept once.
    fn row(&mut self, row: &[f64]) -> usize {
        let known = self.rows.iter().position(|known| known == row);
        known.unwrap_or_else(|| {
            self.rows.push(row.to_vec());
            self.rows.len() - 1
        })
    }

    /// Reads something at some instants; all that is read at one of them is read together.
    fn sample(&mut self, item: Item, times: &[f64]) {
        for (number, time) in times.iter().enumerate() {
            let place = (item, self.width + number);
            match self.samples.iter_mut().find(|known| known.time == *time) {
                Some(known) => known.items.push(place),
                None => self.samples.push(Sample {
                    time: *time,
                    items: vec![place],
                }),
            }
        }
    }
}

fn rate(derivative: Derivative) -> Option<bool> {
    match derivative {
        Derivative::Displacement => Some(false),
        Derivative::Velocity => Some(true),
        Derivative::Acceleration => None,
    }
}
