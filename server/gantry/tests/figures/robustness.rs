//! Whatever is commanded, whatever breaks, whenever it is called: no panic, no undefined number, inside the stops.

use covr_engine::frames::{Floor, Planar};
use covr_engine::safety::vetted::{Action, Setpoint};
use covr_engine::time::Span;
use covr_gantry::contract::Gantry;
use covr_gantry::sim::faults::{AxisFaults, Direction, Faults, LinkFault};
use proptest::prelude::*;

use crate::course::Course;

fn actions() -> impl Strategy<Value = Action> {
    let track = (
        (0.0..4.0_f64, 0.0..4.0_f64),
        (-1.1..1.1_f64, -1.1..1.1_f64),
        (-50.0..50.0_f64, prop_oneof![9 => -2.5..2.5_f64, 1 => Just(f64::NAN)]),
        -5_000..100_000_i64,
    )
        .prop_map(|(position, velocity, acceleration, micros)| {
            Action::Track(Setpoint {
                position: Floor::new(position.0, position.1),
                velocity: Planar::new(velocity.0, velocity.1),
                acceleration: Planar::new(acceleration.0, acceleration.1),
                valid_for: Span::from_micros(micros),
            })
        });
    prop_oneof![1 => Just(Action::Release), 1 => Just(Action::Hold), 1 => Just(Action::Home), 5 => track]
}

fn faults() -> impl Strategy<Value = Faults> {
    let direction = prop_oneof![
        6 => Just(None),
        1 => Just(Some(Direction::Positive)),
        1 => Just(Some(Direction::Negative)),
    ];
    let axis = (prop::bool::weighted(0.1), direction, prop_oneof![5 => Just(0.0), 1 => 0.0..1.0_f64])
        .prop_map(|(stalled, runaway, encoder_slip)| AxisFaults { stalled, runaway, encoder_slip });
    let link = prop_oneof![
        6 => Just(LinkFault::None),
        1 => Just(LinkFault::Dead),
        2 => (0..300_000_i64).prop_map(|micros| LinkFault::Slow(Span::from_micros(micros))),
    ];
    (axis.clone(), axis, link).prop_map(|(x, y, link)| Faults { x, y, link })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn nothing_that_is_sent_or_broken_makes_it_leave_its_stops(
        course_of_events in prop::collection::vec((actions(), faults(), 0..200_000_i64, 1..40_usize), 1..40),
    ) {
        let mut course = Course::homed_at(Floor::new(2.0, 2.0));
        for (action, faults, micros, times) in course_of_events {
            course.machine.faults = faults;
            for _ in 0..times {
                // Refusals are part of the game; what they do to the motion is looked at below.
                let _taken_or_not = course.step_for(action, Span::from_micros(micros)).0;
                let truth = course.machine.true_position();
                let report = course.machine.read(course.now).report;
                prop_assert!(truth.is_finite() && report.position.is_finite());
                prop_assert!(report.velocity.norm().is_finite());
                prop_assert!(course.machine.travel().depth_m(truth) > -0.15, "{:?}", truth);
                prop_assert!(report.answered_at <= course.now);
            }
        }
        course.machine.faults = Faults::default();
        course.keep(Action::Release, 5.0);
        prop_assert_eq!(course.machine.true_velocity(), Planar::ZERO);
        course.home();
        let report = course.keep(Action::Hold, 0.5);
        prop_assert!(report.position.distance_m(course.machine.true_position()) < 1e-4);
    }
}

#[test]
fn a_caller_that_was_away_for_a_day_finds_it_at_rest() {
    let mut course = Course::homed_at(Floor::new(2.0, 2.0));
    let setpoint = Setpoint {
        position: Floor::new(2.0, 2.0),
        velocity: Planar::new(0.5, 0.0),
        acceleration: Planar::ZERO,
        valid_for: Span::from_millis(40),
    };
    let day = Span::from_millis(86_400_000);
    let (_, reading) = course.step_for(Action::Track(setpoint), day);
    assert_eq!(reading.report.answered_at, course.now);
    assert_eq!(course.machine.true_velocity(), Planar::ZERO);
    assert!(course.machine.true_position().distance_m(Floor::new(2.0, 2.0)) < 0.2);
}

#[test]
fn time_that_stands_still_or_runs_back_moves_nothing() {
    let mut course = Course::homed_at(Floor::new(2.0, 2.0));
    let before = course.machine.true_position();
    let earlier = course.now - Span::from_millis(500);
    course.machine.faults.y.runaway = Some(Direction::Positive);
    for _ in 0..100 {
        course.machine.read(course.now);
        course.machine.read(earlier);
    }
    assert_eq!(course.machine.true_position(), before);
}
