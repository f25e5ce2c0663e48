//! A continuous function of straight segments: what multilinear springs and dampers follow.

use crate::error::{Error, Result, check_finite, check_length};
use crate::number::Number;

/// One straight piece of the function.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Segment {
    /// Its point nearest to zero: no constant cancels where the function is small there.
    origin: f64,
    /// Value and integral there.
    value: f64,
    integral: f64,
    /// Its slope.
    pub slope: f64,
}

/// A function that changes its slope at breaks.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Polyline {
    breaks: Vec<f64>,
    segments: Vec<Segment>,
}

/// What the numbers of a polyline are called in messages.
pub(super) struct Names {
    pub breaks: &'static str,
    pub slopes: &'static str,
    pub distance: &'static str,
}

/// The most segments: states are told apart by a byte.
const MOST_SEGMENTS: usize = 255;

impl Polyline {
    /// The function with `slopes[i]` between `breaks[i-1]` and `breaks[i]`, and `home` at zero.
    ///
    /// # Errors
    /// When a number is not finite, the breaks do not increase, or there is not one slope more than
    /// breaks.
    pub fn new(breaks: Vec<f64>, slopes: &[f64], home: f64, names: &Names) -> Result<Self> {
        check_finite(names.breaks, &breaks)?;
        check_finite(names.slopes, slopes)?;
        check_length(names.slopes, slopes, breaks.len() + 1)?;
        if let Some(pair) = breaks.windows(2).find(|pair| pair[1] <= pair[0]) {
            return Err(Error::NotPositive {
                what: names.distance,
                value: pair[1] - pair[0],
            });
        }
        if slopes.len() > MOST_SEGMENTS {
            return Err(Error::Length {
                what: names.slopes,
                found: slopes.len(),
                expected: MOST_SEGMENTS,
            });
        }
        let segments = segments(&breaks, slopes, home);
        Ok(Self { breaks, segments })
    }

    /// The points between segments.
    pub fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    /// A segment by its number.
    pub fn segment(&self, number: u8) -> &Segment {
        &self.segments[number as usize]
    }

    /// The number of the segment that holds a point; at a break the one above.
    #[inline(always)]
    pub fn number_at(&self, point: f64) -> u8 {
        self.breaks.iter().filter(|b| **b <= point).count() as u8
    }

    /// The same where a point that lies on a break to rounding is told with its derivatives, each
    /// with the size below which it counts as zero: the first that does not vanish decides.
    pub fn number_around(&self, series: &[(f64, f64)]) -> u8 {
        let (point, zero) = series[0];
        let Some(at) = (self.breaks.iter()).position(|b| (point - b).abs() <= zero) else {
            return self.number_at(point);
        };
        let leaves = (series[1..].iter()).find(|(rate, zero)| rate.abs() > *zero);
        let above = leaves.is_none_or(|(rate, _)| *rate > 0.0);
        (at + usize::from(above)) as u8
    }

    /// The steepest slope, at least zero.
    pub fn steepest(&self) -> f64 {
        (self.segments.iter()).fold(0.0, |m, s| s.slope.max(m))
    }
}

/// The segments of a function that is `home` at the origin, from there outward, and their integrals.
fn segments(breaks: &[f64], slopes: &[f64], home: f64) -> Vec<Segment> {
    let at_home = breaks.iter().filter(|b| **b <= 0.0).count();
    let mut segments: Vec<Segment> = (slopes.iter())
        .map(|slope| Segment {
            origin: 0.0,
            value: home,
            integral: 0.0,
            slope: *slope,
        })
        .collect();
    for i in at_home + 1..segments.len() {
        segments[i] = segments[i - 1].bent(breaks[i - 1], slopes[i]);
    }
    for i in (0..at_home).rev() {
        segments[i] = segments[i + 1].bent(breaks[i], slopes[i]);
    }
    segments
}

impl Segment {
    /// The segment that goes on from a point of this one at another slope.
    fn bent(&self, origin: f64, slope: f64) -> Self {
        Self {
            origin,
            value: self.value_at(origin),
            integral: self.integral_at(origin),
            slope,
        }
    }

    /// The function, along the line of this segment.
    #[inline(always)]
    pub fn value_at<T: Number>(&self, point: T) -> T {
        let beyond = point - T::of(self.origin);
        T::of(self.value) + T::of(self.slope) * beyond
    }

    /// Its integral from zero.
    #[inline(always)]
    pub fn integral_at<T: Number>(&self, point: T) -> T {
        let beyond = point - T::of(self.origin);
        T::of(self.integral) + beyond * (T::of(self.value) + T::of(0.5 * self.slope) * beyond)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAMES: Names = Names {
        breaks: "breaks",
        slopes: "slopes",
        distance: "distance",
    };

    #[test]
    fn small_values_beside_large_breaks_lose_no_digits() {
        let line = Polyline::new(vec![-0.3, 0.7], &[4e3, 1e3, 9e3], 0.0, &NAMES).unwrap();
        for point in [1e-300, -3e-17, 2e-9] {
            let segment = line.segment(line.number_at(point));
            assert_eq!(segment.value_at(point), 1e3 * point);
            assert_eq!(segment.integral_at(point), point * (500.0 * point));
        }
    }

    #[test]
    fn values_and_integrals_are_those_of_straight_pieces() {
        let line = Polyline::new(vec![-2.0, -1.0, 3.0], &[5.0, 1.0, 2.0, 8.0], 7.0, &NAMES);
        let line = line.unwrap();
        for (point, value, integral) in [
            (-3.0, -1.0, -12.0),
            (-1.5, 4.5, -8.375),
            (-1.0, 5.0, -6.0),
            (2.0, 11.0, 18.0),
            (4.0, 21.0, 47.0),
        ] {
            let segment = line.segment(line.number_at(point));
            assert_eq!(segment.value_at(point), value);
            assert_eq!(segment.integral_at(point), integral);
        }
    }
}
