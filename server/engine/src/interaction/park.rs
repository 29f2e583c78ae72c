//! Park: for an object that must not be felt, the column keeps out of reach.
//!
//! ```text
//!             the object is meant
//!   (offered) ────────────────────▶ parked
//!        ▲                            │
//!        └── another object is meant ─┘
//! ```

use super::{Ask, Over, Seen, Step};

/// A column that keeps out of reach.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Park(());

impl Park {
    /// It is the object that the visitor means.
    pub fn begin(seen: &Seen<'_>) -> Option<Self> {
        seen.is_meant.then_some(Self(()))
    }

    /// Out of reach until something else is meant.
    pub fn step(&mut self, seen: &Seen<'_>) -> Step {
        if seen.is_meant { Step::asks(Ask::Go(seen.out_of_reach)) } else { Step::over(Over::NotMeant) }
    }
}
