//! Why a machine cannot be driven, in its own words.

use std::fmt;

use covr_engine::machine::Trouble as Engine;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ts_rs::TS;

/// What keeps a machine from being driven.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(rename_all = "snake_case")]
pub enum MachineTrouble {
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

impl From<Engine> for MachineTrouble {
    fn from(trouble: Engine) -> Self {
        match trouble {
            Engine::NoPort => Self::NoPort,
            Engine::NoAnswer => Self::NoAnswer,
            Engine::UnknownFirmware => Self::UnknownFirmware,
            Engine::NotConfigured => Self::NotConfigured,
            Engine::SwitchOffAndOn => Self::SwitchOffAndOn,
            Engine::Restarted => Self::Restarted,
            Engine::EmergencyStop => Self::EmergencyStop,
            Engine::DriverFault => Self::DriverFault,
            Engine::TooHot => Self::TooHot,
            Engine::BadSupply => Self::BadSupply,
        }
    }
}

impl fmt::Display for MachineTrouble {
    /// The English sentence.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NoPort => "the port of the motor controller cannot be opened",
            Self::NoAnswer => "the motor controller does not answer",
            Self::UnknownFirmware => "the motor controller has a firmware that is not known here",
            Self::NotConfigured => "the motor controller does not keep a setting",
            Self::SwitchOffAndOn => {
                "settings of the motor controller come into force when its power is switched off and on"
            }
            Self::Restarted => "the motor controller has restarted, or its counts jumped: the place is lost",
            Self::EmergencyStop => "the wired emergency stop is active",
            Self::DriverFault => "a bridge of the motor controller is broken",
            Self::TooHot => "the motor controller is too hot",
            Self::BadSupply => "a supply of the motor controller is too high or too low",
        })
    }
}
