//! Central difference with modal damping taken at the middle of the step. Second order.
//!
//! `(q[n+1] - 2 q[n] + q[n-1]) / dt^2 + c (q[n+1] - q[n-1]) / (2 dt) + omega^2 q[n] = f[n]`,
//! stable while `dt < 2 / omega`. Laws see the velocity of their local coordinates as the
//! second-order backward difference, so that a damper in a stop keeps the order.
//! Source: T. J. R. Hughes, The Finite Element Method, 1987, section 9.1.

use super::fixed_step::{
    LawForces, STEPS_BETWEEN_OBSERVATIONS, Step, StepRecord, VelocityRule, check_step,
    highest_frequency, row_products,
};
use super::{Observer, observe};
use crate::error::Result;
use crate::history::History;
use crate::law::{Law, project};
use crate::number::{Block, Instructions, Lanes, Number, Vectorised, blocks, dispatch, dot};
use crate::problem::Problem;
use crate::system::ModalSystem;
use std::sync::Arc;

/// The method's name.
pub const NAME: &str = "central_difference";

/// Largest stable step, in s, with the laws in their stiffest states.
pub fn stability_limit<L: Law>(system: &ModalSystem, laws: &[L]) -> f64 {
    2.0 / highest_frequency(system, laws)
}

/// Runs a problem.
///
/// # Errors
/// See [`crate::error::Error`].
pub fn simulate<L: Law>(
    problem: &Arc<Problem<L>>,
    step: Step,
    observer: Observer<'_>,
) -> Result<History<L>> {
    let mut record = StepRecord::new(problem, step.dt, VelocityRule::Central)?;
    check_step(NAME, step, stability_limit(&problem.system, &problem.laws))?;
    let mut laws = LawForces::new(problem);
    dispatch(March {
        problem,
        record: &mut record,
        laws: &mut laws,
        observer,
    })?;
    record.check()?;
    Ok(History::of_steps(problem, NAME, record, laws.into_events()))
}

/// The scheme solved for `q[n+1] = own q[n] + past q[n-1] + gain f[n]`.
struct Coefficients {
    own: Vec<Block>,
    past: Vec<Block>,
    gain: Vec<Block>,
}

impl Coefficients {
    fn new(system: &ModalSystem, dt: f64) -> Self {
        let each = |f: &dyn Fn(f64, f64) -> f64| {
            let values: Vec<f64> = (system.omega2().iter().zip(system.damping()))
                .map(|(w2, c)| f(*w2, 0.5 * c * dt))
                .collect();
            blocks(&values)
        };
        Self {
            own: each(&|w2, half| (2.0 - w2 * dt * dt) / (1.0 + half)),
            past: each(&|_, half| -(1.0 - half) / (1.0 + half)),
            gain: each(&|_, half| dt * dt / (1.0 + half)),
        }
    }
}

struct March<'a, 'b, 'o, L> {
    problem: &'a Problem<L>,
    record: &'a mut StepRecord,
    laws: &'a mut LawForces<'b, L>,
    observer: Observer<'o>,
}

impl<L: Law> Vectorised for March<'_, '_, '_, L> {
    type Output = Result<()>;
    #[inline(always)]
    fn run<I: Instructions>(self) -> Result<()> {
        march::<I, L>(self.problem, self.record, self.laws, self.observer)
    }
}

/// The structure's part of a step does not wait for the laws: local positions follow from it
/// and the forces alone, `x[n+1] = row . free + (row . gain row) f`, so that the forces of the
/// next step are known before the modes are.
#[inline(always)]
fn march<I: Instructions, L: Law>(
    problem: &Problem<L>,
    record: &mut StepRecord,
    laws: &mut LawForces<'_, L>,
    observer: Observer<'_>,
) -> Result<()> {
    let dt = record.dt;
    let Coefficients { own, past, gain } = Coefficients::new(&problem.system, dt);
    let load: Vec<f64> = (gain.as_flattened().iter().zip(problem.forcing.forces()))
        .map(|(gain, force)| gain * force)
        .collect();
    let load = blocks(&load);
    let rows = laws.rows.clone();
    let coupling = row_products(&rows, &gain);
    let mut forces = vec![0.0; rows.len()];
    let pushes: Vec<Vec<Block>> = rows.iter().map(|row| weighted(row, &gain)).collect();
    let mut q = blocks(&problem.displacement);
    let mut before = blocks(&displacement_before(problem, dt));
    let mut free = q.clone();
    let mut local = LocalHistory::new::<I>(&rows, &before, &q, &blocks(&problem.velocity), dt);
    record.push(&before);
    record.push(&q);
    for n in 0..=record.steps {
        if n % STEPS_BETWEEN_OBSERVATIONS == 0 {
            observe(observer, n as f64 * dt)?;
        }
        laws.evaluate(n as f64 * dt, &local.now, &local.rate, &mut forces);
        let known = own.iter().zip(&q).zip(past.iter().zip(&before)).zip(&load);
        for (free, (((own, q), (past, before)), load)) in free.iter_mut().zip(known) {
            let own = Lanes::<I>::of_block(own) * Lanes::of_block(q);
            let past = Lanes::of_block(past) * Lanes::of_block(before);
            (own + past + Lanes::of_block(load)).to_block(free);
        }
        for (r, row) in rows.iter().enumerate() {
            let mut pushed = 0.0;
            for (product, force) in coupling[r * rows.len()..].iter().zip(&forces) {
                pushed += product * force;
            }
            local.push(r, dot::<I>(row, &free) + pushed, dt);
        }
        for (push, force) in pushes.iter().zip(&forces) {
            let force = Lanes::<I>::of(*force);
            for (free, push) in free.iter_mut().zip(push) {
                (Lanes::of_block(free) + Lanes::of_block(push) * force).to_block(free);
            }
        }
        std::mem::swap(&mut before, &mut q);
        std::mem::swap(&mut q, &mut free);
        record.push(&q);
    }
    Ok(())
}

fn weighted(row: &[Block], weight: &[Block]) -> Vec<Block> {
    let both = row.as_flattened().iter().zip(weight.as_flattened());
    blocks(&both.map(|(r, w)| r * w).collect::<Vec<_>>())
}

/// Local positions at three steps and the rate of the latest, one entry a row.
struct LocalHistory {
    now: Vec<f64>,
    rate: Vec<f64>,
    past: Vec<[f64; 2]>,
}

impl LocalHistory {
    #[inline(always)]
    fn new<I: Instructions>(
        rows: &[Vec<Block>],
        before: &[Block],
        q: &[Block],
        v: &[Block],
        dt: f64,
    ) -> Self {
        let mut history = Self {
            now: Vec::with_capacity(rows.len()),
            rate: Vec::with_capacity(rows.len()),
            past: Vec::with_capacity(rows.len()),
        };
        for row in rows {
            let (now, rate) = (dot::<I>(row, q), dot::<I>(row, v));
            let previous = dot::<I>(row, before);
            // Such that the difference at the start gives the initial velocity.
            let older = 2.0 * dt * rate - 3.0 * now + 4.0 * previous;
            history.now.push(now);
            history.rate.push(rate);
            history.past.push([previous, older]);
        }
        history
    }

    /// Goes one step on; the rate is `(3 x[n] - 4 x[n-1] + x[n-2]) / (2 dt)`.
    #[inline(always)]
    fn push(&mut self, row: usize, next: f64, dt: f64) {
        self.past[row] = [self.now[row], self.past[row][0]];
        self.now[row] = next;
        let [previous, older] = self.past[row];
        self.rate[row] = (3.0 * next - 4.0 * previous + older) * (0.5 / dt);
    }
}

/// `q[-1] = q0 - dt v0 + dt^2/2 a0`, which starts the scheme at its own order.
fn displacement_before<L: Law>(problem: &Problem<L>, dt: f64) -> Vec<f64> {
    let (q, v) = (&problem.displacement, &problem.velocity);
    let mut forces = problem.forcing.forces().to_vec();
    for law in &problem.laws {
        let (position, rate) = (project(law, q), project(law, v));
        let force = law.force(law.sampled_state(&position, &rate), &position, &rate);
        for (row, f) in law.rows().iter().zip(force) {
            for (total, r) in forces.iter_mut().zip(row) {
                *total += r * f;
            }
        }
    }
    let (omega2, damping) = (problem.system.omega2(), problem.system.damping());
    (0..q.len())
        .map(|i| {
            let acceleration = forces[i] - damping[i] * v[i] - omega2[i] * q[i];
            q[i] - dt * v[i] + 0.5 * dt * dt * acceleration
        })
        .collect()
}
