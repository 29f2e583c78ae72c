//! The ODrive machine's part of the configuration.

use std::path::PathBuf;

use covr_engine::frames::Floor;
use covr_engine::time::Span;
use covr_gantry::homing::HomingParameters;
use covr_gantry::odrive::settings::{AxisSettings, Settings};

use super::Config;

/// Board, line and motors.
#[derive(Debug, Clone, PartialEq)]
pub struct Odrive {
    /// The board is an emulated one.
    pub emulated: bool,
    /// The serial port on USB.
    pub port: PathBuf,
    /// The long rail, on axis0.
    pub x: OdriveAxis,
    /// The cross rail, on axis1.
    pub y: OdriveAxis,
    /// Current limit, A.
    pub current_limit_amps: f64,
    /// The same while homing, A.
    pub homing_current_amps: f64,
    /// The board's own timeout, s.
    pub watchdog_timeout_secs: f64,
    /// Longest time between two looks, s.
    pub period_secs: f64,
    /// Gain of the position loop, 1/s.
    pub position_gain_per_s: f64,
    /// How homing moves.
    pub homing: HomingParameters,
}

/// One rail's motor.
#[derive(Debug, Clone, PartialEq)]
pub struct OdriveAxis {
    /// Turns of the encoder a metre.
    pub turns_per_metre: f64,
    /// Turns fall where the coordinate rises.
    pub reversed: bool,
}

impl Default for Odrive {
    /// Motors on the paper's rails, as the emulated board has them; a port by the board's name on USB.
    fn default() -> Self {
        let axis = |turns_per_metre| OdriveAxis { turns_per_metre, reversed: false };
        Self {
            emulated: false,
            port: "/dev/odrive".into(),
            x: axis(45.454_545),
            y: axis(46.666_667),
            current_limit_amps: 5.0,
            homing_current_amps: 3.0,
            watchdog_timeout_secs: 0.8,
            period_secs: 0.01,
            position_gain_per_s: 8.0,
            homing: HomingParameters {
                creep_mps: 0.1,
                approach_mps: 0.02,
                switch_outside_m: 0.03,
                rest_inside_m: 0.05,
            },
        }
    }
}

impl Odrive {
    /// The whole machine, with what the other keys say of it.
    pub fn settings(&self, config: &Config) -> Settings {
        Settings {
            port: self.port.clone(),
            axes: [self.x.settings(), self.y.settings()],
            limits: config.machine.limits(),
            travel: config.machine.travel(),
            parked: Floor::new(config.machine.parked_x_m, config.machine.parked_y_m),
            current_limit_amps: self.current_limit_amps,
            homing_current_amps: self.homing_current_amps,
            watchdog_timeout: Span::from_secs(self.watchdog_timeout_secs),
            period: Span::from_secs(self.period_secs),
            homing: self.homing,
            position_gain_per_s: self.position_gain_per_s,
        }
    }
}

impl OdriveAxis {
    const fn settings(&self) -> AxisSettings {
        AxisSettings { turns_per_metre: self.turns_per_metre, reversed: self.reversed }
    }
}
