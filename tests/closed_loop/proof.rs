//! Random worlds with adversarial people and operators, step by step, all of it decided by one seed.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

use covr_engine::engine::Request;
use covr_engine::frames::Planar;
use covr_engine::mode::{Mode, RequestKind};
use covr_engine::observation::{Observation, PersonId};
use covr_engine::safety::vetted::Action;
use covr_engine::time::{Span, Time};
use covr_study::checker::Verdict;
use covr_study::random::Random;
use covr_study::replay::{ClosedLoop, Stepped, TrueHead};

use crate::adversary::{Adversary, Surroundings};
use crate::world::World;

/// What a seed led to.
#[derive(Debug, Clone, PartialEq)]
pub struct Proof {
    /// The seed.
    pub seed: u64,
    /// The world in words.
    pub told: String,
    /// Of the true motion.
    pub truth: Verdict,
    /// Of the commanded motion.
    pub commanded: Verdict,
    /// Steps in the mode `following`.
    pub following: u64,
    /// Every command, and every snapshot that was asked for, in one number.
    pub digest: u64,
}

/// Run the world of `seed` for `steps`; a snapshot goes into the digest every `snapshot_every` steps.
pub fn run(seed: u64, steps: u64, snapshot_every: u64) -> Proof {
    let mut random = Random::seeded(seed);
    let mut world = World::random(&mut random);
    let told = std::mem::take(&mut world.told);
    let brought_up = world.control.bring_up(Span::from_millis(120_000));
    assert_eq!(brought_up, Ok(()), "seed {seed}: the machine could not be brought up: {told}");
    let now = world.control.now();
    let mut people: Vec<Adversary> =
        (0..1 + random.below(3)).map(|i| Adversary::new(&mut random, i as u32, world.arena, now)).collect();
    let mut operator = Operator { random: random.fork(), next_act: now, next_care: now };
    let mut digest = DefaultHasher::new();
    let mut following = 0;
    let mut column = (world.arena.centre(), Planar::ZERO);
    let mut heads: Vec<TrueHead> = Vec::new();
    for step in 0..steps {
        let now = world.control.now();
        heads.clear();
        let scene = Arc::clone(world.control.engine().scene());
        let around = Surroundings {
            now,
            period: world.control.engine().config().period,
            arena: world.arena,
            v_h_mps: world.v_h_mps,
            pose_hz: world.pose_hz,
            column: column.0,
            column_velocity: column.1,
            scene: scene.spec(),
        };
        for person in &mut people {
            let doings = person.step(&around);
            doings.observations.into_iter().for_each(|observation| world.control.observe(observation));
            if let Some(sample) = doings.pose
                && let Some(truth) = doings.truth
            {
                world.control.send(truth.person, sample);
            }
            heads.extend(doings.truth);
        }
        operator.act(now, &mut world, &heads);
        let stepped = world.control.step(&heads);
        column = (stepped.truth.position, stepped.truth.velocity);
        following += u64::from(world.control.engine().mode() == Mode::Following);
        remember(&mut digest, &stepped);
        if step % snapshot_every == 0 {
            format!("{:?}", world.control.engine().snapshot(now)).hash(&mut digest);
        }
        for event in world.control.drain_events() {
            format!("{event:?}").hash(&mut digest);
        }
    }
    let control: &ClosedLoop = &world.control;
    Proof {
        seed,
        told,
        truth: control.true_verdict().clone(),
        commanded: control.commanded_verdict().clone(),
        following,
        digest: digest.finish(),
    }
}

fn remember(digest: &mut DefaultHasher, stepped: &Stepped) {
    digest.write_i64(stepped.command.at().micros());
    match stepped.command.action() {
        Action::Release => digest.write_u8(0),
        Action::Hold => digest.write_u8(1),
        Action::Home => digest.write_u8(2),
        Action::Track(setpoint) => {
            digest.write_u8(3);
            let numbers = [
                setpoint.position.x,
                setpoint.position.y,
                setpoint.velocity.x,
                setpoint.velocity.y,
                setpoint.acceleration.x,
                setpoint.acceleration.y,
            ];
            numbers.into_iter().for_each(|number| digest.write_u64(number.to_bits()));
            digest.write_i64(setpoint.valid_for.micros());
        }
    }
}

/// Somebody at the dashboard who presses whatever there is, and always gets the machine going again.
struct Operator {
    random: Random,
    next_act: Time,
    next_care: Time,
}

impl Operator {
    fn act(&mut self, now: Time, world: &mut World, heads: &[TrueHead]) {
        if now >= self.next_care {
            self.next_care = now + Span::from_millis(250);
            self.care(world, heads);
        }
        if now >= self.next_act {
            self.next_act = now + Span::from_secs(self.random.between(0.1, 3.0));
            self.meddle(world, heads);
        }
    }

    /// Get it going again.
    fn care(&mut self, world: &mut World, heads: &[TrueHead]) {
        let control = &mut world.control;
        for head in heads {
            control.observe(Observation::ClientBack(head.person));
            control.request(Request::ConfirmOrigin(head.person));
        }
        match control.engine().mode() {
            Mode::LatchedStop | Mode::Faulted => {
                control.request(Request::Machine(RequestKind::Reset, Some("looked".into())));
            }
            Mode::Disarmed | Mode::Ready => {
                let armed = control.arm();
                if armed.is_err() {
                    control.request(Request::Machine(RequestKind::Home, None));
                }
            }
            Mode::Homing | Mode::Following | Mode::ProtectiveStop => {}
        }
    }

    fn meddle(&mut self, world: &mut World, heads: &[TrueHead]) {
        let anybody = heads.get(self.random.below(heads.len())).map_or(PersonId(0), |head| head.person);
        let chosen = self.random.below(world.scenes.len());
        let control = &mut world.control;
        match self.random.below(40) {
            0 => drop(control.request(Request::Machine(RequestKind::Stop, Some("a whim".into())))),
            1 => drop(control.request(Request::Machine(RequestKind::Disarm, None))),
            2..=4 => drop(control.request(Request::ActivateScene(Arc::clone(&world.scenes[chosen])))),
            5 => control.observe(Observation::OriginChanged(anybody)),
            6 => control.observe(Observation::ClientGone(anybody)),
            7 => drop(control.request(Request::Machine(RequestKind::Home, None))),
            8 => drop(control.request(Request::Machine(RequestKind::Reset, None))),
            _ => {
                let count = control.engine().scene().spec().objects.len();
                let priors = (0..count).map(|object| (object, self.random.unit())).collect();
                control.request(Request::SetPriors(priors));
            }
        }
    }
}
