//! The emulator as a host sees it: bytes in, bytes out, and what the machine truly does.

#![allow(clippy::unwrap_used, reason = "helpers of tests are outside #[test] functions")]

mod golden;
mod motion;
mod noise;
mod pins;
mod switches;
mod timing;

use covr_engine::frames::Floor;
use covr_engine::machine::Travel;
use covr_engine::time::{Span, Time};

use super::firmware::Firmware;
use super::setup::{Eeprom, EndSwitches};
use super::*;
use crate::sim::parameters::MachineParameters;

/// A host on virtual time.
struct Host {
    emulator: Emulator,
    now: Time,
}

impl Host {
    fn new(setup: Setup) -> Self {
        Self { emulator: Emulator::new(setup).unwrap(), now: Time::ZERO }
    }

    fn tuned() -> Self {
        Self::new(Setup { eeprom: Eeprom::Tuned, ..setup() })
    }

    fn with_firmware(name: &str) -> Self {
        Self::new(Setup { firmware: name.parse().unwrap(), eeprom: Eeprom::Tuned, ..setup() })
    }

    fn send(&mut self, bytes: &[u8]) {
        self.emulator.receive(self.now, bytes);
    }

    /// Everything that comes within a span.
    fn run(&mut self, span: Span) -> Vec<u8> {
        let until = self.now + span;
        let mut bytes = Vec::new();
        loop {
            let next = self.emulator.next_due().unwrap_or(until).min(until);
            self.now = next.max(self.now);
            bytes.extend(self.emulator.poll(self.now));
            if self.now >= until {
                return bytes;
            }
        }
    }

    fn run_secs(&mut self, secs: f64) -> Vec<u8> {
        self.run(Span::from_secs(secs))
    }

    /// What comes within 12 ms of these bytes: longer than any reply takes, and than a gap.
    fn exchange(&mut self, bytes: &[u8]) -> Vec<u8> {
        self.send(bytes);
        self.run(Span::from_millis(12))
    }

    /// A command that changes something; whether it was acknowledged.
    fn tell(&mut self, command: u8, data: &[u8]) -> bool {
        self.exchange(&packet(0x80, command, data)) == [0xFF]
    }

    /// The values of a reply with a right check word.
    fn ask(&mut self, command: u8) -> Option<Vec<u8>> {
        self.ask_at(0x80, command)
    }

    fn ask_at(&mut self, address: u8, command: u8) -> Option<Vec<u8>> {
        let reply = self.exchange(&[address, command]);
        let (values, check) = reply.split_at_checked(reply.len().checked_sub(2)?)?;
        let told = [&[address, command], values].concat();
        assert_eq!(check, check_word(&told).to_be_bytes(), "the check word of {reply:02X?}");
        Some(values.to_vec())
    }

    fn long(&mut self, command: u8) -> i32 {
        let values = self.ask(command).unwrap();
        i32::from_be_bytes(values[..4].try_into().unwrap())
    }

    fn longs(&mut self, command: u8) -> [i32; 2] {
        let values = self.ask(command).unwrap();
        [0, 4].map(|at| i32::from_be_bytes(values[at..at + 4].try_into().unwrap()))
    }

    fn words(&mut self, command: u8) -> [i16; 2] {
        let values = self.ask(command).unwrap();
        [0, 2].map(|at| i16::from_be_bytes(values[at..at + 2].try_into().unwrap()))
    }

    fn status(&mut self) -> u32 {
        self.ask(90).unwrap().iter().fold(0, |word, byte| word << 8 | u32::from(*byte))
    }

    fn speed_mps(&self, axis: Axis) -> f64 {
        self.emulator.truth(axis).speed_mps
    }

    fn position_m(&self, axis: Axis) -> f64 {
        self.emulator.truth(axis).position_m
    }

    fn order(&mut self, line: &str) {
        self.emulator.give(self.now, line.parse().unwrap());
    }
}

fn setup() -> Setup {
    let travel = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) };
    Setup::paper(MachineParameters::paper(travel))
}

fn packet(address: u8, command: u8, data: &[u8]) -> Vec<u8> {
    let mut bytes = [&[address, command], data].concat();
    bytes.extend(check_word(&bytes).to_be_bytes());
    bytes
}

/// Values high byte first, one after another.
fn longs(values: &[i64]) -> Vec<u8> {
    values.iter().flat_map(|value| (*value as u32).to_be_bytes()).collect()
}

/// Counts a metre of the axes.
fn counts_per_m(axis: Axis) -> f64 {
    let machine = setup().machine;
    1.0 / [machine.x, machine.y][axis.index()].metres_per_count()
}
