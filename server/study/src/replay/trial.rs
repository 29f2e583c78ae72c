//! One recorded reach against engine and machine: was the column in place when the hand arrived?

use std::sync::Arc;

use covr_engine::engine::{EngineConfig, Foretold, Request};
use covr_engine::frames::{Floor, Pose, Room};
use covr_engine::intention::{IntentionParameters, RuleName};
use covr_engine::machine::Travel;
use covr_engine::mode::Mode;
use covr_engine::motion::MotionName;
use covr_engine::observation::{Observation, PersonId, PoseSample};
use covr_engine::safety::separation::KeptFrom;
use covr_engine::scene::{ObjectSpec, Scene, SceneProblem, SceneSpec, Shape};
use covr_engine::time::{Span, Time};
use covr_gantry::contract::Simulated;

use super::belief::{BeliefTold, BeliefWatch};
use super::foretold::{FORETOLD_BEFORE_REACH_SECS, ForetoldWatch};
use super::walk::Walk;
use super::watch::ReachWatch;
use super::{ClosedLoop, LinkProfile, Stepped, TrueHead};
use crate::checker::Verdict;
use crate::random::Random;
use crate::trace::Recording;

/// A recorded reach and what it is replayed with.
#[derive(Debug, Clone, Copy)]
pub struct ReachTrial<'a> {
    /// The person; a recording with a goal.
    pub walk: &'a Walk<'a>,
    /// The targets shown to the engine, as indices into the recording's; the goal is among them.
    pub targets: &'a [usize],
    /// The scenario prior of each of them; none: 1 for all.
    pub priors: Option<&'a [f64]>,
    /// How the engine decides.
    pub conduct: Conduct<'a>,
    /// From when the engine is told the goal, by the recording's clock; none: never.
    pub told_from: Option<Time>,
    /// How poses travel.
    pub link: LinkProfile,
    /// Decides what the link does.
    pub seed: u64,
}

/// How the engine decides in a replay.
#[derive(Debug, Clone, Copy)]
pub struct Conduct<'a> {
    /// The intention rule.
    pub rule: RuleName,
    /// Its numbers.
    pub intention: &'a IntentionParameters,
    /// How the column is moved.
    pub motion: MotionName,
    /// Whom the separation rule keeps the column from.
    pub kept_from: KeptFrom,
    /// v_h of that rule, m/s.
    pub v_h_mps: f64,
}

/// One moment of a replay, for those who draw it.
#[derive(Clone, Copy)]
pub struct Glimpse<'a> {
    /// When, by the recording's clock.
    pub at: Time,
    /// The head as it really was.
    pub head: Pose<Room>,
    /// What the step did.
    pub stepped: Stepped,
    /// The loop after it.
    pub control: &'a ClosedLoop,
}

/// What came of it.
#[derive(Debug, Clone, PartialEq)]
pub struct TrialOutcome {
    /// Within 10 cm of the goal's place at the reach, and slower than 0.05 m/s over the last 0.2 s.
    pub success: bool,
    /// Within 10 cm, whatever its speed.
    pub within_10cm: bool,
    /// From the column's centre to the goal's place at the reach, m.
    pub distance_at_reach_m: f64,
    /// How long it had been in place then, s; 0 when it is not.
    pub in_place_before_reach_secs: f64,
    /// How often the machine stopped, protectively or for good.
    pub stops: u32,
    /// Way of the column, m.
    pub column_travel_m: f64,
    /// Greatest commanded speed, acceleration and jerk of an axis: m/s, m/s2, m/s3.
    pub peaks: [f64; 3],
    /// Mean distance between the column and the proxy, m.
    pub proxy_distance_m: f64,
    /// What the rule believed.
    pub belief: BeliefTold,
    /// What was foretold of the goal, [`FORETOLD_BEFORE_REACH_SECS`] before the reach; none before the beginning.
    pub foretold: [Option<Foretold>; FORETOLD_BEFORE_REACH_SECS.len()],
    /// What would have come of it had the client shifted the goal by the offset that was offered then; none before the
    /// beginning.
    pub with_offset: [Option<WithOffset>; FORETOLD_BEFORE_REACH_SECS.len()],
    /// Virtual time, s.
    pub simulated_secs: f64,
    /// What the checker says of the true motion.
    pub true_verdict: Verdict,
    /// And of the commanded one.
    pub commanded_verdict: Verdict,
}

/// What would have come of a reach with the goal shifted by the offset that was offered, where one was.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WithOffset {
    /// One was.
    pub offered: bool,
    /// The column was in place for the shifted goal, at rest.
    pub success: bool,
    /// Distance of the column's centre from the shifted goal's place, m.
    pub distance_at_reach_m: f64,
}

impl TrialOutcome {
    /// A column that stays so far from the goal's place for so long.
    pub(crate) fn nowhere(distance_at_reach_m: f64, simulated_secs: f64) -> Self {
        Self {
            success: false,
            within_10cm: false,
            distance_at_reach_m,
            in_place_before_reach_secs: 0.0,
            stops: 0,
            column_travel_m: 0.0,
            peaks: [0.0; 3],
            proxy_distance_m: 0.0,
            belief: BeliefTold::default(),
            foretold: Default::default(),
            with_offset: Default::default(),
            simulated_secs,
            true_verdict: Verdict::default(),
            commanded_verdict: Verdict::default(),
        }
    }
}

/// Why a recording cannot be replayed as a reach.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TrialProblem {
    /// It names no goal.
    #[error("trial {0}: found no goal, expected one")]
    NoGoal(String),
    /// It names no reach.
    #[error("trial {0}: found no reach among the events, expected one")]
    NoReach(String),
    /// There are no frames from which to start before the reach.
    #[error("trial {0}: found no frames before the reach, expected some")]
    NoFrames(String),
    /// The goal is not among the targets shown.
    #[error("trial {0}: the goal is not among the targets shown")]
    GoalNotShown(String),
    /// The targets make no scene.
    #[error("trial {trial}: {}", problems.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
    Scene {
        /// Which.
        trial: String,
        /// What is wrong.
        problems: Vec<SceneProblem>,
    },
    /// The machine could not be armed.
    #[error("trial {trial}: the machine could not be armed, it is {}", mode.name())]
    NotArmed {
        /// Which.
        trial: String,
        /// What it is instead.
        mode: Mode,
    },
}

impl<'a> ReachTrial<'a> {
    /// Replay it with a machine that is homed and stands where the trial begins.
    pub fn run(&self, machine: Box<dyn Simulated>) -> Result<TrialOutcome, TrialProblem> {
        self.run_watched(machine, &mut |_| ())
    }

    /// The same, with every step shown to `watcher`.
    pub fn run_watched(
        &self,
        machine: Box<dyn Simulated>,
        watcher: &mut dyn FnMut(Glimpse<'_>),
    ) -> Result<TrialOutcome, TrialProblem> {
        let recording = self.walk.recording();
        let trial = || recording.trial.clone();
        let goal = recording.goal.ok_or_else(|| TrialProblem::NoGoal(trial()))?;
        let shown = |shown: &&usize| **shown == goal;
        let shown = self.targets.iter().position(|index| shown(&index));
        let goal = shown.ok_or_else(|| TrialProblem::GoalNotShown(trial()))?;
        let scene = self.scene().map_err(|problems| TrialProblem::Scene { trial: trial(), problems })?;
        let mut playback = Playback::new(self.walk, scene, &self.conduct, machine, self.link, self.seed)
            .map_err(|mode| TrialProblem::NotArmed { trial: trial(), mode })?;
        let wall = recording.targets[self.targets[goal]].view_deg;
        let on_wall = |&index: &usize| recording.targets[index].view_deg == wall;
        let same_wall = wall.map(|_| self.targets.iter().map(on_wall).collect());
        let place = playback.control.engine().scene().objects()[goal].column_place();
        let belief = BeliefWatch::new(goal, same_wall, self.walk.ends());
        let foretold = ForetoldWatch::new(goal, self.walk.ends(), self.walk.period());
        let mut watch = ReachWatch::new(place, belief, foretold, self.walk.period());
        let mut told_from = self.told_from;
        while playback.at() <= self.walk.ends() {
            if told_from.take_if(|from| playback.at() >= *from).is_some() {
                playback.tell(goal);
            }
            let (at, stepped) = playback.step();
            watch.see(at, &stepped, playback.control.engine());
            watcher(Glimpse { at, head: playback.head.pose, stepped, control: &playback.control });
        }
        playback.control.drain_events().for_each(|event| watch.hear(&event));
        let [true_verdict, commanded_verdict] = playback.control.take_verdicts();
        Ok(watch.outcome(true_verdict, commanded_verdict))
    }

    /// The scene of the targets shown: spheres, the column without props.
    pub fn scene(&self) -> Result<Scene, Vec<SceneProblem>> {
        scene_of(self.walk.recording(), self.targets, self.priors)
    }
}

/// Targets as spheres, and the column without props.
pub(super) fn scene_of(
    recording: &Recording,
    targets: &[usize],
    priors: Option<&[f64]>,
) -> Result<Scene, Vec<SceneProblem>> {
    let room_from_trace = recording.room_from_trace();
    let objects = targets.iter().enumerate().map(|(shown, &index)| {
        let target = &recording.targets[index];
        ObjectSpec {
            id: target.id.clone(),
            position: room_from_trace.point(&target.position),
            yaw_rad: 0.0,
            shape: Shape::Sphere { radius_m: target.radius_m },
            prop: None,
            prior: priors.and_then(|priors| priors.get(shown)).copied().unwrap_or(1.0),
            enabled: true,
        }
    });
    let min = Floor::default();
    let arena = Travel { min, max: min + recording.size_m() };
    Scene::build(SceneSpec::open(arena, objects.collect()))
}

/// A walk played into a loop.
pub(super) struct Playback<'a> {
    pub control: ClosedLoop,
    pub head: TrueHead,
    walk: &'a Walk<'a>,
    poses: std::slice::Iter<'a, PoseSample>,
    truth: std::slice::Iter<'a, (Time, Pose<Room>)>,
}

impl<'a> Playback<'a> {
    /// Armed with nobody there, longer ago than a soft start lasts, as in a session; then the person comes in.
    pub fn new(
        walk: &'a Walk<'a>,
        scene: Scene,
        conduct: &Conduct<'_>,
        machine: Box<dyn Simulated>,
        link: LinkProfile,
        seed: u64,
    ) -> Result<Self, Mode> {
        let config = EngineConfig {
            limits: machine.limits(),
            travel: machine.travel(),
            period: walk.period(),
            intention_rule: conduct.rule,
            intention: conduct.intention.clone(),
            motion: conduct.motion,
            standing: None,
            kept_from: conduct.kept_from,
            v_h_mps: conduct.v_h_mps,
            needs_game_master: false,
            latched_because: None,
        };
        let random = Random::seeded(seed);
        let mut control = ClosedLoop::new(config, Arc::new(scene), machine, link, random, STARTS);
        control.armed_standing(ARMED_FOR)?;
        control.observe(Observation::PersonEntered(VISITOR));
        control.drain_events();
        let pose = walk.truth()[0].1;
        let head = TrueHead { person: VISITOR, pose };
        Ok(Self { control, head, walk, poses: walk.poses().iter(), truth: walk.truth().iter() })
    }

    /// When the next step will be, by the recording's clock.
    pub fn at(&self) -> Time {
        self.walk.begins() + (self.control.now() - STARTS)
    }

    /// One period. In a gap of the recording the head stays where it was last seen.
    pub fn step(&mut self) -> (Time, Stepped) {
        let at = self.at();
        while let Some(sample) = self.poses.as_slice().first().filter(|sample| sample.taken_at <= at) {
            let taken_at = STARTS + (sample.taken_at - self.walk.begins());
            self.control.send(VISITOR, PoseSample { taken_at, ..*sample });
            self.poses.next();
        }
        while let Some((_, pose)) = self.truth.as_slice().first().filter(|(then, _)| *then <= at) {
            self.head.pose = *pose;
            self.truth.next();
        }
        (at, self.control.step(&[self.head]))
    }

    /// The goal is known from now on: every other object has no prior.
    pub fn tell(&mut self, goal: usize) {
        let count = self.control.engine().priors().len();
        let changes = (0..count).map(|index| (index, if index == goal { 1.0 } else { 0.0 })).collect();
        self.control.request(Request::SetPriors(changes));
    }
}

const VISITOR: PersonId = PersonId(1);
/// The loop's clock when the person comes in.
const STARTS: Time = Time::from_micros(10_000_000);
/// Longer than a soft start lasts at the paper's speed.
const ARMED_FOR: Span = Span::from_millis(2_000);

#[cfg(test)]
mod tests {
    use super::super::walk::{Pace, TrackingNoise};
    use super::*;
    use crate::trace::Recordings;
    use covr_engine::machine::Limits;
    use covr_gantry::ideal::IdealMachine;
    use std::fmt::Write;
    use std::io::Cursor;
    use std::path::Path;

    /// A person who stands at (2, 0.5) m and looks at the ball "far" at (2, 3.4) m, then walks to 0.6 m before it.
    fn walk(walks_for_secs: f64) -> Recording {
        let (stands, total) = (1.0, 1.0 + walks_for_secs);
        let mut frames = String::new();
        for i in 0..=(total * 30.0) as i64 {
            let t = i as f64 / 30.0;
            let s = ((t - stands) / walks_for_secs).clamp(0.0, 1.0);
            let y = 0.5 + 2.3 * s.powi(3) * (10.0 + s * (6.0 * s - 15.0));
            let comma = if i > 0 { "," } else { "" };
            write!(frames, "{comma}[{},2000,{},1600,1571,-150]", (t * 1000.0) as i64, (y * 1000.0) as i64)
                .unwrap();
        }
        let line = format!(
            r#"{{"dataset":"made","trial":"walk","user":"u","arena":{{"x":[0,4],"y":[0,4]}},"goal":"far",
            "targets":[{{"id":"far","x":2,"y":3.4,"z":1.1,"r":0.1}},{{"id":"side","x":0.5,"y":0.6,"z":1.1,"r":0.1}}],
            "events":{{"reach":{total}}},"cols":["t_ms","x_mm","y_mm","z_mm","yaw_mrad","pitch_mrad"],"frames":[{frames}]}}"#
        );
        let line = line.replace('\n', " ");
        Recordings::from_lines(Path::new("made"), Box::new(Cursor::new(line))).next().unwrap().unwrap()
    }

    const TRAVEL: Travel = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) };

    const PACE: Pace = Pace {
        period: Span::from_millis(4),
        pose_hz: 75.0,
        noise: TrackingNoise { position_m: 0.0, rotation_rad: 0.0 },
        seed: 1,
        hands: true,
    };

    fn prepared(recording: &Recording) -> Result<Walk<'_>, TrialProblem> {
        Walk::of_reach(recording, &PACE)
    }

    fn outcome(
        walk: &Walk<'_>,
        targets: &[usize],
        machine: IdealMachine,
        told_from: Option<Time>,
    ) -> Result<TrialOutcome, TrialProblem> {
        let conduct = Conduct {
            rule: RuleName::Paper,
            intention: &IntentionParameters::default(),
            motion: MotionName::Proxy,
            kept_from: KeptFrom::Everybody,
            v_h_mps: 1.6,
        };
        let link = LinkProfile::WIRELESS;
        let trial = ReachTrial { walk, targets, priors: None, conduct, told_from, link, seed: 1 };
        trial.run(Box::new(machine))
    }

    fn run(recording: &Recording, targets: &[usize], start: Floor) -> TrialOutcome {
        let machine = IdealMachine::standing(Limits::PAPER, TRAVEL, start);
        outcome(&prepared(recording).unwrap(), targets, machine, None).unwrap()
    }

    #[test]
    fn an_easy_reach_succeeds_and_is_the_same_each_time() {
        let recording = walk(4.0);
        let start = Floor::new(1.0, 3.0);
        let outcome = run(&recording, &[0], start);
        assert!(outcome.success, "{outcome:?}");
        assert!(outcome.in_place_before_reach_secs > 0.5 && outcome.distance_at_reach_m < 0.02);
        let half_a_second_before = outcome.foretold[0].unwrap();
        assert_eq!(half_a_second_before.in_time_probability(), Some(1.0), "{outcome:?}");
        // 1.077 m as the crow flies.
        assert!((1.06..1.5).contains(&outcome.column_travel_m), "{}", outcome.column_travel_m);
        let violations = [&outcome.true_verdict, &outcome.commanded_verdict].map(|v| v.violations());
        assert_eq!(violations, [0, 0], "{:?}", outcome.commanded_verdict.first.first());
        assert_eq!(outcome, run(&recording, &[0], start));
    }

    #[test]
    fn a_reach_that_no_column_can_make_fails() {
        // 0.9 s for the walk: faster than the rule lets the column come.
        let outcome = run(&walk(0.9), &[0, 1], Floor::new(3.8, 0.3));
        assert!(!outcome.success && outcome.in_place_before_reach_secs == 0.0, "{outcome:?}");
        let foretold = outcome.foretold[0].unwrap();
        assert!(foretold.late_by_secs().unwrap() > 1.0, "{foretold:?}");
        assert!(outcome.foretold[2].is_none(), "two seconds before, it had not begun");
    }

    #[test]
    fn a_recording_without_goal_or_reach_is_refused_by_name() {
        let refused = |recording: &Recording, targets: &[usize], machine: IdealMachine| {
            prepared(recording).and_then(|walk| outcome(&walk, targets, machine, None)).unwrap_err()
        };
        let machine = || IdealMachine::standing(Limits::PAPER, TRAVEL, TRAVEL.centre());
        let good = walk(2.0);
        assert_eq!(refused(&good, &[1], machine()), TrialProblem::GoalNotShown("walk".into()));
        let aimless = Recording { goal: None, ..good.clone() };
        assert_eq!(refused(&aimless, &[0], machine()), TrialProblem::NoGoal("walk".into()));
        let endless = Recording { events: Default::default(), ..good.clone() };
        assert_eq!(refused(&endless, &[0], machine()), TrialProblem::NoReach("walk".into()));
        let not_homed = IdealMachine::new(Limits::PAPER, TRAVEL, TRAVEL.centre());
        let refused = refused(&good, &[0], not_homed);
        assert!(matches!(refused, TrialProblem::NotArmed { mode: Mode::Disarmed, .. }));
    }

    #[test]
    fn whoever_is_told_the_goal_on_the_way_believes_in_it_from_then_on() {
        let recording = walk(4.0);
        let prepared = prepared(&recording).unwrap();
        let told_from = |secs: f64| {
            let machine = IdealMachine::standing(Limits::PAPER, TRAVEL, TRAVEL.centre());
            // The goal is the one that nobody looks at.
            let aside = Recording { goal: Some(1), ..recording.clone() };
            let walk = Walk::of_reach(&aside, &PACE).unwrap();
            let told_from = Some(prepared.begins() + Span::from_secs(secs));
            outcome(&walk, &[0, 1], machine, told_from).unwrap().belief.detected_before_reach_secs
        };
        let detected = told_from(3.0).unwrap();
        assert!((detected - 2.0).abs() < 0.05, "{detected}");
    }
}
