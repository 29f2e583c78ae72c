//! How the column gets to where it is wanted: the paper's proxy, and the proposals that safety chooses from.
//!
//! It proposes velocities, best first. It never makes a command: safety takes the first proposal that it can allow.

pub mod arrival;
pub mod foresight;
pub mod jog;
pub mod planner;
pub mod proxy;
pub mod standing;
pub mod way;

use std::sync::LazyLock;

use crate::frames::{Floor, Planar};
use crate::machine::{AxisLimits, Limits, Travel};
use crate::safety::separation::Threat;

/// The ways to move that can be chosen, by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MotionName {
    /// The paper's spring, damper and cone.
    Proxy,
    /// The quickest way found by driving ahead.
    Planner,
}

impl MotionName {
    /// Every motion.
    pub const ALL: [Self; 2] = [Self::Proxy, Self::Planner];

    /// Its name in configuration, tables and JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Proxy => "proxy",
            Self::Planner => "planner",
        }
    }

    /// The motion of this name.
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|motion| motion.name() == name)
    }
}

/// Velocities to try, best first.
#[derive(Debug, Clone, Default)]
pub struct Proposals {
    velocities: Vec<Planar>,
    side: f64,
}

impl Proposals {
    /// Try what the proxy wants, or the way around whoever stands between; then slower and aside.
    ///
    /// `speed_cap_mps` binds every proposal. The side taken last is preferred, so that a detour does not dither.
    pub fn fill(
        &mut self,
        wanted: Planar,
        speed_cap_mps: f64,
        column: Floor,
        target: Floor,
        threats: &[Threat],
        inside: &Travel,
    ) {
        self.velocities.clear();
        let wanted = wanted.capped(speed_cap_mps);
        let Some(way) = way::find(column, target, self.side, threats, inside) else {
            self.velocities.push(wanted);
            return;
        };
        if way.side == 0.0 {
            self.velocities.push(wanted);
        }
        self.side = way.side;
        let left_m = target.distance_m(column);
        let cruise =
            if way.side == 0.0 { wanted.norm().max(ASIDE_MPS).min(2.0 * left_m) } else { CRUISE_MPS };
        let cruise = cruise.min(speed_cap_mps);
        // Aside means away from the person first.
        let outward = if way.side == 0.0 { 1.0 } else { way.side };
        for (&(angle_deg, share), (sin, cos)) in FAN.iter().zip(TURNS.iter()) {
            for side in [outward, -outward] {
                let velocity = way.heading.turned_by(side * sin, *cos) * (share * cruise);
                self.velocities.push(along_the_walls(velocity, column, inside));
                if angle_deg == 0.0 {
                    break;
                }
            }
        }
    }

    /// The way leads around somebody.
    pub fn goes_around(&self) -> bool {
        self.side != 0.0
    }

    /// The proposals, best first.
    pub fn velocities(&self) -> &[Planar] {
        &self.velocities
    }
}

/// No faster towards a wall than the column can stop before it.
fn along_the_walls(velocity: Planar, column: Floor, inside: &Travel) -> Planar {
    let axis = |v: f64, p: f64, min: f64, max: f64| {
        v.clamp(-WALL_PER_SEC * (p - min).max(0.0), WALL_PER_SEC * (max - p).max(0.0))
    };
    Planar::new(
        axis(velocity.x, column.x, inside.min.x, inside.max.x),
        axis(velocity.y, column.y, inside.min.y, inside.max.y),
    )
}

/// How long the column needs to a place from rest at its limits, s: the slower axis of two trapezoids.
pub fn travel_secs(from: Floor, to: Floor, limits: &Limits) -> f64 {
    let axis = |distance: f64, limits: &AxisLimits| {
        let (v, up, down) = (limits.speed_mps, limits.acceleration_mps2, limits.braking_mps2);
        let ramps = 0.5 * v * v * (1.0 / up + 1.0 / down);
        if distance >= ramps {
            v / up + v / down + (distance - ramps) / v
        } else {
            (2.0 * distance * (1.0 / up + 1.0 / down)).sqrt()
        }
    };
    axis((to.x - from.x).abs(), &limits.x).max(axis((to.y - from.y).abs(), &limits.y))
}

/// Angle from the way, degrees, and share of the cruising speed; by progress made, best first.
const FAN: [(f64, f64); 17] = [
    (0.0, 1.0),
    (20.0, 1.0),
    (0.0, 0.75),
    (40.0, 1.0),
    (20.0, 0.7),
    (60.0, 1.0),
    (0.0, 0.5),
    (40.0, 0.6),
    (75.0, 1.0),
    (60.0, 0.6),
    (25.0, 0.35),
    (0.0, 0.18),
    (90.0, 0.8),
    (80.0, 0.5),
    (50.0, 0.18),
    (90.0, 0.35),
    (110.0, 0.6),
];
/// Sine and cosine of the fan's angles.
static TURNS: LazyLock<[(f64, f64); FAN.len()]> =
    LazyLock::new(|| FAN.map(|(deg, _)| deg.to_radians().sin_cos()));
/// On the way around somebody, m/s.
const CRUISE_MPS: f64 = 1.1;
/// Aside of a straight way at least, m/s.
const ASIDE_MPS: f64 = 0.6;
/// A metre from a wall leaves this much speed towards it, 1/s.
const WALL_PER_SEC: f64 = 2.5;
#[cfg(test)]
mod tests {
    use super::*;
    use crate::observation::PersonId;

    const ROOM: Travel = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) };

    fn threat(x: f64, y: f64) -> Threat {
        let velocity = Planar::ZERO;
        Threat {
            person: PersonId(1),
            head: Floor::new(x, y),
            velocity,
            age_secs: 0.02,
            near_object: false,
            low: false,
        }
    }

    #[test]
    fn no_proposal_is_faster_than_the_cap() {
        let mut proposals = Proposals::default();
        let (column, target) = (Floor::new(0.5, 0.5), Floor::new(3.0, 1.0));
        proposals.fill(Planar::new(1.1, 0.4), 0.3, column, target, &[threat(1.3, 0.5)], &ROOM);
        assert!(proposals.velocities().len() > FAN.len());
        assert!(proposals.velocities().iter().all(|v| v.norm() <= 0.3 + 1e-12));
    }

    #[test]
    fn the_fan_turns_as_its_angles_do() {
        let heading = Planar::new(0.6, -0.8);
        for ((angle_deg, _), (sin, cos)) in FAN.into_iter().zip(*TURNS) {
            for side in [1.0, -1.0] {
                assert_eq!(
                    heading.turned_by(side * sin, cos),
                    heading.turned(side * f64::to_radians(angle_deg))
                );
            }
        }
    }

    #[test]
    fn travel_time_is_the_papers() {
        let far = travel_secs(Floor::new(0.0, 0.0), Floor::new(3.0, 0.0), &Limits::PAPER);
        // 1.1/1.25 + 1.1/2.5 + (3 - 0.726)/1.1
        assert!((far - 3.387).abs() < 0.01, "{far}");
    }
}
