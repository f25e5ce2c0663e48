//! Loads on motions so slow that they are followed by their Taylor series.

use super::parts::{ComplexParts, Parts};
use super::single::is_slow;
use crate::forcing::{Forcing, Onset};
use crate::method::piecewise_linear::single_mode::Regime;
use crate::method::piecewise_linear::spectrum::Spectrum;
use crate::number::Complex;

/// The load on a single motion that is so slow that it is followed by its Taylor series.
#[derive(Debug, Clone)]
pub(super) struct SlowLoad {
    pub single: usize,
    /// Where its coefficients stand among those kept for a phase, and how many they are.
    at: usize,
    length: usize,
    channels: Vec<f64>,
    /// The slow harmonics, with their amplitudes.
    harmonics: Vec<(usize, Complex<f64>)>,
}

/// Terms of the Taylor series of a slow harmonic load; their last is far below rounding.
const SLOW_TERMS: usize = 20;

impl SlowLoad {
    /// The loads on the slow singles of a spectrum.
    pub(super) fn list(forcing: &Forcing, spectrum: &Spectrum, duration: f64) -> Vec<Self> {
        let mut loads: Vec<Self> = Vec::new();
        let channels: Vec<Parts> = (forcing.channels().iter())
            .map(|channel| Parts::of(spectrum, &channel.direction))
            .collect();
        let harmonics: Vec<(usize, ComplexParts)> = (forcing.harmonics().iter().enumerate())
            .filter(|(_, harmonic)| is_slow(harmonic.omega, duration))
            .map(|(number, h)| (number, ComplexParts::of(spectrum, &h.amplitude)))
            .collect();
        let mut at = 2 * spectrum.singles.len();
        let length = if harmonics.is_empty() {
            forcing.stride()
        } else {
            SLOW_TERMS
        };
        for (single, _) in (spectrum.singles.iter().enumerate())
            .filter(|(_, single)| single.motion.regime == Regime::Slow)
        {
            loads.push(Self {
                single,
                at,
                length,
                channels: channels.iter().map(|parts| parts.singles[single]).collect(),
                harmonics: (harmonics.iter())
                    .map(|(number, parts)| (*number, parts.singles[single]))
                    .collect(),
            });
            at += length;
        }
        loads
    }

    /// Puts the coefficients of the load on its single behind what is kept of a phase.
    pub(super) fn keep(&self, onset: &Onset, stride: usize, omegas: &[f64], kept: &mut Vec<f64>) {
        let from = kept.len();
        kept.resize(from + self.length, 0.0);
        let to = &mut kept[from..];
        let channels = onset.coefficients.chunks(stride.max(1));
        for (gain, coefficients) in self.channels.iter().zip(channels) {
            for (to, c) in to.iter_mut().zip(coefficients) {
                *to += gain * c;
            }
        }
        for (harmonic, amplitude) in &self.harmonics {
            let mut term = *amplitude * onset.units[*harmonic];
            for (n, to) in to.iter_mut().enumerate() {
                *to += term.re;
                term = term * Complex::new(0.0, omegas[*harmonic] / (n + 1) as f64);
            }
        }
    }

    /// The coefficients among those kept of a phase.
    pub(super) fn coefficients<'a>(&self, kept: &'a [f64]) -> &'a [f64] {
        &kept[self.at..][..self.length]
    }
}
