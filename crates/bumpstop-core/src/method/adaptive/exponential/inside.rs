//! The motion inside a step: that under forces on the parabola through three stages, kept as
//! polynomials of degree five.
//!
//! Each polynomial has the values and rates of the motion at both ends and in the middle of its
//! piece. A mode that moves at a rate r with an amplitude A is followed to `A (r w)^6 / 311,000` by
//! pieces of width w (the remainder of Hermite's interpolation at three points: J. Stoer, R. Bulirsch,
//! Introduction to Numerical Analysis, 3rd edition, 2002, section 2.1.5): there are as many as keep
//! that below a tenth of the tolerance. A fast mode that does not move needs none of its own.

use super::leave_forces;
use super::propagators::{Propagators, STAGES};
use crate::law::Law;
use crate::method::adaptive::pieces::Pieces;
use crate::method::polynomial_steps::{Equations, write_cubic};

/// Degree of the polynomials.
pub(super) const DEGREE: usize = 5;

/// Largest of `(x (x - 1/2) (x - 1))^2 / 6!` over the tenth of the tolerance.
const REMAINDER: f64 = 3.215e-5;

/// The most pieces of a step.
const MOST: f64 = 4096.0;

/// A step whose stages are known.
pub(super) struct Step<'a> {
    pub time: f64,
    pub h: f64,
    /// Numbers and rates at its start.
    pub start: [&'a [f64]; 2],
    pub stages: &'a [Vec<f64>; STAGES],
    /// The error that is allowed in each number.
    pub scales: &'a [f64],
}

/// Room for the numbers at both ends and in the middle of a piece, and their rates.
pub(super) struct Inside {
    fine: Propagators,
    numbers: [Vec<f64>; 3],
    rates: [Vec<f64>; 3],
    /// The first stage of the next step.
    next: Vec<f64>,
}

impl Inside {
    pub(super) fn new(size: usize) -> Self {
        let room = || vec![0.0; size];
        Self {
            fine: Propagators::default(),
            numbers: std::array::from_fn(|_| room()),
            rates: std::array::from_fn(|_| room()),
            next: room(),
        }
    }

    /// Hands rates and the first stage over to the next step.
    pub(super) fn go_on(&mut self, rates: &mut Vec<f64>, first: &mut Vec<f64>) {
        std::mem::swap(rates, &mut self.rates[2]);
        std::mem::swap(first, &mut self.next);
    }

    /// Makes the pieces of a step, and the works at its end.
    pub(super) fn follow<L: Law>(
        &mut self,
        step: &Step<'_>,
        end: &mut [f64],
        equations: &mut Equations<'_, L>,
        pieces: &mut Pieces,
    ) {
        let works = equations.layout.works;
        let count = step.pieces(end, equations);
        let part = 0.5 / count as f64;
        let width = step.h / count as f64;
        self.fine.turn(part * step.h, &equations.problem.system);
        self.numbers[2].copy_from_slice(step.start[0]);
        self.rates[2].copy_from_slice(step.start[1]);
        pieces.clear();
        for piece in 0..count {
            self.numbers.swap(0, 2);
            self.rates.swap(0, 2);
            for half in 0..2 {
                let gone = 2 * piece + half;
                let (from, to) = self.numbers.split_at_mut(half + 1);
                let to = &mut to[0];
                if gone + 1 == 2 * count {
                    to[..works].copy_from_slice(&end[..works]);
                } else {
                    self.fine.carry(&from[half], &mut to[..works]);
                    for (k, weights) in parabola(gone as f64 * part, part).iter().enumerate() {
                        (self.fine).push(k + 1, weights, step.stages, &mut to[..works]);
                    }
                }
                let time = step.time + (gone + 1) as f64 * part * step.h;
                equations.rates(time, to, &mut self.rates[half + 1]);
            }
            self.add_works(width, works);
            self.write(width, works, pieces.next());
        }
        end[works..].copy_from_slice(&self.numbers[2][works..]);
        self.next.copy_from_slice(&self.rates[2]);
        leave_forces(equations, end, &mut self.next);
    }

    /// The works at the end of a piece, by Simpson's rule.
    fn add_works(&mut self, width: f64, works: usize) {
        let [start, _, end] = &mut self.numbers;
        let [first, middle, last] = &self.rates;
        for i in works..start.len() {
            end[i] = start[i] + width / 6.0 * (first[i] + 4.0 * middle[i] + last[i]);
        }
    }

    /// Writes the polynomial of a piece: the cubic of both ends, and what the middle adds.
    fn write(&self, width: f64, works: usize, rows: &mut Vec<f64>) {
        let [start, middle, end] = &self.numbers;
        let [first, slope, last] = &self.rates;
        write_cubic(width, [start, end], [first, last], rows);
        let size = start.len();
        rows.resize(6 * size, 0.0);
        for i in 0..works {
            let [value, across, second, third] = [0, 1, 2, 3].map(|row| rows[row * size + i]);
            let value = middle[i] - value - 0.5 * (across + 0.5 * (second + 0.5 * third));
            let slope = width * slope[i] - across - 0.25 * third;
            rows[4 * size + i] = 16.0 * value - 8.0 * slope;
            rows[5 * size + i] = 16.0 * slope;
        }
    }
}

impl Step<'_> {
    /// How many pieces the modes need that move.
    fn pieces<L: Law>(&self, end: &[f64], equations: &Equations<'_, L>) -> usize {
        let modes = equations.layout.modes;
        let system = &equations.problem.system;
        let own = system.omega2().iter().zip(system.damping());
        let mut most = 1.0f64;
        for (i, (w2, c)) in own.enumerate() {
            let rate = w2.abs().sqrt().max(*c);
            let [start, rates] = self.start;
            let at_end = self.stages[3][modes + i] - w2 * end[i] - c * end[modes + i];
            let speed = start[modes + i].abs().max(end[modes + i].abs());
            let speed = speed.max(rates[modes + i].abs().max(at_end.abs()) / rate);
            let allowed = (rate * self.scales[i]).min(self.scales[modes + i]);
            if speed > 0.0 && rate > 0.0 {
                most = most.max(rate * self.h * (REMAINDER * speed / allowed).powf(1.0 / 6.0));
            }
        }
        most.ceil().min(MOST) as usize
    }
}

/// Weights of the stages in the forces on a part of the step, from `s` on, by powers of the part
/// gone, over its factorials: the parabola through the first, the fifth and the fourth.
pub(super) fn parabola(s: f64, part: f64) -> [[f64; STAGES]; 3] {
    let on = |[first, middle, last]: [f64; 3]| [first, 0.0, 0.0, last, middle];
    let value = [
        (1.0 - s) * (1.0 - 2.0 * s),
        4.0 * s * (1.0 - s),
        s * (2.0 * s - 1.0),
    ];
    let slope = [4.0 * s - 3.0, 4.0 - 8.0 * s, 4.0 * s - 1.0].map(|x| part * x);
    let bend = [4.0, -8.0, 4.0].map(|x| part * part * x);
    [on(value), on(slope), on(bend)]
}
