//! Semi-implicit (symplectic) Euler: `v += dt a(q, v)`, then `q += dt v`. First order.
//!
//! The scheme of the published solution of SDNL32. Stable while
//! `dt < 2 (sqrt(1 + xi^2) - xi) / omega` for each mode, from the Jury conditions on its
//! amplification matrix. Source: E. Hairer, C. Lubich, G. Wanner, Geometric Numerical
//! Integration, 2nd edition, 2006, section I.1.2.

use super::Observer;
use super::fixed_step::{
    ChangingLoads, Count, March, Modal, Sized, Step, StepRecord, VelocityRule, check_forces,
    check_step, check_uncoupled, coupling, first_state, highest_frequency, laws_damping, modal,
    pushed,
};
use crate::error::Result;
use crate::history::History;
use crate::law::{COORDINATES, Law, Local, project};
use crate::number::{Instructions, Lanes, Number, dispatch};
use crate::problem::Problem;
use crate::system::ModalSystem;
use std::sync::Arc;

/// The method's name.
pub const NAME: &str = "symplectic_euler";

/// Largest stable step, in s, with the laws in their stiffest states.
pub fn stability_limit<L: Law>(system: &ModalSystem, laws: &[L]) -> f64 {
    let omega = highest_frequency(system, laws);
    let modal = system.damping().iter().fold(0.0f64, |m, c| m.max(*c));
    let half = 0.5 * (modal + laws_damping(laws));
    2.0 / (half + half.hypot(omega))
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
    check_uncoupled(NAME, &problem.system)?;
    check_forces(NAME, &problem.laws)?;
    check_step(NAME, step, stability_limit(&problem.system, &problem.laws))?;
    let march = SymplecticEuler {
        problem,
        record: &mut record,
        observer,
    };
    dispatch(Sized { problem, march })?;
    record.check()?;
    let events = record.events(problem);
    Ok(History::of_steps(problem, NAME, record, events))
}

struct SymplecticEuler<'a, 'o, L> {
    problem: &'a Problem<L>,
    record: &'a mut StepRecord,
    observer: Observer<'o>,
}

impl<L: Law> March<L> for SymplecticEuler<'_, '_, L> {
    /// The laws do not wait for the modes of their own step: local velocities follow from the
    /// modes of the step before and the forces alone,
    /// `x' = (row - dt row c) . v - (dt row w2) . q + dt row . (p + row f)`.
    #[inline(always)]
    fn march<I: Instructions, B: Count, A: Count, const CHANGING: bool>(self) -> Result<()> {
        let Self {
            problem,
            record,
            observer,
        } = self;
        let dt = record.dt;
        let step = Lanes::<I>::of(dt);
        let omega2 = modal::<I, B>(problem.system.omega2());
        let damping = modal::<I, B>(problem.system.damping());
        let mut load = modal::<I, B>(problem.forcing.forces());
        let gain = vec![dt; problem.system.modes()];
        let same = vec![1.0; problem.system.modes()];
        let mut changing = ChangingLoads::new(&problem.forcing, dt, &same);
        let laws = A::make(problem.laws.len(), |i| &problem.laws[i]);
        let laws = laws.as_ref();
        let couplings = A::make(laws.len(), |i| {
            A::make(laws.len(), |j| coupling(laws[i], laws[j], &gain))
        });
        let mut contacts = A::make(laws.len(), |i| Contact::<I, B>::new(laws[i], problem, dt));
        let contacts = contacts.as_mut();
        let mut forces = A::make(laws.len(), |_| [0.0; COORDINATES]);
        let forces = forces.as_mut();
        let mut seen = A::make(laws.len(), |i| first_state(laws[i], problem));
        let seen = seen.as_mut();
        let mut q = modal::<I, B>(&problem.displacement);
        let mut v = modal::<I, B>(&problem.velocity);
        let both = problem.displacement.iter().zip(&problem.velocity);
        let before: Vec<f64> = both.map(|(q, v)| q - dt * v).collect();
        record.begin(&before, &problem.displacement);
        let (blocks, states) = (q.as_ref().len(), laws.len().max(1));
        while let Some(stretch) = record.next_stretch() {
            stretch.observe(observer)?;
            let rows = stretch.rows.chunks_exact_mut(blocks);
            for (row, states) in rows.zip(stretch.states.chunks_exact_mut(states)) {
                if CHANGING {
                    let now = changing.next();
                    for (load, now) in load.as_mut().iter_mut().zip(now) {
                        *load = Lanes::of_block(now);
                    }
                    for (law, contact) in laws.iter().zip(contacts.iter_mut()) {
                        contact.load = project(*law, now.as_flattened()).map(|p| dt * p);
                    }
                }
                for (i, (law, contact)) in laws.iter().zip(contacts.iter()).enumerate() {
                    let (position, velocity) = (&contact.position, &contact.velocity);
                    seen[i] = law.sampled_state(seen[i], position, velocity);
                    forces[i] = law.force(seen[i], position, velocity);
                    states[i] = seen[i];
                }
                let coupled = contacts.iter_mut().zip(couplings.as_ref());
                for (law, (contact, couplings)) in laws.iter().zip(coupled) {
                    for c in 0..law.rows().len() {
                        let free = contact.free(c, q.as_ref(), v.as_ref());
                        contact.velocity[c] = free + pushed(laws, couplings.as_ref(), c, forces);
                        contact.position[c] += dt * contact.velocity[c];
                    }
                }
                let known = omega2.as_ref().iter().zip(damping.as_ref());
                for ((v, q), ((w2, c), p)) in
                    (v.as_mut().iter_mut().zip(q.as_ref())).zip(known.zip(load.as_ref()))
                {
                    *v = p.sub_mul(*w2, *q).sub_mul(*c, *v).mul_add(step, *v);
                }
                for ((law, contact), force) in laws.iter().zip(contacts.iter()).zip(&*forces) {
                    let along = contact.rows.iter().zip(force).take(law.rows().len());
                    for (row, force) in along {
                        let impulse = Lanes::<I>::of(dt * force);
                        for (v, row) in v.as_mut().iter_mut().zip(row.as_ref()) {
                            *v = row.mul_add(impulse, *v);
                        }
                    }
                }
                for (q, v) in q.as_mut().iter_mut().zip(v.as_ref()) {
                    *q = v.mul_add(step, *q);
                }
                for (block, q) in row.iter_mut().zip(q.as_ref()) {
                    q.to_block(block);
                }
            }
        }
        Ok(())
    }
}

/// A law's rows times the scheme's coefficients, and its local motion.
struct Contact<I: Instructions, B: Count> {
    rows: Local<Modal<I, B>>,
    of_position: Local<Modal<I, B>>,
    of_velocity: Local<Modal<I, B>>,
    /// What the loads add to the local velocities in a step.
    load: Local<f64>,
    position: Local<f64>,
    velocity: Local<f64>,
}

impl<I: Instructions, B: Count> Contact<I, B> {
    fn new<L: Law>(law: &L, problem: &Problem<L>, dt: f64) -> Self {
        let (omega2, damping) = (problem.system.omega2(), problem.system.damping());
        let zero = vec![0.0; omega2.len()];
        let row = |c: usize| law.rows().get(c).unwrap_or(&zero);
        let times = |c: usize, factor: &dyn Fn(usize) -> f64| {
            let products: Vec<f64> = (row(c).iter().enumerate())
                .map(|(i, r)| r * factor(i))
                .collect();
            modal::<I, B>(&products)
        };
        Self {
            rows: std::array::from_fn(|c| modal::<I, B>(row(c))),
            of_position: std::array::from_fn(|c| times(c, &|i| -dt * omega2[i])),
            of_velocity: std::array::from_fn(|c| times(c, &|i| 1.0 - dt * damping[i])),
            load: project(law, problem.forcing.forces()).map(|p| dt * p),
            position: project(law, &problem.displacement),
            velocity: project(law, &problem.velocity),
        }
    }

    /// The next velocity of a coordinate if no law pushed.
    #[inline(always)]
    fn free(&self, c: usize, q: &[Lanes<I>], v: &[Lanes<I>]) -> f64 {
        let mut total = Lanes::<I>::of(0.0);
        for (factor, v) in self.of_velocity[c].as_ref().iter().zip(v) {
            total = factor.mul_add(*v, total);
        }
        for (factor, q) in self.of_position[c].as_ref().iter().zip(q) {
            total = factor.mul_add(*q, total);
        }
        total.total() + self.load[c]
    }
}
