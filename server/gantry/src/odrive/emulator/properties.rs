//! The properties that can be read and set by name: those of the board's tree that concern driving a gantry.
//!
//! An answer has nine characters at most, as the board's own buffer for one.

use super::Board;
use super::axis::{Axis, State};
use super::text::leading_number;

/// A property's place in the board: how it is read, and set if it can be.
enum Property<'a> {
    Float(&'a mut f32),
    Switch(&'a mut bool),
    Whole(&'a mut i32),
    Told(String),
}

/// The answer to `r NAME`.
pub fn read(board: &mut Board, name: &str) -> String {
    let text = match find(board, name) {
        None => return "invalid property".into(),
        Some(Property::Float(value)) => format!("{value:.6}"),
        Some(Property::Switch(value)) => u8::from(*value).to_string(),
        Some(Property::Whole(value)) => value.to_string(),
        Some(Property::Told(text)) => text,
    };
    text.chars().take(MOST_CHARACTERS).collect()
}

/// `w NAME VALUE`; what it answers, if anything.
pub fn write(board: &mut Board, name: &str, value: &str) -> Option<String> {
    let Some(number) = leading_number(value) else { return Some("not implemented".into()) };
    if let Some((axis, rest)) = of_axis(name) {
        let axis = &mut board.axes[axis];
        match rest {
            "requested_state" => {
                match number as i32 {
                    1 => axis.request(State::Idle),
                    8 => axis.request(State::ClosedLoop),
                    // Others calibrate and search, which this one does not.
                    _ => return Some("not implemented".into()),
                }
                return None;
            }
            "config.watchdog_timeout" => {
                axis.config.watchdog_timeout = number;
                axis.feed_watchdog();
                return None;
            }
            _ => {}
        }
    }
    if name == "test_property" {
        board.test_property =
            value.chars().take_while(char::is_ascii_digit).collect::<String>().parse().unwrap_or(0);
        return None;
    }
    match find(board, name) {
        None => return Some("invalid property".into()),
        Some(Property::Float(place)) => *place = number,
        Some(Property::Switch(place)) => *place = number != 0.0,
        Some(Property::Whole(place)) => *place = number as i32,
        Some(Property::Told(_)) => return Some("not implemented".into()),
    }
    None
}

fn find<'a>(board: &'a mut Board, name: &str) -> Option<Property<'a>> {
    let [major, minor, revision] = board.firmware.parts();
    let told = |text: String| Some(Property::Told(text));
    match name {
        "fw_version_major" => return told(major.to_string()),
        "fw_version_minor" => return told(minor.to_string()),
        "fw_version_revision" => return told(revision.to_string()),
        "hw_version_major" => return told("3".into()),
        "hw_version_minor" => return told("6".into()),
        "hw_version_variant" => return told("56".into()),
        "vbus_voltage" => return told(format!("{:.6}", board.supply_volts)),
        "error" => return told(board.error.to_string()),
        "test_property" => return told(board.test_property.to_string()),
        "system_stats.uptime" => return told(board.uptime_millis.to_string()),
        _ => {}
    }
    let temperature = board.temperature_c;
    let (axis, rest) = of_axis(name)?;
    let axis = &mut board.axes[axis];
    let Axis { config, .. } = axis;
    Some(match rest {
        "current_state" => Property::Told(if axis.state == State::Idle { "1" } else { "8" }.into()),
        "requested_state" => Property::Told("0".into()),
        "error" => Property::Told(axis.error.to_string()),
        "motor.is_calibrated" | "encoder.is_ready" => {
            Property::Told(u8::from(axis.is_calibrated).to_string())
        }
        "motor.current_control.Iq_measured" => Property::Told(format!("{:.6}", axis.iq_measured)),
        "motor.fet_thermistor.temperature" => Property::Told(format!("{temperature:.6}")),
        "motor.fet_thermistor.config.temp_limit_upper" => Property::Float(&mut config.temp_limit_upper),
        "motor.config.current_lim" => Property::Float(&mut config.current_lim),
        "motor.config.torque_constant" => Property::Float(&mut config.torque_constant),
        "encoder.pos_estimate" => Property::Told(format!("{:.6}", axis.pos_estimate)),
        "encoder.vel_estimate" => Property::Told(format!("{:.6}", axis.vel_estimate)),
        "controller.input_pos" => Property::Float(&mut axis.input_pos),
        "controller.input_vel" => Property::Float(&mut axis.input_vel),
        "controller.input_torque" => Property::Float(&mut axis.input_torque),
        "controller.pos_setpoint" => Property::Told(format!("{:.6}", axis.pos_setpoint)),
        "controller.vel_setpoint" => Property::Told(format!("{:.6}", axis.vel_setpoint)),
        "controller.config.control_mode" => Property::Whole(&mut config.control_mode),
        "controller.config.input_mode" => Property::Whole(&mut config.input_mode),
        "controller.config.pos_gain" => Property::Float(&mut config.pos_gain),
        "controller.config.vel_gain" => Property::Float(&mut config.vel_gain),
        "controller.config.vel_integrator_gain" => Property::Float(&mut config.vel_integrator_gain),
        "controller.config.inertia" => Property::Float(&mut config.inertia),
        "controller.config.vel_limit" => Property::Float(&mut config.vel_limit),
        "controller.config.vel_limit_tolerance" => Property::Float(&mut config.vel_limit_tolerance),
        "controller.config.enable_vel_limit" => Property::Switch(&mut config.enable_vel_limit),
        "controller.config.enable_overspeed_error" => Property::Switch(&mut config.enable_overspeed_error),
        "controller.config.circular_setpoints" => Property::Switch(&mut config.circular_setpoints),
        "trap_traj.config.vel_limit" => Property::Float(&mut config.trajectory_vel_limit),
        "trap_traj.config.accel_limit" => Property::Float(&mut config.accel_limit),
        "trap_traj.config.decel_limit" => Property::Float(&mut config.decel_limit),
        "config.enable_watchdog" => Property::Switch(&mut config.enable_watchdog),
        "config.watchdog_timeout" => Property::Float(&mut config.watchdog_timeout),
        "config.enable_step_dir" => Property::Switch(&mut config.enable_step_dir),
        "config.startup_closed_loop_control" => Property::Switch(&mut config.startup_closed_loop_control),
        "config.startup_homing" => Property::Switch(&mut config.startup_homing),
        "config.startup_motor_calibration" => Property::Switch(&mut config.startup_motor_calibration),
        _ => return None,
    })
}

fn of_axis(name: &str) -> Option<(usize, &str)> {
    let (axis, rest) = name.split_once('.')?;
    match axis {
        "axis0" => Some((0, rest)),
        "axis1" => Some((1, rest)),
        _ => None,
    }
}

const MOST_CHARACTERS: usize = 9;
