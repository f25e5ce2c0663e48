//! What is known of a guard on a cell of time, and what follows from it.

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
    /// Bound of the rounding of a value.
    pub rounding: f64,
}

/// What a jet proves of a guard that is positive at the left end of the cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Verdict {
    /// Positive on the whole cell, or never away from zero by more than rounding.
    Clear,
    /// At most one zero, and the sign at the right end tells.
    EndDecides,
    /// Convex: its least value decides; the curvature is at least this.
    Convex(f64),
    /// Nothing proved: the cell must be halved.
    Open,
}

impl Jet {
    /// Judges a cell of half-width r.
    #[inline(always)]
    pub fn verdict(&self, r: f64) -> Verdict {
        let spread = self.third * r * r * r / 6.0 + self.rest[0];
        let bend = 0.5 * self.curvature * r * r;
        let tilt = (self.slope * r).abs();
        let inner = self.curvature > 0.0 && tilt < 2.0 * bend;
        let least = if inner {
            self.value - 0.5 * self.slope * self.slope / self.curvature
        } else {
            self.value - tilt + bend
        };
        if least - spread > self.rounding {
            return Verdict::Clear;
        }
        if self.value.abs() + tilt + bend.abs() + spread <= self.rounding {
            return Verdict::Clear;
        }
        let slope_spread = self.curvature.abs() * r + 0.5 * self.third * r * r + self.rest[1];
        if self.slope > slope_spread {
            return Verdict::Clear;
        }
        if -self.slope > slope_spread {
            return Verdict::EndDecides;
        }
        let curvature_spread = self.third * r + self.rest[2];
        if -self.curvature > curvature_spread {
            return Verdict::EndDecides;
        }
        if self.curvature > curvature_spread {
            return Verdict::Convex(self.curvature - curvature_spread);
        }
        Verdict::Open
    }

    /// Where the parabola through the jet comes down to zero, from the middle of the cell; not a
    /// number where it does not.
    #[inline(always)]
    pub fn descent(&self) -> f64 {
        let discriminant = self.slope * self.slope - 2.0 * self.curvature * self.value;
        2.0 * self.value / (discriminant.sqrt() - self.slope)
    }

    /// Judges the first cell of a phase, of width h, for a guard that starts at zero; this jet
    /// stands at the left end, its slope holding the fast part too.
    #[inline(always)]
    pub fn departs(&self, h: f64) -> bool {
        // g(t)/t >= slope + (curvature - rest) t/2 - third t^2/6, concave in t.
        let end = self.slope.max(0.0) + 0.5 * (self.curvature - self.rest[2]) * h
            - self.third * h * h / 6.0;
        let size = self.slope.abs() * h
            + 0.5 * (self.curvature.abs() + self.rest[2]) * h * h
            + self.third * h * h * h / 6.0;
        end > 0.0 || size <= self.rounding
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Any function that a jet describes obeys the jet's verdict.
        #[test]
        fn verdicts_hold_for_members_of_the_jet(
            value in -1.0f64..1.0, slope in -3.0f64..3.0, curvature in -3.0f64..3.0,
            third in 0.0f64..4.0, part in -1.0f64..1.0, fast in 0.0f64..0.1,
            phase in 0.0f64..6.3, r in 0.05f64..1.0,
        ) {
            let w = 4.0;
            let jet = Jet {
                value, slope, curvature, third,
                rest: [fast, fast * w, fast * w * w],
                rounding: 1e-15,
            };
            let g = |x: f64| value + slope * x + 0.5 * curvature * x * x
                + part * third * x * x * x / 6.0 + fast * (w * x + phase).sin();
            prop_assume!(g(-r) > 1e-9);
            let samples: Vec<f64> = (0..=400).map(|i| g(-r + 2.0 * r * f64::from(i) / 400.0)).collect();
            let negative = samples.iter().any(|s| *s < -1e-12);
            let changes = samples.windows(2).filter(|w| (w[0] > 0.0) != (w[1] > 0.0)).count();
            match jet.verdict(r) {
                Verdict::Clear => prop_assert!(!negative),
                Verdict::EndDecides => {
                    prop_assert!(changes <= 1);
                    prop_assert!(negative == (g(r) < 0.0) || g(r).abs() < 1e-3);
                }
                Verdict::Convex(curvature) => {
                    prop_assert!(curvature > 0.0);
                    prop_assert!(changes <= 2);
                }
                Verdict::Open => {}
            }
        }
    }
}
