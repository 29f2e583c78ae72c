//! A place on the floor that somebody can be in.

use super::footprint::{convex_hull, gap_to_convex};
use super::spec::KeepOutShape;
use crate::frames::Floor;

/// A zone, ready for distances.
#[derive(Debug, Clone, PartialEq)]
pub enum Zone {
    /// A disc.
    Circle {
        /// Centre.
        centre: Floor,
        /// Radius, m.
        radius_m: f64,
    },
    /// A convex polygon, counter-clockwise.
    Polygon(Vec<Floor>),
}

impl Zone {
    /// Of a shape that is right.
    pub fn new(shape: &KeepOutShape) -> Self {
        match shape {
            KeepOutShape::Circle { centre, radius_m } => {
                Self::Circle { centre: *centre, radius_m: *radius_m }
            }
            KeepOutShape::Polygon { corners } => Self::Polygon(convex_hull(corners.clone())),
        }
    }

    /// From a place to the zone, m; 0 inside.
    pub fn distance_m(&self, place: Floor) -> f64 {
        match self {
            Self::Circle { centre, radius_m } => (place.distance_m(*centre) - radius_m).max(0.0),
            Self::Polygon(corners) => gap_to_convex(corners, place).norm(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_zero_inside_and_grow_outside() {
        let circle = Zone::new(&KeepOutShape::Circle { centre: Floor::new(1.0, 1.0), radius_m: 0.5 });
        assert_eq!(circle.distance_m(Floor::new(1.3, 1.0)), 0.0);
        assert!((circle.distance_m(Floor::new(2.0, 1.0)) - 0.5).abs() < 1e-12);
        let clockwise = [(0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0)].map(|(x, y)| Floor::new(x, y));
        let square = Zone::new(&KeepOutShape::Polygon { corners: clockwise.to_vec() });
        assert_eq!(square.distance_m(Floor::new(0.4, 0.9)), 0.0);
        assert!((square.distance_m(Floor::new(2.0, 2.0)) - 2.0_f64.sqrt()).abs() < 1e-12);
    }
}
