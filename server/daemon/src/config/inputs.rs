//! Digital inputs: lines that stop the machine, or that notice somebody whom nobody tracks.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

/// One digital input.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Input {
    /// What people call it.
    pub name: String,
    /// What it does.
    pub kind: InputKind,
    /// A serial port, a pseudo-terminal or a FIFO that speaks the line protocol, or the value file of a GPIO.
    pub source: PathBuf,
    /// The level at which it is active. Low by default, so that a cut wire with a pull-down is active.
    #[serde(default)]
    pub active: Level,
    /// Without a good word for so long it counts as active, s.
    #[serde(default = "usual_timeout_secs")]
    pub heartbeat_timeout_secs: f64,
}

/// What an input does while it is active.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum InputKind {
    /// The software stop, latched (R4).
    Stop,
    /// A protective stop: somebody is there whom nobody tracks (R12).
    Intruder,
}

/// The level of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Level {
    /// `0`.
    #[default]
    Low,
    /// `1`.
    High,
}

/// The inputs that a value of the configuration names; none when it is not a list of right ones with names of their own.
pub fn parse(value: &toml::Value) -> Option<Vec<Input>> {
    let inputs: Vec<Input> = value.clone().try_into().ok()?;
    let names: std::collections::BTreeSet<_> = inputs.iter().map(|input| &input.name).collect();
    let is_right = |input: &Input| {
        !input.name.trim().is_empty()
            && !input.source.as_os_str().is_empty()
            && (SHORTEST_TIMEOUT_SECS..=LONGEST_TIMEOUT_SECS).contains(&input.heartbeat_timeout_secs)
    };
    (names.len() == inputs.len() && inputs.iter().all(is_right)).then_some(inputs)
}

/// The inputs as a value of the configuration.
pub fn value(inputs: &[Input]) -> toml::Value {
    toml::Value::try_from(inputs).unwrap_or_else(|_| toml::Value::Array(Vec::new()))
}

fn usual_timeout_secs() -> f64 {
    0.5
}

const SHORTEST_TIMEOUT_SECS: f64 = 0.05;
const LONGEST_TIMEOUT_SECS: f64 = 10.0;

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Option<Vec<Input>> {
        parse(&toml::from_str::<toml::Table>(text).unwrap()["inputs"])
    }

    #[test]
    fn an_input_needs_a_name_a_kind_and_a_source() {
        let inputs =
            parsed("[[inputs]]\nname = 'mat'\nkind = 'intruder'\nsource = '/dev/ttyUSB0'\n").unwrap();
        assert_eq!((inputs[0].active, inputs[0].heartbeat_timeout_secs), (Level::Low, 0.5));
        assert_eq!(parse(&value(&inputs)).unwrap(), inputs);
        for wrong in [
            "inputs = [{ kind = 'stop', source = '/dev/ttyUSB0' }]",
            "inputs = [{ name = '', kind = 'stop', source = '/dev/ttyUSB0' }]",
            "inputs = [{ name = 'mat', kind = 'alarm', source = '/dev/ttyUSB0' }]",
            "inputs = [{ name = 'mat', kind = 'stop', source = '' }]",
            "inputs = [{ name = 'mat', kind = 'stop', source = 'x', active = 'up' }]",
            "inputs = [{ name = 'mat', kind = 'stop', source = 'x', heartbeat_timeout_secs = 0.0 }]",
            "inputs = [{ name = 'mat', kind = 'stop', source = 'x', actve = 'low' }]",
            "inputs = [{ name = 'a', kind = 'stop', source = 'x' }, { name = 'a', kind = 'stop', source = 'y' }]",
            "inputs = 'mat'",
        ] {
            assert_eq!(parsed(wrong), None, "{wrong}");
        }
    }
}
