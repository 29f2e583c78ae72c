//! Requests and their answers: each is answered at once, accepted, already so, or refused with its reason.
//!
//! What the mode table allows is in `mode`; here are the effects.

use std::sync::Arc;

use super::Engine;
use crate::event::EventKind;
use crate::frames::Floor;
use crate::machine::Homing;
use crate::mode::{self, Conditions, Mode, RequestKind, Response};
use crate::motion::jog::JogOrder;
use crate::observation::PersonId;
use crate::reason::Reason;
use crate::safety::supervisor::GameMaster;
use crate::scene::Scene;
use crate::scene::footprint::KeepOut;
use crate::snapshot::RuleId;
use crate::time::{Span, Time};

/// What somebody asks.
#[derive(Debug, Clone)]
pub enum Request {
    /// Home, arm, disarm, stop, reset, with the reason given.
    Machine(RequestKind, Option<String>),
    /// The person stands on the floor mark again (R15).
    ConfirmOrigin(PersonId),
    /// A person whose headset is lost has left the arena: somebody saw it.
    ConfirmLeft(PersonId),
    /// Somebody looked: nobody is in the arena (R16). The word holds until somebody has been there, the next stop or disarming.
    ConfirmClear,
    /// New priors by object index, each 0 to 1.
    SetPriors(Vec<(usize, f64)>),
    /// Move by hand; the order is good for a moment (hold-to-run).
    Jog(JogOrder),
    /// The hand lets go of the jog.
    LetGo,
    /// Another scene, whole; refused while homing.
    ActivateScene(Arc<Scene>),
    /// A game master's cue to the scenario, by its name.
    Cue(String),
    /// Something that a VR client tells the scenario, by its name.
    ClientEvent(String),
    /// Skip to the state of this id, for this reason.
    SkipTo(String, String),
    /// Back to the state before, for this reason.
    Rewind(String),
    /// A moving column may touch this visitor, for so long at most (R14).
    ArmContact(PersonId, Span),
    /// Nobody may be touched by a moving column any more.
    DisarmContact,
    /// Somebody looked: nobody leans on the column or rides it.
    ConfirmFree,
}

/// What came of a request.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// Accepted, already so, or refused.
    pub outcome: Outcome,
    /// Why, or what came of it.
    pub reason: Reason,
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

impl Engine {
    /// Answer a request at once.
    pub fn request(&mut self, now: Time, request: Request) -> Answer {
        let answer = match request {
            Request::Machine(kind, reason) => self.request_machine(now, kind, reason.unwrap_or_default()),
            Request::ConfirmOrigin(id) => self.confirm_origin(id),
            Request::ConfirmLeft(id) => self.confirm_left(now, id),
            Request::ConfirmClear => self.confirm_clear(),
            Request::SetPriors(changes) => self.set_priors(&changes),
            Request::Jog(order) => self.take_jog(now, order),
            Request::LetGo => self.let_go_of_jog(),
            Request::ActivateScene(scene) => self.activate(scene),
            Request::Cue(name) => self.cue(&name),
            Request::ClientEvent(name) => self.client_event(&name),
            Request::SkipTo(state, reason) => self.skip_to(&state, reason),
            Request::Rewind(reason) => self.rewind(reason),
            Request::ArmContact(person, lasts) => self.arm_contact(now, person, lasts),
            Request::DisarmContact => self.take_contact_back(),
            Request::ConfirmFree => self.confirm_free(),
        };
        self.record(now);
        answer
    }

    fn request_machine(&mut self, now: Time, kind: RequestKind, reason: String) -> Answer {
        match mode::respond(self.mode, kind, &self.conditions(now)) {
            Response::AlreadySo(reason) => Answer { outcome: Outcome::AlreadySo, reason },
            Response::Refuse(reason) => refused(reason),
            Response::Go(Mode::Homing) if let Some(reason) = self.shape_on_the_way_home() => refused(reason),
            Response::Go(to) => {
                match kind {
                    RequestKind::Stop => {
                        self.latch(RuleId(4), Reason::SoftwareStop(reason), now);
                    }
                    RequestKind::Home | RequestKind::Arm => {
                        self.arena_confirmed_clear = self.persons.is_empty();
                        self.enter(to, None, Reason::Asked(kind), now);
                    }
                    RequestKind::Disarm => self.enter(to, None, Reason::Asked(kind), now),
                    // Without a way or a place it is no order.
                    RequestKind::Jog => return refused(self.no_jog_order()),
                    RequestKind::Reset => {
                        self.supervisor.software_stop(None, now, &mut self.pending);
                        self.enter(to, None, Reason::ResetAsked(reason), now);
                    }
                }
                accepted(Reason::NowIn(self.mode))
            }
        }
    }

    pub(super) fn conditions(&self, now: Time) -> Conditions {
        Conditions {
            homed: self.report.is_some_and(|r| r.homing == Homing::Homed),
            moves: self.report.is_some() && !self.rests(now),
            game_master_absent: self.game_master() == GameMaster::Absent,
            cause_still_there: self
                .stop_input()
                .map(|reason| Reason::CauseStillThere { rule: RuleId(4), because: Box::new(reason) })
                .or_else(|| self.supervisor.cause_still_there()),
        }
    }

    /// The keep-out shape that homing would come too near: straight to the corner, each axis until its switch.
    fn shape_on_the_way_home(&self) -> Option<Reason> {
        let from = self.report?.position;
        let corner = self.config.travel.min;
        let farthest = (from.x - corner.x).max(from.y - corner.y).max(0.0);
        let steps = (farthest / HOMING_LOOK_M).ceil() as u32 + 1;
        let on_the_way = (0..=steps).map(|k| {
            let gone = f64::from(k) * HOMING_LOOK_M;
            Floor::new((from.x - gone).max(corner.x), (from.y - gone).max(corner.y))
        });
        let needed = self.parameters.radius_m + HOMING_MARGIN_M;
        for centre in on_the_way {
            let near = |k: &KeepOut| k.distance_m(self.scene.footprint(), centre) < needed;
            if let Some(index) = self.scene.keep_outs().iter().position(near) {
                let keep_out = self.scene.spec().keep_outs[index].id.clone();
                return Some(Reason::HomingNearKeepOut { keep_out, required_m: needed });
            }
        }
        None
    }

    fn confirm_origin(&mut self, id: PersonId) -> Answer {
        match self.persons.iter_mut().find(|p| p.id() == id) {
            None => refused(Reason::PersonNotInside(id)),
            Some(person) if !person.awaits_confirmation() => {
                Answer { outcome: Outcome::AlreadySo, reason: Reason::OriginConfirmedAlready(id) }
            }
            Some(person) => {
                person.confirm_origin();
                accepted(Reason::OriginConfirmed(id))
            }
        }
    }

    fn confirm_left(&mut self, now: Time, id: PersonId) -> Answer {
        match self.person(id) {
            None => refused(Reason::PersonNotInside(id)),
            Some(person) if person.lost(now, &self.parameters).is_none() => {
                refused(Reason::PersonStillTracked(id))
            }
            Some(_) => {
                self.leave(id);
                accepted(Reason::PersonLeft(id))
            }
        }
    }

    fn confirm_clear(&mut self) -> Answer {
        if let Some(person) = self.persons.first() {
            return refused(Reason::PersonInside(person.id()));
        }
        let outcome = if self.arena_confirmed_clear { Outcome::AlreadySo } else { Outcome::Accepted };
        self.arena_confirmed_clear = true;
        Answer { outcome, reason: Reason::ArenaConfirmedClear }
    }

    pub(super) fn leave(&mut self, id: PersonId) {
        let before = self.persons.len();
        self.persons.retain(|p| p.id() != id);
        if self.persons.len() < before {
            self.pending.push(EventKind::PersonLeft(id));
            // Whoever said that nobody is there looked before this person came; a headset that is off is no look.
            self.arena_confirmed_clear = false;
            self.leave_the_play(id);
            self.hand_off();
        }
    }

    fn set_priors(&mut self, changes: &[(usize, f64)]) -> Answer {
        for (index, prior) in changes {
            if *index >= self.priors.len() {
                return refused(Reason::NoSuchObject { index: *index, objects: self.priors.len() });
            }
            if !(0.0..=1.0).contains(prior) {
                return refused(Reason::PriorOutOfRange { index: *index, prior: *prior });
            }
        }
        for (index, prior) in changes {
            self.priors[*index] = *prior;
            // Against the scenario's own, until the state is left.
            self.prior_edits[*index] = Some(*prior);
        }
        accepted(Reason::PriorsSet(changes.len()))
    }

    fn activate(&mut self, scene: Arc<Scene>) -> Answer {
        if self.mode == Mode::Homing {
            return refused(Reason::WaitForHoming);
        }
        if let Some(report) = self.report.filter(|r| r.homing == Homing::Homed) {
            // Inside a keep-out's distance nothing may move, so the column would be shut in.
            let shuts_in =
                |k: &KeepOut| k.distance_m(scene.footprint(), report.position) < self.parameters.radius_m;
            if let Some(index) = scene.keep_outs().iter().position(shuts_in) {
                let keep_out = scene.spec().keep_outs[index].id.clone();
                return refused(Reason::ColumnInKeepOut { keep_out, required_m: self.parameters.radius_m });
            }
        }
        self.forget_interactions();
        self.set_the_stage(scene);
        self.following.forget_visitors();
        self.place_everybody();
        accepted(Reason::SceneActivated)
    }
}

pub(super) fn accepted(reason: Reason) -> Answer {
    Answer { outcome: Outcome::Accepted, reason }
}

pub(super) fn refused(reason: Reason) -> Answer {
    Answer { outcome: Outcome::Refused, reason }
}

/// Homing's course is looked at this often, m.
const HOMING_LOOK_M: f64 = 0.02;
/// Homing backs off and comes back by about this much, m.
const HOMING_MARGIN_M: f64 = 0.06;
