//! From text to a scene, or to everything that is wrong with it: where, what was found, what was expected.
//!
//! Syntax and types end at the first error, as nothing after it can be trusted; ranges, references and geometry are
//! reported all at once.

use std::fmt::{self, Display};

use covr_engine::machine::Travel;
use covr_engine::placing;
use covr_engine::scenario::Finding;
use covr_engine::scene::Scene;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ts_rs::TS;

use super::place::Finder;
use super::{SceneDocument, check, spec};
use crate::complaint::Complaint;
use crate::phrase::Phrase;

/// The longest scene, bytes: some 100 meshes of 500 triangles.
pub const MAX_SCENE_BYTES: usize = 4 * 1024 * 1024;

/// One thing that is wrong with a scene.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema, TS)]
pub struct SceneError {
    /// Where, as a JSON path: `$.objects[3].shape.radius`.
    pub path: String,
    /// Line in the text, from 1; null without a text.
    pub line: Option<usize>,
    /// Column in the line, from 1, in bytes; null without a text.
    pub column: Option<usize>,
    /// What was found there.
    pub found: String,
    /// What was expected there.
    pub expected: String,
    /// What was found as an id and its values; none: a value as it stands.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[ts(optional)]
    pub found_as: Option<Box<Phrase>>,
    /// What was expected as an id and its values; none: a value as it stands.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[ts(optional)]
    pub expected_as: Option<Box<Phrase>>,
}

/// Something in a good scene that is worth a second look.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema, TS)]
pub struct SceneWarning {
    /// Where, as a JSON path: `$.scenario.states[3]`.
    pub path: String,
    /// Line in the text, from 1; null without a text.
    pub line: Option<usize>,
    /// Column in the line, from 1, in bytes; null without a text.
    pub column: Option<usize>,
    /// What is found, in plain words.
    pub found: String,
    /// The same as an id and its values.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[ts(optional)]
    pub found_as: Option<Box<Phrase>>,
}

/// What is worth a second look in a scene that was read from this text: what a machine of this travel cannot serve well, then its
/// scenario.
pub fn scene_warnings(text: &[u8], scene: &Scene, travel: &Travel) -> Vec<SceneWarning> {
    let finder = Finder::new(text);
    let warning = |under: &str, finding: Finding| {
        let path = format!("${under}.{}", finding.path);
        let (line, column) = finder.find(&path).unzip();
        SceneWarning {
            path,
            line,
            column,
            found_as: Phrase::of(&finding.words).map(Box::new),
            found: finding.words,
        }
    };
    let placing = placing::findings(scene, travel).into_iter().map(|finding| warning("", finding));
    placing.chain(scene.findings().into_iter().map(|finding| warning(".scenario", finding))).collect()
}

/// Read a scene: its document, and what the engine makes of it.
pub fn parse_scene(text: &[u8]) -> Result<(SceneDocument, Scene), Vec<SceneError>> {
    if text.len() > MAX_SCENE_BYTES {
        let found = format!("{} bytes", text.len());
        let error = SceneError::new("$".into(), found, format!("at most {MAX_SCENE_BYTES} bytes"));
        return Err(vec![error.with_phrases()]);
    }
    let document = read(text).map_err(|error| vec![error.with_phrases()])?;
    match build_scene(&document) {
        Ok(scene) => Ok((document, scene)),
        Err(mut errors) => {
            let finder = Finder::new(text);
            for error in &mut errors {
                (error.line, error.column) = finder.find(&error.path).unzip();
            }
            Err(errors)
        }
    }
}

/// What the engine makes of a document that is there already.
pub fn build_scene(document: &SceneDocument) -> Result<Scene, Vec<SceneError>> {
    let mut errors = check::check(document);
    let checked = errors.len();
    match Scene::build(spec::spec(document)) {
        Ok(scene) if errors.is_empty() => return Ok(scene),
        Ok(_) => {}
        Err(problems) => {
            let said_already = |path: &str, errors: &[SceneError]| {
                errors.iter().any(|known| {
                    known.path.strip_prefix(path).is_some_and(|rest| rest.is_empty() || rest.starts_with('['))
                })
            };
            for error in problems.iter().map(spec::error) {
                if !said_already(&error.path, &errors[..checked]) {
                    errors.push(error);
                }
            }
        }
    }
    errors.truncate(MOST_ERRORS);
    Err(errors.into_iter().map(SceneError::with_phrases).collect())
}

/// A scene with more errors than this has one error many times.
const MOST_ERRORS: usize = 100;

fn read(text: &[u8]) -> Result<SceneDocument, SceneError> {
    let mut json = serde_json::Deserializer::from_slice(text);
    let document = serde_path_to_error::deserialize(&mut json).map_err(|error| {
        let path = error.path().to_string();
        SceneError::from_serde(&path, error.inner())
    })?;
    json.end().map_err(|error| SceneError::from_serde(".", &error))?;
    Ok(document)
}

impl SceneError {
    pub(super) fn new(path: String, found: impl Display, expected: impl Display) -> Self {
        let (found, expected) = (found.to_string(), expected.to_string());
        Self { path, line: None, column: None, found, expected, found_as: None, expected_as: None }
    }

    /// With the ids of its phrases: looked up at the end, for those that are told.
    fn with_phrases(self) -> Self {
        let (found_as, expected_as) =
            (Phrase::of(&self.found).map(Box::new), Phrase::of(&self.expected).map(Box::new));
        Self { found_as, expected_as, ..self }
    }

    fn from_serde(path: &str, error: &serde_json::Error) -> Self {
        let complaint = Complaint::parse(&error.to_string(), "JSON");
        let mut full = "$".to_owned();
        if path != "." {
            if !path.starts_with('[') {
                full.push('.');
            }
            full.push_str(path);
        }
        if let Some(key) = complaint.key {
            full.push('.');
            full.push_str(&key);
        }
        let known = error.line() > 0;
        Self {
            line: known.then(|| error.line()),
            column: known.then(|| error.column().max(1)),
            ..Self::new(full, complaint.found, complaint.expected)
        }
    }
}

impl Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let (Some(line), Some(column)) = (self.line, self.column) {
            write!(f, "line {line}, column {column}: ")?;
        }
        write!(f, "{}: found {}, expected {}", self.path, self.found, self.expected)
    }
}

impl std::error::Error for SceneError {}

impl Display for SceneWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let (Some(line), Some(column)) = (self.line, self.column) {
            write!(f, "line {line}, column {column}: ")?;
        }
        write!(f, "{}: {}", self.path, self.found)
    }
}
