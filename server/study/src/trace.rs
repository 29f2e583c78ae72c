//! Recorded people: one trial or one session a line of JSON, plain or gzipped, read line by line.
//!
//! A recording stays in its own frame ([`Trace`]: x right, y forward, z up) until [`Recording::room_from_trace`]
//! maps it. Nothing here invents a frame across a gap, and a bad line is refused with its file, line and field.

mod parse;
mod resample;
mod scene;

use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::{Path, PathBuf};

use covr_engine::frames::{Planar, Point, RigidMap, Room};
use covr_engine::time::{Span, Time};
use flate2::read::MultiGzDecoder;
use nalgebra::Vector3;

pub use resample::{HeadSample, Resampled};

/// The frame of a recording: right-handed metres, x right, y forward on the floor plane, z up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Trace {}

/// One trial or one session of one person.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// Where it comes from: `jov2023`, `pearl`, `openrdw`, or a laboratory's own name.
    pub dataset: String,
    /// Unique in the data set.
    pub trial: String,
    /// The person.
    pub user: String,
    /// What the person was asked to do (`fixed`, `object`, `cube`; `task` in openrdw).
    pub mode: Option<String>,
    /// Where the person could be; openrdw does not say.
    pub arena: Option<Arena>,
    /// Possible goals.
    pub targets: Vec<Target>,
    /// The goal really reached, as an index into `targets`; of a single trial.
    pub goal: Option<usize>,
    /// When things happened, of a single trial.
    pub events: Moments,
    /// What happened, of a session.
    pub visits: Vec<Visit>,
    /// Whether heights mean anything.
    pub heights: Heights,
    /// The head, in order of time; never empty.
    pub frames: Vec<Frame>,
}

/// The rectangle of the floor where the person could be, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arena {
    /// Least and greatest x.
    pub x_m: [f64; 2],
    /// Least and greatest y.
    pub y_m: [f64; 2],
}

/// A possible goal.
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    /// Unique in the recording.
    pub id: String,
    /// For people; may be empty.
    pub label: String,
    /// Its centre.
    pub position: Point<Trace>,
    /// Its radius, m.
    pub radius_m: f64,
    /// The heading from which it is seen, degrees: targets of one wall have the same; none where nobody says.
    pub view_deg: Option<f64>,
}

/// When things happened, from the start of the recording; none where the data set has no such moment.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Moments {
    /// The person was told to go home.
    pub trial_start: Option<Time>,
    /// The person stands at home.
    pub at_home: Option<Time>,
    /// The scene is shown, the goal not yet named.
    pub preview_start: Option<Time>,
    /// The scene is hidden.
    pub preview_end: Option<Time>,
    /// The person may go.
    pub response_start: Option<Time>,
    /// The person left the goal before (pearl: this goal, in a session).
    pub leave: Option<Time>,
    /// Arrival at the goal.
    pub reach: Option<Time>,
    /// The person said that it is done.
    pub response_end: Option<Time>,
}

/// One goal of a session.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Visit {
    /// Index into the recording's targets.
    pub goal: usize,
    /// The source's own word that it may be used.
    pub valid: bool,
    /// When.
    pub moments: Moments,
}

/// What the heights of a recording mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Heights {
    /// Above the floor.
    AboveFloor,
    /// From an unknown level, the same for heads and targets (pearl).
    UnknownOffset,
    /// There are none (openrdw).
    Missing,
}

/// The head at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// When, from the start of the recording.
    pub at: Time,
    /// To the right, m.
    pub x_m: f64,
    /// Forward, m.
    pub y_m: f64,
    /// Up, m.
    pub z_m: Option<f64>,
    /// Heading of the view axis, counter-clockwise from +x.
    pub yaw_rad: Option<f64>,
    /// Elevation of the view axis.
    pub pitch_rad: Option<f64>,
    /// The left and the right hand, each where it was tracked.
    pub hands: [Option<Point<Trace>>; 2],
}

/// Why a trace cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum TraceError {
    /// The file system refused.
    #[error("{}: {source}", file.display())]
    Unreadable {
        /// Which file or folder.
        file: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A folder without a trace in it.
    #[error("{}: found no .jsonl or .jsonl.gz file, expected at least one", file.display())]
    NoTraces {
        /// Which folder.
        file: PathBuf,
    },
    /// A line that is not a recording.
    #[error("{}, line {line}, {field}: found {found}, expected {expected}", file.display())]
    Line {
        /// Which file.
        file: PathBuf,
        /// Which line, from 1.
        line: usize,
        /// Path of the field, as `frames[3][1]`.
        field: String,
        /// What is there.
        found: String,
        /// What should be.
        expected: String,
    },
}

/// The recordings of one file, one at a time; stops after the first error.
pub struct Recordings {
    file: PathBuf,
    lines: Box<dyn BufRead + Send>,
    line: usize,
    failed: bool,
}

impl Recordings {
    /// Open a `.jsonl` or `.jsonl.gz` file.
    pub fn open(file: &Path) -> Result<Self, TraceError> {
        let opened =
            File::open(file).map_err(|source| TraceError::Unreadable { file: file.to_path_buf(), source })?;
        let gzipped = file.extension().is_some_and(|extension| extension == "gz");
        let lines: Box<dyn BufRead + Send> = if gzipped {
            Box::new(BufReader::new(MultiGzDecoder::new(opened)))
        } else {
            Box::new(BufReader::new(opened))
        };
        Ok(Self::from_lines(file, lines))
    }

    /// Read already opened lines; `file` is what errors will name.
    pub fn from_lines(file: &Path, lines: Box<dyn BufRead + Send>) -> Self {
        Self { file: file.to_path_buf(), lines, line: 0, failed: false }
    }

    fn read(&mut self) -> Option<Result<Recording, TraceError>> {
        loop {
            let mut text = String::new();
            self.line += 1;
            match self.lines.read_line(&mut text) {
                Err(source) => return Some(Err(TraceError::Unreadable { file: self.file.clone(), source })),
                Ok(0) => return None,
                Ok(_) if text.trim().is_empty() => {}
                Ok(_) => {
                    return Some(parse::recording(&text).map_err(|bad| TraceError::Line {
                        file: self.file.clone(),
                        line: self.line,
                        field: bad.field,
                        found: bad.found,
                        expected: bad.expected,
                    }));
                }
            }
        }
    }
}

impl Iterator for Recordings {
    type Item = Result<Recording, TraceError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.failed {
            return None;
        }
        let next = self.read();
        self.failed = matches!(next, Some(Err(_)));
        next
    }
}

/// The trace files of a path: itself, or those of the folder, in the order of their names.
pub fn trace_files(path: &Path) -> Result<Vec<PathBuf>, TraceError> {
    let unreadable = |source| TraceError::Unreadable { file: path.to_path_buf(), source };
    if !std::fs::metadata(path).map_err(unreadable)?.is_dir() {
        return Ok(vec![path.to_path_buf()]);
    }
    let mut files = Vec::new();
    for entry in std::fs::read_dir(path).map_err(unreadable)? {
        let file = entry.map_err(unreadable)?.path();
        let name = file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        if name.ends_with(".jsonl") || name.ends_with(".jsonl.gz") {
            files.push(file);
        }
    }
    files.sort();
    if files.is_empty() { Err(TraceError::NoTraces { file: path.to_path_buf() }) } else { Ok(files) }
}

impl Recording {
    /// The map into a room whose origin is the corner of the arena of least x and y. Without an arena the extent of
    /// the walk stands in for it. Heights of unknown offset are moved so that the median head is at [`HEAD_HEIGHT_M`].
    pub fn room_from_trace(&self) -> RigidMap<Trace, Room> {
        let extent = self.extent();
        let lift_m = match self.heights {
            Heights::AboveFloor | Heights::Missing => 0.0,
            Heights::UnknownOffset => HEAD_HEIGHT_M - self.median_height_m(),
        };
        RigidMap::from_yaw(0.0, Vector3::new(-extent.x_m[0], -extent.y_m[0], lift_m))
    }

    /// Size of the arena, or of the extent of the walk, m.
    pub fn size_m(&self) -> Planar {
        let extent = self.extent();
        Planar::new(extent.x_m[1] - extent.x_m[0], extent.y_m[1] - extent.y_m[0])
    }

    /// From the first frame to the last.
    pub fn duration(&self) -> Span {
        match (self.frames.first(), self.frames.last()) {
            (Some(first), Some(last)) => last.at - first.at,
            _ => Span::ZERO,
        }
    }

    fn extent(&self) -> Arena {
        self.arena.unwrap_or_else(|| {
            let of = |value: fn(&Frame) -> f64| {
                self.frames
                    .iter()
                    .map(value)
                    .fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], v| [least.min(v), most.max(v)])
            };
            Arena { x_m: of(|frame| frame.x_m), y_m: of(|frame| frame.y_m) }
        })
    }

    fn median_height_m(&self) -> f64 {
        let mut heights: Vec<f64> = self.frames.iter().filter_map(|frame| frame.z_m).collect();
        heights.sort_by(f64::total_cmp);
        heights.get(heights.len() / 2).copied().unwrap_or(HEAD_HEIGHT_M)
    }
}

/// Where a head is when the recording has no heights, m above the floor.
pub const HEAD_HEIGHT_M: f64 = 1.6;

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{Cursor, Write};

    const WALK: &str = r#"{"dataset":"openrdw","trial":"a","user":"u","task":"Free","hz":20,"cols":["t_ms","x_mm","y_mm"],"frames":[[0,-1000,500],[50,-900,500],[100,-800,700]]}"#;

    #[test]
    fn gzipped_and_plain_files_of_a_folder_read_alike_and_in_order() {
        let folder = std::env::temp_dir().join(format!("covr-traces-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join("b.jsonl"), format!("{WALK}\n\n{WALK}\n")).unwrap();
        std::fs::write(folder.join("notes.txt"), "not a trace").unwrap();
        let mut gz = flate2::write::GzEncoder::new(
            File::create(folder.join("a.jsonl.gz")).unwrap(),
            flate2::Compression::fast(),
        );
        writeln!(gz, "{WALK}").unwrap();
        gz.finish().unwrap();

        let files = trace_files(&folder).unwrap();
        let names: Vec<_> =
            files.iter().map(|f| f.file_name().unwrap().to_string_lossy().into_owned()).collect();
        assert_eq!(names, ["a.jsonl.gz", "b.jsonl"]);
        let read = |file: &Path| Recordings::open(file).unwrap().collect::<Result<Vec<_>, _>>().unwrap();
        let (zipped, plain) = (read(&files[0]), read(&files[1]));
        std::fs::remove_dir_all(&folder).unwrap();
        assert_eq!(plain.len(), 2);
        assert_eq!(zipped[0], plain[1]);
    }

    #[test]
    fn a_bad_line_is_named_and_ends_the_reading() {
        let bad = WALK.replace("-900", "\"left\"");
        let text = format!("{WALK}\n{bad}\n{WALK}\n");
        let mut read = Recordings::from_lines(Path::new("walks.jsonl"), Box::new(Cursor::new(text)));
        assert!(read.next().unwrap().is_ok());
        let error = read.next().unwrap().unwrap_err();
        assert_eq!(
            error.to_string(),
            "walks.jsonl, line 2, frames[1][1]: found \"left\", expected a finite number"
        );
        assert!(read.next().is_none());
    }

    #[test]
    fn a_missing_file_and_an_empty_folder_are_errors_that_name_them() {
        let missing = trace_files(Path::new("no/such/place")).unwrap_err();
        assert!(missing.to_string().starts_with("no/such/place: "), "{missing}");
        let folder = std::env::temp_dir().join(format!("covr-no-traces-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let empty = trace_files(&folder).unwrap_err();
        std::fs::remove_dir_all(&folder).unwrap();
        assert!(empty.to_string().ends_with("found no .jsonl or .jsonl.gz file, expected at least one"));
    }

    #[test]
    fn without_an_arena_the_walk_itself_is_moved_to_the_room_corner() {
        let recording = parse::recording(WALK).unwrap();
        let corner = recording.room_from_trace().point(&Point::new(-1.0, 0.5, 0.0));
        assert!(corner.vector().norm() < 1e-12);
        assert!((recording.size_m() - Planar::new(0.2, 0.2)).norm() < 1e-12);
        assert_eq!(recording.duration(), Span::from_millis(100));
    }

    /// Reads the real recordings of the folder named by `COVR_TRACES`; on a machine without them it says so.
    #[test]
    fn every_recording_of_the_named_folder_reads_and_resamples() {
        let Some(folder) = std::env::var_os("COVR_TRACES") else {
            println!(
                "every_recording_of_the_named_folder_reads_and_resamples: skipped, COVR_TRACES is not set"
            );
            return;
        };
        for file in trace_files(Path::new(&folder)).unwrap() {
            let (mut count, mut samples) = (0, 0);
            for recording in Recordings::open(&file).unwrap() {
                let recording = recording.unwrap_or_else(|error| panic!("{error}"));
                let size = recording.size_m();
                let room_from_trace = recording.room_from_trace();
                for sample in recording.resampled(75.0) {
                    let head = room_from_trace.pose(&sample.pose).position;
                    assert!(
                        (-1.0..size.x + 1.0).contains(&head.x()) && (-1.0..size.y + 1.0).contains(&head.y()),
                        "{} {}: head at {head:?} is far outside the room",
                        file.display(),
                        recording.trial
                    );
                    samples += 1;
                }
                count += 1;
            }
            println!("{}: {count} recordings, {samples} poses at 75 Hz", file.display());
            assert!(count > 0, "{} holds no recording", file.display());
        }
    }
}
