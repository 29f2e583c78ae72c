//! The record: events.

use std::sync::Arc;

use axum::Json;
use axum::extract::{Query, State};
use covr_wire::dashboard::Event;
use serde::Deserialize;
use utoipa::IntoParams;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::input::Limit;
use super::problem::Problem;
use crate::app::App;

#[derive(Debug, Clone, Copy, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
struct EventFilter {
    /// Most rows, 1 to 10000; 100 when not given.
    limit: Option<u32>,
    /// Of one session alone.
    session: Option<i64>,
}

/// The routes.
pub fn routes() -> OpenApiRouter<Arc<App>> {
    OpenApiRouter::new().routes(routes!(events))
}

/// Events, newest first.
#[utoipa::path(get, path = "/events", tag = "record", params(EventFilter),
    responses((status = 200, description = "Events", body = ref("#/components/schemas/EventList")), (status = 422, body = Problem, description = "Bad limit")))]
async fn events(
    State(app): State<Arc<App>>,
    Query(EventFilter { limit, session }): Query<EventFilter>,
) -> Result<Json<Vec<Event>>, Problem> {
    Ok(Json(app.store.events(Limit { limit }.rows()?, session).await?))
}
