//! An encoder register of 32 bits and the speeds that the board works out from it.

use std::collections::VecDeque;

use super::settings::SAMPLES_A_SECOND;

/// Of one channel.
#[derive(Debug, Clone, Default)]
pub(super) struct Encoder {
    /// Counts since power-on.
    counts: i64,
    /// What the register was zero at.
    zero_at: i64,
    has_underflowed: bool,
    has_overflowed: bool,
    goes_backward: bool,
    /// Counts at the last samples, newest last; a second of them and one.
    samples: VecDeque<i64>,
    /// Thousandths of a sample since the last.
    since_sample: u32,
    filtered_cps: f64,
}

impl Encoder {
    /// A millisecond on.
    pub(super) fn tick(&mut self, counts: i64) {
        let wraps = |counts: i64| (counts - self.zero_at).div_euclid(RANGE);
        let turned = wraps(counts) - wraps(self.counts);
        self.has_underflowed |= turned < 0;
        self.has_overflowed |= turned > 0;
        let moved = counts - self.counts;
        if moved != 0 {
            self.goes_backward = moved < 0;
        }
        self.counts = counts;
        self.since_sample += SAMPLES_A_SECOND;
        if self.since_sample >= TICKS_A_SECOND {
            self.since_sample -= TICKS_A_SECOND;
            // A sample lies between two ticks: so much of the last one's motion came after it.
            let after = moved * i64::from(self.since_sample) / i64::from(SAMPLES_A_SECOND);
            self.samples.push_back(counts - after);
            if self.samples.len() > SAMPLES_A_SECOND as usize + 1 {
                self.samples.pop_front();
            }
            self.filtered_cps += FILTER_SHARE * (f64::from(self.raw_cps()) - self.filtered_cps);
        }
    }

    /// The register is `value` from now on.
    pub(super) fn set(&mut self, value: u32) {
        self.zero_at = self.counts - i64::from(value);
    }

    /// The register.
    pub(super) const fn register(&self) -> u32 {
        (self.counts - self.zero_at) as u32
    }

    /// Counts since power-on of a place that the register names: the nearest such place.
    pub(super) const fn counts_at(&self, register: i32) -> i64 {
        let off = register.wrapping_sub(self.register().cast_signed());
        self.counts + off as i64
    }

    /// The status byte of commands 16 and 17: underflow, direction, overflow; the first and the last are forgotten by
    /// it (manual). Bit 7 is set on real boards (osr-rover-code's set-up: 128 forward, 130 backward).
    pub(super) fn take_status(&mut self) -> u8 {
        let status = 0x80
            | u8::from(self.has_underflowed)
            | u8::from(self.goes_backward) << 1
            | u8::from(self.has_overflowed) << 2;
        (self.has_underflowed, self.has_overflowed) = (false, false);
        status
    }

    /// Counts in the last 300th of a second, times 300 (commands 30, 31, 79).
    pub(super) fn raw_cps(&self) -> i32 {
        let newest = self.samples.len().saturating_sub(1);
        self.speed_over(newest.saturating_sub(1), newest)
    }

    /// The same, filtered (commands 18, 19). *Unverified:* how much; here with a time constant of a 30th of a second.
    pub(super) fn filtered_cps(&self) -> i32 {
        self.filtered_cps.round() as i32
    }

    /// Over the last second, or since power-on (command 108).
    pub(super) fn average_cps(&self) -> i32 {
        self.speed_over(0, self.samples.len().saturating_sub(1))
    }

    fn speed_over(&self, from: usize, to: usize) -> i32 {
        match (self.samples.get(from), self.samples.get(to)) {
            (Some(before), Some(after)) if to > from => {
                ((after - before) * i64::from(SAMPLES_A_SECOND) / (to - from) as i64) as i32
            }
            _ => 0,
        }
    }
}

const RANGE: i64 = 1 << 32;
const TICKS_A_SECOND: u32 = 1_000;
const FILTER_SHARE: f64 = 0.1;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_register_wraps_and_says_so_once() {
        let mut encoder = Encoder::default();
        encoder.tick(-1);
        assert_eq!(encoder.register(), u32::MAX);
        assert_eq!(encoder.take_status(), 0b1000_0011);
        assert_eq!(encoder.take_status(), 0b1000_0010);
        encoder.tick(1);
        assert_eq!(encoder.take_status(), 0b1000_0100);
        assert_eq!(encoder.take_status(), 0b1000_0000);
    }

    #[test]
    fn a_set_register_counts_on_from_there_and_names_places() {
        let mut encoder = Encoder::default();
        encoder.tick(500);
        encoder.set(u32::MAX);
        encoder.tick(501);
        assert_eq!(encoder.register(), 0);
        assert_eq!(encoder.counts_at(-1), 500);
        assert_eq!(encoder.counts_at(20), 521);
    }

    #[test]
    fn speeds_are_those_of_the_motion() {
        let mut encoder = Encoder::default();
        for tick in 0..3_000 {
            encoder.tick(-12 * tick);
        }
        assert!((encoder.raw_cps() + 12_000).abs() <= 300, "{}", encoder.raw_cps());
        assert!((encoder.filtered_cps() + 12_000).abs() < 600, "{}", encoder.filtered_cps());
        assert!((encoder.average_cps() + 12_000).abs() <= 12, "{}", encoder.average_cps());
    }
}
