//! What the engine foretold of the goal before a reach: when the column is in place, and when the hand is there.

use covr_engine::engine::{Engine, Foretold};
use covr_engine::time::{Span, Time};

/// How long before the reach it is looked at, s.
pub const FORETOLD_BEFORE_REACH_SECS: [f64; 3] = [0.5, 1.0, 2.0];

/// Watches it until the reach.
#[derive(Debug)]
pub(super) struct ForetoldWatch {
    goal: usize,
    reach: Time,
    period: Span,
    told: [Option<Foretold>; FORETOLD_BEFORE_REACH_SECS.len()],
}

impl ForetoldWatch {
    /// `goal` counts as the engine's objects do.
    pub fn new(goal: usize, reach: Time, period: Span) -> Self {
        Self { goal, reach, period, told: [None; FORETOLD_BEFORE_REACH_SECS.len()] }
    }

    /// The engine after the step at a moment of the recording.
    pub fn look(&mut self, at: Time, engine: &Engine) {
        for (told, before_secs) in self.told.iter_mut().zip(FORETOLD_BEFORE_REACH_SECS) {
            let then = self.reach - Span::from_secs(before_secs);
            if at <= then && then < at + self.period {
                *told = engine.foretell(self.goal);
            }
        }
    }

    /// What was seen.
    pub fn told(self) -> [Option<Foretold>; FORETOLD_BEFORE_REACH_SECS.len()] {
        self.told
    }
}
