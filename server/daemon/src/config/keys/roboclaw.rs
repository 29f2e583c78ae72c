//! The keys of the RoboClaw machine.

use std::ops::RangeInclusive;

use super::{Key, Place};
use crate::config::Config;

/// Every key of the section.
pub fn keys() -> Vec<Key> {
    vec![
        Key::new(
            "machine.roboclaw.emulated",
            "Whether the boards are those of covr emulate roboclaw, so that nothing moves: such a machine is armed without having been commissioned (covr commission). Never for real boards.",
            Place::Switch(|c| &mut c.machine.roboclaw.emulated),
        ),
        Key::new(
            "machine.roboclaw.port",
            "For machine.kind \"roboclaw\": the serial port, best by a udev rule's name, so that it is the same after unplugging.",
            Place::Path(|c| &mut c.machine.roboclaw.port),
        ),
        Key::new(
            "machine.roboclaw.baud",
            "Rate of the serial line, bits a second. A board on USB takes any.",
            Place::Whole(38_400..=460_800, |c| &mut c.machine.roboclaw.baud),
        ),
        Key::new(
            "machine.roboclaw.address",
            "Address of the board: 128 is 0x80. The long rail is its M1, the cross rail its M2.",
            Place::Whole(128..=135, |c| &mut c.machine.roboclaw.address),
        ),
        Key::new(
            "machine.roboclaw.second_address",
            "With a board for each rail on one line: the address of the cross rail's board; each rail is then its board's M1. 0: one board.",
            Place::Whole(0..=135, |c| &mut c.machine.roboclaw.second_address),
        ),
        Key::new(
            "machine.roboclaw.current_limit_amps",
            "Above this the board limits a motor's current, which counts as over-current (R5), A.",
            Place::Number(0.5..=30.0, |c| &mut c.machine.roboclaw.current_limit_amps),
        ),
        Key::new(
            "machine.roboclaw.homing_current_amps",
            "The same while homing, A: what it pushes with against a hard stop.",
            Place::Number(0.2..=30.0, |c| &mut c.machine.roboclaw.homing_current_amps),
        ),
        Key::new(
            "machine.roboclaw.serial_timeout_secs",
            "With no packet for this long the board stops both motors by itself, s; in steps of 0.1.",
            Place::Number(0.1..=1.0, |c| &mut c.machine.roboclaw.serial_timeout_secs),
        ),
        Key::new(
            "machine.roboclaw.period_secs",
            "Longest time from one look at the boards to the next, s. Each command of the control loop starts one, as often as the line allows.",
            Place::Number(0.002..=0.05, |c| &mut c.machine.roboclaw.period_secs),
        ),
        Key::new(
            "machine.roboclaw.position_gain_per_s",
            "Gain of the position loop about the board's velocity loop, 1/s.",
            Place::Number(0.5..=50.0, |c| &mut c.machine.roboclaw.position_gain_per_s),
        ),
        Key::new(
            "machine.roboclaw.home_by",
            "What homing looks for at the low end of each rail: switches (S4 of the long rail's motor, S5 of the cross rail's; with two boards each board's S4), or the hard stops.",
            Place::HomeBy(|c| &mut c.machine.roboclaw.home_by),
        ),
        Key::new(
            "machine.roboclaw.creep_mps",
            "Speed of homing, m/s.",
            Place::Number(0.01..=0.1, |c| &mut c.machine.roboclaw.homing.creep_mps),
        ),
        Key::new(
            "machine.roboclaw.approach_mps",
            "Speed of its last, measuring approach, m/s.",
            Place::Number(0.005..=0.05, |c| &mut c.machine.roboclaw.homing.approach_mps),
        ),
        Key::new(
            "machine.roboclaw.switch_outside_m",
            "How far outside the travel's low ends the switches trip, or the stops are met, m.",
            Place::Number(0.0..=0.5, |c| &mut c.machine.roboclaw.homing.switch_outside_m),
        ),
        Key::new(
            "machine.roboclaw.rest_inside_m",
            "How far inside the travel's corner it rests once homed, m.",
            Place::Number(0.02..=1.0, |c| &mut c.machine.roboclaw.homing.rest_inside_m),
        ),
        Key::new(
            "machine.roboclaw.x.counts_per_metre",
            "Encoder counts a metre of the long rail, after quadrature.",
            counts(|c| &mut c.machine.roboclaw.x.counts_per_metre),
        ),
        Key::new(
            "machine.roboclaw.x.reversed",
            "Counts fall where x rises.",
            Place::Switch(|c| &mut c.machine.roboclaw.x.reversed),
        ),
        Key::new(
            "machine.roboclaw.x.velocity_p",
            "Proportional gain of the board's velocity loop.",
            gain(|c| &mut c.machine.roboclaw.x.velocity[0]),
        ),
        Key::new(
            "machine.roboclaw.x.velocity_i",
            "Its integral gain.",
            gain(|c| &mut c.machine.roboclaw.x.velocity[1]),
        ),
        Key::new(
            "machine.roboclaw.x.velocity_d",
            "Its derivative gain.",
            gain(|c| &mut c.machine.roboclaw.x.velocity[2]),
        ),
        Key::new(
            "machine.roboclaw.x.velocity_qpps",
            "Its speed at full duty, counts a second; 0 leaves the whole loop as the board has it stored.",
            Place::Number(QPPS, |c| &mut c.machine.roboclaw.x.velocity[3]),
        ),
        Key::new(
            "machine.roboclaw.y.counts_per_metre",
            "Encoder counts a metre of the cross rail, after quadrature.",
            counts(|c| &mut c.machine.roboclaw.y.counts_per_metre),
        ),
        Key::new(
            "machine.roboclaw.y.reversed",
            "Counts fall where y rises.",
            Place::Switch(|c| &mut c.machine.roboclaw.y.reversed),
        ),
        Key::new(
            "machine.roboclaw.y.velocity_p",
            "Proportional gain of the board's velocity loop.",
            gain(|c| &mut c.machine.roboclaw.y.velocity[0]),
        ),
        Key::new(
            "machine.roboclaw.y.velocity_i",
            "Its integral gain.",
            gain(|c| &mut c.machine.roboclaw.y.velocity[1]),
        ),
        Key::new(
            "machine.roboclaw.y.velocity_d",
            "Its derivative gain.",
            gain(|c| &mut c.machine.roboclaw.y.velocity[2]),
        ),
        Key::new(
            "machine.roboclaw.y.velocity_qpps",
            "Its speed at full duty, counts a second; 0 leaves the whole loop as the board has it stored.",
            Place::Number(QPPS, |c| &mut c.machine.roboclaw.y.velocity[3]),
        ),
    ]
}

fn counts(place: fn(&mut Config) -> &mut f64) -> Place {
    Place::Number(100.0..=10_000_000.0, place)
}

fn gain(place: fn(&mut Config) -> &mut f64) -> Place {
    Place::Number(0.0..=1_000.0, place)
}

const QPPS: RangeInclusive<f64> = 0.0..=1_000_000_000.0;
