//! How well it follows: the paper's figures, and the numbers that separation and R5 to R7 count on.

use covr_engine::frames::{Floor, Planar};
use covr_engine::time::Span;
use covr_gantry::contract::Gantry;
use covr_gantry::sim::parameters::MachineParameters;
use proptest::prelude::*;

use crate::course::{ARENA, Course, PERIOD, Seen};

/// The worst of a move.
#[derive(Default, Debug)]
struct Worst {
    error_m: f64,
    lag_secs: f64,
    overshoot_m: f64,
    rest_speed_mps: f64,
    amps: f64,
    reported_error_m: f64,
    secs: f64,
    peak_mps: f64,
}

fn fly(course: &mut Course, place: Floor) -> Worst {
    let start = course.machine.read(course.now).report.position;
    let way = place - start;
    let mut worst = Worst::default();
    let mut still_secs = 0.0;
    course.travel_to(place, |seen| look(seen, place, way, &mut worst, &mut still_secs));
    worst
}

fn look(seen: &Seen, place: Floor, way: Planar, worst: &mut Worst, still_secs: &mut f64) {
    let (reference, velocity, acceleration) = seen.reference;
    let error = reference - seen.position;
    let beyond = seen.position - place;
    worst.error_m = worst.error_m.max(error.norm());
    worst.amps = worst.amps.max(seen.amps[0].abs()).max(seen.amps[1].abs());
    worst.peak_mps = worst.peak_mps.max(seen.velocity.x.abs()).max(seen.velocity.y.abs());
    worst.reported_error_m =
        worst.reported_error_m.max(seen.reading.report.position.distance_m(seen.position));
    let axes = [
        (way.x, beyond.x, velocity.x - seen.velocity.x, acceleration.x),
        (way.y, beyond.y, velocity.y - seen.velocity.y, acceleration.y),
    ];
    for (way, beyond, late, acceleration) in axes {
        worst.overshoot_m = worst.overshoot_m.max(beyond * way.signum());
        if acceleration.abs() > 1.2 {
            worst.lag_secs = worst.lag_secs.max((late / acceleration).abs());
        }
    }
    if velocity == Planar::ZERO {
        *still_secs += PERIOD.secs();
        if *still_secs > 0.2 {
            worst.rest_speed_mps = worst.rest_speed_mps.max(seen.velocity.norm());
        }
    } else {
        worst.secs += PERIOD.secs();
    }
}

#[test]
fn a_long_move_reaches_the_papers_top_speed() {
    for place in [Floor::new(3.5, 0.5), Floor::new(0.5, 3.5)] {
        let mut course = Course::homed_at(Floor::new(0.5, 0.5));
        let worst = fly(&mut course, place);
        assert!(worst.peak_mps >= 1.099 && worst.peak_mps < 1.11, "{worst:?}");
        assert!(worst.amps < 4.5, "{worst:?}");
        assert!(course.machine.true_position().distance_m(place) < 0.002);
    }
}

#[test]
fn a_short_move_takes_the_papers_time() {
    for way in [0.4, 0.5, 0.6, 0.7] {
        let mut course = Course::homed_at(Floor::new(1.0, 1.0));
        let worst = fly(&mut course, Floor::new(1.0 + way, 1.0));
        let mean_mps = way / worst.secs;
        assert!((0.39..0.56).contains(&mean_mps), "{way} m: {mean_mps} m/s");
    }
}

#[test]
fn a_load_that_the_tuning_does_not_know_is_still_followed() {
    let mut parameters = MachineParameters::paper(ARENA);
    parameters.load_kg = 5.0;
    let mut course = Course::new(parameters);
    course.home();
    fly(&mut course, Floor::new(1.0, 1.0));
    let worst = fly(&mut course, Floor::new(3.0, 2.0));
    assert!(worst.error_m < 0.015 && worst.lag_secs < 0.02, "{worst:?}");
    assert!(worst.overshoot_m < 0.002 && worst.rest_speed_mps < 0.002, "{worst:?}");
}

#[test]
fn a_load_beyond_the_current_limit_is_not_followed() {
    let mut parameters = MachineParameters::paper(ARENA);
    parameters.load_kg = 80.0;
    let mut course = Course::new(parameters);
    course.home();
    let worst = fly(&mut course, Floor::new(3.0, 2.0));
    assert!(worst.amps > 5.0, "R5 must see it: {worst:?}");
    assert!(worst.error_m > 0.05, "R6 must see it: {worst:?}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn every_move_is_followed_closely_and_ends_quietly(
        from in (0.1..3.9_f64, 0.1..3.9_f64),
        to in (0.1..3.9_f64, 0.1..3.9_f64),
    ) {
        let mut course = Course::homed_at(Floor::new(from.0, from.1));
        let place = Floor::new(to.0, to.1);
        let worst = fly(&mut course, place);
        prop_assert!(worst.error_m < 0.003, "{worst:?}");
        prop_assert!(worst.lag_secs < 0.010, "{worst:?}");
        prop_assert!(worst.overshoot_m < 0.002, "{worst:?}");
        prop_assert!(worst.rest_speed_mps < 0.002, "{worst:?}");
        prop_assert!(worst.amps < 4.6, "{worst:?}");
        prop_assert!(worst.reported_error_m < 0.001, "{worst:?}");
        prop_assert!(course.machine.true_position().distance_m(place) < 0.002);
    }
}

#[test]
fn it_rests_without_hunting_for_a_minute() {
    let mut course = Course::homed_at(Floor::new(2.2, 1.7));
    let before = course.machine.true_position();
    for _ in 0..60 {
        // The reference of a column at rest is repeated for as long as nobody reaches.
        course.travel_to(before, |seen| assert!(seen.velocity.norm() < 0.002));
    }
    assert!(course.machine.true_position().distance_m(before) < 0.001);
}

#[test]
fn the_same_calls_give_the_same_motion_bit_for_bit() {
    let run = || {
        let mut course = Course::homed_at(Floor::new(0.5, 0.5));
        let mut seen_bits = Vec::new();
        course.travel_to(Floor::new(2.7, 1.3), |seen| {
            let report = &seen.reading.report;
            let values = [
                seen.position.x,
                seen.position.y,
                seen.velocity.x,
                seen.velocity.y,
                report.position.x,
                report.velocity.y,
                report.current_amps[0],
            ];
            seen_bits.extend(values.map(f64::to_bits));
        });
        seen_bits
    };
    assert_eq!(run(), run());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(50))]

    /// R5 latches at more than 5 A for 20 ms.
    #[test]
    fn a_control_thread_that_wakes_irregularly_is_followed_too(
        micros in prop::collection::vec(1_000..12_000_i64, 50),
    ) {
        let mut course = Course::homed_at(Floor::new(0.5, 0.5));
        let mut periods = micros.iter().cycle();
        let (mut error_m, mut longest_over) = (0.0_f64, Span::ZERO);
        let mut last_under = course.now;
        let place = Floor::new(3.0, 2.0);
        let period = || Span::from_micros(*periods.next().unwrap());
        course.travel_in_periods(place, period, |seen| {
            error_m = error_m.max(seen.position.distance_m(seen.reference.0));
            let at = seen.reading.report.answered_at;
            if seen.amps.iter().any(|amps| amps.abs() > 5.0) {
                longest_over = longest_over.max(at - last_under);
            } else {
                last_under = at;
            }
        });
        prop_assert!(error_m < 0.010, "{} m", error_m);
        prop_assert!(longest_over < Span::from_millis(20), "{} s above 5 A", longest_over.secs());
        prop_assert!(course.machine.true_position().distance_m(place) < 0.002);
    }
}

#[test]
fn setpoints_at_75_hz_are_followed_too() {
    let mut course = Course::homed_at(Floor::new(0.5, 0.5));
    let mut error_m = 0.0_f64;
    course.travel_in_periods(
        Floor::new(3.0, 2.0),
        || Span::from_micros(13_333),
        |seen| error_m = error_m.max(seen.position.distance_m(seen.reference.0)),
    );
    assert!(error_m < 0.010, "{error_m} m");
}

#[test]
fn a_machine_built_standing_moves_as_one_that_was_homed_and_driven_there() {
    let (start, place) = (Floor::new(1.0, 2.5), Floor::new(3.0, 1.0));
    let ways = [Course::homed_at(start), Course::standing_at(start)].map(|mut course| {
        let begins = course.machine.read(course.now).report;
        assert!(begins.position.distance_m(start) < 0.001 && begins.velocity == Planar::ZERO, "{begins:?}");
        let mut way = Vec::new();
        course.travel_to(place, |seen| way.push((seen.position, seen.reading.report.position)));
        way
    });
    assert_eq!(ways[0].len(), ways[1].len());
    for (homed, standing) in ways[0].iter().zip(&ways[1]) {
        assert!(homed.0.distance_m(standing.0) < 0.002, "{homed:?} {standing:?}");
        assert!(standing.0.distance_m(standing.1) < 0.002, "it reports where it is: {standing:?}");
    }
}
