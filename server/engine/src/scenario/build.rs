//! From a description to a scenario: references resolved, values of the right kind, no endless macrostep. Every problem is
//! reported, not the first alone.

use std::fmt::Display;
use std::sync::Arc;

use super::spec::{
    Act, Condition, Interaction, Prior, ScenarioProblem, ScenarioSpec, StateSpec, Transition, Trigger, Value,
};
use super::{LONGEST_SECS, MOST_INTEGER, Scenario, State, Variable, cycles};

/// The ids of a scene that a scenario may speak of, in the scene's order.
#[derive(Debug, Clone, Copy)]
pub struct Names<'a> {
    /// Of objects.
    pub objects: &'a [&'a str],
    /// Of zones.
    pub zones: &'a [&'a str],
}

impl Scenario {
    /// Check and build.
    pub fn build(spec: &ScenarioSpec, names: Names<'_>) -> Result<Self, Vec<ScenarioProblem>> {
        let mut builder =
            Builder { spec, names, cues: Vec::new(), client_events: Vec::new(), problems: Vec::new() };
        let scenario = builder.scenario();
        if builder.problems.is_empty() {
            builder.problems.extend(cycles::find(&scenario));
        }
        if builder.problems.is_empty() { Ok(scenario) } else { Err(builder.problems) }
    }
}

struct Builder<'a> {
    spec: &'a ScenarioSpec,
    names: Names<'a>,
    cues: Vec<Arc<str>>,
    client_events: Vec<Arc<str>>,
    problems: Vec<ScenarioProblem>,
}

impl Builder<'_> {
    fn scenario(&mut self) -> Scenario {
        let spec = self.spec;
        self.count("variables", spec.variables.len(), 0, MOST_VARIABLES);
        self.count("states", spec.states.len(), 1, MOST_STATES);
        self.own_ids("variables", spec.variables.iter().map(|variable| variable.id.as_str()));
        self.own_ids("states", spec.states.iter().map(|state| state.id.as_str()));
        for (i, variable) in spec.variables.iter().enumerate() {
            self.value(&format!("variables[{i}].start"), variable.start);
        }
        let initial = self.state("initial", &spec.initial);
        let states =
            spec.states.iter().enumerate().map(|(i, state)| self.build_state(&format!("states[{i}]"), state));
        let states: Vec<State> = states.collect();
        let anywhere = self.transitions("anywhere", &spec.anywhere);
        let (mut looks, mut places) = (Vec::new(), Vec::new());
        for way in states.iter().flat_map(|state| &state.transitions).chain(&anywhere) {
            way.when.iter().for_each(|when| {
                when.visit(&mut |part| match part {
                    Condition::LooksAt { object, .. } => looks.push(*object),
                    Condition::InPlace(object) => places.push(*object),
                    _ => {}
                });
            });
        }
        for watched in [&mut looks, &mut places] {
            watched.sort_unstable();
            watched.dedup();
        }
        let variables = spec.variables.iter();
        let variables = variables.map(|v| Variable { id: v.id.as_str().into(), start: v.start }).collect();
        Scenario {
            initial,
            variables,
            states,
            anywhere,
            cues: std::mem::take(&mut self.cues),
            client_events: std::mem::take(&mut self.client_events),
            looks,
            places,
        }
    }

    fn build_state(&mut self, at: &str, state: &StateSpec) -> State {
        let objects = self.names.objects.len();
        let mut enabled = vec![false; objects];
        for (i, id) in state.enabled.iter().enumerate() {
            let path = format!("{at}.enabled[{i}]");
            if let Some(object) = self.object(&path, id)
                && std::mem::replace(&mut enabled[object], true)
            {
                self.add(path, quoted(id), "each object once");
            }
        }
        let mut priors = vec![None; objects];
        for (id, prior) in &state.priors {
            let path = format!("{at}.priors.{id}");
            self.prior(&path, prior);
            if let Some(object) = self.object(&path, id) {
                if !enabled[object] {
                    self.add(
                        path,
                        "a prior of an object that is not enabled here",
                        "an object of this state's `enabled`",
                    );
                }
                priors[object] = Some(*prior);
            }
        }
        let mut interactions = vec![None; objects];
        for (id, interaction) in &state.interactions {
            let path = format!("{at}.interactions.{id}");
            if let Some(object) = self.object(&path, id) {
                interactions[object] = Some(interaction.clone());
            }
            self.interaction(&path, interaction);
        }
        let entry = self.acts(&format!("{at}.entry"), &state.entry);
        let transitions = self.transitions(&format!("{at}.transitions"), &state.transitions);
        if state.is_final && !transitions.is_empty() {
            let found = format!("{} transitions", transitions.len());
            self.add(format!("{at}.transitions"), found, "none: the scenario ends in a final state");
        }
        State {
            id: state.id.as_str().into(),
            enabled,
            priors,
            interactions,
            entry,
            transitions,
            is_final: state.is_final,
        }
    }

    fn prior(&mut self, at: &str, prior: &Prior) {
        for (key, share) in [("value", prior.value), ("least", prior.least), ("most", prior.most)] {
            if !(0.0..=1.0).contains(&share) {
                self.add(format!("{at}.{key}"), share, "a number from 0 to 1");
            }
        }
        for (key, change) in [("per_s", prior.per_s), ("per_touch", prior.per_touch)] {
            if !(-1.0..=1.0).contains(&change) {
                self.add(format!("{at}.{key}"), change, "a number from -1 to 1");
            }
        }
        if !(prior.least <= prior.value && prior.value <= prior.most) {
            let found = format!("{} to {} with a value of {}", prior.least, prior.most, prior.value);
            self.add(at, found, "least, value and most in this order");
        }
    }

    fn interaction(&mut self, at: &str, interaction: &Interaction) {
        match interaction {
            Interaction::Hold | Interaction::Park => {}
            Interaction::StepBack { distance_m } => {
                self.range(format!("{at}.distance"), *distance_m, LEAST_STEP_BACK_M, MOST_STEP_BACK_M, "m");
            }
            Interaction::Lead(course) | Interaction::Transport(course) => {
                self.count(&format!("{at}.path"), course.path.len(), 1, MOST_PATH_PLACES);
                for (i, place) in course.path.iter().enumerate() {
                    if !place.is_finite() {
                        self.add(
                            format!("{at}.path[{i}]"),
                            "a coordinate that is not finite",
                            "finite metres",
                        );
                    }
                }
                self.range(
                    format!("{at}.speed"),
                    course.speed_mps,
                    LEAST_SPEED_MPS,
                    MOST_COURSE_MPS,
                    "m/s (R14)",
                );
            }
            Interaction::Brush { speed_mps, secs } => {
                self.range(format!("{at}.speed"), *speed_mps, LEAST_SPEED_MPS, MOST_BRUSH_MPS, "m/s (R14)");
                self.range(format!("{at}.secs"), *secs, 0.0, MOST_BRUSH_SECS, "s");
            }
        }
    }

    fn range(&mut self, at: String, found: f64, least: f64, most: f64, unit: &str) {
        if !(least..=most).contains(&found) {
            self.add(at, found, format!("a number from {least} to {most} {unit}"));
        }
    }

    fn transitions(&mut self, at: &str, transitions: &[Transition<String>]) -> Vec<Transition<usize>> {
        self.count(at, transitions.len(), 0, MOST_TRANSITIONS);
        transitions.iter().enumerate().map(|(i, way)| self.transition(&format!("{at}[{i}]"), way)).collect()
    }

    fn transition(&mut self, at: &str, way: &Transition<String>) -> Transition<usize> {
        self.count(&format!("{at}.on"), way.on.len(), 0, MOST_TRIGGERS);
        let on = way.on.iter().enumerate();
        let on = on.map(|(i, trigger)| self.trigger(&format!("{at}.on[{i}]"), trigger)).collect();
        if let Some(when) = &way.when {
            let mut parts = 0;
            when.visit(&mut |_| parts += 1);
            self.count(&format!("{at}.when"), parts, 1, MOST_CONDITIONS);
        }
        let when = way.when.as_ref().map(|when| self.condition(&format!("{at}.when"), when));
        if way.on.is_empty() && way.to.is_none() {
            self.add(
                at,
                "neither `on` nor `to`",
                "a state that it leads to, or what sets it off: it would be taken without end",
            );
        }
        let to = way.to.as_ref().map(|to| self.state(&format!("{at}.to"), to));
        let acts = self.acts(&format!("{at}.acts"), &way.acts);
        Transition { on, when, to, acts }
    }

    fn trigger(&mut self, at: &str, trigger: &Trigger<String>) -> Trigger<usize> {
        match trigger {
            Trigger::TouchBegan(id) => {
                Trigger::TouchBegan(self.object(&format!("{at}.object"), id).unwrap_or(0))
            }
            Trigger::TouchEnded(id) => {
                Trigger::TouchEnded(self.object(&format!("{at}.object"), id).unwrap_or(0))
            }
            Trigger::InteractionDone(id) => {
                Trigger::InteractionDone(self.object(&format!("{at}.object"), id).unwrap_or(0))
            }
            Trigger::ZoneEntered(id) => Trigger::ZoneEntered(self.zone(&format!("{at}.zone"), id)),
            Trigger::ZoneLeft(id) => Trigger::ZoneLeft(self.zone(&format!("{at}.zone"), id)),
            Trigger::ClientEvent(name) => {
                self.length(format!("{at}.name"), name);
                Trigger::ClientEvent(interned(&mut self.client_events, name))
            }
            Trigger::Cue(name) => {
                self.length(format!("{at}.name"), name);
                Trigger::Cue(interned(&mut self.cues, name))
            }
        }
    }

    fn condition(&mut self, at: &str, condition: &Condition<String>) -> Condition<usize> {
        match condition {
            Condition::Touching { object, secs } => {
                self.secs(&format!("{at}.secs"), *secs);
                let object = self.object(&format!("{at}.object"), object).unwrap_or(0);
                Condition::Touching { object, secs: *secs }
            }
            Condition::LooksAt { object, secs } => {
                self.secs(&format!("{at}.secs"), *secs);
                let object = self.object(&format!("{at}.object"), object).unwrap_or(0);
                Condition::LooksAt { object, secs: *secs }
            }
            Condition::InZone(zone) => Condition::InZone(self.zone(&format!("{at}.zone"), zone)),
            Condition::InPlace(object) => {
                Condition::InPlace(self.object(&format!("{at}.object"), object).unwrap_or(0))
            }
            Condition::TimeInState(secs) => {
                self.secs(&format!("{at}.secs"), *secs);
                Condition::TimeInState(*secs)
            }
            Condition::Variable { variable, is, value } => {
                let index = self.variable(&format!("{at}.variable"), variable);
                self.of_kind(&format!("{at}.value"), index, *value);
                if is.needs_order() && matches!(value, Value::Boolean(_)) {
                    self.add(
                        format!("{at}.is"),
                        quoted(is.sign()),
                        "\"==\" or \"!=\": true and false have no order",
                    );
                }
                Condition::Variable { variable: index.unwrap_or(0), is: *is, value: *value }
            }
            Condition::All(parts) => Condition::All(self.conditions(at, parts)),
            Condition::Any(parts) => Condition::Any(self.conditions(at, parts)),
            Condition::Not(part) => {
                Condition::Not(Box::new(self.condition(&format!("{at}.condition"), part)))
            }
        }
    }

    fn conditions(&mut self, at: &str, parts: &[Condition<String>]) -> Vec<Condition<usize>> {
        self.count(&format!("{at}.conditions"), parts.len(), 1, MOST_CONDITIONS);
        let each = parts.iter().enumerate();
        each.map(|(i, part)| self.condition(&format!("{at}.conditions[{i}]"), part)).collect()
    }

    fn acts(&mut self, at: &str, acts: &[Act<String>]) -> Vec<Act<usize>> {
        self.count(at, acts.len(), 0, MOST_ACTS);
        let each = acts.iter().enumerate();
        each.map(|(i, act)| self.act(&format!("{at}[{i}]"), act)).collect()
    }

    fn act(&mut self, at: &str, act: &Act<String>) -> Act<usize> {
        match act {
            Act::Set { variable, value } => {
                let index = self.variable(&format!("{at}.variable"), variable);
                self.value(&format!("{at}.value"), *value);
                self.of_kind(&format!("{at}.value"), index, *value);
                Act::Set { variable: index.unwrap_or(0), value: *value }
            }
            Act::Add { variable, amount } => {
                let index = self.variable(&format!("{at}.variable"), variable);
                self.value(&format!("{at}.amount"), Value::Integer(*amount));
                if index.is_some_and(|i| matches!(self.spec.variables[i].start, Value::Boolean(_))) {
                    self.add(format!("{at}.variable"), quoted(variable), "a variable that is a number");
                }
                Act::Add { variable: index.unwrap_or(0), amount: *amount }
            }
        }
    }

    fn object(&mut self, at: &str, id: &str) -> Option<usize> {
        let found = self.names.objects.iter().position(|known| *known == id);
        if found.is_none() {
            self.unknown(at, id, "an object of this scene", self.names.objects.iter().copied());
        }
        found
    }

    fn zone(&mut self, at: &str, id: &str) -> usize {
        self.names.zones.iter().position(|known| *known == id).unwrap_or_else(|| {
            self.unknown(at, id, "a zone of this scene", self.names.zones.iter().copied());
            0
        })
    }

    fn state(&mut self, at: &str, id: &str) -> usize {
        let states = &self.spec.states;
        states.iter().position(|known| known.id == id).unwrap_or_else(|| {
            self.unknown(at, id, "a state of this scenario", states.iter().map(|state| state.id.as_str()));
            0
        })
    }

    fn variable(&mut self, at: &str, id: &str) -> Option<usize> {
        let variables = &self.spec.variables;
        let found = variables.iter().position(|known| known.id == id);
        if found.is_none() {
            self.unknown(at, id, "a variable of this scenario", variables.iter().map(|v| v.id.as_str()));
        }
        found
    }

    fn unknown<'n>(&mut self, at: &str, id: &str, what: &str, known: impl Iterator<Item = &'n str>) {
        let mut named: Vec<String> = known.take(MOST_NAMED + 1).map(quoted).collect();
        if named.len() > MOST_NAMED {
            named[MOST_NAMED] = "…".into();
        }
        let expected = if named.is_empty() {
            format!("{what}, which has none")
        } else {
            format!("{what}: {}", named.join(", "))
        };
        self.add(at, quoted(id), expected);
    }

    fn of_kind(&mut self, at: &str, variable: Option<usize>, value: Value) {
        let Some(start) = variable.map(|i| self.spec.variables[i].start) else { return };
        match (start, value) {
            (Value::Integer(_), Value::Boolean(_)) => {
                self.add(at, value, "a whole number, as the variable is")
            }
            (Value::Boolean(_), Value::Integer(_)) => {
                self.add(at, value, "true or false, as the variable is")
            }
            _ => {}
        }
    }

    fn value(&mut self, at: &str, value: Value) {
        if !(-MOST_INTEGER..=MOST_INTEGER).contains(&value.number()) {
            self.add(at, value, format!("a whole number from -{MOST_INTEGER} to {MOST_INTEGER}"));
        }
    }

    fn secs(&mut self, at: &str, secs: f64) {
        if !(0.0..=LONGEST_SECS).contains(&secs) {
            self.add(at, secs, format!("a number from 0 to {LONGEST_SECS}"));
        }
    }

    fn own_ids<'n>(&mut self, at: &str, ids: impl Iterator<Item = &'n str>) {
        let mut seen: Vec<&str> = Vec::new();
        for (i, id) in ids.enumerate() {
            self.length(format!("{at}[{i}].id"), id);
            if let Some(first) = seen.iter().position(|known| *known == id) {
                let found = format!("{}, already the id of {at}[{first}]", quoted(id));
                self.add(format!("{at}[{i}].id"), found, "an id of its own");
            }
            seen.push(id);
        }
    }

    fn length(&mut self, at: String, id: &str) {
        let chars = id.chars().count();
        if !(1..=64).contains(&chars) {
            self.add(at, format!("{chars} characters"), "1 to 64 characters");
        }
    }

    fn count(&mut self, at: &str, count: usize, least: usize, most: usize) {
        if !(least..=most).contains(&count) {
            self.add(at, format!("{count} of them"), format!("{least} to {most}"));
        }
    }

    fn add(&mut self, path: impl Into<String>, found: impl Display, expected: impl Display) {
        let (found, expected) = (found.to_string(), expected.to_string());
        self.problems.push(ScenarioProblem { path: path.into(), found, expected });
    }
}

fn interned(names: &mut Vec<Arc<str>>, name: &str) -> usize {
    names.iter().position(|known| &**known == name).unwrap_or_else(|| {
        names.push(name.into());
        names.len() - 1
    })
}

fn quoted(text: &str) -> String {
    format!("\"{text}\"")
}

/// States of a scenario.
const MOST_STATES: usize = 200;
/// Ways from a state, and from anywhere.
const MOST_TRANSITIONS: usize = 50;
/// What may set a transition off.
const MOST_TRIGGERS: usize = 20;
/// Parts of one condition.
const MOST_CONDITIONS: usize = 50;
/// Acts in a row.
const MOST_ACTS: usize = 20;
/// Variables: it is a small memory, not a program's.
const MOST_VARIABLES: usize = 32;
/// Ids that a problem lists.
const MOST_NAMED: usize = 10;
/// Places of a path.
const MOST_PATH_PLACES: usize = 100;
/// A step back, m.
const LEAST_STEP_BACK_M: f64 = 0.05;
const MOST_STEP_BACK_M: f64 = 3.0;
/// Slower than this is no motion that anybody means, m/s.
const LEAST_SPEED_MPS: f64 = 0.05;
/// R14, m/s: lead and transport.
const MOST_COURSE_MPS: f64 = 0.6;
/// R14, m/s: brush.
const MOST_BRUSH_MPS: f64 = 0.3;
/// A brush lasts no longer, s.
const MOST_BRUSH_SECS: f64 = 10.0;
