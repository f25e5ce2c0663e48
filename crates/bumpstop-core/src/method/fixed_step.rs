//! What the explicit fixed-step schemes share: their record, their check of the step, and the
//! laws' forces on padded rows.

use super::observe;
use crate::error::{Error, Result};
use crate::forcing::Forcing;
use crate::history::Event;
use crate::law::{COORDINATES, Law, Local, LocalMotion, State, project};
use crate::number::{Block, Instructions, LANES, Lanes, Vectorised, blocks};
use crate::problem::Problem;
use crate::system::ModalSystem;

/// A fixed step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// Its length, in s.
    pub dt: f64,
    /// Whether it may lie above the stability limit.
    pub beyond_stability_limit: bool,
}

/// The most memory that a record may take, in bytes.
const LARGEST_RECORD: f64 = 4.0 * 1024.0 * 1024.0 * 1024.0;

/// How often the observer is asked, in steps; a multiple of [`STRETCH`].
const STEPS_BETWEEN_OBSERVATIONS: usize = 1024;

/// Steps for which room is made at once: few enough to stay in the nearest cache.
const STRETCH: usize = 64;

/// From which neighbouring displacements a scheme takes its velocity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VelocityRule {
    /// `(q[n] - q[n-1]) / dt`
    Backward,
    /// `(q[n+1] - q[n-1]) / (2 dt)`
    Central,
}

/// Every step's displacements, with one more before the first and one after the last.
#[derive(Debug, Clone)]
pub struct StepRecord {
    /// The step, in s.
    pub dt: f64,
    /// Number of steps.
    pub steps: usize,
    modes: usize,
    stride: usize,
    rule: VelocityRule,
    displacement: Vec<Block>,
    /// States of the laws during each step, at least one a step.
    states: Vec<State>,
    laws: usize,
}

/// Room for the results of some consecutive steps. A march writes into it without a call or a
/// test, which would cost it its registers.
pub(crate) struct Stretch<'a> {
    /// Time of the first, in s, when the observer is to be asked.
    start: Option<f64>,
    /// Displacements after each step.
    pub rows: &'a mut [Block],
    /// States of the laws during each step.
    pub states: &'a mut [State],
}

impl Stretch<'_> {
    /// Asks the observer when it is time to.
    pub(crate) fn observe(&self, observer: &mut dyn FnMut(f64) -> bool) -> Result<()> {
        self.start.map_or(Ok(()), |time| observe(observer, time))
    }
}

impl StepRecord {
    /// Room for a run of `problem`.
    ///
    /// # Errors
    /// [`Error::NotPositive`], [`Error::NotFinite`] or [`Error::TooManySteps`].
    pub(crate) fn new<L: Law>(problem: &Problem<L>, dt: f64, rule: VelocityRule) -> Result<Self> {
        if !dt.is_finite() {
            return Err(Error::NotFinite { what: "dt" });
        }
        if dt <= 0.0 {
            return Err(Error::NotPositive {
                what: "dt",
                value: dt,
            });
        }
        let modes = problem.system.modes();
        let stride = modes.div_ceil(LANES);
        // A duration that is a whole number of steps up to rounding takes just that many.
        let count = (problem.duration / dt - 1e-9).ceil().max(1.0);
        let bytes = (count + 3.0) * (stride * size_of::<Block>()) as f64;
        if bytes > LARGEST_RECORD {
            return Err(Error::TooManySteps {
                steps: count as usize,
                modes,
                gibibytes: bytes / (1024.0 * 1024.0 * 1024.0),
            });
        }
        let steps = count as usize;
        let laws = problem.laws.len().max(1);
        Ok(Self {
            dt,
            steps,
            modes,
            stride,
            rule,
            displacement: Vec::with_capacity((steps + 3) * stride),
            laws,
            states: Vec::with_capacity((steps + 1) * laws),
        })
    }

    /// Keeps the displacements one step before the start, and at the start.
    pub(crate) fn begin(&mut self, before: &[f64], start: &[f64]) {
        self.displacement.extend(blocks(before));
        self.displacement.extend(blocks(start));
    }

    /// Room for the next steps, until there are no more.
    #[inline(always)]
    pub(crate) fn next_stretch(&mut self) -> Option<Stretch<'_>> {
        let first = self.states.len() / self.laws;
        let last = (first + STRETCH).min(self.steps + 1);
        let rows = self.displacement.len();
        self.displacement
            .resize((last + 2) * self.stride, [0.0; LANES]);
        self.states.resize(last * self.laws, State::FIRST);
        (first < last).then(|| Stretch {
            start: first
                .is_multiple_of(STEPS_BETWEEN_OBSERVATIONS)
                .then_some(first as f64 * self.dt),
            rows: &mut self.displacement[rows..],
            states: &mut self.states[first * self.laws..],
        })
    }

    /// The laws' states at step n.
    pub fn states(&self, n: usize) -> &[State] {
        &self.states[n * self.laws..][..self.laws]
    }

    /// The laws' states at the last step before a time, or at it.
    pub fn states_at(&self, time: f64) -> &[State] {
        self.states(((time / self.dt) as usize).min(self.steps))
    }

    fn row(&self, n: usize) -> &[f64] {
        let blocks = &self.displacement[n * self.stride..(n + 1) * self.stride];
        &blocks.as_flattened()[..self.modes]
    }

    /// Modal displacements at step n.
    pub fn displacement(&self, n: usize) -> &[f64] {
        self.row(n + 1)
    }

    /// Modal velocities at step n, by the scheme's own rule.
    pub fn velocity(&self, n: usize, velocity: &mut [f64]) {
        let (from, to, span) = match self.rule {
            VelocityRule::Backward => (n, n + 1, self.dt),
            VelocityRule::Central => (n, n + 2, 2.0 * self.dt),
        };
        for ((v, a), b) in velocity.iter_mut().zip(self.row(from)).zip(self.row(to)) {
            *v = (b - a) / span;
        }
    }

    /// Modal displacement and velocity at any time, linear between steps.
    pub fn sample(&self, time: f64, displacement: &mut [f64], velocity: &mut [f64]) {
        let position = time / self.dt;
        let n = (position as usize).min(self.steps - 1);
        let part = position - n as f64;
        let mut next = vec![0.0; self.modes];
        self.velocity(n, velocity);
        self.velocity(n + 1, &mut next);
        for (v, after) in velocity.iter_mut().zip(&next) {
            *v += part * (after - *v);
        }
        let rows = self.displacement(n).iter().zip(self.displacement(n + 1));
        for (q, (a, b)) in displacement.iter_mut().zip(rows) {
            *q = a + part * (b - a);
        }
    }

    /// The switches of the laws, in order of time.
    pub(crate) fn events<L: Law>(&self, problem: &Problem<L>) -> Vec<Event> {
        let mut events = Vec::new();
        for (index, law) in problem.laws.iter().enumerate() {
            let mut before = first_state(law, problem);
            for (n, after) in self
                .states
                .chunks_exact(self.laws)
                .map(|s| s[index])
                .enumerate()
            {
                if after.number != before.number {
                    events.push(Event {
                        time: n as f64 * self.dt,
                        law: index,
                        guard: "step",
                        before,
                        after,
                    });
                }
                before = after;
            }
        }
        events.sort_by(|a, b| a.time.total_cmp(&b.time));
        events
    }

    /// Refuses a record whose motion left the range of numbers.
    pub(crate) fn check(&self) -> Result<()> {
        if self.row(self.steps + 2).iter().all(|q| q.is_finite()) {
            return Ok(());
        }
        let bad = |n: &usize| !self.row(*n).iter().all(|q| q.is_finite());
        let first = (1..self.steps + 3).find(bad).unwrap_or(self.steps);
        Err(Error::Overflow {
            time: (first - 1) as f64 * self.dt,
        })
    }
}

/// The state of a law at t = 0.
pub(crate) fn first_state<L: Law>(law: &L, problem: &Problem<L>) -> State {
    let position = project(law, &problem.displacement);
    let velocity = project(law, &problem.velocity);
    let before = law.initial_state(&LocalMotion::of(position, velocity));
    law.sampled_state(before, &position, &velocity)
}

/// Refuses a system whose modes are coupled: the schemes carry each by itself.
pub(crate) fn check_uncoupled(method: &'static str, system: &ModalSystem) -> Result<()> {
    if system.is_coupled() {
        return Err(Error::CoupledModes { method });
    }
    Ok(())
}

/// Refuses laws at which velocities jump: the schemes go by forces.
pub(crate) fn check_forces<L: Law>(method: &'static str, laws: &[L]) -> Result<()> {
    if laws.iter().any(|law| law.restitution().is_some()) {
        return Err(Error::RigidStops { method });
    }
    Ok(())
}

/// Refuses a step above the limit, unless it was asked for by name.
pub(crate) fn check_step(method: &'static str, step: Step, limit: f64) -> Result<()> {
    if step.dt > limit && !step.beyond_stability_limit {
        return Err(Error::Unstable {
            method,
            dt: step.dt,
            limit,
        });
    }
    Ok(())
}

/// Highest angular frequency with every law in its stiffest state, in rad/s, from above:
/// the largest eigenvalue of a sum is at most the sum of the largest eigenvalues.
pub(crate) fn highest_frequency<L: Law>(system: &ModalSystem, laws: &[L]) -> f64 {
    let laws_stiffness: f64 = (laws.iter())
        .map(|law| on_modes(law, &law.stiffest().stiffness))
        .sum();
    (system.highest_frequency().powi(2) + laws_stiffness).sqrt()
}

/// Damping that laws in their stiffest states add to any motion, in rad/s, from above.
pub(crate) fn laws_damping<L: Law>(laws: &[L]) -> f64 {
    (laws.iter())
        .map(|law| on_modes(law, &law.stiffest().damping))
        .sum()
}

/// A bound of the largest eigenvalue of a law's diagonal local matrix on the modes.
fn on_modes<L: Law>(law: &L, matrix: &[Local<f64>; COORDINATES]) -> f64 {
    (law.rows().iter().zip(matrix).enumerate())
        .map(|(i, (row, entries))| entries[i] * row.iter().map(|r| r * r).sum::<f64>())
        .sum()
}

/// How many things of a kind a march has, so that the same text serves a number known when
/// compiling, whose things live in registers, and any other.
pub(crate) trait Count {
    /// That many things.
    type Of<T>: AsRef<[T]> + AsMut<[T]>;

    /// Makes each of `count` things from its number.
    fn make<T>(count: usize, each: impl FnMut(usize) -> T) -> Self::Of<T>;
}

/// Just `N`.
pub(crate) struct Fixed<const N: usize>;

impl<const N: usize> Count for Fixed<N> {
    type Of<T> = [T; N];
    #[inline(always)]
    fn make<T>(count: usize, each: impl FnMut(usize) -> T) -> [T; N] {
        assert_eq!(count, N);
        std::array::from_fn(each)
    }
}

/// Any number.
pub(crate) struct Any;

impl Count for Any {
    type Of<T> = Vec<T>;
    #[inline(always)]
    fn make<T>(count: usize, each: impl FnMut(usize) -> T) -> Vec<T> {
        (0..count).map(each).collect()
    }
}

/// One number a mode, in whole lanes; `B` counts the blocks.
pub(crate) type Modal<I, B> = <B as Count>::Of<Lanes<I>>;

/// Eight numbers a block; the last block is filled with zeros.
#[inline(always)]
pub(crate) fn modal<I: Instructions, B: Count>(numbers: &[f64]) -> Modal<I, B> {
    let blocks = blocks(numbers);
    B::make(blocks.len(), |b| Lanes::of_block(&blocks[b]))
}

/// Loads that change in time, step by step.
pub(crate) struct ChangingLoads<'a> {
    forcing: &'a Forcing,
    dt: f64,
    gain: &'a [f64],
    step: usize,
    forces: Vec<Block>,
}

impl<'a> ChangingLoads<'a> {
    /// The modal forces of a problem, each times its gain.
    pub(crate) fn new(forcing: &'a Forcing, dt: f64, gain: &'a [f64]) -> Self {
        Self {
            forcing,
            dt,
            gain,
            step: 0,
            forces: blocks(gain),
        }
    }

    /// Those of the next step, the first one at t = 0.
    pub(crate) fn next(&mut self) -> &[Block] {
        let forces = &mut self.forces.as_flattened_mut()[..self.gain.len()];
        self.forcing.at(self.step as f64 * self.dt, forces);
        for (force, gain) in forces.iter_mut().zip(self.gain) {
            *force *= gain;
        }
        self.step += 1;
        &self.forces
    }
}

/// A march through time, compiled anew for the usual sizes of problems.
pub(crate) trait March<L: Law> {
    /// The march for `B` blocks of modes and `A` laws, under loads that change in time or not.
    fn march<I: Instructions, B: Count, A: Count, const CHANGING: bool>(self) -> Result<()>;
}

/// Chooses the counts of a march.
pub(crate) struct Sized<'a, L, M> {
    pub problem: &'a Problem<L>,
    pub march: M,
}

impl<L: Law, M: March<L>> Vectorised for Sized<'_, L, M> {
    type Output = Result<()>;
    #[inline(always)]
    fn run<I: Instructions>(self) -> Result<()> {
        if self.problem.forcing.varies() {
            return self.march.march::<I, Any, Any, true>();
        }
        let blocks = self.problem.system.modes().div_ceil(LANES);
        match (blocks, self.problem.laws.len()) {
            (1, 1) => self.march.march::<I, Fixed<1>, Fixed<1>, false>(),
            (2, 1) => self.march.march::<I, Fixed<2>, Fixed<1>, false>(),
            _ => self.march.march::<I, Any, Any, false>(),
        }
    }
}

/// How forces along one law's coordinates move another's: `sum_i a_i gain_i b_i` for its rows a
/// and b, zero beyond them.
pub(crate) type Coupling = [Local<f64>; COORDINATES];

/// How the second law's forces move the first's coordinates.
pub(crate) fn coupling<L: Law>(moved: &L, pushing: &L, gain: &[f64]) -> Coupling {
    let mut coupling = [[0.0; COORDINATES]; COORDINATES];
    for (to, a) in coupling.iter_mut().zip(moved.rows()) {
        for (to, b) in to.iter_mut().zip(pushing.rows()) {
            *to = a.iter().zip(b).zip(gain).map(|((a, b), g)| a * g * b).sum();
        }
    }
    coupling
}

/// How all forces together move one coordinate.
#[inline(always)]
pub(crate) fn pushed<L: Law>(
    laws: &[&L],
    couplings: &[Coupling],
    coordinate: usize,
    forces: &[Local<f64>],
) -> f64 {
    let mut total = 0.0;
    for ((law, force), coupling) in laws.iter().zip(forces).zip(couplings) {
        for c in 0..law.rows().len() {
            total += coupling[coordinate][c] * force[c];
        }
    }
    total
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::history::{Derivative, History};
    use crate::law::Stop;
    use crate::method::{Method, simulate};
    use std::sync::Arc;

    /// A bouncing structure of `modes` modes, all but three of them at rest, before `laws` stops,
    /// all but one of them out of reach.
    fn run(method: fn(Step) -> Method, modes: usize, laws: usize) -> History<Stop> {
        let moving = |i: usize, value: f64| if i < 3 { value } else { 0.0 };
        let each = |f: &dyn Fn(usize) -> f64| (0..modes).map(f).collect::<Vec<f64>>();
        let omega2 = each(&|i| 1e3 * (i * i) as f64);
        let system = ModalSystem::new(omega2, each(&|i| 0.2 * i as f64)).unwrap();
        let row = each(&|i| moving(i, 1.0 - 0.3 * i as f64));
        let stops = (0..laws)
            .map(|n| {
                let gap = if n == 0 { 1e-3 } else { 1e3 };
                Stop::new(row.clone(), gap, 2e4, 3.0).unwrap()
            })
            .collect();
        let forcing = Forcing::constant(each(&|i| moving(i, -2.0))).unwrap();
        let (rest, velocity) = (vec![0.0; modes], each(&|i| moving(i, -0.5)));
        let problem = Problem::new(system, stops, forcing, rest, velocity, 0.2).unwrap();
        let step = Step {
            dt: 1e-4,
            beyond_stability_limit: false,
        };
        simulate(&Arc::new(problem), method(step), &mut |_| true).unwrap()
    }

    #[test]
    fn counts_known_when_compiling_give_the_bits_of_any_other() {
        let times: Vec<f64> = (0..=40).map(|n| f64::from(n) * 5e-3).collect();
        let tip = |history: &History<Stop>| -> Vec<f64> {
            let modes = history.problem().system.modes();
            let motion = history.motion(&times, Derivative::Displacement).unwrap();
            let moving = motion.chunks(modes).flat_map(|row| &row[..3]);
            moving.copied().collect()
        };
        for method in [Method::CentralDifference, Method::SymplecticEuler] {
            let known = run(method, 8, 1);
            assert!(known.events().len() > 2);
            for (modes, laws) in [(16, 1), (24, 1), (8, 2)] {
                let other = run(method, modes, laws);
                assert_eq!(tip(&known), tip(&other));
                assert_eq!(known.events(), other.events());
            }
        }
    }
}
