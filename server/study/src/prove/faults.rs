//! What breaks on its own: the link to the machine and the control thread, each for a while.
//!
//! A motor that runs away, an encoder that slips and an axis that was jammed and comes free are not among it: there the
//! column moves as nobody told it, R6 and R7 release the drive, and the wired chain does the rest.

use covr_engine::time::{Span, Time};
use covr_gantry::sim::faults::{Faults, LinkFault};

use crate::random::Random;
use crate::replay::ClosedLoop;

/// Breaks things, and mends them.
pub struct Nuisance {
    random: Random,
    next: Time,
    breaks: bool,
    starves_until: Time,
}

impl Nuisance {
    /// Nothing is broken before a second after `from`.
    pub fn new(random: Random, from: Time) -> Self {
        Self { random, next: from + Span::from_millis(1_000), breaks: false, starves_until: from }
    }

    /// Break or mend something when it is time to; whether the control thread gets to run in this period.
    pub fn step(&mut self, control: &mut ClosedLoop) -> bool {
        let now = control.now();
        if now >= self.next {
            self.breaks = !self.breaks;
            let lasts = if self.breaks { self.break_something(control) } else { self.mend(control) };
            self.next = now + lasts;
        }
        now >= self.starves_until
    }

    fn break_something(&mut self, control: &mut ClosedLoop) -> Span {
        let link = |link| Faults { link, ..Faults::default() };
        match self.random.below(3) {
            0 => control.set_faults(link(LinkFault::Dead)),
            1 => {
                let slow = Span::from_secs(self.random.between(0.001, SLOWEST_LINK_SECS));
                control.set_faults(link(LinkFault::Slow(slow)));
            }
            _ => {
                let starved = Span::from_secs(self.random.between(0.004, LONGEST_STARVED_SECS));
                self.starves_until = control.now() + starved;
                return starved;
            }
        }
        Span::from_secs(self.random.between(0.01, 0.6))
    }

    fn mend(&mut self, control: &mut ClosedLoop) -> Span {
        control.set_faults(Faults::default());
        Span::from_secs(self.random.between(1.0, 12.0))
    }
}

/// A link slower than this is for R8, s.
const SLOWEST_LINK_SECS: f64 = 0.008;
/// The control thread never waits longer for its turn, s.
const LONGEST_STARVED_SECS: f64 = 0.3;
