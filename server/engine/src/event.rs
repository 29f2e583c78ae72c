//! What happened, for the record: every change of mode, every rule breached or cleared, every act.

use std::sync::Arc;

use crate::frames::{Floor, Planar};
use crate::mode::Mode;
use crate::observation::PersonId;
use crate::reason::Reason;
use crate::snapshot::RuleId;
use crate::time::Time;

/// Something that happened inside the engine.
#[derive(Debug, Clone, PartialEq)]
pub struct Event {
    /// When.
    pub at: Time,
    /// What.
    pub kind: EventKind,
}

/// What happened. Requests and prior changes are recorded by whoever carried them, with their author.
#[derive(Debug, Clone, PartialEq)]
pub enum EventKind {
    /// The mode changed.
    ModeChanged {
        /// Before.
        from: Mode,
        /// After.
        to: Mode,
        /// The safety rule that led to it; none when it was asked or done.
        rule: Option<RuleId>,
        /// Why.
        because: Reason,
    },
    /// A rule was breached.
    RuleBreached {
        /// Which.
        rule: RuleId,
        /// Why.
        reason: Reason,
    },
    /// A breached rule is kept again.
    RuleCleared {
        /// Which.
        rule: RuleId,
    },
    /// A person came in.
    PersonEntered(PersonId),
    /// A person left.
    PersonLeft(PersonId),
    /// The column stands where it serves the object, and the visitor is within reach.
    Served {
        /// Who.
        person: PersonId,
        /// Index of the object in the scene.
        object: usize,
    },
    /// The machine has found its home.
    Homed {
        /// Where the column rests.
        at: Floor,
        /// See [`MachineReport::home_repeatability_m`](crate::machine::MachineReport::home_repeatability_m).
        repeatability_m: Option<[f64; 2]>,
    },
    /// A column that was stopped in motion rests, as measured.
    CameToRest {
        /// When the stop began, m/s.
        velocity: Planar,
        /// From the stop to rest, s.
        secs: f64,
        /// The way along x and y, m.
        distance: Planar,
        /// The way along x and y that separation allowed for, m.
        allowed: Planar,
        /// Deceleration of x and y from nine tenths to one tenth of the speed, m/s2; none for an axis that hardly moved.
        braking_mps2: [Option<f64>; 2],
    },
    /// The column is moved by hand, from here.
    JogBegan(Floor),
    /// It is not any more.
    JogEnded {
        /// Where the column was then.
        at: Floor,
        /// Why.
        because: Reason,
    },
    /// An interaction is under way.
    InteractionBegan {
        /// Index of the object in the scene.
        object: usize,
        /// Which.
        interaction: &'static str,
        /// With whom, where it is with somebody.
        person: Option<PersonId>,
    },
    /// It is not any more.
    InteractionEnded {
        /// Index of the object in the scene.
        object: usize,
        /// Which.
        interaction: &'static str,
        /// With whom, where it was with somebody.
        person: Option<PersonId>,
        /// Why.
        because: Reason,
    },
    /// A contact is armed for this visitor no more (R14).
    ContactOver {
        /// Who.
        person: PersonId,
        /// Why.
        because: Reason,
    },
    /// The scenario entered a state.
    StateEntered {
        /// The state before; none: a run begins.
        from: Option<Arc<str>>,
        /// The state.
        to: Arc<str>,
        /// Why.
        why: WhyState,
    },
    /// The scenario's transitions went in a circle, and wait in this state for something to happen.
    ScenarioCut {
        /// The state.
        state: Arc<str>,
    },
}

/// Why a state of the scenario was entered, by ids.
#[derive(Debug, Clone, PartialEq)]
pub enum WhyState {
    /// The machine was armed: the run begins.
    Began,
    /// The condition of a transition held.
    ConditionHeld,
    /// A person touched the object.
    TouchBegan(PersonId, String),
    /// A person let go of the object.
    TouchEnded(PersonId, String),
    /// A person came into the zone.
    ZoneEntered(PersonId, String),
    /// A person went out of the zone.
    ZoneLeft(PersonId, String),
    /// The interaction at the object came to its end.
    InteractionDone(String),
    /// A VR client said this.
    ClientEvent(String),
    /// A game master gave this cue.
    Cue(String),
    /// A game master skipped, for this reason.
    Skipped(String),
    /// A game master went back, for this reason.
    Rewound(String),
}
