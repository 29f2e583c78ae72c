//! R14: what replaces the separation rule for one visitor while a contact interaction is under way with them.
//!
//! ```text
//!   lead        no faster than 0.6 m/s    the head stays 0.35 m from everything but the prop that is held, or is left behind
//!   transport   no faster than 0.6 m/s    the head stays over the seat (0.6 m): a load, not an obstacle
//!   brush       no faster than 0.3 m/s    the head stays 0.35 m from everything but the prop that comes up to it
//! ```
//!
//! It is for that visitor alone. Everybody else, the keep-out shapes and the travel are kept as ever. The visitor's own walking is not
//! reckoned with, as for a keep-out shape: they took hold of the thing, sat down on it, or stand still for it, and the game master looks on.
//! A pose that is not fresh ends the motion; so does a head that is not where the interaction has it.

use crate::frames::{Floor, Planar};
use crate::machine::{AxisLimits, Limits};
use crate::observation::PersonId;
use crate::safety::parameters::Parameters;

/// A contact interaction under way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact {
    /// With whom.
    pub person: PersonId,
    /// Of which kind.
    pub kind: ContactKind,
    /// The prop that they hold, sit on or are brushed by, as an index; none: the column itself.
    pub prop: Option<usize>,
    /// From the column's centre to that prop's point of touch, m.
    pub offset: Planar,
}

/// The kinds of contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ContactKind {
    /// Somebody holds on to a prop and is pulled along.
    Lead,
    /// Somebody sits or stands on a prop and is carried.
    Transport,
    /// A prop comes up to somebody who stands still.
    Brush,
}

impl Contact {
    /// The greatest speed, m/s (R14).
    pub const fn speed_mps(&self, p: &Parameters) -> f64 {
        match self.kind {
            ContactKind::Lead | ContactKind::Transport => p.contact_speed_mps,
            ContactKind::Brush => p.brush_speed_mps,
        }
    }

    /// How gently it moves: an axis's limits are never more than the machine's. A brake is not bound by it.
    pub fn limits(&self, machine: &Limits, p: &Parameters) -> Limits {
        let (acceleration_mps2, jerk_mps3) = match self.kind {
            ContactKind::Lead | ContactKind::Brush => (p.contact_acceleration_mps2, p.contact_jerk_mps3),
            ContactKind::Transport => (p.ride_acceleration_mps2, p.ride_jerk_mps3),
        };
        let axis = |of: &AxisLimits| AxisLimits {
            speed_mps: of.speed_mps.min(self.speed_mps(p)),
            acceleration_mps2: of.acceleration_mps2.min(acceleration_mps2),
            braking_mps2: of.braking_mps2.min(acceleration_mps2),
            jerk_mps3: of.jerk_mps3.min(jerk_mps3),
        };
        Limits { x: axis(&machine.x), y: axis(&machine.y) }
    }

    /// The visitor's head is over the seat, with the column's centre at `centre`.
    pub fn is_aboard(&self, centre: Floor, head: Floor, p: &Parameters) -> bool {
        (centre + self.offset).distance_m(head) <= p.aboard_m
    }
}
