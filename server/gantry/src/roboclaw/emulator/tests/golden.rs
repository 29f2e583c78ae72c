//! Packets written out from the manual. Their check words were worked out with another implementation of the same CRC
//! (`crc_hqx` of Python's `binascii`), which gives the trace of a real board below.

use super::*;

/// What is sent, and what comes back.
fn check(host: &mut Host, exchanges: &[(&[u8], &[u8])]) {
    for (sent, expected) in exchanges {
        let found = host.exchange(sent);
        assert_eq!(found, *expected, "{sent:02X?} was answered with {found:02X?}");
    }
}

#[test]
fn a_version_reads_as_in_the_trace_of_a_real_board() {
    // Maker's forum, topic 1164: a 2x7a, 80 15 and what it answered.
    let mut firmware: Firmware = "4.1.34".parse().unwrap();
    firmware.says = "USB Roboclaw 2x7a v4.1.34";
    let mut host = Host::new(Setup { firmware, ..setup() });
    let mut expected = b"USB Roboclaw 2x7a v4.1.34\n\0".to_vec();
    expected.extend([0x0B, 0xF6]);
    check(&mut host, &[(&[0x80, 0x15], &expected)]);
}

#[test]
fn a_serial_timeout_is_set_and_read() {
    let mut host = Host::new(setup());
    check(&mut host, &[(&[0x80, 0x0E, 0x02, 0x38, 0x17], &[0xFF]), (&[0x80, 0x0F], &[0x02, 0x0B, 0x26])]);
}

#[test]
fn encoders_are_set_reset_and_read() {
    let mut host = Host::new(setup());
    check(
        &mut host,
        &[
            (&[0x80, 0x16, 0xFF, 0xFF, 0xFF, 0xFE, 0x94, 0x11], &[0xFF]),
            (&[0x80, 0x10], &[0xFF, 0xFF, 0xFF, 0xFE, 0x80, 0xCE, 0x54]),
            (&[0x80, 0x4E], &[0xFF, 0xFF, 0xFF, 0xFE, 0x00, 0x00, 0x00, 0x00, 0x5D, 0xE5]),
            (&[0x80, 0x14, 0x49, 0x2D], &[0xFF]),
        ],
    );
    assert_eq!(host.longs(78), [0, 0]);
}

#[test]
fn batteries_temperatures_currents_and_duties_read_in_their_units() {
    let mut host = Host::new(setup());
    check(
        &mut host,
        &[
            (&[0x80, 0x18], &[0x00, 0xF0, 0xD8, 0xE5]),
            (&[0x80, 0x19], &[0x00, 0x32, 0x16, 0xDB]),
            (&[0x80, 0x52], &[0x01, 0x13, 0xFC, 0xF5]),
            (&[0x80, 0x30], &[0x00, 0x00, 0x00, 0x00, 0xD8, 0xCE]),
            (&[0x80, 0x31], &[0x00, 0x00, 0x00, 0x00, 0x72, 0x9F]),
            (&[0x80, 0x2F], &[0x80, 0x80, 0xFD, 0xDF]),
        ],
    );
}

#[test]
fn velocity_constants_go_in_as_d_p_i_and_come_out_as_p_i_d() {
    let mut host = Host::new(setup());
    check(
        &mut host,
        &[
            // The factory's: P 0x10000, I 0x8000, D 0x4000, 44000.
            (&[0x80, 0x37], &[0, 1, 0, 0, 0, 0, 0x80, 0, 0, 0, 0x40, 0, 0, 0, 0xAB, 0xE0, 0xAB, 0xC0]),
            (&[0x80, 0x1C, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 4, 0x10, 0xD4], &[0xFF]),
            (&[0x80, 0x37], &[0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 1, 0, 0, 0, 4, 0xFA, 0xE5]),
        ],
    );
}

#[test]
fn position_constants_go_in_as_d_p_i_and_come_out_as_p_i_d() {
    let mut host = Host::new(setup());
    let d_p_i = [0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3];
    let p_i_d = [0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 1];
    let rest = [0, 0, 0, 4, 0, 0, 0, 5, 0xFF, 0xFF, 0xFF, 0xFA, 0, 0, 0, 7];
    let sent = [&[0x80, 0x3E][..], &d_p_i, &rest, &[0xFB, 0xD5]].concat();
    let read = [&p_i_d[..], &rest, &[0xEA, 0x15]].concat();
    check(&mut host, &[(&sent, &[0xFF]), (&[0x80, 0x40], &read)]);
}

#[test]
fn pins_limits_and_currents_are_set_and_read() {
    let mut host = Host::new(setup());
    check(
        &mut host,
        &[
            (&[0x80, 0x4A, 0x01, 0x62, 0x62, 0x32, 0x7B], &[0xFF]),
            (&[0x80, 0x4B], &[0x01, 0x62, 0x62, 0x44, 0xCF]),
            // 18.0 to 26.0 V; then what the factory has is gone.
            (&[0x80, 0x3B], &[0x00, 0x3C, 0x01, 0x54, 0xAD, 0xB5]),
            (&[0x80, 0x39, 0x00, 0xB4, 0x01, 0x04, 0x21, 0x38], &[0xFF]),
            // 5 A on M1 and M2.
            (&[0x80, 0x85, 0, 0, 0x01, 0xF4, 0, 0, 0, 0, 0xDF, 0xBA], &[0xFF]),
            (&[0x80, 0x86, 0, 0, 0x01, 0xF4, 0, 0, 0, 0, 0xF2, 0xFE], &[0xFF]),
            (&[0x80, 0x87], &[0, 0, 0x01, 0xF4, 0, 0, 0, 0, 0x19, 0xDD]),
            // Packet serial, 115200, address 0x80.
            (&[0x80, 0x63], &[0x00, 0xA3, 0x9A, 0x8A]),
        ],
    );
    assert_eq!(host.ask(59).unwrap(), [0, 180, 1, 4]);
    assert_eq!(host.ask(136).unwrap()[..4], [0, 0, 1, 0xF4]);
}

#[test]
fn settings_are_saved_with_the_key_alone() {
    let mut host = Host::new(setup());
    check(
        &mut host,
        &[(&[0x80, 0x5E, 0xE2, 0x2E, 0xAB, 0x7A, 0xE4, 0xA6], &[0xFF]), (&[0x80, 0x5F, 0xB0, 0x82], &[0xFF])],
    );
    assert!(!host.tell(94, &[0, 0, 0, 0]));
}

#[test]
fn the_status_is_as_long_as_the_firmware_says() {
    let mut older = Host::with_firmware("older");
    check(&mut older, &[(&[0x80, 0x5A], &[0x00, 0x00, 0x44, 0x37])]);
    older.order("press");
    older.run_secs(0.002);
    check(&mut older, &[(&[0x80, 0x5A], &[0x00, 0x04, 0x04, 0xB3])]);
    let mut newer = Host::with_firmware("newer");
    check(&mut newer, &[(&[0x80, 0x5A], &[0x00, 0x00, 0x00, 0x00, 0x87, 0xBC])]);
    newer.order("press");
    newer.run_secs(0.002);
    check(&mut newer, &[(&[0x80, 0x5A], &[0x00, 0x00, 0x00, 0x01, 0x97, 0x9D])]);
}

#[test]
fn motion_commands_are_acknowledged() {
    let mut host = Host::new(setup());
    check(
        &mut host,
        &[
            (
                // Both accelerate at 20000 counts/s2, to 10000 and -10000 counts/s.
                &[
                    0x80, 0x32, 0, 0, 0x4E, 0x20, 0, 0, 0x27, 0x10, 0, 0, 0x4E, 0x20, 0xFF, 0xFF, 0xD8, 0xF0,
                    0x61, 0x5C,
                ],
                &[0xFF],
            ),
            (
                // The same for 2500 counts, at once.
                &[
                    0x80, 0x33, 0, 0, 0x4E, 0x20, 0, 0, 0x27, 0x10, 0, 0, 0x09, 0xC4, 0, 0, 0x4E, 0x20, 0xFF,
                    0xFF, 0xD8, 0xF0, 0, 0, 0x09, 0xC4, 0x01, 0x23, 0x7B,
                ],
                &[0xFF],
            ),
        ],
    );
}

#[test]
fn a_packet_with_a_wrong_check_word_or_for_somebody_else_is_not_answered() {
    let mut host = Host::new(setup());
    check(
        &mut host,
        &[
            (&[0x80, 0x0E, 0x02, 0x38, 0x16], &[]),
            (&[0x80, 0x0F], &[0x00, 0x2B, 0x64]),
            (&[0x81, 0x0F], &[]),
            (&[0x80, 0xC8], &[]),
        ],
    );
}

#[test]
fn every_command_of_the_table_is_answered_and_no_other() {
    for firmware in Firmware::ALL {
        let mut host = Host::new(Setup { firmware, ..setup() });
        for command in 0..=255 {
            let Some(shape) = commands::shape(command, &firmware) else {
                assert_eq!(host.exchange(&[0x80, command]), [], "{command}");
                continue;
            };
            match shape.sort {
                commands::Sort::Read => {
                    assert!(!host.ask(command).unwrap().is_empty(), "{command} of {}", firmware.name);
                }
                // Without its key.
                commands::Sort::Write if command == 94 => {}
                commands::Sort::Write => {
                    assert!(host.tell(command, &vec![0; shape.data_bytes]), "{command} of {}", firmware.name);
                }
            }
        }
    }
}
