//! Which way to head: straight to the target, or around whoever stands between, early and on the good side.
//!
//! A person who must be passed is a circle, as large as full speed needs under the separation rule. The way leads along
//! its tangent. Of the two sides the one that takes less time is chosen, where a gap to the wall that is narrower
//! than the circle has to be passed more slowly.

use crate::frames::{Floor, Planar};
use crate::machine::Travel;
use crate::safety::separation::Threat;

/// A way to go on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Way {
    /// A unit vector.
    pub heading: Planar,
    /// Around somebody: the person stays on the other side of +1 (leftwards) or -1 (rightwards); 0 straight.
    pub side: f64,
}

/// The way from `column` to `target`; none when it is there. `side` is the side taken last, and is preferred.
pub fn find(column: Floor, target: Floor, side: f64, threats: &[Threat], inside: &Travel) -> Option<Way> {
    let straight = (target - column).unit()?;
    let in_the_way = |threat: &&Threat| blocks(column, target, at_passing(threat, column));
    let nearest = threats
        .iter()
        .filter(in_the_way)
        .min_by(|a, b| a.head.distance_m(column).total_cmp(&b.head.distance_m(column)));
    let Some(threat) = nearest else { return Some(Way { heading: straight, side: 0.0 }) };
    let head = at_passing(threat, column);
    let cost = |way_round: f64| {
        let constancy = if side == way_round { CONSTANCY } else { 1.0 };
        constancy * secs_around(column, target, head, way_round, inside)
    };
    let side = if cost(1.0) <= cost(-1.0) { 1.0 } else { -1.0 };
    Some(Way { heading: tangent(column, head, side), side })
}

/// Where the person will be about when the column passes.
fn at_passing(threat: &Threat, column: Floor) -> Floor {
    let secs = (threat.head.distance_m(column) / SPEED_MPS).min(FORESIGHT_SECS);
    threat.head + threat.velocity * secs
}

/// The straight way enters the person's circle before it ends.
fn blocks(column: Floor, target: Floor, head: Floor) -> bool {
    let way = target - column;
    let to_head = head - column;
    let along = (to_head.dot(way) / way.dot(way)).clamp(0.0, 1.0);
    let nearest = column + way * along;
    // A target inside the circle is not gone around, it is approached; and from inside, leaving is straight.
    let circle = CIRCLE_M.min(target.distance_m(head) - 0.05);
    along > 0.0 && nearest.distance_m(head) < circle
}

/// The direction along the circle about `head`, passing it on `side`.
fn tangent(column: Floor, head: Floor, side: f64) -> Planar {
    let to_head = head - column;
    let distance = to_head.norm().max(1e-6);
    let turn = if distance > CIRCLE_M {
        (CIRCLE_M / distance).asin()
    } else {
        // Inside: along it and outwards, the more so the deeper.
        std::f64::consts::FRAC_PI_2 + OUTWARD_RAD * (1.0 - distance / CIRCLE_M)
    };
    to_head.unit().unwrap_or(Planar::new(1.0, 0.0)).turned(side * turn)
}

/// About how long the way around on one side takes.
fn secs_around(column: Floor, target: Floor, head: Floor, side: f64, inside: &Travel) -> f64 {
    let across = (target - column).unit().unwrap_or(Planar::new(1.0, 0.0)).left() * side;
    let beside = inside.clamped(head + across * CIRCLE_M);
    let gap = beside.distance_m(head);
    let way = column.distance_m(beside) + beside.distance_m(target);
    way / passing_speed_mps(gap)
}

/// The speed that the separation rule leaves at this distance between centres: braking in time, v_h meanwhile.
fn passing_speed_mps(gap_m: f64) -> f64 {
    ((gap_m - CLOSEST_M) * SPEED_PER_METRE).clamp(0.05, SPEED_MPS)
}

/// At this distance between centres the rule leaves full speed: 0.35 m, half a carriage, and 1.6 m/s for as long as
/// reaction and braking from 1.1 m/s take (about 0.6 s).
const CIRCLE_M: f64 = 1.45;
/// At this distance it leaves none.
const CLOSEST_M: f64 = 0.70;
/// In between: full speed over the width of the ring, 1/s.
const SPEED_PER_METRE: f64 = 1.1 / (CIRCLE_M - CLOSEST_M);
/// The paper's machine, m/s.
const SPEED_MPS: f64 = 1.1;
/// A person's present velocity says little about later than this, s.
const FORESIGHT_SECS: f64 = 0.8;
/// The side taken last is left only for one that is this much quicker.
const CONSTANCY: f64 = 0.75;
/// How far outwards of the tangent the way leads from deep inside the circle, rad.
const OUTWARD_RAD: f64 = 0.9;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observation::PersonId;

    const ROOM: Travel = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(5.0, 5.0) };

    fn threat(x: f64, y: f64, velocity: Planar) -> Threat {
        Threat {
            person: PersonId(1),
            head: Floor::new(x, y),
            velocity,
            age_secs: 0.02,
            near_object: false,
            low: false,
        }
    }

    fn way(column: (f64, f64), target: (f64, f64), threat: Threat) -> Way {
        find(Floor::new(column.0, column.1), Floor::new(target.0, target.1), 0.0, &[threat], &ROOM).unwrap()
    }

    #[test]
    fn with_nobody_between_the_way_is_straight() {
        let way = way((0.5, 0.5), (4.5, 0.5), threat(2.5, 4.0, Planar::ZERO));
        assert_eq!(way, Way { heading: Planar::new(1.0, 0.0), side: 0.0 });
    }

    #[test]
    fn it_passes_on_the_side_with_room() {
        assert_eq!(way((0.5, 2.0), (4.5, 2.0), threat(2.5, 1.6, Planar::ZERO)).side, 1.0);
        assert_eq!(way((0.5, 3.0), (4.5, 3.0), threat(2.5, 3.4, Planar::ZERO)).side, -1.0);
    }

    #[test]
    fn it_passes_behind_somebody_who_walks_across() {
        assert_eq!(way((0.5, 2.5), (4.5, 2.5), threat(2.5, 2.5, Planar::new(0.0, 0.8))).side, -1.0);
        assert_eq!(way((0.5, 2.5), (4.5, 2.5), threat(2.5, 2.5, Planar::new(0.0, -0.8))).side, 1.0);
    }

    #[test]
    fn from_inside_the_circle_it_leads_outwards() {
        let way = way((1.7, 2.5), (4.5, 2.5), threat(2.5, 2.5, Planar::ZERO));
        assert!(way.heading.x < 0.0, "{way:?}");
    }

    #[test]
    fn somebody_at_the_target_is_approached() {
        let way = way((0.5, 2.5), (3.5, 2.5), threat(4.1, 2.5, Planar::ZERO));
        assert_eq!(way.side, 0.0);
    }
}
