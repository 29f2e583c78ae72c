//! A stop by a digital input, for the record: nobody waits for its acknowledgement, so the record alone tells of it.

use std::sync::Arc;
use std::time::Duration;

use covr_engine::time::Time;
use covr_wire::reason::Reason;
use serde_json::{Value, json};

/// A stop input that became active.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InputStop {
    /// Its name.
    pub input: Arc<str>,
    /// It gives no good word, which counts as active.
    pub silent: bool,
    /// Since when it counts as active.
    pub since: Time,
}

impl InputStop {
    /// Why it stops.
    pub fn reason(&self) -> Reason {
        let input = self.input.to_string();
        if self.silent { Reason::InputSilent { input } } else { Reason::StopInput { input } }
    }

    /// The event's summary.
    pub fn summary(&self, to_drive: Option<Duration>) -> String {
        let reached = to_drive.map_or_else(
            || "the drive did not acknowledge".into(),
            |to_drive| format!("at the drive after {} us", to_drive.as_micros()),
        );
        format!("stop: {}; {reached}", self.reason())
    }

    /// The event's particulars, as of the other lanes, with the reason as data too.
    pub fn detail(&self, to_drive: Option<Duration>) -> Value {
        json!({
            "author": self.input,
            "by": LANE,
            "reason": self.reason().to_string(),
            "why": self.reason(),
            "to_drive_micros": to_drive.map(|to_drive| to_drive.as_micros() as u64),
        })
    }
}

/// The name of the lane on every surface.
pub const LANE: &str = "input";
