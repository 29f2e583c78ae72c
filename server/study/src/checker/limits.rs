//! Travel, and the limits of speed, acceleration and jerk on the commanded motion, by differences between ticks.

use covr_engine::frames::Planar;
use covr_engine::machine::{AxisLimits, Limits};
use covr_engine::time::Time;

use super::{Breach, Moment, Motion, Rules, TOLERANCE_M};

/// A rail.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// The long rail.
    X,
    /// The cross rail.
    Y,
}

/// What a limit is on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// m/s.
    Speed,
    /// Speeding up, m/s2.
    Acceleration,
    /// Slowing down, m/s2.
    Braking,
    /// m/s3.
    Jerk,
}

/// The commanded motion at the ticks before.
#[derive(Debug, Clone, Default)]
pub(super) struct LimitsWatch {
    before: Option<Before>,
}

#[derive(Debug, Clone, Copy)]
struct Before {
    at: Time,
    column: Motion,
    /// None after a gap: the mean of a long time says nothing of the jerk after it.
    acceleration: Option<Planar>,
    tick_secs: f64,
}

impl Axis {
    pub(super) const BOTH: [Self; 2] = [Self::X, Self::Y];

    fn of(self, vector: Planar) -> f64 {
        match self {
            Self::X => vector.x,
            Self::Y => vector.y,
        }
    }

    fn limits(self, limits: &Limits) -> &AxisLimits {
        match self {
            Self::X => &limits.x,
            Self::Y => &limits.y,
        }
    }
}

/// Where the axis would come to rest, if that is nearer than the margin to the limit that it moves towards.
pub(super) fn travel_breach(rules: &Rules, column: Motion, axis: Axis) -> Option<Breach> {
    let origin = covr_engine::frames::Floor::default();
    let of = |point| axis.of(point - origin);
    let velocity = axis.of(column.velocity);
    let braking = axis.limits(&rules.limits).braking_mps2;
    let rests_at_m = of(column.position) + velocity * velocity.abs() / (2.0 * braking);
    let allowed_m =
        [of(rules.travel.min) + rules.travel_margin_m, of(rules.travel.max) - rules.travel_margin_m];
    let past = (velocity > 0.0 && rests_at_m > allowed_m[1] + TOLERANCE_M)
        || (velocity < 0.0 && rests_at_m < allowed_m[0] - TOLERANCE_M);
    past.then_some(Breach::TravelMargin { axis, rests_at_m, allowed_m })
}

impl LimitsWatch {
    pub(super) fn tick(&mut self, limits: &Limits, moment: &Moment<'_>) -> Vec<Breach> {
        if !moment.follows_setpoints {
            self.before = None;
            return Vec::new();
        }
        let Motion { position, velocity } = moment.column;
        let step = self.before.and_then(|before| {
            let dt = (moment.at - before.at).secs();
            (dt > 0.0).then(|| (before, dt, (velocity - before.column.velocity) * (1.0 / dt)))
        });
        let mut breaches = Vec::new();
        for axis in Axis::BOTH {
            let own = axis.limits(limits);
            let mut demand = |quantity: Quantity, found: f64, limit: f64| {
                if found.abs() > limit * (1.0 + RELATIVE_TOLERANCE) {
                    breaches.push(Breach::Limit { axis, quantity, found, limit });
                }
            };
            // A position that jumps is a speed too.
            let moved = step.map_or(0.0, |(before, dt, _)| axis.of(position - before.column.position) / dt);
            let speed = axis.of(velocity);
            demand(Quantity::Speed, if moved.abs() > speed.abs() { moved } else { speed }, own.speed_mps);
            let Some((before, dt, acceleration)) = step else { continue };
            let (now, earlier) = (axis.of(velocity), axis.of(before.column.velocity));
            let slows = now.abs() < earlier.abs() || now * earlier < 0.0;
            if slows {
                let limit = own.braking_mps2.max(own.acceleration_mps2);
                demand(Quantity::Braking, axis.of(acceleration), limit);
            } else {
                demand(Quantity::Acceleration, axis.of(acceleration), own.acceleration_mps2);
            }
            if let Some(earlier) = before.acceleration {
                demand(Quantity::Jerk, axis.of(acceleration - earlier) / dt, own.jerk_mps3);
            }
        }
        let tick_secs = step.map_or(f64::INFINITY, |(before, dt, _)| dt.min(before.tick_secs));
        let acceleration =
            step.filter(|(_, dt, _)| *dt < GAP * tick_secs).map(|(_, _, acceleration)| acceleration);
        self.before = Some(Before { at: moment.at, column: moment.column, acceleration, tick_secs });
        breaches
    }
}

/// So many times the shortest tick is a gap.
const GAP: f64 = 1.5;
/// Room for rounding when positions and times are differenced.
const RELATIVE_TOLERANCE: f64 = 1e-5;

#[cfg(test)]
mod tests {
    use super::*;
    use covr_engine::frames::Floor;
    use covr_engine::time::Span;

    /// Breaches at 10 ms ticks along x for these (position, velocity) pairs.
    fn run(states: &[(f64, f64)]) -> Vec<(Quantity, f64)> {
        let mut watch = LimitsWatch::default();
        let mut found = Vec::new();
        for (i, &(x, v)) in (0..).zip(states) {
            let moment = Moment {
                at: Time::ZERO + Span::from_millis(10 * i),
                column: Motion { position: Floor::new(x, 0.0), velocity: Planar::new(v, 0.0) },
                follows_setpoints: true,
                homed: true,
                latched: false,
                persons: &[],
            };
            for breach in watch.tick(&Limits::PAPER, &moment) {
                let Breach::Limit { quantity, found: value, .. } = breach else { panic!("{breach:?}") };
                found.push((quantity, value));
            }
        }
        found
    }

    #[test]
    fn speed_is_checked_in_what_is_said_and_in_what_is_covered() {
        assert_eq!(run(&[(0.0, 1.1)]), []);
        assert_eq!(run(&[(0.0, -1.101)]), [(Quantity::Speed, -1.101)]);
        let jump = run(&[(0.0, 0.0), (0.02, 0.0)]);
        assert!(matches!(jump[..], [(Quantity::Speed, found)] if (found - 2.0).abs() < 1e-9), "{jump:?}");
    }

    #[test]
    fn speeding_up_and_slowing_down_have_limits_of_their_own() {
        // 1.25 m/s2 up and 2.5 m/s2 down are at the limits; each is reached in one tick, so jerk is over.
        let of = |states: &[(f64, f64)]| {
            run(states).into_iter().filter(|(q, _)| *q != Quantity::Jerk).map(|(q, _)| q).collect::<Vec<_>>()
        };
        assert_eq!(of(&[(0.0, 0.5), (0.0, 0.5125)]), []);
        assert_eq!(of(&[(0.0, 0.5), (0.0, 0.5127)]), [Quantity::Acceleration]);
        assert_eq!(of(&[(0.0, -0.5), (0.0, -0.475)]), []);
        assert_eq!(of(&[(0.0, -0.5), (0.0, -0.4745)]), [Quantity::Braking]);
    }

    #[test]
    fn jerk_is_the_change_of_acceleration_between_ticks() {
        // Accelerations 0, 0.6, 1.2 m/s2 at 10 ms: 60 m/s3, under the limit of 80. 0, 0.9: 90 m/s3.
        assert_eq!(run(&[(0.0, 0.0), (0.0, 0.0), (0.0, 0.006), (0.0, 0.018)]), []);
        let over = run(&[(0.0, 0.0), (0.0, 0.0), (0.0, 0.009)]);
        assert!(matches!(over[..], [(Quantity::Jerk, found)] if (found - 90.0).abs() < 1e-6), "{over:?}");
    }

    #[test]
    fn without_setpoints_there_is_nothing_to_compare() {
        let mut watch = LimitsWatch::default();
        let moment = |millis: i64, v: f64, follows_setpoints: bool| Moment {
            at: Time::ZERO + Span::from_millis(millis),
            column: Motion { position: Floor::default(), velocity: Planar::new(v, 0.0) },
            follows_setpoints,
            homed: true,
            latched: false,
            persons: &[],
        };
        assert!(watch.tick(&Limits::PAPER, &moment(0, 0.0, true)).is_empty());
        assert!(watch.tick(&Limits::PAPER, &moment(4, 5.0, false)).is_empty());
        assert!(watch.tick(&Limits::PAPER, &moment(8, 1.0, true)).is_empty());
    }
}
