//! Curved guards against closed-form motions, scanned finely.
//!
//! The law of these tests pushes nothing inside a circle of the plane of its two coordinates, or
//! of their rates, and like a spring on each of them outside. Its guard is `R^2 - x^2 - y^2`.

use bumpstop_core::forcing::Forcing;
use bumpstop_core::law::{Affine, Guard, Law, Local, LocalMotion, Piece, Power, State};
use bumpstop_core::method::adaptive::{Adaptive, PairName, Tolerances};
use bumpstop_core::method::{Method, simulate};
use bumpstop_core::number::Number;
use bumpstop_core::problem::Problem;
use bumpstop_core::system::ModalSystem;
use proptest::prelude::*;
use std::borrow::Cow;
use std::sync::Arc;

const INSIDE: State = State::plain(0);
const OUTSIDE: State = State::plain(1);

#[derive(Debug, Clone)]
struct Circle {
    rows: [Vec<f64>; 2],
    radius: f64,
    /// Of the spring outside, in N/m.
    stiffness: f64,
    /// Whether the circle is one of velocities.
    of_speed: bool,
}

impl Circle {
    fn clearance<T: Number>(&self, position: &Local<T>, velocity: &Local<T>) -> T {
        let [x, y, _] = if self.of_speed { velocity } else { position };
        T::of(self.radius * self.radius) - *x * *x - *y * *y
    }
}

impl Law for Circle {
    fn rows(&self) -> &[Vec<f64>] {
        &self.rows
    }
    fn state_name(&self, state: State) -> Cow<'static, str> {
        if state == INSIDE { "inside" } else { "outside" }.into()
    }
    fn initial_state(&self, motion: &LocalMotion, _: impl Fn(State) -> LocalMotion) -> State {
        let clearance = self.clearance(motion.position(), motion.velocity());
        if clearance > 0.0 { INSIDE } else { OUTSIDE }
    }
    fn sampled_state(&self, _: State, position: &Local<f64>, velocity: &Local<f64>) -> State {
        let motion = LocalMotion::of(*position, *velocity);
        self.initial_state(&motion, |_| motion)
    }
    fn force<T: Number>(&self, state: State, position: &Local<T>, velocity: &Local<T>) -> Local<T> {
        let piece = self.piece(state).unwrap_or(Piece::FREE);
        piece.force(position, velocity)
    }
    fn piece(&self, state: State) -> Option<Piece> {
        let mut piece = Piece::FREE;
        if state == OUTSIDE {
            (piece.stiffness[0][0], piece.stiffness[1][1]) = (self.stiffness, self.stiffness);
        }
        Some(piece)
    }
    fn guard_count(&self, _: State) -> usize {
        1
    }
    fn guard(&self, state: State, _: usize) -> Guard {
        Guard {
            name: if state == INSIDE { "out" } else { "in" },
            function: Affine::ZERO,
        }
    }
    fn is_curved(&self, _: State, _: usize) -> bool {
        true
    }
    fn guard_value<T: Number>(
        &self,
        state: State,
        _: usize,
        position: &Local<T>,
        velocity: &Local<T>,
    ) -> T {
        let clearance = self.clearance(position, velocity);
        if state == INSIDE {
            clearance
        } else {
            -clearance
        }
    }
    fn next_state(&self, state: State, _: usize, _: impl Fn(State) -> LocalMotion) -> State {
        if state == INSIDE { OUTSIDE } else { INSIDE }
    }
    fn stored<T: Number>(&self, _: State, _: &Local<T>) -> T {
        T::of(0.0)
    }
    fn dissipation(&self, _: State) -> Power {
        Power::NONE
    }
    fn switch_loss(&self, _: State, _: State, _: &Local<f64>) -> f64 {
        0.0
    }
    fn distance<T: Number>(&self, position: &Local<T>, velocity: &Local<T>) -> (T, T) {
        (self.clearance(position, velocity), T::of(0.0))
    }
    fn in_contact(&self, state: State) -> bool {
        state == OUTSIDE
    }
    fn stiffest(&self) -> Piece {
        self.piece(OUTSIDE).unwrap_or(Piece::FREE)
    }
}

/// Two damped modes, each seen by one coordinate with a factor.
#[derive(Debug, Clone, Copy)]
struct Modes {
    omega: [f64; 2],
    damping: f64,
    factors: [f64; 2],
}

type Motion = [[f64; 2]; 2];

impl Modes {
    /// Displacements and velocities after t, springs of the given stiffness on the coordinates.
    fn after(&self, [q, v]: Motion, t: f64, stiffness: f64) -> Motion {
        let mut end = [[0.0; 2]; 2];
        for i in 0..2 {
            let half = 0.5 * self.damping;
            let w2 = self.omega[i].powi(2) + stiffness * self.factors[i].powi(2);
            let w = (w2 - half * half).sqrt();
            let (sin, cos) = (w * t).sin_cos();
            let (a, b) = (q[i], (v[i] + half * q[i]) / w);
            let decay = (-half * t).exp();
            end[0][i] = decay * (a * cos + b * sin);
            end[1][i] = decay * ((b * w - half * a) * cos - (a * w + half * b) * sin);
        }
        end
    }

    fn clearance(&self, law: &Circle, [q, v]: Motion) -> f64 {
        let of = if law.of_speed { v } else { q };
        law.radius.powi(2) - (of[0] * self.factors[0]).powi(2) - (of[1] * self.factors[1]).powi(2)
    }

    fn events(&self, law: &Circle, start: Motion, duration: f64) -> Vec<f64> {
        self.events_by(Method::Exact, law, start, duration)
    }

    fn events_by(&self, method: Method, law: &Circle, start: Motion, duration: f64) -> Vec<f64> {
        let rows = [vec![self.factors[0], 0.0], vec![0.0, self.factors[1]]];
        let law = Circle {
            rows,
            ..law.clone()
        };
        let omega2 = self.omega.map(|w| w * w).to_vec();
        let system = ModalSystem::new(omega2, vec![self.damping; 2]).unwrap();
        let forcing = Forcing::constant(vec![0.0; 2]).unwrap();
        let [q, v] = start.map(|x| x.to_vec());
        let problem = Problem::new(system, vec![law], forcing, q, v, duration).unwrap();
        let history = simulate(&Arc::new(problem), method, &mut |_| true).unwrap();
        history.events().iter().map(|event| event.time).collect()
    }

    /// The switches, by a scan for changes of sign and for turning points between.
    fn scanned(&self, law: &Circle, start: Motion, duration: f64) -> Vec<f64> {
        let mut found = Vec::new();
        let (mut from, mut motion) = (0.0, start);
        let mut inside = self.clearance(law, start) > 0.0;
        loop {
            let stiffness = if inside { 0.0 } else { law.stiffness };
            let sign = if inside { 1.0 } else { -1.0 };
            let guard = |t: f64| sign * self.clearance(law, self.after(motion, t, stiffness));
            let Some(time) = first_zero(guard, duration - from) else {
                return found;
            };
            motion = self.after(motion, time, stiffness);
            from += time;
            inside = !inside;
            found.push(from);
        }
    }
}

/// With a tolerance that tells touches from misses where the scan does.
fn adaptive(pair: PairName) -> Method {
    let tolerances = Tolerances {
        relative: 1e-12,
        absolute: None,
        exact_flights: false,
    };
    Method::Adaptive(Adaptive::RungeKutta(pair, tolerances))
}

/// Steps of the scan, in s; the fastest guard has a period of about one.
const STEP: f64 = 1e-3;

/// The first zero of a function that is positive, or departs from zero upwards.
fn first_zero(guard: impl Fn(f64) -> f64, limit: f64) -> Option<f64> {
    let mut left = 1e-7;
    while left < limit {
        let right = left + STEP;
        let mut end = right;
        if guard(right) > 0.0 {
            end = least(&guard, left, right);
        }
        if guard(end) <= 0.0 {
            let (mut low, mut high) = (left, end);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if guard(middle) > 0.0 {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            return (low < limit).then_some(low);
        }
        left = right;
    }
    None
}

/// Where a function is least between two times, by thirds.
fn least(guard: &impl Fn(f64) -> f64, mut left: f64, mut right: f64) -> f64 {
    for _ in 0..40 {
        let third = (right - left) / 3.0;
        if guard(left + third) < guard(right - third) {
            right -= third;
        } else {
            left += third;
        }
    }
    0.5 * (left + right)
}

fn circle(radius: f64, stiffness: f64, of_speed: bool) -> Circle {
    Circle {
        rows: [Vec::new(), Vec::new()],
        radius,
        stiffness,
        of_speed,
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn switches_are_those_of_a_fine_scan(
        omega in prop::array::uniform2(1.0f64..6.0), damping in 0.0f64..0.3,
        factors in prop::array::uniform2(0.4f64..1.0),
        q in prop::array::uniform2(-1.0f64..1.0), v in prop::array::uniform2(-3.0f64..3.0),
        radius in 0.3f64..0.9, stiffness in prop_oneof![Just(0.0), 1.0f64..30.0], of_speed: bool,
    ) {
        let modes = Modes { omega, damping, factors };
        let scale = if of_speed { 4.0 } else { 1.0 };
        let law = circle(scale * radius, if of_speed { 0.0 } else { stiffness }, of_speed);
        let start = [q, v];
        prop_assume!(modes.clearance(&law, start).abs() > 1e-3);
        let expected = modes.scanned(&law, start, 8.0);
        let found = modes.events(&law, start, 8.0);
        // A touch can be taken for one by either.
        let gaps = expected.windows(2).map(|w| w[1] - w[0]);
        prop_assume!(gaps.fold(f64::INFINITY, f64::min) > 1e-4);
        prop_assert_eq!(found.len(), expected.len(), "{:?} {:?}", found, expected);
        for (a, b) in found.iter().zip(&expected) {
            prop_assert!((a - b).abs() < 1e-9, "{a} {b}");
        }
        for pair in [PairName::Rk54, PairName::Dop853] {
            let found = modes.events_by(adaptive(pair), &law, start, 8.0);
            prop_assert_eq!(found.len(), expected.len(), "{:?} {:?}", found, expected);
            for (a, b) in found.iter().zip(&expected) {
                prop_assert!((a - b).abs() < 1e-4, "{a} {b}");
            }
        }
    }

    /// Where the motion comes nearest to the circle, or goes just beyond it.
    #[test]
    fn touches_are_told_from_misses(
        omega in prop::array::uniform2(1.0f64..6.0), q in prop::array::uniform2(0.2f64..1.0),
        v in prop::array::uniform2(-3.0f64..3.0), depth in 2i32..12,
    ) {
        let modes = Modes { omega, damping: 0.1, factors: [1.0, 0.7] };
        let start = [q, v];
        let duration = 5.0;
        // The farthest turning point inside the run, from the clearance of a circle of no radius.
        let point = circle(0.0, 0.0, false);
        let guard = |t: f64| modes.clearance(&point, modes.after(start, t, 0.0));
        let steps = (duration / STEP) as usize;
        let farthest = (1..steps).map(|n| n as f64 * STEP).min_by(|a, b| guard(*a).total_cmp(&guard(*b)));
        let near = farthest.unwrap();
        prop_assume!(near > 2.0 * STEP && near < duration - 2.0 * STEP);
        let radius = (-guard(least(&guard, near - STEP, near + STEP))).sqrt();
        let part = 10f64.powi(-depth);
        let missed = circle(radius * (1.0 + part), 0.0, false);
        prop_assert_eq!(modes.events(&missed, start, duration), Vec::<f64>::new());
        let touched = circle(radius * (1.0 - part), 0.0, false);
        let found = modes.events(&touched, start, duration);
        prop_assert!(found.len() >= 2, "{:?}", found);
        for time in found {
            let clearance = modes.clearance(&touched, modes.after(start, time, 0.0));
            prop_assert!(clearance.abs() < 1e-13 * (1.0 + radius * radius));
        }
    }
}

/// A motion on a circle stays as far from another one for ever.
#[test]
fn a_motion_around_the_centre_never_meets_a_wider_circle() {
    let modes = Modes {
        omega: [3.0, 3.0],
        damping: 0.0,
        factors: [1.0, 1.0],
    };
    let start = [[1.0, 0.0], [0.0, 3.0]];
    for beyond in [1e-3, 1e-9, 1e-12] {
        let law = circle(1.0 + beyond, 0.0, false);
        assert!(modes.events(&law, start, 20.0).is_empty(), "{beyond}");
        if beyond > 1e-10 {
            let method = adaptive(PairName::Dop853);
            let found = modes.events_by(method, &law, start, 20.0);
            assert!(found.is_empty(), "{beyond}: {found:?}");
        }
        let speed = circle(3.0 * (1.0 + beyond), 0.0, true);
        assert!(modes.events(&speed, start, 20.0).is_empty(), "{beyond}");
    }
}
