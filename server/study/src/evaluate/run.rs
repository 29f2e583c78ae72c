//! The work: every trial of the plan, on all cores, each in a place of its own.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use covr_engine::intention::IntentionParameters;
use covr_engine::machine::{AxisLimits, Limits};
use covr_engine::motion::MotionName;
use covr_engine::time::Time;
use covr_gantry::contract::Simulated;
use covr_gantry::ideal::IdealMachine;
use covr_gantry::sim::SimulatedMachine;
use covr_gantry::sim::parameters::{MachineParameters, ParameterProblem};

use super::blame;
use super::draw::Draw;
use super::plan::{Conditions, MachineKind, Objects, Plan, Prior, RuleChoice, SeparationChoice};
use super::row::{Evaluation, Judged};
use super::rows::{pooled, rows};
use super::subjects::{Reach, Subjects, task, travel};
use crate::replay::{Conduct, Glimpse, Pace, ReachTrial, TrialOutcome, TrialProblem, Walk};
use crate::trace::TraceError;

/// Why there is no evaluation.
#[derive(Debug, thiserror::Error)]
pub enum EvaluationProblem {
    /// A file is no trace.
    #[error(transparent)]
    Trace(#[from] TraceError),
    /// No trial is left.
    #[error("found no trial with a goal and a reach among the recordings that were asked for")]
    Nothing,
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
    let cells = cells(plan);
    let reaches: Vec<&Reach> = subjects.reaches.iter().filter(|reach| is_chosen(reach, plan)).collect();
    if reaches.is_empty() {
        return Err(EvaluationProblem::Nothing);
    }
    let next = AtomicUsize::new(0);
    let done = AtomicUsize::new(0);
    let work = || {
        let mut mine = Vec::new();
        loop {
            let job = next.fetch_add(1, Ordering::Relaxed);
            let Some(reach) = reaches.get(job) else { return mine };
            let outcomes = with_each(plan, intentions, &cells, reach);
            let of_reach = cells.len() * intentions.len();
            progress(done.fetch_add(of_reach, Ordering::Relaxed) + of_reach, of_reach * reaches.len());
            mine.push((job, outcomes));
        }
    };
    let cores = thread::available_parallelism().map_or(1, usize::from);
    let threads = if plan.threads == 0 { cores } else { plan.threads };
    let mut results: Vec<_> = thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        let joined = workers.into_iter().map(|worker| match worker.join() {
            Ok(mine) => mine,
            Err(panic) => std::panic::resume_unwind(panic),
        });
        joined.flatten().collect()
    });
    results.sort_by_key(|(job, _)| *job);
    let outcomes = results.into_iter().map(|(_, outcome)| outcome).collect::<Result<Vec<_>, _>>()?;
    let mut of_each: Vec<Vec<Vec<Option<Judged>>>> = intentions.iter().map(|_| Vec::new()).collect();
    for of_reach in outcomes {
        of_each.iter_mut().zip(of_reach).for_each(|(of_one, judged)| of_one.push(judged));
    }
    let evaluation = |outcomes: Vec<Vec<Option<Judged>>>| Evaluation {
        schema: "covr.evaluation.v1",
        version: env!("CARGO_PKG_VERSION"),
        limits: limits_in_words(plan),
        wall_secs: 0.0,
        simulated_secs: outcomes.iter().flatten().flatten().map(|judged| judged.outcome.simulated_secs).sum(),
        conditions: conditions_in_words(&plan.conditions),
        left_out: subjects.left_out.clone(),
        rows: rows(plan, &cells, &reaches, &outcomes),
        pooled: pooled(plan, &cells, &reaches, &outcomes),
    };
    Ok(of_each.into_iter().map(evaluation).collect())
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
        let conduct = Conduct {
            rule: self.cell.rule.engine_rule(),
            intention: self.intention,
            motion: self.cell.motion,
            kept_from: self.cell.separation.kept_from(),
            v_h_mps: self.plan.v_h_mps,
        };
        let targets = self.targets();
        let trial = ReachTrial {
            walk: self.walk,
            targets: &targets,
            priors: Some(&priors),
            conduct,
            told_from: self.told_from,
            link: self.conditions.link(),
            seed: SEED,
        };
        Ok(trial.run_watched(self.machine()?, watcher)?)
    }

    /// The same with poses as they were recorded; none where they are.
    pub fn as_recorded(&self) -> Result<Option<TrialOutcome>, EvaluationProblem> {
        let Conditions { acceleration_share, .. } = self.conditions;
        let conditions = Conditions { acceleration_share, ..Conditions::AS_RECORDED };
        if conditions == self.conditions {
            return Ok(None);
        }
        let walk = Walk::of_reach(&self.reach.recording, &pace(self.plan, &conditions))?;
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
        let others = targets.len().saturating_sub(1).max(1) as f64;
        let of = |&index: &usize| match favoured {
            None => 1.0,
            Some(favoured) if index == favoured => FAVOURED,
            Some(_) => (1.0 - FAVOURED) / others,
        };
        targets.iter().map(of).collect()
    }

    fn first_distractor(&self) -> Option<usize> {
        let recording = &self.reach.recording;
        let objects = self.cell.objects.of(recording.targets.len());
        self.cell.draw.first_distractor(recording, &recording.trial, self.reach.goal, objects)
    }

    fn machine(&self) -> Result<Box<dyn Simulated>, EvaluationProblem> {
        let (travel, place) = (travel(&self.reach.recording), self.reach.column);
        Ok(match self.machine {
            MachineKind::Ideal => Box::new(IdealMachine::standing(self.limits, travel, place)),
            MachineKind::Simulated => Box::new(SimulatedMachine::standing(MachineParameters {
                limits: self.limits,
                start: place,
                ..MachineParameters::paper(travel)
            })?),
        })
    }
}

fn cells(plan: &Plan) -> Vec<Cell> {
    let mut cells = Vec::new();
    for &rule in &plan.rules {
        for motion in plan.motions_of(rule) {
            for &separation in &plan.separations {
                for &draw in &plan.draws {
                    for &prior in &plan.priors {
                        for &objects in &plan.objects {
                            // With the goal alone, or told, a prior says nothing.
                            let alone = objects == Objects::Count(1) || rule == RuleChoice::Told;
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

/// Every cell with each of the rules' numbers for one person's reach, whose walk is prepared once; none where the
/// recording has no distractor to name wrongly.
fn with_each(
    plan: &Plan,
    intentions: &[IntentionParameters],
    cells: &[Cell],
    reach: &Reach,
) -> Result<Vec<Vec<Option<Judged>>>, EvaluationProblem> {
    let walk = Walk::of_reach(&reach.recording, &pace(plan, &plan.conditions))?;
    let judge = |intention, cell: &Cell| {
        let course = Course { intention, ..Course::of(plan, *cell, reach, &walk) };
        if cell.prior == Prior::Wrong && course.first_distractor().is_none() {
            return Ok(None);
        }
        let outcome = course.replayed()?;
        let judged =
            if plan.blames { blame::judged(&course, outcome)? } else { Judged { outcome, cause: None } };
        Ok(Some(judged))
    };
    let all_cells = |intention| cells.iter().map(|cell| judge(intention, cell)).collect();
    intentions.iter().map(all_cells).collect()
}

pub(super) fn pace(plan: &Plan, conditions: &Conditions) -> Pace {
    Pace { period: plan.machine.period(), pose_hz: POSE_HZ, noise: conditions.noise, seed: SEED }
}

fn is_chosen(reach: &Reach, plan: &Plan) -> bool {
    let asked = |list: &[String], word: &str| list.is_empty() || list.iter().any(|one| one == word);
    asked(&plan.tasks, task(&reach.recording)) && asked(&plan.people, &reach.recording.user)
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
/// Of losses and noise.
const SEED: u64 = 1;

#[cfg(test)]
mod tests {
    use super::*;
    use covr_engine::frames::Floor;
    use covr_engine::intention::RuleName;
    use std::fmt::Write;
    use std::path::Path;

    /// Two reaches of one person: to A in a file of two lines, then to B.
    fn subjects(folder: &Path) -> Subjects {
        let mut text = String::new();
        for (trial, goal, x) in [("one", "A", 1.0), ("two", "B", 3.0)] {
            let frames: Vec<String> = (0..=180)
                .map(|i| {
                    let t = f64::from(i) / 30.0;
                    let s = ((t - 3.0) / 3.0).clamp(0.0, 1.0);
                    let at = 2000.0 + (x - 2.0) * 1000.0 * s;
                    let yaw = if x > 2.0 { 0 } else { 3142 };
                    format!("[{},{},700,1600,{yaw},-200]", (t * 1000.0) as i64, at as i64)
                })
                .collect();
            writeln!(
                text,
                r#"{{"dataset":"made","trial":"{trial}","user":"u","mode":"fixed","arena":{{"x":[0,4],"y":[0,4]}},"goal":"{goal}","targets":[{{"id":"A","x":0.4,"y":2,"z":1.1,"r":0.1}},{{"id":"B","x":3.6,"y":2,"z":1.1,"r":0.1}}],"events":{{"preview_end":2.0,"reach":6.0}},"cols":["t_ms","x_mm","y_mm","z_mm","yaw_mrad","pitch_mrad"],"frames":[{}]}}"#,
                frames.join(",")
            )
            .unwrap();
        }
        let file = folder.join("made_reach.jsonl");
        std::fs::write(&file, text).unwrap();
        Subjects::read(&[file]).unwrap()
    }

    fn plan(threads: usize) -> Plan {
        Plan {
            rules: vec![RuleChoice::Rule(RuleName::PaperBest), RuleChoice::Told],
            motions: vec![MotionName::Proxy],
            objects: vec![Objects::Count(1), Objects::All],
            priors: Prior::ALL.to_vec(),
            machine: MachineKind::Ideal,
            threads,
            ..Plan::new(RuleName::PaperBest, MotionName::Proxy)
        }
    }

    #[test]
    fn the_table_is_the_same_for_any_number_of_threads() {
        let folder = tempfile::tempdir().unwrap();
        let subjects = subjects(folder.path());
        let one = evaluate(&subjects, &plan(1), &|_, _| ()).unwrap();
        assert_eq!(one, evaluate(&subjects, &plan(3), &|_, _| ()).unwrap());
        assert!(one.pooled.iter().all(|row| row.objects == 0 && row.trials == 2), "{:?}", one.pooled);
        // Prior by prior, two counts for the rule less the lone goal with a prior; two counts told.
        assert_eq!(one.rows.len(), 4 + 2);
        let told = one.rows.iter().find(|row| row.rule == "told" && row.objects == 0).unwrap();
        assert_eq!((told.trials, told.violations, told.success), (2, 0, 1.0));
        assert_eq!(told.top1["0.0"], 1.0);
        assert!(one.rows.iter().filter(|row| row.default).all(|row| row.rule == "paper-best"));
    }

    #[test]
    fn the_column_begins_at_the_goal_before() {
        let folder = tempfile::tempdir().unwrap();
        let subjects = subjects(folder.path());
        assert_eq!(subjects.reaches[0].column, Floor::new(3.0, 3.0));
        assert_eq!(subjects.reaches[1].column, Floor::new(0.4, 2.0));
    }

    #[test]
    fn people_who_are_not_there_are_said_to_be_missing() {
        let folder = tempfile::tempdir().unwrap();
        let subjects = subjects(folder.path());
        let nobody = Plan { people: vec!["x".into()], ..plan(1) };
        assert!(matches!(evaluate(&subjects, &nobody, &|_, _| ()), Err(EvaluationProblem::Nothing)));
    }

    #[test]
    fn every_failure_has_a_cause_and_every_cause_is_counted() {
        let folder = tempfile::tempdir().unwrap();
        let subjects = subjects(folder.path());
        // So slow a machine is nowhere in time.
        let conditions = Conditions { acceleration_share: 0.02, ..Conditions::AS_RECORDED };
        let blamed = evaluate(&subjects, &Plan { blames: true, conditions, ..plan(1) }, &|_, _| ()).unwrap();
        for row in &blamed.rows {
            assert_eq!(row.blame.values().sum::<u64>(), (row.trials - row.successes) as u64, "{row:?}");
        }
        let told = blamed.rows.iter().find(|row| row.rule == "told").unwrap();
        assert!(told.blame.contains_key("acceleration"), "{:?}", told.blame);
    }

    #[test]
    fn without_the_separation_rule_its_breaches_are_counted_apart() {
        let folder = tempfile::tempdir().unwrap();
        let subjects = subjects(folder.path());
        let separations = vec![SeparationChoice::On, SeparationChoice::Off];
        let both = evaluate(&subjects, &Plan { separations, ..plan(1) }, &|_, _| ()).unwrap();
        let of = |name: &str| both.rows.iter().filter(|row| row.separation == name).collect::<Vec<_>>();
        assert_eq!(of("on").len(), of("off").len());
        assert!(of("on").iter().all(|row| row.separation_breaches == 0));
        assert!(both.rows.iter().all(|row| row.violations == 0));
    }
}
