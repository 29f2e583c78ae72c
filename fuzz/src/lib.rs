//! What is fuzzed, and what must never happen: a panic anywhere, and what each function asserts.

use std::io::{BufReader, Cursor};
use std::path::Path;
use std::sync::Arc;

use covr_engine::engine::Outcome;
use covr_engine::frames::{Floor, Planar, Point, Pose};
use covr_engine::intention::{IntentionParameters, RuleName};
use covr_engine::machine::{Drive, Homing, Limits, MachineReport};
use covr_engine::mode::{Mode, RequestKind};
use covr_engine::motion::MotionName;
use covr_engine::observation::{Hands, InputLevel, Inputs, Observation, PersonId, PoseSample};
use covr_engine::safety::separation::KeptFrom;
use covr_engine::safety::vetted::Action;
use covr_engine::time::{Span, Time};
use covr_engine::{Engine, EngineConfig, Request};
use covr_study::trace::Recordings;
use covr_wire::client::{Encoding, decode};
use covr_wire::scene::{build_scene, parse_scene};
use nalgebra::UnitQuaternion;

/// The first byte says which encoding, the rest is a frame of a client. What is a message stays one when it is written
/// again.
pub fn client_decoder(data: &[u8]) {
    let Some((first, frame)) = data.split_first() else { return };
    let encoding = if *first == b'm' { Encoding::MessagePack } else { Encoding::Json };
    match decode(encoding, frame) {
        Ok(message) => {
            let again = encoding.encode(&message).expect("what was read can be written");
            assert_eq!(decode(encoding, again.bytes()), Ok(message));
        }
        Err(refused) => assert!(!refused.message.is_empty(), "a refusal says why"),
    }
}

/// What is a scene is one when it is built from its document again; what is none is told why.
pub fn scene_parser(data: &[u8]) {
    match parse_scene(data) {
        Ok((document, _)) => assert!(build_scene(&document).is_ok()),
        Err(errors) => assert!(!errors.is_empty()),
    }
}

/// Recordings that were read have times in order; reading ends at the first error.
pub fn trace_reader(data: &[u8]) {
    let lines = Box::new(BufReader::new(Cursor::new(data.to_vec())));
    let mut failed = false;
    for recording in Recordings::from_lines(Path::new("fuzzed"), lines) {
        assert!(!failed, "something after an error");
        match recording {
            Ok(recording) => {
                assert!(recording.frames.is_sorted_by_key(|frame| frame.at), "times out of order");
                assert!(!recording.targets.is_empty());
            }
            Err(_) => failed = true,
        }
    }
}

/// Requests, people, inputs and a machine that does and says anything, in any order. Nothing but a reset leaves a latched
/// stop or a fault, and it leads to `disarmed`; nothing but arming leads to people being followed; a stop is never
/// refused; a machine that is stopped is told to hold or let go.
pub fn supervisor(data: &[u8]) {
    let (_, scene) = parse_scene(DEMO_SCENE).expect("the demo scene is right");
    let travel = scene.spec().arena;
    let config = EngineConfig {
        limits: Limits::PAPER,
        travel,
        period: PERIOD,
        intention_rule: RuleName::Paper,
        intention: IntentionParameters::default(),
        motion: MotionName::Proxy,
        standing: None,
        kept_from: KeptFrom::Everybody,
        v_h_mps: 1.6,
        needs_game_master: data.first().is_some_and(|first| first % 2 == 1),
        latched_because: None,
    };
    let mut driven = Driven {
        engine: Engine::new(config, Arc::new(scene)),
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
        answers: true,
        armed: false,
    };
    let mut bytes = data.iter().skip(1).copied();
    while let Some(act) = bytes.next() {
        driven.act(act, bytes.next().unwrap_or(0));
        driven.step();
    }
}

struct Driven {
    engine: Engine,
    now: Time,
    report: MachineReport,
    answers: bool,
    armed: bool,
}

impl Driven {
    fn act(&mut self, act: u8, value: u8) {
        let share = f64::from(value) / 255.0;
        let person = PersonId(u32::from(value % 3) + 1);
        let observation = match act % 16 {
            0..=4 => return self.ask(RequestKind::ALL[usize::from(act % 16)]),
            5 => Observation::PersonEntered(person),
            6 => Observation::PersonLeft(person),
            7 => {
                let at = Point::new(4.0 * share, 4.0 * f64::from(value % 16) / 15.0, 0.4 + 1.4 * share);
                let orientation = UnitQuaternion::from_euler_angles(0.0, 0.0, 6.0 * share - 3.0);
                let pose = Pose { position: at, orientation };
                let (tracked, worn) = (!value.is_multiple_of(7), !value.is_multiple_of(11));
                let hand = Point::new(at.x() + share, at.y() - 0.3, at.z() - 0.6 * share);
                let hands = Hands { left: None, right: (!value.is_multiple_of(5)).then_some(hand) };
                Observation::Pose(person, PoseSample { taken_at: self.now, pose, tracked, worn, hands })
            }
            8 if value.is_multiple_of(2) => Observation::ClientGone(person),
            8 => Observation::ClientBack(person),
            9 if value.is_multiple_of(2) => Observation::OriginChanged(person),
            9 => {
                self.engine.request(self.now, Request::ConfirmOrigin(person));
                return;
            }
            10 => {
                let level = |part: u8| match part % 4 {
                    0 => InputLevel::Absent,
                    1 => InputLevel::Inactive,
                    2 => InputLevel::Active("fuzz".into()),
                    _ => InputLevel::Silent("fuzz".into()),
                };
                Observation::Inputs(Inputs { stop: level(value), intruder: level(value / 4) })
            }
            11 => {
                self.report.velocity = Planar::new(2.0 * share - 1.0, 0.0);
                return;
            }
            12 => {
                self.report.homing = match value % 4 {
                    0 => Homing::NotHomed,
                    1 => Homing::Running,
                    2 => Homing::Homed,
                    _ => Homing::Failed,
                };
                self.report.current_amps[0] = 7.0 * share;
                return;
            }
            13 if value.is_multiple_of(2) => Observation::DeadlineMissed,
            13 => Observation::DeadlineMet,
            14 => Observation::GameMaster(value.is_multiple_of(2)),
            _ => {
                // Time goes by; the machine answers meanwhile, or does not.
                self.answers = value.is_multiple_of(2);
                for _ in 0..value / 2 {
                    self.step();
                }
                return;
            }
        };
        self.engine.observe(self.now, observation);
    }

    fn ask(&mut self, kind: RequestKind) {
        let before = self.engine.mode();
        let answer = self.engine.request(self.now, Request::Machine(kind, None));
        let after = self.engine.mode();
        if kind == RequestKind::Stop {
            assert!(answer.outcome != Outcome::Refused && after == Mode::LatchedStop);
        }
        if is_stopped(before) && after != before && after != Mode::LatchedStop {
            assert!(kind == RequestKind::Reset && after == Mode::Disarmed, "{before:?} {kind:?} {after:?}");
        }
        self.armed |= kind == RequestKind::Arm && after == Mode::Following;
    }

    fn step(&mut self) {
        self.now += PERIOD;
        if self.answers {
            self.report.answered_at = self.now;
        }
        self.engine.observe(self.now, Observation::Machine(self.report));
        let before = self.engine.mode();
        let command = self.engine.step(self.now);
        let mode = self.engine.mode();
        assert!(!is_stopped(before) || is_stopped(mode), "{before:?} was left for {mode:?} by nobody");
        match command.action() {
            Action::Hold => {}
            Action::Release => assert!(is_stopped(mode) || mode == Mode::Disarmed, "{mode:?}"),
            Action::Home => assert_eq!(mode, Mode::Homing),
            Action::Track(setpoint) => {
                assert!(matches!(mode, Mode::Ready | Mode::Following | Mode::ProtectiveStop), "{mode:?}");
                let numbers =
                    [setpoint.position.x, setpoint.position.y, setpoint.velocity.x, setpoint.velocity.y];
                assert!(numbers.iter().all(|number| number.is_finite()), "{setpoint:?}");
                self.report.position = setpoint.position;
                self.report.velocity = setpoint.velocity;
            }
        }
        self.armed &= matches!(mode, Mode::Following | Mode::ProtectiveStop);
        assert!(mode != Mode::Following || self.armed, "it follows people, and nobody armed it");
        self.report.drive = if command.action() == Action::Release { Drive::Released } else { Drive::On };
        self.engine.drain_events();
    }
}

fn is_stopped(mode: Mode) -> bool {
    matches!(mode, Mode::LatchedStop | Mode::Faulted)
}

const PERIOD: Span = Span::from_millis(4);
const DEMO_SCENE: &[u8] = include_bytes!("../../deploy/scenes/demo.json");
