//! Modes that acting laws and matrices of the structure join, apart from those that they do not.
//!
//! Modes and the laws that act on them are the two sides of a graph; what hangs together in it is
//! solved together, and nothing else is.

use super::coupled::{coupled_modes, is_felt};
use super::spectrum::{Member, Spectrum};
use crate::components::labels;
use crate::error::Result;
use crate::law::{Law, Piece, State};
use crate::problem::Problem;
use crate::rigid::Directions;
use crate::system::ModalSystem;
use faer::Mat;

/// Below this part of the largest, rows on like modes depend on each other.
const DEPENDENT: f64 = 1e-12;

/// Modes that hang together, and the laws that act on them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Component {
    pub modes: Vec<usize>,
    pub laws: Vec<usize>,
}

impl Component {
    /// All components of the laws in the given states, by their lowest modes. Where laws hold
    /// coordinates all is one.
    pub(crate) fn all<L: Law>(problem: &Problem<L>, states: &[State]) -> Result<Vec<Self>> {
        let modes = coupled_modes(problem, states);
        let acting: Vec<(usize, Vec<usize>)> = (problem.laws.iter().zip(states).enumerate())
            .map(|(number, (law, state))| (number, modes_of(law, *state)))
            .filter(|(_, modes)| !modes.is_empty())
            .collect();
        if !Directions::held(problem, states).rows.is_empty() {
            let laws = acting.iter().map(|(law, _)| *law).collect();
            return Ok(vec![Self { modes, laws }]);
        }
        let (mut from, mut to) = (Vec::new(), Vec::new());
        for (_, modes) in &acting {
            for mode in &modes[1..] {
                from.push(modes[0]);
                to.push(*mode);
            }
        }
        let system = &problem.system;
        for matrix in [system.coupling(), system.circulatory()]
            .into_iter()
            .flatten()
        {
            for &row in &modes {
                for &column in modes.iter().filter(|c| matrix.at(row, **c) != 0.0) {
                    from.push(row);
                    to.push(column);
                }
            }
        }
        let label = labels(system.modes(), &from, &to)?;
        let mut place = vec![usize::MAX; system.modes()];
        let mut components: Vec<Self> = Vec::new();
        for mode in modes {
            let place = &mut place[label[mode]];
            if *place == usize::MAX {
                *place = components.len();
                components.push(Self::default());
            }
            components[*place].modes.push(mode);
        }
        for (law, modes) in acting {
            components[place[label[modes[0]]]].laws.push(law);
        }
        Ok(components)
    }

    /// What one law by itself acts on.
    pub(crate) fn of_law<L: Law>(problem: &Problem<L>, states: &[State], law: usize) -> Self {
        Self {
            modes: modes_of(&problem.laws[law], states[law]),
            laws: vec![law],
        }
    }
}

/// The modes that a law pushes or feels.
fn modes_of<L: Law>(law: &L, state: State) -> Vec<usize> {
    let rows = rows_of(law, state);
    let Some(first) = rows.first() else {
        return Vec::new();
    };
    let is_seen = |mode: &usize| rows.iter().any(|row| row[*mode] != 0.0);
    (0..first.len()).filter(is_seen).collect()
}

/// The rows along which a law pushes or feels.
fn rows_of<L: Law>(law: &L, state: State) -> Vec<&[f64]> {
    let Some(piece) = law.piece(state).filter(Piece::acts) else {
        return Vec::new();
    };
    (law.rows().iter().enumerate())
        .filter(|(i, _)| piece.acts_along(*i) || is_felt(&piece, *i))
        .map(|(_, row)| row.as_slice())
        .collect()
}

/// Modes, or combinations of those that are alike, as laws see them.
#[derive(Debug, Clone, Default)]
pub(crate) struct Groups {
    pub members: Vec<Member>,
    pub omega2: Vec<f64>,
    pub damping: Vec<f64>,
}

impl Groups {
    /// The modes of a component. Of modes that are alike (same `omega2`, same damping) and more
    /// than the laws tell from each other, the combinations that these see.
    pub(crate) fn of<L: Law>(
        problem: &Problem<L>,
        states: &[State],
        component: &Component,
    ) -> Self {
        let (omega2, damping) = (problem.system.omega2(), problem.system.damping());
        if problem.system.is_coupled() {
            return Self::of_modes(&problem.system, &component.modes);
        }
        let mut groups = Self::default();
        let mut order = component.modes.clone();
        order.sort_by(|&a, &b| {
            (omega2[a].total_cmp(&omega2[b])).then(damping[a].total_cmp(&damping[b]))
        });
        let alike = |a: &usize, b: &usize| omega2[*a] == omega2[*b] && damping[*a] == damping[*b];
        for same in order.chunk_by(alike) {
            let (omega2, damping) = (omega2[same[0]], damping[same[0]]);
            match combinations(problem, states, component, same) {
                Some(seen) => {
                    for column in 0..seen.ncols() {
                        let weights = same.iter().enumerate();
                        let weights = weights.map(|(i, &mode)| (mode, seen[(i, column)]));
                        groups.push(omega2, damping, weights);
                    }
                }
                None => {
                    for &mode in same {
                        groups.push(omega2, damping, [(mode, 1.0)]);
                    }
                }
            }
        }
        groups
    }

    /// Modes as they are.
    pub(crate) fn of_modes(system: &ModalSystem, modes: &[usize]) -> Self {
        let mut groups = Self::default();
        for &mode in modes {
            groups.push(system.omega2()[mode], system.damping()[mode], [(mode, 1.0)]);
        }
        groups
    }

    /// The coupled groups of a spectrum.
    pub(crate) fn of_spectrum(system: &ModalSystem, spectrum: &Spectrum) -> Self {
        let members = spectrum.members.iter();
        let coupled = members.filter(|member| member.group < spectrum.groups);
        let mut groups = Self {
            members: coupled.copied().collect(),
            omega2: vec![0.0; spectrum.groups],
            damping: vec![0.0; spectrum.groups],
        };
        for member in &groups.members {
            groups.omega2[member.group] = system.omega2()[member.mode];
            groups.damping[member.group] = system.damping()[member.mode];
        }
        groups
    }

    /// Adds a group of modes with weights.
    fn push(&mut self, omega2: f64, damping: f64, weights: impl IntoIterator<Item = (usize, f64)>) {
        let group = self.len();
        let member = |(mode, weight)| Member {
            mode,
            group,
            weight,
        };
        let weights = weights.into_iter().filter(|(_, weight)| *weight != 0.0);
        self.members.extend(weights.map(member));
        self.omega2.push(omega2);
        self.damping.push(damping);
    }

    /// How many there are.
    pub(crate) fn len(&self) -> usize {
        self.omega2.len()
    }

    /// A row of the modes as one of the groups.
    pub(crate) fn row(&self, modal: &[f64]) -> Vec<f64> {
        let mut row = vec![0.0; self.len()];
        for member in &self.members {
            row[member.group] += member.weight * modal[member.mode];
        }
        row
    }
}

/// Orthonormal combinations of like modes that span what laws see of them, one a column; `None`
/// where they see as many as there are modes.
fn combinations<L: Law>(
    problem: &Problem<L>,
    states: &[State],
    component: &Component,
    same: &[usize],
) -> Option<Mat<f64>> {
    if same.len() == 1 {
        return None;
    }
    let rows: Vec<&[f64]> = (component.laws.iter())
        .flat_map(|&law| rows_of(&problem.laws[law], states[law]))
        .collect();
    let seen = Mat::from_fn(same.len(), rows.len(), |i, row| rows[row][same[i]]);
    let factors = seen.col_piv_qr();
    let triangle = factors.R();
    let size = |k: usize| triangle[(k, k)].abs();
    let count = same.len().min(rows.len());
    let rank = (0..count)
        .filter(|&k| size(k) > DEPENDENT * size(0))
        .count();
    let all = factors.compute_Q();
    (rank < same.len()).then(|| Mat::from_fn(same.len(), rank, |i, k| all[(i, k)]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::forcing::Forcing;
    use crate::law::Stop;

    const OPEN: State = Stop::OPEN;
    const CLOSED: State = Stop::CLOSED;

    fn problem(omega2: [f64; 5], coupling: Option<[usize; 2]>, rows: &[[f64; 5]]) -> Problem<Stop> {
        let mut system = ModalSystem::new(omega2.to_vec(), vec![0.1; 5]).unwrap();
        if let Some([a, b]) = coupling {
            let mut matrix = vec![vec![0.0; 5]; 5];
            matrix[a][b] = 0.3;
            system = system.with_coupling(matrix).unwrap();
        }
        let laws = rows
            .iter()
            .map(|row| Stop::new(row.to_vec(), 0.1, 2.0, 0.0).unwrap());
        let still = vec![0.0; 5];
        let forcing = Forcing::constant(still.clone()).unwrap();
        Problem::new(system, laws.collect(), forcing, still.clone(), still, 1.0).unwrap()
    }

    #[test]
    fn laws_on_separate_modes_are_separate() {
        let rows = [
            [0.0, 1.0, 0.0, 0.0, 2.0],
            [1.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, 1.0],
        ];
        let omega2 = [1.0, 2.0, 3.0, 4.0, 5.0];
        let component = |modes: &[usize], laws: &[usize]| Component {
            modes: modes.to_vec(),
            laws: laws.to_vec(),
        };
        let alone = problem(omega2, None, &rows);
        let found = Component::all(&alone, &[CLOSED; 3]).unwrap();
        assert_eq!(found, [component(&[0], &[1]), component(&[1, 4], &[0, 2])]);
        let open = Component::all(&alone, &[OPEN, CLOSED, OPEN]).unwrap();
        assert_eq!(open, [component(&[0], &[1])]);
        let joined = problem(omega2, Some([0, 4]), &rows);
        let found = Component::all(&joined, &[CLOSED; 3]).unwrap();
        assert_eq!(found, [component(&[0, 1, 4], &[0, 1, 2])]);
    }

    #[test]
    fn of_like_modes_laws_see_as_many_combinations_as_they_have_rows() {
        let rows = [[1.0, 2.0, 2.0, 1.0, 0.5], [3.0, 6.0, 6.0, 1.0, 0.0]];
        let problem = problem([4.0, 4.0, 4.0, 9.0, 9.0], None, &rows);
        let component = &Component::all(&problem, &[CLOSED; 2]).unwrap()[0];
        let groups = Groups::of(&problem, &[CLOSED; 2], component);
        // The first three modes are seen along one direction only, the last two along two.
        assert_eq!(groups.omega2, [4.0, 9.0, 9.0]);
        let seen = groups.row(&rows[0]);
        assert!((seen[0].abs() - 3.0).abs() < 1e-14, "{seen:?}");
        assert_eq!(seen[1..], [1.0, 0.5]);
    }
}
