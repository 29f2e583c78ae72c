//! An evaluation as one self-contained HTML page: plots as inline SVG, nothing from outside, no scripts; readable on
//! paper, in light and in dark.

mod plot;

use std::collections::BTreeMap;
use std::fmt::Write;

use crate::evaluate::{Evaluation, Row};
use plot::{Line, Plot, Point, escaped};

/// The page.
pub fn html(evaluation: &Evaluation) -> String {
    let mut body = String::new();
    for (group, rows) in groups(&evaluation.rows) {
        let _ = write!(body, "<h2>{}</h2>\n<div class=\"plots\">", escaped(&group));
        body += &by_objects(&rows).svg();
        body += &before_reach(&rows, "Goal most probable, share of reaches", |row| &row.top1, |share| share)
            .svg();
        let title = "Probability of the goal, geometric mean";
        body += &before_reach(&rows, title, |row| &row.log_loss, |loss| (-loss).exp()).svg();
        body += "</div>\n";
        body += &table(&rows);
    }
    let limits: Vec<String> =
        evaluation.limits.iter().map(|(name, value)| format!("{name} {value}")).collect();
    let (schema, version) = (escaped(evaluation.schema), escaped(evaluation.version));
    let trials: usize = evaluation.rows.iter().map(|row| row.trials).sum();
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width\">\n<title>CoVR: evaluation</title>\n\
         <style>{STYLE}</style>\n</head>\n<body>\n<h1>There before the hand</h1>\n\
         <p>{trials} replays of recorded reaches, {:.0} s of people in {:.1} s. {schema}, CoVR {version}.</p>\n\
         <p>{}</p>\n<p>A reach is served when the column's centre is within 10 cm of the goal's place at the reach, and \
         was slower than 0.05 m/s for 0.2 s. Bars are Wilson's intervals at 95 %.</p>\n{body}</body>\n</html>\n",
        evaluation.simulated_secs,
        evaluation.wall_secs,
        escaped(&limits.join(", ")),
    )
}

/// Rows of one file, task, prior, draw and v_h belong together; in the order of the table.
fn groups(rows: &[Row]) -> Vec<(String, Vec<&Row>)> {
    let mut groups: Vec<(String, Vec<&Row>)> = Vec::new();
    for row in rows {
        let Row { file, task, prior, draw, separation, v_h_mps, .. } = row;
        let name = format!(
            "{file}, task {task}, prior {prior}, draw {draw}, separation {separation}, v_h {v_h_mps} m/s"
        );
        match groups.iter_mut().find(|(known, _)| *known == name) {
            Some((_, members)) => members.push(row),
            None => groups.push((name, vec![row])),
        }
    }
    groups
}

/// Rows by rule and motion, in the order of the table.
fn lines<'a>(rows: &[&'a Row]) -> Vec<(String, Vec<&'a Row>)> {
    let mut lines: Vec<(String, Vec<&Row>)> = Vec::new();
    for row in rows {
        let mark = if row.default { " (default)" } else { "" };
        let name = format!("{}, {}{mark}", row.rule, row.motion);
        match lines.iter_mut().find(|(known, _)| *known == name) {
            Some((_, members)) => members.push(row),
            None => lines.push((name, vec![row])),
        }
    }
    lines
}

fn by_objects(rows: &[&Row]) -> Plot {
    let mut counts: Vec<usize> = rows.iter().map(|row| row.objects).collect();
    counts.sort_by_key(|&count| last_when_all(count));
    counts.dedup();
    let place = |objects: usize| counts.iter().position(|count| *count == objects).unwrap_or(0) as f64;
    let name = |count: &usize| if *count == 0 { "all".to_owned() } else { count.to_string() };
    let line = |(name, rows): (String, Vec<&Row>)| {
        let points =
            rows.iter().map(|row| Point { x: place(row.objects), y: row.success, bar: Some(row.ci95) });
        Line { name, points: points.collect() }
    };
    Plot {
        title: "Reaches served".into(),
        across: "objects shown".into(),
        ticks: counts.iter().enumerate().map(|(at, count)| (at as f64, name(count))).collect(),
        lines: lines(rows).into_iter().map(line).collect(),
    }
}

/// A figure at moments before the reach, averaged over the trials with more than one object: time runs to the right.
fn before_reach(
    rows: &[&Row],
    title: &str,
    figure: fn(&Row) -> &BTreeMap<String, f64>,
    shown: fn(f64) -> f64,
) -> Plot {
    let moments: Vec<(f64, String)> =
        crate::replay::LOOKS_BEFORE_REACH_SECS.iter().map(|secs| (-secs, format!("{secs:.1}"))).collect();
    let line = |(name, rows): (String, Vec<&Row>)| {
        let mean = |key: &str| {
            let (mut sum, mut trials) = (0.0, 0.0);
            for row in rows.iter().filter(|row| row.objects != 1) {
                if let Some(value) = figure(row).get(key) {
                    sum += value * row.trials as f64;
                    trials += row.trials as f64;
                }
            }
            (trials > 0.0).then(|| shown(sum / trials))
        };
        let point = |(x, key): &(f64, String)| mean(key).map(|y| Point { x: *x, y, bar: None });
        Line { name, points: moments.iter().rev().filter_map(point).collect() }
    };
    let lines = lines(rows).into_iter().map(line).filter(|line| !line.points.is_empty()).collect();
    let mut ticks = moments.clone();
    ticks.reverse();
    Plot { title: title.into(), across: "seconds before the touch".into(), ticks, lines }
}

fn table(rows: &[&Row]) -> String {
    let mut text = String::from("<table>\n<tr>");
    let heads = [
        "rule",
        "motion",
        "objects",
        "trials",
        "served",
        "95 %",
        "within 10 cm",
        "at the reach, cm",
        "in place, s",
        "detected, s",
        "violations",
        "stops",
    ];
    heads.iter().for_each(|head| _ = write!(text, "<th>{head}</th>"));
    text += "</tr>\n";
    for row in rows {
        let percent = |share: f64| format!("{:.1} %", 100.0 * share);
        let cells = [
            format!("{}{}", row.rule, if row.default { " (default)" } else { "" }),
            row.motion.to_owned(),
            if row.objects == 0 { "all".to_owned() } else { row.objects.to_string() },
            row.trials.to_string(),
            percent(row.success),
            format!("{} to {}", percent(row.ci95[0]), percent(row.ci95[1])),
            percent(row.within_10cm),
            format!("{:.2}", 100.0 * row.distance_at_reach_m),
            format!("{:.2}", row.in_place_before_reach_s),
            format!("{:.2}", row.detection_s),
            row.violations.to_string(),
            row.stops.to_string(),
        ];
        text += "<tr>";
        cells.iter().for_each(|cell| _ = write!(text, "<td>{}</td>", escaped(cell)));
        text += "</tr>\n";
    }
    text + "</table>\n"
}

fn last_when_all(objects: usize) -> usize {
    if objects == 0 { usize::MAX } else { objects }
}

/// The colours are Okabe and Ito's, which people with any colour vision tell apart; lines differ in their dashes too.
const STYLE: &str = "
:root { color-scheme: light dark; --ink: #1a1a1a; --paper: #fff; --faint: #ccc; --l0: #0072b2; --l1: #d55e00; --l2: #007a5a;
  --l3: #a8427e; --l4: #8a6d00; --l5: #1f6f9e; --l6: #444; --l7: #7a3b00 }
@media screen and (prefers-color-scheme: dark) { :root { --ink: #e8e8e8; --paper: #161616; --faint: #444; --l0: #56b4e9; --l1: #ff9340;
  --l2: #2fc79a; --l3: #e291c0; --l4: #f0e442; --l5: #9fd3f2; --l6: #bbb; --l7: #d9a066 } }
body { font: 15px/1.45 system-ui, sans-serif; color: var(--ink); background: var(--paper); margin: 2rem; max-width: 80rem }
.plots { display: flex; flex-wrap: wrap; gap: 1rem } figure { margin: 0; break-inside: avoid } svg { width: 25rem; height: auto }
text { fill: var(--ink); font-size: 11px } .axis { stroke: var(--ink) } .grid { stroke: var(--faint) } .line { fill: none; stroke-width: 1.8 }
table { border-collapse: collapse; margin: 1rem 0; font-variant-numeric: tabular-nums } th, td { padding: .15rem .6rem; text-align: right;
  border-bottom: 1px solid var(--faint) } th:first-child, td:first-child { text-align: left } tr { break-inside: avoid }
";

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::Bin;

    fn row(rule: &'static str, objects: usize, success: f64) -> Row {
        Row {
            file: "a<b".into(),
            task: "fixed".into(),
            rule,
            motion: "proxy",
            default: rule == "paper",
            prior: "none",
            draw: "hash",
            objects,
            separation: "on",
            v_h_mps: 1.6,
            trials: 10,
            successes: 0,
            success,
            within_10cm: success,
            ci95: [success - 0.1, success],
            distance_at_reach_m: 0.01,
            in_place_before_reach_s: 1.0,
            detection_s: 2.0,
            detection_accuracy: 1.0,
            least_separation_moving_m: None,
            violations: 0,
            separation_breaches: 0,
            stops: 0,
            blame: BTreeMap::new(),
            column_travel_m: 1.0,
            peak_speed_mps: 1.0,
            peak_acceleration_mps2: 1.0,
            peak_jerk_mps3: 1.0,
            proxy_distance_m: 0.0,
            in_place: [("0.0".to_owned(), success), ("1.0".to_owned(), 0.5 * success)].into(),
            reliability: vec![Bin { from: 0.7, to: 0.8, cases: 8, probability: 0.75, share: 0.5 }],
            calibration_error: Some(0.25),
            top1: [("0.0".to_owned(), 0.9), ("1.0".to_owned(), 0.5)].into(),
            top1_wall: BTreeMap::new(),
            log_loss: [("0.0".to_owned(), 0.0), ("1.0".to_owned(), std::f64::consts::LN_2)].into(),
            said_late: BTreeMap::new(),
            late_came_true: BTreeMap::new(),
            in_time_came_true: BTreeMap::new(),
            in_time_brier: BTreeMap::new(),
            not_excluded: None,
        }
    }

    fn page() -> String {
        let rows = vec![row("paper", 2, 0.5), row("paper", 0, 0.25), row("told", 2, 1.0)];
        let limits = [("v_h_mps", 1.6)].into();
        html(&Evaluation {
            schema: "s",
            version: "v",
            limits,
            conditions: BTreeMap::new(),
            left_out: Vec::new(),
            wall_secs: 1.0,
            simulated_secs: 9.0,
            rows,
            pooled: Vec::new(),
        })
    }

    #[test]
    fn the_page_stands_alone_and_escapes_what_it_quotes() {
        let page = page();
        for outside in ["<script", "http:", "https:", "src=", "url(", "@import"] {
            assert!(!page.contains(outside), "{outside}");
        }
        assert!(page.contains("a&lt;b, task fixed") && !page.contains("a<b"));
        assert_eq!(page.matches("<svg").count(), 3);
        assert_eq!(page.matches("<svg").count(), page.matches("</svg>").count());
        assert!(page.contains("25.0 %") && page.contains("paper, proxy (default)"), "{page}");
        assert_eq!(page.matches("<tr>").count(), 4);
    }

    #[test]
    fn the_probability_is_the_one_whose_logarithm_was_lost() {
        let paper = row("paper", 2, 0.5);
        let plot = before_reach(&[&paper], "t", |row| &row.log_loss, |loss| (-loss).exp());
        let points: Vec<_> = plot.lines[0].points.iter().map(|p| (p.x, p.y)).collect();
        assert_eq!(points, [(-1.0, 0.5), (-0.0, 1.0)]);
        // With the goal alone nothing was predicted.
        let alone = row("paper", 1, 0.5);
        assert!(before_reach(&[&alone], "t", |row| &row.top1, |x| x).lines.is_empty());
    }
}
