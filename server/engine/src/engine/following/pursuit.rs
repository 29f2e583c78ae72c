//! The way to where the column is wanted: proposals of the motion chosen, and what safety takes of them.

use super::{Following, Wish};
use crate::frames::{Floor, Planar};
use crate::machine::Travel;
use crate::motion::MotionName;
use crate::motion::foresight::Foresight;
use crate::motion::planner::Errand;
use crate::motion::proxy::{Bump, Proxy};
use crate::safety::governor::Governor;
use crate::safety::path::State;
use crate::safety::separation::{Conflict, Separation};
use crate::time::Span;

/// From where the column is to where it is wanted.
#[derive(Clone, Copy)]
struct Way {
    here: Floor,
    /// Inside the travel.
    target: Floor,
    /// The travel less its margin.
    inside: Travel,
    /// The soft start's.
    speed_cap_mps: f64,
}

impl Following {
    /// Move the commanded state on by one period.
    pub fn follow(
        &mut self,
        governor: &mut Governor,
        wish: Option<Wish>,
        measured: &State,
        separation: &Separation<'_>,
        since: Span,
        period: Span,
    ) {
        let ago = |(conflict, ago): (Conflict, Span)| (conflict, ago + period);
        let before = self.last_conflict.map(ago).filter(|(_, ago)| *ago <= HELD_FOR);
        let here = governor.commanded().position();
        let inside = separation.travel.shrunk(separation.parameters.travel_margin_m);
        let target = inside.clamped(wish.map_or(here, |w| w.target));
        let settled =
            here.distance_m(target) < SETTLED_M && governor.commanded().velocity().norm() < SETTLED_MPS;
        let way =
            Way { here, target, inside, speed_cap_mps: SOFT_START_MPS + SOFT_START_MPS2 * since.secs() };
        let stays = settled || wish.is_none();
        let rolls = !stays && self.motion == MotionName::Proxy;
        self.goes_around = false;
        self.conflict = if stays {
            // Nothing is wanted, but somebody may be coming: the measured state is still looked at.
            let choice = governor.govern(&[Planar::ZERO], measured, separation, period);
            choice.conflict.filter(|_| choice.taken.is_none() && !settled)
        } else if rolls {
            self.roll(&way, separation, period);
            governor.govern(self.proposals.velocities(), measured, separation, period).conflict
        } else {
            self.plan(governor, wish.and_then(|w| w.touch_secs), &way, separation, period);
            governor.govern(self.planner.velocities(), measured, separation, period).conflict
        };
        if !rolls {
            self.proxy = Proxy::at(governor.commanded().position());
        }
        self.last_conflict = self.conflict.map(|conflict| (conflict, Span::ZERO)).or(before);
    }

    /// Where the column comes to rest as things are, from `here`: where it is wanted, or a little short of it; none when
    /// nobody is served.
    pub fn rests_at(&self, here: Floor) -> Option<Floor> {
        let target = self.wish()?.target;
        Some(if self.stops_short { nearly(here, target) } else { target })
    }

    /// Proposals of the planner.
    fn plan(
        &mut self,
        governor: &Governor,
        touch_secs: Option<f64>,
        way: &Way,
        separation: &Separation<'_>,
        period: Span,
    ) {
        let foresight = Foresight {
            limits: separation.limits,
            parameters: separation.parameters,
            footprint: separation.scene.footprint(),
            keep_outs: separation.scene.keep_outs(),
            // With the separation rule left out there is nobody to be led around either.
            walkers: if separation.threats.is_empty() { &[] } else { &self.walkers },
        };
        // A hand that meets a moving column is not served: rather than be late in the middle it stops short. Once it
        // does, it makes for the middle again only with time to spare.
        let spare_secs = touch_secs.map(|touch| touch - self.planner.arrival_secs());
        let needs_secs = STILL_BEFORE_TOUCH_SECS + if self.stops_short { SPARE_SECS } else { 0.0 };
        self.stops_short = spare_secs.is_some_and(|spare| spare <= needs_secs);
        let errand = Errand {
            target: if self.stops_short { nearly(way.here, way.target) } else { way.target },
            speed_cap_mps: way.speed_cap_mps,
            inside: way.inside,
            elapsed_secs: period.secs(),
        };
        self.planner.plan(governor.commanded(), &errand, &foresight);
        self.goes_around = self.planner.goes_around();
    }

    /// Proposals of the paper's ball.
    fn roll(&mut self, way: &Way, separation: &Separation<'_>, period: Span) {
        let Way { here, target, inside, speed_cap_mps } = *way;
        let clearances = &self.clearances_m;
        let ball = self.proxy.position();
        let heads = separation.threats.iter().zip(clearances).filter_map(|(threat, radius_m)| {
            let from_head = ball - threat.head;
            Some(Bump { gap_m: from_head.norm() - radius_m, away: from_head.unit()? })
        });
        let footprint = separation.scene.footprint();
        let rims = separation.scene.keep_outs().iter().filter_map(|keep_out| {
            let gap_m =
                keep_out.distance_m(footprint, ball) - separation.parameters.radius_m - KEEP_OUT_RIM_M;
            Some(Bump { gap_m, away: keep_out.away(footprint, ball)? })
        });
        self.proxy.roll(target, here, heads.chain(rims), separation.limits, &inside, period.secs());
        let wanted = self.proxy.followed_from(here);
        self.proposals.fill(wanted, speed_cap_mps, here, target, separation.threats, &inside);
        self.goes_around = self.proposals.goes_around();
    }
}

/// As near as still serves: where it is, or short of the target on the way there.
fn nearly(here: Floor, target: Floor) -> Floor {
    let back = here - target;
    if back.norm() < NEARLY_M { here } else { target + back.capped(SHORT_M) }
}

/// A prop that a hand meets has stood still for so long, s.
const STILL_BEFORE_TOUCH_SECS: f64 = 0.4;
/// So much more time makes it go for the middle again, s.
const SPARE_SECS: f64 = 0.1;
/// Nearer than this, and still, it serves: inside what the evaluation asks, m.
const NEARLY_M: f64 = 0.07;
/// So far short of the target it comes to rest when it would be late there, m.
const SHORT_M: f64 = 0.05;
/// The ball keeps this much more off a keep-out shape than the separation rule asks, m.
const KEEP_OUT_RIM_M: f64 = 0.03;
/// After arming and after a protective stop the speed begins here and grows: m/s, m/s2.
const SOFT_START_MPS: f64 = 0.2;
const SOFT_START_MPS2: f64 = 0.6;
/// A conflict holds the column for so long after it was.
const HELD_FOR: Span = Span::from_millis(200);
/// Closer and slower than this there is nothing to correct: m, m/s.
const SETTLED_M: f64 = 0.001;
const SETTLED_MPS: f64 = 0.002;
