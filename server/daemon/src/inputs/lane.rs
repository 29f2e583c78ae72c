//! What one input said last, in atomics: how long it is believed, whether it was active, how often it became so.

use std::sync::atomic::{AtomicBool, AtomicI64, AtomicU64, Ordering};
use std::sync::{Condvar, Mutex};
use std::time::Duration;

use covr_engine::time::{Span, Time};

/// One input's last word.
#[derive(Debug)]
pub struct Lane {
    timeout: Span,
    /// Twice the time until which the last word is believed, µs, and one more if it was `active`; 0: no good word.
    word: AtomicU64,
    activations: AtomicU64,
    /// When it last became active or was lost, µs.
    activated_at: AtomicI64,
    /// Whether there was a word since the start, for whoever waits for the first.
    begun: AtomicBool,
    first: (Mutex<()>, Condvar),
}

/// What an input says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Seen {
    /// Inactive.
    Inactive,
    /// Active.
    Active,
    /// No good word of late.
    Silent,
}

impl Lane {
    /// A lane that has heard nothing.
    pub fn new(timeout: Span) -> Self {
        Self {
            timeout,
            word: AtomicU64::new(0),
            activations: AtomicU64::new(0),
            activated_at: AtomicI64::new(0),
            begun: AtomicBool::new(false),
            first: (Mutex::new(()), Condvar::new()),
        }
    }

    /// A good word at this time.
    pub fn say(&self, active: bool, now: Time) {
        if active && self.look(now) != Seen::Active {
            self.activate(now);
        }
        let until = (now + self.timeout).micros().max(0) as u64;
        self.word.store(until * 2 + u64::from(active), Ordering::Release);
        if !self.begun.swap(true, Ordering::AcqRel) {
            let _held = self.first.0.lock();
            self.first.1.notify_all();
        }
    }

    /// The line is cut, or what it says is no word.
    pub fn lose(&self, now: Time) {
        if self.word.swap(0, Ordering::AcqRel) != 0 {
            self.activate(now);
        }
    }

    /// What it says at this time.
    pub fn look(&self, now: Time) -> Seen {
        let word = self.word.load(Ordering::Acquire);
        let until = Time::from_micros((word / 2) as i64);
        match (word == 0 || now > until, word % 2 == 1) {
            (true, _) => Seen::Silent,
            (false, true) => Seen::Active,
            (false, false) => Seen::Inactive,
        }
    }

    /// How often it became active or was lost.
    pub fn activations(&self) -> u64 {
        self.activations.load(Ordering::Acquire)
    }

    /// Since when it counts as active, for one that does, or did a moment ago.
    pub fn active_since(&self, now: Time) -> Time {
        let word = self.word.load(Ordering::Acquire);
        let until = Time::from_micros((word / 2) as i64);
        match word {
            0 if !self.begun.load(Ordering::Acquire) => now,
            word if word > 0 && now > until => until,
            _ => Time::from_micros(self.activated_at.load(Ordering::Acquire)),
        }
    }

    /// Wait for the first word, at most so long.
    pub fn wait_for_a_word(&self, at_most: Duration) {
        let Ok(held) = self.first.0.lock() else { return };
        let unheard = |(): &mut ()| !self.begun.load(Ordering::Acquire);
        // Without a word in time the input is silent, and says so.
        drop(self.first.1.wait_timeout_while(held, at_most, unheard));
    }

    fn activate(&self, now: Time) {
        self.activated_at.store(now.micros(), Ordering::Release);
        self.activations.fetch_add(1, Ordering::AcqRel);
    }
}
