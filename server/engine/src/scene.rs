//! The scene as the engine needs it: objects with true surfaces, props, keep-out shapes, the column's footprint.
//!
//! A scene is right once built. parry stays inside this room.

pub mod footprint;
pub mod spec;
mod surface;
pub mod zone;

use std::collections::HashMap;

use crate::frames::{Floor, Planar, Point, Pose, Room};
use crate::machine::Travel;
use crate::scenario::{Finding, Names, Scenario, Stage};
use footprint::{Footprint, KeepOut};
pub use spec::{
    KeepOutShape, KeepOutSpec, ObjectSpec, PropSpec, ScenePart, SceneProblem, SceneSpec, Shape, ZoneSpec,
};
use surface::Surface;
use zone::Zone;

/// A scene, right once built.
#[derive(Debug)]
pub struct Scene {
    spec: SceneSpec,
    objects: Vec<Object>,
    footprint: Footprint,
    keep_outs: Vec<KeepOut>,
    zones: Vec<Zone>,
    scenario: Option<Scenario>,
    enabled: Vec<bool>,
}

/// An object of interest with its surface.
#[derive(Debug)]
pub struct Object {
    surface: Surface,
    column_place: Floor,
}

impl Scene {
    /// Check and build; every problem is reported, not the first alone.
    pub fn build(spec: SceneSpec) -> Result<Self, Vec<SceneProblem>> {
        let mut problems = Vec::new();
        check_rectangle(ScenePart::Arena, "max", spec.arena.max - spec.arena.min, 0.5, 100.0, &mut problems);
        check_rectangle(ScenePart::Column, "size", spec.column_size_m, 0.01, 2.0, &mut problems);
        for (i, prop) in spec.props.iter().enumerate() {
            check_prop(ScenePart::Prop(i), prop, &mut problems);
        }
        let mut objects = Vec::with_capacity(spec.objects.len());
        for (i, object) in spec.objects.iter().enumerate() {
            objects.extend(build_object(i, object, &spec, &mut problems));
        }
        for (i, keep_out) in spec.keep_outs.iter().enumerate() {
            check_shape(ScenePart::KeepOut(i), &keep_out.shape, &mut problems);
        }
        for (i, zone) in spec.zones.iter().enumerate() {
            check_shape(ScenePart::Zone(i), &zone.shape, &mut problems);
        }
        if !(1..=MOST_OBJECTS).contains(&spec.objects.len()) {
            let found = format!("{} objects", spec.objects.len());
            problems.push(problem(
                ScenePart::Scene,
                "objects",
                found,
                format!("1 to {MOST_OBJECTS} objects"),
            ));
        }
        check_ids(&spec, &mut problems);
        let scenario = build_scenario(&spec, &mut problems);
        if !problems.is_empty() {
            return Err(problems);
        }
        let footprint = Footprint::new(spec.column_size_m, &spec.props);
        let keep_outs = spec.keep_outs.iter().map(|k| KeepOut::new(&k.shape, &footprint)).collect();
        let zones = spec.zones.iter().map(|zone| Zone::new(&zone.shape)).collect();
        let enabled = spec.objects.iter().map(|object| object.enabled).collect();
        Ok(Self { spec, objects, footprint, keep_outs, zones, scenario, enabled })
    }

    /// What it was built from.
    pub fn spec(&self) -> &SceneSpec {
        &self.spec
    }

    /// The objects, in the scene's order.
    pub fn objects(&self) -> &[Object] {
        &self.objects
    }

    /// The column seen from above, props included.
    pub fn footprint(&self) -> &Footprint {
        &self.footprint
    }

    /// Where the column must never go.
    pub fn keep_outs(&self) -> &[KeepOut] {
        &self.keep_outs
    }

    /// The zones, in the scene's order.
    pub fn zones(&self) -> &[Zone] {
        &self.zones
    }

    /// The scenario.
    pub fn scenario(&self) -> Option<&Scenario> {
        self.scenario.as_ref()
    }

    /// What is worth a second look in the scenario; paths are from the scenario on.
    pub fn findings(&self) -> Vec<Finding> {
        let (objects, zones) = ids(&self.spec);
        let priors: Vec<f64> = self.spec.objects.iter().map(|object| object.prior).collect();
        let stage = Stage { objects: &objects, zones: &zones, priors: &priors, enabled: &self.enabled };
        self.scenario.as_ref().map_or_else(Vec::new, |scenario| scenario.findings(stage))
    }

    /// Which objects can be served as the scene itself has it, scenario apart.
    pub fn enabled(&self) -> &[bool] {
        &self.enabled
    }

    /// From a head to the nearest surface of any object that the scene itself enables, m; infinite without one.
    pub fn nearest_enabled_object_m(&self, head: &Point<Room>) -> f64 {
        self.nearest_object_m(head, &self.enabled)
    }

    /// From a head to the nearest surface of any of these objects, m; infinite without one.
    pub fn nearest_object_m(&self, head: &Point<Room>, of: &[bool]) -> f64 {
        let enabled = self.objects.iter().zip(of).filter(|(_, enabled)| **enabled);
        enabled.fold(f64::INFINITY, |nearest, (object, _)| {
            // Far objects are not asked for their surface: it is no nearer than the ball about it.
            if object.surface.at_least_m(head) > nearest {
                nearest
            } else {
                nearest.min(object.distance_m(head))
            }
        })
    }
}

impl Object {
    /// Where the column's centre must stand so that the object's prop stands at the object.
    pub fn column_place(&self) -> Floor {
        self.column_place
    }

    /// From the head to the nearest surface point, m; 0 inside.
    pub fn distance_m(&self, head: &Point<Room>) -> f64 {
        self.surface.distance_m(head)
    }

    /// Angle between the view axis and the object, rad; 0 when the view ray hits its surface.
    pub fn angle_rad(&self, head: &Pose<Room>) -> f64 {
        self.surface.angle_rad(head)
    }
}

fn build_object(
    i: usize,
    object: &ObjectSpec,
    spec: &SceneSpec,
    problems: &mut Vec<SceneProblem>,
) -> Option<Object> {
    let part = ScenePart::Object(i);
    let before = problems.len();
    let position = object.position;
    if !(position.floor().is_finite() && position.z().is_finite() && object.yaw_rad.is_finite()) {
        problems.push(problem(
            part,
            "position",
            "a coordinate that is not finite".into(),
            "finite metres".into(),
        ));
    } else if spec.arena.depth_m(position.floor()) < 0.0 {
        let found = format!("({}, {}) m, outside the arena", position.x(), position.y());
        problems.push(problem(part, "position", found, "a place inside the arena".into()));
    } else if !(-1.0..=5.0).contains(&position.z()) {
        problems.push(problem(part, "position", format!("height {} m", position.z()), "-1 to 5 m".into()));
    }
    if !(0.0..=1.0).contains(&object.prior) {
        problems.push(problem(part, "prior", format!("{}", object.prior), "a number from 0 to 1".into()));
    }
    let offset = match object.prop.map(|prop| spec.props.get(prop)) {
        None => Planar::ZERO,
        Some(Some(prop)) => prop.offset,
        Some(None) => {
            problems.push(problem(
                part,
                "prop",
                "no such prop".into(),
                "the id of a prop of this scene".into(),
            ));
            Planar::ZERO
        }
    };
    let column_place = position.floor() - offset;
    let surface = Surface::build(object)
        .map_err(|(key, found, expected)| problems.push(problem(part, key, found, expected)))
        .ok()?;
    (problems.len() == before).then_some(Object { surface, column_place })
}

fn check_prop(part: ScenePart, prop: &PropSpec, problems: &mut Vec<SceneProblem>) {
    let near = |v: Planar, most: f64| v.x.is_finite() && v.y.is_finite() && v.norm() <= most;
    if !near(prop.offset, 2.0) {
        let found = format!("[{}, {}]", prop.offset.x, prop.offset.y);
        problems.push(problem(part, "offset", found, "at most 2 m from the column's centre".into()));
    }
    if !near(prop.size_m, 3.0) || prop.size_m.x < 0.0 || prop.size_m.y < 0.0 {
        let found = format!("[{}, {}]", prop.size_m.x, prop.size_m.y);
        problems.push(problem(part, "size", found, "two lengths from 0 to 3 m".into()));
    }
    if !prop.facing_rad.is_finite() {
        problems.push(problem(part, "facing", format!("{}", prop.facing_rad), "a finite heading".into()));
    }
}

fn check_shape(part: ScenePart, shape: &KeepOutShape, problems: &mut Vec<SceneProblem>) {
    match shape {
        KeepOutShape::Circle { centre, radius_m } => {
            if !centre.is_finite() {
                problems.push(problem(part, "shape.centre", "not finite".into(), "finite metres".into()));
            }
            if !(radius_m.is_finite() && (0.01..=50.0).contains(radius_m)) {
                problems.push(problem(part, "shape.radius", format!("{radius_m}"), "0.01 to 50 m".into()));
            }
        }
        KeepOutShape::Polygon { corners } => {
            if !(3..=32).contains(&corners.len()) {
                let found = format!("{} corners", corners.len());
                problems.push(problem(part, "shape.corners", found, "3 to 32 corners".into()));
            } else if corners.iter().any(|c| !c.is_finite()) || !footprint::is_convex(corners) {
                let found = "corners that are not convex".to_owned();
                problems.push(problem(part, "shape.corners", found, "a convex polygon, in order".into()));
            }
        }
    }
}

fn check_rectangle(
    part: ScenePart,
    key: &str,
    size: Planar,
    least: f64,
    most: f64,
    problems: &mut Vec<SceneProblem>,
) {
    let fits = |v: f64| v.is_finite() && (least..=most).contains(&v);
    if !(fits(size.x) && fits(size.y)) {
        let found = format!("{} x {} m", size.x, size.y);
        problems.push(problem(part, key, found, format!("{least} to {most} m along x and y")));
    }
}

/// The ids of objects and zones.
fn ids(spec: &SceneSpec) -> (Vec<&str>, Vec<&str>) {
    let objects = spec.objects.iter().map(|object| object.id.as_str());
    (objects.collect(), spec.zones.iter().map(|zone| zone.id.as_str()).collect())
}

fn build_scenario(spec: &SceneSpec, problems: &mut Vec<SceneProblem>) -> Option<Scenario> {
    let (objects, zones) = ids(spec);
    let built = Scenario::build(spec.scenario.as_ref()?, Names { objects: &objects, zones: &zones });
    built
        .map_err(|found| {
            problems.extend(found.into_iter().map(|p| SceneProblem {
                part: ScenePart::Scenario,
                key: p.path,
                found: p.found,
                expected: p.expected,
            }));
        })
        .ok()
}

fn check_ids(spec: &SceneSpec, problems: &mut Vec<SceneProblem>) {
    let groups: [Vec<(ScenePart, &str)>; 4] = [
        spec.props.iter().enumerate().map(|(i, p)| (ScenePart::Prop(i), p.id.as_str())).collect(),
        spec.objects.iter().enumerate().map(|(i, o)| (ScenePart::Object(i), o.id.as_str())).collect(),
        spec.keep_outs.iter().enumerate().map(|(i, k)| (ScenePart::KeepOut(i), k.id.as_str())).collect(),
        spec.zones.iter().enumerate().map(|(i, z)| (ScenePart::Zone(i), z.id.as_str())).collect(),
    ];
    for group in groups {
        let mut seen = HashMap::new();
        for (part, id) in group {
            if id.is_empty() || id.chars().count() > 64 {
                let found = format!("{} characters", id.chars().count());
                problems.push(problem(part, "id", found, "1 to 64 characters".into()));
            }
            if let Some(first) = seen.insert(id, part) {
                let found = format!("\"{id}\", already the id of {first}");
                problems.push(problem(part, "id", found, "an id of its own".into()));
            }
        }
    }
}

fn problem(part: ScenePart, key: &str, found: String, expected: String) -> SceneProblem {
    SceneProblem { part, key: key.to_owned(), found, expected }
}

const MOST_OBJECTS: usize = 500;

impl SceneSpec {
    /// An arena without props, keep-outs or scenario, and with the paper's 15 cm column: where replays and tests begin.
    pub fn open(arena: Travel, objects: Vec<ObjectSpec>) -> Self {
        Self {
            arena,
            column_size_m: Planar::new(0.15, 0.15),
            props: Vec::new(),
            objects,
            keep_outs: Vec::new(),
            zones: Vec::new(),
            scenario: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ball(id: &str, x: f64, y: f64) -> ObjectSpec {
        ObjectSpec {
            id: id.into(),
            position: Point::new(x, y, 1.0),
            yaw_rad: 0.0,
            shape: Shape::Sphere { radius_m: 0.1 },
            prop: None,
            prior: 1.0,
            enabled: true,
        }
    }

    fn arena() -> Travel {
        Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) }
    }

    #[test]
    fn the_column_stands_back_by_the_props_offset() {
        let mut spec = SceneSpec::open(arena(), vec![ball("a", 1.0, 2.0)]);
        spec.props.push(PropSpec {
            id: "chair".into(),
            offset: Planar::new(0.4, -0.1),
            facing_rad: 0.0,
            size_m: Planar::ZERO,
        });
        spec.objects[0].prop = Some(0);
        let scene = Scene::build(spec).unwrap();
        assert!(scene.objects()[0].column_place().distance_m(Floor::new(0.6, 2.1)) < 1e-12);
    }

    #[test]
    fn the_nearest_enabled_object_is_found_among_all() {
        let balls = (0..40).map(|i| {
            let (x, y) = (f64::from(i * 37 % 40) * 0.1, f64::from(i * 23 % 40) * 0.1);
            ObjectSpec { enabled: i % 5 != 0, ..ball(&format!("{i}"), x, y) }
        });
        let scene = Scene::build(SceneSpec::open(arena(), balls.collect())).unwrap();
        for k in 0..400 {
            let head = Point::new(f64::from(k % 20) * 0.2, f64::from(k / 20) * 0.2, 1.6);
            let all = scene.objects().iter().zip(&scene.spec().objects).filter(|(_, spec)| spec.enabled);
            let nearest = all.map(|(object, _)| object.distance_m(&head)).fold(f64::INFINITY, f64::min);
            assert_eq!(scene.nearest_enabled_object_m(&head), nearest);
        }
    }

    #[test]
    fn every_problem_is_reported_with_its_part() {
        let mut spec = SceneSpec::open(arena(), vec![ball("a", 1.0, 2.0), ball("a", 9.0, 2.0)]);
        spec.objects[0].prior = 1.5;
        spec.keep_outs.push(KeepOutSpec { id: "k".into(), shape: KeepOutShape::Polygon { corners: vec![] } });
        let problems = Scene::build(spec).unwrap_err();
        let found: Vec<String> = problems.iter().map(|p| format!("{}.{}", p.part, p.key)).collect();
        assert_eq!(
            found,
            ["objects[0].prior", "objects[1].position", "keep_outs[0].shape.corners", "objects[1].id",]
        );
    }
}
