//! The motor controller as the simulated machine has it: per axis a velocity loop on counts at 1 kHz, with a ramp, as
//! in a RoboClaw, and for both axes the dead-man and the homing sequence.
//!
//! It knows encoder counts since power-on, never the room, and never the true state.

use covr_engine::machine::{AxisLimits, Drive, Homing};

use super::homing::{HomingAxis, HomingPlan, HomingStep};
use super::parameters::{AxisParameters, MachineParameters};
use super::settle::Settler;

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
    fn hold(&mut self, at_m: f64) {
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

/// Both axes with what they share.
#[derive(Debug, Clone)]
pub(super) struct Controller {
    pub(super) axes: [AxisController; 2],
    drive: Drive,
    homing: Homing,
    sequences: [HomingAxis; 2],
    plans: [HomingPlan; 2],
    timeout_ticks: u32,
    silent_ticks: u32,
    /// The last command was to home: a repeated one asks for nothing new.
    was_told_to_home: bool,
}

/// A packet from the host.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Packet {
    Release,
    Brake,
    Home,
    /// Courses of both axes, and for how many ticks they are good.
    Speeds {
        courses: [SpeedCourse; 2],
        ticks: u32,
    },
}

impl Controller {
    pub(super) fn new(machine: &MachineParameters) -> Self {
        let span = machine.travel.max - machine.travel.min;
        Self {
            axes: [
                AxisController::new(Gains::new(&machine.x, machine), machine.limits.x),
                AxisController::new(Gains::new(&machine.y, machine), machine.limits.y),
            ],
            drive: Drive::Released,
            homing: Homing::NotHomed,
            sequences: [HomingAxis::default(); 2],
            plans: [HomingPlan::new(machine, span.x), HomingPlan::new(machine, span.y)],
            timeout_ticks: (machine.serial_timeout.micros() / TICK_MICROS) as u32,
            silent_ticks: 0,
            was_told_to_home: false,
        }
    }

    pub(super) fn take(&mut self, packet: Packet) {
        self.silent_ticks = 0;
        let is_home = packet == Packet::Home;
        if self.homing == Homing::Running && !is_home {
            self.homing = Homing::NotHomed;
        }
        match packet {
            Packet::Release => self.release(),
            Packet::Brake => self.brake(),
            Packet::Home if self.was_told_to_home => {}
            Packet::Home => {
                self.drive = Drive::On;
                self.homing = Homing::Running;
                self.sequences = [HomingAxis::default(); 2];
            }
            Packet::Speeds { courses, ticks } => {
                self.drive = Drive::On;
                for (axis, course) in self.axes.iter_mut().zip(courses) {
                    axis.go(course, ticks);
                }
            }
        }
        self.was_told_to_home = is_home;
    }

    /// One millisecond: from counts and homing switches to the voltages on the motors.
    pub(super) fn tick(&mut self, counts: [i64; 2], switches: [bool; 2]) -> [Option<f64>; 2] {
        self.silent_ticks = self.silent_ticks.saturating_add(1);
        if self.silent_ticks == self.timeout_ticks && self.drive == Drive::On {
            if self.homing == Homing::Running {
                self.homing = Homing::NotHomed;
            }
            self.was_told_to_home = false;
            self.brake();
        }
        if self.homing == Homing::Running {
            self.home(switches);
        }
        [self.axes[0].tick(counts[0]), self.axes[1].tick(counts[1])]
    }

    pub(super) const fn drive(&self) -> Drive {
        self.drive
    }

    pub(super) const fn homing(&self) -> Homing {
        self.homing
    }

    /// Where the switches tripped on the measuring approach, m since power-on, once homed.
    pub(super) fn switch_places_m(&self) -> Option<[f64; 2]> {
        Some([self.sequences[0].switch_m()?, self.sequences[1].switch_m()?])
    }

    fn release(&mut self) {
        self.drive = Drive::Released;
        self.axes.iter_mut().for_each(AxisController::release);
    }

    fn brake(&mut self) {
        self.drive = Drive::On;
        self.axes.iter_mut().for_each(AxisController::brake);
    }

    fn home(&mut self, switches: [bool; 2]) {
        let mut are_done = [false; 2];
        for i in 0..2 {
            let axis = &mut self.axes[i];
            match self.sequences[i].step(&self.plans[i], axis, switches[i]) {
                HomingStep::Move(course) => axis.go(course, u32::MAX),
                HomingStep::Brake => axis.brake(),
                HomingStep::Rest { at_m } => axis.hold(at_m),
                HomingStep::Done => are_done[i] = true,
                HomingStep::Failed => {
                    // Something is in the way, or there is no switch: do not lean on it.
                    self.homing = Homing::Failed;
                    self.release();
                    return;
                }
            }
        }
        if are_done == [true; 2] {
            self.homing = Homing::Homed;
        }
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
