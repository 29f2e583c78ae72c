//! `room_from_tracking` from a headset or tracker that rides on the column.
//!
//! The column does not turn, so whatever rides on it keeps its offset from the column's centre, in the room's axes. Positions
//! alone then give the turn and the sum of shift and offset, never each by itself: a headset 10 cm further along the column
//! in a room shifted by 10 cm looks the same. So the offset is measured by hand, or some places are touched with the same
//! headset, which fix the shift; then the visits give the offset.

use covr_engine::frames::{Floor, Point, Tracking};
use nalgebra::{Isometry3, Translation3, Vector3};

use super::fit::{FEWEST_POINTS, Judged, MOST_POINTS, check_outliers, chosen, judge};
use super::robust::{self, Match};
use super::{Bounds, CalibrationRefusal, Pair, RoomFit, fit_room};

/// The column at rest at one place, with the headset on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColumnVisit {
    /// Where the headset said that it was.
    pub tracking: Point<Tracking>,
    /// Where the machine measured the column's centre.
    pub column: Floor,
}

/// A map from visits, and where the headset sat.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnFit {
    /// The map; residuals of the visits first, then of the touched points.
    pub room: RoomFit,
    /// From the column's centre on the floor to the headset, room axes, m.
    pub offset_m: [f64; 3],
}

/// Fit a map to visits of the column, with the offset given or told by touched points.
pub fn fit_column(
    visits: &[ColumnVisit],
    touched: &[Pair],
    offset_m: Option<[f64; 3]>,
    bounds: &Bounds,
) -> Result<ColumnFit, CalibrationRefusal> {
    let on_floor = |column: Floor| Vector3::new(column.x, column.y, 0.0);
    if let Some(offset_m) = offset_m {
        let ridden = visits.iter().map(|visit| Pair {
            tracking: visit.tracking,
            room: Point::from_vector(on_floor(visit.column) + Vector3::from(offset_m)),
        });
        let pairs: Vec<Pair> = ridden.chain(touched.iter().copied()).collect();
        return Ok(ColumnFit { room: fit_room(&pairs, bounds)?, offset_m });
    }
    let points = visits.len() + touched.len();
    if points > MOST_POINTS {
        return Err(CalibrationRefusal::TooManyPoints { found: points, most: MOST_POINTS });
    }
    if visits.len() < FEWEST_POINTS {
        return Err(CalibrationRefusal::TooFewPoints { found: visits.len(), fewest: FEWEST_POINTS });
    }
    // As if the headset sat at the column's foot: the turn is right, the shift lacks the offset.
    let ridden: Vec<Pair> = visits
        .iter()
        .map(|visit| Pair { tracking: visit.tracking, room: Point::from_vector(on_floor(visit.column)) })
        .collect();
    let visit_matches: Vec<Match> =
        ridden.iter().map(|pair| (pair.tracking.vector(), pair.room.vector())).collect();
    let touch_matches: Vec<Match> =
        touched.iter().map(|pair| (pair.tracking.vector(), pair.room.vector())).collect();
    let foot = fit_room(&ridden, bounds)?;
    if touched.len() < FEWEST_TOUCHED {
        return Err(CalibrationRefusal::OffsetUnknown { found: touched.len(), fewest: FEWEST_TOUCHED });
    }
    let lacking: Vec<Vector3<f64>> = touched
        .iter()
        .map(|pair| pair.room.vector() - foot.room_from_tracking.point(&pair.tracking).vector())
        .collect();
    let middle = middle(&lacking);
    let noise_m = foot.rms_m.max(bounds.least_noise_m);
    let (_, centre) = robust::centres(&visit_matches);
    let touches: Vec<bool> = touched
        .iter()
        .zip(&lacking)
        .map(|(pair, one)| {
            // Below the headset's height, what the turn is uncertain by shows too.
            let lever_m = (pair.room.vector() - middle - centre).norm();
            (one - middle).norm() <= FAR_OFF * (noise_m + foot.turn_sd_rad * lever_m)
        })
        .collect();
    let touched_used = touches.iter().filter(|used| **used).count();
    check_outliers(touched.len() - touched_used, touched.len())?;

    let visits_used: Vec<bool> = foot.residuals.iter().map(|residual| residual.used).collect();
    let (rode, held) = (chosen(&visit_matches, &visits_used), chosen(&touch_matches, &touches));
    // The least squares of both together: each group gives the turn from its own centre, the touched one the shift.
    let rotation = robust::least_turn(
        rode.iter().map(|p| (*p, &rode)).chain(held.iter().map(|p| (*p, &held))).map(|((a, b), group)| {
            let (from, to) = robust::centres(group);
            (a - from, b - to)
        }),
    );
    let (from, to) = robust::centres(&held);
    let map = Isometry3::from_parts(Translation3::from(to - rotation * from), rotation);
    let (from, to) = robust::centres(&rode);
    let offset = rotation * from + map.translation.vector - to;

    let with_offset = |(a, b): &Match| (*a, b + offset);
    let rode: Vec<Match> = rode.iter().map(with_offset).collect();
    let matches: Vec<Match> = visit_matches.iter().map(with_offset).chain(touch_matches).collect();
    let used: Vec<bool> = visits_used.into_iter().chain(touches).collect();
    let judged = Judged { matches: &matches, used: &used, map, turned_by: &[&rode, &held], held_by: &held };
    Ok(ColumnFit { room: judge(&judged, bounds)?, offset_m: offset.into() })
}

/// The middle of some estimates of one vector.
fn middle(estimates: &[Vector3<f64>]) -> Vector3<f64> {
    let along = |axis: usize| {
        let mut values: Vec<f64> = estimates.iter().map(|one| one[axis]).collect();
        values.sort_by(f64::total_cmp);
        (values[(values.len() - 1) / 2] + values[values.len() / 2]) / 2.0
    };
    Vector3::new(along(0), along(1), along(2))
}

/// Of three, one that is wrong shows.
pub(super) const FEWEST_TOUCHED: usize = 3;
/// In root mean square distances of the visits (1.7 times the noise along one axis), and standard deviations of the turn.
const FAR_OFF: f64 = 3.5;

#[cfg(test)]
mod tests;
