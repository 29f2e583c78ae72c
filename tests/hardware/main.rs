//! What any machine must do, whatever it is made of: the contract of `covr_gantry::contract`, checked step by step.
//!
//! A machine of your own: implement [`Bench`] for it (how time passes, how its link is cut and its power), add a test below, and run
//! `cargo nextest run -p covr-tests --test hardware`. The steps are `suite::STEPS`, in their order; a failure names the step.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the report")]

mod bench;
mod suite;

use bench::{Ideal, SimulatedBench};
use covr_tests::boards::Boards;
use suite::conforms;

#[test]
fn the_simulated_machine_conforms() {
    conforms(&mut SimulatedBench::new());
}

#[test]
fn the_ideal_machine_conforms() {
    conforms(&mut Ideal::new());
}

#[test]
fn one_roboclaw_over_a_pseudo_terminal_conforms() {
    conforms(&mut Boards::emulated(&["--firmware", "4.3.6"], 460_800, 0));
}

#[test]
fn two_roboclaws_of_an_older_firmware_conform() {
    conforms(&mut Boards::emulated(&["--firmware", "older", "--boards", "2"], 460_800, 0x81));
}

#[test]
fn an_odrive_over_a_pseudo_terminal_conforms() {
    conforms(&mut Boards::odrive(&[]));
}
