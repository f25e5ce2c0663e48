//! Flights: single phases of the exact method, for methods that step through the rest.
//!
//! Where contacts are smooth but nothing of that acts between them, a method that steps hands over
//! its motion when the last contact has opened, and gets it back where the next guard reaches zero.

use super::advance::Path;
use super::curved::{CurvedGuards, Guards};
use super::event;
use super::phase::{Phase, Phases, Workspace};
use super::works::{Meter, Powers, Works};
use super::{Run, SCRATCH};
use crate::error::{Error, Result};
use crate::history::Event;
use crate::law::{Guard, Law, State};
use crate::number::{Instructions, Vectorised, dispatch};
use crate::problem::Problem;
use std::cell::OnceCell;

/// The flights of a run.
pub(crate) struct Flights<'a, L> {
    run: Run<'a, L>,
    meters: Vec<Meter>,
    powers: OnceCell<Powers>,
}

/// Where a flight begins.
#[derive(Clone, Copy)]
pub(crate) struct Takeoff<'a> {
    pub time: f64,
    pub states: &'a [State],
    /// The laws that have switched at this instant, each with the guard that was zero.
    pub fired: &'a [(usize, Guard)],
    pub displacement: &'a [f64],
    pub velocity: &'a [f64],
}

/// A flight that has ended.
pub(crate) struct Flight {
    /// Its number.
    pub number: usize,
    /// Its last instant, in s.
    pub end: f64,
    /// Displacements and velocities at its end.
    pub motion: [Vec<f64>; 2],
    pub works: Works,
    /// The switch that ends it, with its guard if that is zero.
    pub switch: Option<(Event, Option<Guard>)>,
}

impl<'a, L: Law> Flights<'a, L> {
    pub(crate) fn new(problem: &'a Problem<L>) -> Self {
        let mut run = Run::new(problem);
        run.scratch.walk.start(problem.duration);
        run.scratch.places.clear();
        Self {
            run,
            meters: Vec::new(),
            powers: OnceCell::new(),
        }
    }

    /// Flies to the first switch, to a knot of a load or to a limit, whichever comes first; `None`
    /// where the motion has no closed form that gives it back to rounding.
    ///
    /// # Errors
    /// See [`Error`].
    pub(crate) fn fly(&mut self, takeoff: Takeoff<'_>, limit: f64) -> Result<Option<Flight>> {
        match dispatch(Fly {
            flights: self,
            takeoff,
            limit,
        }) {
            Ok(flight) => Ok(Some(flight)),
            Err(Error::Defective { .. } | Error::Overflow { .. }) => Ok(None),
            Err(error) => Err(error),
        }
    }

    #[inline(always)]
    fn advance<I: Instructions>(&mut self, takeoff: Takeoff<'_>, limit: f64) -> Result<Flight> {
        let Takeoff {
            time,
            states,
            fired,
            displacement: q,
            velocity: v,
        } = takeoff;
        let problem = self.run.problem;
        let run = &mut self.run;
        let limit = limit.min(run.meet_loads(time));
        let limit = limit.min(run.begin::<I>(time, states, q, v)?);
        let number = run.phases.list.len() - 1;
        let phase = run.phases.list[number];
        let span = (limit - time).min(run.until_overflow(phase, q, v));
        let rest = (&run.contacts, &run.still);
        (run.scratch.watch).set::<I, L>(problem, &run.phases, phase, fired, [q, v], rest);
        let watch = &run.scratch.watch;
        let path = Path {
            phases: &run.phases,
            phase,
            signals: watch.active(),
            curved: CurvedGuards {
                list: &watch.curved,
                functions: &Guards { problem, states },
            },
            starts: &watch.starts,
            from: 0.0,
            limit: span,
        };
        let crossing = (run.scratch.walk).first_zero::<I>(path, &mut run.certificate);
        let length = crossing.map_or(span, |crossing| crossing.time);
        run.phases.end(length);
        let mut motion = [q.to_vec(), v.to_vec()];
        let [q, v] = &mut motion;
        (run.phases).motion::<I>(phase, length, &mut run.scratch.work, q, v);
        let switch = crossing.map(|crossing| {
            let watch = &run.scratch.watch;
            event::event_of(problem, &run.phases, phase, watch, crossing, [q, v])
        });
        let reaches = switch.is_none() && span == limit - time;
        self.meet_spectra::<I>();
        let (run, meter) = (&mut self.run, &self.meters[phase.spectrum]);
        let works = meter.until::<I, L>(problem, &run.phases, phase, length, &mut run.scratch.work);
        Ok(Flight {
            number,
            end: if reaches { limit } else { time + length },
            motion,
            works,
            switch,
        })
    }

    /// Makes the meters of spectra that are new.
    #[inline(always)]
    fn meet_spectra<I: Instructions>(&mut self) {
        let Self {
            run,
            meters,
            powers,
        } = self;
        for spectrum in &run.phases.spectra[meters.len()..] {
            meters.push(Meter::new::<I, L>(run.problem, powers, spectrum));
        }
    }

    /// Displacements and velocities, one behind the other, in a part of a flight.
    pub(crate) fn motion(&mut self, number: usize, part: f64) -> Vec<f64> {
        let phases = &self.run.phases;
        let phase = phases.list[number];
        let modes = self.run.problem.system.modes();
        let mut motion = vec![0.0; 2 * modes];
        let (q, v) = motion.split_at_mut(modes);
        dispatch(ReadMotion {
            phases,
            phase,
            t: part * phase.length,
            work: &mut self.run.scratch.work,
            motion: [q, v],
        });
        motion
    }

    /// What the run keeps of its flights.
    pub(crate) fn record(mut self) -> FlightRecord {
        self.run.scratch.bench.clear();
        SCRATCH.set(Some(self.run.scratch));
        FlightRecord {
            phases: self.run.phases,
            meters: self.meters,
        }
    }
}

struct Fly<'a, 'b, 't, L> {
    flights: &'a mut Flights<'b, L>,
    takeoff: Takeoff<'t>,
    limit: f64,
}

impl<L: Law> Vectorised for Fly<'_, '_, '_, L> {
    type Output = Result<Flight>;
    #[inline(always)]
    fn run<I: Instructions>(self) -> Result<Flight> {
        self.flights.advance::<I>(self.takeoff, self.limit)
    }
}

/// The flights of a run that is over, from which they are read.
#[derive(Debug, Clone, Default)]
pub(crate) struct FlightRecord {
    phases: Phases,
    meters: Vec<Meter>,
}

impl FlightRecord {
    /// Modal displacement and velocity at a time.
    pub(crate) fn motion(
        &self,
        number: usize,
        time: f64,
        work: &mut Workspace,
        [q, v]: [&mut [f64]; 2],
    ) {
        dispatch(ReadMotion {
            phases: &self.phases,
            phase: self.phases.list[number],
            t: self.since_start(number, time),
            work,
            motion: [q, v],
        });
    }

    /// The works since the start of a flight.
    pub(crate) fn works<L: Law>(
        &self,
        problem: &Problem<L>,
        number: usize,
        time: f64,
        work: &mut Workspace,
    ) -> Works {
        dispatch(ReadWorks {
            record: self,
            problem,
            number,
            time,
            work,
        })
    }

    /// The time since the start of a flight; its end is that where the walk has stopped.
    fn since_start(&self, number: usize, time: f64) -> f64 {
        let phase = &self.phases.list[number];
        (time - phase.start).min(phase.length)
    }
}

struct ReadMotion<'a> {
    phases: &'a Phases,
    phase: Phase,
    /// Time since its start.
    t: f64,
    work: &'a mut Workspace,
    motion: [&'a mut [f64]; 2],
}

impl Vectorised for ReadMotion<'_> {
    type Output = ();
    #[inline(always)]
    fn run<I: Instructions>(self) {
        let [q, v] = self.motion;
        self.phases.motion::<I>(self.phase, self.t, self.work, q, v);
    }
}

struct ReadWorks<'a, L> {
    record: &'a FlightRecord,
    problem: &'a Problem<L>,
    number: usize,
    time: f64,
    work: &'a mut Workspace,
}

impl<L: Law> Vectorised for ReadWorks<'_, L> {
    type Output = Works;
    #[inline(always)]
    fn run<I: Instructions>(self) -> Works {
        let FlightRecord { phases, meters } = self.record;
        let phase = phases.list[self.number];
        let t = self.record.since_start(self.number, self.time);
        meters[phase.spectrum].until::<I, L>(self.problem, phases, phase, t, self.work)
    }
}
