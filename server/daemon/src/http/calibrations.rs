//! Calibrations: one in the making, those that are stored, and which of them is in force.

use std::sync::Arc;

use axum::Json;
use axum::body::Bytes;
use axum::extract::{Path, State};
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use covr_engine::snapshot::Activity;
use covr_wire::calibration::{
    Calibration, CalibrationDraft, CalibrationKind, CalibrationRefusal, CalibrationResult,
    CalibrationSummary, CalibrationTask, Measured, NewCalibrationPoint, PointOn,
};
use covr_wire::client::Convention;
use covr_wire::reason::Reason;
use covr_wire::scene::{parse_scene, scene_warnings};
use serde_json::json;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::input::{invalid_item, json as read_json};
use super::problem::Problem;
use super::scenes::SceneStored;
use crate::app::{App, Asker};
use crate::calibrations::moves;
use crate::store::NewCalibration;

/// The routes.
pub fn routes() -> OpenApiRouter<Arc<App>> {
    OpenApiRouter::new()
        .routes(routes!(list, accept))
        .routes(routes!(draft, begin, discard))
        .routes(routes!(take_point))
        .routes(routes!(remove_point))
        .routes(routes!(read))
        .routes(routes!(activate))
        .routes(routes!(retire))
        .routes(routes!(edit_scene))
}

/// Every calibration, newest first.
#[utoipa::path(get, path = "/calibrations", tag = "calibrations",
    responses((status = 200, description = "Calibrations, newest first", body = ref("#/components/schemas/CalibrationList"))))]
async fn list(State(app): State<Arc<App>>) -> Result<Json<Vec<CalibrationSummary>>, Problem> {
    let published = app.control.published();
    let all = app.store.calibrations().await?.into_iter();
    Ok(Json(all.map(|one| app.calibrations.shown(one, &published).summary).collect()))
}

/// A calibration with its points, their residuals, and the hardware that it was made on.
#[utoipa::path(get, path = "/calibrations/{id}", tag = "calibrations", params(("id" = i64, Path, description = "The store's number")),
    responses((status = 200, body = ref("#/components/schemas/Calibration")), (status = 404, description = "No such calibration", body = Problem)))]
async fn read(State(app): State<Arc<App>>, Path(id): Path<String>) -> Result<Json<Calibration>, Problem> {
    let stored = stored(&app, &id).await?;
    Ok(Json(app.calibrations.shown(stored, &app.control.published())))
}

/// The calibration in the making. It is kept until it is accepted, discarded, or the server ends.
#[utoipa::path(get, path = "/calibrations/draft", tag = "calibrations",
    responses((status = 200, body = ref("#/components/schemas/CalibrationDraft")), (status = 404, description = "None is in the making", body = Problem)))]
async fn draft(State(app): State<Arc<App>>) -> Result<Json<CalibrationDraft>, Problem> {
    in_the_making(&app).map(Json)
}

/// Begin a calibration, in place of one that is in the making. Nothing is in force by that.
#[utoipa::path(put, path = "/calibrations/draft", tag = "calibrations", request_body = ref("#/components/schemas/CalibrationTask"),
    responses((status = 200, body = ref("#/components/schemas/CalibrationDraft")), (status = 400, description = "Not JSON", body = Problem),
        (status = 409, description = "The client is not connected, speaks for several people, is not calibrated (for a prop), or the scene has no such prop", body = Problem),
        (status = 422, description = "Not a task", body = Problem)))]
async fn begin(
    State(app): State<Arc<App>>,
    asker: Asker,
    body: Bytes,
) -> Result<Json<CalibrationDraft>, Problem> {
    let task: CalibrationTask = read_json(&body)?;
    if let Some(offset_m) = task.offset_m {
        check_numbers("offset_m", offset_m, MOST_OFFSET_M)?;
    }
    match (task.kind, &task.prop) {
        (CalibrationKind::Prop, None) => return Err(invalid_item("prop", "nothing", "the id of a prop")),
        (CalibrationKind::RoomFromTracking, Some(prop)) => {
            return Err(invalid_item("prop", prop, "none: a room is calibrated"));
        }
        (CalibrationKind::Prop, Some(prop)) => {
            if !app.stage.active().document.props.iter().any(|known| known.id == *prop) {
                return Err(Problem::refused(Reason::NoProp { prop: prop.clone() }));
            }
        }
        (CalibrationKind::RoomFromTracking, None) => {}
    }
    let by = measured(&app, &task)?;
    Ok(Json(app.calibrations.bench.begin(task, asker.author(), &by)))
}

/// Discard the calibration in the making; it is answered for the last time.
#[utoipa::path(delete, path = "/calibrations/draft", tag = "calibrations",
    responses((status = 200, body = ref("#/components/schemas/CalibrationDraft")), (status = 404, description = "None is in the making", body = Problem)))]
async fn discard(State(app): State<Arc<App>>, _: Asker) -> Result<Json<CalibrationDraft>, Problem> {
    let discarded = app.calibrations.bench.clear();
    discarded.map(Json).ok_or_else(|| Problem::not_found(Reason::NoCalibrationDraft))
}

/// Take a point now: the mean of the client's poses over the next second, refused where it moved. Answers with the fit of all
/// points so far.
#[utoipa::path(post, path = "/calibrations/draft/points", tag = "calibrations", request_body = ref("#/components/schemas/NewCalibrationPoint"),
    responses((status = 200, body = ref("#/components/schemas/CalibrationDraft")), (status = 400, description = "Not JSON", body = Problem),
        (status = 404, description = "None is in the making", body = Problem),
        (status = 409, description = "It moved, the client says too little, the machine may move by itself, or another point is being taken", body = Problem),
        (status = 422, description = "Not such a point", body = Problem)))]
async fn take_point(
    State(app): State<Arc<App>>,
    _: Asker,
    body: Bytes,
) -> Result<Json<CalibrationDraft>, Problem> {
    let new: NewCalibrationPoint = read_json(&body)?;
    let task = in_the_making(&app)?.task;
    check_point(&task, &new)?;
    let by = measured(&app, &task)?;
    let snapshot = &app.control.published().snapshot;
    if moves(snapshot.mode) {
        return Err(Problem::refused(Reason::NotWhileItMoves));
    }
    if new.on != PointOn::Place && !snapshot.column.homed {
        return Err(Problem::refused(Reason::HomeFirst));
    }
    let column = || app.control.published().snapshot.column.position;
    let taken = app.calibrations.bench.take(new, &by, column).await;
    taken.map(Json).map_err(Problem::refused)
}

/// Leave a point out for good.
#[utoipa::path(delete, path = "/calibrations/draft/points/{number}", tag = "calibrations", params(("number" = u32, Path, description = "The point's number")),
    responses((status = 200, body = ref("#/components/schemas/CalibrationDraft")), (status = 404, description = "No such point", body = Problem),
        (status = 409, description = "The client is not connected, or speaks for several people", body = Problem)))]
async fn remove_point(
    State(app): State<Arc<App>>,
    _: Asker,
    Path(number): Path<String>,
) -> Result<Json<CalibrationDraft>, Problem> {
    let by = measured(&app, &in_the_making(&app)?.task)?;
    let removed = number.parse().ok().and_then(|number| app.calibrations.bench.remove(number, &by));
    removed.map(Json).ok_or_else(|| Problem::not_found(Reason::NoCalibrationPoint { point: number }))
}

/// Accept the calibration in the making: store it as its subject's next version and put it in force. Refused where its fit is.
#[utoipa::path(post, path = "/calibrations", tag = "calibrations",
    responses((status = 201, body = ref("#/components/schemas/Calibration")), (status = 404, description = "None is in the making", body = Problem),
        (status = 409, description = "The fit is not good enough, or the machine may move by itself", body = Problem)))]
async fn accept(State(app): State<Arc<App>>, asker: Asker) -> Result<Response, Problem> {
    let draft = in_the_making(&app)?;
    check_at_rest(&app)?;
    let (task, points) = (draft.task, draft.points);
    let subject = subject(&app, &task);
    let Some(result) = draft.result else {
        let fallback = CalibrationRefusal::TooFewPoints { found: points.len(), fewest: 1 };
        let why = Reason::BadCalibration { refusal: draft.why.unwrap_or(fallback) };
        let detail = json!({ "task": task, "subject": subject, "points": points, "detail": why.to_string(), "why": why });
        let summary = format!("calibration of {subject} by {asker}: refused: {why}");
        app.recorder.record("calibration_refused", summary, asker.sign(detail));
        return Err(Problem::refused(why));
    };
    let hardware = app.calibrations.hardware(&app.control.published());
    let author = asker.author().to_owned();
    let new = NewCalibration { kind: task.kind, subject, result, points, hardware, author };
    let id = app.calibrations.accept(&app.store, &new).await?;
    app.calibrations.bench.clear();
    let calibration = stored(&app, &id.to_string()).await?;
    let summary = &calibration.summary;
    let words = format!(
        "{asker} accepted calibration {} of {}: {:.1} mm off on average",
        summary.version,
        summary.subject,
        summary.result.rms_m() * 1e3
    );
    let detail = json!({ "calibration": id, "kind": summary.kind, "subject": summary.subject, "version": summary.version,
        "result": summary.result });
    app.recorder.record("calibration_accepted", words, asker.sign(detail));
    app.recorder.settled().await;
    let place = [(header::LOCATION, format!("/api/v1/calibrations/{id}"))];
    Ok((StatusCode::CREATED, place, Json(calibration)).into_response())
}

/// Put a stored calibration in force. Connected clients are told their new place at once.
#[utoipa::path(put, path = "/calibrations/{id}/activate", tag = "calibrations", params(("id" = i64, Path, description = "The store's number")),
    responses((status = 200, body = ref("#/components/schemas/Calibration")), (status = 404, description = "No such calibration", body = Problem),
        (status = 409, description = "The machine may move by itself", body = Problem)))]
async fn activate(
    State(app): State<Arc<App>>,
    asker: Asker,
    Path(id): Path<String>,
) -> Result<Json<Calibration>, Problem> {
    choose(&app, &asker, &id, true).await
}

/// Put a calibration out of force: its client is where the configuration says again.
#[utoipa::path(put, path = "/calibrations/{id}/retire", tag = "calibrations", params(("id" = i64, Path, description = "The store's number")),
    responses((status = 200, body = ref("#/components/schemas/Calibration")), (status = 404, description = "No such calibration", body = Problem),
        (status = 409, description = "The machine may move by itself", body = Problem)))]
async fn retire(
    State(app): State<Arc<App>>,
    asker: Asker,
    Path(id): Path<String>,
) -> Result<Json<Calibration>, Problem> {
    choose(&app, &asker, &id, false).await
}

/// Write a prop's calibration into the active scene, as a new version of it. That version is not played until it is activated.
#[utoipa::path(post, path = "/calibrations/{id}/scene", tag = "calibrations", params(("id" = i64, Path, description = "The store's number")),
    responses((status = 201, body = SceneStored), (status = 404, description = "No such calibration", body = Problem),
        (status = 409, description = "It is none of a prop that the active scene has", body = Problem),
        (status = 422, description = "The scene would not pass its checks", body = Problem)))]
async fn edit_scene(
    State(app): State<Arc<App>>,
    asker: Asker,
    Path(id): Path<String>,
) -> Result<Response, Problem> {
    let calibration = stored(&app, &id).await?;
    let CalibrationResult::Prop { prop, offset_m, facing_rad, .. } = &calibration.summary.result else {
        return Err(Problem::refused(Reason::NoProp { prop: calibration.summary.subject }));
    };
    let no_prop = || Problem::refused(Reason::NoProp { prop: prop.clone() });
    let scene = app.stage.active().id;
    let mut document = app.store.scene(scene, None).await?.ok_or_else(no_prop)?.document;
    let edited = document.props.iter_mut().find(|known| known.id == *prop).ok_or_else(no_prop)?;
    edited.offset = *offset_m;
    edited.facing = facing_rad.unwrap_or(edited.facing);
    let text = serde_json::to_vec(&document).unwrap_or_default();
    let (_, built) = parse_scene(&text).map_err(|errors| super::scenes::refused(&text, errors))?;
    let warnings = scene_warnings(&text, &built, &app.config.machine.travel());
    let version = app.store.add_scene_version(scene, &document, asker.author()).await?.ok_or_else(no_prop)?;
    let summary = format!("{asker} wrote calibration {id} of {prop} into scene {scene}, version {version}");
    let detail = json!({ "scene": scene, "version": version, "name": document.name, "calibration": calibration.summary.id });
    app.recorder.record("scene_stored", summary, asker.sign(detail));
    let place = [(header::LOCATION, format!("/api/v1/scenes/{scene}?version={version}"))];
    Ok((StatusCode::CREATED, place, Json(SceneStored { id: scene, version, warnings })).into_response())
}

async fn choose(app: &App, asker: &Asker, id: &str, is_in_force: bool) -> Result<Json<Calibration>, Problem> {
    let summary = stored(app, id).await?.summary;
    check_at_rest(app)?;
    app.calibrations.choose(&app.store, &summary, is_in_force, asker.author()).await?;
    let what = if is_in_force { "in force" } else { "out of force" };
    let words = format!("{asker} put calibration {} of {} {what}", summary.version, summary.subject);
    let detail = json!({ "calibration": summary.id, "kind": summary.kind, "subject": summary.subject,
        "version": summary.version, "in_force": is_in_force });
    app.recorder.record("calibration_chosen", words, asker.sign(detail));
    app.recorder.settled().await;
    Ok(Json(app.calibrations.shown(stored(app, id).await?, &app.control.published())))
}

fn in_the_making(app: &App) -> Result<CalibrationDraft, Problem> {
    app.calibrations.bench.draft().ok_or_else(|| Problem::not_found(Reason::NoCalibrationDraft))
}

async fn stored(app: &App, id: &str) -> Result<Calibration, Problem> {
    let missing = || Problem::not_found(Reason::NoCalibration { calibration: id.into() });
    app.store.calibration(id.parse().map_err(|_| missing())?).await?.ok_or_else(missing)
}

fn check_at_rest(app: &App) -> Result<(), Problem> {
    let snapshot = &app.control.published().snapshot;
    let is_free = !moves(snapshot.mode) && snapshot.column.activity != Activity::Jogged;
    if is_free { Ok(()) } else { Err(Problem::refused(Reason::NotWhileItMoves)) }
}

/// The client of a task, where it can measure: connected, by itself under its name, with one person at most.
fn measured(app: &App, task: &CalibrationTask) -> Result<Measured, Problem> {
    let client = || task.client.clone();
    let of_name: Vec<_> = app.clients.list().into_iter().filter(|known| known.name == task.client).collect();
    let convention = match &of_name[..] {
        [only] if only.persons.len() <= 1 => {
            Convention::ALL.into_iter().find(|convention| convention.name() == only.convention)
        }
        _ => None,
    };
    let convention =
        convention.ok_or_else(|| Problem::refused(Reason::ClientNotThere { client: client() }))?;
    let calibrated = app.calibrations.map(&task.client, convention);
    match task.kind {
        CalibrationKind::Prop => calibrated
            .map(|room_from_tracking| Measured { convention, room_from_tracking })
            .ok_or_else(|| Problem::refused(Reason::ClientNotCalibrated { client: client() })),
        CalibrationKind::RoomFromTracking => {
            let room_from_tracking = app.calibrations.configured();
            Ok(Measured { convention, room_from_tracking })
        }
    }
}

fn subject(app: &App, task: &CalibrationTask) -> String {
    match &task.prop {
        Some(prop) => format!("scene {}: {prop}", app.stage.active().id),
        None => task.client.clone(),
    }
}

fn check_point(task: &CalibrationTask, new: &NewCalibrationPoint) -> Result<(), Problem> {
    let fits = match task.kind {
        CalibrationKind::RoomFromTracking => matches!(new.on, PointOn::Place | PointOn::Column),
        CalibrationKind::Prop => matches!(new.on, PointOn::PropPoint | PointOn::PropFace),
    };
    if !fits {
        let found = json!(new.on);
        return Err(invalid_item(
            "on",
            found,
            "place or column for a room, prop_point or prop_face for a prop",
        ));
    }
    match (new.on, new.place_m) {
        (PointOn::Place, None) => Err(invalid_item("place_m", "nothing", "the place in the room, m")),
        (PointOn::Place, Some(place_m)) => check_numbers("place_m", place_m, MOST_PLACE_M),
        (_, Some(_)) => Err(invalid_item("place_m", "a place", "none: the machine measures the column")),
        (_, None) => Ok(()),
    }
}

fn check_numbers(path: &str, numbers: [f64; 3], most: f64) -> Result<(), Problem> {
    match numbers.iter().position(|number| number.abs() > most) {
        None => Ok(()),
        Some(place) => Err(invalid_item(
            &format!("{path}[{place}]"),
            numbers[place],
            &format!("from -{most} to {most} m"),
        )),
    }
}

const MOST_PLACE_M: f64 = 100.0;
const MOST_OFFSET_M: f64 = 3.0;
