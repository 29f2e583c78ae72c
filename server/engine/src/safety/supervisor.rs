//! The supervisor: watches every rule each step and says what they demand. It moves nothing by itself.
//!
//! ```text
//!   rule kept ──breach──▶ breached ──kept again──▶ kept        each change is an event
//!   demand: none < protective stop (R2 R9 R10 R12 R15) < latched stop (R1 R5 R6 R7) < fault (R8, homing failed)
//! ```

use crate::event::EventKind;
use crate::frames::Floor;
use crate::machine::{Homing, MachineReport, Travel};
use crate::observation::{InputLevel, PersonId};
use crate::person::{Lost, Person};
use crate::reason::Reason;
use crate::safety::parameters::Parameters;
use crate::safety::path::State;
use crate::safety::separation::{Conflict, Obstacle};
use crate::snapshot::{RuleId, RuleState, RuleStatus};
use crate::time::{Span, Time};

/// What the supervisor looks at in one step.
#[derive(Debug, Clone, Copy)]
pub struct Watched<'a> {
    /// When.
    pub now: Time,
    /// The machine's newest report; none before the first.
    pub report: Option<&'a MachineReport>,
    /// The state last commanded, while the machine is told to track it.
    pub tracking: Option<&'a State>,
    /// When it was commanded.
    pub commanded_at: Time,
    /// The machine is being homed.
    pub homes: bool,
    /// Everybody in the arena.
    pub persons: &'a [Person],
    /// What the inputs that notice intruders say.
    pub intruder: &'a InputLevel,
    /// Whether a game master's dashboard is needed, and connected.
    pub game_master: GameMaster,
    /// The machine follows people, or will when a protective stop is over.
    pub armed: bool,
    /// Somebody who looked said that nobody is in the arena.
    pub arena_confirmed_clear: bool,
    /// The machine's travel.
    pub travel: &'a Travel,
}

/// Whether a game master is there to see what happens.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GameMaster {
    /// This machine is armed without one.
    NotNeeded,
    /// A dashboard of somebody who may arm is connected.
    Present,
    /// None is.
    Absent,
}

/// What the rules demand, the gravest first in order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Demand {
    /// Brake and hold until the cause has been gone for a while.
    ProtectiveStop(RuleId),
    /// Brake, release, and wait for a reset.
    LatchedStop(RuleId),
    /// The machine cannot be trusted to obey.
    Fault(RuleId),
}

/// Watches R1 to R16.
#[derive(Debug, Clone)]
pub struct Supervisor {
    parameters: Parameters,
    rules: Vec<RuleState>,
    missed_in_a_row: u32,
    over_current: Held,
    following_error: Held,
    astray: Astray,
    velocity_error: Held,
    stall: Option<(Time, Floor, Floor)>,
}

/// How often the machine went astray of late.
#[derive(Debug, Clone, Copy, Default)]
struct Astray {
    since: Option<Time>,
    times: u32,
}

/// A condition that must hold for a while before it counts.
#[derive(Debug, Clone, Copy, Default)]
struct Held {
    since: Option<Time>,
}

impl Supervisor {
    /// Every rule idle.
    pub fn new(parameters: Parameters) -> Self {
        let idle = |n| RuleState {
            rule: RuleId(n),
            status: if n == 4 { RuleStatus::Clear } else { RuleStatus::Idle },
            reason: match n {
                4 => Reason::StopNotPressed,
                11 => Reason::GameMasterNotNeeded,
                14 => Reason::ContactNotArmed,
                12 => Reason::NoIntruderInput,
                _ => Reason::NothingToWatch,
            },
            since: Time::ZERO,
        };
        Self {
            parameters,
            rules: (1..=16).map(idle).collect(),
            missed_in_a_row: 0,
            over_current: Held::default(),
            following_error: Held::default(),
            astray: Astray::default(),
            velocity_error: Held::default(),
            stall: None,
        }
    }

    /// A step began late, or in time (R9).
    pub fn deadline(&mut self, met: bool) {
        self.missed_in_a_row = if met { 0 } else { self.missed_in_a_row.saturating_add(1) };
    }

    /// Look at everything; the gravest demand.
    pub fn watch(&mut self, watched: &Watched<'_>, events: &mut Vec<EventKind>) -> Option<Demand> {
        self.watch_machine(watched, events);
        self.watch_people(watched, events);
        let (status, reason) = match watched.intruder {
            InputLevel::Absent => (RuleStatus::Idle, Reason::NoIntruderInput),
            InputLevel::Inactive => (RuleStatus::Clear, Reason::NoIntruder),
            InputLevel::Active(input) => (RuleStatus::Breached, Reason::Intruder(input.clone())),
            InputLevel::Silent(input) => (RuleStatus::Breached, Reason::InputSilent(input.clone())),
        };
        self.set(RuleId(12), status, watched.now, events, || reason);
        self.watch_game_master(watched, events);
        let missed = self.missed_in_a_row;
        let late = missed >= self.parameters.missed_deadlines;
        self.set(RuleId(9), breach_if(late), watched.now, events, || {
            if late { Reason::StepsLate(missed) } else { Reason::StepsInTime }
        });
        self.rules.iter().filter(|r| r.status == RuleStatus::Breached).filter_map(|r| demand(r.rule)).max()
    }

    /// What separation did this step (R1, R3, R13): in the way of the wanted motion or not.
    pub fn separation(&mut self, conflict: Option<Conflict>, now: Time, events: &mut Vec<EventKind>) {
        let with = conflict.map(|c| c.with);
        let status = |limits: bool| if limits { RuleStatus::Limiting } else { RuleStatus::Clear };
        let (distance_m, required_m) = conflict.map_or((0.0, 0.0), |c| (c.distance_m, c.required_m));
        match with {
            Some(Obstacle::Person(person)) => {
                let reason = || Reason::PersonInTheWay { person, distance_m, required_m };
                self.set(RuleId(3), status(true), now, events, reason);
            }
            _ => self.set(RuleId(3), status(false), now, events, || Reason::NobodyInTheWay),
        }
        match with {
            Some(Obstacle::KeepOut(keep_out)) => {
                let reason = || Reason::KeepOutInTheWay { keep_out, distance_m, required_m };
                self.set(RuleId(13), status(true), now, events, reason);
            }
            _ => self.set(RuleId(13), status(false), now, events, || Reason::NoKeepOutInTheWay),
        }
        if with == Some(Obstacle::Travel) {
            self.set(RuleId(1), RuleStatus::Limiting, now, events, || Reason::TravelEndInTheWay);
        }
    }

    /// Separation is not asked now: nothing is wanted.
    pub fn separation_idle(&mut self, now: Time, events: &mut Vec<EventKind>) {
        for rule in [3, 13] {
            self.set(RuleId(rule), RuleStatus::Idle, now, events, || Reason::NothingToWatch);
        }
    }

    /// Whom a contact is armed for, and which contact is under way (R14).
    pub fn contact(
        &mut self,
        armed: Option<PersonId>,
        under_way: Option<&'static str>,
        now: Time,
        events: &mut Vec<EventKind>,
    ) {
        let (status, reason) = match (armed, under_way) {
            (Some(person), Some(interaction)) => {
                (RuleStatus::Limiting, Reason::InContact { person, interaction: interaction.to_owned() })
            }
            (Some(person), None) => (RuleStatus::Clear, Reason::ContactArmed(person)),
            (None, _) => (RuleStatus::Idle, Reason::ContactNotArmed),
        };
        self.set(RuleId(14), status, now, events, || reason);
    }

    /// The software stop was pressed, for this reason, or reset (R4).
    pub fn software_stop(&mut self, pressed: Option<&Reason>, now: Time, events: &mut Vec<EventKind>) {
        let reason = || pressed.cloned().unwrap_or(Reason::StopNotPressed);
        self.set(RuleId(4), breach_if(pressed.is_some()), now, events, reason);
    }

    /// Forget what counts towards R6 and R7: the commanded state was taken anew from the measured one.
    fn tracking_restarted(&mut self) {
        self.following_error = Held::default();
        self.velocity_error = Held::default();
        self.stall = None;
    }

    /// The machine is not where certificates take it to be: no further motion may be founded on them.
    pub fn is_astray(&self) -> bool {
        self.rule(RuleId(6)).status == RuleStatus::Limiting
    }

    /// Every rule, R1 first.
    pub fn rules(&self) -> &[RuleState] {
        &self.rules
    }

    /// One rule.
    pub fn rule(&self, rule: RuleId) -> &RuleState {
        &self.rules[usize::from(rule.0) - 1]
    }

    /// A rule that demands any stop now, with its reason.
    pub fn breached(&self) -> Option<Reason> {
        let cause =
            self.rules.iter().find(|r| r.status == RuleStatus::Breached && demand(r.rule).is_some())?;
        Some(Reason::CauseStillThere { rule: cause.rule, because: Box::new(cause.reason.clone()) })
    }

    /// Why a latched stop or a fault cannot be left: a rule that led to one is breached now. R4 clears by the reset itself.
    pub fn cause_still_there(&self) -> Option<Reason> {
        let grave = |r: &&RuleState| {
            r.status == RuleStatus::Breached
                && r.rule != RuleId(4)
                && matches!(demand(r.rule), Some(Demand::LatchedStop(_) | Demand::Fault(_)))
        };
        let cause = self.rules.iter().find(grave)?;
        Some(Reason::CauseStillThere { rule: cause.rule, because: Box::new(cause.reason.clone()) })
    }

    fn watch_machine(&mut self, watched: &Watched<'_>, events: &mut Vec<EventKind>) {
        let now = watched.now;
        let Some(report) = watched.report else {
            self.set(RuleId(8), RuleStatus::Idle, now, events, || Reason::NoAnswerYet);
            return;
        };
        let p = self.parameters;
        let silence = now - report.answered_at;
        let dead = silence > p.link;
        let trouble = report.trouble;
        self.set(RuleId(8), breach_if(dead || trouble.is_some()), now, events, || match trouble {
            Some(trouble) => Reason::MachineTrouble(trouble),
            None if dead => Reason::NoGoodAnswer(silence.micros() / 1000),
            None => Reason::ControllerAnswers,
        });
        let homed = report.homing == Homing::Homed;
        let beyond = if homed { -watched.travel.depth_m(report.position) } else { 0.0 };
        self.set(RuleId(1), breach_if(beyond > BEYOND_TRAVEL_M), now, events, || {
            if beyond > BEYOND_TRAVEL_M { Reason::PastTravel(beyond) } else { Reason::InsideTravel }
        });
        let amps = report.current_amps[0].max(report.current_amps[1]);
        let over = self.over_current.for_at_least(amps > p.current_amps, now, p.current_for);
        let reason = || Reason::MotorCurrent { amps, limit_amps: p.current_amps };
        self.set(RuleId(5), breach_if(over), now, events, reason);
        self.watch_tracking(watched, report, events);
    }

    fn watch_tracking(&mut self, watched: &Watched<'_>, report: &MachineReport, events: &mut Vec<EventKind>) {
        let (now, p) = (watched.now, self.parameters);
        let failed = watched.homes && report.homing == Homing::Failed;
        let Some(commanded) = watched.tracking.filter(|_| report.homing == Homing::Homed) else {
            self.tracking_restarted();
            // With the drive let go there is nothing to follow; what was breached stays so until the reset looks again.
            self.set(RuleId(6), RuleStatus::Idle, now, events, || Reason::NothingToWatch);
            let status = if failed { RuleStatus::Breached } else { RuleStatus::Idle };
            self.set(RuleId(7), status, now, events, || {
                if failed { Reason::NoSwitchFound } else { Reason::NothingToWatch }
            });
            return;
        };
        let error = commanded.position().distance_m(report.position);
        let strays =
            self.following_error.for_at_least(error > p.following_error_m, now, p.following_error_for);
        let is_astray = is_astray(commanded, report, watched.commanded_at, &p);
        let times = if is_astray { self.astray.again(now, p.astray_within) } else { 0 };
        let status = match is_astray {
            _ if strays || times >= p.astray_times => RuleStatus::Breached,
            true => RuleStatus::Limiting,
            false => RuleStatus::Clear,
        };
        self.set(RuleId(6), status, now, events, || match (status, strays) {
            (RuleStatus::Limiting, _) => Reason::Astray,
            (RuleStatus::Breached, false) => Reason::AstrayAgain(times),
            _ => Reason::BehindCommand(error),
        });

        let difference = (commanded.velocity() - report.velocity).norm();
        let runs =
            self.velocity_error.for_at_least(difference > p.velocity_error_mps, now, p.velocity_error_for);
        let stalled = self.stalled(now, commanded, report.position);
        self.set(RuleId(7), breach_if(runs || stalled), now, events, || match (runs, stalled) {
            (true, _) => Reason::MovesOtherwise(difference),
            (_, true) => Reason::DoesNotMove,
            _ => Reason::MovesAsCommanded,
        });
    }

    /// Over the last window the command went on and the machine did not.
    fn stalled(&mut self, now: Time, commanded: &State, measured: Floor) -> bool {
        let (since, from_commanded, from_measured) =
            *self.stall.get_or_insert((now, commanded.position(), measured));
        let asked = commanded.position().distance_m(from_commanded);
        let moved = measured.distance_m(from_measured);
        if now - since > STALL_WINDOW {
            self.stall = Some((now, commanded.position(), measured));
        }
        asked > STALL_ASKED_M && moved < STALL_MOVED_M
    }

    fn watch_people(&mut self, watched: &Watched<'_>, events: &mut Vec<EventKind>) {
        let (now, p) = (watched.now, self.parameters);
        let mut lost = [None, None, None];
        for person in watched.persons {
            let rule = match person.lost(now, &p) {
                None if person.awaits_confirmation() => 2,
                None => continue,
                Some(Lost::ClientGone) => 1,
                Some(Lost::NotWorn) => 2,
                Some(_) => 0,
            };
            lost[rule].get_or_insert(person);
        }
        let nobody = watched.persons.is_empty();
        for (rule, who) in [(2, lost[0]), (10, lost[1]), (15, lost[2])] {
            let status = match who {
                Some(_) => RuleStatus::Breached,
                None if nobody => RuleStatus::Idle,
                None => RuleStatus::Clear,
            };
            self.set(RuleId(rule), status, now, events, || match who {
                Some(person) => why_lost(person, now, &p),
                None if nobody => Reason::ArenaEmpty,
                None => Reason::HeadsetsTracked,
            });
        }
        let unsure = nobody && !watched.arena_confirmed_clear;
        let status = if unsure { RuleStatus::Limiting } else { RuleStatus::Clear };
        self.set(RuleId(16), status, now, events, || {
            if unsure { Reason::ArenaUnconfirmed } else { Reason::ArenaAccountedFor }
        });
    }

    /// R11 stops nothing: without a game master nobody arms, and one who goes from an armed machine is told of.
    fn watch_game_master(&mut self, watched: &Watched<'_>, events: &mut Vec<EventKind>) {
        let (status, reason) = match watched.game_master {
            GameMaster::NotNeeded => (RuleStatus::Idle, Reason::GameMasterNotNeeded),
            GameMaster::Present => (RuleStatus::Clear, Reason::GameMasterPresent),
            GameMaster::Absent if watched.armed => (RuleStatus::Breached, Reason::GameMasterAbsent),
            GameMaster::Absent => (RuleStatus::Limiting, Reason::GameMasterAbsent),
        };
        self.set(RuleId(11), status, watched.now, events, || reason);
    }

    fn set(
        &mut self,
        rule: RuleId,
        status: RuleStatus,
        now: Time,
        events: &mut Vec<EventKind>,
        reason: impl FnOnce() -> Reason,
    ) {
        let state = &mut self.rules[usize::from(rule.0) - 1];
        // The numbers of a rule that shapes the motion change from step to step.
        if state.status == status && status != RuleStatus::Limiting {
            return;
        }
        let before = state.status;
        state.reason = reason();
        if before == status {
            return;
        }
        state.status = status;
        state.since = now;
        if status == RuleStatus::Breached {
            events.push(EventKind::RuleBreached { rule, reason: state.reason.clone() });
        } else if before == RuleStatus::Breached {
            events.push(EventKind::RuleCleared { rule });
        }
    }
}

impl Astray {
    /// Once more; how often that makes within this span.
    fn again(&mut self, now: Time, within: Span) -> u32 {
        if self.since.is_none_or(|since| now - since > within) {
            *self = Self { since: Some(now), times: 0 };
        }
        self.times += 1;
        self.times
    }
}

impl Held {
    fn for_at_least(&mut self, condition: bool, now: Time, span: Span) -> bool {
        self.since = if condition { self.since.or(Some(now)) } else { None };
        self.since.is_some_and(|since| now - since >= span)
    }
}

/// What a breach of the rule demands; none for rules that only shape the motion.
pub fn demand(rule: RuleId) -> Option<Demand> {
    match rule.0 {
        2 | 9 | 10 | 12 | 15 => Some(Demand::ProtectiveStop(rule)),
        1 | 4 | 5 | 6 | 7 => Some(Demand::LatchedStop(rule)),
        8 => Some(Demand::Fault(rule)),
        _ => None,
    }
}

/// Whether the machine left what certificates allow it beside the command, when it was measured. One that comes along
/// a little behind is inside the reaction that they allow for.
fn is_astray(commanded: &State, report: &MachineReport, commanded_at: Time, p: &Parameters) -> bool {
    let velocity = commanded.velocity();
    let expected = commanded.position() + velocity * (report.answered_at - commanded_at).secs();
    let behind = expected - report.position;
    let behind_secs =
        (behind.dot(velocity) / velocity.dot(velocity).max(1e-9)).clamp(0.0, p.astray_lag.secs());
    (behind - velocity * behind_secs).norm() > p.astray_m
        || (report.velocity - velocity).norm() > p.astray_mps
}

fn breach_if(breached: bool) -> RuleStatus {
    if breached { RuleStatus::Breached } else { RuleStatus::Clear }
}

fn why_lost(person: &Person, now: Time, parameters: &Parameters) -> Reason {
    let id = person.id();
    match person.lost(now, parameters) {
        Some(Lost::NoPoseYet(secs)) => Reason::NoPoseYet(id, secs),
        Some(Lost::TooOld(secs)) => Reason::PoseTooOld(id, secs),
        Some(Lost::Untracked) => Reason::HeadsetUntracked(id),
        Some(Lost::NotWorn) => Reason::HeadsetOff(id),
        Some(Lost::Jumped) => Reason::PoseJumped(id),
        Some(Lost::ClientGone) => Reason::ClientGone(id),
        None => Reason::OriginUnconfirmed(id),
    }
}

/// Measurement noise and the machine's overshoot past the travel, m.
const BEYOND_TRAVEL_M: f64 = 0.01;
/// R7: looked at over windows of this length.
const STALL_WINDOW: Span = Span::from_millis(500);
/// R7: the command went this far in the window, m.
const STALL_ASKED_M: f64 = 0.03;
/// R7: and the machine less than this, m.
const STALL_MOVED_M: f64 = 0.003;
