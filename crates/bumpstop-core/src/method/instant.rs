//! What the equations of motion say of the laws' local motion at one instant, without a spectrum.

use crate::history::Event;
use crate::law::{Affine, COORDINATES, Law, Local, LocalMotion, Piece, State, project};
use crate::number::Dual;
use crate::problem::Problem;
use crate::rigid::Directions;
use crate::system::ModalSystem;

/// The structure's state at an instant.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Moment<'a> {
    /// In s since the start of the run.
    pub time: f64,
    /// Modal displacement and velocity.
    pub displacement: &'a [f64],
    pub velocity: &'a [f64],
}

/// Sets the laws' states at the start: as the problem tells them, or each from the motion that the structure would have without
/// that law; returns whether one of them changes. One that is just touched is decided by
/// accelerations, and so by what the others push: they are gone through until nothing changes.
/// Rigid stops stay as they are, and push with the reactions of those that rest.
pub(crate) fn initial_states<L: Law>(
    problem: &Problem<L>,
    states: &mut [State],
    moment: Moment<'_>,
) -> bool {
    let soft = |law: &L| law.restitution().is_none();
    if !problem.states.is_empty() {
        let laws = problem.laws.iter().zip(&problem.states);
        for (state, (_, told)) in states
            .iter_mut()
            .zip(laws)
            .filter(|(_, (law, _))| soft(law))
        {
            *state = *told;
        }
        return false;
    }
    let mut changes = false;
    for _ in 0..problem.laws.len() {
        let mut settled = true;
        for (index, law) in problem.laws.iter().enumerate().filter(|(_, law)| soft(law)) {
            let mut free = seen_by(problem, index, moment);
            if !law.starts_by_velocity(&free) {
                free = local_motion(problem, states, Some(index), index, moment);
            }
            let state = law.initial_state(&free, |state| {
                acting(problem, states, (index, state), moment)
            });
            settled &= state == states[index];
            states[index] = state;
        }
        if settled {
            break;
        }
        changes = true;
    }
    changes
}

/// Lets laws whose memory is not told by guards go on behind an instant at which velocities, those
/// of the structure or of obstacles, may have jumped; returns the switches.
#[cold]
pub(crate) fn after_jump<L: Law>(
    problem: &Problem<L>,
    states: &[State],
    before: &[f64],
    moment: Moment<'_>,
) -> Vec<Event> {
    let Moment {
        time,
        displacement,
        velocity,
    } = moment;
    let mut events = Vec::new();
    for (index, (law, state)) in problem.laws.iter().zip(states).enumerate() {
        // Just before, an obstacle is on the course that ends.
        let [_, was] = problem.local(index, time.next_down(), displacement, before);
        let [position, is] = problem.local(index, time, displacement, velocity);
        let after = law.after_jump(*state, &position, [&was, &is]);
        if after != *state {
            events.push(Event {
                time,
                law: index,
                guard: "stick",
                before: *state,
                after,
            });
        }
    }
    events
}

/// Position and velocity of one law's local coordinates, without what follows of forces.
fn seen_by<L: Law>(problem: &Problem<L>, law: usize, moment: Moment<'_>) -> LocalMotion {
    let (q, v) = (moment.displacement, moment.velocity);
    let [position, velocity] = problem.local(law, moment.time, q, v);
    let mut motion = LocalMotion::of(position, velocity);
    for row in problem.laws[law].rows() {
        for (factor, (q, v)) in row.iter().zip(q.iter().zip(v)) {
            motion.zero[0] += ROUNDING * (factor * q).abs();
            motion.zero[1] += ROUNDING * (factor * v).abs();
        }
    }
    if problem.forcing.varies() {
        let size = |motion: &Local<f64>| motion.iter().map(|x| x.abs()).sum::<f64>();
        let [moved, rate, ..] = problem.forcing.motion(law, moment.time);
        motion.zero[0] += ROUNDING * size(&moved);
        motion.zero[1] += ROUNDING * size(&rate);
    }
    motion
}

/// The local motion of one law if it goes on in a given state, the others in theirs.
#[cold]
pub(crate) fn acting<L: Law>(
    problem: &Problem<L>,
    states: &[State],
    (law, state): (usize, State),
    moment: Moment<'_>,
) -> LocalMotion {
    let mut following = states.to_vec();
    following[law] = state;
    local_motion(problem, &following, None, law, moment)
}

/// Slope and curvature of a function of one law's local motion; zero where they are rounding.
/// `None` for functions of accelerations, whose curvature is a derivative too far.
#[cold]
pub(crate) fn rates<L: Law>(
    problem: &Problem<L>,
    states: &[State],
    law: usize,
    function: &Affine,
    moment: Moment<'_>,
) -> Option<[f64; 2]> {
    if function.acceleration != [0.0; COORDINATES] {
        return None;
    }
    let motion = local_motion(problem, states, None, law, moment);
    let of_order = |order: usize| {
        let (mut value, mut zero) = (0.0, 0.0);
        for i in 0..COORDINATES {
            value += function.position[i] * motion.derivatives[order][i];
            value += function.velocity[i] * motion.derivatives[order + 1][i];
            zero += function.position[i].abs() * motion.zero[order];
            zero += function.velocity[i].abs() * motion.zero[order + 1];
        }
        if value.abs() > zero { value } else { 0.0 }
    };
    Some([of_order(1), of_order(2)])
}

/// A sum below this part of the sizes of its terms counts as zero.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Numbers that take no memory from the heap: to ask for it takes as long as the sums of a few
/// modes.
const SMALL: usize = 128;

/// The local motion of one law, all laws but `without` acting.
fn local_motion<L: Law>(
    problem: &Problem<L>,
    states: &[State],
    without: Option<usize>,
    of: usize,
    moment: Moment<'_>,
) -> LocalMotion {
    let (q, v) = (moment.displacement, moment.velocity);
    let modes = q.len();
    let (mut small, mut large) = ([0.0; SMALL], Vec::new());
    let room = if 4 * modes <= SMALL {
        &mut small[..4 * modes]
    } else {
        large.resize(4 * modes, 0.0);
        &mut large[..]
    };
    let (first, second) = room.split_at_mut(2 * modes);
    let (mut accelerations, mut jerks) = (Sums::new(first), Sums::new(second));
    let forcing = &problem.forcing;
    if forcing.varies() {
        let [forces, rates] = forcing.around(moment.time);
        accelerations.add(&forces);
        jerks.add(&rates);
    } else {
        accelerations.add(forcing.forces());
    }
    accelerations.add_structure(&problem.system, q, v);
    for rotation in problem.system.rotations() {
        let turning = rotation.around(moment.time);
        for (mode, parts) in turning.forces(moment.time, [q, v]).enumerate() {
            accelerations.add_to(mode, parts.sum());
        }
    }
    for (index, law, state) in others(problem, states, without) {
        let [position, velocity] = problem.local(index, moment.time, q, v);
        accelerations.add_law(law, &law.force(state, &position, &velocity));
    }
    let held = Directions::held(problem, states);
    accelerations.react(&held);
    let a = &*accelerations.values;
    jerks.add_structure(&problem.system, v, a);
    for rotation in problem.system.rotations() {
        let turning = rotation.around(moment.time);
        for (mode, rate) in turning.force_rates(moment.time, [q, v, a]).enumerate() {
            jerks.add_to(mode, rate);
        }
    }
    for (index, law, state) in others(problem, states, without) {
        let mut motion = [project(law, q), project(law, v), project(law, a)];
        if forcing.varies() {
            let moved = forcing.motion(index, moment.time);
            for (local, moved) in motion.iter_mut().zip(moved) {
                for (local, moved) in local.iter_mut().zip(moved) {
                    *local -= moved;
                }
            }
        }
        jerks.add_law(law, &force_rate(law, state, motion));
    }
    jerks.react(&held);
    let mut motion = LocalMotion::default();
    for (coordinate, row) in problem.laws[of].rows().iter().enumerate() {
        let (mut derivatives, mut zero) = ([0.0; 4], [0.0; 4]);
        for (mode, factor) in row.iter().enumerate() {
            let values = [q[mode], v[mode], a[mode], jerks.values[mode]];
            let (size, jerk_size) = (accelerations.sizes[mode], jerks.sizes[mode]);
            let sizes = [q[mode].abs(), v[mode].abs(), size, jerk_size];
            for order in 0..4 {
                derivatives[order] += factor * values[order];
                zero[order] += ROUNDING * factor.abs() * sizes[order];
            }
        }
        motion.add(coordinate, derivatives, zero);
    }
    if forcing.varies() {
        let moved = forcing.motion(of, moment.time);
        for coordinate in 0..COORDINATES {
            let along = moved.map(|order| order[coordinate]);
            let zero = along.map(|x| ROUNDING * x.abs());
            motion.add(coordinate, along.map(|x| -x), zero);
        }
    }
    motion
}

/// The rate of a law's force, from local position, velocity and acceleration.
pub(crate) fn force_rate<L: Law>(
    law: &L,
    state: State,
    [position, velocity, acceleration]: [Local<f64>; 3],
) -> Local<f64> {
    if let Some(piece) = law.piece(state) {
        let rate = Piece {
            constant: [0.0; COORDINATES],
            ..piece
        };
        return rate.force(&velocity, &acceleration);
    }
    let (position, velocity) = (along(position, velocity), along(velocity, acceleration));
    law.force(state, &position, &velocity)
        .map(|force| force.slope)
}

/// The rate of a law's force along the normal of its contact; see [`force_rate`].
pub(crate) fn push_rate<L: Law>(law: &L, state: State, motion: [Local<f64>; 3]) -> f64 {
    if law.piece(state).is_some() {
        return force_rate(law, state, motion)[0];
    }
    let [position, velocity, acceleration] = motion;
    let (position, velocity) = (along(position, velocity), along(velocity, acceleration));
    let force = law.force(state, &position, &velocity);
    law.on_contact(state, &position, &force)[0].slope
}

/// Local numbers with their rates.
fn along(values: Local<f64>, slopes: Local<f64>) -> Local<Dual> {
    std::array::from_fn(|i| Dual {
        value: values[i],
        slope: slopes[i],
    })
}

/// The laws with their numbers, without one where that is told, and their states.
fn others<'a, L: Law>(
    problem: &'a Problem<L>,
    states: &'a [State],
    without: Option<usize>,
) -> impl Iterator<Item = (usize, &'a L, State)> {
    let all = problem.laws.iter().zip(states).enumerate();
    all.filter(move |(index, _)| Some(*index) != without)
        .map(|(index, (law, state))| (index, law, *state))
}

/// Sums, one for each mode, and the sizes of what was added to each.
struct Sums<'a> {
    values: &'a mut [f64],
    sizes: &'a mut [f64],
}

impl<'a> Sums<'a> {
    /// Sums in a room of zeros.
    fn new(room: &'a mut [f64]) -> Self {
        let (values, sizes) = room.split_at_mut(room.len() / 2);
        Self { values, sizes }
    }

    fn add_to(&mut self, mode: usize, part: f64) {
        self.values[mode] += part;
        self.sizes[mode] += part.abs();
    }

    fn add(&mut self, parts: &[f64]) {
        for (mode, part) in parts.iter().enumerate() {
            self.add_to(mode, *part);
        }
    }

    /// What the structure does to the modes: the motion and its rate, or those of a higher order.
    fn add_structure(&mut self, system: &ModalSystem, x: &[f64], rate: &[f64]) {
        let (omega2, damping) = (system.omega2(), system.damping());
        let sums = self.values.iter_mut().zip(&mut *self.sizes);
        let motion = x.iter().zip(rate).zip(omega2.iter().zip(damping));
        for ((value, size), ((x, rate), (omega2, damping))) in sums.zip(motion) {
            for part in [-omega2 * x, -damping * rate] {
                *value += part;
                *size += part.abs();
            }
        }
        for (matrix, motion) in [(system.coupling(), rate), (system.circulatory(), x)] {
            if let Some(matrix) = matrix {
                for mode in 0..motion.len() {
                    self.add_to(mode, -matrix.product(mode, motion));
                }
            }
        }
    }

    /// A law's force on the modes.
    fn add_law<L: Law>(&mut self, law: &L, force: &Local<f64>) {
        for (row, force) in law.rows().iter().zip(force) {
            for (mode, factor) in row.iter().enumerate() {
                self.add_to(mode, factor * force);
            }
        }
    }

    /// Adds the reactions that keep what is held where it is, or their rates.
    fn react(&mut self, held: &Directions<'_>) {
        if held.rows.is_empty() {
            return;
        }
        let reactions = held.reactions(self.values);
        for (row, reaction) in held.rows.iter().zip(reactions) {
            for (mode, factor) in row.iter().enumerate() {
                self.add_to(mode, factor * reaction);
            }
        }
    }
}
