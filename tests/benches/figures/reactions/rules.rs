//! Causes that rules see, on virtual time: an armed engine that leads an ideal machine after a person, and a cause at a
//! random moment.

use std::sync::Arc;

use covr_engine::frames::{Floor, Planar, Point, Pose};
use covr_engine::intention::{IntentionParameters, RuleName};
use covr_engine::machine::{Limits, MachineReport};
use covr_engine::mode::{Mode, RequestKind};
use covr_engine::motion::MotionName;
use covr_engine::observation::{Hands, Observation, PersonId, PoseSample};
use covr_engine::safety::parameters::Parameters;
use covr_engine::safety::separation::KeptFrom;
use covr_engine::safety::vetted::{Action, Vetted};
use covr_engine::time::{Span, Time};
use covr_engine::{Engine, EngineConfig, Request};
use covr_gantry::contract::Gantry;
use covr_gantry::ideal::IdealMachine;
use covr_study::random::Random;
use covr_wire::scene::parse_scene;
use nalgebra::UnitQuaternion;

use super::row;
use crate::Effort;
use crate::samples::Samples;
use crate::table::Row;

/// What happens, each from one moment on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Cause {
    /// The headset says that it does not know its place.
    Untracked,
    /// No pose comes any more.
    Silence,
    /// The client's connection ends.
    ClientCut,
    /// The controller answers no more.
    ControllerCut,
    /// A motor draws more than its limit.
    OverCurrent,
    /// The machine is 6 cm off its command.
    FollowingError,
    /// Every step begins more than a period late.
    LateSteps,
}

/// A row for each cause.
pub fn measure(effort: Effort) -> Vec<Row> {
    let p = Parameters::new(1.6);
    let late = Span::from_micros(i64::from(p.missed_deadlines) * 4 * PERIOD.micros());
    [
        (Cause::Untracked, "tracking lost, as the headset says it (R2)", Span::ZERO, "the next step"),
        (Cause::Silence, "tracking lost, no pose any more (R2)", p.pose_age, "the pose's age limit and a step"),
        (Cause::ClientCut, "client cut (R10)", Span::ZERO, "the next step"),
        (Cause::ControllerCut, "controller cut (R8; its own timeout brakes after 50 ms)", p.link, "the link's limit and a step"),
        (Cause::OverCurrent, "over-current (R5)", p.current_for, "the current's time and a step"),
        (Cause::FollowingError, "following error of 6 cm (R6)", Span::ZERO, "the next step"),
        (Cause::LateSteps, "missed deadlines, the first of three (R9)", late, "three steps, each up to three periods late"),
    ]
    .into_iter()
    .map(|(cause, name, allowed, limit)| {
        let count = effort.of(2_000, 20);
        let mut random = Random::seeded(7);
        let took: Samples = (0..count).map(|_| reaction(cause, &mut random).secs() * 1e6).collect();
        let limit_micros = (allowed + PERIOD).micros() as f64;
        let how = format!("{count} at random moments of an approach, virtual time, one person, default rule and motion, ideal machine");
        row(name, &took, limit_micros, limit, how)
    })
    .collect()
}

/// From the cause to the first command that brakes.
fn reaction(cause: Cause, random: &mut Random) -> Span {
    let mut room = Room::armed();
    for _ in 0..50 + random.below(150) {
        room.step();
    }
    let begins = room.now + Span::from_micros((random.unit() * PERIOD.micros() as f64) as i64) - PERIOD;
    room.cause = Some(cause);
    if cause == Cause::ClientCut {
        room.engine.observe(room.now, Observation::ClientGone(VISITOR));
    }
    // The moment of a step that is late is when it was due; of what stops coming, when it last came.
    let begins = match cause {
        Cause::LateSteps => room.now,
        Cause::Silence | Cause::ControllerCut => room.now - PERIOD,
        _ => begins,
    };
    loop {
        if cause == Cause::LateSteps {
            let late = Span::from_micros(((1.0 + 2.0 * random.unit()) * PERIOD.micros() as f64) as i64 + 1);
            room.now += late;
            room.engine.observe(room.now, Observation::DeadlineMissed);
        }
        let at = room.now;
        let command = room.step();
        // In a protective stop the brake is commanded as a course, else it is the machine's own.
        if room.engine.mode() != Mode::Following || !matches!(command.action(), Action::Track(_)) {
            return at - begins;
        }
        assert!(at - begins < Span::from_millis(5_000), "{cause:?} stops nothing");
    }
}

/// An engine that leads a machine after somebody who stands and looks at an object.
struct Room {
    engine: Engine,
    machine: IdealMachine,
    now: Time,
    heard: Option<MachineReport>,
    person_is_there: bool,
    cause: Option<Cause>,
}

impl Room {
    fn armed() -> Self {
        let (_, scene) = parse_scene(include_bytes!("../../../../deploy/scenes/demo.json")).unwrap();
        let travel = scene.spec().arena;
        let config = EngineConfig {
            limits: Limits::PAPER,
            travel,
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
        let engine = Engine::new(config, Arc::new(scene));
        let machine = IdealMachine::new(Limits::PAPER, travel, Floor::new(0.3, 0.3));
        let mut room =
            Self { engine, machine, now: Time::ZERO, heard: None, person_is_there: false, cause: None };
        room.ask(RequestKind::Home, Mode::Ready);
        room.ask(RequestKind::Arm, Mode::Following);
        room.engine.observe(room.now, Observation::PersonEntered(VISITOR));
        room.person_is_there = true;
        room
    }

    fn ask(&mut self, kind: RequestKind, mode: Mode) {
        self.step();
        while self.engine.mode() != mode {
            self.engine.request(self.now, Request::Machine(kind, None));
            self.step();
            assert!(self.now < Time::ZERO + Span::from_millis(60_000), "never {}", mode.name());
        }
    }

    fn step(&mut self) -> Vetted {
        let now = self.now;
        let read = self.machine.read(now).report;
        let mut report = match (self.cause, self.heard) {
            (Some(Cause::ControllerCut), Some(heard)) => heard,
            _ => read,
        };
        match self.cause {
            Some(Cause::OverCurrent) => report.current_amps[0] = 6.0,
            Some(Cause::FollowingError) => report.position += Planar::new(0.06, 0.0),
            _ => {}
        }
        self.heard = Some(report);
        self.engine.observe(now, Observation::Machine(report));
        if self.person_is_there && self.cause != Some(Cause::Silence) {
            let pose = Pose {
                position: Point::new(3.2, 1.0, 1.7),
                orientation: UnitQuaternion::from_euler_angles(0.0, 0.0, 2.2),
            };
            let tracked = self.cause != Some(Cause::Untracked);
            let sample = PoseSample { taken_at: now, pose, tracked, worn: true, hands: Hands::UNKNOWN };
            self.engine.observe(now, Observation::Pose(VISITOR, sample));
        }
        let command = self.engine.step(now);
        self.machine.write(now, &command).unwrap();
        self.now = now + PERIOD;
        command
    }
}

const VISITOR: PersonId = PersonId(1);
const PERIOD: Span = Span::from_millis(4);
