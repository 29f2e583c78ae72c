//! What every machine behind a line shares, whatever its controller speaks.
//!
//! ```text
//! control thread                      link thread                                     controller
//! write ─▶ order ─────▶ axes: position loop, homing ─▶ a speed and a cap for each axis ─▶ its own loops
//! read  ◀─ state ◀──── axes: place, speed, current, trouble ◀───────────────────────────── encoders
//! ```
//!
//! The control thread hands over its newest order and takes the newest state, and waits for nothing. The link thread owns the port.
//! Here is all that does not depend on the words that go over the line; [`Session`](link::Session) is where those begin. Nothing here
//! knows counts or turns: what goes to a controller and comes from it is in metres along the axes.
//!
//! - [`machine`]: the machine as the control thread sees it.
//! - [`link`]: the thread; it opens the port, drives, loses and opens anew.
//! - [`axes`]: what is known and decided between two looks.
//! - [`follow`], [`contact`]: a speed from a setpoint; a hard stop as a switch.
//! - [`port`], [`figures`]: the line, and what is shown of it.

pub(crate) mod axes;
#[cfg(test)]
pub(crate) mod bench;
pub(crate) mod contact;
pub(crate) mod figures;
pub(crate) mod follow;
pub(crate) mod link;
pub mod machine;
pub(crate) mod port;
