//! A scenario as designers write it. What it means is said in `deploy/scenes/README.md`; ids, kinds and ranges are the engine's
//! to check.

mod read;
mod spec;

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ts_rs::TS;

pub(super) use spec::spec;

/// What can be served when, how likely it is, and what leads on: a statechart.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(deny_unknown_fields)]
pub struct ScenarioDocument {
    /// Id of the state that it begins in.
    #[schemars(length(min = 1, max = 64))]
    pub initial: String,
    /// What it remembers beside its state.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 32))]
    pub variables: Vec<VariableDocument>,
    /// The states.
    #[schemars(length(min = 1, max = 200))]
    pub states: Vec<StateDocument>,
    /// Transitions from every state, looked at after the state's own.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 50))]
    pub anywhere: Vec<TransitionDocument>,
}

/// A variable.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(deny_unknown_fields)]
pub struct VariableDocument {
    /// Unique in the scenario.
    #[schemars(length(min = 1, max = 64))]
    pub id: String,
    /// Its value at the beginning, which says of what kind it is.
    pub start: ValueDocument,
}

/// A whole number, or true or false.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema, TS)]
#[serde(untagged)]
pub enum ValueDocument {
    /// From -1000000 to 1000000.
    Integer(
        #[schemars(range(min = -1_000_000, max = 1_000_000))]
        #[ts(type = "number")]
        i64,
    ),
    /// Yes or no.
    Boolean(bool),
}

/// A state.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(deny_unknown_fields)]
pub struct StateDocument {
    /// Unique in the scenario.
    #[schemars(length(min = 1, max = 64))]
    pub id: String,
    /// For people.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    #[schemars(length(max = 80))]
    pub label: String,
    /// For the game master: what happens here, and what to look at.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    #[schemars(length(max = 2000))]
    pub note: String,
    /// Ids of the objects that can be served in it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 500))]
    pub enabled: Vec<String>,
    /// Priors by object id; an enabled object without one has the scene's.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub priors: BTreeMap<String, PriorDocument>,
    /// What the column does at an object, by object id; without one it stands in for the object and no more.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub interactions: BTreeMap<String, InteractionDocument>,
    /// Done when it is entered, in this order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 20))]
    pub entry: Vec<ActDocument>,
    /// Its ways out, in the order in which they are looked at: the first that may be taken is.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 50))]
    pub transitions: Vec<TransitionDocument>,
    /// The scenario ends in it.
    #[serde(default, rename = "final", skip_serializing_if = "is_false")]
    pub is_final: bool,
}

/// A prior, or one that changes with the progress of the state.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema, TS)]
#[serde(untagged)]
pub enum PriorDocument {
    /// 0 to 1, the same for the whole state.
    Constant(#[schemars(range(min = 0.0, max = 1.0))] f64),
    /// It changes.
    Changing(ChangingPriorDocument),
}

/// `value + per_s * seconds in the state + per_touch * touches of the object since its entry`, held between `least` and `most`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(deny_unknown_fields)]
pub struct ChangingPriorDocument {
    /// At entry.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub value: f64,
    /// Change per second, 1/s.
    #[serde(default)]
    #[schemars(range(min = -1.0, max = 1.0))]
    pub per_s: f64,
    /// Change per touch that began.
    #[serde(default)]
    #[schemars(range(min = -1.0, max = 1.0))]
    pub per_touch: f64,
    /// Never less.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub least: f64,
    /// Never more.
    #[serde(default = "super::one")]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub most: f64,
}

/// What the column does at an object, beyond standing in for it.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema, TS)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum InteractionDocument {
    /// Keeps its position while somebody touches it: for what is pushed, leaned on, climbed into.
    Hold,
    /// Gives way, against the way that its prop faces, as soon as it stands there in this state.
    StepBack {
        /// How far, m.
        #[schemars(range(min = 0.05, max = 3.0))]
        distance: f64,
    },
    /// Pulls whoever holds on to it along a path. The game master arms it for a visitor (R14).
    Lead {
        /// Places of the object on the floor, one after another, the first after its own; room frame, m.
        #[schemars(length(min = 1, max = 100))]
        path: Vec<[f64; 2]>,
        /// No faster than this, m/s; 0.4 when not given.
        #[serde(default = "lead_speed")]
        #[schemars(range(min = 0.05, max = 0.6))]
        speed: f64,
    },
    /// Carries whoever sits on it along a path. The game master arms it for a visitor (R14).
    Transport {
        /// Places of the object on the floor, one after another, the first after its own; room frame, m.
        #[schemars(length(min = 1, max = 100))]
        path: Vec<[f64; 2]>,
        /// No faster than this, m/s; 0.4 when not given.
        #[serde(default = "lead_speed")]
        #[schemars(range(min = 0.05, max = 0.6))]
        speed: f64,
    },
    /// Comes up to whoever stands still, and leaves. The game master arms it for a visitor (R14).
    Brush {
        /// No faster than this, m/s; 0.25 when not given.
        #[serde(default = "brush_speed")]
        #[schemars(range(min = 0.05, max = 0.3))]
        speed: f64,
        /// It stays for so long, s; 1 when not given.
        #[serde(default = "super::one")]
        #[schemars(range(min = 0.0, max = 10.0))]
        secs: f64,
    },
    /// Keeps out of everybody's reach while this object is the one that is meant.
    Park,
}

/// A way from a state.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(deny_unknown_fields)]
pub struct TransitionDocument {
    /// For people.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    #[schemars(length(max = 80))]
    pub label: String,
    /// What sets it off, any of these; none: its condition alone, as soon as it holds.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 20))]
    pub on: Vec<TriggerDocument>,
    /// What must hold besides.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub when: Option<ConditionDocument>,
    /// Id of the state that it leads to; none: the state stays, and is not entered anew.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<String>,
    /// Done on the way, in this order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 20))]
    pub acts: Vec<ActDocument>,
}

/// Something that happens at one moment.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema, TS)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum TriggerDocument {
    /// Somebody's hand met an object (`touch_began` of a VR client).
    TouchBegan {
        /// Its id.
        object: String,
    },
    /// Somebody's hand let go of an object (`touch_ended`).
    TouchEnded {
        /// Its id.
        object: String,
    },
    /// Somebody came into a zone.
    ZoneEntered {
        /// Its id.
        zone: String,
    },
    /// Somebody went out of a zone.
    ZoneLeft {
        /// Its id.
        zone: String,
    },
    /// What the column does at an object came to its end: the path was driven, the step back made, the brush over.
    InteractionDone {
        /// Its id.
        object: String,
    },
    /// A VR client sent a `scene_event` of this name.
    ClientEvent {
        /// The name.
        #[schemars(length(min = 1, max = 64))]
        name: String,
    },
    /// The game master gave this cue.
    Cue {
        /// The name.
        #[schemars(length(min = 1, max = 64))]
        name: String,
    },
}

/// Something that holds or does not. It holds if it holds for anybody. What lasts counts from the entry of the state at the earliest.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema, TS)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum ConditionDocument {
    /// Somebody touches an object, and has for so long without a break.
    Touching {
        /// Its id.
        object: String,
        /// s; 0 when not given.
        #[serde(default)]
        #[schemars(range(min = 0.0, max = 3600.0))]
        secs: f64,
    },
    /// Somebody is in a zone.
    InZone {
        /// Its id.
        zone: String,
    },
    /// Somebody looks at an object (within ten degrees), and has for so long without a break.
    LooksAt {
        /// Its id.
        object: String,
        /// s; 0 when not given.
        #[serde(default)]
        #[schemars(range(min = 0.0, max = 3600.0))]
        secs: f64,
    },
    /// The column stands still where it serves an object.
    InPlace {
        /// Its id.
        object: String,
    },
    /// The state has lasted for so long.
    TimeInState {
        /// s.
        #[schemars(range(min = 0.0, max = 3600.0))]
        secs: f64,
    },
    /// A variable compares so with a value.
    Variable {
        /// Its id.
        variable: String,
        /// How; true and false know `==` and `!=` alone.
        is: ComparisonDocument,
        /// With what.
        value: ValueDocument,
    },
    /// All of them hold.
    All {
        /// At least one.
        #[schemars(length(min = 1, max = 50))]
        conditions: Vec<ConditionDocument>,
    },
    /// At least one of them holds.
    Any {
        /// At least one.
        #[schemars(length(min = 1, max = 50))]
        conditions: Vec<ConditionDocument>,
    },
    /// It does not hold.
    Not {
        /// What.
        condition: Box<ConditionDocument>,
    },
}

/// How a variable compares with a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, TS)]
pub enum ComparisonDocument {
    /// Is.
    #[serde(rename = "==")]
    Equal,
    /// Is not.
    #[serde(rename = "!=")]
    NotEqual,
    /// Is less.
    #[serde(rename = "<")]
    Less,
    /// Is no more.
    #[serde(rename = "<=")]
    AtMost,
    /// Is more.
    #[serde(rename = ">")]
    Greater,
    /// Is no less.
    #[serde(rename = ">=")]
    AtLeast,
}

/// What is done to a variable.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema, TS)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum ActDocument {
    /// Give it a value.
    Set {
        /// Its id.
        variable: String,
        /// Of its kind.
        value: ValueDocument,
    },
    /// Add to a number.
    Add {
        /// Its id.
        variable: String,
        /// How much.
        #[schemars(range(min = -1_000_000, max = 1_000_000))]
        #[ts(type = "number")]
        amount: i64,
    },
}

impl ScenarioDocument {
    /// Every way, with its path from the scenario on.
    pub fn ways(&self) -> impl Iterator<Item = (String, &TransitionDocument)> {
        let of_states = self.states.iter().enumerate().flat_map(|(i, state)| {
            let ways = state.transitions.iter().enumerate();
            ways.map(move |(k, way)| (format!("states[{i}].transitions[{k}]"), way))
        });
        of_states.chain(self.anywhere.iter().enumerate().map(|(i, way)| (format!("anywhere[{i}]"), way)))
    }
}

pub(super) const fn lead_speed() -> f64 {
    0.4
}

pub(super) const fn brush_speed() -> f64 {
    0.25
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands a reference")]
const fn is_false(yes: &bool) -> bool {
    !*yes
}
