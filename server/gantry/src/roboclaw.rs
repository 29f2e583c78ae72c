//! RoboClaw motor controllers over packet serial: the machine of the paper.
//!
//! ```text
//! control thread                      link thread                                    board
//! write ─▶ order ─────▶ position loop, homing ─▶ speed, acceleration, distance cap ─▶ velocity loop
//! read  ◀─ state ◀──── counts, speeds, currents, status ◀───────────────────────────── encoders
//! ```
//!
//! The control thread hands over its newest order and takes the newest state, and waits for nothing. The link thread
//! owns the port. A board is connected, then identified, then configured, each a type of its own; only a configured one
//! has a verb that moves. Three dead-men lie inside each other: an order that grows old is a hold, each motion carries the distance
//! after which the board brakes by itself, and the board's serial timeout stops it when nothing comes at all.
//!
//! - [`emulator`]: boards that are not there, for trying this driver and others; it shares no code with it.
//! - [`settings`]: what a machine is made of.

mod board;
mod driver;
pub mod emulator;
mod exchange;
mod firmware;
mod packet;
mod session;
pub mod settings;
#[cfg(test)]
mod tests;

use covr_engine::time::Time;

use crate::linked::link::NotBegun;
use crate::linked::machine::{Linked, Machine};
use crate::linked::port::Serial;
use session::Session;
use settings::Settings;

/// Start a machine of one or two boards (see [`Linked::start`]).
pub fn start(
    settings: Settings,
    clock: impl Fn() -> Time + Send + 'static,
    on_thread: impl FnOnce() + Send + 'static,
) -> std::io::Result<Linked> {
    let machine = Machine {
        name: "RoboClaw",
        limits: settings.limits,
        travel: settings.travel,
        parked: settings.parked,
        period: settings.period,
    };
    let open = move |stood_at| {
        let port = Serial::open(&settings.port, settings.baud).map_err(NotBegun::NoPort)?;
        Session::open(port, &settings, stood_at).map_err(NotBegun::Refused)
    };
    Linked::start(machine, open, clock, on_thread)
}
