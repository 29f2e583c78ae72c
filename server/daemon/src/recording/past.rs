//! Where the column stood in the last seconds: what a touch is held against, which is told a little later.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use covr_engine::engine::{IN_PLACE_M, IN_PLACE_MPS};
use covr_engine::frames::{Floor, Planar};
use covr_engine::scene::Scene;
use covr_engine::time::{Span, Time};

use crate::control::Published;

/// The column in the last published states, newest last. Bounded.
#[derive(Debug, Default)]
pub struct Past {
    states: Mutex<VecDeque<Then>>,
}

#[derive(Debug, Clone)]
struct Then {
    at: Time,
    position: Floor,
    velocity: Planar,
    homed: bool,
    scene: Arc<Scene>,
}

/// How the column stood at a touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AtTouch {
    /// From its centre to the object's place, m.
    pub off_m: f64,
    /// How fast it was, m/s.
    pub speed_mps: f64,
    /// It stood there: the prop was where the hand was.
    pub served: bool,
}

impl Past {
    /// Remember a published state.
    pub fn remember(&self, published: &Published) {
        let mut states = self.states();
        if states.len() == MOST_STATES {
            states.pop_front();
        }
        let column = &published.snapshot.column;
        states.push_back(Then {
            at: published.snapshot.at,
            position: column.position,
            velocity: column.velocity,
            homed: column.homed,
            scene: published.scene.clone(),
        });
    }

    /// How the column stood to an object at a moment, by the published state nearest to it; none when that is farther
    /// than 0.25 s, or its scene has no such object.
    pub fn at_touch(&self, object: &str, at: Time) -> Option<AtTouch> {
        let states = self.states();
        let then = states.iter().min_by_key(|then| (then.at - at).micros().abs())?;
        if (then.at - at).micros().abs() > FARTHEST.micros() || !then.homed {
            return None;
        }
        let index = then.scene.spec().objects.iter().position(|known| known.id == object)?;
        let place = then.scene.objects().get(index)?.column_place();
        let (off_m, speed_mps) = (then.position.distance_m(place), then.velocity.norm());
        Some(AtTouch { off_m, speed_mps, served: off_m < IN_PLACE_M && speed_mps < IN_PLACE_MPS })
    }

    fn states(&self) -> MutexGuard<'_, VecDeque<Then>> {
        // Every change is whole, so a panic elsewhere leaves nothing half done.
        self.states.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Four seconds at the fastest publishing.
const MOST_STATES: usize = 512;
const FARTHEST: Span = Span::from_millis(250);
