//! Why the column does what it does, in one plain sentence with values.

use std::collections::BTreeMap;
use std::fmt::Write;

use covr_engine::observation::PersonId;
use covr_engine::snapshot::{Activity, HeldBy, Holder, ObjectState, Snapshot};

use super::convert::name_of;

/// The sentence for the column of this state.
pub fn of(state: &Snapshot, names: &BTreeMap<PersonId, String>) -> String {
    match state.column.activity {
        Activity::Released => match &state.stop {
            Some(stop) => format!("the drive is released: {}", stop.reason),
            None => "the drive is released".into(),
        },
        Activity::Homing => "looks for its switches at creep speed".into(),
        Activity::Ready => "homed and holding; it follows nobody until it is armed".into(),
        Activity::Stopped => match &state.stop {
            Some(stop) => format!("stopped by {}: {}", stop.rule.name(), stop.reason),
            None => "stopped".into(),
        },
        Activity::Waiting => waits_for(state, names),
        Activity::Approaching | Activity::Yielding | Activity::Blocked | Activity::InPlace => {
            format!("{}; {}", serves(state, names), moves(state, names))
        }
    }
}

fn waits_for(state: &Snapshot, names: &BTreeMap<PersonId, String>) -> String {
    let unseen = state.persons.iter().find(|person| person.pose.is_none());
    if let Some(person) = unseen {
        format!("holds until {} sends a first pose", name_of(person.person, names))
    } else if state.persons.is_empty() {
        "nobody is in the arena".into()
    } else if !state.persons.iter().any(|person| person.tracked) {
        "nobody's headset is tracked".into()
    } else {
        "no enabled object has a weight: every prior is 0".into()
    }
}

/// Whom and what for: "for Ada, kettle: weight 0.83, next lamp 0.41".
fn serves(state: &Snapshot, names: &BTreeMap<PersonId, String>) -> String {
    let column = &state.column;
    let mut words = column.serves.map_or_else(String::new, |id| format!("for {}, ", name_of(id, names)));
    let mut by_weight: Vec<(usize, &ObjectState)> = state.objects.iter().enumerate().collect();
    by_weight.sort_by(|a, b| b.1.weight.total_cmp(&a.1.weight));
    let committed = column.committed.and_then(|index| Some((index, state.objects.get(index)?)));
    // Writing to a string cannot fail.
    let _ = match (committed, &by_weight[..]) {
        (Some((index, object)), _) => {
            let next = by_weight.iter().find(|(i, _)| *i != index).filter(|(_, next)| next.weight > 0.0);
            let next = next.map_or_else(String::new, |(_, o)| format!(", next {} {:.2}", o.id, o.weight));
            write!(words, "{}: weight {:.2}{next}", object.id, object.weight)
        }
        (None, [(_, first), (_, second), ..]) if second.weight > 0.0 => write!(
            words,
            "undecided between {} {:.2} and {} {:.2}",
            first.id, first.weight, second.id, second.weight
        ),
        (None, [(_, only), ..]) => write!(words, "{}: weight {:.2}", only.id, only.weight),
        (None, []) => write!(words, "no object"),
    };
    words
}

fn moves(state: &Snapshot, names: &BTreeMap<PersonId, String>) -> String {
    let column = &state.column;
    let short_m = column.target.map_or(0.0, |target| target.distance_m(column.position));
    let speed_mps = column.velocity.norm();
    match (column.activity, &column.held_by) {
        (Activity::InPlace, _) => "stands there".into(),
        (Activity::Blocked, Some(held)) => format!("held {short_m:.2} m short by {}", cause(held, names)),
        (Activity::Yielding, Some(held)) => {
            format!("{short_m:.2} m to go at {speed_mps:.2} m/s, slowed or turned by {}", cause(held, names))
        }
        (Activity::Yielding, None) => {
            format!("{short_m:.2} m to go at {speed_mps:.2} m/s, around somebody in the way")
        }
        _ => format!("{short_m:.2} m to go at {speed_mps:.2} m/s"),
    }
}

/// "the separation from Ada (0.80 m on the way, 1.02 m needed)".
fn cause(held: &HeldBy, names: &BTreeMap<PersonId, String>) -> String {
    let what = match &held.holder {
        Holder::Person(person) => format!("the separation from {}", name_of(*person, names)),
        Holder::KeepOut(id) => format!("the keep-out shape \"{id}\""),
        Holder::Travel => return "the end of the travel".into(),
    };
    format!("{what} ({:.2} m on the way, {:.2} m needed)", held.distance_m, held.required_m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;
    use covr_engine::frames::Planar;

    fn said(alter: impl FnOnce(&mut Snapshot)) -> String {
        let mut state = sample::snapshot();
        state.column.activity = Activity::Approaching;
        alter(&mut state);
        of(&state, &BTreeMap::from([(PersonId(3), "Ada".to_owned())]))
    }

    #[test]
    fn a_column_under_way_says_for_whom_to_what_and_how_far() {
        let words = said(|state| state.column.velocity = Planar::new(0.5, 0.0));
        assert_eq!(words, "for Ada, kettle: weight 0.40, next lamp 0.60; 1.50 m to go at 0.50 m/s");
    }

    #[test]
    fn what_holds_it_is_named_with_both_distances() {
        let by = |holder| Some(HeldBy { holder, distance_m: 0.8, required_m: 1.02 });
        let words = said(|state| {
            state.column.activity = Activity::Blocked;
            state.column.held_by = by(Holder::Person(PersonId(8)));
        });
        let end = "held 1.50 m short by the separation from person 8 (0.80 m on the way, 1.02 m needed)";
        assert!(words.ends_with(end), "{words}");
        let words = said(|state| {
            state.column.activity = Activity::Yielding;
            state.column.held_by = by(Holder::KeepOut("sofa".into()));
        });
        assert!(
            words.ends_with("by the keep-out shape \"sofa\" (0.80 m on the way, 1.02 m needed)"),
            "{words}"
        );
    }

    #[test]
    fn a_column_that_waits_says_for_what() {
        let waits = |alter: &dyn Fn(&mut Snapshot)| {
            said(|state| {
                state.column.activity = Activity::Waiting;
                alter(state);
            })
        };
        assert_eq!(waits(&|_| ()), "holds until person 8 sends a first pose");
        assert_eq!(
            waits(&|state| state.persons.truncate(1)),
            "no enabled object has a weight: every prior is 0"
        );
        assert_eq!(waits(&|state| state.persons.clear()), "nobody is in the arena");
        let lost = |state: &mut Snapshot| {
            state.persons.truncate(1);
            state.persons[0].tracked = false;
        };
        assert_eq!(waits(&lost), "nobody's headset is tracked");
    }

    #[test]
    fn undecided_names_the_first_two() {
        let words = said(|state| state.column.committed = None);
        assert!(words.starts_with("for Ada, undecided between lamp 0.60 and kettle 0.40; "), "{words}");
    }

    #[test]
    fn a_stop_is_said_with_its_rule() {
        assert_eq!(
            said(|state| state.column.activity = Activity::Stopped),
            "stopped by R2: the pose is 0.6 s old"
        );
    }
}
