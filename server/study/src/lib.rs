//! covr-study: people, recorded and made up, against the engine and a simulated machine on virtual time.
//!
//! Pure but for the reading of trace files: no clock, no thread, no random source but [`random::Random`]'s seed.

pub mod bound;
pub mod checker;
pub mod evaluate;
pub mod fit;
mod parallel;
pub mod prove;
pub mod random;
pub mod replay;
pub mod report;
pub mod trace;
pub mod visitor;
pub mod workload;
