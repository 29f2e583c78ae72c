//! The safety room: the one place that can make a command for a machine.
//!
//! It never imports `intention`. It is small and plain on purpose.

pub mod contact;
pub mod governor;
pub mod parameters;
pub mod path;
pub mod separation;
pub mod supervisor;
pub mod vetted;
