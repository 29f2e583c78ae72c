//! One trial in words and as a picture: what the rule believed, where the column was, and why it was late if it was.

use std::fmt::Write;

use covr_engine::frames::{Floor, Planar};
use covr_engine::motion::travel_secs;
use covr_engine::time::Time;

use super::blame;
use super::course::{Course, pace};
use super::plan::{Objects, Plan, RuleChoice};
use super::run::{EvaluationProblem, cells};
use super::subjects::{Subjects, task, travel};
use crate::replay::{TrialOutcome, Walk};

/// A trial explained.
#[derive(Debug, Clone, PartialEq)]
pub struct Explanation {
    /// In words, a line for each thing said.
    pub words: String,
    /// As a picture: an SVG document.
    pub svg: String,
}

/// Replay one trial with the first combination of the plan.
pub fn explain(subjects: &Subjects, plan: &Plan, trial: &str) -> Result<Explanation, EvaluationProblem> {
    let no_trial =
        || EvaluationProblem::NoTrial { trial: trial.to_owned(), like: subjects.trial_like(trial) };
    let reach = subjects.reaches.iter().find(|reach| reach.recording.trial == trial).ok_or_else(no_trial)?;
    let cell = *cells(plan).first().ok_or(EvaluationProblem::Nothing)?;
    if cell.rule == RuleChoice::Bound {
        let (found, expected) =
            ("a trial to explain", "`covr evaluate`: no engine runs that could be watched");
        return Err(EvaluationProblem::Bound { found, expected });
    }
    let walk = Walk::of_reach(&reach.recording, &pace(plan, &plan.conditions, &reach.recording))?;
    let course = Course::of(plan, cell, reach, &walk);
    let mut seen = Vec::new();
    let outcome = course.replayed_before(&mut |glimpse| {
        seen.push(Seen {
            at: glimpse.at,
            head: glimpse.head.position.floor(),
            column: glimpse.stepped.truth.position,
            speed_mps: glimpse.stepped.truth.velocity.norm(),
        });
    })?;
    let judged = blame::judged(&course, outcome)?;
    let picture = Picture { course: &course, seen: &seen, outcome: &judged.outcome };
    let cause = judged.cause.map(|cause| cause.words());
    Ok(Explanation { words: picture.words(cause), svg: picture.svg() })
}

/// One moment.
#[derive(Debug, Clone, Copy)]
struct Seen {
    at: Time,
    head: Floor,
    column: Floor,
    speed_mps: f64,
}

struct Picture<'a> {
    course: &'a Course<'a>,
    seen: &'a [Seen],
    outcome: &'a TrialOutcome,
}

impl Picture<'_> {
    fn words(&self, cause: Option<&str>) -> String {
        let Course { cell, reach, walk, .. } = self.course;
        let recording = &reach.recording;
        let goal = &recording.targets[reach.goal];
        let place = self.goal_place();
        let shown = match cell.objects {
            Objects::Count(1) => "alone".to_owned(),
            Objects::Count(count) => format!("among {count} objects"),
            Objects::All => format!("among all {} objects", recording.targets.len()),
        };
        let name =
            if goal.label.is_empty() { goal.id.clone() } else { format!("{} ({})", goal.label, goal.id) };
        let mut words = format!(
            "Trial {}: person {}, task {}, goal {name} {shown}.\nRule {}, motion {}, separation {}, prior {}, draw {}.\n",
            recording.trial,
            recording.user,
            task(recording),
            cell.rule.name(),
            cell.motion.name(),
            cell.separation.name(),
            cell.prior.name(),
            cell.draw.name(),
        );
        let _ = writeln!(
            words,
            "The hand arrived {:.2} s after the replay began.",
            (walk.ends() - walk.begins()).secs()
        );
        if let Some(first) = self.seen.first() {
            let _ = writeln!(
                words,
                "The column began {:.2} m from the goal's place, {:.2} s away with nobody in the way.",
                first.column.distance_m(place),
                travel_secs(first.column, place, &self.course.limits),
            );
        }
        if let Some(moved) = self.seen.iter().find(|seen| seen.speed_mps > MOVES_MPS) {
            let _ = writeln!(
                words,
                "It first moved {:.2} s before the hand arrived.",
                self.before_reach_secs(moved.at)
            );
        }
        match self.outcome.belief.detected_before_reach_secs {
            Some(secs) => {
                let then =
                    self.seen.iter().find(|seen| self.before_reach_secs(seen.at) <= secs + HALF_A_MILLI);
                let needed = then.map_or(0.0, |seen| travel_secs(seen.column, place, &self.course.limits));
                let _ = writeln!(
                    words,
                    "The rule believed in the goal for good from {secs:.2} s before; from there the column needed {needed:.2} s."
                );
            }
            None => words += "The rule did not believe in the goal when the hand arrived.\n",
        }
        let TrialOutcome { distance_at_reach_m, in_place_before_reach_secs, stops, .. } = *self.outcome;
        let speed_mps = self.seen.last().map_or(0.0, |seen| seen.speed_mps);
        let _ = if self.outcome.success {
            writeln!(
                words,
                "It was in place {in_place_before_reach_secs:.2} s before the hand, {:.1} cm off.",
                100.0 * distance_at_reach_m
            )
        } else {
            writeln!(
                words,
                "When the hand arrived it was {:.2} m from the goal's place at {speed_mps:.2} m/s: late.",
                distance_at_reach_m
            )
        };
        if stops > 0 {
            let _ = writeln!(words, "The machine stopped {stops} times on the way.");
        }
        let verdicts = [&self.outcome.true_verdict, &self.outcome.commanded_verdict];
        let violations: u64 = verdicts.iter().map(|verdict| verdict.violations()).sum();
        let _ = writeln!(words, "The checker found {violations} violations.");
        if let Some(cause) = cause {
            let _ = writeln!(words, "Cause: {cause}.");
        }
        words
    }

    /// The floor from above: y up, a metre is [`SCALE`] units.
    fn svg(&self) -> String {
        let travel = travel(&self.course.reach.recording);
        let size = travel.max - travel.min;
        let (width, height) = (size.x * SCALE + 2.0 * RIM, size.y * SCALE + 2.0 * RIM);
        let at =
            |place: Floor| (RIM + (place.x - travel.min.x) * SCALE, RIM + (travel.max.y - place.y) * SCALE);
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" font-family=\"sans-serif\" font-size=\"10\">\n\
             <rect width=\"{width:.0}\" height=\"{height:.0}\" fill=\"white\"/>\n\
             <rect x=\"{RIM}\" y=\"{RIM}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"none\" stroke=\"#999\"/>\n",
            size.x * SCALE,
            size.y * SCALE,
        );
        let recording = &self.course.reach.recording;
        for index in self.course.targets() {
            let target = &recording.targets[index];
            let (x, y) = at(recording.room_from_trace().point(&target.position).floor());
            let colour = if index == self.course.reach.goal { "#0a7d32" } else { "#888" };
            let name = escaped(if target.label.is_empty() { &target.id } else { &target.label });
            let _ = writeln!(
                svg,
                "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{:.1}\" fill=\"{colour}\" fill-opacity=\"0.25\" stroke=\"{colour}\"/>\
                 <text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\" fill=\"{colour}\">{name}</text>",
                target.radius_m * SCALE,
                y + 4.0,
            );
        }
        let places: [fn(&Seen) -> Floor; 2] = [|seen| seen.head, |seen| seen.column];
        let paths = [("person", "#1f5fbf"), ("column", "#c2410c")].into_iter().zip(places);
        for ((name, colour), place) in paths {
            let points: Vec<String> = self
                .seen
                .iter()
                .step_by(DRAWN_EVERY)
                .chain(self.seen.last())
                .map(|seen| {
                    let (x, y) = at(place(seen));
                    format!("{x:.1},{y:.1}")
                })
                .collect();
            let _ = writeln!(
                svg,
                "<polyline class=\"{name}\" points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\"/>",
                points.join(" ")
            );
            for seen in self.whole_seconds() {
                let (x, y) = at(place(seen));
                let _ = writeln!(
                    svg,
                    "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.5\" fill=\"{colour}\"/><text x=\"{:.1}\" y=\"{:.1}\" fill=\"{colour}\">-{:.0} s</text>",
                    x + 4.0,
                    y - 3.0,
                    self.before_reach_secs(seen.at),
                );
            }
        }
        if let Some(last) = self.seen.last() {
            let half = Planar::new(FOOTPRINT_M / 2.0, -FOOTPRINT_M / 2.0);
            let (x, y) = at(last.column + half * -1.0);
            let side = FOOTPRINT_M * SCALE;
            let _ = writeln!(
                svg,
                "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{side:.1}\" height=\"{side:.1}\" fill=\"none\" stroke=\"#c2410c\" stroke-width=\"2\"/>"
            );
            if !self.outcome.success {
                let ((x1, y1), (x2, y2)) = (at(last.column), at(self.goal_place()));
                let _ = writeln!(
                    svg,
                    "<line class=\"late\" x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\" stroke=\"#dc2626\" stroke-dasharray=\"5 4\" stroke-width=\"2\"/>\
                     <text x=\"{:.1}\" y=\"{:.1}\" fill=\"#dc2626\">{:.2} m late</text>",
                    0.5 * (x1 + x2) + 4.0,
                    0.5 * (y1 + y2),
                    self.outcome.distance_at_reach_m,
                );
            }
        }
        let title = escaped(&format!(
            "{}: person blue, column orange, goal green; seconds before the hand arrived",
            recording.trial
        ));
        let _ = writeln!(svg, "<text x=\"{RIM}\" y=\"{:.1}\">{title}</text>\n</svg>", height - 8.0);
        svg
    }

    fn goal_place(&self) -> Floor {
        let recording = &self.course.reach.recording;
        recording.room_from_trace().point(&recording.targets[self.course.reach.goal].position).floor()
    }

    fn before_reach_secs(&self, at: Time) -> f64 {
        (self.course.walk.ends() - at).secs()
    }

    /// The first moment of each whole second before the reach, the last included.
    fn whole_seconds(&self) -> impl Iterator<Item = &Seen> {
        let mut left = f64::INFINITY;
        self.seen.iter().filter(move |seen| {
            let now = self.before_reach_secs(seen.at).floor();
            let is_next = now < left && left.is_finite();
            left = now;
            is_next
        })
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// SVG units a metre.
const SCALE: f64 = 120.0;
/// White about the arena, SVG units.
const RIM: f64 = 24.0;
/// Not every step is a point of a line.
const DRAWN_EVERY: usize = 5;
/// The side of the column, m.
const FOOTPRINT_M: f64 = 0.15;
/// Faster than this the column has set out, m/s.
const MOVES_MPS: f64 = 0.02;
/// Times are compared no more finely, s.
const HALF_A_MILLI: f64 = 5e-4;
