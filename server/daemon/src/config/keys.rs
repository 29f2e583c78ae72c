//! Every key: its name, its meaning, what it accepts and the place that it fills. The reference text, the
//! example file and the errors all come from this one table.

mod links;
mod odrive;
mod place;
mod roboclaw;

use covr_wire::accepts::Accepts;
use toml::Value;

pub use links::out_of_order;
use place::Place;

use super::Config;

/// One key.
#[derive(Clone)]
pub struct Key {
    /// `section.key`.
    pub name: &'static str,
    /// What it means, with units.
    pub meaning: &'static str,
    /// What it accepts.
    pub accepts: Accepts,
    place: Place,
}

/// Every key, section by section.
pub fn all() -> Vec<Key> {
    let mut keys = vec![
        Key::new(
            "server.bind",
            "Where the server listens. Another address than this machine's own needs TLS and a token, or server.insecure_lan.",
            Place::Address(|c| &mut c.server.bind),
        ),
        Key::new(
            "server.database",
            "The SQLite file of scenes, sessions, events and prior changes; made when missing.",
            Place::Path(|c| &mut c.server.database),
        ),
        Key::new(
            "server.tls_certificate",
            "The certificate for TLS, a PEM file; covr cert makes one. Empty: no TLS.",
            Place::PathOrNone(|c| &mut c.server.tls_certificate),
        ),
        Key::new(
            "server.tls_key",
            "The certificate's key, a PEM file.",
            Place::PathOrNone(|c| &mut c.server.tls_key),
        ),
        Key::new(
            "server.insecure_lan",
            "Let the network reach a server without tokens or TLS: with the simulated machine alone.",
            Place::Switch(|c| &mut c.server.insecure_lan),
        ),
        Key::new(
            "server.requests_per_sec",
            "Most requests of one address in a second, five times as many in a burst. The stop is never counted.",
            Place::Whole(1..=100_000, |c| &mut c.server.requests_per_sec),
        ),
        Key::new(
            "server.header_timeout_secs",
            "Longest time for a connection's TLS handshake, and for the head of each request, s. Also how long an idle connection is kept.",
            Place::Number(0.1..=60.0, |c| &mut c.server.header_timeout_secs),
        ),
        Key::new(
            "server.request_timeout_secs",
            "Longest time that an HTTP request may take, s.",
            Place::Number(1.0..=120.0, |c| &mut c.server.request_timeout_secs),
        ),
        Key::new(
            "server.rest_timeout_secs",
            "Longest time that the machine may take to come to rest at shutdown, s.",
            Place::Number(0.5..=30.0, |c| &mut c.server.rest_timeout_secs),
        ),
        Key::new(
            "access.login_hours",
            "How long a browser stays signed in, hours. Afterwards the page still shows what happens and can stop, and asks for the token.",
            Place::Number(0.1..=720.0, |c| &mut c.access.login_hours),
        ),
        Key::new(
            "control.rate_hz",
            "Rate of the control loop, Hz.",
            Place::Number(50.0..=1_000.0, |c| &mut c.control.rate_hz),
        ),
        Key::new(
            "control.publish_hz",
            "Snapshots published to dashboards and clients, Hz.",
            Place::Number(1.0..=120.0, |c| &mut c.control.publish_hz),
        ),
        Key::new(
            "control.request_queue",
            "Requests that may wait for the control loop before the next is refused as busy. Stop has lanes of its own.",
            Place::Whole(1..=4_096, |c| &mut c.control.request_queue),
        ),
        Key::new(
            "control.real_time",
            "Ask for SCHED_FIFO and locked memory; the server says when it does not get them.",
            Place::Switch(|c| &mut c.control.real_time),
        ),
        Key::new("control.priority", "SCHED_FIFO priority.", Place::Priority(|c| &mut c.control.priority)),
        Key::new("machine.kind", "The machine that is driven.", Place::Machine(|c| &mut c.machine.kind)),
        Key::new(
            "machine.travel_m",
            "Travel limits of the column's centre [min_x, min_y, max_x, max_y], m, room frame.",
            Place::Rectangle(|c| &mut c.machine.travel_m),
        ),
        Key::new(
            "machine.parked_x_m",
            "Where the column is parked when the power comes on, x, m, room frame. Until it is homed, people are kept 0.3 m farther from there. The simulated machine starts there.",
            Place::Number(-100.0..=100.0, |c| &mut c.machine.parked_x_m),
        ),
        Key::new(
            "machine.parked_y_m",
            "The same, y, m.",
            Place::Number(-100.0..=100.0, |c| &mut c.machine.parked_y_m),
        ),
        Key::new(
            "machine.x.speed_mps",
            "Greatest speed along the long rail, m/s.",
            speed(|c| &mut c.machine.x.speed_mps),
        ),
        Key::new(
            "machine.x.acceleration_mps2",
            "Greatest acceleration along the long rail, m/s2.",
            acceleration(|c| &mut c.machine.x.acceleration_mps2),
        ),
        Key::new(
            "machine.x.braking_mps2",
            "Greatest deceleration along the long rail, as the brake test showed it, m/s2.",
            acceleration(|c| &mut c.machine.x.braking_mps2),
        ),
        Key::new(
            "machine.x.jerk_mps3",
            "Greatest jerk along the long rail, m/s3.",
            jerk(|c| &mut c.machine.x.jerk_mps3),
        ),
        Key::new(
            "machine.y.speed_mps",
            "Greatest speed along the cross rail, m/s.",
            speed(|c| &mut c.machine.y.speed_mps),
        ),
        Key::new(
            "machine.y.acceleration_mps2",
            "Greatest acceleration along the cross rail, m/s2.",
            acceleration(|c| &mut c.machine.y.acceleration_mps2),
        ),
        Key::new(
            "machine.y.braking_mps2",
            "Greatest deceleration along the cross rail, as the brake test showed it, m/s2.",
            acceleration(|c| &mut c.machine.y.braking_mps2),
        ),
        Key::new(
            "machine.y.jerk_mps3",
            "Greatest jerk along the cross rail, m/s3.",
            jerk(|c| &mut c.machine.y.jerk_mps3),
        ),
    ];
    keys.extend(roboclaw::keys());
    keys.extend(odrive::keys());
    keys.extend([
        Key::new(
            "safety.game_master",
            "Whether a game master's dashboard must be connected to arm (R11): \"always\", \"never\", or \"by_machine\": for every machine but the simulated one.",
            Place::GameMaster(|c| &mut c.safety.game_master),
        ),
        Key::new(
            "safety.inputs",
            "Digital inputs: of kind \"stop\" (latched, R4) or \"intruder\" (protective stop, R12), from a serial port, a pseudo-terminal or a FIFO with a line \
             \"0\" or \"1\" at least every heartbeat_timeout_secs, or from a GPIO's value file. Silent, cut or garbled counts as active.",
            Place::Inputs(|c| &mut c.safety.inputs),
        ),
        Key::new(
            "people.intention_rule",
            "The intention rule, by name.",
            Place::Rule(|c| &mut c.people.intention_rule),
        ),
        Key::new(
            "people.intention_parameters",
            "A file of parameters for the intention rule, as covr fit writes it; empty for those by default.",
            Place::PathOrNone(|c| &mut c.people.intention_parameters),
        ),
        Key::new(
            "people.standing",
            "Where the column stands while it is not plain what will be touched: the weighted mean, or where it will most likely be in time. \"rule\": as the intention rule has it.",
            Place::Standing(|c| &mut c.people.standing),
        ),
        Key::new(
            "people.motion",
            "How the column is moved: the planner's quickest way, or the paper's proxy on a spring.",
            Place::Motion(|c| &mut c.people.motion),
        ),
        Key::new(
            "people.v_h_mps",
            "v_h of the separation rule: how fast a person is assumed to come nearer, m/s (ISO 13855: 1.6).",
            Place::Number(1.6..=3.0, |c| &mut c.people.v_h_mps),
        ),
        Key::new(
            "recording.enabled",
            "Record every session at control.publish_hz.",
            Place::Switch(|c| &mut c.recording.enabled),
        ),
        Key::new(
            "recording.keep_days",
            "Days after its session's end at which a recording is deleted; 0: never. The session itself and its events stay.",
            Place::Whole(0..=36_500, |c| &mut c.recording.keep_days),
        ),
        Key::new(
            "recording.keep_megabytes",
            "Size of all recordings together above which the oldest are deleted, MB; 0: any. An hour takes about 5 to 120. Space is used again; the file does not shrink.",
            Place::Whole(0..=100_000_000, |c| &mut c.recording.keep_megabytes),
        ),
        Key::new("clients.most", "VR clients at once.", Place::Whole(1..=64, |c| &mut c.clients.most)),
        Key::new(
            "clients.persons_each",
            "Persons that one VR client may speak for; its message rate grows with them.",
            Place::Whole(1..=16, |c| &mut c.clients.persons_each),
        ),
        Key::new(
            "clients.hello_timeout_secs",
            "Longest time from connection to hello, s.",
            Place::Number(0.1..=60.0, |c| &mut c.clients.hello_timeout_secs),
        ),
        Key::new(
            "clients.silence_timeout_secs",
            "Silence after which a VR client counts as gone, s.",
            Place::Number(0.5..=120.0, |c| &mut c.clients.silence_timeout_secs),
        ),
        Key::new(
            "clients.tracking_origin_m",
            "Where the room has the origin of the headsets' tracking space [x, y, z], m.",
            Place::Point(|c| &mut c.clients.tracking_origin_m),
        ),
        Key::new(
            "clients.tracking_yaw_rad",
            "How the tracking space is turned against the room, counter-clockwise about +z, rad.",
            Place::Number(-3.2..=3.2, |c| &mut c.clients.tracking_yaw_rad),
        ),
        Key::new(
            "clients.allowed_origins",
            "Pages of other sites that may connect as VR clients, by their Origin: \"http://localhost:5173\" for a page under development. \
             A page opened from a file has \"file://\" or \"null\", by browser; so has any site's sandboxed frame \"null\". The \
             server's own pages and programs always may.",
            Place::Origins(|c| &mut c.clients.allowed_origins),
        ),
        Key::new(
            "dashboards.most",
            "Dashboards at once.",
            Place::Whole(1..=1_000, |c| &mut c.dashboards.most),
        ),
        Key::new(
            "dashboards.event_queue",
            "Events that may wait for a slow dashboard before it is disconnected to start afresh.",
            Place::Whole(16..=65_536, |c| &mut c.dashboards.event_queue),
        ),
    ]);
    keys.extend(links::keys());
    keys.extend([
        Key::new(
            "log.format",
            "Log lines as text for people or as JSON.",
            Place::LogFormat(|c| &mut c.log.format),
        ),
        Key::new(
            "log.level",
            "error, warn, info, debug, trace, or directives such as \"info,covr_server=debug\".",
            Place::Text(|c| &mut c.log.level),
        ),
    ]);
    keys
}

impl Key {
    fn new(name: &'static str, meaning: &'static str, place: Place) -> Self {
        Self { name, meaning, accepts: place.accepts(), place }
    }

    /// Put a value in its place; false when it is not what the key accepts.
    pub fn set(&self, config: &mut Config, value: &Value) -> bool {
        self.place.set(config, value).is_some()
    }

    /// The value in force.
    pub fn value(&self, config: &Config) -> Value {
        self.place.value(config)
    }
}

fn speed(place: fn(&mut Config) -> &mut f64) -> Place {
    Place::Number(0.05..=3.0, place)
}

fn acceleration(place: fn(&mut Config) -> &mut f64) -> Place {
    Place::Number(0.1..=20.0, place)
}

fn jerk(place: fn(&mut Config) -> &mut f64) -> Place {
    Place::Number(1.0..=1_000.0, place)
}
