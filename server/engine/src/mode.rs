//! The state of the machine as one table: every mode times every request and every trigger.
//!
//! ```text
//!              home               homed             arm
//!  disarmed ─────────▶ homing ─────────▶ ready ─────────▶ following ◀──▶ protective_stop
//!     ▲  ▲               │                 │                 │               │
//!     │  └── disarm ─────┴─────────────────┴─────────────────┴───────────────┘
//!     │                         stop, R4..R7, from anywhere ─▶ latched_stop
//!     └── reset (cause gone) ── latched_stop, faulted ◀─ R8
//! ```
//!
//! A jog leads from `disarmed`, homed, to `ready`, and stays there. A protective stop that came while homing goes back to homing. `tests/modes.rs` explores every state, and
//! `covr-wire` writes the table into `server/SAFETY.md`.
//! It never moves anything: it says what is allowed. Reset starts nothing; arming is a second act.

use crate::reason::Reason;

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
    /// Move by hand for as long as the order is given anew (hold-to-run).
    Jog,
}

/// What happens to the machine without anybody's asking.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Trigger {
    /// A rule demands a protective stop.
    ProtectiveDemand,
    /// No rule has demanded one for a while.
    DemandGone,
    /// A rule demands a latched stop.
    LatchedDemand,
    /// A rule says that the machine cannot be trusted to obey.
    Fault,
    /// The machine has homed, and rests.
    Homed,
    /// The machine does not know its place any more.
    HomeLost,
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
    pub const ALL: [Self; 6] = [Self::Home, Self::Arm, Self::Disarm, Self::Stop, Self::Reset, Self::Jog];

    /// The name on every surface.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Home => "home",
            Self::Arm => "arm",
            Self::Disarm => "disarm",
            Self::Stop => "stop",
            Self::Reset => "reset",
            Self::Jog => "jog",
        }
    }
}

impl Trigger {
    /// Every trigger, in the order of the table.
    pub const ALL: [Self; 6] = [
        Self::ProtectiveDemand,
        Self::DemandGone,
        Self::LatchedDemand,
        Self::Fault,
        Self::Homed,
        Self::HomeLost,
    ];
}

/// What the table needs to know beside the mode.
#[derive(Debug, Clone, PartialEq)]
pub struct Conditions {
    /// Positions are in the room frame.
    pub homed: bool,
    /// The column still moves: who takes it over now could not go on braking as hard as it does.
    pub moves: bool,
    /// A game master's dashboard is needed, and none is connected (R11).
    pub game_master_absent: bool,
    /// Why a latched stop or a fault cannot be left yet: its cause is still there.
    pub cause_still_there: Option<Reason>,
}

/// What the table says.
#[derive(Debug, Clone, PartialEq)]
pub enum Response {
    /// Accepted: the machine goes to this mode.
    Go(Mode),
    /// It is so already, in this way.
    AlreadySo(Reason),
    /// Refused, for this reason.
    Refuse(Reason),
}

/// The table: every mode times every request.
pub fn respond(mode: Mode, request: RequestKind, conditions: &Conditions) -> Response {
    use Mode::{Disarmed, Faulted, Following, Homing, LatchedStop, ProtectiveStop, Ready};
    use RequestKind::{Arm, Disarm, Home, Jog, Reset, Stop};
    use Response::{AlreadySo, Go, Refuse};
    match (mode, request) {
        (LatchedStop, Stop) => AlreadySo(Reason::StoppedAlready),
        (_, Stop) => Go(LatchedStop),

        (Disarmed | Ready, Home | Arm) if conditions.moves => Refuse(Reason::WaitForRest),
        (Disarmed | Ready, Home) => Go(Homing),
        (Homing, Home) => AlreadySo(Reason::HomingAlready),
        (Following | ProtectiveStop, Home) => Refuse(Reason::DisarmFirst),
        (LatchedStop | Faulted, Home | Arm) => Refuse(Reason::ResetFirst),

        (Disarmed, Arm) if !conditions.homed => Refuse(Reason::HomeFirst),
        (Disarmed | Ready, Arm) if conditions.game_master_absent => Refuse(Reason::GameMasterAbsent),
        (Disarmed | Ready, Arm) => Go(Following),
        (Homing, Arm) => Refuse(Reason::WaitForHoming),
        (Following, Arm) => AlreadySo(Reason::ArmedAlready),
        (ProtectiveStop, Arm) => AlreadySo(Reason::ArmedInProtectiveStop),

        (Homing | Ready | Following | ProtectiveStop, Disarm) => Go(Disarmed),
        (Disarmed, Disarm) => AlreadySo(Reason::DisarmedAlready),
        (LatchedStop | Faulted, Disarm) => AlreadySo(Reason::ReleasedAlready),

        (LatchedStop | Faulted, Reset) => match &conditions.cause_still_there {
            Some(cause) => Refuse(cause.clone()),
            None => Go(Disarmed),
        },
        (ProtectiveStop, Reset) => Refuse(Reason::ClearsByItself),
        (Disarmed | Homing | Ready | Following, Reset) => AlreadySo(Reason::NothingToReset),

        (Disarmed, Jog) if !conditions.homed => Refuse(Reason::HomeFirst),
        (Disarmed, Jog) if conditions.moves => Refuse(Reason::WaitForRest),
        (Disarmed | Ready, Jog) => Go(Ready),
        (Homing, Jog) => Refuse(Reason::WaitForHoming),
        (Following | ProtectiveStop, Jog) => Refuse(Reason::DisarmFirst),
        (LatchedStop | Faulted, Jog) => Refuse(Reason::ResetFirst),
    }
}

/// The table: every mode times every trigger. The mode to go to; none: the mode stays.
///
/// `resumes` is where a protective stop goes back to: the mode that it came in.
pub fn react(mode: Mode, trigger: Trigger, resumes: Mode) -> Option<Mode> {
    use Mode::{Disarmed, Faulted, Following, Homing, LatchedStop, ProtectiveStop, Ready};
    match (trigger, mode) {
        (Trigger::ProtectiveDemand, Homing | Following) => Some(ProtectiveStop),
        (Trigger::DemandGone, ProtectiveStop) => Some(resumes),
        (Trigger::LatchedDemand, Homing | Ready | Following | ProtectiveStop) => Some(LatchedStop),
        (Trigger::Fault, Disarmed | Homing | Ready | Following | ProtectiveStop) => Some(Faulted),
        (Trigger::Homed, Homing) => Some(Ready),
        (Trigger::HomeLost, Ready | Following | ProtectiveStop) => Some(LatchedStop),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Response::{AlreadySo, Go, Refuse};

    fn conditions(homed: bool, cause: Option<Reason>) -> Conditions {
        Conditions { homed, moves: false, game_master_absent: false, cause_still_there: cause }
    }

    #[test]
    fn stop_is_accepted_in_every_mode() {
        for mode in Mode::ALL {
            let response = respond(mode, RequestKind::Stop, &conditions(false, Some(Reason::NoAnswerYet)));
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
        // home arm disarm stop reset jog
        let expected = "\
            disarmed unhomed: homing refuse already latched_stop already refuse\n\
            homing unhomed: already refuse disarmed latched_stop already refuse\n\
            ready unhomed: homing following disarmed latched_stop already ready\n\
            following unhomed: refuse already disarmed latched_stop already refuse\n\
            protective_stop unhomed: refuse already disarmed latched_stop refuse refuse\n\
            latched_stop unhomed: refuse refuse already already disarmed refuse\n\
            faulted unhomed: refuse refuse already latched_stop disarmed refuse\n\
            disarmed homed: homing following already latched_stop already ready\n\
            homing homed: already refuse disarmed latched_stop already refuse\n\
            ready homed: homing following disarmed latched_stop already ready\n\
            following homed: refuse already disarmed latched_stop already refuse\n\
            protective_stop homed: refuse already disarmed latched_stop refuse refuse\n\
            latched_stop homed: refuse refuse already already disarmed refuse\n\
            faulted homed: refuse refuse already latched_stop disarmed refuse\n";
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
            for request in [RequestKind::Home, RequestKind::Arm, RequestKind::Jog] {
                let response = respond(mode, request, &moves);
                let stays = response == Go(mode);
                assert!(stays || !matches!(response, Go(_)), "{mode:?} {request:?}: {response:?}");
            }
        }
    }

    #[test]
    fn nobody_arms_without_the_game_master_who_is_needed_and_everything_else_is_as_with_one() {
        for mode in Mode::ALL {
            for request in RequestKind::ALL {
                let with = respond(mode, request, &conditions(true, None));
                let absent = Conditions { game_master_absent: true, ..conditions(true, None) };
                let without = respond(mode, request, &absent);
                let arms = with == Go(Mode::Following);
                assert_eq!(without, if arms { Refuse(Reason::GameMasterAbsent) } else { with });
            }
        }
    }

    #[test]
    fn a_reset_needs_the_cause_gone() {
        for mode in [Mode::LatchedStop, Mode::Faulted] {
            let response = respond(mode, RequestKind::Reset, &conditions(true, Some(Reason::NoAnswerYet)));
            assert_eq!(response, Refuse(Reason::NoAnswerYet));
        }
    }
}
