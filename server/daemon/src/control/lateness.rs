//! How late the control loop woke: the last ten seconds.

/// A ring of latenesses.
#[derive(Debug)]
pub struct Lateness {
    micros: Vec<u32>,
    next: usize,
    filled: usize,
    scratch: Vec<u32>,
}

impl Lateness {
    /// Room for ten seconds at this rate.
    pub fn over_ten_seconds(rate_hz: f64) -> Self {
        let length = (10.0 * rate_hz).ceil() as usize;
        Self { micros: vec![0; length], next: 0, filled: 0, scratch: Vec::with_capacity(length) }
    }

    /// One wake.
    pub fn add(&mut self, late_micros: i64) {
        self.micros[self.next] = u32::try_from(late_micros.max(0)).unwrap_or(u32::MAX);
        self.next = (self.next + 1) % self.micros.len();
        self.filled = (self.filled + 1).min(self.micros.len());
    }

    /// The 99th percentile and the greatest, microseconds.
    pub fn p99_and_max_micros(&mut self) -> (f64, f64) {
        if self.filled == 0 {
            return (0.0, 0.0);
        }
        self.scratch.clear();
        self.scratch.extend_from_slice(&self.micros[..self.filled]);
        let rank = (self.filled * 99).div_ceil(100) - 1;
        let (_, p99, above) = self.scratch.select_nth_unstable(rank);
        let p99 = *p99;
        let max = above.iter().copied().max().unwrap_or(p99);
        (f64::from(p99), f64::from(max))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentile_and_maximum_of_the_last_ten_seconds_only() {
        let mut lateness = Lateness::over_ten_seconds(10.0);
        assert_eq!(lateness.p99_and_max_micros(), (0.0, 0.0));
        lateness.add(1_000_000);
        for late in 1..=100 {
            lateness.add(late);
        }
        assert_eq!(lateness.p99_and_max_micros(), (99.0, 100.0), "the million is older than ten seconds");
    }

    #[test]
    fn an_early_wake_counts_as_in_time() {
        let mut lateness = Lateness::over_ten_seconds(10.0);
        lateness.add(-5);
        assert_eq!(lateness.p99_and_max_micros(), (0.0, 0.0));
    }
}
