//! The RoboClaw machine's part of the configuration.

use std::path::PathBuf;

use covr_engine::frames::Floor;
use covr_engine::time::Span;
use covr_gantry::homing::{HomeBy, HomingParameters};
use covr_gantry::roboclaw::settings::{AxisSettings, Boards, Settings, VelocityPid};

use super::Config;

/// Boards, line and motors.
#[derive(Debug, Clone, PartialEq)]
pub struct RoboClaw {
    /// The boards are emulated ones.
    pub emulated: bool,
    /// The serial port.
    pub port: PathBuf,
    /// Its rate, bits a second.
    pub baud: usize,
    /// The address of the board, or of the long rail's.
    pub address: usize,
    /// The address of the cross rail's board; 0: one board drives both.
    pub second_address: usize,
    /// The long rail.
    pub x: RoboClawAxis,
    /// The cross rail.
    pub y: RoboClawAxis,
    /// Current limit, A.
    pub current_limit_amps: f64,
    /// The same while homing, A.
    pub homing_current_amps: f64,
    /// The boards' own timeout, s.
    pub serial_timeout_secs: f64,
    /// Longest time between two looks, s.
    pub period_secs: f64,
    /// Gain of the position loop, 1/s.
    pub position_gain_per_s: f64,
    /// What homing looks for.
    pub home_by: HomeBy,
    /// How homing moves.
    pub homing: HomingParameters,
}

/// One rail's motor.
#[derive(Debug, Clone, PartialEq)]
pub struct RoboClawAxis {
    /// Encoder counts a metre.
    pub counts_per_metre: f64,
    /// Counts fall where the coordinate rises.
    pub reversed: bool,
    /// Gains of the board's velocity loop, and the speed at full duty, counts a second; a speed of 0 leaves all of them as the board has them.
    pub velocity: [f64; 4],
}

impl Default for RoboClaw {
    /// The paper's drive, as the simulated machine has it; a port by the board's name on USB.
    fn default() -> Self {
        let axis = |counts_per_metre| RoboClawAxis { counts_per_metre, reversed: false, velocity: [0.0; 4] };
        Self {
            emulated: false,
            port: "/dev/roboclaw".into(),
            baud: 460_800,
            address: 0x80,
            second_address: 0,
            x: axis(46_545.0),
            y: axis(47_787.0),
            current_limit_amps: 5.0,
            homing_current_amps: 3.0,
            serial_timeout_secs: 0.2,
            period_secs: 0.01,
            position_gain_per_s: 8.0,
            home_by: HomeBy::Switches,
            homing: HomingParameters {
                creep_mps: 0.1,
                approach_mps: 0.02,
                switch_outside_m: 0.01,
                rest_inside_m: 0.05,
            },
        }
    }
}

impl RoboClaw {
    /// The whole machine, with what the other keys say of it.
    pub fn settings(&self, config: &Config) -> Settings {
        let address = |address: usize| u8::try_from(address).unwrap_or(u8::MAX);
        let boards = match self.second_address {
            0 => Boards::One(address(self.address)),
            second => Boards::Two([address(self.address), address(second)]),
        };
        Settings {
            port: self.port.clone(),
            baud: u32::try_from(self.baud).unwrap_or(u32::MAX),
            boards,
            axes: [self.x.settings(), self.y.settings()],
            limits: config.machine.limits(),
            travel: config.machine.travel(),
            parked: Floor::new(config.machine.parked_x_m, config.machine.parked_y_m),
            current_limit_amps: self.current_limit_amps,
            homing_current_amps: self.homing_current_amps,
            serial_timeout: Span::from_secs(self.serial_timeout_secs),
            period: Span::from_secs(self.period_secs),
            homing: self.homing,
            home_by: self.home_by,
            position_gain_per_s: self.position_gain_per_s,
        }
    }
}

impl RoboClawAxis {
    fn settings(&self) -> AxisSettings {
        let [p, i, d, qpps] = self.velocity;
        let qpps = qpps.round() as u32;
        AxisSettings {
            counts_per_metre: self.counts_per_metre,
            reversed: self.reversed,
            velocity_pid: (qpps > 0).then_some(VelocityPid { p, i, d, qpps }),
        }
    }
}
