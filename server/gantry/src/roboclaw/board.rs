//! Boards, one type for each step on the way to motion: [`Connected`], identified, [`Configured`].
//!
//! Only a configured board has a verb that moves. What was set is read back, and a board that keeps another value is refused.

use covr_engine::machine::Trouble;

use super::exchange::{Line, Lost};
use super::firmware::{Firmware, Status};
use super::packet::{Command, Packet, Reply};
use super::settings::{AxisSettings, Boards, Settings, VelocityPid};
use crate::homing::HomeBy;
use crate::linked::figures::Tally;
use crate::linked::link::{Loss, Refusal};
use crate::linked::port::Port;

/// Why a board is not driven.
#[derive(Debug, thiserror::Error)]
pub enum Refused {
    /// An exchange failed.
    #[error(transparent)]
    Lost(#[from] Lost),
    /// Its firmware is none of the known.
    #[error("the board at address {address:#04x} has firmware {found:?}; known are 4.1, 4.2 and 4.3")]
    UnknownFirmware { address: u8, found: String },
    /// Two boards with different tables.
    #[error("the boards have different firmwares: {0:?} and {1:?}")]
    DifferentFirmwares(String, String),
    /// Its switches' pins had other functions; the new ones are stored and come into force with its next start.
    #[error(
        "the board at address {address:#04x} had other functions on S4 and S5: the new ones are stored; switch its power off and on"
    )]
    SwitchOffAndOn { address: u8 },
    /// It does not keep what it was told.
    #[error("the board at address {address:#04x} does not keep its {what}: told {told}, it says {says}")]
    NotKept { address: u8, what: &'static str, told: String, says: String },
}

impl Refusal for Refused {
    fn trouble(&self) -> Trouble {
        match self {
            Self::Lost(_) => Trouble::NoAnswer,
            Self::UnknownFirmware { .. } | Self::DifferentFirmwares(..) => Trouble::UnknownFirmware,
            Self::NotKept { .. } => Trouble::NotConfigured,
            Self::SwitchOffAndOn { .. } => Trouble::SwitchOffAndOn,
        }
    }

    fn loss(&self) -> Option<Loss> {
        match self {
            Self::Lost(Lost::Port(_)) => Some(Loss::Port),
            Self::Lost(_) => Some(Loss::Answer),
            _ => None,
        }
    }
}

/// Something answers, perhaps.
pub struct Connected<P> {
    line: Line<P>,
    boards: Boards,
}

/// The firmware is known.
pub struct Identified<P> {
    line: Line<P>,
    boards: Boards,
    firmware: Firmware,
    text: String,
}

/// Everything is set and read back: it can be driven.
pub struct Configured<P> {
    line: Line<P>,
    boards: Boards,
    firmware: Firmware,
    text: String,
    serial_timeout_tenths: u8,
}

/// What both axes are to do, in counts; the distance cap after which they brake by themselves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Motion {
    /// Counts a second, signed.
    pub speed: [i32; 2],
    /// Greatest change of speed, counts a second squared.
    pub acceleration: [u32; 2],
    /// The cap, counts.
    pub distance: [u32; 2],
    /// The same change of speed for the brake after the cap.
    pub braking: [u32; 2],
}

/// One look at the motors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Look {
    /// Encoder counts.
    pub counts: [i32; 2],
    /// Counts a second.
    pub speeds: [i32; 2],
    /// A.
    pub amps: [f64; 2],
    /// What the boards say; with two, whatever either says.
    pub status: Status,
}

impl Boards {
    fn addresses(self) -> Vec<u8> {
        match self {
            Self::One(address) => vec![address],
            Self::Two(addresses) => addresses.to_vec(),
        }
    }
}

impl<P: Port> Connected<P> {
    pub fn new(port: P, settings: &Settings) -> Self {
        Self { line: Line::new(port, settings.baud), boards: settings.boards }
    }

    /// Ask which firmware it is.
    pub fn identify(mut self) -> Result<Identified<P>, Refused> {
        let mut found: Option<(Firmware, String)> = None;
        for address in self.boards.addresses() {
            let text = self.line.ask_text(Packet::to(address, Command::ReadFirmware).question())?;
            let Some(firmware) = Firmware::of(&text) else {
                return Err(Refused::UnknownFirmware { address, found: text });
            };
            match &found {
                Some((first, first_text)) if *first != firmware => {
                    return Err(Refused::DifferentFirmwares(first_text.clone(), text));
                }
                _ => found = Some((firmware, text)),
            }
        }
        let (firmware, text) = found.unwrap_or((Firmware::Older, String::new()));
        Ok(Identified { line: self.line, boards: self.boards, firmware, text })
    }
}

impl<P: Port> Identified<P> {
    /// Release both motors and set everything, reading each back.
    pub fn configure(mut self, settings: &Settings) -> Result<Configured<P>, Refused> {
        let tenths = (settings.serial_timeout.secs() * 10.0).round().clamp(1.0, 255.0) as u8;
        for (board, address) in self.boards.addresses().into_iter().enumerate() {
            let to = |command| Packet::to(address, command);
            self.line.tell_again(&to(Command::DutyBoth).word(0).word(0).sealed())?;
            for set in [Command::SetEncoderM1, Command::SetEncoderM2] {
                self.line.tell_again(&to(set).signed(COUNTS_AT_FIRST).sealed())?;
            }
            self.line.tell_again(&to(Command::SetSerialTimeout).byte(tenths).sealed())?;
            let says = self.line.ask::<1>(to(Command::ReadSerialTimeout).question())?;
            kept(address, "serial timeout", [tenths], says)?;
            let modes = self.firmware.pin_modes(settings.home_by == HomeBy::Switches);
            let [s3, s4, s5] = modes;
            let [_, before @ ..] = self.line.ask::<3>(to(Command::ReadPinModes).question())?;
            self.line.tell_again(&to(Command::SetPinModes).byte(s3).byte(s4).byte(s5).sealed())?;
            kept(address, "pin modes", modes, self.line.ask::<3>(to(Command::ReadPinModes).question())?)?;
            if before != [s4, s5] {
                // Firmware 4.1.34 takes up a new function of S4 or S5 only when it starts with it stored (maker's support).
                self.line.tell_again(&to(Command::SaveSettings).long(SAVE_KEY).sealed())?;
                return Err(Refused::SwitchOffAndOn { address });
            }
            let axes = match self.boards {
                Boards::One(_) => &settings.axes[..],
                Boards::Two(_) => &settings.axes[board..=board],
            };
            for (channel, axis) in axes.iter().enumerate() {
                self.set_velocity_pid(address, channel, axis)?;
            }
        }
        let mut board = Configured {
            line: self.line,
            boards: self.boards,
            firmware: self.firmware,
            text: self.text,
            serial_timeout_tenths: tenths,
        };
        board.limit_current(settings.current_limit_amps)?;
        Ok(board)
    }

    fn set_velocity_pid(&mut self, address: u8, channel: usize, axis: &AxisSettings) -> Result<(), Refused> {
        let Some(VelocityPid { p, i, d, qpps }) = axis.velocity_pid else { return Ok(()) };
        let [set, read] = [
            [Command::SetVelocityPidM1, Command::ReadVelocityPidM1],
            [Command::SetVelocityPidM2, Command::ReadVelocityPidM2],
        ][channel];
        let [p, i, d] = [p, i, d].map(|gain| (gain * FIXED_POINT).round() as u32);
        // Set as D, P, I; read as P, I, D (manual, commands 28 and 55).
        let packet = Packet::to(address, set).long(d).long(p).long(i).long(qpps).sealed();
        self.line.tell_again(&packet)?;
        let says = self.line.ask::<16>(Packet::to(address, read).question())?;
        let says = [0, 4, 8, 12].map(|at| Reply(&says).long(at));
        kept(address, "velocity gains", [p, i, d, qpps], says)
    }
}

impl<P: Port> Configured<P> {
    /// The firmware's own words, and the profile.
    pub fn firmware(&self) -> (&str, Firmware) {
        (&self.text, self.firmware)
    }

    pub fn tally(&self) -> Tally {
        self.line.tally
    }

    /// Both motors without torque.
    pub fn release(&mut self) -> Result<(), Lost> {
        for address in self.boards.addresses() {
            self.line.tell(&Packet::to(address, Command::DutyBoth).word(0).word(0).sealed())?;
        }
        Ok(())
    }

    /// Brake both axes to rest and keep the speed at nothing.
    pub fn brake(&mut self, braking: [u32; 2]) -> Result<(), Lost> {
        match self.boards {
            Boards::One(address) => {
                let packet = Packet::to(address, Command::SpeedAccelBoth);
                let packet = packet.long(braking[0]).signed(0).long(braking[1]).signed(0);
                self.line.tell(&packet.sealed())
            }
            Boards::Two(addresses) => {
                // Both are told, whatever the first says.
                let told = [0, 1].map(|i| {
                    let packet = Packet::to(addresses[i], Command::SpeedAccelM1).long(braking[i]).signed(0);
                    self.line.tell(&packet.sealed())
                });
                told.into_iter().collect()
            }
        }
    }

    /// Go on like this, at once; and behind it in the board's buffer the brake that begins when the distance is through.
    pub fn go(&mut self, motion: &Motion) -> Result<(), Lost> {
        let Motion { speed, acceleration, distance, braking } = *motion;
        self.buffer(acceleration, speed, distance, AT_ONCE)?;
        self.buffer(braking, [0; 2], [0; 2], AFTERWARDS)
    }

    fn buffer(
        &mut self,
        acceleration: [u32; 2],
        speed: [i32; 2],
        distance: [u32; 2],
        when: u8,
    ) -> Result<(), Lost> {
        match self.boards {
            Boards::One(address) => {
                let mut packet = Packet::to(address, Command::SpeedAccelDistanceBoth);
                for i in 0..2 {
                    packet = packet.long(acceleration[i]).signed(speed[i]).long(distance[i]);
                }
                self.line.tell(&packet.byte(when).sealed())
            }
            Boards::Two(addresses) => {
                let told = [0, 1].map(|i| {
                    let packet = Packet::to(addresses[i], Command::SpeedAccelDistanceM1);
                    let packet = packet.long(acceleration[i]).signed(speed[i]).long(distance[i]);
                    self.line.tell(&packet.byte(when).sealed())
                });
                told.into_iter().collect()
            }
        }
    }

    /// Limit the current of every motor, A, and read it back.
    pub fn limit_current(&mut self, amps: f64) -> Result<(), Refused> {
        let told = (amps / CURRENT_STEP_AMPS).round() as u32;
        for address in self.boards.addresses() {
            let channels = [
                (Command::SetMaxCurrentM1, Command::ReadMaxCurrentM1),
                (Command::SetMaxCurrentM2, Command::ReadMaxCurrentM2),
            ];
            for (set, read) in channels {
                self.line.tell_again(&Packet::to(address, set).long(told).long(0).sealed())?;
                let says = self.line.ask::<8>(Packet::to(address, read).question())?;
                kept(address, "current limit", told, Reply(&says).long(0))?;
            }
        }
        Ok(())
    }

    /// Everything that changes from look to look.
    pub fn look(&mut self) -> Result<Look, Lost> {
        match self.boards {
            Boards::One(address) => {
                let counts = self.line.ask::<8>(Packet::to(address, Command::ReadEncoders).question())?;
                let speeds = [
                    self.speed(address, Command::ReadRawSpeedM1)?,
                    self.speed(address, Command::ReadRawSpeedM2)?,
                ];
                let amps = self.line.ask::<4>(Packet::to(address, Command::ReadCurrents).question())?;
                let status = self.status(address)?;
                let counts = [Reply(&counts).signed(0), Reply(&counts).signed(4)];
                Ok(Look { counts, speeds, amps: [amperes(&amps, 0), amperes(&amps, 2)], status })
            }
            Boards::Two(addresses) => {
                let mut look =
                    Look { counts: [0; 2], speeds: [0; 2], amps: [0.0; 2], status: Status::default() };
                for (i, address) in addresses.into_iter().enumerate() {
                    let counts =
                        self.line.ask::<5>(Packet::to(address, Command::ReadEncoderM1).question())?;
                    look.counts[i] = Reply(&counts).signed(0);
                    look.speeds[i] = self.speed(address, Command::ReadRawSpeedM1)?;
                    let amps = self.line.ask::<4>(Packet::to(address, Command::ReadCurrents).question())?;
                    look.amps[i] = amperes(&amps, 0);
                    look.status.take_in(self.status(address)?, i);
                }
                Ok(look)
            }
        }
    }

    /// Main battery, V, of the first board.
    pub fn main_volts(&mut self) -> Result<f64, Lost> {
        Ok(f64::from(self.ask_first(Command::ReadMainVolts)?) * 0.1)
    }

    /// Temperature of the first board, degrees Celsius.
    pub fn temperature_c(&mut self) -> Result<f64, Lost> {
        Ok(f64::from(self.ask_first(Command::ReadTemperature)?) * 0.1)
    }

    /// Whether every board still has the serial timeout that it was given: one that restarted has not.
    pub fn keeps_its_timeout(&mut self) -> Result<bool, Lost> {
        for address in self.boards.addresses() {
            let question = Packet::to(address, Command::ReadSerialTimeout).question();
            let says = self.line.ask_if_well::<1>(question)?;
            if says != [self.serial_timeout_tenths] {
                return Ok(false);
            }
        }
        Ok(true)
    }

    fn ask_first(&mut self, command: Command) -> Result<u16, Lost> {
        let (Boards::One(address) | Boards::Two([address, _])) = self.boards;
        let answer = self.line.ask_if_well::<2>(Packet::to(address, command).question())?;
        Ok(Reply(&answer).word(0))
    }

    /// Counts a second over the last 300th of a second: what command 18 answers is filtered, and 30 ms late. The manual gives the direction in a byte of its own and does not say whether the number is signed too.
    fn speed(&mut self, address: u8, command: Command) -> Result<i32, Lost> {
        let answer = self.line.ask::<5>(Packet::to(address, command).question())?;
        let speed = Reply(&answer).signed(0);
        Ok(if answer[4] == BACKWARD { -speed.saturating_abs() } else { speed })
    }

    fn status(&mut self, address: u8) -> Result<Status, Lost> {
        let question = Packet::to(address, Command::ReadStatus).question();
        let bits = match self.firmware.status_bytes() {
            2 => u32::from(Reply(&self.line.ask::<2>(question)?).word(0)),
            _ => Reply(&self.line.ask::<4>(question)?).long(0),
        };
        Ok(self.firmware.status(bits))
    }
}

impl Status {
    /// Take in what the board of this axis says: its M1 is the axis.
    fn take_in(&mut self, board: Self, axis: usize) {
        self.emergency_stop |= board.emergency_stop;
        self.driver_fault |= board.driver_fault;
        self.too_hot |= board.too_hot;
        self.bad_supply |= board.bad_supply;
        self.current_limited[axis] = board.current_limited[0];
        self.at_switch[axis] = board.at_switch[0];
    }
}

fn kept<T: PartialEq + std::fmt::Debug>(
    address: u8,
    what: &'static str,
    told: T,
    says: T,
) -> Result<(), Refused> {
    if told == says {
        return Ok(());
    }
    Err(Refused::NotKept { address, what, told: format!("{told:?}"), says: format!("{says:?}") })
}

fn amperes(reply: &[u8], at: usize) -> f64 {
    f64::from((Reply(reply).word(at) as i16).unsigned_abs()) * CURRENT_STEP_AMPS
}

/// Counting begins so far from 0 that no column gets there: a board that restarts counts from 0, which is then a jump whatever else it
/// has kept.
const COUNTS_AT_FIRST: i32 = 0x2000_0000;
/// What command 94 wants to be sent with (the maker's own library; the manual leaves it out).
const SAVE_KEY: u32 = 0xE22E_AB7A;
/// Gains are numbers with 16 bits behind the point.
const FIXED_POINT: f64 = 65_536.0;
const CURRENT_STEP_AMPS: f64 = 0.01;
/// The status byte beside a speed or a count.
const BACKWARD: u8 = 1;
/// Buffer: replace what is running.
const AT_ONCE: u8 = 1;
/// Buffer: begin when what is before it is through.
const AFTERWARDS: u8 = 0;
