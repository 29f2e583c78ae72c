//! The evaluation: recorded reaches through the whole loop on virtual time, for every rule and number of objects.
//!
//! A trial begins 2 s before the scene is hidden and ends at the reach. The column begins at rest at the goal of the
//! same person's trial before, in the order of the file; the first at the arena's centre and a metre off. Which
//! distractors are shown is decided by a hash, so that everybody draws alike. Results do not depend on the number of
//! threads: each trial has a place of its own, and is summed up in that order.

mod draw;
mod plan;
mod row;
mod run;
mod tables;

pub use draw::Draw;
pub use plan::{MachineKind, Objects, Plan, PlanProblem, Prior, RuleChoice};
pub use row::{Evaluation, Row};
pub use run::{EvaluationProblem, Progress, Subjects, evaluate};
pub use tables::{csv, json, terminal};
