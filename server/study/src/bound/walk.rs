//! The person's walk as a clairvoyant knows it: where the head is, and which r applies, at every tick until the reach.

use covr_engine::frames::Floor;
use covr_engine::scene::Scene;
use covr_engine::time::{Span, Time};

use crate::trace::Recording;

/// A walk, tick by tick from the first replayed pose to the reach.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Walk {
    steps: Vec<Footing>,
}

/// The person at one tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Footing {
    /// The floor under the head, room frame.
    pub head: Floor,
    /// Height of the head, m.
    pub height_m: f64,
    /// From the head to the nearest surface of an enabled object, m; none without one.
    pub to_object_m: Option<f64>,
    /// Which r applies.
    pub zone: Zone,
}

/// Which r applies, in rising order of r.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Zone {
    /// 0.25 m for a column that creeps, else 0.35 m.
    AtObject,
    /// 0.35 m.
    Open,
    /// 1 m.
    Low,
}

/// One tick of a walk.
pub(super) const TICK: Span = Span::from_millis(4);

impl Walk {
    /// The walk of a recording between two moments of it; none without a frame between them.
    pub fn of(recording: &Recording, scene: &Scene, from: Time, to: Time) -> Option<Self> {
        let room_from_trace = recording.room_from_trace();
        let mut samples = recording.resampled_between(1.0 / TICK.secs(), from, to).peekable();
        let mut pose = room_from_trace.pose(&samples.peek()?.pose);
        let ticks = (to - from).micros() / TICK.micros();
        let mut at_object = false;
        let mut steps = Vec::with_capacity(ticks as usize + 1);
        for tick in 0..=ticks {
            let now = from + Span::from_micros(tick * TICK.micros());
            // In a gap of the recording the head stays where it was last seen.
            while let Some(sample) = samples.next_if(|sample| sample.at <= now) {
                pose = room_from_trace.pose(&sample.pose);
            }
            let to_object_m = scene.nearest_enabled_object_m(&pose.position);
            at_object = to_object_m <= if at_object { LEAVES_OBJECT_M } else { COMES_TO_OBJECT_M };
            let height_m = pose.position.z();
            let zone = match (height_m < LOW_M, at_object) {
                (true, _) => Zone::Low,
                (false, true) => Zone::AtObject,
                (false, false) => Zone::Open,
            };
            let to_object_m = to_object_m.is_finite().then_some(to_object_m);
            steps.push(Footing { head: pose.position.floor(), height_m, to_object_m, zone });
        }
        Some(Self { steps })
    }

    /// Seconds from the first tick to the last.
    pub fn secs(&self) -> f64 {
        (self.steps.len() - 1) as f64 * TICK.secs()
    }

    /// Every tick.
    pub fn steps(&self) -> &[Footing] {
        &self.steps
    }

    /// The person so many seconds after the first tick; at either end as there.
    pub fn at(&self, secs: f64) -> &Footing {
        let tick = (secs / TICK.secs()).round().max(0.0) as usize;
        &self.steps[tick.min(self.steps.len() - 1)]
    }

    /// The zone of least r over the `within_secs` before: when r grows, the rule gives the column as long to comply.
    pub fn mildest_zone(&self, secs: f64, within_secs: f64) -> Zone {
        let tick = |secs: f64| ((secs / TICK.secs()).round().max(0.0) as usize).min(self.steps.len() - 1);
        let zones = self.steps[tick(secs - within_secs)..=tick(secs)].iter().map(|step| step.zone);
        zones.min().unwrap_or(Zone::Open)
    }
}

impl Zone {
    /// r for a column of this speed, m.
    pub fn radius_m(self, speed_mps: f64) -> f64 {
        match self {
            Self::AtObject if speed_mps <= AT_OBJECT_MPS + 1e-9 => 0.25,
            Self::AtObject | Self::Open => 0.35,
            Self::Low => 1.0,
        }
    }
}

/// How slow the column must be for the least r, m/s.
const AT_OBJECT_MPS: f64 = 0.25;
/// A head this near to an enabled object comes to it, m.
const COMES_TO_OBJECT_M: f64 = 0.75;
/// And leaves it farther than this, m.
const LEAVES_OBJECT_M: f64 = 0.85;
/// A head lower than this crawls or sits, m.
const LOW_M: f64 = 1.0;
