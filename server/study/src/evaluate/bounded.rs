//! The rule `bound`: not a rule of the engine, but the search for any motion at all that would have served the reach.

use super::course::Course;
use super::plan::{Plan, RuleChoice, SeparationChoice};
use super::row::{Judged, LeftOut};
use super::run::{EvaluationProblem, Job};
use super::subjects::travel;
use crate::bound::{Bound, Question, bound};
use crate::replay::{BeliefTold, TrialOutcome, TrialProblem};

/// Refuse what the limit is not defined for.
pub(super) fn check(plan: &Plan, only_sessions: bool) -> Result<(), EvaluationProblem> {
    if !plan.rules.contains(&RuleChoice::Bound) {
        return Ok(());
    }
    if plan.separations.contains(&SeparationChoice::Off) {
        let (found, expected) = ("separation off", "on: it is the limit of what the separation rule allows");
        return Err(EvaluationProblem::Bound { found, expected });
    }
    if only_sessions && plan.rules.iter().all(|rule| *rule == RuleChoice::Bound) {
        let (found, expected) =
            ("whole sessions alone", "recorded reaches: it is the limit of a column that begins at rest");
        return Err(EvaluationProblem::Bound { found, expected });
    }
    Ok(())
}

/// Sessions beside reaches have no row of it, which is said.
pub(super) fn left_out(plan: &Plan, jobs: &[Job<'_>]) -> Vec<LeftOut> {
    let mut left_out: Vec<LeftOut> = Vec::new();
    if !plan.rules.contains(&RuleChoice::Bound) {
        return left_out;
    }
    for job in jobs {
        let Job::Session(session) = job else { continue };
        match left_out.iter_mut().find(|out| out.file == session.file) {
            Some(out) => out.recordings += 1,
            None => {
                let (file, because) = (session.file.clone(), "rule bound: it is of reaches, not of sessions");
                left_out.push(LeftOut { file, recordings: 1, because });
            }
        }
    }
    left_out
}

/// Whether the reach could have been served. Delay, loss and noise of poses are nothing to somebody who knows the walk.
pub(super) fn judged(course: &Course<'_>) -> Result<Judged, EvaluationProblem> {
    let (recording, walk) = (&course.reach.recording, course.walk);
    let targets = course.targets();
    let scene = recording.scene(&targets);
    let scene = scene.map_err(|problems| TrialProblem::Scene { trial: recording.trial.clone(), problems })?;
    let goal = targets.iter().position(|target| *target == course.reach.goal);
    let goal = goal.ok_or_else(|| TrialProblem::GoalNotShown(recording.trial.clone()))?;
    let place = scene.objects()[goal].column_place();
    let found = bound(&Question {
        recording,
        scene: &scene,
        place,
        start: course.reach.column,
        begins: walk.begins(),
        reach: walk.ends(),
        limits: course.limits,
        travel: travel(recording),
        v_h_mps: course.plan.v_h_mps,
    })?;
    let secs = (walk.ends() - walk.begins()).secs();
    let known = BeliefTold { detected_before_reach_secs: Some(secs), ..BeliefTold::default() };
    let from_start = course.reach.column.distance_m(place);
    let at_start = TrialOutcome { belief: known, ..TrialOutcome::nowhere(from_start, secs) };
    let not_excluded = Some(found != Bound::Impossible);
    let outcome = match found {
        Bound::Possible(driven) => TrialOutcome {
            success: true,
            within_10cm: true,
            distance_at_reach_m: driven.distance_at_reach_m,
            in_place_before_reach_secs: driven.in_place_before_reach_secs,
            column_travel_m: driven.column_travel_m,
            peaks: driven.peaks,
            true_verdict: driven.verdict,
            ..at_start
        },
        Bound::Undecided | Bound::Impossible => at_start,
    };
    Ok(Judged { outcome, cause: None, not_excluded })
}
