//! What is proved of the guards of eight problems on a cell of time (`docs/theory/certificate.md`), each
//! lane on a cell of its own width.

use super::guard::{Guard, three};
use crate::number::{Instructions, Lanes, Number};

/// Exponents that turn by less than this over half a cell are followed.
pub(super) const FOLLOWED: f64 = 1.2;

/// Cells of one phase after which a lane is given up.
pub(super) const MOST_CELLS: usize = 400;

/// How much more than by its rounding a guard must keep away from zero: single runs decide what is
/// closer.
pub(super) const CLEARANCE: f64 = 64.0;

/// The rounding of a cell's parabola beside that of a value.
const PARABOLA: f64 = 3.1;

/// Bounds on cells of one width.
pub(super) struct Bounds<I: Instructions> {
    pub radius: Lanes<I>,
    spreads: [Lanes<I>; 3],
    pub rounding: Lanes<I>,
}

/// The verdicts on a cell.
pub(super) struct Verdict {
    pub clear: u8,
    pub crosses: u8,
}

impl<I: Instructions> Bounds<I> {
    /// Bounds on cells of some half-widths: exponents never grow, so that they hold all along.
    #[inline(always)]
    pub(super) fn new(guard: &Guard, radius: Lanes<I>, limit: Lanes<I>) -> Self {
        let zero = Lanes::<I>::of(0.0);
        let mut third = zero;
        let mut rest = [zero; 3];
        for j in 0..guard.b.len() {
            let modulus = Lanes::<I>::of_block(&guard.modulus[j]);
            let size = Lanes::<I>::of_block(&guard.size[j]);
            let turn = modulus * radius;
            let slow = turn.select_less(Lanes::of(FOLLOWED), size, zero);
            let fast = size - slow;
            let square = modulus * modulus;
            third = (slow * modulus).mul_add(square, third);
            rest[0] += fast;
            rest[1] = fast.mul_add(modulus, rest[1]);
            rest[2] = fast.mul_add(square, rest[2]);
        }
        let rounding = rounding::<I>(guard, limit) * Lanes::of(PARABOLA);
        let of_slope = rounding / radius;
        Self {
            radius,
            spreads: [
                (third * radius * radius).mul_add(radius * Lanes::of(1.0 / 6.0), rest[0]),
                (third * radius).mul_add(radius * Lanes::of(0.5), rest[1]) + of_slope,
                third.mul_add(radius, rest[2]) + of_slope / radius,
            ],
            rounding,
        }
    }

    /// Lemma 2 of the certificate, for cells at whose left end the guard is positive.
    #[inline(always)]
    pub(super) fn judge(&self, [value, slope, curvature]: &[Lanes<I>; 3]) -> Verdict {
        let (value, slope, curvature) = (*value, *slope, *curvature);
        let zero = Lanes::<I>::of(0.0);
        let r = self.radius;
        let turn = curvature * r;
        let bend = turn * r * Lanes::of(0.5);
        let steepness = slope.abs();
        let tilt = steepness * r;
        let clearance = self.rounding * Lanes::of(CLEARANCE);
        let margin = value - self.spreads[0] - clearance;
        let ends = (tilt - bend).less(margin);
        let vertex = (slope * slope).less((curvature + curvature) * margin);
        let inside = steepness.less(turn);
        let steep = turn.abs() + self.spreads[1];
        let rises = steep.less(slope);
        let falls = steep.less(-slope) | self.spreads[2].less(-curvature);
        let end = slope * r + bend;
        let above = zero.less(margin + end);
        let below = (value + end + self.spreads[0] + clearance).less(zero);
        Verdict {
            clear: (ends & !inside) | (vertex & inside) | rises | (falls & above),
            crosses: falls & below,
        }
    }
}

/// Bound of the rounding of a value of the guard up to a time, after as many cells as there may be.
#[inline(always)]
pub(super) fn rounding<I: Instructions>(guard: &Guard, t: Lanes<I>) -> Lanes<I> {
    let [a, b, c] = three::<I>(&guard.polynomial);
    let polynomial = t.mul_add(t.mul_add(c.abs(), b.abs()), a.abs());
    let size = Lanes::of_block(&guard.totals[0]) + polynomial;
    let turn = Lanes::of_block(&guard.totals[1]) * t;
    let products = (PRODUCTS + 0.5 * guard.b.len() as f64) * f64::EPSILON;
    size * Lanes::of(products) + turn * Lanes::of(f64::EPSILON)
}

/// Rounding of an exponential that is the product of as many as there are cells, each good to 15u
/// with the product itself, in units of 2u.
const PRODUCTS: f64 = 7.5 * MOST_CELLS as f64;
