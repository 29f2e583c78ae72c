//! What a scene is refused for, and what is worth a second look in it, has an id: each by a scene that says it.

use covr_engine::frames::Floor;
use covr_engine::machine::Travel;
use covr_wire::phrase::{Phrase, is_value};
use covr_wire::scene::{parse_scene, scene_warnings};
use serde_json::{Value, json};

const TRAVEL: Travel = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) };

fn base() -> Value {
    let ball = |id: &str, x: f64| json!({"id": id, "position": [x, 2, 1], "shape": {"kind": "sphere", "radius": 0.1}});
    json!({
        "schema": "covr.scene.v2",
        "name": "two balls",
        "arena": {"min": [0, 0], "max": [4, 4]},
        "objects": [ball("a", 1.0), ball("b", 3.0)],
        "keep_outs": [{"id": "sofa", "shape": {"kind": "circle", "centre": [2, 0.4], "radius": 0.2}}],
        "zones": [{"id": "mat", "shape": {"kind": "circle", "centre": [2, 2], "radius": 0.3}}],
        "scenario": {
            "initial": "one",
            "variables": [{"id": "n", "start": 0}, {"id": "lit", "start": false}],
            "states": [
                {"id": "one", "enabled": ["a", "b"], "priors": {"a": 0.5, "b": 0.5},
                 "transitions": [
                    {"on": [{"kind": "zone_entered", "zone": "mat"}], "to": "two",
                     "acts": [{"kind": "add", "variable": "n", "amount": 1}, {"kind": "set", "variable": "lit", "value": true}]}
                 ]},
                {"id": "two", "final": true}
            ]
        }
    })
}

fn changed(pointer: &str, to: Value) -> Value {
    let mut scene = base();
    let (parent, key) = pointer.rsplit_once('/').expect("a pointer");
    let parent = scene.pointer_mut(parent).expect("a part of the scene");
    match key.parse::<usize>() {
        Ok(index) => parent[index] = to,
        Err(_) => parent[key] = to,
    }
    scene
}

fn id(phrase: Option<&Phrase>, text: &str) -> String {
    assert!(phrase.is_some() || is_value(text), "wire/src/phrase/table.rs has no phrase for: {text}");
    phrase.map_or_else(|| "value".into(), |phrase| phrase.id.clone())
}

#[test]
fn what_a_scene_is_refused_for_has_an_id() {
    let shape = "/objects/0/shape";
    let way = "/scenario/states/0/transitions/0";
    let when = "/scenario/states/0/transitions/0/when";
    let flat = json!({"kind": "convex_mesh", "points": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]});
    let mesh = |triangles: Value| json!({"kind": "triangle_mesh", "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": triangles});
    let cases = [
        ("/objects/0/position", json!([9, 2, 1]), "outside_arena", "inside_arena"),
        ("/objects/0/position", json!([1, 2, 7]), "height_found", "metres_between"),
        ("/objects/1/id", json!("a"), "id_taken", "id_own"),
        ("/objects/1/prop", json!("arm"), "value", "prop_none"),
        ("/arena/max", json!([0.2, 4]), "size_found", "size_between"),
        (
            "/keep_outs/0/shape",
            json!({"kind": "polygon", "corners": [[0, 0], [1, 1], [1, 0], [0, 1]]}),
            "corners_not_convex",
            "corners_convex",
        ),
        (shape, flat, "points_flat", "points_span"),
        (shape, mesh(json!([[0, 1, 9]])), "vertex_found", "index_below"),
        (shape, mesh(json!([[0, 1, 1]])), "triangle_flat", "triangle_corners"),
        ("/scenario/initial", json!("nowhere"), "value", "state_of_scenario"),
        ("/scenario/states/0/enabled", json!(["a", "a", "b"]), "value", "object_once"),
        ("/scenario/states/0/enabled", json!(["c", "a", "b"]), "value", "object_of_scene"),
        ("/scenario/states/0/enabled", json!(["a"]), "prior_not_enabled", "object_enabled"),
        (
            "/scenario/states/0/priors/a",
            json!({"value": 0.5, "least": 0.7}),
            "prior_order_found",
            "prior_order",
        ),
        (
            "/scenario/states/1/transitions",
            json!([{"on": [{"kind": "cue", "name": "x"}], "to": "one"}]),
            "final_transitions",
            "final_none",
        ),
        (way, json!({"when": {"kind": "in_zone", "zone": "mat"}}), "neither_on_nor_to", "on_or_to"),
        (when, json!({"kind": "in_zone", "zone": "rug"}), "value", "zone_of_scene"),
        (
            when,
            json!({"kind": "variable", "variable": "m", "is": "==", "value": 1}),
            "value",
            "variable_of_scenario",
        ),
        (
            when,
            json!({"kind": "variable", "variable": "n", "is": "==", "value": true}),
            "value",
            "whole_as_variable",
        ),
        (
            when,
            json!({"kind": "variable", "variable": "lit", "is": "==", "value": 1}),
            "value",
            "yes_no_as_variable",
        ),
        (
            when,
            json!({"kind": "variable", "variable": "lit", "is": "<", "value": true}),
            "value",
            "equal_or_not",
        ),
        ("/scenario/states/0/transitions/0/acts/0/variable", json!("lit"), "value", "variable_number"),
        ("/scenario/states/0/transitions/0/acts/0/amount", json!(2_000_000), "value", "whole_between"),
        (way, json!({"to": "one"}), "cycle", "cycle_end"),
        (
            "/scenario/states/0/interactions",
            json!({"a": {"kind": "lead", "path": [[1, 1]], "speed": 2}}),
            "value",
            "number_between_of",
        ),
        ("/name", json!(""), "characters_found", "characters_between"),
        ("/objects/0/prior", json!(2), "value", "number_between"),
        ("/objects/0/enabled", json!(3), "whole_found", "yes_or_no"),
        ("/colour", json!("red"), "unknown_field", "one_of"),
    ];
    for (pointer, to, found, expected) in cases {
        let text = changed(pointer, to.clone()).to_string();
        let Err(errors) = parse_scene(text.as_bytes()) else { panic!("{pointer} = {to} passes") };
        let ids: Vec<_> = errors
            .iter()
            .map(|e| (id(e.found_as.as_deref(), &e.found), id(e.expected_as.as_deref(), &e.expected)))
            .collect();
        assert!(ids.contains(&(found.into(), expected.into())), "{pointer} = {to}: {ids:?} of {errors:?}");
    }
}

#[test]
fn what_is_worth_a_second_look_has_an_id() {
    let ways = "/scenario/states/0/transitions";
    let never = json!({"kind": "all", "conditions": [
        {"kind": "variable", "variable": "n", "is": "<", "value": 1},
        {"kind": "variable", "variable": "n", "is": ">", "value": 1}]});
    let entered = json!([{"kind": "zone_entered", "zone": "mat"}]);
    let touch = json!([{"kind": "touch_began", "object": "b"}]);
    let at_b = json!({"kind": "in_place", "object": "b"});
    let cases = [
        ("/arena/min", json!([-0.05, 0]), "served_off"),
        ("/arena/min", json!([-1, 0]), "never_served"),
        ("/props", json!([{"id": "arm", "offset": [2, 0], "size": [0.1, 0.1]}]), "sticks_out"),
        ("/objects/0/position", json!([2, 0.5, 1]), "near_keep_out"),
        ("/scenario/states/1", json!({"id": "two"}), "dead_end"),
        (ways, json!([]), "unreached"),
        (ways, json!([{"on": entered, "when": never, "to": "two"}]), "never_condition"),
        (ways, json!([{"on": entered, "to": "two"}, {"to": "two"}]), "never_left_before"),
        (ways, json!([{"on": entered, "to": "two"}, {"on": entered, "to": "two"}]), "never_covered"),
        (ways, json!([{"to": "two"}]), "always_state"),
        ("/objects/0/enabled", json!(false), "switched_off"),
        ("/scenario/states/0/priors", json!({"a": 0, "b": 0}), "priors_zero"),
        ("/scenario/states/0/priors", json!({"a": 0.5, "b": 0.4}), "priors_sum"),
        (ways, json!([{"on": entered, "to": "two"}]), "variable_constant"),
        (
            "/scenario/states/0",
            json!({"id": "one", "enabled": ["a"], "transitions": [{"on": touch, "to": "two"}]}),
            "waits_touch_here",
        ),
        (
            "/scenario/states/0",
            json!({"id": "one", "enabled": ["a"], "transitions": [{"when": at_b, "to": "two"}]}),
            "waits_column_here",
        ),
        (
            "/scenario/states/0",
            json!({"id": "one", "enabled": ["a"], "transitions": [{"to": "two"}]}),
            "object_unused",
        ),
        (ways, json!([{"to": "two"}]), "zone_unused"),
    ];
    for (pointer, to, expected) in cases {
        let mut scene = changed(pointer, to.clone());
        if pointer == "/props" {
            scene["objects"][0]["prop"] = json!("arm");
            scene["objects"][0]["position"] = json!([2.5, 2, 1]);
            scene["column"] = json!({"size": [2, 2]});
        }
        if pointer == "/arena/min" {
            scene["objects"][0]["position"] = json!([to[0], 2, 1]);
        }
        let text = scene.to_string();
        let (_, built) =
            parse_scene(text.as_bytes()).unwrap_or_else(|errors| panic!("{pointer} = {to}: {errors:?}"));
        let warnings = scene_warnings(text.as_bytes(), &built, &TRAVEL);
        let ids: Vec<_> = warnings.iter().map(|w| id(w.found_as.as_deref(), &w.found)).collect();
        assert!(ids.iter().any(|known| known == expected), "{pointer} = {to}: {ids:?} of {warnings:?}");
        assert!(!ids.contains(&"value".to_owned()), "{warnings:?}");
    }
}
