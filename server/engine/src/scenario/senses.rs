//! What a scenario knows of people and the column: touches, places, looks. Levels with the time since when, on the scenario's clock.

use super::spec::Trigger;
use crate::observation::PersonId;
use crate::time::Span;

/// Who does what, and since when.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Senses {
    touches: Vec<Since>,
    looks: Vec<Since>,
    inside: Vec<(PersonId, usize)>,
    in_place: Vec<usize>,
}

/// Somebody at an object since a moment of the scenario's clock.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Since {
    person: PersonId,
    object: usize,
    since: Span,
}

impl Senses {
    /// A hand met an object; false when it was there already.
    pub fn touch(&mut self, person: PersonId, object: usize, clock: Span) -> bool {
        begin(&mut self.touches, person, object, clock)
    }

    /// A hand let go; false when it was not there.
    pub fn let_go(&mut self, person: PersonId, object: usize) -> bool {
        end(&mut self.touches, person, object)
    }

    /// How far somebody is from a zone over the floor, m; 0 inside. What that changes. Leaving takes [`LEAVES_M`], so that
    /// somebody who stands on the line does not come and go.
    pub fn stand(&mut self, person: PersonId, zone: usize, distance_m: f64) -> Option<Trigger<usize>> {
        let was_inside = self.inside.iter().position(|known| *known == (person, zone));
        match was_inside {
            None if distance_m <= 0.0 => {
                self.inside.push((person, zone));
                Some(Trigger::ZoneEntered(zone))
            }
            Some(index) if distance_m > LEAVES_M => {
                self.inside.remove(index);
                Some(Trigger::ZoneLeft(zone))
            }
            _ => None,
        }
    }

    /// The angle between somebody's view axis and an object, rad; 0 when the view ray hits it.
    pub fn look(&mut self, person: PersonId, object: usize, angle_rad: f64, clock: Span) {
        if angle_rad <= LOOKS_RAD {
            begin(&mut self.looks, person, object, clock);
        } else if angle_rad > LOOKS_AWAY_RAD {
            end(&mut self.looks, person, object);
        }
    }

    /// Nobody knows where somebody looks now.
    pub fn lose_sight_of(&mut self, person: PersonId) {
        self.looks.retain(|look| look.person != person);
    }

    /// The objects that the column stands still for.
    pub fn stand_column(&mut self, objects: impl Iterator<Item = usize>) {
        self.in_place.clear();
        self.in_place.extend(objects);
    }

    /// Somebody has left the arena: what that ends, the touches first.
    pub fn leave(&mut self, person: PersonId) -> Vec<Trigger<usize>> {
        let touches = self.touches.iter().filter(|touch| touch.person == person);
        let mut ended: Vec<_> = touches.map(|touch| Trigger::TouchEnded(touch.object)).collect();
        let zones = self.inside.iter().filter(|(known, _)| *known == person);
        ended.extend(zones.map(|(_, zone)| Trigger::ZoneLeft(*zone)));
        self.touches.retain(|touch| touch.person != person);
        self.inside.retain(|(known, _)| *known != person);
        self.lose_sight_of(person);
        ended
    }

    /// Since when somebody touches an object: the longest of all hands.
    pub fn touched_since(&self, object: usize) -> Option<Span> {
        since(&self.touches, object)
    }

    /// Everybody who touches an object.
    pub fn touching(&self, object: usize) -> impl Iterator<Item = PersonId> {
        self.touches.iter().filter(move |touch| touch.object == object).map(|touch| touch.person)
    }

    /// Since when somebody looks at an object: the longest of all looks.
    pub fn looked_at_since(&self, object: usize) -> Option<Span> {
        since(&self.looks, object)
    }

    /// Somebody is in the zone.
    pub fn is_inside(&self, zone: usize) -> bool {
        self.inside.iter().any(|(_, known)| *known == zone)
    }

    /// The column stands still for the object.
    pub fn is_in_place(&self, object: usize) -> bool {
        self.in_place.contains(&object)
    }

    /// The clock starts again: whoever is at something is so from now on.
    pub fn restart(&mut self) {
        self.touches.iter_mut().chain(&mut self.looks).for_each(|known| known.since = Span::ZERO);
    }
}

fn begin(known: &mut Vec<Since>, person: PersonId, object: usize, since: Span) -> bool {
    let is_new = !known.iter().any(|at| (at.person, at.object) == (person, object));
    if is_new {
        known.push(Since { person, object, since });
    }
    is_new
}

fn end(known: &mut Vec<Since>, person: PersonId, object: usize) -> bool {
    let before = known.len();
    known.retain(|at| (at.person, at.object) != (person, object));
    known.len() < before
}

fn since(known: &[Since], object: usize) -> Option<Span> {
    known.iter().filter(|at| at.object == object).map(|at| at.since).min()
}

/// A zone is left when the head is so far outside it, m.
const LEAVES_M: f64 = 0.05;
/// Somebody looks at an object within this of their view axis, rad: ten degrees, which a head turned to something leaves to the eyes.
const LOOKS_RAD: f64 = 0.175;
/// And away from it beyond this, rad.
const LOOKS_AWAY_RAD: f64 = 0.26;

#[cfg(test)]
mod tests {
    use super::*;

    const ADA: PersonId = PersonId(1);
    const BOB: PersonId = PersonId(2);

    #[test]
    fn the_longest_hand_counts_and_each_is_let_go_by_itself() {
        let mut senses = Senses::default();
        assert!(senses.touch(ADA, 3, Span::from_millis(100)));
        assert!(!senses.touch(ADA, 3, Span::from_millis(200)));
        assert!(senses.touch(BOB, 3, Span::from_millis(300)));
        assert_eq!(senses.touched_since(3), Some(Span::from_millis(100)));
        assert!(senses.let_go(ADA, 3));
        assert_eq!(senses.touched_since(3), Some(Span::from_millis(300)));
        assert!(!senses.let_go(ADA, 3));
    }

    #[test]
    fn a_zone_is_left_a_little_outside_it() {
        let mut senses = Senses::default();
        assert_eq!(senses.stand(ADA, 0, 0.01), None);
        assert_eq!(senses.stand(ADA, 0, 0.0), Some(Trigger::ZoneEntered(0)));
        assert_eq!(senses.stand(ADA, 0, 0.04), None);
        assert!(senses.is_inside(0));
        assert_eq!(senses.stand(ADA, 0, 0.06), Some(Trigger::ZoneLeft(0)));
        assert!(!senses.is_inside(0));
    }

    #[test]
    fn whoever_leaves_lets_go_of_everything() {
        let mut senses = Senses::default();
        senses.touch(ADA, 1, Span::ZERO);
        senses.stand(ADA, 0, 0.0);
        senses.look(ADA, 1, 0.0, Span::ZERO);
        senses.touch(BOB, 1, Span::ZERO);
        assert_eq!(senses.leave(ADA), [Trigger::TouchEnded(1), Trigger::ZoneLeft(0)]);
        assert!(senses.touched_since(1).is_some() && senses.looked_at_since(1).is_none());
        assert!(!senses.is_inside(0));
    }

    #[test]
    fn a_look_outlasts_a_small_turn_of_the_head() {
        let mut senses = Senses::default();
        senses.look(ADA, 0, 0.2, Span::ZERO);
        assert_eq!(senses.looked_at_since(0), None);
        senses.look(ADA, 0, 0.05, Span::from_millis(10));
        senses.look(ADA, 0, 0.2, Span::from_millis(20));
        assert_eq!(senses.looked_at_since(0), Some(Span::from_millis(10)));
        senses.look(ADA, 0, 0.3, Span::from_millis(30));
        assert_eq!(senses.looked_at_since(0), None);
    }
}
