//! A scene as designers write it: JSON, room frame, metres, radians.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ts_rs::TS;

/// A scene: objects of interest, props on the column, keep-out shapes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(deny_unknown_fields)]
pub struct SceneDocument {
    /// `covr.scene.v1`.
    pub schema: String,
    /// What people call it; 1 to 80 characters.
    pub name: String,
    /// For people.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
    /// Where persons may be: the floor's rectangle, m.
    pub arena: ArenaDocument,
    /// What the column is, seen from above.
    #[serde(default)]
    pub column: ColumnDocument,
    /// What hangs on the column; an object without a prop is served by the column's centre.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub props: Vec<PropDocument>,
    /// Virtual objects of interest; at least one, at most 500.
    pub objects: Vec<ObjectDocument>,
    /// Where the column must never go: furniture, bystanders.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub keep_outs: Vec<KeepOutDocument>,
}

/// The arena's rectangle on the floor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(deny_unknown_fields)]
pub struct ArenaDocument {
    /// Corner of least x and y, m.
    pub min: [f64; 2],
    /// Corner of greatest x and y, m.
    pub max: [f64; 2],
}

/// The column's footprint without props: a rectangle about its centre.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(deny_unknown_fields)]
pub struct ColumnDocument {
    /// Size along x and y, m.
    pub size: [f64; 2],
}

/// A prop on a side of the column.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(deny_unknown_fields)]
pub struct PropDocument {
    /// Unique in the scene.
    pub id: String,
    /// For people.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub label: String,
    /// From the column's centre to the prop's point of touch, m.
    pub offset: [f64; 2],
    /// Heading that the prop faces, rad, counter-clockwise from +x. The column cannot turn.
    #[serde(default)]
    pub facing: f64,
    /// The floor rectangle that it takes about its offset, m; counts in separation. `[0, 0]`: inside the column.
    #[serde(default)]
    pub size: [f64; 2],
}

/// A virtual object of interest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(deny_unknown_fields)]
pub struct ObjectDocument {
    /// Unique in the scene.
    pub id: String,
    /// For people.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub label: String,
    /// Its centre, room frame, m.
    pub position: [f64; 3],
    /// Heading of its own +x axis, rad.
    #[serde(default)]
    pub yaw: f64,
    /// Its surface.
    pub shape: ShapeDocument,
    /// The prop that stands in for it; none: the column's centre.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub prop: Option<String>,
    /// The scenario prior P, 0 to 1.
    #[serde(default = "one")]
    pub prior: f64,
    /// It can be served now.
    #[serde(default = "yes")]
    pub enabled: bool,
}

/// A surface about the object's centre.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum ShapeDocument {
    /// A ball.
    Sphere {
        /// m.
        radius: f64,
    },
    /// A box.
    Box {
        /// Full size along its own axes, m.
        size: [f64; 3],
    },
    /// An upright cylinder.
    Cylinder {
        /// m.
        radius: f64,
        /// m.
        height: f64,
    },
    /// The convex hull of points.
    ConvexMesh {
        /// In the object's own axes, m; at least 4, not in one plane.
        points: Vec<[f64; 3]>,
    },
    /// Triangles.
    TriangleMesh {
        /// In the object's own axes, m.
        vertices: Vec<[f64; 3]>,
        /// Indices into `vertices`.
        triangles: Vec<[u32; 3]>,
    },
}

/// Where the column must never go.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(deny_unknown_fields)]
pub struct KeepOutDocument {
    /// Unique in the scene.
    pub id: String,
    /// For people.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub label: String,
    /// Its shape on the floor.
    pub shape: KeepOutShape,
}

/// A shape on the floor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum KeepOutShape {
    /// A disc.
    Circle {
        /// Room frame, m.
        centre: [f64; 2],
        /// m.
        radius: f64,
    },
    /// A convex polygon.
    Polygon {
        /// Room frame, m; 3 to 32 corners.
        corners: Vec<[f64; 2]>,
    },
}

impl Default for ColumnDocument {
    /// The paper's 15 cm carriage.
    fn default() -> Self {
        Self { size: [0.15, 0.15] }
    }
}

const fn one() -> f64 {
    1.0
}

const fn yes() -> bool {
    true
}
