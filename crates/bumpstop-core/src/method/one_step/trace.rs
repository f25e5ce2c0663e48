//! What a run of fixed steps leaves: a cubic for each step, cut where laws switch.
//!
//! A scheme knows its motion at the ends of steps alone. Between them it is the cubic that has the
//! values and rates of both ends, on which the guard of a law that has switched is looked for; the
//! step is cut there, and at knots of loads, into parts of one state each. The works of the energy
//! ledger are integrated over each part by Simpson's rule.

use super::Motion;
use super::laws::Laws;
use crate::energy::{self, Growth};
use crate::error::{Error, Place, Result};
use crate::history::Event;
use crate::law::{Law, State};
use crate::method::polynomial_steps::{
    Crossing, Dense, Equations, Layout, Percussion, PolynomialRecord, Step, Watch, cubic_rates,
    write_cubic,
};
use crate::problem::Problem;

/// Degree of the polynomials.
const DEGREE: usize = 3;

/// Of the step, by which its number may exceed a whole one: rounding of a duration.
const ROUNDING: f64 = 1e-9;

/// The trace of a run.
pub(crate) struct Trace<'a, L> {
    problem: &'a Problem<L>,
    h: f64,
    steps: usize,
    equations: Equations<'a, L>,
    watch: Watch,
    record: PolynomialRecord,
    events: Vec<Event>,
    /// States at the start of the next step.
    states: Vec<State>,
    /// Numbers and rates at both ends of the step.
    ends: [Vec<f64>; 2],
    rates: [Vec<f64>; 2],
    /// Rates at both ends that are told and not made of the equations; none or those of all
    /// numbers before the works.
    told: [Vec<f64>; 2],
    /// The cubic of the step, and what a part of it is made of.
    rows: Vec<f64>,
    part: Part,
    cuts: Vec<Cut>,
    /// The works of the energy ledger so far, and what these say of it.
    works: Vec<f64>,
    growth: Option<Growth>,
    /// Times what there is, what the energy of a stable run may seem to be.
    swing: f64,
    /// Impulses in the step that is kept next.
    percussions: Vec<Percussion>,
}

/// Numbers and rates at both ends of a part and in its middle, and its cubic.
#[derive(Debug)]
struct Part {
    numbers: [Vec<f64>; 3],
    rates: [Vec<f64>; 3],
    rows: Vec<f64>,
}

/// Where a step is cut.
#[derive(Debug, Clone, Copy)]
struct Cut {
    theta: f64,
    /// The law that switches, if one does, and the guard's name.
    switch: Option<(usize, &'static str)>,
}

/// What a scheme tells of the end of a step.
pub(crate) trait End {
    /// Writes the numbers before the works.
    fn numbers(&self, to: &mut [f64]);

    /// Writes their rates at both ends of the step, where the equations of the problem do not say
    /// them; those at the start are what the step before told, unless they change.
    fn rates(&self, _ends: [&mut Vec<f64>; 2]) {}

    /// The accelerations squared, over the whole mass, where they are told.
    fn inertia(&self) -> Option<f64> {
        None
    }
}

impl End for Motion {
    fn numbers(&self, to: &mut [f64]) {
        let (q, v) = to.split_at_mut(self.q.len());
        q.copy_from_slice(&self.q);
        v.copy_from_slice(&self.v);
    }
}

impl<'a, L: Law> Trace<'a, L> {
    /// An empty one, for steps of width h.
    ///
    /// # Errors
    /// [`Error::NotPositive`], [`Error::NotFinite`] or [`Error::TooManySteps`].
    pub(crate) fn new(problem: &'a Problem<L>, layout: Layout, h: f64) -> Result<Self> {
        crate::error::check_finite("dt", &[h])?;
        if h <= 0.0 {
            return Err(Error::NotPositive {
                what: "dt",
                value: h,
            });
        }
        let equations = Equations::new(problem, layout.clone());
        let count = (problem.duration / h - ROUNDING).ceil().max(1.0);
        PolynomialRecord::check_room(&layout, DEGREE, count)?;
        let zeros = || vec![0.0; layout.size()];
        Ok(Self {
            problem,
            h,
            steps: count as usize,
            equations,
            watch: Watch::new(problem, DEGREE),
            events: Vec::new(),
            states: Vec::new(),
            ends: [zeros(), zeros()],
            rates: [zeros(), zeros()],
            told: [Vec::new(), Vec::new()],
            rows: Vec::new(),
            part: Part {
                numbers: [zeros(), zeros(), zeros()],
                rates: [zeros(), zeros(), zeros()],
                rows: Vec::new(),
            },
            cuts: Vec::new(),
            works: vec![0.0; layout.size() - layout.works],
            growth: None,
            swing: 1.0,
            percussions: Vec::new(),
            record: PolynomialRecord::new(layout, DEGREE),
        })
    }

    /// Takes the largest step with which the scheme is stable; infinite without one.
    pub(crate) fn know_limit(&mut self, limit: f64) {
        self.swing = energy::swing(self.h / limit);
    }

    pub(super) fn problem(&self) -> &'a Problem<L> {
        self.problem
    }

    pub(crate) fn steps(&self) -> usize {
        self.steps
    }

    pub(crate) fn h(&self) -> f64 {
        self.h
    }

    pub(crate) fn done(self) -> (PolynomialRecord, Vec<Event>) {
        (self.record, self.events)
    }

    /// The motion at t = 0, in equilibrium.
    pub(super) fn begin(&mut self, laws: &Laws<'_, L>) -> Motion {
        let modes = self.problem.displacement.len();
        let mut motion = Motion {
            q: self.problem.displacement.clone(),
            v: self.problem.velocity.clone(),
            a: vec![0.0; modes],
        };
        self.begin_at(&motion, laws);
        (motion.a).copy_from_slice(&self.rates[1][modes..2 * modes]);
        motion
    }

    /// Takes what is told of t = 0.
    pub(crate) fn begin_at(&mut self, end: &impl End, laws: &Laws<'_, L>) {
        self.states.clone_from(&laws.states);
        self.equations.loads.turn(0.0);
        self.equations.take_states(&self.states);
        self.take(end);
        self.find_rates(1, 0.0);
        let layout = &self.equations.layout;
        let start = layout.ledger(self.problem, 0.0, &self.states, &self.ends[1]);
        let modes = layout.modes;
        let squares = || self.rates[1][modes..2 * modes].iter().map(|a| a * a).sum();
        let inertia: f64 = end.inertia().unwrap_or_else(squares);
        let jolt = 0.5 * self.h * self.h * inertia;
        self.growth = Some(Growth::of_steps(&start, self.swing, jolt));
    }

    /// Takes what is told of the end of a step.
    fn take(&mut self, end: &impl End) {
        end.numbers(&mut self.ends[1][..self.equations.layout.works]);
        let [first, last] = &mut self.told;
        last.clear();
        end.rates([first, last]);
    }

    /// The rates at one end of the step, in the states and loads that the equations are turned to.
    fn find_rates(&mut self, end: usize, time: f64) {
        self.equations
            .rates(time, &self.ends[end], &mut self.rates[end]);
        self.take_told(end);
    }

    /// Takes the rates that are told at one end of the step.
    fn take_told(&mut self, end: usize) {
        let told = &self.told[end];
        self.rates[end][..told.len()].copy_from_slice(told);
    }

    /// Keeps a step.
    ///
    /// # Errors
    /// [`Error::LongRecord`]
    pub(crate) fn add(&mut self, span: [f64; 2], end: &impl End, laws: &Laws<'_, L>) -> Result<()> {
        self.ends.swap(0, 1);
        self.told.swap(0, 1);
        self.take(end);
        self.cuts.clear();
        self.follow(span, &laws.states);
        self.find_switches(span, &laws.states);
        (self.cuts).sort_by(|a, b| a.theta.total_cmp(&b.theta));
        self.cuts.push(Cut {
            theta: 1.0,
            switch: None,
        });
        self.record.count_step();
        let mut from = 0.0;
        for number in 0..self.cuts.len() {
            let Cut { theta, switch } = self.cuts[number];
            self.keep([from, theta], span)?;
            from = theta;
            if let Some((law, guard)) = switch {
                self.switch(law, guard, self.instant(theta, span), laws.states[law]);
            }
        }
        // Memories go on, too, where states do not switch.
        self.states.copy_from_slice(&laws.states);
        self.keep_percussions();
        self.check_growth(span[1])
    }

    /// Takes note of an impulse in the step that is kept next.
    pub(super) fn strike(&mut self, percussion: Percussion) {
        self.percussions.push(percussion);
    }

    /// Keeps the impulses of the step that was kept last.
    fn keep_percussions(&mut self) {
        for percussion in self.percussions.drain(..) {
            let Percussion { law, time, .. } = percussion;
            self.record.strike(percussion);
            let state = self.states[law];
            if !self.problem.laws[law].in_contact(state) && time < self.problem.duration {
                self.events.push(Event {
                    time,
                    law,
                    guard: "impact",
                    before: state,
                    after: state,
                });
            }
        }
    }

    /// Refuses a motion that blows up.
    fn check_growth(&mut self, time: f64) -> Result<()> {
        let layout = &self.equations.layout;
        let mut numbers = self.ends[1].clone();
        numbers[layout.works..].copy_from_slice(&self.works);
        let ledger = layout.ledger(self.problem, time, &self.states, &numbers);
        let Some(ratio) = self.growth.as_mut().and_then(|growth| growth.sees(&ledger)) else {
            return Ok(());
        };
        let [q, v] = layout.motion(&numbers);
        let whole = !layout.is_told();
        Err(Error::BlowUp {
            time,
            ratio,
            place: whole
                .then(|| Place::Mode(energy::largest_share(self.problem.system.omega2(), q, v))),
        })
    }

    /// Makes the cubic of the step, and cuts it at the knots of loads.
    fn follow(&mut self, [start, end]: [f64; 2], after: &[State]) {
        let mut knot = self.equations.loads.turn(start);
        self.rates.swap(0, 1);
        if self.equations.loads.vary() {
            // They may have jumped.
            self.equations.take_states(&self.states);
            self.find_rates(0, start);
        } else {
            self.take_told(0);
        }
        while knot < end {
            self.cuts.push(Cut {
                theta: (knot - start) / self.h,
                switch: None,
            });
            knot = self.equations.loads.turn(knot);
        }
        self.equations.take_states(after);
        self.find_rates(1, end);
        let [from, to] = &self.ends;
        let [first, last] = &self.rates;
        write_cubic(self.h, [from, to], [first, last], &mut self.rows);
        self.equations.loads.turn(start);
    }

    /// Cuts the step where laws switch that have other states at its end.
    fn find_switches(&mut self, [start, _]: [f64; 2], after: &[State]) {
        let size = self.ends[0].len();
        let step = Step {
            time: start,
            h: self.h,
            dense: Dense {
                rows: &self.rows,
                size,
            },
            rounded: &[],
        };
        let Equations { layout, loads, .. } = &self.equations;
        for (index, (before, after)) in self.states.iter().zip(after).enumerate() {
            if before.number == after.number {
                continue;
            }
            let law = &self.problem.laws[index];
            let found = (self.watch).fall((law, index), *before, layout, loads, step);
            let name = |crossing: Crossing| law.guard(*before, crossing.guard).name;
            self.cuts.push(Cut {
                theta: found.map_or(1.0, |crossing| crossing.theta),
                switch: Some((index, found.map_or("step", name))),
            });
        }
    }

    /// The time in a part of the step, within the run.
    fn instant(&self, theta: f64, [start, end]: [f64; 2]) -> f64 {
        let duration = self.problem.duration;
        if theta < 1.0 {
            (start + theta * self.h).min(duration)
        } else if end > duration - ROUNDING * self.h {
            duration
        } else {
            end
        }
    }

    /// Keeps a part of the step, with the works in it.
    fn keep(&mut self, [from, to]: [f64; 2], span: [f64; 2]) -> Result<()> {
        let times = [from, to].map(|theta| self.instant(theta, span));
        if times[1] <= times[0] {
            return Ok(());
        }
        let Layout { works, .. } = self.equations.layout;
        let h = (to - from) * self.h;
        self.equations.take_states(&self.states);
        self.equations.loads.turn(times[0]);
        let dense = Dense {
            rows: &self.rows,
            size: self.ends[0].len(),
        };
        let Part {
            numbers,
            rates,
            rows,
        } = &mut self.part;
        let thetas = [from, to, 0.5 * (from + to)];
        for ((numbers, rates), theta) in numbers.iter_mut().zip(&mut *rates).zip(thetas) {
            if theta == 0.0 || theta == 1.0 {
                let end = usize::from(theta == 1.0);
                numbers.copy_from_slice(&self.ends[end]);
                rates.copy_from_slice(&self.rates[end]);
                continue;
            }
            dense.at(theta, &mut numbers[..works]);
            let time = span[0] + theta * self.h;
            self.equations.rates(time, numbers, rates);
            cubic_rates(dense, theta, self.h, &mut rates[..works]);
        }
        for work in works..numbers[0].len() {
            numbers[0][work] = self.works[work - works];
            let mean = (rates[0][work] + 4.0 * rates[2][work] + rates[1][work]) / 6.0;
            numbers[1][work] = numbers[0][work] + h * mean;
        }
        if to == 1.0 {
            for percussion in &self.percussions {
                numbers[1][self.equations.layout.dissipated(percussion.law)] += percussion.loss();
            }
        }
        self.works.copy_from_slice(&numbers[1][works..]);
        let [start, end, _] = &*numbers;
        let [first, last, _] = &*rates;
        write_cubic(h, [start, end], [first, last], rows);
        let part = Dense { rows, ..dense };
        (self.record).add(times[0], h, times[1], part, &self.states)
    }

    /// Switches a law at a time, where the part before ends.
    fn switch(&mut self, law: usize, guard: &'static str, time: f64, after: State) {
        let layout = &self.equations.layout;
        let before = std::mem::replace(&mut self.states[law], after);
        if time >= self.problem.duration {
            return;
        }
        let [q, v] = layout.motion(&self.part.numbers[1]);
        let [position, _] = self.problem.local(law, time, q, v);
        let lost = self.problem.laws[law].switch_loss(before, after, &position);
        self.works[layout.dissipated(law) - layout.works] += lost;
        self.events.push(Event {
            time,
            law,
            guard,
            before,
            after,
        });
    }
}
