//! The keys of the ODrive machine.

use super::{Key, Place};
use crate::config::Config;

/// Every key of the section.
pub fn keys() -> Vec<Key> {
    vec![
        Key::new(
            "machine.odrive.emulated",
            "Whether the board is that of covr emulate odrive, so that nothing moves: such a machine is armed without having been commissioned (covr commission). Never for a real board.",
            Place::Switch(|c| &mut c.machine.odrive.emulated),
        ),
        Key::new(
            "machine.odrive.port",
            "For machine.kind \"odrive\": the board's serial port on USB, best by a udev rule's name, so that it is the same after unplugging. The long rail is its axis0, the cross rail its axis1.",
            Place::Path(|c| &mut c.machine.odrive.port),
        ),
        Key::new(
            "machine.odrive.current_limit_amps",
            "Above this the board limits a motor's current, which counts as over-current (R5), A.",
            Place::Number(0.5..=60.0, |c| &mut c.machine.odrive.current_limit_amps),
        ),
        Key::new(
            "machine.odrive.homing_current_amps",
            "The same while homing, A: what it pushes with against a hard stop.",
            Place::Number(0.2..=60.0, |c| &mut c.machine.odrive.homing_current_amps),
        ),
        Key::new(
            "machine.odrive.watchdog_timeout_secs",
            "With no command for this long the board lets both motors go, and the column coasts, s. So it is refused unless it is longer than the brake from the greatest speed, and 0.2 s.",
            Place::Number(0.2..=10.0, |c| &mut c.machine.odrive.watchdog_timeout_secs),
        ),
        Key::new(
            "machine.odrive.period_secs",
            "Longest time from one look at the board to the next, s. Each command of the control loop starts one, as often as the line allows.",
            Place::Number(0.002..=0.05, |c| &mut c.machine.odrive.period_secs),
        ),
        Key::new(
            "machine.odrive.position_gain_per_s",
            "Gain of the position loop about the board's own loops, 1/s.",
            Place::Number(0.5..=50.0, |c| &mut c.machine.odrive.position_gain_per_s),
        ),
        Key::new(
            "machine.odrive.creep_mps",
            "Speed of homing, m/s. It homes onto the hard stops at the low end of each rail.",
            Place::Number(0.01..=0.1, |c| &mut c.machine.odrive.homing.creep_mps),
        ),
        Key::new(
            "machine.odrive.approach_mps",
            "Speed of its last, measuring approach, m/s.",
            Place::Number(0.005..=0.05, |c| &mut c.machine.odrive.homing.approach_mps),
        ),
        Key::new(
            "machine.odrive.stop_outside_m",
            "How far outside the travel's low ends the hard stops are met, m.",
            Place::Number(0.0..=0.5, |c| &mut c.machine.odrive.homing.switch_outside_m),
        ),
        Key::new(
            "machine.odrive.rest_inside_m",
            "How far inside the travel's corner it rests once homed, m.",
            Place::Number(0.02..=1.0, |c| &mut c.machine.odrive.homing.rest_inside_m),
        ),
        Key::new(
            "machine.odrive.x.turns_per_metre",
            "Turns of the encoder a metre of the long rail.",
            turns(|c| &mut c.machine.odrive.x.turns_per_metre),
        ),
        Key::new(
            "machine.odrive.x.reversed",
            "Turns fall where x rises.",
            Place::Switch(|c| &mut c.machine.odrive.x.reversed),
        ),
        Key::new(
            "machine.odrive.y.turns_per_metre",
            "Turns of the encoder a metre of the cross rail.",
            turns(|c| &mut c.machine.odrive.y.turns_per_metre),
        ),
        Key::new(
            "machine.odrive.y.reversed",
            "Turns fall where y rises.",
            Place::Switch(|c| &mut c.machine.odrive.y.reversed),
        ),
    ]
}

fn turns(place: fn(&mut Config) -> &mut f64) -> Place {
    Place::Number(0.1..=1_000.0, place)
}
