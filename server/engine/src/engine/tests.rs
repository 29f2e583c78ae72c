//! The engine as a whole, on virtual time, in front of a machine that does exactly what it is told.

mod foretold;
mod game_master;
mod inputs;
mod interacting;
mod jog;
mod modes;
mod playing;
mod rules;
mod shown;

use super::*;
use crate::frames::{Floor, Planar, Point, Pose};
use crate::intention::IntentionParameters;
use crate::machine::Homing;
use crate::mode::RequestKind;
use crate::motion::MotionName;
use crate::motion::jog::{Aim, JogOrder};
use crate::observation::{Hands, PoseSample};
use crate::safety::separation::KeptFrom;
use crate::safety::vetted::Action;
use crate::scene::{KeepOutShape, KeepOutSpec, ObjectSpec, SceneSpec, Shape};
use crate::snapshot::{Activity, Holder};
use nalgebra::UnitQuaternion;
use proptest::prelude::*;

const PERIOD: Span = Span::from_millis(4);
const TRAVEL: Travel = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) };
const VISITOR: PersonId = PersonId(1);
/// The rule and the motion of the paper.
const PAPERS: (RuleName, MotionName) = (RuleName::PaperBest, MotionName::Proxy);
/// Ours, the default.
const OURS: (RuleName, MotionName) = (RuleName::Bayes, MotionName::Planner);

/// An engine, an obedient machine and a visitor whose pose arrives with each step, 20 ms old.
struct Room {
    engine: Engine,
    now: Time,
    report: MachineReport,
    head: Option<(f64, f64, f64)>,
    /// How the head moves, m/s along x and y.
    walk_mps: (f64, f64),
    machine_answers: bool,
}

impl Room {
    fn new(latched_because: Option<&str>) -> Self {
        Self::build(latched_because, PAPERS)
    }

    fn build(latched_because: Option<&str>, (intention_rule, motion): (RuleName, MotionName)) -> Self {
        let ball = |id: &str, x, y| ObjectSpec {
            id: id.into(),
            position: Point::new(x, y, 1.4),
            yaw_rad: 0.0,
            shape: Shape::Sphere { radius_m: 0.1 },
            prop: None,
            prior: 1.0,
            enabled: true,
        };
        let spec = SceneSpec::open(TRAVEL, vec![ball("left", 3.5, 3.5), ball("right", 3.5, 0.5)]);
        let config = EngineConfig {
            limits: Limits::PAPER,
            travel: TRAVEL,
            period: PERIOD,
            intention_rule,
            intention: IntentionParameters::default(),
            motion,
            standing: None,
            kept_from: KeptFrom::Everybody,
            v_h_mps: 1.6,
            needs_game_master: false,
            latched_because: latched_because.map(str::to_owned),
        };
        Self {
            engine: Engine::new(config, Arc::new(Scene::build(spec).unwrap())),
            now: Time::ZERO,
            report: MachineReport {
                answered_at: Time::ZERO,
                position: Floor::new(0.3, 0.3),
                velocity: Planar::ZERO,
                current_amps: [0.5; 2],
                drive: Drive::Released,
                homing: Homing::NotHomed,
                home_repeatability_m: None,
                trouble: None,
            },
            head: None,
            walk_mps: (0.0, 0.0),
            machine_answers: true,
        }
    }

    fn armed() -> Self {
        Self::armed_with(PAPERS)
    }

    fn armed_with(deciding: (RuleName, MotionName)) -> Self {
        let mut room = Self::build(None, deciding);
        room.ask(RequestKind::Home);
        room.run(0.5);
        assert_eq!(room.engine.mode(), Mode::Ready);
        room.ask(RequestKind::Arm);
        room.run(0.1);
        assert_eq!(room.engine.mode(), Mode::Following);
        room
    }

    fn ask(&mut self, kind: RequestKind) -> Answer {
        let request = match kind {
            RequestKind::Jog => {
                Request::Jog(JogOrder { aim: Aim::Along(Planar::new(1.0, 0.0)), speed_mps: 0.1 })
            }
            kind => Request::Machine(kind, Some("test".into())),
        };
        self.engine.request(self.now, request)
    }

    fn enter(&mut self, x: f64, y: f64, yaw_rad: f64) {
        self.engine.observe(self.now, Observation::PersonEntered(VISITOR));
        self.head = Some((x, y, yaw_rad));
    }

    fn run(&mut self, secs: f64) {
        for _ in 0..(secs / PERIOD.secs()).round() as usize {
            self.step();
        }
    }

    fn step(&mut self) -> Vetted {
        self.now += PERIOD;
        if self.machine_answers {
            self.report.answered_at = self.now;
        }
        self.engine.observe(self.now, Observation::Machine(self.report));
        if let Some((x, y, yaw)) = &mut self.head {
            *x += self.walk_mps.0 * PERIOD.secs();
            *y += self.walk_mps.1 * PERIOD.secs();
            let (x, y, yaw) = (*x, *y, *yaw);
            let orientation = UnitQuaternion::from_euler_angles(0.0, 0.0, yaw);
            let pose = Pose { position: Point::new(x, y, 1.6), orientation };
            let taken_at = self.now - Span::from_millis(20);
            let sample = PoseSample { taken_at, pose, tracked: true, worn: true, hands: Hands::UNKNOWN };
            self.engine.observe(self.now, Observation::Pose(VISITOR, sample));
        }
        let command = self.engine.step(self.now);
        self.report.drive = Drive::On;
        match command.action() {
            Action::Release => self.report.drive = Drive::Released,
            Action::Home => {
                let long = self.now - self.engine.mode_since > Span::from_millis(200);
                self.report.homing = if long { Homing::Homed } else { Homing::Running };
            }
            Action::Hold => self.report.velocity = Planar::ZERO,
            Action::Track(setpoint) => {
                self.report.position = setpoint.position;
                self.report.velocity = setpoint.velocity;
            }
        }
        command
    }

    fn column(&self) -> Floor {
        self.report.position
    }
}

#[test]
fn it_starts_disarmed_and_arms_only_after_homing() {
    let mut room = Room::new(None);
    room.run(0.1);
    assert_eq!(room.engine.mode(), Mode::Disarmed);
    assert_eq!(room.ask(RequestKind::Arm).outcome, Outcome::Refused);
    assert_eq!(room.step().action(), Action::Release);
}

#[test]
fn it_starts_latched_after_a_run_that_ended_so_and_reset_starts_nothing() {
    let mut room = Room::new(Some("somebody pressed stop"));
    room.run(0.1);
    assert_eq!(room.engine.mode(), Mode::LatchedStop);
    let stop = room.engine.snapshot(room.now).stop.unwrap();
    assert_eq!(stop.reason, Reason::LastRunLatched("somebody pressed stop".into()));
    assert_eq!(room.ask(RequestKind::Home).outcome, Outcome::Refused);
    assert_eq!(room.ask(RequestKind::Reset).outcome, Outcome::Accepted);
    room.run(0.1);
    assert_eq!(room.engine.mode(), Mode::Disarmed);
    assert_eq!(room.step().action(), Action::Release);
}

#[test]
fn the_column_goes_to_what_the_visitor_looks_at() {
    let mut room = Room::armed();
    room.enter(2.0, 3.5, 0.0);
    room.run(6.0);
    assert!(room.column().distance_m(Floor::new(3.5, 3.5)) < 0.01, "stands at {:?}", room.column());
    room.head = Some((2.0, 0.5, 0.0));
    room.run(9.0);
    assert!(room.column().distance_m(Floor::new(3.5, 0.5)) < 0.01, "stands at {:?}", room.column());
}

#[test]
fn a_prior_moves_the_column() {
    let mut room = Room::armed();
    room.enter(1.0, 3.4, 2.5);
    room.run(4.0);
    let between = room.column();
    let answer = room.engine.request(room.now, Request::SetPriors(vec![(0, 0.0), (1, 1.0)]));
    assert_eq!(answer.outcome, Outcome::Accepted);
    room.run(5.0);
    assert!(room.column().distance_m(Floor::new(3.5, 0.5)) < 0.01, "from {between:?} to {:?}", room.column());
    assert_eq!(room.engine.request(room.now, Request::SetPriors(vec![(0, 1.5)])).outcome, Outcome::Refused);
    assert_eq!(room.engine.priors(), [0.0, 1.0]);
}

#[test]
fn stop_brakes_then_releases_and_stays() {
    let mut room = Room::armed();
    room.enter(2.0, 3.5, 0.0);
    room.run(1.0);
    assert!(room.report.velocity.norm() > 0.2);
    assert_eq!(room.ask(RequestKind::Stop).outcome, Outcome::Accepted);
    assert_eq!(room.step().action(), Action::Hold, "the first command after the stop brakes");
    room.run(0.3);
    assert_eq!(room.step().action(), Action::Release);
    room.run(5.0);
    assert_eq!(room.engine.mode(), Mode::LatchedStop);
    assert_eq!(room.ask(RequestKind::Arm).outcome, Outcome::Refused);
}

#[test]
fn a_column_that_still_moves_is_armed_by_nobody() {
    let mut room = Room::armed();
    room.enter(2.0, 3.5, 0.0);
    room.run(1.0);
    room.ask(RequestKind::Disarm);
    assert!(room.report.velocity.norm() > 0.2);
    for kind in [RequestKind::Arm, RequestKind::Home] {
        let answer = room.ask(kind);
        assert_eq!((answer.outcome, room.engine.mode()), (Outcome::Refused, Mode::Disarmed), "{answer:?}");
    }
    room.run(1.0);
    room.ask(RequestKind::Arm);
    assert_eq!(room.engine.mode(), Mode::Following);
}

#[test]
fn a_brake_that_does_not_bite_is_let_go() {
    let mut room = Room::armed();
    room.enter(2.0, 3.5, 0.0);
    room.run(1.0);
    room.ask(RequestKind::Stop);
    room.step();
    for _ in 0..20 {
        room.report.velocity = Planar::new(0.9, 0.9);
        room.step();
    }
    assert_eq!(room.step().action(), Action::Release);
}

#[test]
fn homing_into_a_keep_out_shape_is_refused_by_its_name() {
    let mut room = Room::new(None);
    room.run(0.1);
    let mut spec = room.engine.scene().spec().clone();
    let shape = KeepOutShape::Circle { centre: Floor::new(0.9, 0.1), radius_m: 0.2 };
    spec.keep_outs.push(KeepOutSpec { id: "sofa".into(), shape });
    let scene = Arc::new(Scene::build(spec).unwrap());
    assert_eq!(room.engine.request(room.now, Request::ActivateScene(scene)).outcome, Outcome::Accepted);
    let answer = room.ask(RequestKind::Home);
    assert_eq!(answer.outcome, Outcome::Refused);
    assert!(
        matches!(&answer.reason, Reason::HomingNearKeepOut { keep_out, .. } if keep_out == "sofa"),
        "{answer:?}"
    );
}

#[test]
fn homing_waits_for_somebody_near() {
    let mut room = Room::new(None);
    room.enter(0.6, 0.6, 0.0);
    room.run(0.1);
    room.ask(RequestKind::Home);
    assert_eq!(room.step().action(), Action::Hold);
    room.head = Some((3.0, 3.0, 0.0));
    // A jump: not believed for a second, then a second more until the protective stop clears.
    room.run(3.0);
    assert_eq!(room.engine.mode(), Mode::Ready);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// The plain rule, by its own arithmetic, for a person who walks straight at the column from anywhere.
    #[test]
    fn nobody_who_walks_at_the_column_meets_it_moving(
        x in 0.2..3.8f64, y in 0.2..3.8f64, pace in 0.1..1.6f64, wait in 0.0..3.0f64, yaw in -3.1..3.1f64,
    ) {
        let mut room = Room::armed();
        prop_assume!(room.column().distance_m(Floor::new(x, y)) > 1.0);
        room.enter(x, y, yaw);
        room.run(wait);
        for _ in 0..1500 {
            let (hx, hy, _) = room.head.unwrap();
            let to_column = room.column() - Floor::new(hx, hy);
            let ahead = to_column.unit().unwrap_or(Planar::ZERO) * (pace * PERIOD.secs());
            room.head = Some((hx + ahead.x, hy + ahead.y, yaw));
            room.step();
            let velocity = room.report.velocity;
            let speed = velocity.norm();
            let retreats = velocity.dot(to_column) > 0.0 && speed <= 0.3;
            let rests_after = velocity.x.abs().max(velocity.y.abs()) / 2.5;
            let slack = (0..=20).map(|k| {
                let s = rests_after * f64::from(k) / 20.0;
                // Each axis brakes at 2.5 m/s2 and then rests.
                let way = |v: f64| {
                    let t = s.min(v.abs() / 2.5);
                    v * t - 1.25 * t * t * v.signum()
                };
                let (x, y) = (room.column().x + way(velocity.x), room.column().y + way(velocity.y));
                let gap = ((x - hx).abs() - 0.075).max(0.0).hypot(((y - hy).abs() - 0.075).max(0.0));
                gap - 0.25 - 1.6 * s
            });
            let slack = slack.fold(f64::INFINITY, f64::min);
            prop_assert!(
                speed < 1e-3 || retreats || slack > 0.0,
                "{speed} m/s with {slack} m to spare",
            );
        }
    }
}
