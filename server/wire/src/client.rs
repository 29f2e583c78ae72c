//! Client protocol v1, `/ws/v1/client`: what VR clients and the server say to each other.
//!
//! The same messages travel as JSON text frames or as MessagePack binary frames with named fields; the WebSocket
//! subprotocol says which. Every message is an object with a `type`. A field that is not in the protocol is refused
//! by name, so that a misspelt one cannot go unnoticed.
//!
//! Positions, velocities and orientations are in the client's own convention and units, both ways, as declared in its
//! hello. The scene alone is in the room frame, as its author wrote it; `client_from_room` takes its points into the
//! client's convention and units, and `places` gives every object's centre and heading there already.

mod check;
mod decode;
mod direct;
mod error;
mod outgoing;
mod pace;
mod to_client;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ts_rs::TS;

pub use decode::{DecodeFailed, decode, decode_from_server};
pub use error::{ClientError, ErrorCode};
pub use outgoing::POSE_RATE_HZ;
pub use pace::{AbuseGauge, MOST_POSES_PER_SEC, OTHER_MESSAGES_PER_SEC, OutOfOrder, Sequencer, Verdict};
pub use to_client::{
    ActiveScene, ClientLimits, ClockPong, ColumnNow, EventAnswered, InteractionNow, ObjectPlace, Prediction,
    PropAt, ScenarioNow, StopState, ToClient, Welcome,
};

/// The subprotocol of JSON text frames.
pub const JSON_SUBPROTOCOL: &str = "covr.v1.json";
/// The subprotocol of MessagePack binary frames with named fields.
pub const MSGPACK_SUBPROTOCOL: &str = "covr.v1.msgpack";
/// The longest frame from a client, bytes. A pose takes about 250 as JSON.
pub const MAX_FRAME_BYTES: usize = 16 * 1024;
/// The longest `detail` of a scene event, bytes as JSON.
pub const MAX_DETAIL_BYTES: usize = 4 * 1024;

/// How messages are written in frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Encoding {
    /// Text frames.
    Json,
    /// Binary frames, named fields.
    MessagePack,
}

/// One encoded message.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Frame {
    /// A text frame.
    Text(String),
    /// A binary frame.
    Binary(Vec<u8>),
}

/// What a client says.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema, TS)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum FromClient {
    /// First message of a connection.
    Hello(ClientHello),
    /// A person with a headset came into the arena.
    Enter(PersonName),
    /// A person left the arena.
    Leave(PersonName),
    /// Where a headset is.
    Pose(HeadPose),
    /// The tracking origin of a person's headset moved: recentre, relocalisation, taken off and on.
    OriginChanged(PersonName),
    /// A hand touches a virtual object.
    TouchBegan(Touch),
    /// It touches it no more.
    TouchEnded(Touch),
    /// Something of the client's own, for the record and for the scenario.
    SceneEvent(SceneEvent),
    /// One half of a clock exchange.
    ClockPing(ClockPing),
}

/// Who the client is, and how it counts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(deny_unknown_fields)]
pub struct ClientHello {
    /// For people; 1 to 64 characters.
    #[schemars(length(min = 1, max = 64))]
    pub name: String,
    /// Axes and units of everything it sends and wants to be sent.
    pub convention: Convention,
    /// The word that lets it in, where the server asks for one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[ts(as = "Option<String>")]
    pub token: Option<Token>,
    /// It will send hands.
    #[serde(default)]
    #[ts(optional, as = "Option<bool>")]
    pub hands: bool,
}

/// A word that lets a client in. Never printed.
#[derive(Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Token(String);

/// Which way a client's axes go, and its unit of length.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema, TS)]
#[serde(rename_all = "snake_case")]
pub enum Convention {
    /// OpenXR and WebXR: right-handed, +x right, +y up, -z forward, metres.
    Openxr,
    /// Unity: left-handed, +x right, +y up, +z forward, metres.
    Unity,
    /// Unreal Engine: left-handed, +x forward, +y right, +z up, centimetres.
    Unreal,
    /// Godot and three.js: right-handed, +x right, +y up, -z forward, metres.
    Godot,
    /// SteamVR (OpenVR): right-handed, +x right, +y up, -z forward, metres.
    Steamvr,
    /// ROS REP 103: right-handed, +x forward, +y left, +z up, metres.
    Ros,
}

/// A person by the client's own name for them.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(deny_unknown_fields)]
pub struct PersonName {
    /// 1 to 64 characters; unique on the connection.
    #[schemars(length(min = 1, max = 64))]
    pub person: String,
}

/// Where a headset is, in the client's convention and units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(deny_unknown_fields)]
pub struct HeadPose {
    /// Whose.
    pub person: String,
    /// Grows with every pose of this person; after 4294967295 comes 0.
    pub sequence: u32,
    /// When the headset was there, on the client's clock, microseconds from any start.
    pub client_time_micros: i64,
    /// Of the head.
    pub position: [f64; 3],
    /// Unit quaternion x, y, z, w; no rotation looks along the convention's forward axis.
    pub orientation: [f64; 4],
    /// The headset knows its place.
    pub tracked: bool,
    /// The headset is on a head.
    pub worn: bool,
    /// The hands, where known: evidence of which object is meant.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hands: Option<Hands>,
}

/// Where the hands are, in the client's convention and units.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, JsonSchema, TS)]
#[serde(deny_unknown_fields)]
pub struct Hands {
    /// The left one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub left: Option<[f64; 3]>,
    /// The right one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub right: Option<[f64; 3]>,
}

/// A touch of a virtual object, as the client sees it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(deny_unknown_fields)]
pub struct Touch {
    /// Who.
    pub person: String,
    /// The object's id in the active scene.
    pub object: String,
    /// When, on the client's clock, microseconds.
    pub client_time_micros: i64,
}

/// Something of the client's own, for the record and for the scenario: a transition may wait for its name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(deny_unknown_fields)]
pub struct SceneEvent {
    /// 1 to 64 characters.
    #[schemars(length(min = 1, max = 64))]
    pub name: String,
    /// Any JSON, at most 4096 bytes of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[ts(type = "unknown")]
    pub detail: Option<serde_json::Value>,
}

/// One half of a clock exchange. The server answers with a pong; the next ping says when that pong came, which
/// gives the server all four times of the exchange before.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(deny_unknown_fields)]
pub struct ClockPing {
    /// The client's number of this ping.
    pub id: u32,
    /// When it was sent, on the client's clock, microseconds.
    pub client_time_micros: i64,
    /// When the pong of an earlier ping was received.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub previous: Option<PongReceived>,
}

/// When a pong was received.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema, TS)]
#[serde(deny_unknown_fields)]
pub struct PongReceived {
    /// Of the ping that it answered.
    pub id: u32,
    /// On the client's clock, microseconds.
    pub received_client_time_micros: i64,
}

impl Encoding {
    /// The encoding of the first offered subprotocol that the server speaks, with its name; none if it speaks none of them.
    ///
    /// A client that offers no subprotocol at all speaks JSON: that is the caller's to decide.
    pub fn negotiate<'a>(offered: impl IntoIterator<Item = &'a str>) -> Option<(Self, &'static str)> {
        offered.into_iter().find_map(|name| match name.trim() {
            JSON_SUBPROTOCOL => Some((Self::Json, JSON_SUBPROTOCOL)),
            MSGPACK_SUBPROTOCOL => Some((Self::MessagePack, MSGPACK_SUBPROTOCOL)),
            _ => None,
        })
    }

    /// A message as a frame.
    pub fn encode<M: Serialize>(self, message: &M) -> Result<Frame, EncodeFailed> {
        match self {
            Self::Json => {
                serde_json::to_string(message).map(Frame::Text).map_err(|e| EncodeFailed(e.to_string()))
            }
            Self::MessagePack => {
                rmp_serde::to_vec_named(message).map(Frame::Binary).map_err(|e| EncodeFailed(e.to_string()))
            }
        }
    }
}

/// A message that cannot be written: a bug of the sender.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("a message cannot be encoded: {0}")]
pub struct EncodeFailed(String);

impl Frame {
    /// Its bytes.
    pub fn bytes(&self) -> &[u8] {
        match self {
            Self::Text(text) => text.as_bytes(),
            Self::Binary(bytes) => bytes,
        }
    }
}

impl Token {
    /// From what was read or configured.
    pub fn new(word: impl Into<String>) -> Self {
        Self(word.into())
    }

    /// The word, for comparison.
    pub fn expose(&self) -> &str {
        &self.0
    }
}

impl std::fmt::Debug for Token {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Token(…)")
    }
}

impl Convention {
    /// Every convention.
    pub const ALL: [Self; 6] =
        [Self::Openxr, Self::Unity, Self::Unreal, Self::Godot, Self::Steamvr, Self::Ros];

    /// Its name on the wire.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Openxr => "openxr",
            Self::Unity => "unity",
            Self::Unreal => "unreal",
            Self::Godot => "godot",
            Self::Steamvr => "steamvr",
            Self::Ros => "ros",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_offer_that_is_known_wins() {
        assert_eq!(
            Encoding::negotiate(["chat", " covr.v1.msgpack", "covr.v1.json"]).map(|(_, n)| n),
            Some(MSGPACK_SUBPROTOCOL)
        );
        assert_eq!(Encoding::negotiate(["covr.v2.json"]), None);
        assert_eq!(Encoding::negotiate([]), None);
    }

    #[test]
    fn a_token_is_never_printed() {
        let hello = ClientHello {
            name: "headset".into(),
            convention: Convention::Unity,
            token: Some(Token::new("hunter2")),
            hands: false,
        };
        assert!(!format!("{hello:?}").contains("hunter2"));
    }

    #[test]
    fn a_convention_is_named_alike_everywhere() {
        for convention in Convention::ALL {
            assert_eq!(serde_json::to_value(convention).unwrap(), convention.name());
        }
    }
}
