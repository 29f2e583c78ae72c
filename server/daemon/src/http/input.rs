//! What callers send: bodies, names, limits.

use axum::extract::FromRequestParts;
use axum::http::HeaderMap;
use axum::http::request::Parts;
use covr_wire::complaint::Complaint;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use utoipa::{IntoParams, ToSchema};

use super::problem::{Problem, ProblemItem};
use crate::access::Caller;
use crate::app::Asker;

/// Why, in the asker's words.
#[derive(Debug, Clone, Default, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ReasonBody {
    /// Why; due for a reset.
    #[serde(default)]
    pub reason: Option<String>,
}

/// How many rows.
#[derive(Debug, Clone, Copy, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
pub struct Limit {
    /// Most rows, 1 to 10000; 100 when not given.
    pub limit: Option<u32>,
}

impl Limit {
    /// Rows, or a refusal.
    pub fn rows(self) -> Result<u32, Problem> {
        match self.limit.unwrap_or(DEFAULT_ROWS) {
            rows @ 1..=MOST_ROWS => Ok(rows),
            found => Err(invalid_item("limit", found, "a whole number from 1 to 10000")),
        }
    }
}

impl ReasonBody {
    /// An empty body is no reason given.
    pub fn read(body: &[u8]) -> Result<Option<String>, Problem> {
        if body.iter().all(u8::is_ascii_whitespace) {
            return Ok(None);
        }
        let Self { reason } = json(body)?;
        let reason = reason.map(|words| words.trim().to_owned()).filter(|words| !words.is_empty());
        match reason {
            Some(words) if words.chars().count() > MOST_REASON_CHARS => {
                let found = format!("{} characters", words.chars().count());
                Err(invalid_item("reason", found, "at most 500 characters"))
            }
            reason => Ok(reason),
        }
    }
}

/// The caller whom the gate let in, under the name of the `X-Covr-Author` header (percent-encoded where it is not
/// plain ASCII).
impl<S: Send + Sync> FromRequestParts<S> for Asker {
    type Rejection = Problem;

    async fn from_request_parts(parts: &mut Parts, _: &S) -> Result<Self, Problem> {
        let given = author(&parts.headers)?;
        Ok(Self { by: "http", given, caller: caller(parts) })
    }
}

/// Whom the gate let in.
pub fn caller(parts: &Parts) -> Caller {
    parts.extensions.get().cloned().unwrap_or(Caller::Stranger)
}

fn author(headers: &HeaderMap) -> Result<Option<String>, Problem> {
    let Some(header) = headers.get(AUTHOR_HEADER) else { return Ok(None) };
    let name = percent_encoding::percent_decode(header.as_bytes())
        .decode_utf8()
        .map(|name| name.trim().to_owned())
        .unwrap_or_default();
    if name.is_empty() || name.chars().count() > 64 || name.chars().any(char::is_control) {
        return Err(invalid_item(AUTHOR_HEADER, "another text", "1 to 64 printable characters"));
    }
    Ok(Some(name))
}

/// Read a JSON body; a refusal names path, line and column.
pub fn json<T: DeserializeOwned>(body: &[u8]) -> Result<T, Problem> {
    let mut reader = serde_json::Deserializer::from_slice(body);
    let value = serde_path_to_error::deserialize(&mut reader).map_err(|error| {
        let path = error.path().to_string();
        let path = if path == "." { String::new() } else { path };
        refused_json(path, error.inner())
    })?;
    reader.end().map_err(|error| refused_json(String::new(), &error))?;
    Ok(value)
}

/// One invalid value.
pub fn invalid_item(path: &str, found: impl ToString, expected: &str) -> Problem {
    let found = found.to_string();
    Problem::invalid(
        format!("{path}: found {found}, expected {expected}"),
        vec![ProblemItem::new(path, found, expected)],
    )
}

fn refused_json(path: String, error: &serde_json::Error) -> Problem {
    let (line, column) = (error.line(), error.column());
    let Complaint { key, found, expected, .. } = Complaint::parse(&error.to_string(), "JSON");
    let path = [path, key.unwrap_or_default()].into_iter().filter(|part| !part.is_empty());
    let path = path.collect::<Vec<_>>().join(".");
    let item = ProblemItem {
        line: u32::try_from(line).ok(),
        column: u32::try_from(column).ok(),
        ..ProblemItem::new(path, found, expected)
    };
    let ProblemItem { path, found, expected, .. } = &item;
    let place = if path.is_empty() { String::new() } else { format!("{path}: ") };
    let detail = format!("line {line}, column {column}: {place}found {found}, expected {expected}");
    Problem::malformed(detail, vec![item])
}

const AUTHOR_HEADER: &str = "x-covr-author";
const MOST_REASON_CHARS: usize = 500;
const DEFAULT_ROWS: u32 = 100;
const MOST_ROWS: u32 = 10_000;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn malformed_json_says_where() {
        let problem = json::<ReasonBody>(b"{\n  \"reason\": }").unwrap_err();
        assert_eq!(problem.status, 400);
        assert_eq!((problem.errors[0].line, problem.errors[0].column), (Some(2), Some(13)));
    }

    #[test]
    fn a_wrong_type_names_its_field() {
        let problem = json::<ReasonBody>(b"{\"reason\": 3}").unwrap_err();
        assert_eq!(problem.errors[0].path, "reason");
        assert!(problem.errors[0].found.contains("integer `3`"), "{problem:?}");
    }

    #[test]
    fn what_follows_the_document_is_refused() {
        assert!(json::<ReasonBody>(b"{} {}").is_err());
    }

    #[test]
    fn no_body_is_no_reason_and_blanks_are_none() {
        assert_eq!(ReasonBody::read(b" \n").unwrap(), None);
        assert_eq!(ReasonBody::read(b"{\"reason\": \"  \"}").unwrap(), None);
        assert_eq!(ReasonBody::read(b"{\"reason\": \" hand \"}").unwrap().as_deref(), Some("hand"));
        assert!(ReasonBody::read(format!("{{\"reason\": \"{}\"}}", "x".repeat(501)).as_bytes()).is_err());
    }
}
