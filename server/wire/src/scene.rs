//! A scene as designers write it: JSON, room frame, metres, radians.
//!
//! The ranges in the schema's attributes are the ones that [`parse_scene`] checks; a test holds them together.

mod check;
mod pairs;
mod parse;
mod place;
mod scenario;
mod shape;
mod spec;

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};
use ts_rs::TS;

pub use pairs::{ScenePairs, scene_pairs, walk_secs};
pub use parse::{MAX_SCENE_BYTES, SceneError, SceneWarning, build_scene, parse_scene, scene_warnings};
pub use scenario::{
    ActDocument, ChangingPriorDocument, ComparisonDocument, ConditionDocument, InteractionDocument,
    PriorDocument, ScenarioDocument, StateDocument, TransitionDocument, TriggerDocument, ValueDocument,
    VariableDocument,
};

/// The value of a scene's `schema`.
pub const SCHEMA: &str = "covr.scene.v2";
/// The version before, without zones and scenario: read as what it is today.
const SCHEMA_BEFORE: &str = "covr.scene.v1";

/// The JSON Schema of a scene, draft 2020-12: for editors, and for generators of scenes.
pub fn scene_schema() -> serde_json::Value {
    schemars::schema_for!(SceneDocument).to_value()
}

/// A scene: objects of interest, props on the column, keep-out shapes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(deny_unknown_fields)]
pub struct SceneDocument {
    /// `covr.scene.v2`; `covr.scene.v1` is read too, and written as the newer.
    #[serde(deserialize_with = "migrated")]
    #[schemars(extend("enum" = [SCHEMA, SCHEMA_BEFORE]))]
    pub schema: String,
    /// What people call it; 1 to 80 characters.
    #[schemars(length(min = 1, max = 80))]
    pub name: String,
    /// For people.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    #[schemars(length(max = 2000))]
    pub description: String,
    /// Where persons may be: the floor's rectangle, m.
    pub arena: ArenaDocument,
    /// What the column is, seen from above.
    #[serde(default)]
    pub column: ColumnDocument,
    /// What hangs on the column; an object without a prop is served by the column's centre.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 100))]
    pub props: Vec<PropDocument>,
    /// Virtual objects of interest; at least one, at most 500.
    #[schemars(length(min = 1, max = 500))]
    pub objects: Vec<ObjectDocument>,
    /// Where the column must never go: furniture, bystanders.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 100))]
    pub keep_outs: Vec<KeepOutDocument>,
    /// Places on the floor that the scenario knows people to be in.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 100))]
    pub zones: Vec<ZoneDocument>,
    /// What can be served when, and what leads on; none: every enabled object, always.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scenario: Option<ScenarioDocument>,
    /// What is to be looked at before the machine is armed, for this scene; none: the usual list.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 30), inner(length(min = 1, max = 200)))]
    pub checklist: Vec<String>,
}

/// The arena's rectangle on the floor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(deny_unknown_fields)]
pub struct ArenaDocument {
    /// Corner of least x and y, m.
    #[schemars(inner(range(min = -100.0, max = 100.0)))]
    pub min: [f64; 2],
    /// Corner of greatest x and y, m.
    #[schemars(inner(range(min = -100.0, max = 100.0)))]
    pub max: [f64; 2],
}

/// The column's footprint without props: a rectangle about its centre.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(deny_unknown_fields)]
pub struct ColumnDocument {
    /// Size along x and y, m.
    #[schemars(inner(range(min = 0.01, max = 2.0)))]
    pub size: [f64; 2],
}

/// A prop on a side of the column.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(deny_unknown_fields)]
pub struct PropDocument {
    /// Unique in the scene.
    #[schemars(length(min = 1, max = 64))]
    pub id: String,
    /// For people.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    #[schemars(length(max = 80))]
    pub label: String,
    /// From the column's centre to the prop's point of touch, m.
    #[schemars(inner(range(min = -2.0, max = 2.0)))]
    pub offset: [f64; 2],
    /// Heading that the prop faces, rad, counter-clockwise from +x. The column cannot turn.
    #[serde(default)]
    #[schemars(range(min = -6.3, max = 6.3))]
    pub facing: f64,
    /// The floor rectangle that it takes about its offset, m; counts in separation. `[0, 0]`: inside the column.
    #[serde(default)]
    #[schemars(inner(range(min = 0.0, max = 3.0)))]
    pub size: [f64; 2],
}

/// A virtual object of interest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(deny_unknown_fields)]
pub struct ObjectDocument {
    /// Unique in the scene.
    #[schemars(length(min = 1, max = 64))]
    pub id: String,
    /// For people.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    #[schemars(length(max = 80))]
    pub label: String,
    /// Its centre, room frame, m.
    #[schemars(inner(range(min = -100.0, max = 100.0)))]
    pub position: [f64; 3],
    /// Heading of its own +x axis, rad.
    #[serde(default)]
    #[schemars(range(min = -6.3, max = 6.3))]
    pub yaw: f64,
    /// Its surface.
    pub shape: ShapeDocument,
    /// The prop that stands in for it; none: the column's centre.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub prop: Option<String>,
    /// The scenario prior P, 0 to 1.
    #[serde(default = "one")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub prior: f64,
    /// It can be served now.
    #[serde(default = "yes")]
    pub enabled: bool,
}

/// A surface about the object's centre.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema, TS)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum ShapeDocument {
    /// A ball.
    Sphere {
        /// m.
        #[schemars(range(min = 0.001, max = 50.0))]
        radius: f64,
    },
    /// A box.
    Box {
        /// Full size along its own axes, m.
        #[schemars(inner(range(min = 0.001, max = 50.0)))]
        size: [f64; 3],
    },
    /// An upright cylinder.
    Cylinder {
        /// m.
        #[schemars(range(min = 0.001, max = 50.0))]
        radius: f64,
        /// m.
        #[schemars(range(min = 0.001, max = 50.0))]
        height: f64,
    },
    /// The convex hull of points.
    ConvexMesh {
        /// In the object's own axes, m; at least 4, not in one plane.
        #[schemars(length(min = 4, max = 100_000), inner(inner(range(min = -50.0, max = 50.0))))]
        points: Vec<[f64; 3]>,
    },
    /// Triangles.
    TriangleMesh {
        /// In the object's own axes, m.
        #[schemars(length(min = 3, max = 100_000), inner(inner(range(min = -50.0, max = 50.0))))]
        vertices: Vec<[f64; 3]>,
        /// Indices into `vertices`.
        #[schemars(length(min = 1, max = 100_000))]
        triangles: Vec<[u32; 3]>,
    },
}

/// Where the column must never go.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(deny_unknown_fields)]
pub struct KeepOutDocument {
    /// Unique in the scene.
    #[schemars(length(min = 1, max = 64))]
    pub id: String,
    /// For people.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    #[schemars(length(max = 80))]
    pub label: String,
    /// Its shape on the floor.
    pub shape: KeepOutShape,
}

/// A place on the floor that somebody can be in: the head over it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(deny_unknown_fields)]
pub struct ZoneDocument {
    /// Unique in the scene.
    #[schemars(length(min = 1, max = 64))]
    pub id: String,
    /// For people.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    #[schemars(length(max = 80))]
    pub label: String,
    /// Its shape on the floor.
    pub shape: KeepOutShape,
}

/// A shape on the floor.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema, TS)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum KeepOutShape {
    /// A disc.
    Circle {
        /// Room frame, m.
        #[schemars(inner(range(min = -100.0, max = 100.0)))]
        centre: [f64; 2],
        /// m.
        #[schemars(range(min = 0.01, max = 50.0))]
        radius: f64,
    },
    /// A convex polygon.
    Polygon {
        /// Room frame, m; 3 to 32 corners.
        #[schemars(length(min = 3, max = 32), inner(inner(range(min = -100.0, max = 100.0))))]
        corners: Vec<[f64; 2]>,
    },
}

impl Default for ColumnDocument {
    /// The paper's 15 cm carriage.
    fn default() -> Self {
        Self { size: [0.15, 0.15] }
    }
}

/// A scene of the version before is one of this version, without what came since.
fn migrated<'de, D: Deserializer<'de>>(deserializer: D) -> Result<String, D::Error> {
    let schema = String::deserialize(deserializer)?;
    Ok(if schema == SCHEMA_BEFORE { SCHEMA.to_owned() } else { schema })
}

const fn one() -> f64 {
    1.0
}

const fn yes() -> bool {
    true
}
