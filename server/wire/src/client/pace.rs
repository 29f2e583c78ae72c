//! Order and rate of a client's messages, on the caller's clock.

use covr_engine::time::Time;

/// Lets through poses in their order only. One for each person of a connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Sequencer {
    last: Option<u32>,
}

/// A pose that is not newer than the last.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("sequence: found {found}, expected more than {last}")]
pub struct OutOfOrder {
    /// Its sequence.
    pub found: u32,
    /// The last one let through.
    pub last: u32,
}

/// How much trouble a client makes, as two leaky buckets: messages and errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AbuseGauge {
    messages: Bucket,
    errors: Bucket,
}

/// What to do about a client.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Nothing.
    Fine,
    /// Drop the message and say so.
    Warn,
    /// Say why and close.
    Close,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Bucket {
    level: f64,
    leaks_per_sec: f64,
    warns_at: f64,
    closes_at: f64,
    at: Option<Time>,
}

impl Sequencer {
    /// Let a pose through if its sequence is newer than the last one let through.
    ///
    /// Newer means 1 to 2^31 - 1 steps ahead modulo 2^32, so that the number may wrap: after 4294967295 comes 0.
    /// A refused sequence changes nothing.
    pub fn accept(&mut self, sequence: u32) -> Result<(), OutOfOrder> {
        if let Some(last) = self.last {
            let ahead = sequence.wrapping_sub(last);
            if ahead == 0 || ahead > u32::MAX / 2 {
                return Err(OutOfOrder { found: sequence, last });
            }
        }
        self.last = Some(sequence);
        Ok(())
    }
}

impl AbuseGauge {
    /// For a connection that carries up to `persons` persons.
    ///
    /// Each may send 120 poses a second; as much again in a burst is warned of, and four seconds' worth closes.
    /// Errors leak away at 2 a second: 10 in a burst are warned of, 50 close.
    pub fn new(persons: usize) -> Self {
        let rate = MOST_POSES_PER_SEC * persons.max(1) as f64 + OTHER_MESSAGES_PER_SEC;
        Self { messages: Bucket::new(rate, rate, 4.0 * rate), errors: Bucket::new(2.0, 10.0, 50.0) }
    }

    /// A message came. `Warn`: too many, drop it.
    pub fn message(&mut self, now: Time) -> Verdict {
        self.messages.pour(now)
    }

    /// A message was refused. `Warn`: say so once more, it is near the end.
    pub fn error(&mut self, now: Time) -> Verdict {
        self.errors.pour(now)
    }
}

impl Bucket {
    const fn new(leaks_per_sec: f64, warns_at: f64, closes_at: f64) -> Self {
        Self { level: 0.0, leaks_per_sec, warns_at, closes_at, at: None }
    }

    fn pour(&mut self, now: Time) -> Verdict {
        let passed = self.at.map_or(0.0, |at| (now - at).secs().max(0.0));
        self.at = Some(self.at.map_or(now, |at| at.max(now)));
        self.level = (self.level - passed * self.leaks_per_sec).max(0.0) + 1.0;
        if self.level > self.closes_at {
            Verdict::Close
        } else if self.level > self.warns_at {
            Verdict::Warn
        } else {
            Verdict::Fine
        }
    }
}

/// The protocol's upper pose rate, of one person.
pub const MOST_POSES_PER_SEC: f64 = 120.0;
/// Pings, touches, scene events of one connection.
pub const OTHER_MESSAGES_PER_SEC: f64 = 60.0;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_pose_out_of_order_is_refused_with_both_numbers() {
        let mut sequencer = Sequencer::default();
        sequencer.accept(7).unwrap();
        assert_eq!(sequencer.accept(7), Err(OutOfOrder { found: 7, last: 7 }));
        assert_eq!(sequencer.accept(6).unwrap_err().to_string(), "sequence: found 6, expected more than 7");
        sequencer.accept(9).unwrap();
    }

    #[test]
    fn a_sequence_may_wrap() {
        let mut sequencer = Sequencer::default();
        sequencer.accept(u32::MAX).unwrap();
        sequencer.accept(0).unwrap();
        assert!(sequencer.accept(u32::MAX).is_err());
    }

    proptest! {
        #[test]
        fn of_two_different_sequences_one_is_newer(a: u32, b: u32) {
            prop_assume!(a.wrapping_sub(b) != 1 << 31);
            let after = |first, then| Sequencer { last: Some(first) }.accept(then).is_ok();
            prop_assert_eq!(after(a, b) != after(b, a), a != b);
        }

        #[test]
        fn the_permitted_rate_is_never_warned_of(persons in 1_usize..5, jitter_micros in prop::collection::vec(0_i64..4_000, 500)) {
            let mut gauge = AbuseGauge::new(persons);
            for (pose, jitter) in jitter_micros.iter().enumerate() {
                let now = Time::from_micros(pose as i64 * 8_333 + jitter);
                for _ in 0..persons {
                    prop_assert_eq!(gauge.message(now), Verdict::Fine);
                }
            }
        }
    }

    #[test]
    fn a_flood_is_warned_of_then_closed() {
        let mut gauge = AbuseGauge::new(1);
        let verdicts: Vec<_> = (0..2_000).map(|i| gauge.message(Time::from_micros(i * 10))).collect();
        let warned = verdicts.iter().position(|v| *v == Verdict::Warn).unwrap();
        let closed = verdicts.iter().position(|v| *v == Verdict::Close).unwrap();
        assert_eq!((warned, closed), (180, 721));
    }

    #[test]
    fn errors_are_forgiven_with_time() {
        let mut gauge = AbuseGauge::new(1);
        for second in 0..1_000 {
            assert_eq!(gauge.error(Time::from_micros(second * 1_000_000)), Verdict::Fine);
        }
        let last = (0..60).map(|_| gauge.error(Time::from_micros(1_000_000_000))).last();
        assert_eq!(last, Some(Verdict::Close));
    }
}
