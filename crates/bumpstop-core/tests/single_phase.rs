//! Phases with matrices of any symmetry and exponents that nearly or wholly coincide, against the
//! exponential of the state matrix.

mod flow;

use bumpstop_core::forcing::Forcing;
use bumpstop_core::history::Derivative;
use bumpstop_core::law::{
    Affine, COORDINATES, Guard, Law, Local, LocalMotion, Piece, Power, State,
};
use bumpstop_core::method::{Method, simulate};
use bumpstop_core::number::Number;
use bumpstop_core::problem::Problem;
use bumpstop_core::system::ModalSystem;
use flow::Equations;
use proptest::prelude::*;
use std::borrow::Cow;
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
    fn state_name(&self, _: State) -> Cow<'static, str> {
        "constant".into()
    }
    fn initial_state(&self, _: &LocalMotion, _: impl Fn(State) -> LocalMotion) -> State {
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
    fn next_state(&self, state: State, _: usize, _: impl Fn(State) -> LocalMotion) -> State {
        state
    }
    fn stored<T: Number>(&self, _: State, _: &Local<T>) -> T {
        T::of(0.0)
    }
    fn dissipation(&self, _: State) -> Power {
        // Nothing is stored: whatever its forces take out counts.
        let product = |i: usize| {
            let force = Affine {
                constant: -self.piece.constant[i],
                position: self.piece.stiffness[i],
                velocity: self.piece.damping[i],
                ..Affine::ZERO
            };
            (force, Affine::rate(i))
        };
        Power::of(&[0, 1, 2].map(product)[..self.rows.len()])
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
const DURATION: f64 = 3.0;

type Square = Vec<Vec<f64>>;

fn row() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-1.0f64..1.0, MODES)
}

fn local(size: f64) -> impl Strategy<Value = [Local<f64>; COORDINATES]> {
    prop::array::uniform3(prop::array::uniform3(-size..size))
}

fn square(size: f64) -> impl Strategy<Value = Square> {
    prop::collection::vec(prop::collection::vec(-size..size, MODES), MODES)
}

fn zeros() -> Square {
    vec![vec![0.0; MODES]; MODES]
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

/// A spring and damper along the first coordinate, with a preload.
fn spring(stiffness: f64, damping: f64, constant: f64) -> Piece {
    let mut piece = Piece::FREE;
    piece.constant[0] = constant;
    piece.stiffness[0][0] = stiffness;
    piece.damping[0][0] = damping;
    piece
}

/// Modes, what couples them, and laws that never switch.
#[derive(Debug, Clone)]
struct Case {
    omega2: Vec<f64>,
    damping: Vec<f64>,
    coupling: Square,
    circulatory: Square,
    laws: Vec<Constant>,
    force: Vec<f64>,
    displacement: Vec<f64>,
    velocity: Vec<f64>,
}

impl Case {
    fn equations(&self) -> Equations {
        let mut equations = Equations {
            stiffness: self.circulatory.clone(),
            damping: self.coupling.clone(),
            force: self.force.clone(),
        };
        for r in 0..MODES {
            equations.stiffness[r][r] += self.omega2[r];
            equations.damping[r][r] += self.damping[r];
        }
        for law in &self.laws {
            let Piece {
                constant,
                stiffness,
                damping,
            } = law.piece;
            let seen = |matrix: &[Local<f64>; COORDINATES], r: usize, c: usize| -> f64 {
                (law.rows.iter().zip(matrix))
                    .flat_map(|(left, row)| {
                        let pairs = law.rows.iter().zip(row);
                        pairs.map(move |(right, factor)| left[r] * factor * right[c])
                    })
                    .sum()
            };
            for r in 0..MODES {
                let push = law.rows.iter().zip(constant);
                equations.force[r] += push.map(|(row, force)| row[r] * force).sum::<f64>();
                for c in 0..MODES {
                    equations.stiffness[r][c] += seen(&stiffness, r, c);
                    equations.damping[r][c] += seen(&damping, r, c);
                }
            }
        }
        equations
    }

    fn problem(&self) -> Problem<Constant> {
        let system = ModalSystem::new(self.omega2.clone(), self.damping.clone())
            .and_then(|system| system.with_coupling(self.coupling.clone()))
            .and_then(|system| system.with_circulatory(self.circulatory.clone()))
            .unwrap();
        Problem::new(
            system,
            self.laws.clone(),
            Forcing::constant(self.force.clone()).unwrap(),
            self.displacement.clone(),
            self.velocity.clone(),
            DURATION,
        )
        .unwrap()
    }

    /// The largest difference from the exponential, relative to the motion, and what the ledger
    /// misses.
    fn errors(&self) -> [f64; 2] {
        let problem = Arc::new(self.problem());
        let history = simulate(&problem, Method::Exact, &mut |_| true).unwrap();
        let start = [self.displacement.clone(), self.velocity.clone()].concat();
        let equations = self.equations();
        let mut worst = 0.0f64;
        for time in [0.0, 0.7, DURATION] {
            let expected = equations.after(&start, time);
            let found = [Derivative::Displacement, Derivative::Velocity]
                .map(|derivative| history.motion(&[time], derivative).unwrap())
                .concat();
            let size = (expected.iter().chain(&start)).fold(1.0f64, |m, x| m.max(x.abs()));
            for (found, expected) in found.iter().zip(&expected) {
                let error = (found - expected).abs() / size;
                worst = if error.is_nan() {
                    error
                } else {
                    worst.max(error)
                };
            }
        }
        [worst, history.energy_residual()]
    }
}

proptest! {
    #[test]
    fn matrices_of_any_symmetry(
        rows in prop::collection::vec(prop::array::uniform3(row()), 0..3),
        pieces in prop::array::uniform2(piece()),
        damping in prop::collection::vec(0.0f64..0.8, MODES),
        (coupling, circulatory) in prop_oneof![
            Just((zeros(), zeros())),
            (square(0.3), square(3.0)),
        ],
        force in row(), displacement in row(), velocity in row(),
    ) {
        let laws = rows.iter().zip(pieces)
            .map(|(rows, piece)| Constant { rows: rows.to_vec(), piece })
            .collect();
        let omega2 = vec![4.0, 9.0, 30.0, 55.0, 90.0];
        let case = Case {
            omega2, damping, coupling, circulatory, laws, force, displacement, velocity,
        };
        let [error, residual] = case.errors();
        prop_assert!(error < 1e-11, "{error:e}");
        prop_assert!(residual < 1e-11, "energy residual {residual:e}");
    }

    /// Critical damping on purpose, nearly or wholly; free modes with and without drag; modes that
    /// are alike but for their damping; slow ones.
    #[test]
    fn exponents_that_coincide(
        omega in prop::collection::vec(
            prop_oneof![Just(0.0), Just(2.0), Just(2.0 + 1e-9), 1e-5f64..1e-2, 1.0f64..6.0], MODES),
        ratio in prop::collection::vec(
            prop_oneof![Just(0.0), Just(1.0), 0.0f64..0.1, 0.999_999f64..1.000_001], MODES),
        drag in prop::collection::vec(prop_oneof![Just(0.0), Just(0.3), 0.0f64..2.0], MODES),
        rows in prop::collection::vec(row(), 1..4),
        stiffness in prop_oneof![Just(0.0), 1e-8f64..1e-3, 1.0f64..50.0],
        damper in prop_oneof![Just(0.0), 0.0f64..2.0],
        constant in prop_oneof![Just(0.0), -1.0f64..1.0],
        force in prop_oneof![Just(vec![0.0; MODES]), row()],
        displacement in row(), velocity in row(),
    ) {
        let damping = omega.iter().zip(ratio).zip(drag)
            .map(|((omega, ratio), drag)| if *omega == 0.0 { drag } else { 2.0 * ratio * omega })
            .collect();
        let laws = rows.into_iter()
            .map(|row| Constant { rows: vec![row], piece: spring(stiffness, damper, constant) })
            .collect();
        let omega2 = omega.iter().map(|omega| omega * omega).collect();
        let case = Case {
            omega2, damping, coupling: zeros(), circulatory: zeros(), laws, force, displacement,
            velocity,
        };
        let [error, residual] = case.errors();
        prop_assert!(error < 1e-11, "{error:e}");
        prop_assert!(residual < 1e-11, "energy residual {residual:e}");
    }
}
