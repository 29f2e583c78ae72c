//! Hold: the column stands in for something that is pushed, leaned on, climbed into, and keeps its position whatever is meant next.
//!
//! ```text
//!             touched, column in place
//!   (offered) ───────────────────────▶ holding
//!        ▲                                │
//!        └──────── nobody touches it ─────┘
//! ```
//!
//! Who leans is not dropped: a stop that comes meanwhile keeps the drive on (`engine/interacting`).

use super::{Ask, IN_PLACE_M, Over, Seen, Step};

/// A column that holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Hold(());

impl Hold {
    /// Somebody touches it and it stands there.
    pub fn begin(seen: &Seen<'_>) -> Option<Self> {
        let in_place = seen.rests && seen.column.distance_m(seen.place) < IN_PLACE_M;
        (in_place && !seen.touched_by.is_empty()).then_some(Self(()))
    }

    /// It stays until the last hand lets go.
    pub fn step(&mut self, seen: &Seen<'_>) -> Step {
        if seen.touched_by.is_empty() { Step::over(Over::LetGo) } else { Step::asks(Ask::Stay) }
    }
}
