//! What the types of a scene do not say and its schema does: lengths, ranges, counts; and that its props exist. All of
//! it at once. Geometry and ids are the engine's to check.

use std::fmt::Display;
use std::ops::RangeInclusive;

use super::{
    KeepOutShape, ObjectDocument, PropDocument, SCHEMA, ScenarioDocument, SceneDocument, SceneError,
    ShapeDocument,
};

/// Every problem of a document, in its order.
pub(super) fn check(document: &SceneDocument) -> Vec<SceneError> {
    let mut problems = Problems::default();
    if document.schema != SCHEMA {
        problems.add("$.schema", quoted(&document.schema), format!("\"{SCHEMA}\""));
    }
    problems.text("$.name", &document.name, 1..=80);
    problems.text("$.description", &document.description, 0..=2_000);
    problems.numbers("$.arena.min", &document.arena.min, ROOM);
    problems.numbers("$.arena.max", &document.arena.max, ROOM);
    problems.numbers("$.column.size", &document.column.size, 0.01..=2.0);
    problems.count("$.props", document.props.len(), 0..=100);
    for (i, prop) in document.props.iter().enumerate() {
        problems.prop(&format!("$.props[{i}]"), prop);
    }
    problems.count("$.objects", document.objects.len(), 1..=500);
    for (i, object) in document.objects.iter().enumerate() {
        problems.object(&format!("$.objects[{i}]"), object, &document.props);
    }
    problems.count("$.keep_outs", document.keep_outs.len(), 0..=100);
    for (i, keep_out) in document.keep_outs.iter().enumerate() {
        let at = format!("$.keep_outs[{i}]");
        problems.text(&format!("{at}.id"), &keep_out.id, 1..=64);
        problems.text(&format!("{at}.label"), &keep_out.label, 0..=80);
        problems.floor_shape(&format!("{at}.shape"), &keep_out.shape);
    }
    problems.count("$.zones", document.zones.len(), 0..=100);
    for (i, zone) in document.zones.iter().enumerate() {
        let at = format!("$.zones[{i}]");
        problems.text(&format!("{at}.id"), &zone.id, 1..=64);
        problems.text(&format!("{at}.label"), &zone.label, 0..=80);
        problems.floor_shape(&format!("{at}.shape"), &zone.shape);
    }
    if let Some(scenario) = &document.scenario {
        problems.scenario(scenario);
    }
    problems.count("$.checklist", document.checklist.len(), 0..=30);
    for (i, item) in document.checklist.iter().enumerate() {
        problems.text(&format!("$.checklist[{i}]"), item, 1..=200);
    }
    problems.0
}

#[derive(Default)]
struct Problems(Vec<SceneError>);

impl Problems {
    fn add(&mut self, path: impl Into<String>, found: impl Display, expected: impl Display) {
        self.0.push(SceneError::new(path.into(), found, expected));
    }

    fn prop(&mut self, at: &str, prop: &PropDocument) {
        self.text(&format!("{at}.id"), &prop.id, 1..=64);
        self.text(&format!("{at}.label"), &prop.label, 0..=80);
        self.numbers(&format!("{at}.offset"), &prop.offset, -2.0..=2.0);
        self.angle(&format!("{at}.facing"), prop.facing);
        self.numbers(&format!("{at}.size"), &prop.size, 0.0..=3.0);
    }

    fn object(&mut self, at: &str, object: &ObjectDocument, props: &[PropDocument]) {
        self.text(&format!("{at}.id"), &object.id, 1..=64);
        self.text(&format!("{at}.label"), &object.label, 0..=80);
        self.numbers(&format!("{at}.position"), &object.position, ROOM);
        self.angle(&format!("{at}.yaw"), object.yaw);
        self.shape(&format!("{at}.shape"), &object.shape);
        if let Some(id) = object.prop.as_ref().filter(|id| !props.iter().any(|prop| prop.id == **id)) {
            let known: Vec<_> = props.iter().take(MOST_NAMED).map(|prop| quoted(&prop.id)).collect();
            let expected = match (known.is_empty(), props.len() > MOST_NAMED) {
                (true, _) => "a prop of this scene, which has none".into(),
                (false, true) => format!("a prop of this scene: {}, …", known.join(", ")),
                (false, false) => format!("a prop of this scene: {}", known.join(", ")),
            };
            self.add(format!("{at}.prop"), quoted(id), expected);
        }
        self.number(&format!("{at}.prior"), object.prior, 0.0..=1.0);
    }

    fn shape(&mut self, at: &str, shape: &ShapeDocument) {
        match shape {
            ShapeDocument::Sphere { radius } => self.number(&format!("{at}.radius"), *radius, SIZE),
            ShapeDocument::Box { size } => self.numbers(&format!("{at}.size"), size, SIZE),
            ShapeDocument::Cylinder { radius, height } => {
                self.number(&format!("{at}.radius"), *radius, SIZE);
                self.number(&format!("{at}.height"), *height, SIZE);
            }
            ShapeDocument::ConvexMesh { points } => {
                self.count(&format!("{at}.points"), points.len(), 4..=100_000);
                self.points(&format!("{at}.points"), points, MESH);
            }
            ShapeDocument::TriangleMesh { vertices, triangles } => {
                self.count(&format!("{at}.vertices"), vertices.len(), 3..=100_000);
                self.points(&format!("{at}.vertices"), vertices, MESH);
                self.count(&format!("{at}.triangles"), triangles.len(), 1..=100_000);
            }
        }
    }

    /// What is for people alone; the engine checks the rest.
    fn scenario(&mut self, scenario: &ScenarioDocument) {
        for (i, state) in scenario.states.iter().enumerate() {
            self.text(&format!("$.scenario.states[{i}].label"), &state.label, 0..=80);
            self.text(&format!("$.scenario.states[{i}].note"), &state.note, 0..=2_000);
            self.count(&format!("$.scenario.states[{i}].enabled"), state.enabled.len(), 0..=500);
        }
        for (path, way) in scenario.ways() {
            self.text(&format!("$.scenario.{path}.label"), &way.label, 0..=80);
        }
    }

    fn floor_shape(&mut self, at: &str, shape: &KeepOutShape) {
        match shape {
            KeepOutShape::Circle { centre, radius } => {
                self.numbers(&format!("{at}.centre"), centre, ROOM);
                self.number(&format!("{at}.radius"), *radius, 0.01..=50.0);
            }
            KeepOutShape::Polygon { corners } => {
                self.count(&format!("{at}.corners"), corners.len(), 3..=32);
                self.points(&format!("{at}.corners"), corners, ROOM);
            }
        }
    }

    fn points<const N: usize>(&mut self, at: &str, points: &[[f64; N]], range: RangeInclusive<f64>) {
        for (i, point) in points.iter().enumerate() {
            if point.iter().any(|number| !range.contains(number)) {
                self.numbers(&format!("{at}[{i}]"), point, range.clone());
            }
        }
    }

    fn numbers(&mut self, at: &str, numbers: &[f64], range: RangeInclusive<f64>) {
        for (i, number) in numbers.iter().enumerate() {
            self.number(&format!("{at}[{i}]"), *number, range.clone());
        }
    }

    fn number(&mut self, at: &str, number: f64, range: RangeInclusive<f64>) {
        if !range.contains(&number) {
            self.add(at, number, format!("a number from {} to {}", range.start(), range.end()));
        }
    }

    fn angle(&mut self, at: &str, angle_rad: f64) {
        if !ANGLE.contains(&angle_rad) {
            self.add(at, angle_rad, "radians from -6.3 to 6.3 (a full turn either way)");
        }
    }

    fn text(&mut self, at: &str, text: &str, chars: RangeInclusive<usize>) {
        let count = text.chars().count();
        if !chars.contains(&count) {
            let expected = format!("{} to {} characters", chars.start(), chars.end());
            self.add(at, format!("{count} characters"), expected);
        }
    }

    fn count(&mut self, at: &str, count: usize, range: RangeInclusive<usize>) {
        if !range.contains(&count) {
            self.add(at, format!("{count} of them"), format!("{} to {}", range.start(), range.end()));
        }
    }
}

fn quoted(text: &str) -> String {
    format!("\"{}\"", crate::complaint::shortened(text))
}

/// Coordinates, m: a hall; a number beyond it is in another unit.
const ROOM: RangeInclusive<f64> = -100.0..=100.0;
/// Sizes of surfaces, m.
const SIZE: RangeInclusive<f64> = 0.001..=50.0;
/// Coordinates of a mesh about its object's centre, m.
const MESH: RangeInclusive<f64> = -50.0..=50.0;
/// Headings, rad: a number beyond it is in degrees.
const ANGLE: RangeInclusive<f64> = -6.3..=6.3;
/// Ids that an error lists.
const MOST_NAMED: usize = 10;
