//! A recorded walk as the loop takes it: the truth at every period, and the poses as the server would have decoded
//! them. Prepared once and replayed with every rule that is tried on it: what a client writes does not depend on the
//! rule that reads it.

use covr_engine::frames::{Point, Pose, Room};
use covr_engine::observation::{Hands, PoseSample};
use covr_engine::time::{Span, Time};
use nalgebra::UnitQuaternion;

use super::headset::Headset;
use super::trial::TrialProblem;
use crate::random::Random;
use crate::trace::Recording;

/// How a walk is prepared.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pace {
    /// The period of the loop that will take it.
    pub period: Span,
    /// Poses a second.
    pub pose_hz: f64,
    /// What tracking gets wrong.
    pub noise: TrackingNoise,
    /// Decides the noise.
    pub seed: u64,
    /// The client sends the hands, where the recording has them.
    pub hands: bool,
}

/// Independent normal errors of each pose.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TrackingNoise {
    /// Standard deviation of each coordinate, m.
    pub position_m: f64,
    /// Standard deviation of heading, elevation and roll, rad.
    pub rotation_rad: f64,
}

/// A stretch of a recording, ready for the loop. Times are the recording's.
#[derive(Debug, Clone)]
pub struct Walk<'a> {
    recording: &'a Recording,
    begins: Time,
    ends: Time,
    period: Span,
    poses: Vec<PoseSample>,
    truth: Vec<(Time, Pose<Room>)>,
}

impl<'a> Walk<'a> {
    /// The stretch that a reach is judged on: from 2 s before the scene is hidden, else the first frame, to the reach.
    pub fn of_reach(recording: &'a Recording, pace: &Pace) -> Result<Self, TrialProblem> {
        let reach = recording.events.reach.ok_or_else(|| TrialProblem::NoReach(recording.trial.clone()))?;
        let first_frame = recording.frames.first().map_or(Time::ZERO, |frame| frame.at);
        let hidden = recording.events.preview_end;
        let begins = hidden.map_or(first_frame, |hidden| hidden - BEFORE_PREVIEW_END).max(first_frame);
        Self::between(recording, begins, reach, pace)
    }

    /// Any stretch of a recording.
    pub fn between(
        recording: &'a Recording,
        begins: Time,
        ends: Time,
        pace: &Pace,
    ) -> Result<Self, TrialProblem> {
        let room_from_trace = recording.room_from_trace();
        let mut headset = Headset::new();
        let mut random = Random::seeded(pace.seed);
        let poses = recording.resampled_between(pace.pose_hz, begins, ends);
        let poses = poses.map(|sample| {
            let pose = pace.noise.on(room_from_trace.pose(&sample.pose), &mut random);
            let hands = if pace.hands { sample.hands_in(&room_from_trace) } else { Hands::UNKNOWN };
            headset.seen(sample.at, &pose, &pace.noise.on_hands(hands, &mut random))
        });
        let poses = poses.collect();
        let truth = recording.resampled_between(1.0 / pace.period.secs(), begins, ends);
        let truth: Vec<_> = truth.map(|sample| (sample.at, room_from_trace.pose(&sample.pose))).collect();
        if truth.is_empty() {
            return Err(TrialProblem::NoFrames(recording.trial.clone()));
        }
        Ok(Self { recording, begins, ends, period: pace.period, poses, truth })
    }

    /// The recording.
    pub fn recording(&self) -> &'a Recording {
        self.recording
    }

    /// When it begins.
    pub fn begins(&self) -> Time {
        self.begins
    }

    /// When it ends.
    pub fn ends(&self) -> Time {
        self.ends
    }

    /// The period of the loop that it is for.
    pub fn period(&self) -> Span {
        self.period
    }

    /// The poses that the headset sends, in order of time.
    pub fn poses(&self) -> &[PoseSample] {
        &self.poses
    }

    /// The head, at every period that is not in a gap of the recording; never empty.
    pub fn truth(&self) -> &[(Time, Pose<Room>)] {
        &self.truth
    }

    /// The longest time without a pose.
    pub fn longest_gap(&self) -> Span {
        let times = self.poses.iter().map(|sample| sample.taken_at).chain([self.ends]);
        let after = |(longest, before): (Span, Time), at: Time| (longest.max(at - before), at);
        times.fold((Span::ZERO, self.begins), after).0
    }
}

impl TrackingNoise {
    fn on(&self, pose: Pose<Room>, random: &mut Random) -> Pose<Room> {
        if *self == Self::default() {
            return pose;
        }
        let position = self.on_point(pose.position, random);
        let mut off = |deviation: f64| deviation * random.normal();
        let turn = UnitQuaternion::from_euler_angles(
            off(self.rotation_rad),
            off(self.rotation_rad),
            off(self.rotation_rad),
        );
        Pose { position, orientation: pose.orientation * turn }
    }
}

impl TrackingNoise {
    fn on_hands(&self, hands: Hands, random: &mut Random) -> Hands {
        let [left, right] = hands.both().map(|hand| hand.map(|hand| self.on_point(hand, random)));
        Hands { left, right }
    }

    fn on_point(&self, point: Point<Room>, random: &mut Random) -> Point<Room> {
        if self.position_m == 0.0 && self.rotation_rad == 0.0 {
            return point;
        }
        let mut off = || self.position_m * random.normal();
        Point::new(point.x() + off(), point.y() + off(), point.z() + off())
    }
}

/// A reach is replayed from so long before the scene is hidden.
const BEFORE_PREVIEW_END: Span = Span::from_millis(2_000);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::Recordings;
    use std::io::Cursor;
    use std::path::Path;

    const PACE: Pace = Pace {
        period: Span::from_millis(4),
        pose_hz: 75.0,
        noise: TrackingNoise { position_m: 0.0, rotation_rad: 0.0 },
        seed: 1,
        hands: true,
    };

    /// A person who stands for 4 s, unseen from 2 s to 2.9 s.
    fn recording() -> Recording {
        let frames: Vec<String> = (0..=40)
            .filter(|i| !(21..29).contains(i))
            .map(|i| format!("[{},1000,2000,1600,0,0]", i * 100))
            .collect();
        let line = format!(
            r#"{{"dataset":"made","trial":"stand","user":"u","arena":{{"x":[0,4],"y":[0,4]}},"goal":"A",
            "targets":[{{"id":"A","x":1,"y":3,"z":1,"r":0.1}}],"events":{{"preview_end":3.0,"reach":4.0}},
            "cols":["t_ms","x_mm","y_mm","z_mm","yaw_mrad","pitch_mrad"],"frames":[{}]}}"#,
            frames.join(",")
        );
        let line = line.replace('\n', " ");
        Recordings::from_lines(Path::new("made"), Box::new(Cursor::new(line))).next().unwrap().unwrap()
    }

    #[test]
    fn a_reach_begins_before_the_scene_is_hidden_and_nothing_is_invented_in_its_gap() {
        let recording = recording();
        let walk = Walk::of_reach(&recording, &PACE).unwrap();
        assert_eq!((walk.begins().micros(), walk.ends().micros()), (1_000_000, 4_000_000));
        let in_gap = |at: Time| (2_000_001..2_900_000).contains(&at.micros());
        assert!(!walk.poses().iter().any(|sample| in_gap(sample.taken_at)));
        assert!(!walk.truth().iter().any(|(at, _)| in_gap(*at)));
        assert!((walk.longest_gap().secs() - 0.9).abs() < 0.02, "{}", walk.longest_gap().secs());
    }

    #[test]
    fn noise_has_the_size_it_was_given_and_the_truth_none() {
        let recording = recording();
        let noise = TrackingNoise { position_m: 0.02, rotation_rad: 0.035 };
        let walk = Walk::of_reach(&recording, &Pace { noise, ..PACE }).unwrap();
        let true_x = walk.truth()[0].1.position.x();
        let squares = walk.poses().iter().map(|s| (s.pose.position.x() - true_x).powi(2)).sum::<f64>();
        let deviation = (squares / walk.poses().len() as f64).sqrt();
        assert!((0.016..0.024).contains(&deviation), "{deviation}");
        let angle = |sample: &PoseSample| sample.pose.orientation.angle_to(&walk.truth()[0].1.orientation);
        assert!(walk.poses().iter().any(|sample| angle(sample) > 0.035));
        assert!(walk.truth().iter().all(|(_, pose)| pose.position.x() == true_x));
    }
}
