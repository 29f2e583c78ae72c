//! The engine: observe, request, step. It owns no clock; the caller says when it is.
//!
//! One step: the supervisor looks at every rule and may change the mode; the intention of every visitor is weighed; the scenario goes
//! on; the mode says what the machine does; in `following` motion proposes and safety disposes.

mod braking;
mod following;
mod foretold;
mod interacting;
mod jogging;
mod modes;
pub mod outlook;
mod playing;
mod requests;
mod view;

use std::sync::Arc;

use crate::event::{Event, EventKind};
use crate::intention::{IntentionParameters, RuleName};
use crate::interaction::Ask;
use crate::machine::{Drive, Homing, Limits, MachineReport, Travel};
use crate::mode::Mode;
use crate::motion::MotionName;
use crate::motion::standing::StandingName;
use crate::observation::{Inputs, Observation, PersonId};
use crate::person::Person;
use crate::reason::Reason;
use crate::safety::contact::Contact;
use crate::safety::governor::Governor;
use crate::safety::parameters::Parameters;
use crate::safety::path::State;
use crate::safety::separation::{KeptFrom, Separation, Threat};
use crate::safety::supervisor::Supervisor;
use crate::safety::vetted::Vetted;
use crate::scenario::Play;
use crate::scene::Scene;
use crate::snapshot::{RuleId, StopCause};
use crate::time::{Span, Time};
use braking::Braking;
use following::{Following, Offer, Wish};
pub use following::{IN_PLACE_M, IN_PLACE_MPS};
pub use foretold::Foretold;
use interacting::Interactions;
use jogging::Jog;
pub use requests::{Answer, Outcome, Request};

/// What the engine is built with. Right once built.
#[derive(Debug, Clone, PartialEq)]
pub struct EngineConfig {
    /// The machine's limits.
    pub limits: Limits,
    /// The machine's travel, room frame.
    pub travel: Travel,
    /// Control period.
    pub period: Span,
    /// The intention rule.
    pub intention_rule: RuleName,
    /// The numbers of the intention rules.
    pub intention: IntentionParameters,
    /// How the column is moved to where it is wanted.
    pub motion: MotionName,
    /// Where the column stands while it is not known which object will be touched; none: as the rule has it.
    pub standing: Option<StandingName>,
    /// Whom separation keeps the column from: everybody, but in a study on virtual time.
    pub kept_from: KeptFrom,
    /// v_h of the separation rule, m/s.
    pub v_h_mps: f64,
    /// Arming needs a game master's dashboard (R11).
    pub needs_game_master: bool,
    /// Start latched: the last run ended in a latched stop and left this record, which the engine hands on unread.
    pub latched_because: Option<String>,
}

/// Every decision about motion, for one machine and its arena.
#[derive(Debug)]
pub struct Engine {
    config: EngineConfig,
    parameters: Parameters,
    scene: Arc<Scene>,
    /// Priors in force.
    priors: Vec<f64>,
    /// Those that a game master set against the scenario, until the state is left.
    prior_edits: Vec<Option<f64>>,
    /// Which objects can be served now.
    enabled: Vec<bool>,
    /// Which objects a head is near to, for the separation rule: those enabled, and those that were when the column began to move.
    near: Vec<bool>,
    play: Option<Play>,
    /// The last step in which the scenario's clock ran.
    played_at: Option<Time>,
    mode: Mode,
    mode_since: Time,
    /// Where a protective stop goes back to.
    resumes: Mode,
    /// Since when no rule has demanded a protective stop.
    quiet_since: Option<Time>,
    stop: Option<StopCause>,
    /// Measured speed when the mode was entered, m/s.
    speed_then_mps: f64,
    arena_confirmed_clear: bool,
    inputs: Inputs,
    game_master_present: bool,
    persons: Vec<Person>,
    threats: Vec<Threat>,
    report: Option<MachineReport>,
    /// When the machine was first measured at rest.
    rests_since: Option<Time>,
    supervisor: Supervisor,
    governor: Option<Governor>,
    stepped_at: Option<Time>,
    following: Following,
    jog: Option<Jog>,
    interactions: Interactions,
    /// Of the last step.
    contact: Option<Contact>,
    /// The stop under way, to be measured.
    braking: Option<Braking>,
    events: Vec<Event>,
    pending: Vec<EventKind>,
}

impl Engine {
    /// A disarmed engine; latched, if the last run ended in a latched stop.
    pub fn new(config: EngineConfig, scene: Arc<Scene>) -> Self {
        let parameters = Parameters::new(config.v_h_mps);
        let mut engine = Self {
            parameters,
            priors: Vec::new(),
            prior_edits: Vec::new(),
            enabled: Vec::new(),
            near: Vec::new(),
            play: None,
            played_at: None,
            mode: Mode::Disarmed,
            mode_since: Time::ZERO,
            resumes: Mode::Following,
            quiet_since: None,
            stop: None,
            speed_then_mps: 0.0,
            arena_confirmed_clear: false,
            inputs: Inputs::default(),
            game_master_present: false,
            persons: Vec::new(),
            threats: Vec::new(),
            report: None,
            rests_since: None,
            supervisor: Supervisor::new(parameters),
            governor: None,
            stepped_at: None,
            following: Following::new(
                config.intention_rule,
                &config.intention,
                config.motion,
                config.standing.unwrap_or(config.intention_rule.standing()),
            ),
            jog: None,
            interactions: Interactions::default(),
            contact: None,
            braking: None,
            events: Vec::new(),
            pending: Vec::new(),
            scene: Arc::clone(&scene),
            config,
        };
        engine.set_the_stage(scene);
        if let Some(record) = engine.config.latched_because.clone() {
            engine.latch(RuleId(4), Reason::LastRunLatched(record), Time::ZERO);
        }
        engine
    }

    /// Take in a fact that was seen at `now`.
    pub fn observe(&mut self, now: Time, observation: Observation) {
        match observation {
            Observation::PersonEntered(id) => {
                if self.person(id).is_none() {
                    self.persons.push(Person::new(id, now));
                    self.persons.sort_by_key(Person::id);
                    self.pending.push(EventKind::PersonEntered(id));
                }
            }
            Observation::PersonLeft(id) => self.leave(id),
            Observation::Pose(id, sample) => {
                if let Some(person) = self.persons.iter_mut().find(|p| p.id() == id) {
                    person.take_pose(sample, &self.scene, &self.near, &self.parameters);
                }
            }
            Observation::OriginChanged(id) => self.with_person(id, Person::origin_changed),
            Observation::TouchBegan(id, object) => self.touched(id, &object, true),
            Observation::TouchEnded(id, object) => self.touched(id, &object, false),
            Observation::ClientGone(id) => self.with_person(id, |p| p.set_client_present(false)),
            Observation::ClientBack(id) => self.with_person(id, |p| p.set_client_present(true)),
            Observation::Machine(report) => {
                let rests = report.velocity.norm() < AT_REST_MPS;
                self.rests_since = if rests { self.rests_since.or(Some(report.answered_at)) } else { None };
                if let Some(came_to) = self.braking.as_mut().and_then(|b| b.watch(&report, rests)) {
                    self.braking = None;
                    self.pending.push(came_to);
                }
                let homes = self.report.is_some_and(|before| before.homing == Homing::Running);
                if homes && report.homing == Homing::Homed {
                    let repeatability_m = report.home_repeatability_m;
                    self.pending.push(EventKind::Homed { at: report.position, repeatability_m });
                }
                self.report = Some(report);
            }
            Observation::Inputs(inputs) => self.inputs = inputs,
            Observation::GameMaster(present) => self.game_master_present = present,
            Observation::DeadlineMissed => self.supervisor.deadline(false),
            Observation::DeadlineMet => self.supervisor.deadline(true),
        }
        self.record(now);
    }

    /// Decide what the machine does until the next step.
    pub fn step(&mut self, now: Time) -> Vetted {
        self.update_near(now);
        for person in &mut self.persons {
            person.update_zones(now, &self.parameters);
        }
        self.threats.clear();
        if self.config.kept_from == KeptFrom::Everybody {
            self.threats.extend(self.persons.iter().filter_map(|p| p.threat(now)));
        }
        self.heed_stop_input(now);
        self.supervise(now);
        self.progress_homing(now);
        self.keep_up_with_the_machine(now);
        let jog = self.jog_now(now);
        let offer = Offer { scene: &self.scene, priors: &self.priors, enabled: &self.enabled };
        let wish = self.following.wanted(&self.persons, &offer, now, &self.parameters, &self.config.limits);
        self.play(now);
        let ask = self.interact(now);
        let contact = self.contact_of(ask);
        self.contact = contact.filter(|_| self.mode == Mode::Following);
        let config = &self.config;
        let command = match self.mode {
            Mode::Disarmed | Mode::LatchedStop | Mode::Faulted => self.stop_and_release(now),
            Mode::Homing if self.may_home() => Vetted::home(now),
            Mode::Homing => Vetted::hold(now),
            Mode::ProtectiveStop if self.resumes == Mode::Homing => Vetted::hold(now),
            // Nobody takes over a machine that moves.
            Mode::Ready | Mode::Following | Mode::ProtectiveStop
                if self.governor.is_none() && !self.rests(now) =>
            {
                Vetted::hold(now)
            }
            Mode::Ready | Mode::Following | Mode::ProtectiveStop => {
                let Some(report) = self.report else { return Vetted::hold(now) };
                let governor = self.governor.get_or_insert_with(|| Governor::taking_over(report.position));
                let separation = Separation {
                    scene: &self.scene,
                    limits: &config.limits,
                    travel: &config.travel,
                    threats: &self.threats,
                    parameters: &self.parameters,
                    contact,
                };
                let measured = State::moving(report.position, report.velocity);
                if let (Mode::Following, Ask::Contact(_, wanted), Some(contact)) = (self.mode, ask, contact) {
                    let choice =
                        governor.govern_contact(wanted, &contact, &measured, &separation, config.period);
                    self.supervisor.separation(choice.conflict, now, &mut self.pending);
                    self.following.rest_at(governor.commanded().position());
                } else if self.mode == Mode::Following && ask != Ask::Stay {
                    let wish = match (ask, self.persons.first()) {
                        (Ask::Go(place), Some(person)) if !self.persons.iter().any(Person::is_unseen) => {
                            Some(Wish::aside(person.id(), place))
                        }
                        (Ask::Go(_), _) => None,
                        _ => wish,
                    };
                    let since = now - self.mode_since;
                    self.following.follow(governor, wish, &measured, &separation, since, config.period);
                    match self.following.conflict() {
                        None if wish.is_none() => self.supervisor.separation_idle(now, &mut self.pending),
                        conflict => self.supervisor.separation(conflict, now, &mut self.pending),
                    }
                    self.pending.extend(self.following.served(&measured, &self.scene, &self.persons));
                } else if let Some((order, cap_mps)) = jog {
                    let inside = config.travel.shrunk(self.parameters.travel_margin_m);
                    let wanted = order.velocity(governor.commanded().position(), &inside, cap_mps);
                    let slower = [wanted, wanted * 0.5, wanted * 0.2];
                    let choice = governor.govern(&slower, &measured, &separation, config.period);
                    self.supervisor.separation(choice.conflict, now, &mut self.pending);
                    self.following.rest_at(governor.commanded().position());
                } else {
                    governor.protective_brake(&separation, config.period);
                    self.following.rest_at(governor.commanded().position());
                    self.supervisor.separation_idle(now, &mut self.pending);
                }
                let valid_for = self.parameters.setpoint_valid(&config.limits, config.period);
                self.record(now);
                return governor_command(self.governor.as_ref(), now, valid_for);
            }
        };
        self.governor = None;
        self.supervisor.separation_idle(now, &mut self.pending);
        if let Some(report) = self.report {
            self.following.rest_at(report.position);
        }
        self.record(now);
        command
    }

    /// The events since the last call, oldest first.
    pub fn drain_events(&mut self) -> std::vec::Drain<'_, Event> {
        self.events.drain(..)
    }

    /// The state of the machine.
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// The scene in force.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// The priors in force, by object.
    pub fn priors(&self) -> &[f64] {
        &self.priors
    }

    /// Which objects can be served now.
    pub fn enabled(&self) -> &[bool] {
        &self.enabled
    }

    /// The contact that the last step moved in; none: everybody is kept from as the separation rule has it.
    pub fn contact(&self) -> Option<Contact> {
        self.contact
    }

    /// What it was built with.
    pub fn config(&self) -> &EngineConfig {
        &self.config
    }

    /// A step that comes late finds the machine farther on. A machine that brakes already, its last setpoint being too old, or
    /// is not where it should be, is let come to rest and taken over anew.
    fn keep_up_with_the_machine(&mut self, now: Time) {
        let Self { config: EngineConfig { period, limits, .. }, parameters, .. } = self;
        let unwatched = self.stepped_at.map_or(Span::ZERO, |before| now - (before + *period));
        let silent = self.report.map_or(Span::ZERO, |report| now - report.answered_at);
        let valid_for = parameters.setpoint_valid(limits, *period);
        if unwatched > valid_for || silent > parameters.reaction || self.supervisor.is_astray() {
            self.governor = None;
        } else if let Some(governor) =
            self.governor.as_mut().filter(|_| unwatched.secs() > 0.5 * period.secs())
        {
            governor.carry_on(unwatched, limits);
        }
        self.stepped_at = Some(now);
    }

    /// Brake at the limit, then release: at rest, or when the brake does not bite (a runaway ends without power alone). While somebody
    /// leans on the column or rides it, it is held instead: only a runaway is worse than what they would fall from.
    fn stop_and_release(&self, now: Time) -> Vetted {
        let Some(report) = self.report.filter(|r| r.drive == Drive::On) else { return Vetted::release(now) };
        let stopped_for = now - self.mode_since;
        // By what it answered: an old answer says nothing of what it does now.
        let rests = self.rests_since.is_some_and(|since| report.answered_at - since >= REST_BEFORE_RELEASE);
        let bears = self.bears().is_some();
        let faster_mps = if bears { RUNS_AWAY_BEARING_MPS } else { RUNS_AWAY_MPS };
        let runs_away =
            stopped_for > BRAKE_BITES_WITHIN && report.velocity.norm() > self.speed_then_mps + faster_mps;
        if runs_away || !bears && (rests || stopped_for > LONGEST_BRAKE) {
            Vetted::release(now)
        } else {
            Vetted::hold(now)
        }
    }

    /// Measured at rest, and not long ago.
    pub(super) fn rests(&self, now: Time) -> bool {
        let fresh = self.report.is_some_and(|report| now - report.answered_at <= self.parameters.reaction);
        fresh && self.rests_since.is_some()
    }

    /// Nobody can be met at creep speed, whichever way homing goes. Before the machine is homed its place is what it
    /// remembers or was told of where it was parked, so people keep farther away.
    fn may_home(&self) -> bool {
        let Some(report) = self.report else { return false };
        let p = &self.parameters;
        let brake_secs = p.reaction.secs() + p.creep_speed_mps / self.config.limits.x.braking_mps2;
        self.threats.iter().all(|t| {
            let r = if t.low { p.low_radius_m } else { p.radius_m };
            let needed = r + (p.v_h_mps + p.creep_speed_mps) * (t.age_secs + brake_secs) + PARKED_WITHIN_M;
            self.scene.footprint().distance_m(report.position, t.head) > needed
        })
    }

    fn person(&self, id: PersonId) -> Option<&Person> {
        self.persons.iter().find(|p| p.id() == id)
    }

    fn with_person(&mut self, id: PersonId, act: impl FnOnce(&mut Person)) {
        if let Some(person) = self.persons.iter_mut().find(|p| p.id() == id) {
            act(person);
        }
    }

    fn record(&mut self, now: Time) {
        self.events.extend(self.pending.drain(..).map(|kind| Event { at: now, kind }));
    }
}

fn governor_command(governor: Option<&Governor>, now: Time, valid_for: Span) -> Vetted {
    governor.map_or_else(|| Vetted::hold(now), |g| g.command(now, valid_for))
}

/// Slower than this the machine rests, as measured, m/s.
const AT_REST_MPS: f64 = 0.01;
/// It has rested for so long before the drive is let go.
const REST_BEFORE_RELEASE: Span = Span::from_millis(100);
/// No brake of this machine takes longer; a machine that still moves after it is let go all the same.
const LONGEST_BRAKE: Span = Span::from_millis(1500);
/// After so long a brake shows in the measured speed.
const BRAKE_BITES_WITHIN: Span = Span::from_millis(60);
/// Faster by this than when the stop began, m/s.
const RUNS_AWAY_MPS: f64 = 0.05;
/// The same for a column that somebody leans on, who sways it, m/s.
const RUNS_AWAY_BEARING_MPS: f64 = 0.3;
/// A machine that is not homed stands within this of where it says, m.
const PARKED_WITHIN_M: f64 = 0.3;

#[cfg(test)]
mod tests;
