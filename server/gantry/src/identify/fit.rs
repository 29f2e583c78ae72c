//! Inertia and friction.

use nalgebra::{Matrix3, Vector3};

use super::{Sample, half_secs, speed_at};

/// What an axis is made of, as its current shows it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisModel {
    /// J, A/(m/s2).
    pub inertia: f64,
    /// B, A/(m/s).
    pub viscous: f64,
    /// C, A.
    pub coulomb_amps: f64,
    /// Standard deviations of the three.
    pub sd: [f64; 3],
    /// Root mean square of what the model leaves of the windows' mean currents, A.
    pub rms_amps: f64,
    /// Windows that it was fitted to.
    pub windows: usize,
    /// The greatest speed of the run, m/s: faster, the model was not looked at.
    pub fastest_mps: f64,
}

/// Why a run tells too little.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum NotIdentified {
    /// Too short, or with too few samples a second.
    #[error("{found:.1} s at {rate_hz:.0} samples a second: expected at least 2 s at 50")]
    TooShort {
        /// How long it is, s.
        found: f64,
        /// Samples a second.
        rate_hz: f64,
    },
    /// A line that cannot be: counted from 1.
    #[error("sample {number}: its time does not come after the one before, or a number is not finite")]
    BadSample {
        /// Which.
        number: usize,
    },
    /// Too little motion.
    #[error("{found} windows of motion: expected at least {fewest}; move for longer, and faster than 2 cm/s")]
    TooLittleMotion {
        /// How many there are.
        found: usize,
        /// The fewest that are enough.
        fewest: usize,
    },
    /// The run does not tell the parts from each other.
    #[error("the {part} is known to {percent:.0} % only: vary {vary} more")]
    NotExcited {
        /// Which of the three.
        part: &'static str,
        /// Its standard deviation in percent of the current that it takes.
        percent: f64,
        /// What to vary.
        vary: &'static str,
    },
    /// It comes out as no axis can be.
    #[error(
        "the {part} comes out negative ({found:.3}): is the current that of this axis, and does the column move freely?"
    )]
    Impossible {
        /// Which of the three.
        part: &'static str,
        /// What came out.
        found: f64,
    },
    /// The model does not tell the current.
    #[error(
        "the model is {rms_amps:.2} A off on average, more than {most_amps:.2} A: did something touch the column, or did it reach an end?"
    )]
    PoorFit {
        /// What is left.
        rms_amps: f64,
        /// The most that may be.
        most_amps: f64,
    },
}

impl AxisModel {
    /// The acceleration that is left at a speed under a current limit, m/s2; below zero it cannot keep that speed.
    pub fn acceleration_mps2(&self, current_amps: f64, speed_mps: f64) -> f64 {
        (current_amps - self.coulomb_amps - self.viscous * speed_mps) / self.inertia
    }

    /// The deceleration at a speed under a current limit, friction helping, m/s2.
    pub fn braking_mps2(&self, current_amps: f64, speed_mps: f64) -> f64 {
        (current_amps + self.coulomb_amps + self.viscous * speed_mps) / self.inertia
    }

    /// The speed at which a current limit is all taken by friction, m/s. The supply may end it sooner.
    pub fn speed_limit_mps(&self, current_amps: f64) -> f64 {
        if self.viscous > 0.0 {
            (current_amps - self.coulomb_amps).max(0.0) / self.viscous
        } else {
            f64::INFINITY
        }
    }
}

/// One window: both sides of the equation.
#[derive(Debug, Clone)]
struct Window {
    /// Acceleration, speed, direction.
    row: Vector3<f64>,
    /// Current, with its sign where it has one.
    amps: f64,
    /// The same for each sample, roughly: for the sign alone.
    inside: Vec<Vector3<f64>>,
    /// Least size of the current in it.
    least_amps: f64,
}

/// Fit the model to a run. At most three tenths of the windows' current (root mean square) may be left.
pub fn identify(samples: &[Sample]) -> Result<AxisModel, NotIdentified> {
    check(samples)?;
    let is_signed = samples.iter().any(|sample| sample.current_amps < -SIGN_SHOWS_AMPS);
    let mut windows = windows(samples);
    if windows.len() < FEWEST_WINDOWS {
        return Err(NotIdentified::TooLittleMotion { found: windows.len(), fewest: FEWEST_WINDOWS });
    }
    if is_signed {
        let fitted = least_squares(&windows)?;
        return judge(samples, &windows, fitted);
    }
    // A size that comes near to nothing may have changed its sign.
    windows.retain(|w| w.least_amps > SIGN_IS_PLAIN_AMPS);
    let speeds_up = |w: &&Window| w.inside.iter().all(|row| row.x * row.z >= -STEADY_MPS2);
    let mut signed: Vec<Window> = windows.iter().filter(speeds_up).map(|w| with_sign(w, w.row.z)).collect();
    let mut fitted = least_squares(&signed)?;
    for _ in 0..LONGEST_SETTLING {
        let model = fitted.0;
        let keeps_sign = |w: &&Window| {
            let sign = model.dot(&w.row).signum();
            w.inside.iter().all(|row| model.dot(row) * sign > 0.0)
        };
        let next: Vec<Window> =
            windows.iter().filter(keeps_sign).map(|w| with_sign(w, model.dot(&w.row))).collect();
        let is_same = next.len() == signed.len() && next.iter().zip(&signed).all(|(a, b)| a.amps == b.amps);
        signed = next;
        fitted = least_squares(&signed)?;
        if is_same {
            break;
        }
    }
    judge(samples, &signed, fitted)
}

fn judge(
    samples: &[Sample],
    windows: &[Window],
    (model, inverse): (Vector3<f64>, Matrix3<f64>),
) -> Result<AxisModel, NotIdentified> {
    let squares: f64 = windows.iter().map(|w| (w.amps - model.dot(&w.row)).powi(2)).sum();
    let count = windows.len() as f64;
    let rms_amps = (squares / count).sqrt();
    let drawn_amps = (windows.iter().map(|w| w.amps.powi(2)).sum::<f64>() / count).sqrt();
    let most_amps = MOST_LEFT * drawn_amps;
    if rms_amps > most_amps {
        return Err(NotIdentified::PoorFit { rms_amps, most_amps });
    }
    let noise = squares / (count - 3.0);
    let sd: [f64; 3] = std::array::from_fn(|part| (noise * inverse[(part, part)]).sqrt());
    let parts = [
        ("inertia", "the acceleration"),
        ("viscous friction", "the speed"),
        ("Coulomb friction", "the speed"),
    ];
    for (part, (name, vary)) in parts.into_iter().enumerate() {
        // In percent of all the current: a friction of nothing is known well, though not in percent of itself.
        let size = (windows.iter().map(|w| w.row[part].powi(2)).sum::<f64>() / count).sqrt();
        let percent = 100.0 * sd[part] * size / drawn_amps;
        if percent > MOST_UNCERTAIN_PERCENT {
            return Err(NotIdentified::NotExcited { part: name, percent, vary });
        }
        if model[part] < -3.0 * sd[part] || (part == 0 && model[part] <= 0.0) {
            return Err(NotIdentified::Impossible { part: name, found: model[part] });
        }
    }
    let half = half_secs(samples);
    let fastest_mps = samples
        .iter()
        .filter_map(|sample| speed_at(samples, sample.at_secs, half))
        .fold(0.0, |most: f64, speed| most.max(speed.abs()));
    Ok(AxisModel {
        inertia: model.x,
        viscous: model.y.max(0.0),
        coulomb_amps: model.z.max(0.0),
        sd,
        rms_amps,
        windows: windows.len(),
        fastest_mps,
    })
}

fn check(samples: &[Sample]) -> Result<(), NotIdentified> {
    let is_good = |sample: &Sample| {
        [sample.at_secs, sample.command_mps, sample.position_m, sample.current_amps]
            .iter()
            .all(|n| n.is_finite())
    };
    if let Some(bad) = samples.iter().position(|sample| !is_good(sample)) {
        return Err(NotIdentified::BadSample { number: bad + 1 });
    }
    if let Some(before) = samples.windows(2).position(|pair| pair[1].at_secs <= pair[0].at_secs) {
        return Err(NotIdentified::BadSample { number: before + 2 });
    }
    let found = match samples {
        [first, .., last] => last.at_secs - first.at_secs,
        _ => 0.0,
    };
    let rate_hz = if found > 0.0 { (samples.len() - 1) as f64 / found } else { 0.0 };
    if found < SHORTEST_SECS || rate_hz < SLOWEST_HZ {
        return Err(NotIdentified::TooShort { found, rate_hz });
    }
    Ok(())
}

fn windows(samples: &[Sample]) -> Vec<Window> {
    let half = half_secs(samples);
    let (first, last) = (samples[0].at_secs, samples[samples.len() - 1].at_secs);
    let speeds: Vec<f64> =
        samples.iter().map(|sample| speed_at(samples, sample.at_secs, half).unwrap_or(0.0)).collect();
    let count = ((last - first - WINDOW_SECS) / NEXT_WINDOW_SECS).floor().max(0.0) as usize;
    (0..=count)
        .filter_map(|number| {
            let begin = first + number as f64 * NEXT_WINDOW_SECS;
            let from = samples.partition_point(|sample| sample.at_secs < begin);
            let to = samples.partition_point(|sample| sample.at_secs <= begin + WINDOW_SECS);
            // One way throughout, and never so slow that it may have stuck.
            let way = speeds.get(from)?.signum();
            if !speeds[from..to].iter().all(|speed| speed * way > SLOWEST_MPS) {
                return None;
            }
            let inside = (from..to).map(|place| {
                let (before, after) = (place.saturating_sub(1), (place + 1).min(samples.len() - 1));
                let span = samples[after].at_secs - samples[before].at_secs;
                Vector3::new((speeds[after] - speeds[before]) / span, speeds[place], way)
            });
            let inside = inside.collect();
            weighed(&samples[from..to], begin + 0.5 * WINDOW_SECS, way, inside)
        })
        .collect()
}

/// Both sides of the equation, weighed by a bump about a moment.
fn weighed(samples: &[Sample], middle_secs: f64, way: f64, inside_rows: Vec<Vector3<f64>>) -> Option<Window> {
    if samples.len() < FEWEST_IN_WINDOW {
        return None;
    }
    let half = 0.5 * WINDOW_SECS;
    let count = samples.len() as f64;
    let time = |sample: &Sample| sample.at_secs - middle_secs;
    // Without the line through the places: it has no acceleration, but sums are not integrals.
    let line = Line::through(samples.iter().map(|sample| (time(sample), sample.position_m)), count);
    let arch = Line::through(samples.iter().map(|sample| (time(sample), 0.5 * time(sample).powi(2))), count);
    let (mut bump, mut amps) = (0.0, 0.0);
    let (mut slope_of_place, mut slope_of_time) = (0.0, 0.0);
    let (mut bend_of_place, mut bend_of_arch) = (0.0, 0.0);
    for (number, sample) in samples.iter().enumerate() {
        let before = samples[number.saturating_sub(1)].at_secs;
        let after = samples[(number + 1).min(samples.len() - 1)].at_secs;
        let share = 0.5 * (after - before);
        let t = time(sample);
        let u = t / half;
        let inside = (1.0 - u * u).max(0.0);
        // (1 - u^2)^3 and its two derivatives, which are nothing at the ends.
        let weight = share * inside.powi(3);
        let slope = share * -6.0 * u * inside.powi(2) / half;
        let bend = share * (24.0 * u * u * inside - 6.0 * inside.powi(2)) / half.powi(2);
        bump += weight;
        amps += weight * sample.current_amps;
        slope_of_place += slope * (sample.position_m - line.at_nothing);
        slope_of_time += slope * t;
        bend_of_place += bend * (sample.position_m - line.at(t));
        bend_of_arch += bend * (0.5 * t * t - arch.at(t));
    }
    let (speed, acceleration) = (slope_of_place / slope_of_time, bend_of_place / bend_of_arch);
    let least_amps = samples.iter().map(|sample| sample.current_amps.abs()).fold(f64::INFINITY, f64::min);
    let row = Vector3::new(acceleration, speed, way);
    Some(Window { row, amps: amps / bump, inside: inside_rows, least_amps })
}

/// A line of least squares.
struct Line {
    at_nothing: f64,
    slope: f64,
}

impl Line {
    fn through(points: impl Iterator<Item = (f64, f64)> + Clone, count: f64) -> Self {
        let (t, x) = points.clone().fold((0.0, 0.0), |sum, point| (sum.0 + point.0, sum.1 + point.1));
        let (t, x) = (t / count, x / count);
        let (along, squares) = points.fold((0.0, 0.0), |sum, point| {
            (sum.0 + (point.0 - t) * (point.1 - x), sum.1 + (point.0 - t).powi(2))
        });
        let slope = along / squares;
        Self { at_nothing: x - slope * t, slope }
    }

    fn at(&self, t: f64) -> f64 {
        self.at_nothing + self.slope * t
    }
}

fn least_squares(windows: &[Window]) -> Result<(Vector3<f64>, Matrix3<f64>), NotIdentified> {
    let too_little = NotIdentified::TooLittleMotion { found: windows.len(), fewest: FEWEST_WINDOWS };
    if windows.len() < FEWEST_WINDOWS {
        return Err(too_little);
    }
    let (normal, right) = windows.iter().fold((Matrix3::zeros(), Vector3::zeros()), |(normal, right), w| {
        (normal + w.row * w.row.transpose(), right + w.row * w.amps)
    });
    let size = normal.diagonal().map(f64::sqrt);
    let unvaried = |part, vary| NotIdentified::NotExcited { part, percent: 100.0, vary };
    if size.x < LEAST_MPS2 * (windows.len() as f64).sqrt() {
        return Err(unvaried("inertia", "the acceleration"));
    }
    // Of columns that are all of one size: how much each has that the others have not.
    let alike = Matrix3::from_fn(|row, column| normal[(row, column)] / (size[row] * size[column]));
    let inverse = normal.try_inverse().filter(|_| alike.determinant() > LEAST_APART);
    let inverse = inverse.ok_or(unvaried("viscous friction", "the speed"))?;
    Ok((inverse * right, inverse))
}

fn with_sign(window: &Window, sign: f64) -> Window {
    Window { amps: window.amps.abs() * sign.signum(), ..window.clone() }
}

const SHORTEST_SECS: f64 = 2.0;
const SLOWEST_HZ: f64 = 50.0;
const WINDOW_SECS: f64 = 0.16;
/// From one window to the next: they overlap by half.
const NEXT_WINDOW_SECS: f64 = 0.08;
const FEWEST_IN_WINDOW: usize = 8;
const FEWEST_WINDOWS: usize = 12;
/// Slower than this it may stick.
const SLOWEST_MPS: f64 = 0.02;
/// Currents below minus this have a sign; nothing else is that negative.
const SIGN_SHOWS_AMPS: f64 = 0.05;
/// A current that stays this far from zero keeps its sign.
const SIGN_IS_PLAIN_AMPS: f64 = 0.15;
/// Braking by less than this is none: friction is more.
const STEADY_MPS2: f64 = 0.05;
const LONGEST_SETTLING: usize = 20;
/// Root mean square acceleration that tells the inertia, m/s2.
const LEAST_MPS2: f64 = 0.05;
/// Determinant of the correlations below which two of the three cannot be told apart.
const LEAST_APART: f64 = 1e-3;
/// Share of the current that may be left.
const MOST_LEFT: f64 = 0.3;
const MOST_UNCERTAIN_PERCENT: f64 = 10.0;

#[cfg(test)]
mod tests;
