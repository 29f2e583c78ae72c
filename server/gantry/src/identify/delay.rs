//! How late an axis answers.

use super::{Sample, half_secs, speed_at};

/// Delays of a run; those that it does not show are none.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Delays {
    /// From a command to the motion that it asks for, s: where command and speed are most alike. Link, board, the ramp
    /// that it puts in the place of a step, and what the axis lags behind.
    pub command_to_motion_secs: Option<f64>,
    /// How alike they are there, 0 to 1 (coefficient of determination).
    pub likeness: f64,
    /// From a step of the command to the first change of the current, s, as the host sees it; median over the steps. The link both
    /// ways and the board, without the axis.
    pub command_to_current_secs: Option<f64>,
    /// How many steps there were.
    pub steps: usize,
}

/// Find the delays of a run that `identify` has taken.
pub fn delays(samples: &[Sample]) -> Delays {
    let (motion, likeness) = motion_delay(samples)
        .map_or((None, 0.0), |(secs, likeness)| (Some(secs).filter(|_| likeness > LEAST_LIKENESS), likeness));
    let mut onsets = onsets(samples);
    onsets.sort_by(f64::total_cmp);
    Delays {
        command_to_motion_secs: motion,
        likeness,
        command_to_current_secs: onsets.get(onsets.len() / 2).copied(),
        steps: onsets.len(),
    }
}

/// The delay at which the command, scaled and shifted as fits best, is most like the speed.
fn motion_delay(samples: &[Sample]) -> Option<(f64, f64)> {
    let half = half_secs(samples);
    let begin = samples.first()?.at_secs + LONGEST_SECS;
    let speeds: Vec<(f64, f64)> = samples
        .iter()
        .filter(|sample| sample.at_secs >= begin)
        .filter_map(|sample| Some((sample.at_secs, speed_at(samples, sample.at_secs, half)?)))
        .collect();
    let tries = (LONGEST_SECS / TRY_SECS) as usize;
    let likeness: Vec<f64> = (0..=tries).map(|n| alike(samples, &speeds, n as f64 * TRY_SECS)).collect();
    let best = (0..=tries).max_by(|a, b| likeness[*a].total_cmp(&likeness[*b]))?;
    let between = if best > 0 && best < tries {
        // The vertex of the parabola through the best and its neighbours.
        let [before, at, after] = [likeness[best - 1], likeness[best], likeness[best + 1]];
        let bend = before - 2.0 * at + after;
        if bend < 0.0 { 0.5 * (before - after) / bend } else { 0.0 }
    } else {
        0.0
    };
    Some(((best as f64 + between) * TRY_SECS, likeness[best]))
}

/// Squared correlation of the speeds with the command so much earlier.
fn alike(samples: &[Sample], speeds: &[(f64, f64)], earlier_secs: f64) -> f64 {
    let (mut n, mut x, mut y, mut xx, mut yy, mut xy) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    let mut at = 0;
    for (time, speed) in speeds {
        while at + 1 < samples.len() && samples[at + 1].at_secs <= time - earlier_secs {
            at += 1;
        }
        let (before, after) = (&samples[at], &samples[(at + 1).min(samples.len() - 1)]);
        let span = after.at_secs - before.at_secs;
        // Between two commands, so that the delay is not known in steps of the sampling alone.
        let share =
            if span > 0.0 { ((time - earlier_secs - before.at_secs) / span).clamp(0.0, 1.0) } else { 0.0 };
        let command = before.command_mps + share * (after.command_mps - before.command_mps);
        n += 1.0;
        x += command;
        y += speed;
        xx += command * command;
        yy += speed * speed;
        xy += command * speed;
    }
    let (vx, vy, c) = (n * xx - x * x, n * yy - y * y, n * xy - x * y);
    if vx > 0.0 && vy > 0.0 { c * c / (vx * vy) } else { 0.0 }
}

/// From each step of the command out of a steady one to the first current that is another.
fn onsets(samples: &[Sample]) -> Vec<f64> {
    let mut onsets = Vec::new();
    for (place, pair) in samples.windows(2).enumerate() {
        let step = &pair[1];
        if (step.command_mps - pair[0].command_mps).abs() < STEP_MPS {
            continue;
        }
        let from = samples.partition_point(|sample| sample.at_secs < step.at_secs - STEADY_SECS);
        let before = &samples[from..=place];
        let is_steady = before.iter().all(|sample| sample.command_mps == pair[0].command_mps);
        if !is_steady || step.at_secs - samples[0].at_secs < STEADY_SECS || before.len() < 5 {
            continue;
        }
        let count = before.len() as f64;
        let mean = before.iter().map(|sample| sample.current_amps).sum::<f64>() / count;
        let squares: f64 = before.iter().map(|sample| (sample.current_amps - mean).powi(2)).sum();
        let bound = (5.0 * (squares / count).sqrt()).max(CHANGE_AMPS);
        let later =
            samples[place + 1..].iter().take_while(|sample| sample.at_secs < step.at_secs + LONGEST_SECS);
        onsets.extend(
            later
                .filter(|sample| (sample.current_amps - mean).abs() > bound)
                .map(|sample| sample.at_secs - step.at_secs)
                .next(),
        );
    }
    onsets
}

const LONGEST_SECS: f64 = 0.3;
const TRY_SECS: f64 = 0.001;
/// Below this the speed is not the command's.
const LEAST_LIKENESS: f64 = 0.8;
/// A jump of the command that is a step.
const STEP_MPS: f64 = 0.05;
/// How long the command is steady before a step.
const STEADY_SECS: f64 = 0.15;
/// Least change of the current that counts, A: boards report steps of 10 mA.
const CHANGE_AMPS: f64 = 0.1;
