//! How the column gets to where it is wanted: the paper's proxy, and the proposals that safety chooses from.
//!
//! It proposes velocities, best first. It never makes a command: safety takes the first proposal that it can allow.

pub mod proxy;

use crate::frames::{Floor, Planar};
use crate::machine::{AxisLimits, Limits};
use crate::safety::separation::Threat;

/// Velocities to try, best first.
#[derive(Debug, Clone, Default)]
pub struct Proposals {
    velocities: Vec<Planar>,
    side: f64,
}

impl Proposals {
    /// Try `wanted`, then slower and around, by how much of the way to `target` each makes; at last a retreat.
    ///
    /// `speed_cap_mps` binds every proposal. The side taken last is preferred, so that a detour does not dither.
    pub fn fill(
        &mut self,
        wanted: Planar,
        speed_cap_mps: f64,
        column: Floor,
        target: Floor,
        threats: &[Threat],
    ) {
        self.velocities.clear();
        let wanted = wanted.capped(speed_cap_mps);
        self.velocities.push(wanted);
        let to_target = target - column;
        if let Some(heading) = to_target.unit() {
            let cruise = wanted.norm().max(DETOUR_SPEED_MPS).min(speed_cap_mps).min(2.0 * to_target.norm());
            let preferred = if self.side == 0.0 { better_side(column, heading, threats) } else { self.side };
            for (angle_deg, share) in DETOURS {
                for side in [preferred, -preferred] {
                    self.velocities
                        .push(heading.turned(side * f64::to_radians(angle_deg)) * (share * cruise));
                    if angle_deg == 0.0 {
                        break;
                    }
                }
            }
        }
        if to_target.norm() > IN_PLACE_M {
            self.velocities.extend(retreat(column, threats).map(|v| v.capped(speed_cap_mps)));
        }
    }

    /// The proposals, best first.
    pub fn velocities(&self) -> &[Planar] {
        &self.velocities
    }

    /// Remember which way round was taken.
    pub fn took(&mut self, index: usize, column: Floor, target: Floor) {
        let Some(taken) = self.velocities.get(index).and_then(|v| v.unit()) else { return };
        let turn = (target - column).cross(taken);
        if index == 0 {
            self.side = 0.0;
        } else if turn.abs() > 1e-3 {
            self.side = turn.signum();
        }
    }
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

/// Pass behind: on the side that the nearest person on the way moves away from; standing still, the shorter way round.
fn better_side(column: Floor, heading: Planar, threats: &[Threat]) -> f64 {
    let ahead = threats.iter().filter(|t| (t.head - column).dot(heading) > 0.0);
    let nearest = ahead.min_by(|a, b| a.head.distance_m(column).total_cmp(&b.head.distance_m(column)));
    let Some(threat) = nearest else { return 1.0 };
    let drift = heading.cross(threat.velocity);
    let offset = heading.cross(threat.head - column);
    if drift.abs() > 0.15 {
        -drift.signum()
    } else if offset >= 0.0 {
        -1.0
    } else {
        1.0
    }
}

/// Directly away from the nearest person within reach of the column.
fn retreat(column: Floor, threats: &[Threat]) -> Option<Planar> {
    let near = threats.iter().filter(|t| t.head.distance_m(column) < RETREAT_WITHIN_M);
    let nearest = near.min_by(|a, b| a.head.distance_m(column).total_cmp(&b.head.distance_m(column)))?;
    (column - nearest.head).unit().map(|away| away * RETREAT_SPEED_MPS)
}

/// Angle from the straight way, degrees, and share of the cruising speed; by progress made, best first.
const DETOURS: [(f64, f64); 16] = [
    (20.0, 1.0),
    (40.0, 1.0),
    (0.0, 0.7),
    (20.0, 0.7),
    (60.0, 1.0),
    (40.0, 0.6),
    (0.0, 0.4),
    (75.0, 1.0),
    (60.0, 0.6),
    (30.0, 0.35),
    (90.0, 0.8),
    (0.0, 0.18),
    (80.0, 0.5),
    (50.0, 0.18),
    (90.0, 0.35),
    (100.0, 0.6),
];
/// A detour is worth at least this speed, m/s.
const DETOUR_SPEED_MPS: f64 = 0.6;
/// Closer than this to where it is wanted, the column stays, m.
const IN_PLACE_M: f64 = 0.1;
/// Somebody nearer than this is worth leaving when the column cannot go where it is wanted, m.
const RETREAT_WITHIN_M: f64 = 1.0;
/// Within the separation rule's 0.3 m/s, with room for what a machine overshoots.
const RETREAT_SPEED_MPS: f64 = 0.22;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observation::PersonId;

    fn threat(x: f64, y: f64, vy: f64) -> Threat {
        Threat {
            person: PersonId(1),
            head: Floor::new(x, y),
            velocity: Planar::new(0.0, vy),
            age_secs: 0.02,
            near_object: false,
            low: false,
        }
    }

    #[test]
    fn a_detour_passes_behind_a_walking_person() {
        let (column, heading) = (Floor::new(0.0, 0.0), Planar::new(1.0, 0.0));
        assert_eq!(better_side(column, heading, &[threat(1.0, 0.0, 0.8)]), -1.0);
        assert_eq!(better_side(column, heading, &[threat(1.0, 0.0, -0.8)]), 1.0);
        assert_eq!(better_side(column, heading, &[threat(1.0, -0.2, 0.0)]), 1.0, "the shorter way round");
    }

    #[test]
    fn no_proposal_is_faster_than_the_cap() {
        let mut proposals = Proposals::default();
        let (column, target) = (Floor::new(0.0, 0.0), Floor::new(3.0, 1.0));
        proposals.fill(Planar::new(1.1, 0.4), 0.3, column, target, &[threat(0.8, 0.0, 0.0)]);
        assert!(proposals.velocities().len() > DETOURS.len());
        assert!(proposals.velocities().iter().all(|v| v.norm() <= 0.3 + 1e-12));
    }

    #[test]
    fn travel_time_is_the_papers() {
        let far = travel_secs(Floor::new(0.0, 0.0), Floor::new(3.0, 0.0), &Limits::PAPER);
        // 1.1/1.25 + 1.1/2.5 + (3 - 0.726)/1.1
        assert!((far - 3.387).abs() < 0.01, "{far}");
    }
}
