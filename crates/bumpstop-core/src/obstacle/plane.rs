//! A plane.

use crate::law::Local;
use crate::number::Number;

/// A plane at `gap` below the structure's rest position; the first local coordinate runs along
/// its normal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// Distance at rest, in m; negative where the structure is pressed in at rest.
    pub gap: f64,
}

impl Plane {
    /// Distance of the structure from the plane, in m.
    #[inline(always)]
    pub fn distance<T: Number>(&self, position: &Local<T>) -> T {
        T::of(self.gap) + position[0]
    }

    /// Rate of the distance, in m/s.
    #[inline(always)]
    pub fn rate<T: Number>(&self, velocity: &Local<T>) -> T {
        velocity[0]
    }
}
