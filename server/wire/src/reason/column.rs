//! Why the column does what it does: clause by clause.

use std::collections::BTreeMap;

use covr_engine::observation::PersonId;
use covr_engine::snapshot::{Activity, ColumnState, HeldBy, Holder, ObjectState, Snapshot};

use super::Reason;
use crate::dashboard::name_of;

impl Reason {
    /// The clauses for the column of this state, the gravest first.
    pub fn of_column(state: &Snapshot, names: &BTreeMap<PersonId, String>) -> Vec<Self> {
        let stop = state.stop.as_ref();
        let because = stop.map(|stop| Self::new(&stop.reason, names));
        let mut clauses = Vec::new();
        match state.column.activity {
            Activity::Released => {
                clauses.push(Self::DriveReleased);
                clauses.extend(because);
            }
            Activity::Homing => clauses.push(Self::LooksForSwitches),
            Activity::Ready => clauses.push(Self::HoldsUnarmed),
            Activity::Jogged => clauses.push(Self::JogsWhileHeld),
            Activity::Stopped => {
                clauses.push(stop.map_or(Self::Stopped, |stop| Self::StoppedBy { rule: stop.rule.name() }));
                clauses.extend(because);
            }
            Activity::Interacting => clauses.extend(interacts(state, names)),
            Activity::Waiting => clauses.push(waits_for(state, names)),
            Activity::Approaching | Activity::Yielding | Activity::Blocked | Activity::InPlace => {
                serves(state, names, &mut clauses);
                moves(&state.column, names, &mut clauses);
            }
        }
        clauses
    }
}

fn interacts(state: &Snapshot, names: &BTreeMap<PersonId, String>) -> Option<Reason> {
    let interaction = state.interaction.as_ref()?;
    Some(Reason::Interacts {
        interaction: interaction.interaction.into(),
        phase: interaction.phase.into(),
        object: state.objects.get(interaction.object)?.id.clone(),
        person: interaction.person.map(|person| name_of(person, names)),
    })
}

fn waits_for(state: &Snapshot, names: &BTreeMap<PersonId, String>) -> Reason {
    let unseen = state.persons.iter().find(|person| person.pose.is_none());
    if let Some(person) = unseen {
        Reason::WaitsForPose { person: name_of(person.person, names) }
    } else if state.persons.is_empty() {
        Reason::ArenaEmpty
    } else if !state.persons.iter().any(|person| person.tracked) {
        Reason::NoHeadsetTracked
    } else {
        Reason::EveryPriorZero
    }
}

/// Whom and what for.
fn serves(state: &Snapshot, names: &BTreeMap<PersonId, String>, clauses: &mut Vec<Reason>) {
    let column = &state.column;
    let person = column.serves.map(|id| name_of(id, names));
    let mut by_weight: Vec<(usize, &ObjectState)> = state.objects.iter().enumerate().collect();
    by_weight.sort_by(|a, b| b.1.weight.total_cmp(&a.1.weight));
    let committed = column.committed.and_then(|index| Some((index, state.objects.get(index)?)));
    let for_one = |person, one: &ObjectState| Reason::Serves {
        person,
        object: one.id.clone(),
        weight: one.weight,
        probability: one.probability,
    };
    match (committed, &by_weight[..]) {
        (Some((index, object)), _) => {
            clauses.push(for_one(person, object));
            let next = by_weight.iter().find(|(i, _)| *i != index).filter(|(_, next)| next.weight > 0.0);
            clauses.extend(next.map(|(_, next)| Reason::NextInLine {
                object: next.id.clone(),
                weight: next.weight,
                probability: next.probability,
            }));
        }
        (None, [(_, first), (_, second), ..]) if second.weight > 0.0 => clauses.push(Reason::Undecided {
            person,
            object: first.id.clone(),
            weight: first.weight,
            other: second.id.clone(),
            other_weight: second.weight,
        }),
        (None, [(_, only), ..]) => clauses.push(for_one(person, only)),
        (None, []) => clauses.push(Reason::NoObject),
    }
}

fn moves(column: &ColumnState, names: &BTreeMap<PersonId, String>, clauses: &mut Vec<Reason>) {
    let left_m = column.target.map_or(0.0, |target| target.distance_m(column.position));
    let held = column.held_by.as_ref().map(|held| holds(held, names));
    match (column.activity, held) {
        (Activity::InPlace, _) => clauses.push(Reason::StandsThere),
        (Activity::Blocked, Some(held)) => clauses.extend([Reason::HeldShort { left_m }, held]),
        (activity, held) => {
            clauses.push(Reason::ToGo { left_m, speed_mps: column.velocity.norm() });
            match held {
                Some(held) if activity == Activity::Yielding => clauses.push(held),
                None if activity == Activity::Yielding => clauses.push(Reason::GoesAround),
                _ => {}
            }
        }
    }
}

/// Why it takes the way that it takes.
pub(super) fn route(column: &ColumnState, names: &BTreeMap<PersonId, String>) -> Vec<Reason> {
    match (&column.held_by, column.activity) {
        (_, Activity::InPlace) => vec![Reason::StandsThere],
        (Some(held), _) => vec![holds(held, names)],
        (None, _) if column.goes_around => vec![Reason::GoesAround],
        (None, _) => vec![Reason::StraightOn],
    }
}

fn holds(held: &HeldBy, names: &BTreeMap<PersonId, String>) -> Reason {
    let (distance_m, required_m) = (held.distance_m, held.required_m);
    match &held.holder {
        Holder::Person(person) => {
            Reason::PersonInTheWay { person: name_of(*person, names), distance_m, required_m }
        }
        Holder::KeepOut(id) => Reason::KeepOutInTheWay { keep_out: id.clone(), distance_m, required_m },
        Holder::Travel => Reason::TravelEndInTheWay,
    }
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
        let names = BTreeMap::from([(PersonId(3), "Ada".to_owned())]);
        let clauses = Reason::of_column(&state, &names);
        clauses.iter().map(Reason::to_string).collect::<Vec<_>>().join("; ")
    }

    #[test]
    fn a_column_under_way_says_for_whom_to_what_and_how_far() {
        let words = said(|state| state.column.velocity = Planar::new(0.5, 0.0));
        assert_eq!(words, "for Ada, kettle: weight 0.40; next lamp 0.60; 1.50 m to go at 0.50 m/s");
    }

    #[test]
    fn what_holds_it_is_named_with_both_distances() {
        let by = |holder| Some(HeldBy { holder, distance_m: 0.8, required_m: 1.02 });
        let words = said(|state| {
            state.column.activity = Activity::Blocked;
            state.column.held_by = by(Holder::Person(PersonId(8)));
        });
        let end = "held 1.50 m short; slowed or turned for person 8: 0.80 m on the way, 1.02 m needed";
        assert!(words.ends_with(end), "{words}");
        let words = said(|state| {
            state.column.activity = Activity::Yielding;
            state.column.held_by = by(Holder::KeepOut("sofa".into()));
        });
        let end = "slowed or turned for the keep-out shape sofa: 0.80 m on the way, 1.02 m needed";
        assert!(words.ends_with(end), "{words}");
        let words = said(|state| state.column.activity = Activity::Yielding);
        assert!(words.ends_with("around somebody in the way"), "{words}");
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
        let words = said(|state| state.column.activity = Activity::Stopped);
        assert_eq!(words, "stopped by R2; the newest pose of Ada is 0.60 s old");
    }
}
