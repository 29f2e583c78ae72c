//! A board from being found until it is lost: one cycle after the other, each one exchange that tells and looks.

use covr_engine::frames::Floor;
use covr_engine::machine::MachineReport;
use covr_engine::time::{Span, Time};

use super::board::{Configured, Connected, Do, Look, Refused};
use super::firmware::axis_errors;
use super::goal::Aim;
use super::line::Lost;
use super::settings::Settings;
use crate::linked::axes::{self, Axes, Order, Status, Tell};
use crate::linked::figures::{Figures, Tally};
use crate::linked::link;
use crate::linked::port::Port;

/// A board that can be driven, and what is known of it.
pub struct Session<P> {
    board: Configured<P>,
    axes: Axes,
    aims: [Aim; 2],
    last: Option<(Look, Time)>,
    torque: Torque,
    /// Why the board has let a motor go by itself, in its own words.
    failure: Option<String>,
    temperatures_c: [f64; 2],
    /// The current limits of homing and of everything else, A; which of them is set.
    limits_amps: [f64; 2],
    pushes_gently: bool,
    period: Span,
}

/// Whether the motors were told to have torque, and have it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Torque {
    Off,
    /// Told to since then, and not both have it yet.
    Asked(Time),
    On,
}

impl<P: Port> Session<P> {
    /// Identify and configure what is on this port; the column stands there, as far as known.
    pub fn open(port: P, settings: &Settings, stood_at: Floor) -> Result<Self, Refused> {
        let limits = [settings.limits.x, settings.limits.y];
        Ok(Self {
            board: Connected::new(port).identify()?.configure(settings)?,
            axes: Axes::new(settings.axes(), stood_at),
            aims: limits.map(|limits| Aim::new(limits.braking_mps2)),
            last: None,
            torque: Torque::Off,
            failure: None,
            temperatures_c: [0.0; 2],
            limits_amps: [settings.homing_current_amps, settings.current_limit_amps],
            pushes_gently: false,
            period: settings.period,
        })
    }

    /// What to tell the board for what was decided.
    fn put(&mut self, now: Time, tell: Tell, look: &Look, looked_at: Time) -> Do {
        let speeds = match tell {
            Tell::Go(speeds) if self.failure.is_none() || look.is_on.contains(&true) => speeds,
            // What has let go by itself is not switched on again: not before it was told to be off, and was configured anew.
            Tell::Release | Tell::Go(_) => {
                self.torque = Torque::Off;
                self.aims.iter_mut().for_each(Aim::forget);
                return Do::Release;
            }
        };
        if self.torque != Torque::On && self.failure.is_none() {
            if look.is_on != [true; 2] {
                if self.torque == Torque::Off {
                    self.torque = Torque::Asked(now);
                }
                return Do::SwitchOn(look.is_on.map(|is_on| !is_on));
            }
            self.torque = Torque::On;
        }
        let since_secs = (now - looked_at).secs();
        let mut goal = |i: usize| self.aims[i].next(&speeds[i], &look.axes[i], since_secs);
        Do::Go([goal(0), goal(1)])
    }

    fn see(&mut self, look: Look, at: Time) {
        let before = self.last.replace((look, at)).map(|(look, _)| look);
        let lost_torque = self.torque == Torque::On && look.is_on != [true; 2];
        let never_came = matches!(self.torque, Torque::Asked(since) if at - since > LONGEST_SWITCH_ON);
        let has_errors = look.errors != [0; 2] || look.board_errors != 0;
        if self.failure.is_none() && (lost_torque || never_came || has_errors) {
            self.failure = Some(words(&look));
        }
        let has_failed = self.failure.is_some();
        let is_hot = [0, 1].iter().any(|i| self.temperatures_c[*i] >= self.board.hot_c()[*i]);
        let bad_supply = look.has_bad_supply();
        let too_hot = has_failed && !bad_supply && is_hot;
        // The board tells nine figures, so that after eleven days its hours are cut.
        let restarted = before.is_some_and(|before| {
            look.uptime_millis < before.uptime_millis && before.uptime_millis < LONGEST_UPTIME_MILLIS
        });
        // By what it does now: the limit of homing may not be raised yet.
        let limit_amps = self.limits_amps[usize::from(!self.axes.pushes_gently())];
        let steps_m =
            [0, 1].map(|i| before.map_or(0.0, |before| look.axes[i].here_m - before.axes[i].here_m));
        let status = Status {
            driver_fault: has_failed && !bad_supply && !too_hot,
            too_hot,
            bad_supply,
            restarted,
            current_limited: look.amps.map(|amps| amps >= limit_amps - AT_LIMIT_AMPS),
            ..Status::default()
        };
        self.axes.see(&axes::Look { steps_m, speeds_mps: look.speeds_mps, amps: look.amps, status }, at);
    }

    fn limit_current(&mut self, gently: bool) -> Result<(), Refused> {
        if gently != self.pushes_gently {
            let [homing, usual] = self.limits_amps;
            self.board.limit_current(if gently { homing } else { usual })?;
            self.pushes_gently = gently;
        }
        Ok(())
    }
}

impl<P: Port> link::Session for Session<P> {
    type Refused = Refused;

    fn cycle(&mut self, order: &Order, clock: &dyn Fn() -> Time) -> Result<bool, Refused> {
        let mut tell = None;
        // Nothing is told to a board that was never looked at.
        if let Some((look, looked_at)) = self.last {
            let decided = self.axes.next(clock(), order, self.period);
            // A lower limit comes before the motion that it is for, a higher one after whatever ended that: nothing delays a brake.
            if self.axes.pushes_gently() {
                self.limit_current(true)?;
            }
            tell = Some(self.put(clock(), decided, &look, looked_at));
        }
        let asked_at = clock();
        let look = match self.board.exchange(tell.as_ref()) {
            Err(gone @ Lost::Port(_)) => return Err(gone.into()),
            outcome => outcome?,
        };
        let middle = (asked_at.micros() + clock().micros()) / 2;
        self.see(look, Time::from_micros(middle));
        self.limit_current(self.axes.pushes_gently())?;
        Ok(look.has_taken)
    }

    fn slow_look(&mut self, turn: u64, figures: &mut Figures) -> bool {
        if let Some(words) = &self.failure {
            figures.ended(words.clone());
        }
        if !turn.is_multiple_of(2) {
            // A lost answer is nothing to act on: the fast looks watch the link.
            return !matches!(self.board.keeps_its_watchdog(), Ok(false));
        }
        if let Ok((volts, temperatures_c)) = self.board.supply_and_temperatures() {
            self.temperatures_c = temperatures_c;
            figures.volts(Some(volts));
            figures.temperature(Some(temperatures_c[0].max(temperatures_c[1])));
        }
        true
    }

    fn report(&self) -> MachineReport {
        self.axes.report()
    }

    fn is_over(&self) -> bool {
        let is_off =
            self.torque == Torque::Off && self.last.is_some_and(|(look, _)| look.is_on == [false; 2]);
        self.axes.is_over() || (self.failure.is_some() && is_off)
    }

    fn firmware(&self) -> (&str, &str) {
        let (text, firmware) = self.board.firmware();
        (text, firmware.name())
    }

    fn tally(&self) -> Tally {
        self.board.tally()
    }
}

/// What a board says of why it let go.
fn words(look: &Look) -> String {
    let axis = |i: usize| (look.errors[i] != 0).then(|| format!("axis{i}: {}", axis_errors(look.errors[i])));
    let board = (look.board_errors != 0).then(|| format!("the board: {:#x}", look.board_errors));
    let said: Vec<_> = axis(0).into_iter().chain(axis(1)).chain(board).collect();
    if said.is_empty() {
        "a motor has no torque, and the board says no error".into()
    } else {
        said.join("; ")
    }
}

/// From being told to have torque to having it. *Unverified* on a board: some milliseconds.
const LONGEST_SWITCH_ON: Span = Span::from_millis(500);
/// So near to its limit a motor's current is limited, A.
const AT_LIMIT_AMPS: f64 = 0.1;
const LONGEST_UPTIME_MILLIS: u64 = 900_000_000;
