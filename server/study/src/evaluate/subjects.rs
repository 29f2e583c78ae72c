//! Who is evaluated: recorded reaches, and whole sessions.

use std::path::{Path, PathBuf};

use covr_engine::frames::{Floor, Planar, Point};
use covr_engine::machine::Travel;

use super::row::LeftOut;
use super::run::EvaluationProblem;
use super::synthetic;
use crate::trace::{HEAD_HEIGHT_M, Heights, Recording, Recordings, Target, Visit, trace_files};

/// Recorded reaches and sessions, by file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Subjects {
    pub(super) reaches: Vec<Reach>,
    pub(super) sessions: Vec<Session>,
    pub(super) left_out: Vec<LeftOut>,
}

/// One recorded reach.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Reach {
    pub file: String,
    pub recording: Recording,
    pub goal: usize,
    /// Where the column begins: this person's goal before, in the recording's room.
    pub column: Floor,
}

/// One recorded session.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Session {
    pub file: String,
    pub recording: Recording,
}

impl Subjects {
    /// Read files and folders of traces. What has no goals is left out, and listed so.
    pub fn read(paths: &[PathBuf]) -> Result<Self, EvaluationProblem> {
        let mut subjects = Self::default();
        for path in paths {
            for file in trace_files(path)? {
                let name = stem(&file);
                for recording in Recordings::open(&file)? {
                    subjects.take(&name, with_targets_inside(with_horizontal_angles(recording?)));
                }
            }
        }
        if subjects.reaches.is_empty() && subjects.sessions.is_empty() {
            Err(EvaluationProblem::Nothing)
        } else {
            Ok(subjects)
        }
    }

    /// So many reaches of the made-up visitor.
    pub fn synthetic(reaches: usize) -> Self {
        let mut subjects = Self::default();
        synthetic::recordings(reaches).for_each(|recording| subjects.take("synthetic", recording));
        subjects
    }

    /// The first so many reaches alone.
    pub fn first(mut self, reaches: usize) -> Self {
        self.reaches.truncate(reaches);
        self.sessions.clear();
        self
    }

    /// A trial whose name looks like this one.
    pub(super) fn trial_like(&self, trial: &str) -> String {
        let names = || self.reaches.iter().map(|reach| &reach.recording.trial);
        let like = names().find(|name| name.contains(trial)).or_else(|| names().next());
        like.cloned().unwrap_or_default()
    }

    fn take(&mut self, file: &str, recording: Recording) {
        match recording.goal.filter(|_| recording.events.reach.is_some()) {
            Some(goal) => {
                let column = column_start(&self.reaches, &recording);
                self.reaches.push(Reach { file: file.to_owned(), recording, goal, column });
            }
            None if recording.visits.iter().any(|visit| visit.moments.reach.is_some()) => {
                self.sessions.push(Session { file: file.to_owned(), recording });
            }
            None if recording.events.reach.is_some() && !recording.targets.is_empty() => {
                self.leave_out(file, "the goal lies outside the arena, or there is none");
            }
            None => self.leave_out(file, "no goal and no reach"),
        }
    }

    fn leave_out(&mut self, file: &str, because: &'static str) {
        match self.left_out.iter_mut().find(|out| out.file == file && out.because == because) {
            Some(out) => out.recordings += 1,
            None => self.left_out.push(LeftOut { file: file.to_owned(), recordings: 1, because }),
        }
    }
}

/// What the person was asked to do.
pub(super) fn task(recording: &Recording) -> &str {
    recording.mode.as_deref().unwrap_or("none")
}

/// Where the column can stand in a recording's room.
pub(super) fn travel(recording: &Recording) -> Travel {
    Travel { min: Floor::default(), max: Floor::default() + recording.size_m() }
}

/// Where heights are not known, heads and targets are put at one height, so that angles are those over the floor; and
/// targets that lie nearer than a prop is wide are one target.
fn with_horizontal_angles(mut recording: Recording) -> Recording {
    if recording.heights != Heights::UnknownOffset {
        return recording;
    }
    recording.heights = Heights::Missing;
    for frame in &mut recording.frames {
        // A hand without a height points nowhere.
        (frame.z_m, frame.pitch_rad, frame.hands) = (None, None, [None; 2]);
    }
    let mut kept: Vec<Target> = Vec::new();
    let merged: Vec<usize> = std::mem::take(&mut recording.targets)
        .into_iter()
        .map(|mut target| {
            target.position = Point::new(target.position.x(), target.position.y(), HEAD_HEIGHT_M);
            let near = |other: &Target| other.position.distance_m(&target.position) < MERGED_WITHIN_M;
            kept.iter().position(near).unwrap_or_else(|| {
                kept.push(target);
                kept.len() - 1
            })
        })
        .collect();
    recording.targets = kept;
    recording.goal = recording.goal.map(|goal| merged[goal]);
    recording.visits.iter_mut().for_each(|visit| visit.goal = merged[visit.goal]);
    recording
}

/// A target outside the arena is where no column can stand: it is no object, and nobody is served there.
fn with_targets_inside(mut recording: Recording) -> Recording {
    let Some(arena) = recording.arena else { return recording };
    let inside = |target: &Target| {
        let (x, y) = (target.position.x(), target.position.y());
        (arena.x_m[0]..=arena.x_m[1]).contains(&x) && (arena.y_m[0]..=arena.y_m[1]).contains(&y)
    };
    let mut kept: Vec<Target> = Vec::new();
    let now_at: Vec<Option<usize>> = std::mem::take(&mut recording.targets)
        .into_iter()
        .map(|target| {
            inside(&target).then(|| {
                kept.push(target);
                kept.len() - 1
            })
        })
        .collect();
    recording.targets = kept;
    recording.goal = recording.goal.and_then(|goal| now_at[goal]);
    recording.visits = std::mem::take(&mut recording.visits)
        .into_iter()
        .filter_map(|visit| Some(Visit { goal: now_at[visit.goal]?, ..visit }))
        .collect();
    recording
}

/// The goal of the trial before of this person and task; for the first the arena's centre and a metre off.
fn column_start(before: &[Reach], recording: &Recording) -> Floor {
    let travel = travel(recording);
    let last = before
        .iter()
        .rev()
        .find(|reach| reach.recording.user == recording.user && reach.recording.mode == recording.mode);
    let place = last.map_or(travel.centre() + Planar::new(1.0, 1.0), |reach| {
        reach.recording.room_from_trace().point(&reach.recording.targets[reach.goal].position).floor()
    });
    travel.shrunk(TRAVEL_MARGIN_M).clamped(place)
}

/// The file's name up to its first dot.
fn stem(file: &Path) -> String {
    let name = file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    name.split('.').next().unwrap_or_default().to_owned()
}

/// Inside the engine's own margin to the travel limits, m.
pub(super) const TRAVEL_MARGIN_M: f64 = 0.05;
/// Targets of unknown height nearer to each other than this are one, m.
const MERGED_WITHIN_M: f64 = 0.2;

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    #[test]
    fn targets_of_unknown_height_are_merged_and_seen_over_the_floor() {
        let line = r#"{"dataset":"pearl","trial":"01/V1","user":"01","arena":{"x":[0,4],"y":[0,4]},"goal":"B",
            "targets":[{"id":"A","x":1,"y":1,"z":-0.3,"r":0.35},{"id":"B","x":1.1,"y":1.1,"z":-0.3,"r":0.35},{"id":"C","x":3,"y":1,"z":-0.3,"r":0.35}],
            "events":{"leave":1.0,"reach":4.0},"cols":["t_ms","x_mm","y_mm","z_mm","yaw_mrad","pitch_mrad"],
            "frames":[[0,2000,2000,19,0,-300],[33,2000,2000,25,0,-300]]}"#;
        let line = line.replace('\n', " ");
        let read = Recordings::from_lines(Path::new("made"), Box::new(Cursor::new(line))).next().unwrap();
        let recording = with_horizontal_angles(read.unwrap());
        let ids: Vec<&str> = recording.targets.iter().map(|target| target.id.as_str()).collect();
        assert_eq!((ids, recording.goal), (vec!["A", "C"], Some(0)));
        let room_from_trace = recording.room_from_trace();
        let head = room_from_trace.pose(&recording.resampled(75.0).next().unwrap().pose);
        assert_eq!(head.position.z(), room_from_trace.point(&recording.targets[1].position).z());
        assert_eq!(head.view().z, 0.0);
    }

    #[test]
    fn a_goal_outside_the_arena_is_left_out_and_said() {
        let line = |trial: &str, goal: &str| {
            format!(
                r#"{{"dataset":"made","trial":"{trial}","user":"u","arena":{{"x":[0,4],"y":[0,4]}},"goal":"{goal}","targets":[{{"id":"out","x":1,"y":4.2,"z":1,"r":0.1}},{{"id":"in","x":3,"y":1,"z":1,"r":0.1}}],"events":{{"reach":0.03}},"cols":["t_ms","x_mm","y_mm"],"frames":[[0,2000,2000],[33,2000,2000]]}}"#
            )
        };
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("made.jsonl");
        std::fs::write(&file, format!("{}\n{}\n", line("a", "out"), line("b", "in"))).unwrap();
        let subjects = Subjects::read(&[file]).unwrap();
        let [reach] = &subjects.reaches[..] else { panic!("{subjects:?}") };
        assert_eq!((reach.recording.trial.as_str(), reach.goal, reach.recording.targets.len()), ("b", 0, 1));
        assert_eq!(subjects.left_out[0].recordings, 1);
    }
}
