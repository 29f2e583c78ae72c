//! Identification of an axis from a recorded run (steps and chirps of speed): inertia, friction, and how late it answers.
//!
//! In amperes, since torque constant, gear and pulley are known to nobody who did not build the machine:
//! `i = J a + B v + C sign(v)`, J in A/(m/s2), B in A/(m/s), C in A. Nothing is differentiated: the equation is weighed by a smooth
//! bump over 0.16 s and integrated by parts, which moves the derivatives from the measured places onto the bump (modulating
//! functions, Shinbrot 1957). Windows in which the axis stands or turns round are left out: there friction is not C.
//!
//! Boards report currents without a sign. It is the sign of the motion while an axis speeds up; for the others it is that which the
//! fit so far foretells, and those that are too near to zero to tell are left out.

mod delay;
mod fit;

pub use delay::{Delays, delays};
pub use fit::{AxisModel, NotIdentified, identify};

/// One line of a recorded run of one axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// On the host's clock, s.
    pub at_secs: f64,
    /// The speed that was commanded then, m/s.
    pub command_mps: f64,
    /// What the encoder said, m.
    pub position_m: f64,
    /// What the board said of the motor's current, A; with or without a sign.
    pub current_amps: f64,
}

/// Speed at a moment: the slope of the line through the places within `half_secs`.
fn speed_at(samples: &[Sample], at_secs: f64, half_secs: f64) -> Option<f64> {
    let from = samples.partition_point(|sample| sample.at_secs < at_secs - half_secs);
    let to = samples.partition_point(|sample| sample.at_secs <= at_secs + half_secs);
    let near = &samples[from..to];
    if near.len() < 3 {
        return None;
    }
    let count = near.len() as f64;
    let mean_t = near.iter().map(|sample| sample.at_secs).sum::<f64>() / count;
    let mean_x = near.iter().map(|sample| sample.position_m).sum::<f64>() / count;
    let (mut along, mut squares) = (0.0, 0.0);
    for sample in near {
        let t = sample.at_secs - mean_t;
        along += t * (sample.position_m - mean_x);
        squares += t * t;
    }
    Some(along / squares)
}

/// Half the stretch over which a speed is measured, s: short against the motion, and at least three samples.
fn half_secs(samples: &[Sample]) -> f64 {
    let period = (samples[samples.len() - 1].at_secs - samples[0].at_secs) / (samples.len() - 1) as f64;
    SPEED_HALF_SECS.max(1.6 * period)
}

const SPEED_HALF_SECS: f64 = 0.015;
