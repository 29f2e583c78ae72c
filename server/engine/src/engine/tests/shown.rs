//! What is shown of the engine: what the column is about, and its outlook.

use super::*;

#[test]
fn the_column_says_what_it_is_about_and_who_holds_it() {
    let mut room = Room::armed();
    let about = |room: &Room| room.engine.snapshot(room.now).column.activity;
    assert_eq!(about(&room), Activity::Waiting);
    // From (2.2, 3.5) towards "left" at (3.5, 3.5): nobody between.
    room.enter(2.2, 3.5, 0.0);
    room.run(0.5);
    let snapshot = room.engine.snapshot(room.now);
    assert!(matches!(snapshot.column.activity, Activity::Approaching | Activity::Yielding));
    room.run(15.0);
    assert_eq!(about(&room), Activity::InPlace);

    // Somebody at the very place: the column is held short of it.
    let mut room = Room::armed();
    room.enter(3.4, 3.3, 1.2);
    room.run(15.0);
    let snapshot = room.engine.snapshot(room.now);
    assert_eq!(snapshot.column.activity, Activity::Blocked, "{:?}", snapshot.column);
    let held = snapshot.column.held_by.unwrap();
    assert_eq!(held.holder, Holder::Person(VISITOR));
    assert!(held.distance_m <= held.required_m);
    let person = &snapshot.persons[0];
    assert!(person.limits_column);
    let terms = person.separation.unwrap();
    assert_eq!(terms.required_m(), person.required_m);
    let moves = terms.reaction_m + terms.braking_m + terms.walking_m;
    assert!(moves < 1e-3 || snapshot.column.velocity.norm() > 0.0, "{terms:?} at rest");
    room.ask(RequestKind::Disarm);
    room.run(0.5);
    let snapshot = room.engine.snapshot(room.now);
    assert_eq!((snapshot.column.activity, snapshot.column.held_by), (Activity::Released, None));
    assert!(!snapshot.persons[0].limits_column);
}

#[test]
fn the_outlook_is_where_the_column_then_goes() {
    for head in [(2.2, 3.5, 0.0), (1.9, 1.7, 0.7)] {
        let mut room = Room::armed();
        room.enter(head.0, head.1, head.2);
        room.run(1.2);
        let path = room.engine.outlook(room.now).path();
        assert!(path.len() > 10, "{path:?}");
        for (k, planned) in path.iter().enumerate() {
            room.run(0.1);
            let off_m = room.column().distance_m(*planned);
            let allowed_m = if k < 20 { 0.01 } else { 0.15 };
            assert!(off_m < allowed_m, "{off_m} m off after {} points, head at {head:?}", k + 1);
        }
        room.run(4.0 - 0.1 * path.len() as f64);
        assert!(path[path.len() - 1].distance_m(room.column()) < 0.05);
    }
}

#[test]
fn a_column_that_goes_nowhere_has_no_path() {
    let path = |room: &Room| room.engine.outlook(room.now).path();
    let mut room = Room::new(None);
    room.enter(2.2, 3.5, 0.0);
    room.run(0.1);
    assert_eq!(path(&room), [], "disarmed");
    let mut room = Room::armed();
    assert_eq!(path(&room), [], "nobody there");
    room.enter(2.2, 3.5, 0.0);
    room.run(20.0);
    assert_eq!(path(&room), [], "in place");
    room.ask(RequestKind::Stop);
    room.run(0.1);
    assert_eq!(path(&room), [], "stopped");
}

#[test]
fn looking_ahead_changes_nothing() {
    let commands = |looks: bool| {
        let mut room = Room::armed();
        room.enter(1.9, 1.7, 0.7);
        let step = |room: &mut Room| {
            if looks {
                let outlook = room.engine.outlook(room.now);
                assert_eq!(outlook.path(), outlook.path());
                outlook.with_priors(&[0.1, 1.0]);
            }
            room.step()
        };
        (0..250).map(|_| step(&mut room)).collect::<Vec<_>>()
    };
    assert_eq!(commands(true), commands(false));
}

#[test]
fn a_preview_is_what_the_priors_then_do() {
    let mut room = Room::armed();
    // Between both, looking at "right" rather.
    room.enter(2.5, 2.0, -0.3);
    room.run(0.5);
    let before = room.engine.snapshot(room.now);
    let preview = room.engine.outlook(room.now).with_priors(&[1.0, 0.0]);
    assert_ne!(preview.target, before.column.target);
    assert_eq!(room.engine.snapshot(room.now), before, "a preview changes nothing");
    room.engine.request(room.now, Request::SetPriors(vec![(0, 1.0), (1, 0.0)]));
    room.step();
    let after = room.engine.snapshot(room.now);
    assert_eq!((preview.target, preview.committed), (after.column.target, after.column.committed));
    assert_eq!(preview.serves, Some(VISITOR));
    let found = preview.objects.iter().map(|o| (o.weight, o.probability, o.prior));
    assert!(found.eq(after.objects.iter().map(|o| (o.weight, o.probability, o.prior))), "{preview:?}");
    room.run(preview.path.len() as f64 * 0.1);
    assert!(preview.path[preview.path.len() - 1].distance_m(room.column()) < 0.05);
}
