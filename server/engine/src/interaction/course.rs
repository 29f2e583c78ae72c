//! A path that is driven, corner by corner, and how fast.

use super::THERE_M;
use crate::frames::{Floor, Planar};
use crate::scenario::Course;

/// The way of the column's centre along a course.
#[derive(Debug, Clone, PartialEq)]
pub struct Drive {
    /// From where the object is, places of the column's centre.
    places: Vec<Floor>,
    /// The place that it makes for.
    next: usize,
    speed_mps: f64,
}

impl Drive {
    /// Along `course` from the object at `place`, taken up where the column stands; none when it stands nowhere near the way.
    pub fn taken_up(course: &Course, place: Floor, offset: Planar, column: Floor) -> Option<Self> {
        let mut places = vec![place];
        places.extend(course.path.iter().map(|at| *at - offset));
        let off_m = |leg: &[Floor]| nearest(leg[0], leg[1], column).distance_m(column);
        let legs = places.windows(2).enumerate().map(|(i, leg)| (i, off_m(leg)));
        let (leg, off_m) = legs.min_by(|a, b| a.1.total_cmp(&b.1))?;
        (off_m < NEAR_THE_WAY_M).then_some(Self { places, next: leg + 1, speed_mps: course.speed_mps })
    }

    /// The velocity wanted at `column`, m/s; none at the end. It slows for a corner by how sharp it is, and for the end.
    pub fn velocity(&mut self, column: Floor) -> Option<Planar> {
        while self.next + 1 < self.places.len() && column.distance_m(self.places[self.next]) < CORNER_M {
            self.next += 1;
        }
        let to_next = self.places[self.next] - column;
        let is_last = self.next + 1 == self.places.len();
        if is_last && to_next.norm() < THERE_M {
            return None;
        }
        let through_mps = if is_last { 0.0 } else { self.speed_mps * self.straightness() };
        let speed = self.speed_mps.min(through_mps + NEARING_PER_SEC * to_next.norm()).max(LEAST_MPS);
        Some(to_next.unit()? * speed)
    }

    /// How straight it goes on at the next place: 1 straight on, 0 at a right angle and beyond.
    fn straightness(&self) -> f64 {
        let leg = |i: usize| (self.places[i + 1] - self.places[i]).unit();
        match (leg(self.next - 1), leg(self.next)) {
            (Some(before), Some(after)) => before.dot(after).max(0.0),
            _ => 0.0,
        }
    }
}

/// The point of the leg from `a` to `b` that is nearest to `point`.
fn nearest(a: Floor, b: Floor, point: Floor) -> Floor {
    let leg = b - a;
    let along = (point - a).dot(leg) / leg.dot(leg).max(f64::MIN_POSITIVE);
    a + leg * along.clamp(0.0, 1.0)
}

/// A way is taken up where the column is nearer to it than this, m.
const NEAR_THE_WAY_M: f64 = 0.15;
/// A corner is cut by this much, m.
const CORNER_M: f64 = 0.05;
/// A metre before the end leaves this much speed, 1/s.
const NEARING_PER_SEC: f64 = 0.8;
/// Slower it would never arrive, m/s.
const LEAST_MPS: f64 = 0.02;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn place() -> impl Strategy<Value = Floor> {
        (0.0..4.0f64, 0.0..4.0f64).prop_map(|(x, y)| Floor::new(x, y))
    }

    proptest! {
        /// Whatever the path: never faster than said, and driven to its last place in the order written.
        #[test]
        fn a_course_is_driven_to_its_end_no_faster_than_said(
            start in place(),
            path in prop::collection::vec(place(), 1..8),
            speed_mps in 0.05..0.6f64,
        ) {
            let course = Course { path: path.clone(), speed_mps };
            let mut drive = Drive::taken_up(&course, start, Planar::ZERO, start).unwrap();
            let (mut column, mut steps, mut to_go) = (start, 0, 0);
            while let Some(velocity) = drive.velocity(column) {
                prop_assert!(velocity.norm() <= speed_mps + 1e-12);
                column += velocity * 0.02;
                while to_go < path.len() && column.distance_m(path[to_go]) < CORNER_M + 0.02 {
                    to_go += 1;
                }
                steps += 1;
                prop_assert!(steps < 100_000);
            }
            prop_assert_eq!(to_go, path.len());
            prop_assert!(column.distance_m(path[path.len() - 1]) < THERE_M);
        }
    }

    #[test]
    fn it_is_taken_up_where_the_column_stands_and_not_from_far_away() {
        let course = Course { path: vec![Floor::new(2.0, 1.0), Floor::new(2.0, 3.0)], speed_mps: 0.4 };
        let begun = |column| Drive::taken_up(&course, Floor::new(1.0, 1.0), Planar::ZERO, column);
        let mut later = begun(Floor::new(2.05, 2.0)).unwrap();
        assert!(later.velocity(Floor::new(2.05, 2.0)).unwrap().y > 0.3);
        assert_eq!(begun(Floor::new(3.0, 2.0)), None);
    }
}
