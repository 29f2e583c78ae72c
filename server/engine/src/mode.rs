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

impl RequestKind {
    /// Every request, in the order of the table.
    pub const ALL: [Self; 5] = [Self::Home, Self::Arm, Self::Disarm, Self::Stop, Self::Reset];

    /// The name on every surface.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Home => "home",
            Self::Arm => "arm",
            Self::Disarm => "disarm",
            Self::Stop => "stop",
            Self::Reset => "reset",
        }
    }
}

/// What the table needs to know beside the mode.
#[derive(Debug, Clone, PartialEq)]
pub struct Conditions {
    /// Positions are in the room frame.
    pub homed: bool,
    /// The column still moves: who takes it over now could not go on braking as hard as it does.
    pub moves: bool,
    /// Why a latched stop or a fault cannot be left yet: its cause is still there.
    pub cause_still_there: Option<String>,
}

/// What the table says.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Response {
    /// Accepted: the machine goes to this mode.
    Go(Mode),
    /// It is so already, in these words.
    AlreadySo(&'static str),
    /// Refused, for this reason.
    Refuse(String),
}

/// The table: every mode times every request.
pub fn respond(mode: Mode, request: RequestKind, conditions: &Conditions) -> Response {
    use Mode::{Disarmed, Faulted, Following, Homing, LatchedStop, ProtectiveStop, Ready};
    use RequestKind::{Arm, Disarm, Home, Reset, Stop};
    use Response::{AlreadySo, Go};
    match (mode, request) {
        (LatchedStop, Stop) => AlreadySo("stopped already; the stop is latched"),
        (_, Stop) => Go(LatchedStop),

        (Disarmed | Ready, Home | Arm) if conditions.moves => {
            refuse("the column still moves: wait until it rests")
        }
        (Disarmed | Ready, Home) => Go(Homing),
        (Homing, Home) => AlreadySo("homing already"),
        (Following | ProtectiveStop, Home) => refuse("the machine is armed: disarm first"),
        (LatchedStop | Faulted, Home | Arm) => refuse("the machine is stopped: reset first"),

        (Disarmed, Arm) if !conditions.homed => refuse("not homed: home first"),
        (Disarmed | Ready, Arm) => Go(Following),
        (Homing, Arm) => refuse("homing: wait until it is done"),
        (Following, Arm) => AlreadySo("armed already"),
        (ProtectiveStop, Arm) => AlreadySo("armed already; the protective stop clears by itself"),

        (Homing | Ready | Following | ProtectiveStop, Disarm) => Go(Disarmed),
        (Disarmed, Disarm) => AlreadySo("disarmed already"),
        (LatchedStop | Faulted, Disarm) => {
            AlreadySo("the drive is released already; leave the stop by reset")
        }

        (LatchedStop | Faulted, Reset) => match &conditions.cause_still_there {
            Some(cause) => Response::Refuse(format!("the cause is still there: {cause}")),
            None => Go(Disarmed),
        },
        (ProtectiveStop, Reset) => refuse("a protective stop clears by itself when its cause is gone"),
        (Disarmed | Homing | Ready | Following, Reset) => AlreadySo("nothing to reset"),
    }
}

fn refuse(why: &str) -> Response {
    Response::Refuse(why.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use Response::{AlreadySo, Go, Refuse};

    fn conditions(homed: bool, cause: Option<&str>) -> Conditions {
        Conditions { homed, moves: false, cause_still_there: cause.map(str::to_owned) }
    }

    #[test]
    fn stop_is_accepted_in_every_mode() {
        for mode in Mode::ALL {
            let response = respond(mode, RequestKind::Stop, &conditions(false, Some("x")));
            let stops = matches!(response, Go(Mode::LatchedStop)) || mode == Mode::LatchedStop;
            assert!(stops && !matches!(response, Refuse(_)), "{mode:?}: {response:?}");
        }
    }

    #[test]
    fn the_whole_table() {
        let mut table = String::new();
        for homed in [false, true] {
            for mode in Mode::ALL {
                let word = |request| match respond(mode, request, &conditions(homed, None)) {
                    Go(to) => to.name(),
                    AlreadySo(_) => "already",
                    Refuse(_) => "refuse",
                };
                let row = RequestKind::ALL.map(word).join(" ");
                table.push_str(&format!(
                    "{} {}: {row}\n",
                    mode.name(),
                    if homed { "homed" } else { "unhomed" }
                ));
            }
        }
        // home arm disarm stop reset
        let expected = "\
            disarmed unhomed: homing refuse already latched_stop already\n\
            homing unhomed: already refuse disarmed latched_stop already\n\
            ready unhomed: homing following disarmed latched_stop already\n\
            following unhomed: refuse already disarmed latched_stop already\n\
            protective_stop unhomed: refuse already disarmed latched_stop refuse\n\
            latched_stop unhomed: refuse refuse already already disarmed\n\
            faulted unhomed: refuse refuse already latched_stop disarmed\n\
            disarmed homed: homing following already latched_stop already\n\
            homing homed: already refuse disarmed latched_stop already\n\
            ready homed: homing following disarmed latched_stop already\n\
            following homed: refuse already disarmed latched_stop already\n\
            protective_stop homed: refuse already disarmed latched_stop refuse\n\
            latched_stop homed: refuse refuse already already disarmed\n\
            faulted homed: refuse refuse already latched_stop disarmed\n";
        assert_eq!(table, expected);
    }

    #[test]
    fn no_request_but_arm_leads_to_motion_after_people_and_reset_starts_nothing() {
        for mode in Mode::ALL {
            for request in RequestKind::ALL {
                let response = respond(mode, request, &conditions(true, None));
                if response == Go(Mode::Following) {
                    assert_eq!(request, RequestKind::Arm);
                }
                if request == RequestKind::Reset {
                    assert!(!matches!(response, Go(to) if to != Mode::Disarmed));
                }
            }
        }
    }

    #[test]
    fn nothing_takes_over_a_column_that_still_moves() {
        let moves = Conditions { moves: true, ..conditions(true, None) };
        for mode in Mode::ALL {
            for request in [RequestKind::Home, RequestKind::Arm] {
                let response = respond(mode, request, &moves);
                assert!(!matches!(response, Go(_)), "{mode:?} {request:?}: {response:?}");
            }
        }
    }

    #[test]
    fn a_reset_needs_the_cause_gone() {
        for mode in [Mode::LatchedStop, Mode::Faulted] {
            let response = respond(mode, RequestKind::Reset, &conditions(true, Some("no answer")));
            assert_eq!(response, Refuse("the cause is still there: no answer".into()));
        }
    }
}
