//! Whether a machine can serve a scene: its column inside its travel, off keep-out shapes, inside the arena; and how long it needs.

use crate::frames::Floor;
use crate::machine::{Limits, Travel};
use crate::motion::travel_secs;
use crate::safety::parameters::Parameters;
use crate::scenario::Finding;
use crate::scene::{Object, Scene};

/// Objects that a machine of this travel cannot serve well, in the scene's order.
pub fn findings(scene: &Scene, travel: &Travel) -> Vec<Finding> {
    // The distances of the rules do not depend on v_h.
    let rules = Parameters::new(0.0);
    let inside = travel.shrunk(rules.travel_margin_m);
    let mut found = Vec::new();
    for (i, object) in scene.objects().iter().enumerate() {
        let place = object.column_place();
        let off_m = inside.clamped(place).distance_m(place);
        let mut add = |words: String| found.push(Finding { path: format!("objects[{i}]"), words });
        if off_m > SERVED_WITHIN_M {
            add(format!("never served: the column would have to stand {off_m:.2} m outside its travel"));
        } else if off_m > ROUNDING_M {
            add(format!("served {off_m:.2} m off: the column would have to stand outside its travel"));
        }
        for (keep_out, spec) in scene.keep_outs().iter().zip(&scene.spec().keep_outs) {
            let (distance_m, needed_m) = (keep_out.distance_m(scene.footprint(), place), rules.radius_m);
            if distance_m <= needed_m {
                let id = &spec.id;
                add(format!(
                    "the column may not stand there: {distance_m:.2} m from the keep-out shape \"{id}\", {needed_m:.2} m needed"
                ));
            }
        }
        let out_m = sticks_out_m(scene, place);
        if out_m > ROUNDING_M {
            add(format!("a part of the column would be {out_m:.2} m outside the arena"));
        }
    }
    found
}

/// How long the column needs from each object's place (row) to each other's (column), from rest at its limits, s.
pub fn serve_secs(scene: &Scene, limits: &Limits) -> Vec<Vec<f64>> {
    let places = || scene.objects().iter().map(Object::column_place);
    places().map(|from| places().map(|to| travel_secs(from, to, limits)).collect()).collect()
}

fn sticks_out_m(scene: &Scene, place: Floor) -> f64 {
    let arena = &scene.spec().arena;
    let outside = scene.footprint().rectangles().iter().flat_map(|r| {
        let (low, high) = (place + r.min, place + r.max);
        [arena.min.x - low.x, arena.min.y - low.y, high.x - arena.max.x, high.y - arena.max.y]
    });
    outside.fold(0.0, f64::max)
}

/// A prop nearer than this to its object serves it, m: as the evaluation has it.
const SERVED_WITHIN_M: f64 = 0.1;
/// Less than this is arithmetic, m.
const ROUNDING_M: f64 = 1e-6;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::{Planar, Point};
    use crate::scene::{KeepOutShape, KeepOutSpec, ObjectSpec, PropSpec, SceneSpec, Shape};

    #[test]
    fn what_the_machine_cannot_serve_is_found_with_its_distance() {
        let arena = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) };
        let ball = |id: &str, x: f64, y: f64, prop| ObjectSpec {
            id: id.into(),
            position: Point::new(x, y, 1.0),
            yaw_rad: 0.0,
            shape: Shape::Sphere { radius_m: 0.1 },
            prop,
            prior: 1.0,
            enabled: true,
        };
        let objects = vec![
            ball("good", 2.0, 2.0, None),
            ball("edge", 3.95, 1.0, None),
            ball("behind", 0.2, 1.0, Some(0)),
            ball("sofa", 2.0, 3.5, None),
        ];
        let mut spec = SceneSpec::open(arena, objects);
        let offset = Planar::new(0.5, 0.0);
        spec.props.push(PropSpec { id: "arm".into(), offset, facing_rad: 0.0, size_m: Planar::ZERO });
        let shape = KeepOutShape::Circle { centre: Floor::new(2.0, 3.902), radius_m: 0.1 };
        spec.keep_outs.push(KeepOutSpec { id: "sofa".into(), shape });
        let scene = Scene::build(spec).unwrap();
        let found: Vec<String> =
            findings(&scene, &arena).into_iter().map(|f| format!("{}: {}", f.path, f.words)).collect();
        assert_eq!(
            found,
            [
                "objects[1]: a part of the column would be 0.03 m outside the arena",
                "objects[2]: never served: the column would have to stand 0.32 m outside its travel",
                "objects[2]: a part of the column would be 0.38 m outside the arena",
                "objects[3]: the column may not stand there: 0.23 m from the keep-out shape \"sofa\", 0.35 m needed",
            ]
        );
        let secs = serve_secs(&scene, &Limits::PAPER);
        assert_eq!((secs[0][0], secs.len()), (0.0, 4));
        assert!((secs[0][1] - secs[1][0]).abs() < 1e-12 && secs[0][1] > 1.0);
    }
}
