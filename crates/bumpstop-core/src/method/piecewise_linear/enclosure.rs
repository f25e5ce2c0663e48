//! Jets as numbers: what a formula makes of quantities that are known by their jets.
//!
//! A curved guard (the distance from a circle, a friction cone in two directions) is a formula of
//! local coordinates. Written once, generic over [`Number`], it gives its own jet when it is fed
//! with those of the coordinates: derivatives by the chain rule, bounds by the same rule on the
//! bounds. These are Taylor models (K. Makino, M. Berz, Int. J. Pure Appl. Math. 4, 2003) of
//! second order whose remainder is kept apart for the slow and the fast part of a motion.

use super::jet::Jet;
use crate::number::Number;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A function of time on a cell: its jet at the middle, and the cell's half-width.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Enclosure {
    /// Value, derivatives and bounds.
    pub jet: Jet,
    /// Half-width of the cell, in s; zero for a constant, which holds on any.
    pub radius: f64,
}

/// Bounds over the cell of the slow part and its first three derivatives.
type Spans = [f64; 4];

impl Enclosure {
    /// A quantity known by its jet on a cell of half-width `radius`.
    pub fn new(jet: Jet, radius: f64) -> Self {
        Self { jet, radius }
    }

    fn spans(&self) -> Spans {
        let (jet, r) = (&self.jet, self.radius);
        let third = |order: i32, factorial: f64| match jet.third {
            // An unbounded derivative leaves nothing bounded, even on a cell of no width.
            f64::INFINITY => f64::INFINITY,
            third => third * r.powi(order) / factorial,
        };
        [
            jet.value.abs() + r * (jet.slope.abs() + 0.5 * r * jet.curvature.abs()) + third(3, 6.0),
            jet.slope.abs() + r * jet.curvature.abs() + third(2, 2.0),
            jet.curvature.abs() + third(1, 1.0),
            jet.third,
        ]
    }

    /// The least and the largest value on the cell.
    fn range(&self) -> (f64, f64) {
        let [size, ..] = self.spans();
        let spread = size - self.jet.value.abs() + self.jet.rest[0] + self.jet.rounding;
        (self.jet.value - spread, self.jet.value + spread)
    }

    /// Something of which only the value at the middle is known.
    fn unbounded(value: f64, radius: f64) -> Self {
        let jet = Jet {
            value,
            third: f64::INFINITY,
            rest: [f64::INFINITY; 3],
            rounding: f64::EPSILON * value.abs(),
            ..Jet::default()
        };
        Self { jet, radius }
    }

    /// A smooth function of this: its value and first two derivatives at the middle, and bounds
    /// of its first three derivatives over the range.
    ///
    /// With `f = s + h`, slow and fast, `phi(f) = phi(s) + [phi(s + h) - phi(s)]` is slow and fast
    /// again: Faa di Bruno's formula for the one, the mean value theorem for the other.
    fn compose(&self, at: [f64; 3], bounds: [f64; 3]) -> Self {
        let jet = &self.jet;
        let [_, s1, s2, s3] = self.spans();
        let [h0, h1, h2] = jet.rest;
        let [m1, m2, m3] = bounds;
        Self {
            jet: Jet {
                value: at[0],
                slope: at[1] * jet.slope,
                curvature: at[2] * jet.slope * jet.slope + at[1] * jet.curvature,
                third: m3 * s1 * s1 * s1 + 3.0 * m2 * s1 * s2 + m1 * s3,
                rest: [
                    m1 * h0,
                    m2 * h0 * s1 + m1 * h1,
                    m3 * h0 * s1 * s1 + m2 * (2.0 * s1 * h1 + h1 * h1) + m2 * h0 * s2 + m1 * h2,
                ],
                rounding: m1 * jet.rounding + ELEMENTARY * at[0].abs(),
            },
            radius: self.radius,
        }
    }

    fn recip(self) -> Self {
        let (low, high) = self.range();
        let value = 1.0 / self.jet.value;
        if low <= 0.0 && high >= 0.0 {
            return Self::unbounded(value, self.radius);
        }
        let most = 1.0 / low.abs().min(high.abs());
        let square = value * value;
        self.compose(
            [value, -square, 2.0 * square * value],
            [most.powi(2), 2.0 * most.powi(3), 6.0 * most.powi(4)],
        )
    }

    fn scaled(self, factor: f64) -> Self {
        let size = factor.abs();
        let jet = self.jet;
        Self {
            jet: Jet {
                value: factor * jet.value,
                slope: factor * jet.slope,
                curvature: factor * jet.curvature,
                third: size * jet.third,
                rest: jet.rest.map(|rest| size * rest),
                rounding: size * jet.rounding,
            },
            ..self
        }
    }
}

/// Relative rounding of an elementary function of a value, sine and cosine included.
const ELEMENTARY: f64 = 4.0 * f64::EPSILON;

impl Add for Enclosure {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (a, b) = (self.jet, other.jet);
        let value = a.value + b.value;
        Self {
            jet: Jet {
                value,
                slope: a.slope + b.slope,
                curvature: a.curvature + b.curvature,
                third: a.third + b.third,
                rest: std::array::from_fn(|n| a.rest[n] + b.rest[n]),
                rounding: a.rounding + b.rounding + f64::EPSILON * value.abs(),
            },
            radius: self.radius.max(other.radius),
        }
    }
}

impl Mul for Enclosure {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let radius = self.radius.max(other.radius);
        let (a, b) = (self.jet, other.jet);
        let [a0, a1, a2, a3] = self.spans();
        let [b0, b1, b2, b3] = other.spans();
        let ([f0, f1, f2], [g0, g1, g2]) = (a.rest, b.rest);
        let value = a.value * b.value;
        Self {
            jet: Jet {
                value,
                slope: a.slope * b.value + a.value * b.slope,
                curvature: a.curvature * b.value + 2.0 * a.slope * b.slope + a.value * b.curvature,
                third: zero_wins(a3, b0)
                    + 3.0 * (zero_wins(a2, b1) + zero_wins(a1, b2))
                    + zero_wins(a0, b3),
                // The sizes with the fast parts bound the whole of each factor.
                rest: [
                    zero_wins(a0, g0) + zero_wins(f0, b0 + g0),
                    zero_wins(a1, g0)
                        + zero_wins(a0, g1)
                        + zero_wins(f1, b0 + g0)
                        + zero_wins(f0, b1 + g1),
                    zero_wins(a2, g0)
                        + 2.0 * zero_wins(a1, g1)
                        + zero_wins(a0, g2)
                        + zero_wins(f2, b0 + g0)
                        + 2.0 * zero_wins(f1, b1 + g1)
                        + zero_wins(f0, b2 + g2),
                ],
                rounding: zero_wins(a0 + f0, b.rounding)
                    + zero_wins(b0 + g0, a.rounding)
                    + a.rounding * b.rounding
                    + f64::EPSILON * value.abs(),
            },
            radius,
        }
    }
}

/// A product of bounds: nothing times anything, even unbounded, is nothing.
fn zero_wins(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { a * b }
}

impl Neg for Enclosure {
    type Output = Self;
    fn neg(self) -> Self {
        self.scaled(-1.0)
    }
}

impl Sub for Enclosure {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Div for Enclosure {
    type Output = Self;
    #[allow(clippy::suspicious_arithmetic_impl)] // a quotient is a product with the reciprocal
    fn div(self, other: Self) -> Self {
        self * other.recip()
    }
}

impl AddAssign for Enclosure {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Enclosure {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Number for Enclosure {
    fn of(x: f64) -> Self {
        let jet = Jet {
            value: x,
            ..Jet::default()
        };
        Self { jet, radius: 0.0 }
    }

    fn mul_add(self, factor: Self, term: Self) -> Self {
        self * factor + term
    }

    fn sub_mul(self, a: Self, b: Self) -> Self {
        self - a * b
    }

    fn sqrt(self) -> Self {
        let (low, _) = self.range();
        let root = self.jet.value.sqrt();
        if low <= 0.0 {
            return Self::unbounded(root, self.radius);
        }
        let least = low.sqrt();
        self.compose(
            [root, 0.5 / root, -0.25 / (root * self.jet.value)],
            [
                0.5 / least,
                0.25 / (least * low),
                0.375 / (least * low * low),
            ],
        )
    }

    fn abs(self) -> Self {
        self.max(-self)
    }

    fn max(self, other: Self) -> Self {
        other.select_less(self, self, other)
    }

    fn exp(self) -> Self {
        let (_, high) = self.range();
        self.compose([self.jet.value.exp(); 3], [high.exp(); 3])
    }

    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.jet.value.sin_cos();
        let of = |at| {
            let mut part = self.compose(at, [1.0; 3]);
            part.jet.rounding = self.jet.rounding + ELEMENTARY;
            part
        };
        (of([sin, cos, -sin]), of([cos, -sin, -cos]))
    }

    fn power(self, exponent: f64) -> Self {
        let (low, high) = self.range();
        let value = self.jet.value.power(exponent);
        if low <= 0.0 {
            return Self::unbounded(value, self.radius);
        }
        let factors = [
            exponent,
            exponent * (exponent - 1.0),
            exponent * (exponent - 1.0) * (exponent - 2.0),
        ];
        // Powers of a positive number rise or fall all the way.
        let largest = |order: usize| {
            let power = exponent - (order + 1) as f64;
            factors[order].abs() * low.power(power).max(high.power(power))
        };
        self.compose(
            [
                value,
                factors[0] * self.jet.value.power(exponent - 1.0),
                factors[1] * self.jet.value.power(exponent - 2.0),
            ],
            std::array::from_fn(largest),
        )
    }

    /// Where the two cannot be told apart on the whole cell nothing is known but the value, and
    /// the walk takes a smaller one.
    fn select_less(self, other: Self, yes: Self, no: Self) -> Self {
        let difference = other - self;
        let (low, high) = difference.range();
        let radius = difference.radius.max(yes.radius).max(no.radius);
        if low > 0.0 {
            yes
        } else if high <= 0.0 {
            no
        } else if difference.jet.value > 0.0 {
            Self::unbounded(yes.jet.value, radius)
        } else {
            Self::unbounded(no.jet.value, radius)
        }
    }

    /// A gradient tells nothing of what lies beside it.
    fn function<const N: usize>(
        arguments: [Self; N],
        value: impl Fn([f64; N]) -> f64,
        _: impl Fn([f64; N]) -> [f64; N],
    ) -> Self {
        let radius = (arguments.iter()).fold(0.0, |radius: f64, each| radius.max(each.radius));
        Self::unbounded(value(arguments.map(|each| each.jet.value)), radius)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const FAST: f64 = 30.0;

    /// A cubic plus a fast sine, and the enclosure that a signal would give of it.
    #[derive(Debug, Clone, Copy)]
    struct Motion {
        cubic: [f64; 4],
        fast: f64,
        phase: f64,
    }

    impl Motion {
        fn at(&self, x: f64) -> f64 {
            let [a, b, c, d] = self.cubic;
            a + x * (b + x * (c / 2.0 + x * d / 6.0)) + self.fast * (FAST * x + self.phase).sin()
        }

        fn enclosure(&self, radius: f64) -> Enclosure {
            let [value, slope, curvature, third] = self.cubic;
            let jet = Jet {
                value,
                slope,
                curvature,
                third: third.abs(),
                rest: [self.fast, self.fast * FAST, self.fast * FAST * FAST],
                rounding: 0.0,
            };
            Enclosure::new(jet, radius)
        }
    }

    fn motion() -> impl Strategy<Value = Motion> {
        (
            [-2.0f64..2.0, -3.0..3.0, -5.0..5.0, -9.0..9.0],
            0.0f64..0.02,
            0.0f64..6.3,
        )
            .prop_map(|(cubic, fast, phase)| Motion { cubic, fast, phase })
    }

    /// Formulas that between them use every operation.
    fn formulas<T: Number>(x: T, y: T) -> Vec<T> {
        let distance = (x * x + y * y + T::of(0.5)).sqrt();
        let (sin, cos) = x.sin_cos();
        vec![
            x * y,
            T::of(1.0) - distance,
            x / distance,
            (x - y).exp() / (T::of(2.0) + y * y),
            sin * y.sub_mul(cos, x),
            x.abs() + y.max(T::of(-0.3)),
            -(x.mul_add(y, distance)),
            distance.power(1.5) * x,
        ]
    }

    proptest! {
        /// Value, slope and curvature of every formula stay where its enclosure says.
        #[test]
        fn formulas_stay_inside_their_enclosures(
            x in motion(), y in motion(), r in 0.001f64..0.3, part in -1.0f64..1.0,
        ) {
            let enclosed = formulas(x.enclosure(r), y.enclosure(r));
            // Differences of high order, in the middle of the cell's inner part.
            let at = 0.98 * part * r;
            let h = 1e-3 * r;
            let around: Vec<Vec<f64>> = (-2..=2)
                .map(|i| at + f64::from(i) * h)
                .map(|t| formulas(x.at(t), y.at(t)))
                .collect();
            for (k, e) in enclosed.iter().enumerate() {
                let g = |i: usize| around[i][k];
                let jet = &e.jet;
                let size = 1.0 + g(2).abs();
                let value = jet.value + at * (jet.slope + 0.5 * at * jet.curvature);
                let spread = jet.third * r.powi(3) / 6.0 + jet.rest[0];
                prop_assert!((g(2) - value).abs() <= spread + 1e-12 * size);
                let slope = (g(0) - 8.0 * g(1) + 8.0 * g(3) - g(4)) / (12.0 * h);
                let spread = 0.5 * jet.third * r * r + jet.rest[1];
                let noise = 1e-13 * size / h + 1e-7 * (1.0 + spread);
                prop_assert!((slope - jet.slope - at * jet.curvature).abs() <= spread + noise);
                let curvature =
                    (-g(0) + 16.0 * g(1) - 30.0 * g(2) + 16.0 * g(3) - g(4)) / (12.0 * h * h);
                let spread = jet.third * r + jet.rest[2];
                let noise = 1e-13 * size / (h * h) + 1e-4 * (1.0 + spread);
                prop_assert!((curvature - jet.curvature).abs() <= spread + noise);
            }
        }
    }

    #[test]
    fn a_choice_that_is_open_on_the_cell_proves_nothing() {
        let x = Motion {
            cubic: [0.1, 1.0, 0.0, 0.0],
            fast: 0.0,
            phase: 0.0,
        };
        assert_eq!(x.enclosure(0.05).abs(), x.enclosure(0.05));
        assert_eq!(x.enclosure(0.2).abs().jet.third, f64::INFINITY);
        assert_eq!(x.enclosure(0.2).abs().jet.value, 0.1);
    }
}
