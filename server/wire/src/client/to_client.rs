//! What the server says to a VR client.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ts_rs::TS;

use super::{ClientError, Convention};
use crate::dashboard::{Mode, Outcome};
use crate::scene::{SceneDocument, ValueDocument};

/// What the server says to a client.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum ToClient {
    /// The answer to a hello.
    Welcome(Box<Welcome>),
    /// Another scene, or another version, is active.
    Scene(Box<ActiveScene>),
    /// Where the column is.
    Column(ColumnNow),
    /// What the visitor will touch next.
    Prediction(Prediction),
    /// Whether the machine is stopped; sent on connection and at each change.
    Stop(StopState),
    /// The scenario's state; sent on connection and at each change, where the active scene has one.
    Scenario(ScenarioNow),
    /// What came of a `scene_event`, where the active scene has a scenario.
    EventAnswered(EventAnswered),
    /// The answer to a ping.
    ClockPong(ClockPong),
    /// A message was refused.
    Error(ClientError),
}

/// The answer to a hello.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct Welcome {
    /// The server's version.
    pub server_version: String,
    /// Store id of the running session.
    #[ts(type = "number | null")]
    pub session_id: Option<i64>,
    /// As declared.
    pub convention: Convention,
    /// What the machine and the protocol allow.
    pub limits: ClientLimits,
    /// The active scene.
    pub scene: Option<ActiveScene>,
}

/// What the machine and the protocol allow, SI units, room axes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct ClientLimits {
    /// Greatest speed of the column along x and y, m/s.
    pub speed_mps: [f64; 2],
    /// Greatest acceleration along x and y, m/s2.
    pub acceleration_mps2: [f64; 2],
    /// Greatest deceleration along x and y, m/s2.
    pub braking_mps2: [f64; 2],
    /// Least and greatest rate of poses of a person, Hz.
    pub pose_rate_hz: [f64; 2],
    /// The longest frame, bytes.
    pub frame_bytes: usize,
    /// A pose older than this stops the column, s.
    pub max_pose_age_secs: f64,
}

/// The active scene, and how to find it in the client's space.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct ActiveScene {
    /// Store id.
    #[ts(type = "number")]
    pub id: i64,
    /// Its version.
    #[ts(type = "number")]
    pub version: i64,
    /// As its author wrote it: room frame, metres, radians.
    pub document: SceneDocument,
    /// Takes a point of the room (x, y, z, 1; m) to the client's convention and units: three rows of four.
    pub client_from_room: [[f64; 4]; 3],
    /// Every object in the client's convention and units, in the document's order.
    pub places: Vec<ObjectPlace>,
}

/// Where an object is, in the client's convention and units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct ObjectPlace {
    /// Its id.
    pub object: String,
    /// Its centre.
    pub position: [f64; 3],
    /// Unit quaternion x, y, z, w that takes the convention's forward axis to the object's own +x axis.
    pub orientation: [f64; 4],
}

/// Where the column is, in the client's convention and units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct ColumnNow {
    /// Server time, microseconds since its start.
    #[ts(type = "number")]
    pub at_micros: i64,
    /// The state of the machine.
    pub mode: Mode,
    /// Of its centre, on the floor; means something when `homed`.
    pub position: [f64; 3],
    /// Units a second.
    pub velocity: [f64; 3],
    /// The machine knows where the column is.
    pub homed: bool,
    /// Every object of the active scene, in its order.
    pub prop_at: Vec<PropAt>,
    /// The interaction under way; null: none.
    #[serde(default)]
    pub interaction: Option<InteractionNow>,
}

/// What the column does at an object now, beyond standing in for it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct InteractionNow {
    /// The object's id.
    pub object: String,
    /// `hold`, `step_back`, `lead`, `transport`, `brush` or `park`.
    pub interaction: String,
    /// `waiting`, `holding`, `stepping_back`, `leading`, `riding`, `approaching`, `touching`, `leaving`, `parked` or `done`.
    pub phase: String,
    /// Where its prop is now, at the object's height: draw the object here while it is led, carried, or comes up to somebody.
    pub position: [f64; 3],
}

/// Whether what stands in for an object is there.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct PropAt {
    /// The object's id.
    pub object: String,
    /// The prop's id; null: the column itself.
    pub prop: Option<String>,
    /// It is there, within 2 cm.
    pub in_place: bool,
}

/// What the visitor will touch next, and whether the column will be there.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct Prediction {
    /// Server time, microseconds since its start.
    #[ts(type = "number")]
    pub at_micros: i64,
    /// The object's id.
    pub object: String,
    /// The rule's probability of it, 0 to 1.
    pub probability: f64,
    /// When the column is in place for it, s from `at_micros`: by the way that it takes now, people in the way included,
    /// where that leads there, else at its limits; 0 while it is in place.
    pub arrival_secs: f64,
    /// How much later than the hand that is, s; negative: earlier; null where no hand is foreseen.
    pub late_by_s: Option<f64>,
    /// The probability that the column is in place before the hand, 0 to 1; 1 while it is in place, 0 while the machine is
    /// not following and it is not; null where no hand is foreseen.
    pub in_time_probability: Option<f64>,
    /// Shift the virtual object by this, along the client's axes but in metres whatever its unit, and it is where its prop
    /// will be when the hand comes. At most 2.5 cm, the published detection threshold (Zenner and Krueger 2019); null where no
    /// shift is needed, and where the prop is more than 10 cm off.
    pub offset_m: Option<[f64; 3]>,
}

/// Whether the machine is stopped, and why.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct StopState {
    /// In a stop or faulted.
    pub stopped: bool,
    /// The state of the machine.
    pub mode: Mode,
    /// `R1` to `R16`.
    pub rule: Option<String>,
    /// What happened, in plain words.
    pub reason: Option<String>,
    /// What clears it, in plain words.
    pub clears_when: Option<String>,
}

/// Where the scenario is. Its states are in the scene's document.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct ScenarioNow {
    /// Id of its state.
    pub state: String,
    /// It runs: the machine follows people.
    pub runs: bool,
    /// States entered since the run began; the same state entered again counts again.
    #[ts(type = "number")]
    pub entered: usize,
    /// The variables, by id.
    pub variables: BTreeMap<String, ValueDocument>,
}

/// What came of a client event.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema, TS)]
pub struct EventAnswered {
    /// Its name.
    pub name: String,
    /// `accepted`: a transition was taken for it; `refused`: it is on record, and changed nothing.
    pub outcome: Outcome,
    /// Which state the scenario is in, or why nothing changed, in plain words.
    pub detail: String,
}

/// The answer to a ping.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, TS)]
pub struct ClockPong {
    /// The ping's.
    pub id: u32,
    /// The ping's, on the client's clock, microseconds.
    #[ts(type = "number")]
    pub client_time_micros: i64,
    /// When the ping was received, server time, microseconds.
    #[ts(type = "number")]
    pub server_received_micros: i64,
    /// When this was sent, server time, microseconds.
    #[ts(type = "number")]
    pub server_sent_micros: i64,
}
