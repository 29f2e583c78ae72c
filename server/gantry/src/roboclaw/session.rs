//! Boards from being found until they are lost: one cycle after the other, each a command and a look.

use covr_engine::frames::Floor;
use covr_engine::machine::MachineReport;
use covr_engine::time::{Span, Time};

use super::board::{Configured, Connected, Refused};
use super::driver::{Driver, Order, Tell};
use super::exchange::{Lost, Tally};
use super::firmware::Firmware;
use super::port::Port;
use super::settings::Settings;

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

    /// Tell the boards what the order means, then look. Whether they acknowledged it.
    pub fn cycle(&mut self, order: &Order, clock: &impl Fn() -> Time) -> Result<bool, Refused> {
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

    pub fn report(&self) -> MachineReport {
        self.driver.report()
    }

    pub fn board(&mut self) -> &mut Configured<P> {
        &mut self.board
    }

    pub fn firmware(&self) -> (&str, Firmware) {
        self.board.firmware()
    }

    pub fn tally(&self) -> Tally {
        self.board.tally()
    }

    /// Its place is lost and it is let go: it is to be found and configured anew.
    pub fn is_over(&self) -> bool {
        self.driver.is_over()
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
