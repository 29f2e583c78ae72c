//! What a configuration key accepts: as data, for a page that says it in its reader's language, and in English.

use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ts_rs::TS;

/// What a key's value must be.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(tag = "kind", rename_all = "snake_case")]
pub enum Accepts {
    /// A number in a range, its ends included.
    Number {
        /// The least.
        least: f64,
        /// The greatest.
        most: f64,
    },
    /// A whole number in a range, its ends included.
    Whole {
        /// The least.
        #[ts(type = "number")]
        least: usize,
        /// The greatest.
        #[ts(type = "number")]
        most: usize,
    },
    /// A switch.
    TrueOrFalse,
    /// A text that is not empty.
    Text,
    /// A path that is not empty.
    Path,
    /// A path, or nothing.
    PathOrNone,
    /// An IP address and a port.
    Address,
    /// Origins of pages.
    Origins,
    /// Digital inputs.
    Inputs,
    /// `[min_x, min_y, max_x, max_y]`, each side at least 0.5 m.
    Rectangle,
    /// `[x, y, z]`, each at most 100 m.
    Point,
    /// One of some names.
    OneOf {
        /// The names.
        names: Vec<String>,
    },
}

impl fmt::Display for Accepts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number { least, most } => write!(f, "a number from {least} to {most}"),
            Self::Whole { least, most } => write!(f, "a whole number from {least} to {most}"),
            Self::TrueOrFalse => write!(f, "true or false"),
            Self::Text => write!(f, "a text that is not empty"),
            Self::Path => write!(f, "a path that is not empty"),
            Self::PathOrNone => write!(f, "a path, or \"\" for none"),
            Self::Address => write!(f, "an address and a port such as \"127.0.0.1:7878\""),
            Self::Origins => {
                write!(f, "a list of texts such as \"https://lab.example:8443\", \"file://\" or \"null\"")
            }
            Self::Inputs => write!(
                f,
                "a list of inputs such as {{name = \"curtain\", kind = \"intruder\", source = \"/dev/ttyUSB0\"}}, each of another name; \
                 kind \"stop\" or \"intruder\"; active \"low\" (usual) or \"high\"; heartbeat_timeout_secs from 0.05 to 10 (usual 0.5)"
            ),
            Self::Rectangle => {
                write!(f, "four numbers [min_x, min_y, max_x, max_y], each side at least 0.5 m")
            }
            Self::Point => write!(f, "three numbers [x, y, z] of at most 100 m"),
            Self::OneOf { names } => {
                let names: Vec<_> = names.iter().map(|name| format!("\"{name}\"")).collect();
                match &names[..] {
                    [only] => write!(f, "{only}"),
                    _ => write!(f, "one of {}", names.join(", ")),
                }
            }
        }
    }
}
