//! Central difference with modal damping taken at the middle of the step. Second order.
//!
//! `(q[n+1] - 2 q[n] + q[n-1]) / dt^2 + c (q[n+1] - q[n-1]) / (2 dt) + omega^2 q[n] = f[n]`,
//! stable while `dt < 2 / omega`. Laws see the velocity of their local coordinates as the
//! second-order backward difference, so that a damper in a stop keeps the order. It lowers the
//! limit: with `c_law` from dampers of laws, the root of the scheme's characteristic polynomial
//! that leaves the unit circle first passes -1 where `omega^2 dt^2 + 4 c_law dt = 4`.
//! Source: T. J. R. Hughes, The Finite Element Method, 1987, section 9.1.

use super::fixed_step::{
    Any, ChangingLoads, Count, Follow, March, Modal, Scheme, Setting, Step, StepRecord,
    VelocityRule, among_many, check_forces, check_growth, check_step, check_uncoupled, coupling,
    highest_frequency, in_lanes, law_force, laws_damping, modal, pushed, run,
};
use super::{Observer, check_flows, check_not_stepped};
use crate::error::Result;
use crate::history::History;
use crate::law::{COORDINATES, Law, Local, Stop, project};
use crate::number::{Instructions, Lanes, Number};
use crate::problem::Problem;
use crate::system::ModalSystem;
use std::sync::Arc;

/// The method's name.
pub const NAME: &str = "central_difference";

/// Largest stable step, in s, with the laws in their stiffest states.
pub fn stability_limit<L: Law>(system: &ModalSystem, laws: &[L]) -> f64 {
    let omega = highest_frequency(system, laws);
    let damping = laws_damping(laws);
    2.0 / (damping + damping.hypot(omega))
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
    check_uncoupled(NAME, &problem.system)?;
    check_forces(NAME, &problem.laws)?;
    check_flows(NAME, &problem.laws)?;
    check_not_stepped(NAME, &problem.laws)?;
    let limit = stability_limit(&problem.system, &problem.laws);
    check_step(NAME, step, limit)?;
    let march = CentralDifference {
        record: &mut record,
        observer,
    };
    run(march, problem)?;
    check_growth(problem, &record, limit)?;
    let events = record.events();
    Ok(History::of_steps(problem, NAME, record, events))
}

/// The scheme solved for `q[n+1] = own q[n] + past q[n-1] + gain f[n]`.
struct Coefficients {
    own: Vec<f64>,
    past: Vec<f64>,
    gain: Vec<f64>,
}

impl Coefficients {
    fn new(system: &ModalSystem, dt: f64) -> Self {
        let each = |f: fn(f64, f64, f64) -> f64| {
            let modes = system.omega2().iter().zip(system.damping());
            modes.map(|(w2, c)| f(*w2, 0.5 * c * dt, dt)).collect()
        };
        Self {
            own: each(|w2, half, dt| (2.0 - w2 * dt * dt) / (1.0 + half)),
            past: each(|_, half, _| -(1.0 - half) / (1.0 + half)),
            gain: each(|_, half, dt| dt * dt / (1.0 + half)),
        }
    }
}

struct CentralDifference<'a, 'o> {
    record: &'a mut StepRecord,
    observer: Observer<'o>,
}

impl March for CentralDifference<'_, '_> {
    fn among_stops(self, setting: &Setting<'_, Stop>) -> Result<()> {
        in_lanes(self, setting)
    }

    /// The laws do not wait for the modes of their own step: local positions follow from the
    /// modes of the two steps before and the forces alone,
    /// `x[n+1] = (row own) . q[n] + (row past) . q[n-1] + (row gain) . (p + row f)`.
    #[inline(always)]
    fn march<P: Law, I: Instructions, B: Count, A: Count, const CHANGING: bool>(
        self,
        setting: &Setting<'_, P>,
    ) -> Result<()> {
        let Self { record, observer } = self;
        let dt = record.dt;
        let coefficients = Coefficients::new(setting.system, dt);
        let gain = &coefficients.gain;
        let own = modal::<I, B>(&coefficients.own);
        let past = modal::<I, B>(&coefficients.past);
        let mut load = modal::<I, B>(&weighted(setting.forcing.forces(), gain));
        let mut changing = ChangingLoads::new(setting.forcing, dt, gain);
        let laws = A::make(setting.laws.len(), |i| setting.laws[i]);
        let laws = laws.as_ref();
        let couplings = A::make(laws.len(), |i| {
            A::make(laws.len(), |j| coupling(laws[i], laws[j], gain))
        });
        let initial = displacement_before(setting, dt);
        let mut contacts = A::make(laws.len(), |i| {
            Contact::<I, B>::new(laws[i], setting, &initial, &coefficients, dt)
        });
        let contacts = contacts.as_mut();
        let mut forces = A::make(laws.len(), |_| [0.0; COORDINATES]);
        let forces = forces.as_mut();
        let mut before = modal::<I, B>(&initial);
        let mut q = modal::<I, B>(setting.displacement);
        let first = record.begin(setting, &initial);
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
                        contact.load = project(*law, now.as_flattened()).map(Lanes::first);
                    }
                }
                for (i, (law, contact)) in laws.iter().zip(contacts.iter()).enumerate() {
                    let Steps { now, rate, .. } = &contact.steps;
                    forces[i] = law_force(*law, &mut seen[i], now, rate);
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
                        let free = contact.free(c, q.as_ref(), before.as_ref());
                        let next = pushed(laws, couplings.as_ref(), c, forces, free);
                        contact.steps.follow(c, next);
                    }
                }
                let known = own.as_ref().iter().zip(past.as_ref()).zip(load.as_ref());
                let both = q.as_mut().iter_mut().zip(before.as_mut());
                for ((q, before), ((own, past), load)) in both.zip(known) {
                    let next = own.mul_add(*q, past.mul_add(*before, *load));
                    (*before, *q) = (*q, next);
                }
                for ((law, contact), force) in laws.iter().zip(contacts.iter()).zip(&*forces) {
                    let along = contact.pushes.iter().zip(force).take(law.rows().len());
                    for (pushes, force) in along {
                        let force = Lanes::<I>::of(*force);
                        for (q, push) in q.as_mut().iter_mut().zip(pushes.as_ref()) {
                            *q = push.mul_add(force, *q);
                        }
                    }
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

/// The modes at two steps, moved by their forces.
struct Modes<I: Instructions> {
    dt: f64,
    own: Vec<Lanes<I>>,
    past: Vec<Lanes<I>>,
    gain: Vec<Lanes<I>>,
    initial: Vec<f64>,
    before: Vec<Lanes<I>>,
    now: Vec<Lanes<I>>,
}

impl<I: Instructions> Modes<I> {
    fn new<P: Law>(setting: &Setting<'_, P>, dt: f64) -> Self {
        let Coefficients { own, past, gain } = Coefficients::new(setting.system, dt);
        let initial = displacement_before(setting, dt);
        Self {
            dt,
            own: modal::<I, Any>(&own),
            past: modal::<I, Any>(&past),
            gain: modal::<I, Any>(&gain),
            before: modal::<I, Any>(&initial),
            now: modal::<I, Any>(setting.displacement),
            initial,
        }
    }
}

impl<I: Instructions> Scheme<I> for Modes<I> {
    type Followed = Steps;

    fn followed<P: Law>(&self, law: &P, setting: &Setting<'_, P>) -> Steps {
        Steps::new(law, setting, &self.initial, self.dt)
    }
    fn before(&self) -> &[f64] {
        &self.initial
    }
    #[inline(always)]
    fn step(&mut self, block: usize, force: Lanes<I>) -> Lanes<I> {
        let now = self.now[block];
        let known = self.past[block].mul_add(self.before[block], self.gain[block] * force);
        let next = self.own[block].mul_add(now, known);
        (self.before[block], self.now[block]) = (now, next);
        next
    }
    fn displacement(&self) -> &[Lanes<I>] {
        &self.now
    }
}

/// Local positions of a law at three steps.
struct Steps {
    dt: f64,
    now: Local<f64>,
    rate: Local<f64>,
    previous: Local<f64>,
    older: Local<f64>,
}

impl Steps {
    fn new<L: Law>(law: &L, setting: &Setting<'_, L>, before: &[f64], dt: f64) -> Self {
        let (now, rate) = setting.local_start(law);
        let previous = project(law, before);
        Self {
            dt,
            now,
            rate,
            previous,
            // Such that the difference at the start gives the initial velocity.
            older: std::array::from_fn(|c| 2.0 * dt * rate[c] - 3.0 * now[c] + 4.0 * previous[c]),
        }
    }
}

impl Follow for Steps {
    fn position(&self) -> &Local<f64> {
        &self.now
    }
    fn velocity(&self) -> &Local<f64> {
        &self.rate
    }
    /// The rate is `(3 x[n] - 4 x[n-1] + x[n-2]) / (2 dt)`.
    #[inline(always)]
    fn follow(&mut self, c: usize, next: f64) {
        (self.older[c], self.previous[c]) = (self.previous[c], self.now[c]);
        self.now[c] = next;
        self.rate[c] = (3.0 * next - 4.0 * self.previous[c] + self.older[c]) * (0.5 / self.dt);
    }
}

fn weighted(row: &[f64], weight: &[f64]) -> Vec<f64> {
    row.iter().zip(weight).map(|(r, w)| r * w).collect()
}

/// A law's rows times the scheme's coefficients, and its local positions.
struct Contact<I: Instructions, B: Count> {
    own: Local<Modal<I, B>>,
    past: Local<Modal<I, B>>,
    /// What the loads add to the local positions in a step.
    load: Local<Lanes<I>>,
    /// What unit forces add to the modes in a step.
    pushes: Local<Modal<I, B>>,
    steps: Steps,
}

impl<I: Instructions, B: Count> Contact<I, B> {
    fn new<L: Law>(
        law: &L,
        setting: &Setting<'_, L>,
        before: &[f64],
        Coefficients { own, past, gain }: &Coefficients,
        dt: f64,
    ) -> Self {
        let zero = vec![0.0; gain.len()];
        let row = |c: usize| law.rows().get(c).unwrap_or(&zero);
        let times =
            |factor: &[f64]| std::array::from_fn(|c| modal::<I, B>(&weighted(row(c), factor)));
        Self {
            own: times(own),
            past: times(past),
            load: project(law, &weighted(setting.forcing.forces(), gain)).map(Lanes::first),
            pushes: times(gain),
            steps: Steps::new(law, setting, before, dt),
        }
    }

    /// The next position of a coordinate if no law pushed.
    #[inline(always)]
    fn free(&self, c: usize, q: &[Lanes<I>], before: &[Lanes<I>]) -> f64 {
        let mut total = self.load[c];
        for (past, before) in self.past[c].as_ref().iter().zip(before) {
            total = past.mul_add(*before, total);
        }
        for (own, q) in self.own[c].as_ref().iter().zip(q) {
            total = own.mul_add(*q, total);
        }
        total.total()
    }
}

/// `q[-1] = q0 - dt v0 + dt^2/2 a0`, which starts the scheme at its own order.
fn displacement_before<L: Law>(setting: &Setting<'_, L>, dt: f64) -> Vec<f64> {
    let (q, v) = (setting.displacement, setting.velocity);
    let [mut forces, _] = setting.forcing.around(0.0);
    for (number, law) in setting.laws.iter().enumerate() {
        let force = setting.first_force(number);
        for (row, f) in law.rows().iter().zip(force) {
            for (total, r) in forces.iter_mut().zip(row) {
                *total += r * f;
            }
        }
    }
    let (omega2, damping) = (setting.system.omega2(), setting.system.damping());
    (0..q.len())
        .map(|i| {
            let acceleration = forces[i] - damping[i] * v[i] - omega2[i] * q[i];
            q[i] - dt * v[i] + 0.5 * dt * dt * acceleration
        })
        .collect()
}
