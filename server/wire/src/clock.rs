//! From a client's clock to the server's: what a pose's time means here. Pure; the caller says when things came.
//!
//! The offset is taken from the exchange of least round trip in the last 10 s, since its error is at most half that
//! round trip whatever the asymmetry of the link; nor is anything dated later than the quickest delivery of the last
//! 10 s allows. Until there is an exchange, that delivery, the least (reception - client time), stands in for it: it
//! dates poses too late by the quickest one-way delay, so 20 ms are added to every age.
//!
//! A client's clock that jumps shows itself by an exchange that contradicts the kept ones, or by a pose from the
//! future; what was known is then forgotten. A jump backwards alone looks like delay, so poses age until the next
//! exchange: the safe side.

use std::collections::VecDeque;

use covr_engine::time::{Span, Time};

use crate::client::{ClockPing, ClockPong};

/// The estimate of one client's clock.
#[derive(Debug, Clone, Default)]
pub struct ClientClock {
    pongs: VecDeque<ClockPong>,
    exchanges: VecDeque<Exchange>,
    quickest: VecDeque<Quickest>,
}

/// A closed exchange: server minus client, and the round trip without the server's own time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Exchange {
    at: Time,
    offset_micros: i128,
    rtt_micros: i128,
}

/// The least (reception - client time) of one second.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Quickest {
    second: i64,
    lead_micros: i128,
}

impl ClientClock {
    /// Nothing known yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Take in a ping received at `received`, and make the pong that leaves at `sent`.
    pub fn ping(&mut self, ping: &ClockPing, received: Time, sent: Time) -> ClockPong {
        if let Some(previous) = ping.previous
            && let Some(at) = self.pongs.iter().position(|pong| pong.id == previous.id)
            && let Some(pong) = self.pongs.remove(at)
        {
            self.close(&pong, previous.received_client_time_micros);
        }
        let pong = ClockPong {
            id: ping.id,
            client_time_micros: ping.client_time_micros,
            server_received_micros: received.micros(),
            server_sent_micros: sent.micros(),
        };
        self.pongs.retain(|known| known.id != pong.id);
        self.pongs.push_back(pong);
        if self.pongs.len() > MOST_OPEN_PONGS {
            self.pongs.pop_front();
        }
        pong
    }

    /// When something that the client dates `client_time_micros`, received at `received`, happened on the server's
    /// clock. Never later than its reception.
    pub fn server_time(&mut self, client_time_micros: i64, received: Time) -> Time {
        let client_time = i128::from(client_time_micros);
        let lead = i128::from(received.micros()) - client_time;
        if let Some(best) = self.best()
            && best.offset_micros - lead > best.error_micros(received)
        {
            self.forget();
        }
        self.note_lead(lead, received);
        let least_lead = self.least_lead().unwrap_or(lead);
        let offset = match self.best() {
            // Nothing arrives before it leaves: where all exchanges are slow, the quickest delivery bounds better.
            Some(best) => best.offset_micros.min(least_lead + MOST_DRIFT_MICROS),
            None => least_lead - i128::from(ONE_WAY_ALLOWANCE.micros()),
        };
        let micros = (client_time + offset).clamp(i128::from(i64::MIN), i128::from(i64::MAX)) as i64;
        Time::from_micros(micros).min(received)
    }

    /// The least round trip of the window; none before the first exchange.
    pub fn rtt(&self) -> Option<Span> {
        self.best().map(|best| Span::from_micros(best.rtt_micros as i64))
    }

    /// How wrong a converted time can be at `now`; none before the first exchange.
    pub fn error_bound(&self, now: Time) -> Option<Span> {
        self.best().map(|best| Span::from_micros(best.error_micros(now) as i64))
    }

    fn close(&mut self, pong: &ClockPong, back_at_client: i64) {
        let now = Time::from_micros(pong.server_sent_micros);
        let [sent, received, returned, back] =
            [pong.client_time_micros, pong.server_received_micros, pong.server_sent_micros, back_at_client]
                .map(i128::from);
        let rtt_micros = (back - sent) - (returned - received);
        if !(0..=MOST_RTT_MICROS).contains(&rtt_micros) {
            return;
        }
        let offset_micros = ((received - sent) + (returned - back)).div_euclid(2);
        let exchange = Exchange { at: now, offset_micros, rtt_micros };
        if self.best().is_some_and(|best| exchange.contradicts(&best, now)) {
            self.forget();
        }
        self.exchanges.push_back(exchange);
        self.exchanges.retain(|known| now - known.at <= WINDOW);
        if self.exchanges.len() > MOST_EXCHANGES {
            self.exchanges.pop_front();
        }
    }

    fn note_lead(&mut self, lead_micros: i128, received: Time) {
        let second = received.micros().div_euclid(1_000_000);
        match self.quickest.back_mut() {
            Some(last) if last.second >= second => last.lead_micros = last.lead_micros.min(lead_micros),
            _ => self.quickest.push_back(Quickest { second, lead_micros }),
        }
        let oldest = second.saturating_sub(WINDOW.micros() / 1_000_000);
        self.quickest.retain(|quickest| quickest.second >= oldest);
    }

    fn forget(&mut self) {
        self.exchanges.clear();
        self.quickest.clear();
    }

    fn best(&self) -> Option<Exchange> {
        self.exchanges.iter().copied().min_by_key(|exchange| exchange.rtt_micros)
    }

    fn least_lead(&self) -> Option<i128> {
        self.quickest.iter().map(|quickest| quickest.lead_micros).min()
    }
}

impl Exchange {
    /// Half the round trip, and what two clocks may have drifted apart since; 1 us for rounding.
    fn error_micros(&self, now: Time) -> i128 {
        let age = i128::from((now - self.at).micros().max(0));
        self.rtt_micros / 2 + age * DRIFT_PPM / 1_000_000 + 1
    }

    /// Both cannot be true of a clock that did not jump.
    fn contradicts(&self, other: &Self, now: Time) -> bool {
        (self.offset_micros - other.offset_micros).abs() > self.error_micros(now) + other.error_micros(now)
    }
}

/// How long an exchange counts. With the drift below it costs 2 ms at most.
const WINDOW: Span = Span::from_micros(10_000_000);
/// At ten pings a second, more than a client needs.
const MOST_EXCHANGES: usize = 100;
/// Pongs that wait for the client's word of their reception.
const MOST_OPEN_PONGS: usize = 16;
/// A round trip beyond this says nothing worth keeping.
const MOST_RTT_MICROS: i128 = 2_000_000;
/// Two quartz clocks of 100 ppm each, the worst that is sold.
const DRIFT_PPM: i128 = 200;
/// What they may drift apart in one window.
const MOST_DRIFT_MICROS: i128 = WINDOW.micros() as i128 * DRIFT_PPM / 1_000_000;
/// Added to every age while only one-way times are known: a wireless headset's quickest delivery takes less.
pub const ONE_WAY_ALLOWANCE: Span = Span::from_millis(20);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::client::PongReceived;
    use proptest::prelude::*;

    /// A client whose clock is the true time times its rate plus an offset, and a link with delays of its own.
    struct Simulated {
        clock: ClientClock,
        now: i64,
        offset: i64,
        drift_ppm: i64,
        pings: u32,
        previous: Option<PongReceived>,
    }

    impl Simulated {
        fn new(offset: i64, drift_ppm: i64) -> Self {
            Self { clock: ClientClock::new(), now: 1_000_000, offset, drift_ppm, pings: 0, previous: None }
        }

        fn client(&self, at: i64) -> i64 {
            at + at * self.drift_ppm / 1_000_000 - self.offset
        }

        /// A ping a quarter second after the last; its pong's reception is told by the next.
        fn exchange(&mut self, up: i64, turn: i64, down: i64) {
            let sent = self.now;
            let ping = ClockPing {
                id: self.pings,
                client_time_micros: self.client(sent),
                previous: self.previous.take(),
            };
            self.clock.ping(&ping, Time::from_micros(sent + up), Time::from_micros(sent + up + turn));
            let back = self.client(sent + up + turn + down);
            self.previous = Some(PongReceived { id: self.pings, received_client_time_micros: back });
            self.pings += 1;
            self.now += 250_000;
        }

        /// Taken now, received `delay` later: (converted, true, received).
        fn pose(&mut self, delay: i64) -> (i64, i64, i64) {
            let received = self.now + delay;
            let converted = self.clock.server_time(self.client(self.now), Time::from_micros(received));
            (converted.micros(), self.now, received)
        }
    }

    proptest! {
        #[test]
        fn the_error_is_at_most_half_the_least_round_trip(
            offset in -10_000_000_000_i64..10_000_000_000,
            delays in prop::collection::vec((100_i64..80_000, 0_i64..2_000, 100_i64..80_000), 2..60),
            pose_delay in 100_i64..80_000,
        ) {
            let mut client = Simulated::new(offset, 0);
            for (up, turn, down) in &delays {
                client.exchange(*up, *turn, *down);
            }
            let closed = &delays[..delays.len() - 1];
            let recent = &closed[closed.len().saturating_sub(39)..];
            let least = recent.iter().map(|(up, _, down)| up + down).min().unwrap();
            let (converted, taken, received) = client.pose(pose_delay);
            prop_assert!((converted - taken).abs() <= least / 2 + 1, "off by {}", converted - taken);
            prop_assert!(converted <= received);
        }

        #[test]
        fn drift_stays_inside_the_stated_bound(
            offset in -10_000_000_i64..10_000_000,
            drift_ppm in -200_i64..200,
            delays in prop::collection::vec((100_i64..20_000, 100_i64..20_000), 100..200),
        ) {
            let mut client = Simulated::new(offset, drift_ppm);
            for (up, down) in delays {
                client.exchange(up, 0, down);
                let (converted, taken, received) = client.pose(5_000);
                if let Some(bound) = client.clock.error_bound(Time::from_micros(received)) {
                    let slack = 5;
                    prop_assert!((converted - taken).abs() <= bound.micros() + slack);
                }
                prop_assert!(converted <= received);
            }
        }

        #[test]
        fn before_an_exchange_a_pose_is_dated_too_early_rather_than_too_late(
            offset in -10_000_000_000_i64..10_000_000_000,
            delays in prop::collection::vec(500_i64..150_000, 1..200),
        ) {
            let mut client = Simulated::new(offset, 0);
            let allowance = ONE_WAY_ALLOWANCE.micros();
            let mut quickest = i64::MAX;
            for delay in delays {
                quickest = quickest.min(delay);
                let (converted, taken, received) = client.pose(delay);
                prop_assert_eq!(converted, taken + quickest - allowance);
                prop_assert!(converted <= received);
                client.now += 10_000;
            }
        }

        #[test]
        fn no_words_of_a_client_put_a_pose_into_the_future(
            words in prop::collection::vec((any::<u32>(), any::<i64>(), prop::option::of((0_u32..4, any::<i64>()))), 0..40),
            times in prop::collection::vec((any::<i64>(), 0_i64..1_000_000), 1..40),
        ) {
            let mut clock = ClientClock::new();
            let mut now = 0;
            for (id, client_time_micros, previous) in words {
                let previous = previous.map(|(id, received_client_time_micros)| PongReceived { id, received_client_time_micros });
                let ping = ClockPing { id: id % 4, client_time_micros, previous };
                now += 1_000;
                clock.ping(&ping, Time::from_micros(now), Time::from_micros(now + 10));
            }
            for (client_time, step) in times {
                now += step;
                prop_assert!(clock.server_time(client_time, Time::from_micros(now)) <= Time::from_micros(now));
            }
        }
    }

    #[test]
    fn a_clock_that_jumps_is_followed_after_one_exchange() {
        for jump in [-3_600_000_000, -500_000, 500_000, 3_600_000_000] {
            let mut client = Simulated::new(42, 0);
            for _ in 0..20 {
                client.exchange(3_000, 100, 4_000);
            }
            client.offset += jump;
            client.previous = None;
            for _ in 0..2 {
                client.exchange(3_000, 100, 4_000);
            }
            let (converted, taken, _) = client.pose(3_000);
            assert!((converted - taken).abs() <= 3_500, "jump {jump}: off by {}", converted - taken);
        }
    }

    #[test]
    fn a_jump_backwards_ages_poses_until_the_next_exchange() {
        let mut client = Simulated::new(0, 0);
        for _ in 0..5 {
            client.exchange(3_000, 100, 3_000);
        }
        client.offset += 2_000_000;
        let (converted, taken, _) = client.pose(3_000);
        assert!(converted <= taken - 1_900_000);
    }

    #[test]
    fn a_pose_from_the_future_ends_trust_in_the_old_offset() {
        let mut client = Simulated::new(0, 0);
        for _ in 0..5 {
            client.exchange(3_000, 100, 3_000);
        }
        client.offset -= 2_000_000;
        let (converted, taken, received) = client.pose(3_000);
        assert_eq!(client.clock.rtt(), None);
        assert_eq!(converted, taken + 3_000 - ONE_WAY_ALLOWANCE.micros());
        assert!(converted < received);
    }

    #[test]
    fn a_slow_and_lopsided_exchange_cannot_date_poses_later_than_the_quickest_delivery() {
        let mut client = Simulated::new(77, 0);
        for _ in 0..3 {
            client.exchange(1_500_000, 0, 1_000);
        }
        client.pose(4_000);
        client.now += 100_000;
        let (converted, taken, _) = client.pose(400_000);
        assert_eq!(converted, taken + 4_000 + 2_000);
    }

    #[test]
    fn old_one_way_times_are_forgotten() {
        let mut clock = ClientClock::new();
        clock.server_time(0, Time::from_micros(1_000));
        let late = Time::from_micros(20_000_000);
        assert_eq!(clock.server_time(10_000_000, late), late - ONE_WAY_ALLOWANCE);
    }
}
