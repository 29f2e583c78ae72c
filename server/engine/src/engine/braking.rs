//! What a stop of a moving column came to, as measured: how far and how long, beside what was certified. The brake test of a real
//! machine is made of these.

use crate::event::EventKind;
use crate::frames::{Floor, Planar};
use crate::machine::{Limits, MachineReport};
use crate::safety::path::{BrakePath, State};
use crate::time::{Span, Time};

/// A stop under way.
#[derive(Debug, Clone, Copy)]
pub(super) struct Braking {
    began: Time,
    from: Floor,
    velocity: Planar,
    /// The way along x and y that separation allowed for.
    allowed: Planar,
    axes: [AxisBraking; 2],
}

/// When an axis passed 90 and 10 percent of its speed.
#[derive(Debug, Clone, Copy, Default)]
struct AxisBraking {
    nine_tenths_at: Option<Time>,
    one_tenth_at: Option<Time>,
}

impl Braking {
    /// A stop that begins now; none for a column that hardly moves.
    pub fn begin(now: Time, report: &MachineReport, limits: &Limits, reaction: Span) -> Option<Self> {
        let State { x, y } = State::moving(report.position, report.velocity);
        let (least, most) = BrakePath::worst(&State { x, y }, limits, reaction.secs()).extent();
        (report.velocity.norm() > WORTH_MEASURING_MPS).then_some(Self {
            began: now,
            from: report.position,
            velocity: report.velocity,
            allowed: most - least,
            axes: [AxisBraking::default(); 2],
        })
    }

    /// Look at a report; what it came to, once at rest.
    pub fn watch(&mut self, report: &MachineReport, rests: bool) -> Option<EventKind> {
        let at = report.answered_at;
        let speeds = [(self.velocity.x, report.velocity.x), (self.velocity.y, report.velocity.y)];
        for (axis, (before, now)) in self.axes.iter_mut().zip(speeds) {
            let share = now / before;
            if share <= 0.9 {
                axis.nine_tenths_at.get_or_insert(at);
            }
            if share <= 0.1 {
                axis.one_tenth_at.get_or_insert(at);
            }
        }
        if !rests || at <= self.began {
            return None;
        }
        let [x, y] = self.axes;
        Some(EventKind::CameToRest {
            velocity: self.velocity,
            secs: (at - self.began).secs(),
            distance: report.position - self.from,
            allowed: self.allowed,
            braking_mps2: [x.braking_mps2(self.velocity.x), y.braking_mps2(self.velocity.y)],
        })
    }
}

impl AxisBraking {
    /// From nine tenths to one tenth of the speed, m/s2; none for an axis that hardly moved.
    fn braking_mps2(&self, speed_mps: f64) -> Option<f64> {
        let secs = (self.one_tenth_at? - self.nine_tenths_at?).secs();
        (speed_mps.abs() > WORTH_MEASURING_MPS && secs > 0.0).then(|| 0.8 * speed_mps.abs() / secs)
    }
}

/// A slower column says nothing of its brake, m/s.
const WORTH_MEASURING_MPS: f64 = 0.1;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::{Drive, Homing};
    use proptest::prelude::*;

    proptest! {
        /// What a machine that brakes evenly after a delay is found to do.
        #[test]
        fn an_even_brake_is_found_with_its_way(
            v in prop_oneof![-1.5..-0.2f64, 0.2..1.5f64],
            braking_mps2 in 0.5..5.0f64,
            delay_secs in 0.0..0.05f64,
        ) {
            let report = |at: Time, x: f64, vx: f64| MachineReport {
                answered_at: at,
                position: Floor::new(x, 1.0),
                velocity: Planar::new(vx, 0.0),
                current_amps: [1.0; 2],
                drive: Drive::On,
                homing: Homing::Homed,
                home_repeatability_m: None,
                trouble: None,
            };
            let begun = Braking::begin(Time::ZERO, &report(Time::ZERO, 2.0, v), &Limits::PAPER, Span::from_millis(50));
            let mut braking = begun.unwrap();
            let period = Span::from_millis(4);
            let (mut at, mut x, mut vx) = (Time::ZERO, 2.0, v);
            let found = loop {
                at += period;
                if at.micros() as f64 > delay_secs * 1e6 {
                    vx -= (braking_mps2 * period.secs()).min(vx.abs()) * vx.signum();
                }
                x += vx * period.secs();
                if let Some(found) = braking.watch(&report(at, x, vx), vx.abs() < 0.01) {
                    break found;
                }
            };
            let EventKind::CameToRest { distance, braking_mps2: [Some(measured), None], .. } = found else {
                return Err(TestCaseError::fail(format!("{found:?}")));
            };
            // To a period's time at either end.
            let exact_secs = 0.8 * v.abs() / braking_mps2;
            prop_assert!((0.8 * v.abs() / measured - exact_secs).abs() <= 2.1 * period.secs(), "{} for {}", measured, braking_mps2);
            let way = v.abs() * delay_secs + v * v / (2.0 * braking_mps2);
            prop_assert!((distance.norm() - way).abs() < 0.02, "{} m for {} m", distance.norm(), way);
        }
    }

    #[test]
    fn a_column_that_hardly_moves_is_not_measured() {
        let report = MachineReport {
            answered_at: Time::ZERO,
            position: Floor::new(1.0, 1.0),
            velocity: Planar::new(0.05, 0.05),
            current_amps: [0.0; 2],
            drive: Drive::On,
            homing: Homing::Homed,
            home_repeatability_m: None,
            trouble: None,
        };
        assert!(Braking::begin(Time::ZERO, &report, &Limits::PAPER, Span::from_millis(50)).is_none());
    }
}
