//! What breaches a rule, and what comes of it.

use super::*;

#[test]
fn lost_tracking_is_a_protective_stop_that_clears_by_itself() {
    let mut room = Room::armed();
    room.enter(2.0, 3.5, 0.0);
    room.run(1.0);
    let head = room.head.take();
    room.run(0.6);
    assert_eq!(room.engine.mode(), Mode::ProtectiveStop);
    assert_eq!(room.engine.snapshot(room.now).stop.unwrap().rule, RuleId(2));
    room.run(1.0);
    assert_eq!(room.report.velocity, Planar::ZERO);
    room.head = head;
    room.run(0.9);
    assert_eq!(room.engine.mode(), Mode::ProtectiveStop, "not before 1 s");
    room.run(0.2);
    assert_eq!(room.engine.mode(), Mode::Following);
}

#[test]
fn a_changed_origin_waits_for_the_game_master() {
    let mut room = Room::armed();
    room.enter(2.0, 3.5, 0.0);
    room.run(0.5);
    room.engine.observe(room.now, Observation::OriginChanged(VISITOR));
    room.run(5.0);
    assert_eq!(room.engine.mode(), Mode::ProtectiveStop);
    assert_eq!(room.engine.request(room.now, Request::ConfirmOrigin(VISITOR)).outcome, Outcome::Accepted);
    room.run(1.1);
    assert_eq!(room.engine.mode(), Mode::Following);
}

#[test]
fn a_gone_client_is_lost_tracking_and_a_person_who_left_is_not() {
    let mut room = Room::armed();
    room.enter(2.0, 3.5, 0.0);
    room.run(0.5);
    room.engine.observe(room.now, Observation::ClientGone(VISITOR));
    room.run(0.1);
    assert_eq!(room.engine.snapshot(room.now).stop.unwrap().rule, RuleId(10));
    room.engine.observe(room.now, Observation::PersonLeft(VISITOR));
    room.head = None;
    room.run(1.1);
    assert_eq!(room.engine.mode(), Mode::Following);
}

#[test]
fn until_the_first_pose_of_somebody_new_the_column_holds() {
    let mut room = Room::armed();
    room.enter(2.0, 3.5, 0.0);
    room.run(1.0);
    assert!(room.report.velocity.norm() > 0.2);
    room.engine.observe(room.now, Observation::PersonEntered(PersonId(2)));
    room.run(0.48);
    assert_eq!((room.engine.mode(), room.report.velocity), (Mode::Following, Planar::ZERO));
    room.run(0.1);
    assert_eq!(room.engine.mode(), Mode::ProtectiveStop);
}

#[test]
fn somebody_who_has_left_without_a_word_can_be_said_to_have_left() {
    let mut room = Room::armed();
    room.enter(2.0, 3.5, 0.0);
    room.run(0.5);
    let said = |room: &mut Room| room.engine.request(room.now, Request::ConfirmLeft(VISITOR)).outcome;
    assert_eq!(said(&mut room), Outcome::Refused, "the headset is tracked");
    room.engine.observe(room.now, Observation::ClientGone(VISITOR));
    room.head = None;
    room.run(0.5);
    assert_eq!(room.engine.mode(), Mode::ProtectiveStop);
    assert_eq!(said(&mut room), Outcome::Accepted);
    room.run(1.1);
    assert_eq!(room.engine.mode(), Mode::Following);
}

#[test]
fn a_silent_machine_is_a_fault_that_reset_leaves_only_when_it_answers() {
    let mut room = Room::armed();
    room.machine_answers = false;
    room.run(0.15);
    assert_eq!(room.engine.mode(), Mode::Faulted);
    assert_eq!(room.ask(RequestKind::Reset).outcome, Outcome::Refused);
    room.machine_answers = true;
    room.run(0.1);
    assert_eq!(room.ask(RequestKind::Reset).outcome, Outcome::Accepted);
    assert_eq!(room.engine.mode(), Mode::Disarmed);
}

#[test]
fn over_current_and_a_straying_machine_latch() {
    let mut room = Room::armed();
    room.report.current_amps = [5.5, 0.0];
    room.run(0.05);
    assert_eq!(room.engine.snapshot(room.now).stop.unwrap().rule, RuleId(5));

    let mut room = Room::armed();
    room.enter(2.0, 3.5, 0.0);
    room.run(0.5);
    let mut held_after = None;
    for step in 0..250 {
        let stuck = room.report.position;
        if room.step().action() == Action::Hold {
            held_after = held_after.or(Some(step));
        }
        room.report.position = Floor::new(stuck.x.min(0.5), stuck.y.min(0.5));
    }
    assert!(held_after.is_some_and(|step| step < 60), "held after {held_after:?} steps");
    let rule = room.engine.snapshot(room.now).stop.unwrap().rule;
    assert!(rule == RuleId(6) || rule == RuleId(7), "{rule:?}");
}

#[test]
fn over_current_latches_while_homing_too() {
    let mut room = Room::new(None);
    room.run(0.1);
    room.ask(RequestKind::Home);
    room.report.current_amps = [0.0, 5.5];
    room.run(0.05);
    assert_eq!(room.engine.mode(), Mode::LatchedStop);
    assert_eq!(room.engine.snapshot(room.now).stop.unwrap().rule, RuleId(5));
}

#[test]
fn three_missed_deadlines_in_a_row_are_a_protective_stop() {
    let mut room = Room::armed();
    for _ in 0..2 {
        room.engine.observe(room.now, Observation::DeadlineMissed);
    }
    room.engine.observe(room.now, Observation::DeadlineMet);
    room.engine.observe(room.now, Observation::DeadlineMissed);
    room.step();
    assert_eq!(room.engine.mode(), Mode::Following);
    for _ in 0..2 {
        room.engine.observe(room.now, Observation::DeadlineMissed);
    }
    room.step();
    assert_eq!(room.engine.snapshot(room.now).stop.unwrap().rule, RuleId(9));
}
