//! A made-up visitor for machines without recordings: reads, searches, walks, reaches, dwells and returns, for ever.
//!
//! As in the recorded sessions everything begins in the middle of the room: there the visitor reads what to do and looks
//! for it, and there it returns. From half a second before it sets out to the arrival its horizontal speed has the percentiles of the recorded people
//! (p50 0.26, p95 0.87, p99 1.12, greatest 1.58 m/s). It walks through the column if that is in its way: a visitor
//! who cannot see the machine does too. The seed decides everything.

mod arms;

use std::f64::consts::{PI, TAU};

use covr_engine::frames::{Floor, Planar, Point, Pose, Room};
use covr_engine::machine::Travel;
use covr_engine::observation::Hands;
use covr_engine::scene::SceneSpec;
use covr_engine::time::{Span, Time};
use nalgebra::UnitQuaternion;

use self::arms::Arms;
use crate::random::Random;

/// What the visitor is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Phase {
    /// Stands and reads what to do next.
    Reads,
    /// Stands and looks about for the goal, and at it.
    Searches,
    /// Walks to the goal.
    Walks,
    /// The head has arrived; the hand goes to the object.
    Reaches,
    /// The hand is at the object.
    Dwells,
    /// Walks back to the middle of the room.
    Returns,
}

/// The visitor at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VisitorSample {
    /// When, from the start of the visit.
    pub at: Time,
    /// Where the head is.
    pub pose: Pose<Room>,
    /// Where the hands are.
    pub hands: Hands,
    /// What it does.
    pub phase: Phase,
    /// Which object it is after, by index in the scene; none while it returns and reads.
    pub goal: Option<usize>,
}

/// A possible goal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VisitorGoal {
    /// Index in the scene.
    pub object: usize,
    /// Its centre.
    pub position: Point<Room>,
}

/// An endless visit, sample by sample.
#[derive(Debug, Clone)]
pub struct Visitor {
    random: Random,
    arena: Travel,
    goals: Vec<VisitorGoal>,
    hz: f64,
    tick: u64,
    height_m: f64,
    phase: Phase,
    phase_ends: Time,
    goal: Option<VisitorGoal>,
    last_object: Option<usize>,
    walk: Walk,
    view: View,
    gaze: Gaze,
    gaze_until: Time,
    /// How long the next reach takes from the arrival of the head on, s.
    reach_secs: f64,
    arms: Arms,
}

/// From one standing place to the next: minimum jerk along a slight bow.
#[derive(Debug, Clone, Copy)]
struct Walk {
    from: Floor,
    to: Floor,
    bow_m: f64,
    starts: Time,
    secs: f64,
}

/// Where the view axis points now.
#[derive(Debug, Clone, Copy)]
struct View {
    yaw_rad: f64,
    pitch_rad: f64,
}

/// What the eyes are on.
#[derive(Debug, Clone, Copy)]
enum Gaze {
    At(Point<Room>),
    Along { yaw_rad: f64, pitch_rad: f64 },
}

impl Visitor {
    /// A visitor of the enabled objects of a scene, sampled at `hz`.
    pub fn of_scene(scene: &SceneSpec, hz: f64, seed: u64) -> Self {
        let enabled = scene.objects.iter().enumerate().filter(|(_, object)| object.enabled);
        let goals = enabled.map(|(object, spec)| VisitorGoal { object, position: spec.position }).collect();
        Self::new(scene.arena, goals, hz, seed)
    }

    /// A visitor of these goals, who starts in the middle of the arena. Without goals it stays about there.
    pub fn new(arena: Travel, goals: Vec<VisitorGoal>, hz: f64, seed: u64) -> Self {
        let mut random = Random::seeded(seed);
        let middle = arena.centre();
        let yaw_rad = random.between(-PI, PI);
        let mut visitor = Self {
            height_m: random.between(1.52, 1.78),
            random,
            arena,
            goals,
            hz,
            tick: 0,
            phase: Phase::Reads,
            phase_ends: Time::ZERO,
            goal: None,
            last_object: None,
            walk: Walk { from: middle, to: middle, bow_m: 0.0, starts: Time::ZERO, secs: 1.0 },
            view: View { yaw_rad, pitch_rad: 0.0 },
            gaze: Gaze::Along { yaw_rad, pitch_rad: 0.0 },
            gaze_until: Time::ZERO,
            reach_secs: 0.0,
            arms: Arms::new(seed ^ OF_ARMS, yaw_rad),
        };
        visitor.begin(Phase::Reads, Time::ZERO);
        visitor
    }

    /// The next sample. There always is one.
    pub fn sample(&mut self) -> VisitorSample {
        let at = Time::ZERO + Span::from_secs(self.tick as f64 / self.hz);
        self.tick += 1;
        while at >= self.phase_ends {
            let next = match self.phase {
                Phase::Reads => Phase::Searches,
                Phase::Searches => Phase::Walks,
                Phase::Walks => Phase::Reaches,
                Phase::Reaches => Phase::Dwells,
                Phase::Dwells => Phase::Returns,
                Phase::Returns => Phase::Reads,
            };
            self.begin(next, self.phase_ends);
        }
        let position = self.head_at(at);
        self.look(position, at);
        let orientation = UnitQuaternion::from_euler_angles(0.0, -self.view.pitch_rad, self.view.yaw_rad);
        let goal = self.goal.map(|goal| goal.object);
        let pose = Pose { position, orientation };
        let hands = self.arms.hands(&pose, at);
        VisitorSample { at, pose, hands, phase: self.phase, goal }
    }

    fn begin(&mut self, phase: Phase, at: Time) {
        let secs = match phase {
            Phase::Reads => {
                // Instructions hang in the air, at about the heading that the person had.
                let turn = self.random.between(-0.5, 0.5);
                self.gaze = Gaze::Along { yaw_rad: self.view.yaw_rad + turn, pitch_rad: -0.1 };
                self.random.between(1.0, 2.5)
            }
            Phase::Searches => {
                self.choose_goal();
                self.gaze_until = at;
                self.random.between(1.0, 3.0) + KNOWS_BEFORE_SECS
            }
            Phase::Walks => {
                let secs = self.set_out(at);
                self.reach_secs = self.random.between(0.2, 0.5);
                if let Some(goal) = self.goal {
                    let head_arrives = at + Span::from_secs(secs);
                    self.arms.reach_for(
                        goal.position,
                        head_arrives,
                        head_arrives + Span::from_secs(self.reach_secs),
                    );
                }
                secs
            }
            Phase::Reaches => self.reach_secs,
            Phase::Dwells => self.random.between(1.0, 3.0),
            Phase::Returns => {
                self.last_object = self.goal.map(|goal| goal.object);
                self.goal = None;
                self.arms.draw_back(at);
                self.set_out(at)
            }
        };
        self.phase = phase;
        self.phase_ends = at + Span::from_secs(secs);
    }

    /// Another object than the last, where there is another.
    fn choose_goal(&mut self) {
        let others = self.goals.iter().copied().filter(|goal| Some(goal.object) != self.last_object);
        let mut choices: Vec<VisitorGoal> = others.collect();
        if choices.is_empty() {
            choices.clone_from(&self.goals);
        }
        self.goal = choices.get(self.random.below(choices.len())).copied();
    }

    /// Plan the walk; how long it takes, s.
    fn set_out(&mut self, at: Time) -> f64 {
        let from = self.walk.to;
        let to = match self.goal {
            Some(goal) => self.standing_place(from, goal.position.floor()),
            None => {
                let middle = self.arena.centre();
                let off = Planar::new(self.random.between(0.0, HOME_RADIUS_M), 0.0);
                middle + off.turned(self.random.between(-PI, PI))
            }
        };
        let distance_m = from.distance_m(to);
        let bow_m = (0.06 * self.random.normal() * distance_m).clamp(-0.2, 0.2);
        // The peak of a minimum-jerk walk is 15/8 of its mean.
        let peak_mps = (PEAK_MEDIAN_MPS * (PEAK_SPREAD * self.random.normal()).exp())
            .clamp(PEAK_MPS[0], PEAK_MPS[1])
            .min(PEAK_PER_ROOT_M * distance_m.sqrt().max(0.1));
        let secs = (1.875 * distance_m / peak_mps).max(0.3);
        self.walk = Walk { from, to, bow_m, starts: at, secs };
        self.gaze = match self.goal {
            Some(goal) => Gaze::At(goal.position),
            None => Gaze::At(Point::new(to.x, to.y, self.height_m)),
        };
        secs
    }

    /// Where the head stops for an object: about 0.6 m before it on the way, or at another side if that is a wall.
    fn standing_place(&mut self, from: Floor, object: Floor) -> Floor {
        let away_m = STOPS_AT_M + 0.05 * self.random.normal().clamp(-2.0, 2.0);
        let towards_person = (from - object).unit().unwrap_or(Planar::new(1.0, 0.0));
        let inside = self.arena.shrunk(ARENA_EDGE_M);
        let turned = |i: i32| {
            let steps = f64::from((i + 1) / 2) * if i % 2 == 0 { 1.0 } else { -1.0 };
            object + towards_person.turned(steps * TAU / 16.0) * away_m
        };
        let places = (0..16).map(turned);
        places
            .clone()
            .find(|&place| inside.depth_m(place) >= 0.0)
            .unwrap_or_else(|| inside.clamped(turned(0)))
    }

    fn head_at(&self, at: Time) -> Point<Room> {
        let Walk { from, to, bow_m, starts, secs } = self.walk;
        let share = ((at - starts).secs() / secs).clamp(0.0, 1.0);
        let covered = share.powi(3) * (10.0 + share * (6.0 * share - 15.0));
        let along = to - from;
        let aside = along.unit().map_or(Planar::ZERO, Planar::left);
        // A bow that leaves and arrives without a jerk.
        let bow = 16.0 * (covered * (1.0 - covered)).powi(2);
        let floor = from + along * covered + aside * (bow_m * bow);
        // Nobody stands still: a slow sway, and a step's bob while walking.
        let t = at.secs();
        let sway = Planar::new(
            SWAY_M * ((TAU * 0.31 * t).sin() + 0.5 * (TAU * 0.73 * t + 1.0).sin()),
            SWAY_M * ((TAU * 0.27 * t + 2.0).sin() + 0.5 * (TAU * 0.61 * t).sin()),
        );
        let floor = floor + sway;
        let bob = 0.02 * (16.0 * covered * (1.0 - covered)).min(1.0) * (TAU * 1.8 * t).sin();
        Point::new(floor.x, floor.y, self.height_m + bob)
    }

    /// Turn the head towards what the eyes are on, as fast as heads turn.
    fn look(&mut self, head: Point<Room>, at: Time) {
        if self.phase == Phase::Searches && at >= self.gaze_until {
            let knows = (self.phase_ends - at).secs() <= KNOWS_BEFORE_SECS;
            let goal = self.goal.filter(|_| knows).map(|goal| Gaze::At(goal.position));
            self.gaze = goal.unwrap_or_else(|| self.next_glance());
            self.gaze_until = at + Span::from_secs(self.random.between(0.25, 0.6));
        }
        let (yaw_rad, pitch_rad) = match self.gaze {
            Gaze::Along { yaw_rad, pitch_rad } => (yaw_rad, pitch_rad),
            Gaze::At(point) => {
                let to = point.vector() - head.vector();
                (to.y.atan2(to.x), to.z.atan2(to.x.hypot(to.y)).max(LOWEST_PITCH_RAD))
            }
        };
        let dt = 1.0 / self.hz;
        let turn = |error: f64| {
            let rate = (HEAD_GAIN_PER_S * error).clamp(-HEAD_TURN_RADPS, HEAD_TURN_RADPS);
            if HEAD_GAIN_PER_S * dt < 1.0 { rate * dt } else { error }
        };
        let off = (yaw_rad - self.view.yaw_rad + PI).rem_euclid(TAU) - PI;
        self.view.yaw_rad = (self.view.yaw_rad + turn(off) + PI).rem_euclid(TAU) - PI;
        self.view.pitch_rad += turn(pitch_rad - self.view.pitch_rad);
    }

    /// Searching eyes are on another object, somewhere in the room, or on the goal, which they often find at once.
    fn next_glance(&mut self) -> Gaze {
        let chance = self.random.unit();
        match self.goal {
            Some(goal) if chance < 0.5 => Gaze::At(goal.position),
            _ if chance < 0.8 && !self.goals.is_empty() => {
                Gaze::At(self.goals[self.random.below(self.goals.len())].position)
            }
            _ => Gaze::Along {
                yaw_rad: self.view.yaw_rad + self.random.between(-1.5, 1.5),
                pitch_rad: self.random.between(-0.4, 0.2),
            },
        }
    }
}

impl Iterator for Visitor {
    type Item = VisitorSample;

    fn next(&mut self) -> Option<VisitorSample> {
        Some(self.sample())
    }
}

/// Arms have chance of their own.
const OF_ARMS: u64 = 0x4152_4d53;
/// Whoever has found the goal keeps it in view for so long before setting out, s (jov2023: 2 s from the end of the
/// preview to the response).
const KNOWS_BEFORE_SECS: f64 = 2.0;
/// How far from an object's centre the head stops, m (jov2023: median 0.6 m at the reach).
const STOPS_AT_M: f64 = 0.6;
/// How far from the middle of the room the visitor reads, m (jov2023: trials start within 0.3 m of it).
const HOME_RADIUS_M: f64 = 0.3;
/// How near to the arena's edge a head comes, m.
const ARENA_EDGE_M: f64 = 0.15;
/// Median of the fastest moment of a walk, m/s.
const PEAK_MEDIAN_MPS: f64 = 0.8;
/// Deviation of its logarithm between walks.
const PEAK_SPREAD: f64 = 0.24;
/// Slowest and fastest peak, m/s.
const PEAK_MPS: [f64; 2] = [0.4, 1.55];
/// A short walk has a lower peak: m/s for the root of a metre.
const PEAK_PER_ROOT_M: f64 = 1.3;
/// Amplitude of the slower sway of a standing head, m.
const SWAY_M: f64 = 0.006;
/// How fast a head turns at most, rad/s.
const HEAD_TURN_RADPS: f64 = 2.5;
/// How eagerly it turns, 1/s.
const HEAD_GAIN_PER_S: f64 = 6.0;
/// Nobody looks further down at a thing beneath the chin, rad.
const LOWEST_PITCH_RAD: f64 = -1.2;

#[cfg(test)]
mod tests;
