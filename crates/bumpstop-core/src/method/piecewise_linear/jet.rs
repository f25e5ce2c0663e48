//! What is known of a guard on a cell of time, and what follows from it.

use crate::number::{Block, Instructions, Lanes, Number};

/// A guard around the middle of a cell: value and derivatives of its slow part there, and
/// bounds on everything else over the whole cell.
///
/// With x the time from the middle, |x| <= r,
/// `|g(x) - (value + slope x + curvature x^2/2)| <= third r^3/6 + rest[0]`, and likewise
/// `third r^2/2 + rest[1]` for the slope and `third r + rest[2]` for the curvature.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Jet {
    /// Value of the slow part at the middle.
    pub value: f64,
    /// Its first derivative.
    pub slope: f64,
    /// Its second derivative.
    pub curvature: f64,
    /// Bound of its third derivative over the cell.
    pub third: f64,
    /// Bounds of the fast part, of its slope and of its curvature over the cell.
    pub rest: [f64; 3],
    /// Bound of the rounding of a value and of the parabola, and of r times a slope's and r^2 times
    /// a curvature's.
    pub rounding: f64,
}

/// Jets on eight consecutive cells of one width.
#[derive(Debug, Clone, Copy, Default)]
pub struct Jets {
    /// Values of the slow parts at the middles.
    pub values: Block,
    /// Their first derivatives.
    pub slopes: Block,
    /// Their second derivatives.
    pub curvatures: Block,
    /// Bound of their third derivatives over all eight cells.
    pub third: f64,
    /// Bounds of the fast part, of its slope and of its curvature over all eight cells.
    pub rest: [f64; 3],
    /// Bound of the rounding, as in a [`Jet`].
    pub rounding: f64,
}

impl Jets {
    /// The cells, one bit each, on which the guard is proved to stay positive, or never to be away
    /// from zero by more than rounding, if it is positive at the cell's left end.
    #[inline(always)]
    pub fn clear<I: Instructions>(&self, r: f64) -> u8 {
        let value = Lanes::<I>::of_block(&self.values);
        let slope = Lanes::<I>::of_block(&self.slopes);
        let curvature = Lanes::<I>::of_block(&self.curvatures);
        let rounding = self.rounding;
        let spreads = spreads(self.third, self.rest, rounding, r);
        let twice = Lanes::<I>::of(2.0);
        let radius = Lanes::<I>::of(r);
        let turn = curvature * radius;
        let bend = turn * Lanes::of(0.5 * r);
        let steepness = slope.abs();
        let tilt = steepness * radius;
        // The least value of the parabola lies at an end, or at its vertex inside.
        let margin = value - Lanes::of(spreads[0] + rounding);
        let ends = (tilt - bend).less(margin);
        let vertex = (slope * slope).less(twice * curvature * margin);
        let inside = steepness.less(turn);
        let nothing = (value.abs() + tilt + bend.abs()).less(Lanes::of(rounding - spreads[0]));
        // Monotone or concave: the right end decides.
        let steep = turn.abs() + Lanes::of(spreads[1]);
        let rises = steep.less(slope);
        let one_way = steep.less(-slope) | Lanes::of(spreads[2]).less(-curvature);
        let right = Lanes::of(0.0).less(margin + slope * radius + bend);
        (ends & !inside) | (vertex & inside) | nothing | rises | (one_way & right)
    }

    /// Takes the jet on one of the cells; bounds over all cells are the largest.
    pub fn set_cell(&mut self, number: usize, jet: &Jet) {
        self.values[number] = jet.value;
        self.slopes[number] = jet.slope;
        self.curvatures[number] = jet.curvature;
        self.third = self.third.max(jet.third);
        self.rounding = self.rounding.max(jet.rounding);
        for (largest, rest) in self.rest.iter_mut().zip(jet.rest) {
            *largest = largest.max(rest);
        }
    }

    /// The jet on one of the cells.
    #[inline(always)]
    pub fn cell(&self, number: usize) -> Jet {
        Jet {
            value: self.values[number],
            slope: self.slopes[number],
            curvature: self.curvatures[number],
            third: self.third,
            rest: self.rest,
            rounding: self.rounding,
        }
    }
}

/// What value, slope and curvature of a guard may differ by from those of the parabola, on a cell
/// of half-width r. With the rounding of slope and curvature, but not of the value.
#[inline(always)]
fn spreads(third: f64, [value, slope, curvature]: [f64; 3], rounding: f64, r: f64) -> [f64; 3] {
    let of_slope = rounding / r;
    [
        third * (r * r * r / 6.0) + value,
        third * (0.5 * r * r) + slope + of_slope,
        third * r + curvature + of_slope / r,
    ]
}

/// What a jet proves of a guard that is positive at the left end of a cell that is not clear.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Verdict {
    /// Negative at the right end, and one zero.
    Crosses,
    /// At most one zero, and the sign at the right end tells.
    EndDecides,
    /// Convex: its least value decides; the curvature is at least this.
    Convex(f64),
    /// Nothing proved: the cell must be halved.
    Open,
}

impl Jet {
    /// Judges a cell of half-width r that is not clear.
    #[inline(always)]
    pub fn verdict(&self, r: f64) -> Verdict {
        let spreads = spreads(self.third, self.rest, self.rounding, r);
        let turn = self.curvature * r;
        if -self.slope > turn.abs() + spreads[1] || -self.curvature > spreads[2] {
            let end = self.value + self.slope * r + 0.5 * turn * r;
            if end + spreads[0] < -self.rounding {
                return Verdict::Crosses;
            }
            return Verdict::EndDecides;
        }
        if self.curvature > spreads[2] {
            return Verdict::Convex(self.curvature - spreads[2]);
        }
        Verdict::Open
    }

    /// Whether a guard that starts at zero, with a slope that is not negative there, is positive on
    /// the rest of a cell of half-width r, around whose middle this jet is.
    pub fn rises(&self, r: f64) -> bool {
        let spreads = spreads(self.third, self.rest, self.rounding, r);
        let turn = self.curvature * r;
        let end = self.value + self.slope * r + 0.5 * turn * r;
        self.slope > turn.abs() + spreads[1]
            || self.curvature > spreads[2]
            || -self.curvature > spreads[2] && end > spreads[0] + self.rounding
    }

    /// Where the parabola through the jet comes down to zero, from the middle of the cell; not a
    /// number where it does not.
    #[inline(always)]
    pub fn descent(&self) -> f64 {
        let discriminant = self.slope * self.slope - 2.0 * self.curvature * self.value;
        2.0 * self.value / (discriminant.sqrt() - self.slope)
    }

    /// Judges the first cell of a phase, of width h, for a guard that starts at zero; this jet
    /// stands at the left end, its slope, less its rounding, holding the fast part too.
    #[inline(always)]
    pub fn departs(&self, h: f64) -> bool {
        let Self {
            third,
            rest,
            rounding,
            ..
        } = *self;
        // g(t)/t >= slope + (curvature - rest) t/2 - third t^2/6, concave in t.
        let end = self.slope.max(0.0) + 0.5 * (self.curvature - rest[2]) * h - third * h * h / 6.0;
        let size = self.slope.abs() * h
            + 0.5 * (self.curvature.abs() + rest[2]) * h * h
            + third * h * h * h / 6.0;
        // The curvature is off by 4 rounding/h^2 at most.
        end > 2.0 * rounding / h || size <= rounding
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::{LANES, Plain};
    use proptest::prelude::*;
    use proptest::{array::uniform8, test_runner::TestCaseError};

    /// A function that a jet describes, by what it does between samples of its cell.
    struct Member {
        right: f64,
        negative: bool,
        changes: usize,
    }

    fn check(cell: &Jet, clear: bool, r: f64, member: &Member) -> Result<(), TestCaseError> {
        if clear {
            prop_assert!(!member.negative);
            return Ok(());
        }
        match cell.verdict(r) {
            Verdict::Crosses => prop_assert!(member.right < 0.0 && member.changes == 1),
            Verdict::EndDecides => {
                prop_assert!(member.changes <= 1);
                prop_assert!(member.negative == (member.right < 0.0) || member.right.abs() < 1e-3);
            }
            Verdict::Convex(curvature) => {
                prop_assert!(curvature > 0.0);
                prop_assert!(member.changes <= 2);
            }
            Verdict::Open => {}
        }
        Ok(())
    }

    proptest! {
        /// Any functions that the jets describe obey their verdicts.
        #[test]
        fn verdicts_hold_for_members_of_the_jets(
            values in uniform8(-1.0f64..1.0), slopes in uniform8(-3.0f64..3.0),
            curvatures in uniform8(-3.0f64..3.0), parts in uniform8(-1.0f64..1.0),
            phases in uniform8(0.0f64..6.3),
            third in 0.0f64..4.0, fast in 0.0f64..0.1, r in 0.05f64..1.0,
        ) {
            let w = 4.0;
            let (rest, rounding) = ([fast, fast * w, fast * w * w], 1e-15);
            let jets = Jets { values, slopes, curvatures, third, rest, rounding };
            let clear = jets.clear::<Plain>(r);
            for lane in 0..LANES {
                let Jet { value, slope, curvature, .. } = jets.cell(lane);
                let g = |x: f64| value + slope * x + 0.5 * curvature * x * x
                    + parts[lane] * third * x * x * x / 6.0 + fast * (w * x + phases[lane]).sin();
                if g(-r) <= 1e-9 {
                    continue;
                }
                let samples: Vec<f64> =
                    (0..=400).map(|i| g(-r + 2.0 * r * f64::from(i) / 400.0)).collect();
                let member = Member {
                    right: g(r),
                    negative: samples.iter().any(|s| *s < -1e-12),
                    changes: samples.windows(2).filter(|w| (w[0] > 0.0) != (w[1] > 0.0)).count(),
                };
                check(&jets.cell(lane), clear >> lane & 1 == 1, r, &member)?;
            }
        }

        #[test]
        fn what_departs_is_positive_on_the_first_cell(
            slope in 0.0f64..3.0, curvature in -3.0f64..3.0, third in 0.0f64..4.0,
            part in -1.0f64..1.0, fast in 0.0f64..0.1, h in 0.05f64..2.0,
        ) {
            let w = 4.0;
            let (rest, rounding) = ([fast, fast * w, fast * w * w], 1e-15);
            let jet = Jet { value: 0.0, slope, curvature, third, rest, rounding };
            // The fast part without value and slope at the start: these are in the jet's.
            let g = |x: f64| slope * x + 0.5 * curvature * x * x
                + part * third * x * x * x / 6.0 + fast * ((w * x).cos() - 1.0);
            if jet.departs(h) {
                for i in 1..=400 {
                    prop_assert!(g(h * f64::from(i) / 400.0) > 0.0);
                }
            }
        }
    }
}
