//! What it does when all is well, and when nobody speaks to it any more.

use super::*;
use crate::emulation::Emulated as _;
use crate::linked::bench::{Off, drive, drive_stuttering, speed_up, velocity_covers};

#[test]
fn it_finds_the_room_from_anywhere() {
    for start in [Floor::new(0.6, 0.35), Floor::new(0.01, 3.9)] {
        let mut bench = Bench::new(start);
        assert_eq!(bench.home(), Homing::Homed);
        let off_m = bench.session.report().position.distance_m(bench.truth().0);
        assert!(off_m < 0.003, "{off_m} m off");
        let repeats_m = bench.session.report().home_repeatability_m.unwrap();
        println!("repeats within {repeats_m:?} m");
        assert!(repeats_m.iter().all(|off_m| off_m.abs() < 0.004), "{repeats_m:?}");
    }
}

#[test]
fn told_that_its_motor_turns_the_other_way_it_goes_the_other_way() {
    let mut settings = paper(travel());
    settings.axes[0].reversed = true;
    let port = Bench::world(|setup| setup, Floor::new(0.6, 0.35));
    let mut bench = Bench::try_new(&settings, &port).unwrap();
    for _ in 0..300 {
        bench.cycle(Action::Home).unwrap();
    }
    assert!(bench.truth().0.x > 0.65, "{}", bench.truth().0.x);
    assert!(bench.session.report().velocity.x < -0.05, "which it takes for down the rail");
}

#[test]
fn it_follows_a_course_at_its_limits() {
    let mut bench = Bench::homed();
    let Off { greatest_m, greatest_mps, greatest_amps, last_m } = drive(&mut bench);
    println!(
        "{:.1} mm and {greatest_mps:.3} m/s on the way, {greatest_amps:.1} A, {:.2} mm at the end",
        greatest_m * 1e3,
        last_m * 1e3
    );
    assert!(greatest_m < 0.02, "{greatest_m} m on the way");
    assert!(greatest_mps < 0.1, "{greatest_mps} m/s on the way");
    assert!(last_m < 0.003, "{last_m} m at the end");
    assert!(greatest_amps < 5.0, "{greatest_amps} A");
}

#[test]
fn a_host_that_stutters_takes_no_more_current_than_r5_allows() {
    for late_millis in [4, 8, 14] {
        let mut bench = Bench::homed();
        let off = drive_stuttering(&mut bench, Span::from_millis(late_millis));
        println!(
            "{late_millis} ms: {:.1} mm and {:.3} m/s on the way, {:.1} A",
            off.greatest_m * 1e3,
            off.greatest_mps,
            off.greatest_amps
        );
        assert!(off.greatest_amps < 5.0, "{late_millis} ms late: {} A", off.greatest_amps);
    }
}

#[test]
fn without_a_newer_order_it_brakes_to_rest_with_torque_and_lets_go_only_then() {
    let mut bench = Bench::homed();
    speed_up(&mut bench, 1.0);
    let (from, velocity) = bench.truth();
    assert!(velocity.x > 0.85, "{velocity:?}");
    // Nobody speaks to the board any more.
    bench.port.wait(Span::from_millis(600));
    bench.port.with(|world| world.emulator.poll(world.now));
    let (at, velocity) = bench.truth();
    let most = velocity_covers(1.0, 0.05 + 0.06, 2.5);
    assert!(velocity.norm() < 0.02, "still at {} m/s", velocity.norm());
    assert!(at.x - from.x < most, "{} m, at most {most} m", at.x - from.x);
    assert_eq!(bench.port.with(|world| world.emulator.flags()), [("is_x_on", true), ("is_y_on", true)]);
    // Then its watchdog is over, and nothing moves any more.
    bench.port.wait(Span::from_secs(1.0));
    bench.port.with(|world| world.emulator.poll(world.now));
    assert_eq!(bench.port.with(|world| world.emulator.flags()), [("is_x_on", false), ("is_y_on", false)]);
    assert!(bench.truth().0.distance_m(at) < 0.005);
}

#[test]
fn a_hold_brakes_at_the_limit_and_keeps_the_place() {
    let mut bench = Bench::homed();
    speed_up(&mut bench, 1.0);
    let (from, _) = bench.truth();
    for _ in 0..400 {
        bench.cycle(Action::Hold).unwrap();
    }
    let (at, velocity) = bench.truth();
    assert!(velocity.norm() < 0.005 && at.x - from.x < velocity_covers(1.1, 0.03, 2.5), "{}", at.x - from.x);
    bench.give("push x 40");
    for _ in 0..300 {
        bench.cycle(Action::Hold).unwrap();
    }
    assert!(bench.truth().0.distance_m(at) < 0.01, "{} m", bench.truth().0.distance_m(at));
}

#[test]
fn set_free_again_a_held_column_goes_no_further_than_the_cap_and_the_lead() {
    let mut bench = Bench::homed();
    speed_up(&mut bench, 0.3);
    bench.give("jam x on");
    for _ in 0..50 {
        let at = bench.session.report().position;
        // An engine that does not look leads it on: a place always ahead.
        bench.cycle(setpoint(at + Planar::new(0.2, 0.0), Planar::new(0.3, 0.0), Planar::ZERO)).unwrap();
    }
    let (held, _) = bench.truth();
    bench.give("jam x off");
    for _ in 0..200 {
        bench.cycle(Action::Hold).unwrap();
    }
    let went = bench.truth().0.x - held.x;
    assert!(went < 0.12, "{went} m");
}

#[test]
fn released_it_can_be_pushed_and_is_switched_on_again_where_it_stands() {
    let mut bench = Bench::homed();
    let (at, _) = bench.truth();
    bench.give("push x 60");
    for _ in 0..300 {
        bench.cycle(Action::Release).unwrap();
    }
    let pushed = bench.truth().0;
    assert!(pushed.x - at.x > 0.05);
    assert!((bench.session.report().position.x - pushed.x).abs() < 0.02, "the count goes on");
    bench.give("push x -20");
    for _ in 0..400 {
        bench.cycle(Action::Release).unwrap();
    }
    bench.give("push x 0");
    for _ in 0..100 {
        bench.cycle(Action::Release).unwrap();
    }
    let (rests_at, velocity) = bench.truth();
    assert!(velocity.norm() < 0.5, "{velocity:?}");
    for _ in 0..400 {
        bench.cycle(Action::Hold).unwrap();
    }
    assert_eq!(bench.session.report().trouble, None);
    let (at, now) = bench.truth();
    assert!(now.norm() < 0.005 && at.distance_m(rests_at) < 0.1, "{} m", at.distance_m(rests_at));
}

#[test]
fn a_stop_goes_out_in_the_exchange_that_it_comes_with_and_is_acknowledged_by_it() {
    let mut bench = Bench::homed();
    speed_up(&mut bench, 0.4);
    bench.port.with(|world| world.sent.clear());
    assert!(bench.cycle(Action::Hold).unwrap());
    assert_eq!(bench.port.with(|world| world.sent.len()), 1);
    let has_let_go = bench.cycle(Action::Release).unwrap() || bench.cycle(Action::Release).unwrap();
    assert!(has_let_go);
}
