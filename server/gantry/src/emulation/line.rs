//! The serial line between host and boards: every byte takes its time, ten bits at the line's rate, in each direction
//! on its own. Times are nanoseconds inside, for a byte at 460800 baud is 21.7 microseconds.

use std::collections::VecDeque;

use covr_engine::time::{Span, Time};

/// Both directions.
#[derive(Debug, Clone)]
pub(crate) struct Line {
    byte_nanos: i64,
    /// Bytes reach the host only at multiples of this, as through a USB bridge.
    burst_nanos: Option<i64>,
    to_board: Direction,
    to_host: Direction,
}

/// Bytes with the time at which their last bit is over.
#[derive(Debug, Clone, Default)]
struct Direction {
    bytes: VecDeque<(i64, u8)>,
    free_at: i64,
}

/// A reply on its way to the host.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Reply {
    /// When the board begins to send.
    pub(crate) from: Moment,
    /// What it sends.
    pub(crate) bytes: Vec<u8>,
    /// It pauses after so many bytes for so long.
    pub(crate) pause: Option<(usize, Span)>,
}

/// Nanoseconds on the clock of [`Time`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Moment(pub(crate) i64);

impl Moment {
    /// The first microsecond that is not before it.
    pub(crate) const fn rounded_up(self) -> Time {
        Time::from_micros(self.0.div_euclid(1_000) + (self.0.rem_euclid(1_000) != 0) as i64)
    }

    /// The microsecond that it lies in.
    pub(crate) const fn rounded_down(self) -> Time {
        Time::from_micros(self.0.div_euclid(1_000))
    }

    pub(crate) const fn later(self, span: Span) -> Self {
        Self(self.0.saturating_add(span.micros().saturating_mul(1_000)))
    }
}

impl From<Time> for Moment {
    fn from(time: Time) -> Self {
        Self(time.micros().saturating_mul(1_000))
    }
}

impl Line {
    pub(crate) fn new(baud: u32, burst: Option<Span>) -> Self {
        Self {
            byte_nanos: BITS_A_BYTE * 1_000_000_000 / i64::from(baud),
            burst_nanos: burst.map(|burst| burst.micros() * 1_000),
            to_board: Direction::default(),
            to_host: Direction::default(),
        }
    }

    /// The host hands over a byte; none when the line swallows it, which takes as long.
    pub(crate) fn send_to_board(&mut self, now: Time, byte: Option<u8>) {
        self.to_board.send(Moment::from(now).0, self.byte_nanos, byte);
    }

    /// The next byte that is at the boards by `now`, and since when.
    pub(crate) fn next_at_board(&mut self, now: Time) -> Option<(Moment, u8)> {
        self.to_board.next(Moment::from(now).0)
    }

    /// A board answers.
    pub(crate) fn send_to_host(&mut self, reply: &Reply, mut noise: impl FnMut(u8) -> Option<u8>) {
        let mut earliest = reply.from;
        for (index, byte) in reply.bytes.iter().enumerate() {
            if let Some((after, span)) = reply.pause
                && after == index
            {
                earliest = Moment(earliest.0.max(self.to_host.free_at)).later(span);
            }
            self.to_host.send(earliest.0, self.byte_nanos, noise(*byte));
        }
    }

    /// Everything that is at the host by `now`.
    pub(crate) fn at_host(&mut self, now: Time) -> Vec<u8> {
        let visible = Moment::from(now).0;
        // What was over by the last burst before now.
        let over = self.burst_nanos.map_or(visible, |burst| visible.div_euclid(burst) * burst);
        std::iter::from_fn(|| self.to_host.next(over)).map(|(_, byte)| byte).collect()
    }

    /// When the next byte is over, in either direction, as the boards or the host can see it.
    pub(crate) fn next_due(&self) -> Option<Time> {
        let to_host =
            self.to_host.bytes.front().map(|(over, _)| {
                self.burst_nanos.map_or(*over, |burst| -((-over).div_euclid(burst)) * burst)
            });
        let to_board = self.to_board.bytes.front().map(|(over, _)| *over);
        to_host.into_iter().chain(to_board).min().map(|over| Moment(over).rounded_up())
    }

    /// Bytes that the host has handed over and that are still on their way.
    pub(crate) fn backlog(&self) -> usize {
        self.to_board.bytes.len()
    }

    /// Whatever is on its way is lost.
    pub(crate) fn cut(&mut self) {
        self.to_board.bytes.clear();
        self.to_host.bytes.clear();
    }

    /// What boards have not sent yet is never sent.
    pub(crate) fn silence_boards(&mut self, now: Time) {
        let now = Moment::from(now).0;
        self.to_host.bytes.retain(|(over, _)| *over <= now);
        self.to_host.free_at = self.to_host.free_at.min(now);
    }
}

impl Direction {
    fn send(&mut self, from: i64, byte_nanos: i64, byte: Option<u8>) {
        self.free_at = self.free_at.max(from) + byte_nanos;
        if let Some(byte) = byte {
            self.bytes.push_back((self.free_at, byte));
        }
    }

    fn next(&mut self, by: i64) -> Option<(Moment, u8)> {
        let (over, byte) = *self.bytes.front()?;
        (over <= by).then(|| {
            self.bytes.pop_front();
            (Moment(over), byte)
        })
    }
}

/// 8N1: a start bit, eight bits, a stop bit.
const BITS_A_BYTE: i64 = 10;

#[cfg(test)]
mod tests {
    use super::*;

    fn reply(at_micros: i64, bytes: &[u8], pause: Option<(usize, Span)>) -> Reply {
        Reply { from: Moment::from(Time::from_micros(at_micros)), bytes: bytes.to_vec(), pause }
    }

    #[test]
    fn a_byte_takes_ten_bits_and_bytes_queue_up() {
        let mut line = Line::new(115_200, None);
        for byte in [1, 2] {
            line.send_to_board(Time::ZERO, Some(byte));
        }
        assert_eq!(line.next_due(), Some(Time::from_micros(87)));
        assert_eq!(line.next_at_board(Time::from_micros(86)), None);
        assert_eq!(line.next_at_board(Time::from_micros(87)), Some((Moment(86_805), 1)));
        assert_eq!(line.next_at_board(Time::from_micros(173)), None);
        assert_eq!(line.next_at_board(Time::from_micros(174)), Some((Moment(173_610), 2)));
        assert_eq!(line.next_due(), None);
    }

    #[test]
    fn a_second_is_as_many_bytes_as_the_rate_says() {
        let mut line = Line::new(460_800, None);
        line.send_to_host(&reply(0, &[0; 50_000], None), Some);
        let second = Time::from_micros(1_000_000).micros();
        assert_eq!(line.at_host(Time::from_micros(second)).len(), 46_080);
    }

    #[test]
    fn a_pause_lies_where_it_is_asked_for() {
        let mut line = Line::new(115_200, None);
        line.send_to_host(&reply(0, &[1, 2, 3], Some((2, Span::from_millis(12)))), Some);
        assert_eq!(line.at_host(Time::from_micros(12_173)), [1, 2]);
        assert_eq!(line.next_due(), Some(Time::from_micros(12_261)));
        assert_eq!(line.at_host(Time::from_micros(12_261)), [3]);
    }

    #[test]
    fn a_bridge_hands_over_at_its_own_times() {
        let mut line = Line::new(115_200, Some(Span::from_millis(16)));
        line.send_to_host(&reply(100, &[1, 2], None), Some);
        assert_eq!(line.next_due(), Some(Time::from_micros(16_000)));
        assert_eq!(line.at_host(Time::from_micros(15_999)), []);
        assert_eq!(line.at_host(Time::from_micros(16_000)), [1, 2]);
    }

    #[test]
    fn a_lost_byte_takes_its_time() {
        let mut line = Line::new(115_200, None);
        line.send_to_board(Time::ZERO, None);
        line.send_to_board(Time::ZERO, Some(2));
        assert_eq!(line.next_due(), Some(Time::from_micros(174)));
    }
}
