//! The contract with a machine, and the machines behind it.
//!
//! Encoder counts live here and nowhere else: what goes out is in the room frame (once homed) and in SI units.
//! Nothing here decides about motion; a machine takes [`Vetted`](covr_engine::safety::vetted::Vetted) commands
//! and nothing else, and brakes to rest by itself when they stop coming.
//!
//! - [`contract`]: what every machine offers: read, update, write.
//! - [`sim`]: a simulated gantry with motors, friction, encoders, a velocity controller, and faults to switch on.
//! - [`emulation`]: what every emulated controller stands on.
//! - [`linked`]: what every machine behind a line shares.
//! - [`odrive`]: an ODrive on USB.
//! - [`roboclaw`]: one or two RoboClaw controllers on a serial line.
//! - [`identify`]: inertia, friction and delays of an axis from a recorded run.
//! - [`ideal`]: a machine that does exactly what it is told, for sweeps over rules rather than machines.

pub mod contract;
mod deviation;
pub mod emulation;
pub mod homing;
pub mod ideal;
pub mod identify;
pub mod linked;
pub mod odrive;
pub mod roboclaw;
mod settle;
pub mod sim;
