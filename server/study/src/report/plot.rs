//! Shares over a row of marks, as SVG.

use std::fmt::Write;

/// One plot.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Plot {
    pub title: String,
    /// What is marked along the axis.
    pub across: String,
    /// What the height is, in a few words.
    pub up: String,
    /// Places along the axis, rising, and what is written there.
    pub ticks: Vec<(f64, String)>,
    /// A line from corner to corner, where height and place are the same.
    pub diagonal: bool,
    pub lines: Vec<Line>,
}

/// One line.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Line {
    pub name: String,
    /// Of its stroke.
    pub style: String,
    pub points: Vec<Point>,
}

/// A point, the interval about it, and how large it is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Point {
    pub x: f64,
    pub y: f64,
    pub bar: Option<[f64; 2]>,
    pub radius: f64,
}

impl Point {
    pub fn at(x: f64, y: f64) -> Self {
        Self { x, y, bar: None, radius: 2.2 }
    }
}

impl Plot {
    pub fn svg(&self) -> String {
        let title = escaped(&self.title);
        let mut svg = format!(
            "<figure><figcaption>{title}</figcaption><svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"{title}\">\
             <text x=\"{LEFT}\" y=\"11\" class=\"unit\">{}</text>\n",
            escaped(&self.up)
        );
        let floor = self.floor();
        let step = if floor >= 60 { 10 } else { 20 };
        for percent in (floor..=100).step_by(step) {
            let y = y_of(percent as f64 / 100.0, floor);
            let _ = writeln!(
                svg,
                "<line class=\"grid\" x1=\"{LEFT}\" x2=\"{RIGHT}\" y1=\"{y:.1}\" y2=\"{y:.1}\"/>\
                 <text x=\"{:.0}\" y=\"{:.1}\" text-anchor=\"end\">{percent} %</text>",
                LEFT - 6.0,
                y + 4.0
            );
        }
        for (at, name) in &self.ticks {
            let (x, y) = (self.x_of(*at), BOTTOM + 17.0);
            let _ = writeln!(
                svg,
                "<line class=\"axis\" x1=\"{x:.1}\" x2=\"{x:.1}\" y1=\"{BOTTOM}\" y2=\"{:.1}\"/>\
                 <text x=\"{x:.1}\" y=\"{y}\" text-anchor=\"middle\">{}</text>",
                BOTTOM + 4.0,
                escaped(name)
            );
        }
        let _ = writeln!(
            svg,
            "<line class=\"axis\" x1=\"{LEFT}\" x2=\"{RIGHT}\" y1=\"{BOTTOM}\" y2=\"{BOTTOM}\"/>\
             <text x=\"{:.0}\" y=\"{}\" text-anchor=\"middle\" class=\"unit\">{}</text>",
            0.5 * (LEFT + RIGHT),
            BOTTOM + 33.0,
            escaped(&self.across)
        );
        if let (true, Some((first, _)), Some((last, _))) =
            (self.diagonal, self.ticks.first(), self.ticks.last())
        {
            let (x1, x2) = (self.x_of(*first), self.x_of(*last));
            let (y1, y2) = (y_of(*first, floor), y_of(*last, floor));
            let _ = writeln!(
                svg,
                "<line class=\"even\" x1=\"{x1:.1}\" x2=\"{x2:.1}\" y1=\"{y1:.1}\" y2=\"{y2:.1}\"/>"
            );
        }
        for (number, line) in self.lines.iter().enumerate() {
            self.draw(&mut svg, floor, number, line);
        }
        svg + "</svg></figure>\n"
    }

    fn draw(&self, svg: &mut String, floor: usize, number: usize, line: &Line) {
        let style = &line.style;
        // Beside each other, so that intervals of neighbours can be told apart.
        let aside = 3.0 * number as f64 - 1.5 * (self.lines.len() as f64 - 1.0);
        for (point, [low, high]) in line.points.iter().filter_map(|point| Some((point, point.bar?))) {
            let (x, low, high) = (self.x_of(point.x) + aside, y_of(low, floor), y_of(high, floor));
            let _ = writeln!(
                svg,
                "<line class=\"bar\" style=\"{style}\" x1=\"{x:.1}\" x2=\"{x:.1}\" y1=\"{low:.1}\" y2=\"{high:.1}\"/>"
            );
        }
        let place = |point: &Point| {
            let aside = if point.bar.is_some() { aside } else { 0.0 };
            (self.x_of(point.x) + aside, y_of(point.y, floor))
        };
        let points: Vec<String> = line
            .points
            .iter()
            .map(|point| {
                let (x, y) = place(point);
                format!("{x:.1},{y:.1}")
            })
            .collect();
        let _ = writeln!(svg, "<polyline class=\"line\" style=\"{style}\" points=\"{}\"/>", points.join(" "));
        for point in &line.points {
            let ((x, y), radius) = (place(point), point.radius);
            let told = match point.bar {
                Some([low, high]) => format!(" ({:.1} to {:.1})", 100.0 * low, 100.0 * high),
                None => String::new(),
            };
            let _ = writeln!(
                svg,
                "<circle class=\"dot\" style=\"{style}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius:.1}\"><title>{}: {:.1} %{told}</title></circle>",
                escaped(&line.name),
                100.0 * point.y
            );
        }
    }

    /// Where the height begins, %: what is drawn fills the plot.
    fn floor(&self) -> usize {
        let lows = self.lines.iter().flat_map(|line| &line.points);
        let least =
            lows.map(|point| point.bar.map_or(point.y, |bar| bar[0].min(point.y))).fold(1.0, f64::min);
        let least = if self.diagonal {
            self.ticks.first().map_or(least, |(first, _)| least.min(*first))
        } else {
            least
        };
        ((5.0 * least).floor().clamp(0.0, 4.0) * 20.0) as usize
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

/// `floor`: %, at the bottom.
fn y_of(share: f64, floor: usize) -> f64 {
    let floor = floor as f64 / 100.0;
    BOTTOM - (share.clamp(floor, 1.0) - floor) / (1.0 - floor) * (BOTTOM - TOP)
}

const WIDTH: f64 = 400.0;
const HEIGHT: f64 = 270.0;
const LEFT: f64 = 46.0;
const RIGHT: f64 = 392.0;
const TOP: f64 = 24.0;
const BOTTOM: f64 = 228.0;
/// From the frame to the first and last mark.
const INDENT: f64 = 24.0;

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(points: Vec<Point>) -> Plot {
        let line = Line { name: "a & b".into(), style: "stroke:red".into(), points };
        let ticks = vec![(0.0, "1".into()), (2.0, "all".into())];
        Plot {
            title: "t".into(),
            across: "x".into(),
            up: "y".into(),
            ticks,
            diagonal: false,
            lines: vec![line],
        }
    }

    #[test]
    fn points_lie_where_their_values_say() {
        let svg = plot(vec![Point::at(0.0, 0.0), Point::at(2.0, 1.0)]).svg();
        assert!(svg.contains("points=\"70.0,228.0 368.0,24.0\""), "{svg}");
        assert!(svg.contains("a &amp; b: 100.0 %"));
    }

    #[test]
    fn what_is_drawn_fills_the_plot_and_intervals_are_in_it() {
        let high = plot(vec![Point::at(0.0, 0.85), Point::at(2.0, 1.0)]);
        assert_eq!(high.floor(), 80);
        assert!(high.svg().contains("points=\"70.0,177.0 368.0,24.0\""), "{}", high.svg());
        let wide = plot(vec![Point { bar: Some([0.55, 0.9]), ..Point::at(0.0, 0.85) }]);
        assert_eq!(wide.floor(), 40);
        assert_eq!(Plot { diagonal: true, ..high }.floor(), 0);
    }
}
