//! From a frame to a message, or to an error that names the field. Never a panic, whatever the bytes.
//!
//! Bytes become a tree first, which settles syntax, repeated keys, depth and non-finite numbers for both encodings
//! alike; the tree's `type` then says which message its other fields are read as. A good pose in JSON, which is nearly
//! all that comes, needs no tree (`direct`).

use std::fmt;
use std::io::Cursor;

use serde::de::{self, Deserialize, DeserializeOwned, Deserializer, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Value};

use super::check::check;
use super::direct;
use super::{ClientError, Encoding, ErrorCode, FromClient, MAX_FRAME_BYTES, ToClient};

/// Read one frame from a client.
pub fn decode(encoding: Encoding, frame: &[u8]) -> Result<FromClient, ClientError> {
    if frame.len() > MAX_FRAME_BYTES {
        return Err(ClientError::at(
            ErrorCode::FrameTooLarge,
            "",
            format!("a frame of {} bytes", frame.len()),
            format!("at most {MAX_FRAME_BYTES} bytes"),
        ));
    }
    if encoding == Encoding::Json
        && let Some(pose) = direct::pose(frame)
    {
        return Ok(FromClient::Pose(pose));
    }
    decode_by_tree(encoding, frame)
}

/// Read one frame from the server: for clients in Rust.
pub fn decode_from_server(encoding: Encoding, frame: &[u8]) -> Result<ToClient, DecodeFailed> {
    match encoding {
        Encoding::Json => serde_json::from_slice(frame).map_err(|e| DecodeFailed(e.to_string())),
        Encoding::MessagePack => rmp_serde::from_slice(frame).map_err(|e| DecodeFailed(e.to_string())),
    }
}

/// A frame from the server that is no message of this protocol.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the server's frame cannot be read: {0}")]
pub struct DecodeFailed(String);

const MESSAGES: &str = "one of `hello`, `enter`, `leave`, `pose`, `origin_changed`, `touch_began`, `touch_ended`, \
                        `scene_event`, `clock_ping`";

/// A pose is 3 deep; a scene event's detail may be somewhat deeper. Bounds the stack that a hostile frame can take.
const MOST_NESTED: usize = 64;

fn decode_by_tree(encoding: Encoding, frame: &[u8]) -> Result<FromClient, ClientError> {
    let Value::Object(mut fields) = tree(encoding, frame)? else {
        return Err(ClientError::at(ErrorCode::WrongType, "", "another value", "an object with a `type`"));
    };
    let kind = match fields.remove("type") {
        Some(Value::String(kind)) => kind,
        Some(_) => return Err(ClientError::at(ErrorCode::WrongType, "type", "another value", MESSAGES)),
        None => return Err(ClientError::at(ErrorCode::MissingField, "type", "nothing", MESSAGES)),
    };
    let message = match kind.as_str() {
        "hello" => FromClient::Hello(read(fields)?),
        "enter" => FromClient::Enter(read(fields)?),
        "leave" => FromClient::Leave(read(fields)?),
        "pose" => FromClient::Pose(read(fields)?),
        "origin_changed" => FromClient::OriginChanged(read(fields)?),
        "touch_began" => FromClient::TouchBegan(read(fields)?),
        "touch_ended" => FromClient::TouchEnded(read(fields)?),
        "scene_event" => FromClient::SceneEvent(read(fields)?),
        "clock_ping" => FromClient::ClockPing(read(fields)?),
        other => {
            let found = format!("`{}`", crate::complaint::shortened(other));
            return Err(ClientError::at(ErrorCode::UnknownMessage, "type", found, MESSAGES));
        }
    };
    check(&message)?;
    Ok(message)
}

fn read<M: DeserializeOwned>(fields: Map<String, Value>) -> Result<M, ClientError> {
    serde_path_to_error::deserialize(Value::Object(fields))
        .map_err(|e| ClientError::from_serde(&e.path().to_string(), &e.inner().to_string(), "message"))
}

fn tree(encoding: Encoding, frame: &[u8]) -> Result<Value, ClientError> {
    match encoding {
        Encoding::Json => {
            let mut json = serde_json::Deserializer::from_slice(frame);
            let tree: Tree = serde_path_to_error::deserialize(&mut json)
                .map_err(|e| refused(&e.path().to_string(), &e.inner().to_string(), "JSON"))?;
            json.end().map_err(|e| refused(".", &e.to_string(), "JSON"))?;
            Ok(tree.0)
        }
        Encoding::MessagePack => {
            let mut pack = rmp_serde::Deserializer::new(Cursor::new(frame));
            pack.set_max_depth(MOST_NESTED);
            let tree: Tree = serde_path_to_error::deserialize(&mut pack)
                .map_err(|e| refused(&e.path().to_string(), &e.inner().to_string(), "MessagePack"))?;
            let left = frame.len() as u64 - pack.position();
            if left > 0 {
                let found = format!("{left} more bytes after the message");
                return Err(ClientError::at(ErrorCode::Malformed, "", found, "one message in a frame"));
            }
            Ok(tree.0)
        }
    }
}

fn refused(path: &str, message: &str, format: &str) -> ClientError {
    let error = ClientError::from_serde(path, message, format);
    match message.contains(FINITE) {
        true => ClientError { code: ErrorCode::NotFinite, ..error },
        false => error,
    }
}

const FINITE: &str = "a finite number";

/// A tree of values with finite numbers and keys that do not repeat.
struct Tree(Value);

impl<'de> Deserialize<'de> for Tree {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(TreeVisitor)
    }
}

struct TreeVisitor;

impl<'de> Visitor<'de> for TreeVisitor {
    type Value = Tree;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a value that JSON has")
    }

    fn visit_unit<E>(self) -> Result<Tree, E> {
        Ok(Tree(Value::Null))
    }

    fn visit_none<E>(self) -> Result<Tree, E> {
        Ok(Tree(Value::Null))
    }

    fn visit_some<D: Deserializer<'de>>(self, deserializer: D) -> Result<Tree, D::Error> {
        Tree::deserialize(deserializer)
    }

    fn visit_bool<E>(self, value: bool) -> Result<Tree, E> {
        Ok(Tree(Value::Bool(value)))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Tree, E> {
        Ok(Tree(value.into()))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Tree, E> {
        Ok(Tree(value.into()))
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<Tree, E> {
        serde_json::Number::from_f64(value)
            .map(|number| Tree(Value::Number(number)))
            .ok_or_else(|| E::invalid_value(de::Unexpected::Float(value), &FINITE))
    }

    fn visit_str<E>(self, value: &str) -> Result<Tree, E> {
        Ok(Tree(value.into()))
    }

    fn visit_string<E>(self, value: String) -> Result<Tree, E> {
        Ok(Tree(value.into()))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Tree, A::Error> {
        let mut list = Vec::new();
        while let Some(Tree(item)) = items.next_element()? {
            list.push(item);
        }
        Ok(Tree(Value::Array(list)))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Tree, A::Error> {
        let mut map = Map::new();
        while let Some(key) = entries.next_key::<String>()? {
            if map.contains_key(&key) {
                return Err(de::Error::custom(format_args!("duplicate field `{key}`")));
            }
            let Tree(value) = entries.next_value()?;
            map.insert(key, value);
        }
        Ok(Tree(Value::Object(map)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Values that a field of a pose may be given, good ones first.
    fn value() -> impl Strategy<Value = String> {
        prop_oneof![
            Just("\"ada\"".to_owned()),
            Just("\"pose\"".to_owned()),
            Just("\"p\\u006fse\"".to_owned()),
            any::<u32>().prop_map(|n| n.to_string()),
            any::<i64>().prop_map(|n| n.to_string()),
            any::<f64>().prop_map(|x| format!("{x:e}")),
            Just("3.0".to_owned()),
            Just("1e999".to_owned()),
            Just("-0".to_owned()),
            Just("18446744073709551615".to_owned()),
            Just("true".to_owned()),
            Just("null".to_owned()),
            Just("{}".to_owned()),
            Just("[0, 1.6, 0]".to_owned()),
            Just("[0, 0, 0, 1]".to_owned()),
            Just("[[0, 1, 2], null]".to_owned()),
            Just("{\"left\": [1, 2, 3]}".to_owned()),
            Just("{\"left\": [1, 2, 3], \"left\": null}".to_owned()),
            Just("{\"pose\": null}".to_owned()),
        ]
    }

    proptest! {
        #[test]
        fn what_is_read_directly_is_what_the_tree_reads(
            changed in prop::collection::vec((0_usize..9, value()), 0..3),
            repeated in prop::option::of(0_usize..9),
            left_out in prop::option::of(0_usize..9),
            around in prop_oneof![
                8 => Just(("{", "}")), 1 => Just((" {", "}\n")), 1 => Just(("[", "]")), 1 => Just(("{", "} {}")),
            ],
            order in Just((0..9).collect::<Vec<usize>>()).prop_shuffle(),
        ) {
            const NAMES: [&str; 9] = [
                "type", "person", "sequence", "client_time_micros", "position", "orientation", "tracked", "worn", "hands",
            ];
            let mut values = [
                "\"pose\"", "\"ada\"", "7", "-5", "[0.1, 1.7, -2]", "[0, 0.6, 0, 0.8]", "true", "false", "null",
            ].map(str::to_owned);
            for (field, value) in changed {
                values[field] = value;
            }
            let fields: Vec<String> = order.into_iter().filter(|field| left_out != Some(*field)).chain(repeated)
                .map(|field| format!("\"{}\": {}", NAMES[field], values[field])).collect();
            let frame = format!("{}{}{}", around.0, fields.join(", "), around.1);
            if let Some(pose) = direct::pose(frame.as_bytes()) {
                prop_assert_eq!(decode_by_tree(Encoding::Json, frame.as_bytes()), Ok(FromClient::Pose(pose)), "{}", frame);
            }
        }
    }

    #[test]
    fn a_good_pose_needs_no_tree() {
        let frame = br#"{"type": "pose", "person": "ada", "sequence": 1, "client_time_micros": 2,
            "position": [0, 1.7, 0], "orientation": [0, 0, 0, 1], "tracked": true, "worn": true}"#;
        let pose = direct::pose(frame).unwrap();
        assert_eq!(decode_by_tree(Encoding::Json, frame), Ok(FromClient::Pose(pose)));
    }
}
