//! Which laws act, and which modes they couple.

use super::secular::Coupling;
use super::spectrum::Member;
use crate::law::{COORDINATES, Law, Piece, State};
use crate::problem::Problem;

/// A law in a state that is one spring and damper along one local coordinate.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Acting {
    pub law: usize,
    pub coordinate: usize,
    pub constant: f64,
    pub stiffness: f64,
    pub damping: f64,
}

/// What acts in the given states of the laws.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Acts {
    Nothing,
    /// One spring and damper.
    One(Acting),
    /// Anything else: several of them, forces that depend on other coordinates than their own, or
    /// coordinates that are held.
    Several,
}

impl Acts {
    /// Finds out what acts.
    #[inline(always)]
    pub(crate) fn of<L: Law>(problem: &Problem<L>, states: &[State]) -> Self {
        let mut acts = Self::Nothing;
        for (index, (law, state)) in problem.laws.iter().zip(states).enumerate() {
            if law.constraint(*state).is_some() {
                return Self::Several;
            }
            let piece = law.piece(*state).unwrap_or(Piece::FREE);
            for (i, row) in law.rows().iter().enumerate().take(COORDINATES) {
                if !piece.acts_along(i) || row.iter().all(|r| *r == 0.0) {
                    continue;
                }
                match Acting::spring(index, i, &piece) {
                    Some(spring) if matches!(acts, Self::Nothing) => acts = Self::One(spring),
                    _ => return Self::Several,
                }
            }
        }
        acts
    }
}

impl Acting {
    /// The springs that some laws are in their states; `None` where one of them is anything else.
    pub(crate) fn springs<L: Law>(
        problem: &Problem<L>,
        states: &[State],
        laws: &[usize],
    ) -> Option<Vec<Self>> {
        let mut springs = Vec::new();
        for &number in laws {
            let law = &problem.laws[number];
            let piece = law.piece(states[number])?;
            for (coordinate, row) in law.rows().iter().enumerate().take(COORDINATES) {
                if piece.acts_along(coordinate) && row.iter().any(|r| *r != 0.0) {
                    springs.push(Self::spring(number, coordinate, &piece)?);
                }
            }
        }
        Some(springs)
    }

    /// The spring and damper along one coordinate; `None` where there is anything else.
    #[inline(always)]
    fn spring(law: usize, coordinate: usize, piece: &Piece) -> Option<Self> {
        let i = coordinate;
        let is_spring = piece.stiffness[i][i] > 0.0 && piece.is_own(i);
        is_spring.then_some(Self {
            law,
            coordinate,
            constant: piece.constant[i],
            stiffness: piece.stiffness[i][i],
            damping: piece.damping[i][i],
        })
    }

    /// Its row, which projects modal displacements to the local coordinate.
    #[inline(always)]
    pub(crate) fn row<'a, L: Law>(&self, problem: &'a Problem<L>) -> &'a [f64] {
        &problem.laws[self.law].rows()[self.coordinate]
    }
}

/// Makes every mode a group of its own where a law sees them all and no two are alike or out of
/// order, as is usual; `false` where that is not so.
#[inline(always)]
pub(crate) fn group_modes<L: Law>(
    problem: &Problem<L>,
    law: &Acting,
    coupling: &mut Coupling,
    members: &mut Vec<Member>,
) -> bool {
    let omega2 = problem.system.omega2();
    let row = law.row(problem);
    let rises = omega2.windows(2).all(|pair| pair[0] < pair[1]);
    if !rises || row.contains(&0.0) {
        return false;
    }
    coupling.start(law.stiffness, law.damping);
    coupling.omega2.extend_from_slice(omega2);
    coupling.damping.extend_from_slice(problem.system.damping());
    coupling.phi.extend_from_slice(row);
    members.extend((0..row.len()).map(|mode| Member {
        mode,
        group: mode,
        weight: 1.0,
    }));
    true
}

/// Sorts the modes that a law sees and joins those that are alike (same `omega2`, same damping)
/// to groups.
#[inline(always)]
pub(crate) fn group_alike<L: Law>(
    problem: &Problem<L>,
    law: &Acting,
    order: &mut Vec<usize>,
    coupling: &mut Coupling,
    members: &mut Vec<Member>,
) {
    let (omega2, damping) = (problem.system.omega2(), problem.system.damping());
    let row = law.row(problem);
    coupling.start(law.stiffness, law.damping);
    members.clear();
    order.clear();
    order.extend((0..row.len()).filter(|mode| row[*mode] != 0.0));
    order.sort_by(|&a, &b| {
        (omega2[a].total_cmp(&omega2[b])).then(damping[a].total_cmp(&damping[b]))
    });
    let alike = |a: usize, b: usize| omega2[a] == omega2[b] && damping[a] == damping[b];
    for same in order.chunk_by(|&a, &b| alike(a, b)) {
        let size2: f64 = same.iter().map(|&mode| row[mode] * row[mode]).sum();
        // A mode alone in its group keeps its sign in phi, so that its weight is exactly one.
        let phi = match same {
            [only] => row[*only],
            _ => size2.sqrt(),
        };
        let group = coupling.push(omega2[same[0]], damping[same[0]], phi);
        members.extend(same.iter().map(|&mode| Member {
            mode,
            group,
            weight: row[mode] / phi,
        }));
    }
}

/// Constant forces on the groups.
#[inline(always)]
pub(crate) fn group_forces(modal: &[f64], members: &[Member], groups: usize, to: &mut Vec<f64>) {
    to.clear();
    to.resize(groups, 0.0);
    for m in members {
        to[m.group] += m.weight * modal[m.mode];
    }
}

/// Static position of the groups on the spring: `w_i^2 y_i = p_i + phi_i F`,
/// `F = constant - k sum phi_i y_i`. Further groups without stiffness than the softest (of other
/// damping) stay where they are if the forces on them balance; `false` if not.
///
/// Where the spring is stiff it resists nearly all of a force along its row. What is left is a
/// small difference, made with one rounding, and the spring's force on that is found once more.
#[inline(always)]
pub(crate) fn static_groups(
    coupling: &Coupling,
    forces: &[f64],
    constant: f64,
    to: &mut Vec<f64>,
) -> bool {
    let (omega2, phi) = (&coupling.omega2, &coupling.phi);
    to.clear();
    to.extend_from_slice(forces);
    if constant == 0.0 && forces.iter().all(|force| *force == 0.0) {
        return true;
    }
    let mut soft = 0;
    for i in 1..omega2.len() {
        if omega2[i].abs() < omega2[soft].abs() {
            soft = i;
        }
    }
    let (mut at_softest, mut resisting) = resisted(coupling, soft, to, constant);
    if is_nearly_all(resisting, phi, forces) {
        for (force, phi) in to.iter_mut().zip(phi) {
            *force = phi.mul_add(resisting, *force);
        }
        (at_softest, resisting) = resisted(coupling, soft, to, constant - resisting);
    }
    for i in 0..omega2.len() {
        let pushed = to[i] + phi[i] * resisting;
        if i == soft {
            to[i] = at_softest;
        } else if omega2[i] != 0.0 {
            to[i] = pushed / omega2[i];
        } else if pushed.abs() <= BALANCED * forces[i].abs() {
            to[i] = 0.0;
        } else {
            return false;
        }
    }
    true
}

/// Whether a spring's force leaves little of others.
#[inline(always)]
fn is_nearly_all(resisting: f64, phi: &[f64], forces: &[f64]) -> bool {
    let (mut left, mut largest) = (0.0f64, 0.0f64);
    for (force, phi) in forces.iter().zip(phi) {
        left = left.max((force + phi * resisting).abs());
        largest = largest.max(force.abs());
    }
    left < LITTLE * largest
}

/// Part of the forces that is left when so many digits of it are lost that it is found once more.
const LITTLE: f64 = 1e-3;

/// Where the softest group rests under forces, and the force of the spring. The softest one's own
/// row gives this, so that a rigid-body mode (stiffness zero) needs no special case.
#[inline(always)]
fn resisted(coupling: &Coupling, soft: usize, forces: &[f64], constant: f64) -> (f64, f64) {
    let Coupling {
        omega2,
        phi,
        stiffness,
        ..
    } = coupling;
    let (mut flexibility, mut pushed) = (0.0, 0.0);
    for i in 0..omega2.len() {
        if i != soft && omega2[i] != 0.0 {
            let share = phi[i] / omega2[i];
            flexibility += phi[i] * share;
            pushed += share * forces[i];
        }
    }
    let compliance = flexibility + 1.0 / stiffness;
    // phi_s y_s + compliance F = constant/k - pushed,  F = (w_s^2 y_s - p_s)/phi_s
    let factor = phi[soft] + compliance * omega2[soft] / phi[soft];
    let right = constant / stiffness - pushed + compliance * forces[soft] / phi[soft];
    let y = right / factor;
    (y, (omega2[soft] * y - forces[soft]) / phi[soft])
}

/// Forces on a rigid-body mode are in balance when what is left of them is rounding.
const BALANCED: f64 = 1e-12;
