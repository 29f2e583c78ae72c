//! What the column does at an object beyond standing in for it: hold, step back, lead, transport, brush, park.
//!
//! Each is a small state machine of its own, drawn in its file's head. It is told what is so ([`Seen`]) and answers what it asks of the
//! column ([`Ask`]); it moves nothing. A contact ([`Ask::Contact`]) is under R14, everything else under the separation rule as ever.
//! Which interaction is offered where is the scenario's word; whether a contact may begin is the game master's (`engine/interacting`).

mod brush;
mod course;
mod hold;
mod lead;
mod park;
mod step_back;
mod transport;

use crate::frames::{Floor, Planar};
use crate::observation::PersonId;
use crate::safety::contact::ContactKind;
use crate::scenario::Interaction;
use crate::time::Span;

/// What an interaction sees of the world in one step.
#[derive(Debug, Clone, Copy)]
pub struct Seen<'a> {
    /// Since the step before.
    pub elapsed: Span,
    /// The column's centre as commanded, room frame.
    pub column: Floor,
    /// It rests, as measured.
    pub rests: bool,
    /// Where the column's centre serves the object.
    pub place: Floor,
    /// From the column's centre to the prop's point of touch, m.
    pub offset: Planar,
    /// The heading that the prop faces, rad.
    pub facing_rad: f64,
    /// The greater motor current, A.
    pub current_amps: f64,
    /// Everybody who touches the object.
    pub touched_by: &'a [PersonId],
    /// The visitor meant: whom a contact is armed for, else whoever touches the object.
    pub person: Option<PersonId>,
    /// A contact is armed for that visitor (R14).
    pub is_armed: bool,
    /// Their head: where it is and how it moves, m/s; none while it is not tracked.
    pub head: Option<(Floor, Planar)>,
    /// The visitor's rule is committed to this object.
    pub is_meant: bool,
    /// Where the column is out of everybody's reach.
    pub out_of_reach: Floor,
}

/// What an interaction asks of the column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ask {
    /// Nothing: it follows intention.
    Follow,
    /// To stay where it is.
    Stay,
    /// To go there, under the separation rule.
    Go(Floor),
    /// To move so, in contact with the visitor, under R14, m/s.
    Contact(ContactKind, Planar),
}

/// What an interaction is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// It waits for the visitor to be still, or to sit down.
    Waiting,
    /// It keeps its place under load.
    Holding,
    /// It makes way.
    SteppingBack,
    /// It pulls.
    Leading,
    /// It carries.
    Riding,
    /// It comes up to the visitor.
    Approaching,
    /// It is at the visitor.
    Touching,
    /// It goes away from the visitor.
    Leaving,
    /// It goes out of reach, or is.
    Parked,
    /// It came to its end, and stands until the scenario goes on.
    Done,
}

/// Why an interaction ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Over {
    /// The visitor let go.
    LetGo,
    /// The visitor is not on the seat any more.
    SteppedOff,
    /// Another object is meant.
    NotMeant,
}

/// One step of an interaction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// What it asks.
    pub ask: Ask,
    /// Why it is over, if it is.
    pub over: Option<Over>,
}

impl Step {
    const fn asks(ask: Ask) -> Self {
        Self { ask, over: None }
    }

    const fn over(over: Over) -> Self {
        Self { ask: Ask::Stay, over: Some(over) }
    }
}

/// An interaction under way.
#[derive(Debug, Clone, PartialEq)]
pub enum Running {
    /// See [`hold`].
    Hold(hold::Hold),
    /// See [`step_back`].
    StepBack(step_back::StepBack),
    /// See [`lead`].
    Lead(lead::Lead),
    /// See [`transport`].
    Transport(transport::Transport),
    /// See [`brush`].
    Brush(brush::Brush),
    /// See [`park`].
    Park(park::Park),
}

impl Running {
    /// Begin, where everything for it is there.
    pub fn begin(of: &Interaction, seen: &Seen<'_>) -> Option<Self> {
        match of {
            Interaction::Hold => hold::Hold::begin(seen).map(Self::Hold),
            Interaction::StepBack { distance_m } => {
                step_back::StepBack::begin(*distance_m, seen).map(Self::StepBack)
            }
            Interaction::Lead(course) => lead::Lead::begin(course, seen).map(Self::Lead),
            Interaction::Transport(course) => transport::Transport::begin(course, seen).map(Self::Transport),
            Interaction::Brush { speed_mps, secs } => {
                brush::Brush::begin(*speed_mps, *secs, seen).map(Self::Brush)
            }
            Interaction::Park => park::Park::begin(seen).map(Self::Park),
        }
    }

    /// One step.
    pub fn step(&mut self, seen: &Seen<'_>) -> Step {
        match self {
            Self::Hold(hold) => hold.step(seen),
            Self::StepBack(step_back) => step_back.step(seen),
            Self::Lead(lead) => lead.step(seen),
            Self::Transport(transport) => transport.step(seen),
            Self::Brush(brush) => brush.step(seen),
            Self::Park(park) => park.step(seen),
        }
    }

    /// What it is about.
    pub fn phase(&self) -> Phase {
        match self {
            Self::Hold(_) => Phase::Holding,
            Self::StepBack(step_back) => step_back.phase(),
            Self::Lead(lead) => lead.phase(),
            Self::Transport(transport) => transport.phase(),
            Self::Brush(brush) => brush.phase(),
            Self::Park(_) => Phase::Parked,
        }
    }

    /// The visitor may lean on the column or ride it.
    pub fn bears_somebody(&self) -> bool {
        matches!(self, Self::Hold(_) | Self::Transport(_))
    }
}

impl Phase {
    /// Its name in JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Waiting => "waiting",
            Self::Holding => "holding",
            Self::SteppingBack => "stepping_back",
            Self::Leading => "leading",
            Self::Riding => "riding",
            Self::Approaching => "approaching",
            Self::Touching => "touching",
            Self::Leaving => "leaving",
            Self::Parked => "parked",
            Self::Done => "done",
        }
    }
}

/// Nearer than this a place is reached, m.
const THERE_M: f64 = 0.02;
/// Nearer than this, and still, the column is in place, m.
const IN_PLACE_M: f64 = 0.1;
