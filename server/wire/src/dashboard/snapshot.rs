//! The whole state at one moment, as dashboards and `GET /api/v1/state` have it: room frame, SI units.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ts_rs::TS;

use super::MachineHealth;
use crate::reason::Reason;
use crate::scene::ValueDocument;

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
    /// The scenario; null where the active scene has none.
    pub scenario: Option<Scenario>,
    /// The interaction under way; null: none.
    #[serde(default)]
    pub interaction: Option<Interaction>,
    /// For whom a contact is armed (R14); null: nobody.
    #[serde(default)]
    pub contact: Option<Contact>,
    /// Who leans on the column or rides it, as far as is known: a stop keeps the drive on until they let go, or until a game master says
    /// that nobody does (`confirm_free`); null: nobody.
    #[serde(default)]
    pub bears: Option<u32>,
    /// The intention rule in use.
    pub intention_rule: String,
    /// Where the column stands while it is not plain what will be touched, by name.
    pub standing: String,
    /// How the column is moved, by name.
    pub motion: String,
    /// The share of the belief that says "none of them", 0 to 1; 0 for a rule that does not know it.
    pub none_probability: f64,
    /// The control loop's health.
    pub control_loop: ControlLoop,
    /// The machine's boards and link; null for a machine without any.
    pub machine_health: Option<MachineHealth>,
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
    /// `home`, `arm`, `disarm`, `stop`, `reset` or `jog`.
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
    /// Why, decision by decision; null while it does not follow, and when nobody is served.
    pub decision: Option<Decision>,
    /// When it will be where it is wanted by the way that it takes now, s; null where that is not known, and when nobody
    /// is served.
    pub arrival_secs: Option<f64>,
    /// Where it would go from here if everybody walked on for a moment and then stood, 0.1 s apart; empty when it goes
    /// nowhere.
    pub planned_path_m: Vec<[f64; 2]>,
    /// The greatest speed of a jog as things are, m/s; null where the mode allows none.
    pub jog_speed_mps: Option<f64>,
    /// Motor currents, A.
    pub current_amps: [f64; 2],
    /// Where the second, slow approach of the last homing found each switch or stop, less where its first, faster one did, m; null before it,
    /// and for a machine that does not tell.
    pub home_repeatability_m: Option<[f64; 2]>,
    /// Positions are in the room frame.
    pub homed: bool,
}

/// Why the column does what it does, decision by decision: each as ids with their values.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct Decision {
    /// Why the rule believes what it believes.
    pub belief: Vec<Reason>,
    /// Why it is wanted where it is wanted.
    pub place: Vec<Reason>,
    /// Why it takes the way that it takes.
    pub route: Vec<Reason>,
    /// What the time until it is there is made of.
    pub arrival: Vec<Reason>,
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
    /// Moved by hand, for as long as somebody holds the button.
    Jogged,
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
    /// An interaction is under way.
    Interacting,
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
    /// It can be served now.
    pub enabled: bool,
    /// Where the column's centre must stand.
    pub column_place_m: [f64; 2],
    /// Seconds until the column is in place for it: by the way that it takes now, people in the way included, where that
    /// leads there, else at its limits; 0 while it is in place.
    pub arrival_secs: f64,
    /// Seconds until the visitor's hand could be at it; null without a visitor.
    pub touch_secs: Option<f64>,
    /// How much later than the hand the column is in place, s; negative: earlier; null without a visitor.
    pub late_by_s: Option<f64>,
    /// The probability that it is in place before the hand, 0 to 1; null without a visitor.
    pub in_time_probability: Option<f64>,
    /// Between the visitor's view axis and it, rad; null without a visitor.
    pub angle_rad: Option<f64>,
    /// From the visitor's head to its surface, m; null without a visitor.
    pub distance_m: Option<f64>,
}

/// The interaction under way.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct Interaction {
    /// Id of its object.
    pub object: String,
    /// `hold`, `step_back`, `lead`, `transport`, `brush` or `park`.
    pub interaction: String,
    /// What it is about: `waiting`, `holding`, `stepping_back`, `leading`, `riding`, `approaching`, `touching`, `leaving`, `parked` or `done`.
    pub phase: String,
    /// With whom; null where it is with nobody.
    pub person: Option<u32>,
    /// For how long it has been under way, s.
    pub lasted_secs: f64,
}

/// A contact armed for a visitor (R14): a moving column may touch them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct Contact {
    /// Who.
    pub person: u32,
    /// It ends by itself in so long, s.
    pub left_secs: f64,
}

/// The scenario now. Its states and transitions are in the scene's document.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct Scenario {
    /// Id of its state.
    pub state: String,
    /// For how long it has been in it, s, on a clock that stands while the machine does not follow people.
    pub in_state_secs: f64,
    /// That clock runs.
    pub runs: bool,
    /// States entered since the run began.
    #[ts(type = "number")]
    pub entered: usize,
    /// The variables, by id.
    pub variables: BTreeMap<String, ValueDocument>,
    /// The ways on from here, in the order in which they are looked at.
    pub next: Vec<NextState>,
    /// Id of the state that a rewind leads to; null at the beginning.
    pub before: Option<String>,
    /// Id of the state that the last run ended in, if it got beyond its beginning and no other has begun since.
    pub left_in: Option<String>,
    /// Its transitions went in a circle and wait for something to happen.
    pub is_cut: bool,
}

/// A way on from the scenario's state.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct NextState {
    /// It is one of the scenario's `anywhere`, else one of the state's `transitions`.
    pub is_from_anywhere: bool,
    /// Its index there.
    #[ts(type = "number")]
    pub index: usize,
    /// Id of the state that it leads to; null: the state stays.
    pub to: Option<String>,
    /// In how many seconds its condition holds if everybody goes on with what they do, 0: it does; null: time alone will not do.
    pub due_secs: Option<f64>,
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
    /// The same as ids and their values.
    pub scheduling_why: Vec<Reason>,
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
