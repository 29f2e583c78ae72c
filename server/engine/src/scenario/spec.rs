//! A scenario as described: plain data, not yet checked. References are ids; times are seconds, lengths metres, places in the room
//! frame.

use crate::frames::Floor;

/// A scenario as described, not yet checked.
#[derive(Debug, Clone, PartialEq)]
pub struct ScenarioSpec {
    /// Id of the state that it begins in.
    pub initial: String,
    /// What it remembers beside its state.
    pub variables: Vec<VariableSpec>,
    /// The states.
    pub states: Vec<StateSpec>,
    /// Transitions from every state; looked at after the state's own.
    pub anywhere: Vec<Transition<String>>,
}

/// A variable.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct VariableSpec {
    /// Unique in the scenario.
    pub id: String,
    /// Its value at the beginning, which says of what kind it is.
    pub start: Value,
}

/// The value of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Value {
    /// A whole number.
    Integer(i64),
    /// Yes or no.
    Boolean(bool),
}

/// A state.
#[derive(Debug, Clone, PartialEq)]
pub struct StateSpec {
    /// Unique in the scenario.
    pub id: String,
    /// Ids of the objects that can be served in it.
    pub enabled: Vec<String>,
    /// Priors by object id; others are the scene's.
    pub priors: Vec<(String, Prior)>,
    /// What the column does at an object, by object id.
    pub interactions: Vec<(String, Interaction)>,
    /// Done when it is entered, in this order.
    pub entry: Vec<Act<String>>,
    /// Its ways out; the first that may be taken is.
    pub transitions: Vec<Transition<String>>,
    /// The scenario ends in it.
    pub is_final: bool,
}

/// A prior that changes with the progress of a state: `value + per_s * time in state + per_touch * touches of the object
/// since the state was entered`, held between `least` and `most`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prior {
    /// At entry, 0 to 1.
    pub value: f64,
    /// Change per second.
    pub per_s: f64,
    /// Change per touch that began.
    pub per_touch: f64,
    /// Never less, 0 to 1.
    pub least: f64,
    /// Never more, 0 to 1.
    pub most: f64,
}

/// What the column does at an object, in one state; what each does is said in `interaction`.
#[derive(Debug, Clone, PartialEq)]
pub enum Interaction {
    /// Keeps its position under load.
    Hold,
    /// Gives way after being pushed.
    StepBack {
        /// How far, against the way that its prop faces, m.
        distance_m: f64,
    },
    /// Pulls along a path.
    Lead(Course),
    /// Carries along a path.
    Transport(Course),
    /// Comes up to a still person and leaves.
    Brush {
        /// No faster than this, m/s.
        speed_mps: f64,
        /// It stays at the person for so long, s.
        secs: f64,
    },
    /// Keeps out of reach.
    Park,
}

/// A path that somebody is led or carried along, from where the object is.
#[derive(Debug, Clone, PartialEq)]
pub struct Course {
    /// The places of the object on the floor, one after another, the first after its own.
    pub path: Vec<Floor>,
    /// No faster than this, m/s.
    pub speed_mps: f64,
}

/// A way from a state, in terms of `R`: ids as described, indices once built.
#[derive(Debug, Clone, PartialEq)]
pub struct Transition<R> {
    /// What sets it off, any of these; none: its condition alone.
    pub on: Vec<Trigger<R>>,
    /// What must hold besides.
    pub when: Option<Condition<R>>,
    /// The state that it leads to; none: it stays, and is not entered anew.
    pub to: Option<R>,
    /// Done on the way, in this order.
    pub acts: Vec<Act<R>>,
}

/// Something that happens at one moment.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Trigger<R> {
    /// Somebody's hand met the object.
    TouchBegan(R),
    /// Somebody's hand let go of the object.
    TouchEnded(R),
    /// Somebody came into the zone.
    ZoneEntered(R),
    /// Somebody went out of the zone.
    ZoneLeft(R),
    /// What the column does at the object came to its end.
    InteractionDone(R),
    /// A VR client said this name.
    ClientEvent(R),
    /// The game master gave this cue.
    Cue(R),
}

/// Something that holds or does not. People are not told apart: it holds if it holds for anybody.
#[derive(Debug, Clone, PartialEq)]
pub enum Condition<R> {
    /// Somebody has touched the object for so long without a break, counted from the entry of the state at the earliest.
    Touching {
        /// The object.
        object: R,
        /// s.
        secs: f64,
    },
    /// Somebody is in the zone.
    InZone(R),
    /// Somebody has looked at the object for so long without a break, counted from the entry of the state at the earliest.
    LooksAt {
        /// The object.
        object: R,
        /// s.
        secs: f64,
    },
    /// The column stands still where it serves the object.
    InPlace(R),
    /// The state has lasted for so long, s.
    TimeInState(f64),
    /// A variable compares so.
    Variable {
        /// The variable.
        variable: R,
        /// How.
        is: Comparison,
        /// With what.
        value: Value,
    },
    /// All of them.
    All(Vec<Condition<R>>),
    /// At least one of them.
    Any(Vec<Condition<R>>),
    /// It does not hold.
    Not(Box<Condition<R>>),
}

/// How a variable compares with a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Comparison {
    /// `==`
    Equal,
    /// `!=`
    NotEqual,
    /// `<`; numbers alone.
    Less,
    /// `<=`; numbers alone.
    AtMost,
    /// `>`; numbers alone.
    Greater,
    /// `>=`; numbers alone.
    AtLeast,
}

/// What is done to a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Act<R> {
    /// Give it this value.
    Set {
        /// The variable.
        variable: R,
        /// Of its kind.
        value: Value,
    },
    /// Add to it; numbers alone. It stops at [`MOST_INTEGER`](super::MOST_INTEGER) either way.
    Add {
        /// The variable.
        variable: R,
        /// How much.
        amount: i64,
    },
}

/// What is wrong with a scenario, and where.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ScenarioProblem {
    /// Where, from the scenario on: `states[2].transitions[0].to`.
    pub path: String,
    /// What was found.
    pub found: String,
    /// What was expected.
    pub expected: String,
}

impl Value {
    /// As a number: yes is 1.
    pub const fn number(self) -> i64 {
        match self {
            Self::Integer(number) => number,
            Self::Boolean(yes) => yes as i64,
        }
    }

    /// The number as a value of the same kind.
    pub const fn like(self, number: i64) -> Self {
        match self {
            Self::Integer(_) => Self::Integer(number),
            Self::Boolean(_) => Self::Boolean(number != 0),
        }
    }
}

impl std::fmt::Display for Value {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Integer(number) => write!(f, "{number}"),
            Self::Boolean(yes) => write!(f, "{yes}"),
        }
    }
}

impl Interaction {
    /// Its name in JSON.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Hold => "hold",
            Self::StepBack { .. } => "step_back",
            Self::Lead(_) => "lead",
            Self::Transport(_) => "transport",
            Self::Brush { .. } => "brush",
            Self::Park => "park",
        }
    }

    /// A moving column touches somebody in it (R14).
    pub const fn is_contact(&self) -> bool {
        matches!(self, Self::Lead(_) | Self::Transport(_) | Self::Brush { .. })
    }
}

impl Prior {
    /// Always the same.
    pub const fn constant(value: f64) -> Self {
        Self { value, per_s: 0.0, per_touch: 0.0, least: 0.0, most: 1.0 }
    }

    /// After so long in the state and so many touches.
    pub fn after(&self, in_state_secs: f64, touches: u32) -> f64 {
        let changed = self.value + self.per_s * in_state_secs + self.per_touch * f64::from(touches);
        changed.clamp(self.least, self.most)
    }
}

impl Comparison {
    /// Its sign in JSON.
    pub const fn sign(self) -> &'static str {
        match self {
            Self::Equal => "==",
            Self::NotEqual => "!=",
            Self::Less => "<",
            Self::AtMost => "<=",
            Self::Greater => ">",
            Self::AtLeast => ">=",
        }
    }

    /// It needs an order, which yes and no have not.
    pub const fn needs_order(self) -> bool {
        !matches!(self, Self::Equal | Self::NotEqual)
    }

    /// Whether it holds.
    pub const fn holds(self, left: i64, right: i64) -> bool {
        match self {
            Self::Equal => left == right,
            Self::NotEqual => left != right,
            Self::Less => left < right,
            Self::AtMost => left <= right,
            Self::Greater => left > right,
            Self::AtLeast => left >= right,
        }
    }
}

impl<R> Condition<R> {
    /// Every part of it, itself first.
    pub fn visit<'a>(&'a self, seen: &mut impl FnMut(&'a Self)) {
        seen(self);
        match self {
            Self::All(parts) | Self::Any(parts) => parts.iter().for_each(|part| part.visit(seen)),
            Self::Not(part) => part.visit(seen),
            _ => {}
        }
    }
}
