//! The game master's own: notes for the record, and the checklist before a start.

use std::sync::Arc;

use axum::Json;
use axum::body::Bytes;
use axum::extract::{Path, State};
use axum::http::StatusCode;
use serde::{Deserialize, Serialize};
use serde_json::json;
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::input::{invalid_item, json as read_json};
use super::problem::Problem;
use crate::app::{App, Asker};
use crate::checklist::{ChecklistNow, Start};
use crate::recorder::Settled;

/// A note.
#[derive(Debug, Clone, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
#[schema(example = json!({ "text": "the visitor laughed at the wall" }))]
pub struct NoteBody {
    /// What is to be remembered; 1 to 1000 characters.
    pub text: String,
}

/// A note is in the record.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[schema(example = json!({ "session": 12 }))]
pub struct Noted {
    /// The session that it is of; null between two.
    pub session: Option<i64>,
}

/// A tick, or none.
#[derive(Debug, Clone, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
#[schema(example = json!({ "ticked": true }))]
pub struct TickBody {
    /// It was looked at; false takes a tick back.
    pub ticked: bool,
}

/// The routes.
pub fn routes() -> OpenApiRouter<Arc<App>> {
    OpenApiRouter::new().routes(routes!(note)).routes(routes!(checklist)).routes(routes!(tick))
}

/// Write a note into the record, with who and when; it belongs to the running session.
#[utoipa::path(post, path = "/notes", tag = "record", request_body = NoteBody,
    responses((status = 201, body = Noted), (status = 400, description = "Not JSON, or not a note", body = Problem),
        (status = 422, description = "No text, or too long", body = Problem), (status = 503, description = "The database did not answer", body = Problem)))]
async fn note(
    State(app): State<Arc<App>>,
    asker: Asker,
    body: Bytes,
) -> Result<(StatusCode, Json<Noted>), Problem> {
    let NoteBody { text } = read_json(&body)?;
    let text = text.trim();
    let chars = text.chars().count();
    if !(1..=MOST_NOTE_CHARS).contains(&chars) {
        return Err(invalid_item("text", format!("{chars} characters"), "1 to 1000 characters"));
    }
    let session = app.recorder.session_id();
    app.recorder.record("note", format!("{asker}: {text}"), asker.sign(json!({ "text": text })));
    match app.recorder.settled().await {
        Settled::Stored => Ok((StatusCode::CREATED, Json(Noted { session }))),
        Settled::Lost => Err(Problem::unavailable(covr_wire::reason::Reason::DatabaseSilent)),
    }
}

/// What is looked at before the machine is armed, and who has. Ticks are for the next start: they end with the session, and with
/// another scene.
#[utoipa::path(get, path = "/checklist", tag = "record", responses((status = 200, body = ChecklistNow)))]
async fn checklist(State(app): State<Arc<App>>) -> Json<ChecklistNow> {
    let start = start(&app).await;
    Json(app.checklist.now(start, &app.stage.active().document.checklist))
}

/// Tick an item of the checklist, or take its tick back.
#[utoipa::path(put, path = "/checklist/{item}", tag = "record", params(("item" = usize, Path, description = "Its place in the list, from 0")), request_body = TickBody,
    responses((status = 200, body = ChecklistNow), (status = 400, description = "Not JSON, or not a tick", body = Problem),
        (status = 422, description = "No such item", body = Problem)))]
async fn tick(
    State(app): State<Arc<App>>,
    asker: Asker,
    Path(item): Path<String>,
    body: Bytes,
) -> Result<Json<ChecklistNow>, Problem> {
    let TickBody { ticked } = read_json(&body)?;
    let start = start(&app).await;
    let of_scene = app.stage.active().document.checklist.clone();
    let by = ticked.then(|| asker.author());
    let now = item
        .parse()
        .ok()
        .and_then(|place| app.checklist.tick(start, &of_scene, place, by).map(|now| (place, now)));
    let Some((place, now)) = now else {
        return Err(invalid_item("item", format!("\"{item}\""), "the place of an item of the list, from 0"));
    };
    let item = &now.items[place];
    let verb = if ticked { "ticked" } else { "took back the tick of" };
    let detail = json!({ "item": place, "text": item.text, "id": item.id, "ticked": ticked });
    app.recorder.record("checklist_ticked", format!("{asker} {verb} \"{}\"", item.text), asker.sign(detail));
    Ok(Json(now))
}

/// The start that is next, or that the running session began with.
async fn start(app: &App) -> Start {
    let (scene, version) = app.stage.active().key();
    let ended = app.recorder.session_spans().await.into_iter().rev().find(|span| span.to_micros.is_some());
    (scene, version, ended.map(|span| span.id))
}

const MOST_NOTE_CHARS: usize = 1000;
