//! Stops that are touched without load: distance, speed and acceleration are zero to rounding.
//!
//! Between two stops that face each other without clearance a coordinate may stay at zero, because
//! the motion is symmetric or has died out. What is computed of it is rounding, which the stops
//! would answer by switching for ever at one instant. Any of their states is right then: their
//! forces are rounding, too. So they keep those that they have until they are left or pressed by
//! more than the rounding of the motion, and the certificate tells how much that is.

use crate::law::{Affine, Law, State, Stop};
use crate::method::instant::{self, Moment};
use crate::problem::Problem;

/// Rounding of a sum over modes, relative to the sizes of its terms.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// How much further than its rounding a distance must go before its stop switches: what one phase
/// rounds must not end the next.
const MARGIN: f64 = 4.0;

/// How far stops that are touched without load may go before they switch.
#[derive(Debug, Clone, Default)]
pub(crate) struct Still {
    /// For each law; empty where no stop is still.
    margins: Vec<Margin>,
}

/// Rounding of a stop's distance, in m, and of its rate, in m/s; zero where it is not still.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Margin {
    distance: f64,
    rate: f64,
}

impl Margin {
    fn times(self, factor: f64) -> Self {
        Self {
            distance: factor * self.distance,
            rate: factor * self.rate,
        }
    }

    /// The same of a function of both.
    fn of(self, function: &Affine) -> f64 {
        function.position[0].abs() * self.distance + function.velocity[0].abs() * self.rate
    }
}

impl Still {
    /// How far a function of a law's distance and rate may go below zero.
    #[inline(always)]
    pub(crate) fn margin(&self, law: usize, function: &Affine) -> f64 {
        match self.margins.get(law) {
            Some(margin) => margin.of(function),
            None => 0.0,
        }
    }

    /// Whether a law is a stop that is still.
    pub(crate) fn is(&self, law: usize) -> bool {
        self.margins[law] != Margin::default()
    }

    /// Lets a law that has switched be as others are.
    #[inline(always)]
    pub(crate) fn release(&mut self, law: usize) {
        if let Some(margin) = self.margins.get_mut(law) {
            *margin = Margin::default();
        }
    }

    /// Finds the stops that are still in a motion whose fastest angular frequency is given, in
    /// rad/s; returns the largest distance that one of them may go, in m.
    #[cold]
    pub(crate) fn find<L: Law>(
        &mut self,
        problem: &Problem<L>,
        states: &[State],
        fastest: f64,
        moment: Moment<'_>,
    ) -> f64 {
        let (reach, speed) = (largest(moment.displacement), largest(moment.velocity));
        let rounding = Margin {
            distance: ROUNDING * reach.max(speed / fastest),
            rate: ROUNDING * speed.max(reach * fastest),
        };
        self.margins.clear();
        let margin_of = |(index, law): (usize, &L)| match law.as_stop() {
            Some(stop) if is_still(problem, states, (index, stop), rounding, moment) => {
                rounding.times(MARGIN * sum_of(&law.rows()[0]))
            }
            _ => Margin::default(),
        };
        let laws = problem.laws.iter().enumerate();
        self.margins.extend(laws.map(margin_of));
        let distances = self.margins.iter().map(|margin| margin.distance);
        distances.fold(0.0, f64::max)
    }
}

/// Whether distance, speed and acceleration of a stop are rounding, for that of modal coordinates:
/// so are accelerations that the stops make of it.
fn is_still<L: Law>(
    problem: &Problem<L>,
    states: &[State],
    (index, stop): (usize, &Stop),
    rounding: Margin,
    moment: Moment<'_>,
) -> bool {
    let motion = instant::acting(problem, states, (index, states[index]), moment);
    let row = &stop.rows()[0];
    let own = rounding.times(sum_of(row));
    let pushed: f64 = (problem.laws.iter().filter_map(Law::as_stop))
        .map(|other| rounding_of_push(other, rounding) * product(row, &other.rows()[0]).abs())
        .sum();
    let [x, v, a, _] = motion.derivatives.map(|local| local[0]);
    (stop.gap() + x).abs() <= own.distance
        && v.abs() <= own.rate
        && a.abs() <= motion.zero[2] + pushed
}

/// What the rounding of modal coordinates makes of a stop's force, in N.
fn rounding_of_push(stop: &Stop, rounding: Margin) -> f64 {
    let own = rounding.times(sum_of(&stop.rows()[0]));
    stop.stiffness() * own.distance + stop.damping() * own.rate
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, x| most.max(x.abs()))
}

/// The sum of the sizes of a row's entries.
fn sum_of(row: &[f64]) -> f64 {
    row.iter().map(|x| x.abs()).sum()
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
