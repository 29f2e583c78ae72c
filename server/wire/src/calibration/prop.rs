//! Where on the column a prop is, and which way it faces, from touches with a headset or controller whose place is calibrated.

use covr_engine::frames::{Floor, Planar, Point, Room};

use super::CalibrationRefusal;

/// A touch while the column stood still.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PropTouch {
    /// What touched, in the room.
    pub touched: Point<Room>,
    /// The column's centre then.
    pub column: Floor,
}

/// What a prop's fit must keep to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PropBounds {
    /// Root mean square distance of the touches from their mean, and of the face's points from its plane, m.
    pub most_rms_m: f64,
    /// Root mean square spread of the face's points along the face, at least, m.
    pub least_face_m: f64,
}

impl Default for PropBounds {
    fn default() -> Self {
        Self { most_rms_m: 0.010, least_face_m: 0.03 }
    }
}

/// Where a prop is.
#[derive(Debug, Clone, PartialEq)]
pub struct PropFit {
    /// From the column's centre to the prop's point of touch, m.
    pub offset: Planar,
    /// Above the floor, m.
    pub height_m: f64,
    /// Distance over the floor of each touch from the mean, in their order, m.
    pub residuals_m: Vec<f64>,
    /// Their root mean square, m.
    pub rms_m: f64,
    /// Where points on its face were touched.
    pub face: Option<FaceFit>,
}

/// Which way a prop faces.
#[derive(Debug, Clone, PartialEq)]
pub struct FaceFit {
    /// Heading away from the column, rad, counter-clockwise from +x.
    pub facing_rad: f64,
    /// Distance of each point from the face's plane, in their order, m.
    pub residuals_m: Vec<f64>,
    /// Their root mean square, m.
    pub rms_m: f64,
    /// Standard deviation of the heading, rad.
    pub facing_sd_rad: f64,
}

/// Fit a prop's offset to touches of its point, and its facing to points all over its face (none: the facing is left alone).
pub fn fit_prop(
    point: &[PropTouch],
    face: &[PropTouch],
    bounds: &PropBounds,
) -> Result<PropFit, CalibrationRefusal> {
    let found = point.len();
    if found < FEWEST_TOUCHES {
        return Err(CalibrationRefusal::TooFewPoints { found, fewest: FEWEST_TOUCHES });
    }
    let offsets = from_column(point);
    let offset = mean(&offsets);
    let residuals_m: Vec<f64> = offsets.iter().map(|one| (*one - offset).norm()).collect();
    let rms_m = rms(&residuals_m);
    check_rms(rms_m, bounds)?;
    let height_m = point.iter().map(|touch| touch.touched.z()).sum::<f64>() / found as f64;
    let face = if face.is_empty() { None } else { Some(fit_face(face, bounds)?) };
    Ok(PropFit { offset, height_m, residuals_m, rms_m, face })
}

/// A vertical plane through points: the line of total least squares over the floor.
fn fit_face(face: &[PropTouch], bounds: &PropBounds) -> Result<FaceFit, CalibrationRefusal> {
    let found = face.len();
    if found < FEWEST_ON_FACE {
        return Err(CalibrationRefusal::TooFewPoints { found, fewest: FEWEST_ON_FACE });
    }
    let points = from_column(face);
    let centre = mean(&points);
    let (mut xx, mut yy, mut xy) = (0.0, 0.0, 0.0);
    for point in &points {
        let from_centre = *point - centre;
        xx += from_centre.x * from_centre.x;
        yy += from_centre.y * from_centre.y;
        xy += from_centre.x * from_centre.y;
    }
    // The direction of the greatest spread is along the face.
    let along = Planar::new(1.0, 0.0).turned(0.5 * (2.0 * xy).atan2(xx - yy));
    let spread_squares: f64 = points.iter().map(|point| (*point - centre).dot(along).powi(2)).sum();
    let spread_m = (spread_squares / found as f64).sqrt();
    if spread_m < bounds.least_face_m {
        return Err(CalibrationRefusal::PointsTooClose { spread_m, least_m: bounds.least_face_m });
    }
    let normal = along.left();
    let outward = if normal.dot(centre) < 0.0 { -normal } else { normal };
    let residuals_m: Vec<f64> = points.iter().map(|point| (*point - centre).dot(outward).abs()).collect();
    let rms_m = rms(&residuals_m);
    check_rms(rms_m, bounds)?;
    let squares: f64 = residuals_m.iter().map(|r| r * r).sum();
    let noise_m = (squares / (found as f64 - 2.0)).sqrt();
    Ok(FaceFit {
        facing_rad: outward.y.atan2(outward.x),
        residuals_m,
        rms_m,
        facing_sd_rad: noise_m / spread_squares.sqrt(),
    })
}

fn from_column(touches: &[PropTouch]) -> Vec<Planar> {
    touches.iter().map(|touch| touch.touched.floor() - touch.column).collect()
}

fn check_rms(rms_m: f64, bounds: &PropBounds) -> Result<(), CalibrationRefusal> {
    if rms_m > bounds.most_rms_m {
        return Err(CalibrationRefusal::PoorFit { rms_m, most_m: bounds.most_rms_m });
    }
    Ok(())
}

fn mean(points: &[Planar]) -> Planar {
    points.iter().fold(Planar::ZERO, |sum, point| sum + *point) * (1.0 / points.len() as f64)
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

/// Of three, one that is wrong shows.
const FEWEST_TOUCHES: usize = 3;
/// Two points always lie on a line.
const FEWEST_ON_FACE: usize = 4;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::PI;

    fn touch(column: Floor, offset: Planar, z: f64) -> PropTouch {
        let at = column + offset;
        PropTouch { touched: Point::new(at.x, at.y, z), column }
    }

    #[test]
    fn touches_that_disagree_are_refused() {
        let column = Floor::new(1.0, 1.0);
        let far_apart = [0.0, 0.02, 0.06].map(|x| touch(column, Planar::new(x, 0.2), 1.0));
        let refused = fit_prop(&far_apart, &[], &PropBounds::default());
        assert!(matches!(refused, Err(CalibrationRefusal::PoorFit { .. })), "{refused:?}");
        let refused = fit_prop(&far_apart[..2], &[], &PropBounds::default());
        assert_eq!(refused, Err(CalibrationRefusal::TooFewPoints { found: 2, fewest: FEWEST_TOUCHES }));
    }

    #[test]
    fn a_face_touched_one_above_the_other_has_no_facing() {
        let column = Floor::new(1.0, 1.0);
        let point = [Planar::new(0.0, 0.2); 3].map(|offset| touch(column, offset, 1.0));
        let above: Vec<_> = [0.8, 0.9, 1.0, 1.1].map(|z| touch(column, Planar::new(0.0, 0.2), z)).into();
        let refused = fit_prop(&point, &above, &PropBounds::default());
        assert!(matches!(refused, Err(CalibrationRefusal::PointsTooClose { .. })), "{refused:?}");
    }

    proptest! {
        /// The column may stand elsewhere at each touch.
        #[test]
        fn a_prop_is_found_where_it_is_and_faces_as_it_does(
            facing in -PI..PI,
            distance in 0.1..0.5_f64,
            columns in prop::collection::vec((0.0..4.0, 0.0..4.0), 10),
            noise in prop::collection::vec((-0.003..0.003, -0.003..0.003), 10),
        ) {
            let outward = Planar::new(1.0, 0.0).turned(facing);
            let offset = outward * distance;
            let at = |index: usize, aside: f64| {
                let ((x, y), (dx, dy)) = (columns[index], noise[index]);
                touch(Floor::new(x, y), offset + outward.left() * aside + Planar::new(dx, dy), 1.0)
            };
            let point: Vec<_> = (0..4).map(|i| at(i, 0.0)).collect();
            let face: Vec<_> = (4..10).map(|i| at(i, [-0.15, -0.1, -0.05, 0.05, 0.1, 0.15][i - 4])).collect();
            let fit = fit_prop(&point, &face, &PropBounds::default()).unwrap();
            prop_assert!((fit.offset - offset).norm() < 0.0043, "{:?}", fit.offset);
            let face = fit.face.unwrap();
            let off = (face.facing_rad - facing + 3.0 * PI).rem_euclid(2.0 * PI) - PI;
            prop_assert!(off.abs() < 0.06, "{off} rad off");
            prop_assert!(face.facing_sd_rad < 0.02);
        }
    }
}
