//! From bytes to packets, as the boards on a line see them.
//!
//! A packet is address, command, data and, for commands that change something, the check word over all of that. It
//! says nothing of its own length: the command does. Requests to read carry no check word (manual; a trace of a real
//! board on the maker's forum, topic 1164, shows `80 15` answered).
//!
//! - A gap of more than 10 ms between two bytes discards what came before it (manual, "Packet Timeout").
//! - A packet with a wrong check word is dropped and not answered (manual, "Packet Acknowledgement").
//! - *Unverified:* a byte that is no address is passed over where a packet would begin. After a command that the board
//!   does not know nobody can tell where the packet ends, so everything is dropped until such a gap.

use covr_engine::time::Span;

use super::commands::{Shape, Sort};
use super::crc::check_word;
use crate::emulation::line::Moment;

/// Collects bytes until they are a packet.
#[derive(Debug, Clone, Default)]
pub(super) struct Framer {
    bytes: Vec<u8>,
    last_at: Option<Moment>,
    waits_for_gap: bool,
}

/// A whole packet with a right check word.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Packet {
    pub(super) address: u8,
    pub(super) command: u8,
    pub(super) data: Vec<u8>,
}

impl Framer {
    /// A byte whose last bit is over at `at`; what shape a command has says `shape`.
    pub(super) fn push(
        &mut self,
        at: Moment,
        byte: u8,
        shape: impl Fn(u8, u8) -> Option<Shape>,
    ) -> Option<Packet> {
        if self.last_at.is_some_and(|last| last.later(LONGEST_GAP) < at) {
            self.forget();
        }
        self.last_at = Some(at);
        if self.waits_for_gap || (self.bytes.is_empty() && !ADDRESSES.contains(&byte)) {
            return None;
        }
        self.bytes.push(byte);
        let [address, command, ref rest @ ..] = self.bytes[..] else { return None };
        let Some(shape) = shape(address, command) else {
            self.bytes.clear();
            self.waits_for_gap = true;
            return None;
        };
        let check_bytes = match shape.sort {
            Sort::Read => 0,
            Sort::Write => 2,
        };
        if rest.len() < shape.data_bytes + check_bytes {
            return None;
        }
        let (told, check) = self.bytes.split_at(2 + shape.data_bytes);
        let is_right = check.is_empty() || check == check_word(told).to_be_bytes();
        let packet = is_right.then(|| Packet { address, command, data: told[2..].to_vec() });
        self.bytes.clear();
        packet
    }

    /// As after a long gap.
    pub(super) fn forget(&mut self) {
        *self = Self::default();
    }
}

/// Of packet serial (manual, "Address").
pub(super) const ADDRESSES: std::ops::RangeInclusive<u8> = 0x80..=0x87;
const LONGEST_GAP: Span = Span::from_millis(10);

#[cfg(test)]
mod tests {
    use super::*;

    /// 14 takes a byte, 15 is read.
    fn shape(_: u8, command: u8) -> Option<Shape> {
        match command {
            14 => Some(Shape { sort: Sort::Write, data_bytes: 1 }),
            15 => Some(Shape { sort: Sort::Read, data_bytes: 0 }),
            _ => None,
        }
    }

    /// Bytes 0.1 ms apart, from a time on.
    fn feed(framer: &mut Framer, from_micros: i64, bytes: &[u8]) -> Vec<Packet> {
        let at = |index: i64| Moment((from_micros + 100 * index) * 1_000);
        (0..).zip(bytes).filter_map(|(index, byte)| framer.push(at(index), *byte, shape)).collect()
    }

    fn timeout(tenths: u8) -> Vec<u8> {
        let mut bytes = vec![0x80, 14, tenths];
        bytes.extend(check_word(&bytes).to_be_bytes());
        bytes
    }

    #[test]
    fn packets_follow_one_another() {
        let mut framer = Framer::default();
        let mut bytes = timeout(5);
        bytes.extend([0x81, 15]);
        let found = feed(&mut framer, 0, &bytes);
        assert_eq!(
            found,
            [
                Packet { address: 0x80, command: 14, data: vec![5] },
                Packet { address: 0x81, command: 15, data: vec![] }
            ]
        );
    }

    #[test]
    fn a_gap_of_ten_milliseconds_is_still_one_packet_and_a_longer_one_is_not() {
        for (gap_micros, packets) in [(10_000, 1), (10_001, 0)] {
            let mut framer = Framer::default();
            let bytes = timeout(5);
            assert_eq!(feed(&mut framer, 0, &bytes[..3]), []);
            assert_eq!(feed(&mut framer, 200 + gap_micros, &bytes[3..]).len(), packets, "{gap_micros}");
        }
    }

    #[test]
    fn a_wrong_check_word_drops_the_packet_and_the_next_one_counts() {
        let mut framer = Framer::default();
        let mut bytes = timeout(5);
        bytes[2] ^= 0x10;
        bytes.extend(timeout(6));
        assert_eq!(feed(&mut framer, 0, &bytes), [Packet { address: 0x80, command: 14, data: vec![6] }]);
    }

    #[test]
    fn after_an_unknown_command_only_a_gap_helps() {
        let mut framer = Framer::default();
        assert_eq!(feed(&mut framer, 0, &[0x80, 200]), []);
        assert_eq!(feed(&mut framer, 300, &[0x80, 15]), []);
        assert_eq!(feed(&mut framer, 10_600, &[0x80, 15]).len(), 1);
    }

    #[test]
    fn bytes_that_are_no_address_are_passed_over() {
        let mut framer = Framer::default();
        assert_eq!(feed(&mut framer, 0, &[0x00, 0x7F, 0xFF, 0x80, 15]).len(), 1);
    }
}
