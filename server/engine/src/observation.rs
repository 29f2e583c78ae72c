//! What reaches the engine from outside: facts with the time at which they were true.

use std::sync::Arc;

use crate::frames::{Point, Pose, Room};
use crate::machine::MachineReport;
use crate::time::Time;

/// A person in this run, as the shell numbers them. Never reused within a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PersonId(pub u32);

/// Where a person's hands are, each where it is known. Evidence of intention alone: nothing of safety looks at them.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Hands {
    /// The left one.
    pub left: Option<Point<Room>>,
    /// The right one.
    pub right: Option<Point<Room>>,
}

impl Hands {
    /// Nobody knows where they are.
    pub const UNKNOWN: Self = Self { left: None, right: None };

    /// Left and right.
    pub const fn both(&self) -> [Option<Point<Room>>; 2] {
        [self.left, self.right]
    }
}

/// A headset pose, already in the room frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PoseSample {
    /// When the headset was there, on the server's clock.
    pub taken_at: Time,
    /// Where it was.
    pub pose: Pose<Room>,
    /// The headset knows its place.
    pub tracked: bool,
    /// The headset is on a head.
    pub worn: bool,
    /// Where the hands were then.
    pub hands: Hands,
}

/// What the digital inputs of one kind say together: the first that is not inactive, by its name.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum InputLevel {
    /// There is none of this kind.
    #[default]
    Absent,
    /// All are inactive.
    Inactive,
    /// This one is active.
    Active(Arc<str>),
    /// This one gives no good word: it counts as active.
    Silent(Arc<str>),
}

/// What the digital inputs say.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Inputs {
    /// Inputs that stop (R4).
    pub stop: InputLevel,
    /// Inputs that notice somebody whom nobody tracks (R12).
    pub intruder: InputLevel,
}

/// A fact.
#[derive(Debug, Clone, PartialEq)]
pub enum Observation {
    /// A person with a headset came into the arena.
    PersonEntered(PersonId),
    /// A person left the arena, said by their client.
    PersonLeft(PersonId),
    /// A headset pose; the newest wins.
    Pose(PersonId, PoseSample),
    /// The tracking origin moved: recentre, relocalisation, headset off and on (R15).
    OriginChanged(PersonId),
    /// A hand of this person met the object of this id.
    TouchBegan(PersonId, Arc<str>),
    /// And let go of it.
    TouchEnded(PersonId, Arc<str>),
    /// The client of this person is gone without a word (R10); the person is still there.
    ClientGone(PersonId),
    /// The client of this person is back.
    ClientBack(PersonId),
    /// What the machine says, once a period.
    Machine(MachineReport),
    /// What the digital inputs say; it holds until the next.
    Inputs(Inputs),
    /// Whether a dashboard of somebody who may arm is connected (R11); it holds until the next.
    GameMaster(bool),
    /// The control loop began a step more than one period late (R9).
    DeadlineMissed,
    /// The control loop began a step in time.
    DeadlineMet,
}
