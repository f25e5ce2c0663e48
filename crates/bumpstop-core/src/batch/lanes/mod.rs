//! Eight problems at a time, a problem a lane of the vector registers.
//!
//! They are solved as single runs are: closed-form phases, and the certificate for where they end.
//! What is common to most batches is all that lanes can do: one plain stop without damper,
//! constant forces, modes that oscillate and one that is rigid perhaps. A run in which anything is
//! out of the usual, a touch, a zero too close to another, is given up and made by itself. No lane
//! sees what is in the others, so that no bit depends on it.

mod bounds;
mod guard;
mod mask;
mod motion;
mod outputs;
mod peaks;
mod plan;
mod run;
mod shape;
mod spectrum;
#[cfg(all(test, target_arch = "x86_64"))]
mod tests;
mod walk;

use super::parameters::Parameters;
use super::quantity::Quantity;
use crate::law::{AnyLaw, Stop};
use crate::number::{Block, Instructions, LANES, Vectorised};
use crate::problem::Problem;
use plan::Plan;
use run::{Eight, Runner};
use shape::Shape;

/// A batch of the common shape.
#[derive(Debug, Clone)]
pub(super) struct Common {
    shape: Shape,
    plan: Plan,
    stop: Stop,
}

/// Room for runs in lanes.
#[derive(Debug)]
pub(super) struct Bench {
    eight: Eight,
    runner: Runner,
    /// The runs of a part by how they start, and their stiffnesses: those of one kind side by side.
    order: Vec<(bool, f64, usize)>,
}

impl Common {
    /// `None` where the problem is not of this shape, or something is asked for that lanes do not
    /// read.
    pub(super) fn of(problem: &Problem<AnyLaw>, quantities: &[Quantity]) -> Option<Self> {
        let [AnyLaw::Stop(stop)] = problem.laws.as_slice() else {
            return None;
        };
        if problem.forcing.varies() || problem.system.is_coupled() {
            return None;
        }
        Some(Self {
            shape: Shape::new(
                &problem.system,
                stop,
                problem.forcing.forces(),
                problem.duration,
            )?,
            plan: Plan::new(quantities)?,
            stop: stop.clone(),
        })
    }

    pub(super) fn bench(&self) -> Bench {
        Bench {
            eight: Eight::new(self.shape.modes),
            runner: Runner::new(&self.shape, &self.plan),
            order: Vec::new(),
        }
    }
}

/// Consecutive runs, made in lanes where they can be.
pub(super) struct Part<'a> {
    pub common: &'a Common,
    pub problem: &'a Problem<AnyLaw>,
    pub parameters: &'a Parameters<'a>,
    /// Number of the first run.
    pub first: usize,
    /// Rows of results.
    pub values: &'a mut [f64],
    pub bench: &'a mut Bench,
    /// Gets the runs that must be made by themselves, counted from the first.
    pub left: &'a mut Vec<usize>,
}

impl Vectorised for Part<'_> {
    type Output = ();
    #[inline(always)]
    fn run<I: Instructions>(mut self) {
        let runs = self.values.len() / self.common.plan.width;
        self.sort(runs);
        let order = std::mem::take(&mut self.bench.order);
        for group in order.chunk_by(|a, b| a.0 == b.0) {
            for eight in group.chunks(LANES) {
                self.make::<I>(eight);
            }
        }
        self.bench.order = order;
    }
}

impl Part<'_> {
    /// Puts runs that go alike side by side: those that start in contact, and by stiffness.
    fn sort(&mut self, runs: usize) {
        self.bench.order.clear();
        for number in 0..runs {
            let run = self.first + number;
            let [gap, stiffness, damping] = self.parameters.stop(run, &self.common.stop);
            let usual = stiffness > 0.0 && stiffness.is_finite() && damping == 0.0;
            if usual && self.parameters.loads.is_none() && self.parameters.pace.is_none() {
                let is_closed = self.starts_closed(run, gap);
                self.bench.order.push((is_closed, stiffness, number));
            } else {
                self.left.push(number);
            }
        }
        (self.bench.order).sort_by(|a, b| {
            (a.0.cmp(&b.0))
                .then(a.1.total_cmp(&b.1))
                .then(a.2.cmp(&b.2))
        });
    }

    /// Whether a run starts in contact, as far as rounding tells.
    fn starts_closed(&self, run: usize, gap: f64) -> bool {
        let (mut distance, mut speed) = (gap, 0.0);
        for (mode, phi) in self.common.shape.phi.iter().enumerate() {
            let [q, v] = self.state(run, mode);
            distance += phi * q;
            speed += phi * v;
        }
        distance < 0.0 || distance == 0.0 && speed < 0.0
    }

    /// Displacement and velocity of a mode at the start of a run.
    #[inline(always)]
    fn state(&self, run: usize, mode: usize) -> [f64; 2] {
        let Self {
            problem,
            parameters,
            ..
        } = self;
        [
            parameters.displacement.of(run, &problem.displacement, mode),
            parameters.velocity.of(run, &problem.velocity, mode),
        ]
    }

    /// Makes up to eight runs; what lanes are left hold the last of them once more.
    #[inline(always)]
    fn make<I: Instructions>(&mut self, runs: &[(bool, f64, usize)]) {
        let modes = self.common.shape.modes;
        for lane in 0..LANES {
            let (is_closed, _, number) = runs[lane.min(runs.len() - 1)];
            let run = self.first + number;
            let [gap, stiffness, _] = self.parameters.stop(run, &self.common.stop);
            for mode in 0..modes {
                let [q, v] = self.state(run, mode);
                self.bench.eight.displacement[mode][lane] = q;
                self.bench.eight.velocity[mode][lane] = v;
            }
            let eight = &mut self.bench.eight;
            (eight.gap[lane], eight.stiffness[lane]) = (gap, stiffness);
            eight.is_closed = is_closed;
        }
        self.bench.eight.live = u8::MAX >> (LANES - runs.len());
        let Common { shape, plan, .. } = self.common;
        let Bench { eight, runner, .. } = &mut *self.bench;
        let failed = runner.run::<I>(shape, plan, eight);
        for (lane, (_, _, number)) in runs.iter().enumerate() {
            if failed >> lane & 1 == 1 {
                self.left.push(*number);
                continue;
            }
            let row = &mut self.values[number * plan.width..(number + 1) * plan.width];
            put(row, runner.kept(), lane);
        }
    }
}

/// Writes the numbers of one lane.
#[inline(always)]
fn put(row: &mut [f64], kept: &[Block], lane: usize) {
    for (to, from) in row.iter_mut().zip(kept) {
        *to = from[lane];
    }
}
