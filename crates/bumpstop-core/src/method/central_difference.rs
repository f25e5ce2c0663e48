//! Central difference with modal damping taken at the middle of the step. Second order.
//!
//! `(q[n+1] - 2 q[n] + q[n-1]) / dt^2 + c (q[n+1] - q[n-1]) / (2 dt) + omega^2 q[n] = f[n]`,
//! stable while `dt < 2 / omega`. Laws see the velocity of their local coordinates as the
//! second-order backward difference, so that a damper in a stop keeps the order.
//! Source: T. J. R. Hughes, The Finite Element Method, 1987, section 9.1.

use super::fixed_step::{
    LawForces, STEPS_BETWEEN_OBSERVATIONS, Step, StepRecord, VelocityRule, check_step,
    highest_frequency,
};
use super::{Observer, observe};
use crate::error::Result;
use crate::history::History;
use crate::law::{COORDINATES, Law, Local, project};
use crate::number::{LANES, Lanes, fill};
use crate::problem::Problem;
use crate::system::ModalSystem;
use pulp::Arch;

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
    problem: &Problem<L>,
    step: Step,
    observer: Observer<'_>,
) -> Result<History<L>> {
    let mut record = StepRecord::new(problem, step.dt, VelocityRule::Central)?;
    check_step(NAME, step, stability_limit(&problem.system, &problem.laws))?;
    let mut laws = LawForces::new(&problem.laws, &problem.displacement, &problem.velocity);
    Arch::new().dispatch(|| march(problem, &mut record, &mut laws, observer))?;
    record.check()?;
    Ok(History::of_steps(problem, NAME, record, laws.into_events()))
}

/// The scheme solved for `q[n+1] = own q[n] + past q[n-1] + gain f[n]`.
struct Coefficients {
    own: Vec<f64>,
    past: Vec<f64>,
    gain: Vec<f64>,
}

impl Coefficients {
    fn new(system: &ModalSystem, dt: f64) -> Self {
        let each = |f: &dyn Fn(f64, f64) -> f64| {
            let values: Vec<f64> = (system.omega2().iter().zip(system.damping()))
                .map(|(w2, c)| f(*w2, 0.5 * c * dt))
                .collect();
            fill(&values, 0.0)
        };
        Self {
            own: each(&|w2, half| (2.0 - w2 * dt * dt) / (1.0 + half)),
            past: each(&|_, half| -(1.0 - half) / (1.0 + half)),
            gain: each(&|_, half| dt * dt / (1.0 + half)),
        }
    }
}

#[inline(always)]
fn march<L: Law>(
    problem: &Problem<L>,
    record: &mut StepRecord,
    laws: &mut LawForces<'_, L>,
    observer: Observer<'_>,
) -> Result<()> {
    let dt = record.dt;
    let coefficients = Coefficients::new(&problem.system, dt);
    let constant = fill(problem.forcing.forces(), 0.0);
    let mut forces = vec![0.0; constant.len()];
    let before = displacement_before(problem, dt);
    let mut past: Vec<[Local<f64>; 2]> = (problem.laws.iter())
        .map(|law| past_positions(law, problem, &before, dt))
        .collect();
    record.start(&before, &problem.displacement);
    for n in 0..=record.steps {
        if n % STEPS_BETWEEN_OBSERVATIONS == 0 {
            observe(observer, n as f64 * dt)?;
        }
        let (previous, q, next) = record.window(n);
        forces.copy_from_slice(&constant);
        laws.add(&mut forces, n as f64 * dt, q, |law, position| {
            let rate = backward_difference(position, &past[law], dt);
            past[law] = [*position, past[law][0]];
            rate
        });
        for o in (0..forces.len()).step_by(LANES) {
            let own = Lanes::load(&coefficients.own[o..]) * Lanes::load(&q[o..]);
            let past = Lanes::load(&coefficients.past[o..]) * Lanes::load(&previous[o..]);
            let gain = Lanes::load(&coefficients.gain[o..]) * Lanes::load(&forces[o..]);
            (own + past + gain).store(&mut next[o..]);
        }
    }
    Ok(())
}

/// `(3 x[n] - 4 x[n-1] + x[n-2]) / (2 dt)`
#[inline(always)]
fn backward_difference(now: &Local<f64>, past: &[Local<f64>; 2], dt: f64) -> Local<f64> {
    std::array::from_fn(|i| (3.0 * now[i] - 4.0 * past[0][i] + past[1][i]) / (2.0 * dt))
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

/// Local positions at steps -1 and -2, such that the backward difference at step 0 gives the
/// initial velocity.
fn past_positions<L: Law>(
    law: &L,
    problem: &Problem<L>,
    before: &[f64],
    dt: f64,
) -> [Local<f64>; 2] {
    let now = project(law, &problem.displacement);
    let rate = project(law, &problem.velocity);
    let previous = project(law, before);
    let mut older = [0.0; COORDINATES];
    for i in 0..COORDINATES {
        older[i] = 2.0 * dt * rate[i] - 3.0 * now[i] + 4.0 * previous[i];
    }
    [previous, older]
}
