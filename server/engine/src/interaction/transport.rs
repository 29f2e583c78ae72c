//! Transport: somebody sits on a prop and is carried along a path (the paper's moving in the clouds). A contact (R14).
//!
//! ```text
//!             armed visitor touches it, over          still for 1 s          at the end
//!             the seat, column at the path
//!   (offered) ───────────────────────────▶ waiting ───────────────▶ riding ───────────▶ done
//!        ▲                                    │                        │
//!        └──────────────── lets go, or is not over the seat ───────────┘
//! ```
//!
//! The rider is a load, not an obstacle; everybody else is an obstacle as ever. Whoever steps off makes the column brake; it is taken up
//! where it stands when they sit down again. A rider whose headset is lost is stopped and not dropped: the drive stays on (`engine/interacting`).

use super::course::Drive;
use super::{Ask, Over, Phase, Seen, Step};
use crate::frames::Planar;
use crate::observation::PersonId;
use crate::safety::contact::ContactKind;
use crate::scenario::Course;
use crate::time::Span;

/// A column that carries.
#[derive(Debug, Clone, PartialEq)]
pub struct Transport {
    person: PersonId,
    drive: Drive,
    /// For how long the rider has been still.
    still_for: Span,
    is_under_way: bool,
    is_done: bool,
}

impl Transport {
    /// The armed visitor sits on it, and it stands at the path.
    pub fn begin(course: &Course, seen: &Seen<'_>) -> Option<Self> {
        let person = seen.person.filter(|person| seen.is_armed && seen.touched_by.contains(person))?;
        let drive = Drive::taken_up(course, seen.place, seen.offset, seen.column).filter(|_| seen.rests)?;
        is_over_the_seat(seen).then_some(Self {
            person,
            drive,
            still_for: Span::ZERO,
            is_under_way: false,
            is_done: false,
        })
    }

    /// On along the path for as long as they sit.
    pub fn step(&mut self, seen: &Seen<'_>) -> Step {
        if self.is_done {
            return Step::asks(Ask::Stay);
        }
        if !seen.touched_by.contains(&self.person) {
            return Step::over(Over::LetGo);
        }
        if !is_over_the_seat(seen) {
            return Step::over(Over::SteppedOff);
        }
        if !self.is_under_way {
            let is_still = seen.head.is_some_and(|(_, velocity)| velocity.norm() < STILL_MPS);
            self.still_for = if is_still { self.still_for + seen.elapsed } else { Span::ZERO };
            self.is_under_way = self.still_for >= SETTLES_FOR;
            return Step::asks(Ask::Stay);
        }
        match self.drive.velocity(seen.column) {
            Some(velocity) => Step::asks(Ask::Contact(ContactKind::Transport, velocity)),
            None => {
                self.is_done = seen.rests;
                Step::asks(Ask::Contact(ContactKind::Transport, Planar::ZERO))
            }
        }
    }

    /// Waiting for the rider to settle, riding, or done.
    pub fn phase(&self) -> Phase {
        match (self.is_under_way, self.is_done) {
            (_, true) => Phase::Done,
            (true, false) => Phase::Riding,
            (false, false) => Phase::Waiting,
        }
    }
}

fn is_over_the_seat(seen: &Seen<'_>) -> bool {
    seen.head.is_some_and(|(head, _)| (seen.column + seen.offset).distance_m(head) < SEAT_M)
}

/// Nearer than this to the seat's point somebody sits on it, m; inside what R14 allows a rider.
const SEAT_M: f64 = 0.5;
/// A head that sits is slower, m/s.
const STILL_MPS: f64 = 0.2;
/// It sits still for so long before the ride begins.
const SETTLES_FOR: Span = Span::from_millis(1_000);
