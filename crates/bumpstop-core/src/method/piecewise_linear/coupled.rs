//! The equations of the modes that laws and matrices of the structure couple.

use super::partition::Groups;
use super::secular::Coupling;
use super::stiff::{Push, STIFFER, Stiff};
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
    /// The same, where laws are so stiff that they stand apart from the structure.
    pub stiff: Option<Box<Stiff>>,
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
            stiff: None,
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
        let pushes: Vec<Push> = (pieces(problem, states))
            .map(|(law, piece)| Push::new(law.rows().iter().map(|row| groups.row(row)), piece))
            .filter(|push| push.rows.iter().flatten().any(|factor| *factor != 0.0))
            .collect();
        coupled.stiff = coupled.apart(&pushes, problem.duration);
        for push in &pushes {
            coupled.add(push);
        }
        coupled
    }

    /// What the equations of a structure become when stiff laws among some stand apart, if there
    /// are such.
    fn apart(&self, pushes: &[Push], duration: f64) -> Option<Box<Stiff>> {
        let least = (1.0 / duration).powi(2);
        let limit = STIFFER * self.stiffness.norm_max().max(least);
        if pushes.iter().all(|push| push.size() <= limit) {
            return None;
        }
        let mut soft = Self {
            stiffness: self.stiffness.clone(),
            damping: self.damping.clone(),
            force: self.force.clone(),
            stiff: None,
        };
        let (stiff, others): (Vec<&Push>, Vec<&Push>) =
            pushes.iter().partition(|push| push.size() > limit);
        for push in others {
            soft.add(push);
        }
        Stiff::new(&soft, &stiff)
    }

    pub(super) fn add(&mut self, push: &Push) {
        add_product(&mut self.stiffness, &push.rows, &push.piece.stiffness);
        add_product(&mut self.damping, &push.rows, &push.piece.damping);
        for (row, constant) in push.rows.iter().zip(push.piece.constant) {
            for (i, factor) in row.iter().enumerate() {
                self.force[(i, 0)] += factor * constant;
            }
        }
    }

    /// Those of the combinations that one spring and damper couples, under forces and the constant
    /// one of the law.
    pub(crate) fn by_one(
        coupling: &Coupling,
        forces: &[f64],
        constant: f64,
        duration: f64,
    ) -> Self {
        let mut coupled = Self {
            stiffness: diagonal(&coupling.omega2),
            damping: diagonal(&coupling.damping),
            force: Mat::from_fn(forces.len(), 1, |i, _| forces[i]),
            stiff: None,
        };
        let mut piece = Piece::FREE;
        piece.constant[0] = constant;
        piece.stiffness[0][0] = coupling.stiffness;
        piece.damping[0][0] = coupling.stop_damping;
        let push = Push::new(std::iter::once(coupling.phi.clone()), piece);
        coupled.stiff = coupled.apart(std::slice::from_ref(&push), duration);
        coupled.add(&push);
        coupled
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
        let right = Mat::from_fn(n, 1, |i, _| c64::new(forces[i].re, forces[i].im));
        let solution = match &self.stiff {
            Some(stiff) => stiff.harmonic(omega, &right),
            None => self.dynamic(omega).full_piv_lu().solve(&right),
        };
        (0..n)
            .map(|i| Complex::new(solution[(i, 0)].re, solution[(i, 0)].im))
            .collect()
    }

    /// `K + i omega C - omega^2`
    fn dynamic(&self, omega: f64) -> Mat<c64> {
        let n = self.stiffness.nrows();
        Mat::from_fn(n, n, |r, c| {
            let inertia = if r == c { omega * omega } else { 0.0 };
            c64::new(
                self.stiffness[(r, c)] - inertia,
                omega * self.damping[(r, c)],
            )
        })
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
