//! Curved guards along a step: enclosures of the local motion make one of the guard.

use super::bernstein::Bernstein;
use super::watch::{ROUNDINGS, Track};
use crate::law::{COORDINATES, Law, Local, State};
use crate::method::piecewise_linear::{Enclosure, Jet};

/// How often a step is halved before its ends are taken to tell all.
const HALVINGS: u32 = 48;

/// A curved guard of a law.
pub(crate) struct Curve<'a, L> {
    pub law: &'a L,
    pub state: State,
    pub guard: usize,
}

/// What is known of a guard on a stretch.
struct Bound {
    /// Its least value, and the largest of its slope in s.
    least: f64,
    steepest: f64,
}

impl<L: Law> Curve<'_, L> {
    /// Where it first goes below zero by more than rounding, as a part of the step.
    pub(crate) fn first_fall(&self, track: &Track) -> Option<f64> {
        self.fall(track, 0.0, 1.0, HALVINGS)
    }

    fn fall(&self, track: &Track, left: f64, width: f64, halvings: u32) -> Option<f64> {
        let Bound { least, steepest } = self.bound(track);
        let low = -self.tolerance(track);
        if least >= low {
            return None;
        }
        if self.value(track, 0.0) < low {
            return Some(left);
        }
        if steepest <= 0.0 || halvings == 0 {
            return (self.value(track, 1.0) < low).then(|| left + width * self.falling_zero(track));
        }
        let half = 0.5 * width;
        let [before, after] = track.halves();
        (self.fall(&before, left, half, halvings - 1))
            .or_else(|| self.fall(&after, left + half, half, halvings - 1))
    }

    /// Its value at a part of a stretch.
    fn value(&self, track: &Track, theta: f64) -> f64 {
        let at = |parts: &[Bernstein; COORDINATES]| parts.map(|part| part.at(theta));
        let (position, velocity) = (at(&track.position), at(&track.velocity));
        let memory = track.memory.map(|part| part.at(theta));
        (self.law).flowing_guard(self.state, self.guard, &position, &velocity, &memory)
    }

    /// Down to where it is zero.
    fn tolerance(&self, track: &Track) -> f64 {
        ROUNDINGS * self.enclosure(track).jet.rounding
    }

    fn enclosure(&self, track: &Track) -> Enclosure {
        let width = track.width();
        let on =
            |parts: &[Bernstein; COORDINATES], sizes: &[f64; COORDINATES]| -> Local<Enclosure> {
                std::array::from_fn(|c| enclosed(&parts[c], width, sizes[c]))
            };
        let [positions, velocities] = track.sizes();
        let position = on(&track.position, positions);
        let velocity = on(&track.velocity, velocities);
        let memory = track.memory.map(|part| enclosed(&part, width, 0.0));
        (self.law).flowing_guard(self.state, self.guard, &position, &velocity, &memory)
    }

    fn bound(&self, track: &Track) -> Bound {
        let Jet {
            value,
            slope,
            curvature,
            third,
            rest,
            ..
        } = self.enclosure(track).jet;
        let radius = 0.5 * track.width();
        let cubic = third * radius.powi(3) / 6.0 + rest[0];
        let square = 0.5 * third * radius * radius + rest[1];
        let bend = curvature.abs() * radius;
        Bound {
            least: value - (slope.abs() + 0.5 * bend) * radius - cubic,
            steepest: slope + bend + square,
        }
    }

    /// The zero of a guard that falls, by halving.
    fn falling_zero(&self, track: &Track) -> f64 {
        let [mut low, mut high] = [0.0, 1.0];
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.value(track, middle) > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }
}

/// The jet of a polynomial about the middle of a stretch of some width; `size` is that of what its
/// coefficients were summed of.
fn enclosed(polynomial: &Bernstein, width: f64, size: f64) -> Enclosure {
    let slope = polynomial.derivative();
    let curvature = slope.derivative();
    let third = curvature.derivative();
    let jet = Jet {
        value: polynomial.at(0.5),
        slope: slope.at(0.5) / width,
        curvature: curvature.at(0.5) / (width * width),
        third: third.size() / width.powi(3),
        rounding: f64::EPSILON * polynomial.size().max(size),
        ..Jet::default()
    };
    Enclosure::new(jet, 0.5 * width)
}
