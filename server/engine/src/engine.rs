//! The engine: observe, request, step. It owns no clock; the caller says when it is.

use std::sync::Arc;

use crate::event::Event;
use crate::machine::{Limits, Travel};
use crate::mode::{Mode, RequestKind};
use crate::observation::{Observation, PersonId};
use crate::safety::vetted::{Action, Vetted};
use crate::scene::Scene;
use crate::snapshot::Snapshot;
use crate::time::{Span, Time};

/// What the engine is built with. Right once built.
#[derive(Debug, Clone, PartialEq)]
pub struct EngineConfig {
    /// The machine's limits.
    pub limits: Limits,
    /// The machine's travel, room frame.
    pub travel: Travel,
    /// Control period.
    pub period: Span,
    /// The intention rule, by name.
    pub intention_rule: String,
    /// v_h of the separation rule, m/s.
    pub v_h_mps: f64,
    /// Start latched, with this reason: the last run ended in a latched stop.
    pub latched_because: Option<String>,
}

/// What somebody asks.
#[derive(Debug, Clone)]
pub enum Request {
    /// Home, arm, disarm, stop, reset, with the reason given.
    Machine(RequestKind, Option<String>),
    /// The person stands on the floor mark again (R15).
    ConfirmOrigin(PersonId),
    /// New priors by object index, each 0 to 1.
    SetPriors(Vec<(usize, f64)>),
    /// Another scene, whole; refused while homing.
    ActivateScene(Arc<Scene>),
}

/// What came of a request.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// Accepted, already so, or refused.
    pub outcome: Outcome,
    /// In plain words.
    pub detail: String,
}

/// What came of a request, in one word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// Done, or begun.
    Accepted,
    /// It was so already.
    AlreadySo,
    /// Not now.
    Refused,
}

/// Every decision about motion, for one machine and its arena.
#[derive(Debug)]
pub struct Engine {
    config: EngineConfig,
    scene: Arc<Scene>,
    events: Vec<Event>,
}

impl Engine {
    /// A disarmed engine (or latched, if the last run ended so).
    pub fn new(config: EngineConfig, scene: Arc<Scene>) -> Self {
        Self { config, scene, events: Vec::new() }
    }

    /// Take in a fact that was seen at `now`.
    pub fn observe(&mut self, _now: Time, _observation: Observation) {}

    /// Answer a request at once.
    pub fn request(&mut self, _now: Time, _request: Request) -> Answer {
        Answer { outcome: Outcome::Refused, detail: String::new() }
    }

    /// Decide what the machine does until the next step.
    pub fn step(&mut self, now: Time) -> Vetted {
        Vetted::new(now, Action::Release)
    }

    /// The whole state at `now`.
    pub fn snapshot(&self, _now: Time) -> Snapshot {
        unreachable!("skeleton")
    }

    /// The events since the last call, oldest first.
    pub fn drain_events(&mut self) -> std::vec::Drain<'_, Event> {
        self.events.drain(..)
    }

    /// The state of the machine.
    pub fn mode(&self) -> Mode {
        Mode::Disarmed
    }

    /// The scene in force.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// What it was built with.
    pub fn config(&self) -> &EngineConfig {
        &self.config
    }
}
