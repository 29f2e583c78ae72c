//! Reading what is tagged or of several types by hand, so that an error keeps its path and says what was expected.

use std::fmt;

use serde::de::{Error, MapAccess, Unexpected, Visitor, value::MapAccessDeserializer};
use serde::{Deserialize, Deserializer};

use super::super::shape::{due, only, written};
use super::{
    ActDocument, ChangingPriorDocument, ComparisonDocument, ConditionDocument, InteractionDocument,
    PriorDocument, TriggerDocument, ValueDocument, brush_speed, lead_speed,
};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct TriggerFields {
    kind: TriggerKind,
    #[serde(default, deserialize_with = "written")]
    object: Option<String>,
    #[serde(default, deserialize_with = "written")]
    zone: Option<String>,
    #[serde(default, deserialize_with = "written")]
    name: Option<String>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
enum TriggerKind {
    TouchBegan,
    TouchEnded,
    ZoneEntered,
    ZoneLeft,
    InteractionDone,
    ClientEvent,
    Cue,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ConditionFields {
    kind: ConditionKind,
    #[serde(default, deserialize_with = "written")]
    object: Option<String>,
    #[serde(default, deserialize_with = "written")]
    zone: Option<String>,
    #[serde(default, deserialize_with = "written")]
    secs: Option<f64>,
    #[serde(default, deserialize_with = "written")]
    variable: Option<String>,
    #[serde(default, deserialize_with = "written")]
    is: Option<ComparisonDocument>,
    #[serde(default, deserialize_with = "written")]
    value: Option<ValueDocument>,
    #[serde(default, deserialize_with = "written")]
    conditions: Option<Vec<ConditionDocument>>,
    #[serde(default, deserialize_with = "written")]
    condition: Option<Box<ConditionDocument>>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
enum ConditionKind {
    Touching,
    InZone,
    LooksAt,
    InPlace,
    TimeInState,
    Variable,
    All,
    Any,
    Not,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct InteractionFields {
    kind: InteractionKind,
    #[serde(default, deserialize_with = "written")]
    distance: Option<f64>,
    #[serde(default, deserialize_with = "written")]
    path: Option<Vec<[f64; 2]>>,
    #[serde(default, deserialize_with = "written")]
    speed: Option<f64>,
    #[serde(default, deserialize_with = "written")]
    secs: Option<f64>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
enum InteractionKind {
    Hold,
    StepBack,
    Lead,
    Transport,
    Brush,
    Park,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ActFields {
    kind: ActKind,
    variable: String,
    #[serde(default, deserialize_with = "written")]
    value: Option<ValueDocument>,
    #[serde(default, deserialize_with = "written")]
    amount: Option<i64>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
enum ActKind {
    Set,
    Add,
}

impl<'de> Deserialize<'de> for TriggerDocument {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let TriggerFields { kind, object, zone, name } = TriggerFields::deserialize(deserializer)?;
        let present = [("object", object.is_some()), ("zone", zone.is_some()), ("name", name.is_some())];
        let known: &[&str] = match kind {
            TriggerKind::TouchBegan | TriggerKind::TouchEnded | TriggerKind::InteractionDone => &["object"],
            TriggerKind::ZoneEntered | TriggerKind::ZoneLeft => &["zone"],
            TriggerKind::ClientEvent | TriggerKind::Cue => &["name"],
        };
        only::<D>(&present, known)?;
        Ok(match kind {
            TriggerKind::TouchBegan => Self::TouchBegan { object: due::<D, _>(object, "object")? },
            TriggerKind::TouchEnded => Self::TouchEnded { object: due::<D, _>(object, "object")? },
            TriggerKind::InteractionDone => Self::InteractionDone { object: due::<D, _>(object, "object")? },
            TriggerKind::ZoneEntered => Self::ZoneEntered { zone: due::<D, _>(zone, "zone")? },
            TriggerKind::ZoneLeft => Self::ZoneLeft { zone: due::<D, _>(zone, "zone")? },
            TriggerKind::ClientEvent => Self::ClientEvent { name: due::<D, _>(name, "name")? },
            TriggerKind::Cue => Self::Cue { name: due::<D, _>(name, "name")? },
        })
    }
}

impl<'de> Deserialize<'de> for ConditionDocument {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let fields = ConditionFields::deserialize(deserializer)?;
        let present = [
            ("object", fields.object.is_some()),
            ("zone", fields.zone.is_some()),
            ("secs", fields.secs.is_some()),
            ("variable", fields.variable.is_some()),
            ("is", fields.is.is_some()),
            ("value", fields.value.is_some()),
            ("conditions", fields.conditions.is_some()),
            ("condition", fields.condition.is_some()),
        ];
        let known: &[&str] = match fields.kind {
            ConditionKind::Touching | ConditionKind::LooksAt => &["object", "secs"],
            ConditionKind::InZone => &["zone"],
            ConditionKind::InPlace => &["object"],
            ConditionKind::TimeInState => &["secs"],
            ConditionKind::Variable => &["variable", "is", "value"],
            ConditionKind::All | ConditionKind::Any => &["conditions"],
            ConditionKind::Not => &["condition"],
        };
        only::<D>(&present, known)?;
        let object = || due::<D, _>(fields.object, "object");
        Ok(match fields.kind {
            ConditionKind::Touching => Self::Touching { object: object()?, secs: fields.secs.unwrap_or(0.0) },
            ConditionKind::LooksAt => Self::LooksAt { object: object()?, secs: fields.secs.unwrap_or(0.0) },
            ConditionKind::InZone => Self::InZone { zone: due::<D, _>(fields.zone, "zone")? },
            ConditionKind::InPlace => Self::InPlace { object: object()? },
            ConditionKind::TimeInState => Self::TimeInState { secs: due::<D, _>(fields.secs, "secs")? },
            ConditionKind::Variable => Self::Variable {
                variable: due::<D, _>(fields.variable, "variable")?,
                is: due::<D, _>(fields.is, "is")?,
                value: due::<D, _>(fields.value, "value")?,
            },
            ConditionKind::All => Self::All { conditions: due::<D, _>(fields.conditions, "conditions")? },
            ConditionKind::Any => Self::Any { conditions: due::<D, _>(fields.conditions, "conditions")? },
            ConditionKind::Not => Self::Not { condition: due::<D, _>(fields.condition, "condition")? },
        })
    }
}

impl<'de> Deserialize<'de> for InteractionDocument {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let InteractionFields { kind, distance, path, speed, secs } =
            InteractionFields::deserialize(deserializer)?;
        let present = [
            ("distance", distance.is_some()),
            ("path", path.is_some()),
            ("speed", speed.is_some()),
            ("secs", secs.is_some()),
        ];
        let known: &[&str] = match kind {
            InteractionKind::Hold | InteractionKind::Park => &[],
            InteractionKind::StepBack => &["distance"],
            InteractionKind::Lead | InteractionKind::Transport => &["path", "speed"],
            InteractionKind::Brush => &["speed", "secs"],
        };
        only::<D>(&present, known)?;
        Ok(match kind {
            InteractionKind::Hold => Self::Hold,
            InteractionKind::Park => Self::Park,
            InteractionKind::StepBack => Self::StepBack { distance: due::<D, _>(distance, "distance")? },
            InteractionKind::Lead => {
                Self::Lead { path: due::<D, _>(path, "path")?, speed: speed.unwrap_or_else(lead_speed) }
            }
            InteractionKind::Transport => {
                Self::Transport { path: due::<D, _>(path, "path")?, speed: speed.unwrap_or_else(lead_speed) }
            }
            InteractionKind::Brush => {
                Self::Brush { speed: speed.unwrap_or_else(brush_speed), secs: secs.unwrap_or(1.0) }
            }
        })
    }
}

impl<'de> Deserialize<'de> for ActDocument {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let ActFields { kind, variable, value, amount } = ActFields::deserialize(deserializer)?;
        let present = [("value", value.is_some()), ("amount", amount.is_some())];
        Ok(match kind {
            ActKind::Set => {
                only::<D>(&present, &["value"])?;
                Self::Set { variable, value: due::<D, _>(value, "value")? }
            }
            ActKind::Add => {
                only::<D>(&present, &["amount"])?;
                Self::Add { variable, amount: due::<D, _>(amount, "amount")? }
            }
        })
    }
}

impl<'de> Deserialize<'de> for ValueDocument {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ValueVisitor)
    }
}

struct ValueVisitor;

impl Visitor<'_> for ValueVisitor {
    type Value = ValueDocument;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a whole number, or true or false")
    }

    fn visit_bool<E>(self, yes: bool) -> Result<ValueDocument, E> {
        Ok(ValueDocument::Boolean(yes))
    }

    fn visit_i64<E>(self, number: i64) -> Result<ValueDocument, E> {
        Ok(ValueDocument::Integer(number))
    }

    fn visit_u64<E: Error>(self, number: u64) -> Result<ValueDocument, E> {
        let fits = i64::try_from(number).map(ValueDocument::Integer);
        fits.map_err(|_| E::invalid_value(Unexpected::Unsigned(number), &self))
    }
}

impl<'de> Deserialize<'de> for PriorDocument {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(PriorVisitor)
    }
}

struct PriorVisitor;

impl<'de> Visitor<'de> for PriorVisitor {
    type Value = PriorDocument;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number from 0 to 1, or an object with a `value`")
    }

    fn visit_f64<E>(self, prior: f64) -> Result<PriorDocument, E> {
        Ok(PriorDocument::Constant(prior))
    }

    fn visit_i64<E>(self, prior: i64) -> Result<PriorDocument, E> {
        Ok(PriorDocument::Constant(prior as f64))
    }

    fn visit_u64<E>(self, prior: u64) -> Result<PriorDocument, E> {
        Ok(PriorDocument::Constant(prior as f64))
    }

    fn visit_map<A: MapAccess<'de>>(self, fields: A) -> Result<PriorDocument, A::Error> {
        ChangingPriorDocument::deserialize(MapAccessDeserializer::new(fields)).map(PriorDocument::Changing)
    }
}
