//! Each switch of the emulator while the column is moved: what the engine did, within which time and which way, on virtual time. The
//! table in `server/SAFETY.md` is made of this.
//!
//! `COVR_UPDATE_SAFETY=1 cargo nextest run -p covr-gantry the_committed_switches` rewrites it.

use std::fs;
use std::path::Path;

use covr_engine::engine::Request;
use covr_engine::frames::Point;
use covr_engine::intention::{IntentionParameters, RuleName};
use covr_engine::mode::{Mode, RequestKind};
use covr_engine::motion::MotionName;
use covr_engine::motion::jog::{Aim, JogOrder};
use covr_engine::observation::Observation;
use covr_engine::safety::separation::KeptFrom;
use covr_engine::scene::{ObjectSpec, Scene, SceneSpec, Shape};
use covr_engine::{Engine, EngineConfig};

use super::*;

/// An order to the emulator, and whether it must end in a stop.
type Switch = (&'static str, bool);

const SWITCHES: [Switch; 18] = [
    ("lose 0.002", false),
    ("flip 0.002", false),
    ("missing 0.02", false),
    ("gap 0.02 40", false),
    ("late 0.02 40", false),
    ("lose 1", true),
    ("missing 1", true),
    ("late 1 200", true),
    ("brown-out 100", true),
    ("press", true),
    ("stick pressed", true),
    ("slip x 1", true),
    ("jam x on", true),
    ("push x -400", true),
    ("runaway x positive", true),
    ("runaway x negative", true),
    ("supply 5", true),
    ("temperature 105", true),
];

/// The engine on boards, with nobody in the arena, moved by hand at half a metre a second.
struct Moved {
    engine: Engine,
    bench: Bench,
    is_open: bool,
}

/// What came of a switch.
struct Came {
    stop: Option<(String, f64)>,
    rests_after_secs: f64,
    way_m: f64,
}

impl Moved {
    fn at_half_a_metre_a_second() -> Self {
        let ball = ObjectSpec {
            id: "ball".into(),
            position: Point::new(3.5, 3.5, 1.0),
            yaw_rad: 0.0,
            shape: Shape::Sphere { radius_m: 0.1 },
            prop: None,
            prior: 1.0,
            enabled: true,
        };
        let config = EngineConfig {
            limits: Limits::PAPER,
            travel: travel(),
            period: CONTROL_PERIOD,
            intention_rule: RuleName::Bayes,
            intention: IntentionParameters::default(),
            motion: MotionName::Planner,
            standing: None,
            kept_from: KeptFrom::Everybody,
            v_h_mps: 1.6,
            needs_game_master: false,
            latched_because: None,
        };
        let scene = Arc::new(Scene::build(SceneSpec::open(travel(), vec![ball])).unwrap());
        let mut bench = Bench::new(USUAL, Floor::new(0.4, 0.3));
        bench.cycle(Action::Release).unwrap();
        let mut moved = Self { engine: Engine::new(config, scene), bench, is_open: true };
        moved.step();
        moved.engine.request(moved.bench.port.time(), Request::Machine(RequestKind::Home, None));
        while moved.engine.mode() != Mode::Ready {
            moved.step();
        }
        moved.run(1.2);
        moved.jog();
        while moved.bench.truth().1.x < 0.49 {
            moved.jog();
            moved.step();
        }
        moved
    }

    fn jog(&mut self) {
        let order = JogOrder { aim: Aim::Along(Planar::new(1.0, 0.0)), speed_mps: 0.5 };
        self.engine.request(self.bench.port.time(), Request::Jog(order));
    }

    /// One step of the engine and one cycle on the line. A line that is lost stays so: the link thread opens it anew, which
    /// takes longer than R8 waits.
    fn step(&mut self) {
        let now = self.bench.port.time();
        self.engine.observe(now, Observation::Machine(self.bench.session.report()));
        let command = self.engine.step(now);
        if self.is_open {
            let order = Order { vetted_at: command.at(), action: command.action() };
            self.is_open = self.bench.cycle_with(order).is_ok();
        } else {
            self.bench.port.wait(CONTROL_PERIOD);
            // Time passes for the boards too.
            self.bench.port.with(|world| world.emulator.poll(world.now));
        }
    }

    fn run(&mut self, secs: f64) {
        let until = self.bench.port.time() + Span::from_secs(secs);
        while self.bench.port.time() < until {
            self.step();
        }
    }

    /// Turn the switch, hold the button for two seconds more, and look.
    fn switch(mut self, order: &str) -> Came {
        self.engine.drain_events();
        self.bench.give(order);
        let (began, (from, _)) = (self.bench.port.time(), self.bench.truth());
        let (mut stop, mut moves_until) = (None, began);
        while self.bench.port.time() - began < Span::from_secs(2.0) {
            self.jog();
            self.step();
            let now = self.bench.port.time();
            if self.bench.truth().1.norm() > 0.02 {
                moves_until = now;
            }
            if stop.is_none() && matches!(self.engine.mode(), Mode::LatchedStop | Mode::Faulted) {
                let cause = self.engine.snapshot(now).stop.unwrap();
                let rule = cause.rule.name();
                stop = Some((format!("{rule}, `{}`", self.engine.mode().name()), (now - began).secs()));
            }
        }
        let rests_after_secs = (moves_until - began).secs();
        Came { stop, rests_after_secs, way_m: self.bench.truth().0.distance_m(from) }
    }
}

#[test]
fn the_committed_switches_are_the_generated_ones() {
    let mut table = String::from(
        "\n| order | what the server did | after | at rest after | way |\n|---|---|---|---|---|\n",
    );
    for (order, must_stop) in SWITCHES {
        let came = Moved::at_half_a_metre_a_second().switch(order);
        assert_eq!(came.stop.is_some(), must_stop, "{order}: {:?}", came.stop);
        let row = match &came.stop {
            None => format!("| `{order}` | went on | | | |\n"),
            Some((what, secs)) => format!(
                "| `{order}` | {what} | {:.0} ms | {:.0} ms | {:.2} m |\n",
                secs * 1e3,
                came.rests_after_secs * 1e3,
                came.way_m
            ),
        };
        table.push_str(&row);
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../SAFETY.md");
    let text = fs::read_to_string(&path).unwrap();
    let (before, rest) = text.split_once(BEGIN).unwrap();
    let (committed, after) = rest.split_once(END).unwrap();
    if std::env::var_os("COVR_UPDATE_SAFETY").is_some() {
        fs::write(&path, [before, BEGIN, &table, END, after].concat()).unwrap();
    } else {
        assert_eq!(committed, table, "run again with COVR_UPDATE_SAFETY=1 and commit");
    }
}

const BEGIN: &str = "<!-- generated: switches -->";
const END: &str = "<!-- end of generated: switches -->";
