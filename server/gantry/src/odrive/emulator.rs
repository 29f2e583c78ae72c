//! A board that is not there: whoever talks to it over a line cannot tell it from an ODrive v3.
//!
//! ```text
//! host ─▶ line ─▶ lines of text ─▶ board: properties, axes ─▶ voltage ─▶ motors of the simulated machine
//!                                     │                                       │
//! host ◀─ line ◀── answers ◀──────────┘◀── encoders, currents ◀───────────────┘
//! ```
//!
//! A pure machine on a given clock: bytes in, bytes out, no clock, port or random source of its own. It is written from the maker's
//! documents of firmware 0.5 ("ASCII Protocol", "Control", "Trajectory", the reference of every property, release notes), and shares no code
//! with any driver. What is nowhere said is *chosen* or *unverified*, where it stands. The motors are the brushed ones of the simulated
//! machine, with their current in place of the torque-making one.

mod axis;
pub mod firmware;
pub mod orders;
mod properties;
pub mod setup;
#[cfg(test)]
mod tests;
mod text;
mod trajectory;

use covr_engine::time::{Span, Time};

use axis::{AxisConfig, MOTOR_FAILED, State};
use firmware::Firmware;
use orders::Order;
use setup::{Setup, SetupProblem};
use text::{Heard, Reader, leading_number, sealed};

use crate::emulation::line::{Line, Moment, Reply};
use crate::emulation::random::Random;
use crate::emulation::rig::{EndSwitches, Rig, TICK_MICROS};
use crate::emulation::{Axis, AxisTruth, Emulated, Traffic};

/// A board, its line, and what it drives.
#[derive(Debug, Clone)]
pub struct Emulator {
    setup: Setup,
    rig: Rig,
    board: Board,
    reader: Reader,
    line: Line,
    switches: Switches,
    random: Random,
    /// Where the motion has got to; none before the first call.
    clock: Option<Time>,
    /// Orders for later.
    orders: Vec<(Time, Order)>,
    traffic: Traffic,
}

/// The board itself.
#[derive(Debug, Clone)]
struct Board {
    firmware: Firmware,
    axes: [axis::Axis; 2],
    /// Errors of the board as a whole.
    error: u32,
    supply_volts: f64,
    temperature_c: f64,
    uptime_millis: u32,
    test_property: u32,
}

/// What is wrong now.
#[derive(Debug, Clone, Copy)]
struct Switches {
    lose: f64,
    flip: f64,
    late: (f64, Span),
    missing: f64,
    gap: (f64, Span),
    temperature_c: f64,
    /// Without power until then.
    dark_until: Option<Time>,
}

impl Emulator {
    /// A board whose power comes on with the first call.
    pub fn new(setup: Setup) -> Result<Self, SetupProblem> {
        setup.check()?;
        let rig = Rig::new(&setup.machine, EndSwitches::None);
        let switches = Switches {
            lose: 0.0,
            flip: 0.0,
            late: (0.0, Span::ZERO),
            missing: 0.0,
            gap: (0.0, Span::ZERO),
            temperature_c: USUAL_DEGREES,
            dark_until: None,
        };
        Ok(Self {
            board: Board::new(&setup, setup.firmware, &rig),
            rig,
            reader: Reader::default(),
            line: Line::new(FULL_SPEED, Some(setup.usb_latency)),
            switches,
            random: Random::new(setup.seed),
            clock: None,
            orders: Vec::new(),
            traffic: Traffic { starts: 1, ..Traffic::default() },
            setup,
        })
    }

    fn advance(&mut self, now: Time) {
        self.clock.get_or_insert(now);
        while let Some((at, byte)) = self.line.next_at_board(now) {
            self.move_on(at.rounded_down());
            self.hear(at, byte);
        }
        self.move_on(now);
    }

    /// Motors and board as they go on by themselves until `now`.
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
            self.board = Board::new(&self.setup, self.board.firmware, &self.rig);
            self.traffic.starts += 1;
        }
        let duties = match self.switches.dark_until {
            Some(_) => [None; 2],
            None => self.board.tick(&self.rig, self.switches.temperature_c),
        };
        for (axis, duty) in Axis::BOTH.into_iter().zip(duties) {
            let most_amps = f64::from(self.board.axes[axis.index()].config.current_lim);
            self.rig.apply(axis, duty, most_amps);
        }
        self.rig.tick();
    }

    fn hear(&mut self, at: Moment, byte: u8) {
        if self.switches.dark_until.is_some() {
            self.reader.forget();
            return;
        }
        self.traffic.bytes_in += 1;
        let Some(heard) = self.reader.push(byte) else { return };
        self.traffic.packets += 1;
        for answer in self.board.obey(&heard.words) {
            self.answer(at, &heard, &answer);
        }
    }

    fn answer(&mut self, at: Moment, heard: &Heard, answer: &str) {
        if self.random.chance(self.switches.missing) {
            return;
        }
        let bytes = sealed(answer, heard.is_checked);
        let mut from = at.later(LINE_TAKES);
        let (probability, span) = self.switches.late;
        if self.random.chance(probability) {
            from = from.later(span);
        }
        let (probability, span) = self.switches.gap;
        let pause = self.random.chance(probability).then(|| (1 + self.random.below(bytes.len() - 1), span));
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
            Order::Error(axis, bits) => self.board.axes[axis.index()].fail(bits),
            Order::Slip(axis, share) => self.rig.faults[axis.index()].encoder_slip = share,
            Order::Jam(axis, is_jammed) => self.rig.faults[axis.index()].stalled = is_jammed,
            Order::Runaway(axis, direction) => self.rig.faults[axis.index()].runaway = direction,
            Order::Push(axis, force_n) => self.rig.push(axis, force_n),
            Order::Supply(volts) => self.rig.supply_volts = volts,
            Order::Temperature(degrees) => switches.temperature_c = degrees,
            Order::Firmware(firmware) => {
                self.board.firmware = firmware;
                self.brown_out(now, Span::ZERO);
            }
            Order::After(span, order) => self.orders.push((now + span, *order)),
        }
    }

    fn brown_out(&mut self, now: Time, span: Span) {
        self.switches.dark_until = Some(now + span + START_TAKES);
        self.line.silence_boards(now);
        self.reader.forget();
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
        self.reader.forget();
    }

    fn truth(&self, axis: Axis) -> AxisTruth {
        self.rig.truth(axis)
    }

    fn traffic(&self) -> Traffic {
        self.traffic
    }

    fn flags(&self) -> Vec<(&'static str, bool)> {
        let is_on = |axis: Axis| self.board.axes[axis.index()].state == State::ClosedLoop;
        vec![("is_x_on", is_on(Axis::X)), ("is_y_on", is_on(Axis::Y))]
    }
}

impl Board {
    /// At power-on.
    fn new(setup: &Setup, firmware: Firmware, rig: &Rig) -> Self {
        let axis = |axis: Axis| {
            let parameters = [&setup.machine.x, &setup.machine.y][axis.index()];
            let config = AxisConfig::tuned(parameters, &setup.machine);
            axis::Axis::new(config, parameters, setup.is_calibrated, rig.counts(axis))
        };
        Self {
            firmware,
            axes: Axis::BOTH.map(axis),
            error: 0,
            supply_volts: rig.supply_volts,
            temperature_c: USUAL_DEGREES,
            uptime_millis: 0,
            test_property: 0,
        }
    }

    /// A millisecond: the shares of the supply on the motors, none with a bridge open.
    fn tick(&mut self, rig: &Rig, temperature_c: f64) -> [Option<f64>; 2] {
        self.uptime_millis += 1;
        self.supply_volts = rig.supply_volts;
        self.temperature_c = temperature_c;
        if self.supply_volts < LEAST_VOLTS {
            self.error |= UNDER_VOLTAGE;
        }
        if self.supply_volts > MOST_VOLTS {
            self.error |= OVER_VOLTAGE;
        }
        let has_board_error = self.error != 0;
        Axis::BOTH.map(|which| {
            let axis = &mut self.axes[which.index()];
            let is_too_hot = temperature_c > f64::from(axis.config.temp_limit_upper);
            if axis.state == State::ClosedLoop && (has_board_error || is_too_hot) {
                axis.fail(MOTOR_FAILED);
            }
            axis.tick(rig.counts(which), rig.amps(which), self.supply_volts)
        })
    }

    /// What a line says is done; what is answered.
    fn obey(&mut self, line: &str) -> Vec<String> {
        let mut words = line.split_whitespace();
        let command = words.next().unwrap_or_default();
        let rest: Vec<&str> = words.collect();
        match command {
            "t" | "p" | "q" | "v" | "c" => self.drive(command, &rest),
            "f" => self.with_axis(rest.first().copied(), |axis| {
                Some(format!("{:.6} {:.6}", axis.pos_estimate, axis.vel_estimate))
            }),
            "u" => self.with_axis(rest.first().copied(), |axis| {
                axis.feed_watchdog();
                None
            }),
            "r" => match rest.first() {
                Some(name) => vec![properties::read(self, name)],
                None => vec![BAD_FORMAT.into()],
            },
            "w" => match rest.first() {
                Some(name) => {
                    let value = rest.get(1).copied().unwrap_or_default();
                    properties::write(self, name, value).into_iter().collect()
                }
                None => vec![BAD_FORMAT.into()],
            },
            "sc" => {
                self.error = 0;
                self.axes.iter_mut().for_each(|axis| axis.error = 0);
                Vec::new()
            }
            "i" => {
                let [major, minor, revision] = self.firmware.parts();
                vec![
                    "Hardware version: 3.6-56V".into(),
                    format!("Firmware version: {major}.{minor}.{revision}"),
                    "Serial number: 000000000000".into(),
                ]
            }
            // Saving, erasing and starting anew: what was saved stays as it is here.
            command if command.starts_with('s') => Vec::new(),
            _ => vec!["unknown command".into()],
        }
    }

    /// A setpoint: it feeds the watchdog.
    fn drive(&mut self, command: &str, rest: &[&str]) -> Vec<String> {
        let numbers: Vec<f32> = rest.iter().skip(1).map_while(|word| leading_number(word)).collect();
        let Some(first) = numbers.first().copied() else { return vec![BAD_FORMAT.into()] };
        let second = numbers.get(1).copied();
        let third = numbers.get(2).copied();
        self.with_axis(rest.first().copied(), |axis| {
            match command {
                "t" => {
                    axis.config.input_mode = axis::TRAPEZOIDAL;
                    axis.config.control_mode = axis::POSITION;
                }
                "p" | "q" => axis.config.control_mode = axis::POSITION,
                "v" => axis.config.control_mode = VELOCITY,
                _ => axis.config.control_mode = TORQUE,
            }
            match command {
                "v" => axis.input_vel = first,
                "c" => axis.input_torque = first,
                _ => {
                    axis.input_pos = first;
                    axis.input_pos_updated();
                }
            }
            match command {
                "p" => {
                    axis.input_vel = second.unwrap_or(axis.input_vel);
                    axis.input_torque = third.unwrap_or(axis.input_torque);
                }
                "q" => axis.config.vel_limit = second.unwrap_or(axis.config.vel_limit),
                "v" => axis.input_torque = second.unwrap_or(axis.input_torque),
                _ => {}
            }
            axis.feed_watchdog();
            None
        })
    }

    fn with_axis(
        &mut self,
        number: Option<&str>,
        act: impl FnOnce(&mut axis::Axis) -> Option<String>,
    ) -> Vec<String> {
        let Some(number) = number.and_then(leading_number) else { return vec![BAD_FORMAT.into()] };
        match number as i64 {
            axis @ (0 | 1) => act(&mut self.axes[axis as usize]).into_iter().collect(),
            other => vec![format!("invalid motor {other}")],
        }
    }
}

/// What is left of a byte on the line.
fn noise(random: &mut Random, switches: &Switches, byte: u8) -> Option<u8> {
    if random.chance(switches.lose) {
        return None;
    }
    Some(if random.chance(switches.flip) { byte ^ (1 << random.below(8)) } else { byte })
}

const BAD_FORMAT: &str = "invalid command format";
const VELOCITY: i32 = 2;
const TORQUE: i32 = 1;
const UNDER_VOLTAGE: u32 = 0x2;
const OVER_VOLTAGE: u32 = 0x4;
/// The maker's defaults of `dc_bus_undervoltage_trip_level` and, for a board of 56 V, of the other.
const LEAST_VOLTS: f64 = 8.0;
const MOST_VOLTS: f64 = 59.92;
/// USB at full speed, as bits of a line with ten for a byte: about a megabyte a second.
const FULL_SPEED: u32 = 10_000_000;
/// From the end of a line to the beginning of its answer. *Unverified.*
const LINE_TAKES: Span = Span::from_micros(50);
/// From power to the first answer. *Unverified.*
const START_TAKES: Span = Span::from_millis(500);
const USUAL_DEGREES: f64 = 30.0;
