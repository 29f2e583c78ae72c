//! Errors as RFC 9457 problem documents, whatever layer they come from.

use axum::Json;
use axum::body::Body;
use axum::extract::Request;
use axum::http::{HeaderValue, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use covr_wire::phrase::Phrase;
use covr_wire::reason::Reason;
use serde::{Deserialize, Serialize};
use ts_rs::TS;
use utoipa::ToSchema;

use crate::access::NotLetIn;
use crate::control::NotDelivered;
use crate::store::StoreError;

/// A refusal or a failure, `application/problem+json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema, TS)]
pub struct Problem {
    /// What kind of problem, as a URN that stays.
    #[serde(rename = "type")]
    pub kind: String,
    /// The kind in a few words.
    #[schema(value_type = String)]
    pub title: Box<str>,
    /// The HTTP status.
    pub status: u16,
    /// What happened this time, in plain words.
    #[schema(value_type = String)]
    pub detail: Box<str>,
    /// The same as an id and its values, where it is one of the known reasons.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(schema_with = reason_schema)]
    #[ts(optional, type = "import(\"../generated/Reason\").Reason")]
    pub why: Option<Box<Reason>>,
    /// The detail as an id and its values, where it is one of the known phrases.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(schema_with = phrase_schema)]
    #[ts(optional, type = "import(\"../generated/Phrase\").Phrase")]
    pub detail_as: Option<Box<Phrase>>,
    /// The path that was asked.
    #[schema(value_type = String)]
    pub instance: Box<str>,
    /// What is wrong, place by place.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[ts(optional, as = "Option<Vec<ProblemItem>>")]
    pub errors: Vec<ProblemItem>,
}

/// One thing that is wrong.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema, TS)]
pub struct ProblemItem {
    /// Where in the document: `objects[2].position`; empty for the document itself.
    pub path: String,
    /// What was found.
    pub found: String,
    /// What was expected.
    pub expected: String,
    /// What was found as an id and its values; none: a value as it stands.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(schema_with = phrase_schema)]
    #[ts(optional, type = "import(\"../generated/Phrase\").Phrase")]
    pub found_as: Option<Box<Phrase>>,
    /// What was expected as an id and its values; none: a value as it stands.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schema(schema_with = phrase_schema)]
    #[ts(optional, type = "import(\"../generated/Phrase\").Phrase")]
    pub expected_as: Option<Box<Phrase>>,
    /// Line in the text, from 1, where known.
    pub line: Option<u32>,
    /// Column in the text, from 1, where known.
    pub column: Option<u32>,
}

impl ProblemItem {
    /// What is wrong at a path; its place in the text is not known.
    pub fn new(path: impl Into<String>, found: impl Into<String>, expected: impl Into<String>) -> Self {
        let (found, expected) = (found.into(), expected.into());
        let (found_as, expected_as) = (Phrase::of(&found).map(Box::new), Phrase::of(&expected).map(Box::new));
        Self { path: path.into(), found, expected, found_as, expected_as, line: None, column: None }
    }
}

impl Problem {
    /// A problem of a kind; the kind's name ends its URN.
    pub fn new(status: StatusCode, kind: &str, title: &str, detail: impl Into<String>) -> Self {
        let detail: Box<str> = detail.into().into();
        Self {
            kind: format!("urn:covr:problem:{kind}"),
            title: title.into(),
            status: status.as_u16(),
            detail_as: Phrase::of(&detail).map(Box::new),
            detail,
            why: None,
            instance: Box::default(),
            errors: Vec::new(),
        }
    }

    /// The machine or the scene does not allow it now.
    pub fn refused(why: Reason) -> Self {
        Self::new(StatusCode::CONFLICT, "refused", "Refused", why.to_string()).because(why)
    }

    /// Well-formed, but not something that can be.
    pub fn invalid(detail: impl Into<String>, errors: Vec<ProblemItem>) -> Self {
        Self { errors, ..Self::new(StatusCode::UNPROCESSABLE_ENTITY, "invalid", "Invalid", detail) }
    }

    /// Not JSON, or not the fields that are due.
    pub fn malformed(detail: impl Into<String>, errors: Vec<ProblemItem>) -> Self {
        Self { errors, ..Self::new(StatusCode::BAD_REQUEST, "malformed", "Malformed", detail) }
    }

    /// There is no such thing.
    pub fn not_found(why: Reason) -> Self {
        Self::new(StatusCode::NOT_FOUND, "not-found", "Not found", why.to_string()).because(why)
    }

    /// Nobody who is known.
    pub fn unauthorized(detail: impl Into<String>) -> Self {
        Self::new(StatusCode::UNAUTHORIZED, "unauthorized", "Not signed in", detail)
    }

    /// Not for this asker.
    pub fn forbidden(detail: impl Into<String>) -> Self {
        Self::new(StatusCode::FORBIDDEN, "forbidden", "Forbidden", detail)
    }

    /// Too often.
    pub fn too_many(detail: impl Into<String>) -> Self {
        Self::new(StatusCode::TOO_MANY_REQUESTS, "too-many", "Too many requests", detail)
    }

    /// It could be done at another time.
    pub fn unavailable(why: Reason) -> Self {
        Self::new(StatusCode::SERVICE_UNAVAILABLE, "unavailable", "Unavailable", why.to_string()).because(why)
    }

    /// What a bare status means.
    pub fn of_status(status: StatusCode) -> Self {
        let title = status.canonical_reason().unwrap_or("Error");
        let (kind, detail) = match status {
            StatusCode::NOT_FOUND => ("not-found", "there is nothing at this path"),
            StatusCode::METHOD_NOT_ALLOWED => ("method-not-allowed", "this path does not take this method"),
            StatusCode::PAYLOAD_TOO_LARGE => ("too-large", "the body is larger than 4 MiB"),
            StatusCode::REQUEST_TIMEOUT => ("timeout", "the request took too long"),
            StatusCode::INTERNAL_SERVER_ERROR => ("internal", "the server failed; its log says why"),
            _ => ("http", title),
        };
        Self::new(status, kind, title, detail)
    }

    fn because(self, why: Reason) -> Self {
        Self { why: Some(Box::new(why)), ..self }
    }
}

impl IntoResponse for Problem {
    /// [`finish`] adds the path.
    fn into_response(self) -> Response {
        let status = StatusCode::from_u16(self.status).unwrap_or(StatusCode::INTERNAL_SERVER_ERROR);
        let mut response = status.into_response();
        response.extensions_mut().insert(self);
        response
    }
}

impl From<StoreError> for Problem {
    fn from(error: StoreError) -> Self {
        tracing::error!(%error, "the store failed");
        Self::unavailable(Reason::DatabaseSilent)
    }
}

impl From<NotLetIn> for Problem {
    fn from(why: NotLetIn) -> Self {
        match why {
            NotLetIn::NotInForce => Self::unauthorized(why.to_string()),
            NotLetIn::Store(error) => error.into(),
            NotLetIn::Random(_) => {
                Self::new(StatusCode::SERVICE_UNAVAILABLE, "unavailable", "Unavailable", why.to_string())
            }
        }
    }
}

impl From<NotDelivered> for Problem {
    fn from(error: NotDelivered) -> Self {
        match error {
            NotDelivered::NotAsked(why) => Self::refused(*why),
            error => Self::unavailable(error.reason()),
        }
    }
}

/// Give every error under /api the form of a problem, with the path that was asked.
pub async fn finish(request: Request, next: Next) -> Response {
    let path = request.uri().path().to_owned();
    let mut response = next.run(request).await;
    let status = response.status();
    let is_error = status.is_client_error() || status.is_server_error();
    let known = response.extensions_mut().remove::<Problem>();
    let in_api = path.starts_with("/api/");
    let mut problem = match known {
        Some(problem) => problem,
        None if is_error && in_api => Problem::of_status(status),
        None => return response,
    };
    problem.instance = path.into();
    let (mut parts, _) = response.into_parts();
    let body = Json(problem).into_response().into_body();
    parts.headers.remove(header::CONTENT_LENGTH);
    parts.headers.insert(header::CONTENT_TYPE, HeaderValue::from_static(PROBLEM_JSON));
    Response::from_parts(parts, Body::new(body))
}

/// The wire's own schema, which the document has.
fn reason_schema() -> utoipa::openapi::Ref {
    utoipa::openapi::Ref::from_schema_name("Reason")
}

fn phrase_schema() -> utoipa::openapi::Ref {
    utoipa::openapi::Ref::from_schema_name("Phrase")
}

/// The media type.
pub const PROBLEM_JSON: &str = "application/problem+json";
