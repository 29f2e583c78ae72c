//! `room_from_tracking` from pairs of points.

use std::f64::consts::FRAC_PI_2;

use covr_engine::frames::RigidMap;
use nalgebra::{Isometry3, Matrix3, Vector3};

use super::robust::{self, Match};
use super::{CalibrationRefusal, Pair, RoomFromTracking};

/// What a fit must keep to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Root mean square spread of the points along their longest direction, at least, m.
    pub least_spread_m: f64,
    /// And across it, m.
    pub least_spread_across_m: f64,
    /// How far the scale may be off 1. An arena of 4 m that is 1 % too large is 2 cm off at its ends.
    pub most_scale_off: f64,
    /// Root mean square of the distances left, m.
    pub most_rms_m: f64,
    /// Between the two upward axes, rad. Headsets know gravity to well under a degree.
    pub most_tilt_rad: f64,
    /// 95 % uncertainty at the worst of the points, m.
    pub most_uncertainty_m: f64,
    /// Noise below which no point is called wrong, m: measuring tapes and feet are not finer.
    pub least_noise_m: f64,
}

impl Default for Bounds {
    fn default() -> Self {
        Self {
            least_spread_m: 0.5,
            least_spread_across_m: 0.25,
            most_scale_off: 0.01,
            most_rms_m: 0.015,
            most_tilt_rad: 2.0_f64.to_radians(),
            most_uncertainty_m: 0.010,
            least_noise_m: 0.001,
        }
    }
}

/// How one point agrees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residual {
    /// From where the map puts it to where it was said to be, m.
    pub distance_m: f64,
    /// It has a part in the map; otherwise it disagrees with the others.
    pub used: bool,
}

/// A fitted map and how good it is.
#[derive(Debug, Clone, PartialEq)]
pub struct RoomFit {
    /// The map; its scale is 1.
    pub room_from_tracking: RoomFromTracking,
    /// Of each pair, in their order.
    pub residuals: Vec<Residual>,
    /// Root mean square of the residuals of the points used, m.
    pub rms_m: f64,
    /// What the scale would have been, were it free.
    pub scale: f64,
    /// Between the two upward axes, rad.
    pub tilt_rad: f64,
    /// 95 % of such fits are within this at the worst of the points, m.
    pub uncertainty_m: f64,
    /// Standard deviation of the turn about its least certain axis, rad.
    pub turn_sd_rad: f64,
}

/// Fit a map to pairs, most of which are right.
///
/// Noise is held to be the same along every axis. A point is left out when its residual is one that a right point has in 3 of
/// 1000 cases. At most a third may be left out, so two of six and four of twelve.
pub fn fit_room(pairs: &[Pair], bounds: &Bounds) -> Result<RoomFit, CalibrationRefusal> {
    let matches: Vec<Match> = pairs.iter().map(|pair| (pair.tracking.vector(), pair.room.vector())).collect();
    check_layout(&matches, bounds)?;
    check_rough_scale(&matches, bounds)?;
    let agreed = agreement(&matches, bounds);
    let Some(agreed) = agreed else {
        return Err(CalibrationRefusal::PointsOnALine {
            spread_m: 0.0,
            least_m: bounds.least_spread_across_m,
        });
    };
    check_hand(&matches, &agreed, bounds)?;
    let kept = chosen(&matches, &agreed.used);
    check_outliers(matches.len() - kept.len(), matches.len())?;
    check_layout_of(&kept, bounds)?;
    judge(
        &Judged {
            matches: &matches,
            used: &agreed.used,
            map: agreed.map,
            turned_by: &[&kept],
            held_by: &kept,
        },
        bounds,
    )
}

/// A map to be judged.
pub(super) struct Judged<'a> {
    /// Every match.
    pub matches: &'a [Match],
    /// Which of them the map is made of.
    pub used: &'a [bool],
    /// The map.
    pub map: Isometry3<f64>,
    /// Those that fix its turn, by groups whose centres are free of each other.
    pub turned_by: &'a [&'a [Match]],
    /// Those that fix its shift.
    pub held_by: &'a [Match],
}

/// Hold a map against what it must keep to.
pub(super) fn judge(judged: &Judged<'_>, bounds: &Bounds) -> Result<RoomFit, CalibrationRefusal> {
    let map = &judged.map;
    let scale = scale_of(judged.turned_by, map);
    if (scale - 1.0).abs() > bounds.most_scale_off {
        return Err(CalibrationRefusal::WrongScale { scale, most_off: bounds.most_scale_off });
    }
    let kept = chosen(judged.matches, judged.used);
    let squares: f64 = kept.iter().map(|pair| robust::distance_m(map, pair).powi(2)).sum();
    let rms_m = (squares / kept.len() as f64).sqrt();
    if rms_m > bounds.most_rms_m {
        return Err(CalibrationRefusal::PoorFit { rms_m, most_m: bounds.most_rms_m });
    }
    let tilt_rad = (map.rotation * Vector3::z()).angle(&Vector3::z());
    if tilt_rad > FRAC_PI_2 {
        return Err(CalibrationRefusal::Mirrored);
    }
    if tilt_rad > bounds.most_tilt_rad {
        return Err(CalibrationRefusal::Tilted { tilt_rad, most_rad: bounds.most_tilt_rad });
    }
    let noise_m = (squares / degrees_of_freedom(kept.len(), judged.turned_by.len())).sqrt();
    let (uncertainty_m, turn_sd_rad) = uncertainty(judged, noise_m);
    if uncertainty_m > bounds.most_uncertainty_m {
        return Err(CalibrationRefusal::Uncertain { uncertainty_m, most_m: bounds.most_uncertainty_m });
    }
    let residuals = judged
        .matches
        .iter()
        .zip(judged.used)
        .map(|(pair, used)| Residual { distance_m: robust::distance_m(map, pair), used: *used })
        .collect();
    let room_from_tracking = RigidMap::new(*map);
    Ok(RoomFit { room_from_tracking, residuals, rms_m, scale, tilt_rad, uncertainty_m, turn_sd_rad })
}

/// The matches that are used.
pub(super) fn chosen(matches: &[Match], used: &[bool]) -> Vec<Match> {
    matches.iter().zip(used).filter(|(_, used)| **used).map(|(pair, _)| *pair).collect()
}

/// At most a third may disagree.
pub(super) fn check_outliers(outliers: usize, points: usize) -> Result<(), CalibrationRefusal> {
    let most = points / 3;
    if outliers > most {
        return Err(CalibrationRefusal::TooManyOutliers { outliers, points, most });
    }
    Ok(())
}

/// What most points agree on.
struct Agreed {
    map: Isometry3<f64>,
    used: Vec<bool>,
    /// Median distance of all points, m.
    median_m: f64,
}

fn agreement(matches: &[Match], bounds: &Bounds) -> Option<Agreed> {
    let mut map = robust::trimmed(matches)?;
    let distances = |map: &Isometry3<f64>| -> Vec<f64> {
        matches.iter().map(|pair| robust::distance_m(map, pair)).collect()
    };
    let median_m = median(distances(&map));
    // The median of the fit is too small where few points make it (Rousseeuw and Leroy, 1987, in three dimensions).
    let few = 1.0 + 5.0 / (matches.len() as f64 - 2.0);
    let mut noise_m = few * median_m / MEDIAN_OF_CHI_3;
    let mut used: Vec<bool> = Vec::new();
    for _ in 0..LONGEST_SETTLING {
        let bound_m = noise_m.max(bounds.least_noise_m) * RIGHT_POINT;
        let next: Vec<bool> = distances(&map).into_iter().map(|d| d <= bound_m).collect();
        if next == used {
            break;
        }
        let kept = chosen(matches, &next);
        used = next;
        if kept.len() < 3 {
            break;
        }
        map = robust::least_squares(&kept);
        let squares: f64 = kept.iter().map(|pair| robust::distance_m(&map, pair).powi(2)).sum();
        noise_m = (squares / degrees_of_freedom(kept.len(), 1)).sqrt();
    }
    Some(Agreed { map, used, median_m })
}

fn check_layout(matches: &[Match], bounds: &Bounds) -> Result<(), CalibrationRefusal> {
    let found = matches.len();
    if found < FEWEST_POINTS {
        return Err(CalibrationRefusal::TooFewPoints { found, fewest: FEWEST_POINTS });
    }
    if found > MOST_POINTS {
        return Err(CalibrationRefusal::TooManyPoints { found, most: MOST_POINTS });
    }
    check_layout_of(matches, bounds)
}

/// The places in the room: those of the headset are the same where the fit is good.
fn check_layout_of(matches: &[Match], bounds: &Bounds) -> Result<(), CalibrationRefusal> {
    let [along, across, _] = robust::spreads_m(matches.iter().map(|(_, room)| *room));
    if along < bounds.least_spread_m {
        let least_m = bounds.least_spread_m;
        return Err(CalibrationRefusal::PointsTooClose { spread_m: along, least_m });
    }
    if across < bounds.least_spread_across_m {
        let least_m = bounds.least_spread_across_m;
        return Err(CalibrationRefusal::PointsOnALine { spread_m: across, least_m });
    }
    Ok(())
}

/// Before anything is fitted, so that wrong units are called that: the median ratio of the distances between points.
fn check_rough_scale(matches: &[Match], bounds: &Bounds) -> Result<(), CalibrationRefusal> {
    let mut ratios = Vec::new();
    for (i, (a, b)) in matches.iter().enumerate() {
        for (a2, b2) in &matches[i + 1..] {
            let (tracking, room) = ((a - a2).norm(), (b - b2).norm());
            if room > FAR_APART_M && tracking > 0.0 {
                ratios.push(room / tracking);
            }
        }
    }
    // None: every place is another place to the room and the same to the headset.
    let scale = if ratios.is_empty() { f64::MAX } else { median(ratios) };
    if (scale - 1.0).abs() > ROUGHLY * bounds.most_scale_off {
        return Err(CalibrationRefusal::WrongScale { scale, most_off: bounds.most_scale_off });
    }
    Ok(())
}

/// Points that do not fit, but do in a mirror, come from axes of the other hand. On a plane no fit can tell: there they
/// come out upside down.
fn check_hand(matches: &[Match], agreed: &Agreed, bounds: &Bounds) -> Result<(), CalibrationRefusal> {
    if agreed.median_m < bounds.most_rms_m {
        return Ok(());
    }
    let mirrored: Vec<Match> = matches.iter().map(|(a, b)| (Vector3::new(-a.x, a.y, a.z), *b)).collect();
    let Some(other) = agreement(&mirrored, bounds) else { return Ok(()) };
    if other.median_m < agreed.median_m / 2.0 { Err(CalibrationRefusal::Mirrored) } else { Ok(()) }
}

fn scale_of(groups: &[&[Match]], map: &Isometry3<f64>) -> f64 {
    let (mut along, mut squares) = (0.0, 0.0);
    for group in groups {
        let (from, to) = robust::centres(group);
        for (a, b) in *group {
            let turned = map.rotation * (a - from);
            along += turned.dot(&(b - to));
            squares += turned.norm_squared();
        }
    }
    along / squares
}

/// From the noise of one point along one axis: the 95 % radius at the worst point, and the turn about the worst axis.
///
/// Gauss-Newton at the solution, from the centre c of the points that hold the shift: the shift has variance s2/n along each
/// axis, the turn s2 A^-1 with A the sum of |r|2 I - r r^T from each group's own centre; a point at r from c moves by shift + turn x r.
fn uncertainty(judged: &Judged<'_>, noise_m: f64) -> (f64, f64) {
    let mut stiffness = Matrix3::zeros();
    for group in judged.turned_by {
        let (_, centre) = robust::centres(group);
        for (_, b) in *group {
            let r = b - centre;
            stiffness += Matrix3::identity() * r.norm_squared() - r * r.transpose();
        }
    }
    let (_, centre) = robust::centres(judged.held_by);
    let turn = stiffness.try_inverse().unwrap_or_else(|| Matrix3::identity() * f64::MAX) * noise_m.powi(2);
    let shift = noise_m.powi(2) / judged.held_by.len() as f64;
    let worst = judged
        .matches
        .iter()
        .map(|(_, b)| {
            let lever = (b - centre).cross_matrix();
            3.0 * shift + (lever * turn * lever.transpose()).trace()
        })
        .fold(0.0, f64::max);
    (worst.sqrt() * RADIUS_95, turn.symmetric_eigenvalues().max().max(0.0).sqrt())
}

/// Of the noise along one axis: a point has three coordinates, a map takes six, an offset between groups three.
fn degrees_of_freedom(points: usize, groups: usize) -> f64 {
    (3.0 * points as f64 - 3.0 - 3.0 * groups as f64).max(1.0)
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    if values.len() % 2 == 1 { values[middle] } else { (values[middle - 1] + values[middle]) / 2.0 }
}

/// With fewer points a wrong one cannot be told from the right ones.
pub const FEWEST_POINTS: usize = 6;
/// Every triple is tried: 4060 of them.
pub const MOST_POINTS: usize = 30;
/// sqrt of the chi-square median with 3 degrees of freedom: the median distance of points whose noise is 1 along each axis.
const MEDIAN_OF_CHI_3: f64 = 1.538;
/// sqrt of the 99.7 % point of the same distribution.
const RIGHT_POINT: f64 = 3.73;
/// 95 % radius in root mean square radii: 1.61 for the same noise along three axes (chi-square), 1.96 along one. Far from the
/// centre the turn makes it uneven, and the noise itself is known from few points; a test holds the share.
const RADIUS_95: f64 = 1.85;
/// The set of points used settles in a few rounds.
const LONGEST_SETTLING: usize = 20;
/// Points this far apart tell the scale.
const FAR_APART_M: f64 = 0.3;
/// Before wrong points are out the scale is known less well, and a wrong unit is off by far more.
const ROUGHLY: f64 = 10.0;

#[cfg(test)]
mod tests;
