//! What a run leaves behind: the motion at any instant, events, impacts and energies.

use crate::dynamics::Moment;
use crate::energy::{self, Ledger};
use crate::error::{Error, Result, check_length};
use crate::impacts::{Impact, Sample};
use crate::law::{Law, Local, State};
use crate::method::fixed_step::{StepRecord, sampled_states, step_ledgers};
use crate::method::piecewise_linear::PhaseRecord;
use crate::method::polynomial_steps::PolynomialRecord;
use crate::problem::Problem;
use std::sync::{Arc, OnceLock};

/// A switch of one law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// Instant, in s.
    pub time: f64,
    /// The law, by its number in the problem.
    pub law: usize,
    /// The guard that reached zero.
    pub guard: &'static str,
    /// State before.
    pub before: State,
    /// State after.
    pub after: State,
}

/// Time derivative of the modal coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Derivative {
    /// Displacement.
    Displacement,
    /// Velocity.
    Velocity,
    /// Acceleration.
    Acceleration,
}

// One a run, never moved about in numbers.
#[allow(clippy::large_enum_variant)]
#[derive(Debug, Clone)]
enum Record {
    Steps(StepRecord),
    Phases(PhaseRecord),
    Polynomials(PolynomialRecord),
}

/// The result of a run. It can be sampled anywhere in `[0, duration]`; at a switch the values
/// after it are given.
#[derive(Debug, Clone)]
pub struct History<L> {
    problem: Arc<Problem<L>>,
    method: &'static str,
    events: Vec<Event>,
    record: Record,
    step_ledgers: OnceLock<Vec<Ledger>>,
}

impl<L: Law> History<L> {
    pub(crate) fn of_steps(
        problem: &Arc<Problem<L>>,
        method: &'static str,
        record: StepRecord,
        events: Vec<Event>,
    ) -> Self {
        Self::new(problem, method, Record::Steps(record), events)
    }

    pub(crate) fn of_phases(
        problem: &Arc<Problem<L>>,
        method: &'static str,
        record: PhaseRecord,
        events: Vec<Event>,
    ) -> Self {
        Self::new(problem, method, Record::Phases(record), events)
    }

    pub(crate) fn of_polynomials(
        problem: &Arc<Problem<L>>,
        method: &'static str,
        record: PolynomialRecord,
        events: Vec<Event>,
    ) -> Self {
        Self::new(problem, method, Record::Polynomials(record), events)
    }

    fn new(
        problem: &Arc<Problem<L>>,
        method: &'static str,
        record: Record,
        events: Vec<Event>,
    ) -> Self {
        Self {
            problem: Arc::clone(problem),
            method,
            events,
            record,
            step_ledgers: OnceLock::new(),
        }
    }

    /// The problem that was solved.
    pub fn problem(&self) -> &Problem<L> {
        &self.problem
    }

    /// Name of the method.
    pub fn method(&self) -> &'static str {
        self.method
    }

    /// Switches, in order of time.
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// Time steps, or certified cells of the exact method.
    pub fn steps(&self) -> usize {
        match &self.record {
            Record::Steps(record) => record.steps,
            Record::Phases(record) => record.cells(),
            Record::Polynomials(record) => record.steps(),
        }
    }

    /// The deepest penetration that the exact method could have missed, in m: its bound on its
    /// own rounding. `None` for methods with steps, whose error is larger than that.
    pub fn missed_penetration(&self) -> Option<f64> {
        match &self.record {
            Record::Steps(_) | Record::Polynomials(_) => None,
            Record::Phases(record) => Some(record.missed_penetration()),
        }
    }

    /// A bound, in the laws' local coordinates, of how far the exact method's motion is from the
    /// solution of its equations that starts where the last switch left it; without laws, in
    /// modal coordinates. `None` for methods with steps.
    pub fn motion_error(&self) -> Option<f64> {
        match &self.record {
            Record::Steps(_) | Record::Polynomials(_) => None,
            Record::Phases(record) => Some(record.motion_error(&self.problem)),
        }
    }

    /// Shows modal displacement, velocity and law states at each time.
    fn visit(&self, times: &[f64], mut see: impl FnMut(f64, &[f64], &[f64], &[State])) {
        let modes = self.problem.system.modes();
        match &self.record {
            Record::Phases(record) => record.visit(times, modes, &mut see),
            Record::Polynomials(record) => record.visit(times, see),
            Record::Steps(record) => {
                let (mut q, mut v) = (vec![0.0; modes], vec![0.0; modes]);
                for &time in times {
                    record.sample(time, &mut q, &mut v);
                    let known = record.states_at(&self.problem.laws, time).into_iter();
                    see(
                        time,
                        &q,
                        &v,
                        &sampled_states(&self.problem, known, time, &q, &v),
                    );
                }
            }
        }
    }

    /// Samples the modal coordinates, rows of `modes` values, one row a time.
    ///
    /// # Errors
    /// When a time lies outside `[0, duration]`.
    pub fn motion(&self, times: &[f64], derivative: Derivative) -> Result<Vec<f64>> {
        self.check_times(times)?;
        let modes = self.problem.system.modes();
        if let (Record::Phases(record), Derivative::Displacement | Derivative::Velocity) =
            (&self.record, derivative)
        {
            return Ok(record.motion(derivative as usize, times, modes));
        }
        let mut rows = Vec::with_capacity(times.len() * modes);
        if let (Record::Polynomials(record), Derivative::Acceleration) = (&self.record, derivative)
            && record.layout.is_told()
        {
            record.slopes(times, |accelerations| rows.extend_from_slice(accelerations));
            return Ok(rows);
        }
        self.visit(times, |time, q, v, states| match derivative {
            Derivative::Displacement => rows.extend_from_slice(q),
            Derivative::Velocity => rows.extend_from_slice(v),
            Derivative::Acceleration => {
                let moment = Moment {
                    time,
                    displacement: q,
                    velocity: v,
                    states,
                };
                rows.extend(moment.acceleration(&self.problem));
            }
        });
        Ok(rows)
    }

    /// Samples one linear combination of the modal coordinates.
    ///
    /// # Errors
    /// When a time lies outside `[0, duration]` or the row has the wrong length.
    pub fn project(&self, row: &[f64], times: &[f64], derivative: Derivative) -> Result<Vec<f64>> {
        check_length("the row", row, self.problem.system.modes())?;
        if let Record::Phases(record) = &self.record {
            self.check_times(times)?;
            return Ok(record.project(row, times, derivative as usize));
        }
        let modal = self.motion(times, derivative)?;
        let product = |q: &[f64]| q.iter().zip(row).map(|(q, r)| q * r).sum();
        Ok(modal.chunks(row.len()).map(product).collect())
    }

    /// Distance, its rate and the first component of force of one law at each time; the force of
    /// a stop that is rested on is its reaction.
    ///
    /// # Errors
    /// When a time lies outside `[0, duration]`.
    pub fn law_motion(&self, law: usize, times: &[f64]) -> Result<[Vec<f64>; 3]> {
        self.check_times(times)?;
        let which = &self.problem.laws[law];
        let mut columns = [const { Vec::new() }; 3];
        self.visit_law(law, times, |[position, rate], state, force| {
            let (distance, speed) = which.distance(&position, &rate);
            columns[0].push(distance);
            columns[1].push(speed);
            columns[2].push(which.on_contact(state, &position, &force)[0]);
        });
        Ok(columns)
    }

    /// Force of a law on the structure along each of its coordinates, one triple a time, in N; that
    /// of a stop that is rested on is its reaction.
    ///
    /// # Errors
    /// When a time lies outside `[0, duration]`.
    pub fn law_forces(&self, law: usize, times: &[f64]) -> Result<Vec<Local<f64>>> {
        self.check_times(times)?;
        let mut forces = Vec::with_capacity(times.len());
        self.visit_law(law, times, |_, _, force| forces.push(force));
        Ok(forces)
    }

    /// The same along the normal of the contact and across it.
    ///
    /// # Errors
    /// When a time lies outside `[0, duration]`.
    pub fn contact_forces(&self, law: usize, times: &[f64]) -> Result<Vec<Local<f64>>> {
        self.check_times(times)?;
        let mut forces = Vec::with_capacity(times.len());
        let which = &self.problem.laws[law];
        self.visit_law(law, times, |[position, _], state, force| {
            forces.push(which.on_contact(state, &position, &force));
        });
        Ok(forces)
    }

    /// State of a law at each time.
    ///
    /// # Errors
    /// When a time lies outside `[0, duration]`.
    pub fn law_states(&self, law: usize, times: &[f64]) -> Result<Vec<State>> {
        self.check_times(times)?;
        let mut found = Vec::with_capacity(times.len());
        self.visit(times, |_, _, _, states| found.push(states[law]));
        Ok(found)
    }

    /// The states of all laws at a time, with what they remember then.
    ///
    /// # Errors
    /// When the time lies outside `[0, duration]`.
    pub fn states(&self, time: f64) -> Result<Vec<State>> {
        self.check_times(&[time])?;
        let mut found = Vec::with_capacity(self.problem.laws.len());
        for law in 0..self.problem.laws.len() {
            self.visit_law(law, &[time], |_, state, _| found.push(state));
        }
        Ok(found)
    }

    /// Internal variables of a law at each time; see [`Law::internal_variables`].
    ///
    /// # Errors
    /// When a time lies outside `[0, duration]`.
    pub fn internal_variables(&self, law: usize, times: &[f64]) -> Result<Vec<[f64; 2]>> {
        self.check_times(times)?;
        let which = &self.problem.laws[law];
        let mut found = Vec::with_capacity(times.len());
        self.visit_law(law, times, |[position, rate], state, _| {
            found.push(which.internal_variables(state, &position, &rate));
        });
        Ok(found)
    }

    /// Shows local position and velocity of a law, its state and its force at each time.
    fn visit_law(
        &self,
        law: usize,
        times: &[f64],
        mut see: impl FnMut([Local<f64>; 2], State, Local<f64>),
    ) {
        let which = &self.problem.laws[law];
        match &self.record {
            // A reaction follows from the motion of all modes, a force from what the law sees.
            Record::Phases(record) if which.restitution().is_none() => {
                record.visit_law(law, which.rows(), times, |time, local, state| {
                    let local = self.problem.seen_from_obstacle(law, time, local);
                    see(local, state, which.force(state, &local[0], &local[1]));
                });
            }
            _ => self.visit(times, |time, q, v, states| {
                let local = self.problem.local(law, time, q, v);
                see(local, states[law], self.force_at(law, time, q, v, states));
            }),
        }
    }

    fn force_at(
        &self,
        law: usize,
        time: f64,
        q: &[f64],
        v: &[f64],
        states: &[State],
    ) -> Local<f64> {
        let moment = Moment {
            time,
            displacement: q,
            velocity: v,
            states,
        };
        let [position, rate] = self.problem.local(law, time, q, v);
        let mut force = self.problem.laws[law].force(states[law], &position, &rate);
        if let Some(reaction) = moment.reaction(&self.problem, law) {
            force[0] = reaction;
        }
        force
    }

    /// The energy ledger at each time.
    ///
    /// # Errors
    /// When a time lies outside `[0, duration]`.
    pub fn energy(&self, times: &[f64]) -> Result<Vec<Ledger>> {
        self.check_times(times)?;
        Ok(match &self.record {
            Record::Steps(record) => {
                let ledgers = self.step_ledgers(record);
                (times.iter().map(|t| interpolate(ledgers, t / record.dt))).collect()
            }
            Record::Phases(record) => record.ledgers(&self.problem, times),
            Record::Polynomials(record) => record.ledgers(&self.problem, times),
        })
    }

    /// Largest imbalance of the ledger at steps or switches, relative to the largest energy.
    pub fn energy_residual(&self) -> f64 {
        match &self.record {
            Record::Steps(record) => energy::residual(self.step_ledgers(record).iter()),
            Record::Phases(record) => record.energy_residual(&self.problem),
            Record::Polynomials(record) => record.energy_residual(&self.problem),
        }
    }

    /// Impacts of one law, in order of closing.
    pub fn impacts(&self, law: usize) -> Vec<Impact> {
        match &self.record {
            Record::Steps(record) => {
                let times: Vec<f64> = (0..=record.steps)
                    .map(|n| (n as f64 * record.dt).min(self.problem.duration))
                    .collect();
                crate::impacts::from_samples(&self.law_samples(law, &times))
            }
            Record::Phases(record) => record.impacts(&self.problem, law),
            Record::Polynomials(record) => record.impacts(&self.problem, law),
        }
    }

    /// The same with instants and speeds alone: peaks, impulses and energies may be left out, which
    /// takes a fraction of the time.
    pub fn contacts(&self, law: usize) -> Vec<Impact> {
        match &self.record {
            Record::Phases(record) => record.contacts(&self.problem, law),
            _ => self.impacts(law),
        }
    }

    fn law_samples(&self, law: usize, times: &[f64]) -> Vec<Sample> {
        let which = &self.problem.laws[law];
        let mut samples = Vec::with_capacity(times.len());
        self.visit(times, |time, q, v, states| {
            let [position, rate] = self.problem.local(law, time, q, v);
            let (distance, speed) = which.distance(&position, &rate);
            let force = which.force(states[law], &position, &rate);
            samples.push(Sample {
                time,
                distance,
                speed,
                force: which.on_contact(states[law], &position, &force)[0],
                in_contact: which.in_contact(states[law]),
            });
        });
        samples
    }

    fn step_ledgers(&self, record: &StepRecord) -> &[Ledger] {
        self.step_ledgers
            .get_or_init(|| step_ledgers(&self.problem, record))
    }

    fn check_times(&self, times: &[f64]) -> Result<()> {
        let inside = |t: &f64| *t >= 0.0 && *t <= self.problem.duration;
        match times.iter().find(|t| !inside(t)) {
            None => Ok(()),
            Some(&time) => Err(Error::OutsideRun {
                time,
                duration: self.problem.duration,
            }),
        }
    }
}

/// Linear between two ledgers.
fn interpolate(ledgers: &[Ledger], position: f64) -> Ledger {
    let n = (position as usize).min(ledgers.len() - 2);
    let part = position - n as f64;
    let (a, b) = (&ledgers[n], &ledgers[n + 1]);
    let mix = |x: f64, y: f64| x + part * (y - x);
    let each = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| mix(*x, *y)).collect();
    Ledger {
        kinetic: mix(a.kinetic, b.kinetic),
        elastic: mix(a.elastic, b.elastic),
        law_stored: each(&a.law_stored, &b.law_stored),
        modal_dissipation: mix(a.modal_dissipation, b.modal_dissipation),
        law_dissipated: each(&a.law_dissipated, &b.law_dissipated),
        load_work: mix(a.load_work, b.load_work),
        circulatory_work: mix(a.circulatory_work, b.circulatory_work),
        obstacle_work: mix(a.obstacle_work, b.obstacle_work),
    }
}
