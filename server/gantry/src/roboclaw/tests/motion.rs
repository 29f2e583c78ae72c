//! What it does when all is well.

use super::*;
use crate::linked::bench::{CONTROL_PERIOD, Off, drive, velocity_covers};

const KINDS: [Kind; 5] = [
    USUAL,
    Kind { firmware: "older", ..USUAL },
    Kind { home_by: HomeBy::Stops, ..USUAL },
    Kind { boards: Boards::Two([0x80, 0x81]), ..USUAL },
    Kind { baud: 115_200, ..USUAL },
];

#[test]
fn it_finds_the_room_on_every_kind_of_boards() {
    for kind in KINDS {
        let mut bench = Bench::new(kind, Floor::new(0.6, 0.35));
        assert_eq!(bench.home(), Homing::Homed, "{} {:?}", kind.firmware, kind.boards);
        let off_m = bench.session.report().position.distance_m(bench.truth().0);
        let repeats_m = bench.session.report().home_repeatability_m.unwrap();
        println!("{} {:?} {:?}: repeats within {repeats_m:?} m", kind.firmware, kind.boards, kind.home_by);
        assert!(repeats_m.iter().all(|off_m| off_m.abs() < 0.004), "{repeats_m:?}");
        assert!(off_m < 0.003, "{} {:?} {:?}: {off_m} m off", kind.firmware, kind.boards, kind.home_by);
    }
}

#[test]
fn it_follows_a_course_at_its_limits_on_every_kind_of_boards() {
    for kind in KINDS {
        let mut bench = Bench::homed(kind);
        let Off { greatest_m, greatest_mps, greatest_amps, last_m } = drive(&mut bench);
        let what = format!("{} {:?} {} baud", kind.firmware, kind.boards, kind.baud);
        println!(
            "{what}: {:.1} mm and {greatest_mps:.3} m/s on the way, {greatest_amps:.1} A, {:.2} mm at the end",
            greatest_m * 1e3,
            last_m * 1e3
        );
        assert!(greatest_m < 0.02, "{what}: {greatest_m} m on the way");
        assert!(greatest_mps < 0.1, "{what}: {greatest_mps} m/s on the way");
        assert!(last_m < 0.003, "{what}: {last_m} m at the end");
        assert!(greatest_amps < 5.0, "{what}: {greatest_amps} A");
    }
}

#[test]
fn without_a_newer_order_it_rests_within_the_cap_and_a_brake() {
    let mut bench = Bench::homed(USUAL);
    let (place, _) = bench.truth();
    let mut v = 0.0;
    while v < 1.0 {
        v += 1.25 * CONTROL_PERIOD.secs();
        let at = bench.session.report().position;
        bench
            .cycle(setpoint(at + Planar::new(v * 0.004, 0.0), Planar::new(v, 0.0), Planar::new(1.25, 0.0)))
            .unwrap();
    }
    let (from, velocity) = bench.truth();
    assert!(velocity.x > 0.8 && from.x > place.x);
    // Nobody speaks to the boards any more: the cap of 50 ms is through, then the brake that lay behind it.
    bench.port.wait(Span::from_secs(2.0));
    bench.port.with(|world| world.emulator.poll(world.now));
    let (at, velocity) = bench.truth();
    let most = velocity_covers(1.0, 0.05 + 0.06, 2.5);
    assert!(velocity.norm() < 0.01, "still at {} m/s", velocity.norm());
    assert!(at.x - from.x < most, "{} m, at most {most} m", at.x - from.x);
}

#[test]
fn a_hold_brakes_at_the_limit_and_keeps_the_place() {
    let mut bench = Bench::homed(USUAL);
    let mut v = 0.0;
    while v < 1.0 {
        v += 1.25 * CONTROL_PERIOD.secs();
        let at = bench.session.report().position;
        bench.cycle(setpoint(at, Planar::new(v, 0.0), Planar::new(1.25, 0.0))).unwrap();
    }
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
fn released_it_can_be_pushed() {
    let mut bench = Bench::homed(USUAL);
    let (at, _) = bench.truth();
    bench.give("push x 60");
    for _ in 0..300 {
        bench.cycle(Action::Release).unwrap();
    }
    assert!(bench.truth().0.x - at.x > 0.05);
    assert!((bench.session.report().position.x - bench.truth().0.x).abs() < 0.005, "the count goes on");
}
