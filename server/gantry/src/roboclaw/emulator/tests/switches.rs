//! Every order does what it says.

use super::*;

/// How many of a hundred requests are answered in full and right.
fn answered_of_100(host: &mut Host) -> usize {
    let right = |reply: &[u8]| check_word(&[&[0x80, 78], reply].concat()) == 0 && reply.len() == 10;
    (0..100).filter(|_| right(&host.exchange(&[0x80, 78]))).count()
}

#[test]
fn bytes_are_lost_as_often_as_asked() {
    let mut host = Host::new(setup());
    host.order("lose 0.02");
    // Twelve bytes have to arrive.
    let found = answered_of_100(&mut host);
    assert!((60..95).contains(&found), "{found}");
    host.order("lose 1");
    assert_eq!(host.exchange(&[0x80, 78]), []);
    host.order("lose 0");
    assert_eq!(answered_of_100(&mut host), 100);
}

#[test]
fn bits_are_flipped_as_often_as_asked() {
    let mut host = Host::new(setup());
    host.order("flip 0.02");
    let found = answered_of_100(&mut host);
    assert!((60..95).contains(&found), "{found}");
    host.order("flip 1");
    assert!(!host.tell(14, &[2]));
    host.order("flip 0");
    host.run_secs(0.02);
    assert_eq!(host.ask(15).unwrap(), [0], "a flipped packet was not obeyed");
}

#[test]
fn replies_come_late_and_in_their_order() {
    let mut host = Host::new(setup());
    host.order("late 1 30");
    assert_eq!(host.exchange(&packet(0x80, 14, &[2])), []);
    assert_eq!(host.run(Span::from_millis(17)), []);
    assert_eq!(host.run(Span::from_millis(3)), [0xFF]);
    host.send(&packet(0x80, 14, &[3]));
    host.send(&[0x80, 15]);
    assert_eq!(host.run(Span::from_millis(50)), [0xFF, 0x03, 0x1B, 0x07]);
}

#[test]
fn a_missing_reply_is_for_a_command_that_was_done() {
    let mut host = Host::new(setup());
    host.order("missing 1");
    assert!(!host.tell(14, &[2]));
    host.order("missing 0");
    assert_eq!(host.ask(15).unwrap(), [2]);
}

#[test]
fn a_reply_has_a_gap_in_its_middle() {
    let mut host = Host::new(setup());
    host.order("gap 1 12");
    host.send(&[0x80, 78]);
    let mut arrivals = Vec::new();
    while arrivals.len() < 10 {
        host.now = host.emulator.next_due().unwrap();
        let count = host.emulator.poll(host.now).len();
        arrivals.extend(std::iter::repeat_n(host.now.micros(), count));
    }
    let gaps: Vec<_> = arrivals.windows(2).map(|pair| pair[1] - pair[0]).filter(|gap| *gap > 1_000).collect();
    assert_eq!(gaps.len(), 1, "{arrivals:?}");
    assert!((12_086..=12_089).contains(&gaps[0]), "{gaps:?}");
}

#[test]
fn a_brown_out_is_silent_lets_motors_coast_and_forgets_what_was_not_saved() {
    let mut host = Host::tuned();
    let tuned = host.ask(55).unwrap();
    assert!(host.tell(14, &[2]) && host.tell(94, &[0xE2, 0x2E, 0xAB, 0x7A]));
    assert!(host.tell(14, &[9]) && host.tell(28, &longs(&[1, 2, 3, 4])));
    assert!(host.tell(28, &longs(&[0, 0x5_0000, 0x1_0000, 66_000])) && host.tell(14, &[0]));
    assert!(host.tell(35, &longs(&[20_000])));
    host.run_secs(1.0);
    assert!(host.longs(78)[0] > 10_000 && host.speed_mps(Axis::X) > 0.4);
    host.order("brown-out 200");
    assert_eq!(host.exchange(&[0x80, 78]), []);
    host.run_secs(0.1);
    assert_eq!(host.emulator.truth(Axis::X).amps, 0.0);
    // 0.2 s without power and 0.5 s to start.
    host.run_secs(0.55);
    assert_eq!(host.exchange(&[0x80, 78]), []);
    host.run_secs(0.05);
    assert_eq!(host.ask(15).unwrap(), [2], "what was saved");
    assert_eq!(host.ask(55).unwrap(), tuned, "not what was not");
    host.run_secs(1.0);
    let counts = host.longs(78)[0];
    assert!(counts.abs() < 10_000, "encoders begin at zero: {counts}");
    assert_eq!(host.speed_mps(Axis::X), 0.0);
    assert_eq!(host.emulator.traffic().starts, 2);
}

#[test]
fn settings_can_be_read_back_from_what_was_saved() {
    let mut host = Host::new(setup());
    assert!(host.tell(14, &[2]) && host.tell(94, &[0xE2, 0x2E, 0xAB, 0x7A]) && host.tell(14, &[9]));
    assert!(host.tell(95, &[]));
    assert_eq!(host.ask(15).unwrap(), [2]);
}

#[test]
fn a_slipping_encoder_misses_its_share() {
    let mut host = Host::tuned();
    host.order("slip x 0.1");
    assert!(host.tell(37, &longs(&[20_000, 20_000])));
    host.run_secs(1.0);
    for (axis, share) in [(Axis::X, 0.9), (Axis::Y, 1.0)] {
        let truth = host.emulator.truth(axis);
        let moved = (truth.position_m - 2.0) * counts_per_m(axis);
        assert!((truth.counts as f64 / moved - share).abs() < 1e-3, "{truth:?}");
    }
}

#[test]
fn a_jammed_axis_stands_whatever_it_draws() {
    let mut host = Host::tuned();
    host.order("jam y on");
    assert!(host.tell(37, &longs(&[20_000, 20_000])));
    host.run_secs(1.0);
    assert!(host.speed_mps(Axis::X) > 0.4);
    assert_eq!(host.speed_mps(Axis::Y), 0.0);
    assert!(host.emulator.truth(Axis::Y).amps > 14.9);
    host.order("jam y off");
    host.run_secs(1.0);
    assert!(host.speed_mps(Axis::Y) > 0.4);
}

#[test]
fn a_stuck_bridge_does_not_obey() {
    let mut host = Host::tuned();
    host.order("runaway x negative");
    assert!(host.tell(35, &longs(&[5_000])));
    host.run_secs(0.5);
    assert!(host.speed_mps(Axis::X) < -0.5);
}

#[test]
fn a_stuck_e_stop_pin_does_not_follow_the_button() {
    let mut host = Host::with_firmware("newer");
    assert!(host.tell(74, &[0x01, 0, 0]));
    host.order("stick released");
    host.order("press");
    host.run_secs(0.01);
    assert_eq!((host.status(), host.emulator.is_e_stopped()), (0, false));
    host.order("stick pressed");
    host.order("release");
    host.run_secs(0.01);
    assert_eq!((host.status(), host.emulator.is_e_stopped()), (1, true));
    host.order("stick off");
    host.run_secs(0.01);
    assert_eq!(host.status(), 0);
}

#[test]
fn another_firmware_comes_with_a_restart() {
    let mut host = Host::with_firmware("newer");
    host.order("firmware older");
    assert_eq!(host.exchange(&[0x80, 21]), []);
    host.run_secs(0.6);
    assert_eq!(host.ask(21).unwrap(), b"USB Roboclaw 2x7a v4.1.24\n\0");
    assert_eq!(host.ask(90).unwrap().len(), 2);
    host.order("firmware unknown");
    host.run_secs(0.6);
    assert_eq!(host.ask(21).unwrap(), b"USB Roboclaw 2x15a v9.0.1\n\0");
}

#[test]
fn a_low_supply_opens_the_bridges_and_a_high_one_brakes() {
    let mut host = Host::tuned();
    assert!(host.tell(57, &[0, 180, 1, 4]));
    assert!(host.tell(35, &longs(&[20_000])));
    host.run_secs(0.5);
    host.order("supply 17.5");
    host.run_secs(0.05);
    assert_eq!(host.ask(24).unwrap(), [0, 175]);
    assert_eq!(host.status(), 0x0008_4000);
    assert_eq!(host.emulator.truth(Axis::X).amps, 0.0);
    host.order("supply 27");
    host.run_secs(0.5);
    assert_eq!(host.status(), 0x0004_0008);
    assert_eq!(host.speed_mps(Axis::X), 0.0);
}

#[test]
fn a_hot_board_warns_and_then_stops() {
    let mut host = Host::tuned();
    assert!(host.tell(35, &longs(&[20_000])));
    host.run_secs(0.5);
    host.order("temperature 90");
    host.run_secs(0.1);
    assert_eq!(host.ask(82).unwrap(), 900_u16.to_be_bytes());
    assert_eq!(host.status(), 0x0010_0000);
    assert!(host.speed_mps(Axis::X) > 0.4);
    host.order("temperature 101");
    host.run_secs(0.5);
    assert_eq!(host.status(), 0x0010_0002);
    assert_eq!(host.speed_mps(Axis::X), 0.0);
}

#[test]
fn somebody_can_lean_on_it() {
    let mut host = Host::tuned();
    host.run_secs(0.01);
    host.order("push x 40");
    host.run_secs(1.0);
    assert!(host.position_m(Axis::X) > 2.01);
}

#[test]
fn an_order_for_later_comes_later() {
    let mut host = Host::tuned();
    host.run_secs(0.01);
    host.order("after 0.5 press");
    host.order("after 1 after 0.5 release");
    host.run_secs(0.4);
    assert!(!host.emulator.is_e_stopped());
    host.run_secs(0.2);
    assert!(host.emulator.is_e_stopped());
    host.run_secs(0.8);
    assert!(host.emulator.switches.is_pressed);
    host.run_secs(0.2);
    assert!(!host.emulator.switches.is_pressed);
}

#[test]
fn what_is_on_the_line_is_lost_with_the_cable_and_the_board_stays_powered() {
    let mut host = Host::new(setup());
    assert!(host.tell(14, &[2]));
    host.send(&[0x80, 15]);
    host.run(Span::from_micros(400));
    host.emulator.unplug(host.now);
    assert_eq!(host.run(Span::from_millis(20)), []);
    assert_eq!(host.ask(15).unwrap(), [2]);
}
