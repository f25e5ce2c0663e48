//! The modal exponential scheme: each mode exactly, under loads that change linearly over a step and
//! forces of laws that are held at the mean of both its ends.
//!
//! Second order in what laws and loads do; exact for a linear structure under loads that are
//! constant or linear in each step, whatever the step. The forces of laws at the end of a step are
//! part of what is solved for.
//!
//! Any step is stable among springs, however stiff, that neither open nor close. A force f that is
//! held does the work `f (x1 - x)` on a structure that goes exactly; where f is `-k (x + x1) / 2`
//! that is what the springs give, `k (x x - x1 x1) / 2`, so that the energy of both does not
//! grow. (Forces of laws that change linearly, as loads do, would be stable no further than to
//! `h omega = 2 sqrt(3)`, and not even there beside a mode that turns by nearly pi in a step.) A
//! damper takes `c (v + v1) (x1 - x) / 2`, which is not negative in any mode that turns by less than pi
//! in a step: a faster one turns back between the instants at which its rate is seen.
//!
//! Source: J. Certaine, The solution of ordinary differential equations with large time constants,
//! in Mathematical Methods for Digital Computers, 1960, with the linear interpolation of the force;
//! the integrals of the exponentials from one of a larger matrix: C. F. Van Loan, Computing
//! integrals involving the matrix exponential, IEEE Transactions on Automatic Control 23, 395-404,
//! 1978.

use super::laws::{Laws, Pushes, rows};
use super::structure::resist;
use super::{Motion, Scheme};
use crate::error::Result;
use crate::law::Law;
use crate::method::fixed_step::laws_damping;
use crate::problem::Problem;
use crate::system::ModalSystem;
use std::f64::consts::PI;

/// The method's name.
pub const NAME: &str = "exponential";

/// Largest step at which all modes turn by no more than half a circle, in s, where laws damp; infinite
/// where none does.
pub(super) fn stability_limit<L: Law>(system: &ModalSystem, laws: &[L]) -> f64 {
    if laws_damping(laws) > 0.0 {
        PI / system.highest_frequency()
    } else {
        f64::INFINITY
    }
}

/// Size below which the matrix is halved down, and terms of its series.
const SMALL: f64 = 0.5;
const TERMS: usize = 18;

type Matrix = [[f64; 4]; 4];

/// How a mode goes on: what displacement, velocity and the forces at both ends make of
/// displacement and velocity.
#[derive(Debug, Clone, Copy)]
struct Propagator([[f64; 4]; 2]);

impl Propagator {
    /// Over a step of width h. The unknowns are q, v / s, the force, and its change; s makes the
    /// first two alike.
    fn new(omega2: f64, damping: f64, h: f64) -> Self {
        let s = omega2.abs().sqrt().max(1.0 / h);
        let exp = exponential([
            [0.0, s * h, 0.0, 0.0],
            [-omega2 / s * h, -damping * h, h / s, 0.0],
            [0.0, 0.0, 0.0, 1.0],
            [0.0; 4],
        ]);
        let row = |row: usize, unit: f64| {
            let [q, v, force, change] = exp[row].map(|x| unit * x);
            [q, v / s, force - change, change]
        };
        Self([row(0, 1.0), row(1, s)])
    }

    /// What a force at either end makes of displacement or velocity, which acts with half of it all
    /// along.
    fn of_mean(&self, order: usize) -> f64 {
        let [_, _, first, last] = self.0[order];
        0.5 * (first + last)
    }

    fn go(&self, from: [f64; 4]) -> [f64; 2] {
        self.0
            .map(|row| row.iter().zip(from).map(|(a, x)| a * x).sum())
    }
}

/// The exponential of a matrix, by its series after halving and by squaring back.
fn exponential(mut matrix: Matrix) -> Matrix {
    let sums = matrix.map(|row| row.iter().map(|x| x.abs()).sum::<f64>());
    let size = sums.into_iter().fold(0.0, f64::max);
    let halvings = (size / SMALL).log2().ceil().max(0.0) as i32;
    let scale = 0.5f64.powi(halvings);
    for x in matrix.as_flattened_mut() {
        *x *= scale;
    }
    let unit: Matrix = std::array::from_fn(|i| std::array::from_fn(|j| f64::from(i == j)));
    let mut sum = unit;
    // Horner's rule: 1 + M (1 + M/2 (1 + M/3 (...))).
    for term in (1..=TERMS).rev() {
        sum = product(&matrix, &sum);
        for (i, row) in sum.iter_mut().enumerate() {
            for x in row.iter_mut() {
                *x /= term as f64;
            }
            row[i] += 1.0;
        }
    }
    for _ in 0..halvings {
        sum = product(&sum, &sum);
    }
    sum
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let entry = |i: usize, j: usize| (0..4).map(|k| a[i][k] * b[k][j]).sum();
    std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)))
}

/// The scheme for one problem and step.
pub(super) struct Exponential<'a, L> {
    problem: &'a Problem<L>,
    propagators: Vec<Propagator>,
    /// Modal displacements and velocities that unit forces of the laws at an end give.
    kicks: [Vec<Vec<f64>>; 2],
    pushes: Pushes,
    /// Modal loads at both ends, with half the forces of the laws at the start.
    forces: [Vec<f64>; 2],
}

impl<'a, L: Law> Exponential<'a, L> {
    pub(super) fn new(problem: &'a Problem<L>, h: f64) -> Self {
        let system = &problem.system;
        let modes = system.omega2().iter().zip(system.damping());
        let propagators: Vec<Propagator> =
            modes.map(|(w2, c)| Propagator::new(*w2, *c, h)).collect();
        let kicks = [0, 1].map(|order: usize| {
            let kick = |row: &[f64]| -> Vec<f64> {
                let both = row.iter().zip(&propagators);
                both.map(|(r, propagator)| r * propagator.of_mean(order))
                    .collect()
            };
            rows(&problem.laws).map(kick).collect::<Vec<_>>()
        });
        let zeros = || vec![0.0; system.modes()];
        Self {
            problem,
            pushes: Pushes::new(&problem.laws, &kicks[0], &kicks[1]),
            kicks,
            propagators,
            forces: [zeros(), zeros()],
        }
    }
}

impl<L: Law> Scheme<L> for Exponential<'_, L> {
    fn step(
        &mut self,
        [start, end]: [f64; 2],
        motion: &mut Motion,
        laws: &mut Laws<'_, L>,
    ) -> Result<()> {
        let [before, after] = &mut self.forces;
        self.problem.forcing.at(start, before);
        self.problem.forcing.at(end, after);
        let Motion { q, v, a } = motion;
        a.copy_from_slice(after);
        laws.add_forces(0.5, before);
        laws.add_forces(0.5, after);
        for (i, propagator) in self.propagators.iter().enumerate() {
            [q[i], v[i]] = propagator.go([q[i], v[i], before[i], after[i]]);
        }
        laws.meet(&self.pushes, end, q, v)?;
        laws.push(&self.kicks[0], 1.0, q);
        laws.push(&self.kicks[1], 1.0, v);
        laws.add_forces(1.0, a);
        resist(&self.problem.system, q, v, a);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against closed forms: a rigid mode, an oscillator, one with damping of twice the critical.
    #[test]
    fn a_mode_goes_on_as_the_closed_forms_say() {
        let h = 0.7f64;
        let rigid = Propagator::new(0.0, 0.0, h).0;
        let expected = [
            [1.0, h, h * h / 3.0, h * h / 6.0],
            [0.0, 1.0, h / 2.0, h / 2.0],
        ];
        assert_close(rigid, expected);
        for omega in [3.0, 400.0f64] {
            let (sin, cos) = (omega * h).sin_cos();
            let sine = sin / omega;
            let [held, slope] = [
                (1.0 - cos) / omega.powi(2),
                (h - sine) / (h * omega.powi(2)),
            ];
            let [held_rate, slope_rate] = [sine, (1.0 - cos) / (h * omega.powi(2))];
            let expected = [
                [cos, sine, held - slope, slope],
                [-omega * sin, cos, held_rate - slope_rate, slope_rate],
            ];
            assert_close(Propagator::new(omega * omega, 0.0, h).0, expected);
        }
        let (omega, damping) = (5.0f64, 20.0f64);
        let root = (0.25 * damping * damping - omega * omega).sqrt();
        let [slow, fast] = [root - 0.5 * damping, -root - 0.5 * damping];
        let velocity = ((slow * h).exp() - (fast * h).exp()) / (2.0 * root);
        let found = Propagator::new(omega * omega, damping, h).0;
        assert!((found[0][1] - velocity).abs() < 1e-14);
        let still = found[0][0] + omega * omega * (found[0][2] + found[0][3]);
        assert!((still - 1.0).abs() < 1e-14);
    }

    fn assert_close(found: [[f64; 4]; 2], expected: [[f64; 4]; 2]) {
        for (a, b) in found.as_flattened().iter().zip(expected.as_flattened()) {
            // Squaring back adds rounding as the angle grows.
            assert!((a - b).abs() < 1e-11 * b.abs().max(1e-3), "{a} {b}");
        }
    }
}
