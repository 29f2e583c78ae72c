//! It stops: when told to, when nobody says anything, and when it is let go.

use covr_engine::frames::{Floor, Planar};
use covr_engine::machine::Drive;
use covr_engine::safety::vetted::{Action, Setpoint};
use covr_engine::time::Span;
use proptest::prelude::*;

use crate::course::{Course, PERIOD};

const VALID_FOR: Span = Span::from_millis(40);

/// At `speed_mps` along x after a gentle start, somewhere near the middle.
fn cruising(speed_mps: f64) -> Course {
    let mut course = Course::homed_at(Floor::new(0.5, 2.0));
    let mut position = course.machine.true_position();
    let mut speed = 0.0_f64;
    while speed < speed_mps {
        let next = (speed + 1.25 * PERIOD.secs()).min(speed_mps);
        let acceleration = (next - speed) / PERIOD.secs();
        track(&mut course, position, speed, acceleration);
        position.x += 0.5 * (speed + next) * PERIOD.secs();
        speed = next;
    }
    for _ in 0..50 {
        track(&mut course, position, speed, 0.0);
        position.x += speed * PERIOD.secs();
    }
    course
}

fn track(course: &mut Course, position: Floor, speed_mps: f64, acceleration_mps2: f64) {
    let setpoint = Setpoint {
        position,
        velocity: Planar::new(speed_mps, 0.0),
        acceleration: Planar::new(acceleration_mps2, 0.0),
        valid_for: VALID_FOR,
    };
    course.step(Action::Track(setpoint)).0.unwrap();
}

/// Way of a stop at 2.5 m/s2 with a jerk of 60 m/s3 at both ends.
fn stop_way_m(speed_mps: f64) -> f64 {
    let (b, j) = (2.5_f64, 60.0);
    let b = b.min((speed_mps * j).sqrt());
    0.5 * speed_mps * (speed_mps / b + b / j)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn without_a_newer_command_it_brakes_to_rest_by_itself(speed_mps in 0.1..1.1_f64) {
        let mut course = cruising(speed_mps);
        let from = course.machine.true_position().x;
        course.be_silent(1.0);
        prop_assert_eq!(course.machine.true_velocity(), Planar::ZERO);
        let way = course.machine.true_position().x - from;
        // One period of the last command is gone when the silence begins.
        let most = speed_mps * VALID_FOR.secs() + stop_way_m(speed_mps) + 0.005;
        prop_assert!(way < most, "{} of {}", way, most);
        prop_assert!(way > 0.8 * most - 0.01, "{} of {}", way, most);
    }

    #[test]
    fn hold_stops_within_the_jerk_limited_way_and_stays(speed_mps in 0.1..1.1_f64) {
        let mut course = cruising(speed_mps);
        let from = course.machine.true_position().x;
        let mut amps = 0.0_f64;
        for _ in 0..250 {
            let report = course.step(Action::Hold).1.report;
            amps = amps.max(report.current_amps[0]).max(report.current_amps[1]);
        }
        let rest = course.machine.true_position();
        prop_assert!(rest.x - from < stop_way_m(speed_mps) + 0.003, "{}", rest.x - from);
        prop_assert!(amps < 4.6, "{} A", amps);
        let report = course.keep(Action::Hold, 5.0);
        prop_assert!(course.machine.true_position().distance_m(rest) < 0.001);
        prop_assert_eq!(course.machine.true_velocity(), Planar::ZERO);
        prop_assert_eq!(report.drive, Drive::On);
    }
}

#[test]
fn the_serial_timeout_ends_a_command_that_would_be_valid_for_ever() {
    let mut course = Course::homed_at(Floor::new(0.5, 2.0));
    let setpoint = Setpoint {
        position: course.machine.true_position(),
        velocity: Planar::new(0.2, 0.0),
        acceleration: Planar::ZERO,
        valid_for: Span::from_millis(3_600_000),
    };
    course.step(Action::Track(setpoint)).0.unwrap();
    let from = course.machine.true_position().x;
    course.be_silent(2.0);
    assert_eq!(course.machine.true_velocity(), Planar::ZERO);
    let way = course.machine.true_position().x - from;
    assert!(way > 0.02 && way < 0.2 * 0.2 + stop_way_m(0.2) + 0.005, "{way}");
}

#[test]
fn a_released_column_coasts_and_can_be_pushed() {
    let mut course = cruising(0.8);
    let from = course.machine.true_position().x;
    let report = course.keep(Action::Release, 3.0);
    let way = course.machine.true_position().x - from;
    assert_eq!(report.drive, Drive::Released);
    assert_eq!(report.current_amps, [0.0; 2]);
    assert_eq!(course.machine.true_velocity(), Planar::ZERO);
    assert!(way > stop_way_m(0.8) + 0.05, "friction alone stops later than the brake: {way}");

    course.machine.push(Planar::new(0.0, 40.0));
    let pushed = course.keep(Action::Release, 0.5);
    assert!(pushed.position.y > report.position.y + 0.02, "the report shows an uncommanded motion");
    assert!(pushed.velocity.y > 0.1);
}

#[test]
fn a_held_column_withstands_a_push() {
    let mut course = Course::homed_at(Floor::new(2.0, 2.0));
    let before = course.keep(Action::Hold, 0.5).position;
    course.machine.push(Planar::new(-40.0, 0.0));
    let mut furthest_m = 0.0_f64;
    for _ in 0..500 {
        let report = course.step(Action::Hold).1.report;
        furthest_m = furthest_m.max(report.position.distance_m(before));
    }
    assert!(furthest_m < 0.05, "{furthest_m}");
    assert!(course.machine.true_position().distance_m(before) < 0.002);
    assert!(course.machine.true_current_amps()[0] > 1.5);
}

#[test]
fn after_a_pause_the_reference_is_caught_up_with_inside_the_limits() {
    let mut course = cruising(0.9);
    let start = course.machine.true_position();
    let began = course.now;
    // The control thread is away for 120 ms; its reference has gone on.
    course.be_silent(0.12);
    let (mut amps, mut peak_mps) = (0.0_f64, 0.0_f64);
    while (course.now - began).secs() < 2.0 {
        let gone = 0.9 * (course.now - began).secs();
        track(&mut course, Floor::new(start.x + gone, start.y), 0.9, 0.0);
        amps = amps.max(course.machine.true_current_amps()[0].abs());
        peak_mps = peak_mps.max(course.machine.true_velocity().x);
    }
    let behind_m = start.x + 0.9 * (course.now - began).secs() - course.machine.true_position().x;
    assert!(behind_m.abs() < 0.003, "{behind_m} m");
    assert!(amps < 5.0, "{amps} A");
    assert!(peak_mps > 0.95 && peak_mps < 1.13, "{peak_mps} m/s");
}
