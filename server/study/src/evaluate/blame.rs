//! Why a trial failed: it is replayed with one thing made right at a time, and the first that saves it is the cause.

use covr_engine::machine::{AxisLimits, Limits};
use covr_engine::time::Span;

use super::course::Course;
use super::plan::{MachineKind, RuleChoice, SeparationChoice};
use super::row::Judged;
use super::run::EvaluationProblem;
use crate::replay::TrialOutcome;

/// Why a column was not there.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Cause {
    /// Poses were missing for longer than they may be old, or came late, lost or noisy, and as they were recorded the
    /// trial succeeds.
    Tracking,
    /// Told the goal from the beginning it succeeds; told it when the rule came to believe in it, it does not.
    Prediction,
    /// Told the goal when the rule came to believe in it for good, it succeeds: the column went or waited elsewhere.
    StandingPlace,
    /// Told the goal from the beginning it fails, and succeeds without the separation rule: the way round the person.
    Route,
    /// Told, and even without the separation rule it fails; with a machine that accelerates at once it succeeds.
    Acceleration,
    /// None of these saves it alone.
    OutOfReach,
}

impl Cause {
    /// Every cause, in the order in which they are tried.
    pub const ALL: [Self; 6] = [
        Self::Tracking,
        Self::Prediction,
        Self::StandingPlace,
        Self::Route,
        Self::Acceleration,
        Self::OutOfReach,
    ];

    /// Its name in tables and JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Tracking => "tracking",
            Self::Prediction => "prediction",
            Self::StandingPlace => "standing_place",
            Self::Route => "route",
            Self::Acceleration => "acceleration",
            Self::OutOfReach => "out_of_reach",
        }
    }

    /// In a sentence.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Tracking => {
                "tracking: with poses as they were recorded, all of them and in time, it is there"
            }
            Self::Prediction => "prediction: told the goal from the beginning, the column is there",
            Self::StandingPlace => {
                "standing place: the rule believed in the goal early enough, but the column waited or went elsewhere"
            }
            Self::Route => {
                "route: even told the goal it is late, and it is there without the separation rule"
            }
            Self::Acceleration => "acceleration: a machine that accelerates at once is there",
            Self::OutOfReach => {
                "out of reach: neither the goal, nor no separation rule, nor any acceleration saves it"
            }
        }
    }
}

/// The trial, and its cause if it failed.
pub(super) fn judged(course: &Course<'_>, outcome: TrialOutcome) -> Result<Judged, EvaluationProblem> {
    let cause = if outcome.success { None } else { Some(cause(course, &outcome)?) };
    Ok(Judged { outcome, cause, not_excluded: None })
}

fn cause(course: &Course<'_>, outcome: &TrialOutcome) -> Result<Cause, EvaluationProblem> {
    if outcome.stops > 0 && course.walk.longest_gap() > POSE_AGE {
        return Ok(Cause::Tracking);
    }
    if let Some(recorded) = course.as_recorded()?
        && recorded.success
    {
        return Ok(Cause::Tracking);
    }
    let begins = course.walk.begins();
    let is_told = course.cell.rule == RuleChoice::Told;
    let mut told = Course { told_from: Some(begins), ..*course };
    told.cell.rule = RuleChoice::Told;
    if !is_told && told.replayed()?.success {
        let detected = outcome.belief.detected_before_reach_secs;
        let in_time = detected.map(|secs| course.walk.ends() - Span::from_secs(secs));
        let saved = match in_time {
            Some(from) => Course { told_from: Some(from), ..*course }.replayed()?.success,
            None => false,
        };
        return Ok(if saved { Cause::StandingPlace } else { Cause::Prediction });
    }
    let mut apart = told;
    apart.cell.separation = SeparationChoice::Off;
    if course.cell.separation == SeparationChoice::On && apart.replayed()?.success {
        return Ok(Cause::Route);
    }
    let swift = Course { limits: AT_ONCE, machine: MachineKind::Ideal, ..told };
    Ok(if swift.replayed()?.success { Cause::Acceleration } else { Cause::OutOfReach })
}

/// R2: poses may be this old.
const POSE_AGE: Span = Span::from_millis(500);
/// The paper's speed, reached and left within a period.
const AT_ONCE: Limits = Limits { x: AT_ONCE_AXIS, y: AT_ONCE_AXIS };
const AT_ONCE_AXIS: AxisLimits = AxisLimits {
    acceleration_mps2: 100.0,
    braking_mps2: 100.0,
    jerk_mps3: 1e5,
    speed_mps: AxisLimits::PAPER.speed_mps,
};
