//! Where to stand while it is not known which object will be touched: where the column will most likely be in time.
//!
//! The weighted mean may serve no object at all. Here the loss of a place is the probability of arriving late: for each
//! object, that the visitor touches it sooner after it becomes plain which one they mean than the column needs to it.

use crate::frames::{Floor, Planar};
use crate::machine::Limits;
use crate::motion::foresight::Walker;
use crate::motion::travel_secs;

/// The ways to choose where to stand, by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StandingName {
    /// The weighted mean of the objects' places: the paper's command position.
    Mean,
    /// Where the column will most likely be in time.
    InTime,
}

impl StandingName {
    /// Every way.
    pub const ALL: [Self; 2] = [Self::Mean, Self::InTime];

    /// Its name in configuration and JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Mean => "mean",
            Self::InTime => "in-time",
        }
    }

    /// The way of this name.
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|standing| standing.name() == name)
    }
}

/// An object that may be touched.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chance {
    /// Where the column must stand for it.
    pub place: Floor,
    /// How probable it is.
    pub probability: f64,
    /// When it would be touched, s from now.
    pub touch_secs: f64,
}

/// The place of least loss among those worth a look; `held` is kept against a little less. None without any chance.
pub fn stand(chances: &[Chance], held: Option<Floor>, walkers: &[Walker], limits: &Limits) -> Option<Floor> {
    let loss = |place: Floor| -> f64 {
        chances.iter().map(|c| c.probability * lateness(place, c, walkers, limits)).sum()
    };
    let mut best: Option<(Floor, f64)> = None;
    let mut look = |place: Floor, favour: f64| {
        let found = loss(place) - favour;
        if best.is_none_or(|(_, least)| found < least) {
            best = Some((place, found));
        }
    };
    if let Some(held) = held {
        look(held, CONSTANCY);
    }
    for (k, one) in chances.iter().enumerate() {
        look(one.place, 0.0);
        for other in &chances[k + 1..] {
            for share in BETWEEN {
                look(one.place + (other.place - one.place) * share, 0.0);
            }
        }
    }
    if chances.len() > 2 {
        let total: f64 = chances.iter().map(|c| c.probability).sum();
        let origin = Floor::new(0.0, 0.0);
        let sum = chances.iter().fold(Planar::ZERO, |sum, c| sum + (c.place - origin) * c.probability);
        look(origin + sum * (1.0 / total), 0.0);
    }
    best.map(|(place, _)| place)
}

/// The probability that the column is late for an object from a place.
fn lateness(place: Floor, chance: &Chance, walkers: &[Walker], limits: &Limits) -> f64 {
    let straight = travel_secs(place, chance.place, limits);
    let detour =
        walkers.iter().map(|walker| detour_secs(place, chance.place, walker.head)).fold(0.0, f64::max);
    let needed = straight + detour;
    // By then it will be plain which object is meant; late in the reach there is no more than what is left.
    let plain = PLAIN_SECS.min(chance.touch_secs);
    let late = 1.0 / (1.0 + ((plain - needed) / PLAIN_SPREAD_SECS).exp());
    late + NEEDED_LOSS * needed
}

/// How much longer the way around a person is, s.
fn detour_secs(from: Floor, to: Floor, head: Floor) -> f64 {
    let way = to - from;
    let along = ((head - from).dot(way) / way.dot(way).max(1e-9)).clamp(0.0, 1.0);
    let gap = (from + way * along).distance_m(head);
    if along > 0.0 && along < 1.0 { DETOUR_SECS_PER_M * (PASSING_M - gap).max(0.0) } else { 0.0 }
}

/// How long before the touch it is plain which object is meant, s, and how much that varies.
const PLAIN_SECS: f64 = 1.0;
const PLAIN_SPREAD_SECS: f64 = 0.2;
/// The loss of a second on the way, in probability: among places that are all in time the nearer.
const NEEDED_LOSS: f64 = 0.03;
/// A place is left only for one that is better by this probability.
const CONSTANCY: f64 = 0.01;
/// Places looked at between two objects.
const BETWEEN: [f64; 3] = [0.3, 0.5, 0.7];
/// A column at full speed passes a person at this distance between centres, m.
const PASSING_M: f64 = 1.3;
const DETOUR_SECS_PER_M: f64 = 1.2;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::Floor;

    fn chance(x: f64, y: f64, probability: f64, touch_secs: f64) -> Chance {
        Chance { place: Floor::new(x, y), probability, touch_secs }
    }

    fn stands(chances: &[Chance]) -> Floor {
        stand(chances, None, &[], &Limits::PAPER).unwrap()
    }

    #[test]
    fn it_stands_at_what_is_sure_and_nowhere_for_nothing() {
        assert_eq!(stands(&[chance(1.0, 2.0, 0.9, 3.0)]), Floor::new(1.0, 2.0));
        assert_eq!(stand(&[], None, &[], &Limits::PAPER), None);
    }

    #[test]
    fn between_far_objects_it_stands_at_one_and_not_at_their_mean() {
        let chances = [chance(0.5, 2.0, 0.6, 3.0), chance(4.5, 2.0, 0.4, 3.0)];
        assert_eq!(stands(&chances), chances[0].place);
    }

    #[test]
    fn from_between_neighbours_either_is_in_time() {
        let chances = [chance(2.0, 2.0, 0.5, 3.0), chance(2.4, 2.0, 0.5, 3.0)];
        let place = stands(&chances);
        assert!((place.x - 2.2).abs() < 0.1, "{place:?}");
    }

    #[test]
    fn with_the_hand_on_its_way_it_decides() {
        let chances = [chance(2.0, 2.0, 0.55, 0.4), chance(2.8, 2.0, 0.45, 0.4)];
        assert_eq!(stands(&chances), chances[0].place);
    }

    #[test]
    fn a_place_is_kept_against_one_that_is_hardly_better() {
        let chances = [chance(2.0, 2.0, 0.501, 0.4), chance(2.8, 2.0, 0.499, 0.4)];
        let held = Some(chances[1].place);
        assert_eq!(stand(&chances, held, &[], &Limits::PAPER), held);
    }
}
