//! Times of the core on random variants of SDNL32, each solved once: medians in microseconds.
//!
//! `cargo bench -p bumpstop-core` prints them; `benchmarks/sdnl32.py` sets them beside peers.

use bumpstop_core::forcing::Forcing;
use bumpstop_core::history::{Derivative, History};
use bumpstop_core::law::Stop;
use bumpstop_core::method::fixed_step::Step;
use bumpstop_core::method::{Method, simulate};
use bumpstop_core::problem::Problem;
use bumpstop_core::system::ModalSystem;
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

const MODES: &str = include_str!("sdnl32_modes.txt");
const CASES: usize = 10_000;

fn columns() -> [Vec<f64>; 3] {
    let mut columns = [const { Vec::new() }; 3];
    for line in MODES.lines().filter(|line| !line.starts_with('#')) {
        for (column, word) in columns.iter_mut().zip(line.split_whitespace()) {
            column.push(word.parse().expect("a number"));
        }
    }
    columns
}

/// Weyl's sequence: equally spread, the same everywhere.
fn spread(n: usize, step: f64) -> f64 {
    (n as f64 * step).fract()
}

fn problem(n: usize) -> Arc<Problem<Stop>> {
    let [omega2, damping, tip] = columns();
    let stiffness = 5e3 + 95e3 * spread(n, 0.618_033_988_749_895);
    let rate = -6.0 + 5.0 * spread(n, 0.754_877_666_246_693);
    let mut velocity = vec![0.0; tip.len()];
    velocity[0] = rate * 0.783 / tip[0];
    let modes = omega2.len();
    let system = ModalSystem::new(omega2, damping).expect("a system");
    let stop = Stop::new(tip, 0.0, stiffness, 0.0).expect("a stop");
    let forcing = Forcing::constant(vec![0.0; modes]).expect("no forces");
    let rest = vec![0.0; modes];
    Arc::new(Problem::new(system, vec![stop], forcing, rest, velocity, 0.02).expect("a problem"))
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

fn time(
    problems: &[Arc<Problem<Stop>>],
    method: Method,
    read: impl Fn(&History<Stop>) -> f64,
) -> f64 {
    let run = |problem: &Arc<Problem<Stop>>| {
        let start = Instant::now();
        let history = simulate(problem, method, &mut |_| true).expect("a solution");
        black_box(read(&history));
        start.elapsed().as_secs_f64() * 1e6
    };
    median(problems.iter().map(run).collect())
}

fn main() {
    let problems: Vec<_> = (0..CASES).map(problem).collect();
    let nothing = |_: &History<Stop>| 0.0;
    let step = Step {
        dt: 1e-5,
        beyond_stability_limit: false,
    };
    let outputs: Vec<f64> = (1..=20).map(|n| f64::from(n) * 1e-3).collect();
    let [_, _, tip] = columns();
    let read_tip = |history: &History<Stop>| {
        history
            .project(&tip, &outputs, Derivative::Displacement)
            .expect("inside")[19]
    };

    let ledger = |h: &History<Stop>| read_tip(h) + h.energy_residual();
    let rows = [
        (
            "exact, integration alone",
            time(&problems, Method::Exact, nothing),
        ),
        ("exact", time(&problems, Method::Exact, read_tip)),
        (
            "exact + energy ledger",
            time(&problems, Method::Exact, ledger),
        ),
        (
            "central difference",
            time(&problems[..2000], Method::CentralDifference(step), read_tip),
        ),
        (
            "symplectic Euler",
            time(&problems[..2000], Method::SymplecticEuler(step), read_tip),
        ),
    ];
    for (name, microseconds) in rows {
        println!("{name}: {microseconds:.2}");
    }
}
