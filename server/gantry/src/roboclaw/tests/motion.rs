//! What it does when all is well.

use super::*;

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
        assert!(off_m < 0.003, "{} {:?} {:?}: {off_m} m off", kind.firmware, kind.boards, kind.home_by);
    }
}

/// Greatest deviations on a course, and the last: what R6 looks at.
#[derive(Default)]
struct Off {
    greatest_m: f64,
    greatest_mps: f64,
    greatest_amps: f64,
    last_m: f64,
}

/// A way of 2 m at the limits of an axis: place, velocity and acceleration after so long. Averaged over the time that the jerk limit
/// gives a change of acceleration.
fn course(t: f64) -> (f64, f64, f64) {
    let parts = 16;
    let at = |part: i32| raw_course(t - RAMP_SECS * f64::from(part) / f64::from(parts));
    let sum = (0..=parts).map(at).fold((0.0, 0.0, 0.0), |sum, of| (sum.0 + of.0, sum.1 + of.1, sum.2 + of.2));
    let count = f64::from(parts + 1);
    (sum.0 / count, sum.1 / count, sum.2 / count)
}

fn raw_course(t: f64) -> (f64, f64, f64) {
    let (speed, up, down, way) = (1.0, 1.25, 2.5, 2.0);
    let (up_secs, down_secs) = (speed / up, speed / down);
    let whole_secs = way / speed + 0.5 * (up_secs + down_secs);
    if t < 0.0 {
        (0.0, 0.0, 0.0)
    } else if t < up_secs {
        (0.5 * up * t * t, up * t, up)
    } else if t < whole_secs - down_secs {
        (speed * (t - 0.5 * up_secs), speed, 0.0)
    } else if t < whole_secs {
        let left = whole_secs - t;
        (way - 0.5 * down * left * left, down * left, -down)
    } else {
        (way, 0.0, 0.0)
    }
}

/// Drive that way along both axes, and stay there.
fn drive(bench: &mut Bench) -> Off {
    let from = bench.session.report().position;
    let begun = bench.port.time();
    let both = Planar::new(1.0, 1.0);
    let mut off = Off::default();
    loop {
        let t = (bench.port.time() - begun).secs();
        let (s, v, a) = course(t);
        bench.cycle(setpoint(from + both * s, both * v, both * a)).unwrap();
        let report = bench.session.report();
        let since = (report.answered_at - begun).secs() - t;
        let [x, y] = report.current_amps;
        off.greatest_amps = off.greatest_amps.max(x).max(y);
        off.greatest_mps = off.greatest_mps.max((report.velocity - both * (v + a * since)).norm());
        let (true_place, _) = bench.truth();
        let since = (bench.port.time() - begun).secs() - t;
        off.greatest_m = off.greatest_m.max((true_place - (from + both * (s + v * since))).norm());
        if t > 4.5 {
            off.last_m = (true_place - (from + both * s)).norm();
            return off;
        }
    }
}

/// 2.5 m/s2 at 80 m/s3.
const RAMP_SECS: f64 = 2.5 / 80.0;

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

fn velocity_covers(mps: f64, secs: f64, braking_mps2: f64) -> f64 {
    mps * secs + mps * mps / (2.0 * braking_mps2)
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
