//! The error of a step, and the step that follows from it.
//!
//! The error of each number is measured by the largest that this number has been so far, since a
//! vibration passes zero over and over. Displacements that are small beside the largest of them
//! are measured by a part of that, and velocities alike, unless an absolute tolerance is given. A
//! law's memory is measured so by the motion that it goes with. What leaves rest is measured by what
//! its acceleration makes of it in the time of the first step that was tried: forces may begin with
//! any power of time, and a step that is measured by nothing but itself may never be good enough.
//! The largest ratio counts.
//!
//! The controller is proportional and integral: K. Gustafsson, Control theoretic techniques for
//! stepsize selection in explicit Runge-Kutta methods, ACM Transactions on Mathematical Software
//! 17, 533-554, 1991.

use super::stepping::Attempt;
use crate::error::{Error, Result};
use crate::law::Law;
use crate::method::polynomial_steps::{Equations, Layout};

/// How accurate a run is to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerances {
    /// Error of a step relative to the largest value that a number has had.
    pub relative: f64,
    /// Error that is let pass besides, in m and m/s of the modal coordinates; without one, numbers
    /// count as no smaller than [`SMALL`] of the largest of their kind.
    pub absolute: Option<f64>,
    /// Whether flights, in which no contact pushes and nothing smooth acts, are solved in closed
    /// form where the exact method does not take the problem.
    pub exact_flights: bool,
}

/// The finest relative tolerance: below it rounding rules the error estimate.
pub const FINEST: f64 = 1e-14;

/// Part of the largest displacement, or velocity, below which others are measured by that part.
pub const SMALL: f64 = 0.1;

/// Part taken of the step that the error just allows.
const SAFETY: f64 = 0.9;
/// The most by which a step shrinks and grows.
const FACTORS: [f64; 2] = [0.2, 5.0];
/// Exponents of the last error and of the one before, times the order of the error.
const EXPONENTS: [f64; 2] = [0.7, 0.4];
/// Errors below it count as this: a step that has none tells nothing of the next.
const LEAST: f64 = 1e-4;

impl Tolerances {
    /// Refuses tolerances out of range.
    pub(super) fn check(&self) -> Result<()> {
        if !(FINEST..1.0).contains(&self.relative) {
            return Err(Error::Tolerance {
                value: self.relative,
                finest: FINEST,
            });
        }
        match self.absolute {
            Some(value) if value < 0.0 || !value.is_finite() => Err(Error::Negative {
                what: "the absolute tolerance",
                value,
            }),
            _ => Ok(()),
        }
    }
}

/// Judges steps and proposes the next.
#[derive(Debug)]
pub(super) struct Control {
    tolerances: Tolerances,
    /// What the error estimate goes with: the power of the step.
    error_order: f64,
    /// The largest size of each number so far.
    sizes: Vec<f64>,
    scales: Vec<f64>,
    /// What memories are measured by besides, so far and at the end of the step that is tried.
    floors: [Vec<f64>; 2],
    /// Error of the last step that was taken.
    before: f64,
    /// The first step that is tried, in s.
    first_step: f64,
}

impl Control {
    pub(super) fn new(
        tolerances: Tolerances,
        error_order: f64,
        first_step: f64,
        start: &[f64],
        layout: &Layout,
    ) -> Self {
        let controlled = layout.works;
        Self {
            tolerances,
            error_order,
            sizes: start[..controlled].iter().map(|x| x.abs()).collect(),
            scales: vec![0.0; controlled],
            floors: [0, 1].map(|_| vec![0.0; controlled - 2 * layout.modes]),
            before: LEAST,
            first_step,
        }
    }

    /// Takes the measure of a step that ends at a time in given numbers.
    pub(super) fn measure<L: Law>(
        &mut self,
        stages: &[Vec<f64>],
        (time, end): (f64, &[f64]),
        equations: &Equations<'_, L>,
    ) {
        let layout = &equations.layout;
        equations.memory_sizes(time, end, &mut self.floors[1]);
        self.set_sizes(end, stages, layout);
        self.set_scales(layout);
    }

    /// Sees how large displacements and velocities have been.
    pub(super) fn see(&mut self, motion: &[f64]) {
        for (size, x) in self.sizes.iter_mut().zip(motion) {
            *size = size.max(x.abs());
        }
    }

    /// The error that is allowed in each number before the works, in the measure taken last.
    pub(super) fn scales(&self) -> &[f64] {
        &self.scales
    }

    /// The largest of the errors, one a number, over what is allowed.
    pub(super) fn largest(&self, errors: &[f64]) -> f64 {
        let mut largest = 0.0f64;
        for (error, scale) in errors.iter().zip(&self.scales) {
            // A number that has always been zero has no error, or has just left zero.
            let ratio = if *error == 0.0 {
                0.0
            } else {
                error.abs() / scale
            };
            largest = if ratio > largest || ratio.is_nan() {
                ratio
            } else {
                largest
            };
        }
        largest
    }

    /// Takes a step with an error over what is allowed, that ends in given numbers, or not.
    pub(super) fn judge(&mut self, h: f64, error: f64, end: &[f64]) -> Attempt {
        if error <= 1.0 {
            Attempt::Good(self.accept(h, error, end))
        } else {
            let error = if error.is_finite() {
                error
            } else {
                f64::INFINITY
            };
            let factor = SAFETY * error.powf(-1.0 / self.error_order);
            Attempt::Again(h * factor.max(FACTORS[0]))
        }
    }

    /// The step after one that is good.
    fn accept(&mut self, h: f64, error: f64, end: &[f64]) -> f64 {
        self.see(end);
        let [so_far, now] = &mut self.floors;
        for (floor, now) in so_far.iter_mut().zip(now) {
            *floor = floor.max(*now);
        }
        let error = error.max(LEAST);
        let [now, last] = EXPONENTS.map(|exponent| exponent / self.error_order);
        let factor = SAFETY * error.powf(-now) * self.before.powf(last);
        self.before = error;
        h * factor.clamp(FACTORS[0], FACTORS[1])
    }

    /// How large each number has been, the end of the step that is tried included.
    fn set_sizes(&mut self, end: &[f64], stages: &[Vec<f64>], layout: &Layout) {
        for ((scale, size), x) in self.scales.iter_mut().zip(&self.sizes).zip(end) {
            *scale = size.max(x.abs());
        }
        let modes = layout.modes;
        if self.sizes[..2 * modes].iter().any(|size| *size != 0.0) {
            return;
        }
        for mode in 0..modes {
            let accelerations = stages.iter().map(|stage| stage[modes + mode].abs());
            let speed = self.first_step * accelerations.fold(0.0, f64::max);
            let both = [(mode, 0.5 * self.first_step * speed), (modes + mode, speed)];
            for (at, floor) in both {
                self.scales[at] = self.scales[at].max(floor);
            }
        }
    }

    /// What the error of each number is measured by.
    fn set_scales(&mut self, layout: &Layout) {
        let Tolerances {
            relative, absolute, ..
        } = self.tolerances;
        let (motion, memories) = self.scales.split_at_mut(2 * layout.modes);
        for kind in motion.chunks_mut(layout.modes) {
            let largest = kind.iter().fold(0.0f64, |largest, x| largest.max(*x));
            for scale in kind {
                *scale = match absolute {
                    Some(absolute) => absolute + relative * *scale,
                    None => relative * scale.max(SMALL * largest),
                };
            }
        }
        let [so_far, now] = &self.floors;
        for (scale, (before, now)) in memories.iter_mut().zip(so_far.iter().zip(now)) {
            *scale = match absolute {
                Some(absolute) => absolute + relative * *scale,
                None => relative * scale.max(SMALL * before.max(*now)),
            };
        }
    }
}
