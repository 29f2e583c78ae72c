//! The configuration: one TOML file, every key documented, unknown keys refused by name.
//!
//! Values are right once loaded: each key knows what it accepts, and a refusal names the key, what was
//! found and what was expected. `COVR_SECTION__KEY` in the environment overrides the file.

mod inputs;
mod intention;
mod keys;
mod load;
mod odrive;
mod origins;
mod roboclaw;

use std::net::SocketAddr;
use std::path::PathBuf;

use covr_engine::frames::Floor;
use covr_engine::intention::RuleName;
use covr_engine::machine::{AxisLimits, Limits, Travel};
use covr_engine::motion::MotionName;
use covr_engine::motion::standing::StandingName;
use covr_wire::dashboard::LinkThresholds;

pub use inputs::{Input, InputKind, Level};
pub use intention::ParametersRefused;
pub use keys::{Key, all as keys};
pub use load::{ConfigError, load, load_text, reference};
pub use odrive::Odrive;
pub use origins::{Loaded, Origins};
pub use roboclaw::RoboClaw;

/// Everything that can be configured.
#[derive(Debug, Clone, PartialEq)]
pub struct Config {
    /// Sockets and files.
    pub server: Server,
    /// Who may do what.
    pub access: Access,
    /// The control loop.
    pub control: Control,
    /// The machine.
    pub machine: Machine,
    /// What watches the arena beside the headsets.
    pub safety: Safety,
    /// What is known of people.
    pub people: People,
    /// The recording of sessions.
    pub recording: Recording,
    /// VR clients.
    pub clients: Clients,
    /// Dashboards.
    pub dashboards: Dashboards,
    /// From where on links are shown as weak and bad.
    pub links: LinkThresholds,
    /// Logs.
    pub log: Log,
}

/// Sockets and files.
#[derive(Debug, Clone, PartialEq)]
pub struct Server {
    /// Where to listen.
    pub bind: SocketAddr,
    /// The database file.
    pub database: PathBuf,
    /// The certificate for TLS, PEM; none: no TLS.
    pub tls_certificate: Option<PathBuf>,
    /// Its key, PEM.
    pub tls_key: Option<PathBuf>,
    /// The network may reach a server without tokens and TLS: with the simulated machine alone.
    pub insecure_lan: bool,
    /// Most requests of one address in a second.
    pub requests_per_sec: usize,
    /// Longest time for a connection's TLS handshake and for each request's head, s.
    pub header_timeout_secs: f64,
    /// Longest time that an HTTP request may take, s.
    pub request_timeout_secs: f64,
    /// Longest time that the machine may take to come to rest at shutdown, s.
    pub rest_timeout_secs: f64,
}

/// Who may do what.
#[derive(Debug, Clone, PartialEq)]
pub struct Access {
    /// How long a browser stays signed in, hours.
    pub login_hours: f64,
}

/// The control loop.
#[derive(Debug, Clone, PartialEq)]
pub struct Control {
    /// Rate, Hz.
    pub rate_hz: f64,
    /// Published snapshots a second, Hz.
    pub publish_hz: f64,
    /// Requests that may wait for the loop.
    pub request_queue: usize,
    /// Ask for real-time scheduling and locked memory.
    pub real_time: bool,
    /// SCHED_FIFO priority.
    pub priority: u8,
}

/// The machine.
#[derive(Debug, Clone, PartialEq)]
pub struct Machine {
    /// Which machine.
    pub kind: MachineKind,
    /// Travel limits `[min_x, min_y, max_x, max_y]`, m.
    pub travel_m: [f64; 4],
    /// Where the column is parked when the power comes on, m.
    pub parked_x_m: f64,
    /// See `parked_x_m`.
    pub parked_y_m: f64,
    /// The long rail.
    pub x: AxisLimits,
    /// The cross rail.
    pub y: AxisLimits,
    /// What a RoboClaw machine needs beside.
    pub roboclaw: RoboClaw,
    /// What an ODrive machine needs beside.
    pub odrive: Odrive,
}

/// What watches the arena beside the headsets.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Safety {
    /// When a game master's dashboard must be connected to arm (R11).
    pub game_master: GameMasterNeeded,
    /// Digital inputs.
    pub inputs: Vec<Input>,
}

/// When arming needs a game master's dashboard.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum GameMasterNeeded {
    /// With every machine but the simulated one.
    #[default]
    ByMachine,
    /// With every machine.
    Always,
    /// With none.
    Never,
}

/// Which machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MachineKind {
    /// The simulated machine.
    Simulated,
    /// One or two RoboClaws.
    RoboClaw,
    /// An ODrive.
    Odrive,
}

/// What is known of people.
#[derive(Debug, Clone, PartialEq)]
pub struct People {
    /// The intention rule.
    pub intention_rule: RuleName,
    /// A file of parameters for it, as `covr fit` writes them; none: those by default.
    pub intention_parameters: Option<PathBuf>,
    /// Where the column stands while it is not plain what will be touched; none: as the rule has it.
    pub standing: Option<StandingName>,
    /// How the column is moved.
    pub motion: MotionName,
    /// v_h of the separation rule, m/s.
    pub v_h_mps: f64,
}

/// The recording of sessions.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Recording {
    /// Whether sessions are recorded.
    pub enabled: bool,
    /// Days after which a recording is deleted; 0: never.
    pub keep_days: usize,
    /// Most of all recordings together, MB; 0: any.
    pub keep_megabytes: usize,
}

/// VR clients.
#[derive(Debug, Clone, PartialEq)]
pub struct Clients {
    /// Most at once.
    pub most: usize,
    /// Most persons of one client.
    pub persons_each: usize,
    /// Longest time from connection to hello, s.
    pub hello_timeout_secs: f64,
    /// Silence after which a client counts as gone, s.
    pub silence_timeout_secs: f64,
    /// Where the room has the origin of the headsets' tracking space, m.
    pub tracking_origin_m: [f64; 3],
    /// How the tracking space is turned against the room, counter-clockwise about +z, rad.
    pub tracking_yaw_rad: f64,
    /// Origins of other sites' pages that may connect as VR clients.
    pub allowed_origins: Vec<String>,
}

/// Dashboards.
#[derive(Debug, Clone, PartialEq)]
pub struct Dashboards {
    /// Most at once.
    pub most: usize,
    /// Events that may wait for one dashboard before it is disconnected.
    pub event_queue: usize,
}

/// Logs.
#[derive(Debug, Clone, PartialEq)]
pub struct Log {
    /// Text for people, JSON for machines.
    pub format: LogFormat,
    /// `error`, `warn`, `info`, `debug`, `trace`, or directives such as `info,covr_server=debug`.
    pub level: String,
}

/// How a log line looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum LogFormat {
    /// For people.
    Text,
    /// For machines.
    Json,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            server: Server {
                bind: SocketAddr::from(([127, 0, 0, 1], 7878)),
                database: PathBuf::from("covr.sqlite"),
                tls_certificate: None,
                tls_key: None,
                insecure_lan: false,
                requests_per_sec: 200,
                header_timeout_secs: 10.0,
                request_timeout_secs: 10.0,
                rest_timeout_secs: 3.0,
            },
            access: Access { login_hours: 12.0 },
            control: Control {
                rate_hz: 250.0,
                publish_hz: 30.0,
                request_queue: 64,
                real_time: true,
                priority: 60,
            },
            machine: Machine {
                kind: MachineKind::Simulated,
                travel_m: [0.0, 0.0, 4.0, 4.0],
                parked_x_m: 0.3,
                parked_y_m: 0.3,
                x: AxisLimits::PAPER,
                y: AxisLimits::PAPER,
                roboclaw: RoboClaw::default(),
                odrive: Odrive::default(),
            },
            safety: Safety::default(),
            people: People {
                intention_rule: RuleName::Bayes,
                intention_parameters: None,
                standing: None,
                motion: MotionName::Planner,
                v_h_mps: 1.6,
            },
            recording: Recording { enabled: true, keep_days: 365, keep_megabytes: 20_000 },
            clients: Clients {
                most: 8,
                persons_each: 2,
                hello_timeout_secs: 5.0,
                silence_timeout_secs: 10.0,
                tracking_origin_m: [0.0; 3],
                tracking_yaw_rad: 0.0,
                allowed_origins: Vec::new(),
            },
            dashboards: Dashboards { most: 32, event_queue: 1_024 },
            links: LinkThresholds::USUAL,
            log: Log { format: LogFormat::Text, level: "info".into() },
        }
    }
}

impl Config {
    /// Whether arming needs a game master's dashboard (R11).
    pub fn needs_game_master(&self) -> bool {
        match self.safety.game_master {
            GameMasterNeeded::ByMachine => !self.machine.kind.is_simulated(),
            GameMasterNeeded::Always => true,
            GameMasterNeeded::Never => false,
        }
    }
}

impl GameMasterNeeded {
    /// Every choice.
    pub const ALL: [Self; 3] = [Self::ByMachine, Self::Always, Self::Never];

    /// The name on every surface.
    pub const fn name(self) -> &'static str {
        match self {
            Self::ByMachine => "by_machine",
            Self::Always => "always",
            Self::Never => "never",
        }
    }

    /// The choice of this name.
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|needed| needed.name() == name)
    }
}

impl Server {
    /// Whether it speaks TLS.
    pub fn is_encrypted(&self) -> bool {
        self.tls_certificate.is_some()
    }
}

impl Machine {
    /// The limits of both axes.
    pub fn limits(&self) -> Limits {
        Limits { x: self.x, y: self.y }
    }

    /// Whether nothing moves that could hurt anybody: it is simulated, or its controller is an emulated one.
    pub const fn is_harmless(&self) -> bool {
        match self.kind {
            MachineKind::Simulated => true,
            MachineKind::RoboClaw => self.roboclaw.emulated,
            MachineKind::Odrive => self.odrive.emulated,
        }
    }

    /// Where the column's centre can stand.
    pub fn travel(&self) -> Travel {
        let [min_x, min_y, max_x, max_y] = self.travel_m;
        Travel { min: Floor::new(min_x, min_y), max: Floor::new(max_x, max_y) }
    }
}

impl MachineKind {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Simulated, Self::RoboClaw, Self::Odrive];

    /// Whether nothing real moves.
    pub const fn is_simulated(self) -> bool {
        matches!(self, Self::Simulated)
    }

    /// The name on every surface.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Simulated => "simulated",
            Self::RoboClaw => "roboclaw",
            Self::Odrive => "odrive",
        }
    }
}
