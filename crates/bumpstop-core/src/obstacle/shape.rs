//! An obstacle of any shape in the plane of the first two local coordinates.

use super::{Circle, Plane, Polygon};
use crate::number::Number;

/// The shapes.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// A plane across the first coordinate.
    Plane(Plane),
    /// A circle, from inside or from outside.
    Circle(Circle),
    /// A closed polygon, from inside.
    Polygon(Polygon),
}

impl Shape {
    /// Distance of a point, and the direction in which the obstacle pushes there; of a polygon
    /// those of one side.
    #[inline(always)]
    pub fn at<T: Number>(&self, side: usize, point: [T; 2]) -> (T, [T; 2]) {
        match self {
            Self::Plane(plane) => (T::of(plane.gap) + point[0], [T::of(1.0), T::of(0.0)]),
            Self::Circle(circle) => circle.at(point),
            Self::Polygon(polygon) => polygon.at(side, point),
        }
    }

    /// The same, whichever side of a polygon it is.
    #[inline(always)]
    pub fn anywhere<T: Number>(&self, point: [T; 2]) -> (T, [T; 2]) {
        match self {
            Self::Polygon(polygon) => polygon.anywhere(point),
            _ => self.at(0, point),
        }
    }

    /// A smooth function with the sign and, at the obstacle, the slope of the distance.
    #[inline(always)]
    pub fn clearance<T: Number>(&self, side: usize, point: [T; 2]) -> T {
        match self {
            Self::Circle(circle) => circle.clearance(point),
            _ => self.at(side, point).0,
        }
    }

    /// The factor of the squared speed along the obstacle in the distance's second derivative.
    pub fn bend(&self, point: [f64; 2]) -> f64 {
        match self {
            Self::Circle(circle) => circle.bend(point),
            _ => 0.0,
        }
    }

    /// The side of a polygon whose sector a point is in; 0 for shapes of one side.
    pub fn side(&self, point: [f64; 2]) -> usize {
        self.polygon().map_or(0, |polygon| polygon.sector(point))
    }

    /// The polygon that it is, if it is one.
    #[inline(always)]
    pub fn polygon(&self) -> Option<&Polygon> {
        match self {
            Self::Polygon(polygon) => Some(polygon),
            _ => None,
        }
    }

    /// Its size, for judging what is rounding.
    pub fn size(&self) -> f64 {
        match self {
            Self::Plane(plane) => plane.gap.abs(),
            Self::Circle(circle) => circle.size(),
            Self::Polygon(polygon) => polygon.size(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::Dual;
    use proptest::prelude::*;

    fn polygon(turned: f64) -> Polygon {
        let corners: Vec<[f64; 2]> = (0..5)
            .map(|n| {
                let (sin, cos) = (turned + f64::from(n) * std::f64::consts::TAU / 5.0).sin_cos();
                let radius = 1.0 + 0.05 * f64::from(n);
                [radius * cos, radius * sin]
            })
            .collect();
        Polygon::new(&corners).unwrap()
    }

    proptest! {
        #[test]
        fn the_obstacle_pushes_along_the_slope_of_the_distance(
            radius in 0.2f64..2.0, angle in -3.0f64..3.0, turned in -3.0f64..3.0,
        ) {
            let point = [radius * angle.cos(), radius * angle.sin()];
            let plane = Shape::Plane(Plane { gap: 0.3 });
            let circles = [Circle::around(1.0), Circle::beside(1.0)];
            let circles = circles.map(|circle| Shape::Circle(circle.unwrap()));
            for shape in circles.into_iter().chain([plane, Shape::Polygon(polygon(turned))]) {
                let side = shape.side(point);
                let (distance, normal) = shape.at(side, point);
                for along in 0..2 {
                    let mut seen = point.map(Dual::of);
                    seen[along] = Dual::variable(point[along]);
                    let (found, _) = shape.at(side, seen);
                    prop_assert!((found.slope - normal[along]).abs() < 1e-14);
                }
                prop_assert!((normal[0].hypot(normal[1]) - 1.0).abs() < 1e-14);
                prop_assert_eq!(shape.anywhere(point), (distance, normal));
                let clearance = shape.clearance(side, point);
                prop_assert!(distance.abs() < 1e-12 || clearance * distance > 0.0);
            }
        }

        #[test]
        fn every_point_is_in_the_sector_between_its_rays(
            radius in 0.1f64..2.0, angle in -3.0f64..3.0, turned in -3.0f64..3.0,
        ) {
            let (polygon, point) = (polygon(turned), [radius * angle.cos(), radius * angle.sin()]);
            let side = polygon.sector(point);
            prop_assert!(polygon.rays(side, point).iter().all(|ray| *ray >= 0.0));
            prop_assert_eq!(polygon.neighbour(polygon.neighbour(side, true), false), side);
            // What is well within it touches no side.
            let (distance, _) = polygon.at(side, point);
            prop_assert!(polygon.within(1.0, point) <= 0.0 || distance > 0.0);
        }
    }

    #[test]
    fn what_is_no_polygon_around_the_origin_is_refused() {
        let twice: Vec<[f64; 2]> = (0..8)
            .map(|n| {
                (f64::from(n) * 1.5 * std::f64::consts::FRAC_PI_3)
                    .sin_cos()
                    .into()
            })
            .collect();
        let beside = [[1.0, 0.0], [2.0, 0.0], [1.5, 1.0]];
        for corners in [&twice[..], &beside, &beside[..2]] {
            assert!(Polygon::new(corners).is_err());
        }
        assert!(Circle::around(0.0).is_err());
    }
}
