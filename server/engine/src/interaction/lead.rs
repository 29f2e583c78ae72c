//! Lead: somebody holds on to a prop on a spring and is pulled along a path (the paper's magic broom). A contact (R14).
//!
//! ```text
//!             armed visitor touches it,            at the end
//!             column at the path          ┌──────────────────────▶ done (stands until the state is left)
//!   (offered) ───────────────────────▶ leading
//!        ▲                                │
//!        └─── lets go, or is out of reach ┘   taken up where it stands when they take hold again
//! ```
//!
//! The force at the hand is limited by the motor's current: from [`YIELDS_FROM_AMPS`] on the column is slower, at [`STANDS_AT_AMPS`] it stands.

use super::course::Drive;
use super::{Ask, Over, Phase, Seen, Step};
use crate::frames::Planar;
use crate::observation::PersonId;
use crate::safety::contact::ContactKind;
use crate::scenario::Course;

/// A column that leads.
#[derive(Debug, Clone, PartialEq)]
pub struct Lead {
    person: PersonId,
    drive: Drive,
    is_done: bool,
}

impl Lead {
    /// The armed visitor takes hold of it, and it stands at the path.
    pub fn begin(course: &Course, seen: &Seen<'_>) -> Option<Self> {
        let person = seen.person.filter(|person| seen.is_armed && seen.touched_by.contains(person))?;
        if !is_within_reach(seen) {
            return None;
        }
        let drive = Drive::taken_up(course, seen.place, seen.offset, seen.column).filter(|_| seen.rests)?;
        Some(Self { person, drive, is_done: false })
    }

    /// On along the path for as long as they hold on.
    pub fn step(&mut self, seen: &Seen<'_>) -> Step {
        if self.is_done {
            return Step::asks(Ask::Stay);
        }
        if !seen.touched_by.contains(&self.person) || !is_within_reach(seen) {
            return Step::over(Over::LetGo);
        }
        match self.drive.velocity(seen.column) {
            Some(velocity) => Step::asks(Ask::Contact(ContactKind::Lead, velocity * pull(seen.current_amps))),
            None => {
                self.is_done = seen.rests;
                Step::asks(Ask::Contact(ContactKind::Lead, Planar::ZERO))
            }
        }
    }

    /// Leading, or done.
    pub fn phase(&self) -> Phase {
        if self.is_done { Phase::Done } else { Phase::Leading }
    }
}

/// A hand can be on it: whatever the VR client says, nobody holds on from afar.
fn is_within_reach(seen: &Seen<'_>) -> bool {
    seen.head.is_some_and(|(head, _)| (seen.column + seen.offset).distance_m(head) < REACH_M)
}

/// The share of the speed that is left at this current.
fn pull(amps: f64) -> f64 {
    ((STANDS_AT_AMPS - amps) / (STANDS_AT_AMPS - YIELDS_FROM_AMPS)).clamp(0.0, 1.0)
}

/// From the prop to the head of who holds on to it, m: an arm, a step that comes late, and the spring.
const REACH_M: f64 = 1.5;
/// What the paper's machine takes for itself at this acceleration, and a hand's pull, A.
const YIELDS_FROM_AMPS: f64 = 3.5;
/// Short of the 5 A of R5, A.
const STANDS_AT_AMPS: f64 = 4.5;
