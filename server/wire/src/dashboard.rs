//! The messages between the server and a dashboard, `/ws/v1/dashboard`: JSON text frames, room frame, SI units.
//!
//! The server sends `welcome` once, the active `scene` whenever it changes, a whole `snapshot` about 30 times a second
//! (a slow reader skips generations), every `event`, and an `answer` to each request. Nothing is ever patched.

mod convert;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ts_rs::TS;

pub use convert::{Surroundings, request_name, rule_title};
pub(crate) use convert::{clears_when, name_of};

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
    /// Home, arm, disarm or reset; confirm a person on the floor mark, or gone.
    Request {
        /// Echoed in the answer.
        request_id: u32,
        /// What is asked.
        request: MachineRequest,
        /// Why; due for a reset.
        #[serde(default)]
        reason: Option<String>,
    },
}

/// A request to the machine, other than stop.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema, TS)]
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

/// The state of the machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(rename_all = "snake_case")]
pub enum Mode {
    /// Drive released.
    Disarmed,
    /// Finding the switches.
    Homing,
    /// Homed and holding; serves nobody.
    Ready,
    /// Armed.
    Following,
    /// Braked; clears by itself.
    ProtectiveStop,
    /// Braked and released; needs a reset.
    LatchedStop,
    /// Machine or link cannot be trusted.
    Faulted,
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

/// Everything at one moment; also the body of `GET /api/v1/state`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct Snapshot {
    /// Grows by one with each published snapshot.
    #[ts(type = "number")]
    pub generation: u64,
    /// Server time, microseconds since its start.
    #[ts(type = "number")]
    pub at_micros: i64,
    /// The state of the machine.
    pub mode: Mode,
    /// Since when, server time.
    #[ts(type = "number")]
    pub mode_since_micros: i64,
    /// Why the machine is stopped; null unless in a stop or faulted.
    pub stop: Option<StopCause>,
    /// What can be asked now, and why not.
    pub requests: Vec<RequestState>,
    /// Every safety rule, R1 first.
    pub rules: Vec<RuleState>,
    /// The column.
    pub column: Column,
    /// Everybody in the arena.
    pub persons: Vec<Person>,
    /// Every object of the active scene, in its order.
    pub objects: Vec<Object>,
    /// The intention rule in use.
    pub intention_rule: String,
    /// The control loop's health.
    pub control_loop: ControlLoop,
    /// Connected VR clients.
    pub clients: Vec<Client>,
    /// Store id of the active scene.
    pub scene_id: Option<i64>,
    /// Store id of the running session.
    pub session_id: Option<i64>,
}

/// Whether a request would be accepted now.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct RequestState {
    /// `home`, `arm`, `disarm`, `stop` or `reset`.
    pub request: String,
    /// Why it would be refused, in plain words; null if it would be accepted.
    pub refused_because: Option<String>,
    /// The same as an id and its values.
    pub why: Option<Reason>,
}

/// What stopped the machine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct StopCause {
    /// `R1` to `R16`.
    pub rule: String,
    /// What happened, in plain words.
    pub reason: String,
    /// The same as an id and its values.
    pub why: Reason,
    /// What clears it, in plain words; the same for every stop of a rule.
    pub clears_when: String,
    /// When, server time.
    #[ts(type = "number")]
    pub since_micros: i64,
}

/// How a rule stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(rename_all = "snake_case")]
pub enum RuleStatus {
    /// Kept, not in the way.
    Clear,
    /// It shapes the motion now.
    Limiting,
    /// Breached: it stops the machine.
    Breached,
    /// Nothing to watch now.
    Idle,
}

/// One safety rule.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct RuleState {
    /// `R1` to `R16`.
    pub rule: String,
    /// A short name: "travel", "tracking", ...
    pub title: String,
    /// How it stands.
    pub status: RuleStatus,
    /// In plain words, with values and units.
    pub reason: String,
    /// The same as an id and its values.
    pub why: Reason,
    /// Since when, server time.
    #[ts(type = "number")]
    pub since_micros: i64,
}

/// The column, room frame, m and m/s.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct Column {
    /// Measured centre.
    pub position_m: [f64; 2],
    /// Measured velocity.
    pub velocity_mps: [f64; 2],
    /// Commanded centre.
    pub commanded_m: [f64; 2],
    /// The spring-damper proxy.
    pub proxy_m: [f64; 2],
    /// Where it is wanted; null when nobody is served.
    pub target_m: Option<[f64; 2]>,
    /// Id of the person served.
    pub serves: Option<u32>,
    /// Id of the object that the rule is committed to.
    pub committed: Option<String>,
    /// What it is about.
    pub activity: Activity,
    /// Why it does that, in plain words, with values and units.
    pub reason: String,
    /// The same, clause by clause, each as an id and its values.
    pub why: Vec<Reason>,
    /// Where it would go from here if everybody walked on for a moment and then stood, 0.1 s apart; empty when it goes
    /// nowhere.
    pub planned_path_m: Vec<[f64; 2]>,
    /// Motor currents, A.
    pub current_amps: [f64; 2],
    /// Positions are in the room frame.
    pub homed: bool,
}

/// What the column is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(rename_all = "snake_case")]
pub enum Activity {
    /// The drive is released.
    Released,
    /// It looks for the switches.
    Homing,
    /// Homed, holding, not armed.
    Ready,
    /// Armed, and there is nobody to serve, or nothing to serve them.
    Waiting,
    /// On its way to where it is wanted.
    Approaching,
    /// On its way, slower or another way because of a safety rule.
    Yielding,
    /// It may not go on: a safety rule holds it.
    Blocked,
    /// It stands where it is wanted.
    InPlace,
    /// Stopped, or braking for a stop.
    Stopped,
}

/// The terms of the separation rule: `required_m` of a person is their sum.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct SeparationTerms {
    /// r, m.
    pub radius_m: f64,
    /// What column and person cover in the reaction time, m.
    pub reaction_m: f64,
    /// What the column covers while it brakes, m.
    pub braking_m: f64,
    /// What the person may walk while it brakes, m.
    pub walking_m: f64,
    /// What the person may have walked since the pose was taken, m.
    pub age_m: f64,
    /// The greatest of the four beyond r.
    pub binding: SeparationTerm,
}

/// A term of the separation rule.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(rename_all = "snake_case")]
pub enum SeparationTerm {
    /// Reaction time.
    Reaction,
    /// The column's braking.
    Braking,
    /// The person's walking.
    Walking,
    /// The age of the pose.
    Age,
}

/// One person, room frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct Person {
    /// The server's number of this person in this run.
    pub id: u32,
    /// The name that the client gave.
    pub name: String,
    /// Head position; null before the first pose.
    pub head_m: Option<[f64; 3]>,
    /// Heading of the view axis, rad, counter-clockwise from +x.
    pub yaw_rad: f64,
    /// Pitch of the view axis, rad, up positive.
    pub pitch_rad: f64,
    /// Age of the pose, s.
    pub pose_age_secs: f64,
    /// Tracked and worn.
    pub tracked: bool,
    /// The origin changed; a game master must confirm the floor mark (R15).
    pub awaits_confirmation: bool,
    /// r of the separation rule now, m.
    pub separation_radius_m: f64,
    /// Head axis to footprint, m.
    pub distance_m: f64,
    /// What the rule asks at the present speed, m: the sum of its terms.
    pub required_m: f64,
    /// The terms of that sum; null without a pose.
    pub separation: Option<SeparationTerms>,
    /// The column is slowed, turned aside or held because of this person.
    pub limits_column: bool,
}

/// One object of the active scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct Object {
    /// The scene's id.
    pub id: String,
    /// W, prior included.
    pub weight: f64,
    /// Share of the weight.
    pub probability: f64,
    /// The prior in force.
    pub prior: f64,
    /// Where the column's centre must stand.
    pub column_place_m: [f64; 2],
    /// Seconds until the column could be there.
    pub arrival_secs: f64,
    /// Seconds until the visitor could touch it; null without a visitor.
    pub touch_secs: Option<f64>,
}

/// The control loop's health.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct ControlLoop {
    /// Nominal rate, Hz.
    pub rate_hz: f64,
    /// Steps begun.
    #[ts(type = "number")]
    pub steps: u64,
    /// Steps begun more than one period late.
    #[ts(type = "number")]
    pub missed_deadlines: u64,
    /// 99th percentile of lateness over the last 10 s, microseconds.
    pub lateness_p99_micros: f64,
    /// Greatest lateness over the last 10 s, microseconds.
    pub lateness_max_micros: f64,
    /// The scheduler and locked memory in force, in plain words.
    pub scheduling: String,
}

/// One VR client.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct Client {
    /// The name of its hello.
    pub name: String,
    /// Its convention.
    pub convention: String,
    /// Poses accepted.
    #[ts(type = "number")]
    pub poses: u64,
    /// Poses a second over the last second.
    pub pose_rate_hz: f64,
    /// Least round trip of the clock window, ms; null before the first.
    pub rtt_millis: Option<f64>,
    /// Ids of the persons that it speaks for.
    pub persons: Vec<u32>,
    /// Greatest age that a pose had when it was received, over the last second, ms; null without poses.
    pub pose_age_millis: Option<f64>,
    /// Interarrival jitter of its poses (RFC 3550, 6.4.1), ms; null before the second pose.
    pub jitter_millis: Option<f64>,
    /// Poses missing in their sequence over the last 10 s, percent; null without poses.
    pub loss_percent: Option<f64>,
    /// Messages refused.
    #[ts(type = "number")]
    pub errors: u64,
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
    /// `person_entered`, `person_left`, `served`, `origin_changed`, `touch_began`, `touch_ended`, `scene_event`,
    /// `scene_activated`, `prior_changed`, `client_connected`, `client_gone`, `client_error`.
    pub kind: String,
    /// In plain words.
    pub summary: String,
    /// Particulars, by kind; `why` is a reason as an id and its values.
    #[ts(type = "unknown")]
    pub detail: serde_json::Value,
}

impl Event {
    /// Every kind.
    pub const KINDS: [&'static str; 18] = [
        "mode_changed",
        "rule_breached",
        "rule_cleared",
        "request_accepted",
        "request_refused",
        "stop_pressed",
        "person_entered",
        "person_left",
        "served",
        "origin_changed",
        "touch_began",
        "touch_ended",
        "scene_event",
        "scene_activated",
        "prior_changed",
        "client_connected",
        "client_gone",
        "client_error",
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
