//! A following engine with as many objects and walking people as wanted: what its speed is measured with.
//!
//! The inputs of a period and the engine's step are two calls, so that whoever holds a clock can time the step alone.
//! The seed and the load decide everything; nothing here reads a clock.

use std::f64::consts::{PI, TAU};
use std::iter::Peekable;
use std::sync::Arc;

use covr_engine::engine::{Engine, EngineConfig, Outcome, Request};
use covr_engine::frames::{Floor, Point};
use covr_engine::intention::{IntentionParameters, RuleName};
use covr_engine::machine::{Limits, Travel};
use covr_engine::mode::{Mode, RequestKind};
use covr_engine::motion::MotionName;
use covr_engine::observation::{Observation, PersonId, PoseSample};
use covr_engine::safety::separation::KeptFrom;
use covr_engine::safety::vetted::Vetted;
use covr_engine::scene::{ObjectSpec, Scene, SceneProblem, SceneSpec, Shape};
use covr_engine::time::{Span, Time};
use covr_gantry::contract::Gantry;
use covr_gantry::ideal::IdealMachine;

use crate::random::Random;
use crate::visitor::Visitor;

/// How much there is to decide about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Load {
    /// Visitors who read, search, walk and reach, each with a headset of 90 poses a second.
    pub persons: u32,
    /// Objects in all.
    pub objects: u32,
    /// How many of the objects are closed triangle meshes; the others are spheres, boxes and cylinders in turn.
    pub meshes: u32,
    /// Triangles of each mesh, at least; exact for twice a square.
    pub triangles: u32,
    /// Decides places and walks.
    pub seed: u64,
    /// What decides, and how the column is moved.
    pub deciding: Deciding,
}

/// What decides about the column, from the belief to the way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Deciding {
    /// The paper's best rule, the mean of the places, the proxy on a spring.
    Papers,
    /// The server's default: the filter, the standing place of least loss, the planner.
    Ours,
}

/// The engine with its load, a machine that does what it is told, and people.
pub struct Workload {
    engine: Engine,
    machine: IdealMachine,
    headsets: Vec<Headset>,
    started: Time,
    now: Time,
    command: Vetted,
}

/// Why there is no such workload.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoWorkload {
    /// The load makes no scene.
    #[error("the load makes no scene: {}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
    Scene(Vec<SceneProblem>),
    /// The engine could not be armed.
    #[error("the engine is in mode {}, expected {}", .0.name(), Mode::Following.name())]
    NotFollowing(Mode),
}

struct Headset {
    person: PersonId,
    poses: Peekable<Visitor>,
    /// Poses of different headsets are not taken at the same time.
    offset: Span,
}

impl Load {
    /// One person and ten objects: a usual scene.
    pub const USUAL: Self =
        Self { persons: 1, objects: 10, meshes: 0, triangles: 0, seed: 1, deciding: Deciding::Papers };
    /// Five persons and two hundred objects, twenty of them meshes of 5,000 triangles: the greatest that is promised.
    pub const GREATEST: Self =
        Self { persons: 5, objects: 200, meshes: 20, triangles: 5_000, seed: 1, deciding: Deciding::Papers };

    /// The scene of this load.
    pub fn scene(&self) -> SceneSpec {
        let mut random = Random::seeded(self.seed);
        let objects = (0..self.objects).map(|i| ObjectSpec {
            id: format!("object {}", i + 1),
            position: Point::new(
                random.between(0.3, SIDE_M - 0.3),
                random.between(0.3, SIDE_M - 0.3),
                random.between(0.7, 1.7),
            ),
            yaw_rad: random.between(-PI, PI),
            shape: if is_mesh(i, self) { boulder(self.triangles, &mut random) } else { plain(i) },
            prop: None,
            prior: random.between(0.2, 1.0),
            enabled: true,
        });
        SceneSpec::open(ROOM, objects.collect())
    }
}

impl Workload {
    /// Homed, armed and following, everybody inside.
    pub fn following(load: &Load) -> Result<Self, NoWorkload> {
        let spec = load.scene();
        let headsets = (0..load.persons).map(|k| Headset {
            person: PersonId(k + 1),
            poses: Visitor::of_scene(&spec, POSES_HZ, load.seed.wrapping_add(u64::from(k) + 1)).peekable(),
            offset: Span::from_secs(f64::from(k) / f64::from(load.persons) / POSES_HZ),
        });
        let headsets = headsets.collect();
        let scene = Scene::build(spec).map_err(NoWorkload::Scene)?;
        let (intention_rule, motion) = match load.deciding {
            Deciding::Papers => (RuleName::PaperBest, MotionName::Proxy),
            Deciding::Ours => (RuleName::Bayes, MotionName::Planner),
        };
        let config = EngineConfig {
            limits: Limits::PAPER,
            travel: ROOM,
            period: PERIOD,
            intention_rule,
            intention: IntentionParameters::default(),
            motion,
            standing: None,
            kept_from: KeptFrom::Everybody,
            v_h_mps: 1.6,
            needs_game_master: false,
            latched_because: None,
        };
        let mut workload = Self {
            engine: Engine::new(config, Arc::new(scene)),
            machine: IdealMachine::new(Limits::PAPER, ROOM, STARTS),
            headsets,
            started: Time::ZERO,
            now: Time::ZERO,
            command: Vetted::release(Time::ZERO),
        };
        workload.bring_up()?;
        Ok(workload)
    }

    /// The next period's inputs: what the machine did with the last command, and the poses that came since.
    pub fn observe(&mut self) {
        self.now += PERIOD;
        // The ideal machine takes whatever a homed engine says; one that is not taken shows in its report.
        let _ = self.machine.write(self.now, &self.command);
        let report = self.machine.read(self.now).report;
        self.engine.observe(self.now, Observation::Machine(report));
        self.engine.observe(self.now, Observation::DeadlineMet);
        for headset in &mut self.headsets {
            let begins = self.started + headset.offset;
            let taken_at = |at: Time| begins + (at - Time::ZERO);
            let due = |at: Time| taken_at(at) + UNDERWAY <= self.now;
            while let Some(sample) = headset.poses.next_if(|sample| due(sample.at)) {
                let (taken_at, pose) = (taken_at(sample.at), sample.pose);
                let sample = PoseSample { taken_at, pose, tracked: true, worn: true, hands: sample.hands };
                self.engine.observe(self.now, Observation::Pose(headset.person, sample));
            }
        }
    }

    /// The engine's step of this period.
    pub fn step(&mut self) -> Vetted {
        self.command = self.engine.step(self.now);
        self.command
    }

    /// Inputs and step, this many periods, with the events thrown away.
    pub fn run(&mut self, periods: u32) {
        for _ in 0..periods {
            self.observe();
            self.step();
            self.engine.drain_events();
        }
    }

    /// The engine, to look at.
    pub fn engine(&self) -> &Engine {
        &self.engine
    }

    /// The engine's events since the last call are thrown away.
    pub fn forget_events(&mut self) {
        self.engine.drain_events();
    }

    /// When the last period began.
    pub fn now(&self) -> Time {
        self.now
    }

    fn bring_up(&mut self) -> Result<(), NoWorkload> {
        let headsets = std::mem::take(&mut self.headsets);
        self.ask(RequestKind::Home)?;
        let until = self.now + LONGEST_BRING_UP;
        while self.engine.mode() != Mode::Ready && self.now < until {
            self.run(1);
        }
        self.ask(RequestKind::Arm)?;
        self.run(1);
        for headset in &headsets {
            self.engine.observe(self.now, Observation::PersonEntered(headset.person));
        }
        self.headsets = headsets;
        self.started = self.now;
        while self.now < self.started + WARM_UP {
            self.run(1);
        }
        match self.engine.mode() {
            Mode::Following => Ok(()),
            mode => Err(NoWorkload::NotFollowing(mode)),
        }
    }

    fn ask(&mut self, kind: RequestKind) -> Result<(), NoWorkload> {
        match self.engine.request(self.now, Request::Machine(kind, None)).outcome {
            Outcome::Refused => Err(NoWorkload::NotFollowing(self.engine.mode())),
            Outcome::Accepted | Outcome::AlreadySo => Ok(()),
        }
    }
}

/// Meshes are spread over the scene's order.
fn is_mesh(i: u32, load: &Load) -> bool {
    let meshes_before = |i: u32| u64::from(i) * u64::from(load.meshes) / u64::from(load.objects.max(1));
    meshes_before(i + 1) > meshes_before(i)
}

fn plain(i: u32) -> Shape {
    match i % 3 {
        0 => Shape::Sphere { radius_m: 0.1 },
        1 => Shape::Box { size_m: [0.3, 0.2, 0.25] },
        _ => Shape::Cylinder { radius_m: 0.08, height_m: 0.4 },
    }
}

/// A closed mesh with bumps and dents, about 0.3 m across, wound outwards.
fn boulder(triangles: u32, random: &mut Random) -> Shape {
    let slices = (f64::from(triangles) / 2.0).sqrt().ceil().max(3.0) as u32;
    let rings = slices + 1;
    let (bumps, dents) = (random.between(0.0, TAU), random.between(0.0, TAU));
    let mut vertices_m = vec![[0.0, 0.0, 0.15]];
    for ring in 1..rings {
        let polar = PI * f64::from(ring) / f64::from(rings);
        for slice in 0..slices {
            let around = TAU * f64::from(slice) / f64::from(slices);
            let bump = (5.0 * around + bumps).sin() * (4.0 * polar + dents).sin() * polar.sin();
            let radius_m = 0.15 * (1.0 + 0.2 * bump);
            let aside = radius_m * polar.sin();
            vertices_m.push([aside * around.cos(), aside * around.sin(), radius_m * polar.cos()]);
        }
    }
    vertices_m.push([0.0, 0.0, -0.15]);
    let last = vertices_m.len() as u32 - 1;
    let at = |ring: u32, slice: u32| 1 + (ring - 1) * slices + slice % slices;
    let mut corners = Vec::new();
    for slice in 0..slices {
        corners.push([0, at(1, slice), at(1, slice + 1)]);
        for ring in 1..rings - 1 {
            corners.push([at(ring, slice), at(ring + 1, slice), at(ring + 1, slice + 1)]);
            corners.push([at(ring, slice), at(ring + 1, slice + 1), at(ring, slice + 1)]);
        }
        corners.push([last, at(rings - 1, slice + 1), at(rings - 1, slice)]);
    }
    Shape::TriangleMesh { vertices_m, triangles: corners }
}

/// Side of the room and of the machine's travel, m: five people walk in it and the column still gets through.
const SIDE_M: f64 = 6.0;
const ROOM: Travel = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(SIDE_M, SIDE_M) };
/// People begin in the middle of the room.
const STARTS: Floor = Floor::new(0.5, 0.5);
const PERIOD: Span = Span::from_millis(4);
const POSES_HZ: f64 = 90.0;
/// From the headset to the engine.
const UNDERWAY: Span = Span::from_millis(15);
/// The ideal machine is homed at once; the engine waits for its word.
const LONGEST_BRING_UP: Span = Span::from_millis(5_000);
/// Until every headset has sent poses.
const WARM_UP: Span = Span::from_millis(500);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_greatest_load_is_as_promised() {
        let scene = Load::GREATEST.scene();
        assert_eq!(scene.objects.len(), 200);
        let meshes = scene.objects.iter().filter_map(|object| match &object.shape {
            Shape::TriangleMesh { triangles, .. } => Some(triangles.len()),
            _ => None,
        });
        assert_eq!(meshes.collect::<Vec<_>>(), [5_000; 20]);
    }

    #[test]
    fn a_boulder_is_closed_and_knows_its_inside() {
        let load =
            Load { persons: 0, objects: 1, meshes: 1, triangles: 200, seed: 3, deciding: Deciding::Papers };
        let spec = load.scene();
        let centre = spec.objects[0].position;
        let scene = Scene::build(spec).unwrap();
        assert_eq!(scene.objects()[0].distance_m(&centre), 0.0);
        let above = Point::new(centre.x(), centre.y(), centre.z() + 1.15);
        assert!((scene.objects()[0].distance_m(&above) - 1.0).abs() < 0.01);
    }

    #[test]
    fn it_follows_people_who_walk_and_is_the_same_each_time() {
        for deciding in [Deciding::Papers, Deciding::Ours] {
            follows_people(&Load { persons: 3, objects: 12, meshes: 2, triangles: 128, seed: 5, deciding });
        }
    }

    fn follows_people(load: &Load) {
        let ended = || {
            let mut workload = Workload::following(load).unwrap();
            let from = workload.engine().snapshot(workload.now());
            workload.run(5_000);
            assert_eq!(workload.engine().mode(), Mode::Following);
            (from, workload.engine().snapshot(workload.now()))
        };
        let (from, to) = ended();
        for (before, after) in from.persons.iter().zip(&to.persons) {
            assert!(before.pose != after.pose && after.tracked && after.pose_age_secs < 0.03, "{after:?}");
        }
        assert_ne!(from.column.position, to.column.position);
        assert_eq!(ended(), (from, to));
    }

    #[test]
    fn a_load_without_objects_is_refused() {
        let load = Load { objects: 0, ..Load::USUAL };
        assert!(matches!(Workload::following(&load), Err(NoWorkload::Scene(_))));
    }
}
