//! What rules, stop inputs and the machine itself do to the mode. What the mode table says is in `mode`; here are the effects.

use super::Engine;
use super::braking::Braking;
use crate::event::EventKind;
use crate::machine::Homing;
use crate::mode::{self, Mode, Trigger};
use crate::observation::InputLevel;
use crate::reason::Reason;
use crate::safety::governor::Governor;
use crate::safety::supervisor::{Demand, GameMaster, Watched};
use crate::snapshot::{RuleId, StopCause};
use crate::time::Time;

impl Engine {
    pub(super) fn supervise(&mut self, now: Time) {
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
    pub(super) fn heed_stop_input(&mut self, now: Time) {
        if let Some(reason) = self.stop_input()
            && self.mode != Mode::LatchedStop
        {
            self.latch(RuleId(4), reason, now);
        }
    }

    /// Why a digital input asks for a stop now.
    pub(super) fn stop_input(&self) -> Option<Reason> {
        match &self.inputs.stop {
            InputLevel::Absent | InputLevel::Inactive => None,
            InputLevel::Active(input) => Some(Reason::StopInput(input.clone())),
            InputLevel::Silent(input) => Some(Reason::InputSilent(input.clone())),
        }
    }

    /// R11, as far as this machine asks for it.
    pub(super) fn game_master(&self) -> GameMaster {
        match (self.config.needs_game_master, self.game_master_present) {
            (false, _) => GameMaster::NotNeeded,
            (true, true) => GameMaster::Present,
            (true, false) => GameMaster::Absent,
        }
    }

    /// It follows people, or will when a protective stop is over.
    pub(super) fn is_armed(&self) -> bool {
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

    pub(super) fn progress_homing(&mut self, now: Time) {
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

    pub(super) fn latch(&mut self, rule: RuleId, reason: Reason, now: Time) {
        if rule == RuleId(4) {
            self.supervisor.software_stop(Some(&reason), now, &mut self.pending);
        }
        self.enter_stop(Mode::LatchedStop, rule, reason, now);
    }

    fn enter_stop(&mut self, to: Mode, rule: RuleId, reason: Reason, now: Time) {
        self.enter(to, Some(rule), reason.clone(), now);
        self.stop = Some(StopCause { rule, reason, since: now });
    }

    pub(super) fn enter(&mut self, to: Mode, rule: Option<RuleId>, because: Reason, now: Time) {
        self.quiet_since = None;
        self.stop = None;
        if matches!(to, Mode::Disarmed | Mode::LatchedStop | Mode::Faulted) {
            self.arena_confirmed_clear = false;
        }
        let stops = matches!(to, Mode::Disarmed | Mode::ProtectiveStop | Mode::LatchedStop | Mode::Faulted);
        if let Some(report) = self.report.filter(|_| stops && to != self.mode) {
            self.braking = Braking::begin(now, &report, &self.config.limits, self.parameters.reaction);
        }
        if to != self.mode {
            let was_armed = self.is_armed();
            self.pending.push(EventKind::ModeChanged { from: self.mode, to, rule, because });
            self.mode = to;
            match (was_armed, self.is_armed()) {
                (false, true) => self.begin_to_play(),
                (true, false) => self.end_the_play(),
                _ => {}
            }
        }
        self.mode_since = now;
        self.speed_then_mps = self.report.map_or(0.0, |r| r.velocity.norm());
    }
}
