//! The engine does what the table of modes says: every mode times every request and every trigger, by acts and faults.

use super::*;
use crate::mode::{Response, Trigger, react, respond};

/// A room in this mode, with a tracked visitor where the mode allows one.
fn room_in(mode: Mode) -> Room {
    let mut room = match mode {
        Mode::Following | Mode::ProtectiveStop => Room::armed(),
        _ => Room::new(None),
    };
    room.enter(3.0, 3.0, 0.0);
    room.run(0.1);
    match mode {
        Mode::Disarmed | Mode::Following => {}
        Mode::Homing => drop(room.ask(RequestKind::Home)),
        Mode::Ready => {
            room.ask(RequestKind::Home);
            // A jog is taken a second after it has become ready.
            room.run(1.5);
        }
        Mode::ProtectiveStop => {
            room.engine.observe(room.now, Observation::OriginChanged(VISITOR));
            room.run(0.5);
        }
        Mode::LatchedStop => drop(room.ask(RequestKind::Stop)),
        Mode::Faulted => {
            room.machine_answers = false;
            room.run(0.15);
            room.machine_answers = true;
            room.step();
        }
    }
    assert_eq!(room.engine.mode(), mode);
    room
}

/// Bring the trigger about and give it time; a homing takes longer than that.
fn bring_about(room: &mut Room, trigger: Trigger) {
    match trigger {
        Trigger::ProtectiveDemand => {
            for _ in 0..3 {
                room.engine.observe(room.now, Observation::DeadlineMissed);
            }
            room.step();
        }
        Trigger::DemandGone => {
            room.engine.request(room.now, Request::ConfirmOrigin(VISITOR));
            // In a mode that is on its way elsewhere nothing is waited for.
            if room.engine.mode() != Mode::Homing {
                room.run(1.1);
            }
        }
        Trigger::LatchedDemand => {
            room.report.current_amps = [5.5, 0.0];
            room.run(0.06);
        }
        Trigger::Fault => {
            room.machine_answers = false;
            room.run(0.15);
        }
        Trigger::Homed => {
            room.report.homing = Homing::Homed;
            room.run(0.3);
        }
        Trigger::HomeLost => {
            room.report.homing = Homing::NotHomed;
            room.step();
        }
    }
}

#[test]
fn the_engine_answers_every_request_in_every_mode_as_the_table_says() {
    for mode in Mode::ALL {
        for request in RequestKind::ALL {
            let mut room = room_in(mode);
            let conditions = room.engine.conditions(room.now);
            let answer = room.ask(request);
            let (outcome, to) = match respond(mode, request, &conditions) {
                Response::Go(to) => (Outcome::Accepted, to),
                Response::AlreadySo(_) => (Outcome::AlreadySo, mode),
                Response::Refuse(_) => (Outcome::Refused, mode),
            };
            assert_eq!((answer.outcome, room.engine.mode()), (outcome, to), "{mode:?} {request:?}");
        }
    }
}

#[test]
fn the_engine_goes_where_the_table_says_at_every_trigger_in_every_mode() {
    for mode in Mode::ALL {
        for trigger in Trigger::ALL {
            let mut room = room_in(mode);
            bring_about(&mut room, trigger);
            let expected = react(mode, trigger, Mode::Following).unwrap_or(mode);
            assert_eq!(room.engine.mode(), expected, "{mode:?} {trigger:?}");
        }
    }
}

#[test]
fn a_protective_stop_while_homing_goes_back_to_homing() {
    let mut room = room_in(Mode::Homing);
    bring_about(&mut room, Trigger::ProtectiveDemand);
    assert_eq!(room.engine.mode(), Mode::ProtectiveStop);
    room.engine.observe(room.now, Observation::DeadlineMet);
    while room.engine.mode() == Mode::ProtectiveStop {
        room.step();
    }
    assert_eq!(room.engine.mode(), Mode::Homing);
}

/// What each cause of a protective stop does, and the rule that answers.
type Cause = (u8, &'static str, fn(&mut Room));

#[test]
fn every_cause_of_a_protective_stop_leads_to_one() {
    let pose = |room: &Room, x: f64, tracked: bool, worn: bool| {
        let pose = Pose { position: Point::new(x, 3.0, 1.6), orientation: UnitQuaternion::identity() };
        Observation::Pose(
            VISITOR,
            PoseSample { taken_at: room.now, pose, tracked, worn, hands: Hands::UNKNOWN },
        )
    };
    let causes: [Cause; 9] = [
        (2, "no pose yet", |room| room.engine.observe(room.now, Observation::PersonEntered(PersonId(2)))),
        (2, "too old", |room| room.head = None),
        (2, "untracked", |_| {}),
        (2, "jumped", |room| room.head = Some((1.0, 1.0, 0.0))),
        (9, "steps late", |room| {
            (0..3).for_each(|_| room.engine.observe(room.now, Observation::DeadlineMissed));
        }),
        (10, "client gone", |room| room.engine.observe(room.now, Observation::ClientGone(VISITOR))),
        (12, "intruder", |room| {
            let intruder = crate::observation::InputLevel::Active("curtain".into());
            let inputs = crate::observation::Inputs { intruder, ..Default::default() };
            room.engine.observe(room.now, Observation::Inputs(inputs));
        }),
        (15, "headset off", |_| {}),
        (15, "origin changed", |room| room.engine.observe(room.now, Observation::OriginChanged(VISITOR))),
    ];
    for (rule, cause, act) in causes {
        let mut room = room_in(Mode::Following);
        act(&mut room);
        if let "untracked" | "headset off" = cause {
            room.head = None;
            room.now += Span::from_millis(1);
            let seen = pose(&room, 3.0, cause != "untracked", cause != "headset off");
            room.engine.observe(room.now, seen);
            room.step();
        } else {
            let wait_secs = if matches!(cause, "no pose yet" | "too old") { 0.6 } else { PERIOD.secs() };
            room.run(wait_secs);
        }
        assert_eq!(room.engine.mode(), Mode::ProtectiveStop, "{cause}");
        assert_eq!(room.engine.snapshot(room.now).stop.unwrap().rule, RuleId(rule), "{cause}");
    }
}

#[test]
fn a_home_that_was_found_is_an_event_with_how_well_it_repeats() {
    let mut room = Room::new(None);
    room.report.homing = Homing::Running;
    room.step();
    drop(room.engine.drain_events());
    room.report.homing = Homing::Homed;
    room.report.home_repeatability_m = Some([0.0004, -0.0002]);
    room.run(0.1);
    let homed: Vec<_> = room
        .engine
        .drain_events()
        .filter_map(|event| match event.kind {
            EventKind::Homed { repeatability_m, .. } => Some(repeatability_m),
            _ => None,
        })
        .collect();
    assert_eq!(homed, [Some([0.0004, -0.0002])]);
    assert_eq!(room.engine.snapshot(room.now).column.home_repeatability_m, Some([0.0004, -0.0002]));
}
