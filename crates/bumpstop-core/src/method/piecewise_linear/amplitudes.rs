//! Amplitudes of a phase from the state at its start, with the proof that they are complete.

use super::phase::Workspace;
use super::rows::set_entry;
use super::singles::Subject;
use super::spectrum::Spectrum;
use crate::error::{Error, Result};
use crate::number::{Instructions, Plain};

/// The largest error, relative to the state's largest part, with which the amplitudes of a
/// phase may give back the state they were made from. Beyond it the eigenvectors are too close
/// to each other to be trusted.
const LARGEST_DEFECT: f64 = 1e-10;

/// The same at first, where further rounds bring it below: what is lost to eigenvectors so close
/// to each other is told by the error of the motion.
const LARGEST_FIRST_DEFECT: f64 = 1e-8;

/// Further rounds at most.
const MOST_ROUNDS: usize = 4;

impl Workspace {
    /// Amplitudes of what moves by itself, and what is kept of it.
    #[inline(always)]
    pub(super) fn begin_singles(&mut self, spectrum: &Spectrum, kept: &mut Vec<f64>) {
        for single in &spectrum.singles {
            let (x0, v0) = match single.subject {
                Subject::Mode(mode) => (self.own_position[mode], self.own_velocity[mode]),
                Subject::Combination(number) => (self.position[number], self.velocity[number]),
            };
            kept.extend([x0, v0]);
            let amplitudes = single.motion.amplitudes(x0, v0);
            let count = single.motion.count();
            for (i, amplitude) in amplitudes[..count].iter().enumerate() {
                set_entry(&mut self.z, single.at + i, *amplitude);
            }
        }
    }

    /// Amplitudes of the coupled exponents, with the proof that they are complete: they must
    /// give the state back.
    ///
    /// What is lacking is given to them in a second round. Left vectors and shapes are inverse
    /// to each other only up to rounding, the same one in every phase, and over ten thousand
    /// impacts an amplitude that grows by it each time would be felt.
    #[inline(always)]
    pub(super) fn solve_amplitudes<I: Instructions>(
        &mut self,
        spectrum: &Spectrum,
        time: f64,
    ) -> Result<()> {
        let [size, size_rate] = self.take_state(spectrum);
        spectrum.add_amplitudes::<I>(&self.lack_position, &self.lack_velocity, &mut self.z);
        let (lack, lack_rate) = self.find_lack::<I>(spectrum);
        if !(size.is_finite() && size_rate.is_finite()) {
            return Err(Error::Overflow { time });
        }
        // A position and a velocity are measured against each other by the fastest exponent.
        let fastest = spectrum.pace().max(f64::MIN_POSITIVE);
        let scale = size.max(size_rate / fastest).max(f64::MIN_POSITIVE);
        let defect = lack.max(lack_rate / fastest) / scale;
        // Written so that a defect which is not a number is one too large.
        let is_complete = defect <= LARGEST_DEFECT
            || defect <= LARGEST_FIRST_DEFECT && self.complete(spectrum, fastest, scale);
        if !is_complete {
            return Err(Error::Defective { time, defect });
        }
        spectrum.add_amplitudes::<I>(&self.lack_position, &self.lack_velocity, &mut self.z);
        Ok(())
    }

    /// The state less the position at rest, which the amplitudes are to give; returns the sizes of
    /// positions and velocities.
    #[inline(always)]
    fn take_state(&mut self, spectrum: &Spectrum) -> [f64; 2] {
        let (mut size, mut size_rate) = (0.0f64, 0.0f64);
        self.lack_position.clear();
        self.lack_velocity.clear();
        self.given_position.resize(spectrum.groups, 0.0);
        self.given_velocity.resize(spectrum.groups, 0.0);
        self.lack_position.extend_from_slice(&self.position);
        for (position, rest) in self.lack_position.iter_mut().zip(&spectrum.at_rest) {
            size = either(size, either(position.abs(), rest.abs()));
            *position -= rest;
        }
        self.lack_velocity.extend_from_slice(&self.velocity);
        for velocity in &self.velocity {
            size_rate = either(size_rate, velocity.abs());
        }
        for (lack, rate) in self.lack_velocity.iter_mut().zip(&spectrum.rate_at_rest) {
            *lack -= rate;
        }
        [size, size_rate]
    }

    /// Gives the amplitudes what they lack until they give the state back, and tells whether they
    /// do. Rare, so that plain arithmetic does.
    #[cold]
    fn complete(&mut self, spectrum: &Spectrum, fastest: f64, scale: f64) -> bool {
        (0..MOST_ROUNDS).any(|_| {
            spectrum.add_amplitudes::<Plain>(&self.lack_position, &self.lack_velocity, &mut self.z);
            self.take_state(spectrum);
            let (lack, lack_rate) = self.find_lack::<Plain>(spectrum);
            lack.max(lack_rate / fastest) <= LARGEST_DEFECT * scale
        })
    }

    /// What the amplitudes lack of the state; returns the largest lack of position and velocity.
    #[inline(always)]
    fn find_lack<I: Instructions>(&mut self, spectrum: &Spectrum) -> (f64, f64) {
        let exponents = spectrum.lambda.iter().take(spectrum.coupled_width);
        for ((lambda, z), rate) in exponents.zip(&self.z).zip(&mut self.rate) {
            rate.put(z.lanes::<I>() * lambda.lanes());
        }
        for cluster in &spectrum.clusters {
            let rate = cluster.rate(&cluster.columns(&self.z));
            cluster.put(&rate, &mut self.rate);
        }
        spectrum.group_sums::<I>(
            [&self.z, &self.rate],
            [&mut self.given_position, &mut self.given_velocity],
        );
        let (mut worst, mut worst_rate) = (0.0f64, 0.0f64);
        for (lack, given) in self.lack_position.iter_mut().zip(&self.given_position) {
            *lack -= given;
            worst = larger(worst, lack.abs());
        }
        for (lack, given) in self.lack_velocity.iter_mut().zip(&self.given_velocity) {
            *lack -= given;
            worst_rate = larger(worst_rate, lack.abs());
        }
        (worst, worst_rate)
    }
}

/// The larger of two, in one instruction; the first where one is not a number.
#[inline(always)]
fn either(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

/// The larger of two, NaN if one is.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b <= a { a } else { b }
}
