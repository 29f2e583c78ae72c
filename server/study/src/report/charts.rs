//! Which plots are drawn of the rows of a group.

use std::collections::BTreeMap;

use super::plot::{Line, Plot, Point};
use super::series::{Palette, Series};
use crate::evaluate::{Bin, Row, wilson};
use crate::replay::LOOKS_BEFORE_REACH_SECS;

/// Rows of a rule and motion, in the order of the table.
pub(super) type Lines<'a> = Vec<(Series, Vec<&'a Row>)>;

/// Rows by rule and motion.
pub(super) fn lines<'a>(rows: &[&'a Row], palette: &Palette) -> Lines<'a> {
    let mut lines: Lines<'_> = Vec::new();
    for row in rows {
        let series = palette.series(row);
        match lines.iter_mut().find(|(known, _)| *known == series) {
            Some((_, members)) => members.push(row),
            None => lines.push((series, vec![row])),
        }
    }
    lines
}

/// Success against the number of objects.
pub(super) fn by_objects(lines: &Lines<'_>) -> Plot {
    let counts = counts(lines);
    let place = |objects: usize| counts.iter().position(|count| *count == objects).unwrap_or(0) as f64;
    let line = |(series, rows): &(Series, Vec<&Row>)| {
        let point = |row: &&Row| Point { bar: Some(row.ci95), ..Point::at(place(row.objects), row.success) };
        line_of(series, rows.iter().map(point).collect())
    };
    Plot {
        title: "Reaches served, by number of objects".into(),
        across: "objects shown".into(),
        up: "served".into(),
        ticks: counts.iter().enumerate().map(|(at, count)| (at as f64, count_words(*count))).collect(),
        diagonal: false,
        lines: lines.iter().map(line).collect(),
    }
}

/// Success against a parameter that was swept, a line for each number of objects and one for all together.
pub(super) fn by_value(parameter: &str, name: &str, rows: &[&Row]) -> Plot {
    let mut values: Vec<f64> = rows.iter().filter_map(|row| row.value).collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    let mut counts: Vec<usize> = rows.iter().map(|row| row.objects).collect();
    counts.sort_by_key(|&count| last_when_all(count));
    counts.dedup();
    let of = |style: String, name: String, chosen: &dyn Fn(&Row) -> bool| {
        let point = |value: &f64| {
            let here = || rows.iter().filter(|row| row.value == Some(*value) && chosen(row));
            let trials: usize = here().map(|row| row.trials).sum();
            let successes: usize = here().map(|row| row.successes).sum();
            let share = successes as f64 / trials.max(1) as f64;
            (trials > 0).then(|| Point { bar: Some(wilson(successes, trials)), ..Point::at(*value, share) })
        };
        Line { name, style, points: values.iter().filter_map(point).collect() }
    };
    let mut lines: Vec<Line> = counts
        .iter()
        .enumerate()
        .map(|(at, count)| {
            let style = format!("stroke:var(--l{});stroke-width:1.7", at % 8);
            let word = if *count == 1 { "object" } else { "objects" };
            of(style, format!("{} {word}", count_words(*count)), &|row| row.objects == *count)
        })
        .collect();
    if counts.len() > 1 {
        let name = "all of these together".to_owned();
        lines.push(of("stroke:var(--own);stroke-width:3.2".into(), name, &|_| true));
    }
    // A mark at every third value is enough.
    let marked =
        |(at, value): (usize, &f64)| (at % 3 == 0 || at + 1 == values.len()).then(|| (*value, short(*value)));
    Plot {
        title: format!("Reaches served: {name}"),
        across: parameter.into(),
        up: "served".into(),
        ticks: values.iter().enumerate().filter_map(marked).collect(),
        diagonal: false,
        lines,
    }
}

/// A figure at moments before the reach: time runs to the right. `guessed`: over rows with more than one object alone,
/// for with the goal alone nothing was predicted.
pub(super) fn before_reach(
    lines: &Lines<'_>,
    [title, up]: [&str; 2],
    guessed: bool,
    figure: fn(&Row) -> &BTreeMap<String, f64>,
    shown: fn(f64) -> f64,
) -> Plot {
    let moments: Vec<(f64, String)> =
        LOOKS_BEFORE_REACH_SECS.iter().rev().map(|secs| (-secs, format!("{secs:.1}"))).collect();
    let line = |(series, rows): &(Series, Vec<&Row>)| {
        let mean = |key: &str| {
            let (mut sum, mut trials) = (0.0, 0.0);
            for row in rows.iter().filter(|row| !guessed || row.objects != 1) {
                if let Some(value) = figure(row).get(key) {
                    sum += value * row.trials as f64;
                    trials += row.trials as f64;
                }
            }
            (trials > 0.0).then(|| shown(sum / trials))
        };
        let point = |(x, key): &(f64, String)| mean(key).map(|y| Point::at(*x, y));
        line_of(series, moments.iter().filter_map(point).collect())
    };
    Plot {
        title: title.into(),
        across: "seconds before the touch".into(),
        up: up.into(),
        lines: lines.iter().map(line).filter(|line| !line.points.is_empty()).collect(),
        ticks: moments,
        diagonal: false,
    }
}

/// How often the most probable object was the goal, against its probability.
pub(super) fn reliability(lines: &Lines<'_>) -> Plot {
    let line = |(series, rows): &(Series, Vec<&Row>)| {
        let mut sums: BTreeMap<usize, [f64; 3]> = BTreeMap::new();
        let bins = rows.iter().filter(|row| row.objects != 1).flat_map(|row| &row.reliability);
        for Bin { from, cases, probability, share, .. } in bins {
            let cases = *cases as f64;
            let sum = sums.entry((from * 100.0).round() as usize).or_default();
            for (sum, part) in sum.iter_mut().zip([cases, cases * probability, cases * share]) {
                *sum += part;
            }
        }
        let total: f64 = sums.values().map(|[cases, ..]| cases).sum();
        // A share of a few moments is none.
        sums.retain(|_, [cases, ..]| *cases >= LEAST_CASES);
        let point = |[cases, probability, share]: &[f64; 3]| Point {
            radius: 1.5 + 6.0 * (cases / total).sqrt(),
            ..Point::at(probability / cases, share / cases)
        };
        line_of(series, sums.values().map(point).collect())
    };
    Plot {
        title: "Does the belief mean what it says?".into(),
        across: "probability of the most probable object".into(),
        up: "it was the goal (size: how often this was said)".into(),
        ticks: (0..=5).map(|fifth| (0.2 * f64::from(fifth), format!("{} %", 20 * fifth))).collect(),
        diagonal: true,
        lines: lines.iter().map(line).filter(|line| line.points.len() > 1).collect(),
    }
}

fn line_of(series: &Series, points: Vec<Point>) -> Line {
    Line { name: series.name.clone(), style: series.style.clone(), points }
}

/// So many moments make a point of the reliability diagram.
const LEAST_CASES: f64 = 10.0;

/// The numbers of objects, all of them last.
fn counts(lines: &Lines<'_>) -> Vec<usize> {
    let mut counts: Vec<usize> = lines.iter().flat_map(|(_, rows)| rows).map(|row| row.objects).collect();
    counts.sort_by_key(|&count| last_when_all(count));
    counts.dedup();
    counts
}

fn last_when_all(objects: usize) -> usize {
    if objects == 0 { usize::MAX } else { objects }
}

pub(super) fn count_words(objects: usize) -> String {
    if objects == 0 { "all".to_owned() } else { objects.to_string() }
}

/// With no more digits than it needs, four at most.
pub(super) fn short(value: f64) -> String {
    let text = format!("{value:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
