//! Reading the impacts of one law along the steps.

use super::record::{PolynomialRecord, Reading, Step};
use crate::dynamics::Moment;
use crate::impacts::Impact;
use crate::law::{Law, Local, project};
use crate::method::instant::push_rate;
use crate::method::piecewise_linear::quadrature::panel;
use crate::problem::Problem;

/// Parts of a step at whose ends signs are looked at.
const PARTS: usize = 4;

/// Reads the contact of one law.
pub(crate) struct ContactReader<'a, L> {
    record: &'a PolynomialRecord,
    problem: &'a Problem<L>,
    law: usize,
    reading: Reading,
}

impl<'a, L: Law> ContactReader<'a, L> {
    pub(crate) fn new(record: &'a PolynomialRecord, problem: &'a Problem<L>, law: usize) -> Self {
        Self {
            record,
            problem,
            law,
            reading: record.reading(),
        }
    }

    pub(crate) fn impacts(&mut self) -> Vec<Impact> {
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
        let (mut from, mut last_turn) = (step.start, step.start);
        impact.see_force(from, self.look(number, from)[0]);
        for i in 1..=PARTS {
            let end = step.start + i as f64 * part;
            let to = if i == PARTS { step.end } else { end };
            impact.see_force(to, self.look(number, to)[0]);
            if let Some(peak) = self.sign_change(number, [from, to], Self::force_rate) {
                impact.see_force(peak, self.look(number, peak)[0]);
            }
            // Work to and fro counts apart.
            if let Some(turn) = self.sign_change(number, [from, to], Self::speed) {
                self.add_stretch(&mut impact, number, last_turn, turn);
                last_turn = turn;
            }
            from = to;
        }
        self.add_stretch(&mut impact, number, last_turn, step.end);
        impact
    }

    /// Adds impulse and work between two times.
    fn add_stretch(&mut self, impact: &mut Impact, number: usize, from: f64, to: f64) {
        let [impulse, work] = panel(from, to - from, |time| {
            let [force, speed] = self.look(number, time);
            [force, force * speed]
        });
        impact.impulse += impulse;
        impact.add_work(work);
    }

    /// Where a function changes its sign between two times, by halving.
    fn sign_change(
        &mut self,
        number: usize,
        [mut from, mut to]: [f64; 2],
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

    /// Force and speed of the distance at a time.
    fn look(&mut self, number: usize, time: f64) -> [f64; 2] {
        let [position, velocity] = self.local(number, time);
        let law = &self.problem.laws[self.law];
        let state = self.reading.states[self.law];
        let force = law.force(state, &position, &velocity);
        let push = law.on_contact(state, &position, &force)[0];
        [push, law.distance(&position, &velocity).1]
    }

    fn speed(&mut self, number: usize, time: f64) -> f64 {
        self.look(number, time)[1]
    }

    /// The local motion at a time.
    fn local(&mut self, number: usize, time: f64) -> [Local<f64>; 2] {
        self.record.read(number, time, &mut self.reading);
        let [q, v] = self.record.layout.motion(&self.reading.numbers);
        self.problem.local(self.law, time, q, v)
    }

    /// The accelerations at the time that was read last.
    fn acceleration(&self, number: usize, time: f64) -> Vec<f64> {
        let layout = &self.record.layout;
        if layout.is_told() {
            let mut slopes = vec![0.0; 2 * layout.modes];
            self.record.slope(number, time, &mut slopes);
            return slopes.split_off(layout.modes);
        }
        let Reading {
            numbers, states, ..
        } = &self.reading;
        let [displacement, velocity] = layout.motion(numbers);
        let moment = Moment {
            time,
            displacement,
            velocity,
            states,
        };
        moment.acceleration(self.problem)
    }

    fn force_rate(&mut self, number: usize, time: f64) -> f64 {
        let [position, velocity] = self.local(number, time);
        let whole = self.acceleration(number, time);
        let states = &self.reading.states;
        let law = &self.problem.laws[self.law];
        let mut acceleration = project(law, &whole);
        if self.problem.forcing.varies() {
            let moved = self.problem.forcing.motion(self.law, time)[2];
            for (a, moved) in acceleration.iter_mut().zip(moved) {
                *a -= moved;
            }
        }
        push_rate(law, states[self.law], [position, velocity, acceleration])
    }
}
