//! Reading the impacts of one law along the steps.

use super::record::{AdaptiveRecord, Reading, Step};
use crate::dynamics::Moment;
use crate::impacts::Impact;
use crate::law::{Law, Local};
use crate::method::instant::force_rate;
use crate::method::piecewise_linear::quadrature::panel;
use crate::problem::Problem;

/// Parts of a step at whose ends signs are looked at.
const PARTS: usize = 8;

/// Reads the contact of one law.
pub(super) struct ContactReader<'a, L> {
    record: &'a AdaptiveRecord,
    problem: &'a Problem<L>,
    law: usize,
    reading: Reading,
}

impl<'a, L: Law> ContactReader<'a, L> {
    pub(super) fn new(record: &'a AdaptiveRecord, problem: &'a Problem<L>, law: usize) -> Self {
        Self {
            record,
            problem,
            law,
            reading: record.reading(),
        }
    }

    pub(super) fn impacts(&mut self) -> Vec<Impact> {
        let mut impacts = Vec::new();
        let mut current: Option<Impact> = None;
        for (number, step) in self.record.list().iter().enumerate() {
            self.record.read(number, step.start, &mut self.reading);
            let contact = self.problem.laws[self.law].in_contact(self.reading.states[self.law]);
            if contact {
                let impact = match current.take() {
                    Some(impact) => impact,
                    None => Impact::starting(step.start, -self.speed(number, step.start)),
                };
                current = Some(self.follow(impact, number, *step));
            } else if let Some(mut impact) = current.take() {
                impact.end = step.start;
                impact.opening_speed = self.speed(number, step.start);
                impacts.push(impact);
            }
        }
        impacts.extend(current);
        impacts
    }

    /// Takes note of one step in contact.
    fn follow(&mut self, mut impact: Impact, number: usize, step: Step) -> Impact {
        let part = (step.end - step.start) / PARTS as f64;
        let at = |i: usize| {
            if i == PARTS {
                step.end
            } else {
                step.start + i as f64 * part
            }
        };
        for i in 0..PARTS {
            let (from, to) = (at(i), at(i + 1));
            for time in [from, to] {
                impact.see_force(time, self.force(number, time));
            }
            if let Some(time) = self.sign_change(number, from, to, Self::force_rate) {
                impact.see_force(time, self.force(number, time));
            }
            let turn = self.sign_change(number, from, to, Self::speed);
            let [impulse, work] = self.integrals(number, from, turn.unwrap_or(to));
            impact.impulse += impulse;
            impact.add_work(work);
            if let Some(turn) = turn {
                let [impulse, work] = self.integrals(number, turn, to);
                impact.impulse += impulse;
                impact.add_work(work);
            }
        }
        impact
    }

    /// Where a function changes its sign between two times, by halving.
    fn sign_change(
        &mut self,
        number: usize,
        mut from: f64,
        mut to: f64,
        function: fn(&mut Self, usize, f64) -> f64,
    ) -> Option<f64> {
        let start = function(self, number, from);
        if start * function(self, number, to) >= 0.0 {
            return None;
        }
        loop {
            let middle = 0.5 * (from + to);
            if middle <= from || middle >= to {
                return Some(middle);
            }
            if start * function(self, number, middle) > 0.0 {
                from = middle;
            } else {
                to = middle;
            }
        }
    }

    /// Impulse, and work done on the structure.
    fn integrals(&mut self, number: usize, from: f64, to: f64) -> [f64; 2] {
        panel(from, to - from, |time| {
            let (force, speed) = (self.force(number, time), self.speed(number, time));
            [force, force * speed]
        })
    }

    /// The local motion at a time.
    fn local(&mut self, number: usize, time: f64) -> [Local<f64>; 2] {
        self.record.read(number, time, &mut self.reading);
        let [q, v] = self.record.layout.motion(&self.reading.numbers);
        self.problem.local(self.law, time, q, v)
    }

    fn force(&mut self, number: usize, time: f64) -> f64 {
        let [position, velocity] = self.local(number, time);
        let state = self.reading.states[self.law];
        self.problem.laws[self.law].force(state, &position, &velocity)[0]
    }

    fn speed(&mut self, number: usize, time: f64) -> f64 {
        let [position, velocity] = self.local(number, time);
        self.problem.laws[self.law].distance(&position, &velocity).1
    }

    fn force_rate(&mut self, number: usize, time: f64) -> f64 {
        let [position, velocity] = self.local(number, time);
        let Reading { numbers, states } = &self.reading;
        let [q, v] = self.record.layout.motion(numbers);
        let moment = Moment {
            time,
            displacement: q,
            velocity: v,
            states,
        };
        let modal = moment.acceleration(self.problem);
        let law = &self.problem.laws[self.law];
        let mut acceleration = crate::law::project(law, &modal);
        if self.problem.forcing.varies() {
            acceleration[0] -= self.problem.forcing.motion(self.law, time)[2];
        }
        force_rate(law, states[self.law], [position, velocity, acceleration])[0]
    }
}
