//! Rigid maps between points, some of which are wrong.
//!
//! Least trimmed squares (Rousseeuw, 1984): the map whose h smallest squared distances have the least sum. It is searched
//! from every triple of points, so without a draw of chance, and each of the best is concentrated as in FAST-LTS (Rousseeuw
//! and Van Driessen, 2006). Least squares itself is that of Kabsch (1976) with the sign of Umeyama (1991), which never mirrors.

use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};

/// A point in the one frame and in the other.
pub(super) type Match = (Vector3<f64>, Vector3<f64>);

/// The rigid map from the first of each to the second with the least sum of squared distances. The points must not all
/// lie on a line.
pub(super) fn least_squares(matches: &[Match]) -> Isometry3<f64> {
    let (from, to) = centres(matches);
    let rotation = least_turn(matches.iter().map(|(a, b)| (a - from, b - to)));
    Isometry3::from_parts(Translation3::from(to - rotation * from), rotation)
}

/// The turn alone, for points from their centres.
pub(super) fn least_turn(centred: impl Iterator<Item = Match>) -> UnitQuaternion<f64> {
    let correlation = centred.fold(Matrix3::zeros(), |sum, (a, b)| sum + b * a.transpose());
    let svd = correlation.svd(true, true);
    let (Some(u), Some(v_t)) = (svd.u, svd.v_t) else { return UnitQuaternion::identity() };
    let hand = (u * v_t).determinant().signum();
    let turn = u * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, hand)) * v_t;
    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(turn))
}

/// The map that most of the points agree on, before any is judged.
pub(super) fn trimmed(matches: &[Match]) -> Option<Isometry3<f64>> {
    let kept = (matches.len() + 4) / 2;
    let mut starts: Vec<(f64, Isometry3<f64>)> = Vec::new();
    for i in 0..matches.len() {
        for j in i + 1..matches.len() {
            for k in j + 1..matches.len() {
                let Some(map) = through([matches[i], matches[j], matches[k]]) else { continue };
                let loss = closest(matches, &map, kept).1;
                if starts.len() < STARTS || starts.last().is_some_and(|(worst, _)| loss < *worst) {
                    let place = starts.partition_point(|(better, _)| *better <= loss);
                    starts.insert(place, (loss, map));
                    starts.truncate(STARTS);
                }
            }
        }
    }
    let concentrated = starts.into_iter().map(|(_, map)| concentrate(matches, map, kept));
    concentrated.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, map)| map)
}

/// Fit what fits best anew until nothing changes.
fn concentrate(matches: &[Match], mut map: Isometry3<f64>, kept: usize) -> (f64, Isometry3<f64>) {
    let (mut chosen, mut loss) = closest(matches, &map, kept);
    for _ in 0..LONGEST_CONCENTRATION {
        let next = least_squares(&chosen);
        let (next_chosen, next_loss) = closest(matches, &next, kept);
        if next_loss >= loss {
            break;
        }
        (map, chosen, loss) = (next, next_chosen, next_loss);
    }
    (loss, map)
}

/// The matches that a map leaves closest, and the sum of their squared distances.
fn closest(matches: &[Match], map: &Isometry3<f64>, kept: usize) -> (Vec<Match>, f64) {
    let mut by_distance: Vec<(f64, Match)> =
        matches.iter().map(|pair| (distance_m(map, pair).powi(2), *pair)).collect();
    by_distance.sort_by(|a, b| a.0.total_cmp(&b.0));
    by_distance.truncate(kept);
    let loss = by_distance.iter().map(|(squared, _)| squared).sum();
    (by_distance.into_iter().map(|(_, pair)| pair).collect(), loss)
}

/// The map that takes three points' plane to that of the others; none where they lie on a line.
fn through([(a0, b0), (a1, b1), (a2, b2)]: [Match; 3]) -> Option<Isometry3<f64>> {
    let axes = |origin: Vector3<f64>, along: Vector3<f64>, beside: Vector3<f64>| {
        let x = (along - origin).try_normalize(SHORTEST_M)?;
        let across = (beside - origin) - x * x.dot(&(beside - origin));
        let y = across.try_normalize(SHORTEST_M)?;
        Some(Matrix3::from_columns(&[x, y, x.cross(&y)]))
    };
    let turn = axes(b0, b1, b2)? * axes(a0, a1, a2)?.transpose();
    let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(turn));
    let (from, to) = centres(&[(a0, b0), (a1, b1), (a2, b2)]);
    Some(Isometry3::from_parts(Translation3::from(to - rotation * from), rotation))
}

/// How far a map leaves the first point of a match from the second.
pub(super) fn distance_m(map: &Isometry3<f64>, (from, to): &Match) -> f64 {
    (map.rotation * from + map.translation.vector - to).norm()
}

/// The mean of each side.
pub(super) fn centres(matches: &[Match]) -> Match {
    let sum = matches.iter().fold((Vector3::zeros(), Vector3::zeros()), |s, (a, b)| (s.0 + a, s.1 + b));
    (sum.0 / matches.len() as f64, sum.1 / matches.len() as f64)
}

/// Root mean square spread of points along their longest, middle and shortest directions.
pub(super) fn spreads_m(points: impl Iterator<Item = Vector3<f64>> + Clone) -> [f64; 3] {
    let count = points.clone().count().max(1) as f64;
    let centre = points.clone().sum::<Vector3<f64>>() / count;
    let scatter = points.fold(Matrix3::zeros(), |sum, p| sum + (p - centre) * (p - centre).transpose());
    let mut along: [f64; 3] =
        scatter.symmetric_eigenvalues().map(|squared: f64| (squared / count).max(0.0).sqrt()).into();
    along.sort_by(|a, b| b.total_cmp(a));
    along
}

/// How many of the best triples are looked at further.
const STARTS: usize = 10;
/// Concentration ends by itself after a few rounds.
const LONGEST_CONCENTRATION: usize = 30;
/// Points nearer than this to each other, or to a line, give no direction.
const SHORTEST_M: f64 = 0.05;
