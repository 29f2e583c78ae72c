//! Digital inputs: each is read on a thread of its own, away from the async runtime and the database, and says what it
//! saw in atomics that the control thread reads at each step.
//!
//! ```text
//!  line `0` or `1`  ──▶ active or inactive, believed for the heartbeat timeout
//!  silence, a cut line, anything else ──▶ silent, which counts as active
//! ```

mod lane;
mod source;
mod stop;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use covr_engine::observation::{InputLevel, Inputs};
use covr_engine::time::{Span, Time};

use crate::clock::Clock;
use crate::config::{Input, InputKind};
use lane::{Lane, Seen};
pub use stop::{InputStop, LANE};

/// Every input that is set up. The threads end when this is dropped.
#[derive(Debug, Default)]
pub struct InputLines {
    lines: Vec<Line>,
    quit: Arc<AtomicBool>,
}

/// One input, as the control thread sees it.
#[derive(Debug)]
struct Line {
    name: Arc<str>,
    kind: InputKind,
    lane: Arc<Lane>,
    activations_seen: u64,
    seen: Seen,
    /// When a stop by it was last noted.
    noted_at: Option<Time>,
}

impl InputLines {
    /// Start a thread for each, and wait for the first word of each, at most its heartbeat timeout: what has said
    /// nothing by then is silent.
    pub fn start(inputs: &[Input], clock: Clock) -> std::io::Result<Self> {
        let quit = Arc::new(AtomicBool::new(false));
        let mut lines = Self { lines: Vec::new(), quit: quit.clone() };
        for input in inputs {
            let timeout = Span::from_secs(input.heartbeat_timeout_secs);
            let lane = Arc::new(Lane::new(timeout));
            let follower =
                source::Follower { input: input.clone(), lane: lane.clone(), clock, quit: quit.clone() };
            std::thread::Builder::new().name("input".into()).spawn(move || follower.run())?;
            let (name, kind) = (input.name.as_str().into(), input.kind);
            let line = Line { name, kind, lane, activations_seen: 0, seen: Seen::Inactive, noted_at: None };
            lines.lines.push(line);
        }
        for (line, input) in lines.lines.iter().zip(inputs) {
            line.lane.wait_for_a_word(Duration::from_secs_f64(input.heartbeat_timeout_secs));
        }
        Ok(lines)
    }

    /// For the control thread: what they say now, with every new stop put to `stops`. An activation shorter than a step
    /// is said once all the same. `latched`: the machine is in a latched stop already.
    pub fn look(&mut self, now: Time, latched: bool, stops: &mut Vec<InputStop>) -> Inputs {
        let mut inputs = Inputs::default();
        for line in &mut self.lines {
            let level = match line.look(now, latched, stops) {
                Seen::Inactive => InputLevel::Inactive,
                Seen::Active => InputLevel::Active(line.name.clone()),
                Seen::Silent => InputLevel::Silent(line.name.clone()),
            };
            let place = match line.kind {
                InputKind::Stop => &mut inputs.stop,
                InputKind::Intruder => &mut inputs.intruder,
            };
            if matches!(place, InputLevel::Absent | InputLevel::Inactive) {
                *place = level;
            }
        }
        inputs
    }
}

impl Drop for InputLines {
    fn drop(&mut self) {
        self.quit.store(true, Ordering::Release);
    }
}

impl Line {
    fn look(&mut self, now: Time, latched: bool, stops: &mut Vec<InputStop>) -> Seen {
        let activations = self.lane.activations();
        let anew = std::mem::replace(&mut self.activations_seen, activations) != activations;
        let seen = match self.lane.look(now) {
            Seen::Inactive if anew => Seen::Active,
            seen => seen,
        };
        let before = std::mem::replace(&mut self.seen, seen);
        let activated = seen != Seen::Inactive && (anew || before == Seen::Inactive);
        let chatters = latched && self.noted_at.is_some_and(|at| now - at < NOTED_ONCE_IN);
        if activated && self.kind == InputKind::Stop && !chatters {
            self.noted_at = Some(now);
            let silent = seen == Seen::Silent;
            stops.push(InputStop { input: self.name.clone(), silent, since: self.lane.active_since(now) });
        }
        seen
    }
}

/// A line that chatters while the machine is stopped already is recorded once in this time.
const NOTED_ONCE_IN: Span = Span::from_millis(1_000);

#[cfg(test)]
mod tests;
