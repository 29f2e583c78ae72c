//! Requests and their answers: each is answered at once, accepted, already so, or refused with its reason.
//!
//! What the mode table allows is in `mode`; here are the effects.

use std::sync::Arc;

use super::Engine;
use crate::event::EventKind;
use crate::frames::Floor;
use crate::machine::Homing;
use crate::mode::{self, Conditions, Mode, RequestKind, Response};
use crate::observation::PersonId;
use crate::scene::Scene;
use crate::scene::footprint::KeepOut;
use crate::snapshot::RuleId;
use crate::time::Time;

/// What somebody asks.
#[derive(Debug, Clone)]
pub enum Request {
    /// Home, arm, disarm, stop, reset, with the reason given.
    Machine(RequestKind, Option<String>),
    /// The person stands on the floor mark again (R15).
    ConfirmOrigin(PersonId),
    /// A person whose headset is lost has left the arena: somebody saw it.
    ConfirmLeft(PersonId),
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

impl Engine {
    /// Answer a request at once.
    pub fn request(&mut self, now: Time, request: Request) -> Answer {
        let answer = match request {
            Request::Machine(kind, reason) => self.request_machine(now, kind, reason.unwrap_or_default()),
            Request::ConfirmOrigin(id) => self.confirm_origin(id),
            Request::ConfirmLeft(id) => self.confirm_left(now, id),
            Request::SetPriors(changes) => self.set_priors(&changes),
            Request::ActivateScene(scene) => self.activate(scene),
        };
        self.record(now);
        answer
    }

    fn request_machine(&mut self, now: Time, kind: RequestKind, reason: String) -> Answer {
        match mode::respond(self.mode, kind, &self.conditions(now)) {
            Response::AlreadySo(detail) => Answer { outcome: Outcome::AlreadySo, detail: detail.to_owned() },
            Response::Refuse(detail) => Answer { outcome: Outcome::Refused, detail },
            Response::Go(Mode::Homing) if let Some(detail) = self.shape_on_the_way_home() => refused(detail),
            Response::Go(to) => {
                match kind {
                    RequestKind::Stop => {
                        let why = if reason.is_empty() { "no reason given" } else { &reason };
                        self.latch(RuleId(4), format!("software stop: {why}"), now);
                    }
                    RequestKind::Home | RequestKind::Arm => {
                        self.arena_confirmed_clear = self.persons.is_empty();
                        self.enter(to, kind.name(), now);
                    }
                    RequestKind::Disarm => self.enter(to, "disarmed", now),
                    RequestKind::Reset => {
                        self.supervisor.software_stop(false, "not pressed", now, &mut self.pending);
                        self.enter(to, &format!("reset: {reason}"), now);
                    }
                }
                Answer { outcome: Outcome::Accepted, detail: format!("now {}", self.mode.name()) }
            }
        }
    }

    pub(super) fn conditions(&self, now: Time) -> Conditions {
        Conditions {
            homed: self.report.is_some_and(|r| r.homing == Homing::Homed),
            moves: self.report.is_some() && !self.rests(now),
            cause_still_there: self.supervisor.cause_still_there(),
        }
    }

    /// The keep-out shape, in words, that homing would come too near: straight to the corner, each axis until its switch.
    fn shape_on_the_way_home(&self) -> Option<String> {
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
                let id = &self.scene.spec().keep_outs[index].id;
                return Some(format!(
                    "homing would come within {needed:.2} m of the keep-out shape \"{id}\""
                ));
            }
        }
        None
    }

    fn confirm_origin(&mut self, id: PersonId) -> Answer {
        match self.persons.iter_mut().find(|p| p.id() == id) {
            None => refused(format!("person {} is not in the arena", id.0)),
            Some(person) if !person.awaits_confirmation() => {
                Answer { outcome: Outcome::AlreadySo, detail: "this person's origin is confirmed".to_owned() }
            }
            Some(person) => {
                person.confirm_origin();
                Answer { outcome: Outcome::Accepted, detail: format!("person {} confirmed", id.0) }
            }
        }
    }

    fn confirm_left(&mut self, now: Time, id: PersonId) -> Answer {
        match self.person(id) {
            None => refused(format!("person {} is not in the arena", id.0)),
            Some(person) if person.lost(now, &self.parameters).is_none() => {
                refused(format!("the headset of person {} is tracked: they are in the arena", id.0))
            }
            Some(_) => {
                self.leave(id);
                Answer { outcome: Outcome::Accepted, detail: format!("person {} has left", id.0) }
            }
        }
    }

    pub(super) fn leave(&mut self, id: PersonId) {
        let before = self.persons.len();
        self.persons.retain(|p| p.id() != id);
        if self.persons.len() < before {
            self.pending.push(EventKind::PersonLeft(id));
        }
    }

    fn set_priors(&mut self, changes: &[(usize, f64)]) -> Answer {
        for (index, prior) in changes {
            if *index >= self.priors.len() {
                return refused(format!("object {index} of {} objects", self.priors.len()));
            }
            if !(0.0..=1.0).contains(prior) {
                return refused(format!("prior {prior} of object {index}: expected 0 to 1"));
            }
        }
        for (index, prior) in changes {
            self.priors[*index] = *prior;
        }
        Answer { outcome: Outcome::Accepted, detail: format!("{} priors set", changes.len()) }
    }

    fn activate(&mut self, scene: Arc<Scene>) -> Answer {
        if self.mode == Mode::Homing {
            return refused("homing: wait until it is done".to_owned());
        }
        if let Some(report) = self.report.filter(|r| r.homing == Homing::Homed) {
            // Inside a keep-out's distance nothing may move, so the column would be shut in.
            let shuts_in =
                |k: &KeepOut| k.distance_m(scene.footprint(), report.position) < self.parameters.radius_m;
            if let Some(index) = scene.keep_outs().iter().position(shuts_in) {
                let (id, r) = (&scene.spec().keep_outs[index].id, self.parameters.radius_m);
                return refused(format!(
                    "the column stands within {r} m of the keep-out shape \"{id}\": move it away first"
                ));
            }
        }
        self.priors = scene.spec().objects.iter().map(|o| o.prior).collect();
        self.scene = scene;
        self.following.forget_visitors();
        for person in &mut self.persons {
            person.place_among(&self.scene);
        }
        Answer { outcome: Outcome::Accepted, detail: "scene activated".to_owned() }
    }
}

fn refused(detail: String) -> Answer {
    Answer { outcome: Outcome::Refused, detail }
}

/// Homing's course is looked at this often, m.
const HOMING_LOOK_M: f64 = 0.02;
/// Homing backs off and comes back by about this much, m.
const HOMING_MARGIN_M: f64 = 0.06;
