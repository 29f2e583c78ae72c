//! The scenario of the active scene: cues, skipping, going back.

use std::sync::Arc;

use axum::Json;
use axum::body::Bytes;
use axum::extract::State;
use serde::Deserialize;
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::input::{ReasonBody, invalid_item, json as read_json};
use super::machine::{Answered, answered};
use super::problem::Problem;
use crate::app::{App, Asker};

/// A cue.
#[derive(Debug, Clone, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
#[schema(example = json!({ "name": "lights on" }))]
pub struct CueBody {
    /// Its name, as the scenario's transitions have it.
    pub name: String,
}

/// Where to skip to, and why.
#[derive(Debug, Clone, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
#[schema(example = json!({ "to": "walls", "reason": "the carpet was missed" }))]
pub struct SkipBody {
    /// Id of the state.
    pub to: String,
    /// Why, in the asker's words; 1 to 500 characters.
    pub reason: String,
}

/// The routes.
pub fn routes() -> OpenApiRouter<Arc<App>> {
    OpenApiRouter::new().routes(routes!(cue)).routes(routes!(skip)).routes(routes!(rewind))
}

/// Give a cue to the scenario. It is refused where nothing waits for it now, and while the scenario stands.
#[utoipa::path(post, path = "/scenario/cue", tag = "scenes", request_body = CueBody,
    responses((status = 200, body = Answered), (status = 400, description = "Not JSON, or not a cue", body = Problem),
        (status = 409, description = "Refused", body = Problem), (status = 503, description = "Busy", body = Problem)))]
async fn cue(State(app): State<Arc<App>>, asker: Asker, body: Bytes) -> Result<Json<Answered>, Problem> {
    let CueBody { name } = read_json(&body)?;
    answered(&app, &app.cue(&asker, name).await?)
}

/// Skip to a state of the scenario. While the machine is not armed, the next run begins there.
#[utoipa::path(post, path = "/scenario/skip", tag = "scenes", request_body = SkipBody,
    responses((status = 200, body = Answered), (status = 400, description = "Not JSON, or not a skip", body = Problem),
        (status = 409, description = "Refused", body = Problem), (status = 422, description = "No reason given", body = Problem),
        (status = 503, description = "Busy", body = Problem)))]
async fn skip(State(app): State<Arc<App>>, asker: Asker, body: Bytes) -> Result<Json<Answered>, Problem> {
    let SkipBody { to, reason } = read_json(&body)?;
    let reason = reason.trim().to_owned();
    let chars = reason.chars().count();
    if !(1..=MOST_REASON_CHARS).contains(&chars) {
        return Err(invalid_item("reason", format!("{chars} characters"), "why, in 1 to 500 characters"));
    }
    answered(&app, &app.skip_to(&asker, to, reason).await?)
}

/// Back to the scenario's state before, with the variables as they were when it was entered.
#[utoipa::path(post, path = "/scenario/rewind", tag = "scenes", request_body(content = ReasonBody, description = "The reason is due"),
    responses((status = 200, body = Answered), (status = 409, description = "Refused", body = Problem),
        (status = 422, description = "No reason given", body = Problem), (status = 503, description = "Busy", body = Problem)))]
async fn rewind(State(app): State<Arc<App>>, asker: Asker, body: Bytes) -> Result<Json<Answered>, Problem> {
    let Some(reason) = ReasonBody::read(&body)? else {
        return Err(invalid_item("reason", "nothing", "why the scenario goes back, in words"));
    };
    answered(&app, &app.rewind(&asker, reason).await?)
}

const MOST_REASON_CHARS: usize = 500;
