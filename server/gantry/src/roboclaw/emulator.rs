//! Boards that are not there: whoever talks to them over a serial line cannot tell them from RoboClaws.
//!
//! ```text
//! host ─▶ line ─▶ framing ─▶ board: registers, channels ─▶ duty ─▶ motors of the simulated machine
//!                               │                                        │
//! host ◀─ line ◀── reply ◀──────┘◀─── encoders, currents, end switches ◀─┘
//! ```
//!
//! A pure machine on a given clock: bytes in, bytes out, no clock, port or random source of its own. The same calls
//! give the same bytes. It is written from the maker's description and from what owners of boards measured, and shares
//! no code with any driver.
//!
//! Where a fact comes from:
//! - *manual*: Basicmicro's "RoboClaw Series User Manual", by the command's heading. There are two generations of it,
//!   "older" and "newer" here, which differ in the status word and the pin functions.
//! - *maker's forum*: forums.basicmicro.com, by topic number, where the maker's support answers.
//! - *unverified*: nowhere found, or found to be contradictory; what was chosen stands beside it. A real board may differ.
//!
//! - [`setup`]: what to emulate.
//! - [`orders`]: everything that can be made to go wrong.
//! - [`firmware`]: the firmwares that it can pretend to be.
//! - [`settings`]: what a board keeps.

mod board;
mod channel;
mod commands;
mod crc;
mod encoder;
pub mod firmware;
mod framing;
pub mod orders;
pub mod settings;
pub mod setup;
mod speed_loop;
#[cfg(test)]
mod tests;

use covr_engine::time::{Span, Time};

use board::{Answer, Board, Identity, Senses};
use commands::shape;
use crc::check_word;
use framing::{Framer, Packet};
use orders::{Axis, Order};
use setup::{Setup, SetupProblem, Wiring};

use crate::emulation::line::{Line, Moment, Reply};
use crate::emulation::random::Random;
use crate::emulation::rig::{Rig, TICK_MICROS};
pub use crate::emulation::{AxisTruth, Emulated, Traffic};

/// Boards, their line, and what they drive.
#[derive(Debug, Clone)]
pub struct Emulator {
    setup: Setup,
    rig: Rig,
    boards: Vec<Board>,
    framer: Framer,
    line: Line,
    switches: Switches,
    random: Random,
    /// Where the motion has got to; none before the first call.
    clock: Option<Time>,
    /// Orders for later.
    orders: Vec<(Time, Order)>,
    traffic: Traffic,
}

/// What is wrong now.
#[derive(Debug, Clone, Copy, Default)]
struct Switches {
    lose: f64,
    flip: f64,
    late: (f64, Span),
    missing: f64,
    gap: (f64, Span),
    is_pressed: bool,
    stuck_at: Option<bool>,
    temperature: Option<f64>,
    /// Without power until then.
    dark_until: Option<Time>,
}

impl Emulator {
    /// Boards whose power comes on with the first call.
    pub fn new(setup: Setup) -> Result<Self, SetupProblem> {
        setup.check()?;
        Ok(Self {
            rig: Rig::new(&setup.machine, setup.end_switches),
            boards: Vec::new(),
            framer: Framer::default(),
            line: Line::new(setup.baud, setup.usb_latency),
            switches: Switches::default(),
            random: Random::new(setup.seed),
            clock: None,
            orders: Vec::new(),
            traffic: Traffic::default(),
            setup,
        })
    }

    /// A board keeps its motors off because of its e-stop pin.
    pub fn is_e_stopped(&self) -> bool {
        self.boards.iter().any(Board::is_e_stopped)
    }

    fn advance(&mut self, now: Time) {
        if self.clock.is_none() {
            self.clock = Some(now);
            self.start(now);
        }
        while let Some((at, byte)) = self.line.next_at_board(now) {
            self.move_on(at.rounded_down());
            self.hear(at, byte);
        }
        self.move_on(now);
    }

    /// Motors and boards as they go on by themselves until `now`.
    fn move_on(&mut self, now: Time) {
        let mut clock = self.clock.unwrap_or(now);
        while clock + Span::from_micros(TICK_MICROS) <= now {
            self.tick(clock);
            clock += Span::from_micros(TICK_MICROS);
        }
        self.clock = Some(clock);
    }

    fn tick(&mut self, clock: Time) {
        let (due, later) = std::mem::take(&mut self.orders).into_iter().partition(|(at, _)| *at <= clock);
        self.orders = later;
        let due: Vec<_> = due;
        for (_, order) in due {
            self.obey(clock, order);
        }
        if self.switches.dark_until.is_some_and(|until| until <= clock) {
            self.switches.dark_until = None;
            let boards = self.boards.iter().enumerate();
            self.boards = boards.map(|(index, board)| board.restarted(clock, self.senses(index))).collect();
            self.traffic.starts += 1;
        }
        for index in 0..self.boards.len() {
            self.tick_board(clock, index);
        }
        self.rig.tick();
    }

    fn tick_board(&mut self, clock: Time, index: usize) {
        let axes = self.setup.axes(index);
        let senses = self.senses(index);
        let board = &mut self.boards[index];
        let duties = match self.switches.dark_until {
            Some(_) => [None; 2],
            None => board.tick(clock, senses),
        };
        for (channel, axis) in axes.into_iter().enumerate() {
            if let Some(axis) = axis {
                self.rig.apply(axis, duties[channel], board.maximum_amps(channel));
            }
        }
    }

    /// What a board sees now.
    fn senses(&self, board: usize) -> Senses {
        let axes = self.setup.axes(board);
        let of_axes = |value: &dyn Fn(Axis) -> f64| axes.map(|axis| axis.map_or(0.0, value));
        Senses {
            counts: axes.map(|axis| axis.map_or(0, |axis| self.rig.counts(axis))),
            amps: of_axes(&|axis| self.rig.amps(axis)),
            is_e_stop_pressed: self.switches.stuck_at.unwrap_or(self.switches.is_pressed),
            are_switches_active: axes.map(|axis| axis.is_some_and(|axis| self.rig.is_switch_active(axis))),
            supply_volts: self.rig.supply_volts,
            temperature: self.switches.temperature.unwrap_or(USUAL_DEGREES),
        }
    }

    fn hear(&mut self, at: Moment, byte: u8) {
        if self.switches.dark_until.is_some() {
            self.framer.forget();
            return;
        }
        self.traffic.bytes_in += 1;
        let Self { framer, boards, setup, .. } = self;
        let packet = framer.push(at, byte, |address, command| {
            // A packet for somebody else has to be counted through all the same.
            let board = setup.board_for(address).and_then(|index| boards.get(index));
            let firmware = board.map_or(setup.firmware, |board| *board.firmware());
            shape(command, &firmware)
        });
        if let Some(packet) = packet {
            self.answer(at, &packet);
        }
    }

    fn answer(&mut self, at: Moment, packet: &Packet) {
        let Some(index) = self.setup.board_for(packet.address) else { return };
        self.traffic.packets += 1;
        let answer = self.boards[index].answer(at.rounded_up(), packet.command, &packet.data);
        let bytes = match answer {
            Answer::None => return,
            Answer::Acknowledged => vec![ACKNOWLEDGED],
            Answer::Values(values) => {
                let mut told = vec![packet.address, packet.command];
                told.extend(&values);
                [values, check_word(&told).to_be_bytes().to_vec()].concat()
            }
        };
        if self.random.chance(self.switches.missing) {
            return;
        }
        let mut from = at.later(self.setup.turnaround());
        let (probability, span) = self.switches.late;
        if self.random.chance(probability) {
            from = from.later(span);
        }
        let (probability, span) = self.switches.gap;
        // In the middle: after the first byte at the earliest. An acknowledgement has no middle.
        let pause = (bytes.len() > 1 && self.random.chance(probability))
            .then(|| (1 + self.random.below(bytes.len() - 1), span));
        self.traffic.bytes_out += bytes.len() as u64;
        let Self { line, random, switches, .. } = self;
        line.send_to_host(&Reply { from, bytes, pause }, |byte| noise(random, switches, byte));
    }

    fn obey(&mut self, now: Time, order: Order) {
        let switches = &mut self.switches;
        match order {
            Order::Lose(probability) => switches.lose = probability,
            Order::Flip(probability) => switches.flip = probability,
            Order::Late(probability, span) => switches.late = (probability, span),
            Order::Missing(probability) => switches.missing = probability,
            Order::Gap(probability, span) => switches.gap = (probability, span),
            Order::BrownOut(span) => self.brown_out(now, span),
            Order::Press(is_pressed) => switches.is_pressed = is_pressed,
            Order::Stick(level) => switches.stuck_at = level,
            Order::Switch(axis, level) => self.rig.stuck_switches[axis.index()] = level,
            Order::Slip(axis, share) => self.rig.faults[axis.index()].encoder_slip = share,
            Order::Jam(axis, is_jammed) => self.rig.faults[axis.index()].stalled = is_jammed,
            Order::Runaway(axis, direction) => self.rig.faults[axis.index()].runaway = direction,
            Order::Push(axis, force_n) => self.rig.push(axis, force_n),
            Order::Supply(volts) => self.rig.supply_volts = volts,
            Order::Temperature(degrees) => switches.temperature = Some(degrees),
            Order::Firmware(firmware) => {
                self.boards.iter_mut().for_each(|board| board.flash(firmware));
                self.brown_out(now, Span::ZERO);
            }
            Order::After(span, order) => self.orders.push((now + span, *order)),
        }
    }

    fn brown_out(&mut self, now: Time, span: Span) {
        self.switches.dark_until = Some(now + span + START_TAKES);
        self.line.silence_boards(now);
        self.framer.forget();
    }

    fn start(&mut self, now: Time) {
        let shares_its_line = self.setup.wiring == Wiring::TwoBoards;
        let Setup { firmware, baud, .. } = self.setup;
        let boards = self.setup.addresses().enumerate().map(|(index, address)| {
            let identity = Identity { address, firmware, baud, shares_its_line };
            Board::new(now, &identity, self.setup.settings(index), self.senses(index))
        });
        self.boards = boards.collect();
        self.traffic.starts = 1;
    }
}

impl Emulated for Emulator {
    type Order = Order;

    fn receive(&mut self, now: Time, bytes: &[u8]) {
        self.advance(now);
        for byte in bytes {
            let arriving = noise(&mut self.random, &self.switches, *byte);
            self.line.send_to_board(now, arriving);
        }
    }

    fn poll(&mut self, now: Time) -> Vec<u8> {
        self.advance(now);
        self.line.at_host(now)
    }

    fn next_due(&self) -> Option<Time> {
        self.line.next_due()
    }

    fn backlog(&self) -> usize {
        self.line.backlog()
    }

    fn give(&mut self, now: Time, order: Order) {
        self.advance(now);
        self.obey(now, order);
    }

    fn unplug(&mut self, now: Time) {
        self.advance(now);
        self.line.cut();
    }

    fn truth(&self, axis: Axis) -> AxisTruth {
        self.rig.truth(axis)
    }

    fn traffic(&self) -> Traffic {
        self.traffic
    }

    fn flags(&self) -> Vec<(&'static str, bool)> {
        vec![("is_e_stopped", self.is_e_stopped())]
    }
}

/// What is left of a byte on the line.
fn noise(random: &mut Random, switches: &Switches, byte: u8) -> Option<u8> {
    if random.chance(switches.lose) {
        return None;
    }
    Some(if random.chance(switches.flip) { byte ^ (1 << random.below(8)) } else { byte })
}

/// Manual, "Packet Acknowledgement".
const ACKNOWLEDGED: u8 = 0xFF;
/// From power to the first answer. *Unverified.*
const START_TAKES: Span = Span::from_millis(500);
const USUAL_DEGREES: f64 = 27.5;
