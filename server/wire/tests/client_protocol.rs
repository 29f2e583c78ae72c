//! The client protocol from outside: both encodings carry the same, and whatever a stranger sends is refused by name.

use covr_wire::client::{
    ClientError, ClockPong, Encoding, ErrorCode, Frame, FromClient, MAX_FRAME_BYTES, ToClient, decode,
    decode_from_server,
};
use proptest::prelude::*;
use serde_json::{Value, json};

const ENCODINGS: [Encoding; 2] = [Encoding::Json, Encoding::MessagePack];

/// One good message of every type.
fn good() -> Vec<Value> {
    vec![
        json!({"type": "hello", "name": "headset 1", "convention": "unity"}),
        json!({"type": "hello", "name": "h", "convention": "openxr", "token": "t", "hands": true}),
        json!({"type": "enter", "person": "Ada"}),
        json!({"type": "leave", "person": "Ada"}),
        pose(),
        json!({"type": "origin_changed", "person": "Ada"}),
        json!({"type": "touch_began", "person": "Ada", "object": "kettle", "client_time_micros": -5}),
        json!({"type": "touch_ended", "person": "Ada", "object": "kettle", "client_time_micros": 12}),
        json!({"type": "scene_event", "name": "lights on", "detail": {"room": [1, null, "x"]}}),
        json!({"type": "clock_ping", "id": 1, "client_time_micros": 100}),
        json!({"type": "clock_ping", "id": 2, "client_time_micros": 200,
               "previous": {"id": 1, "received_client_time_micros": 150}}),
    ]
}

fn pose() -> Value {
    json!({"type": "pose", "person": "Ada", "sequence": 4_294_967_295_u32, "client_time_micros": 1_234_567,
           "position": [0.5, 1.7, -2], "orientation": [0, 0, 0, 1], "tracked": true, "worn": true,
           "hands": {"left": [0.1, 1.0, -1.5]}})
}

fn encoded(encoding: Encoding, value: &Value) -> Vec<u8> {
    encoding.encode(value).expect("a value can be encoded").bytes().to_vec()
}

fn refused(value: &Value) -> ClientError {
    let [by_json, by_pack] =
        ENCODINGS.map(|encoding| decode(encoding, &encoded(encoding, value)).expect_err("a bad message"));
    assert_eq!(by_json, by_pack, "both encodings refuse alike");
    by_json
}

fn changed(mut value: Value, pointer: &str, to: Value) -> Value {
    *value.pointer_mut(pointer).expect("a field of the message") = to;
    value
}

#[test]
fn both_encodings_carry_every_message() {
    for value in good() {
        let [by_json, by_pack] =
            ENCODINGS.map(|encoding| decode(encoding, &encoded(encoding, &value)).expect("a good message"));
        assert_eq!(by_json, by_pack);
        for encoding in ENCODINGS {
            let again = encoding.encode(&by_json).expect("a message can be encoded");
            assert_eq!(decode(encoding, again.bytes()).as_ref(), Ok(&by_json));
        }
    }
}

#[test]
fn the_servers_messages_come_back_as_they_went() {
    let pong = ClockPong { id: 1, client_time_micros: -2, server_received_micros: 3, server_sent_micros: 4 };
    let error = ClientError::at(ErrorCode::NotUnit, "orientation", "length 2", "length 1").fatal();
    for message in [ToClient::ClockPong(pong), ToClient::Error(error)] {
        for encoding in ENCODINGS {
            let frame = encoding.encode(&message).expect("a message can be encoded");
            assert_eq!(matches!(frame, Frame::Text(_)), encoding == Encoding::Json);
            assert_eq!(decode_from_server(encoding, frame.bytes()).as_ref(), Ok(&message));
        }
    }
}

#[test]
fn every_error_names_the_field_and_what_was_there() {
    let cases = [
        (json!({"type": "teleport"}), ErrorCode::UnknownMessage, "type", "`teleport`"),
        (json!({"person": "Ada"}), ErrorCode::MissingField, "type", "nothing"),
        (json!({"type": 3}), ErrorCode::WrongType, "type", "another value"),
        (json!({"type": "enter"}), ErrorCode::MissingField, "person", "nothing"),
        (json!({"type": "enter", "person": ""}), ErrorCode::OutOfRange, "person", "0 characters"),
        (json!({"type": "enter", "person": "a\nb"}), ErrorCode::OutOfRange, "person", "a control character"),
        (
            json!({"type": "hello", "name": "x", "convention": "vrml"}),
            ErrorCode::OutOfRange,
            "convention",
            "`vrml`",
        ),
        (
            changed(pose(), "/position/1", json!("high")),
            ErrorCode::WrongType,
            "position[1]",
            "string \"high\"",
        ),
        (changed(pose(), "/position", json!([1, 2])), ErrorCode::WrongType, "position", "length 2"),
        (changed(pose(), "/position/0", json!(1e9)), ErrorCode::OutOfRange, "position[0]", "1000000000"),
        (changed(pose(), "/hands/left/2", json!(null)), ErrorCode::WrongType, "hands.left[2]", "null"),
        (changed(pose(), "/sequence", json!(-1)), ErrorCode::OutOfRange, "sequence", "integer `-1`"),
        (changed(pose(), "/tracked", json!(1)), ErrorCode::WrongType, "tracked", "integer `1`"),
        (
            changed(pose(), "/orientation/3", json!(1.002)),
            ErrorCode::NotUnit,
            "orientation",
            "a quaternion of length 1.002000",
        ),
        (
            json!({"type": "scene_event", "name": "x", "detail": "y".repeat(5_000)}),
            ErrorCode::OutOfRange,
            "detail",
            "5002 bytes of JSON",
        ),
    ];
    for (value, code, field, found) in cases {
        let error = refused(&value);
        assert_eq!((error.code, error.field.as_deref()), (code, Some(field)), "{error}");
        assert_eq!(error.found.as_deref(), Some(found));
        assert!(error.expected.as_ref().is_some_and(|expected| !expected.is_empty()), "{error}");
        assert!(error.message.starts_with(field) && !error.fatal);
    }
}

#[test]
fn a_field_that_nobody_knows_is_refused_by_name() {
    let mut value = pose();
    value["hands"]["middle"] = json!([0, 0, 0]);
    let error = refused(&value);
    assert_eq!((error.code, error.field.as_deref()), (ErrorCode::UnknownField, Some("hands.middle")));
    let mut value = pose();
    value["postion"] = json!(1);
    let error = refused(&value);
    assert_eq!((error.code, error.field.as_deref()), (ErrorCode::UnknownField, Some("postion")));
}

#[test]
fn a_number_that_is_none_is_refused_where_it_is() {
    for number in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let frame =
            rmp_serde::to_vec_named(&PackedPose { r#type: "pose", position: [0.0, number, 0.0] }).unwrap();
        let error = decode(Encoding::MessagePack, &frame).unwrap_err();
        assert_eq!(
            (error.code, error.field.as_deref()),
            (ErrorCode::NotFinite, Some("position[1]")),
            "{error}"
        );
    }
    let too_large = br#"{"type": "pose", "position": [0, 1e999, 0]}"#;
    let error = decode(Encoding::Json, too_large).unwrap_err();
    assert_eq!(error.field.as_deref(), Some("position[1]"), "{error}");
    assert!(decode(Encoding::Json, br#"{"type": "pose", "position": [NaN, 0, 0]}"#).is_err());
}

#[derive(serde::Serialize)]
struct PackedPose {
    r#type: &'static str,
    position: [f64; 3],
}

#[test]
fn a_key_twice_and_a_second_message_are_refused() {
    let twice = decode(Encoding::Json, br#"{"type": "enter", "person": "a", "person": "b"}"#).unwrap_err();
    assert_eq!((twice.code, twice.found.as_deref()), (ErrorCode::UnknownField, Some("`person` twice")));
    for encoding in ENCODINGS {
        let mut two = encoded(encoding, &good()[2]);
        two.extend(two.clone());
        assert_eq!(decode(encoding, &two).unwrap_err().code, ErrorCode::Malformed);
    }
}

#[test]
fn an_oversized_frame_is_refused_unread() {
    let error = decode(Encoding::Json, &vec![b' '; MAX_FRAME_BYTES + 1]).unwrap_err();
    assert_eq!(error.code, ErrorCode::FrameTooLarge);
    assert_eq!(error.found.as_deref(), Some("a frame of 16385 bytes"));
}

#[test]
fn a_deep_frame_is_refused() {
    let deep_json = format!("{{\"type\": {}", "[".repeat(MAX_FRAME_BYTES - 20));
    assert!(decode(Encoding::Json, deep_json.as_bytes()).is_err());
    assert!(decode(Encoding::MessagePack, &vec![0x91; MAX_FRAME_BYTES]).is_err());
}

/// A good message with one value somewhere in it replaced, or one key renamed.
fn mutated() -> impl Strategy<Value = Value> {
    let odd = prop_oneof![
        Just(Value::Null),
        any::<bool>().prop_map(Value::from),
        any::<i64>().prop_map(Value::from),
        any::<u64>().prop_map(Value::from),
        any::<f64>().prop_map(Value::from),
        ".{0,80}".prop_map(Value::from),
        prop::collection::vec(any::<f64>(), 0..6).prop_map(Value::from),
        Just(json!({})),
    ];
    (prop::sample::select(good()), any::<prop::sample::Index>(), odd, any::<bool>()).prop_map(
        |(mut value, at, odd, renames)| {
            let mut pointers = Vec::new();
            walk(&value, "", &mut pointers);
            let pointer = at.get(&pointers).clone();
            if renames && let Some((parent, key)) = pointer.rsplit_once('/') {
                if let Some(Value::Object(fields)) = value.pointer_mut(parent)
                    && let Some(moved) = fields.remove(key)
                {
                    fields.insert(format!("{key}_"), moved);
                }
            } else if let Some(place) = value.pointer_mut(&pointer) {
                *place = odd;
            }
            value
        },
    )
}

fn walk(value: &Value, at: &str, pointers: &mut Vec<String>) {
    pointers.push(at.to_owned());
    match value {
        Value::Object(fields) => {
            fields.iter().for_each(|(key, v)| walk(v, &format!("{at}/{key}"), pointers));
        }
        Value::Array(items) => {
            items.iter().enumerate().for_each(|(i, v)| walk(v, &format!("{at}/{i}"), pointers));
        }
        _ => {}
    }
}

/// What must hold of anything that was let through.
fn is_sound(message: &FromClient) -> bool {
    let FromClient::Pose(pose) = message else { return true };
    let norm = pose.orientation.iter().map(|part| part * part).sum::<f64>().sqrt();
    pose.position.iter().all(|c| c.is_finite()) && (norm - 1.0).abs() <= 1e-3 && !pose.person.is_empty()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2_000))]

    #[test]
    fn random_bytes_are_refused_or_sound(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        for encoding in ENCODINGS {
            if let Ok(message) = decode(encoding, &bytes) {
                prop_assert!(is_sound(&message));
            }
        }
    }

    #[test]
    fn mutated_messages_are_refused_or_sound_and_alike(value in mutated()) {
        let [by_json, by_pack] = ENCODINGS.map(|encoding| decode(encoding, &encoded(encoding, &value)));
        prop_assert_eq!(&by_json, &by_pack);
        match by_json {
            Ok(message) => prop_assert!(is_sound(&message)),
            Err(error) => prop_assert!(!error.message.is_empty() && error.message.len() < 1_000),
        }
    }

    #[test]
    fn a_position_arrives_to_the_last_bit(position in prop::array::uniform3(-100.0_f64..100.0)) {
        let value = changed(pose(), "/position", json!(position));
        for encoding in ENCODINGS {
            let FromClient::Pose(pose) = decode(encoding, &encoded(encoding, &value)).expect("a good pose") else {
                panic!("another message");
            };
            prop_assert_eq!(pose.position.map(f64::to_bits), position.map(f64::to_bits));
        }
    }

    #[test]
    fn damaged_frames_are_refused_or_sound(
        value in prop::sample::select(good()),
        at in any::<prop::sample::Index>(),
        byte: u8,
        cut in any::<prop::sample::Index>(),
    ) {
        for encoding in ENCODINGS {
            let mut frame = encoded(encoding, &value);
            let place = at.index(frame.len());
            frame[place] = byte;
            for part in [&frame[..], &frame[..cut.index(frame.len())]] {
                if let Ok(message) = decode(encoding, part) {
                    prop_assert!(is_sound(&message));
                }
            }
        }
    }
}
