//! The motor controller of the simulated machine: both axes, what they are told, the dead-man and the homing sequence.
//!
//! It brakes both axes to rest by itself when nothing is heard for the serial timeout.

use covr_engine::machine::{Drive, Homing};

use super::axis::{AxisController, Gains, SpeedCourse, TICK_MICROS, TICK_SECS};
use super::parameters::MachineParameters;
use crate::homing::{HomingAxis, HomingPlan, HomingStep, RAMP_MPS2, Seen};

/// Both axes with what they share.
#[derive(Debug, Clone)]
pub(super) struct Controller {
    pub(super) axes: [AxisController; 2],
    drive: Drive,
    homing: Homing,
    sequences: [HomingAxis; 2],
    switches_m: Option<[f64; 2]>,
    home_repeatability_m: Option<[f64; 2]>,
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
            switches_m: None,
            home_repeatability_m: None,
            plans: [span.x, span.y]
                .map(|span_m| HomingPlan::new(machine.homing, span_m + 2.0 * machine.stop_outside_m)),
            timeout_ticks: (machine.serial_timeout.micros() / TICK_MICROS) as u32,
            silent_ticks: 0,
            was_told_to_home: false,
        }
    }

    /// Homed, its switches at these places since power-on, and holding both axes at `at_m`.
    pub(super) fn stand(&mut self, at_m: f64, switches_m: [f64; 2]) {
        self.drive = Drive::On;
        self.homing = Homing::Homed;
        self.axes.iter_mut().for_each(|axis| axis.hold(at_m));
        self.switches_m = Some(switches_m);
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

    /// Where the switches tripped when it was last homed, m since power-on: the reference holds until a new one is found.
    pub(super) const fn switch_places_m(&self) -> Option<[f64; 2]> {
        self.switches_m
    }

    /// Of the last home found, m.
    pub(super) const fn home_repeatability_m(&self) -> Option<[f64; 2]> {
        self.home_repeatability_m
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
            let seen = Seen {
                here_m: axis.measured_m(),
                at_rest: axis.is_at_rest(),
                on_switch: switches[i],
                since_last_secs: TICK_SECS,
            };
            match self.sequences[i].step(&self.plans[i], seen) {
                HomingStep::Move(target_mps) => {
                    axis.go(SpeedCourse { target_mps, slope_mps2: 0.0, most_mps2: RAMP_MPS2 }, u32::MAX);
                }
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
        if are_done == [true; 2]
            && let (Some(x), Some(y)) = (self.sequences[0].switch_m(), self.sequences[1].switch_m())
        {
            self.homing = Homing::Homed;
            self.switches_m = Some([x, y]);
            self.home_repeatability_m = HomingAxis::both_repeatabilities_m(&self.sequences);
        }
    }
}
