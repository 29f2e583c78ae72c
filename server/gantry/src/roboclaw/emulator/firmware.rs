//! What differs between firmwares: the text that they name themselves by, the bits of the status word, the codes of
//! pin functions, and two known quirks.
//!
//! The status word grew from 16 to 32 bits, with other bits, in 4.1.29 (maker's forum, topics 806 and 817: support says
//! so). Later manuals also number the pin functions anew. A 2x15a with 4.1.34 was measured with both new tables
//! (K9 robot's validation notes). *Unverified:* that the pin functions changed in the very same version.

use std::str::FromStr;

/// One firmware as this emulator knows it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Firmware {
    /// What people call it on the command line.
    pub name: &'static str,
    /// How the board names itself (command 21), without the line feed and the zero at its end.
    pub says: &'static str,
    /// Which codes it speaks.
    pub tables: Tables,
    /// A newly set limit or home function works only after a restart. Of 4.1.34 (maker's forum, topic 981).
    pub switches_wait_for_restart: bool,
    /// Whether commands 0 to 7 are answered; 4.3.6 answers none with one byte of data (osr-rover-code issue 211: "works with 4.2.8").
    pub answers_compatibility: bool,
    /// Default maximum current, A. *Unverified* but for the 30 A of a 2x30a.
    pub(super) rated_amps: u32,
}

/// Which codes a firmware speaks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tables {
    /// Before 4.1.29: a status word of 16 bits; pin function 1 latches, 2 does not.
    Older,
    /// From 4.1.29: a status word of 32 bits; pin function 0x01 does not latch, 0x81 does.
    Newer,
}

/// Something that the status word can say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Flag {
    EStop,
    Temperature,
    TemperatureWarning,
    MainHigh,
    MainLow,
    LogicHigh,
    LogicLow,
    OverCurrent(usize),
    SpeedError(usize),
    PositionError(usize),
    /// The pin of this channel's switch (S4, S5) is active in a home or limit function.
    Switch(usize),
}

/// What a pin does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PinFunction {
    /// Nothing that this emulator follows: disabled, an output, or a function of other control modes.
    None,
    /// Held in shutdown while active; until the power is cycled when it latches.
    EStop { latches: bool },
    /// Stops its motor and sets its encoder to zero; with `limits_forward`, only when it came backward, and else a limit.
    Home { limits_forward: bool },
    /// Its motor does not go on this way (or either) while active.
    Limit { forward: bool, reverse: bool },
}

impl Firmware {
    /// Every one, older first.
    pub const ALL: [Self; 5] = [
        // The text: a rover's diagnosis tool expects it of a 2x7a.
        Self {
            name: "4.1.24",
            says: "USB Roboclaw 2x7a v4.1.24",
            tables: Tables::Older,
            switches_wait_for_restart: false,
            answers_compatibility: true,
            rated_amps: 7,
        },
        // The text: wimblerobotics, K9, the maker's own driver.
        Self {
            name: "4.1.34",
            says: "USB Roboclaw 2x15a v4.1.34",
            tables: Tables::Newer,
            switches_wait_for_restart: true,
            answers_compatibility: true,
            rated_amps: 15,
        },
        Self {
            name: "4.2.8",
            says: "USB Roboclaw 2x15a v4.2.8",
            tables: Tables::Newer,
            switches_wait_for_restart: false,
            answers_compatibility: true,
            rated_amps: 15,
        },
        // The text: a 2x30A owner's notes, with "factory 30 A".
        Self {
            name: "4.3.6",
            says: "USB Roboclaw 2x30a v4.3.6",
            tables: Tables::Newer,
            switches_wait_for_restart: false,
            answers_compatibility: false,
            rated_amps: 30,
        },
        // Made up: a version that nobody has written down.
        Self {
            name: "unknown",
            says: "USB Roboclaw 2x15a v9.0.1",
            tables: Tables::Newer,
            switches_wait_for_restart: false,
            answers_compatibility: false,
            rated_amps: 15,
        },
    ];

    /// The reply to command 21: the text, a line feed, a zero (manual).
    pub(super) fn version(&self) -> Vec<u8> {
        let mut bytes = self.says.as_bytes().to_vec();
        bytes.extend([b'\n', 0]);
        bytes
    }

    /// The status word, as long as this firmware sends it.
    pub(super) fn status(&self, flags: &[Flag]) -> Vec<u8> {
        let word = flags.iter().fold(0, |word, flag| word | self.mask(*flag));
        match self.tables {
            Tables::Older => word.to_be_bytes()[2..].to_vec(),
            Tables::Newer => word.to_be_bytes().to_vec(),
        }
    }

    /// Manuals, "90 - Read Status"; M1's bit is below M2's. MainLow of the newer is the warning and the error that the
    /// maker's support adds (topic 806): "motors are free wheeling due to under voltage".
    const fn mask(&self, flag: Flag) -> u32 {
        match self.tables {
            Tables::Older => match flag {
                Flag::OverCurrent(channel) => 0x0001 << channel,
                Flag::EStop => 0x0004,
                Flag::Temperature => 0x0008,
                Flag::MainHigh => 0x0020 | 0x0400,
                Flag::LogicHigh => 0x0040,
                Flag::LogicLow => 0x0080,
                Flag::MainLow => 0x0800,
                Flag::TemperatureWarning => 0x1000,
                Flag::Switch(channel) => 0x4000 << channel,
                Flag::SpeedError(_) | Flag::PositionError(_) => 0,
            },
            Tables::Newer => match flag {
                Flag::EStop => 0x0000_0001,
                Flag::Temperature => 0x0000_0002,
                Flag::MainHigh => 0x0000_0008 | 0x0004_0000,
                Flag::LogicHigh => 0x0000_0010,
                Flag::LogicLow => 0x0000_0020,
                Flag::SpeedError(channel) => 0x0000_0100 << channel,
                Flag::PositionError(channel) => 0x0000_0400 << channel,
                Flag::MainLow => 0x0000_4000 | 0x0008_0000,
                Flag::OverCurrent(channel) => 0x0001_0000 << channel,
                Flag::TemperatureWarning => 0x0010_0000,
                Flag::Switch(channel) => 0x0040_0000 << channel,
            },
        }
    }

    /// What `code` makes pin S3 (0), S4 (1) or S5 (2) do. Manuals, "74 - Set S3, S4 and S5 Modes".
    ///
    /// *Unverified:* Home(Auto) also homes by itself when the power comes on; here it does not, and is Home(User).
    pub(super) const fn pin_function(&self, pin: usize, code: u8) -> PinFunction {
        let is_s3 = pin == 0;
        match (self.tables, code) {
            // "Default": E-Stop (latching) in serial modes.
            (_, 0) if is_s3 => PinFunction::EStop { latches: true },
            (Tables::Older, 1) | (Tables::Newer, 0x81) => PinFunction::EStop { latches: true },
            (Tables::Older, 2) | (Tables::Newer, 0x01) => PinFunction::EStop { latches: false },
            _ if is_s3 => PinFunction::None,
            (Tables::Older, 4) | (Tables::Newer, 0x62 | 0xE2) => PinFunction::Home { limits_forward: false },
            (Tables::Newer, 0x72 | 0xF2) => PinFunction::Home { limits_forward: true },
            (Tables::Newer, 0x12) => PinFunction::Limit { forward: true, reverse: false },
            (Tables::Newer, 0x22) => PinFunction::Limit { forward: false, reverse: true },
            (Tables::Newer, 0x32) => PinFunction::Limit { forward: true, reverse: true },
            _ => PinFunction::None,
        }
    }
}

impl Default for Firmware {
    /// 4.2.8.
    fn default() -> Self {
        Self::ALL[2]
    }
}

/// A name that is none of [`Firmware::ALL`].
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("firmware: found {0:?}, expected older, newer, 4.1.24, 4.1.34, 4.2.8, 4.3.6 or unknown")]
pub struct UnknownFirmware(String);

impl FromStr for Firmware {
    type Err = UnknownFirmware;

    fn from_str(name: &str) -> Result<Self, UnknownFirmware> {
        let name = match name {
            "older" => "4.1.24",
            "newer" => "4.2.8",
            name => name,
        };
        Self::ALL.into_iter().find(|known| known.name == name).ok_or_else(|| UnknownFirmware(name.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_pin_code_means_opposite_things() {
        let [older, newer] = ["older", "newer"].map(|name| name.parse::<Firmware>().unwrap());
        assert_eq!(older.pin_function(0, 1), PinFunction::EStop { latches: true });
        assert_eq!(newer.pin_function(0, 1), PinFunction::EStop { latches: false });
        assert_eq!(older.pin_function(0, 2), PinFunction::EStop { latches: false });
        assert_eq!(newer.pin_function(0, 0x81), PinFunction::EStop { latches: true });
        for firmware in [older, newer] {
            assert_eq!(firmware.pin_function(0, 0), PinFunction::EStop { latches: true });
            assert_eq!(firmware.pin_function(1, 0), PinFunction::None);
        }
    }

    #[test]
    fn the_stop_is_another_bit_in_a_word_of_another_length() {
        let [older, newer] = ["older", "newer"].map(|name| name.parse::<Firmware>().unwrap());
        assert_eq!(older.status(&[Flag::EStop]), [0x00, 0x04]);
        assert_eq!(newer.status(&[Flag::EStop]), [0x00, 0x00, 0x00, 0x01]);
        assert_eq!(older.status(&[Flag::Switch(1), Flag::OverCurrent(0)]), [0x80, 0x01]);
        assert_eq!(newer.status(&[Flag::Switch(1), Flag::OverCurrent(0)]), [0x00, 0x81, 0x00, 0x00]);
    }

    #[test]
    fn versions_fit_into_the_48_bytes_of_the_manual_and_names_are_found() {
        for firmware in Firmware::ALL {
            assert!(firmware.version().len() <= 48);
            assert_eq!(firmware.name.parse(), Ok(firmware));
        }
        let refused = "4.9".parse::<Firmware>().unwrap_err().to_string();
        assert!(refused.contains("found \"4.9\"") && refused.contains("expected older"), "{refused}");
    }
}
