//! The pins S3, S4 and S5: stops, homes and limits, in both tables.

use super::*;

/// Drive x towards its low end at a creep.
fn creep_to_the_low_end(host: &mut Host) {
    assert!(host.tell(38, &longs(&[20_000, -10_000])));
    host.run_secs(10.5);
}

fn is_moved_by_a_command(host: &mut Host) -> bool {
    let from = host.position_m(Axis::Y);
    host.tell(39, &longs(&[40_000, 10_000]));
    host.run_secs(0.3);
    let is_moved = host.position_m(Axis::Y) - from > 0.01;
    host.tell(36, &longs(&[0]));
    host.run_secs(0.3);
    is_moved
}

#[test]
fn an_e_stop_that_latches_needs_the_power_cycled_and_another_does_not() {
    for (firmware, code, latches) in [
        ("older", 1, true),
        ("older", 2, false),
        ("newer", 0x81, true),
        ("newer", 0x01, false),
        // As it comes, it latches.
        ("older", 0, true),
        ("newer", 0, true),
    ] {
        let what = format!("{firmware} {code:#x}");
        let e_stop = if firmware == "older" { 0x0004 } else { 0x0001 };
        let mut host = Host::with_firmware(firmware);
        assert!(host.tell(74, &[code, 0, 0]));
        assert!(host.tell(94, &[0xE2, 0x2E, 0xAB, 0x7A]));
        assert!(is_moved_by_a_command(&mut host), "{what}");
        assert_eq!(host.status(), 0, "{what}");
        host.order("press");
        host.run_secs(0.1);
        assert_eq!(host.status(), e_stop, "{what}");
        assert!(!is_moved_by_a_command(&mut host), "{what}");
        host.order("release");
        host.run_secs(0.1);
        assert_eq!(host.status() == 0, !latches, "{what}");
        assert_eq!(is_moved_by_a_command(&mut host), !latches, "{what}");
        host.order("brown-out 50");
        host.run_secs(1.0);
        assert_eq!(host.status(), 0, "{what}");
        assert!(is_moved_by_a_command(&mut host), "{what}");
    }
}

#[test]
fn a_pressed_e_stop_lets_a_moving_column_coast_to_rest() {
    let mut host = Host::tuned();
    assert!(host.tell(37, &longs(&[20_000, 20_000])));
    host.run_secs(1.0);
    host.order("press");
    host.run_secs(0.1);
    assert_eq!(host.emulator.truth(Axis::X).amps, 0.0);
    host.run_secs(2.0);
    assert_eq!(Axis::BOTH.map(|axis| host.speed_mps(axis)), [0.0, 0.0]);
}

#[test]
fn a_home_switch_stops_its_motor_zeroes_its_encoder_and_shows_in_the_status() {
    for (firmware, code, flag) in [("older", 4, 0x4000), ("newer", 0x62, 0x0040_0000)] {
        let mut host = Host::with_firmware(firmware);
        assert!(host.tell(74, &[0, code, code]));
        assert_eq!(host.status(), 0);
        creep_to_the_low_end(&mut host);
        let truth = host.emulator.truth(Axis::X);
        assert!(truth.is_switch_active && truth.speed_mps == 0.0, "{truth:?}");
        // The switch is 1 cm outside the travel, the stop 3 cm.
        assert!(truth.position_m < -0.01 && truth.position_m > -0.025, "{truth:?}");
        assert_eq!(host.status(), flag, "{firmware}");
        let coasted = host.longs(78)[0];
        assert!(coasted <= 0 && coasted > -800, "{coasted}");
        // Back off: the other way is free.
        assert!(host.tell(38, &longs(&[20_000, 10_000])));
        host.run_secs(1.0);
        assert!(host.position_m(Axis::X) > 0.0);
        assert_eq!(host.status(), 0, "{firmware}");
        assert!(host.longs(78)[0] > 4_000);
    }
}

#[test]
fn a_disabled_switch_shows_nothing_and_the_stop_stops() {
    let mut host = Host::tuned();
    assert!(host.tell(133, &longs(&[300, 0])));
    creep_to_the_low_end(&mut host);
    let truth = host.emulator.truth(Axis::X);
    assert!(truth.is_switch_active && truth.position_m < -0.029, "{truth:?}");
    // Stalled against the stop at the maximum current: this is what homing without switches feels for.
    host.run_secs(0.5);
    assert_eq!(host.speed_mps(Axis::X), 0.0);
    assert_eq!(host.words(49)[0], 300);
    assert_eq!(host.status(), 0x0001_0000);
}

#[test]
fn a_stuck_switch_is_never_found_or_there_from_the_beginning() {
    let mut host = Host::with_firmware("newer");
    assert!(host.tell(74, &[0, 0x62, 0x62]) && host.tell(133, &longs(&[200, 0])));
    host.order("switch x inactive");
    creep_to_the_low_end(&mut host);
    assert!(host.position_m(Axis::X) < -0.029, "nothing stops it but the stop");
    assert_eq!(host.status() & 0x0040_0000, 0);
    host.order("switch x off");
    host.run_secs(0.01);
    assert_eq!(host.status() & 0x0040_0000, 0x0040_0000);
    host.order("switch y active");
    host.run_secs(0.01);
    assert_eq!(host.status() & 0x0080_0000, 0x0080_0000);
}

#[test]
fn a_limit_lets_a_motor_go_away_and_not_on() {
    for code in [0x22, 0x32] {
        let mut host = Host::with_firmware("newer");
        assert!(host.tell(74, &[0, code, 0]));
        creep_to_the_low_end(&mut host);
        let stopped_at = host.position_m(Axis::X);
        assert!(stopped_at < -0.01 && stopped_at > -0.025, "{stopped_at}");
        assert!(host.longs(78)[0] < -90_000, "a limit is no home");
        assert!(host.tell(38, &longs(&[20_000, -10_000])));
        host.run_secs(1.0);
        assert!((host.position_m(Axis::X) - stopped_at).abs() < 1e-3);
        assert!(host.tell(38, &longs(&[20_000, 10_000])));
        host.run_secs(1.0);
        assert!(host.position_m(Axis::X) > 0.1);
    }
}

#[test]
fn one_pin_for_both_ends_is_a_limit_at_either() {
    let setup = Setup { eeprom: Eeprom::Tuned, end_switches: EndSwitches::Both, ..setup() };
    let mut host = Host::new(setup);
    assert!(host.tell(74, &[0, 0x32, 0]));
    assert!(host.tell(38, &longs(&[20_000, 10_000])));
    host.run_secs(10.5);
    let stopped_at = host.position_m(Axis::X);
    assert!(stopped_at > 4.01 && stopped_at < 4.025, "{stopped_at}");
    assert!(host.tell(38, &longs(&[20_000, -10_000])));
    host.run_secs(1.0);
    assert!(host.position_m(Axis::X) < 3.9);
}

#[test]
fn of_4_1_34_a_new_switch_works_only_after_saving_and_a_restart() {
    let mut host = Host::with_firmware("4.1.34");
    assert!(host.tell(74, &[0, 0x62, 0x62]));
    assert_eq!(host.ask(75).unwrap(), [0, 0x62, 0x62]);
    // So little that the stop does not throw it back off the switch.
    assert!(host.tell(133, &longs(&[200, 0])));
    creep_to_the_low_end(&mut host);
    assert!(host.position_m(Axis::X) < -0.029, "nothing stops it but the stop");
    assert_eq!(host.status() & 0x0040_0000, 0);
    assert!(host.tell(94, &[0xE2, 0x2E, 0xAB, 0x7A]));
    host.order("brown-out 50");
    host.run_secs(1.0);
    assert_eq!(host.status() & 0x0040_0000, 0x0040_0000);
}

#[test]
fn an_end_switch_can_be_an_e_stop_too() {
    let mut host = Host::with_firmware("newer");
    assert!(host.tell(74, &[0, 0x01, 0]));
    creep_to_the_low_end(&mut host);
    assert_eq!(host.status(), 0x0001);
}
