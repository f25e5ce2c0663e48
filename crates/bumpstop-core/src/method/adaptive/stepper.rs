//! One step of a pair: its stages, its end, and the polynomial across it.

use super::pair::Pair;
use crate::law::Law;
use crate::method::polynomial_steps::{Dense, Equations, write_cubic};

/// The numbers at both ends of a step, and the stages between.
#[derive(Debug)]
pub(super) struct Stepper {
    pub start: Vec<f64>,
    pub end: Vec<f64>,
    /// The first is the derivative at the start; number `b.len()` is that at the end.
    pub stages: Vec<Vec<f64>>,
    inner: Vec<f64>,
    rows: Vec<f64>,
    last: usize,
}

impl Stepper {
    pub(super) fn new(pair: &Pair, start: Vec<f64>) -> Self {
        let room = vec![0.0; start.len()];
        Self {
            end: room.clone(),
            stages: vec![room.clone(); pair.stages()],
            inner: room,
            rows: Vec::new(),
            last: pair.b.len(),
            start,
        }
    }

    /// Starts anew: the derivative at the start has changed.
    pub(super) fn start<L: Law>(&mut self, time: f64, equations: &mut Equations<'_, L>) {
        equations.rates(time, &self.start, &mut self.stages[0]);
    }

    /// Takes a step of width h from a time on.
    pub(super) fn attempt<L: Law>(
        &mut self,
        pair: &Pair,
        time: f64,
        h: f64,
        equations: &mut Equations<'_, L>,
    ) {
        for (number, (a, c)) in pair.a.iter().zip(pair.c).enumerate().skip(1) {
            self.inner.copy_from_slice(&self.start);
            add_weighted(&mut self.inner, h, a, &self.stages);
            equations.rates(time + c * h, &self.inner, &mut self.stages[number]);
        }
        self.end.copy_from_slice(&self.start);
        add_weighted(&mut self.end, h, pair.b, &self.stages);
        equations.rates(time + h, &self.end, &mut self.stages[self.last]);
    }

    /// Makes the polynomial across the step.
    pub(super) fn continue_inside<L: Law>(
        &mut self,
        pair: &Pair,
        time: f64,
        h: f64,
        equations: &mut Equations<'_, L>,
    ) {
        for (number, (c, a)) in pair.extra.iter().enumerate() {
            self.inner.copy_from_slice(&self.start);
            add_weighted(&mut self.inner, h, a, &self.stages);
            let stage = &mut self.stages[self.last + 1 + number];
            equations.rates(time + c * h, &self.inner, stage);
        }
        let ends = [&*self.start, &*self.end];
        let slopes = [&*self.stages[0], &*self.stages[self.last]];
        write_cubic(h, ends, slopes, &mut self.rows);
        for weights in pair.corrections {
            let begun = self.rows.len();
            self.rows.resize(begun + self.start.len(), 0.0);
            add_weighted(&mut self.rows[begun..], h, weights, &self.stages);
        }
    }

    /// The polynomial across the step.
    pub(super) fn dense(&self) -> Dense<'_> {
        Dense {
            rows: &self.rows,
            size: self.start.len(),
        }
    }

    /// Goes on from the end of the step.
    pub(super) fn go_on(&mut self) {
        std::mem::swap(&mut self.start, &mut self.end);
        self.stages.swap(0, self.last);
    }

    /// Goes on from a part of the step.
    pub(super) fn stop_at(&mut self, theta: f64) {
        let dense = Dense {
            rows: &self.rows,
            size: self.start.len(),
        };
        dense.at(theta, &mut self.start);
    }
}

/// Adds `h sum_i w_i k_i`.
pub(super) fn add_weighted(to: &mut [f64], h: f64, weights: &[f64], stages: &[Vec<f64>]) {
    for (weight, stage) in weights.iter().zip(stages) {
        if *weight != 0.0 {
            let factor = h * weight;
            for (to, k) in to.iter_mut().zip(stage) {
                *to += factor * k;
            }
        }
    }
}
