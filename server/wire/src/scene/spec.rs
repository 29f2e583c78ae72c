//! From the document to the engine's description, and from the engine's problems to JSON paths.

use covr_engine::frames::{Floor, Planar, Point};
use covr_engine::machine::Travel;
use covr_engine::scene::{
    KeepOutShape as EngineKeepOut, KeepOutSpec, ObjectSpec, PropSpec, ScenePart, SceneProblem, SceneSpec,
    Shape, ZoneSpec,
};

use super::{KeepOutShape, SceneDocument, SceneError, ShapeDocument, scenario};

/// The engine's description. A prop that does not exist becomes none: the checks of this room name it.
pub(super) fn spec(document: &SceneDocument) -> SceneSpec {
    let prop_index = |id: &String| document.props.iter().position(|prop| prop.id == *id);
    SceneSpec {
        arena: Travel { min: floor(document.arena.min), max: floor(document.arena.max) },
        column_size_m: planar(document.column.size),
        props: document
            .props
            .iter()
            .map(|prop| PropSpec {
                id: prop.id.clone(),
                offset: planar(prop.offset),
                facing_rad: prop.facing,
                size_m: planar(prop.size),
            })
            .collect(),
        objects: document
            .objects
            .iter()
            .map(|object| ObjectSpec {
                id: object.id.clone(),
                position: Point::new(object.position[0], object.position[1], object.position[2]),
                yaw_rad: object.yaw,
                shape: shape(&object.shape),
                prop: object.prop.as_ref().and_then(prop_index),
                prior: object.prior,
                enabled: object.enabled,
            })
            .collect(),
        keep_outs: document
            .keep_outs
            .iter()
            .map(|keep_out| KeepOutSpec { id: keep_out.id.clone(), shape: keep_out_shape(&keep_out.shape) })
            .collect(),
        zones: document
            .zones
            .iter()
            .map(|zone| ZoneSpec { id: zone.id.clone(), shape: keep_out_shape(&zone.shape) })
            .collect(),
        scenario: document.scenario.as_ref().map(scenario::spec),
    }
}

/// The engine's problem at its place in the JSON.
pub(super) fn error(problem: &SceneProblem) -> SceneError {
    let mut path = match problem.part {
        ScenePart::Scene => "$".to_owned(),
        ScenePart::Arena => "$.arena".to_owned(),
        ScenePart::Column => "$.column".to_owned(),
        ScenePart::Prop(i) => format!("$.props[{i}]"),
        ScenePart::Object(i) => format!("$.objects[{i}]"),
        ScenePart::KeepOut(i) => format!("$.keep_outs[{i}]"),
        ScenePart::Zone(i) => format!("$.zones[{i}]"),
        ScenePart::Scenario => "$.scenario".to_owned(),
    };
    if !problem.key.is_empty() {
        path.push('.');
        path.push_str(&problem.key);
    }
    SceneError::new(path, &problem.found, &problem.expected)
}

fn shape(document: &ShapeDocument) -> Shape {
    match document {
        ShapeDocument::Sphere { radius } => Shape::Sphere { radius_m: *radius },
        ShapeDocument::Box { size } => Shape::Box { size_m: *size },
        ShapeDocument::Cylinder { radius, height } => {
            Shape::Cylinder { radius_m: *radius, height_m: *height }
        }
        ShapeDocument::ConvexMesh { points } => Shape::ConvexMesh { points_m: points.clone() },
        ShapeDocument::TriangleMesh { vertices, triangles } => {
            Shape::TriangleMesh { vertices_m: vertices.clone(), triangles: triangles.clone() }
        }
    }
}

fn keep_out_shape(document: &KeepOutShape) -> EngineKeepOut {
    match document {
        KeepOutShape::Circle { centre, radius } => {
            EngineKeepOut::Circle { centre: floor(*centre), radius_m: *radius }
        }
        KeepOutShape::Polygon { corners } => {
            EngineKeepOut::Polygon { corners: corners.iter().copied().map(floor).collect() }
        }
    }
}

const fn floor([x, y]: [f64; 2]) -> Floor {
    Floor::new(x, y)
}

const fn planar([x, y]: [f64; 2]) -> Planar {
    Planar::new(x, y)
}
