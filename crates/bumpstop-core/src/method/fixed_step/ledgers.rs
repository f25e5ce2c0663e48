//! The energy ledger along a record of steps, and whether it says that the run went wrong.

use super::StepRecord;
use crate::energy::{self, Growth, Ledger};
use crate::error::{Error, Place, Result};
use crate::law::{Law, Local, State, power};
use crate::problem::Problem;
use crate::system::Coupling;

/// Steps between two looks at the energy of the structure.
const STRIDE: usize = 16;

/// Refuses a record whose motion blew up, with the largest step that the scheme is stable with.
///
/// # Errors
/// [`Error::BlowUp`], or [`Error::Overflow`] where it left the range of numbers at once.
pub(crate) fn check_growth<L: Law>(
    problem: &Problem<L>,
    record: &StepRecord,
    limit: f64,
) -> Result<()> {
    if is_calm(problem, record) {
        return Ok(());
    }
    let mut growth = None;
    let swing = energy::swing(record.dt / limit);
    let modes = problem.system.modes();
    for (n, ledger) in step_ledgers(problem, record).iter().enumerate() {
        let growth = growth.get_or_insert_with(|| Growth::of_steps(ledger, swing, 0.0));
        if let Some(ratio) = growth.sees(ledger) {
            let mut v = vec![0.0; modes];
            record.velocity(n, &mut v);
            let omega2 = problem.system.omega2();
            let mode = energy::largest_share(omega2, record.displacement(n), &v);
            return Err(Error::BlowUp {
                time: n as f64 * record.dt,
                ratio,
                place: Some(Place::Mode(mode)),
            });
        }
    }
    record.check()
}

/// Whether the energy of the structure alone stays so small that nothing can have blown up: that
/// is quickly told, and true of nearly all runs.
fn is_calm<L: Law>(problem: &Problem<L>, record: &StepRecord) -> bool {
    let mut v = vec![0.0; problem.system.modes()];
    let mut most = 0.0f64;
    let mut start = None;
    for n in (0..=record.steps).step_by(STRIDE).chain([record.steps]) {
        let q = record.displacement(n);
        record.velocity(n, &mut v);
        let (kinetic, elastic) = energy::of_structure(problem.system.omega2(), q, &v);
        let held = kinetic + elastic.abs();
        most = if held > most || held.is_nan() {
            held
        } else {
            most
        };
        start.get_or_insert(held);
    }
    start.is_some_and(|start| most <= energy::BLOWN_UP * start)
}

/// The ledger at every step; powers are integrated by the trapezoidal rule.
pub(crate) fn step_ledgers<L: Law>(problem: &Problem<L>, record: &StepRecord) -> Vec<Ledger> {
    let modes = problem.system.modes();
    let mut v = vec![0.0; modes];
    let mut ledgers: Vec<Ledger> = Vec::with_capacity(record.steps + 1);
    let mut before: Option<Powers> = None;
    let mut changing_work = 0.0;
    for n in 0..=record.steps {
        let q = record.displacement(n);
        record.velocity(n, &mut v);
        let (kinetic, elastic) = energy::of_structure(problem.system.omega2(), q, &v);
        let known = record.states(n);
        let powers = Powers::new(problem, n as f64 * record.dt, known, q, &v);
        let mut ledger = Ledger {
            kinetic,
            elastic,
            law_stored: powers.stored.clone(),
            law_dissipated: vec![0.0; problem.laws.len()],
            load_work: problem.forcing.work(record.displacement(0), q),
            modal_dissipation: 0.0,
            circulatory_work: 0.0,
            obstacle_work: 0.0,
        };
        if let (Some(previous), Some(last)) = (&before, ledgers.last()) {
            let half = 0.5 * record.dt;
            changing_work += half * (previous.load + powers.load);
            ledger.load_work += changing_work;
            ledger.circulatory_work =
                last.circulatory_work + half * (previous.circulatory + powers.circulatory);
            ledger.obstacle_work =
                last.obstacle_work + half * (previous.obstacles + powers.obstacles);
            ledger.modal_dissipation =
                last.modal_dissipation + half * (previous.modal + powers.modal);
            for (i, total) in ledger.law_dissipated.iter_mut().enumerate() {
                let lost = problem.laws[i].switch_loss(
                    previous.states[i],
                    powers.states[i],
                    &powers.positions[i],
                );
                let power = previous.laws[i] + powers.laws[i];
                *total = last.law_dissipated[i] + half * power + lost;
            }
        }
        before = Some(powers);
        ledgers.push(ledger);
    }
    ledgers
}

/// Powers and stored energies at one sampled instant.
struct Powers {
    modal: f64,
    /// Of the loads that change in time.
    load: f64,
    /// Of circulatory forces.
    circulatory: f64,
    /// Of the obstacles that move.
    obstacles: f64,
    laws: Vec<f64>,
    stored: Vec<f64>,
    states: Vec<State>,
    /// Of the laws, from their obstacles.
    positions: Vec<Local<f64>>,
}

impl Powers {
    fn new<L: Law>(
        problem: &Problem<L>,
        time: f64,
        known: impl Iterator<Item = State>,
        q: &[f64],
        v: &[f64],
    ) -> Self {
        let states = sampled_states(problem, known, time, q, v);
        let local = (0..problem.laws.len()).map(|law| problem.local(law, time, q, v));
        let local: Vec<[Local<f64>; 2]> = local.collect();
        let laws = || problem.laws.iter().zip(&states).zip(&local);
        let mut obstacles = 0.0;
        if problem.forcing.moved().next().is_some() {
            for (number, ((law, state), [position, velocity])) in laws().enumerate() {
                let [_, rate, ..] = problem.forcing.motion(number, time);
                obstacles += power(&law.force(*state, position, velocity), &rate);
            }
        }
        let taken = |matrix: Option<&Coupling>, motion: &[f64]| {
            let forces = |matrix: &Coupling| {
                let each = v.iter().enumerate();
                each.map(|(mode, v)| matrix.product(mode, motion) * v).sum()
            };
            matrix.map_or(0.0, forces)
        };
        let own: f64 = (problem.system.damping().iter().zip(v))
            .map(|(c, v)| c * v * v)
            .sum();
        Self {
            modal: own + taken(problem.system.coupling(), v),
            circulatory: -taken(problem.system.circulatory(), q),
            load: problem.forcing.changing_power(time, v),
            laws: laws()
                .map(|((law, state), [position, velocity])| {
                    law.dissipated_power(*state, position, velocity)
                })
                .collect(),
            stored: laws()
                .map(|((law, state), [position, _])| law.stored(*state, position))
                .collect(),
            obstacles,
            positions: local.iter().map(|[position, _]| *position).collect(),
            states,
        }
    }
}

/// The laws' states that a motion shows, after those that a scheme saw at its last step.
pub(crate) fn sampled_states<L: Law>(
    problem: &Problem<L>,
    known: impl Iterator<Item = State>,
    time: f64,
    q: &[f64],
    v: &[f64],
) -> Vec<State> {
    (problem.laws.iter().zip(known).enumerate())
        .map(|(number, (law, known))| {
            // What is asked once a step has answered already.
            if law.is_stepped() {
                return known;
            }
            let [position, velocity] = problem.local(number, time, q, v);
            law.sampled_state(known, &position, &velocity)
        })
        .collect()
}
