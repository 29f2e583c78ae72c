//! One row of the table: what became of all trials of one rule, task, number of objects and prior.

use std::collections::BTreeMap;

use serde::Serialize;

use super::blame::Cause;
use super::offsets::Offsets;
use super::plan::SeparationChoice;
use super::reliability::{Bin, calibration_error, reliability};
use crate::checker::Verdict;
use crate::replay::{FORETOLD_BEFORE_REACH_SECS, LOOKS_BEFORE_REACH_SECS, TrialOutcome};

/// The whole table.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Evaluation {
    /// Of this form.
    pub schema: &'static str,
    /// The program's.
    pub version: &'static str,
    /// What the machine may do, and what the separation rule asks: SI units in the names.
    pub limits: BTreeMap<&'static str, f64>,
    /// Time that it took, s.
    pub wall_secs: f64,
    /// Virtual time replayed, s.
    pub simulated_secs: f64,
    /// What was made harder than it was recorded: SI units in the names.
    pub conditions: BTreeMap<&'static str, f64>,
    /// What could not be evaluated, and why.
    pub left_out: Vec<LeftOut>,
    /// The rows.
    pub rows: Vec<Row>,
    /// The same trials pooled: over the numbers of objects up to 5, by task and over every task. `objects` is 0.
    pub pooled: Vec<Row>,
}

/// Recordings of a file that no trial can be made of.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct LeftOut {
    /// The file, without its endings.
    pub file: String,
    /// How many recordings.
    pub recordings: usize,
    /// Why.
    pub because: &'static str,
}

/// One row.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// File of the recordings, without its endings.
    pub file: String,
    /// What the people were asked to do.
    pub task: String,
    /// The intention rule.
    pub rule: &'static str,
    /// How the column is moved.
    pub motion: &'static str,
    /// The server uses this when nothing is configured.
    pub default: bool,
    /// What the scenario said.
    pub prior: &'static str,
    /// How distractors were drawn.
    pub draw: &'static str,
    /// Objects shown; 0 for all.
    pub objects: usize,
    /// Whether the separation rule was kept.
    pub separation: &'static str,
    /// v_h of the separation rule, m/s.
    pub v_h_mps: f64,
    /// Trials replayed.
    pub trials: usize,
    /// Of which the column was in place, at rest.
    pub successes: usize,
    /// Their share.
    pub success: f64,
    /// Share within 10 cm, whatever the speed.
    pub within_10cm: f64,
    /// Wilson's interval of `success`.
    pub ci95: [f64; 2],
    /// Mean distance of the successes at the reach, m.
    pub distance_at_reach_m: f64,
    /// Mean time that the column had been in place at the reach, of the successes, s.
    pub in_place_before_reach_s: f64,
    /// Mean time from the first lasting belief in the goal to the reach, of those who had one, s.
    pub detection_s: f64,
    /// Share of trials that ended with the belief in the goal.
    pub detection_accuracy: f64,
    /// Least distance from a head axis to the footprint while the column moved, m; null if it never did.
    pub least_separation_moving_m: Option<f64>,
    /// Violations of separation, travel and limits, of the commanded and of the true motion; of travel and limits
    /// alone where the separation rule was off.
    pub violations: u64,
    /// Ticks that broke the separation rule, of the commanded and of the true motion, whether or not it was kept.
    pub separation_breaches: u64,
    /// Stops.
    pub stops: u64,
    /// Mean way of the column, m.
    pub column_travel_m: f64,
    /// Greatest commanded speed of an axis, m/s.
    pub peak_speed_mps: f64,
    /// Greatest commanded acceleration of an axis, m/s2.
    pub peak_acceleration_mps2: f64,
    /// Greatest commanded jerk of an axis, m/s3.
    pub peak_jerk_mps3: f64,
    /// Mean distance between column and proxy, m.
    pub proxy_distance_m: f64,
    /// Share in which the column stood in place from so many seconds before the reach on, and to it.
    pub in_place: BTreeMap<String, f64>,
    /// Share with the goal most probable, by seconds before the reach.
    pub top1: BTreeMap<String, f64>,
    /// The same among the targets of its wall; empty where there are no walls.
    pub top1_wall: BTreeMap<String, f64>,
    /// Mean negative logarithm of the goal's probability, by seconds before the reach.
    pub log_loss: BTreeMap<String, f64>,
    /// How often the most probable object was the goal, by its probability, over all those moments.
    pub reliability: Vec<Bin>,
    /// Mean distance between that probability and that share; null without a belief.
    pub calibration_error: Option<f64>,
    /// Share of trials in which the engine said that the column would be late for the goal (`late_by_s` above 0), by
    /// seconds before the reach.
    pub said_late: BTreeMap<String, f64>,
    /// Share of those in which it then was not in place, at rest.
    pub late_came_true: BTreeMap<String, f64>,
    /// Share of those in which the engine said that it would be in time and in which it then was.
    pub in_time_came_true: BTreeMap<String, f64>,
    /// Mean squared error of the goal's `in_time_probability` (Brier 1950), by seconds before the reach.
    pub in_time_brier: BTreeMap<String, f64>,
    /// Share of trials in which the engine offered an `offset_m` for the goal, by seconds before the reach.
    pub offset_offered: BTreeMap<String, f64>,
    /// Share served by a client that shifts the goal by what was offered then, and shifts nothing where nothing was.
    pub success_with_offset: BTreeMap<String, f64>,
    /// Failed trials that are served so.
    pub saved_by_offset: BTreeMap<String, usize>,
    /// Mean distance of the column at the reach from the goal, where an offset was offered and the shifted goal served, m.
    pub distance_without_offset_m: BTreeMap<String, f64>,
    /// The same from the shifted goal, m.
    pub distance_with_offset_m: BTreeMap<String, f64>,
    /// Failed trials by cause; empty where nobody looked for it.
    pub blame: BTreeMap<&'static str, u64>,
    /// Of the rule `bound` alone: trials that were found to be possible, and those of which it is not known.
    pub not_excluded: Option<usize>,
    /// The parameter of the rule that was swept, `group.name`; null where none was.
    pub parameter: Option<&'static str>,
    /// Its value in this row.
    pub value: Option<f64>,
}

impl Evaluation {
    /// One evaluation for each value of a parameter, as one table: the rows say which value they are of.
    pub fn of_sweep(parameter: &'static str, of_values: Vec<(f64, Self)>) -> Option<Self> {
        let mark = |rows: &mut Vec<Row>, value| {
            rows.iter_mut().for_each(|row| (row.parameter, row.value) = (Some(parameter), Some(value)));
        };
        let marked = of_values.into_iter().map(|(value, mut evaluation)| {
            mark(&mut evaluation.rows, value);
            mark(&mut evaluation.pooled, value);
            evaluation
        });
        marked.reduce(|mut all, one| {
            all.simulated_secs += one.simulated_secs;
            all.rows.extend(one.rows);
            all.pooled.extend(one.pooled);
            all
        })
    }
}

/// A trial, and why it failed if it did and somebody looked.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Judged {
    pub outcome: TrialOutcome,
    pub cause: Option<Cause>,
    /// Of the rule `bound` alone: whether it could have been served, for all that is known.
    pub not_excluded: Option<bool>,
}

impl Judged {
    /// Virtual time, s.
    pub fn secs(&self) -> f64 {
        self.outcome.simulated_secs
    }
}

/// What a row is about.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct RowKey {
    pub file: String,
    pub task: String,
    pub rule: &'static str,
    pub motion: &'static str,
    pub default: bool,
    pub prior: &'static str,
    pub draw: &'static str,
    pub objects: usize,
    pub separation: SeparationChoice,
    pub v_h_mps: f64,
}

impl Row {
    /// Sum trials up, in their order.
    pub(super) fn of(key: RowKey, judged: &[&Judged]) -> Self {
        let outcomes: Vec<&TrialOutcome> = judged.iter().map(|judged| &judged.outcome).collect();
        let mut blame = BTreeMap::new();
        for cause in judged.iter().filter_map(|judged| judged.cause) {
            *blame.entry(cause.name()).or_insert(0) += 1;
        }
        let possible = judged.iter().filter_map(|judged| judged.not_excluded);
        let not_excluded = possible.map(usize::from).reduce(|count, one| count + one);
        let verdicts = || outcomes.iter().flat_map(|o| [&o.true_verdict, &o.commanded_verdict]);
        let separation_breaches = verdicts().map(|verdict| verdict.separation).sum();
        let of_all: u64 = verdicts().map(Verdict::violations).sum();
        let kept = key.separation == SeparationChoice::On;
        let trials = outcomes.len();
        let good: Vec<&TrialOutcome> = outcomes.iter().copied().filter(|o| o.success).collect();
        let share = |count: usize| if trials > 0 { count as f64 / trials as f64 } else { 0.0 };
        let greatest = |i: usize| outcomes.iter().map(|o| o.peaks[i]).fold(0.0, f64::max);
        let detections: Vec<f64> =
            outcomes.iter().filter_map(|o| o.belief.detected_before_reach_secs).collect();
        let [mut top1, mut top1_wall, mut log_loss, mut in_place] = [(); 4].map(|()| BTreeMap::new());
        for (look, before_secs) in LOOKS_BEFORE_REACH_SECS.iter().enumerate() {
            let name = || format!("{before_secs:.1}");
            let stood = |o: &&&TrialOutcome| o.in_place_before_reach_secs >= *before_secs;
            in_place.insert(name(), share(good.iter().filter(stood).count()));
            let seen: Vec<_> = outcomes.iter().filter_map(|o| o.belief.at[look]).collect();
            let walls: Vec<bool> = seen.iter().filter_map(|b| b.goal_is_best_of_wall).collect();
            let as_share = |yes: bool| if yes { 1.0 } else { 0.0 };
            if !seen.is_empty() {
                top1.insert(name(), mean(seen.iter().map(|b| as_share(b.goal_is_best))));
                let loss = |b: f64| -b.max(LEAST_PROBABILITY).ln();
                log_loss.insert(name(), mean(seen.iter().map(|b| loss(b.goal_probability))));
            }
            if !walls.is_empty() {
                top1_wall.insert(name(), mean(walls.iter().map(|best| as_share(*best))));
            }
        }
        let reliability = reliability(&outcomes);
        let said = Foretelling::of(&outcomes);
        let offsets = Offsets::of(&outcomes);
        Self {
            file: key.file,
            task: key.task,
            rule: key.rule,
            motion: key.motion,
            default: key.default,
            prior: key.prior,
            draw: key.draw,
            objects: key.objects,
            separation: key.separation.name(),
            v_h_mps: key.v_h_mps,
            trials,
            successes: good.len(),
            success: share(good.len()),
            within_10cm: share(outcomes.iter().filter(|o| o.within_10cm).count()),
            ci95: wilson(good.len(), trials),
            distance_at_reach_m: mean(good.iter().map(|o| o.distance_at_reach_m)),
            in_place_before_reach_s: mean(good.iter().map(|o| o.in_place_before_reach_secs)),
            detection_s: mean(detections.iter().copied()),
            detection_accuracy: share(detections.len()),
            least_separation_moving_m: outcomes
                .iter()
                .filter_map(|o| o.true_verdict.least_separation_moving_m)
                .reduce(f64::min),
            violations: if kept { of_all } else { of_all - separation_breaches },
            separation_breaches,
            stops: outcomes.iter().map(|o| u64::from(o.stops)).sum(),
            column_travel_m: mean(outcomes.iter().map(|o| o.column_travel_m)),
            peak_speed_mps: greatest(0),
            peak_acceleration_mps2: greatest(1),
            peak_jerk_mps3: greatest(2),
            proxy_distance_m: mean(outcomes.iter().map(|o| o.proxy_distance_m)),
            in_place,
            top1,
            top1_wall,
            log_loss,
            calibration_error: calibration_error(&reliability),
            reliability,
            said_late: said.late,
            late_came_true: said.late_came_true,
            in_time_came_true: said.in_time_came_true,
            in_time_brier: said.brier,
            offset_offered: offsets.offered,
            success_with_offset: offsets.success,
            saved_by_offset: offsets.saved,
            distance_without_offset_m: offsets.distance_without_m,
            distance_with_offset_m: offsets.distance_with_m,
            blame,
            not_excluded,
            parameter: None,
            value: None,
        }
    }
}

/// How often what was foretold of the goal came true, by seconds before the reach.
#[derive(Debug, Default)]
struct Foretelling {
    late: BTreeMap<String, f64>,
    late_came_true: BTreeMap<String, f64>,
    in_time_came_true: BTreeMap<String, f64>,
    brier: BTreeMap<String, f64>,
}

impl Foretelling {
    /// A moment without a verdict of a kind has no key.
    fn of(outcomes: &[&TrialOutcome]) -> Self {
        let mut found = Self::default();
        for (look, before_secs) in FORETOLD_BEFORE_REACH_SECS.iter().enumerate() {
            let [mut late, mut in_time, mut errors] = [(); 3].map(|()| Vec::new());
            for outcome in outcomes {
                let then = outcome.foretold[look].and_then(|f| f.late_by_secs().zip(f.in_time_probability()));
                let Some((late_by_secs, probability)) = then else { continue };
                let came_in_time = if outcome.success { 1.0 } else { 0.0 };
                if late_by_secs > 0.0 {
                    late.push(1.0 - came_in_time)
                } else {
                    in_time.push(came_in_time)
                }
                errors.push((probability - came_in_time).powi(2));
            }
            if errors.is_empty() {
                continue;
            }
            let name = || format!("{before_secs:.1}");
            found.late.insert(name(), late.len() as f64 / errors.len() as f64);
            found.brier.insert(name(), mean(errors.into_iter()));
            if !late.is_empty() {
                found.late_came_true.insert(name(), mean(late.into_iter()));
            }
            if !in_time.is_empty() {
                found.in_time_came_true.insert(name(), mean(in_time.into_iter()));
            }
        }
        found
    }
}

/// 0 of nothing.
fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    if count > 0.0 { sum / count } else { 0.0 }
}

/// Wilson's score interval at 95 % (Wilson 1927).
pub fn wilson(successes: usize, trials: usize) -> [f64; 2] {
    if trials == 0 {
        return [0.0, 1.0];
    }
    let (n, p) = (trials as f64, successes as f64 / trials as f64);
    let z2 = Z_95 * Z_95;
    let middle = (p + z2 / (2.0 * n)) / (1.0 + z2 / n);
    let half = Z_95 / (1.0 + z2 / n) * (p * (1.0 - p) / n + z2 / (4.0 * n * n)).sqrt();
    [(middle - half).max(0.0), (middle + half).min(1.0)]
}

/// The 97.5th percentile of the normal distribution.
const Z_95: f64 = 1.959_963_985;
/// A rule that gives the goal no chance at all loses this much, not everything.
const LEAST_PROBABILITY: f64 = 1e-3;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wilsons_interval_is_the_published_one() {
        // 81 of 263: 0.2553 to 0.3662 (Newcombe 1998, table I, method 3).
        let [low, high] = wilson(81, 263);
        assert!((low - 0.2553).abs() < 1e-4 && (high - 0.3662).abs() < 1e-4, "{low} {high}");
        assert_eq!(wilson(0, 0), [0.0, 1.0]);
        assert!(wilson(10, 10)[1] <= 1.0 && wilson(10, 10)[0] > 0.7);
    }
}
