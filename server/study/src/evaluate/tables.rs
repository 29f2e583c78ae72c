//! The table as people and programs read it: for the terminal, as JSON, as CSV.

use std::collections::BTreeMap;
use std::fmt::Write;

use serde_json::Value;

use super::blame::Cause;
use super::row::{Evaluation, LeftOut, Row};
use crate::replay::{FORETOLD_BEFORE_REACH_SECS, LOOKS_BEFORE_REACH_SECS};

/// As JSON, whole numbers as integers.
pub fn json(evaluation: &Evaluation) -> Result<String, serde_json::Error> {
    serde_json::to_string_pretty(evaluation)
}

/// As CSV, rows and then pools: the keys of a JSON row, and one column for each of its moments.
pub fn csv(evaluation: &Evaluation) -> Result<String, serde_json::Error> {
    let mut text = String::new();
    for (number, row) in evaluation.rows.iter().chain(&evaluation.pooled).enumerate() {
        let cells = flat(row)?;
        if number == 0 {
            let names: Vec<&str> = cells.iter().map(|(name, _)| name.as_str()).collect();
            text += &(names.join(",") + "\n");
        }
        let values: Vec<String> = cells.into_iter().map(|(_, value)| value).collect();
        text += &(values.join(",") + "\n");
    }
    Ok(text)
}

/// For the terminal: success by number of objects, a line for all else that was varied; the pools, and the goals.
pub fn terminal(evaluation: &Evaluation) -> String {
    let mut counts: Vec<usize> = evaluation.rows.iter().map(|row| row.objects).collect();
    // All objects come last.
    counts.sort_by_key(|&count| if count == 0 { usize::MAX } else { count });
    counts.dedup();
    let mut lines: Vec<Line<'_>> = Vec::new();
    for row in evaluation.rows.iter().chain(&evaluation.pooled) {
        if !lines.contains(&line(row)) {
            lines.push(line(row));
        }
    }
    let name = |count: &usize| if *count == 0 { "all".to_owned() } else { count.to_string() };
    let mut text = format!(
        "{:<16} {:<8} {:<18} {:<8} {:<4} {:<6} {:<9}",
        "file", "task", "rule", "motion", "sep", "prior", "draw"
    );
    for count in &counts {
        let _ = write!(text, " {:>6}", name(count));
    }
    text += "  pooled   95 % interval  detected s  in place s  violations  stops\n";
    for words in lines {
        let rows: Vec<&Row> = evaluation.rows.iter().filter(|row| line(row) == words).collect();
        let pool = evaluation.pooled.iter().find(|row| line(row) == words);
        let Some(whole) = pool.or(rows.first().copied()) else { continue };
        let Line { file, task, rule, motion, separation, prior, draw, value } = words;
        let mark = if whole.default { "*" } else { "" };
        let value = value.map_or_else(String::new, |value| format!(" {value:.3}"));
        let rule = format!("{rule}{mark}{value}");
        let _ =
            write!(text, "{file:<16} {task:<8} {rule:<18} {motion:<8} {separation:<4} {prior:<6} {draw:<9}");
        for count in &counts {
            match rows.iter().find(|row| row.objects == *count) {
                Some(row) => _ = write!(text, " {:>5.1}%", 100.0 * row.success),
                None => text += "      –",
            }
        }
        let [low, high] = whole.ci95;
        let total = |of: fn(&Row) -> u64| {
            if rows.is_empty() { of(whole) } else { rows.iter().map(|row| of(row)).sum::<u64>() }
        };
        let _ = writeln!(
            text,
            "  {:>5.1}%  {:>5.1} to {:>5.1} {:>11.2} {:>11.2} {:>11} {:>6}",
            100.0 * whole.success,
            100.0 * low,
            100.0 * high,
            whole.detection_s,
            whole.in_place_before_reach_s,
            total(|row| row.violations),
            total(|row| row.stops),
        );
    }
    text += &causes(evaluation);
    text += &foretold(evaluation);
    text += &offsets(evaluation);
    text += &bounds(evaluation);
    text += &goals(evaluation);
    let as_recorded =
        |(name, value): &(&&str, &f64)| **value == if **name == "acceleration_share" { 1.0 } else { 0.0 };
    let harder = evaluation.conditions.iter().filter(|condition| !as_recorded(condition));
    let harder: Vec<String> = harder.map(|(name, value)| format!("{name} {value:.4}")).collect();
    if !harder.is_empty() {
        let _ = writeln!(text, "not as recorded: {}", harder.join(", "));
    }
    for LeftOut { file, recordings, because } in &evaluation.left_out {
        let _ = writeln!(text, "left out: {recordings} recordings of {file}: {because}");
    }
    let faster = evaluation.simulated_secs / evaluation.wall_secs.max(1e-9);
    let _ = writeln!(
        text,
        "* the server's default. {:.0} s of people in {:.1} s, {faster:.0} times as fast as they were.",
        evaluation.simulated_secs, evaluation.wall_secs
    );
    text
}

/// What a line of the terminal is about.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Line<'a> {
    file: &'a str,
    task: &'a str,
    rule: &'a str,
    motion: &'a str,
    separation: &'a str,
    prior: &'a str,
    draw: &'a str,
    value: Option<f64>,
}

fn line(row: &Row) -> Line<'_> {
    Line {
        file: &row.file,
        task: &row.task,
        rule: row.rule,
        motion: row.motion,
        separation: row.separation,
        prior: row.prior,
        draw: row.draw,
        value: row.value,
    }
}

/// Why trials failed, a line for each pool that has failures.
fn causes(evaluation: &Evaluation) -> String {
    let mut text = String::new();
    for row in evaluation.pooled.iter().filter(|row| !row.blame.is_empty()) {
        let failed = row.trials - row.successes;
        let Line { file, task, rule, motion, separation, prior, draw, .. } = line(row);
        let _ = write!(
            text,
            "why {file} {task} {rule} {motion} {separation} {prior} {draw} failed {failed} times:"
        );
        for cause in Cause::ALL {
            if let Some(count) = row.blame.get(cause.name()) {
                let _ = write!(text, " {} {count}", cause.name());
            }
        }
        text += "\n";
    }
    text
}

/// The goals that the pools of a file can be held against, rule on.
pub fn goals(evaluation: &Evaluation) -> String {
    let mut text = String::new();
    let on = |row: &&Row| row.separation == "on" && row.v_h_mps == GOALS_V_H_MPS && row.value.is_none();
    for row in evaluation.whole_files().filter(on) {
        let least = match (row.rule, row.default, row.prior, row.draw) {
            ("told", ..) => Some(98.5),
            (_, true, "none", "hash") => Some(95.0),
            (_, true, "none", "same-wall") => Some(90.0),
            (_, true, "right", _) => Some(97.5),
            (_, true, "wrong", _) => {
                evaluation.without_prior(row).map(|success| 100.0 * success - WRONG_COSTS)
            }
            _ => None,
        };
        let Some(least) = least else { continue };
        let success = 100.0 * row.success;
        let verdict = if success >= least { "reached" } else { "missed" };
        let Line { file, rule, motion, prior, draw, .. } = line(row);
        let _ = writeln!(
            text,
            "goal {verdict}: {file} {rule} {motion} {prior} {draw} {success:.1} %, at least {least:.1} %"
        );
    }
    for told in evaluation.pooled.iter().filter(on).filter(|row| row.rule == "told" && row.task == "fixed") {
        let bound = evaluation.pooled.iter().find(|row| {
            row.rule == "bound" && (&row.file, &row.task, row.draw) == (&told.file, &told.task, told.draw)
        });
        let Some(bound) = bound.filter(|bound| bound.trials == told.trials) else { continue };
        let below = 100.0 * (bound.success - told.success);
        let verdict = if below <= BELOW_BOUND { "reached" } else { "missed" };
        let Row { file, task, motion, draw, .. } = told;
        let _ = writeln!(
            text,
            "goal {verdict}: {file} {task} told {motion} {draw} {below:.1} points below bound, at most {BELOW_BOUND:.1}"
        );
    }
    let kept = || evaluation.rows.iter().filter(|row| row.separation == "on");
    if kept().next().is_some() {
        let breaches: u64 = kept().map(|row| row.separation_breaches).sum();
        let verdict = if breaches == 0 { "reached" } else { "missed" };
        let _ = writeln!(text, "goal {verdict}: {breaches} separation violations, at most 0");
        let farthest = kept()
            .filter(|row| row.successes > 0 && row.rule != "bound")
            .map(|row| row.distance_at_reach_m)
            .fold(0.0, f64::max);
        let verdict = if farthest < TOUCH_M { "reached" } else { "missed" };
        let _ = writeln!(
            text,
            "goal {verdict}: column to goal at touch {:.2} cm in the worst row, under {:.1} cm",
            100.0 * farthest,
            100.0 * TOUCH_M
        );
    }
    text
}

/// Between which shares the physical limit lies, a line for each pool of it.
fn bounds(evaluation: &Evaluation) -> String {
    let mut text = String::new();
    for row in &evaluation.pooled {
        let Some(not_excluded) = row.not_excluded else { continue };
        let Row { file, task, draw, trials, successes, .. } = row;
        let share = |count: usize| 100.0 * count as f64 / *trials as f64;
        let _ = writeln!(
            text,
            "bound {file} {task} {draw}: from {:.1} % ({successes} motions found and passed by the checker) to {:.1} % ({not_excluded} of {trials} not excluded)",
            share(*successes),
            share(not_excluded),
        );
    }
    text
}

/// How often "late" and "in time" came true, a line for each file and rule.
fn foretold(evaluation: &Evaluation) -> String {
    let mut text = String::new();
    for row in evaluation.whole_files().filter(|row| !row.said_late.is_empty()) {
        let Line { file, rule, motion, separation, prior, draw, .. } = line(row);
        let _ = write!(text, "foretold {file} {rule} {motion} {separation} {prior} {draw}:");
        for (number, (before, said_late)) in row.said_late.iter().enumerate() {
            let share = |of: &BTreeMap<String, f64>| {
                of.get(before).map_or_else(|| "–".to_owned(), |share| format!("{:.1} %", 100.0 * share))
            };
            let _ = write!(
                text,
                "{} {before} s before late {:.1} % (true {}), else in time (true {}), Brier {:.3}",
                if number > 0 { ";" } else { "" },
                100.0 * said_late,
                share(&row.late_came_true),
                share(&row.in_time_came_true),
                row.in_time_brier.get(before).copied().unwrap_or_default(),
            );
        }
        text.push('\n');
    }
    text
}

/// What a client that follows the offered offsets would have had of them.
fn offsets(evaluation: &Evaluation) -> String {
    let mut text = String::new();
    for row in evaluation.whole_files().filter(|row| row.offset_offered.values().any(|share| *share > 0.0)) {
        let Line { file, rule, motion, separation, prior, draw, .. } = line(row);
        let _ = write!(text, "offset {file} {rule} {motion} {separation} {prior} {draw}:");
        for (number, (before, offered)) in row.offset_offered.iter().enumerate() {
            let _ = write!(
                text,
                "{} {before} s before offered {:.1} %, saves {} of {} late",
                if number > 0 { ";" } else { "" },
                100.0 * offered,
                row.saved_by_offset.get(before).copied().unwrap_or_default(),
                row.trials - row.successes,
            );
            let distances =
                row.distance_without_offset_m.get(before).zip(row.distance_with_offset_m.get(before));
            if let Some((without, with)) = distances {
                let _ = write!(text, ", {:.1} cm off become {:.1}", 100.0 * without, 100.0 * with);
            }
        }
        text.push('\n');
    }
    text
}

impl Evaluation {
    /// The pools of whole files: every task together where there are several.
    fn whole_files(&self) -> impl Iterator<Item = &Row> {
        let has_all = |file: &str| self.pooled.iter().any(|row| row.file == file && row.task == "all");
        self.pooled.iter().filter(move |row| row.task == "all" || !has_all(&row.file))
    }

    /// The success of the same pool without a prior, over the numbers of objects that can have a wrong one.
    fn without_prior(&self, pool: &Row) -> Option<f64> {
        let like = |row: &&Row| {
            let same = Line { prior: "none", task: &row.task, ..line(pool) } == line(row);
            same && (pool.task == "all" || pool.task == row.task) && (2..=5).contains(&row.objects)
        };
        let rows = || self.rows.iter().filter(like);
        let trials: usize = rows().map(|row| row.trials).sum();
        (trials > 0).then(|| rows().map(|row| row.successes).sum::<usize>() as f64 / trials as f64)
    }
}

/// The goals are for this speed, m/s.
const GOALS_V_H_MPS: f64 = 1.6;
/// `told` may be so many points below `bound`.
const BELOW_BOUND: f64 = 1.5;
/// A wrong prior may cost so many points.
const WRONG_COSTS: f64 = 5.0;
/// From the column to the goal at the touch, m.
const TOUCH_M: f64 = 0.005;
/// Keys of a row that are looked at [`FORETOLD_BEFORE_REACH_SECS`] before the reach.
const FORETOLD: [&str; 9] = [
    "said_late",
    "late_came_true",
    "in_time_came_true",
    "in_time_brier",
    "offset_offered",
    "success_with_offset",
    "saved_by_offset",
    "distance_without_offset_m",
    "distance_with_offset_m",
];

/// Names and values of a row, moments and intervals spread.
fn flat(row: &Row) -> Result<Vec<(String, String)>, serde_json::Error> {
    let Value::Object(fields) = serde_json::to_value(row)? else { return Ok(Vec::new()) };
    let mut cells = Vec::new();
    for (name, value) in fields {
        match value {
            // A list of its own for each row; the CSV has the error that it comes to.
            Value::Array(_) if name == "reliability" => {}
            Value::Array(items) => {
                for (end, item) in ["low", "high"].iter().zip(items) {
                    cells.push((format!("{name}_{end}"), plain(&item)));
                }
            }
            Value::Object(counts) if name == "blame" => {
                for cause in Cause::ALL {
                    let count = counts.get(cause.name()).map(plain).unwrap_or_default();
                    cells.push((format!("blame_{}", cause.name()), count));
                }
            }
            // A moment that nobody reached has no key; its column stays.
            Value::Object(moments) => {
                let of_foretold = FORETOLD.contains(&name.as_str());
                let looks: &[f64] =
                    if of_foretold { &FORETOLD_BEFORE_REACH_SECS } else { &LOOKS_BEFORE_REACH_SECS };
                for before_secs in looks {
                    let key = format!("{before_secs:.1}");
                    cells.push((format!("{name}_{key}s"), moments.get(&key).map(plain).unwrap_or_default()));
                }
            }
            other => cells.push((name, plain(&other))),
        }
    }
    Ok(cells)
}

fn plain(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) if text.contains([',', '"', '\n']) => {
            format!("\"{}\"", text.replace('"', "\"\""))
        }
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}
