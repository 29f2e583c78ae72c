//! Foresight: what separation will allow later on, cheaply and only for planning. Safety decides anew at every period.

use crate::frames::{Floor, Planar};
use crate::machine::{AxisLimits, Limits};
use crate::safety::parameters::Parameters;
use crate::safety::separation::Threat;
use crate::scene::footprint::{Footprint, KeepOut};

/// A person as far as they can be foreseen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Walker {
    /// The head axis now.
    pub head: Floor,
    /// Velocity over the floor that is expected to last, m/s.
    pub velocity: Planar,
    /// For how long they go on like that, s.
    pub walks_secs: f64,
    /// Age of the pose, s.
    pub age_secs: f64,
    /// From then on, s, the head is near an enabled object; infinite: never.
    pub near_from_secs: f64,
    /// The head is low.
    pub low: bool,
}

impl Walker {
    /// A person who goes on for a moment as they do.
    pub fn foreseen(threat: &Threat) -> Self {
        Self {
            head: threat.head + threat.velocity * threat.age_secs,
            velocity: threat.velocity,
            walks_secs: WALKS_ON_SECS,
            age_secs: threat.age_secs,
            near_from_secs: if threat.near_object { 0.0 } else { f64::INFINITY },
            low: threat.low,
        }
    }

    /// Where the head is expected to be.
    pub fn head_at(&self, secs: f64) -> Floor {
        self.head + self.velocity * secs.min(self.walks_secs)
    }
}

/// What stays the same over one plan.
#[derive(Debug, Clone, Copy)]
pub struct Foresight<'a> {
    /// The machine's limits.
    pub limits: &'a Limits,
    /// The separation rule's numbers.
    pub parameters: &'a Parameters,
    /// Column and props.
    pub footprint: &'a Footprint,
    /// Where the column must never go.
    pub keep_outs: &'a [KeepOut],
    /// Everybody.
    pub walkers: &'a [Walker],
}

impl Foresight<'_> {
    /// Whether the column may be expected to be allowed this motion `secs` from now.
    ///
    /// While v_h is at least the column's speed, the slack `d(c(s)) - r - v_h s` falls all along the brake path (d changes
    /// no faster than the column moves), so its end decides.
    pub fn allows(&self, centre: Floor, velocity: Planar, secs: f64) -> bool {
        let speed = velocity.norm();
        if speed < STANDS_MPS {
            return true;
        }
        let reaction = self.parameters.reaction.secs();
        let (x, x_secs) = braked(velocity.x, &self.limits.x, reaction);
        let (y, y_secs) = braked(velocity.y, &self.limits.y, reaction);
        let end = centre + Planar::new(x, y);
        let rests_secs = x_secs.max(y_secs);
        let p = self.parameters;
        let clear_of = |walker: &Walker| {
            let near = secs >= walker.near_from_secs && speed <= p.near_speed_mps - OVERSHOOT_MPS;
            let r = match (walker.low, near) {
                (true, _) => p.low_radius_m,
                (false, true) => p.near_radius_m,
                (false, false) => p.radius_m,
            };
            let required =
                r + p.v_h_mps * (walker.age_secs + rests_secs) + p.following_allowance_m + MARGIN_M;
            self.footprint.distance_m(end, walker.head_at(secs)) > required
        };
        let clear_of_shape = |shape: &KeepOut| {
            shape.distance_m(self.footprint, end) > p.radius_m + p.following_allowance_m + MARGIN_M
        };
        self.walkers.iter().all(clear_of) && self.keep_outs.iter().all(clear_of_shape)
    }
}

/// How far an axis runs on, and for how long, if it speeds up for the reaction time and then brakes at its limit.
fn braked(v: f64, limits: &AxisLimits, reaction_secs: f64) -> (f64, f64) {
    let speed = v.abs();
    if speed < STANDS_MPS {
        return (0.0, 0.0);
    }
    let jerk = limits.jerk_mps3;
    let push = limits.acceleration_mps2.min((limits.speed_mps - speed).max(0.0) / reaction_secs);
    let pushed = speed + push * reaction_secs;
    // The push fades before the brake bites.
    let fades_secs = push / jerk;
    let fastest = pushed + 0.5 * push * fades_secs;
    let brake_secs = fastest / limits.braking_mps2 + limits.braking_mps2 / jerk;
    let way = 0.5 * (speed + pushed) * reaction_secs + fastest * fades_secs + 0.5 * fastest * brake_secs;
    (way.copysign(v), reaction_secs + fades_secs + brake_secs)
}

/// A present velocity says little about later than this, s: from 0 to 1 s the evaluation hardly tells them apart.
pub const WALKS_ON_SECS: f64 = 0.6;
/// Slower than this nothing moves, m/s.
const STANDS_MPS: f64 = 1e-3;
/// Separation takes the column to be this much faster than told, m/s.
const OVERSHOOT_MPS: f64 = 0.03;
/// Plans keep this much more than safety asks, so that a step is not refused for a rounding, m.
const MARGIN_M: f64 = 0.01;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::Point;
    use crate::machine::Travel;
    use crate::observation::PersonId;
    use crate::safety::path::State;
    use crate::safety::separation::Separation;
    use crate::scene::{ObjectSpec, Scene, SceneSpec, Shape};
    use proptest::prelude::*;

    proptest! {
        /// What is foreseen as allowed is allowed when it comes to it: plans are not refused half way.
        #[test]
        fn what_it_allows_safety_allows(
            (x, y) in (1.0..4.0f64, 1.0..4.0f64), (vx, vy) in (-1.1..1.1f64, -1.1..1.1f64),
            (hx, hy) in (0.0..5.0f64, 0.0..5.0f64), age_secs in 0.0..0.1f64, low in prop::bool::ANY,
        ) {
            let ball = ObjectSpec {
                id: "ball".into(),
                position: Point::new(0.5, 0.5, 1.0),
                yaw_rad: 0.0,
                shape: Shape::Sphere { radius_m: 0.1 },
                prop: None,
                prior: 1.0,
                enabled: true,
            };
            let travel = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(5.0, 5.0) };
            let scene = Scene::build(SceneSpec::open(travel, vec![ball])).unwrap();
            let parameters = Parameters::new(1.6);
            let threat = Threat {
                person: PersonId(1),
                head: Floor::new(hx, hy),
                velocity: Planar::ZERO,
                age_secs,
                near_object: false,
                low,
            };
            let foresight = Foresight {
                limits: &Limits::PAPER,
                parameters: &parameters,
                footprint: scene.footprint(),
                keep_outs: scene.keep_outs(),
                walkers: &[Walker::foreseen(&threat)],
            };
            let (place, velocity) = (Floor::new(x, y), Planar::new(vx, vy));
            if foresight.allows(place, velocity, 0.0) {
                let separation = Separation {
                    scene: &scene,
                    limits: &Limits::PAPER,
                    travel: &travel,
                    threats: &[threat],
                    parameters: &parameters, contact: None };
                prop_assert_eq!(separation.certify(&State::moving(place, velocity)), Ok(()));
            }
        }
    }
}
