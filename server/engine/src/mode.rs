//! The state of the machine as one table: every mode times every request.
//!
//! ```text
//!              home               homed             arm
//!  disarmed ─────────▶ homing ─────────▶ ready ─────────▶ following ◀──▶ protective_stop
//!     ▲  ▲               │                 │                 │               │
//!     │  └── disarm ─────┴─────────────────┴─────────────────┴───────────────┘
//!     │                         stop, R4..R7, from anywhere ─▶ latched_stop
//!     └── reset (cause gone) ── latched_stop, faulted ◀─ R8, homing failed
//! ```
//!
//! It never moves anything: it says what is allowed. Reset starts nothing; arming is a second act.

/// The state of the machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Mode {
    /// Drive released. The state after every start that was not latched.
    Disarmed,
    /// Finding the switches at creep speed.
    Homing,
    /// Homed, drive on, holding; serves nobody.
    Ready,
    /// Armed: the column follows the visitor's intention.
    Following,
    /// Braked and holding; clears by itself when its cause has been gone for 1 s.
    ProtectiveStop,
    /// Braked, then released; survives a restart; only a reset clears it.
    LatchedStop,
    /// The machine or its link cannot be trusted to obey.
    Faulted,
}

/// What somebody asks of the machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum RequestKind {
    /// Find the switches.
    Home,
    /// Follow the visitor.
    Arm,
    /// Brake, then release the drive.
    Disarm,
    /// The software stop (R4): always accepted.
    Stop,
    /// Leave a latched stop or a fault; starts nothing.
    Reset,
}

impl Mode {
    /// Every mode, in the order of the table.
    pub const ALL: [Self; 7] = [
        Self::Disarmed,
        Self::Homing,
        Self::Ready,
        Self::Following,
        Self::ProtectiveStop,
        Self::LatchedStop,
        Self::Faulted,
    ];

    /// The name on every surface: SQL, JSON, screen.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Disarmed => "disarmed",
            Self::Homing => "homing",
            Self::Ready => "ready",
            Self::Following => "following",
            Self::ProtectiveStop => "protective_stop",
            Self::LatchedStop => "latched_stop",
            Self::Faulted => "faulted",
        }
    }
}
