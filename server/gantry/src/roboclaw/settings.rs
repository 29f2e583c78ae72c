//! What a RoboClaw machine is made of.

use std::path::PathBuf;

use covr_engine::frames::Floor;
use covr_engine::machine::{Limits, Travel};
use covr_engine::time::Span;

use crate::homing::{HomeBy, HomingParameters};
use crate::linked::axes::AxesSettings;

/// A whole machine.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// The serial port: a path by the board's serial number, so that it is the same after unplugging.
    pub port: PathBuf,
    /// Its rate, bits a second. A board on USB takes any.
    pub baud: u32,
    /// Which boards drive what.
    pub boards: Boards,
    /// The long rail and the cross rail.
    pub axes: [AxisSettings; 2],
    /// What each axis may do.
    pub limits: Limits,
    /// Where the column's centre can stand, room frame.
    pub travel: Travel,
    /// Where the column is parked when the power comes on, room frame.
    pub parked: Floor,
    /// Above this the board limits a motor's current, A. Whoever is limited counts as over it (R5).
    pub current_limit_amps: f64,
    /// The same while it homes, A: against a hard stop it pushes with no more.
    pub homing_current_amps: f64,
    /// With no packet for this long the board stops both motors. The board knows steps of 0.1 s.
    pub serial_timeout: Span,
    /// Shortest time from one look at the board to the next.
    pub period: Span,
    /// How homing moves.
    pub homing: HomingParameters,
    /// What homing looks for. Switches: the long rail's on S4, the cross rail's on S5; with two boards each on its board's S4.
    pub home_by: HomeBy,
    /// Gain of the position loop, 1/s.
    pub position_gain_per_s: f64,
}

/// Which boards drive what.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Boards {
    /// One board at this address: the long rail is M1, the cross rail M2.
    One(u8),
    /// Two boards on one line at these addresses: each rail is its board's M1.
    Two([u8; 2]),
}

/// One axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisSettings {
    /// Encoder counts a metre of travel, after quadrature.
    pub counts_per_metre: f64,
    /// Counts fall where the room's coordinate rises.
    pub reversed: bool,
    /// The board's velocity loop; none: what the board has stored.
    pub velocity_pid: Option<VelocityPid>,
}

/// Gains of the board's velocity loop, as the maker's program shows them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VelocityPid {
    /// Proportional.
    pub p: f64,
    /// Integral.
    pub i: f64,
    /// Derivative.
    pub d: f64,
    /// Speed at full duty, counts a second.
    pub qpps: u32,
}

impl Settings {
    /// What the decisions about both axes need of it.
    pub(super) const fn axes(&self) -> AxesSettings {
        AxesSettings {
            limits: self.limits,
            travel: self.travel,
            current_limit_amps: self.current_limit_amps,
            homing: self.homing,
            home_by: self.home_by,
            position_gain_per_s: self.position_gain_per_s,
        }
    }
}
