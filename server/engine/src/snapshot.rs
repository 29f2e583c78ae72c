//! The engine's published state: one whole value, made on demand, never patched.

use crate::frames::{Floor, Planar, Pose, Room};
use crate::mode::{Mode, RequestKind};
use crate::observation::PersonId;
use crate::reason::Reason;
use crate::safety::separation::Terms;
use crate::scenario::Value;
use crate::time::Time;

/// Everything that a dashboard or a client may see of the engine at one moment.
#[derive(Debug, Clone, PartialEq)]
pub struct Snapshot {
    /// When it was taken.
    pub at: Time,
    /// The state of the machine.
    pub mode: Mode,
    /// Since when.
    pub mode_since: Time,
    /// Why the machine is stopped, in a stop.
    pub stop: Option<StopCause>,
    /// For each request: none if it would be accepted now, else why not.
    pub refusals: Vec<(RequestKind, Option<Reason>)>,
    /// Every safety rule, in the order of their numbers.
    pub rules: Vec<RuleState>,
    /// The column.
    pub column: ColumnState,
    /// Everybody in the arena, by id.
    pub persons: Vec<PersonState>,
    /// Every object of the scene, in the scene's order.
    pub objects: Vec<ObjectState>,
    /// The scenario; none where the scene has none.
    pub scenario: Option<ScenarioState>,
    /// The interaction under way.
    pub interaction: Option<InteractionState>,
    /// For whom a contact is armed (R14).
    pub contact: Option<ContactState>,
    /// Who leans on the column or rides it, as far as is known: a stop keeps the drive on.
    pub bears: Option<PersonId>,
    /// The intention rule in use, by name.
    pub intention_rule: &'static str,
    /// Where the column stands while it is not plain what will be touched, by name.
    pub standing: &'static str,
    /// How the column is moved, by name.
    pub motion: &'static str,
    /// The share of the weight that says "none of them", where the rule knows it; else 0.
    pub none_probability: f64,
}

/// A safety rule's id, R1 to R16.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct RuleId(pub u8);

/// What stopped the machine.
#[derive(Debug, Clone, PartialEq)]
pub struct StopCause {
    /// The rule.
    pub rule: RuleId,
    /// What happened. What clears it is the same for every stop of a rule.
    pub reason: Reason,
    /// When.
    pub since: Time,
}

/// How a rule stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RuleStatus {
    /// Kept, and not in the way.
    Clear,
    /// It shapes the motion now: slower, another way, or away.
    Limiting,
    /// Breached: it caused a stop or holds one.
    Breached,
    /// Nothing to watch now (no machine answer, nobody there).
    Idle,
}

/// One rule now.
#[derive(Debug, Clone, PartialEq)]
pub struct RuleState {
    /// The rule.
    pub rule: RuleId,
    /// How it stands.
    pub status: RuleStatus,
    /// Why.
    pub reason: Reason,
    /// Since when it has stood so.
    pub since: Time,
}

/// The column now, room frame.
#[derive(Debug, Clone, PartialEq)]
pub struct ColumnState {
    /// Measured centre.
    pub position: Floor,
    /// Measured velocity, m/s.
    pub velocity: Planar,
    /// Commanded centre.
    pub commanded: Floor,
    /// Commanded velocity, m/s.
    pub commanded_velocity: Planar,
    /// The spring-damper proxy.
    pub proxy: Floor,
    /// Where it is wanted (the command position); none when nobody is served.
    pub target: Option<Floor>,
    /// The visitor served.
    pub serves: Option<PersonId>,
    /// The object it is committed to, as an index into `objects`.
    pub committed: Option<usize>,
    /// What it is about.
    pub activity: Activity,
    /// What keeps it from moving as wanted, in `following`.
    pub held_by: Option<HeldBy>,
    /// It is led around somebody who stands in its way.
    pub goes_around: bool,
    /// When it will be where it is wanted by the way that it takes now, s from now; none when nobody is served, and
    /// when the way does not lead there as far ahead as the planner looks.
    pub arrival_secs: Option<f64>,
    /// When it could be there at its limits with nobody in the way, s from now; none when nobody is served.
    pub least_arrival_secs: Option<f64>,
    /// The greatest speed of a jog as things are, m/s; none where none is taken.
    pub jog_speed_mps: Option<f64>,
    /// Motor currents x, y, A.
    pub current_amps: [f64; 2],
    /// Where the second, slow approach of the last homing found each switch or stop, less where its first, faster one did, m; none before it, and for a
    /// machine that does not tell.
    pub home_repeatability_m: Option<[f64; 2]>,
    /// Positions are in the room frame.
    pub homed: bool,
}

/// What the column is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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

/// What keeps the column from moving as wanted, with the distance on its brake path and the distance needed there.
#[derive(Debug, Clone, PartialEq)]
pub struct HeldBy {
    /// Whom or what it would come too near.
    pub holder: Holder,
    /// The distance that there would be, m.
    pub distance_m: f64,
    /// The distance that a safety rule asks, m.
    pub required_m: f64,
}

/// Whom or what the column would come too near.
#[derive(Debug, Clone, PartialEq)]
pub enum Holder {
    /// A person (R3).
    Person(PersonId),
    /// A keep-out shape, by its id in the scene (R13).
    KeepOut(String),
    /// The travel's end (R1).
    Travel,
}

/// One person now, room frame.
#[derive(Debug, Clone, PartialEq)]
pub struct PersonState {
    /// Who.
    pub person: PersonId,
    /// Last known head pose; none before the first.
    pub pose: Option<Pose<Room>>,
    /// Age of that pose, s.
    pub pose_age_secs: f64,
    /// The headset knows its place and is worn.
    pub tracked: bool,
    /// The origin changed and nobody has confirmed the person on the floor mark (R15).
    pub awaits_confirmation: bool,
    /// Radius r of the separation rule for this head now, m.
    pub separation_radius_m: f64,
    /// Distance from the head axis to the footprint, m.
    pub distance_m: f64,
    /// What the separation rule asks at the present speed, term by term; none before the first pose.
    pub separation: Option<Terms>,
    /// What the separation rule asks at the present speed, m: the sum of the terms.
    pub required_m: f64,
    /// The column is slower, elsewhere or at rest because of this person now.
    pub limits_column: bool,
}

/// One object now.
#[derive(Debug, Clone, PartialEq)]
pub struct ObjectState {
    /// The scene's id of the object.
    pub id: String,
    /// W of the rule for the served visitor, prior included.
    pub weight: f64,
    /// The share of the weight: the probability that the rule gives it.
    pub probability: f64,
    /// The prior in force.
    pub prior: f64,
    /// It can be served now.
    pub enabled: bool,
    /// Where the column's centre must stand to serve it.
    pub column_place: Floor,
    /// When the column is in place for it, s from now: by the plan that it drives now where that leads there, people in
    /// the way and soft start included, else at its limits from rest; 0 while it is in place (within 0.1 m, at rest).
    pub arrival_secs: f64,
    /// When the visitor's hand could be at it, s from now; none without a visitor.
    pub touch_secs: Option<f64>,
    /// How much later than the hand the column is in place, s; negative: earlier; none without a visitor.
    pub late_by_secs: Option<f64>,
    /// The probability that it is in place before the hand, 0 to 1; none without a visitor.
    pub in_time_probability: Option<f64>,
    /// The shift of the virtual object, m, by which it is where its prop will be when the hand comes, within what nobody
    /// notices; none where the column makes for something else, and where no shift is needed or would serve.
    pub offset: Option<Planar>,
    /// Between the visitor's view axis and it, rad; none without a visitor.
    pub angle_rad: Option<f64>,
    /// From the visitor's head to its surface, m; none without a visitor.
    pub distance_m: Option<f64>,
}

/// The interaction under way.
#[derive(Debug, Clone, PartialEq)]
pub struct InteractionState {
    /// Its object, as an index into `objects`.
    pub object: usize,
    /// Which, by name.
    pub interaction: &'static str,
    /// What it is about, by name.
    pub phase: &'static str,
    /// With whom, where it is with somebody.
    pub person: Option<PersonId>,
    /// For how long it has been under way, s.
    pub lasted_secs: f64,
}

/// A contact armed for a visitor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactState {
    /// Who.
    pub person: PersonId,
    /// It ends by itself in so long, s.
    pub left_secs: f64,
}

/// The scenario now; states and variables by id.
#[derive(Debug, Clone, PartialEq)]
pub struct ScenarioState {
    /// The state.
    pub state: String,
    /// For how long, on the scenario's clock, s.
    pub in_state_secs: f64,
    /// Its clock runs: the machine follows people.
    pub runs: bool,
    /// States entered in this run.
    pub entered: usize,
    /// The variables.
    pub variables: Vec<(String, Value)>,
    /// The ways on from here, in the order in which they are looked at.
    pub next: Vec<NextState>,
    /// The state that a rewind leads to.
    pub before: Option<String>,
    /// Where the last run ended, if it got beyond its beginning and no other has begun since.
    pub left_in: Option<String>,
    /// Its transitions went in a circle and wait for something to happen.
    pub is_cut: bool,
}

/// A way on.
#[derive(Debug, Clone, PartialEq)]
pub struct NextState {
    /// It is one of those from anywhere.
    pub is_from_anywhere: bool,
    /// Its index there, or among the state's own.
    pub index: usize,
    /// The state that it leads to; none: it stays.
    pub to: Option<String>,
    /// In how many seconds its condition holds if everybody goes on with what they do, 0: now; none: time alone will not do.
    pub due_secs: Option<f64>,
}

impl RuleId {
    /// Its number as people write it.
    pub fn name(self) -> String {
        format!("R{}", self.0)
    }
}
