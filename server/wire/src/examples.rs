//! One value of every message, for the published contract: built from the types themselves, so that an example cannot say
//! what the wire does not. The client of the examples counts as WebXR does.

use std::collections::BTreeMap;

use covr_engine::frames::{Floor, RigidMap};
use covr_engine::machine::{Limits, Travel};
use covr_engine::observation::PersonId;
use covr_engine::safety::parameters::Parameters;
use nalgebra::Vector3;
use serde_json::json;

use crate::client::{
    ActiveScene, ClientError, ClientHello, ClientLimits, ClockPing, ClockPong, ColumnNow, Convention,
    ErrorCode, EventAnswered, FromClient, Hands, HeadPose, PersonName, PongReceived, Prediction, ScenarioNow,
    SceneEvent, StopState, ToClient, Touch, Welcome,
};
use crate::convention::ClientFrame;
use crate::dashboard::{
    Client, Event, FromDashboard, JogAim, LinkThresholds, MachineHealth, MachineLink, MachineRequest,
    MachineShape, Outcome, Snapshot, Surroundings, ToDashboard,
};
use crate::reason::Reason;
use crate::sample;
use crate::scene::SceneDocument;

/// A scene of two objects.
pub fn scene() -> SceneDocument {
    sample::document()
}

/// A state in a protective stop, with two persons.
pub fn snapshot() -> Snapshot {
    let names = BTreeMap::from([(PersonId(3), "Ada".to_owned())]);
    let around = Surroundings {
        generation: 214,
        names: &names,
        control_loop: sample::control_loop(),
        machine_health: Some(machine_health()),
        clients: vec![client()],
        scene_id: Some(4),
        session_id: Some(17),
    };
    Snapshot::new(&sample::snapshot(), around)
}

/// A RoboClaw in order.
pub fn machine_health() -> MachineHealth {
    MachineHealth {
        firmware: Some("USB Roboclaw 2x30a v4.1.34".into()),
        profile: Some("4.1.29–4.3".into()),
        trouble: None,
        condition: String::new(),
        supply_volts: Some(24.1),
        temperature_c: Some(31.5),
        link: MachineLink {
            rate_hz: 112.0,
            cycle_p50_micros: 8_700.0,
            cycle_p99_micros: 9_400.0,
            cycle_max_micros: 29_800.0,
            exchanges: 40_312,
            lost: 3,
            repeated: 2,
            cycles_lost: 1,
            last_loss: "command 51: 0 of 1 bytes came within 20 ms".into(),
            connections: 1,
        },
    }
}

/// A request's record.
pub fn event() -> Event {
    Event {
        at_micros: 7_250_000,
        at: "2026-11-24T10:15:07.250Z".into(),
        kind: "stop_pressed".into(),
        summary: "Ada pressed stop; at the drive after 2130 us".into(),
        detail: json!({ "author": "Ada", "by": "http", "reason": "hand near the rail", "to_drive_micros": 2130 }),
    }
}

/// What clients say, at least one of each.
pub fn from_client() -> Vec<FromClient> {
    let person = || PersonName { person: "visitor".into() };
    let touch = || Touch { person: "visitor".into(), object: "kettle".into(), client_time_micros: 5_400_000 };
    vec![
        FromClient::Hello(ClientHello {
            name: "headset 1".into(),
            convention: Convention::Openxr,
            token: None,
            hands: true,
        }),
        FromClient::Enter(person()),
        FromClient::Pose(HeadPose {
            person: "visitor".into(),
            sequence: 1,
            client_time_micros: 1_000_000,
            position: [1.0, 1.6, -2.0],
            orientation: [0.0, 0.0, 0.0, 1.0],
            tracked: true,
            worn: true,
            hands: Some(Hands { left: None, right: Some([1.2, 1.1, -2.3]) }),
        }),
        FromClient::ClockPing(ClockPing { id: 1, client_time_micros: 1_000_500, previous: None }),
        FromClient::ClockPing(ClockPing {
            id: 2,
            client_time_micros: 2_000_500,
            previous: Some(PongReceived { id: 1, received_client_time_micros: 1_003_200 }),
        }),
        FromClient::TouchBegan(touch()),
        FromClient::TouchEnded(touch()),
        FromClient::SceneEvent(SceneEvent { name: "chapter".into(), detail: Some(json!({ "number": 2 })) }),
        FromClient::OriginChanged(person()),
        FromClient::Leave(person()),
    ]
}

/// What clients are told, at least one of each.
pub fn to_client() -> Vec<ToClient> {
    let frame = ClientFrame::new(Convention::Openxr, RigidMap::from_yaw(0.0, Vector3::zeros()));
    let (state, built) = (sample::snapshot(), sample::scene());
    let active = || ActiveScene::new(4, 1, scene(), &frame);
    let mut all = vec![
        ToClient::Welcome(Box::new(Welcome {
            server_version: env!("CARGO_PKG_VERSION").into(),
            session_id: Some(17),
            convention: Convention::Openxr,
            limits: ClientLimits::new(&Limits::PAPER, Parameters::new(1.6).pose_age.secs()),
            scene: Some(active()),
        })),
        ToClient::Scene(Box::new(active())),
        ToClient::Column(ColumnNow::new(&state, &built, &frame)),
        ToClient::Stop(StopState::from(&state)),
        ToClient::ClockPong(ClockPong {
            id: 1,
            client_time_micros: 1_000_500,
            server_received_micros: 6_998_400,
            server_sent_micros: 6_998_460,
        }),
        ToClient::Error(ClientError::at(
            ErrorCode::NotUnit,
            "orientation",
            "a quaternion of length 1.414214",
            "length 1 within 0.001",
        )),
        ToClient::Error(ClientError::plain(ErrorCode::HelloExpected, "no hello came within 5 s").fatal()),
    ];
    all.push(ToClient::EventAnswered(EventAnswered {
        name: "spilled".into(),
        outcome: Outcome::Accepted,
        detail: Reason::NowInState { state: "arrival".into() }.to_string(),
    }));
    all.extend(ScenarioNow::new(&state).map(ToClient::Scenario));
    all.extend(Prediction::new(&state, &frame).map(ToClient::Prediction));
    all
}

/// What dashboards say, at least one of each.
pub fn from_dashboard() -> Vec<FromDashboard> {
    vec![
        FromDashboard::Stop { request_id: 7, reason: Some("hand near the rail".into()) },
        FromDashboard::Request { request_id: 8, request: MachineRequest::Home, reason: None },
        FromDashboard::Request {
            request_id: 9,
            request: MachineRequest::Reset,
            reason: Some("the hand is out of the way".into()),
        },
        FromDashboard::Jog { request_id: 11, to: Some(JogAim::Along([1.0, 0.0])), speed_mps: 0.1 },
        FromDashboard::Jog { request_id: 12, to: Some(JogAim::Place([2.0, 1.5])), speed_mps: 0.25 },
        FromDashboard::Jog { request_id: 13, to: None, speed_mps: 0.0 },
        FromDashboard::Request { request_id: 10, request: MachineRequest::ConfirmOrigin(3), reason: None },
        FromDashboard::Request { request_id: 11, request: MachineRequest::Cue("begin".into()), reason: None },
        FromDashboard::Request {
            request_id: 12,
            request: MachineRequest::SkipTo("tea".into()),
            reason: Some("the kettle is empty".into()),
        },
    ]
}

/// What dashboards are told, at least one of each.
pub fn to_dashboard() -> Vec<ToDashboard> {
    vec![
        ToDashboard::Welcome {
            version: env!("CARGO_PKG_VERSION").into(),
            machine: "simulated".into(),
            machine_shape: machine_shape(),
            link_thresholds: LinkThresholds::USUAL,
        },
        ToDashboard::Scene { id: 4, version: 1, scene: scene() },
        ToDashboard::Snapshot(Box::new(snapshot())),
        ToDashboard::Event(event()),
        ToDashboard::Answer {
            request_id: 7,
            outcome: Outcome::Accepted,
            detail: Reason::Stopped.to_string(),
            why: Some(Reason::Stopped),
            to_drive_micros: Some(2_130),
        },
        ToDashboard::Answer {
            request_id: 9,
            outcome: Outcome::Refused,
            detail: Reason::ResetNeedsReason.to_string(),
            why: Some(Reason::ResetNeedsReason),
            to_drive_micros: None,
        },
    ]
}

/// The paper's machine over four metres.
pub fn machine_shape() -> MachineShape {
    let travel = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) };
    MachineShape::new(&travel, &Limits::PAPER)
}

fn client() -> Client {
    Client {
        name: "headset 1".into(),
        convention: Convention::Openxr.name().into(),
        poses: 642,
        pose_rate_hz: 90.0,
        rtt_millis: Some(2.4),
        persons: vec![3],
        pose_age_millis: Some(12.0),
        jitter_millis: Some(0.8),
        loss_percent: Some(0.0),
        errors: 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::client::{Encoding, decode, decode_from_server};

    #[test]
    fn what_clients_say_is_understood_in_both_encodings() {
        for message in from_client() {
            for encoding in [Encoding::Json, Encoding::MessagePack] {
                let frame = encoding.encode(&message).unwrap();
                assert_eq!(decode(encoding, frame.bytes()), Ok(message.clone()));
            }
        }
    }

    #[test]
    fn what_clients_are_told_is_understood_in_both_encodings() {
        for message in to_client() {
            for encoding in [Encoding::Json, Encoding::MessagePack] {
                let frame = encoding.encode(&message).unwrap();
                assert_eq!(decode_from_server(encoding, frame.bytes()), Ok(message.clone()));
            }
        }
    }

    #[test]
    fn what_dashboards_say_and_hear_comes_back_the_same() {
        for message in from_dashboard() {
            let text = serde_json::to_string(&message).unwrap();
            assert_eq!(serde_json::from_str::<FromDashboard>(&text).unwrap(), message);
        }
        for message in to_dashboard() {
            let text = serde_json::to_string(&message).unwrap();
            assert_eq!(serde_json::from_str::<ToDashboard>(&text).unwrap(), message);
        }
    }
}
