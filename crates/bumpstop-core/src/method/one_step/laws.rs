//! The laws along a run of steps, and their forces where these depend on the motion that they
//! change.
//!
//! At the end of a stage the motion of the laws' coordinates is that without forces and what the
//! forces add, `x = x* + A f` and `x' = v* + B f`. What is unknown is the forces alone, as many as
//! there are coordinates, not modes: `f = phi(x*+ A f, v* + B f)` with the laws' phi. A semi-smooth
//! Newton iteration solves it with the laws' own derivatives; each law is in the state that it
//! sees in the iterate. Where a force jumps there may be no solution with such states (a damper
//! that throws the structure off the stop that it is part of): then the states are held, those
//! in contact before others, and the force of these is taken.
//!
//! Source: L. Qi, J. Sun, A nonsmooth version of Newton's method, Mathematical Programming 58,
//! 353-367, 1993.

use super::elimination::solve;
use super::impulses::{Struck, Touch};
use crate::error::{Error, Result};
use crate::law::{COORDINATES, Law, Local, State};
use crate::method::instant::{self, Moment};
use crate::method::polynomial_steps::slopes;
use crate::problem::Problem;

/// Iterations with states that follow the iterate, and with held ones.
const ITERATIONS: [usize; 2] = [20, 40];

/// A residual counts as zero down to this many times the rounding of what it is made of.
const ROUNDINGS: f64 = 64.0;

/// Numbers below this one lose digits as they are rounded off: nothing counts as smaller.
const SMALLEST: f64 = f64::MIN_POSITIVE / f64::EPSILON;

/// Sweeps over all forces, one after the other, where no iteration of them together ends.
const SWEEPS: usize = 4000;

/// How unit forces along the laws' coordinates move the modes by the end of a stage.
#[derive(Debug)]
pub(crate) struct Pushes {
    /// On positions and on velocities of the coordinates, a row a coordinate.
    pub(super) on: [Vec<f64>; 2],
}

impl Pushes {
    /// From modal displacements and velocities at the end of a stage, one pair for each unit force.
    pub(crate) fn new<L: Law>(
        laws: &[L],
        displacement: &[Vec<f64>],
        velocity: &[Vec<f64>],
    ) -> Self {
        let on = |moved: &[Vec<f64>]| {
            let products = rows(laws).flat_map(|row| moved.iter().map(|moved| dot(row, moved)));
            products.collect()
        };
        Self {
            on: [on(displacement), on(velocity)],
        }
    }
}

/// The rows of all laws, one after the other.
pub(crate) fn rows<L: Law>(laws: &[L]) -> impl Iterator<Item = &[f64]> {
    laws.iter().flat_map(|law| law.rows()).map(Vec::as_slice)
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The laws, with their states and forces at the instant reached.
#[derive(Debug, Clone)]
pub(crate) struct Laws<'a, L> {
    problem: &'a Problem<L>,
    /// The first coordinate of each law among all.
    first: Vec<usize>,
    pub states: Vec<State>,
    /// One a coordinate, in N.
    pub forces: Vec<f64>,
    seen: Vec<State>,
    /// Of each law with restitution, how it takes part.
    touched: Vec<Option<Touch>>,
    /// What forces are solved from: motion of the coordinates without them.
    free: [Vec<f64>; 2],
    iterate: Iterate,
}

/// Forces and motions during an iteration, and room for its equations.
#[derive(Debug, Clone)]
pub(super) struct Iterate {
    pub(super) forces: Vec<f64>,
    /// Positions and velocities, and the sizes of what they are summed of.
    pub(super) motion: [Vec<f64>; 2],
    pub(super) sizes: [Vec<f64>; 2],
    pub(super) residual: Vec<f64>,
    /// Derivatives of each force with respect to the coordinates of its own law.
    pub(super) slopes: [Vec<Local<f64>>; 2],
    /// What of each force itself is in its equation: all, or nothing where an impact tells a rate.
    pub(super) own: Vec<f64>,
    /// By how much each force grows with the one before it, where friction follows a push.
    pub(super) follows: Vec<f64>,
    /// The law of each coordinate.
    law: Vec<usize>,
    active: Vec<usize>,
    matrix: Vec<f64>,
    step: Vec<f64>,
}

impl<'a, L: Law> Laws<'a, L> {
    /// At t = 0.
    pub(crate) fn new(problem: &'a Problem<L>) -> Self {
        let mut states = vec![State::FIRST; problem.laws.len()];
        let start = Moment {
            time: 0.0,
            displacement: &problem.displacement,
            velocity: &problem.velocity,
        };
        instant::initial_states(problem, &mut states, start);
        let mut first = Vec::with_capacity(states.len());
        let mut law = Vec::new();
        for (index, which) in problem.laws.iter().enumerate() {
            first.push(law.len());
            law.resize(law.len() + which.rows().len(), index);
        }
        let count = law.len();
        let zeros = || vec![0.0; count];
        let mut laws = Self {
            problem,
            first,
            touched: vec![None; states.len()],
            seen: states.clone(),
            states,
            forces: zeros(),
            free: [zeros(), zeros()],
            iterate: Iterate {
                forces: zeros(),
                motion: [zeros(), zeros()],
                sizes: [zeros(), zeros()],
                residual: zeros(),
                slopes: [
                    vec![[0.0; COORDINATES]; count],
                    vec![[0.0; COORDINATES]; count],
                ],
                own: vec![1.0; count],
                follows: zeros(),
                law,
                active: Vec::with_capacity(count),
                matrix: Vec::with_capacity(count * count),
                step: zeros(),
            },
        };
        laws.start();
        laws
    }

    fn start(&mut self) {
        let Problem {
            displacement,
            velocity,
            ..
        } = self.problem;
        for (index, law) in self.problem.laws.iter().enumerate() {
            let [x, v] = self.problem.local(index, 0.0, displacement, velocity);
            let force = law.force(self.states[index], &x, &v);
            let count = law.rows().len();
            self.forces[self.first[index]..][..count].copy_from_slice(&force[..count]);
        }
    }

    /// Lets a law with restitution take part in a step, or not.
    pub(super) fn touch(&mut self, law: usize, how: Option<Touch>) {
        self.touched[law] = how;
    }

    /// Takes the forces of a law with restitution back, if it took part and pushed.
    pub(super) fn release(&mut self, law: usize, pushes: &Pushes) -> Option<Struck> {
        let (first, all) = (self.first[law], self.forces.len());
        let own = &mut self.forces[first..][..self.problem.laws[law].rows().len()];
        let struck = self.touched[law].take().map(|touch| Struck {
            push: own[0],
            rub: own.get(1).copied().unwrap_or(0.0),
            speed: own[0] * pushes.on[1][first * all + first],
            touch,
        });
        own.fill(0.0);
        struck.filter(|struck| struck.push > 0.0)
    }

    /// Adds the modal forces of all laws, times a factor, to modal numbers.
    pub(crate) fn add_forces(&self, factor: f64, to: &mut [f64]) {
        for (row, force) in rows(&self.problem.laws).zip(&self.forces) {
            add(factor * force, row, to);
        }
    }

    /// Adds what the forces push, one vector for each unit force, times a factor.
    pub(crate) fn push(&self, pushes: &[Vec<f64>], factor: f64, to: &mut [f64]) {
        for (pushed, force) in pushes.iter().zip(&self.forces) {
            add(factor * force, pushed, to);
        }
    }

    /// Finds states and forces at a time, from the motion that the modes have there without
    /// these forces.
    ///
    /// # Errors
    /// [`Error::NoContactForce`]
    pub(crate) fn meet(&mut self, pushes: &Pushes, time: f64, q: &[f64], v: &[f64]) -> Result<()> {
        if self.forces.is_empty() {
            return Ok(());
        }
        for (index, law) in self.problem.laws.iter().enumerate() {
            let local = self.problem.local(index, time, q, v);
            for (free, local) in self.free.iter_mut().zip(local) {
                let count = law.rows().len();
                free[self.first[index]..][..count].copy_from_slice(&local[..count]);
            }
        }
        self.iterate.forces.copy_from_slice(&self.forces);
        for (held, most) in ITERATIONS.into_iter().enumerate() {
            if held == 1 {
                self.hold();
            }
            for _ in 0..most {
                if self.agrees(held == 1, pushes) {
                    return Ok(());
                }
                self.iterate.improve(pushes);
            }
        }
        if self.touched.iter().any(Option::is_some) {
            self.iterate.forces.copy_from_slice(&self.forces);
            for _ in 0..SWEEPS {
                if self.agrees(false, pushes) {
                    return Ok(());
                }
                self.sweep(pushes);
            }
        }
        let unsure = self.iterate.residual.iter().enumerate();
        let worst = unsure.max_by(|(_, a), (_, b)| a.abs().total_cmp(&b.abs()));
        let law = worst.map_or(0, |(coordinate, _)| self.iterate.law[coordinate]);
        Err(Error::NoContactForce { time, law })
    }

    /// Takes the forces of the iterate, and the states that go with them, if they are those that
    /// the laws have in the motion that they make.
    fn agrees(&mut self, held: bool, pushes: &Pushes) -> bool {
        self.go_to(pushes);
        let settled = self.look(held, pushes);
        if settled {
            self.forces.copy_from_slice(&self.iterate.forces);
            self.states.copy_from_slice(&self.seen);
        }
        settled
    }

    /// Lets one force after the other follow from the motion that the others make: projected Gauss
    /// and Seidel, which ends where stops share what each alone could push, or friction follows
    /// pushes that it changes.
    fn sweep(&mut self, pushes: &Pushes) {
        let count = self.iterate.forces.len();
        for (index, law) in self.problem.laws.iter().enumerate() {
            let (first, own) = (self.first[index], law.rows().len());
            let rigid = law.restitution().is_some();
            for at in first..first + own {
                let iterate = &mut self.iterate;
                let before = iterate.forces[at];
                let after = if rigid {
                    let touch = self.touched[index].as_ref();
                    touch.map_or(0.0, |touch| iterate.impulse(touch, first, at, pushes))
                } else {
                    before + iterate.residual[at] / (1.0 - iterate.gain(pushes, at, at))
                };
                iterate.forces[at] = after;
                for (order, motion) in iterate.motion.iter_mut().enumerate() {
                    for (i, to) in motion.iter_mut().enumerate() {
                        *to += pushes.on[order][i * count + at] * (after - before);
                    }
                }
            }
        }
    }

    /// The motion under the forces of the iterate.
    fn go_to(&mut self, pushes: &Pushes) {
        let Iterate {
            forces,
            motion,
            sizes,
            ..
        } = &mut self.iterate;
        let count = forces.len();
        for order in 0..2 {
            let (to, sizes) = (&mut motion[order], &mut sizes[order]);
            to.copy_from_slice(&self.free[order]);
            for (size, free) in sizes.iter_mut().zip(&*to) {
                *size = free.abs() + SMALLEST;
            }
            for (i, row) in pushes.on[order].chunks_exact(count).enumerate() {
                for (push, force) in row.iter().zip(&*forces) {
                    to[i] += push * force;
                    sizes[i] += (push * force).abs();
                }
            }
        }
    }

    /// Looks at the laws' forces in the motion of the iterate; returns whether they are those of
    /// the iterate.
    fn look(&mut self, held: bool, pushes: &Pushes) -> bool {
        let mut settled = true;
        for (index, law) in self.problem.laws.iter().enumerate() {
            if law.restitution().is_some() {
                let (first, touched) = (self.first[index], self.touched[index].as_ref());
                settled &= self
                    .iterate
                    .strike(first, law.rows().len(), touched, pushes);
                continue;
            }
            let (first, count) = (self.first[index], law.rows().len());
            let local = |all: &[f64]| -> Local<f64> {
                std::array::from_fn(|c| if c < count { all[first + c] } else { 0.0 })
            };
            let iterate = &mut self.iterate;
            let [x, v] = [0, 1].map(|order| local(&iterate.motion[order]));
            if !held {
                self.seen[index] = law.sampled_state(self.states[index], &x, &v);
            }
            let state = self.seen[index];
            let force = law.force(state, &x, &v);
            let slopes = slopes(law, state, [x, v]);
            let sizes = [0, 1].map(|order| local(&iterate.sizes[order]));
            for c in 0..count {
                let known = iterate.forces[first + c];
                let residual = force[c] - known;
                let mut size = force[c].abs() + known.abs() + SMALLEST;
                for order in 0..2 {
                    let slopes = slopes[order][c];
                    size += (slopes.iter().zip(&sizes[order]))
                        .map(|(slope, size)| (slope * size).abs())
                        .sum::<f64>();
                    iterate.slopes[order][first + c] = slopes;
                }
                iterate.residual[first + c] = residual;
                settled &= residual.abs() <= ROUNDINGS * f64::EPSILON * size;
            }
        }
        settled
    }

    /// Keeps laws in contact that were so before or are in the iterate.
    fn hold(&mut self) {
        for ((law, seen), before) in self
            .problem
            .laws
            .iter()
            .zip(&mut self.seen)
            .zip(&self.states)
        {
            if !law.in_contact(*seen) && law.in_contact(*before) {
                *seen = *before;
            }
        }
    }
}

impl Iterate {
    /// Newton's step: `(1 - phi_x A - phi_v B) step = residual`. The forces of laws that do not
    /// answer to motions follow at once; the others are solved for together.
    fn improve(&mut self, pushes: &Pushes) {
        let count = self.forces.len();
        let answers = |slopes: &Vec<Local<f64>>, i: usize| slopes[i] != [0.0; COORDINATES];
        let answers = |i: &usize| {
            self.follows[*i] != 0.0 || self.slopes.iter().any(|slopes| answers(slopes, *i))
        };
        self.active.clear();
        self.active.extend((0..count).filter(answers));
        self.step.copy_from_slice(&self.residual);
        self.matrix.clear();
        for &i in &self.active {
            for j in 0..count {
                let gain = self.gain(pushes, i, j);
                if self.active.binary_search(&j).is_ok() {
                    let own = if i == j { self.own[i] } else { 0.0 };
                    self.matrix.push(own - gain);
                } else {
                    self.step[i] += gain * self.residual[j];
                }
            }
        }
        for (place, i) in self.active.iter().enumerate() {
            self.step.swap(place, *i);
        }
        let active = self.active.len();
        solve(&mut self.matrix, &mut self.step[..active]);
        for (place, i) in self.active.iter().enumerate().rev() {
            self.step.swap(place, *i);
        }
        for (force, step) in self.forces.iter_mut().zip(&self.step) {
            *force += step;
        }
    }

    /// How a force answers to another one.
    fn gain(&self, pushes: &Pushes, i: usize, j: usize) -> f64 {
        let count = self.forces.len();
        let first = self.law.partition_point(|law| *law < self.law[i]);
        let own = self.law[first..]
            .iter()
            .take_while(|law| **law == self.law[i]);
        let mut gain = if j + 1 == i { self.follows[i] } else { 0.0 };
        for c in 0..own.count() {
            for order in 0..2 {
                gain += self.slopes[order][i][c] * pushes.on[order][(first + c) * count + j];
            }
        }
        gain
    }
}

fn add(factor: f64, row: &[f64], to: &mut [f64]) {
    if factor != 0.0 {
        for (to, x) in to.iter_mut().zip(row) {
            *to += factor * x;
        }
    }
}
