//! What is shown of boards and link: counted by the link thread, published as one piece.

use std::sync::Arc;
use std::time::{Duration, Instant};

use covr_engine::machine::Trouble;

use crate::contract::{Health, LinkFigures};

/// What a line has been like since it was opened.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tally {
    /// Exchanges that were answered.
    pub answered: u64,
    /// Exchanges that were not answered, or not well.
    pub lost: u64,
    /// Of these, sent again.
    pub repeated: u64,
    /// Bytes, either way.
    pub bytes: u64,
}

/// Counts and last values.
#[derive(Debug, Default)]
pub struct Figures {
    now: Health,
    shown: Arc<Health>,
    shown_at: Option<Instant>,
    cycles_micros: Vec<u32>,
    since: Option<Instant>,
    before: Tally,
}

impl Figures {
    /// Boards with this firmware were found.
    pub fn found(&mut self, (text, profile): (&str, &str)) {
        self.now.firmware = Some(text.to_owned());
        self.now.profile = Some(profile.to_owned());
        self.now.condition = String::new();
        self.now.link.connections += 1;
        self.before = Tally::default();
        self.shown_at = None;
    }

    /// The boards were lost, for this reason.
    pub fn ended(&mut self, why: String) {
        self.now.condition = why;
        self.shown_at = None;
    }

    /// A cycle was through.
    pub fn cycle(&mut self, begun: Instant, ended: Instant, tally: Tally) {
        self.cycles_micros.push((ended - begun).as_micros() as u32);
        let link = &mut self.now.link;
        link.exchanges += tally.answered.saturating_sub(self.before.answered);
        link.lost += tally.lost.saturating_sub(self.before.lost);
        link.repeated += tally.repeated.saturating_sub(self.before.repeated);
        link.bytes += tally.bytes.saturating_sub(self.before.bytes);
        link.cycles += 1;
        self.before = tally;
    }

    /// A cycle was lost, for this reason.
    pub fn lost(&mut self, why: String) {
        self.now.link.cycles_lost += 1;
        self.now.link.last_loss = why;
    }

    pub fn volts(&mut self, volts: Option<f64>) {
        self.now.supply_volts = volts.or(self.now.supply_volts);
    }

    pub fn temperature(&mut self, celsius: Option<f64>) {
        self.now.temperature_c = celsius.or(self.now.temperature_c);
    }

    /// The whole, made anew twice a second and whenever the trouble is another.
    pub fn health(&mut self, trouble: Option<Trouble>) -> Arc<Health> {
        let is_old = self.shown_at.is_none_or(|at| at.elapsed() >= SHOW_EVERY);
        if is_old || self.shown.trouble != trouble {
            self.now.trouble = trouble;
            self.count_cycles();
            self.shown = Arc::new(self.now.clone());
            self.shown_at = Some(Instant::now());
        }
        self.shown.clone()
    }

    fn count_cycles(&mut self) {
        let since = self.since.replace(Instant::now());
        self.cycles_micros.sort_unstable();
        let at = |part: f64| {
            let last = self.cycles_micros.len().saturating_sub(1) as f64;
            self.cycles_micros.get((part * last).round() as usize).copied().map_or(0.0, f64::from)
        };
        let secs = since.map_or(0.0, |since| since.elapsed().as_secs_f64());
        let rate_hz = if secs > 0.0 { self.cycles_micros.len() as f64 / secs } else { 0.0 };
        self.now.link = LinkFigures {
            rate_hz,
            cycle_p50_micros: at(0.5),
            cycle_p99_micros: at(0.99),
            cycle_max_micros: at(1.0),
            ..std::mem::take(&mut self.now.link)
        };
        self.cycles_micros.clear();
    }
}

const SHOW_EVERY: Duration = Duration::from_millis(500);
