//! One axis of the motor controller, as in a RoboClaw: a velocity loop on encoder counts at 1 kHz behind a ramp, and the
//! position loop that brakes and holds.
//!
//! It knows encoder counts since power-on, never the room, and never the true state.

use covr_engine::machine::AxisLimits;

use super::parameters::{AxisParameters, MachineParameters};
use crate::settle::Settler;

/// One axis of the controller.
#[derive(Debug, Clone)]
pub(super) struct AxisController {
    motion: Motion,
    ramp: Ramp,
    /// The integral of the velocity loop, V.
    integral_volts: f64,
    settler: Settler,
    window: [i64; WINDOW_TICKS],
    /// What was asked in each tick of the window.
    asked_mps: [f64; WINDOW_TICKS],
    oldest: usize,
    measured_m: f64,
    measured_mps: f64,
    gains: Gains,
    limits: AxisLimits,
}

/// What the axis is doing.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Motion {
    /// Bridge open.
    Released,
    /// Follow a course of speeds; `ticks_left` until the dead-man brakes.
    Speed { course: SpeedCourse, ticks_left: u32 },
    /// Brake to rest along a reference of its own.
    Brake { reference_m: f64 },
    /// Hold a place.
    Hold { at_m: f64 },
}

/// A speed, how it goes on from there, and how steeply the axis may change its own to get there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SpeedCourse {
    pub(super) target_mps: f64,
    pub(super) slope_mps2: f64,
    pub(super) most_mps2: f64,
}

/// The speed that the velocity loop follows, and how it changes.
#[derive(Debug, Clone, Copy, Default)]
struct Ramp {
    speed_mps: f64,
    acceleration_mps2: f64,
}

/// Gains of one axis, from its parameters: what tuning a real controller finds.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gains {
    volts_per_mps: f64,
    proportional: f64,
    integral: f64,
    supply_volts: f64,
    position_per_s: f64,
    /// Voltage that an acceleration of 1 m/s2 takes.
    volts_per_mps2: f64,
    metres_per_count: f64,
}

impl Gains {
    pub(super) fn new(axis: &AxisParameters, machine: &MachineParameters) -> Self {
        let k = axis.force_per_amp();
        let inertia = axis.motor.resistance_ohm * axis.effective_mass_kg() / k;
        let proportional = (machine.tuning.velocity_bandwidth_rad_per_s * inertia - k).max(0.0);
        Self {
            volts_per_mps: k,
            proportional,
            integral: proportional * machine.tuning.integral_rate_per_s,
            supply_volts: machine.supply_volts,
            position_per_s: machine.tuning.position_gain_per_s,
            volts_per_mps2: inertia,
            metres_per_count: axis.metres_per_count(),
        }
    }
}

impl AxisController {
    pub(super) fn new(gains: Gains, limits: AxisLimits) -> Self {
        Self {
            motion: Motion::Released,
            ramp: Ramp::default(),
            integral_volts: 0.0,
            settler: Settler::default(),
            window: [0; WINDOW_TICKS],
            asked_mps: [0.0; WINDOW_TICKS],
            oldest: 0,
            measured_m: 0.0,
            measured_mps: 0.0,
            gains,
            limits,
        }
    }

    pub(super) fn release(&mut self) {
        self.motion = Motion::Released;
        self.integral_volts = 0.0;
    }

    /// Go at a course of speeds; brake when nothing newer came for `ticks`.
    pub(super) fn go(&mut self, course: SpeedCourse, ticks: u32) {
        self.power_up();
        self.motion = Motion::Speed { course, ticks_left: ticks };
    }

    /// Brake to rest and hold there. Does nothing to an axis that brakes or holds already.
    pub(super) fn brake(&mut self) {
        self.power_up();
        if let Motion::Speed { .. } | Motion::Released = self.motion {
            self.motion = Motion::Brake { reference_m: self.measured_m };
        }
    }

    /// Hold a place that is a few millimetres away at most.
    pub(super) fn hold(&mut self, at_m: f64) {
        self.power_up();
        self.ramp = Ramp::default();
        self.motion = Motion::Hold { at_m };
    }

    /// One millisecond: from counts to the voltage on the motor, none with the bridge open.
    pub(super) fn tick(&mut self, counts: i64) -> Option<f64> {
        let window_secs = WINDOW_TICKS as f64 * TICK_SECS;
        self.measured_mps =
            (counts - self.window[self.oldest]) as f64 * self.gains.metres_per_count / window_secs;
        self.window[self.oldest] = counts;
        let slot = self.oldest;
        self.oldest = (self.oldest + 1) % WINDOW_TICKS;
        self.measured_m = counts as f64 * self.gains.metres_per_count;

        let asked_mps = match self.motion {
            Motion::Released => return None,
            Motion::Speed { ticks_left: 0, .. } => self.braking(self.measured_m),
            Motion::Speed { course, ticks_left } => {
                self.motion = Motion::Speed { course: course.after_a_tick(), ticks_left: ticks_left - 1 };
                self.ramp.along(&course, &self.limits)
            }
            Motion::Brake { reference_m } => self.braking(reference_m),
            Motion::Hold { at_m } => {
                let error_m = at_m - self.measured_m;
                if self.settler.is_settled(0.0, self.measured_mps, error_m) {
                    0.0
                } else {
                    (self.gains.position_per_s * error_m).clamp(-HOLD_MOST_MPS, HOLD_MOST_MPS)
                }
            }
        };
        Some(self.velocity_loop(asked_mps, slot))
    }

    /// Measured place since power-on, m.
    pub(super) const fn measured_m(&self) -> f64 {
        self.measured_m
    }

    /// Measured speed over the last window, m/s.
    pub(super) const fn measured_mps(&self) -> f64 {
        self.measured_mps
    }

    /// It stands still and is told to.
    pub(super) fn is_at_rest(&self) -> bool {
        matches!(self.motion, Motion::Hold { .. }) && self.measured_mps == 0.0 && self.settler.was_settled()
    }

    fn power_up(&mut self) {
        if self.motion == Motion::Released {
            self.ramp = Ramp { speed_mps: self.measured_mps, acceleration_mps2: 0.0 };
            self.asked_mps = [self.measured_mps; WINDOW_TICKS];
            self.integral_volts = 0.0;
        }
    }

    /// The next speed of a jerk-limited brake, and rest at its end.
    fn braking(&mut self, reference_m: f64) -> f64 {
        let before = self.ramp.speed_mps;
        let speed = self.ramp.brake(&self.limits);
        let reference_m = reference_m + 0.5 * (before + speed) * TICK_SECS;
        self.motion =
            if speed == 0.0 { Motion::Hold { at_m: reference_m } } else { Motion::Brake { reference_m } };
        let correction = self.gains.position_per_s * (reference_m - self.measured_m);
        speed + correction.clamp(-BRAKE_CORRECTION_MPS, BRAKE_CORRECTION_MPS)
    }

    /// Proportional and integral, with the back-EMF of the asked speed and the inertia of its ramp fed forward.
    ///
    /// The measured speed is a mean over the window, so it is held against the mean of what was asked in that window;
    /// else the integral would lean on the window's delay at every acceleration.
    fn velocity_loop(&mut self, asked_mps: f64, slot: usize) -> f64 {
        self.asked_mps[slot] = asked_mps;
        let mean_asked_mps = self.asked_mps.iter().sum::<f64>() / WINDOW_TICKS as f64;
        let error_mps = mean_asked_mps - self.measured_mps;
        if asked_mps == 0.0 && self.measured_mps == 0.0 {
            // At rest friction holds: let the current fade instead of leaning on it.
            self.integral_volts *= 1.0 - TICK_SECS / REST_FADE_SECS;
        }
        let wanted = self.gains.volts_per_mps * asked_mps
            + self.gains.volts_per_mps2 * self.ramp.acceleration_mps2
            + self.gains.proportional * error_mps
            + self.integral_volts;
        let volts = wanted.clamp(-self.gains.supply_volts, self.gains.supply_volts);
        // No winding up against the supply.
        if wanted == volts || error_mps * wanted < 0.0 {
            self.integral_volts = (self.integral_volts + self.gains.integral * error_mps * TICK_SECS)
                .clamp(-self.gains.supply_volts, self.gains.supply_volts);
        }
        volts
    }
}

impl SpeedCourse {
    /// The same course a tick later: a course that slows down ends at rest, not beyond.
    fn after_a_tick(self) -> Self {
        let next = self.target_mps + self.slope_mps2 * TICK_SECS;
        if next * self.target_mps < 0.0 {
            Self { target_mps: 0.0, slope_mps2: 0.0, ..self }
        } else {
            Self { target_mps: next, ..self }
        }
    }
}

impl Ramp {
    /// Onto the course within a few ticks, and then along it, no steeper than course and axis allow.
    fn along(&mut self, course: &SpeedCourse, limits: &AxisLimits) -> f64 {
        let off_mps = course.target_mps - self.speed_mps;
        let wanted = course.slope_mps2 + off_mps / BLEND_SECS;
        let is_slowing = wanted * self.speed_mps < 0.0;
        let limit_mps2 = if is_slowing { limits.braking_mps2 } else { limits.acceleration_mps2 };
        let most = course.most_mps2.min(CORRECTION_MARGIN * limit_mps2);
        self.acceleration_mps2 = wanted.clamp(-most, most);
        self.speed_mps = if course.slope_mps2 == 0.0 && off_mps.abs() < ON_COURSE_MPS {
            course.target_mps
        } else {
            self.speed_mps + self.acceleration_mps2 * TICK_SECS
        };
        self.speed_mps
    }

    fn brake(&mut self, limits: &AxisLimits) -> f64 {
        let speed = self.speed_mps;
        // What can still fade to nothing before the speed does.
        let most = limits.braking_mps2.min((2.0 * limits.jerk_mps3 * speed.abs()).sqrt());
        let step = limits.jerk_mps3 * TICK_SECS;
        let wanted = -speed.signum() * most;
        self.acceleration_mps2 += (wanted - self.acceleration_mps2).clamp(-step, step);
        let next = speed + self.acceleration_mps2 * TICK_SECS;
        if next * speed <= 0.0 || next.abs() < REST_MPS {
            *self = Self::default();
        } else {
            self.speed_mps = next;
        }
        self.speed_mps
    }
}

/// The controller's period.
pub(super) const TICK_MICROS: i64 = 1_000;
pub(super) const TICK_SECS: f64 = TICK_MICROS as f64 * 1e-6;
/// Speed is measured over this many ticks: one count in it is 2.7 mm/s.
const WINDOW_TICKS: usize = 8;
/// Time in which an axis gets onto a new course; short of it, corrections would carry the counts' graininess.
const BLEND_SECS: f64 = 0.006;
/// Nearer than this to a constant speed is on it.
const ON_COURSE_MPS: f64 = 1e-5;
/// A ramp may be this much steeper than the axis limits, for corrections on top of a reference at its limits.
const CORRECTION_MARGIN: f64 = 1.2;
/// Below this a brake has come to rest.
const REST_MPS: f64 = 1e-3;
/// How fast a displaced axis returns to the place that it holds.
const HOLD_MOST_MPS: f64 = 0.1;
/// How much a brake may deviate from its ramp to stay on its reference.
const BRAKE_CORRECTION_MPS: f64 = 0.05;
/// Time in which the current at rest fades.
const REST_FADE_SECS: f64 = 0.2;

#[cfg(test)]
mod tests {
    use super::*;
    use covr_engine::frames::Floor;
    use covr_engine::machine::Travel;

    fn axis() -> AxisController {
        let travel = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) };
        let machine = MachineParameters::paper(travel);
        AxisController::new(Gains::new(&machine.x, &machine), machine.limits.x)
    }

    fn course(target_mps: f64, slope_mps2: f64) -> SpeedCourse {
        SpeedCourse { target_mps, slope_mps2, most_mps2: f64::INFINITY }
    }

    /// Speeds of the ramp, tick by tick, as `follow` makes them.
    fn speeds(ticks: usize, mut follow: impl FnMut() -> f64) -> Vec<f64> {
        (0..ticks).map(|_| follow()).collect()
    }

    #[test]
    fn a_ramp_speeds_up_within_the_limit_and_its_margin_and_arrives_exactly() {
        let mut ramp = Ramp::default();
        let speeds = speeds(1_000, || ramp.along(&course(0.5, 0.0), &AxisLimits::PAPER));
        let steepest = speeds.windows(2).map(|w| (w[1] - w[0]) / TICK_SECS).fold(0.0, f64::max);
        assert!(steepest <= 1.25 * CORRECTION_MARGIN + 1e-9 && steepest > 1.4, "{steepest}");
        assert_eq!(ramp.speed_mps, 0.5);
    }

    #[test]
    fn a_course_that_slows_down_ends_at_rest() {
        let mut at = course(0.01, -2.5);
        for _ in 0..10 {
            at = at.after_a_tick();
        }
        assert_eq!((at.target_mps, at.slope_mps2), (0.0, 0.0));
    }

    #[test]
    fn a_brake_keeps_its_deceleration_and_jerk_and_never_turns_round() {
        for start in [0.02, 0.3, 1.1, -1.1] {
            let mut ramp = Ramp { speed_mps: start, acceleration_mps2: 0.0 };
            let mut accelerations = vec![0.0];
            while ramp.speed_mps != 0.0 {
                ramp.brake(&AxisLimits::PAPER);
                assert!(ramp.speed_mps * start >= 0.0);
                accelerations.push(ramp.acceleration_mps2);
                assert!(accelerations.len() < 1_000, "it takes for ever");
            }
            for pair in accelerations.windows(2) {
                assert!(pair[1].abs() <= 2.5 + 1e-9);
                // The last step to rest drops what little deceleration is left.
                let is_last = pair[1] == 0.0;
                assert!(
                    is_last || (pair[1] - pair[0]).abs() <= AxisLimits::PAPER.jerk_mps3 * TICK_SECS + 1e-9,
                    "{pair:?}"
                );
            }
        }
    }

    #[test]
    fn the_measured_speed_is_the_mean_over_eight_ticks() {
        let mut axis = axis();
        for tick in 0..20 {
            axis.tick(5 * tick);
        }
        let expected = 5.0 * AxisParameters::PAPER_X.metres_per_count() / TICK_SECS;
        assert!((axis.measured_mps() - expected).abs() < 1e-12);
    }

    #[test]
    fn a_speed_lasts_its_ticks_and_not_one_more() {
        let mut axis = axis();
        axis.go(course(0.3, 0.0), 10);
        for _ in 0..10 {
            axis.tick(0);
            assert!(matches!(axis.motion, Motion::Speed { .. }));
        }
        axis.tick(0);
        assert!(matches!(axis.motion, Motion::Brake { .. }));
    }

    #[test]
    fn a_released_axis_puts_nothing_on_the_motor() {
        let mut axis = axis();
        axis.go(course(0.3, 0.0), 10);
        assert!(axis.tick(0).is_some());
        axis.release();
        assert_eq!(axis.tick(0), None);
    }

    #[test]
    fn an_axis_that_cannot_move_gets_the_whole_supply_and_winds_nothing_up_against_it() {
        let mut axis = axis();
        let mut wound_volts = None;
        for _ in 0..5_000 {
            axis.go(course(1.1, 0.0), 10);
            let volts = axis.tick(0).unwrap();
            assert!(volts.abs() <= 24.0);
            if volts == 24.0 {
                let wound = *wound_volts.get_or_insert(axis.integral_volts);
                assert_eq!(axis.integral_volts, wound);
            }
        }
        assert!(wound_volts.is_some());
    }
}
