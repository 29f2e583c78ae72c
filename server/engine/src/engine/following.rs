//! In `following`: whom the column serves, where it is wanted, and what safety makes of the way there.

mod pursuit;

use crate::event::EventKind;
use crate::frames::{Floor, Planar};
use crate::intention::{self, Belief, IntentionParameters, Rule, RuleName, Sight, View};
use crate::machine::Limits;
use crate::motion::foresight::Walker;
use crate::motion::planner::Planner;
use crate::motion::proxy::Proxy;
use crate::motion::standing::{self, Chance, StandingName};
use crate::motion::{MotionName, Proposals};
use crate::observation::PersonId;
use crate::person::Person;
use crate::safety::parameters::Parameters;
use crate::safety::path::State;
use crate::safety::separation::{Conflict, Threat};
use crate::scene::Scene;
use crate::time::{Span, Time};

/// What the column is wanted for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wish {
    /// Whom it serves.
    pub visitor: PersonId,
    /// The command position.
    pub target: Floor,
    /// The object that the visitor's rule is committed to.
    pub committed: Option<usize>,
    /// When the most probable object would be touched, s from now.
    pub touch_secs: Option<f64>,
}

impl Wish {
    /// To be at a place for no object's sake.
    pub const fn aside(visitor: PersonId, target: Floor) -> Self {
        Self { visitor, target, committed: None, touch_secs: None }
    }
}

/// What can be served, and how likely it is.
#[derive(Debug, Clone, Copy)]
pub struct Offer<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The priors in force, by object.
    pub priors: &'a [f64],
    /// Which objects can be served now.
    pub enabled: &'a [bool],
}

/// One visitor with a rule of their own.
#[derive(Debug, Clone)]
struct Visitor {
    person: PersonId,
    rule: Box<dyn Rule>,
    sights: Vec<Sight>,
    belief: Belief,
    /// When the pose was taken that the belief is about; a rule that sees the same again finds the same.
    believed_at: Option<Time>,
}

/// Intention of every visitor, and the proxy.
#[derive(Debug, Clone)]
pub struct Following {
    rule: RuleName,
    /// As it begins for everybody.
    fresh: Box<dyn Rule>,
    motion: MotionName,
    standing: StandingName,
    visitors: Vec<Visitor>,
    /// The priors that the beliefs are about, and which objects were enabled then.
    believed_priors: Vec<f64>,
    believed_enabled: Vec<bool>,
    serves: Option<PersonId>,
    wish: Option<Wish>,
    proxy: Proxy,
    proposals: Proposals,
    planner: Planner,
    /// It would be late in the middle of what it makes for.
    stops_short: bool,
    walkers: Vec<Walker>,
    chances: Vec<Chance>,
    conflict: Option<Conflict>,
    /// The last conflict, and how long ago it was.
    last_conflict: Option<(Conflict, Span)>,
    /// The way of the last period led around somebody.
    goes_around: bool,
    clearances_m: Vec<f64>,
    announced: Option<(PersonId, usize)>,
}

impl Following {
    pub fn new(
        rule: RuleName,
        parameters: &IntentionParameters,
        motion: MotionName,
        standing: StandingName,
    ) -> Self {
        Self {
            rule,
            fresh: rule.rule(parameters),
            motion,
            standing,
            visitors: Vec::new(),
            believed_priors: Vec::new(),
            believed_enabled: Vec::new(),
            serves: None,
            wish: None,
            proxy: Proxy::at(Floor::new(0.0, 0.0)),
            proposals: Proposals::default(),
            planner: Planner::default(),
            stops_short: false,
            walkers: Vec::new(),
            chances: Vec::new(),
            conflict: None,
            last_conflict: None,
            goes_around: false,
            clearances_m: Vec::new(),
            announced: None,
        }
    }

    /// What is wanted of the column: nothing while somebody has come in and nobody knows yet where they are.
    pub fn wanted(
        &mut self,
        persons: &[Person],
        offer: &Offer<'_>,
        now: Time,
        parameters: &Parameters,
        limits: &Limits,
    ) -> Option<Wish> {
        let wish = self.weigh(persons, offer, now, parameters, limits);
        wish.filter(|_| !persons.iter().any(Person::is_unseen))
    }

    /// Weigh every visitor's objects and choose whom to serve: the strongest intention, with some constancy.
    fn weigh(
        &mut self,
        persons: &[Person],
        &Offer { scene, priors, enabled }: &Offer<'_>,
        now: Time,
        parameters: &Parameters,
        limits: &Limits,
    ) -> Option<Wish> {
        self.foresee(persons.iter().filter_map(|p| p.threat(now)));
        self.visitors.retain(|v| persons.iter().any(|p| p.id() == v.person));
        if self.believed_priors != priors || self.believed_enabled != enabled {
            self.believed_priors.clear();
            self.believed_priors.extend_from_slice(priors);
            self.believed_enabled.clear();
            self.believed_enabled.extend_from_slice(enabled);
            self.visitors.iter_mut().for_each(|v| v.believed_at = None);
        }
        self.clearances_m.clear();
        for person in persons {
            self.clearances_m.push(cone_radius_m(person.nearest_object_m()));
            let Some(sample) = person.newest().filter(|_| person.lost(now, parameters).is_none()) else {
                continue;
            };
            let index = self.visitors.iter().position(|v| v.person == person.id()).unwrap_or_else(|| {
                let rule = self.fresh.clone();
                let (sights, belief) = (Vec::new(), Belief::default());
                self.visitors.push(Visitor { person: person.id(), rule, sights, belief, believed_at: None });
                self.visitors.len() - 1
            });
            let visitor = &mut self.visitors[index];
            if visitor.believed_at != Some(sample.taken_at) {
                intention::sights(scene, priors, enabled, &sample.pose, &mut visitor.sights);
                let view = View {
                    taken_at: sample.taken_at,
                    head: sample.pose,
                    velocity: person.velocity(),
                    hands: sample.hands,
                    sights: &visitor.sights,
                };
                visitor.rule.weigh(&view, &mut visitor.belief);
                visitor.believed_at = Some(sample.taken_at);
            }
        }
        let reliable =
            |v: &&Visitor| persons.iter().any(|p| p.id() == v.person && p.lost(now, parameters).is_none());
        let strength = |v: &Visitor| {
            let strongest = v.belief.weights.iter().copied().fold(0.0, f64::max);
            strongest + if self.serves == Some(v.person) { CONSTANCY } else { 0.0 }
        };
        let served = self
            .visitors
            .iter()
            .filter(reliable)
            .max_by(|a, b| strength(a).total_cmp(&strength(b)).then(b.person.cmp(&a.person)));
        let held = self.wish.map(|w| w.target);
        self.wish = served.and_then(|v| {
            let velocity = persons.iter().find(|p| p.id() == v.person)?.velocity();
            let target = match self.standing {
                StandingName::Mean => intention::command_position(scene, &v.belief)?,
                StandingName::InTime => {
                    v.chances(scene, velocity, &mut self.chances);
                    standing::stand(&self.chances, held, &self.walkers, limits)?
                }
            };
            let touch_secs = v.belief.best().map(|i| intention::touch_secs(&v.sights[i], velocity));
            Some(Wish { visitor: v.person, target, committed: v.belief.committed, touch_secs })
        });
        self.serves = served.map(|v| v.person);
        self.wish
    }

    /// Where everybody is, and goes on to, for the plans to come.
    pub fn foresee(&mut self, threats: impl Iterator<Item = Threat>) {
        self.walkers.clear();
        self.walkers.extend(threats.map(|threat| Walker::foreseen(&threat)));
    }

    /// The column is not following: the ball lies where it stands.
    pub fn rest_at(&mut self, column: Floor) {
        self.proxy = Proxy::at(column);
        self.stops_short = false;
        self.conflict = None;
        self.last_conflict = None;
        self.goes_around = false;
        self.announced = None;
    }

    /// The scene changed: every visitor starts anew.
    pub fn forget_visitors(&mut self) {
        self.visitors.clear();
        self.announced = None;
    }

    /// The column stands at the object and the visitor is within reach: said once.
    pub fn served(&mut self, measured: &State, scene: &Scene, persons: &[Person]) -> Option<EventKind> {
        let wish = self.wish?;
        let index = wish.committed?;
        let object = scene.objects().get(index)?;
        let head = persons.iter().find(|p| p.id() == wish.visitor)?.newest()?.pose;
        let in_place = measured.position().distance_m(object.column_place()) < IN_PLACE_M;
        let still = measured.velocity().norm() < IN_PLACE_MPS;
        if object.distance_m(&head.position) > WITHIN_REACH_M {
            if self.announced == Some((wish.visitor, index)) {
                self.announced = None;
            }
            return None;
        }
        if !(in_place && still) || self.announced == Some((wish.visitor, index)) {
            return None;
        }
        self.announced = Some((wish.visitor, index));
        Some(EventKind::Served { person: wish.visitor, object: index })
    }

    /// The objects as this visitor has them, of the newest pose.
    pub fn sights_of(&self, person: PersonId) -> Option<&[Sight]> {
        self.visitors.iter().find(|v| v.person == person).map(|v| &v.sights[..])
    }

    /// What is in the way of the wanted motion.
    pub fn conflict(&self) -> Option<Conflict> {
        self.conflict
    }

    /// What holds the column: a conflict now or a moment ago. At the edge of what is allowed it comes and goes from
    /// period to period.
    pub fn held_by(&self) -> Option<Conflict> {
        self.last_conflict.map(|(conflict, _)| conflict)
    }

    /// The way leads around somebody.
    pub fn goes_around(&self) -> bool {
        self.goes_around
    }

    pub fn wish(&self) -> Option<&Wish> {
        self.wish.as_ref()
    }

    pub fn proxy(&self) -> &Proxy {
        &self.proxy
    }

    pub fn rule(&self) -> RuleName {
        self.rule
    }

    pub fn motion(&self) -> MotionName {
        self.motion
    }

    pub fn standing(&self) -> StandingName {
        self.standing
    }

    /// How long the planner's present plan takes, s; none with another motion, and where it does not arrive.
    pub fn arrives_in_secs(&self) -> Option<f64> {
        self.planner.arrives_in_secs().filter(|_| self.motion == MotionName::Planner)
    }

    /// The same; past the horizon, and by what is left there, where it does not arrive.
    pub fn foreseen_arrival_secs(&self) -> Option<f64> {
        Some(self.planner.arrival_secs()).filter(|_| self.motion == MotionName::Planner)
    }

    /// The belief about the served visitor.
    pub fn belief(&self) -> Option<&Belief> {
        self.served_visitor().map(|v| &v.belief)
    }

    /// The objects as the served visitor has them.
    pub fn sights(&self) -> Option<&[Sight]> {
        self.served_visitor().map(|v| &v.sights[..])
    }

    pub fn serves(&self) -> Option<PersonId> {
        self.serves
    }

    fn served_visitor(&self) -> Option<&Visitor> {
        let serves = self.serves?;
        self.visitors.iter().find(|v| v.person == serves)
    }
}

impl Visitor {
    /// What may be touched, the most probable first.
    fn chances(&self, scene: &Scene, velocity: Planar, out: &mut Vec<Chance>) {
        out.clear();
        let total = self.belief.total();
        for ((object, sight), weight) in scene.objects().iter().zip(&self.sights).zip(&self.belief.weights) {
            if *weight > LEAST_CHANCE * total {
                out.push(Chance {
                    place: object.column_place(),
                    probability: weight / total,
                    touch_secs: intention::touch_secs(sight, velocity),
                });
            }
        }
        out.sort_by(|a, b| b.probability.total_cmp(&a.probability));
        out.truncate(MOST_CHANCES);
    }
}

/// The paper's cone: 45 cm around a person, shrinking smoothly to 20 cm as the head comes near an object.
fn cone_radius_m(nearest_object_m: f64) -> f64 {
    let share = ((nearest_object_m - CONE_SMALL_WITHIN_M) / (CONE_LARGE_FROM_M - CONE_SMALL_WITHIN_M))
        .clamp(0.0, 1.0);
    CONE_SMALL_M + (CONE_LARGE_M - CONE_SMALL_M) * share
}

/// What is less probable is not worth a place.
const LEAST_CHANCE: f64 = 0.01;
const MOST_CHANCES: usize = 6;
/// A visitor who is served keeps being served against one who is this much stronger.
const CONSTANCY: f64 = 0.1;
const CONE_LARGE_M: f64 = 0.45;
const CONE_SMALL_M: f64 = 0.20;
const CONE_SMALL_WITHIN_M: f64 = 0.40;
const CONE_LARGE_FROM_M: f64 = 0.75;
/// Success as the evaluation has it: nearer than this the column is in place, m.
pub const IN_PLACE_M: f64 = 0.1;
/// And slower than this, m/s.
pub const IN_PLACE_MPS: f64 = 0.05;
/// An arm's length from the head to the surface, m.
const WITHIN_REACH_M: f64 = 0.75;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cone_is_the_papers() {
        assert!((cone_radius_m(2.0) - 0.45).abs() < 1e-12);
        assert!((cone_radius_m(0.1) - 0.20).abs() < 1e-12);
        assert!(cone_radius_m(0.5) < cone_radius_m(0.6));
    }
}
