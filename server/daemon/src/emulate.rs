//! `covr emulate`: motor controllers that are not there, on a pseudo-terminal.
//!
//! They are [`covr_gantry::roboclaw::emulator`] and [`covr_gantry::odrive::emulator`]; here is their clock, their port and the orders on standard input.

mod odrive;
mod options;
mod port;
mod session;

use clap::{Args, Subcommand};
use covr_gantry::{odrive as odrive_board, roboclaw};

use session::Start;

pub use odrive::Odrive;
pub use options::Roboclaw;

/// Emulate hardware, for trying a driver without any.
#[derive(Debug, Clone, Args)]
pub struct EmulateCommand {
    /// What to emulate.
    #[command(subcommand)]
    pub what: Emulated,
}

/// What can be emulated.
#[derive(Debug, Clone, Subcommand)]
pub enum Emulated {
    /// RoboClaw boards in front of the simulated motors; prints `roboclaw emulator on PATH` and runs until SIGINT or SIGTERM.
    Roboclaw(Box<Roboclaw>),
    /// An ODrive in front of the simulated motors; prints `odrive emulator on PATH` and runs until SIGINT or SIGTERM.
    Odrive(Box<Odrive>),
}

/// Until it is told to end by a signal.
pub fn run(command: &EmulateCommand) -> anyhow::Result<()> {
    match &command.what {
        Emulated::Roboclaw(options) => session::run(Start {
            name: "roboclaw",
            emulator: roboclaw::emulator::Emulator::new(options.setup())?,
            orders: options.orders().collect(),
            link: options.link.as_deref(),
        }),
        Emulated::Odrive(options) => session::run(Start {
            name: "odrive",
            emulator: odrive_board::emulator::Emulator::new(options.setup())?,
            orders: options.order.clone(),
            link: options.link.as_deref(),
        }),
    }
}
