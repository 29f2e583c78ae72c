//! From the document to the engine's description.

use covr_engine::frames::Floor;
use covr_engine::scenario::{
    Act, Comparison, Condition, Course, Interaction, Prior, ScenarioSpec, StateSpec, Transition, Trigger,
    Value, VariableSpec,
};

use super::{
    ActDocument, ChangingPriorDocument, ComparisonDocument, ConditionDocument, InteractionDocument,
    PriorDocument, ScenarioDocument, StateDocument, TransitionDocument, TriggerDocument, ValueDocument,
};

/// The engine's description.
pub fn spec(document: &ScenarioDocument) -> ScenarioSpec {
    let variable = |variable: &super::VariableDocument| VariableSpec {
        id: variable.id.clone(),
        start: value(variable.start),
    };
    ScenarioSpec {
        initial: document.initial.clone(),
        variables: document.variables.iter().map(variable).collect(),
        states: document.states.iter().map(state).collect(),
        anywhere: document.anywhere.iter().map(transition).collect(),
    }
}

fn state(state: &StateDocument) -> StateSpec {
    let interactions = state.interactions.iter();
    StateSpec {
        id: state.id.clone(),
        enabled: state.enabled.clone(),
        priors: state.priors.iter().map(|(id, document)| (id.clone(), prior(*document))).collect(),
        interactions: interactions.map(|(id, document)| (id.clone(), interaction(document))).collect(),
        entry: state.entry.iter().map(act).collect(),
        transitions: state.transitions.iter().map(transition).collect(),
        is_final: state.is_final,
    }
}

fn transition(document: &TransitionDocument) -> Transition<String> {
    Transition {
        on: document.on.iter().map(trigger).collect(),
        when: document.when.as_ref().map(condition),
        to: document.to.clone(),
        acts: document.acts.iter().map(act).collect(),
    }
}

fn trigger(document: &TriggerDocument) -> Trigger<String> {
    match document.clone() {
        TriggerDocument::TouchBegan { object } => Trigger::TouchBegan(object),
        TriggerDocument::TouchEnded { object } => Trigger::TouchEnded(object),
        TriggerDocument::ZoneEntered { zone } => Trigger::ZoneEntered(zone),
        TriggerDocument::ZoneLeft { zone } => Trigger::ZoneLeft(zone),
        TriggerDocument::InteractionDone { object } => Trigger::InteractionDone(object),
        TriggerDocument::ClientEvent { name } => Trigger::ClientEvent(name),
        TriggerDocument::Cue { name } => Trigger::Cue(name),
    }
}

fn condition(document: &ConditionDocument) -> Condition<String> {
    match document {
        ConditionDocument::Touching { object, secs } => {
            Condition::Touching { object: object.clone(), secs: *secs }
        }
        ConditionDocument::InZone { zone } => Condition::InZone(zone.clone()),
        ConditionDocument::LooksAt { object, secs } => {
            Condition::LooksAt { object: object.clone(), secs: *secs }
        }
        ConditionDocument::InPlace { object } => Condition::InPlace(object.clone()),
        ConditionDocument::TimeInState { secs } => Condition::TimeInState(*secs),
        ConditionDocument::Variable { variable, is, value: with } => {
            Condition::Variable { variable: variable.clone(), is: comparison(*is), value: value(*with) }
        }
        ConditionDocument::All { conditions } => Condition::All(conditions.iter().map(condition).collect()),
        ConditionDocument::Any { conditions } => Condition::Any(conditions.iter().map(condition).collect()),
        ConditionDocument::Not { condition: inner } => Condition::Not(Box::new(condition(inner))),
    }
}

fn act(document: &ActDocument) -> Act<String> {
    match document {
        ActDocument::Set { variable, value: to } => {
            Act::Set { variable: variable.clone(), value: value(*to) }
        }
        ActDocument::Add { variable, amount } => Act::Add { variable: variable.clone(), amount: *amount },
    }
}

const fn value(document: ValueDocument) -> Value {
    match document {
        ValueDocument::Integer(number) => Value::Integer(number),
        ValueDocument::Boolean(yes) => Value::Boolean(yes),
    }
}

const fn prior(document: PriorDocument) -> Prior {
    match document {
        PriorDocument::Constant(value) => Prior::constant(value),
        PriorDocument::Changing(ChangingPriorDocument { value, per_s, per_touch, least, most }) => {
            Prior { value, per_s, per_touch, least, most }
        }
    }
}

fn interaction(document: &InteractionDocument) -> Interaction {
    let course = |path: &[[f64; 2]], speed_mps| Course {
        path: path.iter().map(|[x, y]| Floor::new(*x, *y)).collect(),
        speed_mps,
    };
    match document {
        InteractionDocument::Hold => Interaction::Hold,
        InteractionDocument::StepBack { distance } => Interaction::StepBack { distance_m: *distance },
        InteractionDocument::Lead { path, speed } => Interaction::Lead(course(path, *speed)),
        InteractionDocument::Transport { path, speed } => Interaction::Transport(course(path, *speed)),
        InteractionDocument::Brush { speed, secs } => Interaction::Brush { speed_mps: *speed, secs: *secs },
        InteractionDocument::Park => Interaction::Park,
    }
}

const fn comparison(document: ComparisonDocument) -> Comparison {
    match document {
        ComparisonDocument::Equal => Comparison::Equal,
        ComparisonDocument::NotEqual => Comparison::NotEqual,
        ComparisonDocument::Less => Comparison::Less,
        ComparisonDocument::AtMost => Comparison::AtMost,
        ComparisonDocument::Greater => Comparison::Greater,
        ComparisonDocument::AtLeast => Comparison::AtLeast,
    }
}

impl From<Value> for ValueDocument {
    fn from(value: Value) -> Self {
        match value {
            Value::Integer(number) => Self::Integer(number),
            Value::Boolean(yes) => Self::Boolean(yes),
        }
    }
}
