//! The equations of the modes that laws and matrices of the structure couple.

use super::partition::Groups;
use super::secular::Coupling;
use crate::law::{COORDINATES, Law, Local, Piece, State};
use crate::number::Complex;
use crate::problem::Problem;
use crate::rigid::Directions;
use faer::linalg::solvers::Solve;
use faer::{Mat, c64};

/// `y'' + C y' + K y = p` with matrices of any symmetry and constant p.
pub(crate) struct Coupled {
    pub stiffness: Mat<f64>,
    pub damping: Mat<f64>,
    pub force: Mat<f64>,
}

/// The modes that laws in the given states push, feel or hold, and those that matrices couple.
pub(crate) fn coupled_modes<L: Law>(problem: &Problem<L>, states: &[State]) -> Vec<usize> {
    let mut involved: Vec<bool> = (0..problem.system.modes())
        .map(|mode| problem.system.couples(mode))
        .collect();
    for (law, piece) in pieces(problem, states) {
        for (coordinate, row) in law.rows().iter().enumerate() {
            if piece.acts_along(coordinate) || is_felt(&piece, coordinate) {
                for (involved, factor) in involved.iter_mut().zip(row) {
                    *involved |= *factor != 0.0;
                }
            }
        }
    }
    for row in Directions::held(problem, states).rows {
        for (involved, factor) in involved.iter_mut().zip(row) {
            *involved |= *factor != 0.0;
        }
    }
    (0..involved.len()).filter(|&mode| involved[mode]).collect()
}

/// The laws that act, and their matrices.
fn pieces<'a, L: Law>(
    problem: &'a Problem<L>,
    states: &'a [State],
) -> impl Iterator<Item = (&'a L, Piece)> {
    (problem.laws.iter().zip(states)).filter_map(|(law, state)| {
        let piece = law.piece(*state).filter(Piece::acts)?;
        Some((law, piece))
    })
}

/// Whether a force along some coordinate depends on this one.
pub(super) fn is_felt(piece: &Piece, coordinate: usize) -> bool {
    (piece.stiffness.iter().chain(&piece.damping)).any(|row| row[coordinate] != 0.0)
}

impl Coupled {
    /// The equations of some groups with the laws in the given states.
    pub(crate) fn of_groups<L: Law>(
        problem: &Problem<L>,
        states: &[State],
        groups: &Groups,
    ) -> Self {
        let system = &problem.system;
        let force = groups.row(problem.forcing.forces());
        let mut coupled = Self {
            stiffness: diagonal(&groups.omega2),
            damping: diagonal(&groups.damping),
            force: Mat::from_fn(groups.len(), 1, |r, _| force[r]),
        };
        let matrices = [
            (system.circulatory(), &mut coupled.stiffness),
            (system.coupling(), &mut coupled.damping),
        ];
        for (matrix, to) in matrices {
            if let Some(matrix) = matrix {
                add_matrix(to, groups, matrix);
            }
        }
        for (law, piece) in pieces(problem, states) {
            let rows: Vec<Vec<f64>> = law.rows().iter().map(|row| groups.row(row)).collect();
            if rows.iter().flatten().all(|factor| *factor == 0.0) {
                continue;
            }
            add_product(&mut coupled.stiffness, &rows, &piece.stiffness);
            add_product(&mut coupled.damping, &rows, &piece.damping);
            for (row, constant) in rows.iter().zip(piece.constant) {
                for (i, factor) in row.iter().enumerate() {
                    coupled.force[(i, 0)] += factor * constant;
                }
            }
        }
        coupled
    }

    /// Those of the combinations that one spring and damper couples, under no force.
    pub(crate) fn by_one(coupling: &Coupling) -> Self {
        let n = coupling.omega2.len();
        let phi = &coupling.phi;
        let entry = |own: &[f64], factor: f64, r: usize, c: usize| {
            factor * phi[r] * phi[c] + if r == c { own[r] } else { 0.0 }
        };
        let (k, c) = (coupling.stiffness, coupling.stop_damping);
        Self {
            stiffness: Mat::from_fn(n, n, |row, column| entry(&coupling.omega2, k, row, column)),
            damping: Mat::from_fn(n, n, |row, column| entry(&coupling.damping, c, row, column)),
            force: Mat::zeros(n, 1),
        }
    }
}

impl Coupled {
    /// `C y`
    pub(crate) fn damped(&self, y: &[f64]) -> Vec<f64> {
        product(&self.damping, y)
    }

    /// `K y`
    pub(crate) fn held(&self, y: &[f64]) -> Vec<f64> {
        product(&self.stiffness, y)
    }

    /// `(K + i omega C - omega^2)^-1 p`
    pub(crate) fn harmonic(&self, omega: f64, forces: &[Complex<f64>]) -> Vec<Complex<f64>> {
        let n = forces.len();
        let dynamic = Mat::from_fn(n, n, |r, c| {
            let inertia = if r == c { omega * omega } else { 0.0 };
            c64::new(
                self.stiffness[(r, c)] - inertia,
                omega * self.damping[(r, c)],
            )
        });
        let right = Mat::from_fn(n, 1, |i, _| c64::new(forces[i].re, forces[i].im));
        let solution = dynamic.full_piv_lu().solve(&right);
        (0..n)
            .map(|i| Complex::new(solution[(i, 0)].re, solution[(i, 0)].im))
            .collect()
    }
}

fn product(matrix: &Mat<f64>, y: &[f64]) -> Vec<f64> {
    let row = |i: usize| (0..y.len()).map(|k| matrix[(i, k)] * y[k]).sum();
    (0..y.len()).map(row).collect()
}

fn diagonal(values: &[f64]) -> Mat<f64> {
    let n = values.len();
    Mat::from_fn(n, n, |r, c| if r == c { values[r] } else { 0.0 })
}

/// Adds a matrix of the structure as the groups see it.
fn add_matrix(to: &mut Mat<f64>, groups: &Groups, matrix: &crate::system::Coupling) {
    for row in &groups.members {
        for column in &groups.members {
            let weight = row.weight * column.weight;
            to[(row.group, column.group)] += weight * matrix.at(row.mode, column.mode);
        }
    }
}

/// Adds `rows' local rows`.
fn add_product(to: &mut Mat<f64>, rows: &[Vec<f64>], local: &[Local<f64>; COORDINATES]) {
    for (row, factors) in rows.iter().zip(local) {
        for (column, factor) in rows.iter().zip(factors) {
            if *factor == 0.0 {
                continue;
            }
            for (i, left) in row.iter().enumerate() {
                for (j, right) in column.iter().enumerate() {
                    to[(i, j)] += left * factor * right;
                }
            }
        }
    }
}
