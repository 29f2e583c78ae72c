//! The host's half of the loop: from a setpoint and the newest look to a speed for each axis, and the distance after which
//! the board brakes by itself.

use covr_engine::machine::{Limits, MachineReport};
use covr_engine::safety::vetted::Setpoint;
use covr_engine::time::{Span, Time};

use crate::deviation::{Deviation, deviations};
use crate::settle::Settler;

/// What one axis is to do until the next look.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisSpeed {
    /// m/s, room frame.
    pub speed_mps: f64,
    /// Greatest change of speed, m/s2.
    pub acceleration_mps2: f64,
    /// How its course goes on to change the speed, signed, m/s2: for a controller that can be told so.
    pub slope_mps2: f64,
    /// The distance cap, m.
    pub distance_m: f64,
}

/// The position loops of both axes.
#[derive(Debug, Clone)]
pub struct Follower {
    gain_per_s: f64,
    limits: Limits,
    settlers: [Settler; 2],
}

impl Follower {
    pub fn new(gain_per_s: f64, limits: Limits) -> Self {
        Self { gain_per_s, limits, settlers: [Settler::default(); 2] }
    }

    /// Whatever was followed is over.
    pub fn forget(&mut self) {
        self.settlers = [Settler::default(); 2];
    }

    /// Follow a setpoint vetted at `vetted_at`, from `now` until the next look a `period` later.
    pub fn follow(
        &mut self,
        now: Time,
        vetted_at: Time,
        setpoint: &Setpoint,
        report: &MachineReport,
        period: Span,
    ) -> [AxisSpeed; 2] {
        let valid_secs = setpoint.valid_for.secs().max(0.0);
        let deviations = deviations(now, vetted_at, setpoint, report);
        [0, 1].map(|i| {
            let Deviation { velocity_mps, acceleration_mps2, measured_mps, error_m, since_vetted_secs } =
                deviations[i];
            let speed_mps = if self.settlers[i].is_settled(velocity_mps, measured_mps, error_m) {
                0.0
            } else {
                // The speed that is right in the middle of the time that it will be kept.
                let ahead_secs = (since_vetted_secs + 0.5 * period.secs()).min(valid_secs) + LAG_SECS;
                let correction = (self.gain_per_s * error_m).clamp(-CORRECTION_MPS, CORRECTION_MPS);
                let most = OVERSPEED * self.axis(i).speed_mps;
                (velocity_mps + acceleration_mps2 * ahead_secs + correction).clamp(-most, most)
            };
            let slope_mps2 = if speed_mps == 0.0 { 0.0 } else { acceleration_mps2 };
            AxisSpeed { slope_mps2, ..self.axis_speed(i, speed_mps, measured_mps, valid_secs) }
        })
    }

    /// Bring one axis to this place and keep it there, no faster than a correction.
    pub fn keep_at(&mut self, axis: usize, place_m: f64, measured_m: f64, measured_mps: f64) -> AxisSpeed {
        let error_m = place_m - measured_m;
        let speed_mps = if self.settlers[axis].is_settled(0.0, measured_mps, error_m) {
            0.0
        } else {
            (self.gain_per_s * error_m).clamp(-KEEPING_MPS, KEEPING_MPS)
        };
        self.axis_speed(axis, speed_mps, measured_mps, KEEPING_SECS)
    }

    /// A speed of one axis that is good for so long. The ramp to it is that of speeding up or of slowing, whichever it is: friction
    /// helps the one and adds to the other, and a ramp as steep as a brake would take more current than R5 allows.
    fn axis_speed(&self, axis: usize, speed_mps: f64, measured_mps: f64, valid_secs: f64) -> AxisSpeed {
        let limits = self.axis(axis);
        let slows = speed_mps * measured_mps >= 0.0 && speed_mps.abs() < measured_mps.abs();
        let ramp_mps2 = if slows { limits.braking_mps2 } else { STEEPER * limits.acceleration_mps2 };
        let distance_m = speed_mps.abs() * valid_secs;
        AxisSpeed { speed_mps, acceleration_mps2: ramp_mps2, slope_mps2: 0.0, distance_m }
    }

    const fn axis(&self, axis: usize) -> &covr_engine::machine::AxisLimits {
        if axis == 0 { &self.limits.x } else { &self.limits.y }
    }
}

/// How far the board's velocity loop and its ramp are behind what they are told, s: told so much ahead, a speed is right when it is
/// reached. On the emulated boards it takes the greatest error of speed on a course at the limits from 0.037 to 0.027 m/s (460800 baud).
const LAG_SECS: f64 = 0.005;
/// Corrections at top speed may exceed it by this factor and no more.
const OVERSPEED: f64 = 1.02;
/// The most that the position loop adds to the speed fed forward, m/s.
const CORRECTION_MPS: f64 = 0.25;
/// The most with which a place is kept, m/s: the creep speed.
const KEEPING_MPS: f64 = 0.1;
/// How long such a correction is good, s.
pub const KEEPING_SECS: f64 = 0.1;
/// The ramp up is this much steeper than the limit, so that a step of speed is through within the time that it is for. The ramp down is
/// not: at the limit a brake takes 4.2 A of the paper's cross rail, a quarter more of it 5.4 A.
const STEEPER: f64 = 1.25;

#[cfg(test)]
mod tests {
    use super::*;
    use covr_engine::frames::{Floor, Planar};
    use covr_engine::machine::{Drive, Homing};

    const PERIOD: Span = Span::from_millis(8);

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
            valid_for: Span::from_millis(50),
        }
    }

    fn x(setpoint: &Setpoint, report: &MachineReport) -> AxisSpeed {
        let mut follower = Follower::new(10.0, Limits::PAPER);
        follower.follow(Time::ZERO, Time::ZERO, setpoint, report, PERIOD)[0]
    }

    #[test]
    fn the_speed_is_that_of_the_middle_of_its_time_and_the_cap_is_what_it_covers_while_valid() {
        let on_course = x(&setpoint(1.0, 0.5, 1.0), &report(1.0, 0.5));
        let middle = 0.5 + 0.004 + LAG_SECS;
        assert!((on_course.speed_mps - middle).abs() < 1e-9);
        assert!((on_course.distance_m - middle * 0.05).abs() < 1e-9);
    }

    #[test]
    fn a_place_behind_adds_speed_up_to_a_cap_and_never_much_over_the_top() {
        assert!((x(&setpoint(1.0, 0.5, 0.0), &report(0.99, 0.5)).speed_mps - 0.6).abs() < 1e-9);
        assert!((x(&setpoint(1.0, 0.5, 0.0), &report(0.5, 0.5)).speed_mps - 0.75).abs() < 1e-9);
        assert!((x(&setpoint(1.0, 1.1, 0.0), &report(0.5, 1.1)).speed_mps - 1.122).abs() < 1e-9);
    }

    #[test]
    fn at_rest_near_enough_nothing_is_asked() {
        let mut follower = Follower::new(10.0, Limits::PAPER);
        let near = follower.keep_at(0, 1.0003, 1.0, 0.0);
        assert_eq!((near.speed_mps, near.distance_m), (0.0, 0.0));
        let off = follower.keep_at(0, 1.002, 1.0, 0.0);
        assert!(off.speed_mps > 0.0 && off.speed_mps <= KEEPING_MPS);
    }
}
