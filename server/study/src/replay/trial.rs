//! One recorded reach against engine and machine: was the column in place when the hand arrived?

use std::sync::Arc;

use covr_engine::engine::EngineConfig;
use covr_engine::event::EventKind;
use covr_engine::frames::{Floor, Planar};
use covr_engine::intention::{IntentionParameters, RuleName};
use covr_engine::machine::Travel;
use covr_engine::mode::Mode;
use covr_engine::motion::MotionName;
use covr_engine::observation::{Observation, PersonId};
use covr_engine::safety::separation::KeptFrom;
use covr_engine::safety::vetted::{Action, Vetted};
use covr_engine::scene::{ObjectSpec, Scene, SceneProblem, SceneSpec, Shape};
use covr_engine::time::{Span, Time};
use covr_gantry::contract::Simulated;

use super::belief::{BeliefTold, BeliefWatch};
use super::headset::Headset;
use super::{ClosedLoop, LinkProfile, TrueHead};
use crate::checker::Verdict;
use crate::random::Random;
use crate::trace::{HeadSample, Recording};

/// A recorded reach and what it is replayed with.
#[derive(Debug, Clone, Copy)]
pub struct ReachTrial<'a> {
    /// The person; a trial with a goal and a reach.
    pub recording: &'a Recording,
    /// The targets shown to the engine, as indices into the recording's; the goal is among them.
    pub targets: &'a [usize],
    /// The scenario prior of each of them; none: 1 for all.
    pub priors: Option<&'a [f64]>,
    /// The intention rule.
    pub rule: RuleName,
    /// v_h of the separation rule, m/s.
    pub v_h_mps: f64,
    /// Poses a second.
    pub pose_hz: f64,
    /// How poses travel.
    pub link: LinkProfile,
    /// Decides what the link does.
    pub seed: u64,
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
    /// Virtual time, s.
    pub simulated_secs: f64,
    /// What the checker says of the true motion.
    pub true_verdict: Verdict,
    /// And of the commanded one.
    pub commanded_verdict: Verdict,
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

impl ReachTrial<'_> {
    /// Replay it with a machine that is homed and stands at its start at `from` on its clock.
    pub fn run(&self, machine: Box<dyn Simulated>, from: Time) -> Result<TrialOutcome, TrialProblem> {
        let trial = || self.recording.trial.clone();
        let goal = self.recording.goal.ok_or_else(|| TrialProblem::NoGoal(trial()))?;
        let goal = self
            .targets
            .iter()
            .position(|&shown| shown == goal)
            .ok_or_else(|| TrialProblem::GoalNotShown(trial()))?;
        let reach = self.recording.events.reach.ok_or_else(|| TrialProblem::NoReach(trial()))?;
        let first_frame = self.recording.frames.first().map_or(Time::ZERO, |frame| frame.at);
        let begins = self
            .recording
            .events
            .preview_end
            .map_or(first_frame, |preview_end| preview_end - BEFORE_PREVIEW_END)
            .max(first_frame);
        let scene =
            Arc::new(self.scene().map_err(|problems| TrialProblem::Scene { trial: trial(), problems })?);
        let place = scene.objects()[goal].column_place();
        let config = EngineConfig {
            limits: machine.limits(),
            travel: machine.travel(),
            period: PERIOD,
            intention_rule: self.rule,
            intention: IntentionParameters::default(),
            motion: MotionName::Proxy,
            kept_from: KeptFrom::Everybody,
            v_h_mps: self.v_h_mps,
            latched_because: None,
        };
        let random = Random::seeded(self.seed);
        let control = ClosedLoop::new(config, scene, machine, self.link, random, from);
        let wall = self.recording.targets[self.targets[goal]].view_deg;
        let on_wall = |&index: &usize| self.recording.targets[index].view_deg == wall;
        let same_wall = wall.map(|_| self.targets.iter().map(on_wall).collect());
        let belief = BeliefWatch::new(goal, same_wall, reach);
        let mut playback = Playback::new(self, control, belief, begins, reach)
            .ok_or_else(|| TrialProblem::NoFrames(trial()))?;
        playback.warm_up().map_err(|mode| TrialProblem::NotArmed { trial: trial(), mode })?;
        Ok(playback.play(place))
    }

    /// The scene of the targets shown: spheres, the column without props.
    pub fn scene(&self) -> Result<Scene, Vec<SceneProblem>> {
        let room_from_trace = self.recording.room_from_trace();
        let objects = self.targets.iter().enumerate().map(|(shown, &index)| {
            let target = &self.recording.targets[index];
            ObjectSpec {
                id: target.id.clone(),
                position: room_from_trace.point(&target.position),
                yaw_rad: 0.0,
                shape: Shape::Sphere { radius_m: target.radius_m },
                prop: None,
                prior: self.priors.and_then(|priors| priors.get(shown)).copied().unwrap_or(1.0),
                enabled: true,
            }
        });
        let min = Floor::default();
        let arena = Travel { min, max: min + self.recording.size_m() };
        Scene::build(SceneSpec::open(arena, objects.collect()))
    }
}

/// A recording played into a loop.
struct Playback<'a> {
    trial: &'a ReachTrial<'a>,
    control: ClosedLoop,
    headset: Headset,
    belief: BeliefWatch,
    /// The truth at every control period, and the poses that the headset sends, in the recording's time.
    truth: std::iter::Peekable<crate::trace::Resampled<'a>>,
    poses: std::iter::Peekable<crate::trace::Resampled<'a>>,
    begins: Time,
    reach: Time,
    head: TrueHead,
}

impl<'a> Playback<'a> {
    fn new(
        trial: &'a ReachTrial<'a>,
        control: ClosedLoop,
        belief: BeliefWatch,
        begins: Time,
        reach: Time,
    ) -> Option<Self> {
        let mut truth = trial.recording.resampled_between(1.0 / PERIOD.secs(), begins, reach).peekable();
        let poses = trial.recording.resampled_between(trial.pose_hz, begins, reach).peekable();
        let first = *truth.peek()?;
        let head = TrueHead { person: VISITOR, pose: trial.recording.room_from_trace().pose(&first.pose) };
        let headset = Headset::new();
        Some(Self { trial, control, headset, belief, truth, poses, begins, reach, head })
    }

    /// Armed with nobody there for as long as a soft start lasts, as in a session; then the person comes in.
    fn warm_up(&mut self) -> Result<(), Mode> {
        // The engine hears of the machine first.
        self.control.step(&[]);
        self.control.arm()?;
        let until = self.control.now() + WARM_UP;
        while self.control.now() < until {
            self.control.step(&[]);
        }
        self.control.observe(Observation::PersonEntered(VISITOR));
        self.control.drain_events();
        Ok(())
    }

    fn play(mut self, place: Floor) -> TrialOutcome {
        let room_from_trace = self.trial.recording.room_from_trace();
        let started = self.control.now();
        let in_recording = |now: Time| self.begins + (now - started);
        let mut column_travel_m = 0.0;
        let mut before: Option<Floor> = None;
        let mut arrived_at: Option<Time> = None;
        let mut fast_at: Option<Time> = None;
        let mut last = (f64::INFINITY, started);
        let mut peaks = Peaks::default();
        let mut proxy_way = (0.0, 0.0);
        while in_recording(self.control.now()) <= self.reach {
            let now = self.control.now();
            let due = |sample: &HeadSample| sample.at <= in_recording(now);
            while let Some(sample) = self.poses.next_if(due) {
                let pose = room_from_trace.pose(&sample.pose);
                let taken_at = started + (sample.at - self.begins);
                self.control.send(VISITOR, self.headset.seen(taken_at, &pose));
            }
            // In a gap of the recording the head stays where it was last seen.
            while let Some(sample) = self.truth.next_if(due) {
                self.head.pose = room_from_trace.pose(&sample.pose);
            }
            let stepped = self.control.step(&[self.head]);
            let truth = stepped.truth;
            self.belief.look(in_recording(now), self.control.engine().belief());
            peaks.see(&stepped.command);
            proxy_way.0 += self.control.engine().proxy().distance_m(truth.position);
            proxy_way.1 += 1.0;
            column_travel_m += before.map_or(0.0, |before| before.distance_m(truth.position));
            before = Some(truth.position);
            if truth.velocity.norm() >= AT_REST_MPS {
                fast_at = Some(now);
            }
            let distance_m = truth.position.distance_m(place);
            let in_place = distance_m <= WITHIN_M && truth.velocity.norm() < AT_REST_MPS;
            arrived_at = if in_place { arrived_at.or(Some(now)) } else { None };
            last = (distance_m, now);
        }
        let (distance_at_reach_m, ended) = last;
        let within_10cm = distance_at_reach_m <= WITHIN_M;
        let calm = fast_at.is_none_or(|fast_at| ended - fast_at >= CALM_FOR);
        let events: Vec<_> = self.control.drain_events().collect();
        let is_stop = |kind: &EventKind| {
            matches!(
                kind,
                EventKind::ModeChanged { to: Mode::ProtectiveStop | Mode::LatchedStop | Mode::Faulted, .. }
            )
        };
        TrialOutcome {
            success: within_10cm && calm,
            within_10cm,
            distance_at_reach_m,
            in_place_before_reach_secs: arrived_at.map_or(0.0, |at| (ended - at).secs()),
            stops: events.iter().filter(|event| is_stop(&event.kind)).count() as u32,
            column_travel_m,
            peaks: peaks.greatest,
            proxy_distance_m: proxy_way.0 / f64::max(proxy_way.1, 1.0),
            belief: self.belief.told(),
            simulated_secs: (ended - started).secs(),
            true_verdict: self.control.true_verdict().clone(),
            commanded_verdict: self.control.commanded_verdict().clone(),
        }
    }
}

/// Greatest commanded speed, acceleration and jerk of an axis.
#[derive(Default)]
struct Peaks {
    greatest: [f64; 3],
    before: Option<Planar>,
}

impl Peaks {
    fn see(&mut self, command: &Vetted) {
        let Action::Track(setpoint) = command.action() else {
            self.before = None;
            return;
        };
        let jerk = self.before.map_or(Planar::ZERO, |a| (setpoint.acceleration - a) * (1.0 / PERIOD.secs()));
        self.before = Some(setpoint.acceleration);
        for (greatest, now) in self.greatest.iter_mut().zip([setpoint.velocity, setpoint.acceleration, jerk])
        {
            *greatest = greatest.max(now.x.abs()).max(now.y.abs());
        }
    }
}

const VISITOR: PersonId = PersonId(1);
const PERIOD: Span = Span::from_millis(4);
/// The replay begins this long before the scene is hidden.
const BEFORE_PREVIEW_END: Span = Span::from_millis(2_000);
/// Longer than a soft start lasts at the paper's speed.
const WARM_UP: Span = Span::from_millis(2_000);
/// How near the column's centre must be, m.
const WITHIN_M: f64 = 0.1;
/// How slow, m/s.
const AT_REST_MPS: f64 = 0.05;
/// For how long.
const CALM_FOR: Span = Span::from_millis(200);

#[cfg(test)]
mod tests {
    use super::super::bring_to;
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

    fn run(recording: &Recording, targets: &[usize], start: Floor) -> TrialOutcome {
        let travel = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) };
        let mut machine = IdealMachine::new(Limits::PAPER, travel, travel.centre());
        let from = bring_to(&mut machine, start, Time::ZERO).unwrap();
        let trial = ReachTrial {
            recording,
            targets,
            priors: None,
            rule: RuleName::Paper,
            v_h_mps: 1.6,
            pose_hz: 75.0,
            link: LinkProfile::WIRELESS,
            seed: 1,
        };
        trial.run(Box::new(machine), from).unwrap()
    }

    #[test]
    fn an_easy_reach_succeeds_and_is_the_same_each_time() {
        let recording = walk(4.0);
        let start = Floor::new(1.0, 3.0);
        let outcome = run(&recording, &[0], start);
        assert!(outcome.success, "{outcome:?}");
        assert!(outcome.in_place_before_reach_secs > 0.5 && outcome.distance_at_reach_m < 0.02);
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
    }

    #[test]
    fn a_recording_without_goal_or_reach_is_refused_by_name() {
        let travel = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) };
        let refused = |recording: &Recording, targets: &[usize]| {
            let machine = Box::new(IdealMachine::new(Limits::PAPER, travel, travel.centre()));
            let trial = ReachTrial {
                recording,
                targets,
                priors: None,
                rule: RuleName::Paper,
                v_h_mps: 1.6,
                pose_hz: 75.0,
                link: LinkProfile::PERFECT,
                seed: 1,
            };
            trial.run(machine, Time::ZERO).unwrap_err()
        };
        let good = walk(2.0);
        assert_eq!(refused(&good, &[1]), TrialProblem::GoalNotShown("walk".into()));
        assert_eq!(
            refused(&Recording { goal: None, ..good.clone() }, &[0]),
            TrialProblem::NoGoal("walk".into())
        );
        let endless = Recording { events: Default::default(), ..good.clone() };
        assert_eq!(refused(&endless, &[0]), TrialProblem::NoReach("walk".into()));
        // Not homed: it cannot be armed.
        assert!(matches!(refused(&good, &[0]), TrialProblem::NotArmed { mode: Mode::Disarmed, .. }));
    }
}
