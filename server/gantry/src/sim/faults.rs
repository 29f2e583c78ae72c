//! Faults of the simulated machine, switched on and off at run time by whoever owns it.

use covr_engine::time::Span;

/// Everything that is wrong with the machine now.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Faults {
    /// Of the long rail's axis.
    pub x: AxisFaults,
    /// Of the cross rail's axis.
    pub y: AxisFaults,
    /// Of the link to the controller.
    pub link: LinkFault,
}

/// What is wrong with one axis.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AxisFaults {
    /// The carriage is jammed: it stops within centimetres and no motor force moves it.
    pub stalled: bool,
    /// The controller drives the motor this way as hard as its current limit lets it, whatever it is told; only a
    /// release of the drive ends it. (A transistor stuck on would not heed that either: the wired chain is for that.)
    pub runaway: Option<Direction>,
    /// The share of the motion that the encoder misses, 0 to 1, as a loose coupling does.
    pub encoder_slip: f64,
}

/// Which way along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// Away from the home corner.
    Positive,
    /// Towards the home corner.
    Negative,
}

/// What is wrong with the link.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LinkFault {
    /// Nothing.
    #[default]
    None,
    /// Commands and reports are lost.
    Dead,
    /// Commands arrive, and reports are, this much later.
    Slow(Span),
}

impl Direction {
    pub(crate) const fn sign(self) -> f64 {
        match self {
            Self::Positive => 1.0,
            Self::Negative => -1.0,
        }
    }
}
