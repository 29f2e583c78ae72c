//! The messages between the server and a dashboard, `/ws/v1/dashboard`: JSON text frames, room frame, SI units.
//!
//! The server sends `welcome` once, the active `scene` whenever it changes, a whole `snapshot` about 30 times a second
//! (a slow reader skips generations), every `event`, and an `answer` to each request. Nothing is ever patched.

mod convert;
mod event;
mod health;
mod snapshot;

use covr_engine::frames::{Floor, Planar};
use covr_engine::motion::jog::{Aim, JogOrder};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ts_rs::TS;

pub use convert::{Surroundings, request_name};
pub(crate) use convert::{clears_when, name_of};
pub use event::rule_title;
pub use health::{MachineHealth, MachineLink};
pub use snapshot::{
    Activity, Client, Column, Contact, ControlLoop, Decision, Interaction, Mode, NextState, Object, Person,
    RequestState, RuleState, RuleStatus, Scenario, SeparationTerm, SeparationTerms, Snapshot, StopCause,
};

use crate::reason::Reason;
use crate::scene::SceneDocument;

/// What a dashboard says.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
pub enum FromDashboard {
    /// The software stop. Answered like a request, with the time that it took to reach the drive.
    Stop {
        /// Echoed in the answer.
        request_id: u32,
        /// Why, in the presser's words.
        #[serde(default)]
        reason: Option<String>,
    },
    /// Move the column by hand (hold-to-run): an order is good for 0.3 s, so it is given anew, ten times a second, while the
    /// button is held. In mode `ready` alone. Answered like a request.
    Jog {
        /// Echoed in the answer.
        request_id: u32,
        /// Where to; null: the hand lets go.
        to: Option<JogAim>,
        /// No faster than this, m/s: more than 0 and no more than the machine's. Among people and where nobody vouches for the arena
        /// the column is slower (`column.jog_speed_mps`).
        #[serde(default)]
        speed_mps: f64,
    },
    /// Home, arm, disarm or reset; confirm a person on the floor mark, or gone; lead the scenario on.
    Request {
        /// Echoed in the answer.
        request_id: u32,
        /// What is asked.
        request: MachineRequest,
        /// Why; due for a reset, and to skip or go back in the scenario.
        #[serde(default)]
        reason: Option<String>,
    },
}

impl FromDashboard {
    /// What its answer echoes.
    pub const fn request_id(&self) -> u32 {
        match self {
            Self::Stop { request_id, .. }
            | Self::Jog { request_id, .. }
            | Self::Request { request_id, .. } => *request_id,
        }
    }
}

/// Where a jog leads, room frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(rename_all = "snake_case")]
pub enum JogAim {
    /// On and on this way, x and y; its length says nothing.
    Along([f64; 2]),
    /// To this place of the column's centre, m.
    Place([f64; 2]),
}

impl JogAim {
    /// The engine's order.
    pub fn order(self, speed_mps: f64) -> JogOrder {
        let aim = match self {
            Self::Along([x, y]) => Aim::Along(Planar::new(x, y)),
            Self::Place([x, y]) => Aim::To(Floor::new(x, y)),
        };
        JogOrder { aim, speed_mps }
    }
}

/// A request to the machine, other than stop.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(rename_all = "snake_case")]
pub enum MachineRequest {
    /// Find the switches. Whoever asks says that the arena is clear.
    Home,
    /// Follow the visitor.
    Arm,
    /// Brake and release the drive.
    Disarm,
    /// Leave a latched stop or a fault. Starts nothing.
    Reset,
    /// The person with this id stands on the floor mark again (R15).
    ConfirmOrigin(u32),
    /// The person with this id, whose headset is lost, has left the arena (R10).
    ConfirmLeft(u32),
    /// Somebody looked: nobody is in the arena (R16). The word holds until somebody has been there, the next stop or disarming.
    ConfirmClear,
    /// Give this cue to the scenario.
    Cue(String),
    /// Skip to the scenario's state of this id.
    SkipTo(String),
    /// Back to the scenario's state before, with the variables as they were.
    Rewind,
    /// A moving column may touch this visitor (R14): in the interactions lead, transport and brush.
    ArmContact {
        /// The visitor's id.
        person: u32,
        /// For so long at most, s.
        #[schemars(range(min = 1.0, max = 300.0))]
        secs: f64,
    },
    /// Nobody may be touched by a moving column any more.
    DisarmContact,
    /// Somebody looked: nobody leans on the column or rides it. A stop that kept the drive on lets it go.
    ConfirmFree,
}

/// What the server says to a dashboard.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum ToDashboard {
    /// First message of a connection.
    Welcome {
        /// The server's version.
        version: String,
        /// The machine: `simulated`, later others by name.
        machine: String,
        /// Column and travel.
        machine_shape: MachineShape,
        /// From where on a link is shown as weak or bad.
        link_thresholds: LinkThresholds,
    },
    /// The active scene; sent on connection and at each activation.
    Scene {
        /// Store id of the scene.
        id: i64,
        /// Its version.
        version: i64,
        /// The document.
        scene: SceneDocument,
    },
    /// The whole state.
    Snapshot(Box<Snapshot>),
    /// Something happened.
    Event(Event),
    /// The answer to a request or a stop.
    Answer {
        /// The request's.
        request_id: u32,
        /// What came of it.
        outcome: Outcome,
        /// Why it was refused, or what it did, in plain words.
        detail: String,
        /// The same as an id and its values; null for a message that was not understood.
        why: Option<Reason>,
        /// For a stop: from the server's reception to the braking command written to the drive, microseconds.
        to_drive_micros: Option<u64>,
    },
}

/// What came of a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// Done, or begun.
    Accepted,
    /// It was so already.
    AlreadySo,
    /// Not now; the detail says why.
    Refused,
}

/// The column's and the arena's fixed numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct MachineShape {
    /// Travel limits of the column's centre, m: `[min_x, min_y, max_x, max_y]`.
    pub travel_m: [f64; 4],
    /// Greatest speed of x and y, m/s.
    pub speed_mps: [f64; 2],
    /// Greatest acceleration of x and y, m/s2.
    pub acceleration_mps2: [f64; 2],
    /// Greatest deceleration of x and y, m/s2.
    pub braking_mps2: [f64; 2],
}

/// From where on a measure is shown as weak, and as bad.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct Threshold {
    /// Weak from here on.
    pub weak: f64,
    /// Bad from here on.
    pub bad: f64,
}

/// Thresholds of what links and loop are measured by. They colour the dashboard; the safety rules have their own.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct LinkThresholds {
    /// Of `pose_age_millis`.
    pub pose_age_millis: Threshold,
    /// Of `jitter_millis`.
    pub jitter_millis: Threshold,
    /// Of `loss_percent`.
    pub loss_percent: Threshold,
    /// Of `rtt_millis`.
    pub rtt_millis: Threshold,
    /// Of `lateness_p99_micros`.
    pub lateness_micros: Threshold,
}

/// Something that happened, as stored.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct Event {
    /// Server time, microseconds since its start.
    #[ts(type = "number")]
    pub at_micros: i64,
    /// Wall clock, RFC 3339.
    pub at: String,
    /// Kind: `mode_changed`, `rule_breached`, `rule_cleared`, `request_accepted`, `request_refused`, `stop_pressed`,
    /// `homed`, `came_to_rest`, `jog_began`, `jog_ended`, `person_entered`, `person_left`, `served`, `origin_changed`, `touch_began`, `touch_ended`, `scene_event`,
    /// `scene_activated`, `state_entered`, `scenario_cut`, `prior_changed`, `client_connected`, `client_gone`, `client_error`, `calibration_accepted`,
    /// `calibration_refused`, `calibration_chosen`, `machine_commissioned`, `commissioning_refused`, `note`, `checklist_ticked`.
    pub kind: String,
    /// In plain words.
    pub summary: String,
    /// Particulars, by kind; `why` is a reason as an id and its values.
    #[ts(type = "unknown")]
    pub detail: serde_json::Value,
}

impl Event {
    /// Every kind.
    pub const KINDS: &'static [&'static str] = &[
        "mode_changed",
        "rule_breached",
        "rule_cleared",
        "request_accepted",
        "request_refused",
        "stop_pressed",
        "homed",
        "came_to_rest",
        "jog_began",
        "jog_ended",
        "person_entered",
        "person_left",
        "served",
        "origin_changed",
        "touch_began",
        "touch_ended",
        "scene_event",
        "scene_activated",
        "state_entered",
        "scenario_cut",
        "interaction_began",
        "interaction_ended",
        "contact_over",
        "prior_changed",
        "client_connected",
        "client_gone",
        "client_error",
        "calibration_accepted",
        "calibration_refused",
        "calibration_chosen",
        "machine_commissioned",
        "commissioning_refused",
        "note",
        "checklist_ticked",
    ];
}

impl LinkThresholds {
    /// What suits a 90 Hz headset on a wireless link and a 250 Hz loop.
    pub const USUAL: Self = Self {
        pose_age_millis: Threshold { weak: 50.0, bad: 150.0 },
        jitter_millis: Threshold { weak: 8.0, bad: 25.0 },
        loss_percent: Threshold { weak: 1.0, bad: 5.0 },
        rtt_millis: Threshold { weak: 20.0, bad: 60.0 },
        lateness_micros: Threshold { weak: 1_000.0, bad: 4_000.0 },
    };
}
