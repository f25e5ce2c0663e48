//! The equations of motion as a system of first order.
//!
//! Its numbers are modal displacements, modal velocities, memories of laws that follow rate
//! equations, and the works of the energy ledger, each integrated from its own power.

use super::loads::Loads;
use super::slopes::slopes;
use crate::energy::{self, Ledger};
use crate::law::{COORDINATES, Law, Local, Piece, State, power, project};
use crate::method::piecewise_linear::Works;
use crate::problem::Problem;
use crate::rotation::Turning;

/// Where the numbers stand.
#[derive(Debug, Clone)]
pub(crate) struct Layout {
    pub modes: usize,
    /// Where the memory of each law that flows begins.
    pub memories: Vec<Option<usize>>,
    /// Where the structure's own energies begin, if they are told and not made of the motion.
    told: Option<usize>,
    /// Where the works begin; numbers from there on do not feed back.
    pub works: usize,
}

/// Numbers of a memory.
const MEMORY: usize = 2;

/// Energies of the structure that a record may be told: kinetic and elastic, and what was lost to
/// damping and given by loads.
pub(crate) const TOLD: usize = 4;

/// Works beside those of each law.
const WORKS: usize = 4;
const MODAL: usize = 0;
const LOADS: usize = 1;
const CIRCULATORY: usize = 2;
const OBSTACLES: usize = 3;

impl Layout {
    pub(crate) fn new<L: Law>(problem: &Problem<L>) -> Self {
        let modes = problem.system.modes();
        let mut works = 2 * modes;
        let memories = (problem.laws.iter())
            .map(|law| {
                law.flows().then(|| {
                    works += MEMORY;
                    works - MEMORY
                })
            })
            .collect();
        Self {
            modes,
            memories,
            told: None,
            works,
        }
    }

    /// The same for a motion that is but a part of the structure's, whose energies are told.
    pub(crate) fn told<L: Law>(problem: &Problem<L>) -> Self {
        let layout = Self::new(problem);
        Self {
            told: Some(layout.works),
            works: layout.works + TOLD,
            ..layout
        }
    }

    /// Whether accelerations and energies are told: the problem's equations are then not those of
    /// the structure.
    pub(crate) fn is_told(&self) -> bool {
        self.told.is_some()
    }

    /// How many numbers there are.
    pub(crate) fn size(&self) -> usize {
        self.works + WORKS + self.memories.len()
    }

    /// Where the dissipation of a law stands.
    pub(crate) fn dissipated(&self, law: usize) -> usize {
        self.works + WORKS + law
    }

    /// Modal displacements and velocities.
    pub(crate) fn motion<'a>(&self, numbers: &'a [f64]) -> [&'a [f64]; 2] {
        let (q, rest) = numbers.split_at(self.modes);
        [q, &rest[..self.modes]]
    }

    /// A law's state with the memory that the numbers tell.
    pub(crate) fn state(&self, law: usize, state: State, numbers: &[f64]) -> State {
        match self.memories[law] {
            Some(at) => State {
                memory: [numbers[at], numbers[at + 1]],
                ..state
            },
            None => state,
        }
    }

    /// Puts the memory of a state that begins among the numbers.
    pub(crate) fn remember(&self, law: usize, state: State, numbers: &mut [f64]) {
        if let Some(at) = self.memories[law] {
            numbers[at..at + MEMORY].copy_from_slice(&state.memory);
        }
    }

    /// Adds what a stretch of time did that was not integrated.
    pub(crate) fn add_works(&self, done: &Works, numbers: &mut [f64]) {
        let works = &mut numbers[self.works..];
        works[MODAL] += done.modal;
        works[LOADS] += done.loads;
        works[CIRCULATORY] += done.circulatory;
        works[OBSTACLES] += done.obstacles;
        for (total, law) in works[WORKS..].iter_mut().zip(&done.laws) {
            *total += law;
        }
    }

    /// The energy ledger that the numbers tell.
    pub(crate) fn ledger<L: Law>(
        &self,
        problem: &Problem<L>,
        time: f64,
        states: &[State],
        numbers: &[f64],
    ) -> Ledger {
        let [q, v] = self.motion(numbers);
        let works = &numbers[self.works..];
        let [kinetic, elastic, damped, given] = match self.told {
            Some(at) => std::array::from_fn(|energy| numbers[at + energy]),
            None => {
                let (kinetic, elastic) = energy::of_structure(problem.system.omega2(), q, v);
                let given = problem.forcing.work(&problem.displacement, q) + works[LOADS];
                [kinetic, elastic, works[MODAL], given]
            }
        };
        let laws = problem.laws.iter().enumerate();
        Ledger {
            kinetic,
            elastic,
            law_stored: laws
                .map(|(index, law)| {
                    let [position, _] = problem.local(index, time, q, v);
                    law.stored(self.state(index, states[index], numbers), &position)
                })
                .collect(),
            modal_dissipation: damped,
            law_dissipated: works[WORKS..].to_vec(),
            load_work: given,
            circulatory_work: works[CIRCULATORY],
            obstacle_work: works[OBSTACLES],
        }
    }
}

/// The rates of all numbers.
pub(crate) struct Equations<'a, L> {
    pub problem: &'a Problem<L>,
    pub layout: Layout,
    pub loads: Loads<'a>,
    /// Shafts whose speed changes.
    turning: Vec<Turning<'a>>,
    /// The laws' states, and their matrices where these say all.
    states: Vec<State>,
    pieces: Vec<Option<Piece>>,
    moves: bool,
    /// The loads that change, unbalances among them, at the time the rates were taken last.
    changing: Vec<f64>,
}

impl<'a, L: Law> Equations<'a, L> {
    pub(crate) fn new(problem: &'a Problem<L>, layout: Layout) -> Self {
        Self {
            problem,
            layout,
            loads: Loads::new(&problem.forcing),
            turning: Vec::new(),
            states: Vec::new(),
            pieces: Vec::new(),
            moves: problem.forcing.moved().next().is_some(),
            changing: vec![0.0; problem.system.modes()],
        }
    }

    /// Turns to the stretch of time from an instant on, in which loads and shafts do not change
    /// their course; returns where it ends.
    pub(crate) fn turn(&mut self, time: f64) -> f64 {
        self.turning.clear();
        let rotations = self.problem.system.rotations().iter();
        (self.turning).extend(rotations.map(|rotation| rotation.around(time)));
        let ends = self.turning.iter().map(Turning::end);
        ends.fold(self.loads.turn(time), f64::min)
    }

    /// Turns to other states of the laws.
    pub(crate) fn take_states(&mut self, states: &[State]) {
        self.states.clear();
        self.states.extend_from_slice(states);
        let both = self.problem.laws.iter().zip(states);
        self.pieces.clear();
        // The matrices go on beyond the guards, where a law's own force is cut off: a step that
        // passes a guard stays smooth.
        self.pieces.extend(both.map(|(law, state)| {
            let remembers = law.flows();
            law.piece(*state).filter(|_| !remembers)
        }));
    }

    /// Local position and velocity of a law, from its obstacle, and the velocity of that.
    fn local(&self, law: usize, time: f64, [q, v]: [&[f64]; 2]) -> [Local<f64>; 3] {
        let which = &self.problem.laws[law];
        let (mut position, mut velocity) = (project(which, q), project(which, v));
        let mut speed = Local::default();
        if self.moves {
            let moved;
            [moved, speed] = self.loads.motion(law, time);
            for (c, position) in position.iter_mut().enumerate() {
                *position -= moved[c];
                velocity[c] -= speed[c];
            }
        }
        [position, velocity, speed]
    }

    /// What errors of each memory are measured by besides its own size, at a time.
    pub(crate) fn memory_sizes(&self, time: f64, numbers: &[f64], to: &mut [f64]) {
        let layout = &self.layout;
        for (index, law) in self.problem.laws.iter().enumerate() {
            if let Some(at) = layout.memories[index] {
                let [position, ..] = self.local(index, time, layout.motion(numbers));
                let sizes = law.memory_sizes(&position);
                to[at - 2 * layout.modes..][..MEMORY].copy_from_slice(&sizes);
            }
        }
    }

    /// The rates of the numbers at a time.
    pub(crate) fn rates(&mut self, time: f64, numbers: &[f64], to: &mut [f64]) {
        let layout = &self.layout;
        let modes = layout.modes;
        let [q, v] = layout.motion(numbers);
        let (motion, works) = to.split_at_mut(layout.works);
        let (rates, rest) = motion.split_at_mut(modes);
        let (accelerations, memories) = rest.split_at_mut(modes);
        works.fill(0.0);
        rates.copy_from_slice(v);
        accelerations.copy_from_slice(self.problem.forcing.forces());
        self.changing.fill(0.0);
        if self.loads.vary() {
            self.loads.changing(time, &mut self.changing);
        }
        for turning in &self.turning {
            let modes = accelerations.iter_mut().zip(&mut self.changing).zip(v);
            for (((a, p), v), parts) in modes.zip(turning.forces(time, [q, v])) {
                *a += parts.gyroscopic + parts.accelerating;
                *p += parts.unbalance;
                // Gyroscopic forces do no work.
                works[CIRCULATORY] += parts.accelerating * v;
            }
        }
        for (a, p) in accelerations.iter_mut().zip(&self.changing) {
            *a += p;
        }
        works[LOADS] = self.load_power(v);
        self.add_structure([q, v], accelerations, works);
        for (index, law) in self.problem.laws.iter().enumerate() {
            let [position, velocity, speed] = self.local(index, time, [q, v]);
            let state = layout.state(index, self.states[index], numbers);
            let force = match &self.pieces[index] {
                Some(piece) => piece.force(&position, &velocity),
                None => law.force(state, &position, &velocity),
            };
            for (row, force) in law.rows().iter().zip(force) {
                for (a, r) in accelerations.iter_mut().zip(row) {
                    *a += r * force;
                }
            }
            works[OBSTACLES] += power(&force, &speed);
            works[WORKS + index] = law.dissipated_power(state, &position, &velocity);
            if let Some(at) = layout.memories[index] {
                let rates = law.memory_rates(state, &position, &velocity);
                memories[at - 2 * modes..][..MEMORY].copy_from_slice(&rates);
            }
        }
    }

    /// The power of the changing loads that the rates were taken with last, in W.
    fn load_power(&self, velocity: &[f64]) -> f64 {
        let both = self.changing.iter().zip(velocity);
        both.map(|(p, v)| p * v).sum()
    }

    /// Corrects the power of these loads among the rates, for other numbers than those were taken of.
    pub(crate) fn correct_load_power(&self, numbers: &[f64], rates: &mut [f64]) {
        let [_, velocity] = self.layout.motion(numbers);
        rates[self.layout.works + LOADS] = self.load_power(velocity);
    }

    /// How the laws answer to motions in their present states: bounds of the stiffness and of the
    /// damping that they add to any motion of the modes, in rad2/s2 and rad/s.
    pub(crate) fn answers(&self, time: f64, numbers: &[f64]) -> [f64; 2] {
        let motion = self.layout.motion(numbers);
        let mut sums = [0.0; 2];
        for turning in &self.turning {
            let [damping, stiffness] = turning.sizes(time);
            // A quarter turn of the shaft is a quarter of a period of its forces.
            sums[0] += stiffness + turning.speed(time).powi(2);
            sums[1] += damping;
        }
        for (index, law) in self.problem.laws.iter().enumerate() {
            let [position, velocity, _] = self.local(index, time, motion);
            let state = self.layout.state(index, self.states[index], numbers);
            add_answers(law, &slopes(law, state, [position, velocity]), &mut sums);
        }
        sums
    }

    /// The same of the laws alone that are linear in their present states, wherever in these.
    pub(crate) fn linear_answers(&self) -> [f64; 2] {
        let mut sums = [0.0; 2];
        for (law, piece) in self.problem.laws.iter().zip(&self.pieces) {
            if let Some(piece) = piece {
                add_answers(law, &[piece.stiffness, piece.damping], &mut sums);
            }
        }
        sums
    }

    /// What stiffness, damping and the matrices that couple modes do.
    fn add_structure(&self, [q, v]: [&[f64]; 2], to: &mut [f64], works: &mut [f64]) {
        let system = &self.problem.system;
        let own = system.omega2().iter().zip(system.damping());
        for ((a, (w2, c)), (q, v)) in to.iter_mut().zip(own).zip(q.iter().zip(v)) {
            *a -= w2 * q + c * v;
            works[MODAL] += c * v * v;
        }
        for (matrix, motion, work, sign) in [
            (system.coupling(), v, MODAL, 1.0),
            (system.circulatory(), q, CIRCULATORY, -1.0),
        ] {
            if let Some(matrix) = matrix {
                for (mode, (a, v)) in to.iter_mut().zip(v).enumerate() {
                    let force = matrix.product(mode, motion);
                    *a -= force;
                    works[work] += sign * force * v;
                }
            }
        }
    }
}

/// Adds bounds of what a law's stiffness and damping matrices are to motions of the modes.
fn add_answers<L: Law>(law: &L, answers: &[[Local<f64>; COORDINATES]; 2], sums: &mut [f64; 2]) {
    let length = |row: &[f64]| row.iter().map(|x| x * x).sum::<f64>().sqrt();
    let lengths: Local<f64> =
        std::array::from_fn(|c| law.rows().get(c).map_or(0.0, |row| length(row)));
    for (sum, answers) in sums.iter_mut().zip(answers) {
        for (row, i) in answers.iter().zip(lengths) {
            let row = row.iter().zip(lengths);
            *sum += row.map(|(slope, j)| (slope * i * j).abs()).sum::<f64>();
        }
    }
}
