//! The directions along which rigid stops push.

use crate::eigen::symmetric_eigen;
use crate::law::{Law, State};
use crate::problem::Problem;
use faer::Mat;

/// Below this part of the largest eigenvalue of `R R'` rows depend on each other.
const DEPENDENT: f64 = 1e-12;

/// The rows R of some laws.
#[derive(Debug)]
pub(crate) struct Directions<'a> {
    /// The laws, by number.
    pub laws: Vec<usize>,
    /// The row of each.
    pub rows: Vec<&'a [f64]>,
}

impl<'a> Directions<'a> {
    /// The first rows of some laws.
    pub(crate) fn of<L: Law>(problem: &'a Problem<L>, laws: Vec<usize>) -> Self {
        let rows = (laws.iter())
            .map(|&law| problem.laws[law].rows()[0].as_slice())
            .collect();
        Self { laws, rows }
    }

    /// The rows of what laws hold in the given states.
    pub(crate) fn held<L: Law>(problem: &'a Problem<L>, states: &[State]) -> Self {
        let (mut laws, mut rows) = (Vec::new(), Vec::new());
        for (number, (law, state)) in problem.laws.iter().zip(states).enumerate() {
            if let Some(held) = law.constraint(*state) {
                laws.push(number);
                rows.push(law.rows()[held.coordinate].as_slice());
            }
        }
        Self { laws, rows }
    }

    /// Some of them.
    pub(crate) fn some(&self, places: &[usize]) -> Self {
        Self {
            laws: places.iter().map(|&i| self.laws[i]).collect(),
            rows: places.iter().map(|&i| self.rows[i]).collect(),
        }
    }

    /// `R x`
    pub(crate) fn project(&self, modal: &[f64]) -> Vec<f64> {
        let along = |row: &&[f64]| row.iter().zip(modal).map(|(r, x)| r * x).sum();
        self.rows.iter().map(along).collect()
    }

    /// The sums of the sizes that `R x` is made of, for bounds of its rounding.
    pub(crate) fn sizes(&self, modal: &[f64]) -> Vec<f64> {
        let along = |row: &&[f64]| row.iter().zip(modal).map(|(r, x)| (r * x).abs()).sum();
        self.rows.iter().map(along).collect()
    }

    /// Adds `R' s`.
    pub(crate) fn add(&self, impulses: &[f64], modal: &mut [f64]) {
        for (row, impulse) in self.rows.iter().zip(impulses) {
            if *impulse != 0.0 {
                for (x, r) in modal.iter_mut().zip(*row) {
                    *x += r * impulse;
                }
            }
        }
    }

    /// `W = R R'`
    pub(crate) fn delassus(&self) -> Mat<f64> {
        let n = self.rows.len();
        Mat::from_fn(n, n, |i, j| {
            let both = self.rows[i].iter().zip(self.rows[j]);
            both.map(|(a, b)| a * b).sum::<f64>()
        })
    }

    /// The least impulses that change `R v` by so much, as far as dependent rows allow.
    pub(crate) fn impulses(&self, change: &[f64]) -> Vec<f64> {
        let n = self.rows.len();
        let delassus = self.delassus();
        if n <= 1 {
            let alone = |change: &f64| change / delassus[(0, 0)];
            return change.iter().map(alone).collect();
        }
        let Ok(eigen) = symmetric_eigen(&delassus) else {
            return vec![f64::NAN; n];
        };
        let (vectors, values) = (eigen.vectors, eigen.values);
        let largest = values[n - 1];
        let mut impulses = vec![0.0; n];
        for k in (0..n).filter(|&k| values[k] > DEPENDENT * largest) {
            let part: f64 = (0..n).map(|i| vectors[(i, k)] * change[i]).sum();
            for (i, impulse) in impulses.iter_mut().enumerate() {
                *impulse += vectors[(i, k)] * part / values[k];
            }
        }
        impulses
    }

    /// The reactions that keep `R q''` at zero against accelerations without them.
    pub(crate) fn reactions(&self, acceleration: &[f64]) -> Vec<f64> {
        let lack: Vec<f64> = (self.project(acceleration).iter()).map(|a| -a).collect();
        self.impulses(&lack)
    }
}
