//! One step of a Runge-Kutta pair: its stages, its end, and the polynomial across it.

use super::control::{Control, Tolerances};
use super::pair::Pair;
use super::pieces::Pieces;
use super::stepping::{Attempt, Stepping};
use crate::law::Law;
use crate::method::polynomial_steps::{Equations, write_cubic};

/// The numbers at both ends of a step, and the stages between.
#[derive(Debug)]
pub(super) struct RungeKutta {
    pair: &'static Pair,
    control: Control,
    start: Vec<f64>,
    end: Vec<f64>,
    /// The first is the derivative at the start; number `last` is that at the end.
    stages: Vec<Vec<f64>>,
    last: usize,
    inner: Vec<f64>,
    errors: Vec<f64>,
    pieces: Pieces,
}

impl RungeKutta {
    pub(super) fn new<L: Law>(
        pair: &'static Pair,
        tolerances: Tolerances,
        first_step: f64,
        start: Vec<f64>,
        equations: &Equations<'_, L>,
    ) -> Self {
        let room = vec![0.0; start.len()];
        let layout = &equations.layout;
        Self {
            pair,
            control: Control::new(tolerances, pair.error_order, first_step, &start, layout),
            end: room.clone(),
            stages: vec![room.clone(); pair.stages()],
            last: pair.b.len(),
            inner: room,
            errors: vec![0.0; layout.works],
            pieces: Pieces::new(start.len()),
            start,
        }
    }

    /// The estimate of the error over what is allowed.
    fn error<L: Law>(&mut self, time: f64, h: f64, equations: &Equations<'_, L>) -> f64 {
        (self.control).measure(&self.stages, (time + h, &self.end), equations);
        let mut largest = [0.0; 2];
        for (largest, weights) in largest.iter_mut().zip(self.pair.errors) {
            self.errors.fill(0.0);
            add_weighted(&mut self.errors, h, weights, &self.stages);
            *largest = self.control.largest(&self.errors);
        }
        let [first, second] = largest;
        if self.pair.errors.len() == 1 || first == 0.0 {
            first
        } else {
            // Hairer's estimate for the pair of order 8, section II.10 of the same book.
            first * first / (first * first + 0.01 * second * second).sqrt()
        }
    }
}

impl<L: Law> Stepping<L> for RungeKutta {
    fn degree(&self) -> usize {
        self.pair.degree()
    }

    fn numbers(&mut self) -> &mut Vec<f64> {
        &mut self.start
    }

    fn start(&mut self, time: f64, equations: &mut Equations<'_, L>) {
        equations.rates(time, &self.start, &mut self.stages[0]);
    }

    fn see(&mut self, motion: &[f64]) {
        self.control.see(motion);
    }

    fn attempt(&mut self, time: f64, h: f64, equations: &mut Equations<'_, L>) -> Attempt {
        let pair = self.pair;
        for (number, (a, c)) in pair.a.iter().zip(pair.c).enumerate().skip(1) {
            self.inner.copy_from_slice(&self.start);
            add_weighted(&mut self.inner, h, a, &self.stages);
            equations.rates(time + c * h, &self.inner, &mut self.stages[number]);
        }
        self.end.copy_from_slice(&self.start);
        add_weighted(&mut self.end, h, pair.b, &self.stages);
        equations.rates(time + h, &self.end, &mut self.stages[self.last]);
        let error = self.error(time, h, equations);
        self.control.judge(h, error, &self.end)
    }

    fn follow(&mut self, time: f64, h: f64, equations: &mut Equations<'_, L>) {
        let pair = self.pair;
        for (number, (c, a)) in pair.extra.iter().enumerate() {
            self.inner.copy_from_slice(&self.start);
            add_weighted(&mut self.inner, h, a, &self.stages);
            let stage = &mut self.stages[self.last + 1 + number];
            equations.rates(time + c * h, &self.inner, stage);
        }
        let ends = [&*self.start, &*self.end];
        let slopes = [&*self.stages[0], &*self.stages[self.last]];
        self.pieces.clear();
        let rows = self.pieces.next();
        write_cubic(h, ends, slopes, rows);
        for weights in pair.corrections {
            let begun = rows.len();
            rows.resize(begun + self.start.len(), 0.0);
            add_weighted(&mut rows[begun..], h, weights, &self.stages);
        }
    }

    fn pieces(&self) -> &Pieces {
        &self.pieces
    }

    fn go_on(&mut self) {
        std::mem::swap(&mut self.start, &mut self.end);
        self.stages.swap(0, self.last);
    }

    fn stop_at(&mut self, piece: usize, theta: f64) {
        self.pieces.dense(piece).at(theta, &mut self.start);
    }
}

/// Adds `h sum_i w_i k_i`.
fn add_weighted(to: &mut [f64], h: f64, weights: &[f64], stages: &[Vec<f64>]) {
    for (weight, stage) in weights.iter().zip(stages) {
        if *weight != 0.0 {
            let factor = h * weight;
            for (to, k) in to.iter_mut().zip(stage) {
                *to += factor * k;
            }
        }
    }
}
