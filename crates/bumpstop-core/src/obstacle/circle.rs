//! A circle, hit from inside (a tube in its hole) or from outside (a tube beside another one).

use crate::error::{Error, Result, check_finite};
use crate::number::Number;

/// A circle about the origin of the plane of the first two local coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circle {
    radius: f64,
    /// 1 where the structure is inside, -1 where it is outside.
    side: f64,
}

impl Circle {
    /// A hole that the structure is in.
    ///
    /// # Errors
    /// When the radius is not positive.
    pub fn around(radius: f64) -> Result<Self> {
        Self::new(radius, 1.0)
    }

    /// A body that the structure is beside.
    ///
    /// # Errors
    /// When the radius is not positive.
    pub fn beside(radius: f64) -> Result<Self> {
        Self::new(radius, -1.0)
    }

    fn new(radius: f64, side: f64) -> Result<Self> {
        let what = "the circle's radius";
        check_finite(what, &[radius])?;
        if radius <= 0.0 {
            return Err(Error::NotPositive {
                what,
                value: radius,
            });
        }
        Ok(Self { radius, side })
    }

    /// Distance of a point, and the direction in which the circle pushes there.
    #[inline(always)]
    pub fn at<T: Number>(&self, [y, z]: [T; 2]) -> (T, [T; 2]) {
        let r = (y * y + z * z).sqrt();
        // No direction is told from another one at the centre.
        let inwards = T::of(-self.side) / r.max(T::of(f64::MIN_POSITIVE));
        let distance = T::of(self.side) * (T::of(self.radius) - r);
        (distance, [inwards * y, inwards * z])
    }

    /// A smooth function with the sign and, at the circle, the slope of the distance.
    #[inline(always)]
    pub fn clearance<T: Number>(&self, [y, z]: [T; 2]) -> T {
        let square = T::of(self.radius * self.radius) - y * y - z * z;
        T::of(0.5 * self.side / self.radius) * square
    }

    /// How the distance of a point bends as that moves along the circle: the factor of its
    /// squared speed in the distance's second derivative.
    pub fn bend(&self, [y, z]: [f64; 2]) -> f64 {
        -self.side / y.hypot(z).max(f64::MIN_POSITIVE)
    }

    /// Its size, for judging what is rounding.
    pub fn size(&self) -> f64 {
        self.radius
    }
}
