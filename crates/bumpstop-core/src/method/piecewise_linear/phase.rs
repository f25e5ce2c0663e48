//! Phases: stretches of time in which no law switches, kept as amplitudes of exponentials.

use super::spectrum::{Rows, Single, Spectrum, Subject};
use crate::error::{Error, Result};
use crate::law::State;
use crate::number::{Complex, Instructions, LANES, Lanes, Number};

/// The largest error, relative to the state's largest part, with which the amplitudes of a
/// phase may give back the state they were made from. Beyond it the eigenvectors are too close
/// to each other to be trusted.
const LARGEST_DEFECT: f64 = 1e-10;

/// One phase.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Phase {
    /// Its first instant, in s.
    pub start: f64,
    /// Its spectrum, by number.
    pub spectrum: usize,
    /// Where its amplitudes and its singles' initial states start.
    amplitudes: usize,
    kept: usize,
}

/// The phases of a run in order of time.
#[derive(Debug, Clone, Default)]
pub(crate) struct Phases {
    pub spectra: Vec<Spectrum>,
    pub list: Vec<Phase>,
    amplitude_re: Vec<f64>,
    amplitude_im: Vec<f64>,
    kept: Vec<f64>,
}

/// Room for the evaluation of a phase, used again and again.
#[derive(Debug, Clone, Default)]
pub(crate) struct Workspace {
    /// `a exp(lambda t)` and its rate.
    pub z: Rows,
    pub rate: Rows,
    position: Vec<f64>,
    velocity: Vec<f64>,
    own_position: Vec<f64>,
    own_velocity: Vec<f64>,
    lack_position: Vec<f64>,
    lack_velocity: Vec<f64>,
}

impl Workspace {
    fn fit(&mut self, exponents: usize) {
        if self.z.stride != exponents {
            self.z = Rows::zeros(1, exponents);
            self.rate = Rows::zeros(1, exponents);
        }
    }
}

impl Phases {
    /// Starts a phase from a state.
    ///
    /// # Errors
    /// [`Error::Defective`] when the amplitudes do not give the state back,
    /// [`Error::Overflow`] when it is not finite.
    #[inline(always)]
    pub(crate) fn begin<I: Instructions>(
        &mut self,
        start: f64,
        spectrum: usize,
        q: &[f64],
        v: &[f64],
        work: &mut Workspace,
    ) -> Result<()> {
        let phase = Phase {
            start,
            spectrum,
            amplitudes: self.amplitude_re.len(),
            kept: self.kept.len(),
        };
        let which = &self.spectra[spectrum];
        work.fit(which.exponents());
        work.position.resize(which.combinations, 0.0);
        work.velocity.resize(which.combinations, 0.0);
        which.gather(q, &mut work.position);
        which.gather(v, &mut work.velocity);
        if which.groups > 0 {
            work.solve_amplitudes::<I>(which, start)?;
        }
        subtract(which, q, &work.position, &mut work.own_position);
        subtract(which, v, &work.velocity, &mut work.own_velocity);
        for single in &which.singles {
            let (x0, v0) = match single.subject {
                Subject::Mode(mode) => (work.own_position[mode], work.own_velocity[mode]),
                Subject::Combination => (work.position[0], work.velocity[0]),
            };
            self.kept.extend([x0, v0]);
            let amplitudes = single.motion.amplitudes(x0, v0);
            for (i, a) in amplitudes
                .iter()
                .enumerate()
                .take(single.motion.exponents().1)
            {
                work.z.set(0, single.at + i, *a);
            }
        }
        self.amplitude_re.extend_from_slice(&work.z.re);
        self.amplitude_im.extend_from_slice(&work.z.im);
        self.list.push(phase);
        Ok(())
    }

    /// Keeps a spectrum; returns its number.
    pub(crate) fn add_spectrum(&mut self, spectrum: Spectrum) -> usize {
        self.spectra.push(spectrum);
        self.spectra.len() - 1
    }

    /// Amplitudes of a phase.
    #[inline(always)]
    pub(crate) fn amplitudes(&self, phase: Phase) -> (&[f64], &[f64]) {
        let range = phase.amplitudes..phase.amplitudes + self.spectra[phase.spectrum].exponents();
        (&self.amplitude_re[range.clone()], &self.amplitude_im[range])
    }

    /// Initial position and velocity of a single motion.
    #[inline(always)]
    pub(crate) fn kept(&self, phase: Phase, single: usize) -> (f64, f64) {
        let at = phase.kept + 2 * single;
        (self.kept[at], self.kept[at + 1])
    }

    /// Fills the workspace with the exponentials of a phase, `t` after its start.
    #[inline(always)]
    pub(crate) fn turn<I: Instructions>(&self, phase: Phase, t: f64, work: &mut Workspace) {
        let spectrum = &self.spectra[phase.spectrum];
        let (re, im) = self.amplitudes(phase);
        work.fit(spectrum.exponents());
        for o in (0..spectrum.exponents()).step_by(LANES) {
            let lambda = spectrum.lambda.lanes::<I>(0, o);
            let amplitude = Complex::new(Lanes::<I>::load(&re[o..]), Lanes::<I>::load(&im[o..]));
            let z = amplitude * lambda.scale(Lanes::<I>::of(t)).exp();
            work.z.put(0, o, z);
            work.rate.put(0, o, z * lambda);
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
        for g in 0..spectrum.groups {
            work.position[g] = spectrum.at_rest[g] + spectrum.group_sum::<I>(g, &work.z);
            work.velocity[g] = spectrum.group_sum::<I>(g, &work.rate);
        }
        q.fill(0.0);
        v.fill(0.0);
        for (index, single) in spectrum.singles.iter().enumerate() {
            let (x, rate) = self.single_motion(phase, index, single, t, work);
            match single.subject {
                Subject::Mode(mode) => (q[mode], v[mode]) = (x, rate),
                Subject::Combination => {
                    (work.position[0], work.velocity[0]) = (x, rate);
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
        let (x0, v0) = self.kept(phase, index);
        if single.motion.is_special() {
            let [x, v, _] = single.motion.special(x0, v0, t);
            return (x, v);
        }
        let p = single.motion.polynomial(x0, v0);
        let (mut x, mut v) = (p[0] + t * (p[1] + t * p[2]), p[1] + 2.0 * t * p[2]);
        for i in 0..single.motion.exponents().1 {
            x += work.z.re[single.at + i];
            v += work.rate.re[single.at + i];
        }
        (x, v)
    }

    /// The states of the laws during a phase.
    pub(crate) fn states(&self, phase: Phase) -> &[State] {
        &self.spectra[phase.spectrum].states
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

impl Workspace {
    /// Amplitudes of the coupled exponents, with the proof that they are complete: they must
    /// give the state back.
    ///
    /// What is lacking is given to them in a second round. Left vectors and shapes are inverse
    /// to each other only up to rounding, the same one in every phase, and over ten thousand
    /// impacts an amplitude that grows by it each time would be felt.
    #[inline(always)]
    fn solve_amplitudes<I: Instructions>(&mut self, spectrum: &Spectrum, time: f64) -> Result<()> {
        let (mut size, mut size_rate) = (0.0f64, 0.0f64);
        self.lack_position.clear();
        self.lack_velocity.clear();
        for g in 0..spectrum.groups {
            let (rest, velocity) = (spectrum.at_rest[g], self.velocity[g]);
            self.lack_position.push(self.position[g] - rest);
            self.lack_velocity.push(velocity);
            size = size.max(self.position[g].abs()).max(rest.abs());
            size_rate = size_rate.max(velocity.abs());
        }
        spectrum.amplitudes::<I>(&self.lack_position, &self.lack_velocity, &mut self.rate);
        self.z.re[..].copy_from_slice(&self.rate.re);
        self.z.im[..].copy_from_slice(&self.rate.im);
        let (lack, lack_rate) = self.find_lack::<I>(spectrum);
        if !(size.is_finite() && size_rate.is_finite()) {
            return Err(Error::Overflow { time });
        }
        // A position and a velocity are measured against each other by the fastest exponent.
        let fastest = spectrum.fastest.max(f64::MIN_POSITIVE);
        let scale = size.max(size_rate / fastest).max(f64::MIN_POSITIVE);
        let defect = lack.max(lack_rate / fastest) / scale;
        if defect.is_nan() || defect > LARGEST_DEFECT {
            return Err(Error::Defective { time, defect });
        }
        spectrum.amplitudes::<I>(&self.lack_position, &self.lack_velocity, &mut self.rate);
        for o in (0..spectrum.coupled_stride).step_by(LANES) {
            let whole = self.z.lanes::<I>(0, o) + self.rate.lanes(0, o);
            self.z.put(0, o, whole);
        }
        Ok(())
    }

    /// What the amplitudes lack of the state; returns the largest lack of position and velocity.
    #[inline(always)]
    fn find_lack<I: Instructions>(&mut self, spectrum: &Spectrum) -> (f64, f64) {
        for o in (0..spectrum.coupled_stride).step_by(LANES) {
            let rate = self.z.lanes::<I>(0, o) * spectrum.lambda.lanes(0, o);
            self.rate.put(0, o, rate);
        }
        let (mut worst, mut worst_rate) = (0.0f64, 0.0f64);
        for g in 0..spectrum.groups {
            self.lack_position[g] -= spectrum.group_sum::<I>(g, &self.z);
            self.lack_velocity[g] -= spectrum.group_sum::<I>(g, &self.rate);
            worst = larger(worst, self.lack_position[g].abs());
            worst_rate = larger(worst_rate, self.lack_velocity[g].abs());
        }
        (worst, worst_rate)
    }
}

/// The larger of two, NaN if one is.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b <= a { a } else { b }
}
