//! Memories that follow rate equations, along the straight motion of a step.

use crate::law::{COORDINATES, Law, Local, State};

/// The error of a memory in a part of a step, over what it may be, that is small enough.
const SMALL: f64 = 1e-12;

/// A part of a step below which no error is found to be small enough any more.
const SHORTEST: f64 = 1e-6;

/// A memory at the end of a step in which the law's coordinates go straight from one position to
/// another: the classical Runge-Kutta formula, with the error of two half steps beside a whole one,
/// which is taken off.
pub(crate) fn flowed<L: Law>(law: &L, state: State, path: [Local<f64>; 2], dt: f64) -> [f64; 2] {
    let path = Path::new(law, state, path, dt);
    let (mut memory, mut at, mut width) = (state.memory, 0.0, 1.0f64);
    while at < 1.0 {
        width = width.min(1.0 - at);
        let whole = path.stepped(memory, at, width);
        let half = path.stepped(memory, at, 0.5 * width);
        let halves = path.stepped(half, at + 0.5 * width, 0.5 * width);
        let error = path.error(&whole, &halves);
        // Written so that an error which is no number does not go on for ever.
        if error > SMALL && width > SHORTEST {
            width *= 0.5;
            continue;
        }
        for (memory, (fine, coarse)) in memory.iter_mut().zip(halves.iter().zip(whole)) {
            *memory = fine + (fine - coarse) / 15.0;
        }
        at += width;
        width *= 2.0;
    }
    memory
}

/// The motion that a memory follows.
struct Path<'a, L> {
    law: &'a L,
    state: State,
    from: Local<f64>,
    velocity: Local<f64>,
    dt: f64,
    sizes: [f64; 2],
}

impl<'a, L: Law> Path<'a, L> {
    fn new(law: &'a L, state: State, [from, to]: [Local<f64>; 2], dt: f64) -> Self {
        let mut velocity = [0.0; COORDINATES];
        for ((v, from), to) in velocity.iter_mut().zip(from).zip(to) {
            *v = (to - from) / dt;
        }
        Self {
            law,
            state,
            from,
            velocity,
            dt,
            sizes: law.memory_sizes(&to),
        }
    }

    /// The rates of a memory at a part of the step, times the step.
    fn rates(&self, memory: [f64; 2], at: f64) -> [f64; 2] {
        let mut position = self.from;
        for (x, v) in position.iter_mut().zip(self.velocity) {
            *x += at * self.dt * v;
        }
        let state = State::with_memory(self.state.number, memory);
        let rates = self.law.memory_rates(state, &position, &self.velocity);
        rates.map(|rate| rate * self.dt)
    }

    /// A memory after a part of the step.
    fn stepped(&self, memory: [f64; 2], at: f64, width: f64) -> [f64; 2] {
        let on = |rates: [f64; 2], part: f64| [0, 1].map(|i| memory[i] + part * width * rates[i]);
        let middle = at + 0.5 * width;
        let first = self.rates(memory, at);
        let second = self.rates(on(first, 0.5), middle);
        let third = self.rates(on(second, 0.5), middle);
        let last = self.rates(on(third, 1.0), at + width);
        let mean = [0, 1].map(|i| (first[i] + 2.0 * (second[i] + third[i]) + last[i]) / 6.0);
        on(mean, 1.0)
    }

    /// By how much two memories differ, over what these may be.
    fn error(&self, one: &[f64; 2], other: &[f64; 2]) -> f64 {
        let both = one.iter().zip(other).zip(self.sizes);
        both.fold(0.0, |error: f64, ((a, b), size)| {
            let apart = (a - b).abs();
            if apart == 0.0 {
                error
            } else {
                error.max(apart / size.max(a.abs()))
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::{Zener, ZenerDamper};

    /// Drawn out at a constant speed, a linear dashpot behind a spring lags by `v tau (1 - e^(-t/tau))`.
    #[test]
    fn a_linear_dashpot_follows_its_closed_form() {
        let parts = Zener {
            in_series: 1e12,
            in_parallel: 0.0,
            in_branch: 50.0,
            damping: 2.0,
            exponent: 1.0,
        };
        let law = ZenerDamper::new(vec![1.0], parts).unwrap();
        let (speed, dt, time) = (0.3, 0.5, 2.0 / 50.0);
        let end = [speed * dt, 0.0, 0.0];
        let [found, rest] = flowed(&law, State::FIRST, [[0.0; 3], end], dt);
        let known = speed * (dt - time * (1.0 - f64::exp(-dt / time)));
        assert!((found - known).abs() < 1e-9 * known, "{found} {known}");
        assert_eq!(rest, 0.0);
    }
}
