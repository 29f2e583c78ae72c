//! The machine: its state, what may be asked of it, and the stop.

use std::sync::Arc;
use std::time::{Duration, Instant};

use axum::Json;
use axum::body::{Bytes, to_bytes};
use axum::extract::{Path, Request, State};
use axum::http::HeaderValue;
use axum::http::header::CACHE_CONTROL;
use axum::response::{IntoResponse, Response};
use covr_engine::mode::RequestKind;
use covr_engine::observation::PersonId;
use covr_engine::{Answer, Outcome};
use covr_wire::reason::Reason;
use serde::{Deserialize, Serialize};
use ts_rs::TS;
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::input::{ReasonBody, caller, invalid_item};
use super::problem::Problem;
use crate::app::{App, Asker};
use crate::control::StopLaneName;

/// What came of a request.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema, TS)]
pub struct Answered {
    /// `accepted` or `already_so`; a refusal is a problem.
    pub outcome: String,
    /// What it did, in plain words.
    pub detail: String,
}

/// The stop reached the drive.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema, TS)]
pub struct StopAcknowledged {
    /// Always true: without an acknowledgement there is a problem instead.
    pub acknowledged: bool,
    /// From reception to the braking command written to the drive, microseconds.
    pub to_drive_micros: u64,
}

/// The routes.
pub fn routes() -> OpenApiRouter<Arc<App>> {
    OpenApiRouter::new()
        .routes(routes!(state))
        .routes(routes!(home))
        .routes(routes!(arm))
        .routes(routes!(disarm))
        .routes(routes!(reset))
        .routes(routes!(stop))
        .routes(routes!(confirm))
        .routes(routes!(left))
        .routes(routes!(clear))
}

/// The whole state now.
#[utoipa::path(get, path = "/state", tag = "machine",
    responses((status = 200, description = "The snapshot", body = ref("#/components/schemas/Snapshot"))))]
async fn state(State(app): State<Arc<App>>) -> Response {
    let snapshot = crate::live::wire_snapshot(&app, &app.control.published()).await;
    ([(CACHE_CONTROL, HeaderValue::from_static("no-store"))], Json(snapshot)).into_response()
}

/// Find the switches. Whoever asks says that the arena is clear.
#[utoipa::path(post, path = "/home", tag = "machine", request_body(content = ReasonBody, description = "May be empty"),
    responses((status = 200, body = Answered), (status = 409, description = "Refused", body = Problem), (status = 503, description = "Busy", body = Problem)))]
async fn home(State(app): State<Arc<App>>, asker: Asker, body: Bytes) -> Result<Json<Answered>, Problem> {
    ask(&app, &asker, RequestKind::Home, &body).await
}

/// Follow the visitor.
#[utoipa::path(post, path = "/arm", tag = "machine", request_body(content = ReasonBody, description = "May be empty"),
    responses((status = 200, body = Answered), (status = 409, description = "Refused", body = Problem), (status = 503, description = "Busy", body = Problem)))]
async fn arm(State(app): State<Arc<App>>, asker: Asker, body: Bytes) -> Result<Json<Answered>, Problem> {
    ask(&app, &asker, RequestKind::Arm, &body).await
}

/// Brake and release the drive.
#[utoipa::path(post, path = "/disarm", tag = "machine", request_body(content = ReasonBody, description = "May be empty"),
    responses((status = 200, body = Answered), (status = 409, description = "Refused", body = Problem), (status = 503, description = "Busy", body = Problem)))]
async fn disarm(State(app): State<Arc<App>>, asker: Asker, body: Bytes) -> Result<Json<Answered>, Problem> {
    ask(&app, &asker, RequestKind::Disarm, &body).await
}

/// Leave a latched stop or a fault. Starts nothing.
#[utoipa::path(post, path = "/reset", tag = "machine", request_body(content = ReasonBody, description = "The reason is due"),
    responses((status = 200, body = Answered), (status = 409, description = "Refused", body = Problem),
        (status = 422, description = "No reason given", body = Problem), (status = 503, description = "Busy", body = Problem)))]
async fn reset(State(app): State<Arc<App>>, asker: Asker, body: Bytes) -> Result<Json<Answered>, Problem> {
    if ReasonBody::read(&body)?.is_none() {
        return Err(invalid_item("reason", "nothing", "why the machine may leave its stop, in words"));
    }
    ask(&app, &asker, RequestKind::Reset, &body).await
}

/// The software stop. No body, header or origin keeps it from stopping: a bad or slow body costs the reason alone.
#[utoipa::path(post, path = "/stop", tag = "machine", request_body(content = ReasonBody, description = "May be empty"),
    responses((status = 200, body = StopAcknowledged), (status = 503, description = "The drive did not acknowledge", body = Problem)))]
async fn stop(
    State(app): State<Arc<App>>,
    asker: Result<Asker, Problem>,
    request: Request,
) -> Result<Json<StopAcknowledged>, Problem> {
    let received_at = Instant::now();
    let (parts, body) = request.into_parts();
    let body = tokio::time::timeout(LONGEST_STOP_BODY, to_bytes(body, MOST_STOP_BODY)).await;
    let reason = body.ok().and_then(Result::ok).and_then(|body| ReasonBody::read(&body).ok()).flatten();
    let asker = asker.unwrap_or_else(|_| Asker { by: "http", given: None, caller: caller(&parts) });
    let to_drive = app
        .stop(&asker, StopLaneName::Http, reason, received_at)
        .await
        .map_err(|why| Problem::unavailable(why.reason()))?;
    Ok(Json(StopAcknowledged { acknowledged: true, to_drive_micros: to_drive.as_micros() as u64 }))
}

/// The person stands on the floor mark again (R15).
#[utoipa::path(post, path = "/persons/{id}/confirm", tag = "machine", params(("id" = u32, Path, description = "The server's number of the person")),
    responses((status = 200, body = Answered), (status = 404, description = "Nobody of this number is inside", body = Problem),
        (status = 409, description = "Refused", body = Problem)))]
async fn confirm(
    State(app): State<Arc<App>>,
    asker: Asker,
    Path(id): Path<String>,
) -> Result<Json<Answered>, Problem> {
    let person = inside(&app, &id)?;
    answered(&app, &app.confirm_origin(&asker, person).await?)
}

/// The person, whose headset is lost, has left the arena (R10).
#[utoipa::path(post, path = "/persons/{id}/left", tag = "machine", params(("id" = u32, Path, description = "The server's number of the person")),
    responses((status = 200, body = Answered), (status = 404, description = "Nobody of this number is inside", body = Problem),
        (status = 409, description = "Refused: the headset is tracked", body = Problem)))]
async fn left(
    State(app): State<Arc<App>>,
    asker: Asker,
    Path(id): Path<String>,
) -> Result<Json<Answered>, Problem> {
    let person = inside(&app, &id)?;
    answered(&app, &app.confirm_left(&asker, person).await?)
}

/// Somebody looked: nobody is in the arena (R16). The word holds until somebody has been there, the next stop or disarming.
#[utoipa::path(post, path = "/arena/clear", tag = "machine",
    responses((status = 200, body = Answered), (status = 409, description = "Refused: somebody is in the arena", body = Problem),
        (status = 503, description = "Busy", body = Problem)))]
async fn clear(State(app): State<Arc<App>>, asker: Asker) -> Result<Json<Answered>, Problem> {
    answered(&app, &app.confirm_clear(&asker).await?)
}

fn inside(app: &App, id: &str) -> Result<PersonId, Problem> {
    let person = id.parse().ok().map(PersonId).filter(|person| app.persons.is_inside(*person));
    person.ok_or_else(|| Problem::not_found(Reason::PersonNotInside { person: id.into() }))
}

async fn ask(app: &App, asker: &Asker, kind: RequestKind, body: &[u8]) -> Result<Json<Answered>, Problem> {
    let reason = ReasonBody::read(body)?;
    answered(app, &app.request(asker, kind, reason).await?)
}

pub fn answered(app: &App, answer: &Answer) -> Result<Json<Answered>, Problem> {
    let why = app.reason(answer);
    let outcome = match answer.outcome {
        Outcome::Accepted => "accepted",
        Outcome::AlreadySo => "already_so",
        Outcome::Refused => return Err(Problem::refused(why)),
    };
    Ok(Json(Answered { outcome: outcome.into(), detail: why.to_string() }))
}

/// A stop does not wait longer for its own reason.
const LONGEST_STOP_BODY: Duration = Duration::from_millis(20);
const MOST_STOP_BODY: usize = 64 * 1024;
