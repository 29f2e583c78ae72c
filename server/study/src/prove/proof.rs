//! One world with its people, operator and faults, step by step, all of it decided by a seed.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

use covr_engine::frames::Planar;
use covr_engine::mode::Mode;
use covr_engine::safety::vetted::Action;
use covr_engine::time::Span;

use super::adversary::{Adversary, Surroundings};
use super::faults::Nuisance;
use super::inputs::Sensors;
use super::operator::Operator;
use super::playmate::Playmate;
use super::world::World;
use crate::checker::Verdict;
use crate::random::Random;
use crate::replay::{Stepped, TrueHead};

/// What is run: a world by its seed, and what is left of it when a violation is shrunk.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// The seed decides everything.
    pub seed: u64,
    /// Control periods after the machine was brought up.
    pub steps: u64,
    /// v_h of the rule and of the fastest people, m/s; drawn when none.
    pub v_h_mps: Option<f64>,
    /// Who and what is left out.
    pub without: Vec<Part>,
}

/// A part of a case that can be left out, the rest being as it was.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// The person who came at this place in the order, from 0.
    Person(usize),
    /// What the operator does beyond getting the machine going again.
    Operator,
    /// Faults of the link to the machine and of the control thread.
    Faults,
    /// Scenarios with interactions, the hands on them and the contacts armed.
    Scenario,
    /// Digital inputs that become active or fall silent.
    Inputs,
}

/// What a case led to.
#[derive(Debug, Clone, PartialEq)]
pub struct Proof {
    /// The case.
    pub case: Case,
    /// The world in words.
    pub told: String,
    /// People who came and went.
    pub people: usize,
    /// Of the true motion.
    pub truth: Verdict,
    /// Of the commanded motion.
    pub commanded: Verdict,
    /// Ticks in which the column moved long after an input had become active.
    pub moved_while_input: u64,
    /// Steps in the mode `following`.
    pub following: u64,
    /// Steps in which the column moved in contact with somebody.
    pub in_contact: u64,
    /// The first step after which a violation was found.
    pub violated_at: Option<u64>,
    /// Every command, and every snapshot that was asked for, in one number.
    pub digest: u64,
}

impl Proof {
    /// Violations of both motions, and motion against an input.
    pub fn violations(&self) -> u64 {
        self.truth.violations() + self.commanded.violations() + self.moved_while_input
    }
}

/// Run a case; a snapshot goes into the digest every `snapshot_every` steps. In words what could not even begin.
pub fn run(case: &Case, snapshot_every: u64) -> Result<Proof, String> {
    let mut random = Random::seeded(case.seed);
    let is_left_out = |part| case.without.contains(&part);
    // Of a stream of its own: the rest of a world is the same without it.
    let mut playing = Some(Random::seeded(case.seed ^ PLAYING)).filter(|_| !is_left_out(Part::Scenario));
    let mut world = World::random(&mut random, playing.as_mut(), case.v_h_mps)
        .map_err(|problem| format!("seed {}: {problem}", case.seed))?;
    let told = std::mem::take(&mut world.told);
    let control = &mut world.control;
    if let Err(mode) = control.bring_up(Span::from_millis(120_000)) {
        return Err(format!("seed {}: the machine stuck in {}: {told}", case.seed, mode.name()));
    }
    let now = control.now();
    let people = 1 + random.below(3);
    // Everybody is drawn, so that the rest of the world is the same without one of them.
    let mut everybody: Vec<Adversary> = (0..people)
        .map(|i| (i, Adversary::new(&mut random, i as u32, world.arena, now)))
        .filter(|(i, _)| !is_left_out(Part::Person(*i)))
        .map(|(_, person)| person)
        .collect();
    let mut operator =
        Operator::new(random.fork(), std::mem::take(&mut world.scenes), now, !is_left_out(Part::Operator));
    let mut nuisance = if is_left_out(Part::Faults) { None } else { Some(Nuisance::new(random.fork(), now)) };
    let mut sensors = if is_left_out(Part::Inputs) { None } else { Some(Sensors::new(random.fork(), now)) };
    let mut playmate = playing.map(|random| Playmate::new(random, now));
    let mut in_contact = 0;
    let mut moved_while_input = 0;
    let mut digest = DefaultHasher::new();
    let mut following = 0;
    let mut violated_at = None;
    let mut column = (world.arena.centre(), Planar::ZERO);
    let mut heads: Vec<TrueHead> = Vec::new();
    for step in 0..case.steps {
        let now = control.now();
        let lure = playmate.as_mut().and_then(|playmate| playmate.step(control, &heads, column.0));
        heads.clear();
        let scene = Arc::clone(control.engine().scene());
        let around = Surroundings {
            now,
            period: control.engine().config().period,
            arena: world.arena,
            v_h_mps: world.v_h_mps,
            pose_hz: world.pose_hz,
            column: column.0,
            column_velocity: column.1,
            scene: scene.spec(),
            lure,
        };
        for person in &mut everybody {
            let doings = person.step(&around);
            doings.observations.into_iter().for_each(|observation| control.observe(observation));
            if let Some(sample) = doings.pose
                && let Some(truth) = doings.truth
            {
                control.send(truth.person, sample);
            }
            heads.extend(doings.truth);
        }
        operator.act(control, &heads);
        if let Some(sensors) = &mut sensors {
            sensors.step(control);
        }
        let runs = nuisance.as_mut().is_none_or(|nuisance| nuisance.step(control));
        let truth = if runs {
            let stepped = control.step(&heads);
            remember(&mut digest, &stepped);
            stepped.truth
        } else {
            control.miss_step(&heads)
        };
        column = (truth.position, truth.velocity);
        let must_rest = sensors.as_ref().is_some_and(|sensors| sensors.demand_rest(now));
        moved_while_input += u64::from(must_rest && truth.velocity.norm() > AT_REST_MPS);
        let moves = truth.velocity.norm() > AT_REST_MPS;
        in_contact += u64::from(moves && control.engine().contact().is_some());
        following += u64::from(control.engine().mode() == Mode::Following);
        if step % snapshot_every == 0 {
            format!("{:?}", control.engine().snapshot(now)).hash(&mut digest);
        }
        for event in control.drain_events() {
            format!("{event:?}").hash(&mut digest);
        }
        if violated_at.is_none()
            && control.true_verdict().violations()
                + control.commanded_verdict().violations()
                + moved_while_input
                > 0
        {
            violated_at = Some(step);
        }
    }
    Ok(Proof {
        case: case.clone(),
        told,
        people,
        truth: control.true_verdict().clone(),
        commanded: control.commanded_verdict().clone(),
        moved_while_input,
        following,
        in_contact,
        violated_at,
        digest: digest.finish(),
    })
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

/// Tells the stream of interactions from that of the world.
const PLAYING: u64 = 0x5eed_0000_9a7e;
/// Slower than this the column rests, m/s.
const AT_REST_MPS: f64 = 0.02;
