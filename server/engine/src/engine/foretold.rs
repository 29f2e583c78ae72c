//! What may be said of an object ahead of time: when the column is there, and when the hand is.

use super::Engine;
use super::following::{IN_PLACE_M, IN_PLACE_MPS};
use crate::frames::{Floor, Planar};
use crate::intention;
use crate::mode::Mode;
use crate::motion::arrival::in_time_probability;
use crate::motion::travel_secs;

/// An object, should the served visitor mean it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Foretold {
    /// When the column is in place for it, s from now: by the plan that it drives now where that leads there, people in
    /// the way and soft start included, else at its limits from rest; 0 while it is in place.
    pub arrival_secs: f64,
    /// When the visitor's hand could be at it, s from now; none without a visitor.
    pub touch_secs: Option<f64>,
    /// The column comes only while the engine follows.
    follows: bool,
}

impl Foretold {
    /// How much later than the hand the column is in place, s; negative: earlier; none without a visitor.
    pub fn late_by_secs(&self) -> Option<f64> {
        self.touch_secs.map(|touch| self.arrival_secs - touch)
    }

    /// The probability that the column is in place before the hand, 0 to 1: 0 for what it is not in place for while it
    /// does not follow; none without a visitor.
    pub fn in_time_probability(&self) -> Option<f64> {
        let comes = self.follows || self.arrival_secs == 0.0;
        self.touch_secs.map(|touch| if comes { in_time_probability(self.arrival_secs, touch) } else { 0.0 })
    }
}

impl Engine {
    /// What may be said of the object of this index, by the state of the last step; none where there is no such object.
    pub fn foretell(&self, object: usize) -> Option<Foretold> {
        let place = self.scene.objects().get(object)?.column_place();
        let visitor = self.following.serves().and_then(|id| self.person(id));
        let sight = self.following.sights().and_then(|sights| sights.get(object));
        let touch_secs = visitor.zip(sight).map(|(v, sight)| intention::touch_secs(sight, v.velocity()));
        let follows = self.mode == Mode::Following;
        Some(Foretold { arrival_secs: self.arrives_in_secs(place), touch_secs, follows })
    }

    fn arrives_in_secs(&self, place: Floor) -> f64 {
        let from = self.report.map_or(Floor::new(0.0, 0.0), |r| r.position);
        let velocity = self.report.map_or(Planar::ZERO, |r| r.velocity);
        if from.distance_m(place) < IN_PLACE_M && velocity.norm() < IN_PLACE_MPS {
            return 0.0;
        }
        let leads_there = self.mode == Mode::Following
            && self.following.wish().is_some_and(|wish| wish.target.distance_m(place) < SAME_PLACE_M);
        let planned = self.following.foreseen_arrival_secs().filter(|_| leads_there);
        planned.unwrap_or_else(|| travel_secs(from, place, &self.config.limits))
    }
}

/// A plan to within this of a place leads there, m.
const SAME_PLACE_M: f64 = 0.01;
