//! A motion that was found, driven past the checker tick by tick as a replay would be.

use covr_engine::frames::{Floor, Planar};
use covr_engine::observation::PersonId;
use covr_engine::time::{Span, Time};

use super::walk::{TICK, Walk};
use super::{CALM_SECS, Plan, WITHIN_M};
use crate::checker::{Checker, Moment, PersonNow, Rules, Track, Verdict};

/// A motion and what was seen of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Driven {
    /// The motion.
    pub plan: Plan,
    /// From the column's centre to the place at the reach, m.
    pub distance_at_reach_m: f64,
    /// How long it had been in place then, at rest, s.
    pub in_place_before_reach_secs: f64,
    /// Way of the column, m; not the shortest.
    pub column_travel_m: f64,
    /// Greatest speed, acceleration and change of acceleration from tick to tick of an axis: m/s, m/s2, m/s3. The last is
    /// that of a motion without a bound on jerk.
    pub peaks: [f64; 3],
    /// What the checker says of it.
    pub verdict: Verdict,
    /// How long it had been slow at the reach, s.
    calm_secs: f64,
}

impl Driven {
    pub(super) fn along(plan: Plan, walk: &Walk, rules: &Rules, place: Floor) -> Self {
        let mut checker = Checker::new(rules.clone(), Track::True);
        let mut before = plan.at(0.0);
        let mut pushed = Planar::ZERO;
        let (mut in_place_from, mut fast_at, mut column_travel_m) = (None, None, 0.0);
        let mut peaks = [0.0f64; 3];
        for (tick, footing) in walk.steps().iter().enumerate() {
            let secs = tick as f64 * TICK.secs();
            let column = plan.at(secs);
            let person = PersonNow {
                id: PersonId(1),
                head: footing.head,
                height_m: footing.height_m,
                to_enabled_object_m: footing.to_object_m,
                contact: None,
            };
            checker.check(&Moment {
                at: Time::ZERO + Span::from_micros(tick as i64 * TICK.micros()),
                column,
                follows_setpoints: true,
                homed: true,
                latched: false,
                persons: &[person],
            });
            let moves = column.velocity.norm() >= AT_REST_MPS;
            fast_at = if moves { Some(secs) } else { fast_at };
            let is_in_place = column.position.distance_m(place) <= WITHIN_M && !moves;
            in_place_from = if is_in_place { in_place_from.or(Some(secs)) } else { None };
            column_travel_m += column.position.distance_m(before.position);
            let per_sec = 1.0 / TICK.secs();
            let push = (column.velocity - before.velocity) * per_sec;
            let seen = [column.velocity, push, (push - pushed) * per_sec];
            for (peak, seen) in peaks.iter_mut().zip(seen) {
                *peak = peak.max(seen.x.abs()).max(seen.y.abs());
            }
            (before, pushed) = (column, push);
        }
        let since = |from: Option<f64>| from.map(|from| walk.secs() - from);
        Self {
            distance_at_reach_m: before.position.distance_m(place),
            in_place_before_reach_secs: since(in_place_from).unwrap_or(0.0),
            column_travel_m,
            peaks,
            verdict: checker.verdict().clone(),
            calm_secs: since(fast_at).unwrap_or(f64::INFINITY),
            plan,
        }
    }

    /// Whether the checker passes it, and the column stands where it should.
    pub(super) fn serves(&self) -> bool {
        let is_calm = self.calm_secs >= CALM_SECS - 1e-9;
        is_calm && self.distance_at_reach_m <= WITHIN_M && self.verdict.violations() == 0
    }
}

/// How slow, m/s.
const AT_REST_MPS: f64 = 0.05;
