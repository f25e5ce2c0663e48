//! What a run keeps: the polynomial of every step, and its flights.

use super::contact::ContactReader;
use super::dense::{Dense, cubic_rates};
use super::equations::Layout;
use super::percussion::{self, Percussion};
use crate::energy::{self, Ledger};
use crate::error::{Error, Result};
use crate::impacts::Impact;
use crate::law::{Law, State};
use crate::method::piecewise_linear::{FlightRecord, Workspace};
use crate::problem::Problem;

/// The most memory that a record may take, in bytes.
const LARGEST_RECORD: usize = 4 << 30;

/// The steps of a run.
#[derive(Debug, Clone)]
pub struct PolynomialRecord {
    pub(crate) layout: Layout,
    degree: usize,
    /// Steps, some of them in parts that were kept one by one.
    steps: usize,
    list: Vec<Step>,
    /// The polynomials of steps, and the numbers at the start of flights.
    rows: Vec<f64>,
    flights: FlightRecord,
    /// States of all laws; steps between two switches share them.
    states: Vec<State>,
    /// Impulses of rigid stops, in order of time.
    percussions: Vec<Percussion>,
}

/// A step, as far as it was gone.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Step {
    pub start: f64,
    pub end: f64,
    course: Course,
    /// Where its rows begin.
    rows: usize,
    /// Where its states begin.
    states: usize,
}

/// How the motion goes on in a step.
#[derive(Debug, Clone, Copy)]
enum Course {
    /// A polynomial of this width in s, which may go on beyond the end.
    Polynomial(f64),
    /// The flight of this number.
    Flight(usize),
}

impl PolynomialRecord {
    pub(crate) fn new(layout: Layout, degree: usize) -> Self {
        Self {
            layout,
            degree,
            steps: 0,
            list: Vec::new(),
            rows: Vec::new(),
            flights: FlightRecord::default(),
            states: Vec::new(),
            percussions: Vec::new(),
        }
    }

    /// Takes note of an impulse.
    pub(crate) fn strike(&mut self, percussion: Percussion) {
        self.percussions.push(percussion);
    }

    /// Refuses to make room for more steps than memory holds.
    ///
    /// # Errors
    /// [`Error::TooManySteps`]
    pub(crate) fn check_room(layout: &Layout, degree: usize, steps: f64) -> Result<()> {
        let bytes = steps * ((degree + 1) * layout.size() * size_of::<f64>()) as f64;
        if bytes > LARGEST_RECORD as f64 {
            return Err(Error::TooManySteps {
                steps: steps as usize,
                modes: layout.modes,
                gibibytes: bytes / (1u64 << 30) as f64,
            });
        }
        Ok(())
    }

    /// Counts a step.
    pub(crate) fn count_step(&mut self) {
        self.steps += 1;
    }

    /// Takes the flights that were added by their numbers.
    pub(crate) fn keep_flights(&mut self, flights: FlightRecord) {
        self.flights = flights;
    }

    /// Keeps a step, or a part of one, of width h up to a time.
    ///
    /// # Errors
    /// [`Error::LongRecord`] where there is no more room.
    pub(crate) fn add(
        &mut self,
        start: f64,
        h: f64,
        end: f64,
        dense: Dense<'_>,
        states: &[State],
    ) -> Result<()> {
        self.add_course([start, end], Course::Polynomial(h), dense.rows, states)
    }

    /// Keeps a flight, by its number, with the numbers at its start.
    ///
    /// # Errors
    /// [`Error::LongRecord`] where there is no more room.
    pub(crate) fn add_flight(
        &mut self,
        span: [f64; 2],
        number: usize,
        numbers: &[f64],
        states: &[State],
    ) -> Result<()> {
        self.add_course(span, Course::Flight(number), numbers, states)
    }

    fn add_course(
        &mut self,
        [start, end]: [f64; 2],
        course: Course,
        rows: &[f64],
        states: &[State],
    ) -> Result<()> {
        self.make_room(rows.len())
            .ok_or(Error::LongRecord { time: start })?;
        let before = self.list.last().map(|step| step.states);
        let states_at = match before.filter(|at| &self.states[*at..] == states) {
            Some(known) => known,
            None => {
                self.states.extend_from_slice(states);
                self.states.len() - states.len()
            }
        };
        self.list.push(Step {
            start,
            end,
            course,
            rows: self.rows.len(),
            states: states_at,
        });
        self.rows.extend_from_slice(rows);
        Ok(())
    }

    /// Makes room for the numbers of one more step, twice as much as there was, up to the largest
    /// record; `None` where that or the memory does not suffice.
    fn make_room(&mut self, more: usize) -> Option<()> {
        let (length, capacity) = (self.rows.len(), self.rows.capacity());
        let most = (LARGEST_RECORD / size_of::<f64>()).checked_sub(length)?;
        if more > most {
            return None;
        }
        if length + more > capacity {
            let room = capacity.max(more).min(most);
            self.rows.try_reserve_exact(room).ok()?;
        }
        Some(())
    }

    /// How many steps there are.
    pub fn steps(&self) -> usize {
        self.steps
    }

    pub(crate) fn list(&self) -> &[Step] {
        &self.list
    }

    /// All numbers and the laws' states in a step at a time; works in a flight are those at its start.
    pub(crate) fn read(&self, step: usize, time: f64, moment: &mut Reading) {
        let Step {
            start,
            course,
            states,
            ..
        } = self.list[step];
        match course {
            Course::Polynomial(h) => (self.dense(step)).at((time - start) / h, &mut moment.numbers),
            Course::Flight(number) => {
                let start = self.numbers_at_start(step);
                moment.numbers.copy_from_slice(start);
                let (q, rest) = moment.numbers.split_at_mut(self.layout.modes);
                let motion = [q, &mut rest[..self.layout.modes]];
                self.flights.motion(number, time, &mut moment.work, motion);
            }
        }
        let known = self.states[states..].iter().enumerate();
        for (to, (law, state)) in moment.states.iter_mut().zip(known) {
            *to = self.layout.state(law, *state, &moment.numbers);
        }
    }

    /// The polynomial of a step.
    fn dense(&self, step: usize) -> Dense<'_> {
        let size = self.layout.size();
        let rows = (self.degree + 1) * size;
        Dense {
            rows: &self.rows[self.list[step].rows..][..rows],
            size,
        }
    }

    fn numbers_at_start(&self, flight: usize) -> &[f64] {
        &self.rows[self.list[flight].rows..][..self.layout.size()]
    }

    /// Room for what is read at one instant.
    pub(crate) fn reading(&self) -> Reading {
        Reading {
            numbers: vec![0.0; self.layout.size()],
            states: vec![State::FIRST; self.layout.memories.len()],
            work: Workspace::default(),
        }
    }

    /// The number of the step at a time: the last one that has started.
    fn step_at(&self, time: f64) -> usize {
        self.list.partition_point(|step| step.start <= time).max(1) - 1
    }

    /// Shows modal displacement, velocity and law states at each time.
    pub(crate) fn visit(&self, times: &[f64], mut see: impl FnMut(f64, &[f64], &[f64], &[State])) {
        let mut reading = self.reading();
        for &time in times {
            self.read(self.step_at(time), time, &mut reading);
            let [q, v] = self.layout.motion(&reading.numbers);
            see(time, q, v, &reading.states);
        }
    }

    /// Shows the slopes of the velocities at each time.
    pub(crate) fn slopes(&self, times: &[f64], mut see: impl FnMut(&[f64])) {
        let modes = self.layout.modes;
        let mut slopes = vec![0.0; 2 * modes];
        for &time in times {
            self.slope(self.step_at(time), time, &mut slopes);
            see(&slopes[modes..]);
        }
    }

    /// The slopes of the numbers in a step at a time, as far as there is room for them; the
    /// polynomials are cubics.
    pub(crate) fn slope(&self, step: usize, time: f64, to: &mut [f64]) {
        debug_assert_eq!(self.degree, 3);
        let Step { start, course, .. } = self.list[step];
        let Course::Polynomial(h) = course else {
            unreachable!("schemes with cubic steps do not fly")
        };
        cubic_rates(self.dense(step), (time - start) / h, h, to);
    }

    /// The energy ledger at each time.
    pub(crate) fn ledgers<L: Law>(&self, problem: &Problem<L>, times: &[f64]) -> Vec<Ledger> {
        let mut reading = self.reading();
        let at = |time: &f64| self.ledger(problem, self.step_at(*time), *time, &mut reading);
        times.iter().map(at).collect()
    }

    fn ledger<L: Law>(
        &self,
        problem: &Problem<L>,
        step: usize,
        time: f64,
        reading: &mut Reading,
    ) -> Ledger {
        self.read(step, time, reading);
        let Reading {
            numbers,
            states,
            work,
        } = reading;
        if let Course::Flight(number) = self.list[step].course {
            let works = self.flights.works(problem, number, time, work);
            self.layout.add_works(&works, numbers);
        }
        self.layout.ledger(problem, time, states, numbers)
    }

    /// Largest imbalance at both ends of all steps, relative to the largest energy.
    pub(crate) fn energy_residual<L: Law>(&self, problem: &Problem<L>) -> f64 {
        let mut reading = self.reading();
        let ends = self.list.iter().enumerate();
        let ends = ends.flat_map(|(number, step)| [(number, step.start), (number, step.end)]);
        let ledgers: Vec<Ledger> = ends
            .map(|(step, time)| self.ledger(problem, step, time, &mut reading))
            .collect();
        energy::residual(ledgers.iter())
    }

    /// Impacts of one law, in order of closing.
    pub(crate) fn impacts<L: Law>(&self, problem: &Problem<L>, law: usize) -> Vec<Impact> {
        if problem.laws[law].restitution().is_some() {
            let own = self.percussions.iter().filter(|each| each.law == law);
            return percussion::impacts(own);
        }
        ContactReader::new(self, problem, law).impacts()
    }
}

/// All numbers and the laws' states at one instant.
pub(crate) struct Reading {
    pub numbers: Vec<f64>,
    pub states: Vec<State>,
    work: Workspace,
}
