//! Digital inputs that become active, or fall silent, at random: one that stops (R4) and one that notices intruders (R12).

use std::sync::Arc;

use covr_engine::observation::{InputLevel, Inputs, Observation};
use covr_engine::time::{Span, Time};

use crate::random::Random;
use crate::replay::ClosedLoop;

/// Both inputs.
pub struct Sensors {
    random: Random,
    stop: Sensor,
    intruder: Sensor,
    active_since: Option<Time>,
}

/// One input.
struct Sensor {
    name: Arc<str>,
    level: InputLevel,
    changes_at: Time,
}

impl Sensors {
    /// Both inactive for a while from now on.
    pub fn new(random: Random, now: Time) -> Self {
        let sensor = |name: &str| Sensor {
            name: name.into(),
            level: InputLevel::Inactive,
            changes_at: now + Span::from_millis(1_500),
        };
        Self { stop: sensor("button"), intruder: sensor("curtain"), active_since: None, random }
    }

    /// What they say in this period.
    pub fn step(&mut self, control: &mut ClosedLoop) {
        let now = control.now();
        for sensor in [&mut self.stop, &mut self.intruder] {
            sensor.step(&mut self.random, now);
        }
        let is_inactive = |sensor: &Sensor| sensor.level == InputLevel::Inactive;
        self.active_since = if is_inactive(&self.stop) && is_inactive(&self.intruder) {
            None
        } else {
            self.active_since.or(Some(now))
        };
        let inputs = Inputs { stop: self.stop.level.clone(), intruder: self.intruder.level.clone() };
        control.observe(Observation::Inputs(inputs));
    }

    /// One of them has been active for so long that the column must have come to rest.
    pub fn demand_rest(&self, now: Time) -> bool {
        self.active_since.is_some_and(|since| now - since > COMES_TO_REST)
    }
}

impl Sensor {
    fn step(&mut self, random: &mut Random, now: Time) {
        if now < self.changes_at {
            return;
        }
        let (level, lasts_secs) = match (&self.level, random.chance(0.5)) {
            (InputLevel::Inactive, true) => {
                (InputLevel::Active(self.name.clone()), random.between(0.004, 4.0))
            }
            (InputLevel::Inactive, false) => {
                (InputLevel::Silent(self.name.clone()), random.between(0.004, 4.0))
            }
            _ => (InputLevel::Inactive, random.between(2.0, 40.0)),
        };
        (self.level, self.changes_at) = (level, now + Span::from_secs(lasts_secs));
    }
}

/// The slowest brake of these worlds, from the greatest speed, with the longest starvation of the control thread.
const COMES_TO_REST: Span = Span::from_millis(2_000);
