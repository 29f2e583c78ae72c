//! The OpenAPI document: routes from their handlers, wire types from their own JSON Schemas.

use std::sync::Arc;

use axum::Router;
use axum::http::header;
use axum::response::{IntoResponse, Response};
use covr_wire::dashboard::{Event, Snapshot};
use covr_wire::records::{ConfigInForce, RecordedFrames, Session, SessionDetail};
use covr_wire::scene::SceneDocument;
use schemars::generate::SchemaSettings;
use serde_json::Value;
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
        description = "Control server for room-scale encountered-type haptic robots. SI units, room frame.",
        license(name = "Apache-2.0", identifier = "Apache-2.0")
    ),
    tags(
        (name = "machine", description = "State, requests, the software stop"),
        (name = "scenes", description = "Scenes and their versions"),
        (name = "priors", description = "The game master's priors"),
        (name = "record", description = "Sessions and events"),
        (name = "config", description = "The configuration in force"),
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
    generator.subschema_for::<RecordedFrames>();
    generator.subschema_for::<SessionDetail>();
    generator.subschema_for::<ConfigInForce>();
    let sessions = generator.subschema_for::<Vec<Session>>();
    let events = generator.subschema_for::<Vec<Event>>();
    let schemas = &mut document["components"]["schemas"];
    for (name, schema) in generator.take_definitions(true) {
        schemas[name] = schema;
    }
    schemas["EventList"] = events.to_value();
    schemas["SessionList"] = sessions.to_value();
}
