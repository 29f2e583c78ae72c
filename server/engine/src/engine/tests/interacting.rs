//! Interactions: each does what its file says, R14 is kept, and wrong acts end in the stated way.

use super::*;
use crate::scenario::{Course, Interaction, ScenarioSpec, StateSpec, Transition, Trigger};
use crate::scene::PropSpec;

/// `left` at (3.5, 3.5) with this interaction; its end leads on to `end`, a cue too.
fn offering(interaction: Interaction, prop: Option<PropSpec>) -> Room {
    let mut room = Room::new(None);
    room.run(0.1);
    let mut spec = room.engine.scene().spec().clone();
    if let Some(prop) = prop {
        spec.objects[0].prop = Some(0);
        spec.props = vec![prop];
    }
    let on = vec![Trigger::InteractionDone("left".into()), Trigger::Cue("on".into())];
    let state = |id: &str, enabled: &[&str], interactions, transitions| StateSpec {
        id: id.into(),
        enabled: enabled.iter().map(|id| (*id).to_owned()).collect(),
        priors: Vec::new(),
        interactions,
        entry: Vec::new(),
        transitions,
        is_final: false,
    };
    let on = vec![Transition { on, when: None, to: Some("end".into()), acts: Vec::new() }];
    let states = vec![
        state("begin", &["left"], vec![("left".into(), interaction)], on),
        state("end", &["right"], vec![], vec![]),
    ];
    let anywhere = Vec::new();
    spec.scenario = Some(ScenarioSpec { initial: "begin".into(), variables: vec![], states, anywhere });
    let scene = Arc::new(Scene::build(spec).unwrap());
    assert_eq!(room.engine.request(room.now, Request::ActivateScene(scene)).outcome, Outcome::Accepted);
    room.ask(RequestKind::Home);
    room.run(0.5);
    room.ask(RequestKind::Arm);
    room.run(0.1);
    room
}

/// Along -y for 1.5 m, then along -x for a metre.
fn course() -> Course {
    Course { path: vec![Floor::new(3.5, 2.0), Floor::new(2.5, 2.0)], speed_mps: 0.5 }
}

impl Room {
    /// The visitor stands at the column, which stands at `left`, and takes hold.
    fn takes_hold(&mut self) {
        self.enter(2.7, 3.5, 0.0);
        self.run(8.0);
        assert!(self.column().distance_m(Floor::new(3.5, 3.5)) < 0.05, "at {:?}", self.column());
        self.hand(true);
    }

    fn hand(&mut self, holds: bool) {
        let left = "left".into();
        let touch = if holds {
            Observation::TouchBegan(VISITOR, left)
        } else {
            Observation::TouchEnded(VISITOR, left)
        };
        self.engine.observe(self.now, touch);
    }

    fn arm_contact(&mut self, secs: f64) -> Answer {
        self.engine.request(self.now, Request::ArmContact(VISITOR, Span::from_secs(secs)))
    }

    fn phase(&self) -> Option<&'static str> {
        self.engine.snapshot(self.now).interaction.map(|interaction| interaction.phase)
    }

    fn scenario(&self) -> String {
        self.engine.snapshot(self.now).scenario.unwrap().state
    }

    fn is_armed_for_contact(&self) -> bool {
        self.engine.snapshot(self.now).contact.is_some()
    }

    /// For so long, or until it is not so any more; the greatest speed and acceleration seen, m/s and m/s2.
    fn watch(&mut self, secs: f64, while_so: impl Fn(&Self) -> bool) -> (f64, f64) {
        let (mut speed, mut acceleration) = (0.0f64, 0.0f64);
        let mut before = self.report.velocity;
        for _ in 0..(secs / PERIOD.secs()).round() as usize {
            if !while_so(self) {
                break;
            }
            self.step();
            let now = self.report.velocity;
            speed = speed.max(now.norm());
            if now.norm() > before.norm() {
                acceleration = acceleration.max((now - before).norm() / PERIOD.secs());
            }
            before = now;
        }
        (speed, acceleration)
    }

    /// The same, the visitor walking along with what they hold.
    fn led(&mut self, secs: f64, while_so: impl Fn(&Self) -> bool) -> (f64, f64) {
        let (mut speed, mut acceleration) = (0.0f64, 0.0f64);
        for _ in 0..(secs / PERIOD.secs()).round() as usize {
            if !while_so(self) {
                break;
            }
            let seen = self.watch(PERIOD.secs(), |_| true);
            (speed, acceleration) = (speed.max(seen.0), acceleration.max(seen.1));
            if let Some((x, y, yaw)) = self.head {
                let column = self.column();
                let away = Planar::new(x - column.x, y - column.y);
                let step = (away * (0.8 / away.norm()) - away).capped(1.2 * PERIOD.secs());
                self.head = Some((x + step.x, y + step.y, yaw));
            }
        }
        (speed, acceleration)
    }

    fn speed(&self) -> f64 {
        self.report.velocity.norm()
    }

    fn ended_because(&mut self) -> Vec<Reason> {
        let events = self.engine.drain_events();
        let ends = events.filter_map(|event| match event.kind {
            EventKind::InteractionEnded { because, .. } => Some(because),
            _ => None,
        });
        ends.collect()
    }
}

#[test]
fn nobody_is_led_whom_the_game_master_has_not_armed_it_for() {
    let mut room = offering(Interaction::Lead(course()), None);
    room.takes_hold();
    let (speed, _) = room.watch(3.0, |_| true);
    assert!(speed < 0.01 && room.phase().is_none(), "{speed} m/s");
    assert_eq!(room.arm_contact(0.5).reason, Reason::ContactSecs { least: 1.0, most: 300.0 });
    let nobody = room.engine.request(room.now, Request::ArmContact(PersonId(9), Span::from_secs(10.0)));
    assert_eq!(nobody.reason, Reason::PersonNotInside(PersonId(9)));
    assert_eq!(room.arm_contact(60.0).outcome, Outcome::Accepted);
    room.run(0.1);
    assert_eq!(room.phase(), Some("leading"));
}

#[test]
fn who_is_led_is_pulled_gently_to_the_end_and_the_scenario_goes_on() {
    let mut room = offering(Interaction::Lead(course()), None);
    room.takes_hold();
    room.arm_contact(60.0);
    let (speed, acceleration) = room.led(20.0, |room| room.scenario() == "begin");
    assert!(speed > 0.4 && speed <= 0.6 + 1e-9, "{speed} m/s");
    assert!(acceleration <= 0.5 * 2f64.sqrt() + 1e-6, "{acceleration} m/s2");
    assert_eq!(room.scenario(), "end");
    assert!(room.column().distance_m(Floor::new(2.5, 2.0)) < 0.03, "at {:?}", room.column());
}

#[test]
fn a_hand_that_lets_go_stops_it_and_one_that_takes_hold_again_goes_on_from_there() {
    let mut room = offering(Interaction::Lead(course()), None);
    room.takes_hold();
    room.arm_contact(60.0);
    room.led(20.0, |room| room.speed() < 0.45);
    let at = room.column();
    room.hand(false);
    room.run(0.5);
    assert!(
        room.speed() < 1e-3 && room.column().distance_m(at) < 0.12,
        "{} m on",
        room.column().distance_m(at)
    );
    assert_eq!(room.ended_because(), [Reason::InteractionLetGo]);
    let stood = room.column();
    room.walk_to(2.7, stood.y);
    room.hand(true);
    room.led(20.0, |room| room.scenario() == "begin");
    assert!(room.column().distance_m(Floor::new(2.5, 2.0)) < 0.03, "at {:?}", room.column());
}

#[test]
fn every_end_of_a_contact_stops_the_column_and_nothing_begins_by_itself() {
    type End = (fn(&mut Room), Reason);
    let ends: [End; 4] = [
        (
            |room| {
                room.engine.request(room.now, Request::DisarmContact);
            },
            Reason::ContactTakenBack,
        ),
        (|room| _ = room.led(4.0, |_| true), Reason::ContactTimeOver),
        (
            |room| {
                room.ask(RequestKind::Stop);
            },
            Reason::InteractionStopped(Mode::LatchedStop),
        ),
        (
            |room| {
                room.head = None;
                room.run(0.6);
            },
            Reason::InteractionStopped(Mode::ProtectiveStop),
        ),
    ];
    for (end, because) in ends {
        let mut room = offering(Interaction::Lead(course()), None);
        room.takes_hold();
        room.arm_contact(5.0);
        room.run(1.5);
        assert_eq!(room.phase(), Some("leading"));
        end(&mut room);
        room.run(1.0);
        assert!(room.speed() < 1e-3, "{because:?}: {} m/s", room.speed());
        assert!(!room.is_armed_for_contact(), "{because:?}");
        let stood = room.column();
        room.run(3.0);
        assert!(room.column().distance_m(stood) < 0.01, "{because:?}");
        assert_eq!(room.ended_because(), [because]);
    }
}

#[test]
fn a_contact_ends_when_no_game_master_looks_on() {
    let mut room = offering(Interaction::Lead(course()), None);
    room.engine.config.needs_game_master = true;
    room.takes_hold();
    assert_eq!(room.arm_contact(60.0).reason, Reason::GameMasterAbsent);
    room.engine.observe(room.now, Observation::GameMaster(true));
    assert_eq!(room.arm_contact(60.0).outcome, Outcome::Accepted);
    room.led(1.5, |_| true);
    assert_eq!(room.phase(), Some("leading"));
    room.engine.observe(room.now, Observation::GameMaster(false));
    room.run(1.0);
    assert_eq!((room.engine.mode(), room.is_armed_for_contact()), (Mode::Following, false));
    assert!(room.speed() < 1e-3, "{} m/s", room.speed());
    assert_eq!(room.ended_because(), [Reason::GameMasterAbsent]);
}

#[test]
fn a_run_that_was_stopped_on_the_way_does_not_hold_the_column_in_the_next() {
    let mut room = offering(Interaction::Lead(course()), None);
    room.takes_hold();
    room.arm_contact(60.0);
    room.led(2.5, |_| true);
    assert!(room.column().distance_m(Floor::new(3.5, 3.5)) > 0.2, "at {:?}", room.column());
    room.hand(false);
    room.ask(RequestKind::Disarm);
    room.run(1.0);
    room.walk_to(1.5, 3.5);
    assert_eq!(room.ask(RequestKind::Arm).outcome, Outcome::Accepted);
    room.run(8.0);
    assert!(room.column().distance_m(Floor::new(3.5, 3.5)) < 0.05, "at {:?}", room.column());
}

#[test]
fn who_has_got_up_at_the_end_of_the_ride_is_borne_no_more() {
    let mut room = riding();
    let states = room.engine.scene().spec().scenario.clone().unwrap().states;
    let mut spec = room.engine.scene().spec().clone();
    let mut stays = spec.scenario.take().unwrap();
    stays.states = states;
    stays.states[0].transitions.clear();
    spec.scenario = Some(stays);
    room.engine.request(room.now, Request::ActivateScene(Arc::new(Scene::build(spec).unwrap())));
    room.run(0.1);
    room.hand(true);
    room.arm_contact(60.0);
    room.ride(30.0, |room| room.phase() != Some("done"));
    assert_eq!(room.engine.snapshot(room.now).bears, Some(VISITOR));
    room.hand(false);
    room.run(0.1);
    assert_eq!(room.engine.snapshot(room.now).bears, None);
}

#[test]
fn a_leader_waits_for_whoever_stands_in_its_path() {
    let mut room = offering(Interaction::Lead(course()), None);
    room.takes_hold();
    room.arm_contact(60.0);
    room.run(0.5);
    // Holding on, they step into the path.
    room.walk_to(3.5, 2.4);
    room.run(6.0);
    assert!(room.speed() < 1e-3, "{} m/s at {:?}", room.speed(), room.column());
    let gap = room.engine.scene().footprint().distance_m(room.column(), Floor::new(3.5, 2.4));
    assert!(gap >= 0.35, "{gap} m");
    assert_eq!(room.phase(), Some("leading"), "and goes on when they are out of it");
    room.walk_to(2.7, 3.2);
    room.led(20.0, |room| room.scenario() == "begin");
    assert_eq!(room.scenario(), "end");
}

fn chair() -> PropSpec {
    PropSpec {
        id: "chair".into(),
        offset: Planar::new(-0.45, 0.0),
        facing_rad: std::f64::consts::PI,
        size_m: Planar::new(0.4, 0.4),
    }
}

/// A rider who sits on the chair and is carried with it.
fn riding() -> Room {
    let mut room = offering(Interaction::Transport(Course { speed_mps: 0.4, ..course() }), Some(chair()));
    room.enter(2.2, 3.5, 0.0);
    room.run(8.0);
    assert!(room.column().distance_m(Floor::new(3.95, 3.5)) < 0.05, "at {:?}", room.column());
    room.walk_to(3.5, 3.5);
    room.run(0.5);
    room.hand(true);
    assert_eq!(room.arm_contact(60.0).outcome, Outcome::Accepted);
    room
}

impl Room {
    /// At 1.2 m/s.
    fn walk_to(&mut self, x: f64, y: f64) {
        while let Some((hx, hy, yaw)) = self.head {
            let way = Planar::new(x - hx, y - hy);
            if way.norm() < 0.01 {
                break;
            }
            let step = way.capped(1.2 * PERIOD.secs());
            self.head = Some((hx + step.x, hy + step.y, yaw));
            self.step();
        }
    }

    /// The head goes with the seat.
    fn ride(&mut self, secs: f64, while_so: impl Fn(&Self) -> bool) -> (f64, f64) {
        let (mut speed, mut acceleration) = (0.0f64, 0.0f64);
        for _ in 0..(secs / PERIOD.secs()).round() as usize {
            if !while_so(self) {
                break;
            }
            let seen = self.watch(PERIOD.secs(), |_| true);
            (speed, acceleration) = (speed.max(seen.0), acceleration.max(seen.1));
            self.head = Some((self.column().x - 0.45, self.column().y, 0.0));
        }
        (speed, acceleration)
    }
}

#[test]
fn a_rider_is_carried_when_still_gently_to_the_end() {
    let mut room = riding();
    room.ride(0.7, |_| true);
    assert_eq!((room.phase(), room.speed() < 1e-3), (Some("waiting"), true));
    let (speed, acceleration) = room.ride(30.0, |room| room.scenario() == "begin");
    assert!(speed > 0.3 && speed <= 0.6, "{speed} m/s");
    assert!(acceleration <= 0.4 * 2f64.sqrt() + 1e-6, "{acceleration} m/s2");
    assert_eq!(room.scenario(), "end");
    assert!(room.column().distance_m(Floor::new(2.95, 2.0)) < 0.03, "at {:?}", room.column());
}

#[test]
fn whoever_steps_off_makes_it_stop() {
    let mut room = riding();
    room.ride(3.0, |_| true);
    assert_eq!(room.phase(), Some("riding"));
    let column = room.column();
    room.walk_to(column.x - 1.2, column.y);
    room.run(1.0);
    assert!(room.speed() < 1e-3);
    assert_eq!(room.ended_because(), [Reason::SteppedOff]);
    assert_eq!(room.engine.snapshot(room.now).bears, None);
}

#[test]
fn a_stop_does_not_drop_a_rider() {
    let mut room = riding();
    room.ride(3.0, |_| true);
    room.ask(RequestKind::Stop);
    room.run(3.0);
    assert_eq!(room.engine.mode(), Mode::LatchedStop);
    assert_eq!(room.step().action(), Action::Hold, "the drive stays on");
    assert_eq!(room.engine.snapshot(room.now).bears, Some(VISITOR));
    // A hand on the column makes it sway: that is no runaway.
    room.report.velocity = Planar::new(0.1, 0.0);
    assert_eq!(room.step().action(), Action::Hold);
    let answer = room.engine.request(room.now, Request::ConfirmFree);
    assert_eq!(answer, Answer { outcome: Outcome::Accepted, reason: Reason::NobodyLeans });
    room.run(0.2);
    assert_eq!(room.step().action(), Action::Release);
}

#[test]
fn what_is_held_keeps_its_place_whatever_is_meant_and_a_stop_does_not_drop_who_leans() {
    let mut room = offering(Interaction::Hold, None);
    room.takes_hold();
    room.run(0.1);
    assert_eq!(room.phase(), Some("holding"));
    let cue = room.engine.request(room.now, Request::Cue("on".into()));
    assert_eq!(cue.outcome, Outcome::Accepted, "another object is enabled now");
    room.ask(RequestKind::Disarm);
    room.run(1.0);
    assert_eq!(room.step().action(), Action::Hold);
    room.hand(false);
    room.run(0.2);
    assert_eq!(room.step().action(), Action::Release);
}

#[test]
fn a_wall_steps_back_when_nobody_leans_on_it_any_more() {
    let panel = PropSpec {
        id: "panel".into(),
        offset: Planar::new(-0.28, 0.0),
        facing_rad: std::f64::consts::PI,
        size_m: Planar::new(0.04, 0.6),
    };
    let mut room = offering(Interaction::StepBack { distance_m: 0.2 }, Some(panel));
    room.enter(2.6, 3.5, 0.0);
    room.watch(15.0, |room| room.scenario() == "begin");
    assert!(room.column().distance_m(Floor::new(3.98, 3.5)) < 0.03, "at {:?}", room.column());
    assert_eq!(room.scenario(), "end");
}

#[test]
fn a_ghost_comes_to_who_stands_still_and_leaves() {
    let fabric = PropSpec {
        id: "fabric".into(),
        offset: Planar::new(-0.45, 0.0),
        facing_rad: std::f64::consts::PI,
        size_m: Planar::new(0.05, 0.05),
    };
    let mut room = offering(Interaction::Brush { speed_mps: 0.25, secs: 1.0 }, Some(fabric));
    room.enter(2.0, 3.5, 0.0);
    room.run(8.0);
    assert!(room.phase().is_none());
    let stood = room.column();
    room.arm_contact(60.0);
    let (speed, acceleration) = room.watch(10.0, |room| room.phase() != Some("touching"));
    assert!(speed > 0.1 && speed <= 0.3 && acceleration <= 0.5 * 2f64.sqrt() + 1e-6, "{speed} m/s");
    let tip = room.column() + Planar::new(-0.45, 0.0);
    assert!(tip.distance_m(Floor::new(2.0, 3.5)) < 0.1, "the prop is at {tip:?}");
    let body = room.engine.scene().footprint().distance_but_m(room.column(), Floor::new(2.0, 3.5), Some(0));
    assert!(body >= 0.35, "{body} m");
    room.watch(15.0, |room| room.scenario() == "begin");
    assert!(room.column().distance_m(stood) < 0.05, "back at {:?}", room.column());
}

#[test]
fn a_ghost_leaves_whoever_walks() {
    let mut room = offering(Interaction::Brush { speed_mps: 0.25, secs: 5.0 }, None);
    room.enter(2.4, 3.5, 0.0);
    room.run(8.0);
    let stood = room.column();
    room.arm_contact(60.0);
    room.watch(10.0, |room| room.phase() != Some("approaching"));
    room.run(0.5);
    room.walk_mps = (-0.6, 0.0);
    room.run(0.5);
    room.walk_mps = (0.0, 0.0);
    assert_eq!(room.phase(), Some("leaving"));
    room.watch(10.0, |room| room.scenario() == "begin");
    assert!(room.column().distance_m(stood) < 0.05, "back at {:?}", room.column());
}

#[test]
fn what_must_not_be_felt_is_kept_out_of_reach() {
    let mut room = offering(Interaction::Park, None);
    room.enter(2.0, 3.5, 0.0);
    room.run(10.0);
    assert_eq!(room.phase(), Some("parked"));
    let gap = room.engine.scene().footprint().distance_m(room.column(), Floor::new(2.0, 3.5));
    assert!(gap > 1.5, "{gap} m");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// R14: whatever a visitor does while they are led, carried or brushed, the column is no faster than it may be in a contact, and
    /// speeds up towards nobody who is nearer than 0.35 m.
    #[test]
    fn a_contact_keeps_its_limits_whatever_the_visitor_does(
        kind in 0..2usize,
        walks in prop::collection::vec(((-1.6..1.6f64, -1.6..1.6f64), any::<bool>(), 0.1..1.0f64), 1..12),
    ) {
        let interaction = if kind == 0 { Interaction::Lead(course()) } else { Interaction::Brush { speed_mps: 0.3, secs: 1.0 } };
        let mut room = offering(interaction, None);
        room.takes_hold();
        room.arm_contact(120.0);
        let fastest = if kind == 0 { 0.6 } else { 0.3 };
        for (walk, holds, secs) in walks {
            room.walk_mps = walk;
            room.hand(holds);
            for _ in 0..(secs / PERIOD.secs()) as usize {
                let (was, was_mps) = (room.column(), room.speed());
                let before = room.head;
                room.step();
                let in_contact = matches!(room.phase(), Some("leading" | "approaching" | "leaving"));
                if in_contact {
                    prop_assert!(room.speed() <= fastest + 1e-6, "{} m/s", room.speed());
                    if let Some((x, y, _)) = before {
                        let gap = |column| room.engine.scene().footprint().distance_m(column, Floor::new(x, y));
                        let comes_nearer = gap(room.column()) < gap(was) - 1e-9;
                        let speeds_up = room.speed() > was_mps + 0.005;
                        prop_assert!(!(comes_nearer && speeds_up) || gap(room.column()) > 0.35, "{} m", gap(room.column()));
                    }
                }
                // Nobody walks out of the arena.
                if let Some((x, y, _)) = &mut room.head {
                    (*x, *y) = (x.clamp(0.0, 4.0), y.clamp(0.0, 4.0));
                }
            }
        }
    }
}
