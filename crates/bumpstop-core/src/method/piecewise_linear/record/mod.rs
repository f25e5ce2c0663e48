//! What an exact run keeps: its phases, from which everything else is read.

mod accounts;
mod contact;
mod crowded;
mod defect;
mod projection;
mod turns;

use super::advance::Certificate;
use super::family::HALF;
use super::phase::{Phase, Phases, Workspace};
use crate::energy::{self, Ledger};
use crate::impacts::Impact;
use crate::law::{COORDINATES, Law, Local, State};
use crate::number::{Instructions, Vectorised, dispatch};
use crate::problem::Problem;
use crate::rigid::Blow;
use accounts::{Accounts, Ledgers, Settlement};
use contact::ContactReader;
use crowded::{NODES, Series, crowd};
use defect::Defect;
use projection::Projection;
use std::mem::take;
use std::sync::OnceLock;

/// The phases of a run.
#[derive(Debug, Clone)]
pub struct PhaseRecord {
    phases: Phases,
    duration: f64,
    certificate: Certificate,
    /// Impulses of rigid stops, in order of time.
    blows: Vec<Blow>,
    accounts: OnceLock<Accounts>,
    motion_error: OnceLock<f64>,
}

/// Position and velocity of all modes.
struct Motion {
    q: Vec<f64>,
    v: Vec<f64>,
}

/// Instants at which what laws see is held in memory.
const TOGETHER: usize = 4096;

/// Phases that are tried one by one before all are searched.
const NEARBY: usize = 4;

impl Drop for PhaseRecord {
    fn drop(&mut self) {
        self.phases.leave();
    }
}

impl PhaseRecord {
    pub(crate) fn new(
        phases: Phases,
        duration: f64,
        certificate: Certificate,
        blows: Vec<Blow>,
    ) -> Self {
        Self {
            phases,
            duration,
            certificate,
            blows,
            accounts: OnceLock::new(),
            motion_error: OnceLock::new(),
        }
    }

    /// Cells that the walk looked at.
    pub fn cells(&self) -> usize {
        self.certificate.cells
    }

    /// Bound of what the walk could have missed for rounding, in m.
    pub fn missed_penetration(&self) -> f64 {
        self.certificate.missed
    }

    /// Bound of how far the motion is, at the laws, from the solution of its equations that
    /// starts at the last switch: see [`defect`]. Infinite where there is no bound.
    pub(crate) fn motion_error<L: Law>(&self, problem: &Problem<L>) -> f64 {
        let largest = || Defect::new(self, problem).largest();
        *(self.motion_error).get_or_init(|| largest().unwrap_or(f64::INFINITY))
    }

    /// The number of the phase at a time: the last one that has started.
    pub fn phase_at(&self, time: f64) -> usize {
        self.phases.list.partition_point(|p| p.start <= time).max(1) - 1
    }

    /// The same, looked for from a phase on: times mostly come in order.
    #[inline(always)]
    fn phase_from(&self, number: usize, time: f64) -> usize {
        let list = &self.phases.list;
        for candidate in number..list.len().min(number + NEARBY) {
            let after = list.get(candidate + 1).map_or(f64::INFINITY, |p| p.start);
            if list[candidate].start <= time && time < after {
                return candidate;
            }
        }
        self.phase_at(time)
    }

    /// Shows modal displacement, velocity and law states at each time.
    pub(crate) fn visit(&self, times: &[f64], modes: usize, see: &mut See<'_>) {
        dispatch(Visit {
            record: self,
            times,
            modes,
            see,
        });
    }

    /// Modal displacements (`derivative` 0) or velocities (1) at each time, one row behind the
    /// other.
    pub(crate) fn motion(&self, derivative: usize, times: &[f64], modes: usize) -> Vec<f64> {
        dispatch(Rows {
            record: self,
            derivative,
            times,
            modes,
        })
    }

    /// Shows what a law sees at each time: position and velocity along its rows, and its state.
    pub(crate) fn visit_law(
        &self,
        law: usize,
        rows: &[Vec<f64>],
        times: &[f64],
        mut see: impl FnMut(f64, [Local<f64>; 2], State),
    ) {
        let mut number = 0;
        for times in times.chunks(TOGETHER) {
            let columns = [0, 1].map(|order| {
                let column = |row: &Vec<f64>| self.project(row, times, order);
                rows.iter().map(column).collect::<Vec<_>>()
            });
            for (i, time) in times.iter().enumerate() {
                let mut local = [[0.0; COORDINATES]; 2];
                for (local, columns) in local.iter_mut().zip(&columns) {
                    for (to, column) in local.iter_mut().zip(columns) {
                        *to = column[i];
                    }
                }
                number = self.phase_from(number, *time);
                see(
                    *time,
                    local,
                    self.phases.states(self.phases.list[number])[law],
                );
            }
        }
    }

    /// A time derivative (0, 1 or 2) of one linear combination of the modal coordinates.
    pub(crate) fn project(&self, row: &[f64], times: &[f64], order: usize) -> Vec<f64> {
        dispatch(Projection {
            record: self,
            row,
            times,
            order,
        })
    }

    /// The energy ledger at each time.
    pub(crate) fn ledgers<L: Law>(&self, problem: &Problem<L>, times: &[f64]) -> Vec<Ledger> {
        dispatch(Ledgers {
            record: self,
            problem,
            times,
        })
    }

    /// Largest imbalance at the switches and at the end, relative to the largest energy.
    pub(crate) fn energy_residual<L: Law>(&self, problem: &Problem<L>) -> f64 {
        energy::residual(self.accounts(problem).ledgers.iter())
    }

    /// The impulses with which a phase begins.
    fn blows_at(&self, phase: usize) -> &[Blow] {
        let first = self.blows.partition_point(|blow| blow.phase < phase);
        let count = self.blows[first..].partition_point(|blow| blow.phase == phase);
        &self.blows[first..first + count]
    }

    fn accounts<L: Law>(&self, problem: &Problem<L>) -> &Accounts {
        self.accounts.get_or_init(|| {
            dispatch(Settlement {
                record: self,
                problem,
            })
        })
    }

    #[inline(always)]
    fn motion_in<I: Instructions, L: Law>(
        &self,
        problem: &Problem<L>,
        phase: Phase,
        t: f64,
        work: &mut Workspace,
    ) -> Motion {
        let modes = problem.system.modes();
        let mut motion = Motion {
            q: vec![0.0; modes],
            v: vec![0.0; modes],
        };
        self.phases
            .motion::<I>(phase, t, work, &mut motion.q, &mut motion.v);
        motion
    }

    /// Impacts of one law.
    pub(crate) fn impacts<L: Law>(&self, problem: &Problem<L>, law: usize) -> Vec<Impact> {
        dispatch(ContactReader::new(self, problem, law))
    }

    /// The same without forces.
    pub(crate) fn contacts<L: Law>(&self, problem: &Problem<L>, law: usize) -> Vec<Impact> {
        dispatch(ContactReader::new(self, problem, law).without_forces())
    }
}

/// Is shown a time, modal displacement, velocity and law states.
pub(crate) type See<'a> = dyn FnMut(f64, &[f64], &[f64], &[State]) + 'a;

struct Visit<'a, 'b> {
    record: &'a PhaseRecord,
    times: &'a [f64],
    modes: usize,
    see: &'a mut See<'b>,
}

impl Vectorised for Visit<'_, '_> {
    type Output = ();
    #[inline(always)]
    fn run<I: Instructions>(self) {
        let phases = &self.record.phases;
        let mut work = Workspace::default();
        let (mut q, mut v) = (vec![0.0; self.modes], vec![0.0; self.modes]);
        for time in self.times {
            let phase = phases.list[self.record.phase_at(*time)];
            phases.motion::<I>(phase, time - phase.start, &mut work, &mut q, &mut v);
            (self.see)(*time, &q, &v, phases.states(phase));
        }
    }
}

struct Rows<'a> {
    record: &'a PhaseRecord,
    derivative: usize,
    times: &'a [f64],
    modes: usize,
}

impl Vectorised for Rows<'_> {
    type Output = Vec<f64>;
    #[inline(always)]
    fn run<I: Instructions>(self) -> Vec<f64> {
        let mut rows = vec![0.0; self.times.len() * self.modes];
        let mut room = Room::new(self.modes);
        let (mut left, mut to) = (self.times, rows.as_mut_slice());
        let mut number = 0;
        while let Some(first) = left.first() {
            number = self.record.phase_from(number, *first);
            let (until, interval) = self.extent(number);
            let count = if let Some(count) = crowd(left, until.min(first + interval)) {
                self.put_crowd::<I>(number, &left[..count], &mut room, to);
                count
            } else {
                let inside = |time: &&f64| self.record.phase_from(number, **time) == number;
                let count = 1 + left[1..].iter().take(HALF - 1).take_while(inside).count();
                self.put_each::<I>(number, &left[..count], &mut room, to);
                count
            };
            (left, to) = (&left[count..], &mut to[count * self.modes..]);
        }
        rows
    }
}

impl Rows<'_> {
    /// The end of a phase, and the length of the intervals in which instants may crowd.
    #[inline(always)]
    fn extent(&self, number: usize) -> (f64, f64) {
        let phases = &self.record.phases;
        let until = (phases.list.get(number + 1)).map_or(f64::INFINITY, |next| next.start);
        let spectrum = &phases.spectra[phases.list[number].spectrum];
        (until, crowded::interval(spectrum))
    }

    /// Up to four instants.
    #[inline(always)]
    fn put_each<I: Instructions>(
        &self,
        number: usize,
        times: &[f64],
        room: &mut Room,
        to: &mut [f64],
    ) {
        let phases = &self.record.phases;
        let phase = phases.list[number];
        let mut since = [0.0; HALF];
        for (since, time) in since.iter_mut().zip(times) {
            *since = time - phase.start;
        }
        let since = &since[..times.len()];
        let to = &mut to[..times.len() * self.modes];
        let Room { works, unused, .. } = room;
        phases.motion_of_four::<I>(phase, self.derivative, since, works, to, unused);
    }

    /// Instants that crowd in an interval.
    #[inline(always)]
    fn put_crowd<I: Instructions>(
        &self,
        number: usize,
        times: &[f64],
        room: &mut Room,
        to: &mut [f64],
    ) {
        let nodes = (room.series).set_interval([times[0], times[times.len() - 1]]);
        let mut rows = take(&mut room.rows);
        rows.resize(NODES * self.modes, 0.0);
        for (nodes, rows) in nodes.chunks(HALF).zip(rows.chunks_mut(HALF * self.modes)) {
            self.put_each::<I>(number, nodes, room, rows);
        }
        room.series.fit::<I>(&rows);
        room.series.at::<I>(times, to);
        room.rows = rows;
    }
}

/// Room for sampling, used again and again.
struct Room {
    works: [Workspace; HALF],
    /// For the other of displacement and velocity.
    unused: Vec<f64>,
    series: Series,
    /// Motion at the nodes of the series.
    rows: Vec<f64>,
}

impl Room {
    fn new(modes: usize) -> Self {
        Self {
            works: Default::default(),
            unused: vec![0.0; modes],
            series: Series::default(),
            rows: Vec::new(),
        }
    }
}
