//! The exact method: closed-form phases between certified switches.
//!
//! While no law switches, a problem whose laws are piecewise linear is a linear system with
//! constant coefficients. [`spectrum`] solves its eigenproblem, [`phase`] keeps the amplitudes of
//! one stretch of time, [`signal`] turns a law's guard into a sum of exponentials, [`jet`] judges
//! it on [`cells`] of time, [`advance`] walks these to the next zero, [`bracket`] finds it, and
//! [`event`] switches. The only approximation is rounding.

mod advance;
mod amplitudes;
mod bracket;
mod cells;
mod cluster;
mod clustered;
mod coupled;
mod curved;
mod dense;
mod dissipation;
mod enclosure;
mod event;
mod family;
mod flight;
mod flights;
mod grouping;
mod held;
mod impedance;
mod jet;
mod one_spring;
mod partition;
mod parts;
mod phase;
mod poles;
mod polynomial;
mod principal;
mod product;
pub(crate) mod quadrature;
mod recent;
mod record;
mod response;
mod rows;
mod secular;
mod several;
mod signal;
mod single_mode;
mod singles;
mod span;
mod spectrum;
mod splitting;
mod stiff;
mod still;
mod subspaces;
mod tables;
mod view;
mod works;

pub use enclosure::Enclosure;
pub(crate) use flights::{FlightRecord, Flights, Takeoff};
pub use jet::{Jet, Jets, Verdict};
pub(crate) use phase::Workspace;
pub(crate) use poles::{Eigenvalue, Nearest};
pub use record::PhaseRecord;
pub(crate) use rows::ComplexBlock;
pub(crate) use secular::middle_way;
pub(crate) use works::Works;

use super::instant::{self, Moment};
use super::{Observer, check_linear, observe};
use crate::error::{Error, Result};
use crate::history::{Event, History};
use crate::law::{Guard, Law, State};
use crate::number::{Instructions, Plain, Vectorised, dispatch};
use crate::problem::Problem;
use crate::rigid::{Cause, Contacts, Place};
use advance::{Certificate, Crossing, Path, Walk};
use curved::{CurvedGuards, Guards};
use event::Watch;
use phase::{Phase, Phases};
use recent::Recent;
use response::Stretch;
use span::Span;
use spectrum::{Secular, Spectrum, Workbench};
use std::cell::Cell;
use std::sync::Arc;
use still::Still;

/// The method's name.
pub const NAME: &str = "exact";

/// Switches of each law at one instant after which the run is given up.
const MOST_SWITCHES_AT_ONCE: usize = 32;

/// Switches of each law at one instant after which it is rounding that switches them, or a state
/// that laws do not agree on.
const SWITCHES_WITHOUT_SENSE: usize = 8;

/// Displacements and velocities beyond which a motion that grows is given up: their squares are
/// numbers still.
const LARGEST_MOTION: f64 = 1e130;

/// How often the observer is asked, in phases.
const PHASES_BETWEEN_OBSERVATIONS: usize = 64;

/// So many phases tell by their mean length how often laws are hit.
const ENOUGH_TO_TELL: usize = 16;

/// Runs a problem whose laws are all piecewise linear.
///
/// # Errors
/// See [`Error`].
pub fn simulate<L: Law>(problem: &Arc<Problem<L>>, observer: Observer<'_>) -> Result<History<L>> {
    check_linear(NAME, &problem.laws)?;
    let mut run = Run::new(problem);
    dispatch(Advance {
        run: &mut run,
        observer,
    })?;
    run.scratch.bench.clear();
    SCRATCH.set(Some(run.scratch));
    let blows = run.contacts.blows;
    let record = PhaseRecord::new(run.phases, problem.duration, run.certificate, blows);
    Ok(History::of_phases(problem, NAME, record, run.events))
}

struct Advance<'a, 'b, 'o, L> {
    run: &'a mut Run<'b, L>,
    observer: Observer<'o>,
}

impl<L: Law> Vectorised for Advance<'_, '_, '_, L> {
    type Output = Result<()>;
    #[inline(always)]
    fn run<I: Instructions>(self) -> Result<()> {
        self.run.advance::<I>(self.observer)
    }
}

/// Memory that a run needs only while it goes on.
#[derive(Debug, Default)]
struct Scratch {
    walk: Walk,
    watch: Watch,
    work: Workspace,
    bench: Workbench,
    /// The laws that have switched at the present instant, each with the guard that was zero.
    fired: Vec<(usize, Guard)>,
    /// Where in its table each load stands.
    places: Vec<usize>,
    displacement: Vec<f64>,
    velocity: Vec<f64>,
}

thread_local! {
    /// Each thread keeps its scratch memory for its next run: asking for it anew would take as
    /// long as a short run itself.
    static SCRATCH: Cell<Option<Box<Scratch>>> = const { Cell::new(None) };
}

/// A run in progress.
struct Run<'a, L> {
    problem: &'a Problem<L>,
    phases: Phases,
    recent: Recent,
    /// What the loads change in at present.
    stretch: Stretch,
    events: Vec<Event>,
    certificate: Certificate,
    contacts: Contacts,
    still: Still,
    scratch: Box<Scratch>,
}

impl<'a, L: Law> Run<'a, L> {
    fn new(problem: &'a Problem<L>) -> Self {
        Self {
            problem,
            phases: Phases::empty(),
            recent: Recent::default(),
            stretch: Stretch::default(),
            events: Vec::new(),
            certificate: Certificate::default(),
            contacts: Contacts::new(problem),
            still: Still::default(),
            scratch: SCRATCH.take().unwrap_or_default(),
        }
    }

    #[inline(always)]
    fn advance<I: Instructions>(&mut self, observer: Observer<'_>) -> Result<()> {
        let problem = self.problem;
        let mut q = std::mem::take(&mut self.scratch.displacement);
        let mut v = std::mem::take(&mut self.scratch.velocity);
        q.clone_from(&problem.displacement);
        v.clone_from(&problem.velocity);
        let mut states = self.start(&q, &mut v)?;
        let mut time = 0.0;
        self.scratch.walk.start(problem.duration);
        self.scratch.fired.clear();
        let mut at_once = 0;
        loop {
            if (self.phases.list.len()).is_multiple_of(PHASES_BETWEEN_OBSERVATIONS) {
                observe(observer, time)?;
            }
            let knot = self.meet_loads(time);
            let until = knot.min(self.begin::<I>(time, &states, &q, &v)?);
            let phase = self.phases.list[self.phases.list.len() - 1];
            self.scratch.watch.set::<I, L>(
                problem,
                &self.phases,
                phase,
                &self.scratch.fired,
                [&q, &v],
                (&self.contacts, &self.still),
            );
            let functions = Guards {
                problem,
                states: &states,
            };
            let end = problem.duration.min(until) - time;
            let path = Path {
                phases: &self.phases,
                phase,
                signals: self.scratch.watch.active(),
                curved: CurvedGuards {
                    list: &self.scratch.watch.curved,
                    functions: &functions,
                },
                starts: &self.scratch.watch.starts,
                from: 0.0,
                limit: end.min(self.until_overflow(phase, &q, &v)),
            };
            let limit = path.limit;
            let crossing = (self.scratch.walk).first_zero::<I>(path, &mut self.certificate);
            self.phases.end(crossing.as_ref().map_or(limit, |c| c.time));
            let Some(crossing) = crossing else {
                if limit < end {
                    return Err(Error::Overflow { time: time + limit });
                }
                if until >= problem.duration {
                    (self.scratch.displacement, self.scratch.velocity) = (q, v);
                    return Ok(());
                }
                self.phases
                    .motion::<I>(phase, limit, &mut self.scratch.work, &mut q, &mut v);
                (time, at_once) = (until, 0);
                self.scratch.fired.clear();
                if problem.forcing.moved().next().is_some() {
                    self.jump(time, &q, [&v, &v], &mut states);
                }
                if !self.contacts.is_empty() {
                    (self.contacts).see_phase(problem, &self.scratch.watch, limit);
                    self.meet(Cause::Other, time, &q, &mut v, &mut states)?;
                }
                continue;
            };
            let goes_on = time + crossing.time > time;
            at_once = if goes_on { 0 } else { at_once + 1 };
            if at_once > MOST_SWITCHES_AT_ONCE * problem.laws.len() {
                return Err(Error::EndlessSwitching { time });
            }
            self.phases
                .motion::<I>(phase, crossing.time, &mut self.scratch.work, &mut q, &mut v);
            time += crossing.time;
            let cause = self.cause(crossing);
            if goes_on || cause != Cause::Other {
                self.scratch.fired.clear();
            }
            if cause == Cause::Other {
                let watch = &self.scratch.watch;
                let (event, zero) =
                    event::event_of(problem, &self.phases, phase, watch, crossing, [&q, &v]);
                states[event.law] = event.after;
                self.scratch.fired.retain(|(law, _)| *law != event.law);
                self.scratch
                    .fired
                    .extend(zero.map(|guard| (event.law, guard)));
                self.events.push(event);
                self.still.release(event.law);
            }
            if at_once == SWITCHES_WITHOUT_SENSE * problem.laws.len() {
                self.find_still(time, &states, [&q, &v]);
            }
            if !self.contacts.is_empty() {
                (self.contacts).see_phase(problem, &self.scratch.watch, crossing.time);
                self.meet(cause, time, &q, &mut v, &mut states)?;
            }
        }
    }

    /// Lets the stops that are touched without load keep their states.
    #[cold]
    fn find_still(&mut self, time: f64, states: &[State], [q, v]: [&[f64]; 2]) {
        let moment = Moment {
            time,
            displacement: q,
            velocity: v,
        };
        let phase = self.phases.list[self.phases.list.len() - 1];
        let fastest = self.phases.spectra[phase.spectrum].pace();
        let still = &mut self.still;
        let missed = still.find(self.problem, states, fastest, moment);
        self.certificate.missed = self.certificate.missed.max(missed);
        self.scratch.fired.retain(|(law, _)| !still.is(*law));
    }

    /// For how long a phase that begins like this stays within numbers: beyond, the walk would
    /// halve its cells without end.
    #[inline(always)]
    fn until_overflow(&self, phase: Phase, q: &[f64], v: &[f64]) -> f64 {
        let growth = self.phases.spectra[phase.spectrum].growth;
        if growth > 0.0 {
            let largest = q.iter().chain(v).fold(1.0f64, |most, x| most.max(x.abs()));
            (LARGEST_MOTION / largest).ln().max(0.0) / growth
        } else {
            f64::INFINITY
        }
    }

    /// The laws' states at t = 0. Rigid stops that the structure rests on push others, which may
    /// in turn let it go: both are gone through until nothing changes.
    fn start(&mut self, q: &[f64], v: &mut [f64]) -> Result<Vec<State>> {
        let problem = self.problem;
        let mut states = vec![State::FIRST; problem.laws.len()];
        if !self.contacts.is_empty() {
            self.contacts.check_start(problem)?;
        }
        for _ in 0..=problem.laws.len() {
            let moment = Moment {
                time: 0.0,
                displacement: q,
                velocity: v,
            };
            let changes = instant::initial_states(problem, &mut states, moment);
            if self.contacts.is_empty() {
                break;
            }
            let known = self.events.len();
            self.meet(Cause::Other, 0.0, q, v, &mut states)?;
            if !changes && self.events.len() == known {
                break;
            }
        }
        Ok(states)
    }

    /// Whether a rigid stop makes a crossing, and how.
    #[inline(always)]
    fn cause(&self, crossing: Crossing) -> Cause {
        let (law, guard) = self.scratch.watch.guards[crossing.watched];
        if guard == event::REACTION {
            Cause::Leave(law)
        } else if !self.contacts.is_empty() && self.problem.laws[law].restitution().is_some() {
            Cause::Touch(law)
        } else {
            Cause::Other
        }
    }

    /// Lets rigid stops in touch do their work at the start of a phase.
    #[cold]
    fn meet(
        &mut self,
        cause: Cause,
        time: f64,
        q: &[f64],
        v: &mut [f64],
        states: &mut [State],
    ) -> Result<()> {
        let place = Place {
            cause,
            time,
            phase: self.phases.list.len(),
        };
        let before = v.to_vec();
        (self.contacts).meet(self.problem, place, q, v, states, &mut self.events)?;
        if self.contacts.jumped_at(time) {
            self.jump(time, q, [&before, v], states);
        }
        Ok(())
    }

    /// Lets laws go on behind an instant at which velocities may have jumped.
    fn jump(&mut self, time: f64, q: &[f64], [before, v]: [&[f64]; 2], states: &mut [State]) {
        let moment = Moment {
            time,
            displacement: q,
            velocity: v,
        };
        for event in instant::after_jump(self.problem, states, before, moment) {
            states[event.law] = event.after;
            self.events.push(event);
        }
    }

    /// Turns to the loads from a time on and to the stretch in which it lies; returns the next
    /// instant at which one of them has a knot.
    #[inline(always)]
    fn meet_loads(&mut self, time: f64) -> f64 {
        let forcing = &self.problem.forcing;
        if !forcing.varies() {
            return f64::INFINITY;
        }
        let Scratch { places, work, .. } = &mut *self.scratch;
        forcing.onset(time, places, &mut work.onset);
        self.stretch = Stretch::of(forcing.stretch(places), self.problem.duration);
        forcing.next_knot(places)
    }

    /// Starts a phase, and tells until when it lasts at most; a spectrum of the secular equation
    /// that fails the phase's check is replaced by that of the dense problem.
    #[inline(always)]
    fn begin<I: Instructions>(
        &mut self,
        time: f64,
        states: &[State],
        q: &[f64],
        v: &[f64],
    ) -> Result<f64> {
        let duration = self.problem.duration;
        let mut span = Span {
            stretch: self.stretch,
            is_parted: false,
        };
        let mut spectrum = self.spectrum::<I>(states, span)?;
        let nearly_slow = self.phases.spectra[spectrum].nearly_slow;
        if nearly_slow.are_large([q, v], self.time_between_phases(time), duration) {
            span.is_parted = true;
            spectrum = self.spectrum::<I>(states, span)?;
        }
        let work = &mut self.scratch.work;
        let begun = self.phases.begin::<I>(time, spectrum, states, q, v, work);
        match begun {
            Err(Error::Defective { .. }) if self.phases.spectra[spectrum].is_secular => {
                let replacement = self.dense_spectrum(states, span)?;
                let work = &mut self.scratch.work;
                self.phases
                    .begin::<I>(time, replacement, states, q, v, work)
            }
            begun => begun,
        }?;
        Ok(span.until(time, duration))
    }

    /// How long phases have been on the average, once there are enough to tell.
    #[inline(always)]
    fn time_between_phases(&self, time: f64) -> Option<f64> {
        let phases = self.phases.list.len();
        (phases >= ENOUGH_TO_TELL).then(|| time / phases as f64)
    }

    /// A spectrum for the given states that does not come from the secular equation. Rare, so
    /// that plain arithmetic, which gives the same bits, does.
    #[cold]
    fn dense_spectrum(&mut self, states: &[State], span: Span) -> Result<usize> {
        let room = self.phases.spare_spectrum();
        let bench = &mut self.scratch.bench;
        let secular = Secular::Skip;
        let dense = Spectrum::new::<Plain, L>(self.problem, states, span, secular, bench, room)?;
        Ok(self.keep(states, dense))
    }

    /// Keeps a spectrum; returns its number.
    #[inline(always)]
    fn keep(&mut self, states: &[State], spectrum: Box<Spectrum>) -> usize {
        let number = self.phases.add_spectrum(spectrum);
        self.recent.keep(states, number);
        number
    }

    /// The number of the spectrum for the given states, the latest one made: one with their
    /// numbers has their matrices, one with their memory their constant forces too.
    #[inline(always)]
    fn spectrum<I: Instructions>(&mut self, states: &[State], span: Span) -> Result<usize> {
        let problem = self.problem;
        let known = (self.recent).find(problem, states, span, &self.phases.spectra);
        match known {
            Some(known) => Ok(known),
            None => {
                let room = self.phases.spare_spectrum();
                let bench = &mut self.scratch.bench;
                let secular = Secular::Try;
                let fresh = Spectrum::new::<I, L>(problem, states, span, secular, bench, room)?;
                Ok(self.keep(states, fresh))
            }
        }
    }
}
