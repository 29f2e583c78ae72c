//! A jerk-limited reference from rest to rest along a line, to drive a machine with.

use covr_engine::machine::AxisLimits;

/// A move along one axis: seven phases at most, evaluated exactly.
pub struct Move {
    sign: f64,
    peak_mps: f64,
    up: Half,
    down: Half,
    cruise_secs: f64,
    way_m: f64,
}

/// From rest to a speed, or back, with S-shaped ends.
#[derive(Clone, Copy)]
struct Half {
    most_mps2: f64,
    jerk_mps3: f64,
    ramp_secs: f64,
    secs: f64,
}

impl Half {
    fn to(speed_mps: f64, most_mps2: f64, jerk_mps3: f64) -> Self {
        let most_mps2 = most_mps2.min((speed_mps * jerk_mps3).sqrt());
        let ramp_secs = most_mps2 / jerk_mps3;
        Self { most_mps2, jerk_mps3, ramp_secs, secs: speed_mps / most_mps2 + ramp_secs }
    }

    fn way_m(&self, speed_mps: f64) -> f64 {
        0.5 * speed_mps * self.secs
    }

    /// Way, speed, acceleration `t` after rest.
    fn at(&self, t: f64) -> (f64, f64, f64) {
        let Self { most_mps2: a, jerk_mps3: j, ramp_secs: r, secs } = *self;
        let t = t.clamp(0.0, secs);
        if t < r {
            (j * t.powi(3) / 6.0, 0.5 * j * t * t, j * t)
        } else if t < secs - r {
            let (s, v, u) = (j * r.powi(3) / 6.0, 0.5 * j * r * r, t - r);
            (s + v * u + 0.5 * a * u * u, v + a * u, a)
        } else {
            let speed = a * (secs - r);
            let u = secs - t;
            (0.5 * speed * secs - speed * u + j * u.powi(3) / 6.0, speed - 0.5 * j * u * u, j * u)
        }
    }
}

impl Move {
    /// A move of `way_m`, either sign, within `limits`.
    pub fn new(way_m: f64, limits: &AxisLimits) -> Self {
        let halves = |peak: f64| {
            let up = Half::to(peak, limits.acceleration_mps2, limits.jerk_mps3);
            let down = Half::to(peak, limits.braking_mps2, limits.jerk_mps3);
            (up, down, up.way_m(peak) + down.way_m(peak))
        };
        let way = way_m.abs();
        let (mut low, mut high) = (1e-6, limits.speed_mps);
        if halves(high).2 > way {
            for _ in 0..100 {
                let middle = 0.5 * (low + high);
                if halves(middle).2 > way { high = middle } else { low = middle }
            }
        } else {
            low = high;
        }
        let (up, down, ends) = halves(low);
        Self {
            sign: way_m.signum(),
            peak_mps: low,
            up,
            down,
            cruise_secs: (way - ends).max(0.0) / low,
            way_m: way,
        }
    }

    pub fn secs(&self) -> f64 {
        self.up.secs + self.cruise_secs + self.down.secs
    }

    /// Way, speed and acceleration at `t`, signed.
    pub fn at(&self, t: f64) -> (f64, f64, f64) {
        let (s, v, a) = if t < self.up.secs {
            self.up.at(t)
        } else if t < self.up.secs + self.cruise_secs {
            (self.up.way_m(self.peak_mps) + self.peak_mps * (t - self.up.secs), self.peak_mps, 0.0)
        } else if t < self.secs() {
            let (left, v, a) = self.down.at(self.secs() - t);
            (self.way_m - left, v, -a)
        } else {
            (self.way_m, 0.0, 0.0)
        };
        (self.sign * s, self.sign * v, self.sign * a)
    }
}
