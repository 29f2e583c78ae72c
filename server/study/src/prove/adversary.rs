//! People at their worst, yet people: never faster than v_h, but they turn in no time, run at the column, crawl,
//! loiter at objects, come from nowhere, leave, and lose their tracking.

use crate::random::Random;
use crate::replay::TrueHead;
use covr_engine::frames::{Floor, Planar, Point, Pose};
use covr_engine::machine::Travel;
use covr_engine::observation::{Hands, Observation, PersonId, PoseSample};
use covr_engine::scene::SceneSpec;
use covr_engine::time::{Span, Time};
use nalgebra::UnitQuaternion;

use super::playmate::Lure;
use super::world::somewhere;

/// One of them.
pub struct Adversary {
    random: Random,
    id: PersonId,
    head: Point<covr_engine::frames::Room>,
    standing_m: f64,
    height_m: f64,
    act: Act,
    act_ends: Time,
    gaze: Gaze,
    present: bool,
    presence_ends: Time,
    tracking: Tracking,
    tracking_ends: Time,
    next_pose: Time,
}

/// What a person's surroundings are at a step.
pub struct Surroundings<'a> {
    pub now: Time,
    pub period: Span,
    pub arena: Travel,
    pub v_h_mps: f64,
    pub pose_hz: f64,
    pub column: Floor,
    pub column_velocity: Planar,
    pub scene: &'a SceneSpec,
    /// Somebody goes there, whatever they would do else.
    pub lure: Option<Lure>,
}

/// What a step of a person brings.
#[derive(Default)]
pub struct Doings {
    /// What the engine is told at once.
    pub observations: Vec<Observation>,
    /// What the headset sends.
    pub pose: Option<PoseSample>,
    /// Where the head really is; none when away.
    pub truth: Option<TrueHead>,
}

#[derive(Debug, Clone, Copy)]
enum Act {
    Stand,
    Charge { speed: f64 },
    Intercept { speed: f64 },
    Straight { velocity: Planar },
    Zigzag { speed: f64 },
    Loiter { object: usize, away_m: f64, speed: f64 },
    Circle { speed: f64, left: bool },
    Flee { speed: f64 },
}

#[derive(Debug, Clone, Copy)]
enum Gaze {
    Object(usize),
    Column,
    Along(f64),
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Tracking {
    Good,
    /// The headset says that it does not know its place, and repeats where it was.
    Untracked(Point<covr_engine::frames::Room>),
    /// Nothing comes.
    Silent,
}

impl Adversary {
    /// Somebody who will come in within a second.
    pub fn new(random: &mut Random, id: u32, arena: Travel, from: Time) -> Self {
        let mut random = random.fork();
        let place = somewhere(&mut random, arena);
        let standing_m = random.between(1.2, 1.9);
        let enters = from + Span::from_secs(random.between(0.0, 1.0));
        Self {
            id: PersonId(id),
            head: Point::new(place.x, place.y, standing_m),
            standing_m,
            height_m: standing_m,
            act: Act::Stand,
            act_ends: from,
            gaze: Gaze::Column,
            present: false,
            presence_ends: enters,
            tracking: Tracking::Good,
            tracking_ends: from + Span::from_secs(random.between(2.0, 15.0)),
            next_pose: from,
            random,
        }
    }

    /// Live through one control period.
    pub fn step(&mut self, around: &Surroundings<'_>) -> Doings {
        let mut doings = Doings::default();
        if around.now >= self.presence_ends {
            self.come_or_go(around, &mut doings);
        }
        if !self.present {
            return doings;
        }
        if around.now >= self.act_ends {
            self.choose_act(around);
        }
        if around.now >= self.tracking_ends {
            self.change_tracking(around.now);
        }
        self.walk(around);
        let pose = Pose { position: self.head, orientation: self.looks(around) };
        doings.truth = Some(TrueHead { person: self.id, pose });
        if around.now >= self.next_pose {
            self.next_pose = around.now + Span::from_secs(1.0 / around.pose_hz);
            let sample = |position, tracked| PoseSample {
                taken_at: around.now,
                pose: Pose { position, ..pose },
                tracked,
                worn: true,
                hands: Hands::UNKNOWN,
            };
            doings.pose = match self.tracking {
                Tracking::Good => Some(sample(self.head, true)),
                Tracking::Untracked(last) => Some(sample(last, false)),
                Tracking::Silent => None,
            };
        }
        doings
    }

    fn come_or_go(&mut self, around: &Surroundings<'_>, doings: &mut Doings) {
        self.present = !self.present;
        let secs = if self.present {
            let place = somewhere(&mut self.random, around.arena);
            self.head = Point::new(place.x, place.y, self.standing_m);
            self.act_ends = around.now;
            self.tracking = Tracking::Good;
            self.next_pose = around.now;
            doings.observations.push(Observation::PersonEntered(self.id));
            self.random.between(5.0, 60.0)
        } else {
            doings.observations.push(Observation::PersonLeft(self.id));
            // The numbers of persons are never used again.
            self.id = PersonId(self.id.0 + PERSONS_APART);
            self.random.between(0.3, 4.0)
        };
        self.presence_ends = around.now + Span::from_secs(secs);
    }

    fn change_tracking(&mut self, now: Time) {
        let secs = if self.tracking == Tracking::Good {
            self.tracking =
                if self.random.chance(0.5) { Tracking::Untracked(self.head) } else { Tracking::Silent };
            self.random.between(0.05, 1.2)
        } else {
            self.tracking = Tracking::Good;
            self.random.between(3.0, 25.0)
        };
        self.tracking_ends = now + Span::from_secs(secs);
    }

    fn choose_act(&mut self, around: &Surroundings<'_>) {
        let objects = around.scene.objects.len();
        let speed =
            if self.random.chance(0.4) { around.v_h_mps } else { self.random.between(0.2, around.v_h_mps) };
        let object = self.random.below(objects);
        self.act = match self.random.below(12) {
            0 | 1 => Act::Stand,
            2 | 3 => Act::Charge { speed },
            4 => Act::Intercept { speed },
            5 => Act::Straight { velocity: Planar::new(speed, 0.0).turned(self.random.between(-3.2, 3.2)) },
            6 => Act::Zigzag { speed },
            7..=9 => Act::Loiter { object, away_m: self.random.between(0.3, 1.1), speed },
            10 => Act::Circle { speed, left: self.random.chance(0.5) },
            _ => Act::Flee { speed },
        };
        self.gaze = match self.random.below(5) {
            0 => Gaze::Column,
            1 => Gaze::Along(self.random.between(-3.2, 3.2)),
            2 => Gaze::Object(self.random.below(objects)),
            _ => Gaze::Object(object),
        };
        self.height_m =
            if self.random.chance(0.12) { self.random.between(0.3, 0.99) } else { self.standing_m };
        self.act_ends = around.now + Span::from_secs(self.random.between(0.2, 4.0));
    }

    fn walk(&mut self, around: &Surroundings<'_>) {
        let here = self.head.floor();
        let towards = |to: Floor| (to - here).unit().unwrap_or(Planar::ZERO);
        let lured = around.lure.filter(|lure| lure.person.is_none_or(|person| person == self.id));
        let velocity = match self.act {
            _ if let Some(lure) = lured => {
                let way = lure.place - here;
                way.capped(around.v_h_mps * around.period.secs()) * (1.0 / around.period.secs())
            }
            Act::Stand => Planar::ZERO,
            Act::Charge { speed } => towards(around.column) * speed,
            Act::Intercept { speed } => towards(around.column + around.column_velocity * 0.5) * speed,
            Act::Straight { velocity } => velocity,
            Act::Zigzag { speed } => {
                let side = if (around.now.micros() / 150_000) % 2 == 0 { 1.3 } else { -1.3 };
                towards(around.column).turned(side) * speed
            }
            Act::Loiter { object, away_m, speed } => {
                let place = around.scene.objects[object % around.scene.objects.len()].position.floor();
                let off = here.distance_m(place) - away_m;
                // About the chosen distance, in and out all the time.
                if off.abs() > 0.08 {
                    towards(place) * speed.copysign(off)
                } else {
                    towards(place).left() * speed
                }
            }
            Act::Circle { speed, left } => towards(around.column).left() * if left { speed } else { -speed },
            Act::Flee { speed } => -(towards(around.column) * speed),
        };
        let secs = around.period.secs();
        let next = around.arena.clamped(here + velocity * (secs * (1.0 - 1e-9)));
        let lift = (self.height_m - self.head.z()).clamp(-STOOPS_MPS * secs, STOOPS_MPS * secs);
        self.head = Point::new(next.x, next.y, self.head.z() + lift);
    }

    fn looks(&self, around: &Surroundings<'_>) -> UnitQuaternion<f64> {
        let at = |x: f64, y: f64, z: f64| {
            let (dx, dy, dz) = (x - self.head.x(), y - self.head.y(), z - self.head.z());
            UnitQuaternion::from_euler_angles(0.0, -dz.atan2(dx.hypot(dy)), dy.atan2(dx))
        };
        match self.gaze {
            Gaze::Object(object) => {
                let place = around.scene.objects[object % around.scene.objects.len()].position;
                at(place.x(), place.y(), place.z())
            }
            Gaze::Column => at(around.column.x, around.column.y, 1.2),
            Gaze::Along(yaw_rad) => UnitQuaternion::from_euler_angles(0.0, 0.0, yaw_rad),
        }
    }
}

/// Fewer people than this are ever there at once.
const PERSONS_APART: u32 = 10;
/// How fast a head goes down or up, m/s: a quick crouch.
const STOOPS_MPS: f64 = 1.5;
