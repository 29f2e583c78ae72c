//! Priors and the record: changes and events.

use std::collections::BTreeMap;
use std::sync::Arc;

use axum::Json;
use axum::body::Bytes;
use axum::extract::{Query, State};
use covr_wire::dashboard::Event;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use utoipa::{IntoParams, ToSchema};
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::input::{Author, Limit, json as read_json};
use super::problem::{Problem, ProblemItem};
use crate::app::App;
use crate::stage::PriorsRefused;
use crate::store::StoredPriorChange;

/// What became of priors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct PriorsChanged {
    /// Objects whose prior is another now.
    pub changed: Vec<String>,
}

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
    OpenApiRouter::new().routes(routes!(change_priors)).routes(routes!(prior_changes)).routes(routes!(events))
}

/// Change priors of the active scene, all or none: `{"object id": 0.4}`.
#[utoipa::path(patch, path = "/priors", tag = "priors", request_body = BTreeMap<String, f64>,
    responses((status = 200, body = PriorsChanged), (status = 400, description = "Not a JSON object", body = Problem),
        (status = 422, description = "An unknown object, or not from 0 to 1; nothing is changed", body = Problem)))]
async fn change_priors(
    State(app): State<Arc<App>>,
    author: Author,
    body: Bytes,
) -> Result<Json<PriorsChanged>, Problem> {
    let wanted: BTreeMap<String, Value> = read_json(&body)?;
    let done = app.stage.change_priors(&app.control, &app.store, &author.0, &wanted).await;
    let changes = done.map_err(|why| match why {
        PriorsRefused::Invalid(bad) => {
            let words =
                bad.iter().map(|b| format!("{}: found {}, expected {}", b.object, b.found, b.expected));
            let detail = words.collect::<Vec<_>>().join("; ");
            let items = bad.into_iter().map(|b| ProblemItem {
                path: b.object,
                found: b.found,
                expected: b.expected,
                line: None,
                column: None,
            });
            Problem::invalid(detail, items.collect())
        }
        PriorsRefused::Refused(detail) => Problem::refused(detail),
        PriorsRefused::NotDelivered(why) => why.into(),
        PriorsRefused::Store(why) => why.into(),
    })?;
    for change in &changes {
        app.recorder.record(
            "prior_changed",
            format!("{} set the prior of {} from {} to {}", author.0, change.object, change.from, change.to),
            json!({ "author": author.0, "object": change.object, "from": change.from, "to": change.to }),
        );
    }
    Ok(Json(PriorsChanged { changed: changes.into_iter().map(|change| change.object).collect() }))
}

/// Who changed which prior when, newest first.
#[utoipa::path(get, path = "/priors/changes", tag = "priors", params(Limit),
    responses((status = 200, body = Vec<StoredPriorChange>), (status = 422, body = Problem, description = "Bad limit")))]
async fn prior_changes(
    State(app): State<Arc<App>>,
    Query(limit): Query<Limit>,
) -> Result<Json<Vec<StoredPriorChange>>, Problem> {
    Ok(Json(app.store.prior_changes(limit.rows()?).await?))
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
