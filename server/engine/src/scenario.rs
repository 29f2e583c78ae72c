//! The scenario of a scene: which objects can be served when, how likely each is, and what leads on.
//!
//! A statechart after SCXML (W3C, 2015), as much of it as a scene needs. Taken: atomic states under one root; entry acts;
//! transitions with events, a guard and acts; the state's own transitions before the root's (`anywhere`), in document order;
//! run to completion, one macrostep for each thing that happens, eventless transitions until none may be taken. Left out:
//! states inside states, parallel states, history, exit acts, events that the chart sends to itself, delays other than the time in
//! a state. A final state says that the scenario ends there.
//!
//! ```text
//!            something happens            nothing may be taken
//!   [state] ────────────────▶ take one ─────────────────────▶ [state]
//!                              ▲    │ eventless transitions whose
//!                              └────┘ guard holds, one after another
//! ```
//!
//! It knows ids, people and time, and no geometry: the engine tells it who is where and looks at what. It makes no motion: it says
//! which objects are enabled and their priors, and intention, motion and safety go on from there.

mod build;
mod check;
mod condition;
mod cycles;
mod formula;
mod play;
mod senses;
mod spec;

use std::sync::Arc;

pub use build::Names;
pub use check::{Finding, Stage};
pub use play::{Change, Happening, NextTransition, Play, PlayState, WhyEntered};
pub use senses::Senses;
pub use spec::{
    Act, Comparison, Condition, Course, Interaction, Prior, ScenarioProblem, ScenarioSpec, StateSpec,
    Transition, Trigger, Value, VariableSpec,
};

/// A scenario, right once built: every reference is to something that is there.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    initial: usize,
    variables: Vec<Variable>,
    states: Vec<State>,
    anywhere: Vec<Transition<usize>>,
    cues: Vec<Arc<str>>,
    client_events: Vec<Arc<str>>,
    looks: Vec<usize>,
    places: Vec<usize>,
}

/// A variable.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Variable {
    /// Its id.
    pub id: Arc<str>,
    /// Its value at the beginning.
    pub start: Value,
}

/// A state.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    id: Arc<str>,
    /// By object.
    enabled: Vec<bool>,
    /// By object; none: the scene's.
    priors: Vec<Option<Prior>>,
    /// By object.
    interactions: Vec<Option<Interaction>>,
    entry: Vec<Act<usize>>,
    transitions: Vec<Transition<usize>>,
    is_final: bool,
}

impl Scenario {
    /// The states, in the scenario's order.
    pub fn states(&self) -> &[State] {
        &self.states
    }

    /// Where it begins.
    pub fn initial(&self) -> usize {
        self.initial
    }

    /// The state of this id.
    pub fn state_of(&self, id: &str) -> Option<usize> {
        self.states.iter().position(|state| &*state.id == id)
    }

    /// The variables, in the scenario's order.
    pub fn variables(&self) -> &[Variable] {
        &self.variables
    }

    /// Every cue that a transition waits for.
    pub fn cues(&self) -> &[Arc<str>] {
        &self.cues
    }

    /// The cue of this name.
    pub fn cue_of(&self, name: &str) -> Option<usize> {
        self.cues.iter().position(|known| &**known == name)
    }

    /// Every client event that a transition waits for.
    pub fn client_events(&self) -> &[Arc<str>] {
        &self.client_events
    }

    /// The client event of this name.
    pub fn client_event_of(&self, name: &str) -> Option<usize> {
        self.client_events.iter().position(|known| &**known == name)
    }

    /// Objects that some condition wants looked at.
    pub fn looks(&self) -> &[usize] {
        &self.looks
    }

    /// Objects that some condition wants the column at.
    pub fn places(&self) -> &[usize] {
        &self.places
    }

    /// The ways from a state: its own, then those from anywhere. Each with whether it is from anywhere, and its index there.
    /// A way from anywhere that waits for nothing does not lead from its own target, or it would lead there without end.
    fn ways(&self, state: usize) -> impl Iterator<Item = (bool, usize, &Transition<usize>)> {
        let own = self.states.get(state).map_or(&[][..], |state| &state.transitions);
        let own = own.iter().enumerate().map(|(index, way)| (false, index, way));
        let root = self.anywhere.iter().enumerate().map(|(index, way)| (true, index, way));
        own.chain(root.filter(move |(_, _, way)| !(way.on.is_empty() && way.to == Some(state))))
    }
}

impl State {
    /// Its id.
    pub fn id(&self) -> &Arc<str> {
        &self.id
    }

    /// Which objects can be served in it.
    pub fn enabled(&self) -> &[bool] {
        &self.enabled
    }

    /// What the column does at each object in it.
    pub fn interactions(&self) -> &[Option<Interaction>] {
        &self.interactions
    }

    /// The scenario ends in it.
    pub fn is_final(&self) -> bool {
        self.is_final
    }
}

/// Whole numbers of a scenario are no greater than this, either way.
pub const MOST_INTEGER: i64 = 1_000_000;
/// The longest time that a condition may wait for, s.
pub const LONGEST_SECS: f64 = 3600.0;

#[cfg(test)]
mod tests;
