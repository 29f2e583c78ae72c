//! A chunk: about a second of a recording as one compressed document.
//!
//! JSON, so that a recording can be read without this program, deflated (zlib). Object ids stand once, and of each
//! frame's objects only those that are different from the frame before. Three ways were weighed, for 5 persons and
//! 200 objects: plain JSON deflated, the same with the objects' changes alone (chosen), and columns of scaled integers
//! in MessagePack, which saves little more and needs a reader of its own.

use std::io::{Read, Write};

use covr_wire::dashboard::Mode;
use covr_wire::records::{RecordedColumn, RecordedFrame, RecordedObject, RecordedPerson, RecordedScenario};
use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use serde::{Deserialize, Serialize};

/// Why a chunk cannot be written or read back.
#[derive(Debug, thiserror::Error)]
pub enum ChunkError {
    /// Not JSON of this form.
    #[error("not a chunk: {0}")]
    Json(#[from] serde_json::Error),
    /// Not deflated, or cut short.
    #[error("not deflated: {0}")]
    Deflate(#[from] std::io::Error),
    /// A frame names an object that the chunk does not list.
    #[error("frame {frame} names object {object} of {objects}")]
    UnknownObject {
        /// Which frame.
        frame: usize,
        /// Which object.
        object: usize,
        /// How many there are.
        objects: usize,
    },
}

#[derive(Serialize, Deserialize)]
struct Document {
    /// Ids of the objects of every frame.
    objects: Vec<String>,
    frames: Vec<Lean>,
}

#[derive(Serialize, Deserialize)]
struct Lean {
    /// Microseconds since the frame before; of the first, server time.
    at: i64,
    mode: Mode,
    column: RecordedColumn,
    persons: Vec<RecordedPerson>,
    /// Index, weight, probability, prior of what is not as in the frame before.
    changed: Vec<(usize, f64, f64, f64)>,
    /// Index of what is enabled and was not in the frame before, or the other way; before the first everything is.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    switched: Vec<(usize, bool)>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    scenario: Option<RecordedScenario>,
}

/// Whether two frames can be in one chunk: the same objects.
pub fn fit_together(a: &RecordedFrame, b: &RecordedFrame) -> bool {
    a.objects.iter().map(|o| &o.id).eq(b.objects.iter().map(|o| &o.id))
}

/// Frames with the same objects as one document.
pub fn encode(frames: &[RecordedFrame]) -> Result<Vec<u8>, ChunkError> {
    let objects = frames.first().map(|frame| frame.objects.iter().map(|o| o.id.clone()).collect());
    let mut before: Option<&RecordedFrame> = None;
    let lean = frames.iter().map(|frame| {
        let was = |i: usize| before.and_then(|before| before.objects.get(i));
        let objects = frame.objects.iter().enumerate();
        let lean = Lean {
            at: frame.at_micros - before.map_or(0, |before| before.at_micros),
            mode: frame.mode,
            column: frame.column.clone(),
            persons: frame.persons.clone(),
            switched: objects
                .clone()
                .filter(|(i, now)| was(*i).is_none_or(|was| was.enabled) != now.enabled)
                .map(|(i, now)| (i, now.enabled))
                .collect(),
            scenario: frame.scenario.clone(),
            changed: objects
                .filter(|(i, now)| was(*i) != Some(now))
                .map(|(i, now)| (i, now.weight, now.probability, now.prior))
                .collect(),
        };
        before = Some(frame);
        lean
    });
    let document = Document { frames: lean.collect(), objects: objects.unwrap_or_default() };
    let mut deflated = ZlibEncoder::new(Vec::new(), Compression::default());
    deflated.write_all(&serde_json::to_vec(&document)?)?;
    Ok(deflated.finish()?)
}

/// The frames of a document.
pub fn decode(document: &[u8]) -> Result<Vec<RecordedFrame>, ChunkError> {
    let mut json = Vec::new();
    ZlibDecoder::new(document).take(MOST_BYTES).read_to_end(&mut json)?;
    let Document { objects: ids, frames } = serde_json::from_slice(&json)?;
    let nothing =
        |id: String| RecordedObject { id, weight: 0.0, probability: 0.0, prior: 0.0, enabled: true };
    let mut objects: Vec<RecordedObject> = ids.into_iter().map(nothing).collect();
    let mut at_micros = 0;
    let whole = frames.into_iter().enumerate().map(|(frame, lean)| {
        at_micros += lean.at;
        for (object, weight, probability, prior) in lean.changed {
            let unknown = ChunkError::UnknownObject { frame, object, objects: objects.len() };
            let known = objects.get_mut(object).ok_or(unknown)?;
            (known.weight, known.probability, known.prior) = (weight, probability, prior);
        }
        for (object, enabled) in lean.switched {
            let unknown = ChunkError::UnknownObject { frame, object, objects: objects.len() };
            objects.get_mut(object).ok_or(unknown)?.enabled = enabled;
        }
        Ok(RecordedFrame {
            at_micros,
            scenario: lean.scenario,
            mode: lean.mode,
            column: lean.column,
            persons: lean.persons,
            objects: objects.clone(),
        })
    });
    whole.collect()
}

/// A document that would become longer is damaged: 256 frames of 500 objects and 16 persons have 20 MB.
const MOST_BYTES: u64 = 64 * 1024 * 1024;

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use covr_wire::dashboard::Activity;
    use covr_wire::scene::ValueDocument;

    /// A made-up frame of so many persons and objects; everything in it moves with `tick`.
    pub(crate) fn frame(tick: i64, persons: u32, objects: usize) -> RecordedFrame {
        let t = tick as f64 / 30.0;
        let round = |v: f64| (v * 1e4).round() / 1e4;
        let at = [round(2.0 + t.sin()), round(2.0 + (0.7 * t).cos())];
        RecordedFrame {
            at_micros: 5_000_000 + tick * 33_333,
            mode: Mode::Following,
            column: RecordedColumn {
                position_m: at,
                velocity_mps: [round(t.cos()), round(-0.7 * (0.7 * t).sin())],
                commanded_m: [round(at[0] + 0.003), at[1]],
                proxy_m: [round(at[0] + 0.02), round(at[1] + 0.01)],
                target_m: (tick % 7 != 0).then_some([1.5, 2.5]),
                serves: Some(1),
                committed: Some("object 3".into()),
                activity: Activity::Approaching,
                homed: true,
            },
            persons: (1..=persons)
                .map(|id| RecordedPerson {
                    id,
                    name: format!("person {id}"),
                    head_m: Some([round(1.0 + 0.5 * (t + f64::from(id)).sin()), 1.0, 1.65]),
                    yaw_rad: round(t.sin() * 2.0),
                    pitch_rad: round(-0.3 + 0.1 * (2.0 * t).sin()),
                    tracked: true,
                    separation_radius_m: 0.35,
                    distance_m: round(1.2 + 0.3 * t.sin()),
                    required_m: round(0.6 + 0.1 * t.cos()),
                })
                .collect(),
            objects: (0..objects)
                .map(|i| {
                    let weight = round(0.5 + 0.5 * (0.3 * t + i as f64).sin());
                    let probability = round(weight / objects as f64);
                    let enabled = (tick / 10 + i as i64) % 3 != 0;
                    RecordedObject { id: format!("object {i}"), weight, probability, prior: 1.0, enabled }
                })
                .collect(),
            scenario: (tick % 4 != 0).then(|| RecordedScenario {
                state: format!("state {}", tick / 20),
                in_state_secs: round(t),
                runs: true,
                variables: [("n".to_owned(), ValueDocument::Integer(tick))].into(),
            }),
        }
    }

    #[test]
    fn frames_come_back_as_they_were() {
        for objects in [0, 1, 10] {
            let frames: Vec<_> = (0..40).map(|tick| frame(tick, 2, objects)).collect();
            assert_eq!(decode(&encode(&frames).unwrap()).unwrap(), frames);
        }
        assert_eq!(decode(&encode(&[]).unwrap()).unwrap(), []);
    }

    #[test]
    fn an_hour_takes_what_the_example_configuration_says() {
        for (persons, objects, most_megabytes) in [(1, 10, 20.0), (5, 200, 150.0)] {
            let seconds: Vec<_> =
                (0..10).map(|s| (0..30).map(|i| frame(s * 30 + i, persons, objects)).collect()).collect();
            let bytes: usize = seconds.iter().map(|frames: &Vec<_>| encode(frames).unwrap().len()).sum();
            let megabytes = bytes as f64 * 360.0 * 1e-6;
            println!("{persons} persons, {objects} objects, all moving: {megabytes:.0} MB an hour");
            assert!(megabytes < most_megabytes, "{megabytes} MB an hour");
        }
    }

    #[test]
    fn a_chunk_takes_the_same_objects_alone() {
        assert!(fit_together(&frame(0, 1, 3), &frame(9, 2, 3)));
        assert!(!fit_together(&frame(0, 1, 3), &frame(0, 1, 4)));
    }

    #[test]
    fn damage_is_an_error() {
        let whole = encode(&[frame(0, 1, 2)]).unwrap();
        assert!(matches!(decode(&whole[..whole.len() / 2]), Err(ChunkError::Deflate(_))));
        assert!(matches!(decode(b"not deflated"), Err(ChunkError::Deflate(_))));
        let mut deflated = ZlibEncoder::new(Vec::new(), Compression::default());
        deflated.write_all(br#"{"objects":[],"frames":3}"#).unwrap();
        assert!(matches!(decode(&deflated.finish().unwrap()), Err(ChunkError::Json(_))));
    }
}
