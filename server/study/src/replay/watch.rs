//! One reach, watched: where the column was and what the rule believed, until the hand arrived.

use covr_engine::engine::Engine;
use covr_engine::event::{Event, EventKind};
use covr_engine::frames::{Floor, Planar};
use covr_engine::mode::Mode;
use covr_engine::safety::vetted::{Action, Vetted};
use covr_engine::time::{Span, Time};

use super::Stepped;
use super::belief::BeliefWatch;
use super::foretold::ForetoldWatch;
use super::trial::{TrialOutcome, WithOffset};
use crate::checker::Verdict;

/// Watches one reach. Times are the recording's.
#[derive(Debug)]
pub(super) struct ReachWatch {
    place: Floor,
    belief: BeliefWatch,
    foretold: ForetoldWatch,
    began: Option<Time>,
    before: Option<Floor>,
    arrived_at: Option<Time>,
    fast_at: Option<Time>,
    last: (Planar, Time),
    column_travel_m: f64,
    peaks: Peaks,
    proxy_way: (f64, u32),
    stops: u32,
}

impl ReachWatch {
    /// `place` is where the column serves the goal.
    pub fn new(place: Floor, belief: BeliefWatch, foretold: ForetoldWatch, period: Span) -> Self {
        Self {
            place,
            belief,
            foretold,
            began: None,
            before: None,
            arrived_at: None,
            fast_at: None,
            last: (Planar::new(f64::INFINITY, f64::INFINITY), Time::ZERO),
            column_travel_m: 0.0,
            peaks: Peaks { greatest: [0.0; 3], before: None, period },
            proxy_way: (0.0, 0),
            stops: 0,
        }
    }

    /// One step, at a moment of the recording, and the engine after it.
    pub fn see(&mut self, at: Time, stepped: &Stepped, engine: &Engine) {
        let truth = stepped.truth;
        self.began = self.began.or(Some(at));
        self.belief.look(at, engine.belief());
        self.foretold.look(at, engine);
        self.peaks.see(&stepped.command);
        self.proxy_way.0 += engine.proxy().distance_m(truth.position);
        self.proxy_way.1 += 1;
        self.column_travel_m += self.before.map_or(0.0, |before| before.distance_m(truth.position));
        self.before = Some(truth.position);
        let moves = truth.velocity.norm() >= AT_REST_MPS;
        if moves {
            self.fast_at = Some(at);
        }
        let distance_m = truth.position.distance_m(self.place);
        self.arrived_at = if distance_m <= WITHIN_M && !moves { self.arrived_at.or(Some(at)) } else { None };
        self.last = (truth.position - self.place, at);
    }

    /// What happened in the engine.
    pub fn hear(&mut self, event: &Event) {
        let stops = matches!(
            event.kind,
            EventKind::ModeChanged { to: Mode::ProtectiveStop | Mode::LatchedStop | Mode::Faulted, .. }
        );
        self.stops += u32::from(stops);
    }

    /// The hand has arrived.
    pub fn outcome(self, true_verdict: Verdict, commanded_verdict: Verdict) -> TrialOutcome {
        let (off, ended) = self.last;
        let distance_at_reach_m = off.norm();
        let within_10cm = distance_at_reach_m <= WITHIN_M;
        let foretold = self.foretold.told();
        let calm = self.fast_at.is_none_or(|fast_at| ended - fast_at >= CALM_FOR);
        TrialOutcome {
            success: within_10cm && calm,
            with_offset: foretold.map(|then| {
                let offset = then?.offset;
                let distance_at_reach_m = (off - offset.unwrap_or(Planar::ZERO)).norm();
                let success = distance_at_reach_m <= WITHIN_M && calm;
                Some(WithOffset { offered: offset.is_some(), success, distance_at_reach_m })
            }),
            within_10cm,
            distance_at_reach_m,
            in_place_before_reach_secs: self.arrived_at.map_or(0.0, |at| (ended - at).secs()),
            stops: self.stops,
            column_travel_m: self.column_travel_m,
            peaks: self.peaks.greatest,
            proxy_distance_m: self.proxy_way.0 / f64::from(self.proxy_way.1.max(1)),
            belief: self.belief.told(),
            foretold,
            simulated_secs: self.began.map_or(0.0, |began| (ended - began).secs()),
            true_verdict,
            commanded_verdict,
        }
    }
}

/// Greatest commanded speed, acceleration and jerk of an axis.
#[derive(Debug)]
struct Peaks {
    greatest: [f64; 3],
    before: Option<Planar>,
    period: Span,
}

impl Peaks {
    fn see(&mut self, command: &Vetted) {
        let Action::Track(setpoint) = command.action() else {
            self.before = None;
            return;
        };
        let per_sec = 1.0 / self.period.secs();
        let jerk = self.before.map_or(Planar::ZERO, |a| (setpoint.acceleration - a) * per_sec);
        self.before = Some(setpoint.acceleration);
        let now = [setpoint.velocity, setpoint.acceleration, jerk];
        for (greatest, now) in self.greatest.iter_mut().zip(now) {
            *greatest = greatest.max(now.x.abs()).max(now.y.abs());
        }
    }
}

/// How near the column's centre must be, m.
const WITHIN_M: f64 = 0.1;
/// How slow, m/s.
const AT_REST_MPS: f64 = 0.05;
/// For how long.
const CALM_FOR: Span = Span::from_millis(200);
