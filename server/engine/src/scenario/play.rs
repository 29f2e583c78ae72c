//! A scenario being played: its state, its variables, its clock.
//!
//! The clock runs while the machine follows people and at no other time. While it stands, levels are kept up to date (a hand lets go all
//! the same) and no transition is taken; whoever runs the engine says when.

use std::sync::Arc;

use super::condition::Now;
use super::senses::Senses;
use super::spec::{Act, Transition, Trigger, Value};
use super::{MOST_INTEGER, Scenario};
use crate::observation::PersonId;
use crate::time::Span;

/// A scenario being played. Same happenings in the same order, same states.
#[derive(Debug, Clone, PartialEq)]
pub struct Play {
    state: usize,
    variables: Vec<i64>,
    clock: Span,
    entered_at: Span,
    /// By object, since the state was entered.
    touches: Vec<u32>,
    senses: Senses,
    /// States entered in this run, with the variables before each; the last is the present one.
    entries: Vec<(usize, Vec<i64>)>,
    /// Counts the states entered, over all runs.
    stay: u64,
    /// Eventless transitions wait for something to happen: they went in a circle.
    is_cut: bool,
    /// Where the last run ended, if it got beyond its beginning.
    left_in: Option<usize>,
}

/// Something that happened.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Happening {
    /// What.
    pub trigger: Trigger<usize>,
    /// By whom, where it is somebody's.
    pub person: Option<PersonId>,
}

/// What a run did.
#[derive(Debug, Clone, PartialEq)]
pub enum Change {
    /// A state was entered.
    Entered {
        /// Before; none: the run begins.
        from: Option<Arc<str>>,
        /// The state.
        to: Arc<str>,
        /// Why.
        why: WhyEntered,
    },
    /// Eventless transitions went in a circle and wait now for something to happen.
    Cut(Arc<str>),
}

/// Why a state was entered.
#[derive(Debug, Clone, PartialEq)]
pub enum WhyEntered {
    /// The run begins.
    Began,
    /// Something happened.
    Happened(Happening),
    /// A condition held.
    ConditionHeld,
    /// A game master skipped there, for this reason.
    Skipped(String),
    /// A game master went back, for this reason.
    Rewound(String),
}

/// Where a run stands, for people.
#[derive(Debug, Clone, PartialEq)]
pub struct PlayState {
    /// Index of the state.
    pub state: usize,
    /// For how long, on the scenario's clock.
    pub in_state: Span,
    /// States entered in this run.
    pub entered: usize,
    /// By variable.
    pub variables: Vec<Value>,
    /// The ways on from here, in the order in which they are looked at.
    pub next: Vec<NextTransition>,
    /// Where the last run ended.
    pub left_in: Option<usize>,
    /// Its transitions went in a circle.
    pub is_cut: bool,
}

/// A way on.
#[derive(Debug, Clone, PartialEq)]
pub struct NextTransition {
    /// It is one of those from anywhere.
    pub is_from_anywhere: bool,
    /// Its index there, or among the state's own.
    pub index: usize,
    /// Index of the state that it leads to; none: it stays.
    pub to: Option<usize>,
    /// In how many seconds its condition holds if everybody goes on with what they do; 0: it does, infinite: not by time alone.
    pub due_secs: f64,
}

impl Play {
    /// At the beginning, with the acts of the initial state done.
    pub fn new(scenario: &Scenario, objects: usize) -> Self {
        let mut play = Self {
            state: scenario.initial,
            variables: Vec::new(),
            clock: Span::ZERO,
            entered_at: Span::ZERO,
            touches: vec![0; objects],
            senses: Senses::default(),
            entries: Vec::new(),
            stay: 0,
            is_cut: false,
            left_in: None,
        };
        play.restart(scenario);
        play
    }

    /// The run is over: the next begins where the scenario begins. What is known of people stays.
    pub fn restart(&mut self, scenario: &Scenario) {
        self.left_in = Some(self.state).filter(|state| *state != scenario.initial);
        self.clock = Span::ZERO;
        self.senses.restart();
        self.variables = scenario.variables.iter().map(|variable| variable.start.number()).collect();
        self.entries.clear();
        self.enter(scenario, scenario.initial);
    }

    /// The state.
    pub fn state(&self) -> usize {
        self.state
    }

    /// The run begins where it stands.
    pub fn begin(&mut self, scenario: &Scenario) -> Change {
        self.left_in = None;
        Change::Entered { from: None, to: scenario.states[self.state].id.clone(), why: WhyEntered::Began }
    }

    /// What is known of people and column, for whoever looks at them.
    pub fn senses_mut(&mut self) -> &mut Senses {
        &mut self.senses
    }

    /// What is known of people and column.
    pub fn senses(&self) -> &Senses {
        &self.senses
    }

    /// The number of this stay in a state: whoever remembers something of a state knows by it that it was left, also for itself.
    pub fn stay(&self) -> u64 {
        self.stay
    }

    /// The scenario's clock.
    pub fn clock(&self) -> Span {
        self.clock
    }

    /// The prior of an object; none: the scene's.
    ///
    /// Read on the scenario's clock in tenths of a second: intention need not weigh anew with every step.
    pub fn prior(&self, scenario: &Scenario, object: usize) -> Option<f64> {
        let prior = scenario.states[self.state].priors.get(object).copied().flatten()?;
        let tenths = self.in_state().micros() / TENTH.micros();
        Some(prior.after(tenths as f64 * TENTH.secs(), self.touches.get(object).copied().unwrap_or(0)))
    }

    /// A hand met an object: counted for its prior, and a macrostep when it is the first of this person at it.
    pub fn touch(&mut self, scenario: &Scenario, person: PersonId, object: usize, runs: bool) -> Vec<Change> {
        if !self.senses.touch(person, object, self.clock) {
            return Vec::new();
        }
        if runs && let Some(touches) = self.touches.get_mut(object) {
            *touches = touches.saturating_add(1);
        }
        self.happen(scenario, Happening { trigger: Trigger::TouchBegan(object), person: Some(person) }, runs)
            .1
    }

    /// A hand let go.
    pub fn let_go(
        &mut self,
        scenario: &Scenario,
        person: PersonId,
        object: usize,
        runs: bool,
    ) -> Vec<Change> {
        if !self.senses.let_go(person, object) {
            return Vec::new();
        }
        self.happen(scenario, Happening { trigger: Trigger::TouchEnded(object), person: Some(person) }, runs)
            .1
    }

    /// Something happened: one macrostep. Whether a transition was taken for it, and what it did.
    pub fn happen(&mut self, scenario: &Scenario, happening: Happening, runs: bool) -> (bool, Vec<Change>) {
        let mut changes = Vec::new();
        let way = self.first(scenario, Some(happening.trigger)).filter(|_| runs);
        if let Some(way) = way {
            self.take(scenario, way, WhyEntered::Happened(happening), &mut changes);
            self.is_cut = false;
        }
        if runs {
            self.settle(scenario, &mut changes);
        }
        (way.is_some(), changes)
    }

    /// Time passed: one macrostep of what needs no event.
    pub fn pass(&mut self, scenario: &Scenario, elapsed: Span) -> Vec<Change> {
        self.clock = self.clock + elapsed;
        let mut changes = Vec::new();
        self.settle(scenario, &mut changes);
        changes
    }

    /// A game master skips to a state. Variables stay as they are.
    pub fn skip(&mut self, scenario: &Scenario, to: usize, reason: String) -> Change {
        let from = self.state;
        self.enter(scenario, to);
        self.entered(scenario, from, WhyEntered::Skipped(reason))
    }

    /// A game master goes back to the state before, with the variables as they were when it was entered; none at the beginning.
    pub fn rewind(&mut self, scenario: &Scenario, reason: String) -> Option<Change> {
        let from = self.state;
        let (to, variables) = self.entries.len().checked_sub(2).map(|before| self.entries[before].clone())?;
        self.entries.truncate(self.entries.len() - 2);
        self.variables = variables;
        self.enter(scenario, to);
        Some(self.entered(scenario, from, WhyEntered::Rewound(reason)))
    }

    /// The state that a rewind would lead to.
    pub fn before(&self) -> Option<usize> {
        self.entries.len().checked_sub(2).map(|before| self.entries[before].0)
    }

    /// Where it stands.
    pub fn shown(&self, scenario: &Scenario) -> PlayState {
        let now = self.now();
        let next = scenario.ways(self.state).map(|(is_from_anywhere, index, way)| NextTransition {
            is_from_anywhere,
            index,
            to: way.to,
            due_secs: way.when.as_ref().map_or(0.0, |when| when.due_secs(&now)),
        });
        let variables = self.variables.iter().zip(&scenario.variables);
        PlayState {
            state: self.state,
            in_state: self.in_state(),
            entered: self.entries.len(),
            variables: variables.map(|(number, variable)| variable.start.like(*number)).collect(),
            next: next.collect(),
            left_in: self.left_in,
            is_cut: self.is_cut,
        }
    }

    /// Eventless transitions until none may be taken. In a scenario without cycles each state is entered once at most.
    fn settle(&mut self, scenario: &Scenario, changes: &mut Vec<Change>) {
        if self.is_cut {
            return;
        }
        for _ in 0..=scenario.states.len() {
            let Some(way) = self.first(scenario, None) else { return };
            self.take(scenario, way, WhyEntered::ConditionHeld, changes);
        }
        if self.first(scenario, None).is_some() {
            self.is_cut = true;
            changes.push(Change::Cut(scenario.states[self.state].id.clone()));
        }
    }

    /// The first transition that may be taken for this, in document order, the state's own first.
    fn first<'s>(
        &self,
        scenario: &'s Scenario,
        trigger: Option<Trigger<usize>>,
    ) -> Option<&'s Transition<usize>> {
        let now = self.now();
        let is_set_off = |way: &Transition<usize>| match trigger {
            Some(trigger) => way.on.contains(&trigger),
            None => way.on.is_empty(),
        };
        let holds = |way: &Transition<usize>| way.when.as_ref().is_none_or(|when| when.holds(&now));
        scenario.ways(self.state).map(|(_, _, way)| way).find(|way| is_set_off(way) && holds(way))
    }

    fn take(
        &mut self,
        scenario: &Scenario,
        way: &Transition<usize>,
        why: WhyEntered,
        changes: &mut Vec<Change>,
    ) {
        let from = self.state;
        way.acts.iter().for_each(|act| self.act(act));
        if let Some(to) = way.to {
            self.enter(scenario, to);
            changes.push(self.entered(scenario, from, why));
        }
    }

    fn enter(&mut self, scenario: &Scenario, to: usize) {
        if self.entries.len() == MOST_ENTRIES {
            self.entries.remove(0);
        }
        self.entries.push((to, self.variables.clone()));
        self.state = to;
        self.entered_at = self.clock;
        self.touches.fill(0);
        self.stay += 1;
        self.is_cut = false;
        scenario.states[to].entry.iter().for_each(|act| self.act(act));
    }

    fn entered(&self, scenario: &Scenario, from: usize, why: WhyEntered) -> Change {
        let id = |state: usize| scenario.states[state].id.clone();
        Change::Entered { from: Some(id(from)), to: id(self.state), why }
    }

    fn act(&mut self, act: &Act<usize>) {
        let Some(number) = self.variables.get_mut(act.variable()) else { return };
        *number = match act {
            Act::Set { value, .. } => value.number(),
            Act::Add { amount, .. } => number.saturating_add(*amount).clamp(-MOST_INTEGER, MOST_INTEGER),
        };
    }

    fn in_state(&self) -> Span {
        self.clock - self.entered_at
    }

    fn now(&self) -> Now<'_> {
        Now { senses: &self.senses, variables: &self.variables, in_state: self.in_state(), clock: self.clock }
    }
}

/// Priors are read so often.
const TENTH: Span = Span::from_millis(100);
/// States that a game master can go back by.
const MOST_ENTRIES: usize = 256;
