//! What a machine says of its boards and its link.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ts_rs::TS;

use crate::reason::MachineTrouble;

/// Boards and link of a real machine.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct MachineHealth {
    /// The firmware's own words; null before it was asked.
    pub firmware: Option<String>,
    /// By which known firmware it is driven.
    pub profile: Option<String>,
    /// Why it cannot be driven now.
    pub trouble: Option<MachineTrouble>,
    /// The same in the driver's words, English; empty when nothing is wrong.
    pub condition: String,
    /// Supply, V.
    pub supply_volts: Option<f64>,
    /// Temperature of the board, degrees Celsius.
    pub temperature_c: Option<f64>,
    /// The link.
    pub link: MachineLink,
}

/// What the link to a machine's controller has been like. A cycle is a command and a look.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
pub struct MachineLink {
    /// Cycles a second over the last half second, Hz.
    pub rate_hz: f64,
    /// Median time of a cycle over the same, us.
    pub cycle_p50_micros: f64,
    /// Its 99th percentile, us.
    pub cycle_p99_micros: f64,
    /// Its greatest, us.
    pub cycle_max_micros: f64,
    /// Exchanges that were answered.
    #[ts(type = "number")]
    pub exchanges: u64,
    /// Exchanges that were not, or not well.
    #[ts(type = "number")]
    pub lost: u64,
    /// Of these, sent again.
    #[ts(type = "number")]
    pub repeated: u64,
    /// Cycles without a whole look.
    #[ts(type = "number")]
    pub cycles_lost: u64,
    /// How the last of them was lost, English; empty for none.
    pub last_loss: String,
    /// How often the boards were found.
    #[ts(type = "number")]
    pub connections: u64,
}
