//! Whatever comes, it does not panic, and after a gap it listens again.

use super::*;
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn any_bytes_are_survived_and_after_ten_milliseconds_of_silence_a_packet_is_answered(
        noise in proptest::collection::vec(any::<u8>(), 0..400),
        firmware in 0..Firmware::ALL.len(),
    ) {
        let mut host = Host::new(Setup { firmware: Firmware::ALL[firmware], ..setup() });
        host.send(&noise);
        // Until the noise is over, and what it made the boards say; then the silence.
        host.run_secs(0.2);
        host.run(Span::from_micros(10_001));
        let reply = host.exchange(&[0x80, 21]);
        let told = [&[0x80, 21][..], &reply].concat();
        prop_assert_eq!(check_word(&told), 0, "{:02X?}", reply);
        prop_assert!(reply.starts_with(b"USB Roboclaw"));
    }

    #[test]
    fn any_command_with_any_data_is_survived(
        commands in proptest::collection::vec((any::<u8>(), proptest::collection::vec(any::<u8>(), 33)), 1..40),
        firmware in 0..Firmware::ALL.len(),
    ) {
        let firmware = Firmware::ALL[firmware];
        let mut host = Host::new(Setup { firmware, ..setup() });
        for (command, data) in commands {
            if let Some(shape) = commands::shape(command, &firmware) {
                match shape.sort {
                    commands::Sort::Read => host.send(&[0x80, command]),
                    commands::Sort::Write => host.send(&packet(0x80, command, &data[..shape.data_bytes])),
                }
                host.run_secs(0.05);
            }
        }
        for axis in Axis::BOTH {
            let truth = host.emulator.truth(axis);
            prop_assert!(truth.position_m.is_finite() && truth.speed_mps.is_finite(), "{truth:?}");
            // The stops hold whatever it was told.
            prop_assert!((-0.5..4.5).contains(&truth.position_m), "{truth:?}");
        }
        prop_assert_eq!(host.ask(21).unwrap(), firmware.version());
    }

    #[test]
    fn the_same_seed_and_bytes_give_the_same_bytes(seed in any::<u64>(), noise in proptest::collection::vec(any::<u8>(), 50)) {
        let run = || {
            let mut host = Host::new(Setup { seed, ..setup() });
            for line in ["lose 0.1", "flip 0.1", "late 0.3 7", "missing 0.2", "gap 0.3 12"] {
                host.order(line);
            }
            let mut bytes = Vec::new();
            for command in noise.chunks(5) {
                host.send(command);
                bytes.push(host.exchange(&[0x80, 78]));
            }
            bytes
        };
        prop_assert_eq!(run(), run());
    }
}
