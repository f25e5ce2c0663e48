//! An exponential Runge-Kutta pair: each mode by its own exponential, all else explicit.
//!
//! With `y' = L y + n(t, y)`, L the stiffness and damping of each mode by itself and n the forces of
//! laws, loads and what couples modes, no step is too long for the modes, whatever their
//! frequencies: how fast n changes rules it. Five stages of stiff order four, at 0, 1/2, 1/2, 1 and
//! 1/2 of the step, with `phi_k` of the whole step and `phi_k'` of half of it, and n_i the stages:
//!
//! - `U2 = e^{hL/2} y + h/2 phi_1' n1`
//! - `U3 = U2 + h phi_2' (n2 - n1)`
//! - `U4 = e^{hL} y + h phi_1 n1 + h phi_2 (n2 + n3 - 2 n1)`
//! - `U5 = e^{hL/2} y + h/2 phi_1' n1 + h a (n2 + n3 - 2 n1) + h (phi_2' / 4 - a) (n4 - n1)`,
//!   `a = phi_2' / 2 - phi_3 + phi_2 / 4 - phi_3' / 2`
//! - `y1 = e^{hL} y + h phi_1 n1 + h phi_2 (4 n5 - 3 n1 - n4) + h phi_3 (4 n1 + 4 n4 - 8 n5)`
//!
//! The end is that of n on the parabola through n1, n5 and n4, which continues the motion inside the
//! step, at order three. Two other ends of order three are compared with it: that with the mean of n2
//! and n3 in the place of n5, which fall together to second order in the middle, and that of the
//! parabola through n1, n4 and n at a quarter of the step, which sees what changes with time alone.
//! The larger of the differences is the error estimate.
//!
//! Inside, the motion is kept as polynomials of degree five, as many as the modes that move need.
//!
//! Source: M. Hochbruck, A. Ostermann, Explicit exponential Runge-Kutta methods for semilinear
//! parabolic problems, SIAM Journal on Numerical Analysis 43, 1069-1090, 2005, formula (5.19).

mod inside;
mod phi;
mod propagators;

use super::control::{Control, Tolerances};
use super::pieces::Pieces;
use super::stepping::{Attempt, Stepping};
use crate::law::Law;
use crate::method::polynomial_steps::Equations;
use inside::{Inside, parabola};
use propagators::{Propagators, STAGES};

/// The method's name.
pub const NAME: &str = "exprk43";

/// The power of the step that the error estimate goes with.
const ERROR_ORDER: f64 = 4.0;

/// A step that may be less than this many times as wide as before keeps its width, whose
/// exponentials are known.
const WORTH_WHILE: f64 = 1.4;

/// The first stage alone.
const FIRST: [f64; STAGES] = [1.0, 0.0, 0.0, 0.0, 0.0];

/// The numbers at both ends of a step, and the stages between.
pub(super) struct Exponential {
    control: Control,
    start: Vec<f64>,
    end: Vec<f64>,
    /// Rates of all numbers at the start.
    rates: Vec<f64>,
    /// What the exponentials leave of the rates in each stage.
    stages: [Vec<f64>; STAGES],
    whole: Propagators,
    half: Propagators,
    quarter: Propagators,
    inner: Vec<f64>,
    errors: Vec<f64>,
    inside: Inside,
    pieces: Pieces,
}

impl Exponential {
    pub(super) fn new<L: Law>(
        tolerances: Tolerances,
        first_step: f64,
        start: Vec<f64>,
        equations: &Equations<'_, L>,
    ) -> Self {
        let room = || vec![0.0; start.len()];
        let layout = &equations.layout;
        Self {
            control: Control::new(tolerances, ERROR_ORDER, first_step, &start, layout),
            end: room(),
            rates: room(),
            stages: std::array::from_fn(|_| room()),
            whole: Propagators::default(),
            half: Propagators::default(),
            quarter: Propagators::default(),
            inner: room(),
            errors: vec![0.0; layout.works],
            inside: Inside::new(start.len()),
            pieces: Pieces::new(start.len()),
            start,
        }
    }

    /// Takes the stage that the inner numbers make at a time.
    fn look<L: Law>(&mut self, stage: usize, time: f64, equations: &mut Equations<'_, L>) {
        let stage = &mut self.stages[stage];
        equations.rates(time, &self.inner, stage);
        leave_forces(equations, &self.inner, stage);
    }

    /// Computes the stages and the end.
    fn step<L: Law>(&mut self, time: f64, h: f64, equations: &mut Equations<'_, L>) {
        let works = equations.layout.works;
        let middle = time + 0.5 * h;
        self.half.carry(&self.start, &mut self.inner[..works]);
        (self.half).push(1, &FIRST, &self.stages, &mut self.inner[..works]);
        self.look(1, middle, equations);
        let second = [-2.0, 2.0, 0.0, 0.0, 0.0];
        (self.half).push(2, &second, &self.stages, &mut self.inner[..works]);
        self.look(2, middle, equations);
        self.whole.carry(&self.start, &mut self.inner[..works]);
        let second = [-2.0, 1.0, 1.0, 0.0, 0.0];
        for (k, weights) in [(1, &FIRST), (2, &second)] {
            (self.whole).push(k, weights, &self.stages, &mut self.inner[..works]);
        }
        self.look(3, time + h, equations);
        self.half.carry(&self.start, &mut self.inner[..works]);
        let second = [-1.5, 1.0, 1.0, -0.5, 0.0];
        let third = [1.0, -1.0, -1.0, 1.0, 0.0];
        for (k, weights) in [(1, &FIRST), (2, &second), (3, &third)] {
            (self.half).push(k, weights, &self.stages, &mut self.inner[..works]);
        }
        let second = third.map(|weight| -0.25 * weight);
        for (k, weights) in [(2, &second), (3, &third)] {
            (self.whole).push(k, weights, &self.stages, &mut self.inner[..works]);
        }
        self.look(4, middle, equations);
        self.whole.carry(&self.start, &mut self.end[..works]);
        let (second, third) = ([-3.0, 0.0, 0.0, -1.0, 4.0], [4.0, 0.0, 0.0, 4.0, -8.0]);
        for (k, weights) in [(1, &FIRST), (2, &second), (3, &third)] {
            (self.whole).push(k, weights, &self.stages, &mut self.end[..works]);
        }
    }

    /// Takes, in the place of the third stage, what the parabola misses at a quarter of the step.
    fn look_between<L: Law>(&mut self, time: f64, h: f64, equations: &mut Equations<'_, L>) {
        let works = equations.layout.works;
        self.quarter.carry(&self.start, &mut self.inner[..works]);
        for (k, weights) in parabola(0.0, 0.25).iter().enumerate() {
            (self.quarter).push(k + 1, weights, &self.stages, &mut self.inner[..works]);
        }
        self.look(2, time + 0.25 * h, equations);
        let [expected, ..] = parabola(0.25, 0.0);
        for i in 0..works {
            let both = expected.iter().zip(&self.stages);
            let told: f64 = both.map(|(weight, stage)| weight * stage[i]).sum();
            self.stages[2][i] -= told;
        }
    }

    /// The estimate of the error over what is allowed.
    fn error<L: Law>(&mut self, time: f64, h: f64, equations: &mut Equations<'_, L>) -> f64 {
        (self.control).measure(&self.stages, (time + h, &self.end), equations);
        let middle = self.difference([0.0, -0.5, -0.5, 0.0, 1.0].map(|weight| 4.0 * weight));
        self.look_between(time, h, equations);
        let between = self.difference([0.0, 0.0, 16.0 / 3.0, 0.0, 0.0]);
        // A number that is none is the larger.
        if middle > between || middle.is_nan() {
            middle
        } else {
            between
        }
    }

    /// The difference that some stages make of the end, on a parabola that is zero at both ends,
    /// over what is allowed.
    fn difference(&mut self, weights: [f64; STAGES]) -> f64 {
        self.errors.fill(0.0);
        let twice = weights.map(|weight| -2.0 * weight);
        for (k, weights) in [(2, &weights), (3, &twice)] {
            (self.whole).push(k, weights, &self.stages, &mut self.errors);
        }
        self.control.largest(&self.errors)
    }
}

impl<L: Law> Stepping<L> for Exponential {
    fn degree(&self) -> usize {
        inside::DEGREE
    }

    fn numbers(&mut self) -> &mut Vec<f64> {
        &mut self.start
    }

    fn see(&mut self, motion: &[f64]) {
        self.control.see(motion);
    }

    fn start(&mut self, time: f64, equations: &mut Equations<'_, L>) {
        equations.rates(time, &self.start, &mut self.rates);
        self.stages[0].copy_from_slice(&self.rates);
        leave_forces(equations, &self.start, &mut self.stages[0]);
    }

    fn attempt(&mut self, time: f64, h: f64, equations: &mut Equations<'_, L>) -> Attempt {
        self.whole.turn(h, &equations.problem.system);
        self.half.turn(0.5 * h, &equations.problem.system);
        self.quarter.turn(0.25 * h, &equations.problem.system);
        self.step(time, h, equations);
        let error = self.error(time, h, equations);
        match self.control.judge(h, error, &self.end) {
            Attempt::Good(next) if (h..WORTH_WHILE * h).contains(&next) => Attempt::Good(h),
            attempt => attempt,
        }
    }

    fn follow(&mut self, time: f64, h: f64, equations: &mut Equations<'_, L>) {
        let step = inside::Step {
            time,
            h,
            start: [&self.start, &self.rates],
            stages: &self.stages,
            scales: self.control.scales(),
        };
        (self.inside).follow(&step, &mut self.end, equations, &mut self.pieces);
    }

    fn pieces(&self) -> &Pieces {
        &self.pieces
    }

    fn go_on(&mut self) {
        std::mem::swap(&mut self.start, &mut self.end);
        self.inside.go_on(&mut self.rates, &mut self.stages[0]);
    }

    fn stop_at(&mut self, piece: usize, theta: f64) {
        self.pieces.dense(piece).at(theta, &mut self.start);
    }
}

/// Takes what the exponentials do off the rates of numbers.
fn leave_forces<L: Law>(equations: &Equations<'_, L>, numbers: &[f64], rates: &mut [f64]) {
    let system = &equations.problem.system;
    let modes = equations.layout.modes;
    let [q, v] = equations.layout.motion(numbers);
    let own = system.omega2().iter().zip(system.damping());
    rates[..modes].fill(0.0);
    for ((n, (w2, c)), (q, v)) in rates[modes..].iter_mut().zip(own).zip(q.iter().zip(v)) {
        *n += w2 * q + c * v;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::forcing::Forcing;
    use crate::law::{HertzStop, Law};
    use crate::method::polynomial_steps::Layout;
    use crate::problem::Problem;
    use crate::system::ModalSystem;

    /// A slow, a fast and an overdamped mode on a smooth contact that stays closed.
    fn problem() -> Problem<HertzStop> {
        let row = vec![1.0, 0.7, -0.4];
        Problem::new(
            ModalSystem::new(vec![4.0, 1e4, 100.0], vec![0.1, 0.5, 60.0]).unwrap(),
            vec![HertzStop::new(row, -1.0, 30.0, 1.5, 0.2).unwrap()],
            Forcing::constant(vec![0.3, -2.0, 1.0]).unwrap(),
            vec![-0.1, 0.01, 0.02],
            vec![0.3, 0.2, -0.1],
            1.0,
        )
        .unwrap()
    }

    /// End, and error estimate, of some equal steps.
    fn march(steps: usize) -> [Vec<f64>; 2] {
        let problem = problem();
        let mut equations = Equations::new(&problem, Layout::new(&problem));
        let closed =
            problem.laws[0].sampled_state(crate::law::State::FIRST, &[-1.0, 0.0, 0.0], &[0.0; 3]);
        equations.take_states(&[closed]);
        equations.loads.turn(0.0);
        let mut numbers = vec![0.0; equations.layout.size()];
        numbers[..3].copy_from_slice(&problem.displacement);
        numbers[3..6].copy_from_slice(&problem.velocity);
        let tolerances = Tolerances {
            relative: 0.5,
            absolute: None,
            exact_flights: false,
        };
        let mut formula = Exponential::new(tolerances, 0.1, numbers, &equations);
        let h = 0.4 / steps as f64;
        let mut estimate = Vec::new();
        for n in 0..steps {
            let time = n as f64 * h;
            formula.start(time, &mut equations);
            formula.attempt(time, h, &mut equations);
            if n == 0 {
                estimate.clone_from(&formula.errors);
            }
            formula.follow(time, h, &mut equations);
            Stepping::<HertzStop>::go_on(&mut formula);
        }
        [formula.start.clone(), estimate]
    }

    #[test]
    fn steps_that_the_fast_mode_turns_far_in_converge_at_order_four() {
        let [exact, _] = march(4096);
        let error = |steps: usize| {
            let [found, estimate] = march(steps);
            let both = found[..6].iter().zip(&exact);
            let worst = both.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            [worst, estimate.iter().fold(0.0f64, |m, e| m.max(e.abs()))]
        };
        // The fast mode turns by 1.25 and 0.6 radians a step.
        let [coarse, fine] = [error(32), error(64)];
        assert!(coarse[0] < 1e-3, "{coarse:?}");
        assert!((coarse[0] / fine[0]).log2() > 3.7, "{coarse:?} {fine:?}");
        assert!((coarse[1] / fine[1]).log2() > 3.5, "{coarse:?} {fine:?}");
        // That of one step, of the error that all steps make.
        assert!(coarse[1] > coarse[0] / 64.0, "{coarse:?}");
    }
}
