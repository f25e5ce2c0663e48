//! Rigid stops against closed forms, hand-solved impacts and the exponential of the state matrix.

mod flow;

use bumpstop_core::forcing::Forcing;
use bumpstop_core::history::{Derivative, History};
use bumpstop_core::impacts::Impact;
use bumpstop_core::law::{AnyLaw, RigidStop, Stop};
use bumpstop_core::method::{Method, simulate};
use bumpstop_core::problem::Problem;
use bumpstop_core::system::ModalSystem;
use flow::Equations;
use proptest::prelude::*;
use std::sync::Arc;

const GRAVITY: f64 = 9.81;

fn rigid(row: &[f64], gap: f64, restitution: f64) -> AnyLaw {
    RigidStop::new(row.to_vec(), gap, restitution)
        .expect("a good stop")
        .into()
}

fn run(problem: Problem<AnyLaw>) -> History<AnyLaw> {
    simulate(&Arc::new(problem), Method::Exact, &mut |_| true).expect("a run")
}

/// Free modes that fly at constant speed or under constant forces.
fn flight(
    laws: Vec<AnyLaw>,
    forces: Vec<f64>,
    displacement: Vec<f64>,
    velocity: Vec<f64>,
    duration: f64,
) -> History<AnyLaw> {
    let modes = forces.len();
    let system = ModalSystem::new(vec![0.0; modes], vec![0.0; modes]).expect("a system");
    let forcing = Forcing::constant(forces).expect("forces");
    run(Problem::new(system, laws, forcing, displacement, velocity, duration).expect("a problem"))
}

fn ball(restitution: f64, duration: f64) -> History<AnyLaw> {
    let floor = rigid(&[1.0], 0.0, restitution);
    flight(vec![floor], vec![-GRAVITY], vec![1.0], vec![0.0], duration)
}

fn only_impacts(history: &History<AnyLaw>, law: usize) -> Vec<Impact> {
    let impacts = history.impacts(law);
    impacts.into_iter().filter(|i| i.start == i.end).collect()
}

fn velocity(history: &History<AnyLaw>, time: f64) -> Vec<f64> {
    history
        .motion(&[time], Derivative::Velocity)
        .expect("a velocity")
}

fn displacement(history: &History<AnyLaw>, time: f64) -> Vec<f64> {
    history
        .motion(&[time], Derivative::Displacement)
        .expect("a displacement")
}

#[test]
fn a_ball_bounces_at_the_instants_of_the_closed_form() {
    let fall = (2.0 / GRAVITY).sqrt();
    for restitution in [0.5, 0.9, 1.0] {
        let history = ball(restitution, 30.0);
        let impacts = only_impacts(&history, 0);
        let mut time = fall;
        let mut speed = (2.0 * GRAVITY).sqrt();
        assert!(impacts.len() >= 15, "{restitution}: {}", impacts.len());
        for impact in &impacts {
            assert!(
                (impact.start - time).abs() < 1e-12 * time,
                "{} {time}",
                impact.start
            );
            assert!((impact.closing_speed - speed).abs() < 1e-10 * speed.max(1e-2));
            assert!((impact.opening_speed - restitution * speed).abs() < 1e-10 * speed.max(1e-2));
            assert!((impact.impulse - (1.0 + restitution) * speed).abs() < 1e-10);
            assert!(impact.peak_force.is_infinite());
            speed *= restitution;
            time += 2.0 * speed / GRAVITY;
        }
        assert!(
            history.energy_residual() < 1e-11,
            "{}",
            history.energy_residual()
        );
    }
}

#[test]
fn infinitely_many_rebounds_end_where_they_accumulate() {
    for restitution in [0.1, 0.5, 0.9] {
        let history = ball(restitution, 30.0);
        let fall = (2.0 / GRAVITY).sqrt();
        let end = fall * (1.0 + restitution) / (1.0 - restitution);
        let last = history.events().last().expect("events");
        assert_eq!(last.guard, "settling");
        // A rebound of 1e-12 of the motion lasts 1e-6 of the fall or little more; the terms of
        // the motion sum to 7 m at most.
        let bound = 7e-12f64.sqrt() * 2.0 * fall / (1.0 - restitution);
        assert!(
            last.time < end && end - last.time < bound,
            "{} {end}",
            last.time
        );
        let impacts = history.impacts(0);
        let rest = impacts.last().expect("a rest");
        assert!(rest.end.is_nan());
        assert!((rest.impulse - GRAVITY * (30.0 - last.time)).abs() < 1e-9);
        assert!((rest.peak_force - GRAVITY).abs() < 1e-12);
        assert!(displacement(&history, 29.0)[0].abs() < 1e-15);
        let force = &history.law_motion(0, &[29.0]).expect("a force")[2];
        assert!((force[0] - GRAVITY).abs() < 1e-12);
        let acceleration = history.motion(&[29.0], Derivative::Acceleration);
        assert!(acceleration.expect("an acceleration")[0].abs() < 1e-12);
    }
}

#[test]
fn without_restitution_it_rests_at_once() {
    let history = ball(0.0, 2.0);
    let events: Vec<_> = history.events().iter().map(|e| e.guard).collect();
    assert_eq!(events, ["impact"]);
    assert!(history.energy_residual() < 1e-11);
    let ledger = &history.energy(&[1.0]).expect("energy")[0];
    assert!((ledger.law_dissipated[0] - GRAVITY).abs() < 1e-12);
}

#[test]
fn what_lies_on_a_stop_stays_there_and_what_hovers_does_too() {
    for force in [-GRAVITY, 0.0] {
        let floor = rigid(&[1.0], -0.25, 0.7);
        let history = flight(vec![floor], vec![force], vec![0.25], vec![0.0], 3.0);
        assert!(history.impacts(0).iter().all(|i| i.closing_speed == 0.0));
        assert!((displacement(&history, 3.0)[0] - 0.25).abs() < 1e-15);
    }
}

/// Two masses (modes) with rows at an angle, both touched at t = 1.
fn two_at_once(rates: [f64; 2], restitution: f64) -> [f64; 2] {
    let rows = [[1.0, 0.0], [0.6, 0.8]];
    let v = [rates[0], (rates[1] - 0.6 * rates[0]) / 0.8];
    let laws = (rows.iter().zip(rates))
        .map(|(row, rate)| rigid(row, -rate, restitution))
        .collect();
    let history = flight(laws, vec![0.0; 2], vec![0.0; 2], v.to_vec(), 1.5);
    assert!(history.energy_residual() < 1e-12);
    let v = velocity(&history, 1.25);
    rows.map(|row| row[0] * v[0] + row[1] * v[1])
}

#[test]
fn two_stops_at_once_obey_the_complementarity_problem() {
    // W = [[1, 0.6], [0.6, 1]]: both push, s = (1 + e)/1.6 each
    let [a, b] = two_at_once([-1.0, -1.0], 0.5);
    assert!(
        (a - 0.5).abs() < 1e-14 && (b - 0.5).abs() < 1e-14,
        "{a} {b}"
    );
    // W^-1 (1.5, 3) has a negative entry: the second alone pushes, s = 3, and throws the first
    // off faster than its own law would.
    let [a, b] = two_at_once([-1.0, -2.0], 0.5);
    assert!(
        (a - 0.8).abs() < 1e-14 && (b - 1.0).abs() < 1e-14,
        "{a} {b}"
    );
}

#[test]
fn three_stops_on_two_masses_share_an_impact() {
    let rows = [[1.0, 0.0], [0.0, 1.0], [0.6, 0.8]];
    let rates = [-1.0, -1.0, -1.4];
    let laws = (rows.iter().zip(rates))
        .map(|(row, rate)| rigid(row, -rate, 0.5))
        .collect();
    let history = flight(laws, vec![0.0; 2], vec![0.0; 2], vec![-1.0, -1.0], 1.5);
    let v = velocity(&history, 1.25);
    assert!(
        (v[0] - 0.5).abs() < 1e-14 && (v[1] - 0.5).abs() < 1e-14,
        "{v:?}"
    );
    assert!(history.energy_residual() < 1e-12);
}

#[test]
fn a_mass_between_walls_without_play_does_not_move() {
    let walls = vec![rigid(&[1.0], 0.0, 0.0), rigid(&[-1.0], 0.0, 0.0)];
    let system = ModalSystem::new(vec![0.0], vec![0.0]).expect("a system");
    let forcing = (Forcing::constant(vec![0.0]).expect("no force"))
        .with_harmonic(2.0, &[1.0], &[0.0])
        .expect("a harmonic");
    let problem = Problem::new(system, walls, forcing, vec![0.0], vec![0.0], 10.0);
    let history = run(problem.expect("a problem"));
    assert!(displacement(&history, 9.0)[0].abs() < 1e-12);
    // The force changes its sign at odd multiples of pi/4.
    let first = history
        .events()
        .iter()
        .find(|e| e.time > 0.0)
        .expect("an exchange");
    assert!(
        (first.time - std::f64::consts::FRAC_PI_4).abs() < 1e-9,
        "{}",
        first.time
    );
}

#[test]
fn a_resting_mass_leaves_when_a_ramp_lifts_it() {
    let system = ModalSystem::new(vec![0.0], vec![0.0]).expect("a system");
    let rate = 4.0;
    let forcing = (Forcing::constant(vec![-GRAVITY]).expect("weight"))
        .with_polynomial(vec![1.0], vec![0.0, rate])
        .expect("a ramp");
    let floor = rigid(&[1.0], 0.3, 0.4);
    let problem = Problem::new(system, vec![floor], forcing, vec![-0.3], vec![0.0], 5.0);
    let history = run(problem.expect("a problem"));
    let leaving = history.events().last().expect("events");
    assert_eq!(leaving.guard, "leaving");
    let lift = GRAVITY / rate;
    assert!(
        (leaving.time - lift).abs() < 1e-14 * lift,
        "{}",
        leaving.time
    );
    let rise = rate * (5.0 - lift).powi(3) / 6.0 - 0.3;
    assert!((displacement(&history, 5.0)[0] - rise).abs() < 1e-12);
    let rest = history.impacts(0)[0];
    assert!((rest.impulse - 0.5 * GRAVITY * lift).abs() < 1e-12);
    assert!(history.energy_residual() < 1e-11);
}

#[test]
fn a_resting_oscillator_leaves_under_a_harmonic_load() {
    // q'' + 4 q = -1 + 2 sin 0.5 t at a floor at q = 0.
    let system = ModalSystem::new(vec![4.0], vec![0.0]).expect("a system");
    let forcing = (Forcing::constant(vec![-1.0]).expect("weight"))
        .with_harmonic(0.5, &[0.0], &[2.0])
        .expect("a harmonic");
    let floor = rigid(&[1.0], 0.0, 0.0);
    let problem = Problem::new(system, vec![floor], forcing, vec![0.0], vec![0.0], 2.0);
    let history = run(problem.expect("a problem"));
    let lift = 2.0 * 0.5f64.asin();
    let leaving = history.events().last().expect("events");
    assert_eq!(leaving.guard, "leaving");
    assert!(
        (leaving.time - lift).abs() < 1e-14,
        "{} {lift}",
        leaving.time
    );
    assert!(history.energy_residual() < 1e-11);
}

const OMEGA2: [f64; 5] = [1.0, 6.0, 19.0, 47.0, 90.0];
const ROW: [f64; 5] = [0.9, -0.7, 0.5, 0.6, -0.4];

/// Five modes that swing against one stop.
fn swing(law: AnyLaw, duration: f64) -> History<AnyLaw> {
    let system = ModalSystem::new(OMEGA2.to_vec(), vec![0.0; 5]).expect("a system");
    let forcing = Forcing::constant(vec![0.0; 5]).expect("no force");
    let velocity = vec![-1.0, 0.3, 0.2, -0.1, 0.1];
    let problem = Problem::new(system, vec![law], forcing, vec![0.0; 5], velocity, duration);
    run(problem.expect("a problem"))
}

#[test]
fn it_is_the_limit_of_stiff_springs() {
    let rigid = swing(rigid(&ROW, 0.5, 1.0), 1.2);
    assert_eq!(rigid.events().len(), 1);
    let end = displacement(&rigid, 1.2);
    let mut before: Option<f64> = None;
    for power in [4, 6, 8, 10, 12] {
        let stop = Stop::new(ROW.to_vec(), 0.5, 10f64.powi(power), 0.0).expect("a stop");
        let soft = displacement(&swing(stop.into(), 1.2), 1.2);
        let error = (soft.iter().zip(&end)).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
        // The contact lasts half a period, as k^-1/2.
        if let Some(before) = before {
            assert!(
                (before / error - 10.0).abs() < 1.0,
                "1e{power}: {before} {error}"
            );
        }
        before = Some(error);
    }
}

/// A random problem of four modes, two rigid stops and an elastic one.
#[derive(Debug, Clone)]
struct Case {
    rows: Vec<Vec<f64>>,
    gaps: Vec<f64>,
    restitution: [f64; 2],
    stiffness: f64,
    damping: Vec<f64>,
    force: Vec<f64>,
    velocity: Vec<f64>,
}

const W2: [f64; 4] = [2.0, 9.0, 26.0, 70.0];
const DURATION: f64 = 6.0;

fn case() -> impl Strategy<Value = Case> {
    let entries = |low: f64, high: f64| prop::collection::vec(low..high, 4);
    (
        prop::collection::vec(entries(-1.0, 1.0), 3),
        prop::collection::vec(0.0f64..0.4, 3),
        [0.0f64..0.9, 0.0f64..0.9],
        1.0f64..300.0,
        entries(0.0, 0.3),
        entries(-3.0, 3.0),
        entries(-2.0, 2.0),
    )
        .prop_map(
            |(rows, gaps, restitution, stiffness, damping, force, velocity)| Case {
                rows,
                gaps,
                // A good part of them without rebound.
                restitution: restitution.map(|e| (e - 0.2).max(0.0)),
                stiffness,
                damping,
                force,
                velocity,
            },
        )
}

impl Case {
    fn history(&self) -> History<AnyLaw> {
        let spring = Stop::new(self.rows[2].clone(), self.gaps[2], self.stiffness, 0.0);
        let laws = vec![
            rigid(&self.rows[0], self.gaps[0], self.restitution[0]),
            rigid(&self.rows[1], self.gaps[1], self.restitution[1]),
            spring.expect("a spring").into(),
        ];
        let system = ModalSystem::new(W2.to_vec(), self.damping.clone()).expect("a system");
        let forcing = Forcing::constant(self.force.clone()).expect("forces");
        let start = vec![0.0; 4];
        let problem = Problem::new(
            system,
            laws,
            forcing,
            start,
            self.velocity.clone(),
            DURATION,
        );
        run(problem.expect("a problem"))
    }

    /// The equations with the stops that hold and the spring where it is closed: held directions
    /// are projected out of the accelerations, so that what starts there stays there.
    fn equations(&self, held: &[usize], closed: bool) -> Equations {
        let unit = |i: usize, j: usize| f64::from(u8::from(i == j));
        let k = if closed { self.stiffness } else { 0.0 };
        let spring = &self.rows[2];
        let mut projector: Vec<Vec<f64>> = (0..4)
            .map(|i| (0..4).map(|j| unit(i, j)).collect())
            .collect();
        let mut done: Vec<Vec<f64>> = Vec::new();
        for &law in held {
            let mut row = self.rows[law].clone();
            for other in &done {
                let part = dot(&row, other);
                row.iter_mut().zip(other).for_each(|(x, o)| *x -= part * o);
            }
            let length = dot(&row, &row).sqrt();
            row.iter_mut().for_each(|x| *x /= length);
            for (i, line) in projector.iter_mut().enumerate() {
                line.iter_mut()
                    .zip(&row)
                    .for_each(|(x, r)| *x -= row[i] * r);
            }
            done.push(row);
        }
        let projected = |entry: &dyn Fn(usize, usize) -> f64| -> Vec<Vec<f64>> {
            let line = |i: usize, j: usize| (0..4).map(|m| projector[i][m] * entry(m, j)).sum();
            (0..4)
                .map(|i| (0..4).map(|j| line(i, j)).collect())
                .collect()
        };
        let force: Vec<f64> = (0..4)
            .map(|m| self.force[m] - k * spring[m] * self.gaps[2])
            .collect();
        Equations {
            stiffness: projected(&|m, j| W2[m] * unit(m, j) + k * spring[m] * spring[j]),
            damping: projected(&|m, j| self.damping[m] * unit(m, j)),
            force: projector.iter().map(|line| dot(line, &force)).collect(),
        }
    }

    fn distance(&self, law: usize, state: &[f64]) -> f64 {
        self.gaps[law] + dot(&self.rows[law], &state[..4])
    }

    fn rate(&self, law: usize, state: &[f64]) -> f64 {
        dot(&self.rows[law], &state[4..])
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn state(history: &History<AnyLaw>, time: f64) -> Vec<f64> {
    let mut state = displacement(history, time);
    state.extend(velocity(history, time));
    state
}

/// Follows a run from event to event by the exponential of the state matrix.
fn verify(case: &Case) -> Result<(), TestCaseError> {
    let history = case.history();
    prop_assert!(
        history.energy_residual() < 1e-11,
        "{}",
        history.energy_residual()
    );
    let mut states: Vec<u8> = vec![0, 0, 0];
    let mut present = state(&history, 0.0);
    let mut time = 0.0;
    let events = history.events();
    let mut next = 0;
    while time < DURATION {
        // Every switch of one instant.
        let mut struck = Vec::new();
        let first = next;
        while next < events.len() && events[next].time == time {
            let event = &events[next];
            prop_assert_eq!(event.before.number, states[event.law]);
            states[event.law] = event.after.number;
            if event.guard == "impact" {
                struck.push(event.law);
            }
            next += 1;
        }
        let after = state(&history, time);
        let settles = events[first..next].iter().any(|e| e.guard == "settling");
        let held: Vec<usize> = (0..2).filter(|&law| states[law] == 1).collect();
        // What lies still shares impulses and is judged by the energy alone.
        if struck.len() == 1 && held.is_empty() && !settles && time > 0.0 {
            let law = struck[0];
            prop_assert!(case.distance(law, &present).abs() < 1e-10);
            let row = &case.rows[law];
            let jump = (1.0 + case.restitution[law]) * case.rate(law, &present) / dot(row, row);
            for mode in 0..4 {
                let wanted = present[4 + mode] - jump * row[mode];
                prop_assert!((after[4 + mode] - wanted).abs() < 1e-9, "t = {time}");
            }
        }
        for i in 0..4 {
            prop_assert!((after[i] - present[i]).abs() < 1e-9, "q jumps at {time}");
        }
        let until = events.get(next).map_or(DURATION, |event| event.time);
        let equations = case.equations(&held, states[2] == 1);
        for part in 1..8 {
            let within = equations.after(&after, (until - time) * f64::from(part) / 8.0);
            for (law, state) in states.iter().enumerate().take(2) {
                let distance = case.distance(law, &within);
                prop_assert!(distance > -1e-9, "{distance} before {law} at {time}");
                if *state == 1 {
                    prop_assert!(distance.abs() < 1e-9);
                }
            }
        }
        present = equations.after(&after, until - time);
        time = until;
    }
    let end = state(&history, DURATION);
    for (a, b) in end.iter().zip(&present) {
        prop_assert!((a - b).abs() < 1e-9, "{a} {b}");
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, ..ProptestConfig::default() })]

    #[test]
    fn random_problems_follow_the_exponential_of_the_state_matrix(case in case()) {
        verify(&case)?;
    }
}
