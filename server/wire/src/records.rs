//! What is kept and what is in force, as HTTP tells it: sessions, the frames of their recordings, the configuration.
//!
//! A recorded frame is a snapshot without what only the live desk needs, rounded: lengths and angles to 0.1 mm and
//! 0.1 mrad, velocities to 1 mm/s, weights to four significant digits, probabilities to 0.0001.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ts_rs::TS;

use crate::accepts::Accepts;
use crate::dashboard::{Activity, Column, MachineShape, Mode, Object, Person, Scenario, Snapshot};
use crate::scene::ValueDocument;

/// The published state at one moment of a session, room frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct RecordedFrame {
    /// Server time, microseconds since its start; the events of a session have the same clock.
    pub at_micros: i64,
    /// The state of the machine.
    pub mode: Mode,
    /// The column.
    pub column: RecordedColumn,
    /// Everybody in the arena.
    pub persons: Vec<RecordedPerson>,
    /// Every object of the scene then in force, in its order.
    pub objects: Vec<RecordedObject>,
    /// The scenario; null where the scene had none.
    #[serde(default)]
    pub scenario: Option<RecordedScenario>,
}

/// The column in a recorded frame; see [`Column`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct RecordedColumn {
    /// Measured centre, m.
    pub position_m: [f64; 2],
    /// Measured velocity, m/s.
    pub velocity_mps: [f64; 2],
    /// Commanded centre, m.
    pub commanded_m: [f64; 2],
    /// The spring-damper proxy, m.
    pub proxy_m: [f64; 2],
    /// Where it was wanted, m; null when nobody was served.
    pub target_m: Option<[f64; 2]>,
    /// Id of the person served.
    pub serves: Option<u32>,
    /// Id of the object that the rule was committed to.
    pub committed: Option<String>,
    /// What it was about.
    pub activity: Activity,
    /// Positions are in the room frame.
    pub homed: bool,
}

/// One person in a recorded frame; see [`Person`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct RecordedPerson {
    /// The server's number of this person in that run.
    pub id: u32,
    /// The name that the client gave.
    pub name: String,
    /// Head position, m; null before the first pose.
    pub head_m: Option<[f64; 3]>,
    /// Heading of the view axis, rad, counter-clockwise from +x.
    pub yaw_rad: f64,
    /// Pitch of the view axis, rad, up positive.
    pub pitch_rad: f64,
    /// Tracked and worn.
    pub tracked: bool,
    /// r of the separation rule, m.
    pub separation_radius_m: f64,
    /// Head axis to footprint, m.
    pub distance_m: f64,
    /// What the rule asked at the speed of that moment, m.
    pub required_m: f64,
}

/// One object in a recorded frame; see [`Object`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct RecordedObject {
    /// The scene's id.
    pub id: String,
    /// W, prior included.
    pub weight: f64,
    /// Share of the weight.
    pub probability: f64,
    /// The prior in force.
    pub prior: f64,
    /// It could be served.
    #[serde(default = "yes")]
    pub enabled: bool,
}

/// The scenario in a recorded frame; see [`Scenario`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct RecordedScenario {
    /// Id of its state.
    pub state: String,
    /// For how long it had been in it, s.
    pub in_state_secs: f64,
    /// Its clock ran.
    pub runs: bool,
    /// The variables, by id.
    pub variables: BTreeMap<String, ValueDocument>,
}

/// Frames of a recording, oldest first: the body of `GET /api/v1/sessions/{id}/frames`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct RecordedFrames {
    /// Oldest first.
    pub frames: Vec<RecordedFrame>,
}

/// A session in the list: from arming to disarming, a latched stop, a fault or the end of the server.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct Session {
    /// The store's number of the session.
    pub id: i64,
    /// When the machine was armed, RFC 3339.
    pub started_at: String,
    /// When it ended; null while it runs. Of an interrupted one: the last that is known of it.
    pub ended_at: Option<String>,
    /// `disarmed`, `latched_stop`, `faulted`, `shutdown` or `interrupted`; null while it runs.
    pub how: Option<String>,
    /// The scene that was active at its start.
    pub scene_id: i64,
    /// And its version.
    pub scene_version: i64,
    /// What people call that scene.
    pub scene: String,
    /// From start to end, s; of a running session until now.
    pub length_secs: Option<f64>,
    /// Touches that clients reported (`touch_began`).
    pub reaches: u32,
    /// Those of them at whose moment the column stood at the object: its measured centre within 0.1 m of the object's
    /// place and slower than 0.05 m/s, in the published state nearest to the touch. Both are the limits of the
    /// engine's own `served` event.
    pub reaches_served: u32,
    /// Entries into a protective or a latched stop.
    pub stops: u32,
    /// Frames in its recording.
    pub recorded_frames: u64,
    /// Frames that could not be recorded in time.
    pub dropped_frames: u64,
    /// Size of its recording in the database, bytes.
    pub recording_bytes: u64,
    /// When the recording was deleted to make room (`recording.keep_days`, `recording.keep_megabytes`), RFC 3339; null
    /// while it is there, and without one.
    pub recording_removed_at: Option<String>,
}

/// One session: the body of `GET /api/v1/sessions/{id}`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct SessionDetail {
    /// As in the list.
    #[serde(flatten)]
    pub session: Session,
    /// The names of everybody who was in the arena, as their clients gave them.
    pub persons: Vec<String>,
    /// Which scene was in force from when on.
    pub scenes: Vec<SceneInForce>,
    /// Server time of its start; every `secs` of a session counts from here.
    pub first_micros: Option<i64>,
    /// Server time of its last frame or event.
    pub last_micros: Option<i64>,
    /// Column and travel at that time.
    pub machine_shape: Option<MachineShape>,
}

/// A scene in force during a session.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct SceneInForce {
    /// Store id of the scene.
    pub id: i64,
    /// Its version.
    pub version: i64,
    /// From when on, s from the session's start.
    pub from_secs: f64,
}

/// The configuration in force: the body of `GET /api/v1/config`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct ConfigInForce {
    /// The server's version.
    pub version: String,
    /// What it was built of.
    pub built: Built,
    /// The file that was read; null without one.
    pub file: Option<String>,
    /// Every key, section by section.
    pub keys: Vec<ConfigKey>,
}

/// What a server was built of.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema, TS)]
pub struct Built {
    /// `release` or `debug`.
    pub profile: String,
    /// Processor and operating system.
    pub target: String,
    /// The compiler's version.
    pub rustc: String,
    /// The commit, where the build was told (`COVR_COMMIT`).
    pub commit: Option<String>,
}

/// One key of the configuration.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct ConfigKey {
    /// `section.key`.
    pub name: String,
    /// The value in force.
    #[ts(type = "unknown")]
    pub value: serde_json::Value,
    /// The value without file, environment and command line.
    #[ts(type = "unknown")]
    pub default: serde_json::Value,
    /// What it means, with units.
    pub meaning: String,
    /// What it accepts, in English.
    pub accepts: String,
    /// The same as data.
    pub takes: Accepts,
    /// Who set it.
    pub from: ConfigOrigin,
}

/// Who set a value; each overrides those before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema, TS)]
#[serde(rename_all = "snake_case")]
pub enum ConfigOrigin {
    /// Nobody.
    #[default]
    Default,
    /// The file.
    File,
    /// A `COVR_SECTION__KEY` variable.
    Environment,
    /// An option of the command.
    CommandLine,
}

impl From<Snapshot> for RecordedFrame {
    fn from(state: Snapshot) -> Self {
        Self {
            at_micros: state.at_micros,
            mode: state.mode,
            column: state.column.into(),
            persons: state.persons.into_iter().map(Into::into).collect(),
            objects: state.objects.into_iter().map(Into::into).collect(),
            scenario: state.scenario.map(Into::into),
        }
    }
}

impl From<Column> for RecordedColumn {
    fn from(column: Column) -> Self {
        Self {
            position_m: column.position_m.map(length),
            velocity_mps: column.velocity_mps.map(|v| to_places(v, 3)),
            commanded_m: column.commanded_m.map(length),
            proxy_m: column.proxy_m.map(length),
            target_m: column.target_m.map(|at| at.map(length)),
            serves: column.serves,
            committed: column.committed,
            activity: column.activity,
            homed: column.homed,
        }
    }
}

impl From<Person> for RecordedPerson {
    fn from(person: Person) -> Self {
        Self {
            id: person.id,
            name: person.name,
            head_m: person.head_m.map(|at| at.map(length)),
            yaw_rad: length(person.yaw_rad),
            pitch_rad: length(person.pitch_rad),
            tracked: person.tracked,
            separation_radius_m: length(person.separation_radius_m),
            distance_m: length(person.distance_m),
            required_m: length(person.required_m),
        }
    }
}

impl From<Object> for RecordedObject {
    fn from(object: Object) -> Self {
        Self {
            id: object.id,
            weight: to_four_digits(object.weight),
            probability: to_places(object.probability, 4),
            prior: to_places(object.prior, 4),
            enabled: object.enabled,
        }
    }
}

impl From<Scenario> for RecordedScenario {
    fn from(scenario: Scenario) -> Self {
        Self {
            state: scenario.state,
            in_state_secs: to_places(scenario.in_state_secs, 2),
            runs: scenario.runs,
            variables: scenario.variables,
        }
    }
}

/// Recordings of before there were scenarios say nothing of what is enabled.
const fn yes() -> bool {
    true
}

fn length(value: f64) -> f64 {
    to_places(value, 4)
}

/// Rounded to so many decimals, so that its shortest decimal form is short.
fn to_places(value: f64, places: i32) -> f64 {
    let scale = 10.0_f64.powi(places);
    let rounded = (value * scale).round() / scale;
    // No negative zero, which would be written differently; and what is not finite stays what it is.
    if rounded == 0.0 { 0.0 } else { rounded }
}

fn to_four_digits(value: f64) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    let places = 3 - value.abs().log10().floor() as i32;
    // Far below anything that a weight can mean, and beyond what a power of ten can scale.
    if places > 12 { 0.0 } else { to_places(value, places) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_keeps_what_is_promised() {
        assert_eq!(length(1.234_56), 1.234_6);
        assert_eq!(length(-0.000_01).to_string(), "0");
        assert_eq!(to_four_digits(0.000_123_456), 0.000_123_5);
        assert_eq!(to_four_digits(123_456.0), 123_500.0);
        assert_eq!(to_four_digits(1e-20), 0.0);
        assert_eq!(to_four_digits(0.0), 0.0);
    }
}
