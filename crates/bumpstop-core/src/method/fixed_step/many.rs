//! Marches among many laws, where products with their rows take most of a step.

use super::laws::law_force;
use super::loads::ChangingLoads;
use super::record::StepRecord;
use super::setting::Setting;
use crate::error::Result;
use crate::forcing::Forcing;
use crate::law::{COORDINATES, Law, Local, State};
use crate::method::Observer;
use crate::number::{Block, Instructions, LANES, Lanes, Number, blocks, padded};

/// From so many laws on a step goes through their rows once; fewer are kept up with one by one.
pub(super) const MANY: usize = 4;
/// So many times eight modes move before laws read them: their part of the rows stays at hand.
const GROUP: usize = 4;

/// A scheme that is told the modal forces of a step.
pub(crate) trait Scheme<I: Instructions> {
    /// How it follows the coordinates of a law.
    type Followed: Follow;

    /// What is known of a law at t = 0.
    fn followed<P: Law>(&self, law: &P, setting: &Setting<'_, P>) -> Self::Followed;

    /// Modal displacements one step before the start.
    fn before(&self) -> &[f64];

    /// Takes off the forces of a step what matrices that couple the modes make of the motion.
    fn couple(&mut self, _load: &mut [Block]) {}

    /// Moves eight modes one step on under their forces, and returns what laws read of them.
    fn step(&mut self, block: usize, force: Lanes<I>) -> Lanes<I>;

    /// Modal displacements now.
    fn displacement(&self) -> &[Lanes<I>];
}

/// The coordinates of one law from step to step.
pub(crate) trait Follow {
    /// Positions now, in m.
    fn position(&self) -> &Local<f64>;
    /// Velocities now, in m/s.
    fn velocity(&self) -> &Local<f64>;
    /// Goes one step on with what a coordinate's row reads of the modes.
    fn follow(&mut self, coordinate: usize, read: f64);
}

/// Carries a scheme through a problem. Laws read the modes of each step as soon as these have
/// moved, a few times eight at a time, while the part of their rows that moved them is at hand.
#[inline(always)]
pub(crate) fn among_many<P: Law, I: Instructions, S: Scheme<I>>(
    mut scheme: S,
    setting: &Setting<'_, P>,
    record: &mut StepRecord,
    observer: Observer<'_>,
) -> Result<()> {
    let mut rows = Rows::<I>::new(&setting.laws, setting.system.modes());
    let same = vec![1.0; setting.system.modes()];
    let mut changing = ChangingLoads::new(setting.forcing, record.dt, &same);
    let mut load = blocks(setting.forcing.forces());
    let is_coupled = setting.system.is_coupled();
    let mut coupled = load.clone();
    let flows = setting.laws.iter().any(|law| law.flows());
    let changes = setting.forcing.varies();
    let moves = setting.moves();
    let (dt, mut step) = (record.dt, 0);
    let mut followed = Vec::new();
    for law in &setting.laws {
        followed.push(scheme.followed(*law, setting));
    }
    let mut seen = record.begin(setting, scheme.before());
    let states = seen.len().max(1);
    while let Some(stretch) = record.next_stretch() {
        stretch.observe(observer)?;
        let kept = stretch.rows.chunks_exact_mut(load.len());
        let mut memories = stretch.states.memories.chunks_exact_mut(states);
        for (kept, numbers) in kept.zip(stretch.states.numbers.chunks_exact_mut(states)) {
            if changes {
                load.copy_from_slice(changing.next());
            }
            let mut forces = rows.forces.iter_mut();
            let laws = setting.laws.iter().zip(&mut seen).zip(&followed);
            for (number, ((law, state), local)) in laws.enumerate() {
                let force = if moves {
                    let time = f64::from(step) * dt;
                    let local = [*local.position(), *local.velocity()];
                    moved_force((*law, number), state, setting.forcing, time, local)
                } else {
                    law_force(*law, state, local.position(), local.velocity())
                };
                for (to, force) in forces.by_ref().take(law.rows().len()).zip(force) {
                    *to = force;
                }
            }
            for (number, state) in numbers.iter_mut().zip(&seen) {
                *number = state.number;
            }
            if P::REMEMBERS
                && let Some(memories) = memories.next()
            {
                for (memory, state) in memories.iter_mut().zip(&seen) {
                    *memory = state.memory;
                }
            }
            step += 1;
            let push = if is_coupled {
                coupled.copy_from_slice(&load);
                scheme.couple(&mut coupled);
                &coupled
            } else {
                &load
            };
            rows.step(&mut scheme, push);
            let mut read = rows.read.iter();
            let laws = setting.laws.iter().zip(&mut followed);
            for (number, (law, local)) in laws.enumerate() {
                let before = *local.position();
                for (coordinate, read) in read.by_ref().take(law.rows().len()).enumerate() {
                    local.follow(coordinate, *read);
                }
                if flows && law.flows() {
                    let times = [f64::from(step - 1) * dt, f64::from(step) * dt];
                    let path = [before, *local.position()];
                    seen[number].memory = setting.flowed(number, seen[number], path, times);
                }
            }
            for (block, q) in kept.iter_mut().zip(scheme.displacement()) {
                q.to_block(block);
            }
        }
    }
    Ok(())
}

/// The force of a law whose obstacle may move.
#[cold]
fn moved_force<P: Law>(
    (law, number): (&P, usize),
    state: &mut State,
    forcing: &Forcing,
    time: f64,
    local: [Local<f64>; 2],
) -> Local<f64> {
    let [position, velocity] = forcing.seen_from_obstacle(number, time, local);
    law_force(law, state, &position, &velocity)
}

/// The rows of all laws, one under another, with zeros to whole lanes of them.
struct Rows<I: Instructions> {
    /// Eight columns of all rows, then the next eight.
    columns: Vec<Block>,
    /// Force along each row.
    forces: Vec<f64>,
    sums: Vec<Lanes<I>>,
    /// What each row reads.
    read: Vec<f64>,
}

impl<I: Instructions> Rows<I> {
    fn new<P: Law>(laws: &[&P], modes: usize) -> Self {
        let rows: Vec<Vec<Block>> = (laws.iter())
            .flat_map(|law| law.rows().iter().take(COORDINATES))
            .map(|row| blocks(row))
            .collect();
        let count = padded(rows.len().max(1));
        let mut columns = vec![[0.0; LANES]; count * modes.div_ceil(LANES)];
        for (block, column) in columns.chunks_exact_mut(count).enumerate() {
            for (to, row) in column.iter_mut().zip(&rows) {
                *to = row[block];
            }
        }
        Self {
            columns,
            forces: vec![0.0; count],
            sums: vec![Lanes::of(0.0); count],
            read: vec![0.0; count],
        }
    }

    /// Moves the modes one step on under forces and loads, and reads them.
    #[inline(always)]
    fn step<S: Scheme<I>>(&mut self, scheme: &mut S, load: &[Block]) {
        self.sums.fill(Lanes::of(0.0));
        let count = self.forces.len();
        let groups = self.columns.chunks(GROUP * count);
        for (group, (columns, loads)) in groups.zip(load.chunks(GROUP)).enumerate() {
            let mut moved = [Lanes::of(0.0); GROUP];
            let blocks = columns.chunks_exact(count).zip(loads).zip(&mut moved);
            for (k, ((column, load), moved)) in blocks.enumerate() {
                let push = Lanes::of_block(load) + pushed(column, &self.forces);
                *moved = scheme.step(GROUP * group + k, push);
            }
            read(columns, &moved, &mut self.sums);
        }
        let eights = self.sums.as_chunks::<LANES>().0.iter();
        for (sums, read) in eights.zip(self.read.as_chunks_mut::<LANES>().0) {
            *read = Lanes::totals(*sums);
        }
    }
}

/// The forces of all rows on eight modes.
#[inline(always)]
fn pushed<I: Instructions>(column: &[Block], forces: &[f64]) -> Lanes<I> {
    let mut pushes = [Lanes::of(0.0); 4]; // sums do not wait for each other
    let eights = column.as_chunks::<LANES>().0;
    for (rows, forces) in eights.iter().zip(forces.as_chunks::<LANES>().0) {
        for k in 0..LANES {
            let row = Lanes::of_block(&rows[k]);
            pushes[k % 4] = row.mul_add(Lanes::of(forces[k]), pushes[k % 4]);
        }
    }
    (pushes[0] + pushes[1]) + (pushes[2] + pushes[3])
}

/// Adds to the sums of all rows what they read of the modes of a group: eight rows at a time,
/// whose sums stay in registers.
#[inline(always)]
fn read<I: Instructions>(columns: &[Block], moved: &[Lanes<I>], sums: &mut [Lanes<I>]) {
    let count = sums.len();
    for (eight, sums) in sums.as_chunks_mut::<LANES>().0.iter_mut().enumerate() {
        let mut own = *sums;
        for (column, moved) in columns.chunks_exact(count).zip(moved) {
            let rows = &column.as_chunks::<LANES>().0[eight];
            for (row, sum) in rows.iter().zip(&mut own) {
                *sum = Lanes::of_block(row).mul_add(*moved, *sum);
            }
        }
        *sums = own;
    }
}
