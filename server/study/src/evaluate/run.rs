//! The work: every trial of the plan, on all cores, each in a place of its own.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use covr_engine::frames::{Floor, Planar};
use covr_engine::machine::{AxisLimits, Limits, Travel};
use covr_engine::time::Time;
use covr_gantry::contract::Simulated;
use covr_gantry::ideal::IdealMachine;
use covr_gantry::sim::SimulatedMachine;
use covr_gantry::sim::parameters::{MachineParameters, ParameterProblem};

use super::plan::{MachineKind, Objects, Plan, Prior, RuleChoice};
use super::row::{Evaluation, Row, RowKey};
use crate::replay::{CannotStand, LinkProfile, ReachTrial, TrialOutcome, TrialProblem, bring_to};
use crate::trace::{Recording, Recordings, TraceError, trace_files};

/// Recorded reaches, by file.
#[derive(Debug, Clone, PartialEq)]
pub struct Subjects {
    reaches: Vec<Reach>,
}

#[derive(Debug, Clone, PartialEq)]
struct Reach {
    file: String,
    recording: Recording,
    goal: usize,
    /// Where the column begins: this person's goal before, in the recording's room.
    column: Floor,
}

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
    /// The machine does not stand where the trial begins.
    #[error("trial {trial}: {problem}")]
    Start {
        /// Which.
        trial: String,
        /// Why.
        problem: CannotStand,
    },
    /// The simulated machine cannot be built for this arena.
    #[error("the simulated machine: {0}")]
    Machine(#[from] ParameterProblem),
}

/// Told of each trial that is done, and of how many there are.
pub type Progress<'a> = &'a (dyn Fn(usize, usize) + Sync);

impl Subjects {
    /// Read files and folders of traces; recordings without a goal and a reach are left out.
    pub fn read(paths: &[PathBuf]) -> Result<Self, EvaluationProblem> {
        let mut reaches: Vec<Reach> = Vec::new();
        for path in paths {
            for file in trace_files(path)? {
                let name = stem(&file);
                for recording in Recordings::open(&file)? {
                    let recording = recording?;
                    let Some(goal) = recording.goal.filter(|_| recording.events.reach.is_some()) else {
                        continue;
                    };
                    let column = column_start(&reaches, &recording);
                    reaches.push(Reach { file: name.clone(), recording, goal, column });
                }
            }
        }
        if reaches.is_empty() { Err(EvaluationProblem::Nothing) } else { Ok(Self { reaches }) }
    }

    fn chosen<'a>(&'a self, plan: &'a Plan) -> impl Iterator<Item = &'a Reach> {
        self.reaches.iter().filter(|reach| {
            let asked = |list: &[String], word: &str| list.is_empty() || list.iter().any(|one| one == word);
            asked(&plan.tasks, task(&reach.recording)) && asked(&plan.people, &reach.recording.user)
        })
    }
}

/// Replay the plan.
pub fn evaluate(
    subjects: &Subjects,
    plan: &Plan,
    progress: Progress<'_>,
) -> Result<Evaluation, EvaluationProblem> {
    let cells = cells(plan);
    let reaches: Vec<&Reach> = subjects.chosen(plan).collect();
    if reaches.is_empty() {
        return Err(EvaluationProblem::Nothing);
    }
    let count = cells.len() * reaches.len();
    let next = AtomicUsize::new(0);
    let done = AtomicUsize::new(0);
    let work = || {
        let mut mine = Vec::new();
        loop {
            let job = next.fetch_add(1, Ordering::Relaxed);
            if job >= count {
                return mine;
            }
            let outcome = replay(plan, &cells[job / reaches.len()], reaches[job % reaches.len()]);
            progress(done.fetch_add(1, Ordering::Relaxed) + 1, count);
            mine.push((job, outcome));
        }
    };
    let cores = thread::available_parallelism().map_or(1, usize::from);
    let threads = if plan.threads == 0 { cores } else { plan.threads };
    let mut results: Vec<(usize, Result<Option<TrialOutcome>, EvaluationProblem>)> = thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        let joined = workers.into_iter().map(|worker| match worker.join() {
            Ok(mine) => mine,
            Err(panic) => std::panic::resume_unwind(panic),
        });
        joined.flatten().collect()
    });
    results.sort_by_key(|(job, _)| *job);
    let outcomes = results.into_iter().map(|(_, outcome)| outcome).collect::<Result<Vec<_>, _>>()?;
    let rows = rows(plan, &cells, &reaches, &outcomes);
    let simulated_secs = outcomes.iter().flatten().map(|outcome| outcome.simulated_secs).sum();
    Ok(Evaluation {
        schema: "covr.evaluation.v1",
        version: env!("CARGO_PKG_VERSION"),
        limits: limits_in_words(plan),
        wall_secs: 0.0,
        simulated_secs,
        rows,
    })
}

/// A rule, a number of objects and a prior.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Cell {
    rule: RuleChoice,
    objects: Objects,
    prior: Prior,
}

fn cells(plan: &Plan) -> Vec<Cell> {
    let mut cells = Vec::new();
    for &rule in &plan.rules {
        for &prior in &plan.priors {
            for &objects in &plan.objects {
                // With the goal alone, or told, a prior says nothing.
                let alone = objects == Objects::Count(1) || rule == RuleChoice::Told;
                if prior == Prior::None || !alone {
                    cells.push(Cell { rule, objects, prior });
                }
            }
        }
    }
    cells
}

/// One trial; none where the recording has no distractor to name wrongly.
fn replay(plan: &Plan, cell: &Cell, reach: &Reach) -> Result<Option<TrialOutcome>, EvaluationProblem> {
    let recording = &reach.recording;
    let objects = cell.objects.of(recording.targets.len());
    let targets = plan.draw.targets(recording, reach.goal, objects);
    let favoured = match cell.prior {
        Prior::None => None,
        Prior::Right => Some(reach.goal),
        Prior::Wrong => match plan.draw.first_distractor(recording, reach.goal, objects) {
            Some(distractor) => Some(distractor),
            None => return Ok(None),
        },
    };
    let others = targets.len().saturating_sub(1).max(1) as f64;
    let prior_of = |&index: &usize| match (cell.rule, favoured) {
        (RuleChoice::Told, _) => f64::from(u8::from(index == reach.goal)),
        (_, None) => 1.0,
        (_, Some(favoured)) if index == favoured => FAVOURED,
        (_, Some(_)) => (1.0 - FAVOURED) / others,
    };
    let priors: Vec<f64> = targets.iter().map(prior_of).collect();
    let trial = ReachTrial {
        recording,
        targets: &targets,
        priors: Some(&priors),
        rule: cell.rule.engine_rule(),
        v_h_mps: plan.v_h_mps,
        pose_hz: POSE_HZ,
        link: LinkProfile::PERFECT,
        seed: 1,
    };
    let size = recording.size_m();
    let travel = Travel { min: Floor::default(), max: Floor::default() + size };
    let mut machine: Box<dyn Simulated> = match plan.machine {
        MachineKind::Ideal => Box::new(IdealMachine::new(LIMITS, travel, travel.centre())),
        MachineKind::Simulated => Box::new(SimulatedMachine::new(MachineParameters::paper(travel))?),
    };
    let from = bring_to(machine.as_mut(), reach.column, Time::ZERO)
        .map_err(|problem| EvaluationProblem::Start { trial: recording.trial.clone(), problem })?;
    Ok(Some(trial.run(machine, from)?))
}

fn rows(plan: &Plan, cells: &[Cell], reaches: &[&Reach], outcomes: &[Option<TrialOutcome>]) -> Vec<Row> {
    let mut groups: Vec<(&str, &str)> = Vec::new();
    for reach in reaches {
        let group = (reach.file.as_str(), task(&reach.recording));
        if !groups.contains(&group) {
            groups.push(group);
        }
    }
    let mut rows = Vec::new();
    for (file, task_name) in groups {
        for (cell, outcomes) in cells.iter().zip(outcomes.chunks(reaches.len())) {
            let of_group: Vec<&TrialOutcome> = reaches
                .iter()
                .zip(outcomes)
                .filter(|(reach, _)| (reach.file.as_str(), task(&reach.recording)) == (file, task_name))
                .filter_map(|(_, outcome)| outcome.as_ref())
                .collect();
            if of_group.is_empty() {
                continue;
            }
            let key = RowKey {
                file: file.to_owned(),
                task: task_name.to_owned(),
                rule: cell.rule.name(),
                default: cell.rule == RuleChoice::Rule(plan.default_rule),
                prior: cell.prior.name(),
                draw: plan.draw.name(),
                objects: match cell.objects {
                    Objects::Count(count) => count,
                    Objects::All => 0,
                },
                v_h_mps: plan.v_h_mps,
            };
            rows.push(Row::of(key, &of_group));
        }
    }
    rows
}

/// The goal of the trial before of this person and task; for the first the arena's centre and a metre off.
fn column_start(before: &[Reach], recording: &Recording) -> Floor {
    let size = recording.size_m();
    let travel = Travel { min: Floor::default(), max: Floor::default() + size };
    let last = before
        .iter()
        .rev()
        .find(|reach| reach.recording.user == recording.user && reach.recording.mode == recording.mode);
    let place = last.map_or(travel.centre() + Planar::new(1.0, 1.0), |reach| {
        reach.recording.room_from_trace().point(&reach.recording.targets[reach.goal].position).floor()
    });
    travel.shrunk(TRAVEL_MARGIN_M).clamped(place)
}

fn limits_in_words(plan: &Plan) -> std::collections::BTreeMap<&'static str, f64> {
    let AxisLimits { speed_mps, acceleration_mps2, braking_mps2, jerk_mps3 } = LIMITS.x;
    [
        ("speed_mps", speed_mps),
        ("acceleration_mps2", acceleration_mps2),
        ("braking_mps2", braking_mps2),
        ("jerk_mps3", jerk_mps3),
        ("v_h_mps", plan.v_h_mps),
        ("pose_hz", POSE_HZ),
    ]
    .into()
}

fn task(recording: &Recording) -> &str {
    recording.mode.as_deref().unwrap_or("none")
}

/// The file's name up to its first dot.
fn stem(file: &Path) -> String {
    let name = file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    name.split('.').next().unwrap_or_default().to_owned()
}

/// The paper's machine.
const LIMITS: Limits = Limits::PAPER;
/// The paper's head tracking, Hz.
const POSE_HZ: f64 = 75.0;
/// The paper's prior on the goal.
const FAVOURED: f64 = 0.75;
/// Inside the engine's own margin to the travel limits, m.
const TRAVEL_MARGIN_M: f64 = 0.05;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::Draw;
    use covr_engine::intention::RuleName;
    use std::fmt::Write;

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
            objects: vec![Objects::Count(1), Objects::All],
            priors: Prior::ALL.to_vec(),
            tasks: Vec::new(),
            people: Vec::new(),
            draw: Draw::Hash,
            v_h_mps: 1.6,
            machine: MachineKind::Ideal,
            default_rule: RuleName::PaperBest,
            threads,
        }
    }

    #[test]
    fn the_table_is_the_same_for_any_number_of_threads() {
        let folder = tempfile::tempdir().unwrap();
        let subjects = subjects(folder.path());
        let one = evaluate(&subjects, &plan(1), &|_, _| ()).unwrap();
        assert_eq!(one, evaluate(&subjects, &plan(3), &|_, _| ()).unwrap());
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
}
