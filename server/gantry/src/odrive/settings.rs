//! What an ODrive machine is made of.

use std::path::PathBuf;

use covr_engine::frames::Floor;
use covr_engine::machine::{AxisLimits, Limits, Travel};
use covr_engine::time::Span;

use crate::homing::{HomeBy, HomingParameters};
use crate::linked::axes::AxesSettings;

/// A whole machine: one board, the long rail on its axis0, the cross rail on its axis1.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// The board's serial port on USB: a path by its serial number, so that it is the same after unplugging.
    pub port: PathBuf,
    /// The long rail and the cross rail.
    pub axes: [AxisSettings; 2],
    /// What each axis may do.
    pub limits: Limits,
    /// Where the column's centre can stand, room frame.
    pub travel: Travel,
    /// Where the column is parked when the power comes on, room frame.
    pub parked: Floor,
    /// Above this the board limits a motor's current, A. Whoever is limited counts as over it (R5).
    pub current_limit_amps: f64,
    /// The same while it homes, A: against a hard stop it pushes with no more.
    pub homing_current_amps: f64,
    /// With no command for this long the board lets both motors go.
    pub watchdog_timeout: Span,
    /// Longest time from one look at the board to the next.
    pub period: Span,
    /// How homing moves: onto the hard stops.
    pub homing: HomingParameters,
    /// Gain of the position loop, 1/s.
    pub position_gain_per_s: f64,
}

/// One axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisSettings {
    /// Turns of the board's encoder a metre of travel.
    pub turns_per_metre: f64,
    /// Turns fall where the room's coordinate rises.
    pub reversed: bool,
}

/// Settings with which a column could coast.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "watchdog timeout: found {found_secs:.2} s, expected at least {least_secs:.2} s: the board lets its motors go when it is over, and must \
     have brought the column to rest before, which takes {brake_secs:.2} s from the greatest speed"
)]
pub struct ShortWatchdog {
    /// What was asked for, s.
    pub found_secs: f64,
    /// The least that is safe, s.
    pub least_secs: f64,
    /// From the greatest speed to rest, s.
    pub brake_secs: f64,
}

impl Settings {
    /// What no machine may be driven with.
    pub fn check(&self) -> Result<(), ShortWatchdog> {
        let brake = |axis: &AxisLimits| axis.speed_mps / axis.braking_mps2;
        let brake_secs = brake(&self.limits.x).max(brake(&self.limits.y));
        let least_secs = brake_secs + BEFORE_AND_AFTER_SECS;
        let found_secs = self.watchdog_timeout.secs();
        // So written that what is no number is refused.
        let is_long_enough = found_secs >= least_secs;
        if is_long_enough { Ok(()) } else { Err(ShortWatchdog { found_secs, least_secs, brake_secs }) }
    }

    /// What the decisions about both axes need of it.
    pub(super) const fn axes(&self) -> AxesSettings {
        AxesSettings {
            limits: self.limits,
            travel: self.travel,
            current_limit_amps: self.current_limit_amps,
            homing: self.homing,
            // The board cannot be asked for a switch that does not also cut its motor.
            home_by: HomeBy::Stops,
            position_gain_per_s: self.position_gain_per_s,
        }
    }
}

/// How long a command is good before the brake begins, and what the brake may take longer than the limits say, s.
const BEFORE_AND_AFTER_SECS: f64 = 0.2;

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::sim::parameters::MachineParameters;

    /// The paper's motors on a board, over this travel.
    pub fn paper(travel: Travel) -> Settings {
        let machine = MachineParameters::paper(travel);
        let axis = |turns_per_metre: f64| AxisSettings { turns_per_metre, reversed: false };
        Settings {
            port: "virtual".into(),
            axes: [
                axis(machine.x.gear_ratio / machine.x.pulley_circumference_m),
                axis(machine.y.gear_ratio / machine.y.pulley_circumference_m),
            ],
            limits: Limits::PAPER,
            travel,
            parked: Floor::new(1.0, 1.0),
            current_limit_amps: 7.0,
            homing_current_amps: 3.0,
            watchdog_timeout: Span::from_millis(800),
            period: Span::from_millis(10),
            homing: HomingParameters { switch_outside_m: machine.stop_outside_m, ..machine.homing },
            position_gain_per_s: 8.0,
        }
    }

    #[test]
    fn a_watchdog_that_ends_before_the_brake_does_is_refused() {
        let travel = Travel { min: Floor::new(0.0, 0.0), max: Floor::new(4.0, 4.0) };
        let mut settings = paper(travel);
        assert_eq!(settings.check(), Ok(()));
        settings.watchdog_timeout = Span::from_millis(600);
        let refused = settings.check().unwrap_err();
        assert_eq!((refused.brake_secs * 100.0).round(), 44.0);
        assert!(refused.to_string().contains("found 0.60 s, expected at least 0.64 s"), "{refused}");
    }
}
