//! Each fault, and what a report shows of it: what R5 to R8 have to see.

use covr_engine::frames::{Floor, Planar};
use covr_engine::machine::Drive;
use covr_engine::safety::vetted::{Action, Setpoint};
use covr_engine::time::Span;
use covr_gantry::contract::{Gantry, LinkError, NotTaken};
use covr_gantry::sim::faults::{Direction, LinkFault};

use crate::course::{Course, PERIOD};

fn middle() -> Course {
    Course::homed_at(Floor::new(2.0, 2.0))
}

#[test]
fn a_stalled_axis_shows_over_current_and_a_growing_following_error() {
    let mut course = middle();
    course.machine.faults.x.stalled = true;
    let (mut amps, mut error_m, mut moved_m) = (0.0_f64, 0.0_f64, 0.0_f64);
    course.travel_to(Floor::new(3.0, 2.0), |seen| {
        amps = amps.max(seen.reading.report.current_amps[0]);
        error_m = error_m.max((seen.reference.0.x - seen.reading.report.position.x).abs());
        moved_m = moved_m.max((seen.position.x - 2.0).abs());
    });
    assert!(amps > 5.0, "{amps} A");
    assert!(error_m > 0.9, "{error_m} m");
    assert!(moved_m < 0.002, "{moved_m} m");

    course.machine.faults.x.stalled = false;
    course.keep(Action::Hold, 1.0);
    course.travel_to(Floor::new(2.5, 2.0), |_| {});
    assert!(course.machine.true_position().distance_m(Floor::new(2.5, 2.0)) < 0.002);
}

#[test]
fn a_runaway_shows_as_motion_that_nobody_commanded_until_the_drive_is_released() {
    let mut course = middle();
    course.machine.faults.y.runaway = Some(Direction::Negative);
    let report = course.keep(Action::Hold, 0.3);
    assert!(report.velocity.y < -0.5, "{:?}", report.velocity);
    assert!(report.position.y < 1.95);
    assert!(report.current_amps[1] > 5.0, "{:?}", report.current_amps);
    assert!(report.velocity.x.abs() < 0.01);
    let released = course.keep(Action::Release, 4.0);
    assert_eq!(released.drive, Drive::Released);
    assert_eq!(course.machine.true_velocity(), Planar::ZERO);
}

#[test]
fn a_runaway_ends_at_the_spring_stops_and_not_beyond() {
    let mut course = middle();
    course.machine.faults.x.runaway = Some(Direction::Positive);
    for _ in 0..1_000 {
        course.step(Action::Hold).0.unwrap();
        assert!(course.machine.true_position().x < 4.12);
    }
    assert!(course.machine.true_position().x > 4.03);
}

#[test]
fn a_dead_link_shows_as_an_answer_that_grows_old_while_the_machine_stops_by_itself() {
    let mut course = middle();
    let onward = |k: i64| Setpoint {
        position: Floor::new(2.0 + 0.2 * k as f64 * PERIOD.secs(), 2.0),
        velocity: Planar::new(0.2, 0.0),
        acceleration: Planar::ZERO,
        valid_for: Span::from_millis(40),
    };
    for k in 0..100 {
        let (taken, reading) = course.step(Action::Track(onward(k)));
        assert_eq!((taken, reading.link), (Ok(()), Ok(())));
        assert_eq!(reading.report.answered_at, course.now);
    }
    assert!(course.machine.true_velocity().x > 0.19);

    course.machine.faults.link = LinkFault::Dead;
    let died_at = course.now;
    for k in 1..=100 {
        let (taken, reading) = course.step(Action::Track(onward(100 + k)));
        let silent = LinkError::Silent { for_span: Span::from_micros(k * PERIOD.micros()) };
        assert!(matches!(taken, Err(NotTaken::Link(_))));
        assert_eq!(reading.link, Err(silent));
        assert_eq!(reading.report.answered_at, died_at);
    }
    assert_eq!(course.machine.true_velocity(), Planar::ZERO);

    course.machine.faults.link = LinkFault::None;
    let (taken, reading) = course.step(Action::Hold);
    assert_eq!((taken, reading.link), (Ok(()), Ok(())));
    assert_eq!(reading.report.answered_at, course.now);
}

#[test]
fn a_slow_link_shows_as_old_answers_and_late_obedience() {
    let mut course = middle();
    let by = Span::from_millis(60);
    course.machine.faults.link = LinkFault::Slow(by);
    course.keep(Action::Hold, 0.2);
    let reading = course.machine.read(course.now);
    assert_eq!(course.now - reading.report.answered_at, by);
    assert_eq!(reading.link, Ok(()));

    let told_at = course.now;
    let mut released_after = None;
    for _ in 0..100 {
        let reading = course.step(Action::Release).1;
        if reading.report.drive == Drive::Released && released_after.is_none() {
            released_after = Some(course.now - told_at);
        }
    }
    let after = released_after.unwrap();
    assert!(after >= Span::from_millis(120) && after <= Span::from_millis(132), "{after:?}");
}

#[test]
fn a_slipping_encoder_reports_less_way_than_there_is() {
    let mut course = middle();
    course.machine.faults.x.encoder_slip = 0.1;
    course.travel_to(Floor::new(3.0, 2.0), |_| {});
    let report = course.machine.read(course.now).report;
    assert!((report.position.x - 3.0).abs() < 0.002, "{}", report.position.x);
    let truth = course.machine.true_position().x;
    assert!((truth - (2.0 + 1.0 / 0.9)).abs() < 0.005, "{truth}");
}

#[test]
fn a_lost_encoder_shows_as_full_current_without_motion() {
    let mut course = middle();
    course.machine.faults.y.encoder_slip = 1.0;
    let mut amps = 0.0_f64;
    let mut reported_m = 0.0_f64;
    course.travel_to(Floor::new(2.0, 3.0), |seen| {
        amps = amps.max(seen.reading.report.current_amps[1]);
        reported_m = reported_m.max((seen.reading.report.position.y - 2.0).abs());
    });
    assert!(amps > 5.0, "{amps}");
    assert!(reported_m < 0.002, "{reported_m}");
}
