//! What a board can be told to keep: in use until the power goes, in EEPROM once saved (manual, "94 - Write Settings to
//! EEPROM"; the maker's forum, topic 981: "a power cycle will lose those settings").

use crate::sim::parameters::{AxisParameters, MachineParameters};

use super::firmware::Firmware;

/// Every setting, in the units of the protocol. M1 before M2.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Settings {
    /// Tenths of a second without a valid packet after which the motors stop; 0 for never (*unverified*).
    pub serial_timeout: u8,
    /// Velocity PID.
    pub velocity: [VelocityPid; 2],
    /// Position PID.
    pub position: [PositionPid; 2],
    /// Change of duty a second for the duty commands, of 32767 for 100 %.
    pub duty_acceleration: [u32; 2],
    /// Least and greatest main battery voltage, 0.1 V.
    pub main_battery: [u16; 2],
    /// Least and greatest logic battery voltage, 0.1 V.
    pub logic_battery: [u16; 2],
    /// Maximum current, 10 mA.
    pub maximum_current: [u32; 2],
    /// Function codes of S3, S4, S5.
    pub pins: [u8; 3],
    /// Encoder modes: bit 6 turns the encoder's direction round, bit 5 the motor's.
    pub encoder_modes: [u8; 2],
    /// Speed errors beyond this end in an error, counts/s; 0 for any.
    pub speed_error_limits: [u32; 2],
    /// Position errors beyond this end in an error, counts; 0 for any.
    pub position_error_limits: [u32; 2],
}

/// Constants of a velocity loop. Gains are in 65536ths.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct VelocityPid {
    /// Proportional.
    pub p: u32,
    /// Integral.
    pub i: u32,
    /// Derivative.
    pub d: u32,
    /// Counts a second at 100 % duty.
    pub qpps: u32,
}

/// Constants of a position loop. Gains are in 1024ths (the maker's library).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PositionPid {
    /// Proportional.
    pub p: u32,
    /// Integral.
    pub i: u32,
    /// Derivative.
    pub d: u32,
    /// Most that the integral may wind up to.
    pub max_i: u32,
    /// Near enough, counts.
    pub deadzone: u32,
    /// Least position, counts.
    pub min: i32,
    /// Greatest position, counts.
    pub max: i32,
}

impl Settings {
    /// As from the factory: the velocity and position constants are the manual's ("28", "61"); no serial timeout and the
    /// current limit of a 2x30a as an owner found them; the voltage limits are *unverified*.
    pub fn factory(firmware: &Firmware) -> Self {
        Self {
            serial_timeout: 0,
            velocity: [VelocityPid::FACTORY; 2],
            position: [PositionPid::default(); 2],
            duty_acceleration: [655_360; 2],
            main_battery: [60, 340],
            logic_battery: [45, 340],
            maximum_current: [firmware.rated_amps * 100; 2],
            pins: [0; 3],
            encoder_modes: [0; 2],
            speed_error_limits: [0; 2],
            position_error_limits: [0; 2],
        }
    }
}

impl VelocityPid {
    /// Manual, "28 - Set Velocity PID Constants M1".
    pub const FACTORY: Self = Self { p: 0x0001_0000, i: 0x0000_8000, d: 0x0000_4000, qpps: 44_000 };

    /// What tuning finds for an axis of the simulated machine, with the loop of this emulator: its bandwidth and the
    /// rate of its integral are the machine's `tuning`.
    pub fn tuned(axis: &AxisParameters, machine: &MachineParameters) -> Self {
        let k = axis.force_per_amp();
        let inertia = axis.motor.resistance_ohm * axis.effective_mass_kg() / k;
        let p = ((machine.tuning.velocity_bandwidth_rad_per_s * inertia - k) / k).max(0.0);
        let i = p * machine.tuning.integral_rate_per_s / f64::from(SAMPLES_A_SECOND);
        let qpps = machine.supply_volts / k / axis.metres_per_count();
        Self { p: sixteenth(p), i: sixteenth(i), d: 0, qpps: qpps.round() as u32 }
    }
}

fn sixteenth(gain: f64) -> u32 {
    (gain * 65_536.0).round() as u32
}

/// Speeds are counted 300 times a second (manual, "30 - Read Raw Speed M1").
pub(super) const SAMPLES_A_SECOND: u32 = 300;
