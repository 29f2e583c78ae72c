//! A recording at another rate: straight lines between frames, angles the short way round, and nothing across a gap.

use covr_engine::frames::{Point, Pose, RigidMap, Room};
use covr_engine::observation::Hands;
use covr_engine::time::{Span, Time};
use nalgebra::UnitQuaternion;

use super::{Frame, HEAD_HEIGHT_M, Recording, Trace};

/// The head at a moment of the new rate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeadSample {
    /// When, from the start of the recording.
    pub at: Time,
    /// Where the head was and where it looked. Without heights it is at [`HEAD_HEIGHT_M`]; without a view axis it
    /// looks where the walk goes.
    pub pose: Pose<Trace>,
    /// The left and the right hand, each where it was tracked before and after.
    pub hands: [Option<Point<Trace>>; 2],
}

impl HeadSample {
    /// The hands in the room.
    pub fn hands_in(&self, room_from_trace: &RigidMap<Trace, Room>) -> Hands {
        let [left, right] = self.hands.map(|hand| hand.map(|hand| room_from_trace.point(&hand)));
        Hands { left, right }
    }
}

/// The samples of a recording, in order of time.
#[derive(Debug, Clone)]
pub struct Resampled<'a> {
    frames: &'a [Frame],
    hz: f64,
    from: Time,
    to: Time,
    tick: u64,
    after: usize,
    course_rad: f64,
    course_from: [f64; 2],
}

impl Recording {
    /// The whole recording at `hz`, from its first frame.
    pub fn resampled(&self, hz: f64) -> Resampled<'_> {
        let first = self.frames.first().map_or(Time::ZERO, |frame| frame.at);
        let last = self.frames.last().map_or(Time::ZERO, |frame| frame.at);
        self.resampled_between(hz, first, last)
    }

    /// The recording at `hz` from `from` to `to` inclusive; the first sample is at `from` if there are frames about it.
    pub fn resampled_between(&self, hz: f64, from: Time, to: Time) -> Resampled<'_> {
        let start = self.frames.first().map_or([0.0, 0.0], |frame| [frame.x_m, frame.y_m]);
        Resampled {
            frames: &self.frames,
            hz,
            from,
            to,
            tick: 0,
            after: 0,
            course_rad: 0.0,
            course_from: start,
        }
    }
}

impl Iterator for Resampled<'_> {
    type Item = HeadSample;

    fn next(&mut self) -> Option<HeadSample> {
        loop {
            let at = self.from + Span::from_secs(self.tick as f64 / self.hz);
            let last = self.frames.last()?;
            if at > self.to || at > last.at {
                return None;
            }
            self.tick += 1;
            while self.frames[self.after].at < at {
                self.follow(self.frames[self.after]);
                self.after += 1;
            }
            let after = self.frames[self.after];
            let before = if after.at == at { after } else { self.frames[self.after.saturating_sub(1)] };
            if before.at > at || after.at - before.at > MOST_GAP {
                continue;
            }
            return Some(self.between(before, after, at));
        }
    }
}

impl Resampled<'_> {
    /// Keep the heading of the walk: it turns only after a few centimetres, because standing people sway.
    fn follow(&mut self, frame: Frame) {
        let (dx, dy) = (frame.x_m - self.course_from[0], frame.y_m - self.course_from[1]);
        if dx.hypot(dy) >= COURSE_STEP_M {
            self.course_rad = dy.atan2(dx);
            self.course_from = [frame.x_m, frame.y_m];
        }
    }

    fn between(&self, before: Frame, after: Frame, at: Time) -> HeadSample {
        let gap = (after.at - before.at).secs();
        let share = if gap > 0.0 { (at - before.at).secs() / gap } else { 0.0 };
        let line = |a: f64, b: f64| a + (b - a) * share;
        let both = |a: Option<f64>, b: Option<f64>| a.zip(b);
        let z = both(before.z_m, after.z_m).map_or(HEAD_HEIGHT_M, |(a, b)| line(a, b));
        let yaw = both(before.yaw_rad, after.yaw_rad)
            .map_or(self.course_rad, |(a, b)| a + short_way_rad(b - a) * share);
        let pitch = both(before.pitch_rad, after.pitch_rad).map_or(0.0, |(a, b)| line(a, b));
        let pose = Pose {
            position: Point::new(line(before.x_m, after.x_m), line(before.y_m, after.y_m), z),
            orientation: UnitQuaternion::from_euler_angles(0.0, -pitch, yaw),
        };
        let hands = [0, 1].map(|hand| {
            let (a, b) = (before.hands[hand]?.vector(), after.hands[hand]?.vector());
            Some(Point::from_vector(a + (b - a) * share))
        });
        HeadSample { at, pose, hands }
    }
}

/// The same turn, between minus and plus half a turn.
fn short_way_rad(turn_rad: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    (turn_rad + PI).rem_euclid(TAU) - PI
}

/// Over this long without a frame nobody knows where the head was.
const MOST_GAP: Span = Span::from_millis(100);

/// The walk has a heading once it went this far, m.
const COURSE_STEP_M: f64 = 0.05;

#[cfg(test)]
mod tests {
    use super::super::Heights;
    use super::*;

    fn frame(millis: i64, x_m: f64, yaw_rad: f64) -> Frame {
        let at = Time::ZERO + Span::from_millis(millis);
        Frame {
            at,
            x_m,
            y_m: 0.0,
            z_m: Some(1.5),
            yaw_rad: Some(yaw_rad),
            pitch_rad: Some(0.5),
            hands: [None; 2],
        }
    }

    fn recording(frames: Vec<Frame>) -> Recording {
        Recording {
            dataset: "test".into(),
            trial: "t".into(),
            user: "u".into(),
            mode: None,
            arena: None,
            targets: Vec::new(),
            goal: None,
            events: Default::default(),
            visits: Vec::new(),
            heights: Heights::AboveFloor,
            frames,
        }
    }

    #[test]
    fn samples_lie_on_the_line_between_frames() {
        let recording = recording(vec![frame(0, 0.0, 0.0), frame(100, 1.0, 0.2)]);
        let samples: Vec<_> = recording.resampled(40.0).collect();
        assert_eq!(
            samples.iter().map(|s| s.at.micros()).collect::<Vec<_>>(),
            [0, 25_000, 50_000, 75_000, 100_000]
        );
        assert!((samples[1].pose.position.x() - 0.25).abs() < 1e-12);
        let view = samples[2].pose.view();
        assert!((view.y.atan2(view.x) - 0.1).abs() < 1e-12);
        assert!((view.z - 0.5_f64.sin()).abs() < 1e-12, "pitch up is positive");
    }

    #[test]
    fn nothing_is_invented_across_a_gap_of_more_than_a_tenth_of_a_second() {
        let recording = recording(vec![frame(0, 0.0, 0.0), frame(100, 1.0, 0.0), frame(201, 2.0, 0.0)]);
        let at: Vec<_> = recording.resampled(50.0).map(|s| s.at.micros() / 1000).collect();
        assert_eq!(at, [0, 20, 40, 60, 80, 100]);
        // A sample that falls on the frame after the gap needs no line.
        let at: Vec<_> = recording
            .resampled_between(1000.0, Time::from_micros(150_000), Time::from_micros(300_000))
            .map(|s| s.at.micros() / 1000)
            .collect();
        assert_eq!(at, [201]);
    }

    #[test]
    fn a_heading_turns_the_short_way_through_half_a_turn() {
        let recording = recording(vec![frame(0, 0.0, 3.1), frame(100, 0.0, -3.1)]);
        let middle = recording.resampled(20.0).nth(1).unwrap().pose.view();
        assert!(middle.x < -0.8 && middle.y.abs() < 1e-9, "{middle:?}");
    }

    #[test]
    fn samples_before_the_first_frame_do_not_exist() {
        let recording = recording(vec![frame(50, 0.0, 0.0), frame(100, 1.0, 0.0)]);
        let from_start: Vec<_> = recording
            .resampled_between(100.0, Time::ZERO, Time::from_micros(70_000))
            .map(|s| s.at.micros() / 1000)
            .collect();
        assert_eq!(from_start, [50, 60, 70]);
    }

    #[test]
    fn without_a_view_axis_the_head_looks_where_the_walk_goes() {
        let bare = |millis: i64, x_m: f64, y_m: f64| Frame {
            at: Time::ZERO + Span::from_millis(millis),
            x_m,
            y_m,
            z_m: None,
            yaw_rad: None,
            pitch_rad: None,
            hands: [None; 2],
        };
        let recording = recording(vec![
            bare(0, 0.0, 0.0),
            bare(50, 0.0, 0.06),
            bare(100, 0.01, 0.06),
            bare(150, -0.06, 0.06),
            bare(200, -0.12, 0.06),
        ]);
        let heads: Vec<_> = recording.resampled(20.0).collect();
        assert!((heads[2].pose.view().y - 1.0).abs() < 1e-9, "a sway of 1 cm does not turn the head");
        assert!((heads[4].pose.view().x + 1.0).abs() < 1e-6);
        assert!((heads[4].pose.position.z() - 1.6).abs() < 1e-12);
    }
}
