//! Scenarios in the whole loop: the paper's first scene from its start to its end, and states that change under people's feet.

use std::sync::Arc;

use covr_engine::event::EventKind;
use covr_engine::frames::{Floor, Planar, Point, Pose};
use covr_engine::intention::{IntentionParameters, RuleName};
use covr_engine::motion::MotionName;
use covr_engine::observation::{Hands, Observation, PersonId, PoseSample};
use covr_engine::safety::separation::KeptFrom;
use covr_engine::scene::Scene;
use covr_engine::time::{Span, Time};
use covr_engine::{EngineConfig, Outcome, Request};
use covr_gantry::contract::Gantry;
use covr_gantry::sim::SimulatedMachine;
use covr_gantry::sim::parameters::MachineParameters;
use covr_study::random::Random;
use covr_study::replay::{ClosedLoop, LinkProfile, TrueHead};
use covr_study::visitor::Visitor;
use covr_wire::scene::parse_scene;
use nalgebra::UnitQuaternion;
use serde_json::{Value, json};

const ADA: PersonId = PersonId(1);
const PERIOD: Span = Span::from_millis(4);

fn armed(scene: &Arc<Scene>) -> ClosedLoop {
    let arena = scene.spec().arena;
    let parameters = MachineParameters { start: Floor::new(0.3, 0.3), ..MachineParameters::paper(arena) };
    let machine = Box::new(SimulatedMachine::new(parameters).expect("the paper's machine is possible"));
    let config = EngineConfig {
        limits: machine.limits(),
        travel: arena,
        period: PERIOD,
        intention_rule: RuleName::Bayes,
        intention: IntentionParameters::default(),
        motion: MotionName::Planner,
        standing: None,
        kept_from: KeptFrom::Everybody,
        v_h_mps: 1.6,
        needs_game_master: false,
        latched_because: None,
    };
    let random = Random::seeded(1);
    let mut control =
        ClosedLoop::new(config, scene.clone(), machine, LinkProfile::WIRELESS, random, Time::ZERO);
    control.bring_up(Span::from_millis(60_000)).expect("it homes and arms");
    control
}

fn holds(control: &ClosedLoop) {
    let (truth, commanded) = (control.true_verdict(), control.commanded_verdict());
    assert_eq!(truth.violations() + commanded.violations(), 0, "{:?} {:?}", truth.first, commanded.first);
    assert!(truth.moving_ticks > 500, "the column hardly moved: this proves nothing");
}

/// A visitor who does what each step asks.
struct Play {
    control: ClosedLoop,
    scene: Arc<Scene>,
    at: Floor,
    looks_at: Point<covr_engine::frames::Room>,
    steps: u32,
}

impl Play {
    fn step(&mut self) {
        let head = Point::new(self.at.x, self.at.y, 1.65);
        let (dx, dy, dz) =
            (self.looks_at.x() - head.x(), self.looks_at.y() - head.y(), self.looks_at.z() - head.z());
        let orientation = UnitQuaternion::from_euler_angles(0.0, -dz.atan2(dx.hypot(dy)), dy.atan2(dx));
        let pose = Pose { position: head, orientation };
        if self.steps.is_multiple_of(3) {
            let sample = PoseSample {
                taken_at: self.control.now(),
                pose,
                tracked: true,
                worn: true,
                hands: Hands::UNKNOWN,
            };
            self.control.send(ADA, sample);
        }
        self.steps += 1;
        self.control.step(&[TrueHead { person: ADA, pose }]);
    }

    fn look_at(&mut self, object: &str) {
        let spec = self.scene.spec().objects.iter().find(|known| known.id == object).expect("an object");
        self.looks_at = spec.position;
    }

    fn walk_to(&mut self, place: Floor) {
        while self.at.distance_m(place) > 0.01 {
            let way = (place - self.at).capped(0.7 * PERIOD.secs());
            self.at += way;
            self.step();
        }
    }

    fn wait(&mut self, secs: f64) {
        for _ in 0..(secs / PERIOD.secs()).round() as u32 {
            self.step();
        }
    }

    /// Until the column stands still where it serves the object.
    fn wait_for_column(&mut self, object: &str) {
        let index = self.scene.spec().objects.iter().position(|known| known.id == object).expect("an object");
        for _ in 0..5_000 {
            self.step();
            if self.off_m(index) < 0.1 && self.speed_mps() < 0.01 {
                return;
            }
        }
        panic!("the column did not come to {object}: {:.2} m off, in {}", self.off_m(index), self.state());
    }

    fn off_m(&self, object: usize) -> f64 {
        let snapshot = self.control.engine().snapshot(self.control.now());
        snapshot.column.position.distance_m(snapshot.objects[object].column_place)
    }

    fn speed_mps(&self) -> f64 {
        self.control.engine().snapshot(self.control.now()).column.velocity.norm()
    }

    fn arm_contact(&mut self) {
        let answer = self.control.request(Request::ArmContact(ADA, Span::from_millis(60_000)));
        assert_eq!(answer.outcome, Outcome::Accepted, "{:?}", answer.reason);
    }

    fn column(&self) -> Floor {
        self.control.engine().snapshot(self.control.now()).column.position
    }

    /// Walks after what she holds, for so long or until the state is left.
    fn led(&mut self, secs: f64) {
        let state = self.state();
        for _ in 0..(secs / PERIOD.secs()).round() as u32 {
            let hand = self.column() + Planar::new(0.0, -0.35);
            let behind = hand + Planar::new(0.0, -0.55);
            self.at += (behind - self.at).capped(0.9 * PERIOD.secs());
            self.step();
            if self.state() != state {
                break;
            }
        }
    }

    /// Goes with the seat, for so long or until the state is left.
    fn carried(&mut self, secs: f64) {
        let state = self.state();
        for _ in 0..(secs / PERIOD.secs()).round() as u32 {
            let seat = self.column() + Planar::new(-0.45, 0.0);
            self.at += (seat - self.at).capped(1.2 * PERIOD.secs());
            self.step();
            if self.state() != state {
                break;
            }
        }
    }

    fn touch(&mut self, object: &str, began: bool) {
        let object = object.into();
        self.control.observe(if began {
            Observation::TouchBegan(ADA, object)
        } else {
            Observation::TouchEnded(ADA, object)
        });
    }

    fn state(&self) -> String {
        self.control.engine().snapshot(self.control.now()).scenario.expect("a scenario").state
    }
}

#[test]
fn the_papers_first_scene_is_played_from_start_to_end_also_with_a_hand_that_lets_go() {
    let document = include_bytes!("../../deploy/scenes/escape-room.json");
    let scene = Arc::new(parse_scene(document).expect("a good scene").1);
    let control = armed(&scene);
    let looks_at = Point::new(2.6, 3.2, 2.2);
    let mut play = Play { control, scene, at: Floor::new(3.3, 0.6), looks_at, steps: 0 };
    play.control.observe(Observation::PersonEntered(ADA));

    play.look_at("bulb");
    play.wait_for_column("bulb");
    play.walk_to(Floor::new(2.6, 2.35));
    play.touch("bulb", true);
    assert_eq!(play.state(), "lit");
    play.touch("bulb", false);
    play.looks_at = Point::new(2.2, 1.4, 0.0);
    play.walk_to(Floor::new(2.2, 1.4));
    play.step();
    assert_eq!(play.state(), "walls");

    play.look_at("wall_middle");
    play.walk_to(Floor::new(1.5, 1.55));
    play.wait_for_column("wall_middle");
    play.touch("wall_middle", true);
    play.wait(7.0);
    // She lets go too early: the ten seconds begin again.
    play.touch("wall_middle", false);
    play.wait(0.5);
    play.touch("wall_middle", true);
    let pushed_at = play.control.now();
    for _ in 0..2_400 {
        play.step();
        assert_eq!(play.state(), "walls");
        assert!(play.off_m(2) < 0.1 && play.speed_mps() < 0.05, "the wall stands while it is pushed");
    }
    while play.state() == "walls" {
        play.step();
    }
    let held = (play.control.now() - pushed_at).secs();
    assert!((held - 10.0).abs() < 0.05, "given way after {held} s");
    assert_eq!(play.state(), "pushed");
    // While her hand stays there is no way on.
    play.wait(6.0);
    assert_eq!(play.state(), "pushed");
    play.touch("wall_middle", false);
    play.step();
    play.step();
    assert_eq!(play.state(), "broom");

    // The broom is armed when she is about to take it, and pulls her out; once she lets go on the way.
    play.look_at("broom");
    play.walk_to(Floor::new(3.2, 0.4));
    play.wait_for_column("broom");
    play.walk_to(Floor::new(2.15, 0.15));
    play.arm_contact();
    play.touch("broom", true);
    play.led(1.5);
    play.touch("broom", false);
    play.wait(1.0);
    assert!(play.speed_mps() < 0.01 && play.state() == "broom");
    play.touch("broom", true);
    play.led(10.0);
    assert_eq!(play.state(), "escaped");
    play.touch("broom", false);

    let entered: Vec<String> = play
        .control
        .drain_events()
        .filter_map(|event| match event.kind {
            EventKind::StateEntered { to, .. } => Some(to.to_string()),
            _ => None,
        })
        .collect();
    assert_eq!(entered, ["dark", "lit", "walls", "pushed", "broom", "escaped"]);
    let snapshot = play.control.engine().snapshot(play.control.now());
    let wall = snapshot.scenario.expect("a scenario").variables.into_iter().find(|(id, _)| id == "wall");
    assert_eq!(wall.map(|(_, value)| value.number()), Some(2));
    holds(&play.control);
}

#[test]
fn the_papers_second_scene_is_played_from_start_to_end_with_a_ride_and_a_ghost() {
    let scene =
        Arc::new(parse_scene(include_bytes!("../../deploy/scenes/clouds.json")).expect("a good scene").1);
    let control = armed(&scene);
    let looks_at = Point::new(1.2, 3.2, 1.3);
    let mut play = Play { control, scene, at: Floor::new(2.6, 3.4), looks_at, steps: 0 };
    play.control.observe(Observation::PersonEntered(ADA));

    play.wait_for_column("continue");
    play.walk_to(Floor::new(1.75, 3.2));
    play.touch("continue", true);
    play.touch("continue", false);
    assert_eq!(play.state(), "chair");

    // She sits down, is carried, gets up in the middle, sits down again.
    play.look_at("cloud_chair");
    play.walk_to(Floor::new(1.9, 0.7));
    play.wait_for_column("cloud_chair");
    play.walk_to(Floor::new(2.7, 2.1));
    play.arm_contact();
    play.touch("cloud_chair", true);
    play.carried(3.5);
    assert!(play.speed_mps() > 0.1, "the ride has begun");
    let seat = play.column() + Planar::new(-0.45, 0.0);
    play.walk_to(seat + Planar::new(-0.3, 0.9));
    play.touch("cloud_chair", false);
    play.wait(1.0);
    assert!(play.speed_mps() < 0.01, "nobody sits on it");
    let seat = play.column() + Planar::new(-0.45, 0.0);
    play.walk_to(seat);
    play.touch("cloud_chair", true);
    play.carried(20.0);
    assert_eq!(play.state(), "ghosts");
    play.touch("cloud_chair", false);

    play.look_at("ghost");
    play.walk_to(Floor::new(1.6, 2.9));
    play.walk_to(Floor::new(3.4, 2.0));
    play.wait_for_column("ghost");
    play.walk_to(Floor::new(3.4, 0.9));
    play.arm_contact();
    let before = play.column();
    let mut nearest_m = f64::INFINITY;
    for _ in 0..5_000 {
        play.step();
        let fabric = play.column() + Planar::new(0.85, 0.2);
        nearest_m = nearest_m.min(fabric.distance_m(play.at));
        if play.state() != "ghosts" {
            break;
        }
    }
    assert_eq!(play.state(), "end");
    assert!(nearest_m < 0.1, "the fabric came as near as {nearest_m} m");
    assert!(play.column().distance_m(before) < 0.05, "and the ghost left");
    holds(&play.control);
    let verdict = play.control.true_verdict();
    assert!(verdict.least_separation_moving_m.is_some_and(|m| m < 0.2), "she rode");
}

/// The demo's objects, on and off by turns, faster than anybody could show them.
fn flickering() -> Scene {
    let mut scene: Value =
        serde_json::from_slice(include_bytes!("../../deploy/scenes/demo.json")).expect("JSON");
    let sets = [
        vec!["lamp", "door"],
        vec!["globe"],
        vec![],
        vec!["painting", "desk", "lamp"],
        vec!["door", "globe"],
    ];
    let states: Vec<Value> = (0..sets.len())
        .map(|i| {
            let secs = 0.35 + 0.4 * i as f64;
            json!({ "id": format!("s{i}"), "enabled": sets[i], "transitions": [
                { "when": { "kind": "time_in_state", "secs": secs }, "to": format!("s{}", (i + 1) % sets.len()) }] })
        })
        .collect();
    scene["scenario"] = json!({ "initial": "s0", "states": states });
    parse_scene(scene.to_string().as_bytes()).expect("a good scene").1
}

#[test]
fn nobody_is_met_while_states_change_under_their_feet() {
    for seed in 1..=4 {
        let scene = Arc::new(flickering());
        let mut control = armed(&scene);
        control.observe(Observation::PersonEntered(ADA));
        let began = control.now();
        for (i, sample) in Visitor::of_scene(scene.spec(), 250.0, seed).take(15_000).enumerate() {
            if i % 3 == 0 {
                let taken_at = began + (sample.at - Time::ZERO);
                control.send(
                    ADA,
                    PoseSample {
                        taken_at,
                        pose: sample.pose,
                        tracked: true,
                        worn: true,
                        hands: sample.hands,
                    },
                );
            }
            control.step(&[TrueHead { person: ADA, pose: sample.pose }]);
        }
        holds(&control);
        let entered =
            control.drain_events().filter(|e| matches!(e.kind, EventKind::StateEntered { .. })).count();
        assert!(entered > 40, "{entered} states");
        assert_ne!(
            control.engine().snapshot(control.now()).column.position - Floor::new(0.3, 0.3),
            Planar::ZERO
        );
    }
}
