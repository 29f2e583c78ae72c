//! A small state: for the examples of the published contract, and for the tests of this crate.

use covr_engine::frames::{Floor, Planar, Point, Pose};
use covr_engine::mode::{Mode, RequestKind};
use covr_engine::observation::PersonId;
use covr_engine::reason::Reason;
use covr_engine::safety::separation::Terms;
use covr_engine::scenario::Value;
use covr_engine::scene::Scene;
use covr_engine::snapshot::{
    Activity, ColumnState, ContactState, InteractionState, NextState, ObjectState, PersonState, RuleId,
    RuleState, RuleStatus, ScenarioState, Snapshot, StopCause,
};
use covr_engine::time::Time;
use nalgebra::UnitQuaternion;

use crate::dashboard::ControlLoop;
use crate::reason::Reason as WireReason;
use crate::scene::{SceneDocument, build_scene, parse_scene};

pub(crate) const SCENE: &str = r#"{
  "schema": "covr.scene.v2",
  "name": "two things",
  "arena": {"min": [0, 0], "max": [4, 4]},
  "props": [{"id": "handle", "offset": [0.1, 0]}],
  "objects": [
    {"id": "kettle", "position": [1, 3, 1.1], "yaw": 0.7, "prop": "handle",
     "shape": {"kind": "cylinder", "radius": 0.1, "height": 0.25}},
    {"id": "lamp", "position": [3, 3, 1.4], "shape": {"kind": "sphere", "radius": 0.15}}
  ],
  "keep_outs": [{"id": "sofa", "shape": {"kind": "circle", "centre": [0.5, 0.5], "radius": 0.3}}],
  "zones": [{"id": "mat", "label": "door mat", "shape": {"kind": "circle", "centre": [3, 1], "radius": 0.4}}],
  "scenario": {
    "initial": "arrival",
    "variables": [{"id": "cups", "start": 0}, {"id": "hot", "start": false}],
    "states": [
      {"id": "arrival", "label": "Somebody comes in",
       "transitions": [{"on": [{"kind": "zone_entered", "zone": "mat"}, {"kind": "cue", "name": "begin"}], "to": "tea"}]},
      {"id": "tea", "label": "The kettle boils", "enabled": ["kettle", "lamp"],
       "priors": {"kettle": {"value": 0.8, "per_touch": -0.2, "least": 0.2}, "lamp": 0.2},
       "entry": [{"kind": "set", "variable": "hot", "value": true}],
       "transitions": [
         {"when": {"kind": "touching", "object": "kettle", "secs": 10}, "to": "light",
          "acts": [{"kind": "add", "variable": "cups", "amount": 1}]}]},
      {"id": "light", "label": "Lights out", "enabled": ["lamp"], "final": true}
    ],
    "anywhere": [
      {"on": [{"kind": "client_event", "name": "spilled"}],
       "when": {"kind": "variable", "variable": "hot", "is": "==", "value": true}, "to": "arrival"}]
  }
}"#;

pub(crate) fn document() -> SceneDocument {
    // A constant; the tests of `examples` read it.
    parse_scene(SCENE.as_bytes()).expect("the sample is a good scene").0
}

pub(crate) fn scene() -> Scene {
    build_scene(&document()).expect("the sample is a good scene")
}

pub(crate) fn control_loop() -> ControlLoop {
    ControlLoop {
        rate_hz: 250.0,
        steps: 10,
        missed_deadlines: 0,
        lateness_p99_micros: 80.0,
        lateness_max_micros: 120.0,
        scheduling: WireReason::RealTimeNotAsked.to_string(),
        scheduling_why: vec![WireReason::RealTimeNotAsked],
    }
}

/// In a protective stop; person 3 looks half a radian to the left and a quarter up; person 8 has sent no pose.
pub(crate) fn snapshot() -> Snapshot {
    let at = Time::from_micros(7_000_000);
    let person = |id, pose| PersonState {
        person: PersonId(id),
        pose,
        pose_age_secs: 0.6,
        tracked: true,
        awaits_confirmation: false,
        separation_radius_m: 0.35,
        distance_m: 1.2,
        required_m: 1.0,
        separation: pose.map(|_| Terms {
            radius_m: 0.35,
            reaction_m: 0.1,
            braking_m: 0.15,
            walking_m: 0.3,
            age_m: 0.1,
        }),
        limits_column: pose.is_some(),
    };
    let object = |id: &str, probability, touch_secs| ObjectState {
        id: id.into(),
        weight: probability,
        probability,
        prior: 1.0,
        enabled: true,
        column_place: Floor::new(if id == "kettle" { 0.9 } else { 3.0 }, 3.0),
        arrival_secs: 2.0,
        touch_secs,
        late_by_secs: touch_secs.map(|touch| 2.0 - touch),
        in_time_probability: touch_secs.map(|_| 0.25),
        offset: touch_secs.map(|_| Planar::new(0.01, 0.02)),
        angle_rad: touch_secs.map(|_| 0.07),
        distance_m: touch_secs.map(|_| 1.2),
    };
    let looking = Pose {
        position: Point::new(2.0, 1.0, 1.7),
        orientation: UnitQuaternion::from_euler_angles(0.0, -0.25, 0.5),
    };
    Snapshot {
        at,
        mode: Mode::ProtectiveStop,
        mode_since: at,
        stop: Some(StopCause { rule: RuleId(2), reason: Reason::PoseTooOld(PersonId(3), 0.6), since: at }),
        refusals: vec![(RequestKind::Reset, Some(Reason::NothingToReset))],
        interaction: Some(InteractionState {
            object: 0,
            interaction: "hold",
            phase: "holding",
            person: Some(PersonId(3)),
            lasted_secs: 1.5,
        }),
        contact: Some(ContactState { person: PersonId(3), left_secs: 30.0 }),
        bears: Some(PersonId(3)),
        rules: vec![RuleState {
            rule: RuleId(1),
            status: RuleStatus::Clear,
            reason: Reason::InsideTravel,
            since: at,
        }],
        column: ColumnState {
            position: Floor::new(1.0, 1.5),
            velocity: Planar::new(0.2, 0.1),
            commanded: Floor::new(1.0, 1.5),
            commanded_velocity: Planar::ZERO,
            proxy: Floor::new(1.1, 1.6),
            target: Some(Floor::new(0.9, 3.0)),
            serves: Some(PersonId(3)),
            committed: Some(0),
            activity: Activity::Stopped,
            held_by: None,
            goes_around: false,
            arrival_secs: Some(2.0),
            least_arrival_secs: Some(1.6),
            jog_speed_mps: None,
            current_amps: [0.5, 0.4],
            home_repeatability_m: Some([0.0003, -0.0001]),
            homed: true,
        },
        persons: vec![person(3, Some(looking)), person(8, None)],
        objects: vec![object("kettle", 0.4, Some(1.5)), object("lamp", 0.6, None)],
        scenario: Some(ScenarioState {
            state: "tea".into(),
            in_state_secs: 4.2,
            runs: false,
            entered: 2,
            variables: vec![("cups".into(), Value::Integer(1)), ("hot".into(), Value::Boolean(true))],
            next: vec![
                NextState {
                    is_from_anywhere: false,
                    index: 0,
                    to: Some("light".into()),
                    due_secs: Some(5.8),
                },
                NextState {
                    is_from_anywhere: true,
                    index: 0,
                    to: Some("arrival".into()),
                    due_secs: Some(0.0),
                },
            ],
            before: Some("arrival".into()),
            left_in: None,
            is_cut: false,
        }),
        intention_rule: "paper",
        standing: "mean",
        motion: "proxy",
        none_probability: 0.0,
    }
}
