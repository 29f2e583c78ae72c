//! Jog: the column moves while the order is given anew, as fast as it may, and in `ready` alone.

use super::*;
use crate::event::EventKind;
use crate::snapshot::RuleStatus;

const ALONG_X: JogOrder = JogOrder { aim: Aim::Along(Planar::new(3.0, 0.0)), speed_mps: 1.0 };

impl Room {
    /// Homed, by somebody who said that the arena is clear, a second and more ago.
    fn ready() -> Self {
        let mut room = Self::new(None);
        room.ask(RequestKind::Home);
        room.run(2.0);
        assert_eq!(room.engine.mode(), Mode::Ready);
        room
    }

    fn jog(&mut self, order: JogOrder) -> Answer {
        self.engine.request(self.now, Request::Jog(order))
    }

    /// Hold the button for so long; the greatest speed.
    fn hold(&mut self, order: JogOrder, secs: f64) -> f64 {
        let mut fastest: f64 = 0.0;
        for k in 0..(secs / PERIOD.secs()).round() as usize {
            if k % 25 == 0 {
                assert_eq!(self.jog(order).outcome, Outcome::Accepted);
            }
            self.step();
            fastest = fastest.max(self.report.velocity.norm());
        }
        fastest
    }

    fn jog_ended(&mut self) -> Option<Reason> {
        self.engine.drain_events().find_map(|event| match event.kind {
            EventKind::JogEnded { because, .. } => Some(because),
            _ => None,
        })
    }
}

#[test]
fn the_column_moves_while_the_button_is_held_and_rests_when_it_is_let_go() {
    let mut room = Room::ready();
    let fastest = room.hold(ALONG_X, 1.5);
    assert!((fastest - 1.0).abs() < 0.01, "an arena confirmed clear: {fastest} m/s");
    assert_eq!(room.engine.snapshot(room.now).column.activity, Activity::Jogged);
    assert_eq!(room.engine.request(room.now, Request::LetGo).outcome, Outcome::Accepted);
    room.run(0.6);
    assert_eq!(room.report.velocity.norm(), 0.0);
    assert_eq!(room.engine.mode(), Mode::Ready);
    assert_eq!(room.jog_ended(), Some(Reason::JogLetGo));
}

#[test]
fn a_button_whose_word_stays_away_is_let_go_of() {
    let mut room = Room::ready();
    room.hold(ALONG_X, 1.0);
    assert!(room.report.velocity.norm() > 0.9);
    room.run(0.3);
    let began_to_brake = room.report.velocity.norm() < 0.95;
    room.run(0.6);
    assert!(began_to_brake && room.report.velocity.norm() == 0.0, "{:?}", room.report.velocity);
    assert_eq!(room.jog_ended(), Some(Reason::JogSilent));
}

#[test]
fn a_place_is_reached_and_not_passed() {
    let mut room = Room::ready();
    let place = Floor::new(1.0, 2.0);
    let mut farthest: f64 = 0.0;
    for _ in 0..60 {
        room.hold(JogOrder { aim: Aim::To(place), speed_mps: 0.25 }, 0.2);
        farthest = farthest.max(room.column().y - place.y);
    }
    assert!(room.column().distance_m(place) < 0.002, "{:?}", room.column());
    assert!(farthest < 0.002, "{farthest} m past it");
}

#[test]
fn a_jog_is_slower_among_people_and_creeps_where_nobody_vouches_for_the_arena() {
    let mut room = Room::ready();
    room.enter(3.5, 3.5, 0.0);
    room.run(0.1);
    let fastest = room.hold(ALONG_X, 1.0);
    assert!(fastest <= 0.24 + 1e-9 && fastest > 0.23, "among people: {fastest} m/s");
    room.engine.observe(room.now, Observation::PersonLeft(VISITOR));
    room.head = None;
    let speed = |room: &Room| room.engine.snapshot(room.now).column.jog_speed_mps;
    assert_eq!(speed(&room), Some(0.1), "who said that the arena is clear looked before the visitor came");
    assert_eq!(room.engine.request(room.now, Request::ConfirmClear).outcome, Outcome::Accepted);
    assert_eq!(speed(&room), Some(1.1));
    room.ask(RequestKind::Disarm);
    room.run(0.5);
    assert_eq!(room.jog(ALONG_X).reason, Reason::JogNotYet);
    assert_eq!(room.engine.mode(), Mode::Ready, "the drive is on");
    room.run(1.1);
    let fastest = room.hold(ALONG_X, 1.0);
    assert!(fastest <= 0.1 + 1e-9 && fastest > 0.09, "nobody vouches for the arena: {fastest} m/s");
    let snapshot = room.engine.snapshot(room.now);
    assert_eq!(snapshot.rules[15].status, RuleStatus::Limiting);
    assert_eq!(snapshot.column.jog_speed_mps, Some(0.1));
}

#[test]
fn what_is_no_order_is_refused_and_nothing_moves() {
    let mut room = Room::ready();
    let orders = [
        (Aim::Along(Planar::ZERO), 0.1),
        (Aim::Along(Planar::new(f64::NAN, 0.0)), 0.1),
        (Aim::Along(Planar::new(1.0, 0.0)), 0.0),
        (Aim::Along(Planar::new(1.0, 0.0)), -0.1),
        (Aim::Along(Planar::new(1.0, 0.0)), f64::NAN),
        (Aim::Along(Planar::new(1.0, 0.0)), 1.2),
        (Aim::To(Floor::new(4.0, 2.0)), 0.1),
        (Aim::To(Floor::new(f64::NAN, 2.0)), 0.1),
    ];
    for (aim, speed_mps) in orders {
        assert_eq!(room.jog(JogOrder { aim, speed_mps }).outcome, Outcome::Refused, "{aim:?} {speed_mps}");
        room.run(0.1);
        assert_eq!(room.report.velocity, Planar::ZERO);
    }
}

#[test]
fn a_jog_ends_with_whatever_ends_the_mode_and_with_a_rule_that_asks_for_a_stop() {
    type Act = (&'static str, fn(&mut Room));
    let acts: [Act; 5] = [
        ("stop", |room| drop(room.ask(RequestKind::Stop))),
        ("disarm", |room| drop(room.ask(RequestKind::Disarm))),
        ("steps late", |room| {
            (0..3).for_each(|_| room.engine.observe(room.now, Observation::DeadlineMissed));
        }),
        ("somebody unseen", |room| room.engine.observe(room.now, Observation::PersonEntered(PersonId(9)))),
        ("current", |room| room.report.current_amps = [6.0, 0.0]),
    ];
    for (what, act) in acts {
        let mut room = Room::ready();
        room.hold(ALONG_X, 1.0);
        act(&mut room);
        for _ in 0..15 {
            room.jog(ALONG_X);
            room.step();
        }
        assert!(room.jog_ended().is_some(), "{what}");
        room.run(0.6);
        assert_eq!(room.report.velocity.norm(), 0.0, "{what}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Whichever way it is jogged, and wherever somebody walks: it stays inside the travel, no faster than it may, and
    /// meets nobody in motion.
    #[test]
    fn a_jog_keeps_its_speed_its_travel_and_its_distance(
        ways in proptest::collection::vec((-3.2..3.2f64, 0.05..1.1f64, 0.1..1.5f64), 1..8),
        (x, y) in (0.2..3.8f64, 0.2..3.8f64),
        pace in 0.0..1.6f64,
    ) {
        let mut room = Room::ready();
        prop_assume!(room.column().distance_m(Floor::new(x, y)) > 1.0);
        room.enter(x, y, 0.0);
        room.run(0.1);
        for (angle, speed_mps, secs) in ways {
            let aim = Aim::Along(Planar::new(1.0, 0.0).turned(angle));
            for _ in 0..(secs / PERIOD.secs()) as usize {
                room.jog(JogOrder { aim, speed_mps });
                let (hx, hy, _) = room.head.unwrap();
                let to_column = room.column() - Floor::new(hx, hy);
                let ahead = to_column.unit().unwrap_or(Planar::ZERO) * (pace * PERIOD.secs());
                room.head = Some((hx + ahead.x, hy + ahead.y, 0.0));
                room.step();
                let speed = room.report.velocity.norm();
                prop_assert!(speed <= 0.25, "{speed} m/s");
                prop_assert!(TRAVEL.depth_m(room.column()) >= 0.02 - 1e-9, "{:?}", room.column());
                // The plain rule at this speed: r, and v_h while it brakes at 2.5 m/s2.
                let gap = (to_column.x.abs() - 0.075).max(0.0).hypot((to_column.y.abs() - 0.075).max(0.0));
                let needed = 0.25 + 1.6 * speed / 2.5 - 0.02;
                let leaves = room.report.velocity.dot(to_column) > 0.0;
                prop_assert!(speed < 1e-3 || leaves || gap > needed, "{speed} m/s, {gap} m away");
            }
        }
    }
}
