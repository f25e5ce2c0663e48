//! How long loads go on without a knot of a table.

/// Stretches of one class are at most this much longer than those of the next.
const RATIO: f64 = 4.0;

/// The classes; shorter stretches are in the last one.
const CLASSES: u8 = 15;

/// Longest stretch of the second class times the ratio, relative to the run. No power of two, so
/// that tables with as many knots are not on the border of two classes.
const LONGEST: f64 = 1.4;

/// A class of stretches of about the same length. Loads are followed in the same way in all of
/// one class, so that uneven tables need a few responses of a spectrum, and even ones a single one.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Stretch(u8);

impl Stretch {
    /// That of a length in a run.
    pub(crate) fn of(length: f64, duration: f64) -> Self {
        let mut class = Self::default();
        while class.0 + 1 < CLASSES && length <= Self(class.0 + 1).longest(duration) {
            class.0 += 1;
        }
        class
    }

    /// What no stretch of the class exceeds within the run.
    pub(crate) fn longest(self, duration: f64) -> f64 {
        match self.0 {
            0 => duration,
            class => LONGEST * duration * RATIO.powi(-i32::from(class)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_are_as_long_as_their_class_says() {
        let duration = 3.0;
        for n in 0..200 {
            let length = 5.0 * 0.9f64.powi(n);
            let class = Stretch::of(length, duration);
            assert!(length.min(duration) <= class.longest(duration), "{n}");
            if class.0 + 1 < CLASSES {
                assert!(length > class.longest(duration) / (LONGEST * RATIO), "{n}");
            }
        }
        assert_eq!(Stretch::of(f64::INFINITY, duration), Stretch::default());
        assert_eq!(Stretch::default().longest(duration), duration);
    }
}
