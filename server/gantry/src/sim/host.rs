//! The host's half of the PIV scheme: a proportional position loop that turns setpoints into speeds for the
//! controller, with the setpoint's velocity and acceleration fed forward.
//!
//! It knows only what the controller last reported.

use covr_engine::machine::MachineReport;
use covr_engine::safety::vetted::Setpoint;
use covr_engine::time::Time;

use super::controller::{Packet, SpeedCourse, TICK_MICROS};
use super::parameters::MachineParameters;
use super::settle::Settler;

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
        let valid_secs = setpoint.valid_for.secs().max(0.0);
        let since_vetted = (now - vetted_at).secs().clamp(0.0, valid_secs);
        let since_report = (now - report.answered_at).secs().clamp(0.0, valid_secs);
        let axes = [
            (setpoint.position.x, setpoint.velocity.x, setpoint.acceleration.x),
            (setpoint.position.y, setpoint.velocity.y, setpoint.acceleration.y),
        ];
        let measured = [(report.position.x, report.velocity.x), (report.position.y, report.velocity.y)];
        let courses = [0, 1].map(|i| {
            let (position, velocity, acceleration) = axes[i];
            let (measured_m, measured_mps) = measured[i];
            let reference_m = position + (velocity + 0.5 * acceleration * since_vetted) * since_vetted;
            let error_m = reference_m - (measured_m + measured_mps * since_report);
            if self.settlers[i].is_settled(velocity, measured_mps, error_m) {
                return SpeedCourse { target_mps: 0.0, slope_mps2: 0.0, most_mps2: f64::INFINITY };
            }
            let correction = (self.position_gain_per_s * error_m).clamp(-CORRECTION_MPS, CORRECTION_MPS);
            let asked = velocity + acceleration * since_vetted + correction;
            SpeedCourse {
                target_mps: asked.clamp(-self.most_mps[i], self.most_mps[i]),
                slope_mps2: acceleration,
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
