//! One point from the poses of a while in which nothing moved.

use covr_engine::frames::{Point, Tracking};
use nalgebra::Vector3;

use super::CalibrationRefusal;

/// Poses being gathered at one place.
///
/// Of 90 poses whose noise is independent, the mean is 9.5 times as good as one of them. What drifts in that second is not
/// averaged out, so it is refused beyond a bound.
#[derive(Debug, Clone, Default)]
pub struct Stillness {
    points: Vec<Vector3<f64>>,
    is_lost: bool,
}

/// The mean of poses that kept still.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StillPoint {
    /// Where.
    pub point: Point<Tracking>,
    /// From how many poses.
    pub poses: usize,
    /// Root mean square distance of a pose from the mean, m.
    pub jitter_m: f64,
}

impl Stillness {
    /// One more pose; `tracked` as the headset says.
    pub fn add(&mut self, point: &Point<Tracking>, tracked: bool) {
        self.is_lost |= !tracked;
        if self.points.len() < MOST_POSES {
            self.points.push(point.vector());
        }
    }

    /// The point, where it kept still.
    pub fn point(&self) -> Result<StillPoint, CalibrationRefusal> {
        let poses = self.points.len();
        if self.is_lost {
            return Err(CalibrationRefusal::NotTracked);
        }
        if poses < FEWEST_POSES {
            return Err(CalibrationRefusal::TooFewPoses { found: poses, fewest: FEWEST_POSES });
        }
        let centre = mean(&self.points);
        let third = poses / 3;
        let drift_m = (mean(&self.points[..third]) - mean(&self.points[poses - third..])).norm();
        if drift_m > MOST_DRIFT_M {
            return Err(CalibrationRefusal::Moved { moved_m: drift_m, most_m: MOST_DRIFT_M });
        }
        let farthest_m = self.points.iter().map(|point| (point - centre).norm()).fold(0.0, f64::max);
        if farthest_m > MOST_EXCURSION_M {
            return Err(CalibrationRefusal::Moved { moved_m: farthest_m, most_m: MOST_EXCURSION_M });
        }
        let squares: f64 = self.points.iter().map(|point| (point - centre).norm_squared()).sum();
        Ok(StillPoint { point: Point::from_vector(centre), poses, jitter_m: (squares / poses as f64).sqrt() })
    }
}

fn mean(points: &[Vector3<f64>]) -> Vector3<f64> {
    points.iter().sum::<Vector3<f64>>() / points.len() as f64
}

/// Half a second of the slowest headset (60 Hz). With 5 mm of noise along each axis the mean is good to 0.9 mm along each.
const FEWEST_POSES: usize = 30;
/// Ten seconds of the fastest headset: more does no harm and helps little.
const MOST_POSES: usize = 1_200;
/// Between the means of the first and the last third. 5 mm of independent noise gives 1.3 mm along each axis.
const MOST_DRIFT_M: f64 = 0.008;
/// Of a single pose.
const MOST_EXCURSION_M: f64 = 0.04;

#[cfg(test)]
mod tests {
    use super::*;

    fn gathered(points: impl Iterator<Item = [f64; 3]>) -> Stillness {
        let mut still = Stillness::default();
        for point in points {
            still.add(&Point::from_vector(point.into()), true);
        }
        still
    }

    #[test]
    fn a_headset_at_rest_is_where_its_poses_are_on_average() {
        let still = gathered((0..90).map(|i| [1.0 + if i % 2 == 0 { 0.001 } else { -0.001 }, 2.0, 1.5]));
        let found = still.point().unwrap();
        assert!(found.point.distance_m(&Point::new(1.0, 2.0, 1.5)) < 1e-12);
        assert!((found.jitter_m - 0.001).abs() < 1e-12, "{found:?}");
        assert_eq!(found.poses, 90);
    }

    #[test]
    fn one_that_is_carried_along_or_jumps_is_refused() {
        let carried = gathered((0..90).map(|i| [f64::from(i) * 0.0003, 0.0, 0.0]));
        assert!(matches!(carried.point(), Err(CalibrationRefusal::Moved { .. })), "{:?}", carried.point());
        let jumped = gathered((0..90).map(|i| [if i == 40 { 0.1 } else { 0.0 }, 0.0, 0.0]));
        assert!(matches!(jumped.point(), Err(CalibrationRefusal::Moved { .. })), "{:?}", jumped.point());
    }

    #[test]
    fn one_that_says_little_or_is_lost_is_refused() {
        let few = gathered((0..29).map(|_| [0.0; 3]));
        assert_eq!(few.point(), Err(CalibrationRefusal::TooFewPoses { found: 29, fewest: FEWEST_POSES }));
        let mut lost = gathered((0..90).map(|_| [0.0; 3]));
        lost.add(&Point::new(0.0, 0.0, 0.0), false);
        assert_eq!(lost.point(), Err(CalibrationRefusal::NotTracked));
    }
}
