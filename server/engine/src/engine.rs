//! The engine: observe, request, step. It owns no clock; the caller says when it is.
//!
//! One step: the supervisor looks at every rule and may change the mode; the intention of every visitor is weighed;
//! the mode says what the machine does; in `following` motion proposes and safety disposes.

mod following;
mod foretold;
pub mod outlook;
mod requests;
mod view;

use std::sync::Arc;

use crate::event::{Event, EventKind};
use crate::intention::{IntentionParameters, RuleName};
use crate::machine::{Drive, Homing, Limits, MachineReport, Travel};
use crate::mode::{self, Mode, Trigger};
use crate::motion::MotionName;
use crate::motion::standing::StandingName;
use crate::observation::{InputLevel, Inputs, Observation, PersonId};
use crate::person::Person;
use crate::reason::Reason;
use crate::safety::governor::Governor;
use crate::safety::parameters::Parameters;
use crate::safety::path::State;
use crate::safety::separation::{KeptFrom, Separation, Threat};
use crate::safety::supervisor::{Demand, GameMaster, Supervisor, Watched};
use crate::safety::vetted::Vetted;
use crate::scene::Scene;
use crate::snapshot::{RuleId, StopCause};
use crate::time::{Span, Time};
use following::Following;
pub use following::{IN_PLACE_M, IN_PLACE_MPS};
pub use foretold::Foretold;
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
    priors: Vec<f64>,
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
    events: Vec<Event>,
    pending: Vec<EventKind>,
}

impl Engine {
    /// A disarmed engine; latched, if the last run ended in a latched stop.
    pub fn new(config: EngineConfig, scene: Arc<Scene>) -> Self {
        let parameters = Parameters::new(config.v_h_mps);
        let mut engine = Self {
            parameters,
            priors: scene.spec().objects.iter().map(|o| o.prior).collect(),
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
            events: Vec::new(),
            pending: Vec::new(),
            scene,
            config,
        };
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
                    person.take_pose(sample, &self.scene, &self.parameters);
                }
            }
            Observation::OriginChanged(id) => self.with_person(id, Person::origin_changed),
            Observation::ClientGone(id) => self.with_person(id, |p| p.set_client_present(false)),
            Observation::ClientBack(id) => self.with_person(id, |p| p.set_client_present(true)),
            Observation::Machine(report) => {
                let rests = report.velocity.norm() < AT_REST_MPS;
                self.rests_since = if rests { self.rests_since.or(Some(report.answered_at)) } else { None };
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
        let config = &self.config;
        let wish = self.following.wanted(
            &self.persons,
            &self.scene,
            &self.priors,
            now,
            &self.parameters,
            &config.limits,
        );
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
                };
                let measured = State::moving(report.position, report.velocity);
                if self.mode == Mode::Following {
                    let since = now - self.mode_since;
                    self.following.follow(governor, wish, &measured, &separation, since, config.period);
                    match self.following.conflict() {
                        None if wish.is_none() => self.supervisor.separation_idle(now, &mut self.pending),
                        conflict => self.supervisor.separation(conflict, now, &mut self.pending),
                    }
                    self.pending.extend(self.following.served(&measured, &self.scene, &self.persons));
                } else {
                    governor.protective_brake(&separation, config.period);
                    self.following.rest_at(governor.commanded().position());
                    self.supervisor.separation_idle(now, &mut self.pending);
                }
                self.record(now);
                return governor_command(self.governor.as_ref(), now, self.parameters.reaction);
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

    /// What it was built with.
    pub fn config(&self) -> &EngineConfig {
        &self.config
    }

    /// A step that comes late finds the machine farther on. A machine that went on by itself for longer than a reaction,
    /// or is not where it should be, is let come to rest and taken over anew.
    fn keep_up_with_the_machine(&mut self, now: Time) {
        let Self { config: EngineConfig { period, limits, .. }, parameters, .. } = self;
        let unwatched = self.stepped_at.map_or(Span::ZERO, |before| now - (before + *period));
        let silent = self.report.map_or(Span::ZERO, |report| now - report.answered_at);
        if unwatched.max(silent) > parameters.reaction || self.supervisor.is_astray() {
            self.governor = None;
        } else if let Some(governor) =
            self.governor.as_mut().filter(|_| unwatched.secs() > 0.5 * period.secs())
        {
            governor.carry_on(unwatched, limits);
        }
        self.stepped_at = Some(now);
    }

    fn supervise(&mut self, now: Time) {
        let watched = Watched {
            now,
            report: self.report.as_ref(),
            tracking: self.governor.as_ref().map(Governor::commanded),
            commanded_at: self.stepped_at.unwrap_or(now),
            homes: self.mode == Mode::Homing,
            persons: &self.persons,
            intruder: &self.inputs.intruder,
            game_master: self.game_master(),
            armed: self.is_armed(),
            arena_confirmed_clear: self.arena_confirmed_clear,
            travel: &self.config.travel,
        };
        match self.supervisor.watch(&watched, &mut self.pending) {
            Some(Demand::Fault(rule)) => self.trigger(Trigger::Fault, rule, now),
            Some(Demand::LatchedStop(rule)) => self.trigger(Trigger::LatchedDemand, rule, now),
            Some(Demand::ProtectiveStop(rule)) => {
                self.quiet_since = None;
                self.trigger(Trigger::ProtectiveDemand, rule, now);
            }
            None => {
                let since = *self.quiet_since.get_or_insert(now);
                if now - since >= self.parameters.clears_after
                    && let Some(to) = mode::react(self.mode, Trigger::DemandGone, self.resumes)
                {
                    self.enter(to, None, Reason::ProtectiveStopOver, now);
                }
            }
        }
    }

    /// A digital input asks for the software stop (R4), for as long as it is active.
    fn heed_stop_input(&mut self, now: Time) {
        if let Some(reason) = self.stop_input()
            && self.mode != Mode::LatchedStop
        {
            self.latch(RuleId(4), reason, now);
        }
    }

    /// Why a digital input asks for a stop now.
    fn stop_input(&self) -> Option<Reason> {
        match &self.inputs.stop {
            InputLevel::Absent | InputLevel::Inactive => None,
            InputLevel::Active(input) => Some(Reason::StopInput(input.clone())),
            InputLevel::Silent(input) => Some(Reason::InputSilent(input.clone())),
        }
    }

    /// R11, as far as this machine asks for it.
    fn game_master(&self) -> GameMaster {
        match (self.config.needs_game_master, self.game_master_present) {
            (false, _) => GameMaster::NotNeeded,
            (true, true) => GameMaster::Present,
            (true, false) => GameMaster::Absent,
        }
    }

    /// It follows people, or will when a protective stop is over.
    fn is_armed(&self) -> bool {
        self.mode == Mode::Following || self.mode == Mode::ProtectiveStop && self.resumes == Mode::Following
    }

    /// What a breached rule does to the mode.
    fn trigger(&mut self, trigger: Trigger, rule: RuleId, now: Time) {
        let Some(to) = mode::react(self.mode, trigger, self.resumes) else { return };
        let reason = self.supervisor.rule(rule).reason.clone();
        if to == Mode::ProtectiveStop {
            self.resumes = self.mode;
        }
        self.enter_stop(to, rule, reason, now);
    }

    fn progress_homing(&mut self, now: Time) {
        let homing = self.report.map(|r| r.homing);
        // The machine says `Homed` of an earlier run until it has taken up the command.
        let begun = now - self.mode_since > self.parameters.link;
        let rests = self.rests(now);
        let trigger = match homing {
            Some(Homing::Homed) if begun && rests => Trigger::Homed,
            Some(Homing::NotHomed | Homing::Failed) if self.governor.is_some() => Trigger::HomeLost,
            _ => return,
        };
        match mode::react(self.mode, trigger, self.resumes) {
            Some(Mode::LatchedStop) => self.latch(RuleId(7), Reason::HomeLost, now),
            Some(to) => self.enter(to, None, Reason::HomingDone, now),
            None => {}
        }
    }

    /// Brake at the limit, then release: at rest, or when the brake does not bite (a runaway ends without power alone).
    fn stop_and_release(&self, now: Time) -> Vetted {
        let Some(report) = self.report.filter(|r| r.drive == Drive::On) else { return Vetted::release(now) };
        let stopped_for = now - self.mode_since;
        // By what it answered: an old answer says nothing of what it does now.
        let rests = self.rests_since.is_some_and(|since| report.answered_at - since >= REST_BEFORE_RELEASE);
        let runs_away =
            stopped_for > BRAKE_BITES_WITHIN && report.velocity.norm() > self.speed_then_mps + RUNS_AWAY_MPS;
        if rests || runs_away || stopped_for > LONGEST_BRAKE {
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

    fn latch(&mut self, rule: RuleId, reason: Reason, now: Time) {
        if rule == RuleId(4) {
            self.supervisor.software_stop(Some(&reason), now, &mut self.pending);
        }
        self.enter_stop(Mode::LatchedStop, rule, reason, now);
    }

    fn enter_stop(&mut self, to: Mode, rule: RuleId, reason: Reason, now: Time) {
        self.enter(to, Some(rule), reason.clone(), now);
        self.stop = Some(StopCause { rule, reason, since: now });
    }

    fn enter(&mut self, to: Mode, rule: Option<RuleId>, because: Reason, now: Time) {
        self.quiet_since = None;
        self.stop = None;
        if matches!(to, Mode::Disarmed | Mode::LatchedStop | Mode::Faulted) {
            self.arena_confirmed_clear = false;
        }
        if to != self.mode {
            self.pending.push(EventKind::ModeChanged { from: self.mode, to, rule, because });
            self.mode = to;
        }
        self.mode_since = now;
        self.speed_then_mps = self.report.map_or(0.0, |r| r.velocity.norm());
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
/// A machine that is not homed stands within this of where it says, m.
const PARKED_WITHIN_M: f64 = 0.3;

#[cfg(test)]
mod tests;
