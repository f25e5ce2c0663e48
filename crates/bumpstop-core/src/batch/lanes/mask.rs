//! Lanes chosen by bits.

use crate::number::{Complex, Instructions, LANES, Lanes, Number};

/// All lanes.
pub(super) const ALL: u8 = u8::MAX;

/// Minus one in the chosen lanes, zero in the others.
#[inline(always)]
pub(super) fn chosen<I: Instructions>(bits: u8) -> Lanes<I> {
    Lanes::of_block(&TABLE[bits as usize])
}

/// `yes` in the chosen lanes, `no` in the others.
#[inline(always)]
pub(super) fn blend<I: Instructions>(chosen: Lanes<I>, yes: Lanes<I>, no: Lanes<I>) -> Lanes<I> {
    chosen.select_less(Lanes::of(0.0), yes, no)
}

/// The same of complex numbers.
#[inline(always)]
pub(super) fn blend_both<I: Instructions>(
    chosen: Lanes<I>,
    yes: Complex<Lanes<I>>,
    no: Complex<Lanes<I>>,
) -> Complex<Lanes<I>> {
    Complex::new(blend(chosen, yes.re, no.re), blend(chosen, yes.im, no.im))
}

const TABLE: [[f64; LANES]; 256] = {
    let mut table = [[0.0; LANES]; 256];
    let mut bits = 0;
    while bits < 256 {
        let mut lane = 0;
        while lane < LANES {
            if bits >> lane & 1 == 1 {
                table[bits][lane] = -1.0;
            }
            lane += 1;
        }
        bits += 1;
    }
    table
};
