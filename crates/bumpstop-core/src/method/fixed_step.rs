//! What the explicit fixed-step schemes share: their record, their check of the step, and the
//! laws' forces on padded rows.

use crate::error::{Error, Result};
use crate::history::Event;
use crate::law::{COORDINATES, Law, Local, State};
use crate::number::{LANES, Lanes, fill, padded, sum};
use crate::problem::Problem;
use crate::system::ModalSystem;

/// A fixed step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// Its length, in s.
    pub dt: f64,
    /// Whether it may lie above the stability limit.
    pub beyond_stability_limit: bool,
}

/// The most memory that a record may take, in bytes.
const LARGEST_RECORD: f64 = 4.0 * 1024.0 * 1024.0 * 1024.0;

/// How often the observer is asked, in steps.
pub(crate) const STEPS_BETWEEN_OBSERVATIONS: usize = 1024;

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
    displacement: Vec<f64>,
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
        let stride = padded(modes);
        // A duration that is a whole number of steps up to rounding takes just that many.
        let count = (problem.duration / dt - 1e-9).ceil().max(1.0);
        let bytes = (count + 3.0) * (stride * 8) as f64;
        if bytes > LARGEST_RECORD {
            return Err(Error::TooManySteps {
                steps: count as usize,
                modes,
                gibibytes: bytes / (1024.0 * 1024.0 * 1024.0),
            });
        }
        let steps = count as usize;
        Ok(Self {
            dt,
            steps,
            modes,
            stride,
            rule,
            displacement: vec![0.0; (steps + 3) * stride],
        })
    }

    /// Three consecutive rows for the step from n to n + 1: n - 1, n (to read) and n + 1.
    #[inline(always)]
    pub(crate) fn window(&mut self, n: usize) -> (&[f64], &[f64], &mut [f64]) {
        let (before, after) = self.displacement.split_at_mut((n + 2) * self.stride);
        let (previous, current) = before[n * self.stride..].split_at(self.stride);
        (previous, current, &mut after[..self.stride])
    }

    /// Sets the rows before and at the start.
    pub(crate) fn start(&mut self, before: &[f64], first: &[f64]) {
        self.displacement[..self.modes].copy_from_slice(before);
        self.displacement[self.stride..self.stride + self.modes].copy_from_slice(first);
    }

    fn row(&self, n: usize) -> &[f64] {
        &self.displacement[n * self.stride..n * self.stride + self.modes]
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

/// Refuses a step above the limit, unless it was asked for by name.
pub(crate) fn check_step(method: &'static str, step: Step, limit: f64) -> Result<()> {
    if step.dt > limit && !step.beyond_stability_limit {
        return Err(Error::Unstable {
            method,
            dt: step.dt,
            limit,
        });
    }
    Ok(())
}

/// Highest angular frequency with every law in its stiffest state, in rad/s, from above:
/// the largest eigenvalue of a sum is at most the sum of the largest eigenvalues.
pub(crate) fn highest_frequency<L: Law>(system: &ModalSystem, laws: &[L]) -> f64 {
    let laws_stiffness: f64 = laws.iter().map(law_stiffness).sum();
    (system.highest_frequency().powi(2) + laws_stiffness).sqrt()
}

fn law_stiffness<L: Law>(law: &L) -> f64 {
    let piece = law.stiffest();
    (law.rows().iter().zip(piece.stiffness).enumerate())
        .map(|(i, (row, stiffness))| stiffness[i] * row.iter().map(|r| r * r).sum::<f64>())
        .sum()
}

/// The laws with rows padded to whole lanes, and what they did so far.
pub(crate) struct LawForces<'a, L> {
    laws: &'a [L],
    rows: Vec<Vec<Vec<f64>>>,
    states: Vec<State>,
    events: Vec<Event>,
}

impl<'a, L: Law> LawForces<'a, L> {
    pub(crate) fn new(laws: &'a [L], displacement: &[f64], velocity: &[f64]) -> Self {
        let states = (laws.iter())
            .map(|law| {
                let position = crate::law::project(law, displacement);
                law.sampled_state(&position, &crate::law::project(law, velocity))
            })
            .collect();
        let pad = |law: &L| law.rows().iter().map(|row| fill(row, 0.0)).collect();
        Self {
            laws,
            rows: laws.iter().map(pad).collect(),
            states,
            events: Vec::new(),
        }
    }

    /// Adds the laws' forces at one instant to `forces`; `velocity` gives local velocities.
    #[inline(always)]
    pub(crate) fn add(
        &mut self,
        forces: &mut [f64],
        time: f64,
        displacement: &[f64],
        mut velocity: impl FnMut(usize, &Local<f64>) -> Local<f64>,
    ) {
        for (index, law) in self.laws.iter().enumerate() {
            let mut position = [0.0; COORDINATES];
            for (x, row) in position.iter_mut().zip(&self.rows[index]) {
                *x = sum(row.len(), |o| {
                    Lanes::load(&row[o..]) * Lanes::load(&displacement[o..])
                });
            }
            let rate = velocity(index, &position);
            let state = law.sampled_state(&position, &rate);
            if state != self.states[index] {
                self.events.push(Event {
                    time,
                    law: index,
                    guard: "step",
                    before: self.states[index],
                    after: state,
                });
                self.states[index] = state;
            }
            let force = law.force(state, &position, &rate);
            for (row, f) in self.rows[index].iter().zip(force) {
                for offset in (0..row.len()).step_by(LANES) {
                    let before = Lanes::load(&forces[offset..]);
                    let added = before + Lanes::load(&row[offset..]) * Lanes([f; LANES]);
                    added.store(&mut forces[offset..]);
                }
            }
        }
    }

    /// The events seen.
    pub(crate) fn into_events(self) -> Vec<Event> {
        self.events
    }
}
