//! Rows that HTTP answers carry and no socket does.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ts_rs::TS;

/// A scene without its document: a row of `GET /api/v1/scenes`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct SceneSummary {
    /// The store's number of the scene.
    pub id: i64,
    /// What people call it.
    pub name: String,
    /// The newest version.
    pub version: i64,
    /// Who wrote the newest version.
    pub author: String,
    /// When the newest version was stored, RFC 3339.
    pub changed_at: String,
    /// A version of it is active.
    pub active: bool,
}

/// A version of a scene without its document: a row of `GET /api/v1/scenes/{id}/versions`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct SceneVersionSummary {
    /// The version.
    pub version: i64,
    /// Who wrote it.
    pub author: String,
    /// When it was stored, RFC 3339.
    pub created_at: String,
    /// It is the one that is played.
    pub active: bool,
    /// How many objects it has.
    pub objects: i64,
}

/// One object's change of prior, as stored: a row of `GET /api/v1/priors/changes`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct PriorChange {
    /// When, RFC 3339.
    pub at: String,
    /// Who.
    pub author: String,
    /// The scene's id of the object.
    pub object: String,
    /// Before, 0 to 1.
    pub from: f64,
    /// After, 0 to 1.
    pub to: f64,
    /// The store's number of the scene.
    pub scene_id: i64,
    /// And its version.
    pub scene_version: i64,
}
