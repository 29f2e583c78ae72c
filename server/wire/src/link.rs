//! How well one person's poses arrive: their age, the jitter between them, and how many are missing. Pure; the caller
//! says when things came. It describes the link and decides nothing: the safety rules look at each pose's own age.

use std::collections::VecDeque;

use covr_engine::time::{Span, Time};

/// The poses of one person on one connection.
#[derive(Debug, Clone, Default)]
pub struct Link {
    last: Option<Last>,
    jitter_micros: Option<f64>,
    /// Oldest first, none older than the window of the loss.
    tenths: VecDeque<Tenth>,
}

/// What is shown of one or several links.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LinkFigures {
    /// Greatest age that a pose had at its reception, over the last second, ms; none without poses in it.
    pub pose_age_millis: Option<f64>,
    /// Interarrival jitter (RFC 3550, 6.4.1), of several links the greatest, ms; none before a second pose.
    pub jitter_millis: Option<f64>,
    /// Poses missing in their sequence among those sent over the last 10 s, percent; none without poses in them.
    pub loss_percent: Option<f64>,
}

/// The last pose accepted.
#[derive(Debug, Clone, Copy)]
struct Last {
    sequence: u32,
    /// Reception less client time: the clocks' offset and the time on the way.
    transit_micros: i128,
}

/// What came in one tenth of a second.
#[derive(Debug, Clone, Copy)]
struct Tenth {
    number: i64,
    received: u64,
    missing: u64,
    oldest: Span,
}

impl Link {
    /// A pose was accepted: later in its sequence than the last, modulo 2^32. It was taken at `taken_at` on the
    /// server's clock and received at `received`.
    pub fn pose(&mut self, sequence: u32, client_time_micros: i64, taken_at: Time, received: Time) {
        let transit_micros = i128::from(received.micros()) - i128::from(client_time_micros);
        let mut missing = 0;
        if let Some(last) = self.last {
            // RFC 3550: J += (|D| - J) / 16, D being how much longer this one was on its way than the one before.
            let difference = (transit_micros - last.transit_micros).unsigned_abs() as f64;
            let jitter = self.jitter_micros.unwrap_or(0.0);
            self.jitter_micros = Some(jitter + (difference - jitter) / JITTER_SMOOTHING);
            let skipped = sequence.wrapping_sub(last.sequence).saturating_sub(1);
            missing = if skipped < LONGEST_GAP { u64::from(skipped) } else { 0 };
        }
        self.last = Some(Last { sequence, transit_micros });

        let age = received - taken_at;
        let number = tenth_of(received);
        match self.tenths.back_mut() {
            Some(tenth) if tenth.number >= number => {
                tenth.received += 1;
                tenth.missing += missing;
                tenth.oldest = tenth.oldest.max(age);
            }
            _ => self.tenths.push_back(Tenth { number, received: 1, missing, oldest: age }),
        }
        while self.tenths.front().is_some_and(|tenth| tenth.number <= number - LOSS_TENTHS) {
            self.tenths.pop_front();
        }
    }
}

impl LinkFigures {
    /// The figures of all these links together, at `now`.
    pub fn of<'a>(links: impl IntoIterator<Item = &'a Link>, now: Time) -> Self {
        let now = tenth_of(now);
        let mut figures = Self::default();
        let (mut received, mut missing) = (0, 0);
        for link in links {
            let jitter = link.jitter_micros.map(|micros| micros * 1e-3);
            figures.jitter_millis = greatest(figures.jitter_millis, jitter);
            for tenth in link.tenths.iter().filter(|tenth| tenth.number > now - LOSS_TENTHS) {
                received += tenth.received;
                missing += tenth.missing;
                if tenth.number > now - AGE_TENTHS {
                    let age = tenth.oldest.micros() as f64 * 1e-3;
                    figures.pose_age_millis = greatest(figures.pose_age_millis, Some(age));
                }
            }
        }
        if received > 0 {
            figures.loss_percent = Some(100.0 * missing as f64 / (received + missing) as f64);
        }
        figures
    }
}

fn greatest(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.max(b)),
        (a, b) => a.or(b),
    }
}

fn tenth_of(at: Time) -> i64 {
    at.micros().div_euclid(TENTH_MICROS)
}

/// The noise filter of RFC 3550, 6.4.1.
const JITTER_SMOOTHING: f64 = 16.0;
/// A gap this long is a client that numbers afresh, not a loss: 3,000 is `MAX_DROPOUT` of RFC 3550, A.1, and more
/// poses than ten seconds can hold.
const LONGEST_GAP: u32 = 3_000;
const TENTH_MICROS: i64 = 100_000;
const AGE_TENTHS: i64 = 10;
const LOSS_TENTHS: i64 = 100;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A link whose client's clock is 5 s behind, with poses every 10 ms.
    struct Sent {
        link: Link,
        sequence: u32,
        at: i64,
    }

    impl Sent {
        fn from(sequence: u32) -> Self {
            Self { link: Link::default(), sequence, at: 7_000_000 }
        }

        fn arrives(&mut self, delay: i64) {
            let (taken, received) = (Time::from_micros(self.at), Time::from_micros(self.at + delay));
            self.link.pose(self.sequence, self.at - 5_000_000, taken, received);
            self.lost();
        }

        fn lost(&mut self) {
            self.sequence = self.sequence.wrapping_add(1);
            self.at += 10_000;
        }

        fn figures(&self) -> LinkFigures {
            LinkFigures::of([&self.link], Time::from_micros(self.at))
        }
    }

    #[test]
    fn nothing_is_said_of_a_link_without_poses() {
        assert_eq!(LinkFigures::of([&Link::default()], Time::ZERO), LinkFigures::default());
        let mut sent = Sent::from(1);
        sent.arrives(4_000);
        assert_eq!(sent.figures().jitter_millis, None, "one pose has no jitter");
        assert_eq!(sent.figures().loss_percent, Some(0.0));
    }

    #[test]
    fn jitter_is_that_of_the_rfc() {
        let mut sent = Sent::from(1);
        for delay in [4_000, 20_000, 4_000] {
            sent.arrives(delay);
        }
        // 16/16 = 1, then 1 + (16 - 1) / 16.
        assert_eq!(sent.figures().jitter_millis, Some(1.9375));
    }

    #[test]
    fn age_is_the_greatest_of_the_last_second() {
        let mut sent = Sent::from(1);
        sent.arrives(80_000);
        for _ in 0..50 {
            sent.arrives(3_000);
        }
        assert_eq!(sent.figures().pose_age_millis, Some(80.0));
        for _ in 0..70 {
            sent.arrives(3_000);
        }
        assert_eq!(sent.figures().pose_age_millis, Some(3.0));
        sent.at += 1_100_000;
        assert_eq!(sent.figures().pose_age_millis, None, "no pose for a second");
    }

    #[test]
    fn loss_counts_gaps_across_the_wrap_and_forgets_them_after_ten_seconds() {
        let mut sent = Sent::from(u32::MAX - 2);
        for _ in 0..4 {
            sent.arrives(1_000);
            sent.lost();
        }
        sent.arrives(1_000);
        let loss = sent.figures().loss_percent.unwrap();
        assert!((loss - 100.0 * 4.0 / 9.0).abs() < 1e-9, "{loss}");
        for _ in 0..1_000 {
            sent.arrives(1_000);
        }
        assert_eq!(sent.figures().loss_percent, Some(0.0));
        sent.at += 10_100_000;
        assert_eq!(sent.figures().loss_percent, None);
    }

    #[test]
    fn a_client_that_numbers_afresh_lost_nothing() {
        let mut sent = Sent::from(1);
        sent.arrives(1_000);
        sent.sequence = 900_000;
        sent.arrives(1_000);
        assert_eq!(sent.figures().loss_percent, Some(0.0));
    }

    #[test]
    fn of_several_links_the_worst_age_and_jitter_and_the_loss_of_all() {
        let (mut good, mut bad) = (Sent::from(1), Sent::from(1));
        for _ in 0..3 {
            good.arrives(1_000);
        }
        bad.arrives(30_000);
        bad.lost();
        bad.arrives(46_000);
        let both = LinkFigures::of([&good.link, &bad.link], Time::from_micros(good.at));
        assert_eq!(both.pose_age_millis, Some(46.0));
        assert_eq!(both.jitter_millis, Some(1.0));
        let loss = both.loss_percent.unwrap();
        assert!((loss - 100.0 / 6.0).abs() < 1e-9, "{loss}");
    }

    proptest! {
        #[test]
        fn any_words_of_a_client_give_figures_in_range(
            poses in prop::collection::vec((any::<u32>(), any::<i64>(), 0_i64..1_000_000, 0_i64..200_000), 1..200),
        ) {
            let mut link = Link::default();
            let mut now = 0;
            for (sequence, client_time, age, step) in poses {
                now += step;
                link.pose(sequence, client_time, Time::from_micros(now - age), Time::from_micros(now));
                let figures = LinkFigures::of([&link], Time::from_micros(now));
                let loss = figures.loss_percent.unwrap();
                prop_assert!((0.0..100.0).contains(&loss));
                prop_assert!(figures.pose_age_millis.unwrap() >= age as f64 * 1e-3);
                prop_assert!(figures.jitter_millis.is_none_or(|jitter| jitter >= 0.0 && jitter.is_finite()));
                prop_assert!(link.tenths.len() <= 100);
            }
        }
    }
}
