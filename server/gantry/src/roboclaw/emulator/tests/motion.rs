//! Each motion command moves the motors that it names, the way that it says, as fast as it says.

use super::*;

/// Speeds of x and y in counts/s once a command has had its effect, as the machine truly has them.
fn speeds_after(command: u8, data: &[u8], secs: f64) -> [f64; 2] {
    let mut host = Host::tuned();
    assert!(host.tell(command, data), "{command}");
    host.run_secs(secs);
    Axis::BOTH.map(|axis| host.speed_mps(axis) * counts_per_m(axis))
}

fn assert_near(found: [f64; 2], expected: [f64; 2], share: f64, what: &str) {
    for (found, expected) in found.into_iter().zip(expected) {
        assert!((found - expected).abs() <= share * expected.abs(), "{what}: {found} for {expected}");
    }
}

fn with(mut bytes: Vec<u8>, last: u8) -> Vec<u8> {
    bytes.push(last);
    bytes
}

#[test]
fn speeds_are_reached_with_their_sign() {
    let (v, w, a, far) = (20_000_i64, -12_000_i64, 60_000_i64, 10_000_000_i64);
    for (command, data, expected) in [
        (35, longs(&[v]), [v, 0]),
        (36, longs(&[w]), [0, w]),
        (37, longs(&[v, w]), [v, w]),
        (38, longs(&[a, v]), [v, 0]),
        (39, longs(&[a, w]), [0, w]),
        (40, longs(&[a, v, w]), [v, w]),
        (50, longs(&[a, w, 2 * a, v]), [w, v]),
        (41, with(longs(&[v, far]), 0), [v, 0]),
        (42, with(longs(&[w, far]), 1), [0, w]),
        (43, with(longs(&[v, far, w, far]), 1), [v, w]),
        (44, with(longs(&[a, v, far]), 1), [v, 0]),
        (45, with(longs(&[a, w, far]), 0), [0, w]),
        (46, with(longs(&[a, v, far, w, far]), 1), [v, w]),
        (51, with(longs(&[a, w, far, a, v, far]), 1), [w, v]),
        (65, with(longs(&[a, v, a, 60_000]), 1), [v, 0]),
        (66, with(longs(&[a, v, a, -60_000]), 1), [0, -v]),
        (67, with(longs(&[a, v, a, -60_000, a, v, a, 60_000]), 1), [-v, v]),
    ] {
        let found = speeds_after(command, &data, 0.8);
        assert_near(found, expected.map(|cps| cps as f64), 0.02, &format!("{command}"));
    }
}

#[test]
fn duties_lead_to_the_speed_where_back_emf_and_friction_take_them_up() {
    let machine = setup().machine;
    let speed_at = |duty: f64, axis: Axis| {
        let parameters = [machine.x, machine.y][axis.index()];
        let (k, r) = (parameters.force_per_amp(), parameters.motor.resistance_ohm);
        let pull = k / r * 24.0 * duty.abs() - parameters.coulomb_n;
        duty.signum() * pull / (k * k / r + parameters.viscous_n_s_per_m) * counts_per_m(axis)
    };
    let duty = |value: i16| value.to_be_bytes().to_vec();
    let (quarter, back) = (8_192, -9_830);
    let x = speed_at(0.25, Axis::X);
    let y = speed_at(-0.3, Axis::Y);
    let accelerated = |value: i16| [duty(value), longs(&[65_534])].concat();
    for (command, data, expected) in [
        (32, duty(quarter), [x, 0.0]),
        (33, duty(back), [0.0, y]),
        (34, [duty(quarter), duty(back)].concat(), [x, y]),
        (52, accelerated(quarter), [x, 0.0]),
        (53, accelerated(back), [0.0, y]),
        (54, [accelerated(quarter), accelerated(back)].concat(), [x, y]),
        (0, vec![32], [speed_at(32.0 / 127.0, Axis::X), 0.0]),
        (1, vec![32], [-speed_at(32.0 / 127.0, Axis::X), 0.0]),
        (4, vec![32], [0.0, speed_at(32.0 / 127.0, Axis::Y)]),
        (5, vec![32], [0.0, -speed_at(32.0 / 127.0, Axis::Y)]),
        (6, vec![80], [speed_at(16.0 / 63.0, Axis::X), 0.0]),
        (7, vec![48], [0.0, speed_at(-16.0 / 63.0, Axis::Y)]),
    ] {
        assert_near(speeds_after(command, &data, 1.5), expected, 0.02, &format!("{command}"));
    }
}

#[test]
fn what_is_read_is_what_the_machine_does() {
    let mut host = Host::tuned();
    assert!(host.tell(50, &longs(&[60_000, 20_000, 60_000, -20_000])));
    host.run_secs(1.5);
    for command in [18, 30] {
        assert!((host.long(command) - 20_000).abs() <= 400, "{command}: {}", host.long(command));
        assert_eq!(host.ask(command).unwrap()[4], 0);
        assert!((host.long(command + 1) + 20_000).abs() <= 400, "{command}: {}", host.long(command + 1));
        assert_eq!(host.ask(command + 1).unwrap()[4], 1);
    }
    for command in [79, 108] {
        let [x, y] = host.longs(command);
        assert!((x - 20_000).abs() <= 400 && (y + 20_000).abs() <= 400, "{command}: {x} {y}");
    }
    let moved = Axis::BOTH.map(|axis| (host.position_m(axis) - 2.0) * counts_per_m(axis));
    let read = host.longs(78);
    // They went on for the 12 ms of the exchange.
    assert!((f64::from(read[0]) - moved[0]).abs() < 300.0 && (f64::from(read[1]) - moved[1]).abs() < 300.0);
    assert_eq!(host.ask(16).unwrap()[4], 0x80);
    // Below zero once: said once.
    assert_eq!(host.ask(17).unwrap()[4], 0x83);
    assert_eq!(host.ask(17).unwrap()[4], 0x82);
    let [x_duty, y_duty] = host.words(48);
    assert!(x_duty > 9_000 && y_duty < -9_000, "{x_duty} {y_duty}");
    // The loop ripples with the counts: means of many.
    let (mut read, mut true_amps) = ([0.0; 2], [0.0; 2]);
    for _ in 0..50 {
        for (axis, found) in Axis::BOTH.into_iter().zip(host.words(49)) {
            read[axis.index()] += f64::from(found) / 100.0 / 50.0;
            true_amps[axis.index()] += host.emulator.truth(axis).amps.abs() / 50.0;
        }
    }
    assert_near(read, true_amps, 0.2, "amperes");
    assert!(read[0] > 0.5 && read[1] > 0.5, "{read:?}");
}

#[test]
fn a_ramp_keeps_its_acceleration() {
    let mut host = Host::tuned();
    assert!(host.tell(38, &longs(&[40_000, 40_000])));
    host.run_secs(0.5 - 0.012);
    let halfway = host.speed_mps(Axis::X) * counts_per_m(Axis::X);
    assert!((halfway - 20_000.0).abs() < 1_000.0, "{halfway}");
}

#[test]
fn a_distance_is_covered_and_then_the_axis_ramps_to_rest() {
    let mut host = Host::tuned();
    let (v, a, distance) = (20_000_i64, 40_000_i64, 15_000_i64);
    assert!(host.tell(44, &with(longs(&[a, v, distance]), 1)));
    assert_eq!(host.ask(47).unwrap(), [0, 0x80]);
    host.run_secs(2.5);
    assert_eq!(host.ask(47).unwrap(), [0x80, 0x80]);
    assert_eq!(host.speed_mps(Axis::X), 0.0);
    let braking = (v * v / (2 * a)) as f64;
    let moved = f64::from(host.longs(78)[0]);
    assert!((moved - distance as f64 - braking).abs() < 500.0, "{moved}");
}

#[test]
fn buffered_commands_follow_one_another_as_in_the_makers_example() {
    // 12000 counts/s for 42000 counts, then to rest: 6000 more.
    let mut host = Host::tuned();
    assert!(host.tell(44, &with(longs(&[12_000, 12_000, 42_000]), 0)));
    assert!(host.tell(44, &with(longs(&[12_000, 0, 0]), 0)));
    assert_eq!(host.ask(47).unwrap(), [1, 0x80]);
    host.run_secs(6.0);
    assert_eq!(host.ask(47).unwrap(), [0x80, 0x80]);
    let moved = host.longs(78)[0];
    assert!((moved - 48_000).abs() < 400, "{moved}");
}

#[test]
fn a_position_is_gone_to_and_held() {
    let mut host = Host::tuned();
    assert!(host.tell(65, &with(longs(&[50_000, 30_000, 50_000, 40_000]), 1)));
    host.run_secs(3.0);
    let [x, y] = host.longs(78);
    assert!((x - 40_000).abs() < 60 && y == 0, "{x} {y}");
}

#[test]
fn the_constants_of_the_factory_move_it_too_but_hold_no_position() {
    let mut host = Host::new(setup());
    assert!(host.tell(38, &longs(&[40_000, 20_000])));
    host.run_secs(3.0);
    let speed = host.speed_mps(Axis::X) * counts_per_m(Axis::X);
    assert!((speed - 20_000.0).abs() < 1_000.0, "{speed}");
    assert!(host.tell(35, &longs(&[0])));
    host.run_secs(1.0);
    let before = host.position_m(Axis::X);
    assert!(host.tell(65, &with(longs(&[50_000, 30_000, 50_000, 0]), 1)));
    host.run_secs(1.0);
    assert!((host.position_m(Axis::X) - before).abs() < 1e-3);
}

#[test]
fn motors_stop_when_nothing_valid_comes_for_the_serial_timeout() {
    let mut host = Host::tuned();
    assert!(host.tell(14, &[2]));
    assert!(host.tell(37, &longs(&[20_000, -20_000])));
    // Reading keeps them going.
    for _ in 0..10 {
        host.ask(78).unwrap();
        host.run_secs(0.15);
    }
    assert!(host.speed_mps(Axis::X) > 0.4 && host.speed_mps(Axis::Y) < -0.4);
    // What is not valid does not.
    let mut wrong = packet(0x80, 37, &longs(&[20_000, -20_000]));
    wrong[5] ^= 1;
    host.send(&wrong);
    host.run_secs(0.035);
    assert!(host.speed_mps(Axis::X) > 0.4 && host.speed_mps(Axis::Y) < -0.4, "0.2 s are not over yet");
    host.run_secs(0.5);
    assert_eq!(Axis::BOTH.map(|axis| host.speed_mps(axis)), [0.0, 0.0]);
    // They do not go on by themselves when it hears again.
    host.ask(78).unwrap();
    host.run_secs(0.1);
    assert_eq!(host.speed_mps(Axis::X), 0.0);
}

#[test]
fn without_a_serial_timeout_they_go_on() {
    let mut host = Host::tuned();
    assert!(host.tell(35, &longs(&[5_000])));
    host.run_secs(5.0);
    assert!(host.speed_mps(Axis::X) > 0.1);
}

#[test]
fn the_maximum_current_is_kept_and_said() {
    let mut host = Host::tuned();
    assert!(host.tell(133, &longs(&[300, 0])));
    host.order("jam x on");
    assert!(host.tell(35, &longs(&[20_000])));
    host.run_secs(0.5);
    assert!((host.emulator.truth(Axis::X).amps - 3.0).abs() < 1e-9);
    assert_eq!(host.words(49)[0], 300);
    assert_eq!(host.status(), 0x0001_0000);
}

#[test]
fn two_boards_have_an_axis_each_on_m1() {
    let mut host = Host::new(Setup { wiring: Wiring::TwoBoards, eeprom: Eeprom::Tuned, ..setup() });
    for (address, cps) in [(0x80, 20_000), (0x81, -20_000)] {
        assert_eq!(host.exchange(&packet(address, 35, &longs(&[cps]))), [0xFF]);
    }
    host.run_secs(0.5);
    assert!(host.speed_mps(Axis::X) > 0.4 && host.speed_mps(Axis::Y) < -0.4);
    let y = host.ask_at(0x81, 78).unwrap();
    assert!(i32::from_be_bytes(y[..4].try_into().unwrap()) < -5_000);
    assert_eq!(y[4..], [0; 4]);
    assert_eq!(host.exchange(&[0x82, 78]), []);
}

#[test]
fn encoder_modes_turn_directions_round() {
    let mut host = Host::tuned();
    assert!(host.tell(92, &[0x60]));
    assert!(host.tell(35, &longs(&[20_000])));
    host.run_secs(0.5);
    assert!(host.speed_mps(Axis::X) < -0.4);
    assert!(host.longs(78)[0] > 5_000);
}

#[test]
fn errors_beyond_their_limits_stop_the_motor_until_a_restart() {
    let mut host = Host::tuned();
    assert!(host.tell(109, &longs(&[8_000, 8_000])));
    assert!(host.tell(38, &longs(&[40_000, 20_000])));
    host.run_secs(1.0);
    assert_eq!(host.status(), 0);
    host.order("jam x on");
    host.run_secs(0.2);
    assert_eq!(host.status() & 0x0100, 0x0100);
    host.order("jam x off");
    assert!(host.tell(38, &longs(&[40_000, 20_000])));
    host.run_secs(0.5);
    assert_eq!(host.speed_mps(Axis::X), 0.0);
    host.order("brown-out 100");
    host.run_secs(1.0);
    assert_eq!(host.status(), 0);
}
