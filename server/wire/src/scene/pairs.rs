//! How long the column needs from each object to each other, beside how long people need.

use covr_engine::machine::Limits;
use covr_engine::placing::serve_secs;
use covr_engine::scene::Scene;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ts_rs::TS;

/// Each pair of a scene's objects: rows are from, columns to, in the scene's order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct ScenePairs {
    /// Ids.
    pub objects: Vec<String>,
    /// What the column needs from where it serves the one to where it serves the other, from rest at its limits, nobody in the way, s.
    pub serve_secs: Vec<Vec<f64>>,
    /// What a person needs from the one to the other at a usual walk, s: see [`walk_secs`].
    pub walk_secs: Vec<Vec<f64>>,
}

/// The pairs of a scene; none where there are more objects than a table has room for.
pub fn scene_pairs(scene: &Scene, limits: &Limits) -> Option<ScenePairs> {
    let objects = &scene.spec().objects;
    if objects.len() > MOST_OBJECTS {
        return None;
    }
    let floor = || objects.iter().map(|object| object.position.floor());
    let walks = floor().map(|from| floor().map(|to| rounded(walk_secs(from.distance_m(to)))).collect());
    let serves = serve_secs(scene, limits).into_iter();
    Some(ScenePairs {
        objects: objects.iter().map(|object| object.id.clone()).collect(),
        serve_secs: serves.map(|row| row.into_iter().map(rounded).collect()).collect(),
        walk_secs: walks.collect(),
    })
}

/// A usual walk over a distance, from rest to rest: of least jerk, whose greatest speed is 1.875 times its mean (Flash and Hogan,
/// 1985), with the median greatest speed of recorded people in VR, 0.8 m/s, as the synthetic visitor walks.
pub fn walk_secs(distance_m: f64) -> f64 {
    1.875 * distance_m / USUAL_PEAK_MPS
}

fn rounded(secs: f64) -> f64 {
    (secs * 100.0).round() / 100.0
}

const USUAL_PEAK_MPS: f64 = 0.8;
/// A table of more is not read by anybody.
const MOST_OBJECTS: usize = 60;
