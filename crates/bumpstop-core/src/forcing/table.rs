//! A function of time given at knots, with straight lines between them.

use crate::error::{Error, Result, check_finite};

/// What a table is before its first knot and after its last.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Beyond {
    /// Zero.
    Zero,
    /// The value of the nearest knot.
    Hold,
}

/// Straight lines between knots; two knots at one time are a jump.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    times: Vec<f64>,
    values: Vec<f64>,
    beyond: Beyond,
}

impl Table {
    /// A table from its knots, in order of time.
    ///
    /// # Errors
    /// When there is no knot, the arrays differ in length, a number is not finite or the times
    /// go backwards.
    pub fn new(times: Vec<f64>, values: Vec<f64>, beyond: Beyond) -> Result<Self> {
        const WHAT: &str = "a load's table";
        check_finite(WHAT, &times)?;
        check_finite(WHAT, &values)?;
        if times.is_empty() || times.len() != values.len() {
            return Err(Error::Length {
                what: WHAT,
                found: values.len(),
                expected: times.len().max(1),
            });
        }
        if let Some(pair) = times.windows(2).find(|pair| pair[1] < pair[0]) {
            return Err(Error::Backwards { time: pair[1] });
        }
        Ok(Self {
            times,
            values,
            beyond,
        })
    }

    /// The same so many times as fast.
    pub(super) fn faster(&self, factor: f64) -> Self {
        Self {
            times: self.times.iter().map(|time| time / factor).collect(),
            ..self.clone()
        }
    }

    /// How many knots are not after a time.
    pub fn place(&self, time: f64) -> usize {
        self.times.partition_point(|knot| *knot <= time)
    }

    /// The same, looked for from an earlier place on.
    pub fn place_from(&self, place: usize, time: f64) -> usize {
        let holds =
            |place: usize| (place == 0 || self.times[place - 1] <= time) && time < self.knot(place);
        (place..(place + 2).min(self.times.len() + 1))
            .find(|place| holds(*place))
            .unwrap_or_else(|| self.place(time))
    }

    /// The knot after a place; infinity after the last.
    pub fn knot(&self, place: usize) -> f64 {
        self.times.get(place).copied().unwrap_or(f64::INFINITY)
    }

    /// The knot before a place; minus infinity before the first.
    pub fn knot_before(&self, place: usize) -> f64 {
        let knot = place.checked_sub(1).and_then(|last| self.times.get(last));
        knot.copied().unwrap_or(f64::NEG_INFINITY)
    }

    /// The first time at which it jumps.
    pub(super) fn jump(&self) -> Option<f64> {
        let last = self.times.len() - 1;
        let ends = [0, last].into_iter().filter(|end| self.values[*end] != 0.0);
        let ends = ends.filter(|_| self.beyond == Beyond::Zero);
        let inside = (0..last).filter(|knot| {
            self.times[*knot] == self.times[knot + 1] && self.values[*knot] != self.values[knot + 1]
        });
        inside.chain(ends).map(|knot| self.times[knot]).next()
    }

    /// Value and slope at a time, from its place.
    pub fn line(&self, place: usize, time: f64) -> [f64; 2] {
        let outside = |knot: usize| match self.beyond {
            Beyond::Zero => [0.0, 0.0],
            Beyond::Hold => [self.values[knot], 0.0],
        };
        if place == 0 {
            return outside(0);
        }
        if place == self.times.len() {
            return outside(place - 1);
        }
        let (from, to) = (self.times[place - 1], self.times[place]);
        let slope = (self.values[place] - self.values[place - 1]) / (to - from);
        [self.values[place - 1] + slope * (time - from), slope]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_found_from_anywhere() {
        let table = Table::new(vec![0.0, 1.0, 1.0, 2.5], vec![0.0; 4], Beyond::Zero).unwrap();
        for time in [-1.0, 0.0, 0.5, 1.0, 2.0, 2.5, 9.0] {
            for place in 0..=4 {
                assert_eq!(table.place_from(place, time), table.place(time));
            }
        }
        assert_eq!(table.knot(4), f64::INFINITY);
    }

    #[test]
    fn lines_jumps_and_ends_are_as_said() {
        let knots = || (vec![1.0, 2.0, 2.0, 3.0], vec![1.0, 3.0, 5.0, 4.0]);
        let (times, values) = knots();
        let hold = Table::new(times, values, Beyond::Hold).unwrap();
        let at = |table: &Table, time: f64| table.line(table.place(time), time);
        assert_eq!(at(&hold, 0.0), [1.0, 0.0]);
        assert_eq!(at(&hold, 1.5), [2.0, 2.0]);
        assert_eq!(at(&hold, 2.0), [5.0, -1.0]);
        assert_eq!(at(&hold, 3.0), [4.0, 0.0]);
        let (times, values) = knots();
        let zero = Table::new(times, values, Beyond::Zero).unwrap();
        assert_eq!(at(&zero, 0.5), [0.0, 0.0]);
        assert_eq!(at(&zero, 7.0), [0.0, 0.0]);
        assert!(Table::new(vec![1.0, 0.5], vec![0.0; 2], Beyond::Zero).is_err());
        assert!(Table::new(vec![], vec![], Beyond::Zero).is_err());
        assert!(Table::new(vec![0.0], vec![f64::NAN], Beyond::Zero).is_err());
    }
}
