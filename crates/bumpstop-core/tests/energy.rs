//! The energy ledger is a check that can fail: a law whose force does not belong to its energy
//! shows in the residual, with every method.

use bumpstop_core::forcing::Forcing;
use bumpstop_core::law::{Guard, Law, Local, LocalMotion, Piece, Power, State, Stop};
use bumpstop_core::method::fixed_step::Step;
use bumpstop_core::method::{Method, simulate};
use bumpstop_core::number::{Dual, Number};
use bumpstop_core::problem::Problem;
use bumpstop_core::system::ModalSystem;
use std::borrow::Cow;
use std::sync::Arc;

/// A stop that pushes more than its stored energy accounts for.
#[derive(Clone)]
struct Corrupted {
    stop: Stop,
    factor: f64,
}

impl Law for Corrupted {
    fn rows(&self) -> &[Vec<f64>] {
        self.stop.rows()
    }
    fn state_name(&self, state: State) -> Cow<'static, str> {
        self.stop.state_name(state)
    }
    fn initial_state(&self, motion: &LocalMotion, acting: impl Fn(State) -> LocalMotion) -> State {
        self.stop.initial_state(motion, acting)
    }
    fn sampled_state(&self, previous: State, x: &Local<f64>, v: &Local<f64>) -> State {
        self.stop.sampled_state(previous, x, v)
    }
    fn force<T: Number>(&self, state: State, position: &Local<T>, velocity: &Local<T>) -> Local<T> {
        (self.stop.force(state, position, velocity)).map(|force| force * T::of(self.factor))
    }
    fn piece(&self, state: State) -> Option<Piece> {
        let mut piece = self.stop.piece(state)?;
        piece.constant[0] *= self.factor;
        piece.stiffness[0][0] *= self.factor;
        Some(piece)
    }
    fn guard_count(&self, state: State) -> usize {
        self.stop.guard_count(state)
    }
    fn guard(&self, state: State, index: usize) -> Guard {
        self.stop.guard(state, index)
    }
    fn next_state(
        &self,
        state: State,
        guard: usize,
        acting: impl Fn(State) -> LocalMotion,
    ) -> State {
        self.stop.next_state(state, guard, acting)
    }
    fn stored<T: Number>(&self, state: State, position: &Local<T>) -> T {
        self.stop.stored(state, position)
    }
    fn dissipation(&self, state: State) -> Power {
        self.stop.dissipation(state)
    }
    fn switch_loss(&self, before: State, after: State, position: &Local<f64>) -> f64 {
        self.stop.switch_loss(before, after, position)
    }
    fn distance<T: Number>(&self, position: &Local<T>, velocity: &Local<T>) -> (T, T) {
        self.stop.distance(position, velocity)
    }
    fn in_contact(&self, state: State) -> bool {
        self.stop.in_contact(state)
    }
    fn stiffest(&self) -> Piece {
        self.stop.stiffest()
    }
}

/// Two modes thrown at a stop under a constant force, the run ending in contact.
fn residual(factor: f64, method: Method) -> f64 {
    let stop = Stop::new(vec![1.0, 0.6], 1e-3, 2e4, 0.0).expect("a stop");
    let system = ModalSystem::new(vec![0.0, 900.0], vec![0.0, 0.8]).expect("a system");
    let forcing = Forcing::constant(vec![-20.0, 0.0]).expect("forces");
    let laws = vec![Corrupted { stop, factor }];
    let start = vec![0.0, 0.0];
    let problem = Problem::new(system, laws, forcing, start, vec![-0.5, 0.2], 0.01);
    let problem = Arc::new(problem.expect("a problem"));
    let history = simulate(&problem, method, &mut |_| true).expect("a solution");
    assert!(!history.events().is_empty(), "the stop must be hit");
    history.energy_residual()
}

#[test]
fn a_corrupted_force_shows_in_the_residual() {
    let step = Step {
        dt: 1e-6,
        beyond_stability_limit: false,
    };
    let methods = [
        (Method::Exact, 1e-13),
        (Method::CentralDifference(step), 1e-4),
        (Method::SymplecticEuler(step), 1e-2),
    ];
    for (method, honest) in methods {
        assert!(residual(1.0, method) < honest, "{method:?}");
        assert!(residual(1.5, method) > 10.0 * honest, "{method:?}");
    }
}

#[test]
fn the_formula_of_the_force_gives_its_derivative_too() {
    let stop = Stop::new(vec![1.0], 1e-3, 2e4, 30.0).expect("a stop");
    let zero = Dual::of(0.0);
    let position = [Dual::variable(-3e-3), zero, zero];
    let velocity = [Dual::of(-0.1), zero, zero];
    let force = stop.force(Stop::CLOSED, &position, &velocity)[0];
    assert!((force.value - 43.0).abs() < 1e-12);
    assert!((force.slope + 2e4).abs() < 1e-9);
}
