//! Scenes from outside: the examples build, the schema and the parser agree, and every problem is named at its place.

use std::path::Path;

use covr_engine::frames::Floor;
use covr_engine::machine::Travel;
use covr_wire::phrase::is_value;
use covr_wire::scene::{MAX_SCENE_BYTES, SCHEMA, SceneError, parse_scene, scene_schema, scene_warnings};
use proptest::prelude::*;
use serde_json::{Value, json};

const TRAVEL: Travel = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) };
const EXAMPLES: [&str; 6] =
    ["demo.json", "kitchen.json", "paper-demo.json", "gallery.json", "escape-room.json", "clouds.json"];

fn example(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../deploy/scenes").join(name);
    std::fs::read_to_string(path).expect("an example scene")
}

fn errors(scene: &Value) -> Vec<SceneError> {
    let errors = parse_scene(scene.to_string().as_bytes()).err().unwrap_or_default();
    errors.iter().for_each(check_phrases);
    errors
}

/// What is said has an id, so that a page can say it in another language.
fn check_phrases(error: &SceneError) {
    let parts = [(&error.found, &error.found_as), (&error.expected, &error.expected_as)];
    for (text, phrase) in parts {
        assert!(phrase.is_some() || is_value(text), "wire/src/phrase/table.rs has no phrase for: {text}");
    }
}

fn changed(mut scene: Value, pointer: &str, to: Value) -> Value {
    *scene.pointer_mut(pointer).expect("a field of the scene") = to;
    scene
}

fn small() -> Value {
    json!({
        "schema": "covr.scene.v2",
        "name": "every shape",
        "arena": {"min": [0, 0], "max": [4, 4]},
        "column": {"size": [0.2, 0.2]},
        "props": [{"id": "p", "offset": [0.1, 0], "facing": 0, "size": [0, 0]}],
        "objects": [
            {"id": "a", "position": [1, 1, 1], "yaw": 0, "shape": {"kind": "sphere", "radius": 0.1}, "prop": "p", "prior": 0.5, "enabled": true},
            {"id": "b", "position": [2, 1, 1], "shape": {"kind": "box", "size": [1, 1, 1]}},
            {"id": "c", "position": [3, 1, 1], "shape": {"kind": "cylinder", "radius": 0.1, "height": 1}},
            {"id": "d", "position": [1, 3, 1], "shape": {"kind": "convex_mesh", "points": [[0,0,0],[1,0,0],[0,1,0],[0,0,1]]}},
            {"id": "e", "position": [2, 3, 1], "shape": {"kind": "triangle_mesh", "vertices": [[0,0,0],[1,0,0],[0,1,0]], "triangles": [[0,1,2]]}}
        ],
        "keep_outs": [
            {"id": "x", "shape": {"kind": "circle", "centre": [3, 3], "radius": 0.2}},
            {"id": "y", "shape": {"kind": "polygon", "corners": [[0,0],[1,0],[0,1]]}}
        ],
        "zones": [{"id": "z", "shape": {"kind": "circle", "centre": [3, 3], "radius": 0.2}}],
        "scenario": {
            "initial": "one",
            "variables": [{"id": "n", "start": 0}, {"id": "yes", "start": false}],
            "states": [
                {
                    "id": "one", "label": "first", "note": "look", "enabled": ["a", "b"],
                    "priors": {"a": 0.5, "b": {"value": 0.5, "per_s": 0.1, "per_touch": -0.1, "least": 0.1, "most": 0.9}},
                    "entry": [{"kind": "set", "variable": "yes", "value": true}, {"kind": "add", "variable": "n", "amount": 1}],
                    "transitions": [
                        {"label": "on", "on": [
                            {"kind": "touch_began", "object": "a"}, {"kind": "touch_ended", "object": "a"},
                            {"kind": "zone_entered", "zone": "z"}, {"kind": "zone_left", "zone": "z"},
                            {"kind": "client_event", "name": "e"}, {"kind": "cue", "name": "c"}
                        ], "to": "two"},
                        {"when": {"kind": "all", "conditions": [
                            {"kind": "touching", "object": "a", "secs": 2},
                            {"kind": "any", "conditions": [{"kind": "in_zone", "zone": "z"}, {"kind": "looks_at", "object": "b"}]},
                            {"kind": "not", "condition": {"kind": "in_place", "object": "a"}},
                            {"kind": "variable", "variable": "n", "is": ">=", "value": 1},
                            {"kind": "time_in_state", "secs": 1}
                        ]}, "to": "two"}
                    ]
                },
                {"id": "two", "final": true}
            ],
            "anywhere": [{"on": [{"kind": "cue", "name": "back"}], "to": "one"}]
        }
    })
}

#[test]
fn the_example_scenes_build() {
    for name in EXAMPLES {
        let (document, scene) = parse_scene(example(name).as_bytes()).unwrap_or_else(|errors| {
            panic!("{name}: {}", errors.iter().map(|e| format!("{e}\n")).collect::<String>())
        });
        assert_eq!(document.objects.len(), scene.spec().objects.len());
        for (object, spec) in document.objects.iter().zip(&scene.spec().objects) {
            let offset = spec.prop.map_or([0.0; 2], |prop| document.props[prop].offset);
            for (centre, offset) in object.position.iter().zip(offset) {
                let place = centre - offset;
                assert!((0.3..=3.7).contains(&place), "{name}: the column serves {} at {place}", object.id);
            }
        }
    }
}

#[test]
fn the_examples_show_every_shape_and_the_papers_counts() {
    let texts = EXAMPLES.map(example);
    for kind in ["sphere", "box", "cylinder", "convex_mesh", "triangle_mesh"] {
        assert!(texts[1].contains(&format!("\"{kind}\"")), "{kind}");
    }
    for kind in ["circle", "polygon"] {
        assert!(texts[3].contains(&format!("\"{kind}\"")), "{kind}");
    }
    let (paper, _) = parse_scene(texts[2].as_bytes()).expect("a good scene");
    assert_eq!((paper.objects.len(), paper.props.len()), (7, 5));
}

#[test]
fn a_document_written_and_read_again_is_the_same() {
    for name in EXAMPLES {
        let (document, _) = parse_scene(example(name).as_bytes()).expect("a good scene");
        let text = serde_json::to_vec(&document).expect("a document can be written");
        assert_eq!(parse_scene(&text).expect("a good scene").0, document);
    }
}

/// Changes that the schema can see: it must refuse what the parser refuses, at the same path.
fn structural() -> Vec<(&'static str, Value, &'static str)> {
    vec![
        ("/schema", json!("covr.scene.v3"), "$.schema"),
        ("/name", json!(""), "$.name"),
        ("/name", json!("x".repeat(81)), "$.name"),
        ("/name", json!(7), "$.name"),
        ("/arena/min/0", json!(-101), "$.arena.min[0]"),
        ("/arena/max", json!([4]), "$.arena.max"),
        ("/column/size/1", json!(0), "$.column.size[1]"),
        ("/props/0/id", json!(""), "$.props[0].id"),
        ("/props/0/offset/0", json!(2.5), "$.props[0].offset[0]"),
        ("/props/0/facing", json!(90), "$.props[0].facing"),
        ("/props/0/size/0", json!(-0.1), "$.props[0].size[0]"),
        ("/objects", json!([]), "$.objects"),
        ("/objects/0/position/2", json!("high"), "$.objects[0].position[2]"),
        ("/objects/0/yaw", json!(180), "$.objects[0].yaw"),
        ("/objects/0/prior", json!(1.5), "$.objects[0].prior"),
        ("/objects/0/prior", json!(-0.1), "$.objects[0].prior"),
        ("/objects/0/enabled", json!("yes"), "$.objects[0].enabled"),
        ("/objects/0/shape/radius", json!(0), "$.objects[0].shape.radius"),
        ("/objects/0/shape/radius", json!("big"), "$.objects[0].shape.radius"),
        ("/objects/0/shape/kind", json!("blob"), "$.objects[0].shape.kind"),
        ("/objects/1/shape/size/2", json!(51), "$.objects[1].shape.size[2]"),
        ("/objects/2/shape/height", json!(null), "$.objects[2].shape.height"),
        ("/objects/3/shape/points", json!([[0, 0, 0]]), "$.objects[3].shape.points"),
        ("/objects/3/shape/points/1/2", json!(60), "$.objects[3].shape.points[1][2]"),
        ("/objects/4/shape/triangles", json!([]), "$.objects[4].shape.triangles"),
        ("/objects/4/shape/triangles/0/1", json!(-1), "$.objects[4].shape.triangles[0][1]"),
        ("/keep_outs/0/shape/radius", json!(0.001), "$.keep_outs[0].shape.radius"),
        ("/keep_outs/1/shape/corners", json!([[0, 0], [1, 0]]), "$.keep_outs[1].shape.corners"),
        ("/keep_outs/1/shape/corners/2/1", json!(400), "$.keep_outs[1].shape.corners[2][1]"),
        ("/zones/0/id", json!(""), "$.zones[0].id"),
        ("/zones/0/shape/radius", json!(0.001), "$.zones[0].shape.radius"),
        ("/scenario/initial", json!(3), "$.scenario.initial"),
        ("/scenario/states", json!([]), "$.scenario.states"),
        ("/scenario/variables/0/start", json!(1.5), "$.scenario.variables[0].start"),
        ("/scenario/variables/0/start", json!(2_000_000), "$.scenario.variables[0].start"),
        ("/scenario/states/0/id", json!("x".repeat(65)), "$.scenario.states[0].id"),
        ("/scenario/states/0/label", json!("x".repeat(81)), "$.scenario.states[0].label"),
        ("/scenario/states/0/enabled", json!("a"), "$.scenario.states[0].enabled"),
        ("/scenario/states/0/priors/a", json!("likely"), "$.scenario.states[0].priors.a"),
        ("/scenario/states/0/priors/b/per_s", json!(2), "$.scenario.states[0].priors.b.per_s"),
        ("/scenario/states/0/priors/b/value", json!(null), "$.scenario.states[0].priors.b.value"),
        ("/scenario/states/0/entry/0/kind", json!("shout"), "$.scenario.states[0].entry[0].kind"),
        ("/scenario/states/0/entry/1/amount", json!(0.5), "$.scenario.states[0].entry[1].amount"),
        (
            "/scenario/states/0/transitions/0/on/4/name",
            json!(""),
            "$.scenario.states[0].transitions[0].on[4].name",
        ),
        (
            "/scenario/states/0/transitions/0/on/0/kind",
            json!("kick"),
            "$.scenario.states[0].transitions[0].on[0].kind",
        ),
        ("/scenario/states/0/transitions/0/to", json!(["two"]), "$.scenario.states[0].transitions[0].to"),
        (
            "/scenario/states/0/transitions/1/when/conditions",
            json!([]),
            "$.scenario.states[0].transitions[1].when.conditions",
        ),
        (
            "/scenario/states/0/transitions/1/when/conditions/0/secs",
            json!(4000),
            "$.scenario.states[0].transitions[1].when.conditions[0].secs",
        ),
        (
            "/scenario/states/0/transitions/1/when/conditions/1/conditions/0/kind",
            json!("near"),
            "$.scenario.states[0].transitions[1].when.conditions[1].conditions[0].kind",
        ),
        (
            "/scenario/states/0/transitions/1/when/conditions/2/condition",
            json!(null),
            "$.scenario.states[0].transitions[1].when.conditions[2].condition",
        ),
        (
            "/scenario/states/0/transitions/1/when/conditions/3/is",
            json!("=>"),
            "$.scenario.states[0].transitions[1].when.conditions[3].is",
        ),
        ("/scenario/anywhere/0/on/0", json!("cue"), "$.scenario.anywhere[0].on[0]"),
    ]
}

#[test]
fn schema_and_parser_refuse_alike_and_the_parser_says_where() {
    let schema = jsonschema::draft202012::new(&scene_schema()).expect("a good schema");
    assert!(schema.is_valid(&small()));
    assert_eq!(errors(&small()), []);
    for (pointer, to, path) in structural() {
        let scene = changed(small(), pointer, to.clone());
        assert!(!schema.is_valid(&scene), "the schema lets {pointer} = {to} through");
        let errors = errors(&scene);
        assert_eq!(errors.first().map(|e| e.path.as_str()), Some(path), "{pointer} = {to}: {errors:?}");
        assert_eq!(errors.iter().filter(|e| e.path == path).count(), 1, "said once: {errors:?}");
        assert!(errors.iter().all(|e| e.line == Some(1) && e.column.is_some()), "{errors:?}");
    }
}

#[test]
fn schema_and_parser_refuse_fields_that_nobody_knows_and_miss_those_due() {
    let schema = jsonschema::draft202012::new(&scene_schema()).expect("a good schema");
    let parents = [
        "",
        "/arena",
        "/column",
        "/props/0",
        "/objects/0",
        "/objects/0/shape",
        "/keep_outs/0",
        "/keep_outs/0/shape",
        "/zones/0",
        "/scenario",
        "/scenario/variables/0",
        "/scenario/states/0",
        "/scenario/states/0/priors/b",
        "/scenario/states/0/entry/0",
        "/scenario/states/0/transitions/0",
        "/scenario/states/0/transitions/0/on/0",
        "/scenario/states/0/transitions/1/when",
        "/scenario/states/0/transitions/1/when/conditions/2",
    ];
    for parent in parents {
        let mut scene = small();
        scene.pointer_mut(parent).expect("a part")["colour"] = json!("red");
        assert!(!schema.is_valid(&scene), "{parent}");
        let error = errors(&scene).remove(0);
        assert!(error.found.contains("colour") && error.expected.contains('`'), "{error}");
    }
    for (parent, key, path) in [
        ("", "schema", "$.schema"),
        ("/arena", "max", "$.arena.max"),
        ("/objects/2", "position", "$.objects[2].position"),
        ("/objects/2/shape", "height", "$.objects[2].shape.height"),
        ("/objects/2/shape", "kind", "$.objects[2].shape.kind"),
        ("/keep_outs/0/shape", "centre", "$.keep_outs[0].shape.centre"),
        ("/scenario", "initial", "$.scenario.initial"),
        ("/scenario/states/0/entry/1", "amount", "$.scenario.states[0].entry[1].amount"),
        (
            "/scenario/states/0/transitions/1/when/conditions/4",
            "secs",
            "$.scenario.states[0].transitions[1].when.conditions[4].secs",
        ),
    ] {
        let mut scene = small();
        scene.pointer_mut(parent).and_then(Value::as_object_mut).expect("a part").remove(key);
        assert!(!schema.is_valid(&scene), "{path}");
        let error = errors(&scene).remove(0);
        assert_eq!((error.path.as_str(), error.found.as_str()), (path, "nothing"));
    }
    let mut scene = small();
    for of_another_kind in [json!(1), json!(null)] {
        scene["objects"][0]["shape"]["height"] = of_another_kind;
        assert!(!schema.is_valid(&scene));
        assert_eq!(errors(&scene).len(), 1);
    }
}

#[test]
fn the_schema_accepts_the_examples() {
    let schema = scene_schema();
    assert_eq!(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
    let schema = jsonschema::draft202012::new(&schema).expect("a good schema");
    for name in EXAMPLES {
        let scene: Value = serde_json::from_str(&example(name)).expect("JSON");
        let complaints: Vec<_> = schema.iter_errors(&scene).map(|e| e.to_string()).collect();
        assert!(complaints.is_empty(), "{name}: {complaints:?}");
    }
}

#[test]
fn everything_wrong_with_a_scene_is_said_at_once_with_its_line() {
    let text = r#"{
  "schema": "covr.scene.v1",
  "name": "two mistakes and more",
  "arena": {"min": [0, 0], "max": [4, 4]},
  "objects": [
    {"id": "a", "position": [1, 1, 1], "shape": {"kind": "sphere", "radius": -1}},
    {"id": "a", "position": [9, 1, 1], "prop": "nowhere",
     "shape": {"kind": "triangle_mesh", "vertices": [[0,0,0],[1,0,0],[0,1,0]], "triangles": [[0,1,7]]}}
  ]
}"#;
    let errors = parse_scene(text.as_bytes()).expect_err("a bad scene");
    let said = |path: &str| {
        let error = errors.iter().find(|e| e.path == path).unwrap_or_else(|| panic!("{path} in {errors:?}"));
        (error.line, error.to_string())
    };
    assert_eq!(
        said("$.objects[0].shape.radius"),
        (
            Some(6),
            "line 6, column 78: $.objects[0].shape.radius: found -1, expected a number from 0.001 to 50"
                .into()
        )
    );
    assert_eq!(said("$.objects[1].id").0, Some(7));
    assert_eq!(said("$.objects[1].position").0, Some(7));
    assert!(said("$.objects[1].prop").1.contains("found \"nowhere\", expected a prop of this scene"));
    assert_eq!(said("$.objects[1].shape.triangles").0, Some(8));
    assert_eq!(errors.len(), 5, "{errors:?}");
}

#[test]
fn a_scene_of_the_version_before_is_read_as_one_of_this() {
    let mut old = small();
    old["schema"] = json!("covr.scene.v1");
    for since_then in ["zones", "scenario"] {
        old.as_object_mut().expect("an object").remove(since_then);
    }
    let (document, scene) = parse_scene(old.to_string().as_bytes()).expect("a scene of before");
    assert_eq!((document.schema.as_str(), scene.scenario()), (SCHEMA, None));
    let written = serde_json::to_value(&document).expect("it can be written");
    assert_eq!(written["schema"], SCHEMA);
    assert!(jsonschema::draft202012::new(&scene_schema()).expect("a good schema").is_valid(&old));
}

#[test]
fn what_is_worth_a_second_look_is_told_with_its_line() {
    let text = small().to_string();
    let (_, scene) = parse_scene(text.as_bytes()).expect("a good scene");
    let warnings = scene_warnings(text.as_bytes(), &scene, &TRAVEL);
    let told: Vec<_> = warnings.iter().map(|w| (w.line, w.path.as_str(), w.found.as_str())).collect();
    assert_eq!(
        told,
        [
            (Some(1), "$.scenario.states", "no state enables the object \"c\""),
            (Some(1), "$.scenario.states", "no state enables the object \"d\""),
            (Some(1), "$.scenario.states", "no state enables the object \"e\""),
        ]
    );
    let escape = example("escape-room.json");
    let (_, scene) = parse_scene(escape.as_bytes()).expect("a good scene");
    let found: Vec<_> =
        scene_warnings(escape.as_bytes(), &scene, &TRAVEL).into_iter().map(|w| w.path).collect();
    assert_eq!(found, ["$.scenario.states[3].transitions[0].when"; 0], "the example has nothing to look at");
}

#[test]
fn text_that_is_no_json_is_refused_with_line_and_column() {
    let error = parse_scene(b"{\n  \"schema\": \"covr.scene.v1\",\n  \"name\" \"x\"\n}")
        .expect_err("no JSON")
        .remove(0);
    assert_eq!((error.line, error.column), (Some(3), Some(10)));
    assert!(error.expected.contains("JSON"), "{error}");
    for text in [&b""[..], b"[]", b"{}", b"\xff\xfe", b"{} {}"] {
        assert_eq!(parse_scene(text).expect_err("no scene").len(), 1);
    }
    let long = parse_scene(&vec![b' '; MAX_SCENE_BYTES + 1]).expect_err("too long").remove(0);
    assert_eq!((long.path.as_str(), long.found.as_str()), ("$", "4194305 bytes"));
}

#[test]
fn a_scene_with_an_error_in_each_vertex_is_answered_in_time() {
    let vertices: Vec<_> = (0..50_000).map(|_| json!([99, 99, 99])).collect();
    let scene = changed(small(), "/objects/4/shape/vertices", json!(vertices));
    assert_eq!(errors(&scene).len(), 100);
}

proptest! {
    #[test]
    fn damaged_scenes_are_refused_or_build(at in any::<prop::sample::Index>(), byte: u8, cut: bool) {
        let mut text = small().to_string().into_bytes();
        let place = at.index(text.len());
        if cut { text.truncate(place) } else { text[place] = byte }
        if let Err(errors) = parse_scene(&text) {
            prop_assert!(!errors.is_empty());
            errors.iter().for_each(check_phrases);
            prop_assert!(errors.iter().all(|e| e.path.starts_with('$') && !e.found.is_empty()));
        }
    }
}
