//! Distances on the floor for the checker: from a footprint to a head axis or a keep-out shape. Written for the
//! checker alone, so that no mistake of the engine's geometry is repeated here.

use covr_engine::frames::{Floor, Planar};
use covr_engine::scene::KeepOutShape;

/// A rectangle of the footprint, about a point that is fixed to the column's centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rectangle {
    /// From the column's centre to the middle of the rectangle, m.
    pub offset: Planar,
    /// Full size along x and y, m.
    pub size_m: Planar,
}

/// How far apart a footprint and a subject are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Gap {
    /// 0 when they overlap, m.
    pub(super) distance_m: f64,
    /// From the subject's nearest point to the footprint's.
    pub(super) away: Planar,
}

/// From a point to the nearest point of the footprint with the column's centre at `centre`.
pub(super) fn to_point(footprint: &[Rectangle], centre: Floor, point: Floor) -> Gap {
    nearest(footprint, |rectangle| {
        let middle = centre + rectangle.offset;
        let half = rectangle.size_m * 0.5;
        let closest = Floor::new(
            point.x.clamp(middle.x - half.x, middle.x + half.x),
            point.y.clamp(middle.y - half.y, middle.y + half.y),
        );
        let away = closest - point;
        Gap { distance_m: away.norm(), away }
    })
}

/// From a keep-out shape to the nearest point of the footprint with the column's centre at `centre`.
pub(super) fn to_shape(footprint: &[Rectangle], centre: Floor, shape: &KeepOutShape) -> Gap {
    match shape {
        KeepOutShape::Circle { centre: middle, radius_m } => {
            let gap = to_point(footprint, centre, *middle);
            let distance_m = (gap.distance_m - radius_m).max(0.0);
            let away = gap.away.unit().map_or(Planar::ZERO, |unit| unit * distance_m);
            Gap { distance_m, away }
        }
        KeepOutShape::Polygon { corners } => nearest(footprint, |rectangle| {
            let middle = centre + rectangle.offset;
            let half = rectangle.size_m * 0.5;
            let box_corners = [
                middle + Planar::new(-half.x, -half.y),
                middle + Planar::new(half.x, -half.y),
                middle + Planar::new(half.x, half.y),
                middle + Planar::new(-half.x, half.y),
            ];
            between_polygons(corners, &box_corners)
        }),
    }
}

fn nearest(footprint: &[Rectangle], gap_of: impl Fn(&Rectangle) -> Gap) -> Gap {
    footprint
        .iter()
        .map(gap_of)
        .min_by(|a, b| a.distance_m.total_cmp(&b.distance_m))
        .unwrap_or(Gap { distance_m: f64::INFINITY, away: Planar::ZERO })
}

/// From convex polygon `a` to convex polygon `b`.
fn between_polygons(a: &[Floor], b: &[Floor]) -> Gap {
    let apart = has_separating_edge(a, b) || has_separating_edge(b, a);
    if !apart {
        return Gap { distance_m: 0.0, away: Planar::ZERO };
    }
    // Apart, the shortest way leaves from a corner of one of them.
    let from_b = b.iter().map(|&corner| corner - nearest_on_edges(a, corner));
    let from_a = a.iter().map(|&corner| nearest_on_edges(b, corner) - corner);
    let away = from_b.chain(from_a).min_by(|p, q| p.norm().total_cmp(&q.norm())).unwrap_or(Planar::ZERO);
    Gap { distance_m: away.norm(), away }
}

/// Whether the line along some edge of `a` has all of `b` on the side where `a` is not.
fn has_separating_edge(a: &[Floor], b: &[Floor]) -> bool {
    edges(a).any(|(from, to)| {
        let along = to - from;
        let side = |point: Floor| along.cross(point - from);
        let own = a.iter().map(|&corner| side(corner)).fold(0.0, |sum: f64, s| sum + s).signum();
        b.iter().all(|&corner| side(corner) * own < 0.0)
    })
}

fn nearest_on_edges(polygon: &[Floor], point: Floor) -> Floor {
    edges(polygon)
        .map(|(from, to)| {
            let along = to - from;
            let length_squared = along.dot(along);
            let share = if length_squared > 0.0 {
                ((point - from).dot(along) / length_squared).clamp(0.0, 1.0)
            } else {
                0.0
            };
            from + along * share
        })
        .min_by(|p, q| (*p - point).norm().total_cmp(&(*q - point).norm()))
        .unwrap_or(point)
}

fn edges(polygon: &[Floor]) -> impl Iterator<Item = (Floor, Floor)> + '_ {
    polygon.iter().copied().zip(polygon.iter().copied().cycle().skip(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    const CARRIAGE: Rectangle = Rectangle { offset: Planar::ZERO, size_m: Planar { x: 0.2, y: 0.2 } };

    #[test]
    fn a_head_is_measured_to_the_nearest_side_corner_or_prop() {
        let arm = Rectangle { offset: Planar::new(0.5, 0.0), size_m: Planar::new(0.2, 0.1) };
        let at = |footprint: &[Rectangle], x, y| to_point(footprint, Floor::new(1.0, 1.0), Floor::new(x, y));
        assert!((at(&[CARRIAGE], 1.5, 1.0).distance_m - 0.4).abs() < 1e-12);
        assert!((at(&[CARRIAGE], 1.4, 1.5).distance_m - 0.5).abs() < 1e-12);
        assert_eq!(at(&[CARRIAGE], 1.05, 0.95).distance_m, 0.0);
        // The arm ends at x = 1.6: 0.2 m from the head, and away points from the head to the arm.
        let gap = at(&[CARRIAGE, arm], 1.8, 1.0);
        assert!((gap.distance_m - 0.2).abs() < 1e-12 && gap.away.x < 0.0 && gap.away.y == 0.0);
        assert_eq!(at(&[], 1.8, 1.0).distance_m, f64::INFINITY);
    }

    #[test]
    fn a_disc_is_measured_from_its_rim() {
        let disc = KeepOutShape::Circle { centre: Floor::new(0.0, 0.0), radius_m: 0.5 };
        let gap = to_shape(&[CARRIAGE], Floor::new(1.0, 0.0), &disc);
        assert!((gap.distance_m - 0.4).abs() < 1e-12 && (gap.away - Planar::new(0.4, 0.0)).norm() < 1e-12);
        assert_eq!(to_shape(&[CARRIAGE], Floor::new(0.55, 0.0), &disc).distance_m, 0.0);
    }

    #[test]
    fn a_polygon_either_way_round_is_measured_from_edges_and_corners() {
        let mut corners =
            vec![Floor::new(0.0, 0.0), Floor::new(1.0, 0.0), Floor::new(1.0, 1.0), Floor::new(0.0, 1.0)];
        for _ in 0..2 {
            let shape = KeepOutShape::Polygon { corners: corners.clone() };
            let at = |x, y| to_shape(&[CARRIAGE], Floor::new(x, y), &shape);
            assert!((at(1.5, 0.5).distance_m - 0.4).abs() < 1e-12, "edge to edge");
            assert!((at(1.4, 1.5).distance_m - 0.5).abs() < 1e-12, "corner to corner");
            assert!((at(1.4, 1.5).away - Planar::new(0.3, 0.4)).norm() < 1e-12);
            assert_eq!(at(0.5, 0.5).distance_m, 0.0, "inside");
            assert_eq!(at(1.05, 0.5).distance_m, 0.0, "across an edge");
            corners.reverse();
        }
        // A diamond whose corner points at the carriage: corner to edge.
        let diamond = KeepOutShape::Polygon {
            corners: vec![
                Floor::new(0.0, -0.5),
                Floor::new(0.5, 0.0),
                Floor::new(0.0, 0.5),
                Floor::new(-0.5, 0.0),
            ],
        };
        assert!((to_shape(&[CARRIAGE], Floor::new(0.9, 0.05), &diamond).distance_m - 0.3).abs() < 1e-12);
        // Overlapping crosswise without any corner inside the other.
        let bar = KeepOutShape::Polygon {
            corners: vec![
                Floor::new(-1.0, -0.01),
                Floor::new(1.0, -0.01),
                Floor::new(1.0, 0.01),
                Floor::new(-1.0, 0.01),
            ],
        };
        assert_eq!(to_shape(&[CARRIAGE], Floor::new(0.0, 0.0), &bar).distance_m, 0.0);
    }
}
