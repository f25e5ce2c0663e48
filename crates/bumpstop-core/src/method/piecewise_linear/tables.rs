//! Exponentials over the cells of the walk, kept for a whole run.

use super::rows::{ComplexBlock, RealBlock};
use super::spectrum::Spectrum;
use crate::number::{Instructions, Lanes, Number};

/// Cells after which the exponentials are computed afresh, so that products do not pile up
/// rounding; the signals' rounding bound counts on it.
pub(crate) const CELLS_BETWEEN_ANCHORS: usize = 8;

/// Exponentials over half a cell and over a whole one, and what a whole one multiplies sizes with.
#[derive(Debug, Clone, Default)]
pub(crate) struct Level {
    filled: bool,
    pub half: Vec<ComplexBlock>,
    pub whole: Vec<ComplexBlock>,
    pub growth: Vec<RealBlock>,
}

/// The levels of each spectrum of a run, by number; cells of each level are half as long as those
/// of the one before.
#[derive(Debug, Default)]
pub(crate) struct Tables {
    spectra: Vec<Vec<Level>>,
    longest: f64,
}

impl Tables {
    /// Forgets everything: the walker turns to another run, whose longest cell is given.
    pub(crate) fn start(&mut self, longest: f64) {
        self.longest = longest;
        for level in self.spectra.iter_mut().flatten() {
            level.filled = false;
        }
    }

    /// The longest cell, in s.
    #[inline(always)]
    pub(crate) fn longest(&self) -> f64 {
        self.longest
    }

    /// Width of the cells of a level, in s.
    #[inline(always)]
    pub(crate) fn width(&self, level: usize) -> f64 {
        self.longest * f64::from_bits((1023 - level.min(1022) as u64) << 52)
    }

    /// Makes sure that a level of a spectrum is there.
    #[inline(always)]
    pub(crate) fn fill<I: Instructions>(
        &mut self,
        number: usize,
        spectrum: &Spectrum,
        level: usize,
    ) {
        let half_width = 0.5 * self.width(level);
        if self.spectra.len() <= number {
            self.spectra.resize_with(number + 1, Vec::new);
        }
        let levels = &mut self.spectra[number];
        if levels.len() <= level {
            levels.resize_with(level + 1, Level::default);
        }
        if !levels[level].filled {
            levels[level].fill::<I>(spectrum, half_width);
        }
    }

    /// A level of a spectrum that is there.
    #[inline(always)]
    pub(crate) fn level(&self, number: usize, level: usize) -> &Level {
        &self.spectra[number][level]
    }
}

impl Level {
    /// One exponential and its square: the rounding of both is in the signals' bound.
    #[inline(always)]
    fn fill<I: Instructions>(&mut self, spectrum: &Spectrum, half_width: f64) {
        let blocks = spectrum.lambda.len();
        self.half.resize(blocks, ComplexBlock::ONE);
        self.whole.resize(blocks, ComplexBlock::ONE);
        self.growth.resize(blocks, RealBlock::ONE);
        let half_width = Lanes::<I>::of(half_width);
        for (b, lambda) in spectrum.lambda.iter().enumerate() {
            let (factor, size) = lambda.lanes::<I>().scale(half_width).exp_and_size();
            self.half[b].put(factor);
            self.whole[b].put(factor * factor);
            self.growth[b].put(size * size);
        }
        self.filled = true;
    }
}
