//! The places that keys fill: what fits, what is there, and putting something there.

use std::net::SocketAddr;
use std::ops::RangeInclusive;
use std::path::PathBuf;

use covr_engine::intention::RuleName;
use covr_engine::motion::MotionName;
use covr_engine::motion::standing::StandingName;
use covr_gantry::homing::HomeBy;
use covr_wire::accepts::Accepts;
use toml::Value;

use crate::config::{Config, GameMasterNeeded, Input, LogFormat, MachineKind, inputs};

/// Where a key's value goes, and what it must be.
#[derive(Clone)]
pub enum Place {
    Number(RangeInclusive<f64>, fn(&mut Config) -> &mut f64),
    Whole(RangeInclusive<usize>, fn(&mut Config) -> &mut usize),
    Priority(fn(&mut Config) -> &mut u8),
    Switch(fn(&mut Config) -> &mut bool),
    Text(fn(&mut Config) -> &mut String),
    Path(fn(&mut Config) -> &mut PathBuf),
    PathOrNone(fn(&mut Config) -> &mut Option<PathBuf>),
    Address(fn(&mut Config) -> &mut SocketAddr),
    Origins(fn(&mut Config) -> &mut Vec<String>),
    GameMaster(fn(&mut Config) -> &mut GameMasterNeeded),
    Inputs(fn(&mut Config) -> &mut Vec<Input>),
    Rectangle(fn(&mut Config) -> &mut [f64; 4]),
    Point(fn(&mut Config) -> &mut [f64; 3]),
    Rule(fn(&mut Config) -> &mut RuleName),
    Motion(fn(&mut Config) -> &mut MotionName),
    Standing(fn(&mut Config) -> &mut Option<StandingName>),
    Machine(fn(&mut Config) -> &mut MachineKind),
    HomeBy(fn(&mut Config) -> &mut HomeBy),
    LogFormat(fn(&mut Config) -> &mut LogFormat),
}

impl Place {
    /// What fits.
    pub fn accepts(&self) -> Accepts {
        match self {
            Place::Number(range, _) => Accepts::Number { least: *range.start(), most: *range.end() },
            Place::Whole(range, _) => Accepts::Whole { least: *range.start(), most: *range.end() },
            Place::Priority(_) => Accepts::Whole { least: 1, most: 99 },
            Place::Switch(_) => Accepts::TrueOrFalse,
            Place::Text(_) => Accepts::Text,
            Place::Path(_) => Accepts::Path,
            Place::PathOrNone(_) => Accepts::PathOrNone,
            Place::Address(_) => Accepts::Address,
            Place::Origins(_) => Accepts::Origins,
            Place::GameMaster(_) => one_of(GameMasterNeeded::ALL.map(GameMasterNeeded::name)),
            Place::Inputs(_) => Accepts::Inputs,
            Place::Rectangle(_) => Accepts::Rectangle,
            Place::Point(_) => Accepts::Point,
            Place::Rule(_) => one_of(RuleName::ALL.map(RuleName::name)),
            Place::Motion(_) => one_of(MotionName::ALL.map(MotionName::name)),
            Place::Standing(_) => {
                one_of([BY_THE_RULE].into_iter().chain(StandingName::ALL.map(StandingName::name)))
            }
            Place::Machine(_) => one_of(MachineKind::ALL.map(MachineKind::name)),
            Place::HomeBy(_) => one_of(HOME_BY.map(|(_, name)| name)),
            Place::LogFormat(_) => one_of(["text", "json"]),
        }
    }

    /// The value in force.
    pub fn value(&self, config: &Config) -> Value {
        let mut config = config.clone();
        match self {
            Place::Number(_, place) => Value::Float(*place(&mut config)),
            Place::Whole(_, place) => Value::Integer(*place(&mut config) as i64),
            Place::Priority(place) => Value::Integer(i64::from(*place(&mut config))),
            Place::Switch(place) => Value::Boolean(*place(&mut config)),
            Place::Text(place) => Value::String(place(&mut config).clone()),
            Place::Path(place) => Value::String(place(&mut config).display().to_string()),
            Place::PathOrNone(place) => {
                let path = place(&mut config).as_ref().map(|path| path.display().to_string());
                Value::String(path.unwrap_or_default())
            }
            Place::Address(place) => Value::String(place(&mut config).to_string()),
            Place::Origins(place) => {
                Value::Array(place(&mut config).iter().cloned().map(Value::String).collect())
            }
            Place::GameMaster(place) => Value::String(place(&mut config).name().into()),
            Place::Inputs(place) => inputs::value(place(&mut config)),
            Place::Rectangle(place) => {
                Value::Array(place(&mut config).iter().map(|v| Value::Float(*v)).collect())
            }
            Place::Point(place) => {
                Value::Array(place(&mut config).iter().map(|v| Value::Float(*v)).collect())
            }
            Place::Rule(place) => Value::String(place(&mut config).name().into()),
            Place::Motion(place) => Value::String(place(&mut config).name().into()),
            Place::Standing(place) => {
                Value::String(place(&mut config).map_or(BY_THE_RULE, StandingName::name).into())
            }
            Place::Machine(place) => Value::String(place(&mut config).name().into()),
            Place::HomeBy(place) => {
                let in_force = *place(&mut config);
                let name = HOME_BY.iter().find(|(home_by, _)| *home_by == in_force);
                Value::String(name.map_or("", |(_, name)| name).into())
            }
            Place::LogFormat(place) => Value::String(
                match place(&mut config) {
                    LogFormat::Text => "text",
                    LogFormat::Json => "json",
                }
                .into(),
            ),
        }
    }

    /// Put a value there; none when it does not fit.
    pub fn set(&self, config: &mut Config, value: &Value) -> Option<()> {
        match self {
            Place::Number(range, place) => {
                *place(config) = number(value).filter(|v| range.contains(v))?;
            }
            Place::Whole(range, place) => {
                *place(config) = usize::try_from(value.as_integer()?).ok().filter(|v| range.contains(v))?;
            }
            Place::Priority(place) => {
                *place(config) = u8::try_from(value.as_integer()?).ok().filter(|v| (1..=99).contains(v))?;
            }
            Place::Switch(place) => *place(config) = value.as_bool()?,
            Place::Text(place) => *place(config) = text(value)?.into(),
            Place::Path(place) => *place(config) = text(value)?.into(),
            Place::PathOrNone(place) => {
                *place(config) =
                    Some(value.as_str()?.trim()).filter(|path| !path.is_empty()).map(PathBuf::from);
            }
            Place::Address(place) => *place(config) = value.as_str()?.parse().ok()?,
            Place::Origins(place) => {
                *place(config) = value.as_array()?.iter().map(origin).collect::<Option<_>>()?;
            }
            Place::GameMaster(place) => *place(config) = GameMasterNeeded::parse(value.as_str()?)?,
            Place::Inputs(place) => *place(config) = inputs::parse(value)?,
            Place::Rectangle(place) => {
                let corners = lengths::<4>(value)?;
                let [min_x, min_y, max_x, max_y] = corners;
                if max_x - min_x < 0.5 || max_y - min_y < 0.5 {
                    return None;
                }
                *place(config) = corners;
            }
            Place::Point(place) => *place(config) = lengths::<3>(value)?,
            Place::Rule(place) => *place(config) = RuleName::parse(value.as_str()?)?,
            Place::Motion(place) => *place(config) = MotionName::parse(value.as_str()?)?,
            Place::Standing(place) => {
                *place(config) = match value.as_str()? {
                    BY_THE_RULE => None,
                    name => Some(StandingName::parse(name)?),
                }
            }
            Place::Machine(place) => {
                let found = value.as_str()?;
                *place(config) = MachineKind::ALL.into_iter().find(|kind| kind.name() == found)?;
            }
            Place::HomeBy(place) => {
                let found = value.as_str()?;
                *place(config) = HOME_BY.iter().find(|(_, name)| *name == found)?.0;
            }
            Place::LogFormat(place) => {
                *place(config) = match value.as_str()? {
                    "text" => LogFormat::Text,
                    "json" => LogFormat::Json,
                    _ => return None,
                }
            }
        }
        Some(())
    }
}

fn one_of(names: impl IntoIterator<Item = &'static str>) -> Accepts {
    Accepts::OneOf { names: names.into_iter().map(str::to_owned).collect() }
}

/// What homing looks for, by name.
const HOME_BY: [(HomeBy, &str); 2] = [(HomeBy::Switches, "switches"), (HomeBy::Stops, "stops")];

/// The word for a standing place as the intention rule has it.
const BY_THE_RULE: &str = "rule";

/// So many lengths of at most 100 m.
fn lengths<const N: usize>(value: &Value) -> Option<[f64; N]> {
    let lengths: Vec<f64> = value.as_array()?.iter().map(number).collect::<Option<_>>()?;
    let lengths: [f64; N] = lengths.try_into().ok()?;
    lengths.iter().all(|length| length.abs() <= 100.0).then_some(lengths)
}

fn number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|v| v as f64)).filter(|v| v.is_finite())
}

fn text(value: &Value) -> Option<&str> {
    value.as_str().filter(|v| !v.trim().is_empty())
}

/// What a browser writes into `Origin`: scheme, host and port without a path, or `null`.
fn origin(value: &Value) -> Option<String> {
    let origin = value.as_str()?;
    let is_one = origin.split_once("://").map_or(origin == "null", |(scheme, host)| {
        !scheme.is_empty() && !host.contains(['/', '*', '?', '#']) && (scheme == "file" || !host.is_empty())
    });
    (is_one && !origin.contains(char::is_whitespace)).then(|| origin.to_ascii_lowercase())
}
