//! One board: its registers, and what each command does to them. What a command is answered with is here too; when,
//! and whether the answer arrives, is not.

use covr_engine::time::{Span, Time};

use super::channel::{Blocked, Channel, Goal};
use super::firmware::{Firmware, Flag, PinFunction};
use super::settings::Settings;

mod answers;
mod motion;

/// A board with its two channels.
#[derive(Debug, Clone)]
pub(super) struct Board {
    address: u8,
    firmware: Firmware,
    settings: Settings,
    eeprom: Settings,
    channels: [Channel; 2],
    /// Function codes of S3, S4, S5 as the board follows them.
    pins_in_force: [u8; 3],
    senses: Senses,
    /// Encoder registers are zero when the power comes on.
    counts_at_start: [i64; 2],
    is_e_stop_latched: bool,
    were_switches_active: [bool; 2],
    blocked: [Blocked; 2],
    has_speed_error: [bool; 2],
    has_position_error: [bool; 2],
    heard_at: Time,
    baud: u32,
    shares_its_line: bool,
}

/// What a board sees of the world in a millisecond.
#[derive(Debug, Clone, Copy)]
pub(super) struct Senses {
    /// Encoder counts since power-on.
    pub(super) counts: [i64; 2],
    /// Winding currents, A.
    pub(super) amps: [f64; 2],
    /// S3 is active.
    pub(super) is_e_stop_pressed: bool,
    /// S4 and S5 are active.
    pub(super) are_switches_active: [bool; 2],
    /// On the main battery's connector, V.
    pub(super) supply_volts: f64,
    /// Of the board, degrees Celsius.
    pub(super) temperature: f64,
}

/// What a command is answered with.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Answer {
    /// 0xFF.
    Acknowledged,
    /// Values, to be followed by a check word.
    Values(Vec<u8>),
    /// Nothing: it was not valid.
    None,
}

impl Board {
    /// A board whose power comes on at `now`, with what is in its EEPROM.
    pub(super) fn new(now: Time, identity: &Identity, eeprom: Settings, senses: Senses) -> Self {
        let Identity { address, firmware, baud, shares_its_line } = *identity;
        Self {
            address,
            firmware,
            settings: eeprom.clone(),
            pins_in_force: eeprom.pins,
            eeprom,
            channels: [Channel::new(), Channel::new()],
            counts_at_start: senses.counts,
            senses,
            is_e_stop_latched: false,
            were_switches_active: [false; 2],
            blocked: [Blocked::default(); 2],
            has_speed_error: [false; 2],
            has_position_error: [false; 2],
            heard_at: now,
            baud,
            shares_its_line,
        }
    }

    /// The same board when its power comes on again.
    pub(super) fn restarted(&self, now: Time, senses: Senses) -> Self {
        let identity = Identity {
            address: self.address,
            firmware: self.firmware,
            baud: self.baud,
            shares_its_line: self.shares_its_line,
        };
        Self::new(now, &identity, self.eeprom.clone(), senses)
    }

    /// Another firmware from the next restart on: it begins with its factory settings.
    pub(super) fn flash(&mut self, firmware: Firmware) {
        self.firmware = firmware;
        self.eeprom = Settings::factory(&firmware);
    }

    /// A millisecond: the duties on the motors, none with a bridge open.
    pub(super) fn tick(&mut self, now: Time, senses: Senses) -> [Option<f64>; 2] {
        self.senses = senses;
        self.follow_pins();
        let timeout = Span::from_millis(100 * i64::from(self.settings.serial_timeout));
        if timeout != Span::ZERO && now - self.heard_at >= timeout {
            // "both motors will stop automatically" (manual, "14 - Set Serial Timeout"); how is unverified.
            self.drive_both(Goal::STOP);
        }
        if self.is_e_stopped() || self.is_main_low() {
            // "Shutdown"; "free wheeling due to under voltage" (maker's forum, topic 806).
            self.drive_both(Goal::Open);
        } else if self.is_main_high() || self.is_too_hot() {
            self.drive_both(Goal::STOP);
        }
        let mut duties = [None; 2];
        for (index, duty) in duties.iter_mut().enumerate() {
            let [encoder_sign, motor_sign] = self.signs(index);
            let channel = &mut self.channels[index];
            let told = channel.tick(
                (senses.counts[index] - self.counts_at_start[index]) * encoder_sign,
                &self.settings.velocity[index],
                &self.settings.position[index],
                self.blocked[index],
            );
            *duty = told.map(|told| told * motor_sign as f64);
            self.hold_error_limits(index);
        }
        duties
    }

    pub(super) const fn firmware(&self) -> &Firmware {
        &self.firmware
    }

    /// Maximum current of a channel, A.
    pub(super) fn maximum_amps(&self, channel: usize) -> f64 {
        f64::from(self.settings.maximum_current[channel]) / 100.0
    }

    /// It keeps its motors off because of an e-stop pin.
    pub(super) fn is_e_stopped(&self) -> bool {
        self.is_e_stop_latched || self.has_active_e_stop(false)
    }

    fn has_active_e_stop(&self, latching: bool) -> bool {
        let [s4, s5] = self.senses.are_switches_active;
        let active = [self.senses.is_e_stop_pressed, s4, s5];
        (0..3).any(|pin| {
            active[pin]
                && self.firmware.pin_function(pin, self.pins_in_force[pin])
                    == PinFunction::EStop { latches: latching }
        })
    }

    fn follow_pins(&mut self) {
        self.is_e_stop_latched |= self.has_active_e_stop(true);
        for channel in 0..2 {
            let is_active = self.senses.are_switches_active[channel];
            let has_just_tripped = is_active && !self.were_switches_active[channel];
            self.were_switches_active[channel] = is_active;
            let moves_forward = self.channels[channel].measured_cps() > 0.0;
            let function = self.switch_function(channel);
            if !is_active {
                self.blocked[channel] = Blocked::default();
            }
            match function {
                PinFunction::Home { limits_forward } if has_just_tripped => {
                    if limits_forward && moves_forward {
                        self.blocked[channel] = Blocked { forward: true, reverse: false };
                    } else {
                        self.channels[channel].drive(Goal::STOP);
                        self.channels[channel].encoder.set(0);
                    }
                }
                // One pin for both ends: which end it is says the way that the motor came (unverified).
                PinFunction::Limit { forward: true, reverse: true } if has_just_tripped => {
                    self.blocked[channel] = Blocked { forward: moves_forward, reverse: !moves_forward };
                }
                PinFunction::Limit { forward, reverse } if is_active && forward != reverse => {
                    self.blocked[channel] = Blocked { forward, reverse };
                }
                _ => {}
            }
        }
    }

    fn switch_function(&self, channel: usize) -> PinFunction {
        let pin = channel + 1;
        self.firmware.pin_function(pin, self.pins_in_force[pin])
    }

    /// "The new speed and position limits" (maker's forum, topic 806). *Unverified:* a motor beyond one is stopped, and
    /// the error stays until the power is cycled.
    fn hold_error_limits(&mut self, index: usize) {
        let beyond = |error: f64, limit: u32| limit != 0 && error.abs() > f64::from(limit);
        let channel = &self.channels[index];
        let speed = beyond(channel.speed_error(), self.settings.speed_error_limits[index]);
        let position = beyond(channel.position_error(), self.settings.position_error_limits[index]);
        self.has_speed_error[index] |= speed;
        self.has_position_error[index] |= position;
        if self.has_speed_error[index] || self.has_position_error[index] {
            self.channels[index].drive(Goal::STOP);
        }
    }

    fn drive_both(&mut self, goal: Goal) {
        self.channels.iter_mut().for_each(|channel| channel.drive(goal));
    }

    /// Of a channel's encoder and motor: bits 6 and 5 of its encoder mode turn them round (newer manual, "91").
    const fn signs(&self, channel: usize) -> [i64; 2] {
        let mode = self.settings.encoder_modes[channel];
        [if mode & 0x40 == 0 { 1 } else { -1 }, if mode & 0x20 == 0 { 1 } else { -1 }]
    }

    fn flags(&self) -> Vec<Flag> {
        let mut flags = Vec::new();
        let mut say = |flag, holds: bool| {
            if holds {
                flags.push(flag);
            }
        };
        say(Flag::EStop, self.is_e_stopped());
        say(Flag::Temperature, self.is_too_hot());
        say(Flag::TemperatureWarning, self.senses.temperature >= WARM_DEGREES);
        say(Flag::MainHigh, self.is_main_high());
        say(Flag::MainLow, self.is_main_low());
        let [least, most] = self.settings.logic_battery;
        say(Flag::LogicLow, LOGIC_TENTHS < least);
        say(Flag::LogicHigh, LOGIC_TENTHS > most);
        for channel in 0..2 {
            let amps = self.senses.amps[channel].abs();
            say(Flag::OverCurrent(channel), amps >= self.maximum_amps(channel) - CURRENT_UNIT_AMPS);
            say(Flag::SpeedError(channel), self.has_speed_error[channel]);
            say(Flag::PositionError(channel), self.has_position_error[channel]);
            let is_a_switch =
                matches!(self.switch_function(channel), PinFunction::Home { .. } | PinFunction::Limit { .. });
            say(Flag::Switch(channel), is_a_switch && self.senses.are_switches_active[channel]);
        }
        flags
    }

    fn is_main_low(&self) -> bool {
        self.main_tenths() < self.settings.main_battery[0]
    }

    fn is_main_high(&self) -> bool {
        self.main_tenths() > self.settings.main_battery[1]
    }

    fn is_too_hot(&self) -> bool {
        self.senses.temperature >= HOT_DEGREES
    }

    fn main_tenths(&self) -> u16 {
        (self.senses.supply_volts * 10.0).round() as u16
    }
}

/// What makes a board this board and not another.
#[derive(Debug, Clone, Copy)]
pub(super) struct Identity {
    pub(super) address: u8,
    pub(super) firmware: Firmware,
    pub(super) baud: u32,
    /// Multi-unit mode.
    pub(super) shares_its_line: bool,
}

/// *Unverified*: from memory, a warning from 85 and a shutdown from 100 degrees.
const WARM_DEGREES: f64 = 85.0;
const HOT_DEGREES: f64 = 100.0;
/// The logic supply that the board makes for itself: 5 V (manual, "BEC").
const LOGIC_TENTHS: u16 = 50;
const CURRENT_UNIT_AMPS: f64 = 0.01;
