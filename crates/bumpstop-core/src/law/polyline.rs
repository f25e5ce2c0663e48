//! A continuous function of straight segments: what multilinear springs and dampers follow.

use crate::error::{Error, Result, check_finite, check_length};
use crate::number::Number;

/// One straight piece of the function.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Segment {
    /// Where it begins, or for the first one where it ends.
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

/// The segments of a function that is `home` at the origin, and their integrals from there.
fn segments(breaks: &[f64], slopes: &[f64], home: f64) -> Vec<Segment> {
    let mut segments: Vec<Segment> = (slopes.iter().enumerate())
        .map(|(i, slope)| Segment {
            origin: breaks.get(i.saturating_sub(1)).copied().unwrap_or(0.0),
            value: 0.0,
            integral: 0.0,
            slope: *slope,
        })
        .collect();
    for i in 1..segments.len() {
        let (before, here) = (segments[i - 1], segments[i].origin);
        segments[i].value = before.value_at(here);
        segments[i].integral = before.integral_at(here);
    }
    let at_home = breaks.iter().filter(|b| **b <= 0.0).count();
    let shift = segments[at_home].value_at(0.0) - home;
    // Another value at the origin adds its own integral.
    for segment in &mut segments {
        segment.value -= shift;
        segment.integral -= shift * segment.origin;
    }
    let integral = segments[at_home].integral_at(0.0);
    for segment in &mut segments {
        segment.integral -= integral;
    }
    segments
}

impl Segment {
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
