//! Boards from being found until they are lost: one cycle after the other, each a command and a look.

use covr_engine::frames::Floor;
use covr_engine::machine::MachineReport;
use covr_engine::time::{Span, Time};

use super::board::{Configured, Connected, Refused};
use super::driver::{Driver, Order, Tell};
use super::exchange::Lost;
use super::settings::Settings;
use crate::linked::figures::{Figures, Tally};
use crate::linked::link;
use crate::linked::port::Port;

/// Boards that can be driven, and what is known of them.
pub struct Session<P> {
    board: Configured<P>,
    driver: Driver,
    /// The current limits of homing and of everything else, A; which of them is set.
    limits_amps: [f64; 2],
    pushes_gently: bool,
    period: Span,
}

impl<P: Port> Session<P> {
    /// Identify and configure what is on this port; the column stands there, as far as known.
    pub fn open(port: P, settings: &Settings, stood_at: Floor) -> Result<Self, Refused> {
        Ok(Self {
            board: Connected::new(port, settings).identify()?.configure(settings)?,
            driver: Driver::new(settings, stood_at),
            limits_amps: [settings.homing_current_amps, settings.current_limit_amps],
            pushes_gently: false,
            period: settings.period,
        })
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
        let mut is_acknowledged = false;
        // Nothing is told to boards that were never looked at.
        if self.driver.report().answered_at != Time::ZERO {
            let tell = self.driver.next(clock(), order, self.period);
            let gently = self.driver.pushes_gently();
            // A lower limit comes before the motion that it is for, a higher one after whatever ended that: nothing delays a brake.
            if gently {
                self.limit_current(gently)?;
            }
            let told = match tell {
                Tell::Release => self.board.release(),
                Tell::Brake(braking) => self.board.brake(braking),
                Tell::Go(motion) => self.board.go(&motion),
            };
            match told {
                Err(gone @ Lost::Port(_)) => return Err(gone.into()),
                // The look comes all the same: a lost command is followed by the next.
                Err(_) => {}
                Ok(()) => is_acknowledged = true,
            }
            self.limit_current(gently)?;
        }
        let asked_at = clock();
        let look = self.board.look()?;
        let middle = (asked_at.micros() + clock().micros()) / 2;
        self.driver.see(&look, Time::from_micros(middle));
        Ok(is_acknowledged)
    }

    fn slow_look(&mut self, turn: u64, figures: &mut Figures) -> bool {
        match turn % 3 {
            0 => figures.volts(self.board.main_volts().ok()),
            1 => figures.temperature(self.board.temperature_c().ok()),
            // A lost answer is nothing to act on: the fast looks watch the link.
            _ => return !matches!(self.board.keeps_its_timeout(), Ok(false)),
        }
        true
    }

    fn report(&self) -> MachineReport {
        self.driver.report()
    }

    fn is_over(&self) -> bool {
        self.driver.is_over()
    }

    fn firmware(&self) -> (&str, &str) {
        let (text, firmware) = self.board.firmware();
        (text, firmware.name())
    }

    fn tally(&self) -> Tally {
        self.board.tally()
    }
}
