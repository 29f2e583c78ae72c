//! An evaluation as one self-contained HTML page: plots as inline SVG, nothing from outside, no scripts; readable on
//! paper, in light and in dark.

mod bars;
mod charts;
mod plot;
mod series;

use std::fmt::Write;

use crate::evaluate::{Evaluation, Row, goals};
use charts::{Lines, before_reach, by_objects, by_value, count_words, lines, reliability, short};
use plot::escaped;
use series::{Palette, Series, legend};

/// The page.
pub fn html(evaluation: &Evaluation) -> String {
    let palette = Palette::of(evaluation);
    let groups = groups(&evaluation.rows);
    let mut body = String::new();
    let goals = goals(evaluation);
    if !goals.is_empty() {
        body += "<section><h2>Goals</h2><ul class=\"goals\">";
        for goal in goals.lines() {
            let goal = goal.trim_start_matches("goal ");
            let class = if goal.starts_with("reached") { "reached" } else { "missed" };
            let _ = write!(body, "<li class=\"{class}\">{}</li>", escaped(goal));
        }
        body += "</ul></section>\n";
    }
    if groups.len() > 1 {
        body += "<nav><ul>";
        for (number, (group, _)) in groups.iter().enumerate() {
            let _ = write!(body, "<li><a href=\"#g{number}\">{}</a></li>", escaped(group));
        }
        body += "</ul></nav>\n";
    }
    for (number, (group, rows)) in groups.iter().enumerate() {
        let _ = writeln!(body, "<section id=\"g{number}\"><h2>{}</h2>", escaped(group));
        body += &section(evaluation, &palette, group, rows);
        body += "</section>\n";
    }
    let words = |of: &std::collections::BTreeMap<&'static str, f64>| {
        of.iter().map(|(name, value)| format!("{name} {}", short(*value))).collect::<Vec<_>>().join(", ")
    };
    let (schema, version) = (escaped(evaluation.schema), escaped(evaluation.version));
    let trials: usize = evaluation.rows.iter().map(|row| row.trials).sum();
    let left_out: String = evaluation
        .left_out
        .iter()
        .map(|out| {
            format!(
                "<p>Left out: {} recordings of {}: {}.</p>\n",
                out.recordings,
                escaped(&out.file),
                out.because
            )
        })
        .collect();
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width\">\n<title>CoVR: evaluation</title>\n\
         <style>{STYLE}</style>\n</head>\n<body>\n<header><h1>There before the hand</h1>\n\
         <p>{trials} replays of recorded reaches: {:.0} s of people in {:.1} s.</p>\n\
         <p>A reach is served when the column's centre is within 10 cm of the goal's place at the reach, and was slower \
         than 0.05 m/s for the 0.2 s before. Intervals are Wilson's, at 95 %.</p></header>\n{body}\
         <footer>{left_out}<p>Limits: {}.</p><p>Conditions: {}.</p><p>{schema}, CoVR {version}.</p></footer>\n</body>\n</html>\n",
        evaluation.simulated_secs,
        evaluation.wall_secs,
        escaped(&words(&evaluation.limits)),
        escaped(&words(&evaluation.conditions)),
    )
}

fn section(evaluation: &Evaluation, palette: &Palette, group: &str, rows: &[&Row]) -> String {
    let (swept, plain): (Vec<&Row>, Vec<&Row>) = rows.iter().partition(|row| row.value.is_some());
    let mut text = String::new();
    let as_lines = lines(&plain, palette);
    let in_pool = |row: &&Row| row.value.is_none() && group_of(row) == group;
    let pooled: Vec<_> =
        evaluation.pooled.iter().filter(in_pool).map(|row| (row, palette.series(row))).collect();
    if pooled.len() > 1 {
        text += &bars::served(&pooled);
    }
    if !as_lines.is_empty() {
        text += &legend(&as_lines.iter().map(|(series, _)| series.clone()).collect::<Vec<_>>());
        text += "<div class=\"plots\">";
        text += &plots(&as_lines);
        text += "</div>\n";
    }
    let mut sweeps = String::new();
    let mut named: Vec<Series> = Vec::new();
    for (series, rows) in lines(&swept, palette) {
        let Some(parameter) = rows.first().and_then(|row| row.parameter) else { continue };
        let plot = by_value(parameter, &series.name, &rows);
        let of_lines =
            plot.lines.iter().map(|line| Series { name: line.name.clone(), style: line.style.clone() });
        // Every rule is swept over the same numbers of objects.
        named = of_lines.collect();
        sweeps += &plot.svg();
    }
    if !sweeps.is_empty() {
        text += &legend(&named);
        let _ = writeln!(text, "<div class=\"plots\">{sweeps}</div>");
    }
    let blamed: Vec<_> = pooled.into_iter().filter(|(row, _)| !row.blame.is_empty()).collect();
    if !blamed.is_empty() {
        text += &bars::failures(&blamed);
    }
    text + &table(rows)
}

fn plots(lines: &Lines<'_>) -> String {
    let mut text = by_objects(lines).svg();
    let stood = ["The column stood in place from then on", "share of all reaches"];
    text += &before_reach(lines, stood, false, |row| &row.in_place, |share| share).svg();
    let best = ["The goal was the most probable object", "share, more than one object"];
    let probability = ["Probability of the goal", "geometric mean, more than one object"];
    for plot in [
        before_reach(lines, best, true, |row| &row.top1, |share| share),
        before_reach(lines, probability, true, |row| &row.log_loss, |loss| (-loss).exp()),
        reliability(lines),
    ] {
        if !plot.lines.is_empty() {
            text += &plot.svg();
        }
    }
    text
}

/// Rows of one file, task, prior, draw and v_h belong together; in the order of the table.
fn groups(rows: &[Row]) -> Vec<(String, Vec<&Row>)> {
    let mut groups: Vec<(String, Vec<&Row>)> = Vec::new();
    for row in rows {
        let name = group_of(row);
        match groups.iter_mut().find(|(known, _)| *known == name) {
            Some((_, members)) => members.push(row),
            None => groups.push((name, vec![row])),
        }
    }
    groups
}

fn group_of(row: &Row) -> String {
    let Row { file, task, prior, draw, separation, v_h_mps, .. } = row;
    format!("{file}, task {task} · prior {prior} · draw {draw} · separation {separation} · v_h {v_h_mps} m/s")
}

fn table(rows: &[&Row]) -> String {
    let mut text = String::from("<details><summary>Figures</summary><div class=\"wide\"><table>\n<tr>");
    let heads = [
        "rule",
        "motion",
        "value",
        "objects",
        "trials",
        "served",
        "95 %",
        "within 10 cm",
        "at the reach, cm",
        "in place, s",
        "detected, s",
        "calibration error",
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
            row.value.map_or_else(String::new, |value| format!("{value:.3}")),
            count_words(row.objects),
            row.trials.to_string(),
            percent(row.success),
            format!("{} to {}", percent(row.ci95[0]), percent(row.ci95[1])),
            percent(row.within_10cm),
            format!("{:.2}", 100.0 * row.distance_at_reach_m),
            format!("{:.2}", row.in_place_before_reach_s),
            format!("{:.2}", row.detection_s),
            row.calibration_error.map_or_else(String::new, |error| format!("{error:.3}")),
            row.violations.to_string(),
            row.stops.to_string(),
        ];
        text += "<tr>";
        cells.iter().for_each(|cell| _ = write!(text, "<td>{}</td>", escaped(cell)));
        text += "</tr>\n";
    }
    text + "</table></div></details>\n"
}

/// How the page looks.
const STYLE: &str = include_str!("report/page.css");

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

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
            offset_offered: BTreeMap::new(),
            success_with_offset: BTreeMap::new(),
            saved_by_offset: BTreeMap::new(),
            distance_without_offset_m: BTreeMap::new(),
            distance_with_offset_m: BTreeMap::new(),
            not_excluded: None,
            parameter: None,
            value: None,
        }
    }

    fn page_of(rows: Vec<Row>, pooled: Vec<Row>) -> String {
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
            pooled,
        })
    }

    fn page() -> String {
        page_of(vec![row("paper", 2, 0.5), row("paper", 0, 0.25), row("told", 2, 1.0)], Vec::new())
    }

    #[test]
    fn the_page_stands_alone_and_escapes_what_it_quotes() {
        let page = page();
        for outside in ["<script", "http:", "https:", "src=", "url(", "@import"] {
            assert!(!page.contains(outside), "{outside}");
        }
        assert!(page.contains("a&lt;b, task fixed") && !page.contains("a<b"));
        // Four plots over rules (a single bin is no line), and two swatches.
        assert_eq!(page.matches("<figure>").count(), 4);
        assert_eq!(page.matches("<svg").count(), 4 + 2);
        assert_eq!(page.matches("<svg").count(), page.matches("</svg>").count());
        assert!(page.contains("25.0 %") && page.contains("paper · proxy, the default"), "{page}");
        assert_eq!(page.matches("<tr>").count(), 4);
    }

    #[test]
    fn failures_are_drawn_by_their_cause_and_success_with_its_interval() {
        let blame = [("prediction", 3), ("route", 2)].into();
        let pool = |rule, success| Row { blame, successes: 5, ..row(rule, 0, success) };
        let page = page_of(vec![row("paper", 2, 0.5)], vec![pool("paper", 0.5)]);
        assert!(page.contains("<title>prediction: 3 of 10 reaches</title>"), "{page}");
        assert!(page.contains("<title>route: 2 of 10 reaches</title>") && page.contains("50.0 % of 10"));
        // One rule needs no comparison.
        assert!(!page.contains("up to five together"));
        let two = page_of(vec![row("paper", 2, 0.5)], vec![row("paper", 0, 0.5), row("told", 0, 0.9)]);
        let (told, paper) =
            (two.find(">told · proxy<").unwrap(), two.find(">paper · proxy, the default<").unwrap());
        assert!(told < paper, "the best comes first");
    }

    #[test]
    fn a_sweep_is_a_plot_of_its_own_and_in_no_other() {
        let at = |value, objects, success, successes| Row {
            parameter: Some("paper.distance_share"),
            value: Some(value),
            successes,
            ..row("paper", objects, success)
        };
        let rows = vec![at(0.0, 1, 0.9, 9), at(0.0, 2, 0.5, 5), at(1.0, 1, 0.8, 8), at(1.0, 2, 0.3, 3)];
        let page = page_of(rows, Vec::new());
        assert_eq!(page.matches("<figure>").count(), 1);
        assert!(
            page.contains("Reaches served: paper · proxy") && page.contains(">paper.distance_share<"),
            "{page}"
        );
        // Of both numbers of objects together: 14 and 11 of 20.
        assert!(
            page.contains("all of these together: 70.0 %") && page.contains("all of these together: 55.0 %")
        );
    }

    #[test]
    fn the_probability_is_the_one_whose_logarithm_was_lost() {
        let evaluation_rows = [row("paper", 2, 0.5), row("paper", 1, 0.5)];
        let of = |rows: &[&Row], figure: fn(&Row) -> &BTreeMap<String, f64>, guessed| {
            let lines = lines(rows, &Palette::of_rows(rows));
            before_reach(&lines, ["t", "u"], guessed, figure, |loss| (-loss).exp())
        };
        let plot = of(&[&evaluation_rows[0]], |row| &row.log_loss, true);
        let points: Vec<_> = plot.lines[0].points.iter().map(|p| (p.x, p.y)).collect();
        assert_eq!(points, [(-1.0, 0.5), (-0.0, 1.0)]);
        // With the goal alone nothing was predicted, but the column stood there all the same.
        assert!(of(&[&evaluation_rows[1]], |row| &row.top1, true).lines.is_empty());
        assert_eq!(of(&[&evaluation_rows[1]], |row| &row.in_place, false).lines.len(), 1);
    }
}
