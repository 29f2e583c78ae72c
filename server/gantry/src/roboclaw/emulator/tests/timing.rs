//! Bytes are seen when the line has carried them, and not before.

use super::*;

/// When a whole reply of so many bytes is there, from the start of the request, in microseconds.
fn micros_for(host: &mut Host, request: &[u8], reply_bytes: usize) -> i64 {
    let from = host.now;
    host.send(request);
    let mut bytes = 0;
    while bytes < reply_bytes {
        host.now += Span::from_micros(1);
        bytes += host.emulator.poll(host.now).len();
        assert!(host.now - from < Span::from_millis(100), "{bytes} bytes");
    }
    (host.now - from).micros()
}

#[test]
fn an_exchange_takes_ten_bits_a_byte_and_the_boards_turnaround() {
    for (baud, turnaround) in [(460_800, 200.0), (115_200, 200.0), (38_400, 1_000.0)] {
        let mut host = Host::new(Setup { baud, ..setup() });
        let found = micros_for(&mut host, &[0x80, 78], 10);
        // Two bytes there, ten back.
        let expected = 12.0 * 10.0 / f64::from(baud) * 1e6 + turnaround;
        assert!((found as f64 - expected).abs() <= 2.0, "{baud}: {found} for {expected}");
    }
}

#[test]
fn a_usb_bridge_hands_replies_over_at_its_own_times() {
    let setup = Setup { usb_latency: Some(Span::from_millis(16)), ..setup() };
    let mut host = Host::new(setup);
    for _ in 0..3 {
        micros_for(&mut host, &[0x80, 78], 10);
        assert_eq!(host.now.micros() % 16_000, 0, "{:?}", host.now);
    }
    // Alone on USB it answers to every address.
    assert!(host.exchange(&[0x85, 78]).is_empty(), "not within 12 ms");
    assert_eq!(host.run(Span::from_millis(16)).len(), 10);
}

#[test]
fn it_says_when_there_is_something_to_do() {
    let mut host = Host::new(setup());
    assert_eq!(host.emulator.next_due(), None);
    host.send(&[0x80, 15]);
    assert_eq!(host.emulator.backlog(), 2);
    let mut looks = 0;
    let mut bytes = Vec::new();
    while let Some(due) = host.emulator.next_due() {
        bytes.extend(host.emulator.poll(due));
        looks += 1;
    }
    assert_eq!((bytes.len(), looks), (3, 5));
    assert_eq!(host.emulator.backlog(), 0);
}

#[test]
fn a_setup_that_no_board_has_is_refused() {
    let refused = |setup| Emulator::new(setup).unwrap_err().to_string();
    assert!(refused(Setup { baud: 100_000, ..setup() }).contains("found 100000, expected 2400"));
    assert!(refused(Setup { address: 0x7F, ..setup() }).contains("found 0x7f, expected 0x80 to 0x87"));
    let second_is_beyond = Setup { address: 0x87, wiring: Wiring::TwoBoards, ..setup() };
    assert!(refused(second_is_beyond).contains("0x87"));
    assert!(refused(Setup { usb_latency: Some(Span::ZERO), ..setup() }).contains("found 0 microseconds"));
    let mut machine = setup().machine;
    machine.supply_volts = 0.0;
    assert!(refused(Setup { machine, ..setup() }).contains("supply_volts"));
}
