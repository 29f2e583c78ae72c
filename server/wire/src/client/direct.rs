//! A shorter way for the one message that comes ninety times a second and person: a pose in JSON, read straight into
//! its type. It may give up on any frame, and then says nothing: the decoder's tree says what is wrong. What it reads
//! must be what the tree reads, or the encodings and the documented errors part.

use serde::Deserialize;

use super::check::check_pose;
use super::{Hands, HeadPose};

/// The pose in a JSON frame, if it is a good one.
pub(super) fn pose(frame: &[u8]) -> Option<HeadPose> {
    // A list of the fields' values would do for the derived reader, and is no message.
    if frame.first() != Some(&b'{') {
        return None;
    }
    let read: Tagged = serde_json::from_slice(frame).ok()?;
    if read.kind != "pose" {
        return None;
    }
    let pose = HeadPose {
        person: read.person,
        sequence: read.sequence,
        client_time_micros: read.client_time_micros,
        position: read.position,
        orientation: read.orientation,
        tracked: read.tracked,
        worn: read.worn,
        hands: read.hands,
    };
    check_pose(&pose).ok()?;
    Some(pose)
}

/// [`HeadPose`] with its tag.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Tagged<'a> {
    /// Borrowed: a tag that is written with escapes goes the long way.
    #[serde(rename = "type")]
    kind: &'a str,
    person: String,
    sequence: u32,
    client_time_micros: i64,
    position: [f64; 3],
    orientation: [f64; 4],
    tracked: bool,
    worn: bool,
    #[serde(default)]
    hands: Option<Hands>,
}
