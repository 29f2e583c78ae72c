//! What the engine knows of a machine: its limits, its travel, and what it reports each period.

use crate::frames::{Floor, Planar};
use crate::time::Time;

/// What one axis may do. The same numbers bind the planner, the limiter and the proofs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisLimits {
    /// Greatest speed, m/s.
    pub speed_mps: f64,
    /// Greatest acceleration when speeding up, m/s2.
    pub acceleration_mps2: f64,
    /// Greatest deceleration, m/s2: the a_b of the brake test.
    pub braking_mps2: f64,
    /// Greatest jerk, m/s3.
    pub jerk_mps3: f64,
}

/// Limits of both axes: `x` runs along the long rail.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// The long rail.
    pub x: AxisLimits,
    /// The cross rail.
    pub y: AxisLimits,
}

/// Where the column's centre can stand mechanically: the travel limits, room frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Travel {
    /// The corner of least x and y.
    pub min: Floor,
    /// The corner of greatest x and y.
    pub max: Floor,
}

/// Whether the motors are powered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Drive {
    /// No torque: the column can be pushed.
    Released,
    /// The position is held or followed.
    On,
}

/// How far homing is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Homing {
    /// Positions mean nothing yet.
    NotHomed,
    /// On the way to the switches.
    Running,
    /// Positions are in the room frame.
    Homed,
    /// It did not find a switch.
    Failed,
}

/// What a machine says of itself, read once a period. Positions are in the room frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MachineReport {
    /// When the controller last gave a good answer (R8 watches its age).
    pub answered_at: Time,
    /// Measured position of the column's centre: by the last home found, also while homing anew.
    pub position: Floor,
    /// Measured velocity, m/s.
    pub velocity: Planar,
    /// Motor currents x, y; magnitude, A.
    pub current_amps: [f64; 2],
    /// Whether the motors are powered.
    pub drive: Drive,
    /// How far homing is.
    pub homing: Homing,
    /// Where the second, slow approach of the last homing found each switch or stop, less where its first, faster one did, m; none before it, and for a
    /// machine that does not tell.
    pub home_repeatability_m: Option<[f64; 2]>,
    /// Why it cannot be driven now, though it may answer (R8).
    pub trouble: Option<Trouble>,
}

/// Why a machine cannot be driven, in its own words.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Trouble {
    /// Its port cannot be opened.
    NoPort,
    /// Nothing answers there.
    NoAnswer,
    /// Its controller has a firmware that the driver does not know.
    UnknownFirmware,
    /// Its controller does not keep a setting.
    NotConfigured,
    /// Settings of its controller come into force when its power is switched off and on.
    SwitchOffAndOn,
    /// Its controller has restarted, or its counts jumped: the place is lost.
    Restarted,
    /// The wired emergency stop is active at the controller.
    EmergencyStop,
    /// A bridge of the controller is broken.
    DriverFault,
    /// The controller is too hot.
    TooHot,
    /// A supply of the controller is too high or too low.
    BadSupply,
}

impl AxisLimits {
    /// The paper's machine: over 1.1 m/s on long moves, and 0.5 m/s on average under 0.8 m, from which 1.25 m/s2 follows.
    pub const PAPER: Self =
        Self { speed_mps: 1.1, acceleration_mps2: 1.25, braking_mps2: 2.5, jerk_mps3: 80.0 };
}

impl Limits {
    /// Both axes as in the paper.
    pub const PAPER: Self = Self { x: AxisLimits::PAPER, y: AxisLimits::PAPER };
}

impl Travel {
    /// The travel reduced by `margin_m` on every side.
    pub fn shrunk(self, margin_m: f64) -> Self {
        let by = Planar::new(margin_m, margin_m);
        Self { min: self.min + by, max: self.max - by }
    }

    /// The nearest point inside.
    pub fn clamped(self, point: Floor) -> Floor {
        Floor::new(point.x.clamp(self.min.x, self.max.x), point.y.clamp(self.min.y, self.max.y))
    }

    /// How far inside the point is, metres; negative outside, and for a point that is none.
    pub fn depth_m(self, point: Floor) -> f64 {
        if !point.is_finite() {
            return f64::NEG_INFINITY;
        }
        let x = (point.x - self.min.x).min(self.max.x - point.x);
        let y = (point.y - self.min.y).min(self.max.y - point.y);
        x.min(y)
    }

    /// The middle.
    pub fn centre(self) -> Floor {
        Floor::new(0.5 * (self.min.x + self.max.x), 0.5 * (self.min.y + self.max.y))
    }
}
