//! The steps that every machine goes through, one after another on the same machine.

use covr_engine::frames::{Floor, Planar};
use covr_engine::machine::{Drive, Homing, Limits, MachineReport};
use covr_engine::safety::path::{BrakePath, State};
use covr_engine::safety::vetted::{Action, ArenaConfirmedClear, Setpoint, Vetted};
use covr_engine::time::{Span, Time};
use covr_gantry::contract::{NotTaken, Reading};

use super::bench::Bench;

/// A step, by its name.
type Step = (&'static str, fn(&mut dyn Bench));

/// Every step.
pub const STEPS: [Step; 10] = [
    ("it answers, not homed and let go", answers),
    ("before it is homed a setpoint is refused and nothing moves", refuses_before_home),
    ("it homes, and rests inside its travel with the drive on", homes),
    ("it holds, and confirms the command", holds),
    ("it follows a course to a place", follows),
    ("told to hold in motion it rests within what separation allows for", holds_in_motion),
    ("told nothing it rests by itself", rests_by_itself),
    ("a setpoint that is none is refused, and it rests", refuses_nonsense),
    ("let go, it says so", lets_go),
    ("with its link cut it says so, and comes back with its place or without one", survives_a_cut),
];

/// All of it; panics with the step's name.
pub fn conforms(bench: &mut dyn Bench) {
    for (name, step) in STEPS {
        eprintln!("{name}");
        step(bench);
    }
    if bench.interrupt_power() {
        eprintln!("after its power was gone its place is too");
        forgets_with_its_power(bench);
    }
}

fn answers(bench: &mut dyn Bench) {
    let reading =
        until(bench, "an answer", |reading| reading.link.is_ok() && reading.report.trouble.is_none());
    assert_eq!((reading.report.homing, reading.report.drive), (Homing::NotHomed, Drive::Released));
}

fn refuses_before_home(bench: &mut dyn Bench) {
    let before = read(bench).report.position;
    let setpoint = at_rest(before + Planar::new(0.05, 0.0));
    for _ in 0..50 {
        assert_eq!(write(bench, Action::Track(setpoint)), Err(NotTaken::NotHomed));
        bench.pass(PERIOD);
    }
    assert!(read(bench).report.position.distance_m(before) < 0.002);
}

fn homes(bench: &mut dyn Bench) {
    let report = keep(bench, Action::Home, "homed", |report| {
        assert_ne!(report.homing, Homing::Failed);
        report.homing == Homing::Homed && report.velocity.norm() < AT_REST_MPS
    });
    assert_eq!(report.drive, Drive::On);
    // What a machine says of how well its home repeats is small; one that homes by nothing says nothing.
    for off_m in report.home_repeatability_m.into_iter().flatten() {
        assert!(off_m.abs() < 0.005, "the two approaches found the home {off_m} m apart");
    }
    let depth = bench.gantry().travel().depth_m(report.position);
    assert!(depth > -0.002, "{:?} is {depth} m inside the travel", report.position);
}

fn holds(bench: &mut dyn Bench) {
    let before = read(bench).report.position;
    write(bench, Action::Hold).unwrap();
    let told = bench.now();
    keep(bench, Action::Hold, "the command is confirmed", |_| true);
    confirmed(bench, told);
    assert!(read(bench).report.position.distance_m(before) < 0.002);
}

fn follows(bench: &mut dyn Bench) {
    let limits = bench.gantry().limits();
    let mut farthest: f64 = 0.0;
    course(bench, PLACE, |report, setpoint| {
        farthest = farthest.max(report.position.distance_m(setpoint.position));
        assert!(report.velocity.x.abs() <= 1.15 * limits.x.speed_mps, "{:?}", report.velocity);
        true
    });
    assert!(farthest < 0.05, "{farthest} m off the course");
    let there = keep(bench, Action::Track(at_rest(PLACE)), "at rest", rests);
    assert!(there.position.distance_m(PLACE) < 0.005, "{:?}", there.position);
}

fn holds_in_motion(bench: &mut dyn Bench) {
    let moving = in_motion(bench, HOME_SIDE);
    let limits = bench.gantry().limits();
    let rest = keep(bench, Action::Hold, "at rest", rests);
    assert!(
        rest.position.distance_m(moving.position) <= brakes_within(&moving, &limits),
        "{moving:?} {rest:?}"
    );
    let later = keep_for(bench, Action::Hold, Span::from_millis(300));
    assert!(later.position.distance_m(rest.position) < 0.003, "it stays: {rest:?} {later:?}");
}

fn rests_by_itself(bench: &mut dyn Bench) {
    let moving = in_motion(bench, PLACE);
    let limits = bench.gantry().limits();
    let rest = until(bench, "at rest", |reading| rests(&reading.report)).report;
    let coasts = moving.velocity.norm() * VALID_FOR.secs();
    assert!(
        rest.position.distance_m(moving.position) <= coasts + brakes_within(&moving, &limits),
        "{moving:?} {rest:?}"
    );
}

fn refuses_nonsense(bench: &mut dyn Bench) {
    in_motion(bench, HOME_SIDE);
    let nonsense = Setpoint {
        velocity: Planar::new(0.0, 0.0),
        acceleration: Planar::new(f64::NAN, 0.0),
        ..at_rest(PLACE)
    };
    assert_eq!(write(bench, Action::Track(nonsense)), Err(NotTaken::NotFinite));
    until(bench, "at rest", |reading| rests(&reading.report));
}

fn lets_go(bench: &mut dyn Bench) {
    let told = bench.now();
    keep(bench, Action::Release, "let go", |report| report.drive == Drive::Released);
    confirmed(bench, told);
    keep(bench, Action::Hold, "the drive is on again", |report| report.drive == Drive::On);
}

fn survives_a_cut(bench: &mut dyn Bench) {
    let before = keep_for(bench, Action::Hold, Span::from_millis(100));
    if !bench.cut(true) {
        return;
    }
    let silent = until(bench, "the link is down", |reading| reading.link.is_err());
    assert!(write(bench, Action::Hold).is_err(), "a command that cannot arrive is not taken");
    bench.pass(Span::from_millis(200));
    let later = read(bench);
    assert_eq!(later.report.answered_at, silent.report.answered_at, "nothing was answered meanwhile");
    bench.cut(false);
    let back = keep(bench, Action::Hold, "it answers again", |report| {
        report.answered_at > silent.report.answered_at && report.trouble.is_none()
    });
    if back.homing == Homing::Homed {
        assert!(back.position.distance_m(before.position) < 0.01, "{before:?} {back:?}");
    }
}

fn forgets_with_its_power(bench: &mut dyn Bench) {
    keep(bench, Action::Hold, "it knows no place", |report| {
        report.homing != Homing::Homed || report.trouble.is_some()
    });
    keep(bench, Action::Release, "it can be driven again", |report| {
        report.homing == Homing::NotHomed && report.trouble.is_none()
    });
}

/// On the way to a place, at speed, by setpoints until now.
fn in_motion(bench: &mut dyn Bench, towards: Floor) -> MachineReport {
    let from = keep_for(bench, Action::Hold, Span::from_millis(50)).position;
    course(bench, towards, |report, setpoint| {
        // Half way, both as told and as measured.
        let half = setpoint.position.distance_m(from) < 0.5 * towards.distance_m(from);
        half || report.velocity.norm() < 0.2
    });
    let report = read(bench).report;
    assert!(report.velocity.norm() > 0.2, "{report:?}");
    report
}

/// Drive to a place on a straight line at half a metre a second, for as long as `goes_on` says so.
fn course(bench: &mut dyn Bench, to: Floor, mut goes_on: impl FnMut(&MachineReport, &Setpoint) -> bool) {
    let from = read(bench).report.position;
    let (way, began) = (to - from, bench.now());
    let unit = way.unit().unwrap();
    // Up in half a second, along, and down again: v t - v T.
    let (speed, ramp) = (0.4, 0.5);
    let along = (way.norm() - speed * ramp).max(0.0) / speed;
    loop {
        let t = (bench.now() - began).secs();
        let (s, v, a) = if t < ramp {
            (0.5 * speed * t * t / ramp, speed * t / ramp, speed / ramp)
        } else if t < ramp + along {
            (0.5 * speed * ramp + speed * (t - ramp), speed, 0.0)
        } else {
            let left = (2.0 * ramp + along - t).max(0.0);
            (way.norm() - 0.5 * speed * left * left / ramp, speed * left / ramp, -speed / ramp)
        };
        let over = t >= 2.0 * ramp + along;
        let setpoint = Setpoint {
            position: from + unit * s.min(way.norm()),
            velocity: unit * v,
            acceleration: if over { Planar::ZERO } else { unit * a },
            valid_for: VALID_FOR,
        };
        write(bench, Action::Track(setpoint)).unwrap();
        bench.pass(PERIOD);
        if !goes_on(&read(bench).report, &setpoint) || over {
            return;
        }
    }
}

/// The greatest way to rest that separation allows for, m, and what a machine may be off.
fn brakes_within(moving: &MachineReport, limits: &Limits) -> f64 {
    let state = State::moving(moving.position, moving.velocity);
    let (least, most) = BrakePath::worst(&state, limits, VALID_FOR.secs()).extent();
    (most - least).norm() + 0.03
}

fn confirmed(bench: &mut dyn Bench, told: Time) {
    let give_up = bench.now() + PATIENCE;
    while bench.gantry().taken() < told {
        assert!(bench.now() < give_up, "the command of {told:?} was not confirmed");
        bench.pass(PERIOD);
        read(bench);
    }
}

fn rests(report: &MachineReport) -> bool {
    report.velocity.norm() < AT_REST_MPS
}

fn at_rest(position: Floor) -> Setpoint {
    Setpoint { position, velocity: Planar::ZERO, acceleration: Planar::ZERO, valid_for: VALID_FOR }
}

fn read(bench: &mut dyn Bench) -> Reading {
    let now = bench.now();
    bench.gantry().read(now)
}

fn write(bench: &mut dyn Bench, action: Action) -> Result<(), NotTaken> {
    let now = bench.now();
    let (limits, travel) = (bench.gantry().limits(), bench.gantry().travel());
    let clear = ArenaConfirmedClear::by_a_person_who_looked();
    let command = Vetted::on_clear_course(clear, now, action, &limits, &travel).unwrap();
    bench.gantry().write(now, &command)
}

/// Say nothing until a reading is so.
fn until(bench: &mut dyn Bench, what: &str, is: impl Fn(&Reading) -> bool) -> Reading {
    let give_up = bench.now() + PATIENCE;
    loop {
        let reading = read(bench);
        if is(&reading) {
            return reading;
        }
        assert!(bench.now() < give_up, "never: {what}; at last {reading:?}");
        bench.pass(PERIOD);
    }
}

/// Say the same, period by period, until the report is so.
fn keep(
    bench: &mut dyn Bench,
    action: Action,
    what: &str,
    is: impl Fn(&MachineReport) -> bool,
) -> MachineReport {
    let give_up = bench.now() + PATIENCE;
    loop {
        // A machine that does not answer takes nothing; whether that is allowed is what `is` looks at.
        let _ = write(bench, action);
        bench.pass(PERIOD);
        let report = read(bench).report;
        if is(&report) {
            return report;
        }
        assert!(bench.now() < give_up, "never: {what}; at last {report:?}");
    }
}

fn keep_for(bench: &mut dyn Bench, action: Action, span: Span) -> MachineReport {
    let until = bench.now() + span;
    let mut report = read(bench).report;
    while bench.now() < until {
        // As in `keep`.
        let _ = write(bench, action);
        bench.pass(PERIOD);
        report = read(bench).report;
    }
    report
}

const PERIOD: Span = Span::from_millis(4);
const VALID_FOR: Span = Span::from_millis(50);
const AT_REST_MPS: f64 = 0.01;
const PLACE: Floor = Floor::new(0.8, 0.7);
const HOME_SIDE: Floor = Floor::new(0.2, 0.2);
/// Homing at creep speed over a metre and back, on a machine that others use too.
const PATIENCE: Span = Span::from_millis(90_000);
