//! What to emulate: the boards, how they are wired, their line, and what they drive.

use covr_engine::time::Span;

use super::firmware::Firmware;
use super::framing::ADDRESSES;
use super::settings::{PositionPid, Settings, VelocityPid};
use crate::emulation::Axis;
use crate::sim::parameters::{MachineParameters, ParameterProblem};

pub use crate::emulation::rig::EndSwitches;

/// What to emulate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setup {
    /// The machine that the boards drive. Its homing sequence, loops and serial timeout are not used: they are the host's.
    pub machine: MachineParameters,
    /// How the axes are wired.
    pub wiring: Wiring,
    /// What every board runs.
    pub firmware: Firmware,
    /// Address of the first board.
    pub address: u8,
    /// Bits a second on the line.
    pub baud: u32,
    /// Replies reach the host only at multiples of this, as through a USB bridge. A lone board on USB also answers to
    /// every address (manual, "Address").
    pub usb_latency: Option<Span>,
    /// Which ends of an axis have a switch; its pin is the channel's (S4 of M1, S5 of M2).
    pub end_switches: EndSwitches,
    /// What is in the boards' EEPROM.
    pub eeprom: Eeprom,
    /// Seed of the faults that come by chance.
    pub seed: u64,
}

/// How the axes are wired.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wiring {
    /// One board: x on M1, y on M2.
    OneBoard,
    /// Two boards on one line with addresses in a row: x on M1 of the first, y on M1 of the second.
    TwoBoards,
}

/// What is in the boards' EEPROM when they come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Eeprom {
    /// The factory's settings.
    Factory,
    /// The same with the velocity and position constants that tuning finds for these motors.
    Tuned,
}

/// A setup that no board has.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SetupProblem {
    /// Of the machine.
    #[error(transparent)]
    Machine(#[from] ParameterProblem),
    /// Of the line.
    #[error("baud: found {0}, expected 2400, 9600, 19200, 38400, 57600, 115200, 230400 or 460800")]
    Baud(u32),
    /// Of a board.
    #[error("address: found {0:#04x}, expected 0x80 to 0x87, for each board")]
    Address(u8),
    /// Of the bridge.
    #[error("USB latency: found {found_micros} microseconds, expected 125 or more")]
    UsbLatency {
        /// What was asked for.
        found_micros: i64,
    },
}

impl Setup {
    /// The paper's machine on one board at 0x80 and 115200 baud, with home switches, as it comes from the factory.
    pub fn paper(machine: MachineParameters) -> Self {
        Self {
            machine,
            wiring: Wiring::OneBoard,
            firmware: Firmware::default(),
            address: *ADDRESSES.start(),
            baud: 115_200,
            usb_latency: None,
            end_switches: EndSwitches::Low,
            eeprom: Eeprom::Factory,
            seed: 1,
        }
    }

    /// What tuning finds for the two axes.
    pub fn tuned(&self) -> [(VelocityPid, PositionPid); 2] {
        let machine = &self.machine;
        let p = (machine.tuning.position_gain_per_s * 1_024.0).round() as u32;
        [&machine.x, &machine.y]
            .map(|axis| (VelocityPid::tuned(axis, machine), PositionPid { p, ..PositionPid::default() }))
    }

    /// The first thing that no board has.
    pub(super) fn check(&self) -> Result<(), SetupProblem> {
        self.machine.check()?;
        if !RATES.contains(&self.baud) {
            return Err(SetupProblem::Baud(self.baud));
        }
        if self.addresses().any(|address| !ADDRESSES.contains(&address)) {
            return Err(SetupProblem::Address(self.address));
        }
        if let Some(found_micros) = self.usb_latency.map(Span::micros)
            && found_micros < LEAST_USB_LATENCY.micros()
        {
            return Err(SetupProblem::UsbLatency { found_micros });
        }
        Ok(())
    }

    pub(super) fn addresses(&self) -> impl Iterator<Item = u8> + use<> {
        let count = match self.wiring {
            Wiring::OneBoard => 1,
            Wiring::TwoBoards => 2,
        };
        let first = self.address;
        (0..count).map(move |index| first.saturating_add(index))
    }

    /// What hangs on M1 and M2 of a board.
    pub(super) const fn axes(&self, board: usize) -> [Option<Axis>; 2] {
        match (self.wiring, board) {
            (Wiring::OneBoard, _) => [Some(Axis::X), Some(Axis::Y)],
            (Wiring::TwoBoards, 0) => [Some(Axis::X), None],
            (Wiring::TwoBoards, _) => [Some(Axis::Y), None],
        }
    }

    pub(super) fn board_for(&self, address: u8) -> Option<usize> {
        let is_alone_on_usb = self.usb_latency.is_some() && self.wiring == Wiring::OneBoard;
        if is_alone_on_usb { Some(0) } else { self.addresses().position(|own| own == address) }
    }

    /// What is in the EEPROM of a board.
    pub(super) fn settings(&self, board: usize) -> Settings {
        let mut settings = Settings::factory(&self.firmware);
        if self.eeprom == Eeprom::Tuned {
            let tuned = self.tuned();
            for (channel, axis) in self.axes(board).into_iter().enumerate() {
                if let Some(axis) = axis {
                    (settings.velocity[channel], settings.position[channel]) = tuned[axis.index()];
                }
            }
        }
        settings
    }

    /// From the last bit of a command to the first of its reply: "at least a 1ms delay" up to 38400 baud (manual,
    /// "Packet Serial Wiring"). *Unverified* above.
    pub(super) const fn turnaround(&self) -> Span {
        if self.baud <= 38_400 { Span::from_millis(1) } else { Span::from_micros(200) }
    }
}

/// Manual, "Packet Serial Baud Rate".
const RATES: [u32; 8] = [2_400, 9_600, 19_200, 38_400, 57_600, 115_200, 230_400, 460_800];
/// A micro-frame of USB 2.0.
const LEAST_USB_LATENCY: Span = Span::from_micros(125);
