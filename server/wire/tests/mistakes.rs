//! Twelve planted mistakes at a time: each is found, at its place in the JSON and in plain words.

use covr_engine::frames::Floor;
use covr_engine::machine::Travel;
use covr_wire::scene::{parse_scene, scene_warnings};

const TRAVEL: Travel = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) };

#[test]
fn twelve_mistakes_in_a_scenario_are_said_at_once_each_with_its_line() {
    let text = r#"{
  "schema": "covr.scene.v2",
  "name": "mistakes in a scenario",
  "arena": {"min": [0, 0], "max": [4, 4]},
  "objects": [
    {"id": "a", "position": [1, 1, 1], "shape": {"kind": "sphere", "radius": 0.1}},
    {"id": "b", "position": [2, 1, 1], "shape": {"kind": "sphere", "radius": 0.1}}
  ],
  "zones": [{"id": "mat", "shape": {"kind": "circle", "centre": [1, 1], "radius": 0.3}}],
  "scenario": {
    "initial": "nowhere",
    "variables": [{"id": "n", "start": 0}],
    "states": [
      {"id": "one", "enabled": ["c"],
       "priors": {"b": 0.4},
       "interactions": {"a": {"kind": "lead", "path": [[1, 1]], "speed": 2}},
       "transitions": [
         {"when": {"kind": "in_zone", "zone": "rug"}, "to": "two"},
         {"when": {"kind": "variable", "variable": "n", "is": "==", "value": true}, "to": "one"}
       ]},
      {"id": "one", "final": true,
       "entry": [{"kind": "add", "variable": "m", "amount": 1}],
       "transitions": [
         {"on": [{"kind": "touch_began", "object": "z"}], "when": {"kind": "time_in_state", "secs": 9999}, "to": "one"}
       ]}
    ]
  }
}"#;
    let errors = parse_scene(text.as_bytes()).expect_err("a bad scene");
    let said: Vec<_> = errors
        .iter()
        .map(|e| format!("{} {}: {}, not {}", e.line.unwrap_or(0), e.path, e.found, e.expected))
        .collect();
    assert_eq!(
        said,
        [
            "21 $.scenario.states[1].id: \"one\", already the id of states[0], not an id of its own",
            "11 $.scenario.initial: \"nowhere\", not a state of this scenario: \"one\", \"one\"",
            "14 $.scenario.states[0].enabled[0]: \"c\", not an object of this scene: \"a\", \"b\"",
            "15 $.scenario.states[0].priors.b: a prior of an object that is not enabled here, not an object of this state's `enabled`",
            "16 $.scenario.states[0].interactions.a.speed: 2, not a number from 0.05 to 0.6 m/s (R14)",
            "18 $.scenario.states[0].transitions[0].when.zone: \"rug\", not a zone of this scene: \"mat\"",
            "18 $.scenario.states[0].transitions[0].to: \"two\", not a state of this scenario: \"one\", \"one\"",
            "19 $.scenario.states[0].transitions[1].when.value: true, not a whole number, as the variable is",
            "22 $.scenario.states[1].entry[0].variable: \"m\", not a variable of this scenario: \"n\"",
            "24 $.scenario.states[1].transitions[0].on[0].object: \"z\", not an object of this scene: \"a\", \"b\"",
            "24 $.scenario.states[1].transitions[0].when.secs: 9999, not a number from 0 to 3600",
            "23 $.scenario.states[1].transitions: 1 transitions, not none: the scenario ends in a final state",
        ]
    );
}

/// What a scene can be played with all the same, and nobody means: the check finds it before anybody wears a headset.
#[test]
fn twelve_mistakes_in_a_scene_that_can_be_played_are_found_each_with_its_line() {
    let text = r#"{
  "schema": "covr.scene.v2",
  "name": "mistakes that can be played",
  "arena": {"min": [-1, 0], "max": [4, 4]},
  "objects": [
    {"id": "good", "position": [1, 1, 1], "shape": {"kind": "sphere", "radius": 0.1}},
    {"id": "outside", "position": [-0.8, 1, 1], "shape": {"kind": "sphere", "radius": 0.1}},
    {"id": "in_sofa", "position": [3, 3, 1], "shape": {"kind": "sphere", "radius": 0.1}},
    {"id": "at_wall", "position": [3.97, 1, 1], "shape": {"kind": "sphere", "radius": 0.1}},
    {"id": "off", "position": [2, 1, 1], "shape": {"kind": "sphere", "radius": 0.1}, "enabled": false}
  ],
  "keep_outs": [{"id": "sofa", "shape": {"kind": "circle", "centre": [3, 3.3], "radius": 0.2}}],
  "zones": [{"id": "mat", "shape": {"kind": "circle", "centre": [2, 2], "radius": 0.3}}],
  "scenario": {
    "initial": "one",
    "variables": [{"id": "n", "start": 0}],
    "states": [
      {"id": "one", "enabled": ["good", "in_sofa", "off"],
       "priors": {"good": 0.5, "in_sofa": 0.2, "off": 0.1},
       "transitions": [
         {"on": [{"kind": "touch_began", "object": "outside"}], "to": "two"},
         {"on": [{"kind": "cue", "name": "on"}], "when": {"kind": "variable", "variable": "n", "is": ">", "value": 3}, "to": "two"},
         {"on": [{"kind": "cue", "name": "go"}], "to": "two"},
         {"on": [{"kind": "cue", "name": "go"}], "to": "three"}
       ]},
      {"id": "two", "enabled": ["outside", "at_wall"], "priors": {"outside": 0, "at_wall": 0}},
      {"id": "three", "transitions": [{"to": "four"}]},
      {"id": "four", "final": true}
    ]
  }
}"#;
    let (_, scene) = parse_scene(text.as_bytes()).expect("it can be played");
    let found: Vec<_> = scene_warnings(text.as_bytes(), &scene, &TRAVEL)
        .iter()
        .map(|w| format!("{} {}: {}", w.line.unwrap_or(0), w.path, w.found))
        .collect();
    let planted = [
        "7 $.objects[1]: never served: the column would have to stand",
        "8 $.objects[2]: the column may not stand there:",
        "9 $.objects[3]: a part of the column would be",
        "18 $.scenario.states[0].enabled: the scene has \"off\" switched off",
        "19 $.scenario.states[0].priors: the priors add up to 0.80 and not to 1",
        "21 $.scenario.states[0].transitions[0].on[0]: waits for a touch of \"outside\", which is not enabled here",
        "22 $.scenario.states[0].transitions[1]: never taken: its condition can never hold",
        "24 $.scenario.states[0].transitions[3]: never taken: a way before it is always taken for the same event",
        "26 $.scenario.states[1]: nothing leads on from the state \"two\"",
        "26 $.scenario.states[1].priors: every prior is 0",
        "27 $.scenario.states[2]: nothing leads to the state \"three\"",
        "27 $.scenario.states[2].transitions[0]: always taken at once: the state \"three\" does not last",
    ];
    for mistake in planted {
        assert_eq!(
            found.iter().filter(|said| said.starts_with(mistake)).count(),
            1,
            "{mistake} in {found:#?}"
        );
    }
    let beside = [
        "nothing leads to the state \"four\"",
        "nothing ever changes \"n\"",
        "nothing waits for the zone \"mat\"",
    ];
    assert_eq!(found.len(), planted.len() + beside.len(), "{found:#?}");
    for said in beside {
        assert!(found.iter().any(|known| known.contains(said)), "{said} in {found:#?}");
    }
}
