//! Looking for the first switch of a law within a step.
//!
//! Along a step the local coordinates are polynomials in time, and so are affine guards: their
//! Bernstein coefficients bound them over the whole step. No guard can hide between its ends.

use super::bernstein::{Bernstein, MOST};
use super::curved::Curve;
use super::dense::Dense;
use super::equations::Layout;
use super::loads::Loads;
use crate::forcing::Moved;
use crate::law::{Affine, COORDINATES, Law, Local, State};
use crate::problem::Problem;

/// A guard counts as zero down to this many times the rounding of what it is made of.
pub(crate) const ROUNDINGS: f64 = 16.0;

/// The largest angle by which a harmonic motion of an obstacle may turn in a step: its Taylor
/// polynomial of the highest degree then tells it to 3e-17 of its amplitude.
const LONGEST_TURN: f64 = 0.15;

/// A switch within a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Crossing {
    pub law: usize,
    pub guard: usize,
    /// The part of the step that goes before it.
    pub theta: f64,
    /// The law's local accelerations there, as the polynomials tell them.
    pub acceleration: Local<f64>,
}

/// A step as the guards see it.
#[derive(Clone, Copy)]
pub(crate) struct Step<'a> {
    pub time: f64,
    pub h: f64,
    pub dense: Dense<'a>,
    /// Sizes of what displacements and velocities at the start, one behind the other, were summed
    /// of, if that was more than themselves: their rounding goes with them. Else empty.
    pub rounded: &'a [f64],
}

/// The polynomials that the dense output is made of, and how obstacles move.
#[derive(Debug)]
pub(crate) struct Watch {
    /// For each degree that is needed: that of the dense output, and the highest.
    bases: [Vec<Bernstein>; 2],
    /// For each law the coordinates along which its obstacle moves.
    moves: Vec<Vec<Moved>>,
}

/// The local motion of a law along a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Track {
    pub position: [Bernstein; COORDINATES],
    pub velocity: [Bernstein; COORDINATES],
    /// The law's memory where that flows.
    pub memory: [Bernstein; 2],
    /// Sizes of what both were summed of.
    sizes: [[f64; COORDINATES]; 2],
    h: f64,
}

impl Watch {
    pub(crate) fn new<L: Law>(problem: &Problem<L>, degree: usize) -> Self {
        let basis = |highest: usize| {
            (0..=degree)
                .map(|k| Bernstein::product(highest, k.div_ceil(2), k / 2))
                .collect()
        };
        let mut moves = vec![Vec::new(); problem.laws.len()];
        for moved in problem.forcing.moved() {
            let known: &mut Vec<Moved> = &mut moves[moved.law];
            if !known.contains(&moved) {
                known.push(moved);
            }
        }
        Self {
            bases: [basis(degree), basis(MOST)],
            moves,
        }
    }

    /// The first switch of a law in a step, if there is one.
    pub(crate) fn first<L: Law>(
        &self,
        problem: &Problem<L>,
        states: &[State],
        layout: &Layout,
        loads: &Loads<'_>,
        step: Step<'_>,
    ) -> Option<Crossing> {
        let mut first: Option<Crossing> = None;
        for (index, law) in problem.laws.iter().enumerate() {
            let found = self.fall((law, index), states[index], layout, loads, step);
            if let Some(crossing) = found
                && first.is_none_or(|first| crossing.theta < first.theta)
            {
                first = Some(crossing);
            }
        }
        first
    }

    /// Where a guard of one law in a state first falls below zero, if one does.
    pub(crate) fn fall<L: Law>(
        &self,
        (law, index): (&L, usize),
        state: State,
        layout: &Layout,
        loads: &Loads<'_>,
        step: Step<'_>,
    ) -> Option<Crossing> {
        let guards = law.guard_count(state);
        if guards == 0 {
            return None;
        }
        let track = self.track(law, index, layout, loads, step);
        let mut first: Option<Crossing> = None;
        for guard in 0..guards {
            let theta = if law.is_curved(state, guard) {
                Curve { law, state, guard }.first_fall(&track)
            } else {
                let function = law.guard(state, guard).function;
                track.guard(&function).first_fall(track.rounding(&function))
            };
            if let Some(theta) = theta.filter(|t| first.is_none_or(|f| *t < f.theta)) {
                first = Some(Crossing {
                    law: index,
                    guard,
                    theta,
                    acceleration: track.acceleration(theta),
                });
            }
        }
        first
    }

    /// The local motion of a law.
    fn track<L: Law>(
        &self,
        law: &L,
        index: usize,
        layout: &Layout,
        loads: &Loads<'_>,
        step: Step<'_>,
    ) -> Track {
        let moves = !self.moves[index].is_empty();
        let basis = &self.bases[usize::from(moves)];
        let zero = Bernstein::constant(if moves { MOST } else { basis.len() - 1 }, 0.0);
        let mut track = Track {
            position: [zero; COORDINATES],
            velocity: [zero; COORDINATES],
            memory: [zero; 2],
            sizes: [[0.0; COORDINATES]; 2],
            h: step.h,
        };
        for (c, row) in law.rows().iter().enumerate() {
            for (k, (numbers, product)) in step.dense.each().zip(basis).enumerate() {
                let motions = [&mut track.position[c], &mut track.velocity[c]];
                let motion = layout.motion(numbers);
                for ((to, x), sizes) in motions.into_iter().zip(motion).zip(&mut track.sizes) {
                    let (mut sum, mut size) = (0.0, 0.0);
                    for (r, x) in row.iter().zip(x) {
                        sum += r * x;
                        size += (r * x).abs();
                    }
                    to.add(sum, product);
                    // The start and what is added across the step; the rest is smaller.
                    if k < 2 {
                        sizes[c] += size;
                    }
                }
            }
            let rounded = step.rounded.chunks(row.len());
            for (sizes, rounded) in track.sizes.iter_mut().zip(rounded) {
                let parts = row.iter().zip(rounded);
                sizes[c] += parts.map(|(r, x)| (r * x).abs()).sum::<f64>();
            }
        }
        if let Some(at) = layout.memories[index] {
            for (numbers, product) in step.dense.each().zip(basis) {
                for (memory, number) in track.memory.iter_mut().zip(&numbers[at..]) {
                    memory.add(*number, product);
                }
            }
        }
        for moved in &self.moves[index] {
            let mut series = [0.0; MOST + 1];
            loads.series(*moved, step.time, step.h, &mut series);
            let (along, c) = (Bernstein::of_powers(&series), moved.coordinate);
            track.position[c].add(-1.0, &along);
            track.velocity[c].add(-1.0 / step.h, &along.derivative());
            track.sizes[0][c] += along.size();
            track.sizes[1][c] += along.derivative().size() / step.h;
        }
        // The instant is known to rounding, too: a position is known no better than how far the
        // motion goes in that.
        let [positions, velocities] = &mut track.sizes;
        for (position, velocity) in positions.iter_mut().zip(velocities) {
            *position += step.time * *velocity;
        }
        track
    }
}

impl Track {
    /// An affine function of the local motion.
    fn guard(&self, function: &Affine) -> Bernstein {
        let mut guard = Bernstein::constant(self.position[0].degree(), function.constant);
        for c in 0..COORDINATES {
            if function.position[c] != 0.0 {
                guard.add(function.position[c], &self.position[c]);
            }
            if function.velocity[c] != 0.0 {
                guard.add(function.velocity[c], &self.velocity[c]);
            }
            if function.acceleration[c] != 0.0 {
                let factor = function.acceleration[c] / self.h;
                guard.add(factor, &self.velocity[c].derivative());
            }
        }
        guard
    }

    /// Down to where it is zero: its rounding, some times.
    fn rounding(&self, function: &Affine) -> f64 {
        let [positions, velocities] = &self.sizes;
        let mut size = function.constant.abs();
        for c in 0..COORDINATES {
            size += function.position[c].abs() * positions[c];
            // Accelerations are differences of velocities.
            let rate = function.velocity[c].abs() + function.acceleration[c].abs() / self.h;
            size += rate * velocities[c];
        }
        ROUNDINGS * f64::EPSILON * size
    }

    fn acceleration(&self, theta: f64) -> Local<f64> {
        (self.velocity).map(|velocity| velocity.derivative().at(theta) / self.h)
    }

    /// The same on both halves of the step.
    pub(crate) fn halves(&self) -> [Self; 2] {
        let (mut left, mut right) = (*self, *self);
        for c in 0..COORDINATES {
            [left.position[c], right.position[c]] = self.position[c].halves();
            [left.velocity[c], right.velocity[c]] = self.velocity[c].halves();
        }
        for (m, memory) in self.memory.iter().enumerate() {
            [left.memory[m], right.memory[m]] = memory.halves();
        }
        (left.h, right.h) = (0.5 * self.h, 0.5 * self.h);
        [left, right]
    }

    /// Sizes of what the positions, and the velocities, were summed of.
    pub(crate) fn sizes(&self) -> &[[f64; COORDINATES]; 2] {
        &self.sizes
    }

    /// Its length in s.
    pub(crate) fn width(&self) -> f64 {
        self.h
    }
}

/// The longest step along which the motions of obstacles are polynomials, to rounding.
pub(crate) fn longest_step<L: Law>(problem: &Problem<L>) -> f64 {
    let harmonics = problem.forcing.harmonics().iter();
    let moving = harmonics.filter(|harmonic| !harmonic.motions.is_empty());
    LONGEST_TURN / moving.fold(0.0, |fastest, harmonic| f64::max(fastest, harmonic.omega))
}
