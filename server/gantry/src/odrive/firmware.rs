//! Firmware profiles: the versions whose words and error bits are known.
//!
//! 0.5.4 is the first whose answers to `r` are right throughout (before, an error was told as `0d`; release notes of 0.5.4) and with
//! which an axis in trajectory mode does not jump to zero when it is switched on (release notes of 0.5.3). From 0.6 on, made for newer
//! boards, properties have other names. A board with any other version is not driven.

use std::fmt;

/// A version as the board tells it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Version(pub [u32; 3]);

/// A firmware whose words are known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Firmware {
    /// 0.5.4 to 0.5.6, on boards v3.
    V0_5,
}

impl Firmware {
    /// The profile of a version; none when it is not one of the known.
    pub const fn of(version: Version) -> Option<Self> {
        match version.0 {
            [0, 5, 4..=6] => Some(Self::V0_5),
            _ => None,
        }
    }

    /// The name on every surface, in any language.
    pub const fn name(self) -> &'static str {
        match self {
            Self::V0_5 => "0.5.4–0.5.6",
        }
    }
}

impl fmt::Display for Version {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [major, minor, revision] = self.0;
        write!(f, "{major}.{minor}.{revision}")
    }
}

/// Of the board's `error`: its supply was too low, too high, or took too much back (`DC_BUS_UNDER_VOLTAGE`, `DC_BUS_OVER_VOLTAGE`,
/// `DC_BUS_OVER_REGEN_CURRENT`, `DC_BUS_OVER_CURRENT`).
pub const SUPPLY_ERRORS: u32 = 0x1E;
/// `AXIS_STATE_IDLE`: no torque.
pub const IDLE: u32 = 1;
/// `AXIS_STATE_CLOSED_LOOP_CONTROL`.
pub const CLOSED_LOOP: u32 = 8;
/// `CONTROL_MODE_POSITION_CONTROL`.
pub const POSITION_CONTROL: u32 = 3;
/// `INPUT_MODE_TRAP_TRAJ`.
pub const TRAPEZOIDAL_TRAJECTORY: u32 = 5;

/// The names of an axis's error bits, as the maker writes them.
pub fn axis_errors(bits: u32) -> String {
    const NAMES: [(u32, &str); 12] = [
        (0x1, "INVALID_STATE"),
        (0x40, "MOTOR_FAILED"),
        (0x80, "SENSORLESS_ESTIMATOR_FAILED"),
        (0x100, "ENCODER_FAILED"),
        (0x200, "CONTROLLER_FAILED"),
        (0x800, "WATCHDOG_TIMER_EXPIRED"),
        (0x1000, "MIN_ENDSTOP_PRESSED"),
        (0x2000, "MAX_ENDSTOP_PRESSED"),
        (0x4000, "ESTOP_REQUESTED"),
        (0x20000, "HOMING_WITHOUT_ENDSTOP"),
        (0x40000, "OVER_TEMP"),
        (0x80000, "UNKNOWN_POSITION"),
    ];
    let known = NAMES.iter().filter(|(bit, _)| bits & bit != 0).map(|(_, name)| (*name).to_owned());
    let rest = bits & !NAMES.iter().fold(0, |all, (bit, _)| all | bit);
    let rest = (rest != 0).then(|| format!("{rest:#x}"));
    known.chain(rest).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_profile_needs_a_version_that_is_known() {
        for known in [[0, 5, 4], [0, 5, 5], [0, 5, 6]] {
            assert_eq!(Firmware::of(Version(known)), Some(Firmware::V0_5));
        }
        for unknown in [[0, 5, 3], [0, 5, 7], [0, 4, 12], [0, 6, 9], [1, 5, 4], [0, 0, 0]] {
            assert_eq!(Firmware::of(Version(unknown)), None, "{}", Version(unknown));
        }
    }

    #[test]
    fn errors_have_the_makers_names_and_what_is_not_known_its_bits() {
        assert_eq!(axis_errors(0x840), "MOTOR_FAILED, WATCHDOG_TIMER_EXPIRED");
        assert_eq!(axis_errors(0x8000_0800), "WATCHDOG_TIMER_EXPIRED, 0x80000000");
        assert_eq!(axis_errors(0), "");
    }
}
