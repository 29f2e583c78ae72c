//! Shares from 0 to 1 over a row of marks, as SVG.

use std::fmt::Write;

/// One plot.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Plot {
    pub title: String,
    /// What is marked along the axis.
    pub across: String,
    /// Places along the axis, rising, and what is written there.
    pub ticks: Vec<(f64, String)>,
    pub lines: Vec<Line>,
}

/// One line.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Line {
    pub name: String,
    pub points: Vec<Point>,
}

/// A point, and the interval about it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Point {
    pub x: f64,
    pub y: f64,
    pub bar: Option<[f64; 2]>,
}

impl Plot {
    /// The plot with its legend below.
    pub fn svg(&self) -> String {
        let height = BOTTOM + 46.0 + 15.0 * self.lines.len() as f64;
        let title = escaped(&self.title);
        let mut svg = format!(
            "<figure><svg viewBox=\"0 0 {WIDTH} {height}\" role=\"img\" aria-label=\"{title}\">\
             <text x=\"{LEFT}\" y=\"16\" font-weight=\"600\">{title}</text>\n"
        );
        for percent in [0, 20, 40, 60, 80, 100] {
            let y = y_of(f64::from(percent) / 100.0);
            let _ = writeln!(
                svg,
                "<line class=\"grid\" x1=\"{LEFT}\" x2=\"{RIGHT}\" y1=\"{y:.1}\" y2=\"{y:.1}\"/>\
                 <text x=\"{:.0}\" y=\"{:.1}\" text-anchor=\"end\">{percent} %</text>",
                LEFT - 5.0,
                y + 4.0
            );
        }
        for (at, name) in &self.ticks {
            let (x, y) = (self.x_of(*at), BOTTOM + 15.0);
            let _ =
                writeln!(svg, "<text x=\"{x:.1}\" y=\"{y}\" text-anchor=\"middle\">{}</text>", escaped(name));
        }
        let _ = writeln!(
            svg,
            "<line class=\"axis\" x1=\"{LEFT}\" x2=\"{RIGHT}\" y1=\"{BOTTOM}\" y2=\"{BOTTOM}\"/>\
             <text x=\"{:.0}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
            0.5 * (LEFT + RIGHT),
            BOTTOM + 30.0,
            escaped(&self.across)
        );
        for (number, line) in self.lines.iter().enumerate() {
            self.draw(&mut svg, number, line);
        }
        svg + "</svg></figure>\n"
    }

    fn draw(&self, svg: &mut String, number: usize, line: &Line) {
        let style = format!(
            "style=\"stroke:var(--l{})\" stroke-dasharray=\"{}\"",
            number % COLOURS,
            DASHES[number / COLOURS % DASHES.len()]
        );
        let points: Vec<String> =
            line.points.iter().map(|p| format!("{:.1},{:.1}", self.x_of(p.x), y_of(p.y))).collect();
        let _ = writeln!(svg, "<polyline class=\"line\" {style} points=\"{}\"/>", points.join(" "));
        for point in &line.points {
            // Beside each other, so that intervals of neighbours can be told apart.
            let x = self.x_of(point.x) + 2.0 * number as f64 - (self.lines.len() as f64 - 1.0);
            if let Some([low, high]) = point.bar {
                let (low, high) = (y_of(low), y_of(high));
                let _ = writeln!(
                    svg,
                    "<line {style} x1=\"{x:.1}\" x2=\"{x:.1}\" y1=\"{low:.1}\" y2=\"{high:.1}\"/>"
                );
            }
        }
        let y = BOTTOM + 48.0 + 15.0 * number as f64;
        let _ = writeln!(
            svg,
            "<line class=\"line\" {style} x1=\"{LEFT}\" x2=\"{:.0}\" y1=\"{:.1}\" y2=\"{:.1}\"/><text x=\"{:.0}\" y=\"{y:.1}\">{}</text>",
            LEFT + 26.0,
            y - 4.0,
            y - 4.0,
            LEFT + 32.0,
            escaped(&line.name)
        );
    }

    fn x_of(&self, at: f64) -> f64 {
        let (first, last) = match (self.ticks.first(), self.ticks.last()) {
            (Some((first, _)), Some((last, _))) if last > first => (*first, *last),
            _ => return 0.5 * (LEFT + RIGHT),
        };
        LEFT + INDENT + (at - first) / (last - first) * (RIGHT - LEFT - 2.0 * INDENT)
    }
}

/// Text inside an element or an attribute.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

fn y_of(share: f64) -> f64 {
    BOTTOM - share.clamp(0.0, 1.0) * (BOTTOM - TOP)
}

const WIDTH: f64 = 400.0;
const LEFT: f64 = 44.0;
const RIGHT: f64 = 390.0;
const TOP: f64 = 30.0;
const BOTTOM: f64 = 230.0;
/// From the frame to the first and last mark.
const INDENT: f64 = 16.0;
/// As many as the page's style names.
const COLOURS: usize = 8;
/// For the lines beyond.
const DASHES: [&str; 3] = ["none", "6 3", "2 3"];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_lie_where_their_values_say() {
        let point = |x, y| Point { x, y, bar: None };
        let line = Line { name: "a & b".into(), points: vec![point(0.0, 0.0), point(2.0, 1.0)] };
        let ticks = vec![(0.0, "1".into()), (2.0, "all".into())];
        let plot = Plot { title: "t".into(), across: "x".into(), ticks, lines: vec![line] };
        let svg = plot.svg();
        assert!(svg.contains("points=\"60.0,230.0 374.0,30.0\""), "{svg}");
        assert!(svg.contains("a &amp; b"));
    }
}
