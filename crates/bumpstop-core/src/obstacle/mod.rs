//! Shapes that a structure can hit: distance and normal in local coordinates.

mod circle;
mod plane;
mod polygon;
mod shape;

pub use circle::Circle;
pub use plane::Plane;
pub use polygon::Polygon;
pub use shape::Shape;
