//! How a rule and motion look, the same all over the page.

use std::fmt::Write;

use super::plot::escaped;
use crate::evaluate::{Evaluation, Row};

/// The rules of an evaluation, in the order of its table.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Palette {
    rules: Vec<&'static str>,
}

/// A rule and motion.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Series {
    pub name: String,
    /// Of a stroke.
    pub style: String,
}

impl Palette {
    pub fn of(evaluation: &Evaluation) -> Self {
        Self::of_rows(&evaluation.rows.iter().collect::<Vec<_>>())
    }

    pub fn of_rows(rows: &[&Row]) -> Self {
        let mut rules = Vec::new();
        for row in rows {
            if !row.default && !KNOWING.contains(&row.rule) && !rules.contains(&row.rule) {
                rules.push(row.rule);
            }
        }
        Self { rules }
    }

    /// Rules that are run have a colour each, the server's default the thickest line, and what knows the goal that of
    /// the text; the paper's motion is dashed.
    pub fn series(&self, row: &Row) -> Series {
        let place = self.rules.iter().position(|rule| *rule == row.rule);
        let colour = match place {
            _ if KNOWING.contains(&row.rule) => "var(--ink)".to_owned(),
            Some(place) if !row.default => format!("var(--l{})", place % COLOURS),
            _ => "var(--own)".to_owned(),
        };
        let width = if row.default { 3.2 } else { 1.7 };
        let dashes = match row.motion {
            "proxy" => ";stroke-dasharray:5 3",
            "any" => ";stroke-dasharray:1.5 3",
            _ => "",
        };
        let mark = if row.default { ", the default" } else { "" };
        let name = format!("{} · {}{mark}", row.rule, row.motion);
        Series { name, style: format!("stroke:{colour};stroke-width:{width}{dashes}") }
    }
}

/// The lines that are drawn, named once for all plots beside each other.
pub(super) fn legend(series: &[Series]) -> String {
    let mut text = String::from("<ul class=\"legend\">");
    for Series { name, style } in series {
        let _ = write!(
            text,
            "<li><svg viewBox=\"0 0 30 10\" aria-hidden=\"true\"><line x1=\"1\" x2=\"29\" y1=\"5\" y2=\"5\" style=\"{style}\"/></svg>{}</li>",
            escaped(name)
        );
    }
    text + "</ul>\n"
}

/// What knows the goal beforehand.
const KNOWING: [&str; 2] = ["told", "bound"];
/// As many as the page's style names.
const COLOURS: usize = 8;
