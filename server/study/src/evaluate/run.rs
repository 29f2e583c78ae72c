//! The work: every trial of the plan, on all cores, each in a place of its own.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};

use covr_engine::frames::Floor;
use covr_engine::intention::IntentionParameters;
use covr_engine::machine::{AxisLimits, Limits, Travel};
use covr_engine::motion::MotionName;
use covr_engine::time::Time;
use covr_gantry::contract::Simulated;
use covr_gantry::ideal::IdealMachine;
use covr_gantry::sim::SimulatedMachine;
use covr_gantry::sim::parameters::{MachineParameters, ParameterProblem};
use sha2::{Digest, Sha256};

use super::blame;
use super::bounded;
use super::draw::Draw;
use super::plan::{Conditions, MachineKind, Objects, Plan, Prior, RuleChoice, SeparationChoice};
use super::row::{Evaluation, Judged};
use super::rows::{pooled, rows};
use super::session::visits_by_cell;
use super::subjects::{Reach, Session, Subjects, task, travel};
use crate::parallel;
use crate::replay::{Conduct, Glimpse, Pace, ReachTrial, TrialOutcome, TrialProblem, Walk};
use crate::trace::{Recording, TraceError};

/// Why there is no evaluation.
#[derive(Debug, thiserror::Error)]
pub enum EvaluationProblem {
    /// A file is no trace.
    #[error(transparent)]
    Trace(#[from] TraceError),
    /// No trial is left.
    #[error("found no trial with a goal and a reach among the recordings that were asked for")]
    Nothing,
    /// No trial of that name.
    #[error("trial: found `{trial}`, expected the name of a recorded reach, such as `{like}`")]
    NoTrial {
        /// What was said.
        trial: String,
        /// What could have been.
        like: String,
    },
    /// The limit is asked for of what has none.
    #[error("rule bound: found {found}, expected {expected}")]
    Bound {
        /// What was said.
        found: &'static str,
        /// What could have been.
        expected: &'static str,
    },
    /// A trial cannot be replayed.
    #[error(transparent)]
    Trial(#[from] TrialProblem),
    /// The simulated machine cannot be built for this arena.
    #[error("the simulated machine: {0}")]
    Machine(#[from] ParameterProblem),
}

/// Told of each trial that is done, and of how many there are.
pub type Progress<'a> = &'a (dyn Fn(usize, usize) + Sync);

/// Replay the plan.
pub fn evaluate(
    subjects: &Subjects,
    plan: &Plan,
    progress: Progress<'_>,
) -> Result<Evaluation, EvaluationProblem> {
    let one = sweep(subjects, plan, std::slice::from_ref(&plan.intention), progress)?;
    one.into_iter().next().ok_or(EvaluationProblem::Nothing)
}

/// Replay the plan with each of these numbers of the rules, in their order: what evaluating one after the other would
/// give, but every person's poses are prepared once.
pub fn sweep(
    subjects: &Subjects,
    plan: &Plan,
    intentions: &[IntentionParameters],
    progress: Progress<'_>,
) -> Result<Vec<Evaluation>, EvaluationProblem> {
    let (cells, jobs) = (cells(plan), jobs(subjects, plan)?);
    let of_each = cases(&jobs, plan, &cells, intentions, progress)?;
    let evaluation = |cases: Vec<Case<'_>>| Evaluation {
        schema: "covr.evaluation.v1",
        version: env!("CARGO_PKG_VERSION"),
        limits: limits_in_words(plan),
        wall_secs: 0.0,
        simulated_secs: cases.iter().flat_map(|case| case.by_cell.iter().flatten()).map(Judged::secs).sum(),
        conditions: conditions_in_words(&plan.conditions),
        left_out: subjects.left_out.iter().cloned().chain(bounded::left_out(plan, &jobs)).collect(),
        rows: rows(plan, &cells, &cases),
        pooled: pooled(plan, &cells, &cases),
    };
    Ok(of_each.into_iter().map(evaluation).collect())
}

/// With each of these numbers of the rules, for every person: how many reaches failed, and of how many.
pub fn failures(
    subjects: &Subjects,
    plan: &Plan,
    intentions: &[IntentionParameters],
    progress: Progress<'_>,
) -> Result<Vec<BTreeMap<String, [usize; 2]>>, EvaluationProblem> {
    let (cells, jobs) = (cells(plan), jobs(subjects, plan)?);
    let of_each = cases(&jobs, plan, &cells, intentions, progress)?;
    let by_person = |cases: Vec<Case<'_>>| {
        let mut people: BTreeMap<String, [usize; 2]> = BTreeMap::new();
        for case in cases {
            let [failed, trials] = people.entry(case.person.to_owned()).or_default();
            for judged in case.by_cell.iter().flatten() {
                *failed += usize::from(!judged.outcome.success);
                *trials += 1;
            }
        }
        people
    };
    Ok(of_each.into_iter().map(by_person).collect())
}

fn jobs<'a>(subjects: &'a Subjects, plan: &Plan) -> Result<Vec<Job<'a>>, EvaluationProblem> {
    let chosen = |recording: &Recording| is_chosen(recording, plan);
    let reaches = subjects.reaches.iter().filter(|reach| chosen(&reach.recording)).map(Job::Reach);
    let sessions = subjects.sessions.iter().filter(|session| chosen(&session.recording)).map(Job::Session);
    let jobs: Vec<Job<'_>> = reaches.chain(sessions).collect();
    if jobs.is_empty() {
        return Err(EvaluationProblem::Nothing);
    }
    let sessions = jobs.iter().filter(|job| matches!(job, Job::Session(_))).count();
    bounded::check(plan, sessions == jobs.len())?;
    Ok(jobs)
}

/// For each of the rules' numbers every reach, in the order of the jobs whoever did them.
fn cases<'a>(
    jobs: &[Job<'a>],
    plan: &Plan,
    cells: &[Cell],
    intentions: &[IntentionParameters],
    progress: Progress<'_>,
) -> Result<Vec<Vec<Case<'a>>>, EvaluationProblem> {
    let done = AtomicUsize::new(0);
    let replays = cells.len() * intentions.len();
    let outcomes = parallel::each(jobs.len(), plan.threads, |number| {
        let outcomes = with_each(plan, intentions, cells, &jobs[number]);
        progress(done.fetch_add(replays, Ordering::Relaxed) + replays, replays * jobs.len());
        outcomes
    });
    let outcomes = outcomes.into_iter().collect::<Result<Vec<_>, _>>()?;
    let mut of_each: Vec<Vec<Case<'_>>> = intentions.iter().map(|_| Vec::new()).collect();
    for (job, outcomes) in jobs.iter().zip(outcomes) {
        let (file, recording) = match job {
            Job::Reach(reach) => (&reach.file, &reach.recording),
            Job::Session(session) => (&session.file, &session.recording),
        };
        for (of_one, cases) in of_each.iter_mut().zip(outcomes) {
            let case = |by_cell| Case { file, person: &recording.user, task: task(recording), by_cell };
            of_one.extend(cases.into_iter().map(case));
        }
    }
    Ok(of_each)
}

/// What a thread takes at once.
#[derive(Debug, Clone, Copy)]
pub(super) enum Job<'a> {
    Reach(&'a Reach),
    Session(&'a Session),
}

/// One reach, of a trial or in a session, and what became of it in each cell.
#[derive(Debug, Clone)]
pub(super) struct Case<'a> {
    pub file: &'a str,
    pub person: &'a str,
    pub task: &'a str,
    pub by_cell: Vec<Option<Judged>>,
}

/// One combination of the plan.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cell {
    pub rule: RuleChoice,
    pub motion: MotionName,
    pub separation: SeparationChoice,
    pub prior: Prior,
    pub draw: Draw,
    pub objects: Objects,
}

/// One replay: a walk, what is shown, and how it is driven.
#[derive(Debug, Clone, Copy)]
pub(super) struct Course<'a> {
    pub plan: &'a Plan,
    pub cell: Cell,
    pub reach: &'a Reach,
    pub walk: &'a Walk<'a>,
    pub intention: &'a IntentionParameters,
    pub told_from: Option<Time>,
    pub limits: Limits,
    pub machine: MachineKind,
    pub conditions: Conditions,
}

impl<'a> Course<'a> {
    /// The replay that a cell of the plan asks for.
    pub fn of(plan: &'a Plan, cell: Cell, reach: &'a Reach, walk: &'a Walk<'a>) -> Self {
        let told_from = (cell.rule == RuleChoice::Told).then_some(walk.begins());
        let Plan { conditions, machine, ref intention, .. } = *plan;
        let limits = conditions.limits();
        Self { plan, cell, reach, walk, intention, told_from, limits, machine, conditions }
    }

    /// What comes of it.
    pub fn replayed(&self) -> Result<TrialOutcome, EvaluationProblem> {
        self.replayed_before(&mut |_| ())
    }

    /// The same, with every step shown to `watcher`.
    pub fn replayed_before(
        &self,
        watcher: &mut dyn FnMut(Glimpse<'_>),
    ) -> Result<TrialOutcome, EvaluationProblem> {
        let priors = self.priors();
        let targets = self.targets();
        let trial = ReachTrial {
            walk: self.walk,
            targets: &targets,
            priors: Some(&priors),
            conduct: conduct(self.plan, &self.cell, self.intention),
            told_from: self.told_from,
            link: self.conditions.link(),
            seed: seed(&self.reach.recording, "link"),
        };
        let (travel, place) = (travel(&self.reach.recording), self.reach.column);
        let machine = machine(self.machine, self.limits, travel, place)?;
        Ok(trial.run_watched(machine, watcher)?)
    }

    /// The same with poses as they were recorded; none where they are.
    pub fn as_recorded(&self) -> Result<Option<TrialOutcome>, EvaluationProblem> {
        let Conditions { acceleration_share, .. } = self.conditions;
        let conditions = Conditions { acceleration_share, ..Conditions::AS_RECORDED };
        if conditions == self.conditions {
            return Ok(None);
        }
        let walk =
            Walk::of_reach(&self.reach.recording, &pace(self.plan, &conditions, &self.reach.recording))?;
        let course = Course { walk: &walk, conditions, ..*self };
        course.replayed().map(Some)
    }

    /// The targets shown, as indices into the recording's.
    pub fn targets(&self) -> Vec<usize> {
        let recording = &self.reach.recording;
        let objects = self.cell.objects.of(recording.targets.len());
        self.cell.draw.targets(recording, &recording.trial, self.reach.goal, objects)
    }

    fn priors(&self) -> Vec<f64> {
        let favoured = match self.cell.prior {
            Prior::None => None,
            Prior::Right => Some(self.reach.goal),
            Prior::Wrong => self.first_distractor(),
        };
        let targets = self.targets();
        targets.iter().map(|&index| prior_of(index, favoured, targets.len())).collect()
    }

    fn first_distractor(&self) -> Option<usize> {
        let recording = &self.reach.recording;
        let objects = self.cell.objects.of(recording.targets.len());
        self.cell.draw.first_distractor(recording, &recording.trial, self.reach.goal, objects)
    }
}

pub(super) fn cells(plan: &Plan) -> Vec<Cell> {
    let mut cells = Vec::new();
    for &rule in &plan.rules {
        for motion in plan.motions_of(rule) {
            for &separation in &plan.separations {
                for &draw in &plan.draws {
                    for &prior in &plan.priors {
                        for &objects in &plan.objects {
                            // With the goal alone, or told, a prior says nothing.
                            let alone = objects == Objects::Count(1) || rule.knows_the_goal();
                            if prior == Prior::None || !alone {
                                cells.push(Cell { rule, motion, separation, prior, draw, objects });
                            }
                        }
                    }
                }
            }
        }
    }
    cells
}

/// Every cell with each of the rules' numbers: for each reach of the job, by cell. The walk of a trial is prepared
/// once.
fn with_each(
    plan: &Plan,
    intentions: &[IntentionParameters],
    cells: &[Cell],
    job: &Job<'_>,
) -> Result<Vec<Vec<Vec<Option<Judged>>>>, EvaluationProblem> {
    match job {
        Job::Reach(reach) => {
            let walk = Walk::of_reach(&reach.recording, &pace(plan, &plan.conditions, &reach.recording))?;
            let judge =
                |intention, cell| judged(&Course { intention, ..Course::of(plan, cell, reach, &walk) });
            let all = |intention| cells.iter().map(|&cell| judge(intention, cell)).collect::<Result<_, _>>();
            intentions.iter().map(|intention| Ok(vec![all(intention)?])).collect()
        }
        Job::Session(session) => {
            intentions.iter().map(|intention| visits_by_cell(plan, intention, cells, session)).collect()
        }
    }
}

/// The trial, with its cause if it is asked for; none where the recording has no distractor to name wrongly.
fn judged(course: &Course<'_>) -> Result<Option<Judged>, EvaluationProblem> {
    if course.cell.rule == RuleChoice::Bound {
        return bounded::judged(course).map(Some);
    }
    if course.cell.prior == Prior::Wrong && course.first_distractor().is_none() {
        return Ok(None);
    }
    let outcome = course.replayed()?;
    if course.plan.blames {
        return blame::judged(course, outcome).map(Some);
    }
    Ok(Some(Judged { outcome, cause: None, not_excluded: None }))
}

/// How the engine decides in a cell.
pub(super) fn conduct<'a>(plan: &Plan, cell: &Cell, intention: &'a IntentionParameters) -> Conduct<'a> {
    Conduct {
        rule: cell.rule.engine_rule(),
        intention,
        motion: cell.motion,
        kept_from: cell.separation.kept_from(),
        v_h_mps: plan.v_h_mps,
    }
}

/// The prior of a target among so many shown.
pub(super) fn prior_of(index: usize, favoured: Option<usize>, shown: usize) -> f64 {
    let others = shown.saturating_sub(1).max(1) as f64;
    match favoured {
        None => 1.0,
        Some(favoured) if index == favoured => FAVOURED,
        Some(_) => (1.0 - FAVOURED) / others,
    }
}

/// A machine that is homed and stands at `place`.
pub(super) fn machine(
    kind: MachineKind,
    limits: Limits,
    travel: Travel,
    place: Floor,
) -> Result<Box<dyn Simulated>, EvaluationProblem> {
    Ok(match kind {
        MachineKind::Ideal => Box::new(IdealMachine::standing(limits, travel, place)),
        MachineKind::Simulated => Box::new(SimulatedMachine::standing(MachineParameters {
            limits,
            start: place,
            ..MachineParameters::paper(travel)
        })?),
    })
}

pub(super) fn pace(plan: &Plan, conditions: &Conditions, recording: &Recording) -> Pace {
    let seed = seed(recording, "noise");
    Pace { period: plan.machine.period(), pose_hz: POSE_HZ, noise: conditions.noise, seed }
}

/// Every trial has losses and noise of its own, the same for each rule, number of objects and number of threads.
pub(super) fn seed(recording: &Recording, of: &str) -> u64 {
    let hash: [u8; 32] = Sha256::digest(format!("{}/{of}", recording.trial)).into();
    hash.iter().take(8).fold(0, |seed, byte| seed << 8 | u64::from(*byte))
}

fn is_chosen(recording: &Recording, plan: &Plan) -> bool {
    let asked = |list: &[String], word: &str| list.is_empty() || list.iter().any(|one| one == word);
    asked(&plan.tasks, task(recording)) && asked(&plan.people, &recording.user)
}

fn limits_in_words(plan: &Plan) -> BTreeMap<&'static str, f64> {
    let AxisLimits { speed_mps, acceleration_mps2, braking_mps2, jerk_mps3 } = plan.conditions.limits().x;
    [
        ("speed_mps", speed_mps),
        ("acceleration_mps2", acceleration_mps2),
        ("braking_mps2", braking_mps2),
        ("jerk_mps3", jerk_mps3),
        ("v_h_mps", plan.v_h_mps),
        ("pose_hz", POSE_HZ),
        ("period_s", plan.machine.period().secs()),
    ]
    .into()
}

fn conditions_in_words(conditions: &Conditions) -> BTreeMap<&'static str, f64> {
    [
        ("latency_s", conditions.latency.secs()),
        ("loss", conditions.loss),
        ("noise_m", conditions.noise.position_m),
        ("noise_rad", conditions.noise.rotation_rad),
        ("acceleration_share", conditions.acceleration_share),
    ]
    .into()
}

/// The paper's head tracking, Hz.
const POSE_HZ: f64 = 75.0;
/// The paper's prior on the goal.
const FAVOURED: f64 = 0.75;

#[cfg(test)]
mod tests;
