//! Versions that the emulator can say that it is.

use std::str::FromStr;

/// A version.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Firmware([u8; 3]);

/// A name that is none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("expected {FIRMWARE_NAMES}")]
pub struct NoFirmware;

impl Firmware {
    /// The last for boards v3.
    pub const LAST: Self = Self([0, 5, 6]);

    pub(super) const fn parts(self) -> [u8; 3] {
        self.0
    }
}

impl FromStr for Firmware {
    type Err = NoFirmware;

    fn from_str(name: &str) -> Result<Self, NoFirmware> {
        Ok(Self(match name {
            "0.5.1" => [0, 5, 1],
            "0.5.4" => [0, 5, 4],
            "0.5.5" => [0, 5, 5],
            "0.5.6" => [0, 5, 6],
            // As the boards after v3 have.
            "unknown" => [0, 6, 8],
            _ => return Err(NoFirmware),
        }))
    }
}

pub(super) const FIRMWARE_NAMES: &str = "0.5.1, 0.5.4, 0.5.5, 0.5.6 or unknown";
