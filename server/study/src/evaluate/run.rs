//! The work: every trial of the plan, on all cores, each in a place of its own.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};

use covr_engine::intention::IntentionParameters;
use covr_engine::machine::AxisLimits;
use covr_engine::motion::MotionName;
use covr_gantry::sim::parameters::ParameterProblem;

use super::blame;
use super::bounded;
use super::course::{Course, POSE_HZ, pace};
use super::draw::Draw;
use super::plan::{Conditions, Objects, Plan, Prior, RuleChoice, SeparationChoice};
use super::row::{Evaluation, Judged};
use super::rows::{pooled, rows};
use super::session::visits_by_cell;
use super::subjects::{Reach, Session, Subjects, task};
use crate::parallel;
use crate::replay::{TrialProblem, Walk};
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
    by_person(subjects, plan, intentions.len(), &|_| intentions.iter().collect(), progress)
}

/// Replay the plan with each person under numbers of their own, those of the plan for who has none: so that everybody can be
/// judged by what was fitted to others.
pub fn evaluate_by_person(
    subjects: &Subjects,
    plan: &Plan,
    intentions: &BTreeMap<String, IntentionParameters>,
    progress: Progress<'_>,
) -> Result<Evaluation, EvaluationProblem> {
    let own = |person: &str| vec![intentions.get(person).unwrap_or(&plan.intention)];
    let one = by_person(subjects, plan, 1, &own, progress)?;
    one.into_iter().next().ok_or(EvaluationProblem::Nothing)
}

fn by_person(
    subjects: &Subjects,
    plan: &Plan,
    count: usize,
    intentions: Intentions<'_>,
    progress: Progress<'_>,
) -> Result<Vec<Evaluation>, EvaluationProblem> {
    let (cells, jobs) = (cells(plan), jobs(subjects, plan)?);
    let of_each = cases(&jobs, plan, &cells, count, intentions, progress)?;
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
    let of_each = cases(&jobs, plan, &cells, intentions.len(), &|_| intentions.iter().collect(), progress)?;
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
    count: usize,
    intentions: Intentions<'_>,
    progress: Progress<'_>,
) -> Result<Vec<Vec<Case<'a>>>, EvaluationProblem> {
    let done = AtomicUsize::new(0);
    let replays = cells.len() * count;
    let outcomes = parallel::each(jobs.len(), plan.threads, |number| {
        let outcomes = with_each(plan, &intentions(jobs[number].person()), cells, &jobs[number]);
        progress(done.fetch_add(replays, Ordering::Relaxed) + replays, replays * jobs.len());
        outcomes
    });
    let outcomes = outcomes.into_iter().collect::<Result<Vec<_>, _>>()?;
    let mut of_each: Vec<Vec<Case<'_>>> = (0..count).map(|_| Vec::new()).collect();
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

/// The numbers of the rules that a person is replayed with, as many for everybody.
type Intentions<'a> = &'a (dyn Fn(&str) -> Vec<&'a IntentionParameters> + Sync);

/// What a thread takes at once.
#[derive(Debug, Clone, Copy)]
pub(super) enum Job<'a> {
    Reach(&'a Reach),
    Session(&'a Session),
}

impl Job<'_> {
    fn person(&self) -> &str {
        match self {
            Self::Reach(reach) => &reach.recording.user,
            Self::Session(session) => &session.recording.user,
        }
    }
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
    intentions: &[&IntentionParameters],
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
        ("without_hands", f64::from(u8::from(conditions.without_hands))),
    ]
    .into()
}

#[cfg(test)]
mod tests;
