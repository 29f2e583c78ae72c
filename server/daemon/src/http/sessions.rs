//! Sessions: the list, one of them, its recording, its export.

mod export;
mod stream;

use std::sync::Arc;
use std::time::SystemTime;

use axum::Json;
use axum::extract::{Path, Query, State};
use axum::http::header::{CACHE_CONTROL, CONTENT_DISPOSITION, CONTENT_TYPE};
use axum::response::{IntoResponse, Response};
use covr_wire::reason::Reason;
use covr_wire::records::{Session, SessionDetail};
use serde::Deserialize;
use utoipa::{IntoParams, ToSchema};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use self::stream::Stretch;
use super::input::{Limit, invalid_item};
use super::problem::Problem;
use crate::app::App;
use crate::store::SessionFilter;

#[derive(Debug, Clone, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct Which {
    /// Most rows, 1 to 10000; 100 when not given.
    #[param(example = 50)]
    limit: Option<u32>,
    /// Sessions whose scene, end (`latched stop`, `running`, ...) or persons' names have these words, whatever the
    /// case (of ASCII letters), or that have this number. At most 200 characters.
    #[param(example = "kitchen")]
    search: Option<String>,
    /// Sessions with a smaller number alone: the last of the page before.
    #[param(example = 120)]
    before: Option<i64>,
}

#[derive(Debug, Clone, Copy, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct WhichFrames {
    /// First moment, s from the session's start; its start when not given.
    #[param(example = 60.0)]
    from_secs: Option<f64>,
    /// Last moment, s from the session's start; its end when not given.
    #[param(example = 120.0)]
    to_secs: Option<f64>,
    /// Of frames nearer to each other than this, the first alone, s; every frame when not given.
    #[param(example = 0.1)]
    every_secs: Option<f64>,
}

#[derive(Debug, Clone, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
#[serde(deny_unknown_fields)]
struct WhichForm {
    /// `json` or `csv`.
    #[param(value_type = Form, inline, required = true, example = "csv")]
    format: Option<String>,
}

/// The form of an export.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ToSchema)]
#[schema(rename_all = "snake_case")]
pub enum Form {
    /// Everything in one document.
    Json,
    /// One row per frame and person.
    Csv,
}

/// The routes.
pub fn routes() -> OpenApiRouter<Arc<App>> {
    OpenApiRouter::new()
        .routes(routes!(sessions))
        .routes(routes!(session))
        .routes(routes!(frames))
        .routes(routes!(events))
        .routes(routes!(export))
}

/// Sessions, newest first.
#[utoipa::path(get, path = "/sessions", tag = "record", params(Which),
    responses(
        (status = 200, description = "Sessions", body = ref("#/components/schemas/SessionList"), example = json!([{
            "id": 12, "started_at": "2026-11-24T15:00:00.000000Z", "ended_at": "2026-11-24T15:20:00.500000Z",
            "how": "disarmed", "scene_id": 1, "scene_version": 3, "scene": "Kitchen", "length_secs": 1200.5,
            "reaches": 84, "reaches_served": 79, "stops": 1, "recorded_frames": 36015, "dropped_frames": 0,
            "recording_bytes": 5210334, "recording_removed_at": null}])),
        (status = 400, body = Problem, description = "A parameter that is not known, or not a number"),
        (status = 422, body = Problem, description = "Limit or search out of bounds"),
        (status = 503, body = Problem, description = "The database did not answer")))]
async fn sessions(
    State(app): State<Arc<App>>,
    Query(which): Query<Which>,
) -> Result<Json<Vec<Session>>, Problem> {
    let search = which.search.map(|words| words.trim().to_owned()).filter(|words| !words.is_empty());
    if let Some(words) = &search
        && words.chars().count() > MOST_SEARCH_CHARS
    {
        let found = format!("{} characters", words.chars().count());
        return Err(invalid_item("search", found, "at most 200 characters"));
    }
    let filter = SessionFilter { limit: Limit { limit: which.limit }.rows()?, before: which.before, search };
    Ok(Json(app.store.sessions(&filter, SystemTime::now()).await?))
}

/// One session.
#[utoipa::path(get, path = "/sessions/{id}", tag = "record", params(("id" = i64, Path, description = "The session's number", example = 12)),
    responses(
        (status = 200, description = "The session", body = ref("#/components/schemas/SessionDetail"), example = json!({
            "id": 12, "started_at": "2026-11-24T15:00:00.000000Z", "ended_at": null, "how": null, "scene_id": 1,
            "scene_version": 3, "scene": "Kitchen", "length_secs": 63.2, "reaches": 4, "reaches_served": 4, "stops": 0,
            "recorded_frames": 1890, "dropped_frames": 0, "recording_bytes": 270334, "recording_removed_at": null,
            "persons": ["Ada"], "scenes": [{"id": 1, "version": 3, "from_secs": 0.0}], "first_micros": 41200000,
            "last_micros": 104400000, "machine_shape": {"travel_m": [0.0, 0.0, 4.0, 4.0], "speed_mps": [1.0, 1.0],
            "acceleration_mps2": [3.0, 3.0], "braking_mps2": [4.0, 4.0]}})),
        (status = 404, body = Problem, description = "No session of this number"),
        (status = 503, body = Problem, description = "The database did not answer")))]
async fn session(
    State(app): State<Arc<App>>,
    Path(id): Path<String>,
) -> Result<Json<SessionDetail>, Problem> {
    Ok(Json(find(&app, &id).await?))
}

/// Frames of a session's recording, oldest first; at most 10000. A running session has what is stored so far, about a
/// second behind.
#[utoipa::path(get, path = "/sessions/{id}/frames", tag = "record",
    params(("id" = i64, Path, description = "The session's number", example = 12), WhichFrames),
    responses(
        (status = 200, description = "Frames", body = ref("#/components/schemas/RecordedFrames"), example = json!({"frames": [{
            "at_micros": 41233000, "mode": "following", "column": {"position_m": [2.0, 1.5], "velocity_mps": [0.4, 0.0],
            "commanded_m": [2.0034, 1.5], "proxy_m": [2.02, 1.5], "target_m": [3.0, 1.5], "serves": 1, "committed": "lamp",
            "activity": "approaching", "homed": true}, "persons": [{"id": 1, "name": "Ada", "head_m": [1.0, 2.0, 1.65],
            "yaw_rad": 0.2, "pitch_rad": -0.1, "tracked": true, "separation_radius_m": 0.35, "distance_m": 1.02,
            "required_m": 0.71}], "objects": [{"id": "lamp", "weight": 0.81, "probability": 0.9, "prior": 1.0}]}]})),
        (status = 400, body = Problem, description = "A parameter that is not known, or not a number"),
        (status = 404, body = Problem, description = "No session of this number"),
        (status = 422, body = Problem, description = "A stretch of no length, or of more than 10000 frames"),
        (status = 503, body = Problem, description = "The database did not answer")))]
async fn frames(
    State(app): State<Arc<App>>,
    Path(id): Path<String>,
    Query(which): Query<WhichFrames>,
) -> Result<Response, Problem> {
    let session = find(&app, &id).await?;
    let stretch = stretch(&session, which)?;
    let most = app.store.count_frames(session.session.id, stretch.from_micros, stretch.to_micros).await?;
    let most = stretch.thinned(most);
    if most > MOST_FRAMES {
        return Err(invalid_item(
            "every_secs",
            format!("up to {most} frames from from_secs to to_secs"),
            "at most 10000: a shorter stretch, or every_secs so that fewer are left",
        ));
    }
    let body = stream::body(move |lines| export::frames(app, session.session.id, stretch, lines));
    Ok(([(CONTENT_TYPE, "application/json"), (CACHE_CONTROL, "no-store")], body).into_response())
}

/// Events of a session, oldest first.
#[utoipa::path(get, path = "/sessions/{id}/events", tag = "record",
    params(("id" = i64, Path, description = "The session's number", example = 12)),
    responses(
        (status = 200, description = "Events", body = ref("#/components/schemas/EventList"), example = json!([{
            "at_micros": 41200000, "at": "2026-11-24T15:00:00.000000Z", "kind": "mode_changed",
            "summary": "ready to following: arm", "detail": {"from": "ready", "to": "following", "because": "arm"}}])),
        (status = 404, body = Problem, description = "No session of this number"),
        (status = 503, body = Problem, description = "The database did not answer")))]
async fn events(State(app): State<Arc<App>>, Path(id): Path<String>) -> Result<Response, Problem> {
    let id = find(&app, &id).await?.session.id;
    let body = stream::body(move |lines| export::events(app, id, lines));
    Ok(([(CONTENT_TYPE, "application/json"), (CACHE_CONTROL, "no-store")], body).into_response())
}

/// A session to take away, streamed. `json`: `{"session": SessionDetail, "scenes": [{"id", "version", "from_secs",
/// "document"}], "events": [Event], "frames": [RecordedFrame]}`. `csv` (RFC 4180, UTF-8): one row per frame and person,
/// and one without a person where nobody was there; the columns have their units in their names: `time_s` (from the
/// session's start), `at_micros`, `mode`, `activity`, `column_x_m`, `column_y_m`, `column_vx_mps`, `column_vy_mps`,
/// `commanded_x_m`, `commanded_y_m`, `proxy_x_m`, `proxy_y_m`, `target_x_m`, `target_y_m`, `serves_person`,
/// `committed_object`, `likeliest_object`, `likeliest_probability`, `person`, `person_name`, `head_x_m`, `head_y_m`,
/// `head_z_m`, `yaw_rad`, `pitch_rad`, `tracked`, `separation_radius_m`, `distance_m`, `required_m`. What is not known
/// is empty. A name that a spreadsheet would take for a formula has an apostrophe before it.
#[utoipa::path(get, path = "/sessions/{id}/export", tag = "record",
    params(("id" = i64, Path, description = "The session's number", example = 12), WhichForm),
    responses(
        (status = 200, description = "A download, `Content-Disposition: attachment`", content(
            (serde_json::Value = "application/json"), (String = "text/csv"))),
        (status = 404, body = Problem, description = "No session of this number"),
        (status = 422, body = Problem, description = "No such format"),
        (status = 503, body = Problem, description = "The database did not answer")))]
async fn export(
    State(app): State<Arc<App>>,
    Path(id): Path<String>,
    Query(WhichForm { format }): Query<WhichForm>,
) -> Result<Response, Problem> {
    let form = match format.as_deref() {
        Some("json") => Form::Json,
        Some("csv") => Form::Csv,
        found => return Err(invalid_item("format", found.unwrap_or("nothing"), "json or csv")),
    };
    let session = find(&app, &id).await?;
    let number = session.session.id;
    let (kind, ending) = match form {
        Form::Json => ("application/json", "json"),
        Form::Csv => ("text/csv; charset=utf-8; header=present", "csv"),
    };
    // The name of a session's start, without what files must not be called.
    let started: String =
        session.session.started_at.chars().filter(char::is_ascii_alphanumeric).take(15).collect();
    let name = format!("attachment; filename=\"covr-session-{number}-{started}.{ending}\"");
    let body = stream::body(move |lines| async move {
        match form {
            Form::Json => export::json(app, session, lines).await,
            Form::Csv => export::csv(app, session, lines).await,
        }
    });
    let headers =
        [(CONTENT_TYPE, kind.to_owned()), (CONTENT_DISPOSITION, name), (CACHE_CONTROL, "no-store".into())];
    Ok((headers, body).into_response())
}

/// The session of a number, as a path has it.
async fn find(app: &App, id: &str) -> Result<SessionDetail, Problem> {
    let number: Option<i64> = id.parse().ok();
    let found = match number {
        Some(number) => app.store.session(number, SystemTime::now()).await?,
        None => None,
    };
    found.ok_or_else(|| Problem::not_found(Reason::NoSession { session: id.into() }))
}

/// From seconds of a session to server time.
fn stretch(session: &SessionDetail, which: WhichFrames) -> Result<Stretch, Problem> {
    let start = session.first_micros.unwrap_or(0);
    let micros = |name: &str, secs: Option<f64>, otherwise: i64| match secs {
        None => Ok(otherwise),
        Some(secs) if (0.0..=LONGEST_SECS).contains(&secs) => Ok(start + (secs * 1e6).round() as i64),
        Some(found) => Err(invalid_item(name, found, "seconds from the session's start, 0 to 31536000")),
    };
    let from_micros = micros("from_secs", which.from_secs, start)?;
    let to_micros = micros("to_secs", which.to_secs, i64::MAX)?;
    if to_micros < from_micros {
        return Err(invalid_item("to_secs", which.to_secs.unwrap_or_default(), "no less than from_secs"));
    }
    let every_micros = match which.every_secs {
        None => 0,
        Some(secs) if (0.0..=LONGEST_SECS).contains(&secs) => (secs * 1e6).round() as i64,
        Some(found) => return Err(invalid_item("every_secs", found, "seconds, 0 to 31536000")),
    };
    let ends = session.last_micros.unwrap_or(start);
    Ok(Stretch { from_micros, to_micros, every_micros, ends_micros: ends.max(from_micros).min(to_micros) })
}

const MOST_FRAMES: u64 = 10_000;
const MOST_SEARCH_CHARS: usize = 200;
/// A year.
const LONGEST_SECS: f64 = 31_536_000.0;
