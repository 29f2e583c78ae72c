//! R14, clause by clause, for a visitor in contact: how fast and how gently the column may move, and where the head has to be.
//!
//! Lead and transport no faster than 0.6 m/s, brush 0.3 m/s. Speeding up, as commanded: 0.5 m/s2 an axis, transport 0.4. Lead and brush: the
//! head stays 0.35 m from the footprint less the prop in contact; transport: within 0.6 m of the seat. Where it does not, the column has to
//! rest, or go away from it, within the age that a pose may have in a contact (0.2 s), one reaction and one braking.

use covr_engine::frames::Planar;
use covr_engine::time::{Span, Time};

use super::geometry::to_point;
use super::{Breach, ContactKind, ContactNow, MOVING_MPS, Moment, Rules, Track};

/// What has to be remembered from tick to tick.
#[derive(Debug, Clone, Default)]
pub(super) struct ContactWatch {
    /// Since when the head has not been where it has to be, the column going on.
    astray_since: Option<Time>,
    before: Option<(Time, Planar)>,
}

impl ContactWatch {
    pub(super) fn tick(&mut self, rules: &Rules, moment: &Moment<'_>, track: Track) -> Vec<Breach> {
        let before = self.before.replace((moment.at, moment.column.velocity));
        let Some((person, contact)) =
            moment.persons.iter().find_map(|person| Some((person, person.contact?)))
        else {
            self.astray_since = None;
            return Vec::new();
        };
        let (velocity, centre) = (moment.column.velocity, moment.column.position);
        let mut breaches = Vec::new();
        let fastest_mps = if contact.kind == ContactKind::Brush { BRUSH_MPS } else { COURSE_MPS };
        let room_mps = if track == Track::True { OVERSHOOT_MPS } else { ROUNDING };
        if velocity.norm() > fastest_mps + room_mps {
            breaches.push(Breach::Contact { what: "speed, m/s", found: velocity.norm(), limit: fastest_mps });
        }
        if let (Track::Commanded, true, Some((at, earlier))) = (track, moment.follows_setpoints, before) {
            let secs = (moment.at - at).secs();
            let gentle = if contact.kind == ContactKind::Transport { RIDE_MPS2 } else { CONTACT_MPS2 };
            for (now, then) in [(velocity.x, earlier.x), (velocity.y, earlier.y)] {
                let found = (now.abs() - then.abs()) / secs;
                if secs > 0.0 && now * then >= 0.0 && found > gentle * (1.0 + TOLERANCE) {
                    breaches.push(Breach::Contact { what: "acceleration, m/s2", found, limit: gentle });
                }
            }
        }
        let off = off(rules, &contact, centre, person.head);
        let goes_on = velocity.norm() > MOVING_MPS && !(off.leaves_allowed && velocity.dot(off.away) >= 0.0);
        self.astray_since = if off.is_off && goes_on { self.astray_since.or(Some(moment.at)) } else { None };
        let fastest = rules.limits.x.braking_mps2.min(rules.limits.y.braking_mps2);
        let in_secs =
            POSE_AGE_SECS + rules.reaction.secs() + (fastest_mps + OVERSHOOT_MPS) / fastest + RAMP_SECS;
        if self.astray_since.is_some_and(|since| moment.at - since > Span::from_secs(in_secs)) {
            breaches.push(Breach::Contact { what: off.what, found: off.found_m, limit: off.limit_m });
        }
        breaches
    }
}

/// Where the head is in terms of what it may be.
struct Off {
    is_off: bool,
    /// Going away from the head mends it.
    leaves_allowed: bool,
    away: Planar,
    what: &'static str,
    found_m: f64,
    limit_m: f64,
}

fn off(
    rules: &Rules,
    contact: &ContactNow,
    centre: covr_engine::frames::Floor,
    head: covr_engine::frames::Floor,
) -> Off {
    if contact.kind == ContactKind::Transport {
        let found_m = (centre + contact.offset).distance_m(head);
        let (what, limit_m) = ("from the seat, m", SEAT_M);
        return Off {
            is_off: found_m > limit_m,
            leaves_allowed: false,
            away: Planar::ZERO,
            what,
            found_m,
            limit_m,
        };
    }
    let others = rules.footprint.iter().enumerate().filter(|(i, _)| Some(*i) != contact.rectangle);
    let others: Vec<_> = others.map(|(_, rectangle)| *rectangle).collect();
    let gap = to_point(&others, centre, head);
    let (what, found_m, limit_m) = ("from the column, m", gap.distance_m, BODY_M);
    Off { is_off: found_m < limit_m, leaves_allowed: true, away: gap.away, what, found_m, limit_m }
}

/// Lead and transport, m/s.
const COURSE_MPS: f64 = 0.6;
/// Brush, m/s.
const BRUSH_MPS: f64 = 0.3;
/// Lead and brush, m/s2.
const CONTACT_MPS2: f64 = 0.5;
/// Transport, m/s2.
const RIDE_MPS2: f64 = 0.4;
/// From the head to everything but the prop in contact, m.
const BODY_M: f64 = 0.35;
/// From the seat to the rider's head, m.
const SEAT_M: f64 = 0.6;
/// A pose in contact is not older, s.
const POSE_AGE_SECS: f64 = 0.2;
/// The ramps of a jerk-limited brake, s.
const RAMP_SECS: f64 = 0.05;
/// A healthy machine overshoots its command by less, m/s.
const OVERSHOOT_MPS: f64 = 0.03;
/// Room for rounding.
const ROUNDING: f64 = 1e-9;
const TOLERANCE: f64 = 1e-3;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checker::{Checker, Motion, PersonNow, Rectangle};
    use covr_engine::frames::Floor;
    use covr_engine::machine::{Limits, Travel};
    use covr_engine::observation::PersonId;

    fn rules() -> Rules {
        let travel = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) };
        let carriage = Rectangle { offset: Planar::ZERO, size_m: Planar::new(0.2, 0.2) };
        let chair = Rectangle { offset: Planar::new(-0.4, 0.0), size_m: Planar::new(0.4, 0.4) };
        Rules::of(Limits::PAPER, travel, vec![carriage, chair], Vec::new())
    }

    /// Ticks of 4 ms with the column moving uniformly along x from 2 m on, the head so far from it along x.
    fn contacts(kind: ContactKind, mps: f64, head_off_m: f64, secs: f64) -> u64 {
        let mut checker = Checker::new(rules(), Track::True);
        for i in 0..(secs / 0.004) as i64 {
            let x = 2.0 + mps * i as f64 * 0.004;
            let contact = ContactNow { kind, rectangle: Some(1), offset: Planar::new(-0.4, 0.0) };
            let persons = [PersonNow {
                id: PersonId(1),
                head: Floor::new(x + head_off_m, 2.0),
                height_m: 1.6,
                to_enabled_object_m: None,
                contact: Some(contact),
            }];
            checker.check(&Moment {
                at: Time::ZERO + Span::from_millis(4 * i),
                column: Motion { position: Floor::new(x, 2.0), velocity: Planar::new(mps, 0.0) },
                follows_setpoints: true,
                homed: true,
                latched: false,
                persons: &persons,
            });
        }
        assert_eq!(checker.verdict().separation, 0, "the separation rule stands back");
        checker.verdict().contact
    }

    #[test]
    fn a_rider_over_the_seat_is_carried_and_one_who_is_not_has_to_be_stopped_for() {
        assert_eq!(contacts(ContactKind::Transport, 0.4, -0.5, 1.5), 0);
        assert!(contacts(ContactKind::Transport, 0.4, -1.2, 1.5) > 0);
        assert_eq!(contacts(ContactKind::Transport, 0.4, -1.2, 0.4), 0, "it has time to stop");
        assert!(contacts(ContactKind::Transport, 0.7, -0.5, 0.1) > 0);
    }

    #[test]
    fn who_is_led_may_be_left_behind_and_not_run_into() {
        assert_eq!(contacts(ContactKind::Lead, 0.5, -0.3, 1.5), 0);
        assert_eq!(contacts(ContactKind::Lead, 0.5, 0.6, 1.5), 0);
        assert!(contacts(ContactKind::Lead, 0.5, 0.3, 1.5) > 0);
        assert!(contacts(ContactKind::Brush, 0.4, 0.9, 0.1) > 0);
    }
}
