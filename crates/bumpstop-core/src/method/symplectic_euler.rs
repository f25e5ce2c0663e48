//! Semi-implicit (symplectic) Euler: `v += dt a(q, v)`, then `q += dt v`. First order.
//!
//! The scheme of the published solution of SDNL32. Stable while
//! `dt < 2 (sqrt(1 + xi^2) - xi) / omega` for each mode, from the Jury conditions on its
//! amplification matrix. Source: E. Hairer, C. Lubich, G. Wanner, Geometric Numerical
//! Integration, 2nd edition, 2006, section I.1.2.

use super::fixed_step::{
    LawForces, STEPS_BETWEEN_OBSERVATIONS, Step, StepRecord, VelocityRule, check_step,
    highest_frequency, row_products,
};
use super::{Observer, observe};
use crate::error::Result;
use crate::history::History;
use crate::law::Law;
use crate::number::{Instructions, LANES, Lanes, Number, Vectorised, blocks, dispatch, dot};
use crate::problem::Problem;
use crate::system::ModalSystem;
use std::sync::Arc;

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
    problem: &Arc<Problem<L>>,
    step: Step,
    observer: Observer<'_>,
) -> Result<History<L>> {
    let mut record = StepRecord::new(problem, step.dt, VelocityRule::Backward)?;
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

/// The structure's part of a step does not wait for the laws: local positions and velocities
/// follow from it and the forces alone, `x' = free + dt^2 (rows . rows) f`, so that the forces of
/// the next step are known before the modes are.
#[inline(always)]
fn march<I: Instructions, L: Law>(
    problem: &Problem<L>,
    record: &mut StepRecord,
    laws: &mut LawForces<'_, L>,
    observer: Observer<'_>,
) -> Result<()> {
    let dt = record.dt;
    let step = Lanes::<I>::of(dt);
    let omega2 = blocks(problem.system.omega2());
    let damping = blocks(problem.system.damping());
    let constant = blocks(problem.forcing.forces());
    let mut q = blocks(&problem.displacement);
    let mut v = blocks(&problem.velocity);
    let mut free = v.clone();
    let rows = laws.rows.clone();
    let coupling = row_products(&rows, &vec![[1.0; LANES]; v.len()]);
    let mut forces = vec![0.0; rows.len()];
    let mut positions: Vec<f64> = rows.iter().map(|row| dot::<I>(row, &q)).collect();
    let mut velocities: Vec<f64> = rows.iter().map(|row| dot::<I>(row, &v)).collect();
    let both = problem.displacement.iter().zip(&problem.velocity);
    let before: Vec<f64> = both.map(|(q, v)| q - dt * v).collect();
    record.push(&blocks(&before));
    record.push(&q);
    for n in 0..=record.steps {
        if n % STEPS_BETWEEN_OBSERVATIONS == 0 {
            observe(observer, n as f64 * dt)?;
        }
        laws.evaluate(n as f64 * dt, &positions, &velocities, &mut forces);
        let structure = omega2.iter().zip(&damping).zip(&constant);
        for (((free, q), v), ((w2, c), p)) in free.iter_mut().zip(&q).zip(&v).zip(structure) {
            let v = Lanes::<I>::of_block(v);
            let inner = Lanes::of_block(w2) * Lanes::of_block(q) + Lanes::of_block(c) * v;
            (v + (Lanes::of_block(p) - inner) * step).to_block(free);
        }
        for (r, row) in rows.iter().enumerate() {
            let mut pushed = 0.0;
            for (product, force) in coupling[r * rows.len()..].iter().zip(&forces) {
                pushed += product * force;
            }
            velocities[r] = dot::<I>(row, &free) + dt * pushed;
            positions[r] += dt * velocities[r];
        }
        for (row, force) in rows.iter().zip(&forces) {
            let impulse = Lanes::<I>::of(dt * force);
            for (free, row) in free.iter_mut().zip(row) {
                (Lanes::of_block(free) + Lanes::of_block(row) * impulse).to_block(free);
            }
        }
        std::mem::swap(&mut v, &mut free);
        for (q, v) in q.iter_mut().zip(&v) {
            (Lanes::<I>::of_block(q) + Lanes::of_block(v) * step).to_block(q);
        }
        record.push(&q);
    }
    Ok(())
}
