//! Homing: repeatable from anywhere, slow, inside the stops, and honest about failure.

use covr_engine::frames::{Floor, Planar};
use covr_engine::machine::{Drive, Homing};
use covr_engine::safety::vetted::{Action, Setpoint};
use covr_engine::time::Span;
use covr_gantry::contract::{Gantry, NotTaken};
use covr_gantry::sim::parameters::MachineParameters;
use proptest::prelude::*;

use crate::course::{ARENA, Course};

fn standing_at(x: f64, y: f64) -> Course {
    let mut parameters = MachineParameters::paper(ARENA);
    parameters.start = Floor::new(x, y);
    Course::new(parameters)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn it_finds_the_room_from_anywhere(x in 0.0..4.0_f64, y in 0.0..4.0_f64) {
        let mut course = standing_at(x, y);
        let mut fastest_mps = 0.0_f64;
        let mut lowest_m = f64::INFINITY;
        let mut homing = Homing::Running;
        let latest = course.now + Span::from_millis(90_000);
        while homing == Homing::Running && course.now < latest {
            homing = course.step(Action::Home).1.report.homing;
            let velocity = course.machine.true_velocity();
            let position = course.machine.true_position();
            fastest_mps = fastest_mps.max(velocity.x.abs()).max(velocity.y.abs());
            lowest_m = lowest_m.min(position.x).min(position.y);
        }
        prop_assert_eq!(homing, Homing::Homed);
        prop_assert!(fastest_mps < 0.11, "{}", fastest_mps);
        prop_assert!(lowest_m > -0.03, "onto the spring stops: {}", lowest_m);
        let report = course.keep(Action::Hold, 0.5);
        let truth = course.machine.true_position();
        // One count of 21 micrometres, and 20 more that the slow approach covers in a millisecond.
        prop_assert!(report.position.distance_m(truth) < 1e-4, "{:?} {:?}", report.position, truth);
        prop_assert!(truth.distance_m(Floor::new(0.05, 0.05)) < 0.001, "{:?}", truth);
        // What the fast approach covers in a millisecond, and two counts.
        let [x, y] = report.home_repeatability_m.unwrap();
        prop_assert!(x.abs() < 2e-4 && y.abs() < 2e-4, "{} {}", x, y);
        prop_assert!(ARENA.depth_m(report.position) > 0.02, "outside the margin of R1");
    }
}

#[test]
fn before_homing_positions_count_from_where_it_was_parked() {
    let mut course = standing_at(1.0, 2.0);
    let report = course.keep(Action::Hold, 0.1);
    assert_eq!(report.homing, Homing::NotHomed);
    let parked = course.machine.parameters().parked;
    assert!(report.position.distance_m(parked) < 1e-3, "it was told {parked:?}, and truly stands elsewhere");
}

#[test]
fn while_it_homes_anew_its_place_is_still_known() {
    let mut course = Course::homed();
    let setpoint = |x: f64| {
        let position = Floor::new(x, 0.05);
        Action::Track(Setpoint {
            position,
            velocity: Planar::ZERO,
            acceleration: Planar::ZERO,
            valid_for: Span::from_millis(50),
        })
    };
    for k in 0..500 {
        course.step(setpoint(0.05 + f64::from(k) * 0.002)).0.unwrap();
    }
    let mut running = 0;
    for _ in 0..500 {
        let report = course.step(Action::Home).1.report;
        let truth = course.machine.true_position();
        assert!(
            report.position.distance_m(truth) < 5e-3,
            "{:?}: {:?}, {truth:?}",
            report.homing,
            report.position
        );
        running += u32::from(report.homing == Homing::Running);
    }
    assert!(running > 100, "it homes");
}

#[test]
fn homing_again_starts_only_after_another_command() {
    let mut course = Course::homed();
    let report = course.keep(Action::Home, 1.0);
    assert_eq!(report.homing, Homing::Homed, "a repeated command starts nothing");
    course.step(Action::Hold).0.unwrap();
    let report = course.keep(Action::Home, 0.1);
    assert_eq!(report.homing, Homing::Running);
    assert_eq!(course.home(), Homing::Homed);
}

#[test]
fn a_jammed_axis_fails_homing_and_releases_the_drive() {
    let mut course = standing_at(1.0, 1.0);
    course.machine.faults.y.stalled = true;
    assert_eq!(course.home(), Homing::Failed);
    let report = course.keep(Action::Home, 0.1);
    assert_eq!(report.drive, Drive::Released);
    assert_eq!(report.current_amps, [0.0; 2]);
}

#[test]
fn homing_stops_when_it_is_told_something_else_or_nothing() {
    let mut course = standing_at(2.0, 2.0);
    course.keep(Action::Home, 1.0);
    let report = course.keep(Action::Hold, 0.5);
    assert_eq!(report.homing, Homing::NotHomed);
    assert_eq!(course.machine.true_velocity().norm(), 0.0);

    course.keep(Action::Home, 1.0);
    let report = course.be_silent(1.0);
    assert_eq!(report.homing, Homing::NotHomed);
    assert_eq!(course.machine.true_velocity().norm(), 0.0);
    assert_eq!(course.home(), Homing::Homed);
}

#[test]
fn a_setpoint_before_homing_is_not_taken_and_moves_nothing() {
    let mut course = standing_at(2.0, 2.0);
    let setpoint = Setpoint {
        position: Floor::new(2.5, 2.0),
        velocity: Default::default(),
        acceleration: Default::default(),
        valid_for: Span::from_millis(40),
    };
    for _ in 0..100 {
        assert_eq!(course.step(Action::Track(setpoint)).0, Err(NotTaken::NotHomed));
    }
    assert_eq!(course.machine.true_position(), Floor::new(2.0, 2.0));
    assert_eq!(course.machine.name(), "simulated gantry");
}
