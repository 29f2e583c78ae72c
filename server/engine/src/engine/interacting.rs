//! Interactions in the engine: which is under way, with whom, and who may be touched by a moving column (R14).
//!
//! ```text
//!   contact (R14)      not armed ──game master arms it for a visitor, for some seconds──▶ armed
//!                          ▲                                                               │
//!                          └── taken back, time over, visitor gone, scene changed, game ───┘
//!                              master's dashboard gone (R11), machine not following
//!
//!   interaction        none ──state offers it, its file's conditions hold──▶ under way ──over, or any of the above──▶ none
//! ```
//!
//! One interaction is under way at a time, and every stop ends it. A stop while somebody leans on the column or rides it keeps the drive on
//! until they let go or a game master says that nobody does: a machine let go would give way under them.

use super::requests::{accepted, refused};
use super::{Answer, Engine, Outcome};
use crate::event::EventKind;
use crate::frames::Floor;
use crate::interaction::{Ask, Over, Phase, Running, Seen};
use crate::mode::Mode;
use crate::observation::PersonId;
use crate::person::Person;
use crate::reason::Reason;
use crate::safety::contact::Contact;
use crate::safety::governor::Governor;
use crate::safety::supervisor::GameMaster;
use crate::scenario::{Happening, Interaction, Trigger};
use crate::snapshot::{ContactState, InteractionState};
use crate::time::{Span, Time};

/// Interactions of this engine.
#[derive(Debug, Default)]
pub(super) struct Interactions {
    under_way: Option<UnderWay>,
    /// The state that those done belong to.
    stay: u64,
    /// By object: it came to its end in this state.
    done: Vec<bool>,
    /// The stay in a state in which a path was left in its middle: for as long as it lasts the column waits there to be taken hold of
    /// again.
    left_on_the_way: Option<u64>,
    armed: Option<Armed>,
    /// Who leans on the column or rides it, as far as is known, and by the touch of which object.
    bears: Option<(PersonId, usize)>,
    stepped_at: Option<Time>,
}

#[derive(Debug)]
struct UnderWay {
    object: usize,
    name: &'static str,
    is_contact: bool,
    person: Option<PersonId>,
    running: Running,
    since: Time,
    /// The stay in a state in which it began.
    stay: u64,
}

/// A game master's word that this visitor may be touched by a moving column, until then.
#[derive(Debug, Clone, Copy)]
struct Armed {
    person: PersonId,
    until: Time,
}

impl Interactions {
    pub(super) fn is_under_way(&self) -> bool {
        self.under_way.is_some()
    }
}

impl Engine {
    /// A contact is armed for a visitor, for so long at most.
    pub(super) fn arm_contact(&mut self, now: Time, person: PersonId, lasts: Span) -> Answer {
        let longest = self.parameters.longest_contact;
        let knows =
            |interactions: &[Option<Interaction>]| interactions.iter().flatten().any(Interaction::is_contact);
        let scenario = self.scene.scenario();
        let refusal = if self.mode != Mode::Following {
            Some(Reason::ScenarioStands)
        } else if !scenario.is_some_and(|s| s.states().iter().any(|state| knows(state.interactions()))) {
            Some(Reason::NoContactInteraction)
        } else if !(SHORTEST_CONTACT..=longest).contains(&lasts) {
            Some(Reason::ContactSecs { least: SHORTEST_CONTACT.secs(), most: longest.secs() })
        } else if self.game_master() == GameMaster::Absent {
            Some(Reason::GameMasterAbsent)
        } else {
            match self.person(person) {
                None => Some(Reason::PersonNotInside(person)),
                Some(found) if found.lost(now, &self.parameters).is_some() => {
                    Some(Reason::PersonNotTracked(person))
                }
                Some(_) => None,
            }
        };
        if let Some(reason) = refusal {
            return refused(reason);
        }
        if self.interactions.armed.is_some_and(|armed| armed.person != person) {
            self.disarm_contact(Reason::ContactForAnother(person));
        }
        self.interactions.armed = Some(Armed { person, until: now + lasts });
        accepted(Reason::ContactArmed(person))
    }

    /// Nobody may be touched by a moving column any more.
    pub(super) fn take_contact_back(&mut self) -> Answer {
        let outcome = if self.interactions.armed.is_some() { Outcome::Accepted } else { Outcome::AlreadySo };
        self.disarm_contact(Reason::ContactTakenBack);
        Answer { outcome, reason: Reason::ContactNotArmed }
    }

    /// Somebody looked: nobody leans on the column or rides it.
    pub(super) fn confirm_free(&mut self) -> Answer {
        let bore = self.interactions.bears.take();
        let outcome = if bore.is_some() { Outcome::Accepted } else { Outcome::AlreadySo };
        Answer { outcome, reason: Reason::NobodyLeans }
    }

    /// Somebody who leans on the column or rides it, as far as is known.
    pub(super) fn bears(&self) -> Option<PersonId> {
        self.interactions.bears.map(|(person, _)| person)
    }

    /// A hand let go of something: where it was the last, nobody leans there any more.
    pub(super) fn hand_off(&mut self) {
        if self.interactions.bears.is_some_and(|(_, object)| self.touching(object).is_empty()) {
            self.interactions.bears = None;
        }
    }

    /// What the interaction under way asks; none is under way: the column follows intention.
    pub(super) fn interact(&mut self, now: Time) -> Ask {
        let elapsed = self.interactions.stepped_at.map_or(Span::ZERO, |before| now - before);
        self.interactions.stepped_at = Some(now);
        if let Some((because, also_contact)) = self.why_no_interaction(now) {
            self.end_interaction(because.clone());
            if also_contact {
                self.disarm_contact(because);
            }
        }
        let (person, status) = (self.interactions.armed.map(|armed| armed.person), self.contact_status());
        self.supervisor.contact(person, status, now, &mut self.pending);
        if self.mode != Mode::Following {
            return Ask::Follow;
        }
        self.begin_interaction(now);
        let Some(UnderWay { object, .. }) = self.interactions.under_way else {
            let waits = self.interactions.left_on_the_way == Some(self.interactions.stay);
            return if waits { Ask::Stay } else { Ask::Follow };
        };
        let touched_by = self.touching(object);
        let Some(seen) = self.seen(object, &touched_by, elapsed, now) else { return Ask::Follow };
        let Some(under_way) = &mut self.interactions.under_way else { return Ask::Follow };
        let was_done = under_way.running.phase() == Phase::Done;
        let step = under_way.running.step(&seen);
        let is_done = under_way.running.phase() == Phase::Done;
        self.interactions.bears = match (step.over, under_way.running.bears_somebody()) {
            (None, true) => touched_by.first().map(|person| (*person, object)),
            (Some(_), _) => None,
            _ => self.interactions.bears,
        };
        if is_done && !was_done {
            self.interaction_done(object);
        }
        if let Some(over) = step.over {
            self.end_interaction(match over {
                Over::LetGo => Reason::InteractionLetGo,
                Over::SteppedOff => Reason::SteppedOff,
                Over::NotMeant => Reason::AnotherIsMeant,
            });
        }
        step.ask
    }

    /// The contact that an ask means.
    pub(super) fn contact_of(&self, ask: Ask) -> Option<Contact> {
        let Ask::Contact(kind, _) = ask else { return None };
        let under_way = self.interactions.under_way.as_ref()?;
        let prop = self.scene.spec().objects[under_way.object].prop;
        let offset = prop.map(|prop| self.scene.spec().props[prop].offset).unwrap_or_default();
        Some(Contact { person: under_way.person?, kind, prop, offset })
    }

    /// Why none may be under way, and whether a contact may not stay armed either.
    fn why_no_interaction(&mut self, now: Time) -> Option<(Reason, bool)> {
        let stay = self.play.as_ref().map_or(0, |play| play.stay());
        let is_another = std::mem::replace(&mut self.interactions.stay, stay) != stay;
        if is_another {
            self.interactions.done.clear();
        }
        if self.mode != Mode::Following {
            return Some((Reason::InteractionStopped(self.mode), true));
        }
        if let Some(armed) = self.interactions.armed {
            let tracked = self.person(armed.person).filter(|p| p.lost(now, &self.parameters).is_none());
            if tracked.is_none() {
                return Some((Reason::PersonNotTracked(armed.person), true));
            }
            if self.game_master() == GameMaster::Absent {
                return Some((Reason::GameMasterAbsent, true));
            }
            if now > armed.until {
                return Some((Reason::ContactTimeOver, true));
            }
        }
        if self.is_in_contact() && self.interactions.armed.is_none() {
            return Some((Reason::ContactNotArmed, false));
        }
        is_another.then_some((Reason::StateLeft, false))
    }

    fn begin_interaction(&mut self, now: Time) {
        let Some(state) =
            self.scene.scenario().zip(self.play.as_ref()).map(|(s, play)| &s.states()[play.state()])
        else {
            return;
        };
        if self.interactions.under_way.is_some() {
            return;
        }
        let begun = state.interactions().iter().enumerate().find_map(|(object, interaction)| {
            let interaction = interaction.as_ref()?;
            if self.interactions.done.get(object).copied().unwrap_or(false) {
                return None;
            }
            let touched_by = self.touching(object);
            let seen = self.seen(object, &touched_by, Span::ZERO, now)?;
            // A contact is with whom it is armed for, whoever else has a hand there.
            let person = match interaction {
                Interaction::Hold => touched_by.first().copied(),
                _ => seen.person.filter(|_| interaction.is_contact()),
            };
            let running = Running::begin(interaction, &seen)?;
            let (name, is_contact) = (interaction.name(), interaction.is_contact());
            let stay = self.interactions.stay;
            Some(UnderWay { object, name, is_contact, person, running, since: now, stay })
        });
        if let Some(begun) = begun {
            let UnderWay { object, name: interaction, person, .. } = begun;
            self.pending.push(EventKind::InteractionBegan { object, interaction, person });
            self.interactions.under_way = Some(begun);
        }
    }

    /// The interaction came to its end: the scenario is told.
    fn interaction_done(&mut self, object: usize) {
        let objects = self.scene.objects().len();
        self.interactions.done.resize(objects, false);
        self.interactions.done[object] = true;
        let person = self.interactions.under_way.as_ref().and_then(|under_way| under_way.person);
        let scene = std::sync::Arc::clone(&self.scene);
        if let (Some(scenario), Some(play)) = (scene.scenario(), &mut self.play) {
            let happening = Happening { trigger: Trigger::InteractionDone(object), person };
            let (_, changes) = play.happen(scenario, happening, true);
            self.tell(scenario, changes);
        }
    }

    pub(super) fn end_interaction(&mut self, because: Reason) {
        if let Some(UnderWay { object, name: interaction, person, running, stay, .. }) =
            self.interactions.under_way.take()
        {
            let has_a_way = matches!(running, Running::Lead(_) | Running::Transport(_));
            self.interactions.left_on_the_way = has_a_way.then_some(stay);
            self.pending.push(EventKind::InteractionEnded { object, interaction, person, because });
        }
    }

    pub(super) fn disarm_contact(&mut self, because: Reason) {
        if self.is_in_contact() {
            self.end_interaction(because.clone());
        }
        if let Some(armed) = self.interactions.armed.take() {
            self.pending.push(EventKind::ContactOver { person: armed.person, because });
        }
    }

    /// Another scene: its objects are others.
    pub(super) fn forget_interactions(&mut self) {
        self.end_interaction(Reason::StateLeft);
        self.disarm_contact(Reason::StateLeft);
        self.interactions.done.clear();
        self.interactions.left_on_the_way = None;
    }

    fn is_in_contact(&self) -> bool {
        self.interactions.under_way.as_ref().is_some_and(|under_way| under_way.is_contact)
    }

    fn contact_status(&self) -> Option<&'static str> {
        self.interactions.under_way.as_ref().filter(|now| now.is_contact).map(|now| now.name)
    }

    fn touching(&self, object: usize) -> Vec<PersonId> {
        self.play.as_ref().map_or_else(Vec::new, |play| play.senses().touching(object).collect())
    }

    fn seen<'s>(
        &self,
        object: usize,
        touched_by: &'s [PersonId],
        elapsed: Span,
        now: Time,
    ) -> Option<Seen<'s>> {
        let report = self.report?;
        let armed = self.interactions.armed.map(|armed| armed.person);
        let person = armed.or(touched_by.first().copied());
        let tracked =
            person.and_then(|id| self.person(id)).filter(|p| p.lost(now, &self.parameters).is_none());
        let head = tracked.and_then(|p| Some((p.newest()?.pose.position.floor(), p.velocity())));
        let prop = self.scene.spec().objects[object].prop.map(|prop| &self.scene.spec().props[prop]);
        let column = self.governor.as_ref().map_or(report.position, |g| g.commanded().position());
        Some(Seen {
            elapsed,
            column,
            rests: self.rests(now) && self.governor.as_ref().is_none_or(Governor::rests),
            place: self.scene.objects()[object].column_place(),
            offset: prop.map(|prop| prop.offset).unwrap_or_default(),
            facing_rad: prop.map_or(0.0, |prop| prop.facing_rad),
            current_amps: report.current_amps[0].max(report.current_amps[1]),
            touched_by,
            person,
            is_armed: armed.is_some(),
            head,
            is_meant: self.following.wish().and_then(|wish| wish.committed) == Some(object),
            out_of_reach: self.out_of_reach(),
        })
    }

    /// The corner of the travel that is farthest from everybody.
    fn out_of_reach(&self) -> Floor {
        let inside = self.config.travel.shrunk(self.parameters.travel_margin_m);
        let (a, b) = (inside.min, inside.max);
        let corners = [a, Floor::new(b.x, a.y), b, Floor::new(a.x, b.y)];
        let room = |corner: &Floor| {
            let heads = self.persons.iter().filter_map(Person::newest);
            heads.map(|head| head.pose.position.floor().distance_m(*corner)).fold(f64::INFINITY, f64::min)
        };
        corners.into_iter().max_by(|a, b| room(a).total_cmp(&room(b))).unwrap_or(a)
    }

    pub(super) fn interaction_state(&self, now: Time) -> Option<InteractionState> {
        let under_way = self.interactions.under_way.as_ref()?;
        Some(InteractionState {
            object: under_way.object,
            interaction: under_way.name,
            phase: under_way.running.phase().name(),
            person: under_way.person,
            lasted_secs: (now - under_way.since).secs(),
        })
    }

    pub(super) fn contact_state(&self, now: Time) -> Option<ContactState> {
        let armed = self.interactions.armed?;
        Some(ContactState { person: armed.person, left_secs: (armed.until - now).secs().max(0.0) })
    }
}

/// Nobody arms a contact for less.
const SHORTEST_CONTACT: Span = Span::from_millis(1_000);
