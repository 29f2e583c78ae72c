//! What every machine offers: the control thread reads, updates the engine, writes; once a period.

use std::sync::Arc;

use crate::sim::faults::Faults;
use covr_engine::frames::{Floor, Planar};
use covr_engine::machine::{Limits, MachineReport, Travel, Trouble};
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

    /// When the newest command was vetted that the machine has confirmed. A machine behind a slow link confirms later than
    /// `write` returns; a stop is acknowledged by this.
    fn taken(&self) -> Time;

    /// What is known of boards and link beyond the report; none for a machine without any.
    fn health(&self) -> Option<Arc<Health>> {
        None
    }

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

/// What a machine says of its boards and its link, for people to look at.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Health {
    /// The firmware's own words.
    pub firmware: Option<String>,
    /// By which known firmware it is driven.
    pub profile: Option<String>,
    /// Why it cannot be driven now.
    pub trouble: Option<Trouble>,
    /// The same in the driver's words; empty when nothing is wrong.
    pub condition: String,
    /// Supply, V.
    pub supply_volts: Option<f64>,
    /// Board temperature, degrees Celsius.
    pub temperature_c: Option<f64>,
    /// The link.
    pub link: LinkFigures,
}

/// What a link has been like.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LinkFigures {
    /// Whole cycles (a command and a look) a second, over the last half second.
    pub rate_hz: f64,
    /// Median of a cycle's time over the same, us.
    pub cycle_p50_micros: f64,
    /// Its 99th percentile, us.
    pub cycle_p99_micros: f64,
    /// Its greatest, us.
    pub cycle_max_micros: f64,
    /// Exchanges that were answered.
    pub exchanges: u64,
    /// Exchanges that were not, or not well.
    pub lost: u64,
    /// Of these, sent again.
    pub repeated: u64,
    /// Whole cycles.
    pub cycles: u64,
    /// Bytes that they took, either way.
    pub bytes: u64,
    /// Cycles without a whole look.
    pub cycles_lost: u64,
    /// How the last of them was lost; empty for none.
    pub last_loss: String,
    /// How often the boards were found.
    pub connections: u64,
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
