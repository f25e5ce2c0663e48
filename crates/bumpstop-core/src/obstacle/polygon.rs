//! A closed polygon around the structure: a profile r(theta) given by points.
//!
//! Each side belongs to the sector between the rays through its ends. The distance of a point is
//! that from the line of its sector's side, so that it is zero at the same places on both sides of
//! a ray, but not as large beyond it where the sides do not lean alike against the ray.
//!
//! Source: the obstacle "discret" of code_aster's manual U4.44.21, which goes by the sector too.

use crate::error::{Error, Result, check_finite};
use crate::number::Number;

/// A polygon about the origin of the plane of the first two local coordinates, which every ray from
/// there meets once.
#[derive(Debug, Clone, PartialEq)]
pub struct Polygon {
    sides: Vec<Side>,
    size: f64,
    /// Radius of the circle about the origin that touches the nearest side's line.
    inner: f64,
}

/// One side, seen from the origin.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Side {
    /// Where it begins; it ends where the next one begins.
    corner: [f64; 2],
    /// Unit vector across its line, away from the origin, and the line's distance from there.
    outwards: [f64; 2],
    reach: f64,
}

impl Polygon {
    /// A polygon of corners in the order of their angles.
    ///
    /// # Errors
    /// When it has fewer than three corners, more than can be counted, or does not run around the
    /// origin once.
    pub fn new(corners: &[[f64; 2]]) -> Result<Self> {
        let what = "the polygon's corners";
        check_finite(what, corners.as_flattened())?;
        let count = corners.len();
        if count < 3 || count > usize::from(u16::MAX) {
            return Err(Error::Length {
                what,
                found: count,
                expected: count.clamp(3, usize::from(u16::MAX)),
            });
        }
        let mut turned = 0.0;
        let mut sides = Vec::with_capacity(count);
        for (n, [a, b]) in corners.iter().enumerate() {
            let [c, d] = corners[(n + 1) % count];
            let (cross, dot) = (a * d - b * c, a * c + b * d);
            if cross <= 0.0 {
                return Err(Error::NotPositive {
                    what: "the angle from one corner of the polygon to the next",
                    value: cross.atan2(dot),
                });
            }
            turned += cross.atan2(dot);
            let length = (c - a).hypot(d - b);
            sides.push(Side {
                corner: [*a, *b],
                outwards: [(d - b) / length, (a - c) / length],
                reach: cross / length,
            });
        }
        // Every corner is ahead of the one before: the whole is one round, or more.
        let rounds = (turned / std::f64::consts::TAU).round();
        Error::check_parameter("rounds of a polygon about its origin", rounds, [1.0, 1.0])?;
        let size = corners
            .iter()
            .fold(0.0, |size, [y, z]| y.hypot(*z).max(size));
        let inner = sides.iter().fold(size, |inner, side| side.reach.min(inner));
        Ok(Self { sides, size, inner })
    }

    /// Distance of a point from the line of a side, and the direction in which that pushes.
    #[inline(always)]
    pub fn at<T: Number>(&self, side: usize, [y, z]: [T; 2]) -> (T, [T; 2]) {
        let Side {
            outwards: [a, b],
            reach,
            ..
        } = self.sides[side];
        let distance = T::of(reach) - T::of(a) * y - T::of(b) * z;
        (distance, [T::of(-a), T::of(-b)])
    }

    /// Positive up to the ray where the sector of a side begins, and to that where it ends.
    #[inline(always)]
    pub fn rays<T: Number>(&self, side: usize, [y, z]: [T; 2]) -> [T; 2] {
        let across = |number: usize| {
            let [a, b] = self.sides[number % self.sides.len()].corner;
            let length = a.hypot(b);
            T::of(a / length) * z - T::of(b / length) * y
        };
        [across(side), -across(side + 1)]
    }

    /// Distance of a point, and the direction in which its sector's side pushes, from all sides.
    pub fn anywhere<T: Number>(&self, point: [T; 2]) -> (T, [T; 2]) {
        let zero = T::of(0.0);
        let mut found = self.at(0, point);
        for side in 1..self.sides.len() {
            let [begins, ends] = self.rays(side, point);
            let (distance, [a, b]) = self.at(side, point);
            let within = |here: T, else_: T| {
                let before = ends.select_less(zero, else_, here);
                begins.select_less(zero, else_, before)
            };
            let (known, [c, d]) = found;
            found = (within(distance, known), [within(a, c), within(b, d)]);
        }
        found
    }

    /// Positive within a part of the circle that touches the nearest side.
    #[inline(always)]
    pub fn within<T: Number>(&self, part: f64, [y, z]: [T; 2]) -> T {
        let radius = part * self.inner;
        T::of(0.5 / radius) * (T::of(radius * radius) - y * y - z * z)
    }

    /// The side whose sector a point is in.
    pub fn sector(&self, point: [f64; 2]) -> usize {
        let within = |side: &usize| self.rays(*side, point).iter().all(|ray| *ray >= 0.0);
        // At the origin, in none of them, every side is as good.
        (0..self.sides.len()).find(within).unwrap_or(0)
    }

    /// The neighbour of a side, back or ahead.
    pub fn neighbour(&self, side: usize, ahead: bool) -> usize {
        let count = self.sides.len();
        (side + if ahead { 1 } else { count - 1 }) % count
    }

    /// Its size, for judging what is rounding.
    pub fn size(&self) -> f64 {
        self.size
    }
}
