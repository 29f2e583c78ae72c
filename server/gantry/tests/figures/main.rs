//! The simulated machine against the paper's figures, and against what safety counts on.

#![allow(clippy::unwrap_used, reason = "helpers of tests are outside #[test] functions")]

mod course;
mod deadman;
mod faults;
mod homing;
mod reference;
mod robustness;
mod tracking;
