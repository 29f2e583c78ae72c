//! Step back: something that was pushed gives way (the paper's magic wall).
//!
//! ```text
//!             column in place              there
//!   (offered) ───────────────▶ stepping ──────────▶ done (stands until the state is left)
//! ```
//!
//! It goes against the way that its prop faces, under the separation rule: while somebody still leans on it, it stays where it is.

use super::{Ask, IN_PLACE_M, Phase, Seen, Step, THERE_M};
use crate::frames::{Floor, Planar};

/// A column that gives way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepBack {
    to: Floor,
    is_there: bool,
}

impl StepBack {
    /// It stands at the object.
    pub fn begin(distance_m: f64, seen: &Seen<'_>) -> Option<Self> {
        let in_place = seen.rests && seen.column.distance_m(seen.place) < IN_PLACE_M;
        let back = Planar::new(-distance_m, 0.0).turned(seen.facing_rad);
        in_place.then(|| Self { to: seen.place + back, is_there: false })
    }

    /// Back, and there it stands.
    pub fn step(&mut self, seen: &Seen<'_>) -> Step {
        self.is_there |= seen.rests && seen.column.distance_m(self.to) < THERE_M;
        Step::asks(if self.is_there { Ask::Stay } else { Ask::Go(self.to) })
    }

    /// Stepping back, or done.
    pub fn phase(&self) -> Phase {
        if self.is_there { Phase::Done } else { Phase::SteppingBack }
    }
}
