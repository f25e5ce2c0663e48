//! Eigenvalues of modes coupled by several springs and dampers, from the forces in these.
//!
//! The modes `q_i'' + c_i q_i' + w_i^2 q_i = -phi_i . f` with the forces
//! `f_a = kappa_a(s) sum_i phi_ia q_i`, `kappa_a = k_a + c_a s`, are told by the forces alone,
//! `q_i = -phi_i . f / D_i(s)`. All but one mode o, which moves by one, are eliminated:
//!
//! ```text
//! S f = phi_o,   S = diag(1 / kappa) + sum_(i != o) phi_i phi_i' / D_i,
//! h(s) = D_o + phi_o . f = 0,
//! h'(s) = sum_i q_i^2 (2 s + c_i) + sum_a c_a (f_a / kappa_a)^2.
//! ```
//!
//! Newton's method on h starts at the exponents that damping to first order makes of the
//! undamped ones; o is the mode that takes the largest part. A root costs the number of modes
//! times the square of that of springs. The slope h' is the norm of the left vectors, too.

mod neighbour;
mod search;

pub(crate) use neighbour::Neighbour;

use super::rows::{ComplexBlock, Rows, entry};
use crate::eigen::symmetric_eigen;
use crate::number::{Complex, LANES, dispatch};
use faer::Mat;
use search::Search;

/// Springs whose products are summed together.
const TILE: usize = 4;

/// Groups of modes that several springs and dampers couple.
#[derive(Debug, Clone, Default)]
pub(crate) struct Springs {
    pub omega2: Vec<f64>,
    pub damping: Vec<f64>,
    pub stiffness: Vec<f64>,
    pub dampers: Vec<f64>,
    /// How the springs see each mode, filled with zeros to whole tiles.
    phi: Vec<f64>,
    stride: usize,
}

/// Exponents, and shapes with left vectors.
pub(crate) type Solution = (Vec<ComplexBlock>, Rows);

/// Where the search of a root begins.
#[derive(Debug, Clone, Copy)]
struct Start {
    /// The mode that is not eliminated.
    mode: usize,
    /// The distance from its pole.
    delta: Complex<f64>,
}

impl Springs {
    /// Modes seen by springs and dampers through rows.
    pub(crate) fn new(
        omega2: &[f64],
        damping: &[f64],
        rows: &[Vec<f64>],
        stiffness: Vec<f64>,
        dampers: Vec<f64>,
    ) -> Self {
        let stride = rows.len().next_multiple_of(TILE);
        let mut phi = vec![0.0; stride * omega2.len()];
        for (spring, row) in rows.iter().enumerate() {
            for (mode, factor) in row.iter().enumerate() {
                phi[mode * stride + spring] = *factor;
            }
        }
        Self {
            omega2: omega2.to_vec(),
            damping: damping.to_vec(),
            stiffness,
            dampers,
            phi,
            stride,
        }
    }

    fn modes(&self) -> usize {
        self.omega2.len()
    }

    fn count(&self) -> usize {
        self.stiffness.len()
    }

    /// The springs' factors of a mode.
    #[inline(always)]
    fn phi(&self, mode: usize) -> &[f64] {
        &self.phi[mode * self.stride..][..self.stride]
    }

    /// Whether every mode by itself oscillates with light damping, as this way needs.
    fn is_lightly_damped(&self) -> bool {
        let oscillates = |(w2, c): (&f64, &f64)| *w2 == 0.0 && *c == 0.0 || c * c < 2.0 * w2;
        self.omega2.iter().zip(&self.damping).all(oscillates)
    }

    /// Exponents, shapes and left vectors, of one of each conjugate pair. `None` where some do not
    /// oscillate, or more slowly than `slow`, or are not found.
    ///
    /// A neighbour is the same groups with one spring less: its exponents are those between which
    /// the search begins.
    pub(crate) fn solve(&self, slow: f64, neighbour: Option<Neighbour<'_>>) -> Option<Solution> {
        if !self.is_lightly_damped() {
            return None;
        }
        if let Some(starts) = neighbour.and_then(|neighbour| neighbour.starts(self, slow))
            && let Some(solution) = self.search(starts)
        {
            return Some(solution);
        }
        self.search(self.starts(slow)?)
    }

    /// The roots from where the search begins; `None` where it fails or finds one twice.
    fn search(&self, starts: Vec<Start>) -> Option<Solution> {
        let width = self.modes().div_ceil(LANES);
        let mut vectors = Rows::zeros(3 * self.modes(), width);
        let lambda = dispatch(Search::new(self, starts, &mut vectors))?;
        are_apart(&lambda, self.modes()).then_some((lambda, vectors))
    }

    /// The undamped exponents, moved by the damping to first order.
    fn starts(&self, slow: f64) -> Option<Vec<Start>> {
        let n = self.modes();
        let mut stiffness = Mat::<f64>::zeros(n, n);
        for r in 0..n {
            for c in 0..=r {
                let pairs = self.phi(r).iter().zip(self.phi(c)).zip(&self.stiffness);
                stiffness[(r, c)] = pairs.map(|((a, b), k)| a * b * k).sum();
            }
            stiffness[(r, r)] += self.omega2[r];
        }
        let eigen = symmetric_eigen(&stiffness).ok()?;
        let (values, axes) = (eigen.values, eigen.vectors);
        let mut seen = vec![0.0; self.stride];
        let mut starts = Vec::with_capacity(n);
        for (j, value) in values.iter().enumerate() {
            let axis = axes.col(j);
            let (mut damping, mut mode) = (0.0, 0);
            seen.fill(0.0);
            for i in 0..n {
                let x: f64 = axis[i];
                damping += self.damping[i] * x * x;
                if x.abs() > axis[mode].abs() {
                    mode = i;
                }
                for (seen, phi) in seen.iter_mut().zip(self.phi(i)) {
                    *seen += phi * x;
                }
            }
            for (seen, c) in seen.iter().zip(&self.dampers) {
                damping += c * seen * seen;
            }
            let rate2 = *value - 0.25 * damping * damping;
            // Written so that what is no number has no root.
            let oscillates = rate2 > 0.0 && *value >= slow * slow;
            if !oscillates {
                return None;
            }
            let guess = Complex::new(-0.5 * damping, rate2.sqrt());
            starts.push(self.start(mode, guess));
        }
        Some(starts)
    }

    /// The search from a guess, told by a mode.
    fn start(&self, mode: usize, guess: Complex<f64>) -> Start {
        let (omega2, damping) = (self.omega2[mode], self.damping[mode]);
        let pole = Complex::new(-0.5 * damping, (omega2 - 0.25 * damping * damping).sqrt());
        Start {
            mode,
            delta: guess - pole,
        }
    }

    /// `p - K y`
    pub(crate) fn lack(&self, forces: &[f64], y: &[f64]) -> Vec<f64> {
        let mut pushes = vec![0.0; self.count()];
        for (i, y) in y.iter().enumerate() {
            for (push, phi) in pushes.iter_mut().zip(self.phi(i)) {
                *push += phi * y;
            }
        }
        for (push, k) in pushes.iter_mut().zip(&self.stiffness) {
            *push *= k;
        }
        let lack = (0..self.modes()).map(|i| {
            let pushed: f64 = pushes.iter().zip(self.phi(i)).map(|(f, phi)| f * phi).sum();
            forces[i] - self.omega2[i] * y[i] - pushed
        });
        lack.collect()
    }
}

/// Whether no exponent was found twice.
fn are_apart(lambda: &[ComplexBlock], count: usize) -> bool {
    let mut exponents: Vec<Complex<f64>> = (0..count).map(|j| entry(lambda, j)).collect();
    exponents.sort_by(|a, b| a.im.total_cmp(&b.im));
    let apart = |pair: &[Complex<f64>]| (pair[1] - pair[0]).norm() > SAME * pair[1].norm();
    exponents.windows(2).all(apart)
}

/// Exponents nearer to each other than this part of their size cannot be told from one.
const SAME: f64 = 1e-9;

#[cfg(test)]
mod tests {
    use super::super::family::Family;
    use super::*;
    use proptest::prelude::*;
    use std::sync::Arc;

    const MODES: usize = 9;

    /// Modes from 1 rad/s on with light damping, seen by some springs.
    fn springs() -> impl Strategy<Value = Springs> {
        let mode = (1.02f64..1.6, 0.0f64..0.04);
        let spring = (
            prop::collection::vec(-1.0f64..1.0, MODES),
            prop_oneof![1e-3f64..1.0, 1.0f64..1e3],
            prop_oneof![Just(0.0), 0.0f64..0.05],
        );
        let modes = prop::collection::vec(mode, MODES);
        (modes, prop::collection::vec(spring, 2..7)).prop_map(|(modes, springs)| {
            let mut rate = 1.0;
            let (mut omega2, mut damping) = (Vec::new(), Vec::new());
            for (factor, ratio) in modes {
                rate *= factor;
                omega2.push(rate * rate);
                damping.push(2.0 * ratio * rate);
            }
            let rows: Vec<Vec<f64>> = springs.iter().map(|spring| spring.0.clone()).collect();
            let stiffness = springs.iter().map(|spring| spring.1).collect();
            let dampers = springs.iter().map(|spring| spring.2).collect();
            Springs::new(&omega2, &damping, &rows, stiffness, dampers)
        })
    }

    impl Springs {
        /// Without the last one.
        fn lesser(&self) -> Self {
            let count = self.count() - 1;
            let row = |spring: usize| (0..MODES).map(|i| self.phi(i)[spring]).collect();
            let rows: Vec<Vec<f64>> = (0..count).map(row).collect();
            let (stiffness, dampers) = (self.stiffness[..count].to_vec(), &self.dampers[..count]);
            Self::new(
                &self.omega2,
                &self.damping,
                &rows,
                stiffness,
                dampers.to_vec(),
            )
        }

        /// The largest entry of `(s^2 + C s + K) psi`, relative to those of the terms.
        fn residual(&self, s: Complex<f64>, psi: &[Complex<f64>]) -> f64 {
            let mut pushes = vec![Complex::zero(); self.count()];
            for (i, psi) in psi.iter().enumerate() {
                for (push, phi) in pushes.iter_mut().zip(self.phi(i)) {
                    *push += psi.scale(*phi);
                }
            }
            for (spring, push) in pushes.iter_mut().enumerate() {
                let kappa = s.scale(self.dampers[spring]).plus(self.stiffness[spring]);
                *push = *push * kappa;
            }
            let (mut worst, mut size) = (0.0f64, 0.0f64);
            for (i, psi) in psi.iter().enumerate() {
                let dynamic = (s * s + s.scale(self.damping[i])).plus(self.omega2[i]);
                let mut total = dynamic * *psi;
                size = size.max((s.norm2() + self.omega2[i]) * psi.norm());
                for (push, phi) in pushes.iter().zip(self.phi(i)) {
                    total += push.scale(*phi);
                    size = size.max(push.norm() * phi.abs());
                }
                worst = worst.max(total.norm());
            }
            worst / size
        }
    }

    proptest! {
        /// Exponents and shapes solve the equations, and left vectors and shapes are inverse to
        /// each other: there are as many as states, and none twice.
        #[test]
        fn all_exponents_are_found(springs in springs(), with_neighbour: bool) {
            let lesser = springs.lesser();
            let before = lesser.solve(0.0, None);
            let family = before.as_ref().map(|(_, vectors)| Family {
                groups: MODES,
                vectors: Arc::new(vectors.clone()),
                ..Family::default()
            });
            let neighbour = before.as_ref().zip(family.as_ref()).map(|((lambda, _), family)| {
                Neighbour { lambda, family, spring: lesser.count() }
            });
            let solution = springs.solve(0.0, neighbour.filter(|_| with_neighbour));
            prop_assume!(solution.is_some());
            let (lambda, vectors) = solution.unwrap();
            for j in 0..MODES {
                let psi: Vec<_> = (0..MODES).map(|i| entry(vectors.row(i), j)).collect();
                let residual = springs.residual(entry(&lambda, j), &psi);
                // Roots that nearly meet are not told apart to the last digits.
                prop_assert!(residual < 1e-11, "{residual:e}");
            }
            for row in 0..MODES {
                for column in 0..MODES {
                    // Position of one group from those of another, and from its velocity.
                    let (mut own, mut other) = (0.0, 0.0);
                    for j in 0..MODES {
                        let shape = entry(vectors.row(row), j);
                        own += shape.real_product(entry(vectors.row(MODES + column), j));
                        other += shape.real_product(entry(vectors.row(2 * MODES + column), j));
                    }
                    let expected = if row == column { 1.0 } else { 0.0 };
                    // Exponents that nearly meet share their vectors' errors.
                    prop_assert!((own - expected).abs() < 1e-7, "{own}");
                    prop_assert!(other.abs() < 1e-7, "{other}");
                }
            }
        }
    }

    #[test]
    fn light_damping_is_always_solved() {
        let rows: Vec<Vec<f64>> = (1..4)
            .map(|a| (1..=MODES).map(|i| (0.9 * (a * i) as f64).sin()).collect())
            .collect();
        let omega2: Vec<f64> = (1..=MODES).map(|i| (i * i) as f64).collect();
        let damping: Vec<f64> = (1..=MODES).map(|i| 0.02 * i as f64).collect();
        let springs = Springs::new(
            &omega2,
            &damping,
            &rows,
            vec![50.0; 3],
            vec![0.0, 0.01, 0.0],
        );
        assert!(springs.solve(0.0, None).is_some());
        assert!(springs.solve(1.5, None).is_some());
        assert!(springs.solve(5.0, None).is_none());
    }

    /// A heavy stop beside a spring that hardly pushes: found from the spring's, the fast root is
    /// first told by a mode that takes a ten-millionth of it.
    #[test]
    fn roots_are_told_by_modes_that_take_part() {
        let omega2 = [146.6, 342.2, 419.0, 892.5, 2144.8];
        let rows = [
            vec![-1.161, -0.255, 0.610, 0.863, -0.946],
            vec![0.820, 0.275, -0.286, 1.346, 0.0],
        ];
        let none = [0.0; 5];
        let both = Springs::new(
            &omega2,
            &none,
            &rows,
            vec![1.342, 50504.0],
            vec![0.0, 49.17],
        );
        let lesser = Springs::new(&omega2, &none, &rows[..1], vec![1.342], vec![0.0]);
        let (before, vectors) = lesser.solve(0.0, None).unwrap();
        let family = Family {
            groups: omega2.len(),
            vectors: Arc::new(vectors),
            ..Family::default()
        };
        let neighbour = Neighbour {
            lambda: &before,
            family: &family,
            spring: 1,
        };
        let (lambda, vectors) = both.solve(0.0, Some(neighbour)).unwrap();
        for j in 0..omega2.len() {
            let psi: Vec<_> = (0..omega2.len())
                .map(|i| entry(vectors.row(i), j))
                .collect();
            assert!(both.residual(entry(&lambda, j), &psi) < 1e-13);
        }
    }
}
