//! The largest depth of eight contacts: it is at an end, or where the depth turns.
//!
//! The turns are the zeros of the depth's rate, found one after the other by the same certified
//! walk as the zeros of the depth itself: none is missed. A lane whose rate nearly touches zero is
//! given up.

use super::guard::Guard;
use super::mask::{ALL, blend, chosen};
use super::walk::Walker;
use crate::method::piecewise_linear::ComplexBlock;
use crate::number::{Block, Instructions, LANES, Lanes, Number};

/// Turns of one contact after which a lane is given up.
const MOST_TURNS: usize = 1_000;

/// Room for the peaks of eight contacts.
#[derive(Debug, Default)]
pub(super) struct Peaks {
    /// The rate of the depth since its last turn, of the sign that it has behind it.
    rate: Guard,
    walker: Walker,
    exponentials: Vec<ComplexBlock>,
    /// The largest depths, and when, in s since the start of the contact.
    pub depth: Block,
    pub time: Block,
}

impl Peaks {
    pub(super) fn new(modes: usize) -> Self {
        Self {
            rate: Guard::new(modes),
            walker: Walker::new(modes),
            exponentials: vec![ComplexBlock::ZERO; modes],
            depth: [0.0; LANES],
            time: [0.0; LANES],
        }
    }

    /// Takes the exponents of contacts.
    #[inline(always)]
    pub(super) fn turn_to<I: Instructions>(&mut self, lambda: &[ComplexBlock]) {
        self.rate.turn_to::<I>(lambda);
    }

    /// Finds the largest depths up to the ends of contacts; returns the lanes that are given up.
    #[inline(always)]
    pub(super) fn find<I: Instructions>(&mut self, contact: &Guard, end: Lanes<I>, live: u8) -> u8 {
        self.depth = [0.0; LANES];
        self.see(contact, Lanes::<I>::of(0.0), live);
        let mut failed = self.set_out::<I>(contact, live);
        let mut walking = live & !failed;
        let mut time = Lanes::<I>::of(0.0);
        let mut departs = 0;
        for _ in 0..MOST_TURNS {
            let ends = (self.walker).walk(&self.rate, end - time, walking, departs);
            failed |= ends.failed;
            walking &= ends.found & !ends.failed;
            if walking == 0 {
                break;
            }
            time += Lanes::of_block(&ends.time);
            self.see(contact, time, walking);
            self.turn::<I>();
            departs = ALL;
        }
        self.see(contact, end, live);
        failed | walking
    }

    /// Takes the rates at the start of contacts, all made positive; returns the lanes without one.
    #[inline(always)]
    fn set_out<I: Instructions>(&mut self, contact: &Guard, live: u8) -> u8 {
        let zero = Lanes::<I>::of(0.0);
        let mut start = zero;
        for (j, b) in contact.b.iter().enumerate() {
            let rate = b.lanes::<I>() * contact.lambda[j].lanes();
            start += rate.re;
            self.rate.b[j].put(rate);
        }
        let (rises, falls) = (zero.less(start), start.less(zero));
        let sign = blend(chosen::<I>(falls), Lanes::of(-1.0), Lanes::of(1.0));
        for b in &mut self.rate.b {
            b.put(b.lanes::<I>().scale(sign));
        }
        self.rate.measure::<I>();
        live & !(rises | falls)
    }

    /// Goes on from a zero of the rate, behind which it has the other sign.
    #[inline(always)]
    fn turn<I: Instructions>(&mut self) {
        for (b, e) in self.rate.b.iter_mut().zip(&self.walker.exponentials) {
            let there = b.lanes::<I>() * e.lanes();
            b.put(there.scale(Lanes::of(-1.0)));
        }
        self.rate.measure::<I>();
    }

    /// Takes note of the depth at some time.
    #[inline(always)]
    fn see<I: Instructions>(&mut self, contact: &Guard, time: Lanes<I>, live: u8) {
        let [depth, ..] = contact.values::<I>(time, &mut self.exponentials);
        let largest = Lanes::<I>::of_block(&self.depth);
        let larger = chosen::<I>(largest.less(depth) & live);
        blend(larger, depth, largest).to_block(&mut self.depth);
        blend(larger, time, Lanes::of_block(&self.time)).to_block(&mut self.time);
    }
}
