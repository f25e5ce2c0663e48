//! Every term of the energy ledger comes from its own power: whatever force is not the one that
//! its term accounts for shows in the residual, and over ten thousand impacts nothing else does.

use bumpstop_core::error::Result;
use bumpstop_core::forcing::{Beyond, Forcing, Table};
use bumpstop_core::history::{Derivative, History};
use bumpstop_core::law::{COORDINATES, Guard, Law, Local, LocalMotion, Piece, Power, State, Stop};
use bumpstop_core::method::{Method, simulate};
use bumpstop_core::number::Number;
use bumpstop_core::problem::Problem;
use bumpstop_core::system::ModalSystem;
use std::borrow::Cow;
use std::sync::Arc;

/// A stop before the first of three modes, and forces on all of them that no ledger hears of.
#[derive(Debug, Clone)]
struct Tampered {
    rows: [Vec<f64>; COORDINATES],
    stop: Stop,
    /// Unheard of at any time, and only in contact.
    always: Piece,
    in_contact: Piece,
}

impl Tampered {
    fn hidden(&self, state: State) -> [&Piece; 2] {
        let in_contact = state == Stop::CLOSED;
        [
            &self.always,
            if in_contact {
                &self.in_contact
            } else {
                &Piece::FREE
            },
        ]
    }
}

impl Law for Tampered {
    fn rows(&self) -> &[Vec<f64>] {
        &self.rows
    }
    fn state_name(&self, state: State) -> Cow<'static, str> {
        self.stop.state_name(state)
    }
    fn initial_state(&self, motion: &LocalMotion, acting: impl Fn(State) -> LocalMotion) -> State {
        self.stop.initial_state(motion, acting)
    }
    fn sampled_state(&self, before: State, position: &Local<f64>, velocity: &Local<f64>) -> State {
        self.stop.sampled_state(before, position, velocity)
    }
    fn force<T: Number>(&self, state: State, position: &Local<T>, velocity: &Local<T>) -> Local<T> {
        let mut force = self.stop.force(state, position, velocity);
        for piece in self.hidden(state) {
            for (total, hidden) in force.iter_mut().zip(piece.force(position, velocity)) {
                *total += hidden;
            }
        }
        force
    }
    fn piece(&self, state: State) -> Option<Piece> {
        let mut piece = self.stop.piece(state)?;
        for hidden in self.hidden(state) {
            for i in 0..COORDINATES {
                piece.constant[i] += hidden.constant[i];
                for j in 0..COORDINATES {
                    piece.stiffness[i][j] += hidden.stiffness[i][j];
                    piece.damping[i][j] += hidden.damping[i][j];
                }
            }
        }
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

/// What a structure of three modes and its stop are made of; zero is without.
#[derive(Debug, Clone, Copy, Default)]
struct Parts {
    damping: Local<f64>,
    coupling: [Local<f64>; 3],
    circulatory: [Local<f64>; 3],
    load: Local<f64>,
    /// Along which a harmonic, a polynomial and a table push.
    changing: [Local<f64>; 3],
    stop_damping: f64,
}

const OMEGA2: [f64; 3] = [900.0, 4000.0, 25_000.0];
const STIFFNESS: f64 = 2e4;

/// All of them at once.
const ALL: Parts = Parts {
    damping: [0.5, 0.8, 0.2],
    coupling: [[0.3, 1.2, -0.4], [-0.9, 0.2, 0.1], [0.2, 0.3, 0.1]],
    circulatory: [[0.0, 25.0, -9.0], [-18.0, 0.0, 4.0], [6.0, -2.0, 0.0]],
    load: [-300.0, 20.0, 5.0],
    changing: [[-20.0, 9.0, 3.0], [30.0, -10.0, 8.0], [-90.0, 60.0, 20.0]],
    stop_damping: 1.5,
};

/// The harmonic, in rad/s, with its cosine and sine.
const HARMONIC: (f64, f64, f64) = (71.0, 1.0, -0.4);
/// Coefficients of the powers of the time.
const POLYNOMIAL: [f64; 4] = [1.0, -2.0, 3.0, -1.0];

impl Parts {
    fn forcing(&self) -> Result<Forcing> {
        let [harmonic, polynomial, table] = self.changing;
        let mut forcing = Forcing::constant(self.load.to_vec())?;
        if self.changing == [[0.0; 3]; 3] {
            return Ok(forcing);
        }
        let (omega, cosine, sine) = HARMONIC;
        let (cosine, sine) = (harmonic.map(|x| x * cosine), harmonic.map(|x| x * sine));
        forcing = forcing.with_harmonic(omega, &cosine, &sine)?;
        forcing = forcing.with_polynomial(polynomial.to_vec(), POLYNOMIAL.to_vec())?;
        // A saw's teeth, five a second.
        let times = (0..20_000).map(|i| f64::from(i) * 0.1).collect();
        let values = (0..20_000).map(|i| f64::from(i % 2) - 0.5).collect();
        forcing.with_table(table.to_vec(), Table::new(times, values, Beyond::Zero)?)
    }

    fn run(&self, always: Piece, in_contact: Piece, duration: f64) -> History<Tampered> {
        let unit = |mode: usize| {
            (0..3)
                .map(|i| f64::from(u8::from(i == mode)))
                .collect::<Vec<_>>()
        };
        let rows = |matrix: [Local<f64>; 3]| matrix.iter().map(|row| row.to_vec()).collect();
        let system = ModalSystem::new(OMEGA2.to_vec(), self.damping.to_vec())
            .and_then(|system| system.with_coupling(rows(self.coupling)))
            .and_then(|system| system.with_circulatory(rows(self.circulatory)))
            .expect("a system");
        let law = Tampered {
            rows: [unit(0), unit(1), unit(2)],
            stop: Stop::new(unit(0), 1e-3, STIFFNESS, self.stop_damping).expect("a stop"),
            always,
            in_contact,
        };
        let forcing = self.forcing().expect("forces");
        let (rest, velocity) = (vec![0.0; 3], vec![-2.0, 0.7, 0.4]);
        let problem = Problem::new(system, vec![law], forcing, rest, velocity, duration);
        let problem = Arc::new(problem.expect("a problem"));
        simulate(&problem, Method::Exact, &mut |_| true).expect("a solution")
    }
}

fn times(matrix: [Local<f64>; 3], factor: f64) -> [Local<f64>; 3] {
    matrix.map(|row| row.map(|x| factor * x))
}

fn diagonal(entries: Local<f64>, factor: f64) -> [Local<f64>; 3] {
    let entry = |row: usize, column: usize| {
        if row == column {
            factor * entries[row]
        } else {
            0.0
        }
    };
    std::array::from_fn(|row| std::array::from_fn(|column| entry(row, column)))
}

#[test]
fn each_force_that_its_term_does_not_account_for_shows() {
    let honest = ALL.run(Piece::FREE, Piece::FREE, 2.0);
    assert!(honest.events().len() > 10);
    assert!(
        honest.energy_residual() < 1e-12,
        "{:e}",
        honest.energy_residual()
    );
    let part = 1e-6;
    let free = Piece::FREE;
    let mut spring = free;
    spring.stiffness[0][0] = part * STIFFNESS;
    spring.constant[0] = -part * STIFFNESS * 1e-3;
    let mut damper = free;
    damper.damping[0][0] = part * ALL.stop_damping;
    let mut elastic = free;
    elastic.stiffness = diagonal(OMEGA2, part);
    let mut modal = free;
    modal.damping = diagonal(ALL.damping, part);
    let coupling = Piece {
        damping: times(ALL.coupling, part),
        ..free
    };
    let circulatory = Piece {
        stiffness: times(ALL.circulatory, part),
        ..free
    };
    let load = Piece {
        constant: ALL.load.map(|x| part * x),
        ..free
    };
    let tampered = [
        ("elastic", elastic, free),
        ("modal damping", modal, free),
        ("coupled damping", coupling, free),
        ("circulatory", circulatory, free),
        ("load", load, free),
        ("spring of the stop", free, spring),
        ("damper of the stop", free, damper),
    ];
    for (name, always, in_contact) in tampered {
        let residual = ALL.run(always, in_contact, 2.0).energy_residual();
        assert!(residual > 1e-10, "{name}: {residual:e}");
    }
}

/// A loads' term cannot be tampered with from outside: its power is integrated again instead, by
/// the trapezoidal rule, as are those of the other terms.
#[test]
fn each_term_is_the_integral_of_its_power() {
    const STEPS: usize = 100_000;
    const DURATION: f64 = 0.5;
    let history = ALL.run(Piece::FREE, Piece::FREE, DURATION);
    let times: Vec<f64> = (0..=STEPS)
        .map(|i| i as f64 / STEPS as f64 * DURATION)
        .collect();
    let q = history.motion(&times, Derivative::Displacement).unwrap();
    let v = history.motion(&times, Derivative::Velocity).unwrap();
    let product = |matrix: &[Local<f64>; 3], x: &[f64], y: &[f64]| -> f64 {
        let entries = (0..3).flat_map(|i| (0..3).map(move |j| (i, j)));
        entries.map(|(i, j)| matrix[i][j] * x[i] * y[j]).sum()
    };
    let (mut modal, mut circulatory, mut loads) = (0.0, 0.0, 0.0);
    for (i, (q, v)) in q.chunks(3).zip(v.chunks(3)).enumerate() {
        let end = if i == 0 || i == STEPS { 0.5 } else { 1.0 };
        let part = end * DURATION / STEPS as f64;
        let mut forces = [0.0; 3];
        history.problem().forcing.at(times[i], &mut forces);
        loads += part * forces.iter().zip(v).map(|(p, v)| p * v).sum::<f64>();
        modal += part * product(&diagonal(ALL.damping, 1.0), v, v);
        modal += part * product(&ALL.coupling, v, v);
        circulatory -= part * product(&ALL.circulatory, v, q);
    }
    let ledger = &history.energy(&[DURATION]).unwrap()[0];
    let scale = ledger.scale();
    for (name, found, expected) in [
        ("modal", ledger.modal_dissipation, modal),
        ("circulatory", ledger.circulatory_work, circulatory),
        ("loads", ledger.load_work, loads),
    ] {
        assert!(
            expected.abs() > 1e-3 * scale,
            "{name}: {expected} of {scale}"
        );
        assert!(
            (found - expected).abs() < 1e-6 * scale,
            "{name}: {found} {expected}"
        );
    }
}

#[test]
fn ten_thousand_impacts_leave_rounding() {
    let undamped = Parts::default();
    let driven = Parts {
        coupling: [[0.0; 3]; 3],
        circulatory: [[0.0; 3]; 3],
        load: [-300.0, 20.0, 5.0],
        ..undamped
    };
    let skew = Parts {
        coupling: [[0.0, 3.0, -1.0], [-3.0, 0.0, 2.0], [1.0, -2.0, 0.0]],
        ..driven
    };
    let [harmonic, _, table] = ALL.changing;
    let shaken = Parts {
        changing: [harmonic, [0.0; 3], table],
        ..driven
    };
    for (name, parts, duration) in [
        ("undamped", undamped, 1400.0),
        ("under a load", driven, 750.0),
        ("gyroscopic", skew, 750.0),
        ("under loads that change", shaken, 750.0),
    ] {
        let history = parts.run(Piece::FREE, Piece::FREE, duration);
        let impacts = history.impacts(0).len();
        assert!(impacts > 10_000, "{name}: {impacts}");
        let residual = history.energy_residual();
        assert!(residual < 1e-11, "{name}: {residual:e}");
    }
}
