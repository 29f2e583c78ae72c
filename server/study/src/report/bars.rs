//! Bars from left to right, as SVG: success with its interval, and failures by their cause.

use std::fmt::Write;

use super::plot::escaped;
use super::series::Series;
use crate::evaluate::{Cause, Row};

/// Reaches served, a rule a line, best first, each with Wilson's interval.
pub(super) fn served(rows: &[(&Row, Series)]) -> String {
    let mut rows: Vec<&(&Row, Series)> = rows.iter().collect();
    rows.sort_by(|a, b| b.0.success.total_cmp(&a.0.success));
    let least = rows.iter().map(|(row, _)| row.ci95[0]).fold(1.0, f64::min);
    let floor = (5.0 * least).floor().clamp(0.0, 4.0) / 5.0;
    let x_of = |share: f64| LEFT + (share.clamp(floor, 1.0) - floor) / (1.0 - floor) * (RIGHT - LEFT);
    let height = TOP + STEP * rows.len() as f64 + 6.0;
    let mut svg = opened("Reaches served, all numbers of objects up to five together", height);
    let marks = if floor >= 0.6 { 5 } else { 10 };
    for percent in ((100.0 * floor).round() as usize..=100).step_by(marks) {
        let x = x_of(percent as f64 / 100.0);
        let _ = writeln!(
            svg,
            "<line class=\"grid\" x1=\"{x:.1}\" x2=\"{x:.1}\" y1=\"{TOP}\" y2=\"{height:.1}\"/>\
             <text x=\"{x:.1}\" y=\"12\" text-anchor=\"middle\">{percent} %</text>"
        );
    }
    for (number, (row, series)) in rows.iter().enumerate() {
        let y = TOP + STEP * (number as f64 + 0.5);
        let [low, high] = row.ci95.map(x_of);
        let (x, weight) = (x_of(row.success), if row.default { "600" } else { "400" });
        let _ = writeln!(
            svg,
            "<text x=\"{:.0}\" y=\"{:.1}\" text-anchor=\"end\" font-weight=\"{weight}\">{}</text>\
             <line style=\"{}\" x1=\"{low:.1}\" x2=\"{high:.1}\" y1=\"{y:.1}\" y2=\"{y:.1}\"/>\
             <circle class=\"dot full\" style=\"{}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3.6\"/>\
             <text x=\"{:.0}\" y=\"{:.1}\" font-weight=\"{weight}\">{:.1} %</text>",
            LEFT - 10.0,
            y + 4.0,
            escaped(&series.name),
            series.style,
            series.style,
            RIGHT + 12.0,
            y + 4.0,
            100.0 * row.success,
        );
    }
    svg + "</svg></figure>\n"
}

/// Of the reaches of each line, the share that failed, by cause.
pub(super) fn failures(rows: &[(&Row, Series)]) -> String {
    let failed = |row: &Row| (row.trials - row.successes) as f64 / row.trials.max(1) as f64;
    let most = rows.iter().map(|(row, _)| failed(row)).fold(0.0, f64::max);
    let scale = SCALES.into_iter().find(|scale| *scale >= most).unwrap_or(1.0);
    let width = |share: f64| share / scale * (RIGHT - LEFT);
    let height = TOP + STEP * rows.len() as f64 + 34.0;
    let mut svg = opened("Where failures came from: share of all reaches", height);
    for part in 0..=4 {
        let share = 0.25 * f64::from(part) * scale;
        let x = LEFT + width(share);
        let _ = writeln!(
            svg,
            "<line class=\"grid\" x1=\"{x:.1}\" x2=\"{x:.1}\" y1=\"{TOP}\" y2=\"{:.1}\"/>\
             <text x=\"{x:.1}\" y=\"12\" text-anchor=\"middle\">{} %</text>",
            height - 28.0,
            // No more digits than the mark has.
            (1e4 * share).round() / 100.0
        );
    }
    for (number, (row, series)) in rows.iter().enumerate() {
        let y = TOP + STEP * number as f64;
        let _ = writeln!(
            svg,
            "<text x=\"{:.0}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
            LEFT - 10.0,
            y + 15.0,
            escaped(&series.name)
        );
        let mut x = LEFT;
        for (place, cause) in Cause::ALL.into_iter().enumerate() {
            let count = row.blame.get(cause.name()).copied().unwrap_or(0);
            let long = width(count as f64 / row.trials.max(1) as f64);
            if count > 0 {
                let _ = writeln!(
                    svg,
                    "<rect class=\"c{place}\" x=\"{x:.1}\" y=\"{:.1}\" width=\"{long:.1}\" height=\"14\"><title>{}: {count} of {} reaches</title></rect>",
                    y + 4.0,
                    words(cause),
                    row.trials
                );
            }
            x += long;
        }
        let _ = writeln!(
            svg,
            "<text x=\"{:.1}\" y=\"{:.1}\">{:.1} % of {}</text>",
            x + 8.0,
            y + 15.0,
            100.0 * failed(row),
            row.trials
        );
    }
    let mut x = LEFT;
    for (place, cause) in Cause::ALL.into_iter().enumerate() {
        let y = height - 16.0;
        let _ = writeln!(
            svg,
            "<rect class=\"c{place}\" x=\"{x:.1}\" y=\"{y:.1}\" width=\"11\" height=\"11\"/><text x=\"{:.1}\" y=\"{:.1}\">{}</text>",
            x + 16.0,
            y + 10.0,
            words(cause)
        );
        x += 34.0 + 6.3 * words(cause).len() as f64;
    }
    svg + "</svg></figure>\n"
}

fn words(cause: Cause) -> String {
    cause.name().replace('_', " ")
}

fn opened(title: &str, height: f64) -> String {
    format!(
        "<figure class=\"wide\"><figcaption>{title}</figcaption><svg viewBox=\"0 0 {WIDTH} {height}\" role=\"img\" aria-label=\"{title}\">\n"
    )
}

const WIDTH: f64 = 820.0;
const LEFT: f64 = 200.0;
/// Room for the figure is left beyond it.
const RIGHT: f64 = 730.0;
const TOP: f64 = 20.0;
/// From line to line.
const STEP: f64 = 22.0;
/// Shares that the longest bar is drawn against.
const SCALES: [f64; 6] = [0.04, 0.1, 0.2, 0.4, 0.6, 0.8];
