//! What may be said of an object ahead of time: when the column is there, and when the hand is.

use super::Engine;
use super::following::{IN_PLACE_M, IN_PLACE_MPS};
use crate::frames::{Floor, Planar};
use crate::intention;
use crate::mode::Mode;
use crate::motion::{arrival, travel_secs};

/// An object, should the served visitor mean it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Foretold {
    /// When the column is in place for it, s from now: by the plan that it drives now where that leads there, people in
    /// the way and soft start included, else at its limits from rest; 0 while it is in place.
    pub arrival_secs: f64,
    /// When the visitor's hand could be at it, s from now; none without a visitor.
    pub touch_secs: Option<f64>,
    /// The shift of the virtual object, room frame, m, by which it is where its prop will be when the hand comes, within the
    /// published detection threshold; none where the column makes for something else, and where no shift is needed or would serve.
    pub offset: Option<Planar>,
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
        self.touch_secs
            .map(|touch| if comes { arrival::in_time_probability(self.arrival_secs, touch) } else { 0.0 })
    }
}

impl Engine {
    /// What may be said of the object of this index, by the state of the last step; none where there is no such object.
    pub fn foretell(&self, object: usize) -> Option<Foretold> {
        let place = self.scene.objects().get(object)?.column_place();
        let visitor = self.following.serves().and_then(|id| self.person(id));
        let sight = self.following.sights().and_then(|sights| sights.get(object));
        let touch_secs = visitor.zip(sight).map(|(v, sight)| intention::touch_secs(sight, v.velocity()));
        let arrival_secs = self.arrives_in_secs(place);
        let offset = touch_secs.and_then(|touch| self.offset(place, arrival_secs - touch));
        Some(Foretold { arrival_secs, touch_secs, offset, follows: self.mode == Mode::Following })
    }

    fn arrives_in_secs(&self, place: Floor) -> f64 {
        let from = self.report.map_or(Floor::new(0.0, 0.0), |r| r.position);
        let velocity = self.report.map_or(Planar::ZERO, |r| r.velocity);
        if from.distance_m(place) < IN_PLACE_M && velocity.norm() < IN_PLACE_MPS {
            return 0.0;
        }
        let planned = self.following.foreseen_arrival_secs().filter(|_| self.makes_for(place));
        planned.unwrap_or_else(|| travel_secs(from, place, &self.config.limits))
    }

    fn offset(&self, place: Floor, late_by_secs: f64) -> Option<Planar> {
        let here = self.report.filter(|_| self.makes_for(place))?.position;
        let rests_at = self.following.rests_at(here)?;
        let then = arrival::at_touch(here, rests_at, late_by_secs, &self.config.limits);
        arrival::redirection(then - place, IN_PLACE_M)
    }

    fn makes_for(&self, place: Floor) -> bool {
        self.mode == Mode::Following
            && self.following.wish().is_some_and(|wish| wish.target.distance_m(place) < SAME_PLACE_M)
    }
}

/// A plan to within this of a place leads there, m.
const SAME_PLACE_M: f64 = 0.01;
