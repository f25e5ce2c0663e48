//! The functions phi of exponential integrators, of one mode's matrix.
//!
//! `phi_0(z) = e^z` and `phi_k(z) = sum_j z^j / (j + k)!`: what an oscillator makes of forces that
//! grow with powers of time. Its matrix is small, `z = t [[0, 1], [-omega^2, -c]]`. Where z is small
//! the series is summed; else for halves of z and doubled back by
//! `phi_k(2z) = 2^-k (e^z phi_k(z) + sum_{j=1}^k phi_j(z) / (k - j)!)`.
//!
//! Source: M. Hochbruck, A. Ostermann, Exponential integrators, Acta Numerica 19, 209-286, 2010,
//! section 2.

/// Size up to which the series is summed, and its terms.
const SMALL: f64 = 0.5;
const TERMS: usize = 15;

type Matrix = [[f64; 2]; 2];

/// How a mode goes on in a given time.
#[derive(Debug, Clone, Copy)]
pub(super) struct Propagator {
    /// What displacement and velocity make of themselves.
    pub motion: Matrix,
    /// `t phi_k` of a unit force, in displacement and velocity: k = 1, 2, 3.
    pub pushes: [[f64; 2]; 3],
}

impl Propagator {
    /// Over a time of a mode.
    pub(super) fn new(omega2: f64, damping: f64, time: f64) -> Self {
        // Velocities are counted in units of s, which makes the entries alike.
        let s = omega2.abs().sqrt().max(1.0 / time);
        let z = [[0.0, s * time], [-omega2 / s * time, -damping * time]];
        let [exponential, phis @ ..] = phis(z);
        let [[qq, qv], [vq, vv]] = exponential;
        Self {
            motion: [[qq, qv / s], [vq * s, vv]],
            pushes: phis.map(|[[_, q], [_, v]]| [time * q / s, time * v]),
        }
    }

    /// That of a number that nothing resists: its pushes are on the number itself.
    pub(super) fn free(time: f64) -> [f64; 3] {
        [time, time / 2.0, time / 6.0]
    }
}

/// phi_0 to phi_3.
fn phis(mut z: Matrix) -> [Matrix; 4] {
    let size = z.map(|row| row.map(f64::abs).iter().sum::<f64>());
    let size = size[0].max(size[1]);
    let halvings = (size / SMALL).log2().ceil().max(0.0) as i32;
    let scale = 0.5f64.powi(halvings);
    for x in z.as_flattened_mut() {
        *x *= scale;
    }
    // Horner's rule: 3! phi_3 = 1 + z/4 (1 + z/5 (1 + ...)), then phi_k = 1/k! + z phi_{k+1}.
    let mut sum = unit(1.0);
    for term in (4..4 + TERMS).rev() {
        sum = add(unit(1.0), scaled(1.0 / term as f64, product(&z, &sum)));
    }
    let third = scaled(1.0 / 6.0, sum);
    let second = add(unit(0.5), product(&z, &third));
    let first = add(unit(1.0), product(&z, &second));
    let mut phis = [add(unit(1.0), product(&z, &first)), first, second, third];
    for _ in 0..halvings {
        phis = doubled(&phis);
    }
    phis
}

/// The functions of 2 z from those of z.
fn doubled([exponential, first, second, third]: &[Matrix; 4]) -> [Matrix; 4] {
    let carried = |phi: &Matrix| product(exponential, phi);
    let both = add(*second, *first);
    [
        carried(exponential),
        scaled(0.5, add(carried(first), *first)),
        scaled(0.25, add(carried(second), both)),
        scaled(
            0.125,
            add(
                carried(third),
                add(*third, add(*second, scaled(0.5, *first))),
            ),
        ),
    ]
}

fn unit(x: f64) -> Matrix {
    [[x, 0.0], [0.0, x]]
}

fn add(a: Matrix, b: Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| a[i][j] + b[i][j]))
}

fn scaled(factor: f64, a: Matrix) -> Matrix {
    a.map(|row| row.map(|x| factor * x))
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| a[i][0] * b[0][j] + a[i][1] * b[1][j]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against closed forms: a rigid mode, oscillators, and one with four times critical damping.
    #[test]
    fn modes_go_on_as_the_closed_forms_say() {
        let t = 0.7f64;
        let rigid = Propagator::new(0.0, 0.0, t);
        assert_close(rigid.motion.as_flattened(), &[1.0, t, 0.0, 1.0]);
        let pushes = [t * t / 2.0, t, t * t / 6.0, t / 2.0, t * t / 24.0, t / 6.0];
        assert_close(rigid.pushes.as_flattened(), &pushes);
        for omega in [0.1, 3.0, 400.0f64] {
            let (sin, cos) = (omega * t).sin_cos();
            let found = Propagator::new(omega * omega, 0.0, t);
            assert_close(
                found.motion.as_flattened(),
                &[cos, sin / omega, -omega * sin, cos],
            );
            let half = (0.5 * omega * t).sin();
            let held = 2.0 * half * half / (omega * omega);
            assert_close(&found.pushes[0], &[held, sin / omega]);
            // A force (tau / t)^k / k!: its velocity is the displacement of the one before, over t.
            assert!((found.pushes[1][1] * t / held - 1.0).abs() < 1e-11);
            assert!((found.pushes[2][1] * t / found.pushes[1][0] - 1.0).abs() < 1e-11);
            if omega > 1.0 {
                let ramp = (t - sin / omega) / (t * omega * omega);
                assert!((found.pushes[1][0] / ramp - 1.0).abs() < 1e-11);
            }
        }
        let (omega, damping) = (5.0f64, 40.0f64);
        let root = (0.25 * damping * damping - omega * omega).sqrt();
        let [slow, fast] = [root - 0.5 * damping, -root - 0.5 * damping];
        let velocity = ((slow * t).exp() - (fast * t).exp()) / (2.0 * root);
        let found = Propagator::new(omega * omega, damping, t);
        assert!((found.motion[0][1] / velocity - 1.0).abs() < 1e-12);
        assert!((found.pushes[0][1] / velocity - 1.0).abs() < 1e-12);
    }

    fn assert_close(found: &[f64], expected: &[f64]) {
        for (a, b) in found.iter().zip(expected) {
            // Doubling adds rounding as the angle grows.
            assert!((a - b).abs() <= 1e-11 * b.abs().max(1e-6), "{a} {b}");
        }
    }
}
