//! An ODrive on USB: a motor controller that people who build their own gantries have, for brushless motors.
//!
//! It speaks lines of text (the maker's "ASCII protocol", firmware 0.5.4 to 0.5.6). The link thread, and what is decided between
//! two looks, are shared with every other machine behind a line ([`crate::linked`]). What is the board's own:
//!
//! - It has no command that ends by itself but a trajectory to a place. So each command is the place at which the column rests when its
//!   cap is through and it brakes ([`goal`]): told nothing more, the board brakes along that trajectory and holds.
//! - Its watchdog lets the motors go, and the column coasts. So it is the last resort, and longer than any brake ([`settings`]).
//! - Whatever else lets a motor go by itself (any of its errors) leaves the column to its friction, or to a brake that engages without
//!   power: the board can drive one (`mechanical_brake`), and a machine that people walk beside needs one.
//! - It does not answer what moves or sets: what it was told is read back in the same exchange ([`line`]).
//! - An end switch that it can be asked for also cuts its motor, so it homes on the hard stops.

mod board;
pub mod emulator;
mod firmware;
mod goal;
mod line;
mod session;
pub mod settings;
#[cfg(test)]
mod tests;

use std::io;

use covr_engine::time::Time;

use crate::linked::link::NotBegun;
use crate::linked::machine::{Linked, Machine};
use crate::linked::port::Serial;
use session::Session;
use settings::Settings;

/// Start a machine of one board (see [`Linked`]). Settings with which the column could coast are refused.
pub fn start(
    settings: Settings,
    clock: impl Fn() -> Time + Send + 'static,
    on_thread: impl FnOnce() + Send + 'static,
) -> io::Result<Linked> {
    settings.check().map_err(|refused| io::Error::new(io::ErrorKind::InvalidInput, refused))?;
    let machine = Machine {
        name: "ODrive",
        limits: settings.limits,
        travel: settings.travel,
        parked: settings.parked,
        period: settings.period,
    };
    let open = move |stood_at| {
        let port = Serial::open(&settings.port, ANY_RATE).map_err(NotBegun::NoPort)?;
        Session::open(port, &settings, stood_at).map_err(NotBegun::Refused)
    };
    Linked::start(machine, open, clock, on_thread)
}

/// On USB the rate means nothing; a port has to be opened at some.
const ANY_RATE: u32 = 115_200;
