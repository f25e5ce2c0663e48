//! How long the phases of a spectrum last at most.
//!
//! Motions that are slow beside a phase are followed by series, others by exponentials about their
//! position at rest. Where laws are hit again and again, exponentials that are slow beside the time
//! between hits are far larger than the motion that they sum to, `v / |s|` and `p / |s|^2` beside
//! `x`, and every phase loses the digits that both differ by. Where they are, phases are parted,
//! and more is slow beside their parts.

use super::dense::SLOW;
use super::response::Stretch;
use super::single_mode::{Regime, SingleMode};
use super::spectrum::Spectrum;

/// What phases a spectrum is made for.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Span {
    /// The stretches between knots of tables for which it follows loads.
    pub stretch: Stretch,
    /// Whether phases are parted.
    pub is_parted: bool,
}

/// Into so many phases a run is parted at least.
const PARTS: f64 = 16.0;

/// The last part may be longer than the others by this factor: none is left for rounding alone.
const LITTLE_MORE: f64 = 1.001;

/// So many times as large as the motion exponentials are large.
const LARGE: f64 = 4.0;

/// The longest parted phase of a run of such a length.
pub(super) fn part_of(duration: f64) -> f64 {
    duration / PARTS
}

impl Span {
    /// The longest phase of a run of such a length, in s.
    pub(crate) fn longest(self, duration: f64) -> f64 {
        if self.is_parted {
            part_of(duration)
        } else {
            duration
        }
    }

    /// Until when a phase lasts at most that begins at a time of a run of such a length, in s.
    pub(crate) fn until(self, time: f64, duration: f64) -> f64 {
        let longest = self.longest(duration);
        if duration - time < LITTLE_MORE * longest {
            duration
        } else {
            time + longest
        }
    }
}

/// The exponentials of a spectrum that would be slow beside parted phases.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct NearlySlow {
    /// The least of their exponents, in 1/s; zero where there are none.
    slowest: f64,
    /// How far away they rest under constant forces.
    rest: f64,
}

impl NearlySlow {
    /// Those of a spectrum, if it is one of phases that are not parted.
    pub(super) fn of(spectrum: &Spectrum, duration: f64) -> Self {
        let mut found = Self::default();
        if spectrum.span.is_parted {
            return found;
        }
        let part = part_of(duration);
        for single in &spectrum.singles {
            found.add_single(&single.motion, part);
        }
        let slowest = spectrum.slowest_of_groups();
        if slowest < SLOW / part {
            let far = (spectrum.at_rest.iter()).fold(0.0f64, |far, rest| far.max(rest.abs()));
            found.add(slowest, far);
        }
        found
    }

    fn add_single(&mut self, motion: &SingleMode, part: f64) {
        let (omega2, damping, force) = (motion.omega2, motion.damping, motion.force);
        let is_slow = |regime| matches!(regime, Regime::Slow | Regime::Free);
        let parted = SingleMode::new(omega2, damping, force, part);
        if is_slow(parted.regime) && !is_slow(motion.regime) {
            let size = omega2.abs().max(damping * damping);
            self.add(size.sqrt(), force.abs() / size);
        }
    }

    fn add(&mut self, exponent: f64, rest: f64) {
        if self.slowest == 0.0 || exponent < self.slowest {
            self.slowest = exponent;
        }
        self.rest = self.rest.max(rest);
    }

    /// Whether they are large beside the motion from a state to the next hit. How far that is
    /// tells the mean time between hits; before it is known, positions at rest alone are judged,
    /// beside the motion of a parted phase.
    #[inline(always)]
    pub(super) fn are_large(
        &self,
        state: [&[f64]; 2],
        between_hits: Option<f64>,
        duration: f64,
    ) -> bool {
        self.slowest > 0.0 && self.are_large_beside(state.map(size), between_hits, duration)
    }

    #[cold]
    fn are_large_beside(
        &self,
        [displacement, velocity]: [f64; 2],
        between_hits: Option<f64>,
        duration: f64,
    ) -> bool {
        let part = part_of(duration);
        let (large, time) = match between_hits {
            Some(time) => (self.rest.max(velocity / self.slowest), time.min(part)),
            None => (self.rest, part),
        };
        large > LARGE * (displacement + velocity * time)
    }
}

#[inline(always)]
fn size(values: &[f64]) -> f64 {
    values.iter().fold(0.0f64, |size, x| size.max(x.abs()))
}

impl Spectrum {
    /// The least exponent of the groups that is in no cluster, in 1/s.
    pub(super) fn slowest_of_groups(&self) -> f64 {
        let columns = self.lambda[..self.coupled_width].iter().flat_map(|block| {
            let sides = block.re.iter().zip(&block.im);
            sides.map(|(re, im)| re.hypot(*im)).collect::<Vec<f64>>()
        });
        let in_cluster =
            |column: usize| (self.clusters.iter()).any(|c| (c.at..c.at + c.size).contains(&column));
        let alone = columns
            .enumerate()
            .filter(|(column, size)| *size > 0.0 && !in_cluster(*column));
        alone.fold(f64::INFINITY, |slowest, (_, size)| slowest.min(size))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parted_phases_end_with_the_run() {
        let span = Span {
            is_parted: true,
            ..Span::default()
        };
        let (mut time, mut phases) = (0.0, 0);
        while time < 0.3 {
            time = span.until(time, 0.3);
            phases += 1;
        }
        assert_eq!((time, phases), (0.3, 16));
        assert_eq!(Span::default().until(0.1, 0.3), 0.3);
    }

    #[test]
    fn exponentials_are_large_beside_motions_that_hits_keep_small() {
        let mut slow = NearlySlow::default();
        // Turning by one radian in a run of one second, and resting ten metres away.
        slow.add_single(&SingleMode::new(1.0, 0.0, 10.0, 1.0), part_of(1.0));
        assert_eq!(
            slow,
            NearlySlow {
                slowest: 1.0,
                rest: 10.0
            }
        );
        let at = |x: f64, v: f64, between| slow.are_large([&[x], &[v]], between, 1.0);
        assert!(at(1.0, 1.0, None));
        assert!(!at(3.0, 0.0, None));
        // Where it rests near by, its speed decides, once hits are known.
        slow.rest = 0.0;
        let at = |x: f64, v: f64, between| slow.are_large([&[x], &[v]], between, 1.0);
        assert!(!at(0.0, 1.0, None));
        assert!(at(0.0, 1.0, Some(0.01)));
        assert!(!at(0.3, 1.0, Some(0.01)));
    }

    #[test]
    fn what_is_slow_or_fast_in_any_phase_is_left_alone() {
        let mut none = NearlySlow::default();
        for omega2 in [0.0, 0.01, 1e4] {
            none.add_single(&SingleMode::new(omega2, 0.0, 10.0, 1.0), part_of(1.0));
        }
        assert_eq!(none, NearlySlow::default());
    }
}
