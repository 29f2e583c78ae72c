//! The paper's proxy: a ball on a spring and damper, pulled to the command position, that rolls around people.
//!
//! Theirs ran in a game engine. Ours is the same idea in the plane: the spring's pull is capped so that the ball can
//! still brake in front of its goal; each person carries a cone and each keep-out shape a rim that take away the part
//! of its motion that leads inside, push it out smoothly, and let it slide along.

use crate::frames::{Floor, Planar};
use crate::machine::{Limits, Travel};

/// The ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Proxy {
    position: Floor,
    velocity: Planar,
}

/// Something to roll around.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bump {
    /// From its rim to the ball, m; negative inside.
    pub gap_m: f64,
    /// The direction away from it, a unit vector.
    pub away: Planar,
}

impl Proxy {
    /// Lying still.
    pub const fn at(position: Floor) -> Self {
        Self { position, velocity: Planar::ZERO }
    }

    /// Let it roll for `dt_secs` towards `command`, tied to the column at `column`.
    pub fn roll(
        &mut self,
        command: Floor,
        column: Floor,
        bumps: impl Iterator<Item = Bump>,
        limits: &Limits,
        inside: &Travel,
        dt_secs: f64,
    ) {
        let speed = limits.x.speed_mps.min(limits.y.speed_mps);
        let braking = limits.x.acceleration_mps2.min(limits.y.acceleration_mps2);
        let acceleration = limits.x.braking_mps2.min(limits.y.braking_mps2);
        let to_command = command - self.position;
        let pull =
            (SPRING_PER_SEC * to_command.norm()).min((2.0 * braking * to_command.norm()).sqrt()).min(speed);
        let mut wanted = to_command.unit().map_or(Planar::ZERO, |way| way * pull);
        for bump in bumps {
            wanted = around(wanted, bump);
        }
        let wanted = wanted.capped(speed);
        let change = (wanted - self.velocity) * (DAMPER_PER_SEC * dt_secs).min(1.0);
        self.velocity += change.capped(acceleration * dt_secs);
        // The tie to the column: the ball never runs away from a machine that safety holds back.
        let lead = (self.position + self.velocity * dt_secs - column).capped(LEASH_M);
        self.position = inside.clamped(column + lead);
    }

    /// Where it is.
    pub fn position(&self) -> Floor {
        self.position
    }

    /// Its velocity, m/s.
    pub fn velocity(&self) -> Planar {
        self.velocity
    }

    /// The velocity with which a column at `column` follows the ball, m/s.
    pub fn followed_from(&self, column: Floor) -> Planar {
        self.velocity + (self.position - column) * TIE_PER_SEC
    }
}

/// Keep off a bump: no faster towards it than its gap allows, out of it when inside, and along it instead.
fn around(wanted: Planar, bump: Bump) -> Planar {
    if bump.gap_m > INFLUENCE_M {
        return wanted;
    }
    let inward = -wanted.dot(bump.away);
    let allowed = REPULSION_PER_SEC * bump.gap_m;
    if inward <= allowed {
        return wanted;
    }
    let blocked = inward - allowed;
    let along = wanted + bump.away * inward;
    let tangent = bump.away.left();
    let side = if along.dot(tangent) >= 0.0 { tangent } else { -tangent };
    along + side * (SLIDE * blocked.min(inward.max(0.0))) - bump.away * allowed
}

/// Half the natural frequency of the critically damped spring near its goal, 1/s.
const SPRING_PER_SEC: f64 = 4.0;
/// How fast the damper takes up the wanted velocity, 1/s.
const DAMPER_PER_SEC: f64 = 20.0;
/// How firmly the column is tied to the ball, 1/s.
const TIE_PER_SEC: f64 = 6.0;
/// The ball leads the column by no more than this, m.
const LEASH_M: f64 = 0.25;
/// From here on a bump is felt, m.
const INFLUENCE_M: f64 = 0.8;
/// A metre of gap allows this much speed inward; a metre inside pushes as fast outward, 1/s.
const REPULSION_PER_SEC: f64 = 1.5;
/// The share of the blocked motion that goes along the rim instead.
const SLIDE: f64 = 0.8;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const TRAVEL: Travel = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) };

    fn cone(head: Floor, radius_m: f64, ball: Floor) -> Option<Bump> {
        let from_head = ball - head;
        from_head.unit().map(|away| Bump { gap_m: from_head.norm() - radius_m, away })
    }

    /// Rolls a free ball for `secs`; returns it and the least distance from the head.
    fn rolled(from: Floor, to: Floor, head: Option<Floor>, secs: f64) -> (Proxy, f64) {
        let mut ball = Proxy::at(from);
        let mut least = f64::INFINITY;
        for _ in 0..(secs / 0.004) as usize {
            let here = ball.position();
            let bumps = head.and_then(|h| cone(h, 0.45, here)).into_iter();
            ball.roll(to, here, bumps, &Limits::PAPER, &TRAVEL, 0.004);
            least = least.min(head.map_or(f64::INFINITY, |h| h.distance_m(ball.position())));
        }
        (ball, least)
    }

    #[test]
    fn it_comes_to_rest_at_the_command_position() {
        let (ball, _) = rolled(Floor::new(0.5, 0.5), Floor::new(3.5, 2.0), None, 6.0);
        assert!(ball.position().distance_m(Floor::new(3.5, 2.0)) < 1e-3);
        assert!(ball.velocity().norm() < 1e-3);
    }

    #[test]
    fn it_rolls_around_a_person_who_stands_exactly_in_the_way() {
        let (ball, least) =
            rolled(Floor::new(0.5, 2.0), Floor::new(3.5, 2.0), Some(Floor::new(2.0, 2.0)), 10.0);
        assert!(least > 0.44, "as near as {least} m");
        assert!(ball.position().distance_m(Floor::new(3.5, 2.0)) < 0.01, "stuck at {:?}", ball.position());
    }

    proptest! {
        #[test]
        fn from_outside_it_never_enters_a_cone(
            x in 0.2..3.8f64, y in 0.2..3.8f64, tx in 0.2..3.8f64, ty in 0.2..3.8f64,
        ) {
            let head = Floor::new(2.0, 2.0);
            prop_assume!(head.distance_m(Floor::new(x, y)) > 0.5);
            let (_, least) = rolled(Floor::new(x, y), Floor::new(tx, ty), Some(head), 6.0);
            prop_assert!(least > 0.43, "as near as {}", least);
        }
    }
}
