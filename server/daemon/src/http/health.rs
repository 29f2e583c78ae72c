//! Whether the server lives, whether it is of use, and its metrics.

use std::sync::Arc;

use axum::Json;
use axum::extract::State;
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use crate::app::App;

/// Whether the server can be used, part by part.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Readiness {
    /// Every part is ready.
    pub ready: bool,
    /// `ready`, or what is wrong with the control loop.
    pub control_loop: String,
    /// `ready`, or what is wrong with the store.
    pub store: String,
}

/// The routes.
pub fn routes() -> OpenApiRouter<Arc<App>> {
    OpenApiRouter::new().routes(routes!(healthz)).routes(routes!(readyz)).routes(routes!(metrics))
}

/// The process answers.
#[utoipa::path(get, path = "/healthz", tag = "health", responses((status = 200, description = "It lives", body = String)))]
async fn healthz() -> &'static str {
    "ok"
}

/// The control thread runs and the store can be written.
#[utoipa::path(get, path = "/readyz", tag = "health",
    responses((status = 200, body = Readiness), (status = 503, description = "Not ready", body = Readiness)))]
async fn readyz(State(app): State<Arc<App>>) -> Response {
    let age = app.clock.now() - app.control.published().snapshot.at;
    let control_loop = if !app.control.is_running() {
        "the control thread has ended".to_owned()
    } else if age.secs() > OLDEST_SNAPSHOT_SECS {
        format!("the newest snapshot is {:.1} s old", age.secs())
    } else {
        READY.to_owned()
    };
    let store = match app.store.probe().await {
        Ok(()) => READY.to_owned(),
        Err(why) => why.to_string(),
    };
    let ready = control_loop == READY && store == READY;
    let status = if ready { StatusCode::OK } else { StatusCode::SERVICE_UNAVAILABLE };
    (status, Json(Readiness { ready, control_loop, store })).into_response()
}

/// Prometheus metrics.
#[utoipa::path(get, path = "/metrics", tag = "health", responses((status = 200, description = "Prometheus text format", body = String)))]
async fn metrics(State(app): State<Arc<App>>) -> Response {
    let text = app.prometheus.render();
    ([(header::CONTENT_TYPE, "text/plain; version=0.0.4; charset=utf-8")], text).into_response()
}

const READY: &str = "ready";
const OLDEST_SNAPSHOT_SECS: f64 = 1.0;
