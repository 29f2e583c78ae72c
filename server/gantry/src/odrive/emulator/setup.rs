//! What to emulate: the board, its line, and what it drives.

use covr_engine::time::Span;

use super::firmware::Firmware;
use crate::sim::parameters::{MachineParameters, ParameterProblem};

/// What to emulate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setup {
    /// The machine that the board drives: x on axis0, y on axis1. Its homing sequence, loops and serial timeout are not used.
    pub machine: MachineParameters,
    /// What the board runs.
    pub firmware: Firmware,
    /// Answers reach the host only at multiples of this, as frames of USB do.
    pub usb_latency: Span,
    /// Motors and encoders were calibrated, which was saved.
    pub is_calibrated: bool,
    /// Seed of the faults that come by chance.
    pub seed: u64,
}

/// A setup that no board has.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SetupProblem {
    /// Of the machine.
    #[error(transparent)]
    Machine(#[from] ParameterProblem),
    /// Of USB.
    #[error("USB latency: found {found_micros} microseconds, expected 125 or more")]
    UsbLatency {
        /// What was asked for.
        found_micros: i64,
    },
}

impl Setup {
    /// The paper's motors with an encoder as such boards have, on a board of the last firmware, calibrated and tuned.
    pub const fn paper(mut machine: MachineParameters) -> Self {
        machine.x.counts_per_turn = COUNTS_A_TURN;
        machine.y.counts_per_turn = COUNTS_A_TURN;
        Self {
            machine,
            firmware: Firmware::LAST,
            usb_latency: Span::from_millis(1),
            is_calibrated: true,
            seed: 1,
        }
    }

    /// The first thing that no board has.
    pub(super) fn check(&self) -> Result<(), SetupProblem> {
        self.machine.check()?;
        let found_micros = self.usb_latency.micros();
        if found_micros < LEAST_USB_LATENCY.micros() {
            return Err(SetupProblem::UsbLatency { found_micros });
        }
        Ok(())
    }
}

/// Of the encoder that the maker sells with the board.
const COUNTS_A_TURN: f64 = 8_192.0;
/// A micro-frame of USB 2.0.
const LEAST_USB_LATENCY: Span = Span::from_micros(125);
