//! The host's half of the PIV scheme: a proportional position loop that turns setpoints into speeds for the
//! controller, with the setpoint's velocity and acceleration fed forward.
//!
//! It knows only what the controller last reported.

use covr_engine::machine::MachineReport;
use covr_engine::safety::vetted::Setpoint;
use covr_engine::time::Time;

use super::axis::{SpeedCourse, TICK_MICROS};
use super::controller::Packet;
use super::parameters::MachineParameters;
use crate::deviation::{Deviation, deviations};
use crate::settle::Settler;

/// The position loops of both axes.
#[derive(Debug, Clone)]
pub(super) struct Host {
    position_gain_per_s: f64,
    most_mps: [f64; 2],
    settlers: [Settler; 2],
}

impl Host {
    pub(super) fn new(machine: &MachineParameters) -> Self {
        Self {
            position_gain_per_s: machine.tuning.position_gain_per_s,
            most_mps: [machine.limits.x.speed_mps, machine.limits.y.speed_mps].map(|most| OVERSPEED * most),
            settlers: [Settler::default(); 2],
        }
    }

    /// Whatever was tracked is over.
    pub(super) fn forget(&mut self) {
        self.settlers = [Settler::default(); 2];
    }

    /// Speeds from `now` on that follow a setpoint vetted at `vetted_at`.
    pub(super) fn follow(
        &mut self,
        now: Time,
        vetted_at: Time,
        setpoint: &Setpoint,
        report: &MachineReport,
    ) -> Packet {
        let deviations = deviations(now, vetted_at, setpoint, report);
        let courses = [0, 1].map(|i| {
            let Deviation { velocity_mps, acceleration_mps2, measured_mps, error_m, since_vetted_secs } =
                deviations[i];
            if self.settlers[i].is_settled(velocity_mps, measured_mps, error_m) {
                return SpeedCourse { target_mps: 0.0, slope_mps2: 0.0, most_mps2: f64::INFINITY };
            }
            let correction = (self.position_gain_per_s * error_m).clamp(-CORRECTION_MPS, CORRECTION_MPS);
            let asked = velocity_mps + acceleration_mps2 * since_vetted_secs + correction;
            SpeedCourse {
                target_mps: asked.clamp(-self.most_mps[i], self.most_mps[i]),
                slope_mps2: acceleration_mps2,
                most_mps2: f64::INFINITY,
            }
        });
        let ticks = (setpoint.valid_for.micros() / TICK_MICROS).clamp(0, i64::from(u32::MAX));
        Packet::Speeds { courses, ticks: ticks as u32 }
    }
}

/// Corrections at top speed may exceed it by this factor and no more.
const OVERSPEED: f64 = 1.02;
/// The most that the position loop adds to the speed fed forward, m/s.
const CORRECTION_MPS: f64 = 0.25;

#[cfg(test)]
mod tests {
    use super::*;
    use covr_engine::frames::{Floor, Planar};
    use covr_engine::machine::{Drive, Homing, Travel};
    use covr_engine::time::Span;

    fn host() -> Host {
        let travel = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) };
        Host::new(&MachineParameters::paper(travel))
    }

    fn report(x: f64, vx: f64) -> MachineReport {
        MachineReport {
            answered_at: Time::ZERO,
            position: Floor::new(x, 1.0),
            velocity: Planar::new(vx, 0.0),
            current_amps: [0.0; 2],
            drive: Drive::On,
            homing: Homing::Homed,
            home_repeatability_m: None,
            trouble: None,
        }
    }

    fn setpoint(x: f64, vx: f64, ax: f64) -> Setpoint {
        Setpoint {
            position: Floor::new(x, 1.0),
            velocity: Planar::new(vx, 0.0),
            acceleration: Planar::new(ax, 0.0),
            valid_for: Span::from_millis(40),
        }
    }

    fn courses(packet: Packet) -> [SpeedCourse; 2] {
        match packet {
            Packet::Speeds { courses, ticks } => {
                assert_eq!(ticks, 40);
                courses
            }
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn on_the_reference_speed_and_slope_are_fed_forward_alone() {
        let packet = host().follow(Time::ZERO, Time::ZERO, &setpoint(1.0, 0.5, 1.2), &report(1.0, 0.5));
        let [x, y] = courses(packet);
        assert!((x.target_mps - 0.5).abs() < 1e-12 && (x.slope_mps2 - 1.2).abs() < 1e-12);
        assert_eq!((y.target_mps, y.slope_mps2), (0.0, 0.0));
    }

    #[test]
    fn a_place_behind_the_reference_adds_speed_in_proportion_up_to_a_cap() {
        let target = |x: f64| {
            let packet = host().follow(Time::ZERO, Time::ZERO, &setpoint(1.0, 0.5, 0.0), &report(x, 0.5));
            courses(packet)[0].target_mps
        };
        assert!((target(0.99) - 0.6).abs() < 1e-9);
        assert!((target(0.5) - 0.75).abs() < 1e-9);
    }

    #[test]
    fn an_old_report_and_an_old_setpoint_are_carried_forward_to_now() {
        let now = Time::from_micros(10_000);
        let packet = host().follow(now, Time::ZERO, &setpoint(1.0, 0.5, 0.0), &report(1.0, 0.5));
        assert!((courses(packet)[0].target_mps - 0.5).abs() < 1e-12);
    }
}
