//! HTTP: handlers check, convert and pass on. Every error under /api is a problem document.

mod access;
mod asyncapi;
mod calibrations;
mod cockpit;
mod commissionings;
mod config;
mod contact;
mod events;
mod gate;
mod guard;
mod health;
mod input;
mod limits;
mod machine;
mod openapi;
mod priors;
mod problem;
mod scenario;
mod scenes;
mod sessions;
mod timing;

use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::extract::DefaultBodyLimit;
use axum::http::{HeaderName, HeaderValue, StatusCode, header};
use axum::middleware::{from_fn, from_fn_with_state};
use axum::response::IntoResponse;
use axum::routing::get;
use covr_wire::scene::MAX_SCENE_BYTES;
use tower::ServiceBuilder;
use tower_http::catch_panic::CatchPanicLayer;
use tower_http::request_id::{MakeRequestUuid, PropagateRequestIdLayer, SetRequestIdLayer};
use tower_http::set_header::SetResponseHeaderLayer;
use tower_http::timeout::TimeoutLayer;
use tower_http::trace::TraceLayer;

pub use access::{Me, Ticket};
pub use cockpit::Noted;
pub use health::Readiness;
pub use limits::{Limits, address};
pub use machine::{Answered, StopAcknowledged};
pub use priors::{ObjectPreview, PriorsChanged, PriorsPreview};
pub use problem::{PROBLEM_JSON, Problem, ProblemItem};
pub use scenes::{SceneActivated, SceneChecked, SceneStored};

use crate::app::App;
use crate::{web, ws};

/// Everything that the server answers.
pub fn router(app: Arc<App>) -> Router {
    let (api, document) = openapi::split(
        openapi::base()
            .nest(
                "/api/v1",
                machine::routes()
                    .merge(scenes::routes())
                    .merge(scenario::routes())
                    .merge(contact::routes())
                    .merge(cockpit::routes())
                    .merge(priors::routes())
                    .merge(sessions::routes())
                    .merge(config::routes())
                    .merge(calibrations::routes())
                    .merge(commissionings::routes())
                    .merge(access::routes())
                    .merge(events::routes()),
            )
            .merge(health::routes()),
    );
    let time_out = Duration::from_secs_f64(app.config.server.request_timeout_secs);
    let layers = ServiceBuilder::new()
        .layer(SetRequestIdLayer::x_request_id(MakeRequestUuid))
        .layer(TraceLayer::new_for_http().make_span_with(request_span))
        .layer(PropagateRequestIdLayer::x_request_id())
        .layer(always(header::X_CONTENT_TYPE_OPTIONS, Some("nosniff")))
        .layer(always(header::REFERRER_POLICY, Some("no-referrer")))
        .layer(always(header::X_FRAME_OPTIONS, Some("DENY")))
        .layer(always(HeaderName::from_static("cross-origin-resource-policy"), Some("same-origin")))
        .layer(always(HeaderName::from_static("cross-origin-opener-policy"), Some("same-origin")))
        .layer(always(header::STRICT_TRANSPORT_SECURITY, app.config.server.is_encrypted().then_some(A_DAY)))
        .layer(from_fn(problem::finish))
        .layer(from_fn_with_state(app.clone(), guard::same_host))
        .layer(from_fn_with_state(app.clone(), limits::within_rate))
        .layer(from_fn(timing::measure))
        .layer(CatchPanicLayer::new())
        .layer(TimeoutLayer::with_status_code(StatusCode::REQUEST_TIMEOUT, time_out))
        .layer(from_fn_with_state(app.clone(), gate::pass))
        .layer(DefaultBodyLimit::max(MAX_SCENE_BYTES));
    let sockets = asyncapi::document(&app.config);
    api.route("/api/v1/asyncapi.json", get(move || std::future::ready(sockets.clone().into_response())))
        .route("/api/v1/openapi.json", get(move || std::future::ready(document.clone().into_response())))
        .route("/api/docs", get(web::docs))
        .route("/api/{*rest}", get(nothing_here).fallback(nothing_here))
        .route("/ws/v1/client", get(ws::client::upgrade))
        .route("/ws/v1/dashboard", get(ws::dashboard::upgrade))
        .fallback(web::page)
        .method_not_allowed_fallback(async || StatusCode::METHOD_NOT_ALLOWED)
        .with_state(app)
        .layer(layers)
}

/// A header of every answer that does not have it yet.
fn always(name: HeaderName, value: Option<&'static str>) -> SetResponseHeaderLayer<Option<HeaderValue>> {
    SetResponseHeaderLayer::if_not_present(name, value.map(HeaderValue::from_static))
}

async fn nothing_here() -> StatusCode {
    StatusCode::NOT_FOUND
}

fn request_span(request: &axum::extract::Request) -> tracing::Span {
    let id = request.headers().get("x-request-id").and_then(|id| id.to_str().ok()).unwrap_or_default();
    tracing::debug_span!("http", method = %request.method(), path = request.uri().path(), id)
}

/// Of the one request that nothing may hold up.
const STOP_PATH: &str = "/api/v1/stop";
/// Browsers keep to TLS for so long: a lab that turns it off again, or whose certificate has ended, is not locked out for long.
const A_DAY: &str = "max-age=86400";
