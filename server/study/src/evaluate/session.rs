//! Whole sessions of the plan: what is shown for each visit.

use covr_engine::frames::{Floor, Planar};
use covr_engine::intention::IntentionParameters;
use covr_engine::time::Time;

use super::course::{conduct, machine, pace, prior_of, seed};
use super::plan::{Plan, Prior, RuleChoice};
use super::row::Judged;
use super::run::{Cell, EvaluationProblem};
use super::subjects::{Session, TRAVEL_MARGIN_M, travel};
use crate::replay::{SessionReplay, TrialOutcome, VisitPlan, Walk};
use crate::trace::Recording;

/// A reach of a session, before it is known what is shown.
struct Slot {
    number: usize,
    shown_from: Time,
    reach: Time,
    goal: usize,
    valid: bool,
}

/// Every cell for a session: for each of its valid visits what became of it, none where there is no distractor to name
/// wrongly.
pub(super) fn visits_by_cell(
    plan: &Plan,
    intention: &IntentionParameters,
    cells: &[Cell],
    session: &Session,
) -> Result<Vec<Vec<Option<Judged>>>, EvaluationProblem> {
    let recording = &session.recording;
    let slots = slots(recording);
    let begins = recording.frames.first().map_or(Time::ZERO, |frame| frame.at);
    let ends = slots.last().map_or(begins, |slot| slot.reach);
    let walk = Walk::between(recording, begins, ends, &pace(plan, &plan.conditions, recording))?;
    let mut by_visit: Vec<Vec<Option<Judged>>> =
        slots.iter().filter(|slot| slot.valid).map(|_| Vec::with_capacity(cells.len())).collect();
    for cell in cells {
        if cell.rule == RuleChoice::Bound {
            by_visit.iter_mut().for_each(|of_visit| of_visit.push(None));
            continue;
        }
        let outcomes = replayed(plan, intention, cell, &walk, &slots)?;
        let valid = outcomes.into_iter().zip(&slots).filter(|(_, slot)| slot.valid);
        for (of_visit, (outcome, _)) in by_visit.iter_mut().zip(valid) {
            of_visit.push(outcome.map(|outcome| Judged { outcome, cause: None, not_excluded: None }));
        }
    }
    Ok(by_visit)
}

fn replayed(
    plan: &Plan,
    intention: &IntentionParameters,
    cell: &Cell,
    walk: &Walk<'_>,
    slots: &[Slot],
) -> Result<Vec<Option<TrialOutcome>>, EvaluationProblem> {
    let recording = walk.recording();
    let objects = cell.objects.of(recording.targets.len());
    let mut visits = Vec::with_capacity(slots.len());
    let mut says_something = Vec::with_capacity(slots.len());
    for slot in slots {
        let drawn_for = format!("{}/{}", recording.trial, slot.number);
        let targets = cell.draw.targets(recording, &drawn_for, slot.goal, objects);
        let distractor = cell.draw.first_distractor(recording, &drawn_for, slot.goal, objects);
        let favoured = match cell.prior {
            Prior::None => None,
            Prior::Right => Some(slot.goal),
            Prior::Wrong => distractor,
        };
        says_something.push(cell.prior != Prior::Wrong || distractor.is_some());
        let told = cell.rule == RuleChoice::Told;
        let priors = targets.iter().map(|&index| match told {
            true => f64::from(u8::from(index == slot.goal)),
            false => prior_of(index, favoured, targets.len()),
        });
        let priors = priors.collect();
        let Slot { shown_from, reach, goal, .. } = *slot;
        visits.push(VisitPlan { shown_from, reach, goal, targets, priors });
    }
    let replay = SessionReplay {
        walk,
        visits: &visits,
        conduct: conduct(plan, cell, intention),
        link: plan.conditions.link(),
        seed: seed(recording, "link"),
    };
    let travel = travel(recording);
    let corner = travel.centre() + Planar::new(1.0, 1.0);
    let column: Floor = travel.shrunk(TRAVEL_MARGIN_M).clamped(corner);
    let machine = machine(plan.machine, plan.conditions.limits(), travel, column)?;
    let outcomes = replay.run(machine)?;
    Ok(outcomes.into_iter().zip(says_something).map(|(outcome, says)| says.then_some(outcome)).collect())
}

/// The visits with a reach. One is shown from its preview; where there is none, from when the person left the goal
/// before.
fn slots(recording: &Recording) -> Vec<Slot> {
    let mut left = recording.frames.first().map_or(Time::ZERO, |frame| frame.at);
    let mut slots = Vec::new();
    for (number, visit) in recording.visits.iter().enumerate() {
        let Some(reach) = visit.moments.reach else { continue };
        let shown_from = visit.moments.preview_start.unwrap_or(left).max(left);
        // A session that begins at a goal has no way there.
        if reach - shown_from >= SHORTEST {
            slots.push(Slot { number, shown_from, reach, goal: visit.goal, valid: visit.valid });
        }
        left = visit.moments.leave.unwrap_or(reach).max(reach);
    }
    slots
}

/// A reach is watched for longer than this.
const SHORTEST: covr_engine::time::Span = covr_engine::time::Span::from_millis(1_000);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::Recordings;
    use std::io::Cursor;
    use std::path::Path;

    #[test]
    fn a_visit_is_shown_from_its_preview_or_from_when_the_goal_before_was_left() {
        let line = r#"{"dataset":"pearl","trial":"s","user":"1","arena":{"x":[0,4],"y":[0,4]},
            "targets":[{"id":"A","x":1,"y":1,"z":0,"r":0.3},{"id":"B","x":3,"y":1,"z":0,"r":0.3}],
            "visits":[{"goal":"A","t_reach":0.5,"t_leave":3.8},{"goal":"B","t_reach":7.0,"t_leave":9.0},{"goal":"A","preview_start":11.0,"reach":15.0}],
            "cols":["t_ms","x_mm","y_mm","z_mm","yaw_mrad","pitch_mrad"],"frames":[[0,2000,2000,19,0,0]]}"#;
        let line = line.replace('\n', " ");
        let read = Recordings::from_lines(Path::new("made"), Box::new(Cursor::new(line))).next().unwrap();
        let slots: Vec<_> = slots(&read.unwrap())
            .into_iter()
            .map(|slot| (slot.number, slot.shown_from.secs(), slot.reach.secs()))
            .collect();
        assert_eq!(slots, [(1, 3.8, 7.0), (2, 11.0, 15.0)]);
    }
}
