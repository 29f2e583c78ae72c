//! What every emulator here stands on: the simulated motors behind a controller, the line in front of it, and chance.
//!
//! Nothing of a protocol is here, and nothing of a driver.

pub(crate) mod line;
pub(crate) mod random;
pub(crate) mod rig;
pub mod words;

use std::str::FromStr;

use covr_engine::time::Time;

use words::BadOrder;

/// An axis of the machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// The long rail.
    X,
    /// The cross rail.
    Y,
}

impl Axis {
    /// Both.
    pub const BOTH: [Self; 2] = [Self::X, Self::Y];

    pub(crate) const fn index(self) -> usize {
        match self {
            Self::X => 0,
            Self::Y => 1,
        }
    }
}

/// What is true of an axis, whatever its controller believes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisTruth {
    /// Where the column is along it, room frame, m.
    pub position_m: f64,
    /// m/s.
    pub speed_mps: f64,
    /// In the winding, signed, A.
    pub amps: f64,
    /// What the encoder has counted since the emulator began.
    pub counts: i64,
    /// Its end switch is active.
    pub is_switch_active: bool,
}

/// What went over the line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Traffic {
    /// Bytes that reached the controller.
    pub bytes_in: u64,
    /// Bytes that it sent.
    pub bytes_out: u64,
    /// Commands for it that were whole and right.
    pub packets: u64,
    /// Times that it started.
    pub starts: u64,
}

/// A controller that is not there, as a pure machine on a given clock: bytes in, bytes out.
pub trait Emulated {
    /// What can be made to go wrong.
    type Order: FromStr<Err = BadOrder>;

    /// Bytes that the host begins to send at `now`.
    fn receive(&mut self, now: Time, bytes: &[u8]);

    /// Bytes that have reached the host by `now`.
    fn poll(&mut self, now: Time) -> Vec<u8>;

    /// When there is something to do next, if anything: a byte arrives, either way.
    fn next_due(&self) -> Option<Time>;

    /// Bytes that the host has sent and that have not arrived yet. A host that overfills its line waits.
    fn backlog(&self) -> usize;

    /// From now on, or once.
    fn give(&mut self, now: Time, order: Self::Order);

    /// The cable is out: what is on the line is lost.
    fn unplug(&mut self, now: Time);

    /// What is true of an axis now.
    fn truth(&self, axis: Axis) -> AxisTruth;

    /// What went over the line until now.
    fn traffic(&self) -> Traffic;

    /// What else is so or not, by name.
    fn flags(&self) -> Vec<(&'static str, bool)>;
}
