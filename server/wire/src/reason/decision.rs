//! Why the column does what it does, decision by decision: what is believed, where it is wanted, which way, and when.

use std::collections::BTreeMap;

use covr_engine::frames::Floor;
use covr_engine::mode::Mode;
use covr_engine::motion::standing::StandingName;
use covr_engine::observation::PersonId;
use covr_engine::snapshot::{ObjectState, Snapshot};

use super::Reason;
use crate::dashboard::{Decision, name_of};

/// The reasons of each decision; none while the column does not follow, and when nobody is served.
pub fn decision(state: &Snapshot, names: &BTreeMap<PersonId, String>) -> Option<Decision> {
    let column = &state.column;
    let visitor = column.serves.filter(|_| state.mode == Mode::Following)?;
    let target = column.target?;
    let mut likely: Vec<&ObjectState> = state.objects.iter().filter(|o| o.probability > 0.0).collect();
    likely.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    Some(Decision {
        belief: belief(state, &likely, &name_of(visitor, names)),
        place: vec![place(target, &likely, state.standing)],
        route: super::column::route(column, names),
        arrival: arrival(state).into_iter().collect(),
    })
}

fn belief(state: &Snapshot, likely: &[&ObjectState], person: &str) -> Vec<Reason> {
    let first = likely.first();
    let mut reasons = Vec::new();
    if state.none_probability > first.map_or(0.0, |first| first.probability) {
        reasons.push(Reason::NonePlain { person: person.into(), probability: state.none_probability });
    }
    reasons.extend(first.and_then(|first| {
        Some(Reason::LooksAt {
            person: person.into(),
            object: first.id.clone(),
            angle_rad: first.angle_rad?,
            distance_m: first.distance_m?,
        })
    }));
    reasons
}

/// Whose place it is, told from the place itself.
fn place(target: Floor, likely: &[&ObjectState], standing: &str) -> Reason {
    let at = likely.iter().position(|object| object.column_place.distance_m(target) < SAME_PLACE_M);
    let pairs =
        likely.iter().enumerate().flat_map(|(k, one)| likely[k + 1..].iter().map(move |two| (one, two)));
    let mut between = pairs.filter(|(one, two)| is_between(target, one.column_place, two.column_place));
    match (at, standing == StandingName::Mean.name()) {
        (Some(0), _) => Reason::AtObject { object: likely[0].id.clone(), probability: likely[0].probability },
        (_, true) => Reason::AtMean,
        (Some(other), false) => Reason::AtAnother { object: likely[other].id.clone() },
        (None, false) => between.next().map_or(Reason::AmongObjects, |(one, two)| Reason::Between {
            object: one.id.clone(),
            other: two.id.clone(),
        }),
    }
}

/// None while it is there: that needs no reason.
fn arrival(state: &Snapshot) -> Option<Reason> {
    match (state.column.arrival_secs, state.column.least_arrival_secs) {
        (Some(0.0), _) => None,
        (Some(secs), Some(least)) if secs - least > WORTH_SAYING_SECS => {
            Some(Reason::PeopleCost { secs: secs - least })
        }
        (Some(_), _) => Some(Reason::AtItsLimits),
        (None, _) => Some(Reason::NotForeseen),
    }
}

fn is_between(place: Floor, one: Floor, two: Floor) -> bool {
    one.distance_m(place) + place.distance_m(two) < one.distance_m(two) + SAME_PLACE_M
}

/// Places nearer than this are the same, m.
const SAME_PLACE_M: f64 = 0.01;
const WORTH_SAYING_SECS: f64 = 0.15;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;

    fn decided(alter: impl FnOnce(&mut Snapshot)) -> Option<[String; 4]> {
        let mut state = sample::snapshot();
        state.mode = Mode::Following;
        state.standing = "in-time";
        alter(&mut state);
        let names = BTreeMap::from([(PersonId(3), "Ada".to_owned())]);
        let say = |reasons: Vec<Reason>| reasons.iter().map(Reason::to_string).collect::<Vec<_>>().join("; ");
        let Decision { belief, place, route, arrival } = decision(&state, &names)?;
        Some([belief, place, route, arrival].map(say))
    }

    #[test]
    fn each_decision_has_its_reason() {
        // The lamp is likelier; the column goes to the kettle.
        let [belief, place, route, arrival] = decided(|state| {
            state.objects[1].angle_rad = Some(0.07);
            state.objects[1].distance_m = Some(1.2);
        })
        .unwrap();
        assert_eq!(belief, "Ada looks 4° beside lamp, 1.20 m away");
        assert_eq!(place, "at kettle: from there more can be reached in time");
        assert_eq!(route, "straight, nobody in the way");
        assert_eq!(arrival, "people on the way and a soft start cost 0.4 s");
    }

    #[test]
    fn a_column_that_is_there_gives_no_reason_for_its_arrival() {
        let [.., arrival] = decided(|state| state.column.arrival_secs = Some(0.0)).unwrap();
        assert_eq!(arrival, "");
    }

    #[test]
    fn a_belief_in_none_of_them_is_said_first() {
        let [belief, ..] = decided(|state| {
            state.none_probability = 0.7;
            state.objects[0].probability = 0.2;
            state.objects[1].probability = 0.1;
        })
        .unwrap();
        let words =
            "most likely none of them (70 %): Ada looks around; Ada looks 4° beside kettle, 1.20 m away";
        assert_eq!(belief, words);
    }

    #[test]
    fn a_place_is_known_by_where_it_is() {
        let place_at = |x: f64, y: f64, standing: &'static str| {
            decided(|state| {
                state.column.target = Some(Floor::new(x, y));
                state.standing = standing;
            })
            .unwrap()[1]
                .clone()
        };
        assert_eq!(place_at(3.0, 3.0, "in-time"), "at lamp, the most probable (60 %)");
        let between = "between lamp and kettle: from there either can be reached in time";
        assert_eq!(place_at(1.95, 3.0, "in-time"), between);
        assert_eq!(
            place_at(1.95, 2.0, "in-time"),
            "among several objects: from there most can be reached in time"
        );
        assert_eq!(place_at(1.95, 3.0, "mean"), "the mean of the objects' places, weighted by the belief");
    }

    #[test]
    fn what_is_not_decided_has_no_reason() {
        assert_eq!(decided(|state| state.mode = Mode::ProtectiveStop), None);
        assert_eq!(decided(|state| state.column.serves = None), None);
        let unforeseen = decided(|state| state.column.arrival_secs = None).unwrap();
        assert_eq!(unforeseen[3], "later than it plans ahead");
    }
}
