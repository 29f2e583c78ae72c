//! A switch of an emulator while the column is moved by hand: what the engine did, within which time and which way.

use std::fs;
use std::path::Path;
use std::sync::Arc;

use covr_engine::engine::Request;
use covr_engine::frames::{Planar, Point};
use covr_engine::intention::{IntentionParameters, RuleName};
use covr_engine::machine::{Limits, MachineReport};
use covr_engine::mode::{Mode, RequestKind};
use covr_engine::motion::MotionName;
use covr_engine::motion::jog::{Aim, JogOrder};
use covr_engine::observation::Observation;
use covr_engine::safety::separation::KeptFrom;
use covr_engine::safety::vetted::{Action, Vetted};
use covr_engine::scene::{ObjectSpec, Scene, SceneSpec, Shape};
use covr_engine::time::{Span, Time};
use covr_engine::{Engine, EngineConfig};

use super::{Bench, CONTROL_PERIOD, travel};
use crate::emulation::Emulated;
use crate::linked::axes::Order;
use crate::linked::link::{LONGEST_SILENCE, Loss, Refusal as _, Session};

/// An order to the emulator, and whether it must end in a stop.
pub type Switch = (&'static str, bool);

/// The engine on a controller, with nobody in the arena, moved by hand at half a metre a second.
pub struct Moved<E, S> {
    engine: Engine,
    bench: Bench<E, S>,
    good_at: Time,
    is_open: bool,
    holds_button: bool,
    /// What it was and when, once it stops.
    stop: Option<(String, Time)>,
}

/// What came of a switch.
pub struct Came {
    pub stop: Option<(String, f64)>,
    pub rests_after_secs: f64,
    pub way_m: f64,
}

impl<E: Emulated, S: Session> Moved<E, S> {
    pub fn at_half_a_metre_a_second(mut bench: Bench<E, S>) -> Self {
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
        bench.cycle(Action::Release).unwrap();
        let good_at = bench.port.time();
        let engine = Engine::new(config, scene);
        let mut moved = Self { engine, bench, good_at, is_open: true, holds_button: false, stop: None };
        moved.step();
        moved.engine.request(moved.bench.port.time(), Request::Machine(RequestKind::Home, None));
        while moved.engine.mode() != Mode::Ready {
            moved.step();
        }
        moved.run(1.2);
        moved.holds_button = true;
        while moved.bench.truth().1.x < 0.49 {
            moved.step();
        }
        moved
    }

    /// A cycle on the line, and the engine's steps meanwhile: it waits for no cycle. A line that is lost for as long as the link thread waits
    /// stays so: the thread opens it anew, which takes longer than R8 waits.
    fn step(&mut self) {
        let begun = self.bench.port.time();
        let seen = self.bench.session.report();
        let command = self.think(begun, seen);
        if self.is_open {
            let order = Order { vetted_at: command.at(), action: command.action() };
            let outcome = self.bench.cycle_with(order);
            let now = self.bench.port.time();
            self.is_open = match outcome.map_err(|refused| refused.loss()) {
                Ok(_) => {
                    self.good_at = now;
                    true
                }
                Err(Some(Loss::Answer)) => (now - self.good_at).secs() < LONGEST_SILENCE.as_secs_f64(),
                Err(_) => false,
            };
        } else {
            self.bench.port.wait(CONTROL_PERIOD);
            // Time passes for the controller too.
            self.bench.port.with(|world| world.emulator.poll(world.now));
        }
        let mut next = begun + CONTROL_PERIOD;
        while next + CONTROL_PERIOD <= self.bench.port.time() {
            self.think(next, seen);
            next += CONTROL_PERIOD;
        }
    }

    fn think(&mut self, now: Time, seen: MachineReport) -> Vetted {
        if self.holds_button {
            let order = JogOrder { aim: Aim::Along(Planar::new(1.0, 0.0)), speed_mps: 0.5 };
            self.engine.request(now, Request::Jog(order));
        }
        self.engine.observe(now, Observation::Machine(seen));
        let command = self.engine.step(now);
        if self.stop.is_none() && matches!(self.engine.mode(), Mode::LatchedStop | Mode::Faulted) {
            let rule = self.engine.snapshot(now).stop.unwrap().rule.name();
            self.stop = Some((format!("{rule}, `{}`", self.engine.mode().name()), now));
        }
        command
    }

    fn run(&mut self, secs: f64) {
        let until = self.bench.port.time() + Span::from_secs(secs);
        while self.bench.port.time() < until {
            self.step();
        }
    }

    /// Turn the switch, hold the button for two seconds more, and look.
    pub fn switch(mut self, order: &str) -> Came {
        self.engine.drain_events();
        self.bench.give(order);
        let (began, (from, _)) = (self.bench.port.time(), self.bench.truth());
        let mut moves_until = began;
        while self.bench.port.time() - began < Span::from_secs(2.0) {
            self.step();
            if self.bench.truth().1.norm() > 0.02 {
                moves_until = self.bench.port.time();
            }
        }
        let way_m = self.bench.truth().0.distance_m(from);
        let stop = self.stop.map(|(what, at)| (what, (at - began).secs()));
        Came { stop, rests_after_secs: (moves_until - began).secs(), way_m }
    }
}

/// A table of what came of each switch, which is the one in `server/SAFETY.md` under this name; with `COVR_UPDATE_SAFETY` it is written there.
pub fn committed<E: Emulated, S: Session>(name: &str, switches: &[Switch], bench: impl Fn() -> Bench<E, S>) {
    let mut table = String::from(
        "\n| order | what the server did | after | at rest after | way |\n|---|---|---|---|---|\n",
    );
    for (order, must_stop) in switches {
        let came = Moved::at_half_a_metre_a_second(bench()).switch(order);
        assert_eq!(came.stop.is_some(), *must_stop, "{order}: {:?}", came.stop);
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
    let begin = format!("<!-- generated: {name} -->");
    let end = format!("<!-- end of generated: {name} -->");
    let (before, rest) = text.split_once(&begin).unwrap();
    let (committed, after) = rest.split_once(&end).unwrap();
    if std::env::var_os("COVR_UPDATE_SAFETY").is_some() {
        fs::write(&path, [before, &begin, &table, &end, after].concat()).unwrap();
    } else {
        assert_eq!(committed, table, "run again with COVR_UPDATE_SAFETY=1 and commit");
    }
}
