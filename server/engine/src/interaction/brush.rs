//! Brush: a soft prop comes up to somebody who stands still, and leaves (the paper's ghosts). A contact (R14).
//!
//! ```text
//!             armed visitor,             still for 1 s            prop at the head, or as      secs later
//!             column in place                                     near as the column may
//!   (offered) ──────────────▶ waiting ───────────────▶ approaching ─────────────▶ touching ──────────▶ leaving ──▶ done
//!                                                          │                         │                   ▲
//!                                                          └──── moves, or is gone ──┴───────────────────┘
//! ```
//!
//! It leaves to where it came from. A visitor who walks makes it leave at once.

use super::{Ask, IN_PLACE_M, Phase, Seen, Step, THERE_M};
use crate::frames::{Floor, Planar};
use crate::safety::contact::ContactKind;
use crate::time::Span;

/// A column that brushes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Brush {
    speed_mps: f64,
    lasts: Span,
    from: Floor,
    phase: Phase,
    /// For how long it has been so: still while waiting, without getting nearer while approaching, at the head while touching.
    since: Span,
    nearest_m: f64,
}

impl Brush {
    /// A contact is armed, and it stands at its object.
    pub fn begin(speed_mps: f64, secs: f64, seen: &Seen<'_>) -> Option<Self> {
        let in_place = seen.rests && seen.column.distance_m(seen.place) < IN_PLACE_M;
        (seen.is_armed && in_place).then(|| Self {
            speed_mps,
            lasts: Span::from_secs(secs),
            from: seen.column,
            phase: Phase::Waiting,
            since: Span::ZERO,
            nearest_m: f64::INFINITY,
        })
    }

    /// Up to the head and back.
    pub fn step(&mut self, seen: &Seen<'_>) -> Step {
        self.since = self.since + seen.elapsed;
        let is_still = seen.head.is_some_and(|(_, velocity)| velocity.norm() < STILL_MPS);
        let walks = seen.head.is_none_or(|(_, velocity)| velocity.norm() > WALKS_MPS);
        let to_head = seen.head.map_or(Planar::ZERO, |(head, _)| head - (seen.column + seen.offset));
        match self.phase {
            Phase::Waiting if !is_still => self.since = Span::ZERO,
            Phase::Waiting if self.since >= STILL_FOR && to_head.norm() < FARTHEST_M => {
                self.turn_to(Phase::Approaching);
            }
            Phase::Approaching | Phase::Touching if walks => self.turn_to(Phase::Leaving),
            Phase::Approaching if to_head.norm() < THERE_M => self.turn_to(Phase::Touching),
            Phase::Approaching if to_head.norm() < self.nearest_m - THERE_M => {
                (self.nearest_m, self.since) = (to_head.norm(), Span::ZERO);
            }
            // R14 lets it come no nearer: at the prop's length all the same.
            Phase::Approaching if seen.rests && self.since >= NO_NEARER_FOR => self.turn_to(Phase::Touching),
            Phase::Touching if self.since >= self.lasts => self.turn_to(Phase::Leaving),
            Phase::Leaving if seen.rests && seen.column.distance_m(self.from) < THERE_M => {
                self.turn_to(Phase::Done);
            }
            _ => {}
        }
        let contact = |way: Planar| {
            let speed_mps = (NEARING_PER_SEC * way.norm()).clamp(LEAST_MPS, self.speed_mps);
            let velocity = way.unit().map_or(Planar::ZERO, |unit| unit * speed_mps);
            Ask::Contact(ContactKind::Brush, velocity)
        };
        Step::asks(match self.phase {
            Phase::Approaching => contact(to_head),
            Phase::Leaving if seen.column.distance_m(self.from) >= THERE_M => {
                contact(self.from - seen.column)
            }
            _ => Ask::Stay,
        })
    }

    /// Where it is in this.
    pub const fn phase(&self) -> Phase {
        self.phase
    }

    const fn turn_to(&mut self, phase: Phase) {
        (self.phase, self.since) = (phase, Span::ZERO);
    }
}

/// A head that stands still is slower, m/s.
const STILL_MPS: f64 = 0.1;
/// A head that walks is faster, m/s.
const WALKS_MPS: f64 = 0.3;
/// It stands still for so long before the prop comes.
const STILL_FOR: Span = Span::from_millis(1_000);
/// From the prop to the head, m: nobody is followed through the arena.
const FARTHEST_M: f64 = 1.5;
/// It came no nearer for so long.
const NO_NEARER_FOR: Span = Span::from_millis(500);
/// A metre before the head leaves this much speed, 1/s.
const NEARING_PER_SEC: f64 = 0.8;
/// Slower it would never arrive, m/s.
const LEAST_MPS: f64 = 0.02;
