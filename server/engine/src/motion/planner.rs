//! `planner`: the motion to where the column is wanted that gets there first, looked for anew every period.
//!
//! A plan is a few places to make for in turn, each until a moment, then the target; each axis at its own limits. It is
//! driven ahead of time, people as they are foreseen, slower where separation would not allow it. Around the best plan
//! others are tried, a few each period; the first part of the best is proposed to safety.

use crate::frames::{Floor, Planar};
use crate::machine::{AxisLimits, Travel};
use crate::motion::foresight::Foresight;
use crate::safety::path::State;

/// The planner's memory.
#[derive(Debug, Clone)]
pub struct Planner {
    plan: Plan,
    /// The target when it last moved, how long ago, s, and how many more periods search widely for it.
    target: Floor,
    since_secs: f64,
    fresh: u32,
    draw: Draw,
    arrival_secs: f64,
    velocities: Vec<Planar>,
}

/// Places to make for in turn, each until a moment; then the target.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Plan {
    legs: [Leg; 2],
}

/// A place to make for, and until when, s from now; past ones are over.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Leg {
    to: Floor,
    until_secs: f64,
}

/// Where the column is to go.
#[derive(Debug, Clone, Copy)]
pub struct Errand {
    /// Where it is wanted.
    pub target: Floor,
    /// No faster than this, m/s.
    pub speed_cap_mps: f64,
    /// The travel less its margin.
    pub inside: Travel,
    /// Time since the last plan, s.
    pub elapsed_secs: f64,
}

/// Numbers without a pattern, the same in every run.
#[derive(Debug, Clone, Copy)]
struct Draw(u64);

impl Default for Planner {
    fn default() -> Self {
        Self {
            plan: Plan::STRAIGHT,
            target: Floor::new(0.0, 0.0),
            since_secs: MOVED_AFTER_SECS,
            fresh: FIRST_PERIODS,
            draw: Draw(1),
            arrival_secs: HORIZON_SECS,
            velocities: Vec::new(),
        }
    }
}

impl Planner {
    /// Look for a better plan and say which velocities to try, best first.
    pub fn plan(&mut self, state: &State, errand: &Errand, foresight: &Foresight<'_>) {
        let here = state.position();
        let start = (here, state.velocity());
        let plan = self.plan.after(errand.elapsed_secs);
        let mut best = (plan, drive(&plan, start, errand, foresight));
        let straight = drive(&Plan::STRAIGHT, start, errand, foresight);
        if straight <= best.1 {
            best = (Plan::STRAIGHT, straight);
        }
        self.since_secs += errand.elapsed_secs;
        if self.target.distance_m(errand.target) > MOVED_M && self.since_secs > MOVED_AFTER_SECS {
            self.since_secs = 0.0;
            self.target = errand.target;
            self.fresh = FIRST_PERIODS;
        }
        let (tries, seeds) = if self.fresh > 0 { FIRST_TRIES } else { TRIES };
        self.fresh = self.fresh.saturating_sub(1);
        for k in 0..tries {
            let tried = if k < seeds {
                self.draw.plan(here, errand, foresight)
            } else {
                self.draw.like(&best.0, best.1, errand)
            };
            let cost = drive(&tried, start, errand, foresight);
            if cost < best.1 - GAIN_SECS {
                best = (tried, cost);
            }
        }
        (self.plan, self.arrival_secs) = best;
        let wanted = wanted(&self.plan, here, 0.0, errand, foresight);
        self.velocities.clear();
        for (angle_deg, share) in FAN {
            for side in [1.0, -1.0] {
                let velocity = wanted.turned(side * f64::to_radians(angle_deg)) * share;
                self.velocities.push(along_the_walls(velocity, here, errand));
                if angle_deg == 0.0 {
                    break;
                }
            }
        }
    }

    /// The velocities to try, best first.
    pub fn velocities(&self) -> &[Planar] {
        &self.velocities
    }

    /// How long the plan takes, s from when it was made; none where it does not arrive as far ahead as it looks.
    pub fn arrives_in_secs(&self) -> Option<f64> {
        Some(self.arrival_secs).filter(|secs| *secs < HORIZON_SECS)
    }

    /// The same; past the horizon where it does not arrive.
    pub fn arrival_secs(&self) -> f64 {
        self.arrival_secs
    }

    /// The way leads around somebody.
    pub fn goes_around(&self) -> bool {
        self.plan.legs.iter().any(|leg| leg.until_secs > 0.0)
    }
}

impl Plan {
    const STRAIGHT: Self = Self { legs: [Leg { to: Floor::new(0.0, 0.0), until_secs: 0.0 }; 2] };

    fn after(mut self, secs: f64) -> Self {
        for leg in &mut self.legs {
            leg.until_secs -= secs;
        }
        self
    }
}

impl Draw {
    fn unit(&mut self) -> f64 {
        // SplitMix64.
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn about(&mut self, scale: f64) -> f64 {
        (self.unit() + self.unit() - 1.0) * scale
    }

    /// A plan around somebody: a level of one axis or of the other beside their head.
    fn plan(&mut self, here: Floor, errand: &Errand, foresight: &Foresight<'_>) -> Plan {
        let count = foresight.walkers.len();
        if count == 0 {
            return Plan::STRAIGHT;
        }
        let head = foresight.walkers[(self.unit() * count as f64) as usize % count].head;
        let off = |draw: &mut Self| (1.0 + 0.9 * draw.unit()).copysign(draw.unit() - 0.5);
        let target = errand.target;
        let (dx, dy) = (off(self), off(self));
        let (beside_x, beside_y) = (head.x + dx, head.y + dy);
        let kind = self.unit();
        let (first, second) = if kind < 0.25 {
            (Floor::new(target.x, beside_y), Floor::new(target.x, beside_y))
        } else if kind < 0.5 {
            (Floor::new(beside_x, target.y), Floor::new(beside_x, target.y))
        } else if kind < 0.625 {
            (Floor::new(beside_x, here.y), Floor::new(beside_x, target.y))
        } else if kind < 0.75 {
            (Floor::new(here.x, beside_y), Floor::new(target.x, beside_y))
        } else {
            (Floor::new(beside_x, beside_y), Floor::new(beside_x, beside_y))
        };
        let secs = 3.0 * self.unit();
        let share = self.unit();
        let leg = |to: Floor, until_secs| Leg { to: errand.inside.clamped(to), until_secs };
        Plan { legs: [leg(first, secs * share), leg(second, secs)] }
    }

    /// A plan like this one.
    fn like(&mut self, plan: &Plan, arrival_secs: f64, errand: &Errand) -> Plan {
        let mut plan = *plan;
        let scale = SCALES[(self.unit() * SCALES.len() as f64) as usize % SCALES.len()];
        let which = self.unit();
        for (k, leg) in plan.legs.iter_mut().enumerate() {
            if leg.until_secs <= 0.0 || (which < 0.3 && k == 0) || (which > 0.7 && k == 1) {
                continue;
            }
            let to = leg.to + Planar::new(self.about(scale), self.about(scale));
            leg.to = errand.inside.clamped(to);
            leg.until_secs = (leg.until_secs + self.about(scale)).min(arrival_secs);
        }
        plan
    }
}

/// How long the plan takes, s; past the horizon with what is left of it.
fn drive(plan: &Plan, start: (Floor, Planar), errand: &Errand, foresight: &Foresight<'_>) -> f64 {
    let (mut p, mut v) = start;
    let limits = foresight.limits;
    for k in 0..STEPS {
        let t = k as f64 * STEP_SECS;
        let left_m = p.distance_m(errand.target);
        if left_m < ARRIVED_M && v.norm() < ARRIVED_MPS {
            return t + left_m;
        }
        let wanted = wanted(plan, p, t, errand, foresight);
        let next_of = |share: f64| {
            Planar::new(stepped(v.x, wanted.x * share, &limits.x), stepped(v.y, wanted.y * share, &limits.y))
        };
        let allowed =
            |next: &Planar| foresight.allows(p + (v + *next) * (0.5 * STEP_SECS), *next, t + STEP_SECS);
        let next = SHARES.into_iter().map(next_of).find(allowed).unwrap_or_else(|| next_of(0.0));
        p += (v + next) * (0.5 * STEP_SECS);
        v = next;
    }
    HORIZON_SECS + LATE_SECS_PER_M * p.distance_m(errand.target)
}

/// The velocity wanted at a place.
fn wanted(plan: &Plan, at: Floor, secs: f64, errand: &Errand, foresight: &Foresight<'_>) -> Planar {
    let leg = plan.legs.iter().find(|leg| secs < leg.until_secs);
    let left = leg.map_or(errand.target, |leg| leg.to) - at;
    let x = approach(left.x, &foresight.limits.x);
    let y = approach(left.y, &foresight.limits.y);
    Planar::new(x, y).capped(errand.speed_cap_mps)
}

/// The fastest velocity from which an axis still stops after `left_m`, m/s.
fn approach(left_m: f64, limits: &AxisLimits) -> f64 {
    let b = limits.braking_mps2;
    let v = b * ((SETTLING_SECS * SETTLING_SECS + 2.0 * left_m.abs() / b).sqrt() - SETTLING_SECS);
    v.min(limits.speed_mps).copysign(left_m)
}

/// The velocity of an axis one step later.
fn stepped(v: f64, wanted: f64, limits: &AxisLimits) -> f64 {
    let slows = wanted.abs() < v.abs() || wanted * v < 0.0;
    let most = STEP_SECS * if slows { limits.braking_mps2 } else { limits.acceleration_mps2 };
    v + (wanted - v).clamp(-most, most)
}

/// No faster towards a wall than the column can stop before it.
fn along_the_walls(velocity: Planar, column: Floor, errand: &Errand) -> Planar {
    let axis = |v: f64, p: f64, min: f64, max: f64| {
        v.clamp(-WALL_PER_SEC * (p - min).max(0.0), WALL_PER_SEC * (max - p).max(0.0))
    };
    let inside = &errand.inside;
    Planar::new(
        axis(velocity.x, column.x, inside.min.x, inside.max.x),
        axis(velocity.y, column.y, inside.min.y, inside.max.y),
    )
}

/// A plan is driven in steps of this, s.
const STEP_SECS: f64 = 0.06;
const STEPS: usize = 75;
/// Farther ahead nothing is known, s.
const HORIZON_SECS: f64 = STEP_SECS * STEPS as f64;
/// As near, m, and as slow, m/s, as to have arrived.
const ARRIVED_M: f64 = 0.03;
const ARRIVED_MPS: f64 = 0.25;
/// What a metre left at the horizon counts, s.
const LATE_SECS_PER_M: f64 = 2.0;
/// A plan is left only for one quicker by this, s.
const GAIN_SECS: f64 = 0.005;
/// Plans tried in a period, and how many of them are new rather than like the best.
const TRIES: (usize, usize) = (4, 1);
/// The same for the first periods after the target moved.
const FIRST_TRIES: (usize, usize) = (16, 8);
const FIRST_PERIODS: u32 = 12;
/// A target has moved when it is so far from where it was, m, and not again so soon, s.
const MOVED_M: f64 = 0.3;
const MOVED_AFTER_SECS: f64 = 0.3;
/// How far, m, and by how much time, s, plans like the best differ from it.
const SCALES: [f64; 3] = [0.5, 0.15, 0.05];
/// Taken off the stopping curve, so that an axis settles without running past, s.
const SETTLING_SECS: f64 = 0.08;
/// A metre from a wall leaves this much speed towards it, 1/s.
const WALL_PER_SEC: f64 = 4.0;
/// Shares of the wanted speed that a plan falls back on.
const SHARES: [f64; 5] = [1.0, 0.8, 0.6, 0.4, 0.2];
/// Angle from what the plan wants, degrees, and share of its speed; best first.
const FAN: [(f64, f64); 15] = [
    (0.0, 1.0),
    (10.0, 1.0),
    (0.0, 0.9),
    (0.0, 0.8),
    (20.0, 0.9),
    (0.0, 0.65),
    (30.0, 0.8),
    (0.0, 0.5),
    (45.0, 0.7),
    (0.0, 0.3),
    (65.0, 0.6),
    (0.0, 0.15),
    (30.0, 0.2),
    (90.0, 0.5),
    (90.0, 0.2),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::Limits;
    use crate::motion::foresight::Walker;
    use crate::motion::travel_secs;
    use crate::safety::parameters::Parameters;
    use crate::scene::footprint::Footprint;
    use proptest::prelude::*;

    const INSIDE: Travel = Travel { min: Floor::new(0.02, 0.02), max: Floor::new(4.98, 4.98) };
    const PERIOD_SECS: f64 = 0.004;

    fn stands_at(x: f64, y: f64) -> Walker {
        Walker {
            head: Floor::new(x, y),
            velocity: Planar::ZERO,
            walks_secs: 0.0,
            age_secs: 0.01,
            near_from_secs: f64::INFINITY,
            low: false,
        }
    }

    /// Follows the plans until the target is reached; the time and the least distance from the first walker.
    fn travels(from: Floor, target: Floor, walkers: &[Walker]) -> (f64, f64) {
        let (limits, parameters) = (Limits::PAPER, Parameters::new(1.6));
        let footprint = Footprint::new(Planar::new(0.15, 0.15), &[]);
        let foresight = Foresight {
            limits: &limits,
            parameters: &parameters,
            footprint: &footprint,
            keep_outs: &[],
            walkers,
        };
        let errand = Errand { target, speed_cap_mps: 2.0, inside: INSIDE, elapsed_secs: PERIOD_SECS };
        let mut planner = Planner::default();
        let (mut p, mut v) = (from, Planar::ZERO);
        let mut least = f64::INFINITY;
        for k in 0..3_000 {
            if p.distance_m(target) < 0.05 && v.norm() < 0.05 {
                return (f64::from(k) * PERIOD_SECS, least);
            }
            planner.plan(&State::moving(p, v), &errand, &foresight);
            let follow = |v: f64, wanted: f64, limits: &AxisLimits| {
                let slows = wanted.abs() < v.abs() || wanted * v < 0.0;
                let most = if slows { limits.braking_mps2 } else { limits.acceleration_mps2 } * PERIOD_SECS;
                v + (wanted - v).clamp(-most, most)
            };
            let reached = |wanted: &Planar| {
                Planar::new(follow(v.x, wanted.x, &limits.x), follow(v.y, wanted.y, &limits.y))
            };
            let allowed = |next: &Planar| foresight.allows(p + *next * PERIOD_SECS, *next, 0.0);
            let next = planner.velocities().iter().map(reached).find(allowed);
            v = next.unwrap_or_else(|| reached(&Planar::ZERO));
            p += v * PERIOD_SECS;
            least = least.min(walkers.first().map_or(f64::INFINITY, |walker| p.distance_m(walker.head)));
        }
        (f64::INFINITY, least)
    }

    #[test]
    fn with_nobody_there_it_takes_hardly_longer_than_the_axes_do() {
        let (from, to) = (Floor::new(0.5, 0.5), Floor::new(4.0, 2.5));
        let (secs, _) = travels(from, to, &[]);
        let least = travel_secs(from, to, &Limits::PAPER);
        assert!(secs < least + 0.25, "{secs} s against {least} s");
    }

    #[test]
    fn it_goes_around_somebody_in_the_middle_at_nearly_full_speed() {
        let (from, to) = (Floor::new(0.7, 2.9), Floor::new(4.2, 2.4));
        let (secs, least) = travels(from, to, &[stands_at(2.5, 2.5)]);
        // 3.5 m of rail at 1.1 m/s is 3.8 s; straight on it would never get past.
        assert!(secs < 5.2 && least > 1.0, "{secs} s, as near as {least} m");
    }

    #[test]
    fn the_same_again_is_the_same() {
        let go = || travels(Floor::new(0.7, 2.9), Floor::new(4.2, 2.4), &[stands_at(2.4, 2.6)]);
        assert_eq!(go(), go());
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]
        /// Wherever somebody stands away from both ends, the column gets there.
        #[test]
        fn it_arrives(hx in 1.8..3.2f64, hy in 1.8..3.2f64, y in 0.3..4.7f64, ty in 0.3..4.7f64) {
            let (secs, _) = travels(Floor::new(0.3, y), Floor::new(4.7, ty), &[stands_at(hx, hy)]);
            prop_assert!(secs < 9.0, "{} s", secs);
        }
    }
}
