//! A guard on eight consecutive cells of time at once, a cell a lane.

use super::jet::Jets;
use super::phase::{Phase, Phases};
use super::rows::{ComplexBlock, RealBlock};
use super::signal::Signal;
use super::tables::{CELLS, FOLLOWED, Level};
use crate::number::{Instructions, LANES, Lanes, Number};

/// Eight consecutive cells.
#[derive(Clone, Copy)]
pub(crate) struct Cells<'a> {
    /// Left end of the first, in s since the start of the phase.
    pub time: f64,
    /// Time after which nothing is asked.
    pub limit: f64,
    /// The exponentials there, and their moduli.
    pub left: &'a [ComplexBlock],
    pub sizes: &'a [RealBlock],
    pub level: &'a Level,
}

/// The terms of a signal and of its two derivatives, carried to the left end of some cells.
pub(crate) type Moved = [ComplexBlock; 3];

/// A guard on eight consecutive cells.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Seen {
    pub jets: Jets,
    /// Curvature of the slow part at the left end of the first.
    pub first_curvature: f64,
    /// The cells on which the guard is proved to stay positive, one bit each.
    pub clear: u8,
}

impl Cells<'_> {
    /// Looks at a signal; `moved` is room for its terms, and `seen` is overwritten: it is large, and
    /// not moved about.
    #[inline(always)]
    pub(crate) fn look<I: Instructions>(
        &self,
        signal: &Signal,
        phases: &Phases,
        phase: Phase,
        moved: &mut Vec<Moved>,
        seen: &mut Seen,
    ) {
        let constant = self.bound::<I>(signal, phases, phase, moved, seen);
        self.follow::<I>(signal, phases, phase, moved, constant, &mut seen.jets);
        seen.clear = seen.jets.clear::<I>(0.5 * self.level.width);
    }

    /// Carries the terms to the left end, and bounds over all cells what is not followed. Returns
    /// what exponents of zero add up to: a level does not tell them from padding.
    #[inline(always)]
    fn bound<I: Instructions>(
        &self,
        signal: &Signal,
        phases: &Phases,
        phase: Phase,
        moved: &mut Vec<Moved>,
        seen: &mut Seen,
    ) -> f64 {
        let moduli = &phases.spectra[phase.spectrum].moduli;
        let limit = Lanes::<I>::of(self.level.limit);
        let zero = Lanes::<I>::of(0.0);
        let tiny = Lanes::<I>::of(f64::MIN_POSITIVE);
        let (mut third, mut curvature, mut constant) = (zero, zero, zero);
        let mut rest = [zero; 3];
        moved.resize(moduli.len(), [ComplexBlock::ZERO; 3]);
        for (b, moved) in moved.iter_mut().enumerate() {
            let left = self.left[b].lanes::<I>();
            let terms = &signal.terms[b];
            for (moved, of) in moved.iter_mut().zip(&terms.of) {
                moved.put(of.lanes() * left);
            }
            let modulus = moduli[b].lanes::<I>();
            let modulus2 = modulus * modulus;
            let growth = self.level.growth[b].lanes();
            let size = terms.size.lanes() * self.sizes[b].lanes() * growth;
            let slow = modulus.select_less(limit, size, zero);
            let fast = size - slow;
            curvature += modulus.select_less(limit, moved[2].lanes::<I>().re, zero);
            constant += modulus.select_less(tiny, moved[0].lanes::<I>().re, zero);
            rest[0] += fast;
            rest[1] = fast.mul_add(modulus, rest[1]);
            rest[2] = fast.mul_add(modulus2, rest[2]);
            third = (slow * modulus).mul_add(modulus2, third);
        }
        let totals = Lanes::totals([
            third, rest[0], rest[1], rest[2], curvature, constant, zero, zero,
        ]);
        let last = self.last();
        seen.jets.third = totals[0] + signal.slow_third(last);
        seen.jets.rest = [totals[1], totals[2], totals[3]];
        seen.jets.rounding = PARABOLA * signal.rounding(last);
        let mut first = [0.0; 3];
        signal.add_slow(phases, phase, self.time, &mut first);
        seen.first_curvature = totals[4] + first[2];
        totals[5]
    }

    /// Value, slope and curvature of what is followed, at the middles of the cells.
    #[inline(always)]
    fn follow<I: Instructions>(
        &self,
        signal: &Signal,
        phases: &Phases,
        phase: Phase,
        moved: &[Moved],
        constant: f64,
        jets: &mut Jets,
    ) {
        let zero = Lanes::<I>::of(0.0);
        let (mut re, mut im) = ([zero; 3], [zero; 3]);
        for followed in &self.level.followed {
            let e = followed.middles.lanes::<I>();
            let moved = &moved[followed.block];
            for n in 0..3 {
                re[n] = e.re.mul_add(Lanes::of(moved[n].re[followed.lane]), re[n]);
                im[n] = e.im.mul_add(Lanes::of(moved[n].im[followed.lane]), im[n]);
            }
        }
        let slow = signal.slow_over::<I>(phases, phase, self.middles());
        (re[0] - im[0] + (slow[0] + Lanes::of(constant))).to_block(&mut jets.values);
        (re[1] - im[1] + slow[1]).to_block(&mut jets.slopes);
        (re[2] - im[2] + slow[2]).to_block(&mut jets.curvatures);
        signal.add_clusters(phases, phase, self.time, self.level.width, jets);
    }

    /// Right end of the last cell that matters, or later.
    #[inline(always)]
    fn last(&self) -> f64 {
        let width = self.level.width;
        (self.time + CELLS as f64 * width).min(self.limit + width)
    }

    /// Times of the middles of the cells.
    #[inline(always)]
    fn middles<I: Instructions>(&self) -> Lanes<I> {
        Lanes::new(MIDDLES).mul_add(Lanes::of(self.level.width), Lanes::of(self.time))
    }
}

/// How much more than a value the parabola through value, slope and curvature may be off by
/// rounding, anywhere on its cell: those of the terms that are followed are wrong by (a/r) and
/// (a/r)^2 times what the value is, a = 1.2 bounding `|lambda| r`, so that all of it is
/// 1 + a + a^2/2 = 2.92 times that; the rest is for the arithmetic of the parabola itself.
const PARABOLA: f64 = 3.1;

// Slope and curvature, times r and r^2, are then off by less than the parabola: the verdicts count
// on it.
const _: () = assert!(FOLLOWED + FOLLOWED * FOLLOWED < PARABOLA);

/// Middles of eight cells of width one.
const MIDDLES: [f64; LANES] = [0.5, 1.5, 2.5, 3.5, 4.5, 5.5, 6.5, 7.5];
