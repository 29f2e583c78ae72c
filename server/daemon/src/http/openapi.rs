//! The OpenAPI document: routes from their handlers, wire types from their own JSON Schemas.

mod complete;
mod samples;

use std::sync::Arc;

use axum::Router;
use axum::http::header;
use axum::response::{IntoResponse, Response};
use covr_wire::answers::{PriorChange, SceneSummary, SceneVersionSummary};
use covr_wire::calibration::{
    Calibration, CalibrationDraft, CalibrationSummary, CalibrationTask, NewCalibrationPoint,
};
use covr_wire::commissioning::{Commissioning, NewCommissioning};
use covr_wire::dashboard::{Event, Snapshot};
use covr_wire::phrase::Phrase;
use covr_wire::records::{ConfigInForce, RecordedFrames, Session, SessionDetail};
use covr_wire::scene::{SceneDocument, ScenePairs, SceneWarning};
use schemars::generate::SchemaSettings;
use serde_json::{Value, json};
use utoipa::OpenApi;
use utoipa_axum::router::OpenApiRouter;

use crate::app::App;

/// The document, as text.
#[derive(Clone)]
pub struct Document(Arc<str>);

#[derive(OpenApi)]
#[openapi(
    info(
        title = "CoVR",
        description = "Control server for room-scale encountered-type haptic robots. SI units, room frame: right-handed, metres, +z up, \
            origin on the floor under the home corner, +x along the long rail.\n\n\
            Every refusal under `/api` is a problem document (RFC 9457) with what was found and expected, place by place. A path that is \
            not here is answered 404, a method that a path does not take 405, both as problems.\n\n\
            A browser's page must come from this server: what another origin asks is refused (403), the stop alone is open to \
            everybody. Programs send no `Origin`. A server that listens on this machine alone takes only its names as host.\n\n\
            Where tokens exist (`covr token create`), whoever asks sends one as `Authorization: Bearer`; a browser signs in at \
            `/api/v1/login` and sends what `/api/v1/me` gives it as `X-Covr-Csrf` with everything that is no GET. The role must be among the \
            operation's `x-covr-roles`: without a token in force the answer is 401, with another role 403. Operations without roles, \
            the stop above all, are open to everybody. A server without any token asks nobody.\n\n\
            What changes something takes its author from `X-Covr-Author`; the token's name and role are recorded beside it. WebSockets are described at `/api/v1/asyncapi.json`."
    ),
    tags(
        (name = "machine", description = "State, requests, the software stop"),
        (name = "scenes", description = "Scenes and their versions"),
        (name = "priors", description = "The game master's priors"),
        (name = "calibrations", description = "Where clients and props are: measured, stored, in force"),
        (name = "record", description = "Sessions and events"),
        (name = "access", description = "Who am I, signing in and out, tickets and tokens"),
        (name = "config", description = "The configuration in force"),
        (name = "contract", description = "What describes the server, and its WebSockets"),
        (name = "health", description = "Probes and metrics")
    )
)]
struct Base;

/// A router that collects the document.
pub fn base() -> OpenApiRouter<Arc<App>> {
    OpenApiRouter::with_openapi(Base::openapi())
}

/// The routes, and the finished document.
pub fn split(router: OpenApiRouter<Arc<App>>) -> (Router<Arc<App>>, Document) {
    let (router, document) = router.split_for_parts();
    let mut document = serde_json::to_value(document).unwrap_or_default();
    add_wire_schemas(&mut document);
    complete::complete(&mut document);
    (router, document.into())
}

impl From<Value> for Document {
    fn from(document: Value) -> Self {
        Self(document.to_string().into())
    }
}

impl IntoResponse for Document {
    fn into_response(self) -> Response {
        ([(header::CONTENT_TYPE, "application/json")], self.0.to_string()).into_response()
    }
}

fn add_wire_schemas(document: &mut Value) {
    let mut settings = SchemaSettings::draft2020_12();
    settings.definitions_path = "/components/schemas".into();
    let mut generator = settings.into_generator();
    generator.subschema_for::<Snapshot>();
    generator.subschema_for::<SceneDocument>();
    generator.subschema_for::<SceneWarning>();
    generator.subschema_for::<Phrase>();
    generator.subschema_for::<ScenePairs>();
    generator.subschema_for::<RecordedFrames>();
    generator.subschema_for::<SessionDetail>();
    generator.subschema_for::<ConfigInForce>();
    generator.subschema_for::<CalibrationTask>();
    generator.subschema_for::<NewCalibrationPoint>();
    generator.subschema_for::<CalibrationDraft>();
    generator.subschema_for::<Calibration>();
    generator.subschema_for::<NewCommissioning>();
    let commissionings = generator.subschema_for::<Vec<Commissioning>>();
    let calibrations = generator.subschema_for::<Vec<CalibrationSummary>>();
    let sessions = generator.subschema_for::<Vec<Session>>();
    let events = generator.subschema_for::<Vec<Event>>();
    let scenes = generator.subschema_for::<Vec<SceneSummary>>();
    let versions = generator.subschema_for::<Vec<SceneVersionSummary>>();
    let changes = generator.subschema_for::<Vec<PriorChange>>();
    let schemas = &mut document["components"]["schemas"];
    for (name, schema) in generator.take_definitions(true) {
        schemas[name] = schema;
    }
    schemas["CommissioningList"] = commissionings.to_value();
    schemas["CalibrationList"] = calibrations.to_value();
    schemas["EventList"] = events.to_value();
    schemas["SceneList"] = scenes.to_value();
    schemas["SceneVersionList"] = versions.to_value();
    schemas["PriorChangeList"] = changes.to_value();
    schemas["SessionList"] = sessions.to_value();
    schemas["SessionExport"] = session_export();
    // Streamed piece by piece, so that no type has it all.
    let export =
        "/paths/~1api~1v1~1sessions~1{id}~1export/get/responses/200/content/application~1json/schema";
    if let Some(schema) = document.pointer_mut(export) {
        *schema = json!({ "$ref": "#/components/schemas/SessionExport" });
    }
}

/// A session to take away, with everything that belongs to it.
fn session_export() -> Value {
    let list_of = |items: Value| json!({ "type": "array", "items": items });
    let named = |name: &str| json!({ "$ref": format!("#/components/schemas/{name}") });
    json!({
        "type": "object",
        "description": "A session with its scenes, events and recorded frames, oldest first.",
        "required": ["session", "scenes", "events", "frames"],
        "properties": {
            "session": named("SessionDetail"),
            "scenes": list_of(json!({
                "allOf": [named("SceneInForce")],
                "required": ["document"],
                "properties": { "document": named("SceneDocument") },
            })),
            "events": list_of(named("Event")),
            "frames": list_of(named("RecordedFrame")),
        },
    })
}
