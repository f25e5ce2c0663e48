//! Zeros of a guard inside a bracket, and the least value of a convex one.

use super::curved::{Curved, Functions};
use super::phase::{Phase, Phases};
use super::rows::ComplexBlock;
use super::signal::{Instant, Signal};
use crate::number::Instructions;

/// Most iterations when a bracketed zero is refined; bisection alone needs about sixty.
const REFINEMENTS: usize = 100;

/// A Halley step below this part of its bracket is the last.
const SMALL_STEP: f64 = 2e-6;

/// Where a zero is, and a guess of it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bracket {
    pub left: f64,
    pub right: f64,
    guess: f64,
}

/// A guard along a phase.
#[derive(Clone, Copy)]
pub(crate) enum Watched<'a> {
    /// A sum of exponentials.
    Affine(&'a Signal),
    /// A function of such sums.
    Curved(&'a Curved, &'a dyn Functions),
}

/// A guard that can be evaluated at any time.
pub(crate) struct Probe<'a> {
    pub phases: &'a Phases,
    pub phase: Phase,
    pub guard: Watched<'a>,
    /// Room for the exponentials.
    pub exponentials: &'a mut [ComplexBlock],
}

impl Probe<'_> {
    /// Value and first two derivatives.
    #[inline(always)]
    pub(crate) fn values<I: Instructions>(&mut self, time: f64) -> [f64; 3] {
        let spectrum = &self.phases.spectra[self.phase.spectrum];
        spectrum.exponentials::<I>(time, self.exponentials);
        let at = Instant {
            time,
            exponentials: self.exponentials,
        };
        match self.guard {
            Watched::Affine(signal) => signal.values::<I>(self.phases, self.phase, &at),
            Watched::Curved(curved, functions) => {
                let jet = curved.at(functions, self.phases, self.phase, &at);
                [jet.value, jet.slope, jet.curvature]
            }
        }
    }

    /// Bound of the rounding of its value up to a time.
    #[inline(always)]
    fn rounding<I: Instructions>(&mut self, time: f64) -> f64 {
        match self.guard {
            Watched::Affine(signal) => signal.rounding(time),
            Watched::Curved(curved, functions) => {
                let spectrum = &self.phases.spectra[self.phase.spectrum];
                spectrum.exponentials::<I>(time, self.exponentials);
                let at = Instant {
                    time,
                    exponentials: self.exponentials,
                };
                curved.at(functions, self.phases, self.phase, &at).rest[0]
            }
        }
    }
}

impl Bracket {
    /// The guess is used where it lies inside.
    #[inline(always)]
    pub(crate) fn new(left: f64, right: f64, guess: f64) -> Self {
        let inside = guess > left && guess < right;
        Self {
            left,
            right,
            guess: if inside { guess } else { 0.5 * (left + right) },
        }
    }

    /// Looks for the least value of a guard that is convex inside, with at least the given
    /// curvature. A negative one ends a bracket; one that is zero to rounding is a touch, after
    /// which the right end decides. `margin` bounds the rounding of a parabola on the bracket.
    #[inline(always)]
    pub(crate) fn valley<I: Instructions>(
        self,
        probe: &mut Probe<'_>,
        curvature: f64,
        margin: f64,
    ) -> Option<Self> {
        let rounding = probe.rounding::<I>(self.right);
        let (mut low, mut high) = (self.left, self.right);
        let mut t = 0.5 * (low + high);
        for _ in 0..REFINEMENTS {
            let values = probe.values::<I>(t);
            // A convex function lies above every such parabola.
            let least = values[0] - 0.5 * values[1] * values[1] / curvature;
            if least > margin {
                return None;
            }
            if values[0] < -rounding {
                return Some(Self::new(self.left, t, self.guess));
            }
            if values[1] > 0.0 {
                high = t;
            } else {
                low = t;
            }
            let newton = t - values[1] / values[2];
            let inside = newton > low && newton < high;
            let next = if inside { newton } else { 0.5 * (low + high) };
            if (next - t).abs() <= 4.0 * f64::EPSILON * t || next == t {
                break;
            }
            t = next;
        }
        Some(Self::new(low, self.right, self.guess))
    }

    /// The zero between a positive left and a negative right end, by Halley's method kept
    /// inside the bracket.
    #[inline(always)]
    pub(crate) fn refine<I: Instructions>(self, probe: &mut Probe<'_>) -> f64 {
        let (mut low, mut high) = (self.left, self.right);
        let mut t = self.guess;
        for _ in 0..REFINEMENTS {
            let [value, slope, curvature] = probe.values::<I>(t);
            if value > 0.0 {
                low = t;
            } else {
                high = t;
            }
            let newton = value / slope;
            let halley = t - newton / (1.0 - 0.5 * newton * curvature / slope);
            let next = if halley > low && halley < high {
                halley
            } else {
                0.5 * (low + high)
            };
            let step = (next - t).abs();
            t = next;
            // The error after a Halley step goes with the cube of the step.
            if step < SMALL_STEP * (self.right - self.left) && halley == next
                || high - low <= 2.0 * f64::EPSILON * t
            {
                break;
            }
        }
        t
    }
}
