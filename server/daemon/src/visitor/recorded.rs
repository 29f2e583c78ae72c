//! Recordings as a programme without end, and the scene of a recording's targets.

use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use covr_study::trace::{Recording, Recordings, trace_files};
use covr_wire::scene::{ArenaDocument, ColumnDocument, ObjectDocument, SCHEMA, SceneDocument, ShapeDocument};

/// The recordings of a file or folder, one after another, then from the start again.
pub struct Program {
    files: Vec<PathBuf>,
    file: usize,
    recordings: Option<Recordings>,
    /// Recordings to pass over before the first that is played.
    begin_with: Option<Begin>,
    passed: usize,
    played: usize,
}

enum Begin {
    Number(usize),
    Id(String),
}

impl Program {
    /// Of a file or a folder, to begin with a trial by its number from 1 or by its id.
    pub fn open(path: &Path, trial: Option<&str>) -> anyhow::Result<Self> {
        let begin_with = trial.map(|trial| match trial.parse() {
            Ok(number) => Begin::Number(number),
            Err(_) => Begin::Id(trial.into()),
        });
        Ok(Self { files: trace_files(path)?, file: 0, recordings: None, begin_with, passed: 0, played: 0 })
    }

    /// The next recording. There always is one, unless nothing fits.
    pub fn next_recording(&mut self) -> anyhow::Result<Recording> {
        loop {
            if self.recordings.is_none() {
                if self.file == self.files.len() {
                    if self.played == 0 {
                        bail!("--trial: found no such trial among {}", self.passed);
                    }
                    self.file = 0;
                }
                self.recordings = Some(Recordings::open(&self.files[self.file])?);
                self.file += 1;
            }
            match self.recordings.as_mut().and_then(Iterator::next) {
                None => self.recordings = None,
                Some(recording) => {
                    let recording = recording.context("--trace")?;
                    self.passed += 1;
                    let begins = match &self.begin_with {
                        None => true,
                        Some(Begin::Number(number)) => self.passed == *number,
                        Some(Begin::Id(id)) => recording.trial == *id,
                    };
                    if begins {
                        self.begin_with = None;
                        self.played += 1;
                        return Ok(recording);
                    }
                }
            }
        }
    }
}

/// The targets of a recording as spheres, in the room; none for a walk without targets. Targets derived from views
/// (pearl) may lie outside the recorded arena, which is then widened to hold them: objects are inside the arena.
pub fn scene_of(recording: &Recording) -> Option<SceneDocument> {
    if recording.targets.is_empty() {
        return None;
    }
    let room_from_trace = recording.room_from_trace();
    let size = recording.size_m();
    let objects: Vec<ObjectDocument> = recording
        .targets
        .iter()
        .map(|target| ObjectDocument {
            id: target.id.clone(),
            label: target.label.clone(),
            position: room_from_trace.point(&target.position).vector().into(),
            yaw: 0.0,
            shape: ShapeDocument::Sphere { radius: target.radius_m },
            prop: None,
            prior: 1.0,
            enabled: true,
        })
        .collect();
    let (mut min, mut max) = ([0.0_f64; 2], [size.x, size.y]);
    for object in &objects {
        for axis in 0..2 {
            min[axis] = min[axis].min(object.position[axis]);
            max[axis] = max[axis].max(object.position[axis]);
        }
    }
    let what = recording.mode.as_deref().map(|mode| format!(", {mode}")).unwrap_or_default();
    Some(SceneDocument {
        zones: Vec::new(),
        scenario: None,
        checklist: Vec::new(),
        schema: SCHEMA.into(),
        name: format!("Recorded: {}{what}", recording.dataset),
        description: "The targets of a recording, as spheres.".into(),
        arena: ArenaDocument { min, max },
        column: ColumnDocument::default(),
        props: Vec::new(),
        objects,
        keep_outs: Vec::new(),
    })
}
