//! What is wrong with what a client said: which field, what was found, what was expected.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use ts_rs::TS;

use crate::complaint::{Complaint, Fault};

/// A refused message. It changes nothing.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error, Serialize, Deserialize, JsonSchema, TS)]
#[error("{message}")]
pub struct ClientError {
    /// What kind of wrong.
    pub code: ErrorCode,
    /// The field, as a path: `hands.left[2]`; none for the message as a whole.
    pub field: Option<String>,
    /// What was found there.
    pub found: Option<String>,
    /// What was expected there.
    pub expected: Option<String>,
    /// All of it in plain words.
    pub message: String,
    /// The connection is closed after it.
    pub fatal: bool,
}

/// What kind of wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema, TS)]
#[serde(rename_all = "snake_case")]
pub enum ErrorCode {
    /// Longer than a frame may be.
    FrameTooLarge,
    /// A text frame where the subprotocol says binary, or the other way.
    WrongFrame,
    /// Not JSON, not MessagePack.
    Malformed,
    /// A `type` that the protocol does not have.
    UnknownMessage,
    /// A field that the message does not have, or has twice.
    UnknownField,
    /// A field that must be there is not.
    MissingField,
    /// Another type of value.
    WrongType,
    /// A value that cannot be.
    OutOfRange,
    /// NaN or infinite.
    NotFinite,
    /// A quaternion farther than 0.001 from unit length.
    NotUnit,
    /// A pose that is not newer than the last.
    OutOfOrder,
    /// More messages than the protocol allows.
    TooManyMessages,
    /// The first message must be a hello.
    HelloExpected,
    /// A second hello.
    AlreadyGreeted,
    /// The client's calibration was made on other hardware, and the machine is armed.
    NotCalibrated,
    /// No word, or a wrong one.
    Unauthorized,
    /// A person who has not entered.
    UnknownPerson,
    /// A person who has entered already.
    AlreadyEntered,
    /// An object that the active scene does not have.
    UnknownObject,
    /// The server has as many clients or persons as it takes.
    Full,
}

impl ClientError {
    /// About one field.
    pub fn at(
        code: ErrorCode,
        field: impl Into<String>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Self {
        let (field, found, expected) = (field.into(), found.into(), expected.into());
        let message = if field.is_empty() {
            format!("found {found}, expected {expected}")
        } else {
            format!("{field}: found {found}, expected {expected}")
        };
        Self {
            code,
            field: Some(field).filter(|f| !f.is_empty()),
            found: Some(found),
            expected: Some(expected),
            message,
            fatal: false,
        }
    }

    /// About the message or the connection as a whole.
    pub fn plain(code: ErrorCode, message: impl Into<String>) -> Self {
        Self { code, field: None, found: None, expected: None, message: message.into(), fatal: false }
    }

    /// The same, with the connection closed after it.
    pub fn fatal(self) -> Self {
        Self { fatal: true, ..self }
    }

    /// What serde says of a value at a path.
    pub(crate) fn from_serde(path: &str, message: &str, format: &str) -> Self {
        let complaint = Complaint::parse(message, format);
        let code = match complaint.fault {
            Fault::Missing => ErrorCode::MissingField,
            Fault::UnknownField => ErrorCode::UnknownField,
            Fault::WrongType => ErrorCode::WrongType,
            Fault::OutOfRange => ErrorCode::OutOfRange,
            Fault::Malformed => ErrorCode::Malformed,
        };
        let mut field = if path == "." { String::new() } else { path.to_owned() };
        if let Some(key) = complaint.key {
            if !field.is_empty() {
                field.push('.');
            }
            field.push_str(&key);
        }
        Self::at(code, field, complaint.found, complaint.expected)
    }
}
