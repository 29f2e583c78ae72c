//! What the types of a message do not say: lengths of names, plausible numbers, unit quaternions.
//! Numbers are finite already: the decoder lets no other through.

use super::{ClientError, ErrorCode, FromClient, HeadPose, MAX_DETAIL_BYTES, SceneEvent};

/// Everything that a message's fields must be beside their types.
pub(super) fn check(message: &FromClient) -> Result<(), ClientError> {
    match message {
        FromClient::Hello(hello) => {
            text("name", &hello.name)?;
            match &hello.token {
                Some(token) if token.expose().len() > MOST_TOKEN_BYTES => Err(ClientError::at(
                    ErrorCode::OutOfRange,
                    "token",
                    format!("{} bytes", token.expose().len()),
                    format!("at most {MOST_TOKEN_BYTES} bytes"),
                )),
                _ => Ok(()),
            }
        }
        FromClient::Enter(who) | FromClient::Leave(who) | FromClient::OriginChanged(who) => {
            text("person", &who.person)
        }
        FromClient::Pose(pose) => check_pose(pose),
        FromClient::TouchBegan(touch) | FromClient::TouchEnded(touch) => {
            text("person", &touch.person)?;
            text("object", &touch.object)
        }
        FromClient::SceneEvent(event) => check_event(event),
        FromClient::ClockPing(_) => Ok(()),
    }
}

/// The same for a pose.
pub(super) fn check_pose(pose: &HeadPose) -> Result<(), ClientError> {
    text("person", &pose.person)?;
    coordinates("position", &pose.position)?;
    let norm = pose.orientation.iter().map(|part| part * part).sum::<f64>().sqrt();
    if (norm - 1.0).abs() > MOST_NORM_ERROR {
        return Err(ClientError::at(
            ErrorCode::NotUnit,
            "orientation",
            format!("a quaternion of length {norm:.6}"),
            format!("length 1 within {MOST_NORM_ERROR}"),
        ));
    }
    if let Some(hands) = pose.hands {
        let both = [("hands.left", hands.left), ("hands.right", hands.right)];
        for (field, hand) in both.iter().filter_map(|(field, hand)| hand.as_ref().map(|hand| (field, hand))) {
            coordinates(field, hand)?;
        }
    }
    Ok(())
}

fn check_event(event: &SceneEvent) -> Result<(), ClientError> {
    text("name", &event.name)?;
    let bytes = event.detail.as_ref().map_or(0, |detail| detail.to_string().len());
    if bytes > MAX_DETAIL_BYTES {
        return Err(ClientError::at(
            ErrorCode::OutOfRange,
            "detail",
            format!("{bytes} bytes of JSON"),
            format!("at most {MAX_DETAIL_BYTES} bytes"),
        ));
    }
    Ok(())
}

fn coordinates(field: &str, position: &[f64; 3]) -> Result<(), ClientError> {
    for (axis, coordinate) in position.iter().enumerate() {
        if coordinate.abs() > FARTHEST {
            return Err(ClientError::at(
                ErrorCode::OutOfRange,
                format!("{field}[{axis}]"),
                coordinate.to_string(),
                format!("a coordinate from -{FARTHEST} to {FARTHEST}"),
            ));
        }
    }
    Ok(())
}

fn text(field: &str, value: &str) -> Result<(), ClientError> {
    let chars = value.chars().count();
    let found = if chars == 0 || chars > MOST_NAME_CHARS {
        format!("{chars} characters")
    } else if value.chars().any(char::is_control) {
        "a control character".into()
    } else if value.trim().is_empty() {
        "blanks alone".into()
    } else {
        return Ok(());
    };
    let expected = format!("1 to {MOST_NAME_CHARS} printable characters");
    Err(ClientError::at(ErrorCode::OutOfRange, field, found, expected))
}

const MOST_NAME_CHARS: usize = 64;
const MOST_TOKEN_BYTES: usize = 1024;
/// The tenth of a percent that f32 arithmetic in a client may leave; more is a bug there, which mending would hide.
const MOST_NORM_ERROR: f64 = 1e-3;
/// A kilometre in Unreal's centimetres; no headset tracks that far.
const FARTHEST: f64 = 100_000.0;
