//! Spectra by the dense eigenproblem of the state matrix: any damping, any number of laws, any
//! exponents, near to each other or not.

use super::cluster::{Cluster, Drive, complex};
use super::coupled::{Coupled, coupled_modes};
use super::held::Left;
use super::partition::Groups;
use super::principal::Principal;
use super::rows::set_entry;
use super::secular::Coupling;
use super::spectrum::Spectrum;
use super::splitting::{Part, Split, rest_beside, split};
use super::stiff::Stiff;
use super::subspaces::{Subspace, subspaces};
use crate::error::Result;
use crate::law::{Law, Piece, State};
use crate::number::{Complex, LANES};
use crate::problem::Problem;
use faer::linalg::solvers::Solve;
use faer::{Mat, Scale, c64};

/// Couples groups that laws push together and that matrices of the structure couple.
pub(crate) fn couple<L: Law>(
    spectrum: &mut Spectrum,
    problem: &Problem<L>,
    states: &[State],
    groups: &Groups,
) -> Result<()> {
    spectrum.members.clone_from(&groups.members);
    spectrum.groups = groups.len();
    spectrum.combinations = groups.len();
    spectrum.group_damping.clone_from(&groups.damping);
    let longest = spectrum.span.longest(problem.duration);
    Coupled::of_groups(problem, states, groups).solve_into(spectrum, longest)
}

/// Couples the motions that laws leave to the modes whose local coordinates they hold.
pub(crate) fn couple_left<L: Law>(
    spectrum: &mut Spectrum,
    problem: &Problem<L>,
    states: &[State],
    left: Left,
    groups: &Groups,
) -> Result<()> {
    let reduced = left.reduce(&Coupled::of_groups(problem, states, groups));
    spectrum.members = left.members();
    spectrum.held = Some(Box::new(left.held));
    let count = reduced.force.nrows();
    spectrum.combinations = count;
    let damps = |(law, state): (&L, &State)| {
        let piece = law.piece(*state).unwrap_or(Piece::FREE);
        piece.damping != Piece::FREE.damping
    };
    let is_alone = count == 1 && !problem.laws.iter().zip(states).any(damps);
    if is_alone {
        let (k, c) = (reduced.stiffness[(0, 0)], reduced.damping[(0, 0)]);
        spectrum.add_combination(problem, k, c, reduced.force[(0, 0)]);
    } else if count > 0 {
        spectrum.groups = count;
        let longest = spectrum.span.longest(problem.duration);
        reduced.solve_into(spectrum, longest)?;
    }
    Ok(())
}

/// The equations of the coupled groups of a spectrum.
pub(crate) fn equations<L: Law>(problem: &Problem<L>, spectrum: &Spectrum) -> Coupled {
    let (states, system) = (&spectrum.states, &problem.system);
    if spectrum.held.is_some() {
        let modes = coupled_modes(problem, states);
        let coupled = Coupled::of_groups(problem, states, &Groups::of_modes(system, &modes));
        return match Left::of(problem, states, &modes) {
            Some(left) => left.reduce(&coupled),
            None => coupled,
        };
    }
    Coupled::of_groups(problem, states, &Groups::of_spectrum(system, spectrum))
}

/// Spectrum of one law whose modes are too heavily damped for the secular path, or have no
/// position at rest.
pub(crate) fn set_coupled(
    spectrum: &mut Spectrum,
    coupling: &Coupling,
    forces: &[f64],
    constant: f64,
    duration: f64,
) -> Result<()> {
    let coupled = Coupled::by_one(coupling, forces, constant, duration);
    coupled.solve_into(spectrum, duration)
}

/// What is left of a constant force at rest, relative to it, above which there is no rest.
const UNBALANCED: f64 = 1e-9;

/// What rounding makes of the difference of two entries of a matrix that are meant to be equal,
/// relative to its largest.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Times the length of the run, the size below which an exponent is slow: a position at rest
/// under a constant force would be so far away that digits were lost.
pub(super) const SLOW: f64 = 0.7;

impl Coupled {
    /// Exponents, clusters, shapes, left vectors and the position at rest.
    fn solve_into(&self, spectrum: &mut Spectrum, duration: f64) -> Result<()> {
        if let Some(stiff) = &self.stiff {
            let principal = Principal::apart(stiff, duration);
            if let Some(parted) = subspaces(&principal.state, &stiff.fast()) {
                return self.solve_apart(stiff, &principal, &parted, spectrum, duration);
            }
        }
        let principal = Principal::new(self, duration)?;
        let mut split = split(&principal.state, SLOW / duration)?;
        if self.is_conservative() {
            split.keep_energy();
        }
        let driven = split.driven_by(&self.force);
        let rest = if driven.is_empty() {
            (column(&self.statics(&self.force)), Vec::new())
        } else {
            let state = rest_beside(&principal.state, &principal.force, &split);
            let [position, velocity] = principal.motion(&state);
            (column(&position), column(&velocity))
        };
        (spectrum.at_rest, spectrum.rate_at_rest) = rest;
        Layout::new(&split.parts, &driven).fill(spectrum, &principal, &split, duration);
        Ok(())
    }

    /// The same where stiff laws stand apart: of the motions that are fast because of them, and of
    /// the others.
    fn solve_apart(
        &self,
        stiff: &Stiff,
        principal: &Principal,
        [fast, slow]: &[Subspace; 2],
        spectrum: &mut Spectrum,
        duration: f64,
    ) -> Result<()> {
        let keeps_energy = self.is_conservative();
        let fast = fast.motions(&principal.force, SLOW / duration, keeps_energy)?;
        let slow = slow.motions(&principal.force, SLOW / duration, keeps_energy)?;
        let motions = fast.beside(slow);
        let [position, velocity] = principal.motion(&motions.rest);
        spectrum.at_rest = column(&(position + &stiff.back * &stiff.rest));
        spectrum.rate_at_rest = if motions.driven.is_empty() {
            Vec::new()
        } else {
            column(&velocity)
        };
        Layout::new(&motions.split.parts, &motions.driven).fill(
            spectrum,
            principal,
            &motions.split,
            duration,
        );
        Ok(())
    }

    /// Whether nothing gives or takes energy: the stiffness is symmetric, and velocities are coupled
    /// by a skew matrix alone, both to rounding.
    fn is_conservative(&self) -> bool {
        let n = self.stiffness.nrows();
        let (k, c) = (&self.stiffness, &self.damping);
        let [most_k, most_c] = [k, c].map(|matrix| ROUNDING * matrix.norm_max());
        (0..n).all(|i| {
            (0..=i).all(|j| {
                (k[(i, j)] - k[(j, i)]).abs() <= most_k && (c[(i, j)] + c[(j, i)]).abs() <= most_c
            })
        })
    }

    /// The position at rest under constant forces; `None` where some motion that they push has no
    /// stiffness.
    pub(crate) fn rest(&self, forces: &Mat<f64>) -> Option<Vec<f64>> {
        if let Some(stiff) = &self.stiff {
            return stiff.rest(forces);
        }
        let rest = self.statics(forces);
        let lack = &self.stiffness * &rest - forces;
        // Written so that a lack which is not a number is one too large.
        let balanced = lack.norm_max() <= UNBALANCED * forces.norm_max();
        balanced.then(|| column(&rest))
    }

    fn statics(&self, forces: &Mat<f64>) -> Mat<f64> {
        if forces.norm_max() == 0.0 {
            return forces.clone();
        }
        self.stiffness.full_piv_lu().solve(forces)
    }
}

fn column(matrix: &Mat<f64>) -> Vec<f64> {
    (0..matrix.nrows()).map(|i| matrix[(i, 0)]).collect()
}

/// Where the columns of each part go: exponents first, clusters behind.
struct Layout<'a> {
    parts: Vec<(&'a Part, usize)>,
    /// The first columns of parts that constant forces drive.
    driven: &'a [usize],
    columns: usize,
}

impl<'a> Layout<'a> {
    fn new(parts: &'a [Part], driven: &'a [usize]) -> Self {
        let is_driven = |part: &Part| driven.contains(&part.first);
        let is_cluster = |part: &Part| part.generator.nrows() > 1 || is_driven(part);
        let mut ordered: Vec<&Part> = parts.iter().collect();
        ordered.sort_by_key(|part| is_cluster(part));
        let mut columns = 0;
        let mut placed = Vec::with_capacity(parts.len());
        for part in ordered {
            placed.push((part, columns));
            columns += part.generator.nrows() + usize::from(is_driven(part));
        }
        Self {
            parts: placed,
            driven,
            columns,
        }
    }

    fn fill(&self, spectrum: &mut Spectrum, principal: &Principal, split: &Split, duration: f64) {
        let groups = spectrum.groups;
        let (exponents, vectors) = spectrum.make_room(self.columns.div_ceil(LANES));
        vectors.clear();
        let shapes = principal.positions(&split.right);
        let (position, velocity) = principal.left(&split.left);
        let mut clusters = Vec::new();
        for &(part, at) in &self.parts {
            let factor = part.sides();
            let count = part.generator.nrows();
            for c in 0..count {
                let (column, from) = (at + c, part.first + c);
                set_entry(exponents, column, mean(&part.generator));
                for g in 0..groups {
                    let left = |rows: &Mat<c64>| complex(rows[(from, g)]).scale(factor);
                    set_entry(vectors.row_mut(g), column, complex(shapes[(g, from)]));
                    set_entry(vectors.row_mut(groups + g), column, left(&position));
                    set_entry(vectors.row_mut(2 * groups + g), column, left(&velocity));
                }
            }
            if self.driven.contains(&part.first) {
                let rows = split.left.subrows(part.first, count);
                let n = principal.force.nrows();
                let force = Mat::from_fn(n, 1, |i, _| c64::new(principal.force[(i, 0)], 0.0));
                let drive = rows * force * Scale(c64::new(factor, 0.0));
                let drive = Drive::constant(&drive, &part.generator, duration);
                let cluster = Cluster::driven(at, &part.generator, drive, duration);
                clusters.push(cluster);
            } else if count > 1 {
                clusters.push(Cluster::new(at, &part.generator, duration));
            }
        }
        spectrum.clusters = clusters;
    }
}

fn mean(generator: &Mat<c64>) -> Complex<f64> {
    let count = generator.nrows();
    let trace: c64 = (0..count).map(|i| generator[(i, i)]).sum();
    complex(trace).scale(1.0 / count as f64)
}
