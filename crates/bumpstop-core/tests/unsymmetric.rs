//! Laws and structures with matrices of any symmetry, against the exponential of the state matrix.

mod flow;

use bumpstop_core::forcing::Forcing;
use bumpstop_core::history::Derivative;
use bumpstop_core::law::{COORDINATES, Guard, Law, Local, LocalMotion, Piece, Power, State};
use bumpstop_core::method::{Method, simulate};
use bumpstop_core::number::Number;
use bumpstop_core::problem::Problem;
use bumpstop_core::system::ModalSystem;
use flow::Equations;
use proptest::prelude::*;
use std::sync::Arc;

/// A law that never switches: one piece.
#[derive(Debug, Clone)]
struct Constant {
    rows: Vec<Vec<f64>>,
    piece: Piece,
}

impl Law for Constant {
    fn rows(&self) -> &[Vec<f64>] {
        &self.rows
    }
    fn state_name(&self, _: State) -> &'static str {
        "constant"
    }
    fn initial_state(&self, _: &LocalMotion) -> State {
        State::FIRST
    }
    fn sampled_state(&self, state: State, _: &Local<f64>, _: &Local<f64>) -> State {
        state
    }
    fn force<T: Number>(&self, _: State, position: &Local<T>, velocity: &Local<T>) -> Local<T> {
        self.piece.force(position, velocity)
    }
    fn piece(&self, _: State) -> Option<Piece> {
        Some(self.piece)
    }
    fn guard_count(&self, _: State) -> usize {
        0
    }
    fn guard(&self, _: State, _: usize) -> Guard {
        unreachable!("it has no guards")
    }
    fn next_state(&self, state: State, _: usize, _: impl FnOnce() -> LocalMotion) -> State {
        state
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
        (position[0], velocity[0])
    }
    fn in_contact(&self, _: State) -> bool {
        false
    }
    fn stiffest(&self) -> Piece {
        self.piece
    }
}

const MODES: usize = 5;
const OMEGA2: [f64; MODES] = [4.0, 9.0, 30.0, 55.0, 90.0];
const DURATION: f64 = 3.0;

fn row() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-1.0f64..1.0, MODES)
}

fn local(size: f64) -> impl Strategy<Value = [Local<f64>; COORDINATES]> {
    prop::array::uniform3(prop::array::uniform3(-size..size))
}

type Square = Vec<Vec<f64>>;

fn square(size: f64) -> impl Strategy<Value = Square> {
    prop::collection::vec(prop::collection::vec(-size..size, MODES), MODES)
}

/// A law whose stiffness alone is stable; what couples it otherwise may make the motion grow.
fn piece() -> impl Strategy<Value = Piece> {
    let constant = prop::array::uniform3(-1.0f64..1.0);
    (constant, local(4.0), local(0.5)).prop_map(|(constant, mut stiffness, damping)| {
        for (i, row) in stiffness.iter_mut().enumerate() {
            row[i] += 10.0;
        }
        Piece {
            constant,
            stiffness,
            damping,
        }
    })
}

fn equations(
    damping: &[f64],
    matrices: Option<&(Square, Square)>,
    force: &[f64],
    laws: &[Constant],
) -> Equations {
    let diagonal = |values: &[f64]| -> Square {
        (0..MODES)
            .map(|r| {
                (0..MODES)
                    .map(|c| if r == c { values[r] } else { 0.0 })
                    .collect()
            })
            .collect()
    };
    let mut equations = Equations {
        stiffness: diagonal(&OMEGA2),
        damping: diagonal(damping),
        force: force.to_vec(),
    };
    for r in 0..MODES {
        for c in 0..MODES {
            if let Some((coupling, circulatory)) = matrices {
                equations.damping[r][c] += coupling[r][c];
                equations.stiffness[r][c] += circulatory[r][c];
            }
            for law in laws {
                for (i, left) in law.rows.iter().enumerate() {
                    for (j, right) in law.rows.iter().enumerate() {
                        equations.stiffness[r][c] += left[r] * law.piece.stiffness[i][j] * right[c];
                        equations.damping[r][c] += left[r] * law.piece.damping[i][j] * right[c];
                    }
                }
            }
        }
        for law in laws {
            for (left, constant) in law.rows.iter().zip(law.piece.constant) {
                equations.force[r] += left[r] * constant;
            }
        }
    }
    equations
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn full_pieces_and_circulatory_matrices_move_as_their_exponential(
        rows in prop::collection::vec(prop::array::uniform3(row()), 0..3),
        pieces in prop::array::uniform2(piece()),
        damping in prop::collection::vec(0.0f64..0.8, MODES),
        matrices in prop::option::of((square(0.3), square(3.0))),
        force in row(), displacement in row(), velocity in row(),
    ) {
        let laws: Vec<Constant> = rows.iter().zip(pieces)
            .map(|(rows, piece)| Constant { rows: rows.to_vec(), piece })
            .collect();
        let expected = equations(&damping, matrices.as_ref(), &force, &laws);
        let mut system = ModalSystem::new(OMEGA2.to_vec(), damping).unwrap();
        if let Some((coupling, circulatory)) = matrices {
            system = system.with_coupling(coupling).unwrap();
            system = system.with_circulatory(circulatory).unwrap();
        }
        let forcing = Forcing::constant(force).unwrap();
        let start = [displacement.clone(), velocity.clone()].concat();
        let problem = Problem::new(system, laws, forcing, displacement, velocity, DURATION).unwrap();
        let history = simulate(&Arc::new(problem), Method::Exact, &mut |_| true).unwrap();
        for time in [0.0, 0.7, DURATION] {
            let expected = expected.after(&start, time);
            let found = [
                history.motion(&[time], Derivative::Displacement).unwrap(),
                history.motion(&[time], Derivative::Velocity).unwrap(),
            ].concat();
            let size = expected.iter().chain(&start).fold(1.0f64, |m, x| m.max(x.abs()));
            for (found, expected) in found.iter().zip(&expected) {
                prop_assert!((found - expected).abs() < 1e-11 * size, "{found} {expected}");
            }
        }
    }
}
