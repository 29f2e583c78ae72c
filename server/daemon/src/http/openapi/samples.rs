//! One value of every body, by the name of its schema.

use covr_wire::answers::{PriorChange, SceneSummary, SceneVersionSummary};
use covr_wire::calibration::{
    Calibration, CalibrationDraft, CalibrationKind, CalibrationPoint, CalibrationRefusal, CalibrationResult,
    CalibrationSummary, CalibrationTask, Hardware, HardwareChange, HardwarePart, NewCalibrationPoint,
    PointOn, Pointer,
};
use covr_wire::client::Convention;
use covr_wire::commissioning::{BrakeRun, Commissioning, CommissioningStep, NewCommissioning};
use covr_wire::examples;
use covr_wire::phrase::Phrase;
use covr_wire::records::{RecordedFrame, SceneInForce, Session, SessionDetail};
use covr_wire::scene::{ScenePairs, SceneWarning};
use serde::Serialize;
use serde_json::{Value, json};

use super::super::access::TokenRow;
use super::super::{Answered, PriorsChanged, ProblemItem, Readiness, Ticket};
use super::super::{SceneActivated, SceneChecked, SceneStored, StopAcknowledged};
use crate::access::Role;
use crate::checklist::{ChecklistItem, ChecklistNow};

/// An example of a schema; none for a name that has none.
pub fn of(schema: &str) -> Option<Value> {
    match schema {
        "Snapshot" => value(examples::snapshot()),
        "SceneDocument" => value(examples::scene()),
        "Event" => value(examples::event()),
        "SceneSummary" => value(SceneSummary {
            id: 4,
            name: "Kitchen".into(),
            version: 2,
            author: "Ada".into(),
            changed_at: AT.into(),
            active: true,
        }),
        "SceneVersionSummary" => value(SceneVersionSummary {
            version: 2,
            author: "Ada".into(),
            created_at: AT.into(),
            active: true,
            objects: 12,
        }),
        "NewCommissioning" => value(NewCommissioning {
            begun_at: AT.into(),
            load_kg: 12.5,
            steps: CommissioningStep::ALL.to_vec(),
        }),
        "Commissioning" => value(commissioning()),
        "CalibrationTask" => value(calibration_task()),
        "NewCalibrationPoint" => {
            value(NewCalibrationPoint { on: PointOn::Place, place_m: Some([1.0, 0.5, 0.0]) })
        }
        "CalibrationDraft" => value(CalibrationDraft {
            task: calibration_task(),
            author: "Ada".into(),
            points: vec![CalibrationPoint {
                residual_m: None,
                used: None,
                ..calibration().points[0].clone()
            }],
            result: None,
            refused_because: Some(FEW_POINTS.to_string()),
            why: Some(FEW_POINTS),
        }),
        "Calibration" => value(calibration()),
        "CalibrationSummary" => value(calibration().summary),
        "SceneStored" => value(SceneStored { id: 4, version: 1, warnings: vec![scene_warning()] }),
        "SceneChecked" => value(SceneChecked {
            valid: true,
            name: "Kitchen".into(),
            objects: 12,
            warnings: vec![scene_warning()],
            pairs: Some(scene_pairs()),
        }),
        "ScenePairs" => value(scene_pairs()),
        "NoteBody" => Some(json!({ "text": "the visitor laughed at the wall" })),
        "Noted" => Some(json!({ "session": 12 })),
        "TickBody" => Some(json!({ "ticked": true })),
        "ChecklistNow" => value(ChecklistNow { of_scene: false, items: vec![checklist_item()] }),
        "ChecklistItem" => value(checklist_item()),
        "SceneWarning" => value(scene_warning()),
        "CueBody" => Some(json!({ "name": "lights on" })),
        "ContactBody" => Some(json!({ "person": 3, "secs": 60.0 })),
        "SkipBody" => Some(json!({ "to": "walls", "reason": "the carpet was missed" })),
        "SceneActivated" => value(SceneActivated { id: 4, version: 2, detail: "the scene is active".into() }),
        "PriorChange" => value(PriorChange {
            at: AT.into(),
            author: "Ada".into(),
            object: "kettle".into(),
            from: 0.5,
            to: 0.8,
            scene_id: 4,
            scene_version: 2,
        }),
        "PriorsChanged" => value(PriorsChanged { changed: vec!["kettle".into()] }),
        "PriorsPreview" => Some(json!({
            "target_m": [1.2, 3.4], "serves": 1, "committed": "lamp", "planned_path_m": [[2.0, 2.0], [1.95, 2.08]],
            "objects": [{ "id": "lamp", "weight": 0.36, "probability": 0.8, "prior": 0.8 },
                        { "id": "door", "weight": 0.09, "probability": 0.2, "prior": 0.2 }],
        })),
        "Priors" => Some(json!({ "lamp": 0.8, "door": 0.2 })),
        "ReasonBody" => Some(json!({ "reason": "the hand is out of the way" })),
        "Me" => Some(json!({ "asks": true, "name": "front desk", "role": "game_master", "csrf": null,
            "may": ["POST /api/v1/stop", "dashboard arm"] })),
        "SignIn" => Some(json!({ "token": format!("covr_3f9a01bc_{}", "0".repeat(64)) })),
        "Ticket" => value(Ticket { ticket: "5b0e".repeat(16), lasts_secs: 30 }),
        "TokenRow" => value(TokenRow {
            id: "3f9a01bc".into(),
            name: "front desk".into(),
            role: Role::GameMaster,
            created_at: AT.into(),
            expires_at: None,
            revoked_at: None,
        }),
        "Answered" => value(Answered { outcome: "accepted".into(), detail: "homing".into() }),
        "StopAcknowledged" => value(StopAcknowledged { acknowledged: true, to_drive_micros: 2_130 }),
        "SessionExport" => value(session_export()),
        "Readiness" => value(Readiness { ready: true, control_loop: "ready".into(), store: "ready".into() }),
        _ => None,
    }
}

fn calibration_task() -> CalibrationTask {
    CalibrationTask {
        kind: CalibrationKind::RoomFromTracking,
        client: "headset 1".into(),
        pointer: Pointer::RightHand,
        offset_m: None,
        prop: None,
    }
}

fn commissioning() -> Commissioning {
    let Calibration { hardware, .. } = calibration();
    let run = BrakeRun {
        velocity_mps: [1.1, 0.0],
        secs: 0.49,
        distance_m: [0.291, 0.0],
        allowed_m: [0.354, 0.0],
        braking_mps2: [Some(2.53), None],
    };
    Commissioning {
        id: 1,
        author: "Ada".into(),
        created_at: AT.into(),
        load_kg: 12.5,
        braking_mps2: [2.53, 2.51],
        runs: vec![run],
        hardware,
        changed: Vec::new(),
    }
}

fn calibration() -> Calibration {
    let summary = CalibrationSummary {
        id: 12,
        kind: CalibrationKind::RoomFromTracking,
        subject: "headset 1".into(),
        version: 3,
        author: "Ada".into(),
        created_at: AT.into(),
        in_force: true,
        points_used: 11,
        points_left_out: 1,
        result: CalibrationResult::RoomFromTracking {
            convention: Convention::Openxr,
            position_m: [2.01, 1.48, 0.002],
            orientation: [0.0, 0.0, 0.38, 0.925],
            rms_m: 0.0031,
            scale: 0.9993,
            tilt_rad: 0.004,
            uncertainty_m: 0.0027,
            turn_sd_rad: 0.0006,
            offset_m: None,
        },
        changed: vec![HardwareChange {
            part: HardwarePart::Controller,
            was: "/dev/roboclaw-00A1".into(),
            is: "/dev/roboclaw-00B2".into(),
        }],
    };
    let point = CalibrationPoint {
        number: 1,
        on: PointOn::Place,
        tracking_m: [-0.71, 0.69, 0.003],
        room_m: [1.0, 0.5, 0.0],
        poses: 90,
        jitter_m: 0.0006,
        residual_m: Some(0.0028),
        used: Some(true),
    };
    let hardware = Hardware {
        machine: "roboclaw".into(),
        travel_m: [[0.0, 0.0], [4.0, 4.0]],
        controller: Some("/dev/roboclaw-00A1".into()),
        firmware: Some("USB Roboclaw 2x15a v4.3.6".into()),
        counts_per_metre: Some([20_000.0, 20_000.0]),
    };
    Calibration { summary, points: vec![point], hardware }
}

/// One thing that is wrong.
pub fn problem_item() -> ProblemItem {
    let item = ProblemItem::new("$.objects[0].prior", "7", "a number from 0 to 1");
    ProblemItem { line: Some(5), column: Some(17), ..item }
}

fn scene_pairs() -> ScenePairs {
    ScenePairs {
        objects: vec!["lamp".into(), "door".into()],
        serve_secs: vec![vec![0.0, 2.7], vec![2.7, 0.0]],
        walk_secs: vec![vec![0.0, 4.69], vec![4.69, 0.0]],
    }
}

fn checklist_item() -> ChecklistItem {
    ChecklistItem {
        text: "The stop is in reach and was tried today".into(),
        id: Some("stop_in_reach".into()),
        ticked_by: Some("Ada".into()),
        ticked_at: Some(AT.into()),
    }
}

fn scene_warning() -> SceneWarning {
    let found = "nothing leads on from the state \"walls\", and it is not marked as final";
    SceneWarning {
        path: "$.scenario.states[2]".into(),
        line: Some(31),
        column: Some(7),
        found: found.into(),
        found_as: Phrase::of(found).map(Box::new),
    }
}

/// A session of a minute with one of everything.
fn session_export() -> Value {
    let session = Session {
        id: 12,
        started_at: AT.into(),
        ended_at: None,
        how: None,
        scene_id: 4,
        scene_version: 2,
        scene: "Kitchen".into(),
        length_secs: Some(63.2),
        reaches: 4,
        reaches_served: 4,
        stops: 1,
        recorded_frames: 1_890,
        dropped_frames: 0,
        recording_bytes: 270_334,
        recording_removed_at: None,
    };
    let in_force = SceneInForce { id: 4, version: 2, from_secs: 0.0 };
    let detail = SessionDetail {
        session,
        persons: vec!["Ada".into()],
        scenes: vec![in_force],
        first_micros: Some(7_000_000),
        last_micros: Some(70_200_000),
        machine_shape: Some(examples::machine_shape()),
    };
    let scene = json!({ "id": 4, "version": 2, "from_secs": 0.0, "document": examples::scene() });
    json!({
        "session": detail,
        "scenes": [scene],
        "events": [examples::event()],
        "frames": [RecordedFrame::from(examples::snapshot())],
    })
}

fn value(sample: impl Serialize) -> Option<Value> {
    serde_json::to_value(sample).ok()
}

const FEW_POINTS: CalibrationRefusal = CalibrationRefusal::TooFewPoints { found: 1, fewest: 6 };
const AT: &str = "2026-11-24T10:15:07.250000Z";
