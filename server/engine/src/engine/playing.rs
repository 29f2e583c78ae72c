//! The scenario in the engine: what it is told, when its clock runs, and what it does to what can be served.
//!
//! It runs while the machine follows people. In a protective stop it stands; when the machine is no longer armed the run is over, and the
//! next begins where the scenario begins, unless a game master skips to another state first. It changes priors and enabled objects
//! and nothing else: no state makes the machine move that is not armed.
//!
//! A prior that a game master sets counts until the state is left; the next state has its own again.

use std::sync::Arc;

use super::following::{IN_PLACE_M, IN_PLACE_MPS};
use super::requests::{accepted, refused};
use super::{AT_REST_MPS, Answer, Engine};
use crate::event::{EventKind, WhyState};
use crate::mode::Mode;
use crate::observation::PersonId;
use crate::reason::Reason;
use crate::scenario::{Change, Happening, Play, Scenario, Trigger, WhyEntered};
use crate::scene::Scene;
use crate::snapshot::{NextState, ScenarioState};
use crate::time::{Span, Time};

impl Engine {
    /// A scene begins: its own priors and objects, its scenario at its beginning.
    pub(super) fn set_the_stage(&mut self, scene: Arc<Scene>) {
        let objects = &scene.spec().objects;
        self.priors = objects.iter().map(|object| object.prior).collect();
        self.prior_edits = vec![None; objects.len()];
        self.enabled = scene.enabled().to_vec();
        self.play = scene.scenario().map(|scenario| Play::new(scenario, objects.len()));
        self.scene = scene;
        self.take_the_states_offer();
        self.near = self.enabled.clone();
        if self.is_armed() {
            self.begin_to_play();
        }
    }

    /// The machine was armed.
    pub(super) fn begin_to_play(&mut self) {
        self.played_at = None;
        let scene = Arc::clone(&self.scene);
        if let (Some(scenario), Some(play)) = (scene.scenario(), &mut self.play) {
            let change = play.begin(scenario);
            self.tell(scenario, vec![change]);
        }
    }

    /// The machine is armed no more: the run is over.
    pub(super) fn end_the_play(&mut self) {
        let scene = Arc::clone(&self.scene);
        if let (Some(scenario), Some(play)) = (scene.scenario(), &mut self.play) {
            play.restart(scenario);
            self.prior_edits.fill(None);
            self.take_the_states_offer();
        }
    }

    /// A hand met an object, or let go of it.
    pub(super) fn touched(&mut self, person: PersonId, object: &str, began: bool) {
        let scene = Arc::clone(&self.scene);
        let index = scene.spec().objects.iter().position(|known| known.id == object);
        let runs = self.runs();
        let is_inside = self.person(person).is_some();
        if let (Some(scenario), Some(play), Some(object), true) =
            (scene.scenario(), &mut self.play, index, is_inside)
        {
            let changes = if began {
                play.touch(scenario, person, object, runs)
            } else {
                play.let_go(scenario, person, object, runs)
            };
            self.tell(scenario, changes);
            self.hand_off();
        }
    }

    /// Somebody is gone, and with them their touches.
    pub(super) fn leave_the_play(&mut self, person: PersonId) {
        let scene = Arc::clone(&self.scene);
        let runs = self.runs();
        if let (Some(scenario), Some(play)) = (scene.scenario(), &mut self.play) {
            let mut changes = Vec::new();
            for trigger in play.senses_mut().leave(person) {
                changes.extend(play.happen(scenario, Happening { trigger, person: Some(person) }, runs).1);
            }
            self.tell(scenario, changes);
        }
    }

    /// One step of the scenario, when people and their sights are up to date.
    pub(super) fn play(&mut self, now: Time) {
        let scene = Arc::clone(&self.scene);
        let Some(scenario) = scene.scenario() else { return };
        let Some(mut play) = self.play.take() else { return };
        let runs = self.runs();
        let mut changes = self.look_around(&mut play, &scene, scenario, now);
        let elapsed = self.played_at.map_or(Span::ZERO, |before| now - before);
        self.played_at = runs.then_some(now);
        if runs {
            changes.extend(play.pass(scenario, elapsed));
        }
        self.play = Some(play);
        self.tell(scenario, changes);
        self.take_the_states_offer();
    }

    /// Where everybody stands and looks, and where the column stands: each coming and going is one macrostep.
    fn look_around(&self, play: &mut Play, scene: &Scene, scenario: &Scenario, now: Time) -> Vec<Change> {
        let (runs, clock) = (self.runs(), play.clock());
        let mut changes = Vec::new();
        let still = self.report.filter(|report| report.velocity.norm() < IN_PLACE_MPS);
        let stands_at = |object: &usize| {
            still.is_some_and(|report| {
                report.position.distance_m(scene.objects()[*object].column_place()) < IN_PLACE_M
            })
        };
        play.senses_mut().stand_column(scenario.places().iter().copied().filter(stands_at));
        for person in &self.persons {
            let id = person.id();
            let Some(sample) = person.newest().filter(|_| person.lost(now, &self.parameters).is_none())
            else {
                play.senses_mut().lose_sight_of(id);
                continue;
            };
            for (zone, shape) in scene.zones().iter().enumerate() {
                let distance_m = shape.distance_m(sample.pose.position.floor());
                if let Some(trigger) = play.senses_mut().stand(id, zone, distance_m) {
                    changes.extend(play.happen(scenario, Happening { trigger, person: Some(id) }, runs).1);
                }
            }
            let sights = self.following.sights_of(id).unwrap_or_default();
            for object in scenario.looks() {
                if let Some(sight) = sights.get(*object) {
                    play.senses_mut().look(id, *object, sight.angle_rad, clock);
                }
            }
        }
        changes
    }

    /// What the present state says can be served, and how likely it is.
    fn take_the_states_offer(&mut self) {
        let (Some(scenario), Some(play)) = (self.scene.scenario(), &self.play) else { return };
        let state = &scenario.states()[play.state()];
        let objects = self.scene.spec().objects.iter().zip(self.scene.enabled()).zip(state.enabled());
        for (i, ((spec, in_scene), in_state)) in objects.enumerate() {
            self.enabled[i] = *in_scene && *in_state;
            let prior = || play.prior(scenario, i).unwrap_or(spec.prior);
            self.priors[i] = self.prior_edits[i].unwrap_or_else(prior);
        }
    }

    /// An object that is switched off while the column moves keeps its near zone until the column rests: where the separation
    /// rule would become stricter at once, the column would be in breach of it for as long as it brakes.
    pub(super) fn update_near(&mut self, now: Time) {
        if self.near == self.enabled {
            return;
        }
        let stands = self.governor.is_none_or(|g| g.commanded().velocity().norm() < AT_REST_MPS);
        let rests = stands && self.rests(now);
        let before = self.near.clone();
        for (near, enabled) in self.near.iter_mut().zip(&self.enabled) {
            *near = *enabled || *near && !rests;
        }
        if before != self.near {
            self.place_everybody();
        }
    }

    pub(super) fn place_everybody(&mut self) {
        for person in &mut self.persons {
            person.place_among(&self.scene, &self.near);
        }
    }

    pub(super) fn cue(&mut self, cue: &str) -> Answer {
        let scene = Arc::clone(&self.scene);
        let Some(scenario) = scene.scenario() else { return refused(Reason::NoScenario) };
        match scenario.cue_of(cue) {
            Some(index) => self.heard(scenario, Trigger::Cue(index), cue),
            None => {
                let known = scenario.cues().iter().map(ToString::to_string).collect();
                refused(Reason::NoSuchCue { cue: cue.to_owned(), known })
            }
        }
    }

    pub(super) fn client_event(&mut self, name: &str) -> Answer {
        let scene = Arc::clone(&self.scene);
        let Some(scenario) = scene.scenario() else { return refused(Reason::NoScenario) };
        match scenario.client_event_of(name) {
            Some(index) => self.heard(scenario, Trigger::ClientEvent(index), name),
            None => self.not_awaited(scenario, name),
        }
    }

    fn heard(&mut self, scenario: &Scenario, trigger: Trigger<usize>, name: &str) -> Answer {
        if !self.runs() {
            return refused(Reason::ScenarioStands);
        }
        let Some(play) = &mut self.play else { return refused(Reason::NoScenario) };
        let (taken, changes) = play.happen(scenario, Happening { trigger, person: None }, true);
        let state = scenario.states()[play.state()].id().to_string();
        self.tell(scenario, changes);
        if taken { accepted(Reason::NowInState(state)) } else { self.not_awaited(scenario, name) }
    }

    fn not_awaited(&self, scenario: &Scenario, name: &str) -> Answer {
        let state = self.play.as_ref().map_or(0, Play::state);
        let state = scenario.states()[state].id().to_string();
        refused(Reason::NotAwaited { name: name.to_owned(), state })
    }

    pub(super) fn skip_to(&mut self, state: &str, reason: String) -> Answer {
        let scene = Arc::clone(&self.scene);
        let (Some(scenario), Some(play)) = (scene.scenario(), &mut self.play) else {
            return refused(Reason::NoScenario);
        };
        let Some(to) = scenario.state_of(state) else {
            return refused(Reason::NoSuchState(state.to_owned()));
        };
        let change = play.skip(scenario, to, reason);
        self.tell(scenario, vec![change]);
        accepted(Reason::NowInState(state.to_owned()))
    }

    pub(super) fn rewind(&mut self, reason: String) -> Answer {
        let scene = Arc::clone(&self.scene);
        let (Some(scenario), Some(play)) = (scene.scenario(), &mut self.play) else {
            return refused(Reason::NoScenario);
        };
        let Some(change) = play.rewind(scenario, reason) else { return refused(Reason::NothingBefore) };
        let state = scenario.states()[play.state()].id().to_string();
        self.tell(scenario, vec![change]);
        accepted(Reason::NowInState(state))
    }

    /// For the record; and what a new state says is in force at once.
    pub(super) fn tell(&mut self, scenario: &Scenario, changes: Vec<Change>) {
        if changes.is_empty() {
            return;
        }
        for change in changes {
            self.pending.push(match change {
                Change::Entered { from, to, why } => {
                    self.prior_edits.fill(None);
                    EventKind::StateEntered { from, to, why: named(why, scenario, &self.scene) }
                }
                Change::Cut(state) => EventKind::ScenarioCut { state },
            });
        }
        self.take_the_states_offer();
    }

    /// The scenario's clock runs.
    fn runs(&self) -> bool {
        self.mode == Mode::Following
    }

    pub(super) fn scenario_state(&self) -> Option<ScenarioState> {
        let (scenario, play) = (self.scene.scenario()?, self.play.as_ref()?);
        let id = |state: usize| scenario.states()[state].id().to_string();
        let shown = play.shown(scenario);
        let next = shown.next.iter().map(|next| NextState {
            is_from_anywhere: next.is_from_anywhere,
            index: next.index,
            to: next.to.map(id),
            due_secs: Some(next.due_secs).filter(|secs| secs.is_finite()),
        });
        let variables = scenario.variables().iter().zip(&shown.variables);
        Some(ScenarioState {
            state: id(shown.state),
            in_state_secs: shown.in_state.secs(),
            runs: self.runs(),
            entered: shown.entered,
            variables: variables.map(|(variable, value)| (variable.id.to_string(), *value)).collect(),
            next: next.collect(),
            before: play.before().map(id),
            left_in: shown.left_in.map(id),
            is_cut: shown.is_cut,
        })
    }
}

/// With ids for indices, which the next scene would not know.
fn named(why: WhyEntered, scenario: &Scenario, scene: &Scene) -> WhyState {
    let Happening { trigger, person } = match why {
        WhyEntered::Began => return WhyState::Began,
        WhyEntered::ConditionHeld => return WhyState::ConditionHeld,
        WhyEntered::Skipped(reason) => return WhyState::Skipped(reason),
        WhyEntered::Rewound(reason) => return WhyState::Rewound(reason),
        WhyEntered::Happened(happening) => happening,
    };
    let object = |i: usize| scene.spec().objects[i].id.clone();
    let zone = |i: usize| scene.spec().zones[i].id.clone();
    match (trigger, person) {
        (Trigger::Cue(i), _) => WhyState::Cue(scenario.cues()[i].to_string()),
        (Trigger::ClientEvent(i), _) => WhyState::ClientEvent(scenario.client_events()[i].to_string()),
        (Trigger::InteractionDone(i), _) => WhyState::InteractionDone(object(i)),
        (Trigger::TouchBegan(i), Some(person)) => WhyState::TouchBegan(person, object(i)),
        (Trigger::TouchEnded(i), Some(person)) => WhyState::TouchEnded(person, object(i)),
        (Trigger::ZoneEntered(i), Some(person)) => WhyState::ZoneEntered(person, zone(i)),
        (Trigger::ZoneLeft(i), Some(person)) => WhyState::ZoneLeft(person, zone(i)),
        // Touches and zones are always somebody's.
        (_, None) => WhyState::ConditionHeld,
    }
}
