//! Semi-implicit (symplectic) Euler: `v += dt a(q, v)`, then `q += dt v`. First order.
//!
//! The scheme of the published solution of SDNL32. Stable while
//! `dt < 2 (sqrt(1 + xi^2) - xi) / omega` for each mode, from the Jury conditions on its
//! amplification matrix. Source: E. Hairer, C. Lubich, G. Wanner, Geometric Numerical
//! Integration, 2nd edition, 2006, section I.1.2.

use super::fixed_step::{
    Any, ChangingLoads, Count, Follow, March, Modal, Scheme, Setting, Step, StepRecord,
    VelocityRule, among_many, check_forces, check_growth, check_step, coupling, highest_frequency,
    in_lanes, law_force, laws_damping, modal, pushed, run,
};
use super::{Observer, check_flows};
use crate::error::Result;
use crate::history::History;
use crate::law::{COORDINATES, Law, Local, Stop, project};
use crate::number::{Block, Instructions, Lanes, Number, blocks};
use crate::problem::Problem;
use crate::system::{Coupling, ModalSystem};
use std::sync::Arc;

/// The method's name.
pub const NAME: &str = "symplectic_euler";

/// Largest stable step, in s, with the laws in their stiffest states.
pub fn stability_limit<L: Law>(system: &ModalSystem, laws: &[L]) -> f64 {
    let omega = highest_frequency(system, laws);
    let modal = system.damping().iter().fold(0.0f64, |m, c| m.max(*c));
    let coupled = system.coupling().map_or(0.0, Coupling::size);
    let half = 0.5 * (modal + coupled + laws_damping(laws));
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
    check_forces(NAME, &problem.laws)?;
    check_flows(NAME, &problem.laws)?;
    let limit = stability_limit(&problem.system, &problem.laws);
    check_step(NAME, step, limit)?;
    let march = SymplecticEuler {
        record: &mut record,
        observer,
    };
    run(march, problem)?;
    check_growth(problem, &record, limit)?;
    let events = record.events();
    Ok(History::of_steps(problem, NAME, record, events))
}

struct SymplecticEuler<'a, 'o> {
    record: &'a mut StepRecord,
    observer: Observer<'o>,
}

impl March for SymplecticEuler<'_, '_> {
    fn among_stops(self, setting: &Setting<'_, Stop>) -> Result<()> {
        in_lanes(self, setting)
    }

    /// The laws do not wait for the modes of their own step: local velocities follow from the
    /// modes of the step before and the forces alone,
    /// `x' = (row - dt row c) . v - (dt row w2) . q + dt row . (p + row f)`.
    #[inline(always)]
    fn march<P: Law, I: Instructions, B: Count, A: Count, const CHANGING: bool>(
        self,
        setting: &Setting<'_, P>,
    ) -> Result<()> {
        let Self { record, observer } = self;
        let dt = record.dt;
        let step = Lanes::<I>::of(dt);
        let omega2 = modal::<I, B>(setting.system.omega2());
        let damping = modal::<I, B>(setting.system.damping());
        let mut load = modal::<I, B>(setting.forcing.forces());
        let gain = vec![dt; setting.system.modes()];
        let same = vec![1.0; setting.system.modes()];
        let mut changing = ChangingLoads::new(setting.forcing, dt, &same);
        let laws = A::make(setting.laws.len(), |i| setting.laws[i]);
        let laws = laws.as_ref();
        let couplings = A::make(laws.len(), |i| {
            A::make(laws.len(), |j| coupling(laws[i], laws[j], &gain))
        });
        let mut contacts = A::make(laws.len(), |i| Contact::<I, B>::new(laws[i], setting, dt));
        let contacts = contacts.as_mut();
        let mut forces = A::make(laws.len(), |_| [0.0; COORDINATES]);
        let forces = forces.as_mut();
        let mut q = modal::<I, B>(setting.displacement);
        let mut v = modal::<I, B>(setting.velocity);
        let first = record.begin(setting, &displacement_before(setting, dt));
        let mut seen = A::make(laws.len(), |i| first[i]);
        let seen = seen.as_mut();
        let (blocks, states) = (q.as_ref().len(), laws.len().max(1));
        while let Some(stretch) = record.next_stretch() {
            stretch.observe(observer)?;
            let rows = stretch.rows.chunks_exact_mut(blocks);
            let mut memories = stretch.states.memories.chunks_exact_mut(states);
            for (row, numbers) in rows.zip(stretch.states.numbers.chunks_exact_mut(states)) {
                if CHANGING {
                    let now = changing.next();
                    for (load, now) in load.as_mut().iter_mut().zip(now) {
                        *load = Lanes::of_block(now);
                    }
                    for (law, contact) in laws.iter().zip(contacts.iter_mut()) {
                        let loads = project(*law, now.as_flattened());
                        contact.load = loads.map(|p| Lanes::first(dt * p));
                    }
                }
                for (i, (law, contact)) in laws.iter().zip(contacts.iter()).enumerate() {
                    let Moved {
                        position, velocity, ..
                    } = &contact.moved;
                    forces[i] = law_force(*law, &mut seen[i], position, velocity);
                    numbers[i] = seen[i].number;
                }
                if P::REMEMBERS
                    && let Some(memories) = memories.next()
                {
                    for (memory, state) in memories.iter_mut().zip(&*seen) {
                        *memory = state.memory;
                    }
                }
                let coupled = contacts.iter_mut().zip(couplings.as_ref());
                for (law, (contact, couplings)) in laws.iter().zip(coupled) {
                    for c in 0..law.rows().len() {
                        let free = contact.free(c, q.as_ref(), v.as_ref());
                        let velocity = pushed(laws, couplings.as_ref(), c, forces, free);
                        contact.moved.follow(c, velocity);
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

    #[inline(always)]
    fn among_many<P: Law, I: Instructions>(self, setting: &Setting<'_, P>) -> Result<()> {
        let Self { record, observer } = self;
        among_many(
            Modes::<I>::new(setting, record.dt),
            setting,
            record,
            observer,
        )
    }
}

/// `q[-1] = q0 - dt v0`, from which the record tells the initial velocity.
fn displacement_before<P>(setting: &Setting<'_, P>, dt: f64) -> Vec<f64> {
    let both = setting.displacement.iter().zip(setting.velocity);
    both.map(|(q, v)| q - dt * v).collect()
}

/// The modes, moved by their forces.
struct Modes<I: Instructions> {
    dt: f64,
    omega2: Vec<Lanes<I>>,
    damping: Vec<Lanes<I>>,
    before: Vec<f64>,
    displacement: Vec<Lanes<I>>,
    velocity: Vec<Lanes<I>>,
    /// What couples velocities, and displacements.
    matrices: [Option<Coupling>; 2],
    /// Room for numbers of the modes.
    plain: Vec<Block>,
}

impl<I: Instructions> Modes<I> {
    fn new<P>(setting: &Setting<'_, P>, dt: f64) -> Self {
        Self {
            dt,
            omega2: modal::<I, Any>(setting.system.omega2()),
            damping: modal::<I, Any>(setting.system.damping()),
            before: displacement_before(setting, dt),
            displacement: modal::<I, Any>(setting.displacement),
            velocity: modal::<I, Any>(setting.velocity),
            matrices: [setting.system.coupling(), setting.system.circulatory()]
                .map(Option::<&Coupling>::cloned),
            plain: blocks(setting.displacement),
        }
    }
}

impl<I: Instructions> Scheme<I> for Modes<I> {
    type Followed = Moved;

    fn followed<P: Law>(&self, law: &P, setting: &Setting<'_, P>) -> Moved {
        Moved::new(law, setting, self.dt)
    }
    fn before(&self) -> &[f64] {
        &self.before
    }
    fn couple(&mut self, load: &mut [Block]) {
        let motions = [&self.velocity, &self.displacement];
        for (matrix, motion) in self.matrices.iter().zip(motions) {
            let Some(matrix) = matrix else { continue };
            for (to, motion) in self.plain.iter_mut().zip(motion) {
                motion.to_block(to);
            }
            let motion = &self.plain.as_flattened()[..matrix.modes()];
            for (mode, load) in load.as_flattened_mut()[..matrix.modes()]
                .iter_mut()
                .enumerate()
            {
                *load -= matrix.product(mode, motion);
            }
        }
    }
    #[inline(always)]
    fn step(&mut self, block: usize, force: Lanes<I>) -> Lanes<I> {
        let (q, v) = (self.displacement[block], self.velocity[block]);
        let (w2, c) = (self.omega2[block], self.damping[block]);
        let step = Lanes::of(self.dt);
        let next = force.sub_mul(w2, q).sub_mul(c, v).mul_add(step, v);
        self.velocity[block] = next;
        self.displacement[block] = next.mul_add(step, q);
        next
    }
    fn displacement(&self) -> &[Lanes<I>] {
        &self.displacement
    }
}

/// Local motion of a law.
struct Moved {
    dt: f64,
    position: Local<f64>,
    velocity: Local<f64>,
}

impl Moved {
    fn new<L: Law>(law: &L, setting: &Setting<'_, L>, dt: f64) -> Self {
        let (position, velocity) = setting.local_start(law);
        Self {
            dt,
            position,
            velocity,
        }
    }
}

impl Follow for Moved {
    fn position(&self) -> &Local<f64> {
        &self.position
    }
    fn velocity(&self) -> &Local<f64> {
        &self.velocity
    }
    #[inline(always)]
    fn follow(&mut self, c: usize, velocity: f64) {
        self.position[c] = velocity.mul_add(self.dt, self.position[c]);
        self.velocity[c] = velocity;
    }
}

/// A law's rows times the scheme's coefficients, and its local motion.
struct Contact<I: Instructions, B: Count> {
    rows: Local<Modal<I, B>>,
    of_position: Local<Modal<I, B>>,
    of_velocity: Local<Modal<I, B>>,
    /// What the loads add to the local velocities in a step.
    load: Local<Lanes<I>>,
    moved: Moved,
}

impl<I: Instructions, B: Count> Contact<I, B> {
    fn new<L: Law>(law: &L, setting: &Setting<'_, L>, dt: f64) -> Self {
        let (omega2, damping) = (setting.system.omega2(), setting.system.damping());
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
            load: project(law, setting.forcing.forces()).map(|p| Lanes::first(dt * p)),
            moved: Moved::new(law, setting, dt),
        }
    }

    /// The next velocity of a coordinate if no law pushed.
    #[inline(always)]
    fn free(&self, c: usize, q: &[Lanes<I>], v: &[Lanes<I>]) -> f64 {
        let mut total = self.load[c];
        for (factor, v) in self.of_velocity[c].as_ref().iter().zip(v) {
            total = factor.mul_add(*v, total);
        }
        for (factor, q) in self.of_position[c].as_ref().iter().zip(q) {
            total = factor.mul_add(*q, total);
        }
        total.total()
    }
}
