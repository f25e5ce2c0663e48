//! What a run with fixed steps keeps.

use super::setting::Setting;
use super::states::{Room, States};
use crate::error::{Error, Result};
use crate::history::Event;
use crate::law::{Law, State};
use crate::method::observe;
use crate::number::{Block, LANES, blocks};
use crate::problem::Problem;
use std::cell::Cell;

/// The most memory that a record may take, in bytes.
const LARGEST_RECORD: f64 = 4.0 * 1024.0 * 1024.0 * 1024.0;

/// How often the observer is asked, in steps; a multiple of [`STRETCH`].
const STEPS_BETWEEN_OBSERVATIONS: usize = 1024;

/// Part of a step by which a time on one may miss it.
const AT_A_STEP: f64 = 1e-9;

/// Steps for which room is made at once.
const STRETCH: usize = 64;

/// Most blocks of memory that are left to another run: a mebibyte.
const MOST_SPARE: usize = 1 << 14;

thread_local! {
    /// Memory of a record that nobody needs any more, with whatever it holds: a run writes over
    /// it, and to fill it with zeros first would take a good part of the time of that.
    static SPARE: Cell<Vec<Block>> = const { Cell::new(Vec::new()) };
}

/// From which neighbouring displacements a scheme takes its velocity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VelocityRule {
    /// `(q[n] - q[n-1]) / dt`
    Backward,
    /// `(q[n+1] - q[n-1]) / (2 dt)`
    Central,
}

/// Every step's displacements, with one more before the first and one after the last.
#[derive(Debug, Clone)]
pub struct StepRecord {
    /// The step, in s.
    pub dt: f64,
    /// Number of steps.
    pub steps: usize,
    modes: usize,
    stride: usize,
    rule: VelocityRule,
    /// At least as long as the run needs.
    displacement: Vec<Block>,
    /// How many of the blocks are written.
    written: usize,
    states: States,
}

impl Drop for StepRecord {
    fn drop(&mut self) {
        if self.displacement.len() <= MOST_SPARE {
            SPARE.set(std::mem::take(&mut self.displacement));
        }
    }
}

/// Room for the results of some consecutive steps. A march writes into it without a call or a
/// test, which would cost it its registers.
pub(crate) struct Stretch<'a> {
    /// Time of the first, in s, when the observer is to be asked.
    start: Option<f64>,
    /// Displacements after each step.
    pub rows: &'a mut [Block],
    /// States of the laws during each step.
    pub states: Room<'a>,
}

impl Stretch<'_> {
    /// Asks the observer when it is time to.
    pub(crate) fn observe(&self, observer: &mut dyn FnMut(f64) -> bool) -> Result<()> {
        self.start.map_or(Ok(()), |time| observe(observer, time))
    }
}

impl StepRecord {
    /// Room for a run of `problem`.
    ///
    /// # Errors
    /// [`Error::NotPositive`], [`Error::NotFinite`] or [`Error::TooManySteps`].
    pub(crate) fn new<L: Law>(problem: &Problem<L>, dt: f64, rule: VelocityRule) -> Result<Self> {
        if !dt.is_finite() {
            return Err(Error::NotFinite { what: "dt" });
        }
        if dt <= 0.0 {
            return Err(Error::NotPositive {
                what: "dt",
                value: dt,
            });
        }
        let modes = problem.system.modes();
        let stride = modes.div_ceil(LANES);
        // A duration that is a whole number of steps up to rounding takes just that many.
        let count = (problem.duration / dt - 1e-9).ceil().max(1.0);
        let bytes = (count + 3.0) * (stride * size_of::<Block>()) as f64;
        if bytes > LARGEST_RECORD {
            return Err(Error::TooManySteps {
                steps: count as usize,
                modes,
                gibibytes: bytes / (1024.0 * 1024.0 * 1024.0),
            });
        }
        let steps = count as usize;
        let blocks = (steps + 3) * stride;
        let mut displacement = SPARE.take();
        if displacement.len() < blocks {
            displacement = vec![[0.0; LANES]; blocks];
        }
        Ok(Self {
            dt,
            steps,
            modes,
            stride,
            rule,
            displacement,
            written: 0,
            states: States::new(problem.laws.len(), steps),
        })
    }

    /// Keeps the displacements one step before the start and at the start, and the laws' states
    /// there. Returns these.
    pub(crate) fn begin<P: Law>(&mut self, setting: &Setting<'_, P>, before: &[f64]) -> Vec<State> {
        self.keep(before);
        self.keep(setting.displacement);
        let first = setting.first_states();
        self.states.begin(&first, P::REMEMBERS);
        first
    }

    /// Keeps the displacements of one step.
    fn keep(&mut self, displacement: &[f64]) {
        let row = blocks(displacement);
        self.displacement[self.written..][..row.len()].copy_from_slice(&row);
        self.written += row.len();
    }

    /// Room for the next steps, until there are no more.
    #[inline(always)]
    pub(crate) fn next_stretch(&mut self) -> Option<Stretch<'_>> {
        let first = self.states.steps();
        let count = STRETCH.min(self.steps + 1 - first);
        let first_row = self.written;
        self.written += count * self.stride;
        (count > 0).then(|| Stretch {
            start: first
                .is_multiple_of(STEPS_BETWEEN_OBSERVATIONS)
                .then_some(first as f64 * self.dt),
            rows: &mut self.displacement[first_row..self.written],
            states: self.states.make_room(count),
        })
    }

    /// The laws' states at step n.
    pub fn states(&self, n: usize) -> impl Iterator<Item = State> {
        self.states.at(n)
    }

    /// The laws' states at the last step before a time, or at it. A memory that flows is between
    /// those of the steps before and after.
    pub(crate) fn states_at<L: Law>(&self, laws: &[L], time: f64) -> Vec<State> {
        let position = (time / self.dt).min(self.steps as f64);
        // A step that the time lies on up to rounding counts as reached.
        let n = (position + AT_A_STEP) as usize;
        let part = (position - n as f64).max(0.0);
        let mut states: Vec<State> = self.states(n).collect();
        let next = self.states((n + 1).min(self.steps));
        for ((law, state), next) in laws.iter().zip(&mut states).zip(next) {
            if law.flows() {
                for (memory, next) in state.memory.iter_mut().zip(next.memory) {
                    *memory += part * (next - *memory);
                }
            }
        }
        states
    }

    /// The switches of the laws, in order of time.
    pub(crate) fn events(&self) -> Vec<Event> {
        self.states.events(self.dt)
    }

    fn row(&self, n: usize) -> &[f64] {
        let blocks = &self.displacement[n * self.stride..(n + 1) * self.stride];
        &blocks.as_flattened()[..self.modes]
    }

    /// Modal displacements at step n.
    pub fn displacement(&self, n: usize) -> &[f64] {
        self.row(n + 1)
    }

    /// Modal velocities at step n, by the scheme's own rule.
    pub fn velocity(&self, n: usize, velocity: &mut [f64]) {
        let (from, to, span) = match self.rule {
            VelocityRule::Backward => (n, n + 1, self.dt),
            VelocityRule::Central => (n, n + 2, 2.0 * self.dt),
        };
        for ((v, a), b) in velocity.iter_mut().zip(self.row(from)).zip(self.row(to)) {
            *v = (b - a) / span;
        }
    }

    /// Modal displacement and velocity at any time, linear between steps.
    pub fn sample(&self, time: f64, displacement: &mut [f64], velocity: &mut [f64]) {
        let position = time / self.dt;
        let n = (position as usize).min(self.steps - 1);
        let part = position - n as f64;
        let mut next = vec![0.0; self.modes];
        self.velocity(n, velocity);
        self.velocity(n + 1, &mut next);
        for (v, after) in velocity.iter_mut().zip(&next) {
            *v += part * (after - *v);
        }
        let rows = self.displacement(n).iter().zip(self.displacement(n + 1));
        for (q, (a, b)) in displacement.iter_mut().zip(rows) {
            *q = a + part * (b - a);
        }
    }

    /// Refuses a record whose motion left the range of numbers.
    pub(crate) fn check(&self) -> Result<()> {
        if self.row(self.steps + 2).iter().all(|q| q.is_finite()) {
            return Ok(());
        }
        let bad = |n: &usize| !self.row(*n).iter().all(|q| q.is_finite());
        let first = (1..self.steps + 3).find(bad).unwrap_or(self.steps);
        Err(Error::Overflow {
            time: (first - 1) as f64 * self.dt,
        })
    }
}
