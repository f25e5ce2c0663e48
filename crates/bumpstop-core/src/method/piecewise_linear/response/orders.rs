//! What a load gives to the modes with each of its derivatives and integrals.

use super::parts::Parts;
use crate::method::piecewise_linear::spectrum::Spectrum;
use std::collections::BTreeMap;

/// Numbers for the parts of a spectrum, by the order of the derivative; integrals are negative.
pub(super) struct Orders {
    parts: BTreeMap<i32, Parts>,
    groups: usize,
    zero: Parts,
}

impl Orders {
    /// Nothing yet, but the load itself.
    pub(super) fn new(spectrum: &Spectrum) -> Self {
        let zero = Parts {
            combined: vec![0.0; spectrum.combinations],
            singles: vec![0.0; spectrum.singles.len()],
        };
        Self {
            parts: BTreeMap::from([(0, zero.clone())]),
            groups: spectrum.groups,
            zero,
        }
    }

    fn at(&mut self, order: i32) -> &mut Parts {
        let zero = &self.zero;
        self.parts.entry(order).or_insert_with(|| zero.clone())
    }

    /// The coupled groups: combinations that are alone have numbers behind them.
    pub(super) fn groups(&mut self, order: i32) -> &mut [f64] {
        let groups = self.groups;
        &mut self.at(order).combined[..groups]
    }

    /// Takes a series of the groups, whose orders begin with this one and go up or down.
    pub(super) fn set_groups(&mut self, orders: impl Iterator<Item = i32>, series: &[Vec<f64>]) {
        for (order, row) in orders.zip(series) {
            self.groups(order).copy_from_slice(row);
        }
    }

    /// The same of a motion by itself.
    pub(super) fn set_single(
        &mut self,
        single: usize,
        orders: impl Iterator<Item = i32>,
        series: &[f64],
    ) {
        for (order, x) in orders.zip(series) {
            self.at(order).singles[single] = *x;
        }
    }

    /// All, the lowest order first.
    pub(super) fn all(self) -> impl Iterator<Item = (i32, Parts)> {
        self.parts.into_iter()
    }
}
