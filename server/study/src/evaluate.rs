//! The evaluation: recorded reaches through the whole loop on virtual time, for every rule and number of objects.
//!
//! A trial begins 2 s before the scene is hidden and ends at the reach. The column begins at rest at the goal of the
//! same person's trial before, in the order of the file; the first at the arena's centre and a metre off. Which
//! distractors are shown is decided by a hash, so that everybody draws alike. Results do not depend on the number of
//! threads: each trial has a place of its own, and is summed up in that order.

mod blame;
mod bounded;
mod course;
mod draw;
mod explain;
mod offsets;
mod plan;
mod reliability;
mod row;
mod rows;
mod run;
mod session;
mod subjects;
mod synthetic;
mod tables;

pub use blame::Cause;
pub use draw::Draw;
pub use explain::{Explanation, explain};
pub use plan::{
    Conditions, MachineKind, Objects, Plan, PlanProblem, Prior, RuleChoice, SeparationChoice, motion,
};
pub use reliability::{Bin, calibration_error};
pub use row::{Evaluation, LeftOut, Row, wilson};
pub use run::{EvaluationProblem, Progress, evaluate, evaluate_by_person, failures, sweep};
pub use subjects::Subjects;
pub use tables::{csv, goals, json, terminal};
