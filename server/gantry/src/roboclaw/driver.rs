//! Between what is decided in metres and what a board knows: counts and counts a second.

use covr_engine::frames::Floor;
use covr_engine::machine::MachineReport;
use covr_engine::time::{Span, Time};

use super::board::{Look, Motion};
use super::settings::Settings;
use crate::linked::axes::{self, Axes};

pub use crate::linked::axes::Order;

/// What the boards are to be told.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tell {
    /// No torque.
    Release,
    /// To rest, and no speed.
    Brake([u32; 2]),
    /// This motion.
    Go(Motion),
}

/// One machine between connecting and losing it.
#[derive(Debug, Clone)]
pub struct Driver {
    axes: Axes,
    metres_per_count: [f64; 2],
    braking_mps2: [f64; 2],
    last_counts: [Option<i32>; 2],
}

impl Driver {
    /// A machine that stands there, not homed.
    pub fn new(settings: &Settings, stood_at: Floor) -> Self {
        let metres_per_count = |i: usize| {
            (if settings.axes[i].reversed { -1.0 } else { 1.0 }) / settings.axes[i].counts_per_metre
        };
        Self {
            axes: Axes::new(settings.axes(), stood_at),
            metres_per_count: [0, 1].map(metres_per_count),
            braking_mps2: [settings.limits.x.braking_mps2, settings.limits.y.braking_mps2],
            last_counts: [None; 2],
        }
    }

    /// Take in what the boards say.
    pub fn see(&mut self, look: &Look, at: Time) {
        let step = |i: usize| {
            let now = look.counts[i];
            f64::from(now.wrapping_sub(self.last_counts[i].unwrap_or(now))) * self.metres_per_count[i]
        };
        let steps_m = [0, 1].map(step);
        self.last_counts = look.counts.map(Some);
        let look = axes::Look {
            steps_m,
            speeds_mps: [0, 1].map(|i| f64::from(look.speeds[i]) * self.metres_per_count[i]),
            amps: look.amps,
            status: look.status,
        };
        self.axes.see(&look, at);
    }

    /// The place is lost, and nothing holds the column any more.
    pub fn is_over(&self) -> bool {
        self.axes.is_over()
    }

    /// What to tell the boards at `now`, with the next look a `period` later.
    pub fn next(&mut self, now: Time, order: &Order, period: Span) -> Tell {
        let speeds = match self.axes.next(now, order, period) {
            axes::Tell::Release => return Tell::Release,
            axes::Tell::Go(speeds) => speeds,
        };
        let counts = |i: usize, metres: f64| metres / self.metres_per_count[i];
        let size = |i: usize, metres: f64| counts(i, metres).abs().round() as u32;
        let motion = Motion {
            speed: [0, 1].map(|i| counts(i, speeds[i].speed_mps).round() as i32),
            acceleration: [0, 1].map(|i| size(i, speeds[i].acceleration_mps2)),
            distance: [0, 1].map(|i| size(i, speeds[i].distance_m)),
            braking: [0, 1].map(|i| size(i, self.braking_mps2[i])),
        };
        if motion.speed == [0; 2] { Tell::Brake(motion.acceleration) } else { Tell::Go(motion) }
    }

    /// What the machine says of itself.
    pub fn report(&self) -> MachineReport {
        self.axes.report()
    }

    /// Whether the lower current limit of homing is wanted.
    pub fn pushes_gently(&self) -> bool {
        self.axes.pushes_gently()
    }
}

#[cfg(test)]
mod tests;
