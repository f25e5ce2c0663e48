//! Whole runs of eight problems, in step: the n-th phase of one with the n-th of the others.

use super::mask::ALL;
use super::motion::Motion;
use super::outputs::{Outputs, Span};
use super::plan::Plan;
use super::shape::Shape;
use super::walk::Walker;
use crate::number::{Block, Instructions, LANES, Lanes, Number};

/// Phases after which lanes are given up.
const MOST_PHASES: usize = 100_000;

/// Distances and speeds that are this small beside their parts are looked at by single runs.
const DOUBTFUL: f64 = 1e-9;

/// Eight problems of one shape, which all start in contact or all in flight.
#[derive(Debug)]
pub(super) struct Eight {
    pub stiffness: Block,
    pub gap: Block,
    pub displacement: Vec<Block>,
    pub velocity: Vec<Block>,
    pub is_closed: bool,
    /// The lanes that hold a problem.
    pub live: u8,
}

impl Eight {
    pub(super) fn new(modes: usize) -> Self {
        Self {
            stiffness: [1.0; LANES],
            gap: [0.0; LANES],
            displacement: vec![[0.0; LANES]; modes],
            velocity: vec![[0.0; LANES]; modes],
            is_closed: false,
            live: 0,
        }
    }
}

/// Room for the runs of eight problems.
#[derive(Debug)]
pub(super) struct Runner {
    motion: Motion,
    walker: Walker,
    outputs: Outputs,
}

impl Runner {
    pub(super) fn new(shape: &Shape, plan: &Plan) -> Self {
        Self {
            motion: Motion::new(shape.modes),
            walker: Walker::new(shape.modes),
            outputs: Outputs::new(shape.modes, plan),
        }
    }

    /// Runs the problems; returns the lanes that single runs must make.
    #[inline(always)]
    pub(super) fn run<I: Instructions>(&mut self, shape: &Shape, plan: &Plan, eight: &Eight) -> u8 {
        let Self {
            motion,
            walker,
            outputs,
        } = self;
        let mut failed = motion.start::<I>(shape, eight);
        let starts = Starts::of::<I>(shape, eight);
        failed |= starts.doubtful;
        let mut departs = starts.at_zero;
        let mut live = eight.live & !failed;
        let mut is_closed = eight.is_closed;
        let mut time = Lanes::<I>::of(0.0);
        let duration = Lanes::<I>::of(shape.duration);
        outputs.start::<I>(shape, plan, motion);
        for _ in 0..MOST_PHASES {
            let lost = motion.begin::<I>(shape, eight, is_closed);
            failed |= lost;
            live &= !lost;
            let ends = walker.walk(motion.guard(is_closed), duration - time, live, departs);
            failed |= ends.failed;
            live &= !ends.failed;
            let span = Span {
                is_closed,
                start: time,
                ends: &ends,
                live,
            };
            let lost = outputs.read::<I>(motion, shape, plan, eight, span);
            failed |= lost;
            live &= ends.found & !lost;
            if live == 0 {
                break;
            }
            motion.end::<I>(shape, is_closed, &ends.time, &walker.exponentials);
            time += Lanes::of_block(&ends.time);
            is_closed = !is_closed;
            departs = ALL;
        }
        outputs.finish(plan);
        (failed | live) & eight.live
    }

    /// The numbers kept of the runs, a block for each.
    pub(super) fn kept(&self) -> &[Block] {
        &self.outputs.kept
    }
}

/// How eight problems start.
struct Starts {
    /// Lanes that start at zero distance, with a velocity that decides.
    at_zero: u8,
    /// Lanes in which rounding might decide.
    doubtful: u8,
}

impl Starts {
    #[inline(always)]
    fn of<I: Instructions>(shape: &Shape, eight: &Eight) -> Self {
        let zero = Lanes::<I>::of(0.0);
        let gap = Lanes::<I>::of_block(&eight.gap);
        let (mut distance, mut size) = (gap, gap.abs());
        let (mut speed, mut size_rate) = (zero, zero);
        for i in 0..shape.modes {
            let phi = Lanes::<I>::of(shape.phi[i]);
            let q = phi * Lanes::of_block(&eight.displacement[i]);
            let v = phi * Lanes::of_block(&eight.velocity[i]);
            distance += q;
            size += q.abs();
            speed += v;
            size_rate += v.abs();
        }
        let at_zero = !zero.less(size);
        let close = !(size * Lanes::of(DOUBTFUL)).less(distance.abs());
        let slow = !(size_rate * Lanes::of(DOUBTFUL)).less(speed.abs());
        Self {
            at_zero,
            doubtful: (close & !at_zero) | (at_zero & slow),
        }
    }
}
