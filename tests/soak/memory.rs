//! Resident memory over time, and its slope.

use std::fmt;
use std::time::Duration;

/// Samples of the resident memory.
#[derive(Debug, Default)]
pub struct Memory(Vec<(f64, f64)>);

impl Memory {
    /// After so long it was so much, kB.
    pub fn note(&mut self, at: Duration, kb: f64) {
        self.0.push((at.as_secs_f64() / 3_600.0, kb * 1024.0 / 1e6));
    }

    /// Panics when a long run's memory grows. A short one says nothing: caches and queues fill.
    pub fn judge(&self) {
        let hours = self.0.last().map_or(0.0, |last| last.0);
        assert!(
            hours < LONG_HOURS || self.slope() < MOST_MB_AN_HOUR,
            "{self}: more than {MOST_MB_AN_HOUR} MB an hour"
        );
    }

    /// Least squares over all but the first fifth, MB an hour.
    fn slope(&self) -> f64 {
        let from = self.0.last().map_or(0.0, |last| 0.2 * last.0);
        let settled: Vec<_> = self.0.iter().filter(|sample| sample.0 >= from).collect();
        let count = settled.len() as f64;
        let mean_x = settled.iter().map(|sample| sample.0).sum::<f64>() / count;
        let mean_y = settled.iter().map(|sample| sample.1).sum::<f64>() / count;
        let across: f64 = settled.iter().map(|sample| (sample.0 - mean_x) * (sample.1 - mean_y)).sum();
        let along: f64 = settled.iter().map(|sample| (sample.0 - mean_x).powi(2)).sum();
        across / along
    }
}

impl fmt::Display for Memory {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (first, last) = (self.0.first().map_or(0.0, |s| s.1), self.0.last().map_or(0.0, |s| s.1));
        write!(
            f,
            "resident memory {first:.1} MB at first, {last:.1} MB at last, slope {:+.2} MB an hour",
            self.slope()
        )
    }
}

/// A run of so long tells growth from filling, hours.
const LONG_HOURS: f64 = 0.45;
/// A server that runs for a week of opening hours stays under 0.5 GB with this.
const MOST_MB_AN_HOUR: f64 = 6.0;
