//! Phases: stretches of time in which no law switches, kept as amplitudes of exponentials.

use super::cluster::Cluster;
use super::family::HALF;
use super::product::grown_lanes;
use super::response::Response;
use super::rows::{ComplexBlock, entry};
use super::single_mode::Kept;
use super::singles::{Single, Subject};
use super::spectrum::Spectrum;
use crate::error::Result;
use crate::forcing::Onset;
use crate::law::State;
use crate::number::{Complex, Instructions, LANES, Lanes, Number};
use std::cell::Cell;

/// One phase.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Phase {
    /// Its first instant, in s.
    pub start: f64,
    /// Its length, in s: the difference of two instants has lost digits.
    pub length: f64,
    /// Its spectrum, by number.
    pub spectrum: usize,
    /// Where its amplitudes, its singles' initial states and its laws' states start.
    amplitudes: usize,
    kept: usize,
    states: usize,
    /// Where the polynomials of its loads start.
    coefficients: usize,
}

/// The phases of a run in order of time.
#[derive(Debug, Clone, Default)]
pub(crate) struct Phases {
    /// Each in a place of its own: they are too large to be moved about.
    #[allow(clippy::vec_box)]
    pub spectra: Vec<Box<Spectrum>>,
    pub list: Vec<Phase>,
    amplitudes: Vec<ComplexBlock>,
    kept: Vec<f64>,
    states: Vec<State>,
    /// Polynomials of the loads that change in time.
    coefficients: Vec<f64>,
    /// Spectra of an earlier run, for their memory.
    #[allow(clippy::vec_box)]
    spare: Vec<Box<Spectrum>>,
}

thread_local! {
    /// Memory of a run that nobody needs any more: to ask for it anew would take as long as a
    /// short run itself.
    static SPARE: Cell<Option<Phases>> = const { Cell::new(None) };
}

/// Most numbers that are kept for another run.
const MOST_SPARE: usize = 100_000;

/// Room for the evaluation of a phase, used again and again.
#[derive(Debug, Clone, Default)]
pub(crate) struct Workspace {
    /// `a exp(lambda t)` and its rate.
    pub z: Vec<ComplexBlock>,
    pub rate: Vec<ComplexBlock>,
    pub rate_at_start: Vec<ComplexBlock>,
    pub(super) position: Vec<f64>,
    pub(super) velocity: Vec<f64>,
    pub(super) own_position: Vec<f64>,
    pub(super) own_velocity: Vec<f64>,
    pub(super) lack_position: Vec<f64>,
    pub(super) lack_velocity: Vec<f64>,
    pub(super) given_position: Vec<f64>,
    pub(super) given_velocity: Vec<f64>,
    /// The loads that change in time, at the start of the phase that is to begin.
    pub onset: Onset,
    free: Free,
}

/// A state less what follows the loads.
#[derive(Debug, Clone, Default)]
struct Free {
    q: Vec<f64>,
    v: Vec<f64>,
}

impl Workspace {
    #[inline(always)]
    fn fit(&mut self, blocks: usize) {
        self.z.resize(blocks, ComplexBlock::ZERO);
        self.rate.resize(blocks, ComplexBlock::ZERO);
    }

    /// The exponentials (0) or their rates (1).
    #[inline(always)]
    pub(super) fn turned(&self, derivative: usize) -> &[ComplexBlock] {
        if derivative == 0 { &self.z } else { &self.rate }
    }

    /// Positions (0) or velocities (1) of the groups.
    #[inline(always)]
    pub(super) fn groups(&mut self, derivative: usize) -> &mut [f64] {
        if derivative == 0 {
            &mut self.position
        } else {
            &mut self.velocity
        }
    }

    /// A state less what follows the loads at their onset.
    fn less_loads(
        &mut self,
        response: &Response,
        clusters: &[Cluster],
        q: &[f64],
        v: &[f64],
    ) -> Free {
        let mut free = std::mem::take(&mut self.free);
        free.q.clear();
        free.q.extend_from_slice(q);
        free.v.clear();
        free.v.extend_from_slice(v);
        response.subtract_start(clusters, &self.onset, &mut free.q, &mut free.v);
        free
    }
}

impl Phases {
    /// No phases, in the memory of an earlier run if there is some.
    pub(crate) fn empty() -> Self {
        let mut phases = SPARE.take().unwrap_or_default();
        phases.spare.append(&mut phases.spectra);
        phases.list.clear();
        phases.amplitudes.clear();
        phases.kept.clear();
        phases.states.clear();
        phases.coefficients.clear();
        phases
    }

    /// Leaves the memory to the next run on this thread.
    pub(crate) fn leave(&mut self) {
        let vectors: usize = self.spectra.iter().map(|spectrum| spectrum.numbers()).sum();
        let kept = self.kept.len() + self.coefficients.len();
        let numbers = vectors + self.amplitudes.len() * 2 * LANES + kept;
        if numbers <= MOST_SPARE {
            SPARE.set(Some(std::mem::take(self)));
        }
    }

    /// Memory for a spectrum.
    pub(crate) fn spare_spectrum(&mut self) -> Box<Spectrum> {
        self.spare.pop().unwrap_or_default()
    }

    /// Starts a phase from a motion, with the laws in the given states; the onset of the loads is
    /// in the workspace where they change in time.
    ///
    /// # Errors
    /// [`crate::error::Error::Defective`] when the amplitudes do not give the state back,
    /// [`crate::error::Error::Overflow`] when it is not finite.
    #[inline(always)]
    pub(crate) fn begin<I: Instructions>(
        &mut self,
        start: f64,
        spectrum: usize,
        states: &[State],
        q: &[f64],
        v: &[f64],
        work: &mut Workspace,
    ) -> Result<()> {
        let which = &self.spectra[spectrum];
        let response = which.response.as_ref();
        let free = response.map(|response| work.less_loads(response, &which.clusters, q, v));
        let (q, v) = free.as_ref().map_or((q, v), |free| (&free.q, &free.v));
        let phase = Phase {
            start,
            length: 0.0,
            spectrum,
            amplitudes: self.amplitudes.len(),
            kept: self.kept.len(),
            states: self.states.len(),
            coefficients: self.coefficients.len(),
        };
        work.fit(which.lambda.len());
        work.z.fill(ComplexBlock::ZERO);
        work.position.resize(which.combinations, 0.0);
        work.velocity.resize(which.combinations, 0.0);
        which.gather(q, &mut work.position);
        which.gather(v, &mut work.velocity);
        if which.groups > 0 {
            work.solve_amplitudes::<I>(which, start)?;
        }
        for cluster in &which.clusters {
            cluster.set_drive(&mut work.z);
        }
        if which.is_flight {
            which.flight_amplitudes::<I>(q, v, &mut work.z);
            keep(&mut self.kept, q, v);
        } else if !which.singles.is_empty() {
            subtract(which, q, &work.position, &mut work.own_position);
            subtract(which, v, &work.velocity, &mut work.own_velocity);
            work.begin_singles(which, &mut self.kept);
        }
        self.amplitudes.extend_from_slice(&work.z);
        self.states.extend_from_slice(states);
        self.list.push(phase);
        if let Some(free) = free {
            work.free = free;
            self.keep_loads(phase, &work.onset);
        }
        Ok(())
    }

    /// Keeps the loads of a phase that has just begun.
    fn keep_loads(&mut self, phase: Phase, onset: &Onset) {
        let spectrum = &self.spectra[phase.spectrum];
        let Some(response) = &spectrum.response else {
            return;
        };
        self.coefficients.extend_from_slice(&onset.coefficients);
        let amplitudes = &mut self.amplitudes[phase.amplitudes..];
        response.set_loads(&spectrum.clusters, onset, amplitudes);
    }

    /// Ends the latest phase.
    #[inline(always)]
    pub(crate) fn end(&mut self, length: f64) {
        if let Some(phase) = self.list.last_mut() {
            phase.length = length;
        }
    }

    /// Keeps a spectrum; returns its number.
    pub(crate) fn add_spectrum(&mut self, spectrum: Box<Spectrum>) -> usize {
        self.spectra.push(spectrum);
        self.spectra.len() - 1
    }

    /// Amplitudes of a phase.
    #[inline(always)]
    pub(crate) fn amplitudes(&self, phase: Phase) -> &[ComplexBlock] {
        let blocks = self.spectra[phase.spectrum].lambda.len();
        &self.amplitudes[phase.amplitudes..][..blocks]
    }

    /// Initial position and velocity of a single motion.
    #[inline(always)]
    pub(crate) fn kept(&self, phase: Phase, single: usize) -> Kept {
        let kept = &self.kept[phase.kept..];
        Kept {
            x: kept[2 * single],
            v: kept[2 * single + 1],
        }
    }

    /// The polynomials of the loads in the time since the start of a phase.
    pub(crate) fn coefficients(&self, phase: Phase) -> &[f64] {
        &self.coefficients[phase.coefficients..]
    }

    /// `exp(i omega start)` of a harmonic load.
    pub(crate) fn unit(&self, phase: Phase, response: &Response, harmonic: usize) -> Complex<f64> {
        entry(self.amplitudes(phase), response.at + harmonic)
    }

    /// Fills the workspace with the exponentials of a phase, `t` after its start.
    ///
    /// Over a hundred thousand short phases exponentials close to one would lose the same digits
    /// each time. What they are more than one is added instead: its rounding has no preference.
    #[inline(always)]
    pub(crate) fn turn<I: Instructions>(&self, phase: Phase, t: f64, work: &mut Workspace) {
        let spectrum = &self.spectra[phase.spectrum];
        let amplitudes = self.amplitudes(phase);
        work.fit(amplitudes.len());
        let time = t;
        let t = Lanes::<I>::of(t);
        let is_short = spectrum
            .response
            .as_ref()
            .is_some_and(|r| r.reach.is_finite());
        for (b, (lambda, amplitude)) in spectrum.lambda.iter().zip(amplitudes).enumerate() {
            let lambda = lambda.lanes::<I>();
            let amplitude = amplitude.lanes();
            let z = if is_short {
                amplitude + amplitude * (lambda * grown_lanes::<I>(lambda, time))
            } else {
                amplitude * lambda.scale(t).exp()
            };
            work.z[b].put(z);
            work.rate[b].put(z * lambda);
        }
        for cluster in &spectrum.clusters {
            let mut z = cluster.columns(amplitudes);
            cluster.advance(time, &mut z);
            cluster.put(&z, &mut work.z);
            cluster.put(&cluster.rate(&z), &mut work.rate);
        }
    }

    /// Modal displacement and velocity `t` after the start of a phase.
    #[inline(always)]
    pub(crate) fn motion<I: Instructions>(
        &self,
        phase: Phase,
        t: f64,
        work: &mut Workspace,
        q: &mut [f64],
        v: &mut [f64],
    ) {
        let spectrum = &self.spectra[phase.spectrum];
        self.turn::<I>(phase, t, work);
        work.position.resize(spectrum.combinations, 0.0);
        work.velocity.resize(spectrum.combinations, 0.0);
        spectrum.group_sums::<I>(
            [&work.z, &work.rate],
            [&mut work.position, &mut work.velocity],
        );
        self.complete::<I>(phase, t, work, q, v);
    }

    /// Modal displacements (`derivative` 0) or velocities (1) at up to four instants after the start
    /// of a phase, a row each, the same as [`Phases::motion`] gives them; `unused` is room for the
    /// other of the two.
    #[inline(always)]
    pub(crate) fn motion_of_four<I: Instructions>(
        &self,
        phase: Phase,
        derivative: usize,
        instants: &[f64],
        works: &mut [Workspace; HALF],
        rows: &mut [f64],
        unused: &mut [f64],
    ) {
        let spectrum = &self.spectra[phase.spectrum];
        for (i, work) in works.iter_mut().enumerate() {
            self.turn::<I>(phase, instants[i.min(instants.len() - 1)], work);
            work.position.resize(spectrum.combinations, 0.0);
            work.velocity.resize(spectrum.combinations, 0.0);
        }
        spectrum.groups_of_four::<I>(derivative, works);
        for ((t, work), row) in (instants.iter().zip(works)).zip(rows.chunks_mut(unused.len())) {
            let [q, v] = if derivative == 0 {
                [row, &mut *unused]
            } else {
                [&mut *unused, row]
            };
            self.complete::<I>(phase, *t, work, q, v);
        }
    }

    /// Makes modal motion of the motion of the groups.
    #[inline(always)]
    fn complete<I: Instructions>(
        &self,
        phase: Phase,
        t: f64,
        work: &mut Workspace,
        q: &mut [f64],
        v: &mut [f64],
    ) {
        let spectrum = &self.spectra[phase.spectrum];
        for (position, rest) in work.position.iter_mut().zip(&spectrum.at_rest) {
            *position += rest;
        }
        if spectrum.is_flight {
            spectrum.flight_motion::<I>(work, q, v);
            for &mode in &spectrum.aside {
                let single = &spectrum.singles[mode];
                (q[mode], v[mode]) = self.single_motion(phase, mode, single, t, work);
            }
        } else if spectrum.groups_are_modes {
            q.copy_from_slice(&work.position);
            v.copy_from_slice(&work.velocity);
        } else {
            self.modes_motion(phase, t, work, q, v);
        }
        if let Some(held) = &spectrum.held {
            for (&mode, offset) in held.modes.iter().zip(&held.offsets) {
                q[mode] += offset;
            }
        }
        if let Some(response) = &spectrum.response {
            let units = |harmonic: usize| self.unit(phase, response, harmonic);
            let coefficients = self.coefficients(phase);
            response.add_to(&spectrum.clusters, &work.z, coefficients, units, t, [q, v]);
        }
    }

    /// Adds up singles and groups to modes.
    #[inline(always)]
    fn modes_motion(
        &self,
        phase: Phase,
        t: f64,
        work: &mut Workspace,
        q: &mut [f64],
        v: &mut [f64],
    ) {
        let spectrum = &self.spectra[phase.spectrum];
        q.fill(0.0);
        v.fill(0.0);
        for (index, single) in spectrum.singles.iter().enumerate() {
            let (x, rate) = self.single_motion(phase, index, single, t, work);
            match single.subject {
                Subject::Mode(mode) => (q[mode], v[mode]) = (x, rate),
                Subject::Combination(number) => {
                    (work.position[number], work.velocity[number]) = (x, rate);
                }
            }
        }
        for member in &spectrum.members {
            q[member.mode] += member.weight * work.position[member.group];
            v[member.mode] += member.weight * work.velocity[member.group];
        }
    }

    #[inline(always)]
    fn single_motion(
        &self,
        phase: Phase,
        index: usize,
        single: &Single,
        t: f64,
        work: &Workspace,
    ) -> (f64, f64) {
        if let (1, Some(rest)) = (single.motion.count(), single.motion.rest()) {
            let (x, v) = (
                entry(&work.z, single.at).re,
                entry(&work.rate, single.at).re,
            );
            return (rest + x, v);
        }
        let kept = self.kept(phase, index);
        if single.motion.is_special() {
            let [x, v, ..] = single.motion.special(kept, t);
            return (x, v);
        }
        let p = single.motion.polynomial(kept.x, kept.v);
        let (mut x, mut v) = (p[0] + t * (p[1] + t * p[2]), p[1] + 2.0 * t * p[2]);
        for i in 0..single.motion.count() {
            x += entry(&work.z, single.at + i).re;
            v += entry(&work.rate, single.at + i).re;
        }
        (x, v)
    }

    /// The states of the laws during a phase.
    pub(crate) fn states(&self, phase: Phase) -> &[State] {
        let laws = self.spectra[phase.spectrum].states.len();
        &self.states[phase.states..][..laws]
    }
}

/// Keeps the positions and velocities at the start of a phase of modes that move by themselves.
#[inline(always)]
fn keep(kept: &mut Vec<f64>, q: &[f64], v: &[f64]) {
    kept.reserve(2 * q.len());
    for (x, v) in q.iter().zip(v) {
        kept.extend([*x, *v]);
    }
}

/// What is left of the modal coordinates without the combinations.
#[inline(always)]
fn subtract(spectrum: &Spectrum, modal: &[f64], combined: &[f64], own: &mut Vec<f64>) {
    own.clear();
    own.extend_from_slice(modal);
    for member in &spectrum.members {
        own[member.mode] -= member.weight * combined[member.group];
    }
}
