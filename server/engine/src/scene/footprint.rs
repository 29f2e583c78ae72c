//! Floor geometry: the column's footprint and keep-out shapes, as distances in the plane.
//!
//! The column cannot turn, so its footprint is a few rectangles along the room's axes that move with its centre.

use super::spec::{KeepOutShape, PropSpec};
use crate::frames::{Floor, Planar};

/// The column and its props seen from above, relative to the column's centre.
#[derive(Debug, Clone, PartialEq)]
pub struct Footprint {
    rectangles: Vec<Rectangle>,
    /// The prop that each rectangle is of; none: the column itself.
    props: Vec<Option<usize>>,
}

/// A rectangle along the room's axes, relative to the column's centre, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rectangle {
    /// Corner of least x and y.
    pub min: Planar,
    /// Corner of greatest x and y.
    pub max: Planar,
}

/// A keep-out shape, ready for distances from a moving footprint.
#[derive(Debug, Clone, PartialEq)]
pub enum KeepOut {
    /// A disc.
    Circle {
        /// Centre.
        centre: Floor,
        /// Radius, m.
        radius_m: f64,
    },
    /// For each rectangle of the footprint, the centres at which it touches the polygon: convex, counter-clockwise.
    Polygon(Vec<Vec<Floor>>),
}

impl Footprint {
    /// The column's rectangle and every prop that takes floor.
    pub fn new(column_size_m: Planar, props: &[PropSpec]) -> Self {
        let about =
            |centre: Planar, size: Planar| Rectangle { min: centre - size * 0.5, max: centre + size * 0.5 };
        let taking_floor = || props.iter().enumerate().filter(|(_, p)| p.size_m.norm() > 0.0);
        let rectangles = std::iter::once(about(Planar::ZERO, column_size_m))
            .chain(taking_floor().map(|(_, p)| about(p.offset, p.size_m)))
            .collect();
        let props = std::iter::once(None).chain(taking_floor().map(|(i, _)| Some(i))).collect();
        Self { rectangles, props }
    }

    /// The rectangles.
    pub fn rectangles(&self) -> &[Rectangle] {
        &self.rectangles
    }

    /// From `point` to the nearest point of the footprint with the column's centre at `centre`, m; 0 inside.
    pub fn distance_m(&self, centre: Floor, point: Floor) -> f64 {
        self.rectangles.iter().map(|r| r.gap(point - centre).norm()).fold(f64::INFINITY, f64::min)
    }

    /// The same, but for the rectangle of one prop; of the column itself nothing is left out.
    pub fn distance_but_m(&self, centre: Floor, point: Floor, prop: Option<usize>) -> f64 {
        let of_others =
            self.rectangles.iter().zip(&self.props).filter(|(_, of)| of.is_none() || **of != prop);
        of_others.map(|(r, _)| r.gap(point - centre).norm()).fold(f64::INFINITY, f64::min)
    }

    /// From the nearest point of the footprint away from `point` as a unit vector; none inside.
    pub fn away_from(&self, centre: Floor, point: Floor) -> Option<Planar> {
        let gaps = self.rectangles.iter().map(|r| r.gap(point - centre));
        gaps.min_by(|a, b| a.norm().total_cmp(&b.norm())).and_then(|gap| (-gap).unit())
    }
}

impl Rectangle {
    /// From the nearest point of the rectangle to `point`; zero inside.
    fn gap(&self, point: Planar) -> Planar {
        let outside = |v: f64, min: f64, max: f64| (v - max).max(0.0) + (v - min).min(0.0);
        Planar::new(outside(point.x, self.min.x, self.max.x), outside(point.y, self.min.y, self.max.y))
    }

    fn corners(&self) -> [Planar; 4] {
        let (a, b) = (self.min, self.max);
        [a, Planar::new(b.x, a.y), b, Planar::new(a.x, b.y)]
    }
}

impl KeepOut {
    /// Prepare a shape for a footprint.
    pub fn new(shape: &KeepOutShape, footprint: &Footprint) -> Self {
        match shape {
            KeepOutShape::Circle { centre, radius_m } => {
                Self::Circle { centre: *centre, radius_m: *radius_m }
            }
            KeepOutShape::Polygon { corners } => {
                let touching = |r: &Rectangle| {
                    let sums = corners.iter().flat_map(|c| r.corners().map(|offset| *c - offset)).collect();
                    convex_hull(sums)
                };
                Self::Polygon(footprint.rectangles.iter().map(touching).collect())
            }
        }
    }

    /// From the footprint with its centre at `centre` to the shape, m; 0 when they overlap.
    pub fn distance_m(&self, footprint: &Footprint, centre: Floor) -> f64 {
        match self {
            Self::Circle { centre: disc, radius_m } => {
                (footprint.distance_m(centre, *disc) - radius_m).max(0.0)
            }
            Self::Polygon(hulls) => {
                hulls.iter().map(|hull| gap_to_convex(hull, centre).norm()).fold(f64::INFINITY, f64::min)
            }
        }
    }

    /// The direction in which the column gains distance from the shape; none when they overlap.
    pub fn away(&self, footprint: &Footprint, centre: Floor) -> Option<Planar> {
        match self {
            Self::Circle { centre: disc, .. } => footprint.away_from(centre, *disc),
            Self::Polygon(hulls) => {
                let gaps = hulls.iter().map(|hull| gap_to_convex(hull, centre));
                gaps.min_by(|a, b| a.norm().total_cmp(&b.norm())).and_then(Planar::unit)
            }
        }
    }
}

/// The corners form a convex polygon with an area, either way round.
pub fn is_convex(corners: &[Floor]) -> bool {
    let n = corners.len();
    let turn = |i: usize| {
        let (a, b, c) = (corners[i], corners[(i + 1) % n], corners[(i + 2) % n]);
        (b - a).cross(c - b).atan2((b - a).dot(c - b))
    };
    let turns: Vec<f64> = (0..n).map(turn).collect();
    let one_way = turns.iter().all(|t| *t > 1e-9) || turns.iter().all(|t| *t < -1e-9);
    // One way all along, and once round: a star turns one way too, but twice round.
    one_way && (turns.iter().sum::<f64>().abs() - std::f64::consts::TAU).abs() < 1e-6
}

/// From the nearest point of a convex counter-clockwise polygon to `point`; zero inside.
pub(super) fn gap_to_convex(polygon: &[Floor], point: Floor) -> Planar {
    let mut inside = true;
    let mut nearest = Planar::new(f64::INFINITY, f64::INFINITY);
    for (i, a) in polygon.iter().enumerate() {
        let edge = polygon[(i + 1) % polygon.len()] - *a;
        let to_point = point - *a;
        inside &= edge.cross(to_point) >= 0.0;
        let along = (to_point.dot(edge) / edge.dot(edge)).clamp(0.0, 1.0);
        let gap = to_point - edge * along;
        if gap.dot(gap) < nearest.dot(nearest) || !nearest.x.is_finite() {
            nearest = gap;
        }
    }
    if inside { Planar::ZERO } else { nearest }
}

/// Andrew's monotone chain, counter-clockwise, corners on an edge left out.
pub(super) fn convex_hull(mut points: Vec<Floor>) -> Vec<Floor> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    let half = |points: &mut dyn Iterator<Item = Floor>| {
        let mut chain: Vec<Floor> = Vec::new();
        for p in points {
            while let [.., a, b] = chain[..] {
                if (b - a).cross(p - b) > 0.0 {
                    break;
                }
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut hull = half(&mut points.iter().copied());
    hull.extend(half(&mut points.iter().rev().copied()));
    hull
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn column() -> Footprint {
        let arm = PropSpec {
            id: "arm".into(),
            offset: Planar::new(0.3, 0.0),
            facing_rad: 0.0,
            size_m: Planar::new(0.2, 0.1),
        };
        Footprint::new(Planar::new(0.15, 0.15), &[arm])
    }

    #[test]
    fn distance_is_to_the_nearest_part_props_included() {
        let centre = Floor::new(1.0, 1.0);
        assert!((column().distance_m(centre, Floor::new(2.0, 1.0)) - 0.6).abs() < 1e-12);
        assert!((column().distance_m(centre, Floor::new(0.0, 1.0)) - 0.925).abs() < 1e-12);
        assert_eq!(column().distance_m(centre, Floor::new(1.35, 1.02)), 0.0);
    }

    #[test]
    fn a_star_is_not_convex() {
        let corner = |k: f64| Floor::new((k * 2.513).cos(), (k * 2.513).sin());
        let star: Vec<Floor> = (0..5).map(|k| corner(f64::from(k))).collect();
        assert!(!is_convex(&star));
        assert!(is_convex(&[Floor::new(0.0, 0.0), Floor::new(0.0, 1.0), Floor::new(1.0, 0.0)]));
    }

    proptest! {
        #[test]
        fn polygon_distance_agrees_with_sampling(x in -2.0..4.0, y in -2.0..4.0) {
            let corners = vec![Floor::new(0.0, 0.0), Floor::new(1.5, 0.2), Floor::new(0.9, 1.3)];
            let polygon = KeepOut::new(&KeepOutShape::Polygon { corners: corners.clone() }, &column());
            let centre = Floor::new(x, y);
            let mut sampled = f64::INFINITY;
            for i in 0..=60 {
                for j in 0..=(60 - i) {
                    let (a, b) = (f64::from(i) / 60.0, f64::from(j) / 60.0);
                    let p = corners[0] + (corners[1] - corners[0]) * a + (corners[2] - corners[0]) * b;
                    sampled = sampled.min(column().distance_m(centre, p));
                }
            }
            let exact = polygon.distance_m(&column(), centre);
            prop_assert!(exact <= sampled + 1e-9 && sampled < exact + 0.04, "{exact} against {sampled}");
        }
    }
}
