//! Moreau and Jean's time stepping, for rigid stops: velocities and impulses instead of
//! accelerations and forces, so that a step may hold any number of impacts.
//!
//! `q1 = q + h ((1 - theta) v + theta v1)` and `M (v1 - v) = h r + P`, r the forces of structure,
//! loads and other laws, weighed in the same way. A stop takes part in a step that starts within
//! half a step of it, `d + h d' / 2 <= 0`. Its impulse P and the rate of its distance then obey
//! Newton's law of impact, `0 <= P`, `0 <= u1 + e u`, one of them zero, which is solved for together with
//! the forces of the other laws; so is friction along the obstacle, by Coulomb's law between the
//! impulses and the rates at the end ([`super::impulses`]). A structure at rest is pressed by its
//! weight in each step.
//!
//! First order where there are impacts, second between them with theta = 1/2, which keeps the
//! energy of a linear structure; more of theta takes from it. Any step is stable.
//!
//! Sources: J. J. Moreau, Numerical aspects of the sweeping process, Computer Methods in Applied
//! Mechanics and Engineering 177, 329-349, 1999; M. Jean, The non-smooth contact dynamics method, the
//! same, 235-257.

use super::impulses::Touch;
use super::laws::{Laws, Pushes};
use super::structure::{Modes, Structure, each_scaled};
use super::trace::{End, Trace};
use super::{Motion, STEPS_BETWEEN_OBSERVATIONS, Scheme, finite};
use crate::error::{Error, Result};
use crate::law::{Law, RigidStop};
use crate::method::polynomial_steps::Percussion;
use crate::method::{Observer, observe};
use crate::problem::Problem;

/// The method's name.
pub const NAME: &str = "moreau_jean";

/// Its parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MoreauJean {
    /// Weight of the end of a step.
    pub theta: f64,
}

impl Default for MoreauJean {
    fn default() -> Self {
        Self { theta: 0.5 }
    }
}

impl MoreauJean {
    /// Refuses a parameter out of range.
    ///
    /// # Errors
    /// [`Error::Parameter`]
    pub fn check(self) -> Result<()> {
        Error::check_parameter("theta", self.theta, [0.5, 1.0])
    }
}

/// The scheme for one problem and step.
struct Stepping<'a, L> {
    problem: &'a Problem<L>,
    modes: Modes<'a, L>,
    theta: f64,
    h: f64,
    /// Velocities that unit forces of the laws give.
    kicks: Vec<Vec<f64>>,
    pushes: Pushes,
    start: [Vec<f64>; 2],
    free: [Vec<f64>; 2],
    forces: Vec<f64>,
    percussions: Vec<Percussion>,
    /// How far each stop may seem off, by rounding, that was struck in the steps before.
    struck: Vec<Option<f64>>,
}

/// A stop that was struck is still in touch down to this many times the rounding of what its
/// impulse made of the distance.
const ROUNDINGS: f64 = 64.0;

/// Runs a problem from t = 0 to the end.
pub(super) fn run<'a, L: Law>(
    problem: &'a Problem<L>,
    scheme: MoreauJean,
    mut trace: Trace<'a, L>,
    observer: Observer<'_>,
) -> Result<Trace<'a, L>> {
    let mut stepping = Stepping::new(problem, scheme.theta, trace.h())?;
    let mut laws = Laws::new(problem);
    let mut motion = trace.begin(&laws);
    for n in 0..trace.steps() {
        let span = [n, n + 1].map(|n| n as f64 * trace.h());
        if n.is_multiple_of(STEPS_BETWEEN_OBSERVATIONS) {
            observe(observer, span[0])?;
        }
        stepping.step(span, &mut motion, &mut laws)?;
        finite(&motion, span[1])?;
        for percussion in &stepping.percussions {
            trace.strike(*percussion);
        }
        let across = Across {
            motion: &motion,
            start: &stepping.start,
            h: trace.h(),
        };
        trace.add(span, &across, &laws)?;
    }
    Ok(trace)
}

impl<'a, L: Law> Stepping<'a, L> {
    fn new(problem: &'a Problem<L>, theta: f64, h: f64) -> Result<Self> {
        let part = theta * h;
        let mut modes = Modes::new(problem, [1.0, part, part * part])?;
        let kicks = modes.kicks(part)?;
        let zeros = || vec![0.0; problem.system.modes()];
        Ok(Self {
            problem,
            modes,
            theta,
            h,
            pushes: Pushes::new(&problem.laws, &each_scaled(&kicks, part), &kicks),
            kicks,
            start: [zeros(), zeros()],
            free: [zeros(), zeros()],
            forces: zeros(),
            percussions: Vec::with_capacity(problem.laws.len()),
            struck: vec![None; problem.laws.len()],
        })
    }

    /// Lets the stops take part that the step starts close to.
    fn approach(&self, time: f64, motion: &Motion, laws: &mut Laws<'_, L>) {
        for (index, law) in self.problem.laws.iter().enumerate() {
            let Some(restitution) = law.restitution() else {
                continue;
            };
            let [position, velocity] = self.problem.local(index, time, &motion.q, &motion.v);
            let (distance, rate) = law.distance(&position, &velocity);
            let near = distance + 0.5 * self.h * rate <= self.struck[index].unwrap_or(0.0);
            let touch = Touch {
                before: [rate, velocity[1]],
                restitution,
                friction: law.rigid_friction(),
            };
            laws.touch(index, near.then_some(touch));
        }
    }

    /// Takes note of the impulses, which are no forces to begin the next step with.
    fn depart(&mut self, time: f64, motion: &Motion, laws: &mut Laws<'_, L>) {
        self.percussions.clear();
        for (index, law) in self.problem.laws.iter().enumerate() {
            if law.restitution().is_none() {
                continue;
            }
            let rested = self.struck[index].take();
            laws.states[index] = RigidStop::OPEN;
            let Some(struck) = laws.release(index, &self.pushes) else {
                continue;
            };
            let [position, velocity] = self.problem.local(index, time, &motion.q, &motion.v);
            let (part, before) = (self.theta * self.h, struck.touch.before);
            self.percussions.push(Percussion {
                law: index,
                time,
                h: self.h,
                impulse: part * struck.push,
                before: before[0],
                after: law.distance(&position, &velocity).1,
                rubbed: -0.5 * part * struck.rub * (before[1] + velocity[1]),
            });
            if rested.is_some() {
                laws.states[index] = RigidStop::resting(self.theta * struck.rub);
            }
            let rounding = ROUNDINGS * f64::EPSILON * self.h * struck.speed;
            self.struck[index] = Some(rested.unwrap_or(0.0) + rounding);
        }
    }
}

impl<L: Law> Scheme<L> for Stepping<'_, L> {
    fn step(
        &mut self,
        [start, end]: [f64; 2],
        motion: &mut Motion,
        laws: &mut Laws<'_, L>,
    ) -> Result<()> {
        let (h, theta) = (self.h, self.theta);
        self.approach(start, motion, laws);
        self.start[0].copy_from_slice(&motion.q);
        self.start[1].copy_from_slice(&motion.v);
        let middle = (1.0 - theta) * start + theta * end;
        self.modes.load(middle, &mut self.forces);
        self.modes.add_laws(laws, 1.0 - theta, &mut self.forces);
        let Motion { q, v, a } = motion;
        let [free_q, free_v] = &mut self.free;
        for i in 0..q.len() {
            free_q[i] = q[i] + theta * h * v[i];
        }
        self.modes.resist(free_q, v, &mut self.forces);
        self.modes.solve(&self.forces, a)?;
        for i in 0..q.len() {
            free_v[i] = v[i] + h * a[i];
            free_q[i] = q[i] + h * (v[i] + theta * h * a[i]);
        }
        laws.meet(&self.pushes, end, free_q, free_v)?;
        laws.push(&self.kicks, 1.0, free_v);
        for i in 0..q.len() {
            a[i] = (free_v[i] - v[i]) / h;
            q[i] += h * (v[i] + theta * h * a[i]);
        }
        v.copy_from_slice(free_v);
        self.depart(end, motion, laws);
        Ok(())
    }
}

/// A step whose velocities change evenly from one end to the other, whatever struck it.
struct Across<'a> {
    motion: &'a Motion,
    start: &'a [Vec<f64>; 2],
    h: f64,
}

impl End for Across<'_> {
    fn numbers(&self, to: &mut [f64]) {
        self.motion.numbers(to);
    }

    fn rates(&self, ends: [&mut Vec<f64>; 2]) {
        let Motion { q, a, .. } = self.motion;
        for rates in ends {
            rates.clear();
            let way = q.iter().zip(&self.start[0]);
            rates.extend(way.map(|(to, from)| (to - from) / self.h));
            rates.extend_from_slice(a);
        }
    }
}
