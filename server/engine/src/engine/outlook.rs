//! The outlook: where the column would go from here if everybody looked where they look, walked on for as long as a
//! present velocity is believed, and then stood.
//!
//! It is a copy of what the engine decides with, rolled forward by the engine's own code before a machine that follows
//! perfectly. It yields places and weights. It never makes a command, and nothing that it finds is decided upon.

use std::sync::Arc;

use super::Engine;
use super::following::{Following, Offer, Wish};
use crate::frames::{Floor, Planar};
use crate::intention::Belief;
use crate::machine::{Limits, Travel};
use crate::mode::Mode;
use crate::motion::foresight::WALKS_ON_SECS;
use crate::observation::PersonId;
use crate::person::Person;
use crate::safety::governor::Governor;
use crate::safety::parameters::Parameters;
use crate::safety::path::State;
use crate::safety::separation::{Separation, Threat};
use crate::scene::Scene;
use crate::time::{Span, Time};

/// What the engine decides with at one moment, to be looked at by others. Cheap to make.
#[derive(Debug, Clone)]
pub struct Outlook {
    at: Time,
    scene: Arc<Scene>,
    priors: Vec<f64>,
    enabled: Vec<bool>,
    limits: Limits,
    travel: Travel,
    parameters: Parameters,
    persons: Vec<Person>,
    following: Following,
    /// The commanded state and for how long the column has been following; none while it is not.
    under_way: Option<(Governor, Span)>,
}

/// What the rule would make of other priors, and where the column would go.
#[derive(Debug, Clone, PartialEq)]
pub struct Preview {
    /// Where it would be wanted; none when nobody would be served.
    pub target: Option<Floor>,
    /// Whom it would serve.
    pub serves: Option<PersonId>,
    /// The object that the rule would be committed to, as an index into the scene's.
    pub committed: Option<usize>,
    /// Where the column would go, [`POINT_EVERY`] apart.
    pub path: Vec<Floor>,
    /// Each object of the scene, in its order.
    pub objects: Vec<PreviewedObject>,
}

/// An object under other priors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PreviewedObject {
    /// W of the rule for the served visitor, prior included.
    pub weight: f64,
    /// The share of the weight.
    pub probability: f64,
    /// The prior.
    pub prior: f64,
}

impl Engine {
    /// A copy of what it decides with at `now`.
    pub fn outlook(&self, now: Time) -> Outlook {
        let governor = self.governor.or_else(|| {
            let report = self.report?;
            Some(Governor::taking_over(report.position))
        });
        Outlook {
            at: now,
            scene: Arc::clone(&self.scene),
            priors: self.priors.clone(),
            enabled: self.enabled.clone(),
            limits: self.config.limits,
            travel: self.config.travel,
            parameters: self.parameters,
            persons: self.persons.clone(),
            following: self.following.clone(),
            under_way: governor
                .filter(|_| self.mode == Mode::Following)
                .map(|governor| (governor, now - self.mode_since)),
        }
    }
}

impl Outlook {
    /// The places that the column would pass, [`POINT_EVERY`] apart, [`MOST_POINTS`] at most; none when it goes nowhere.
    pub fn path(&self) -> Vec<Floor> {
        if self.under_way.is_none() {
            return Vec::new();
        }
        let mut ahead = self.clone();
        let wish = ahead.weigh();
        ahead.roll(wish)
    }

    /// The same with other priors, one for each object of the scene; a missing one is as it is.
    pub fn with_priors(&self, priors: &[f64]) -> Preview {
        let mut ahead = self.clone();
        for (prior, wanted) in ahead.priors.iter_mut().zip(priors) {
            *prior = *wanted;
        }
        let wish = ahead.weigh();
        let shown = ahead.following.wish().copied();
        let nobody = Belief::default();
        let belief = ahead.following.belief().unwrap_or(&nobody);
        let total = belief.total();
        let objects = ahead.priors.iter().enumerate().map(|(i, prior)| PreviewedObject {
            weight: belief.weights.get(i).copied().unwrap_or(0.0),
            probability: belief.weights.get(i).filter(|_| total > 0.0).map_or(0.0, |w| w / total),
            prior: *prior,
        });
        Preview {
            target: shown.map(|w| w.target),
            serves: shown.map(|w| w.visitor),
            committed: shown.and_then(|w| w.committed),
            objects: objects.collect(),
            path: ahead.roll(wish),
        }
    }

    /// The priors in force.
    pub fn priors(&self) -> &[f64] {
        &self.priors
    }

    /// The scene in force.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// With everybody as they are: a second look would find the same, so one is enough for the whole way.
    fn weigh(&mut self) -> Option<Wish> {
        let offer = Offer { scene: &self.scene, priors: &self.priors, enabled: &self.enabled };
        self.following.wanted(&self.persons, &offer, self.at, &self.parameters, &self.limits)
    }

    fn roll(self, wish: Option<Wish>) -> Vec<Floor> {
        let Some((mut governor, mut since)) = self.under_way else { return Vec::new() };
        let mut following = self.following;
        let now: Vec<Threat> = self.persons.iter().filter_map(|person| person.threat(self.at)).collect();
        let mut threats = now.clone();
        let mut ahead = Span::ZERO;
        let from = governor.commanded().position();
        let mut path: Vec<Floor> = Vec::with_capacity(MOST_POINTS);
        let mut points_at_rest = 0;
        while path.len() < MOST_POINTS && points_at_rest < RESTS_AFTER_POINTS {
            for _ in 0..STEPS_A_POINT {
                for (threat, now) in threats.iter_mut().zip(&now) {
                    *threat = walked_on(now, ahead);
                }
                following.foresee(threats.iter().copied());
                let separation = Separation {
                    scene: &self.scene,
                    limits: &self.limits,
                    travel: &self.travel,
                    threats: &threats,
                    parameters: &self.parameters,
                    contact: None,
                };
                let commanded = governor.commanded();
                let measured = State::moving(commanded.position(), commanded.velocity());
                following.follow(&mut governor, wish, &measured, &separation, since, STEP);
                since = since + STEP;
                ahead = ahead + STEP;
            }
            let here = governor.commanded().position();
            let moved_m = path.last().unwrap_or(&from).distance_m(here);
            points_at_rest = if moved_m < STANDS_M { points_at_rest + 1 } else { 0 };
            path.push(here);
        }
        path.truncate(path.len() - points_at_rest);
        path
    }
}

/// A person so much later, as the safety rule will see them: with a pose as old as it is now.
fn walked_on(now: &Threat, ahead: Span) -> Threat {
    let walks = WALKS_ON_SECS.min(ahead.secs());
    let velocity = if ahead.secs() < WALKS_ON_SECS { now.velocity } else { Planar::ZERO };
    Threat { head: now.head + now.velocity * walks, velocity, ..*now }
}

/// Between two points of a path.
pub const POINT_EVERY: Span = Span::from_millis(100);
/// Four seconds: farther ahead people do something else.
pub const MOST_POINTS: usize = 40;
/// The engine's code takes steps of this length here, five periods at the usual rate at the cost of one. Its motions
/// are closed forms of time: for two seconds the way is the same within a centimetre. Later, along the edge of what the
/// separation allows, small differences in time grow; 0.1 m was the most seen.
const STEP: Span = Span::from_millis(20);
const STEPS_A_POINT: usize = 5;
/// A column that moves less than this from point to point stands, m.
const STANDS_M: f64 = 0.002;
/// The way ends where the column has stood for so many points.
const RESTS_AFTER_POINTS: usize = 5;
