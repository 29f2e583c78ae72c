//! What is foretold of the objects.

use super::*;
use crate::motion::travel_secs;

#[test]
fn the_arrival_foretold_knows_who_is_in_the_way() {
    let mut room = Room::armed_with(OURS);
    // At the very place of "left", and looking at it.
    room.enter(3.4, 3.3, 1.2);
    room.run(3.0);
    let place = room.engine.scene().objects()[0].column_place();
    let told = room.engine.foretell(0).unwrap();
    let least_secs = travel_secs(room.column(), place, &Limits::PAPER);
    assert!(told.arrival_secs > least_secs + 1.0, "{told:?}, at its limits {least_secs} s");
    assert!(told.late_by_secs().unwrap() > 1.0, "{told:?}");
    assert!(told.in_time_probability().unwrap() < 0.2, "{told:?}");
    room.ask(RequestKind::Disarm);
    room.run(0.5);
    assert_eq!(room.engine.foretell(0).unwrap().in_time_probability(), Some(0.0), "it does not come");
}

#[test]
fn a_column_in_place_is_there_and_what_is_not_served_is_as_far_as_the_way_to_it() {
    for deciding in [PAPERS, OURS] {
        let mut room = Room::armed_with(deciding);
        room.enter(2.2, 3.5, 0.0);
        room.run(15.0);
        let [left, right] = [0, 1].map(|object| room.engine.foretell(object).unwrap());
        assert_eq!((left.arrival_secs, left.in_time_probability()), (0.0, Some(1.0)));
        let place = room.engine.scene().objects()[1].column_place();
        assert_eq!(right.arrival_secs, travel_secs(room.column(), place, &Limits::PAPER));
    }
    assert_eq!(Room::armed().engine.foretell(2), None);
    assert_eq!(Room::armed().engine.foretell(0).unwrap().late_by_secs(), None, "nobody is there");
}

#[test]
fn to_a_prop_that_rests_short_of_its_place_the_virtual_object_can_be_shifted() {
    // The visitor walks up to "left" while the column comes from the corner, and is there about when it is.
    let mut offered = 0;
    for from_x in [1.2, 1.3, 1.4] {
        let mut room = Room::armed_with(OURS);
        room.enter(from_x, 3.5, 0.0);
        room.walk_mps = (0.3, 0.0);
        let place = room.engine.scene().objects()[0].column_place();
        while room.head.is_some_and(|(x, ..)| x < 2.85) {
            room.step();
            let told = room.engine.foretell(0).unwrap();
            let Some(offset) = told.offset else { continue };
            offered += 1;
            assert!((0.01 - 1e-12..=0.025 + 1e-12).contains(&offset.norm()), "{told:?}");
            assert!(offset.dot(room.column() - place) > 0.0, "{told:?}");
            assert_eq!(room.engine.foretell(1).unwrap().offset, None, "nothing comes to it");
        }
    }
    assert!(offered > 0);
}
