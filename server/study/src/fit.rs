//! Fitting: the parameters of an intention rule are swept or optimised over recorded people, and judged on others.
//!
//! An [`Objective`] gives every person a loss for some parameters. What is fitted to some people is judged on those left
//! out ([`folds`]): the figure on people that nothing was fitted to is the one to believe. Everything is deterministic;
//! results do not depend on the number of threads.

mod belief;
mod file;
mod folds;
mod parameters;
mod search;
mod success;

pub use belief::BeliefLoss;
pub use file::{FileProblem, Fitted, FittedOn, ParameterFile};
pub use folds::{Fit, Fold, Loss, Objective, Start, Tally, fit, sweep};
pub use parameters::{PARAMETERS, Parameter, Scale, of_rule};
pub use success::FailureLoss;
