//! The central difference with steps that follow the frequency that the motion shows.
//!
//! `q1 = q + h v + h^2 a / 2`, `v1 = v + h (a + a1) / 2`: second order, and a step of its own for every
//! stretch of the motion. Forces that velocities enter see `v + h a`, memories and works go by Heun's
//! rule alike. The work of loads goes by the trapezoidal rule with `v1`: from rest under a load that
//! grows from zero `v + h a` is zero, and such a load would give nothing in the first step.
//!
//! How fast the motion is, is read from what the last step did to it: between its ends a mode with
//! the frequency w has `|a1 - a| = w^2 |q1 - q|`. The largest of these frequencies takes so many
//! points a period. A mode that hardly moves is not asked for its frequency by what it moves, but by
//! what it would with a small part of the largest speed. No step is shorter than the highest frequency
//! or damping would need that modes and laws in their present states have, nor much longer than half
//! the limit `2 / (c + sqrt(c^2 + w^2))` at which a root of the scheme passes -1, c the damping.
//!
//! Sources: the scheme, T. Belytschko, W. K. Liu, B. Moran, Nonlinear Finite Elements for Continua and
//! Structures, 2000, section 6.2; the apparent frequency, K. C. Park, P. G. Underwood, A
//! variable-step central difference method for structural dynamics analysis, Computer Methods in
//! Applied Mechanics and Engineering 22, 241-258, 1980.

use super::pieces::Pieces;
use super::stepping::{Attempt, Stepping};
use crate::error::{Error, Result};
use crate::law::Law;
use crate::method::polynomial_steps::{Equations, write_cubic};
use crate::system::Coupling;
use std::f64::consts::TAU;
use std::ops::Range;

/// The method's name.
pub const NAME: &str = "adaptive_central_difference";

/// Part of the largest speed so far that counts as the least of a mode.
const LEAST_SPEED: f64 = 0.01;

/// Part of the stability limit that no step exceeds.
const PART_OF_LIMIT: f64 = 0.5;

/// A step that is up to this many times too long is let pass, which keeps it below the limit; the
/// next is shorter.
const TOLERANCE: f64 = 1.5;

/// The most by which a step grows.
const GROWTH: f64 = 1.25;

/// How finely the motion is followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resolution {
    /// Steps a period of the fastest visible motion.
    pub points_per_period: f64,
}

impl Default for Resolution {
    fn default() -> Self {
        Self {
            points_per_period: 50.0,
        }
    }
}

impl Resolution {
    /// The least and the most points a period.
    pub const RANGE: [f64; 2] = [10.0, 1e7];

    /// Refuses points out of range.
    pub(super) fn check(self) -> Result<()> {
        Error::check_parameter("points_per_period", self.points_per_period, Self::RANGE)
    }
}

/// The numbers at both ends of a step.
pub(super) struct CentralDifference {
    /// The angle of the fastest visible motion in a step.
    turn: f64,
    start: Vec<f64>,
    end: Vec<f64>,
    /// Rates at both ends.
    rates: [Vec<f64>; 2],
    /// The shortest and the longest step at the start.
    bounds: [f64; 2],
    /// The largest modal speed so far.
    fastest: f64,
    pieces: Pieces,
}

impl CentralDifference {
    pub(super) fn new<L: Law>(
        resolution: Resolution,
        start: Vec<f64>,
        equations: &Equations<'_, L>,
    ) -> Self {
        let room = || vec![0.0; start.len()];
        let [_, v] = equations.layout.motion(&start);
        Self {
            turn: TAU / resolution.points_per_period,
            end: room(),
            rates: [room(), room()],
            bounds: [0.0, f64::INFINITY],
            fastest: largest(v),
            pieces: Pieces::new(start.len()),
            start,
        }
    }

    /// The shortest and the longest step that modes and laws, as these answer to numbers at a
    /// time, would need.
    fn bounds<L: Law>(&self, time: f64, numbers: &[f64], equations: &Equations<'_, L>) -> [f64; 2] {
        let system = &equations.problem.system;
        let [stiffness, damping] = equations.answers(time, numbers);
        let of = |matrix: Option<&Coupling>| matrix.map_or(0.0, Coupling::size);
        let highest = system.highest_frequency().powi(2) + stiffness + of(system.circulatory());
        let damping = largest(system.damping()) + damping + of(system.coupling());
        let limit = 2.0 / (damping + (damping * damping + highest).sqrt());
        [
            self.turn / highest.sqrt().max(damping),
            PART_OF_LIMIT * limit,
        ]
    }

    /// The displacements at the end of a step, and what forces see of the rest there.
    fn predict(&mut self, h: f64, modes: usize) {
        let first = &self.rates[0];
        for ((to, from), rate) in self.end.iter_mut().zip(&self.start).zip(first) {
            *to = from + h * rate;
        }
        for (to, acceleration) in self.end[..modes].iter_mut().zip(&first[modes..]) {
            *to += 0.5 * h * h * acceleration;
        }
    }

    /// All but the displacements at the end, from the rates at both ends.
    fn correct<L: Law>(&mut self, h: f64, equations: &Equations<'_, L>) {
        let modes = equations.layout.modes;
        self.add_mean_rates(h, modes..2 * modes);
        equations.correct_load_power(&self.end, &mut self.rates[1]);
        self.add_mean_rates(h, 2 * modes..self.end.len());
    }

    /// Some numbers at the end, by the trapezoidal rule.
    fn add_mean_rates(&mut self, h: f64, which: Range<usize>) {
        for i in which {
            self.end[i] = self.start[i] + 0.5 * h * (self.rates[0][i] + self.rates[1][i]);
        }
    }

    /// The highest frequency that the step from the start to the end shows, in rad/s.
    fn frequency(&self, h: f64, modes: usize) -> f64 {
        let [before, after] = [0, 1].map(|end| &self.rates[end][modes..2 * modes]);
        let speed = largest(&self.end[modes..2 * modes]);
        let least = LEAST_SPEED * self.fastest.max(speed) * h;
        let mut squared = 0.0f64;
        for i in 0..modes {
            let way = (self.end[i] - self.start[i]).abs().max(least);
            let change = (after[i] - before[i]).abs();
            if change > 0.0 {
                squared = squared.max(change / way);
            }
        }
        squared.sqrt()
    }
}

/// The largest size of some numbers.
fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0, |most, x| f64::max(most, x.abs()))
}

impl<L: Law> Stepping<L> for CentralDifference {
    fn degree(&self) -> usize {
        3
    }

    fn numbers(&mut self) -> &mut Vec<f64> {
        &mut self.start
    }

    fn start(&mut self, time: f64, equations: &mut Equations<'_, L>) {
        equations.rates(time, &self.start, &mut self.rates[0]);
        self.bounds = self.bounds(time, &self.start, equations);
    }

    fn attempt(&mut self, time: f64, h: f64, equations: &mut Equations<'_, L>) -> Attempt {
        let modes = equations.layout.modes;
        let [shortest, longest] = self.bounds;
        if h > TOLERANCE * longest {
            return Attempt::Again(longest);
        }
        self.predict(h, modes);
        equations.rates(time + h, &self.end, &mut self.rates[1]);
        self.correct(h, equations);
        let wanted = self.turn / self.frequency(h, modes);
        let [now, then] = [self.bounds, self.bounds(time + h, &self.end, equations)];
        let least = now[0].min(then[0]);
        let wanted = wanted.max(least).min(now[1]).min(then[1]);
        // What is no number is not fine enough, either.
        let fine = h <= TOLERANCE * wanted || h <= shortest.min(least);
        if !fine {
            return Attempt::Again(if wanted < h { wanted } else { 0.5 * h });
        }
        let [_, v] = equations.layout.motion(&self.end);
        self.fastest = self.fastest.max(largest(v));
        self.bounds = then;
        Attempt::Good(wanted.min(GROWTH * h))
    }

    fn follow(&mut self, _: f64, h: f64, _: &mut Equations<'_, L>) {
        let [first, last] = &self.rates;
        self.pieces.clear();
        write_cubic(
            h,
            [&self.start, &self.end],
            [first, last],
            self.pieces.next(),
        );
    }

    fn pieces(&self) -> &Pieces {
        &self.pieces
    }

    fn go_on(&mut self) {
        std::mem::swap(&mut self.start, &mut self.end);
        self.rates.swap(0, 1);
    }

    fn stop_at(&mut self, piece: usize, theta: f64) {
        self.pieces.dense(piece).at(theta, &mut self.start);
    }
}
