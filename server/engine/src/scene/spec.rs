//! A scene as described: plain data, not yet checked. Lengths in metres, angles in radians, room frame.

use crate::frames::{Floor, Planar, Point, Room};
use crate::machine::Travel;
use crate::scenario::ScenarioSpec;

/// A scene as described, not yet checked. Lengths in metres, angles in radians, room frame.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneSpec {
    /// Where persons may be.
    pub arena: Travel,
    /// Column size along x and y, about its centre.
    pub column_size_m: Planar,
    /// What hangs on the column.
    pub props: Vec<PropSpec>,
    /// The virtual objects of interest.
    pub objects: Vec<ObjectSpec>,
    /// Where the column must never go.
    pub keep_outs: Vec<KeepOutSpec>,
    /// Places on the floor that the scenario knows people to be in.
    pub zones: Vec<ZoneSpec>,
    /// What can be served when; none: everything enabled, always.
    pub scenario: Option<ScenarioSpec>,
}

/// A prop.
#[derive(Debug, Clone, PartialEq)]
pub struct PropSpec {
    /// Unique in the scene.
    pub id: String,
    /// From the column's centre to the point of touch.
    pub offset: Planar,
    /// Heading that it faces.
    pub facing_rad: f64,
    /// The floor rectangle that it takes about its offset; zero: inside the column.
    pub size_m: Planar,
}

/// An object of interest.
#[derive(Debug, Clone, PartialEq)]
pub struct ObjectSpec {
    /// Unique in the scene.
    pub id: String,
    /// Its centre.
    pub position: Point<Room>,
    /// Heading of its own +x axis.
    pub yaw_rad: f64,
    /// Its surface.
    pub shape: Shape,
    /// The prop that stands in for it, as an index; none: the column's centre.
    pub prop: Option<usize>,
    /// The scenario prior, 0 to 1.
    pub prior: f64,
    /// It can be served now.
    pub enabled: bool,
}

/// A surface about an object's centre, in the object's own axes.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// A ball.
    Sphere {
        /// Radius.
        radius_m: f64,
    },
    /// A box.
    Box {
        /// Full size.
        size_m: [f64; 3],
    },
    /// An upright cylinder.
    Cylinder {
        /// Radius.
        radius_m: f64,
        /// Height.
        height_m: f64,
    },
    /// The convex hull of points.
    ConvexMesh {
        /// Points.
        points_m: Vec<[f64; 3]>,
    },
    /// Triangles.
    TriangleMesh {
        /// Corners.
        vertices_m: Vec<[f64; 3]>,
        /// Indices of corners.
        triangles: Vec<[u32; 3]>,
    },
}

/// Where the column must never go.
#[derive(Debug, Clone, PartialEq)]
pub struct KeepOutSpec {
    /// Unique in the scene.
    pub id: String,
    /// Its shape on the floor.
    pub shape: KeepOutShape,
}

/// A place on the floor that somebody can be in.
#[derive(Debug, Clone, PartialEq)]
pub struct ZoneSpec {
    /// Unique in the scene.
    pub id: String,
    /// Its shape.
    pub shape: KeepOutShape,
}

/// A shape on the floor.
#[derive(Debug, Clone, PartialEq)]
pub enum KeepOutShape {
    /// A disc.
    Circle {
        /// Centre.
        centre: Floor,
        /// Radius.
        radius_m: f64,
    },
    /// A convex polygon.
    Polygon {
        /// Corners in order, either way round.
        corners: Vec<Floor>,
    },
}

/// What is wrong with a scene, and where.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{part}: found {found}, expected {expected}")]
pub struct SceneProblem {
    /// The part.
    pub part: ScenePart,
    /// The key inside the part, as in the JSON: `position`, `shape.radius`, or empty for the part itself.
    pub key: String,
    /// What was found.
    pub found: String,
    /// What was expected.
    pub expected: String,
}

/// A part of a scene, by index.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ScenePart {
    /// The scene as a whole.
    Scene,
    /// The arena.
    Arena,
    /// The column.
    Column,
    /// A prop.
    Prop(usize),
    /// An object.
    Object(usize),
    /// A keep-out shape.
    KeepOut(usize),
    /// A zone.
    Zone(usize),
    /// The scenario.
    Scenario,
}

impl std::fmt::Display for ScenePart {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Scene => write!(f, "scene"),
            Self::Arena => write!(f, "arena"),
            Self::Column => write!(f, "column"),
            Self::Prop(i) => write!(f, "props[{i}]"),
            Self::Object(i) => write!(f, "objects[{i}]"),
            Self::KeepOut(i) => write!(f, "keep_outs[{i}]"),
            Self::Zone(i) => write!(f, "zones[{i}]"),
            Self::Scenario => write!(f, "scenario"),
        }
    }
}
