//! The laws' states during each step of a run.

use crate::history::Event;
use crate::law::State;

/// Numbers that are looked through at once for switches.
const AT_ONCE: usize = 64;

/// A row of states for each step, after one for the instant before the first.
///
/// Numbers and memories stand apart: a byte a step is all that laws without memory leave, and
/// bytes without a switch are told by comparing them with those of the step before, many at once.
#[derive(Debug, Clone)]
pub(super) struct States {
    /// Length of a row: at least one, so that steps can be counted.
    laws: usize,
    numbers: Vec<u8>,
    /// Empty where no law remembers.
    memories: Vec<[f64; 2]>,
}

/// Room for the states of some consecutive steps.
pub(crate) struct Room<'a> {
    pub numbers: &'a mut [u8],
    /// Empty where no law remembers.
    pub memories: &'a mut [[f64; 2]],
}

impl States {
    /// Room for so many laws and steps; the first row comes with [`Self::begin`].
    pub fn new(laws: usize, steps: usize) -> Self {
        let laws = laws.max(1);
        Self {
            laws,
            numbers: Vec::with_capacity((steps + 2) * laws),
            memories: Vec::new(),
        }
    }

    /// Keeps the states before the first step.
    pub fn begin(&mut self, first: &[State], remember: bool) {
        self.numbers.extend(first.iter().map(|state| state.number));
        self.numbers.resize(self.laws, 0);
        if remember {
            self.memories.extend(first.iter().map(|state| state.memory));
            self.memories.resize(self.laws, [0.0; 2]);
        }
    }

    /// How many steps there are.
    pub fn steps(&self) -> usize {
        self.numbers.len() / self.laws - 1
    }

    /// Room for the next steps.
    #[inline(always)]
    pub fn make_room(&mut self, steps: usize) -> Room<'_> {
        let old = self.numbers.len();
        let new = old + steps * self.laws;
        self.numbers.resize(new, 0);
        if !self.memories.is_empty() {
            self.memories.resize(new, [0.0; 2]);
        }
        Room {
            numbers: &mut self.numbers[old..],
            memories: self.memories.get_mut(old..).unwrap_or_default(),
        }
    }

    /// The laws' states during step n.
    pub fn at(&self, n: usize) -> impl Iterator<Item = State> {
        (0..self.laws).map(move |law| self.state(n + 1, law))
    }

    fn state(&self, row: usize, law: usize) -> State {
        let at = row * self.laws + law;
        let memory = self.memories.get(at).copied().unwrap_or_default();
        State::with_memory(self.numbers[at], memory)
    }

    /// The switches in order of time, those of one step in the order of the laws.
    pub fn events(&self, dt: f64) -> Vec<Event> {
        let mut events = Vec::new();
        let (before, after) = (&self.numbers, &self.numbers[self.laws..]);
        let pieces = before.chunks(AT_ONCE).zip(after.chunks(AT_ONCE));
        for (piece, (before, after)) in pieces.enumerate() {
            // The last piece may be shorter after than before.
            if before.starts_with(after) {
                continue;
            }
            let both = before.iter().zip(after).enumerate();
            for (i, _) in both.filter(|(_, (before, after))| before != after) {
                let at = piece * AT_ONCE + i;
                let (step, law) = (at / self.laws, at % self.laws);
                events.push(Event {
                    time: step as f64 * dt,
                    law,
                    guard: "step",
                    before: self.state(step, law),
                    after: self.state(step + 1, law),
                });
            }
        }
        events
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// States of `laws` laws that switch now and then, at many places within what is looked
    /// through at once and between two of these.
    fn state(row: usize, law: usize, period: usize) -> State {
        let number = (row + 3 * law) / period % 3;
        State::with_memory(number as u8, [row as f64, law as f64])
    }

    #[test]
    fn events_are_where_states_differ_from_those_of_the_step_before() {
        let steps = 3 * AT_ONCE + 5;
        for (laws, period) in [(1, 1), (1, 7), (1, 1000), (2, 5), (3, 64), (5, 31)] {
            let row = |n: usize| (0..laws).map(move |law| state(n, law, period));
            let mut states = States::new(laws, steps);
            states.begin(&row(0).collect::<Vec<_>>(), true);
            for n in 0..steps {
                let room = states.make_room(1);
                for (law, state) in row(n + 1).enumerate() {
                    (room.numbers[law], room.memories[law]) = (state.number, state.memory);
                }
            }
            assert_eq!(states.steps(), steps);
            let mut expected = Vec::new();
            for n in 0..steps {
                assert!(states.at(n).eq(row(n + 1)));
                for (law, (before, after)) in row(n).zip(row(n + 1)).enumerate() {
                    if before.number != after.number {
                        expected.push((n as f64 * 0.5, law, before, after));
                    }
                }
            }
            let events = states.events(0.5).into_iter();
            let found: Vec<_> = events.map(|e| (e.time, e.law, e.before, e.after)).collect();
            assert_eq!(found, expected);
        }
    }
}
