//! Exponentials at the middles of eight consecutive cells, kept for a whole run.

use super::rows::{ComplexBlock, RealBlock, spread};
use super::spectrum::Spectrum;
use crate::number::{Complex, Instructions, LANES, Lanes, Number};

/// Cells that are judged at once, one a lane; the signals' rounding bound counts on it.
pub(crate) const CELLS: usize = LANES;

/// Exponents with `|lambda| r` below this are followed by their Taylor polynomial over a cell of
/// half-width r, faster ones are bounded by their size: both cost about the same here.
pub(crate) const FOLLOWED: f64 = 1.2;

/// An exponent that is followed over the cells of a level.
#[derive(Debug, Clone)]
pub(crate) struct Followed {
    /// Its block and lane in the spectrum.
    pub block: usize,
    pub lane: usize,
    /// `exp(lambda t)`, t from the left end of the first cell to the middle of each.
    pub middles: ComplexBlock,
}

/// What depends on the width of the cells alone.
#[derive(Debug, Clone, Default)]
pub(crate) struct Level {
    filled: bool,
    pub width: f64,
    /// Moduli of exponents below this are followed.
    pub limit: f64,
    pub followed: Vec<Followed>,
    /// What a size grows by at most over the cells.
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

    /// A level of a spectrum, computed when it is first asked for.
    #[inline(always)]
    pub(crate) fn level<I: Instructions>(
        &mut self,
        number: usize,
        spectrum: &Spectrum,
        level: usize,
    ) -> &Level {
        let width = self.width(level);
        if self.spectra.len() <= number {
            self.spectra.resize_with(number + 1, Vec::new);
        }
        let levels = &mut self.spectra[number];
        if levels.len() <= level {
            levels.resize_with(level + 1, Level::default);
        }
        let level = &mut levels[level];
        if !level.filled {
            level.fill::<I>(spectrum, width);
        }
        level
    }
}

impl Level {
    /// All from one exponential for each exponent, over half a cell, by squares and products: the
    /// rounding of these is in the signals' bound.
    #[inline(always)]
    fn fill<I: Instructions>(&mut self, spectrum: &Spectrum, width: f64) {
        self.filled = true;
        self.width = width;
        self.limit = FOLLOWED / (0.5 * width);
        self.followed.clear();
        self.growth.resize(spectrum.lambda.len(), RealBlock::ONE);
        let one = Lanes::<I>::of(1.0);
        let exponents = spectrum.lambda.iter().zip(&spectrum.moduli);
        for (block, (lambda, moduli)) in exponents.enumerate() {
            let half = lambda.lanes::<I>().scale(Lanes::of(0.5 * width));
            let (half, size) = half.exp_and_size();
            let whole = half * half;
            let two = whole * whole;
            let four = two * two;
            let size = size * size;
            let size = size * size;
            let size = size * size;
            self.growth[block].put((size * size).max(one));
            let mut powers = [ComplexBlock::ZERO; 4];
            for (block, power) in powers.iter_mut().zip([half, half * whole, two, four]) {
                block.put(power);
            }
            // Padding has modulus zero, and exponents of zero are constants.
            let moduli = moduli.lanes::<I>();
            let moving = Lanes::of(0.0).less(moduli);
            let mut followed = moving & moduli.less(Lanes::of(self.limit));
            while followed != 0 {
                let lane = followed.trailing_zeros() as usize;
                followed &= followed - 1;
                let mut middles = ComplexBlock::ZERO;
                middles.put(middles_of::<I>(&powers, lane));
                self.followed.push(Followed {
                    block,
                    lane,
                    middles,
                });
            }
        }
    }
}

/// The powers 1, 3, 5, .. 15 of an exponential over half a cell, from those at 1, 3, 4 and 8.
#[inline(always)]
fn middles_of<I: Instructions>(powers: &[ComplexBlock; 4], lane: usize) -> Complex<Lanes<I>> {
    let one = Complex::real(Lanes::<I>::of(1.0));
    let [first, second, two, four] = powers;
    let pairs = select(
        Lanes::new([1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0]),
        spread(second, lane),
        spread(first, lane),
    );
    let fours = select(
        Lanes::new([1.0, 1.0, -1.0, -1.0, 1.0, 1.0, -1.0, -1.0]),
        spread(two, lane),
        one,
    );
    let eights = select(
        Lanes::new([1.0, 1.0, 1.0, 1.0, -1.0, -1.0, -1.0, -1.0]),
        spread(four, lane),
        one,
    );
    pairs * fours * eights
}

/// `yes` in the lanes where `sign` is negative.
#[inline(always)]
fn select<I: Instructions>(
    sign: Lanes<I>,
    yes: Complex<Lanes<I>>,
    no: Complex<Lanes<I>>,
) -> Complex<Lanes<I>> {
    let zero = Lanes::<I>::of(0.0);
    Complex::new(
        sign.select_less(zero, yes.re, no.re),
        sign.select_less(zero, yes.im, no.im),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::piecewise_linear::rows::entry;
    use crate::number::Plain;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn middles_are_the_exponentials_there(
            re in -30.0f64..3.0, im in 1.0f64..60.0, width in 0.01f64..0.05,
        ) {
            let lambda = Complex::new(re, im);
            let mut spectrum = Spectrum::default();
            spectrum.lambda.push(ComplexBlock::ZERO);
            spectrum.moduli.push(RealBlock::ZERO);
            let lane = 3;
            (spectrum.lambda[0].re[lane], spectrum.lambda[0].im[lane]) = (re, im);
            spectrum.moduli[0].0[lane] = lambda.norm();
            let mut level = Level::default();
            level.fill::<Plain>(&spectrum, width);
            prop_assert_eq!(level.followed.len(), usize::from(0.5 * lambda.norm() * width < FOLLOWED));
            for followed in &level.followed {
                prop_assert_eq!((followed.block, followed.lane), (0, lane));
                for cell in 0..CELLS {
                    let middle = (cell as f64 + 0.5) * width;
                    let size = (re * middle).exp();
                    let (sin, cos) = (im * middle).sin_cos();
                    let found = entry(std::slice::from_ref(&followed.middles), cell);
                    let error = found - Complex::new(size * cos, size * sin);
                    prop_assert!(error.norm() < 64.0 * f64::EPSILON * size);
                }
            }
            let growth = (8.0 * re * width).exp().max(1.0);
            prop_assert!((level.growth[0].0[lane] - growth).abs() < 64.0 * f64::EPSILON * growth);
        }
    }
}
