//! What happened, for the record: every change of mode, every rule breached or cleared, every act.

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
}
