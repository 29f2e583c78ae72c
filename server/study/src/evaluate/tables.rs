//! The table as people and programs read it: for the terminal, as JSON, as CSV.

use std::fmt::Write;

use serde_json::Value;

use super::row::{Evaluation, Row};

/// As JSON, whole numbers as integers.
pub fn json(evaluation: &Evaluation) -> Result<String, serde_json::Error> {
    serde_json::to_string_pretty(evaluation)
}

/// As CSV: the keys of a JSON row, and one column for each of its moments.
pub fn csv(evaluation: &Evaluation) -> Result<String, serde_json::Error> {
    let mut text = String::new();
    for (number, row) in evaluation.rows.iter().enumerate() {
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

/// For the terminal: success by number of objects, a line for each rule, prior and task.
pub fn terminal(evaluation: &Evaluation) -> String {
    let mut counts: Vec<usize> = evaluation.rows.iter().map(|row| row.objects).collect();
    // All objects come last.
    counts.sort_by_key(|&count| if count == 0 { usize::MAX } else { count });
    counts.dedup();
    let mut lines: Vec<(&str, &str, &str, &str)> = Vec::new();
    for row in &evaluation.rows {
        let line = (row.file.as_str(), row.task.as_str(), row.rule, row.prior);
        if !lines.contains(&line) {
            lines.push(line);
        }
    }
    let mut text = format!("{:<16} {:<8} {:<18} {:<6}", "file", "task", "rule", "prior");
    for count in &counts {
        let name = if *count == 0 { "all".to_owned() } else { count.to_string() };
        let _ = write!(text, " {name:>6}");
    }
    text += "   mean  detected s  in place s  violations  stops\n";
    for (file, task, rule, prior) in lines {
        let rows: Vec<&Row> = evaluation
            .rows
            .iter()
            .filter(|row| {
                (row.file.as_str(), row.task.as_str(), row.rule, row.prior) == (file, task, rule, prior)
            })
            .collect();
        let mark = if rows.iter().any(|row| row.default) { "*" } else { "" };
        let _ = write!(text, "{file:<16} {task:<8} {:<18} {prior:<6}", format!("{rule}{mark}"));
        for count in &counts {
            match rows.iter().find(|row| row.objects == *count) {
                Some(row) => _ = write!(text, " {:>5.1}%", 100.0 * row.success),
                None => text += "      –",
            }
        }
        let mean = |of: fn(&Row) -> f64| rows.iter().map(|row| of(row)).sum::<f64>() / rows.len() as f64;
        let total = |of: fn(&Row) -> u64| rows.iter().map(|row| of(row)).sum::<u64>();
        let _ = writeln!(
            text,
            " {:>5.1}% {:>11.2} {:>11.2} {:>11} {:>6}",
            100.0 * mean(|row| row.success),
            mean(|row| row.detection_s),
            mean(|row| row.in_place_before_reach_s),
            total(|row| row.violations),
            total(|row| row.stops),
        );
    }
    let faster = evaluation.simulated_secs / evaluation.wall_secs.max(1e-9);
    let _ = writeln!(
        text,
        "* the server's default rule. {:.0} s of people in {:.1} s, {faster:.0} times as fast as they were.",
        evaluation.simulated_secs, evaluation.wall_secs
    );
    text
}

/// Names and values of a row, moments and intervals spread.
fn flat(row: &Row) -> Result<Vec<(String, String)>, serde_json::Error> {
    let Value::Object(fields) = serde_json::to_value(row)? else { return Ok(Vec::new()) };
    let mut cells = Vec::new();
    for (name, value) in fields {
        match value {
            Value::Array(items) => {
                for (end, item) in ["low", "high"].iter().zip(items) {
                    cells.push((format!("{name}_{end}"), plain(&item)));
                }
            }
            // A moment that nobody reached has no key; its column stays.
            Value::Object(moments) => {
                for before_secs in crate::replay::LOOKS_BEFORE_REACH_SECS {
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
