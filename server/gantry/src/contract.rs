//! What every machine offers: the control thread reads, updates the engine, writes; once a period.

use crate::sim::faults::Faults;
use covr_engine::frames::{Floor, Planar};
use covr_engine::machine::{Limits, MachineReport, Travel};
use covr_engine::safety::vetted::Vetted;
use covr_engine::time::{Span, Time};

/// A two-axis gantry.
///
/// Neither verb blocks beyond the deadline of its link, and neither panics. A machine that hears no newer command
/// brakes to rest by itself: after `valid_for` of the last setpoint, and after its own serial timeout whatever the
/// last command was.
pub trait Gantry: Send {
    /// What the machine says at `now`.
    ///
    /// Without an answer the report is the last good one, its `answered_at` as old as it is (R8 watches that age),
    /// and `link` says why.
    fn read(&mut self, now: Time) -> Reading;

    /// Tell the machine what to do from `now` on. An error means that the machine did not take the command: what it
    /// does next is what its own dead-man does.
    fn write(&mut self, now: Time, command: &Vetted) -> Result<(), NotTaken>;

    /// What people call this machine.
    fn name(&self) -> &str;

    /// Where the column's centre can stand, room frame.
    fn travel(&self) -> Travel;

    /// What each axis may do.
    fn limits(&self) -> Limits;
}

/// A machine that knows what is true of it, apart from what it reports. For checkers and tests.
pub trait Simulated: Gantry {
    /// The true state at the last moment that it was read or written.
    fn truth(&self) -> Truth;

    /// What is wrong with it from now on. A machine that cannot break takes no notice.
    fn set_faults(&mut self, _faults: Faults) {}
}

/// One reading.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// The last good report; its `answered_at` tells its age.
    pub report: MachineReport,
    /// Whether this very reading was answered.
    pub link: Result<(), LinkError>,
}

/// The true state of a simulated machine, room frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Truth {
    /// The column's centre.
    pub position: Floor,
    /// Its velocity, m/s.
    pub velocity: Planar,
    /// Winding currents x, y; signed, A.
    pub current_amps: [f64; 2],
}

/// The machine did not answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum LinkError {
    /// Nothing came back within the deadline.
    #[error("no answer from the machine for {} ms", .for_span.micros() / 1_000)]
    Silent {
        /// Since the last good answer.
        for_span: Span,
    },
}

/// Why the machine did not take a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum NotTaken {
    /// The link is down.
    #[error(transparent)]
    Link(#[from] LinkError),
    /// A setpoint before homing: positions mean nothing yet. The machine brakes and holds instead.
    #[error("a setpoint was sent before the machine was homed")]
    NotHomed,
    /// A setpoint with an infinite or undefined number. The machine brakes and holds instead.
    #[error("a setpoint was not finite")]
    NotFinite,
}
