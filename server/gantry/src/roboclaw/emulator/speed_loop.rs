//! The velocity loop of a channel: from counts to the duty that keeps a speed, every millisecond.
//!
//! The manual says what `QPPS` is: the speed at 100 % duty. *Unverified*, for no manual says it:
//!
//! - Duty is the ramped speed over QPPS, plus P times the speed error, I times its sum over 300ths of a second and D
//!   times its change in one, over QPPS.
//! - At rest with speed 0 asked, the integral fades (else it would lean on friction for ever).

use super::channel::TICK_SECS;
use super::settings::{SAMPLES_A_SECOND, VelocityPid};

/// From counts to the duty that keeps a speed.
#[derive(Debug, Clone, Default)]
pub(super) struct SpeedLoop {
    pub(super) counts: i64,
    pub(super) measured_cps: f64,
    /// Counts and asked speeds of the last ticks, which the measured speed is a mean over.
    window: [(i64, f64); WINDOW_TICKS],
    slot: usize,
    sum: f64,
    pub(super) last_error: f64,
}

impl SpeedLoop {
    /// Note the counts of this tick; the measured speed.
    pub(super) fn measure(&mut self, counts: i64) -> f64 {
        self.slot = (self.slot + 1) % WINDOW_TICKS;
        let before = self.window[self.slot].0;
        self.window[self.slot] = (counts, self.measured_cps);
        self.measured_cps = (counts - before) as f64 / (WINDOW_TICKS as f64 * TICK_SECS);
        self.counts = counts;
        self.measured_cps
    }

    pub(super) fn forget(&mut self) {
        self.sum = 0.0;
        self.last_error = 0.0;
        let measured = self.measured_cps;
        self.window.iter_mut().for_each(|(_, asked)| *asked = measured);
    }

    pub(super) fn duty(&mut self, asked_cps: f64, pid: &VelocityPid) -> f64 {
        if pid.qpps == 0 {
            return 0.0;
        }
        self.window[self.slot].1 = asked_cps;
        let mean_asked = self.window.iter().map(|(_, asked)| asked).sum::<f64>() / WINDOW_TICKS as f64;
        let error = mean_asked - self.measured_cps;
        let samples_a_tick = f64::from(SAMPLES_A_SECOND) * TICK_SECS;
        let change = (error - self.last_error) / samples_a_tick;
        self.last_error = error;
        if asked_cps == 0.0 && self.measured_cps == 0.0 {
            self.sum *= 1.0 - TICK_SECS / REST_FADE_SECS;
        }
        let [p, i, d] = [pid.p, pid.i, pid.d].map(|gain| f64::from(gain) / VELOCITY_GAIN_UNIT);
        let sum = self.sum + error * samples_a_tick;
        let wanted = (asked_cps + p * error + i * sum + d * change) / f64::from(pid.qpps);
        let duty = wanted.clamp(-1.0, 1.0);
        // No winding up against the supply.
        if wanted == duty || error * wanted < 0.0 {
            self.sum = sum;
        }
        duty
    }
}

/// Speed is measured over this many ticks.
const WINDOW_TICKS: usize = 8;
/// Time in which the integral fades at rest.
const REST_FADE_SECS: f64 = 0.2;
const VELOCITY_GAIN_UNIT: f64 = 65_536.0;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_integral_meets_a_load_and_does_not_wind_up_against_the_supply() {
        let mut speed_loop = SpeedLoop::default();
        let pid = VelocityPid { p: 0x1_0000, i: 0x1_0000, d: 0, qpps: 10_000 };
        let mut duty = 0.0;
        // It stands still whatever is on it.
        for _ in 0..2_000 {
            speed_loop.measure(0);
            duty = speed_loop.duty(5_000.0, &pid);
        }
        assert_eq!(duty, 1.0);
        assert!(speed_loop.sum <= 10_000.0, "{}", speed_loop.sum);
    }

    #[test]
    fn a_speed_that_is_kept_takes_the_share_of_the_supply_that_qpps_says() {
        let mut speed_loop = SpeedLoop::default();
        let pid = VelocityPid { p: 0x1_0000, i: 0x1_0000, d: 0x1_0000, qpps: 10_000 };
        for tick in 0..20 {
            speed_loop.measure(5 * tick);
            speed_loop.duty(5_000.0, &pid);
        }
        speed_loop.sum = 0.0;
        speed_loop.measure(100);
        assert_eq!(speed_loop.duty(5_000.0, &pid), 0.5);
    }
}
