//! Semi-implicit (symplectic) Euler: `v += dt a(q, v)`, then `q += dt v`. First order.
//!
//! The scheme of the published solution of SDNL32. Stable while
//! `dt < 2 (sqrt(1 + xi^2) - xi) / omega` for each mode, from the Jury conditions on its
//! amplification matrix. Source: E. Hairer, C. Lubich, G. Wanner, Geometric Numerical
//! Integration, 2nd edition, 2006, section I.1.2.

use super::fixed_step::{
    LawForces, STEPS_BETWEEN_OBSERVATIONS, Step, StepRecord, VelocityRule, check_step,
    highest_frequency,
};
use super::{Observer, observe};
use crate::error::Result;
use crate::history::History;
use crate::law::{COORDINATES, Law};
use crate::number::{LANES, Lanes, Number, fill, sum};
use crate::problem::Problem;
use crate::system::ModalSystem;
use pulp::Arch;

/// The method's name.
pub const NAME: &str = "symplectic_euler";

/// Largest stable step, in s, with the laws in their stiffest states.
pub fn stability_limit<L: Law>(system: &ModalSystem, laws: &[L]) -> f64 {
    let omega = highest_frequency(system, laws);
    let modal = system.damping().iter().fold(0.0f64, |m, c| m.max(*c));
    let damping = modal + laws.iter().map(law_damping).sum::<f64>();
    let xi = damping / (2.0 * omega);
    2.0 * ((1.0 + xi * xi).sqrt() - xi) / omega
}

fn law_damping<L: Law>(law: &L) -> f64 {
    let piece = law.stiffest();
    (law.rows().iter().zip(piece.damping).enumerate())
        .map(|(i, (row, damping))| damping[i] * row.iter().map(|r| r * r).sum::<f64>())
        .sum()
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
    let mut record = StepRecord::new(problem, step.dt, VelocityRule::Backward)?;
    check_step(NAME, step, stability_limit(&problem.system, &problem.laws))?;
    let mut laws = LawForces::new(&problem.laws, &problem.displacement, &problem.velocity);
    Arch::new().dispatch(|| march(problem, &mut record, &mut laws, observer))?;
    record.check()?;
    Ok(History::of_steps(problem, NAME, record, laws.into_events()))
}

#[inline(always)]
fn march<L: Law>(
    problem: &Problem<L>,
    record: &mut StepRecord,
    laws: &mut LawForces<'_, L>,
    observer: Observer<'_>,
) -> Result<()> {
    let dt = record.dt;
    let omega2 = fill(problem.system.omega2(), 0.0);
    let damping = fill(problem.system.damping(), 0.0);
    let constant = fill(problem.forcing.forces(), 0.0);
    let mut velocity = fill(&problem.velocity, 0.0);
    let mut forces = vec![0.0; velocity.len()];
    let rows: Vec<Vec<Vec<f64>>> = (problem.laws.iter())
        .map(|law| law.rows().iter().map(|row| fill(row, 0.0)).collect())
        .collect();
    let before: Vec<f64> = (problem.displacement.iter().zip(&problem.velocity))
        .map(|(q, v)| q - dt * v)
        .collect();
    record.start(&before, &problem.displacement);
    for n in 0..=record.steps {
        if n % STEPS_BETWEEN_OBSERVATIONS == 0 {
            observe(observer, n as f64 * dt)?;
        }
        let (_, q, next) = record.window(n);
        forces.copy_from_slice(&constant);
        laws.add(&mut forces, n as f64 * dt, q, |law, _| {
            let mut local = [0.0; COORDINATES];
            for (x, row) in local.iter_mut().zip(&rows[law]) {
                *x = sum(row.len(), |o| {
                    Lanes::load(&row[o..]) * Lanes::load(&velocity[o..])
                });
            }
            local
        });
        for o in (0..forces.len()).step_by(LANES) {
            let (q, v) = (Lanes::load(&q[o..]), Lanes::load(&velocity[o..]));
            let force = Lanes::load(&forces[o..]);
            let inner = Lanes::load(&omega2[o..]) * q + Lanes::load(&damping[o..]) * v;
            let faster = v + (force - inner) * Lanes::of(dt);
            faster.store(&mut velocity[o..]);
            (q + faster * Lanes::of(dt)).store(&mut next[o..]);
        }
    }
    Ok(())
}
