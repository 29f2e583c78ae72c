//! A board, one type for each step on the way to motion: [`Connected`], [`Identified`], [`Configured`].
//!
//! Only a configured board has a verb that moves. What was set is read back, and a board that keeps another value is refused.

use covr_engine::machine::Trouble;

use super::firmware::{
    CLOSED_LOOP, Firmware, IDLE, POSITION_CONTROL, SUPPLY_ERRORS, TRAPEZOIDAL_TRAJECTORY, Version,
    axis_errors,
};
use super::goal::{AxisState, Goal, Pace};
use super::line::{Batch, Line, Lost};
use super::settings::Settings;
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
    #[error("the board has firmware {found}; known are 0.5.4, 0.5.5 and 0.5.6")]
    UnknownFirmware { found: Version },
    /// It does not keep what it was told.
    #[error("the board does not keep {property}: told {told}, it says {says}")]
    NotKept { property: String, told: String, says: String },
    /// Its motor and encoder are not calibrated: the maker's program does that, and the motor turns meanwhile.
    #[error(
        "{property} is {says}, expected 1: calibrate motor and encoder with the maker's program, and save"
    )]
    NotCalibrated { property: String, says: String },
    /// It would move by itself when its power comes on.
    #[error("{property} is {says}, expected 0, saved: the board moves by itself when its power comes on")]
    MovesByItself { property: String, says: String },
    /// Its supply is outside what it stands.
    #[error("the board's supply is outside its limits (error {errors:#x})")]
    BadSupply { errors: u32 },
    /// An error that does not go away.
    #[error("axis{axis} says {errors} though its errors were cleared")]
    Faulty { axis: usize, errors: String },
}

impl Refusal for Refused {
    fn trouble(&self) -> Trouble {
        match self {
            Self::Lost(_) => Trouble::NoAnswer,
            Self::UnknownFirmware { .. } => Trouble::UnknownFirmware,
            Self::NotKept { .. } | Self::NotCalibrated { .. } | Self::MovesByItself { .. } => {
                Trouble::NotConfigured
            }
            Self::BadSupply { .. } => Trouble::BadSupply,
            Self::Faulty { .. } => Trouble::DriverFault,
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
}

/// The firmware is known.
pub struct Identified<P> {
    line: Line<P>,
    firmware: Firmware,
    text: String,
}

/// Everything is set and read back: it can be driven.
pub struct Configured<P> {
    line: Line<P>,
    firmware: Firmware,
    text: String,
    /// Turns a metre, signed.
    turns_per_metre: [f64; 2],
    watchdog_secs: f64,
    /// Above this a bridge switches off, degrees Celsius.
    hot_c: [f64; 2],
    /// The trajectories' paces as last told.
    told: [Option<Pace>; 2],
}

/// What the board is to do until the next exchange.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Do {
    /// Both motors without torque.
    Release,
    /// Torque on these, at the place where each stands.
    SwitchOn([bool; 2]),
    /// To these places.
    Go([Goal; 2]),
}

/// One look at the board.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Look {
    /// Both axes.
    pub axes: [AxisState; 2],
    /// m/s.
    pub speeds_mps: [f64; 2],
    /// Size of the torque-making current, A.
    pub amps: [f64; 2],
    /// Whether each motor has torque.
    pub is_on: [bool; 2],
    /// The axes' error bits.
    pub errors: [u32; 2],
    /// The board's own.
    pub board_errors: u32,
    /// Since its power came on, ms.
    pub uptime_millis: u64,
    /// It has what it was told with this look.
    pub has_taken: bool,
}

impl Look {
    /// Its supply has switched it off.
    pub const fn has_bad_supply(&self) -> bool {
        self.board_errors & SUPPLY_ERRORS != 0
    }
}

impl<P: Port> Connected<P> {
    pub fn new(port: P) -> Self {
        Self { line: Line::new(port) }
    }

    /// Ask which firmware it is.
    pub fn identify(mut self) -> Result<Identified<P>, Refused> {
        let mut batch = Batch::default();
        for property in [
            "fw_version_major",
            "fw_version_minor",
            "fw_version_revision",
            "hw_version_major",
            "hw_version_minor",
            "hw_version_variant",
        ] {
            batch.ask(format_args!("r {property}"));
        }
        let answers = self.line.exchange_again(&batch)?;
        let mut numbers = answers.iter().map(|answer| whole(answer));
        let mut next = || numbers.next().unwrap_or_else(|| Err(Lost::Garbled(String::new())));
        let version = Version([next()?, next()?, next()?]);
        let [major, minor, variant] = [next()?, next()?, next()?];
        let text = format!("ODrive v{major}.{minor}-{variant}V {version}");
        let firmware = Firmware::of(version).ok_or(Refused::UnknownFirmware { found: version })?;
        Ok(Identified { line: self.line, firmware, text })
    }
}

impl<P: Port> Identified<P> {
    /// Release both motors and set everything, reading each back.
    pub fn configure(mut self, settings: &Settings) -> Result<Configured<P>, Refused> {
        let limits = [settings.limits.x, settings.limits.y];
        let turns_per_metre =
            settings.axes.map(|axis| axis.turns_per_metre * if axis.reversed { -1.0 } else { 1.0 });
        let watchdog_secs = settings.watchdog_timeout.secs();
        let mut hot_c = [f64::INFINITY; 2];
        for (i, limits) in limits.iter().enumerate() {
            let axis = |rest: &str| format!("axis{i}.{rest}");
            let turns = turns_per_metre[i].abs();
            self.set(&axis("requested_state"), IDLE.into(), false)?;
            for property in ["motor.is_calibrated", "encoder.is_ready"] {
                let says = self.says(&axis(property))?;
                if says != "1" {
                    return Err(Refused::NotCalibrated { property: axis(property), says });
                }
            }
            for property in ["startup_closed_loop_control", "startup_homing", "startup_motor_calibration"] {
                let property = axis(&format!("config.{property}"));
                let says = self.says(&property)?;
                if says != "0" {
                    return Err(Refused::MovesByItself { property, says });
                }
            }
            for (property, value) in [
                ("controller.config.control_mode", f64::from(POSITION_CONTROL)),
                ("controller.config.input_mode", f64::from(TRAPEZOIDAL_TRAJECTORY)),
                ("controller.config.circular_setpoints", 0.0),
                ("controller.config.enable_vel_limit", 1.0),
                ("controller.config.enable_overspeed_error", 1.0),
                ("controller.config.vel_limit_tolerance", OVERSPEED),
                ("controller.config.vel_limit", OVER_TOP * limits.speed_mps * turns),
                ("controller.input_vel", 0.0),
                ("controller.input_torque", 0.0),
                ("config.enable_step_dir", 0.0),
                ("trap_traj.config.accel_limit", limits.braking_mps2 * turns),
                ("trap_traj.config.decel_limit", limits.braking_mps2 * turns),
                ("trap_traj.config.vel_limit", settings.homing.creep_mps * turns),
                ("motor.config.current_lim", settings.current_limit_amps),
                ("config.watchdog_timeout", watchdog_secs),
                ("config.enable_watchdog", 1.0),
            ] {
                self.set(&axis(property), value, true)?;
            }
            hot_c[i] = number(&self.says(&axis("motor.fet_thermistor.config.temp_limit_upper"))?)?;
        }
        self.clear_errors()?;
        let Self { line, firmware, text } = self;
        Ok(Configured { line, firmware, text, turns_per_metre, watchdog_secs, hot_c, told: [None; 2] })
    }

    fn clear_errors(&mut self) -> Result<(), Refused> {
        let mut batch = Batch::default();
        for axis in 0..2 {
            batch.tell(format_args!("u {axis}"));
        }
        batch.tell(format_args!("sc"));
        self.line.exchange_again(&batch)?;
        // In an exchange of its own: what is still wrong is an error again a moment later.
        let mut batch = Batch::default();
        for axis in 0..2 {
            batch.ask(format_args!("r axis{axis}.error"));
        }
        batch.ask(format_args!("r error"));
        let answers = self.line.exchange_again(&batch)?;
        let bits = answers.iter().map(|answer| whole(answer)).collect::<Result<Vec<_>, _>>()?;
        if let Some(errors) = bits.last().copied().filter(|errors| errors & SUPPLY_ERRORS != 0) {
            return Err(Refused::BadSupply { errors });
        }
        match bits.iter().take(2).position(|bits| *bits != 0) {
            Some(axis) => Err(Refused::Faulty { axis, errors: axis_errors(bits[axis]) }),
            None => Ok(()),
        }
    }

    fn says(&mut self, property: &str) -> Result<String, Refused> {
        let mut batch = Batch::default();
        batch.ask(format_args!("r {property}"));
        Ok(self.line.exchange_again(&batch)?.pop().unwrap_or_default())
    }

    /// Set a property and read it back; the state that an axis is asked for reads as nothing.
    fn set(&mut self, property: &str, value: f64, is_kept: bool) -> Result<(), Refused> {
        set(&mut self.line, property, value, is_kept)
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

    /// Above this the bridge of each axis switches itself off, degrees Celsius.
    pub fn hot_c(&self) -> [f64; 2] {
        self.hot_c
    }

    /// Tell it what to do, and look, in one exchange; nothing to tell: look alone.
    pub fn exchange(&mut self, tell: Option<&Do>) -> Result<Look, Lost> {
        let mut batch = Batch::default();
        let goals = self.put(tell, &mut batch);
        for i in 0..2 {
            batch.ask(format_args!("f {i}"));
            for property in AXIS_LOOK {
                batch.ask(format_args!("r axis{i}.{property}"));
            }
        }
        batch.ask(format_args!("r error"));
        batch.ask(format_args!("r system_stats.uptime"));
        let outcome = self.line.exchange(&batch);
        if outcome.is_err() {
            // Who knows what of it arrived.
            self.told = [None; 2];
        }
        self.understood(&outcome?, tell, goals)
    }

    /// Limit the current of both motors, A, and read it back.
    pub fn limit_current(&mut self, amps: f64) -> Result<(), Refused> {
        for i in 0..2 {
            set(&mut self.line, &format!("axis{i}.motor.config.current_lim"), amps, true)?;
        }
        Ok(())
    }

    /// Supply, V, and the temperatures of both bridges, degrees Celsius; in one try.
    pub fn supply_and_temperatures(&mut self) -> Result<(f64, [f64; 2]), Lost> {
        let mut batch = Batch::default();
        batch.ask(format_args!("r vbus_voltage"));
        for i in 0..2 {
            batch.ask(format_args!("r axis{i}.motor.fet_thermistor.temperature"));
        }
        match &self.line.exchange(&batch)?[..] {
            [volts, first, second] => Ok((number(volts)?, [number(first)?, number(second)?])),
            others => Err(Lost::Garbled(others.join(" "))),
        }
    }

    /// Whether both axes still have the watchdog that they were given; in one try.
    pub fn keeps_its_watchdog(&mut self) -> Result<bool, Lost> {
        let mut batch = Batch::default();
        for i in 0..2 {
            batch.ask(format_args!("r axis{i}.config.enable_watchdog"));
            batch.ask(format_args!("r axis{i}.config.watchdog_timeout"));
        }
        let answers = self.line.exchange(&batch)?;
        let is_kept = |of: &[String]| match of {
            [enabled, timeout] => Ok(enabled == "1" && is_near(number(timeout)?, self.watchdog_secs)),
            others => Err(Lost::Garbled(others.join(" "))),
        };
        Ok(is_kept(&answers[..2])? && is_kept(&answers[2..])?)
    }

    /// What to tell as lines; the goals in turns.
    fn put(&mut self, tell: Option<&Do>, batch: &mut Batch) -> [Option<f64>; 2] {
        let mut goals = [None; 2];
        for i in 0..2 {
            match tell {
                None => {}
                Some(Do::Release) => {
                    batch.tell(format_args!("w axis{i}.requested_state {IDLE}"));
                    batch.tell(format_args!("u {i}"));
                }
                Some(Do::SwitchOn(which)) => {
                    batch.tell(format_args!("u {i}"));
                    // An axis that has torque would lose it for a moment.
                    if which[i] {
                        batch.tell(format_args!("w axis{i}.requested_state {CLOSED_LOOP}"));
                    }
                }
                Some(Do::Go(both)) => {
                    let goal = both[i];
                    if let Some(pace) = goal.pace {
                        self.put_pace(i, pace, batch);
                    }
                    let turns = goal.at_m * self.turns_per_metre[i];
                    batch.tell(format_args!("t {i} {turns:.6}"));
                    goals[i] = Some(turns);
                }
            }
        }
        goals
    }

    /// What of a pace is another than was last told: a trajectory takes it up with its goal.
    fn put_pace(&mut self, i: usize, pace: Pace, batch: &mut Batch) {
        let turns_per_metre = self.turns_per_metre[i].abs();
        let told = self.told[i].replace(pace);
        if told.is_none_or(|told| told.speed_mps != pace.speed_mps) {
            let turns = pace.speed_mps * turns_per_metre;
            batch.tell(format_args!("w axis{i}.trap_traj.config.vel_limit {turns:.6}"));
        }
        if told.is_none_or(|told| told.ramp_mps2 != pace.ramp_mps2) {
            let turns = pace.ramp_mps2 * turns_per_metre;
            batch.tell(format_args!("w axis{i}.trap_traj.config.accel_limit {turns:.6}"));
        }
    }

    fn understood(
        &self,
        answers: &[String],
        tell: Option<&Do>,
        goals: [Option<f64>; 2],
    ) -> Result<Look, Lost> {
        let mut look = Look::default();
        let mut answers = answers.iter();
        let mut next = || answers.next().ok_or_else(|| Lost::Garbled(String::new()));
        let mut has_goal = [true; 2];
        for i in 0..2 {
            let feedback = next()?;
            let metres = |turns: f64| turns / self.turns_per_metre[i];
            let (place, speed) = feedback.split_once(' ').ok_or_else(|| Lost::Garbled(feedback.clone()))?;
            look.axes[i].here_m = metres(number(place)?);
            look.speeds_mps[i] = metres(number(speed)?);
            look.axes[i].setpoint_m = metres(number(next()?)?);
            look.axes[i].setpoint_mps = metres(number(next()?)?);
            let goal = number(next()?)?;
            has_goal[i] =
                goals[i].is_none_or(|told| (told - goal).abs() < SAME_GOAL + SAME_GOAL * 1e-2 * told.abs());
            look.amps[i] = number(next()?)?.abs();
            look.is_on[i] = whole(next()?)? == CLOSED_LOOP;
            look.errors[i] = whole(next()?)?;
        }
        look.board_errors = whole(next()?)?;
        look.uptime_millis = u64::from(whole(next()?)?);
        look.has_taken = match tell {
            None | Some(Do::SwitchOn(_)) => false,
            Some(Do::Release) => look.is_on == [false; 2],
            Some(Do::Go(_)) => look.is_on == [true; 2] && has_goal == [true; 2],
        };
        Ok(look)
    }
}

/// Set a property, and read it back if it keeps what it is told. May be sent twice: it sets what it sets.
fn set<P: Port>(line: &mut Line<P>, property: &str, value: f64, is_kept: bool) -> Result<(), Refused> {
    let mut batch = Batch::default();
    // Whole numbers without decimals: the board reads a switch or a mode as one.
    let told = if value.fract() == 0.0 { format!("{value:.0}") } else { format!("{value:.6}") };
    batch.tell(format_args!("w {property} {told}"));
    batch.ask(format_args!("r {property}"));
    let says = line.exchange_again(&batch)?.pop().unwrap_or_default();
    // The board's answer is cut after nine figures.
    if is_kept && !says.parse().is_ok_and(|says| is_near(says, value)) {
        return Err(Refused::NotKept { property: property.to_owned(), told, says });
    }
    Ok(())
}

fn is_near(says: f64, told: f64) -> bool {
    (says - told).abs() <= 1e-5 + 1e-5 * told.abs()
}

fn number(answer: &str) -> Result<f64, Lost> {
    let number = answer.trim().parse().ok().filter(|number: &f64| number.is_finite());
    number.ok_or_else(|| Lost::Garbled(answer.to_owned()))
}

fn whole(answer: &str) -> Result<u32, Lost> {
    answer.trim().parse().map_err(|_| Lost::Garbled(answer.to_owned()))
}

/// What is asked of each axis after its place and speed, in the order in which it is understood.
const AXIS_LOOK: [&str; 6] = [
    "controller.pos_setpoint",
    "controller.vel_setpoint",
    "controller.input_pos",
    "motor.current_control.Iq_measured",
    "current_state",
    "error",
];
/// The board's own speed limit lies so far over the axis's, so that a correction at top speed is none.
const OVER_TOP: f64 = 1.25;
/// At so many times that limit the board lets its motor go (the maker's default).
const OVERSPEED: f64 = 1.2;
/// The board keeps a goal as a number of 24 bits and tells nine characters of it; turns, and a hundredth of it for each turn of the goal.
const SAME_GOAL: f64 = 2e-4;
