//! The command type that a gantry accepts. Nothing outside `safety` can make one.

use crate::frames::{Floor, Planar};
use crate::machine::{Limits, Travel};
use crate::time::{Span, Time};

/// A command that passed the safety rules at `at`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vetted {
    at: Time,
    action: Action,
}

/// What a machine is told to do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Action {
    /// Release the drive: no torque.
    Release,
    /// Drive on; brake each axis at its limit to rest and hold there.
    Hold,
    /// Home onto the switches at creep speed; idempotent while homing runs.
    Home,
    /// Follow this setpoint.
    Track(Setpoint),
}

/// Where the column's centre is to be at the time of the command, and how it moves there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setpoint {
    /// Position, room frame.
    pub position: Floor,
    /// Velocity, m/s.
    pub velocity: Planar,
    /// Acceleration, m/s2.
    pub acceleration: Planar,
    /// The distance cap: with no newer command the controller brakes to rest unaided once this long has passed at `velocity`.
    pub valid_for: Span,
}

/// Somebody confirmed that the arena is clear of people: for commissioning, identification and the machine's own tests.
#[derive(Debug, Clone, Copy)]
pub struct ArenaConfirmedClear(());

/// Why a commissioning setpoint was refused.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum CourseRefused {
    /// The position is outside the travel.
    #[error("position ({:.3}, {:.3}) m is outside the travel limits", .0.x, .0.y)]
    OutsideTravel(Floor),
    /// An axis would exceed its speed.
    #[error("velocity ({:.3}, {:.3}) m/s exceeds the limits", .0.x, .0.y)]
    TooFast(Planar),
}

impl Vetted {
    pub(in crate::safety) const fn new(at: Time, action: Action) -> Self {
        Self { at, action }
    }

    /// Brake to rest and hold: for a shell whose engine has ended. It needs no vetting.
    pub const fn hold(at: Time) -> Self {
        Self { at, action: Action::Hold }
    }

    /// Leave the drive released: for a shell whose engine has ended with the drive released.
    pub const fn release(at: Time) -> Self {
        Self { at, action: Action::Release }
    }

    /// Home at creep speed: the machine's own motion, allowed by the engine while nobody can be met.
    pub(crate) const fn home(at: Time) -> Self {
        Self { at, action: Action::Home }
    }

    /// A command on a course run in an empty arena, checked for travel and speed only.
    pub fn on_clear_course(
        _clear: ArenaConfirmedClear,
        at: Time,
        action: Action,
        limits: &Limits,
        travel: &Travel,
    ) -> Result<Self, CourseRefused> {
        if let Action::Track(setpoint) = action {
            if travel.depth_m(setpoint.position) < 0.0 || !setpoint.position.is_finite() {
                return Err(CourseRefused::OutsideTravel(setpoint.position));
            }
            let within = |v: f64, most: f64| v.abs() <= most * (1.0 + 1e-9);
            if !within(setpoint.velocity.x, limits.x.speed_mps)
                || !within(setpoint.velocity.y, limits.y.speed_mps)
            {
                return Err(CourseRefused::TooFast(setpoint.velocity));
            }
        }
        Ok(Self { at, action })
    }

    /// When it was vetted.
    pub const fn at(&self) -> Time {
        self.at
    }

    /// What it says.
    pub const fn action(&self) -> Action {
        self.action
    }
}

impl ArenaConfirmedClear {
    /// The word of a person who has looked. Never called by the engine.
    pub const fn by_a_person_who_looked() -> Self {
        Self(())
    }
}
