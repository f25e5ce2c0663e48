//! Loads that change in time, against the matrix exponential of the system with the loads' own
//! generators appended: `w' = [A P; 0 S] w`.

use bumpstop_core::error::Error;
use bumpstop_core::forcing::{Beyond, Forcing, Table};
use bumpstop_core::history::{Derivative, History};
use bumpstop_core::law::Stop;
use bumpstop_core::method::fixed_step::Step;
use bumpstop_core::method::{Method, simulate};
use bumpstop_core::problem::Problem;
use bumpstop_core::system::ModalSystem;
use proptest::prelude::*;
use std::sync::Arc;

const MODES: usize = 3;

/// A load along a modal vector.
#[derive(Debug, Clone)]
enum Load {
    Polynomial([f64; MODES], Vec<f64>),
    Harmonic(f64, [f64; MODES], [f64; MODES]),
    Table([f64; MODES], Vec<(f64, f64)>),
}

#[derive(Debug, Clone)]
struct Case {
    omega2: [f64; MODES],
    damping: [f64; MODES],
    /// What is added to the damping, of any symmetry, so that modes share exponents.
    coupling: Option<[[f64; MODES]; MODES]>,
    /// Row, stiffness and damping of a stop that stays closed.
    stop: Option<([f64; MODES], f64, f64)>,
    constant: [f64; MODES],
    loads: Vec<Load>,
    q: [f64; MODES],
    v: [f64; MODES],
    duration: f64,
}

/// How deep the closed stop is, so that it stays so.
const DEPTH: f64 = 1e3;

impl Case {
    fn problem(&self) -> Arc<Problem<Stop>> {
        let mut system = ModalSystem::new(self.omega2.into(), self.damping.into()).unwrap();
        if let Some(matrix) = self.coupling {
            system = system.with_coupling(matrix.map(Vec::from).into()).unwrap();
        }
        let (row, gap, k, c) = match self.stop {
            Some((row, k, c)) => (row, -DEPTH, k, c),
            None => ([1.0, 0.0, 0.0], 1e9, 1.0, 0.0),
        };
        let stop = Stop::new(row.into(), gap, k, c).unwrap();
        let preload = if gap < 0.0 { k * gap } else { 0.0 };
        let constant = (0..MODES).map(|i| self.constant[i] + preload * row[i]);
        let mut forcing = Forcing::constant(constant.collect()).unwrap();
        for load in &self.loads {
            forcing = match load.clone() {
                Load::Polynomial(along, c) => forcing.with_polynomial(along.into(), c),
                Load::Harmonic(omega, cosine, sine) => forcing.with_harmonic(omega, &cosine, &sine),
                Load::Table(along, knots) => {
                    let (times, values) = knots.into_iter().unzip();
                    let table = Table::new(times, values, Beyond::Zero).unwrap();
                    forcing.with_table(along.into(), table)
                }
            }
            .unwrap();
        }
        let (q, v) = (self.q.into(), self.v.into());
        Arc::new(Problem::new(system, vec![stop], forcing, q, v, self.duration).unwrap())
    }

    fn run(&self, method: Method) -> Result<History<Stop>, Error> {
        simulate(&self.problem(), method, &mut |_| true)
    }

    /// Displacements and velocities at a time.
    fn expected(&self, time: f64) -> Vec<f64> {
        let mut instants = vec![0.0, time];
        for load in &self.loads {
            if let Load::Table(_, knots) = load {
                instants.extend(knots.iter().map(|k| k.0).filter(|t| *t > 0.0 && *t < time));
            }
        }
        instants.sort_by(f64::total_cmp);
        let mut state: Vec<f64> = self.q.iter().chain(&self.v).copied().collect();
        for pair in instants.windows(2) {
            state = self.stretch(&state, pair[0], pair[1] - pair[0]);
        }
        state
    }

    /// The state after a time in which no table has a knot.
    fn stretch(&self, state: &[f64], start: f64, length: f64) -> Vec<f64> {
        const N: usize = MODES;
        let (row, k, c) = self.stop.unwrap_or(([0.0; N], 0.0, 0.0));
        // Rows of the augmented matrix: positions, velocities, then what the loads add.
        let mut matrix = vec![vec![0.0; 2 * N]; 2 * N];
        for i in 0..N {
            matrix[i][N + i] = 1.0;
            matrix[N + i][i] -= self.omega2[i];
            matrix[N + i][N + i] -= self.damping[i];
            for j in 0..N {
                matrix[N + i][j] -= k * row[i] * row[j];
                matrix[N + i][N + j] -= c * row[i] * row[j];
                matrix[N + i][N + j] -= self.coupling.map_or(0.0, |matrix| matrix[i][j]);
            }
        }
        let mut vector = state.to_vec();
        let mut append = |along: &[f64; N], value: f64| {
            for line in &mut matrix {
                line.push(0.0);
            }
            for i in 0..N {
                *matrix[N + i].last_mut().unwrap() = along[i];
            }
            let width = matrix[0].len();
            matrix.push(vec![0.0; width]);
            vector.push(value);
            matrix.len() - 1
        };
        append(&self.constant, 1.0);
        let mut rates = Vec::new();
        for load in &self.loads {
            match load {
                Load::Harmonic(omega, cosine, sine) => {
                    let a = append(cosine, (omega * start).cos());
                    let b = append(sine, (omega * start).sin());
                    rates.extend([(a, b, -omega), (b, a, *omega)]);
                }
                Load::Polynomial(along, c) => {
                    // f and its derivatives, each the rate of the one before.
                    for order in 0..c.len() {
                        let value = (order..c.len()).rev().fold(0.0, |value, n| {
                            let ratio: f64 = (n - order + 1..=n).map(|m| m as f64).product();
                            value * start + c[n] * ratio
                        });
                        let at = append(if order == 0 { along } else { &[0.0; N] }, value);
                        if order > 0 {
                            rates.push((at - 1, at, 1.0));
                        }
                    }
                }
                Load::Table(along, knots) => {
                    let middle = start + 0.5 * length;
                    let after = knots.partition_point(|knot| knot.0 <= middle);
                    if after > 0 && after < knots.len() {
                        let ((a, f), (b, g)) = (knots[after - 1], knots[after]);
                        let slope = (g - f) / (b - a);
                        let at = append(along, f + slope * (start - a));
                        append(&[0.0; N], slope);
                        rates.push((at, at + 1, 1.0));
                    }
                }
            }
        }
        let size = matrix.len();
        for line in &mut matrix {
            line.resize(size, 0.0);
        }
        for (line, column, rate) in rates {
            matrix[line][column] = rate;
        }
        flow(&matrix, &vector, length)[..2 * N].to_vec()
    }
}

/// `exp(A t) w` by Taylor's series over short steps.
fn flow(matrix: &[Vec<f64>], vector: &[f64], t: f64) -> Vec<f64> {
    let norm = (matrix.iter())
        .map(|line| line.iter().map(|x| x.abs()).sum::<f64>())
        .fold(0.0, f64::max);
    let steps = (norm * t).ceil().max(1.0);
    let h = t / steps;
    let mut state = vector.to_vec();
    for _ in 0..steps as usize {
        let mut term = state.clone();
        for n in 1..25 {
            let next = matrix.iter().map(|line| {
                let product: f64 = line.iter().zip(&term).map(|(a, x)| a * x).sum();
                product * h / f64::from(n)
            });
            term = next.collect();
            for (total, term) in state.iter_mut().zip(&term) {
                *total += term;
            }
        }
    }
    state
}

/// What loads of order one move in times of order one: motions that are smaller are what is left
/// of such, and are right to its rounding.
const MOVED: f64 = 0.1;

/// How well the ledger closes.
const CLOSED: f64 = 1e-11;

fn check(case: &Case, tolerance: f64) -> Result<(), TestCaseError> {
    let history = case.run(Method::Exact).unwrap();
    let fractions = [0.0, 0.13, 0.5, 0.77, 1.0];
    let times = fractions.map(|part| part * case.duration);
    let expected: Vec<_> = times.iter().map(|t| case.expected(*t)).collect();
    // A closed stop is measured from its obstacle, which is DEPTH away: a soft mode is pushed by the
    // small difference of the stop's force, up to 60 DEPTH, and the load that presses it. Rounding
    // of these two, in a second or two, moves it by some 1e-14 of their 6e4 N.
    let moved = if case.stop.is_some() {
        3e-2 * DEPTH
    } else {
        MOVED
    };
    let sizes: Vec<f64> = [0..MODES, MODES..2 * MODES]
        .map(|part| {
            let all = expected.iter().flat_map(|state| &state[part.clone()]);
            all.fold(moved, |m: f64, x| m.max(x.abs()))
        })
        .into();
    for (order, size) in [Derivative::Displacement, Derivative::Velocity]
        .into_iter()
        .zip(sizes)
    {
        let found = history.motion(&times, order).unwrap();
        for (row, state) in found.chunks(MODES).zip(&expected) {
            for (a, b) in row.iter().zip(&state[order as usize * MODES..]) {
                prop_assert!((a - b).abs() < tolerance * size, "{order:?}: {a} {b}");
            }
        }
    }
    // The ledger is measured by its own largest energy, which may be as little as one likes.
    if expected.iter().flatten().any(|x| x.abs() >= MOVED) {
        let residual = history.energy_residual();
        prop_assert!(residual < CLOSED, "energy residual {residual:e}");
    }
    Ok(())
}

fn vector() -> impl Strategy<Value = [f64; MODES]> {
    prop::array::uniform3(-1.0f64..1.0)
}

fn knots() -> impl Strategy<Value = Vec<(f64, f64)>> {
    prop::collection::vec((0.01f64..0.8, -1.0f64..1.0), 2..9).prop_map(|steps| {
        let mut time = -0.3;
        (steps.into_iter())
            .map(|(step, value)| {
                time += step;
                (time, value)
            })
            .collect()
    })
}

fn load() -> impl Strategy<Value = Load> {
    prop_oneof![
        (vector(), prop::collection::vec(-1.0f64..1.0, 1..=6))
            .prop_map(|(along, c)| Load::Polynomial(along, c)),
        (0.05f64..12.0, vector(), vector()).prop_map(|(w, c, s)| Load::Harmonic(w, c, s)),
        (vector(), knots()).prop_map(|(along, knots)| Load::Table(along, knots)),
    ]
}

/// Frequencies and damping of a mode: any, rigid, coasting, nearly critical, overdamped, slow.
fn mode() -> impl Strategy<Value = (f64, f64)> {
    prop_oneof![
        4 => (0.5f64..8.0, 0.0f64..0.3).prop_map(|(w, xi)| (w * w, 2.0 * xi * w)),
        1 => Just((0.0, 0.0)),
        1 => (0.3f64..3.0).prop_map(|c| (0.0, c)),
        1 => (0.8f64..5.0, 1.0f64..1.00001).prop_map(|(w, xi)| (w * w, 2.0 * xi * w)),
        1 => (1.0f64..4.0, 1.2f64..2.0).prop_map(|(w, xi)| (w * w, 2.0 * xi * w)),
        1 => (0.01f64..0.1, 0.0f64..0.1).prop_map(|(w, c)| (w * w, c)),
    ]
}

fn case() -> impl Strategy<Value = Case> {
    (
        prop::array::uniform3(mode()),
        prop::collection::vec(load(), 1..4),
        vector(),
        vector(),
        vector(),
        0.5f64..4.0,
    )
        .prop_map(|(modes, loads, constant, q, v, duration)| Case {
            omega2: modes.map(|m| m.0),
            damping: modes.map(|m| m.1),
            coupling: None,
            stop: None,
            constant,
            loads,
            q,
            v,
            duration,
        })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn modes_by_themselves_follow_any_loads(case in case()) {
        check(&case, 3e-11)?;
    }

    #[test]
    fn modes_behind_a_closed_stop_follow_any_loads(
        case in case(), row in prop::array::uniform3(0.3f64..1.0), w in 1.0f64..5.0,
        stiffness in 5.0f64..60.0, damping in prop_oneof![Just(0.0), 0.0f64..3.0],
    ) {
        // What is stiff enough keeps the stop closed.
        let ([a, b, _], [c, d, _]) = (case.omega2, case.damping);
        let case = Case {
            omega2: [a, b, 7.0 + w],
            damping: [c, d, 0.1],
            stop: Some((row, stiffness, damping)),
            ..case
        };
        check(&case, 1e-10)?;
    }

    #[test]
    fn coupled_modes_follow_any_loads(case in case(), along in vector(), spin in -2.0f64..2.0) {
        let mut matrix = [[0.0; MODES]; MODES];
        for i in 0..MODES {
            for j in 0..MODES {
                matrix[i][j] = along[i] * along[j];
            }
        }
        matrix[0][1] += spin;
        matrix[1][0] -= spin;
        let case = Case { coupling: Some(matrix), ..case };
        check(&case, 1e-10)?;
    }

    #[test]
    fn a_damped_rigid_body_is_shaken(
        case in case(), c in prop_oneof![0.001f64..3.0, 3.0f64..300.0], d in 0.0f64..3.0,
        along in vector(), omega in prop_oneof![1e-9f64..1e-3, 1e-3f64..1.0],
        cosine in vector(), sine in vector(),
    ) {
        let mut matrix = [[0.0; MODES]; MODES];
        for i in 0..MODES {
            for j in 0..MODES {
                matrix[i][j] = c * along[i] * along[j];
            }
            matrix[i][i] += d;
        }
        let mut case = Case { omega2: [0.0; MODES], damping: [0.0; MODES], coupling: Some(matrix), ..case };
        case.loads.push(Load::Harmonic(omega, cosine, sine));
        check(&case, 1e-10)?;
    }

    #[test]
    fn loads_that_resonate_with_equal_exponents_are_followed(
        case in case(), w in 1.0f64..8.0, xi in prop_oneof![Just(0.0), Just(1.0), 0.0f64..0.01],
        shift in prop_oneof![Just(0.0), -1e-3f64..1e-3], along in vector(),
        cosine in vector(), sine in vector(),
    ) {
        // Nearly alike modes with a little of a common damper have nearly parallel shapes.
        let mut matrix = [[0.0; MODES]; MODES];
        for i in 0..MODES {
            for j in 0..MODES {
                matrix[i][j] = 1e-6 * along[i] * along[j];
            }
        }
        matrix[0][1] += 1e-3;
        let mut case = Case {
            omega2: [w * w, w * w * (1.0 + 1e-9), case.omega2[2]],
            damping: [2.0 * xi * w, 2.0 * xi * w, case.damping[2]],
            coupling: Some(matrix),
            ..case
        };
        case.loads.push(Load::Harmonic(w + shift, cosine, sine));
        check(&case, 1e-10)?;
    }

    #[test]
    fn resonance_is_exact(
        case in case(), mode in 0..MODES, shift in prop_oneof![Just(0.0), -0.3f64..0.3, -1e-7f64..1e-7],
        xi in prop_oneof![Just(0.0), 0.0f64..1e-3], cosine in vector(), sine in vector(),
    ) {
        let mut case = case;
        let w = case.omega2[mode].max(0.5).sqrt();
        case.omega2[mode] = w * w;
        case.damping[mode] = 2.0 * xi * w;
        case.loads.push(Load::Harmonic(w + shift / case.duration, cosine, sine));
        check(&case, 3e-11)?;
    }

    #[test]
    fn resonance_behind_a_closed_stop_is_exact(
        omega in prop::array::uniform3(1.0f64..6.0), row in prop::array::uniform3(0.3f64..1.0),
        stiffness in 5.0f64..60.0, number in 0..MODES, cosine in vector(), sine in vector(),
        q in vector(), v in vector(),
    ) {
        let mut omega2 = omega.map(|w| w * w);
        omega2.sort_by(f64::total_cmp);
        prop_assume!(omega2[0] * 1.1 < omega2[1] && omega2[1] * 1.1 < omega2[2]);
        let mut case = Case {
            omega2, damping: [0.0; MODES], coupling: None, stop: Some((row, stiffness, 0.0)),
            constant: [0.0; MODES], loads: vec![], q, v, duration: 5.0,
        };
        // The frequency of the closed structure between two poles, or above the last.
        let f = |s: f64| 1.0 + (0..MODES)
            .map(|i| stiffness * row[i] * row[i] / (omega2[i] - s)).sum::<f64>();
        let mut low = omega2[number];
        let mut high = omega2.get(number + 1).copied().unwrap_or(omega2[2] + 3.0 * stiffness);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if f(middle) < 0.0 { low = middle } else { high = middle }
        }
        case.loads.push(Load::Harmonic(low.sqrt(), cosine, sine));
        check(&case, 1e-10)?;
    }
}

/// An undamped oscillator driven at its own frequency from rest: `x = t sin(w t) / (2 w)`.
#[test]
fn an_undamped_oscillator_grows_without_end() {
    let case = Case {
        omega2: [9.0, 1.0, 4.0],
        damping: [0.0; MODES],
        coupling: None,
        stop: None,
        constant: [0.0; MODES],
        loads: vec![Load::Harmonic(3.0, [1.0, 0.0, 0.0], [0.0; MODES])],
        q: [0.0; MODES],
        v: [0.0; MODES],
        duration: 200.0,
    };
    let history = case.run(Method::Exact).unwrap();
    for n in 1..=50 {
        let t = 4.0 * f64::from(n);
        let found = history.motion(&[t], Derivative::Displacement).unwrap()[0];
        assert!((found - t * (3.0 * t).sin() / 6.0).abs() < 2e-13 * t);
        let found = history.project(&[1.0, 0.0, 0.0], &[t], Derivative::Acceleration);
        let exact = (3.0 * t).cos() - 1.5 * t * (3.0 * t).sin();
        assert!((found.unwrap()[0] - exact).abs() < 3e-12 * t);
    }
}

#[test]
fn fixed_steps_converge_at_their_order() {
    let case = Case {
        omega2: [4.0, 9.0, 30.0],
        damping: [0.1, 0.0, 0.4],
        coupling: None,
        stop: None,
        constant: [0.3, 0.0, 0.0],
        loads: vec![
            Load::Harmonic(2.5, [1.0, 0.5, 0.0], [0.0, 0.3, 0.2]),
            Load::Polynomial([0.2, 0.1, 1.0], vec![0.0, 1.0, -0.5, 0.1]),
            Load::Table([1.0, 1.0, 1.0], vec![(0.0, 1.0), (0.5, -1.0), (1.0, 0.0)]),
        ],
        q: [0.1, 0.0, 0.2],
        v: [0.0, 1.0, 0.0],
        duration: 2.0,
    };
    let expected = case.expected(2.0);
    let error = |method: fn(Step) -> Method, dt: f64| {
        let history = case
            .run(method(Step {
                dt,
                beyond_stability_limit: false,
            }))
            .unwrap();
        let found = history.motion(&[2.0], Derivative::Displacement).unwrap();
        let errors = found.iter().zip(&expected).map(|(a, b)| (a - b).abs());
        errors.fold(0.0, f64::max)
    };
    for (method, order) in [
        (Method::SymplecticEuler as fn(Step) -> Method, 1.0),
        (Method::CentralDifference, 2.0),
    ] {
        // The knots lie on the steps, and nothing jumps.
        let ratio = error(method, 1e-3) / error(method, 5e-4);
        assert!((ratio.log2() - order).abs() < 0.1, "{ratio}");
    }
}
