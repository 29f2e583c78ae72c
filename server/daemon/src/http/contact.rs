//! R14: who may be touched by a moving column, and who leans on it or rides it.

use std::sync::Arc;

use axum::Json;
use axum::body::Bytes;
use axum::extract::State;
use covr_engine::observation::PersonId;
use covr_engine::time::Span;
use serde::Deserialize;
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::input::json as read_json;
use super::machine::{Answered, answered};
use super::problem::Problem;
use crate::app::{App, Asker};

/// For whom, and for how long.
#[derive(Debug, Clone, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
#[schema(example = json!({ "person": 1, "secs": 60 }))]
pub struct ContactBody {
    /// Id of the visitor.
    pub person: u32,
    /// For so long at most, s: 1 to 300.
    #[schema(minimum = 1, maximum = 300)]
    pub secs: f64,
}

/// The routes.
pub fn routes() -> OpenApiRouter<Arc<App>> {
    OpenApiRouter::new().routes(routes!(arm)).routes(routes!(disarm)).routes(routes!(free))
}

/// A moving column may touch this visitor, in the interactions lead, transport and brush of the active scene. It ends by itself, and with
/// every stop.
#[utoipa::path(post, path = "/contact/arm", tag = "machine", request_body = ContactBody,
    responses((status = 200, body = Answered), (status = 400, description = "Not JSON, or not a contact", body = Problem),
        (status = 409, description = "Refused", body = Problem), (status = 503, description = "Busy", body = Problem)))]
async fn arm(State(app): State<Arc<App>>, asker: Asker, body: Bytes) -> Result<Json<Answered>, Problem> {
    let ContactBody { person, secs } = read_json(&body)?;
    answered(&app, &app.arm_contact(&asker, PersonId(person), Span::from_secs(secs)).await?)
}

/// Nobody may be touched by a moving column any more.
#[utoipa::path(post, path = "/contact/disarm", tag = "machine",
    responses((status = 200, body = Answered), (status = 409, description = "Refused", body = Problem), (status = 503, description = "Busy", body = Problem)))]
async fn disarm(State(app): State<Arc<App>>, asker: Asker) -> Result<Json<Answered>, Problem> {
    answered(&app, &app.disarm_contact(&asker).await?)
}

/// Somebody looked: nobody leans on the column or rides it. A stop that kept the drive on for them lets it go.
#[utoipa::path(post, path = "/contact/free", tag = "machine",
    responses((status = 200, body = Answered), (status = 409, description = "Refused", body = Problem), (status = 503, description = "Busy", body = Problem)))]
async fn free(State(app): State<Arc<App>>, asker: Asker) -> Result<Json<Answered>, Problem> {
    answered(&app, &app.confirm_free(&asker).await?)
}
