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
