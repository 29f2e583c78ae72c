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

/// Drive 2 m along both axes at their limits and stay there; the greatest error on the way, and the last, m.
fn drive(bench: &mut Bench) -> (f64, f64) {
    let from = bench.session.report().position;
    let (speed, acceleration, way) = (1.0, 1.25, 2.0);
    let ramp_secs = speed / acceleration;
    let whole_secs = way / speed + ramp_secs;
    let begun = bench.port.time();
    let mut greatest = 0.0_f64;
    loop {
        let t = (bench.port.time() - begun).secs();
        let (s, v, a) = if t < ramp_secs {
            (0.5 * acceleration * t * t, acceleration * t, acceleration)
        } else if t < whole_secs - ramp_secs {
            (0.5 * speed * ramp_secs + speed * (t - ramp_secs), speed, 0.0)
        } else if t < whole_secs {
            let left = whole_secs - t;
            (way - 0.5 * acceleration * left * left, acceleration * left, -acceleration)
        } else {
            (way, 0.0, 0.0)
        };
        let both = Planar::new(1.0, 1.0);
        let wanted = from + both * s;
        bench.cycle(setpoint(wanted, both * v, both * a)).unwrap();
        let (true_place, _) = bench.truth();
        let since = (bench.port.time() - begun).secs() - t;
        greatest = greatest.max((true_place - (wanted + both * (v * since))).norm());
        if t > whole_secs + 1.5 {
            return (greatest, (true_place - wanted).norm());
        }
    }
}

#[test]
fn it_follows_a_course_at_its_limits_on_every_kind_of_boards() {
    for kind in KINDS {
        let mut bench = Bench::homed(kind);
        let (greatest, last) = drive(&mut bench);
        println!(
            "{} {:?} {} baud: {:.1} mm on the way, {:.2} mm at the end",
            kind.firmware,
            kind.boards,
            kind.baud,
            greatest * 1e3,
            last * 1e3
        );
        assert!(greatest < 0.045, "{} {:?}: {greatest} m on the way", kind.firmware, kind.boards);
        assert!(last < 0.003, "{} {:?}: {last} m at the end", kind.firmware, kind.boards);
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
