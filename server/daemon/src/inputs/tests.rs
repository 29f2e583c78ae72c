//! Inputs from a pseudo-terminal and from a value file.

use std::io::Write;
use std::path::Path;
use std::time::Instant;

use nix::pty::openpty;
use nix::unistd::ttyname;

use super::*;
use crate::config::Level;

fn input(kind: InputKind, source: &Path, heartbeat_timeout_secs: f64) -> Input {
    Input { name: "mat".into(), kind, source: source.into(), active: Level::Low, heartbeat_timeout_secs }
}

/// Look until the inputs are so.
fn until(lines: &mut InputLines, clock: Clock, what: impl Fn(&Inputs) -> bool) {
    let begun = Instant::now();
    loop {
        let seen = lines.look(clock.now(), false, &mut Vec::new());
        if what(&seen) {
            return;
        }
        assert!(begun.elapsed() < Duration::from_secs(10), "{seen:?}");
        std::thread::yield_now();
    }
}

fn is_active(inputs: &Inputs) -> bool {
    matches!(&inputs.intruder, InputLevel::Active(name) if &**name == "mat")
}

fn is_silent(inputs: &Inputs) -> bool {
    matches!(&inputs.intruder, InputLevel::Silent(name) if &**name == "mat")
}

fn is_inactive(inputs: &Inputs) -> bool {
    inputs.intruder == InputLevel::Inactive
}

#[test]
fn a_serial_line_is_heard_and_a_cut_one_is_active() {
    let ends = openpty(None, None).unwrap();
    let path = ttyname(&ends.slave).unwrap();
    let mut far_end = std::fs::File::from(ends.master);
    let clock = Clock::started_now();
    far_end.write_all(b"1\n").unwrap();
    let mut lines = InputLines::start(&[input(InputKind::Intruder, &path, 10.0)], clock).unwrap();
    drop(ends.slave);
    until(&mut lines, clock, is_inactive);
    far_end.write_all(b"0\r\n").unwrap();
    until(&mut lines, clock, is_active);
    far_end.write_all(b"1\r\n").unwrap();
    until(&mut lines, clock, is_inactive);
    far_end.write_all(b"what?\n").unwrap();
    until(&mut lines, clock, is_silent);
    far_end.write_all(b"1\n").unwrap();
    until(&mut lines, clock, is_inactive);
    drop(far_end);
    until(&mut lines, clock, is_silent);
}

#[test]
fn a_line_that_stays_as_it_is_is_active_after_the_heartbeat_timeout() {
    let lane = Lane::new(Span::from_millis(100));
    assert_eq!(lane.look(Time::ZERO), Seen::Silent, "before the first word");
    lane.say(false, Time::from_micros(1_000));
    assert_eq!(lane.look(Time::from_micros(101_000)), Seen::Inactive);
    assert_eq!(lane.look(Time::from_micros(101_001)), Seen::Silent);
    lane.say(true, Time::from_micros(200_000));
    assert_eq!(lane.look(Time::from_micros(300_000)), Seen::Active);
    assert_eq!(lane.look(Time::from_micros(300_001)), Seen::Silent);
}

#[test]
fn an_activation_shorter_than_a_step_is_seen_once() {
    let lane = Arc::new(Lane::new(Span::from_millis(100)));
    let mut line = stop_line(&lane);
    let (now, mut stops) = (Time::from_micros(5_000), Vec::new());
    lane.say(false, now);
    assert_eq!(line.look(now, false, &mut stops), Seen::Inactive);
    lane.say(true, now);
    lane.say(false, now);
    assert_eq!(line.look(now, false, &mut stops), Seen::Active);
    assert_eq!(stops, [InputStop { input: "mat".into(), silent: false, since: now }]);
    assert_eq!(line.look(now, false, &mut stops), Seen::Inactive);
    assert_eq!(stops.len(), 1, "and noted once");
}

#[test]
fn a_stop_is_noted_from_when_it_counts_as_active_and_a_line_that_chatters_then_once_a_second() {
    let lane = Arc::new(Lane::new(Span::from_millis(100)));
    let mut line = stop_line(&lane);
    let at = |millis: i64| Time::from_micros(1_000 * millis);
    let mut look = |latched: bool, millis: i64| {
        let mut stops = Vec::new();
        line.look(at(millis), latched, &mut stops);
        stops.pop().map(|stop| (stop.silent, stop.since))
    };
    lane.say(false, at(1));
    assert_eq!(look(false, 4), None);
    lane.say(true, at(5));
    lane.say(true, at(7));
    assert_eq!(look(false, 8), Some((false, at(5))), "since the first active word");
    assert_eq!(look(true, 12), None);
    for millis in (20..900).step_by(4) {
        lane.say(millis % 8 == 0, at(millis));
        assert_eq!(look(true, millis + 1), None, "{millis} ms");
    }
    lane.say(false, at(910));
    assert_eq!(look(false, 912), None);
    lane.say(true, at(914));
    assert_eq!(look(false, 916), Some((false, at(914))), "after a reset it counts at once");
    lane.say(false, at(1_500));
    assert_eq!(look(false, 1_501), None);
    assert_eq!(look(false, 1_604), Some((true, at(1_600))), "silent since the last word's time was over");
    lane.say(false, at(3_000));
    assert_eq!(look(false, 3_001), None);
    lane.lose(at(3_002));
    assert_eq!(look(false, 3_004), Some((true, at(3_002))));
}

fn stop_line(lane: &Arc<Lane>) -> Line {
    let (lane, seen) = (lane.clone(), Seen::Inactive);
    Line { name: "mat".into(), kind: InputKind::Stop, lane, activations_seen: 0, seen, noted_at: None }
}

#[test]
fn a_value_file_is_read_and_a_missing_one_is_active() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("value");
    std::fs::write(&path, "1\n").unwrap();
    let clock = Clock::started_now();
    let inputs = [input(InputKind::Intruder, &path, 10.0)];
    let mut lines = InputLines::start(&inputs, clock).unwrap();
    assert_eq!(lines.look(clock.now(), false, &mut Vec::new()).stop, InputLevel::Absent);
    until(&mut lines, clock, is_inactive);
    let put = |text: &str| {
        let next = folder.path().join("next");
        std::fs::write(&next, text).unwrap();
        std::fs::rename(&next, &path).unwrap();
    };
    put("0\n");
    until(&mut lines, clock, is_active);
    put("1\n");
    until(&mut lines, clock, is_inactive);
    std::fs::remove_file(&path).unwrap();
    until(&mut lines, clock, is_silent);
    put("1\n");
    until(&mut lines, clock, is_inactive);
}
