//! Shapes that a structure can hit: distance and normal in local coordinates.

mod plane;

pub use plane::Plane;
