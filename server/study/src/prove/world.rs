//! Random worlds: a machine, scenes for it, and a link, each decided by a seed.

use std::sync::Arc;

use super::playmate;
use crate::random::Random;
use crate::replay::{ClosedLoop, LinkProfile};
use covr_engine::EngineConfig;
use covr_engine::frames::{Floor, Planar, Point};
use covr_engine::intention::{IntentionParameters, RuleName};
use covr_engine::machine::{AxisLimits, Limits, Travel};
use covr_engine::motion::MotionName;
use covr_engine::safety::separation::KeptFrom;
use covr_engine::scene::{KeepOutShape, KeepOutSpec, ObjectSpec, PropSpec, Scene, SceneSpec, Shape};
use covr_engine::time::{Span, Time};
use covr_gantry::contract::Simulated;
use covr_gantry::ideal::IdealMachine;
use covr_gantry::sim::SimulatedMachine;
use covr_gantry::sim::parameters::{MachineParameters, ParameterProblem};

/// What a seed makes.
pub struct World {
    /// Home corner to the corner opposite: where people walk.
    pub arena: Travel,
    /// Scenes that an operator may activate; the first is in force.
    pub scenes: Vec<Arc<Scene>>,
    /// The loop, not yet homed.
    pub control: ClosedLoop,
    /// v_h of the rule, m/s: nobody walks faster, or it is counted apart.
    pub v_h_mps: f64,
    /// Poses a second.
    pub pose_hz: f64,
    /// In words, for failures.
    pub told: String,
}

impl World {
    /// The world of this stream of random numbers; v_h is drawn when none is given.
    ///
    /// With `playing` its scenes bring scenarios, drawn from that stream.
    pub fn random(
        random: &mut Random,
        mut playing: Option<&mut Random>,
        v_h_mps: Option<f64>,
    ) -> Result<Self, ParameterProblem> {
        let arena = Travel {
            min: Floor::new(0.0, 0.0),
            max: Floor::new(random.between(3.0, 6.0), random.between(3.0, 6.0)),
        };
        let travel = arena.shrunk(random.between(0.05, 0.3));
        let drawn_mps = if random.chance(0.8) { 1.6 } else { 2.0 };
        let v_h_mps = v_h_mps.unwrap_or(drawn_mps);
        let scenes: Vec<_> =
            (0..3).map(|_| Arc::new(scene(random, playing.as_deref_mut(), arena, travel))).collect();
        let ideal = random.chance(0.4);
        let machine: Box<dyn Simulated> = if ideal {
            let limits = Limits { x: axis(random), y: axis(random) };
            Box::new(IdealMachine::new(limits, travel, somewhere(random, travel)))
        } else {
            let start = travel.min + Planar::new(0.1, 0.1);
            let parameters = MachineParameters { start, ..MachineParameters::paper(travel) };
            Box::new(SimulatedMachine::new(parameters)?)
        };
        let delay = random.between(0.0, 0.05);
        let profile = LinkProfile {
            delay: Span::from_secs(delay),
            jitter: Span::from_secs(random.between(0.0, 0.08 - delay)),
            loss: random.between(0.0, 0.2),
        };
        let config = EngineConfig {
            limits: machine.limits(),
            travel,
            period: Span::from_millis(4),
            intention_rule: RuleName::ALL[random.below(RuleName::ALL.len())],
            intention: IntentionParameters::default(),
            motion: MotionName::ALL[random.below(MotionName::ALL.len())],
            standing: None,
            kept_from: KeptFrom::Everybody,
            v_h_mps,
            needs_game_master: false,
            latched_because: None,
        };
        let told = format!(
            "{}, {:?}, rule {:?}, v_h {v_h_mps} m/s, arena {:?}, link {profile:?}, {} objects, {} props, {} keep-outs",
            machine.name(),
            config.limits,
            config.intention_rule,
            arena.max,
            scenes[0].spec().objects.len(),
            scenes[0].spec().props.len(),
            scenes[0].spec().keep_outs.len(),
        );
        let pose_hz = random.between(75.0, 90.0);
        let control =
            ClosedLoop::new(config, Arc::clone(&scenes[0]), machine, profile, random.fork(), Time::ZERO);
        Ok(Self { arena, scenes, control, v_h_mps, pose_hz, told })
    }
}

/// Anywhere inside.
pub fn somewhere(random: &mut Random, inside: Travel) -> Floor {
    let x = random.between(inside.min.x, inside.max.x);
    Floor::new(x, random.between(inside.min.y, inside.max.y))
}

fn axis(random: &mut Random) -> AxisLimits {
    AxisLimits {
        speed_mps: random.between(0.5, 1.6),
        acceleration_mps2: random.between(0.6, 2.0),
        braking_mps2: random.between(1.5, 4.0),
        jerk_mps3: random.between(30.0, 120.0),
    }
}

fn scene(random: &mut Random, mut playing: Option<&mut Random>, arena: Travel, travel: Travel) -> Scene {
    loop {
        // A random scene may be impossible (props too wide, an object out of reach): draw again.
        let mut spec = spec(random, arena, travel);
        spec.scenario = playing.as_deref_mut().map(|playing| playmate::scenario(playing, &spec));
        if let Ok(scene) = Scene::build(spec) {
            return scene;
        }
    }
}

fn spec(random: &mut Random, arena: Travel, travel: Travel) -> SceneSpec {
    let props: Vec<_> = (0..random.below(4))
        .map(|i| PropSpec {
            id: format!("prop {i}"),
            offset: Planar::new(random.between(0.1, 0.6), 0.0).turned(random.between(-3.2, 3.2)),
            facing_rad: random.between(-3.1, 3.1),
            size_m: if random.chance(0.3) {
                Planar::ZERO
            } else {
                Planar::new(random.between(0.02, 0.3), random.between(0.02, 0.3))
            },
        })
        .collect();
    let objects = (0..1 + random.below(8))
        .map(|i| {
            let place = somewhere(random, travel.shrunk(0.05));
            let prop =
                if props.is_empty() || random.chance(0.3) { None } else { Some(random.below(props.len())) };
            let offset = prop.map_or(Planar::ZERO, |prop| props[prop].offset);
            let place = arena.clamped(place + offset);
            ObjectSpec {
                id: format!("object {i}"),
                position: Point::new(place.x, place.y, random.between(0.3, 1.9)),
                yaw_rad: random.between(-3.1, 3.1),
                shape: shape(random),
                prop,
                prior: random.between(0.2, 1.0),
                enabled: random.chance(0.85),
            }
        })
        .collect();
    let keep_outs = (0..random.below(4)).map(|i| {
        // Homing needs its corner: nobody furnishes it.
        let farther = Travel { min: arena.min + Planar::new(1.5, 1.5), max: arena.max };
        let among = if random.chance(0.5) { farther } else { arena };
        let centre = somewhere(random, among);
        let too_near = centre.distance_m(arena.min) < 2.0;
        let centre = if too_near { arena.max - Planar::new(0.5, 0.5) } else { centre };
        let size = random.between(0.1, 0.5);
        let shape = if random.chance(0.5) {
            KeepOutShape::Circle { centre, radius_m: size }
        } else {
            let turn = random.between(0.0, 3.0);
            let count = 3 + random.below(4);
            let corner = |k: usize| {
                Planar::new(size, 0.0).turned(turn + k as f64 * std::f64::consts::TAU / count as f64)
            };
            KeepOutShape::Polygon { corners: (0..count).map(|k| centre + corner(k)).collect() }
        };
        KeepOutSpec { id: format!("keep-out {i}"), shape }
    });
    let keep_outs = keep_outs.collect();
    let side = random.between(0.1, 0.3);
    SceneSpec {
        arena,
        column_size_m: Planar::new(side, random.between(0.1, 0.3)),
        props,
        objects,
        keep_outs,
        zones: Vec::new(),
        scenario: None,
    }
}

fn shape(random: &mut Random) -> Shape {
    match random.below(3) {
        0 => Shape::Sphere { radius_m: random.between(0.05, 0.4) },
        1 => Shape::Box { size_m: std::array::from_fn(|_| random.between(0.05, 0.6)) },
        _ => Shape::Cylinder { radius_m: random.between(0.05, 0.3), height_m: random.between(0.1, 1.5) },
    }
}
