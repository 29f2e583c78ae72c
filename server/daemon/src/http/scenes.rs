//! Scenes: upload, check, versions, activation.

use std::sync::Arc;

use axum::Json;
use axum::body::Bytes;
use axum::extract::{Path, Query, State};
use axum::http::{HeaderMap, StatusCode, header};
use axum::response::{IntoResponse, Response};
use covr_engine::mode::Mode;
use covr_wire::answers::{SceneSummary, SceneVersionSummary};
use covr_wire::reason::Reason;
use covr_wire::scene::{
    SceneError, ScenePairs, SceneWarning, parse_scene, scene_pairs, scene_schema, scene_warnings,
};
use serde::{Deserialize, Serialize};
use serde_json::json;
use ts_rs::TS;
use utoipa::{IntoParams, ToSchema};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::problem::{Problem, ProblemItem};
use crate::app::{App, Asker};
use crate::stage::ActivationRefused;

/// Where a scene was stored.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema, TS)]
pub struct SceneStored {
    /// The store's number of the scene.
    pub id: i64,
    /// Its version.
    pub version: i64,
    /// What is worth a second look: what this machine cannot serve well, and its scenario.
    #[schema(schema_with = warnings_schema)]
    #[ts(type = "import(\"../generated/SceneWarning\").SceneWarning[]")]
    pub warnings: Vec<SceneWarning>,
}

/// A scene passed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema, TS)]
pub struct SceneChecked {
    /// Always true: a scene that does not pass is a problem.
    pub valid: bool,
    /// Its name.
    pub name: String,
    /// How many objects it has.
    pub objects: usize,
    /// What is worth a second look: what this machine cannot serve well, and its scenario.
    #[schema(schema_with = warnings_schema)]
    #[ts(type = "import(\"../generated/SceneWarning\").SceneWarning[]")]
    pub warnings: Vec<SceneWarning>,
    /// Each pair of its objects: how long the column needs, and how long people; null for more than 60 objects.
    #[schema(schema_with = pairs_schema)]
    #[ts(type = "import(\"../generated/ScenePairs\").ScenePairs | null")]
    pub pairs: Option<ScenePairs>,
}

/// A scene is active.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct SceneActivated {
    /// The store's number of the scene.
    pub id: i64,
    /// The version that is active.
    pub version: i64,
    /// What it did, in plain words.
    pub detail: String,
}

#[derive(Debug, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
struct Version {
    /// A version; the newest when not given.
    version: Option<i64>,
}

/// The routes.
pub fn routes() -> OpenApiRouter<Arc<App>> {
    OpenApiRouter::new()
        .routes(routes!(list, add))
        .routes(routes!(check))
        .routes(routes!(read, replace))
        .routes(routes!(versions))
        .routes(routes!(activate))
        .routes(routes!(schema))
}

/// Every scene.
#[utoipa::path(get, path = "/scenes", tag = "scenes", responses((status = 200, description = "Scenes, oldest first", body = ref("#/components/schemas/SceneList"))))]
async fn list(State(app): State<Arc<App>>) -> Result<Json<Vec<SceneSummary>>, Problem> {
    Ok(Json(app.store.scenes().await?))
}

/// Store a new scene as its version 1. It is not active by that.
#[utoipa::path(post, path = "/scenes", tag = "scenes", request_body = ref("#/components/schemas/SceneDocument"),
    responses((status = 201, body = SceneStored), (status = 400, description = "Not JSON", body = Problem),
        (status = 422, description = "Not a scene, place by place", body = Problem)))]
async fn add(State(app): State<Arc<App>>, asker: Asker, body: Bytes) -> Result<Response, Problem> {
    let (document, scene) = parse_scene(&body).map_err(|errors| refused(&body, errors))?;
    let id = app.store.add_scene(&document, asker.author()).await?;
    record_stored(&app, &asker, id, 1, &document.name);
    let place = [(header::LOCATION, format!("/api/v1/scenes/{id}"))];
    Ok((
        StatusCode::CREATED,
        place,
        Json(SceneStored {
            id,
            version: 1,
            warnings: scene_warnings(&body, &scene, &app.config.machine.travel()),
        }),
    )
        .into_response())
}

/// Check a scene and store nothing.
#[utoipa::path(post, path = "/scenes/check", tag = "scenes", request_body = ref("#/components/schemas/SceneDocument"),
    responses((status = 200, body = SceneChecked), (status = 400, description = "Not JSON", body = Problem),
        (status = 422, description = "Not a scene, place by place", body = Problem)))]
async fn check(State(app): State<Arc<App>>, body: Bytes) -> Result<Json<SceneChecked>, Problem> {
    let (document, scene) = parse_scene(&body).map_err(|errors| refused(&body, errors))?;
    let warnings = scene_warnings(&body, &scene, &app.config.machine.travel());
    let pairs = scene_pairs(&scene, &app.config.machine.limits());
    Ok(Json(SceneChecked {
        valid: true,
        objects: document.objects.len(),
        name: document.name,
        warnings,
        pairs,
    }))
}

/// A scene's document. Version, author and date are in the headers `X-Covr-Version`, `X-Covr-Author` and `X-Covr-Created`.
#[utoipa::path(get, path = "/scenes/{id}", tag = "scenes", params(("id" = i64, Path, description = "The store's number"), Version),
    responses((status = 200, body = ref("#/components/schemas/SceneDocument")), (status = 404, description = "No such scene", body = Problem)))]
async fn read(
    State(app): State<Arc<App>>,
    Path(id): Path<String>,
    Query(Version { version }): Query<Version>,
) -> Result<Response, Problem> {
    let stored = app.store.scene(number(&id)?, version).await?.ok_or_else(|| no_scene(&id, version))?;
    let mut headers = HeaderMap::new();
    headers.insert("x-covr-version", stored.version.into());
    let author =
        percent_encoding::utf8_percent_encode(&stored.author, percent_encoding::CONTROLS).to_string();
    for (name, value) in [("x-covr-author", author), ("x-covr-created", stored.created)] {
        if let Ok(value) = value.parse() {
            headers.insert(name, value);
        }
    }
    Ok((headers, Json(stored.document)).into_response())
}

/// Every version of a scene, newest first.
#[utoipa::path(get, path = "/scenes/{id}/versions", tag = "scenes", params(("id" = i64, Path, description = "The store's number")),
    responses((status = 200, description = "Versions, newest first", body = ref("#/components/schemas/SceneVersionList")), (status = 404, description = "No such scene", body = Problem)))]
async fn versions(
    State(app): State<Arc<App>>,
    Path(id): Path<String>,
) -> Result<Json<Vec<SceneVersionSummary>>, Problem> {
    let versions = app.store.scene_versions(number(&id)?).await?;
    // A scene is stored together with its version 1: one without versions is none.
    if versions.is_empty() { Err(no_scene(&id, None)) } else { Ok(Json(versions)) }
}

/// Store a new version of a scene. The active scene stays as it is until the new version is activated.
#[utoipa::path(put, path = "/scenes/{id}", tag = "scenes", params(("id" = i64, Path, description = "The store's number")),
    request_body = ref("#/components/schemas/SceneDocument"),
    responses((status = 200, body = SceneStored), (status = 400, description = "Not JSON", body = Problem),
        (status = 404, description = "No such scene", body = Problem), (status = 422, description = "Not a scene, place by place", body = Problem)))]
async fn replace(
    State(app): State<Arc<App>>,
    asker: Asker,
    Path(id): Path<String>,
    body: Bytes,
) -> Result<Json<SceneStored>, Problem> {
    let (document, scene) = parse_scene(&body).map_err(|errors| refused(&body, errors))?;
    let id_number = number(&id)?;
    let version = app
        .store
        .add_scene_version(id_number, &document, asker.author())
        .await?
        .ok_or_else(|| no_scene(&id, None))?;
    record_stored(&app, &asker, id_number, version, &document.name);
    Ok(Json(SceneStored {
        id: id_number,
        version,
        warnings: scene_warnings(&body, &scene, &app.config.machine.travel()),
    }))
}

/// Play a scene: its newest version, or the one named. Its priors start from the document.
#[utoipa::path(put, path = "/scenes/{id}/activate", tag = "scenes", params(("id" = i64, Path, description = "The store's number"), Version),
    responses((status = 200, body = SceneActivated), (status = 404, description = "No such scene", body = Problem),
        (status = 409, description = "Not now", body = Problem)))]
async fn activate(
    State(app): State<Arc<App>>,
    asker: Asker,
    Path(id): Path<String>,
    Query(Version { version }): Query<Version>,
) -> Result<Json<SceneActivated>, Problem> {
    let stored = app.store.scene(number(&id)?, version).await?.ok_or_else(|| no_scene(&id, version))?;
    nobody_touches(&app)?;
    let (id, version, name) = (stored.id, stored.version, stored.document.name.clone());
    let answer = app.stage.activate(&app.control, &app.store, stored).await.map_err(|why| match why {
        ActivationRefused::Invalid(errors) => refused(&[], errors),
        ActivationRefused::Refused(why) => Problem::refused(Reason::new(&why, &app.persons.names())),
        ActivationRefused::NotDelivered(why) => why.into(),
        ActivationRefused::Store(why) => why.into(),
    })?;
    app.persons.forget_touches();
    app.recorder.record(
        "scene_activated",
        format!("{asker} activated \"{name}\" (scene {id}, version {version})"),
        asker.sign(json!({ "scene": id, "version": version, "name": name })),
    );
    app.recorder.settled().await;
    Ok(Json(SceneActivated { id, version, detail: app.reason(&answer).to_string() }))
}

/// The JSON Schema of a scene.
#[utoipa::path(get, path = "/scene.schema.json", tag = "scenes",
    responses((status = 200, description = "JSON Schema, draft 2020-12", content_type = "application/schema+json")))]
async fn schema() -> Response {
    ([(header::CONTENT_TYPE, "application/schema+json")], scene_schema().to_string()).into_response()
}

fn record_stored(app: &App, asker: &Asker, id: i64, version: i64, name: &str) {
    let summary = format!("{asker} stored \"{name}\" (scene {id}, version {version})");
    let detail = json!({ "scene": id, "version": version, "name": name });
    app.recorder.record("scene_stored", summary, asker.sign(detail));
}

/// What is not JSON at all is malformed; what is JSON but no scene is invalid.
pub(super) fn refused(text: &[u8], errors: Vec<SceneError>) -> Problem {
    let is_json = serde_json::from_slice::<serde::de::IgnoredAny>(text).is_ok() || text.is_empty();
    let count = errors.len();
    let first = errors.first().map(ToString::to_string).unwrap_or_default();
    let more = if count > 1 { format!(" (and {} more)", count - 1) } else { String::new() };
    let items = errors
        .into_iter()
        .map(|error| ProblemItem {
            path: error.path,
            found: error.found,
            expected: error.expected,
            found_as: error.found_as,
            expected_as: error.expected_as,
            line: error.line.and_then(|line| line.try_into().ok()),
            column: error.column.and_then(|column| column.try_into().ok()),
        })
        .collect();
    let detail = format!("{first}{more}");
    if is_json { Problem::invalid(detail, items) } else { Problem::malformed(detail, items) }
}

/// Nothing is put under somebody's hand: a scene waits while the machine is armed and an object is touched, or an interaction is under way.
fn nobody_touches(app: &App) -> Result<(), Problem> {
    let published = app.control.published();
    let mode = published.snapshot.mode;
    if let Some(now) = published.snapshot.interaction.as_ref().filter(|now| now.phase != "done") {
        let object = published.snapshot.objects.get(now.object).map(|object| object.id.clone());
        let object = object.unwrap_or_default();
        return Err(Problem::refused(Reason::InteractionGoesOn {
            interaction: now.interaction.into(),
            object,
        }));
    }
    let touch = matches!(mode, Mode::Following | Mode::ProtectiveStop).then(|| app.persons.touch()).flatten();
    match touch {
        Some((person, object)) => Err(Problem::refused(Reason::TouchGoesOn { person, object })),
        None => Ok(()),
    }
}

/// The wire's own schema, which the document has.
fn warnings_schema() -> utoipa::openapi::schema::Array {
    utoipa::openapi::schema::Array::new(utoipa::openapi::Ref::from_schema_name("SceneWarning"))
}

fn pairs_schema() -> utoipa::openapi::Ref {
    utoipa::openapi::Ref::from_schema_name("ScenePairs")
}

fn number(id: &str) -> Result<i64, Problem> {
    id.parse().map_err(|_| no_scene(id, None))
}

fn no_scene(id: &str, version: Option<i64>) -> Problem {
    let scene = id.into();
    Problem::not_found(match version {
        None => Reason::NoScene { scene },
        Some(version) => Reason::NoSceneVersion { scene, version },
    })
}
