//! What the explicit fixed-step schemes share: their record, their check of the step, and the
//! laws' forces on padded rows.

use crate::error::{Error, Result};
use crate::history::Event;
use crate::law::{COORDINATES, Law, Local, State, project};
use crate::number::{Block, LANES, blocks};
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
    displacement: Vec<Block>,
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
        Ok(Self {
            dt,
            steps,
            modes,
            stride,
            rule,
            displacement: Vec::with_capacity((steps + 3) * stride),
        })
    }

    /// Keeps the displacements of the next step; the first call gives
    /// those one step before the start.
    #[inline(always)]
    pub(crate) fn push(&mut self, displacement: &[Block]) {
        for block in displacement {
            self.displacement.push(*block);
        }
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

/// The laws of a problem for an explicit scheme: rows padded to whole lanes, in one list, and
/// what the laws did so far.
pub(crate) struct LawForces<'a, L> {
    laws: &'a [L],
    /// The rows of all laws, one after the other.
    pub rows: Vec<Vec<Block>>,
    states: Vec<State>,
    events: Vec<Event>,
}

impl<'a, L: Law> LawForces<'a, L> {
    pub(crate) fn new(problem: &'a Problem<L>) -> Self {
        let laws = &problem.laws;
        let states = (laws.iter())
            .map(|law| {
                let position = project(law, &problem.displacement);
                law.sampled_state(&position, &project(law, &problem.velocity))
            })
            .collect();
        let all = laws.iter().flat_map(|law| law.rows());
        Self {
            laws,
            rows: all.map(|row| blocks(row)).collect(),
            states,
            events: Vec::new(),
        }
    }

    /// What a law at local positions and velocities (one a row) exerts along each row.
    #[inline(always)]
    pub(crate) fn evaluate(
        &mut self,
        time: f64,
        positions: &[f64],
        velocities: &[f64],
        forces: &mut [f64],
    ) {
        let mut first = 0;
        for (index, law) in self.laws.iter().enumerate() {
            let rows = first..first + law.rows().len();
            let position = local(&positions[rows.clone()]);
            let velocity = local(&velocities[rows.clone()]);
            let state = law.sampled_state(&position, &velocity);
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
            let force = law.force(state, &position, &velocity);
            for (to, from) in forces[rows.clone()].iter_mut().zip(force) {
                *to = from;
            }
            first = rows.end;
        }
    }

    /// The events seen.
    pub(crate) fn into_events(self) -> Vec<Event> {
        self.events
    }
}

#[inline(always)]
fn local(values: &[f64]) -> Local<f64> {
    let mut local = [0.0; COORDINATES];
    for (to, from) in local.iter_mut().zip(values) {
        *to = *from;
    }
    local
}

/// Products of rows: `sum_i a_i weight_i b_i` for all pairs, row by row.
pub(crate) fn row_products(rows: &[Vec<Block>], weight: &[Block]) -> Vec<f64> {
    let product = |a: &[Block], b: &[Block]| -> f64 {
        let pairs = a.as_flattened().iter().zip(b.as_flattened());
        pairs
            .zip(weight.as_flattened())
            .map(|((a, b), w)| a * w * b)
            .sum()
    };
    let all = rows.iter().flat_map(|a| rows.iter().map(move |b| (a, b)));
    all.map(|(a, b)| product(a, b)).collect()
}
