//! Commissionings: what `covr commission` hands in, and what came of it.

use std::sync::Arc;

use axum::Json;
use axum::body::Bytes;
use axum::extract::State;
use axum::http::StatusCode;
use covr_wire::commissioning::{Commissioning, CommissioningStep, NewCommissioning, judge};
use covr_wire::reason::Reason;
use serde_json::json;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::input::{invalid_item, json as read_json};
use super::problem::Problem;
use crate::app::{App, Asker};
use crate::clock::{wall_now, wall_time};

/// The routes.
pub fn routes() -> OpenApiRouter<Arc<App>> {
    OpenApiRouter::new().routes(routes!(list, add))
}

/// Every commissioning, newest first; the first counts.
#[utoipa::path(get, path = "/commissionings", tag = "machine",
    responses((status = 200, description = "Commissionings, newest first", body = ref("#/components/schemas/CommissioningList"))))]
async fn list(State(app): State<Arc<App>>) -> Result<Json<Vec<Commissioning>>, Problem> {
    let now = app.calibrations.hardware(&app.control.published());
    let all = app.store.commissionings().await?.into_iter();
    Ok(Json(all.map(|one| Commissioning { changed: one.hardware.changes(&now), ..one }).collect()))
}

/// Hand in a commissioning. The server judges the brake by the stops that it measured itself since `begun_at`.
#[utoipa::path(post, path = "/commissionings", tag = "machine", request_body = ref("#/components/schemas/NewCommissioning"),
    responses((status = 201, body = ref("#/components/schemas/Commissioning")), (status = 400, description = "Not JSON", body = Problem),
        (status = 409, description = "A step is missing, or the brake is not what separation relies on", body = Problem),
        (status = 422, description = "Not a commissioning", body = Problem)))]
async fn add(
    State(app): State<Arc<App>>,
    asker: Asker,
    body: Bytes,
) -> Result<(StatusCode, Json<Commissioning>), Problem> {
    let new: NewCommissioning = read_json(&body)?;
    if !(0.0..=MOST_LOAD_KG).contains(&new.load_kg) {
        return Err(invalid_item("load_kg", new.load_kg, "0 to 500 kg"));
    }
    let Some(begun) = wall_time(&new.begun_at) else {
        return Err(invalid_item("begun_at", &new.begun_at, "a time as in RFC 3339, in UTC"));
    };
    if let Some(step) = CommissioningStep::ALL.into_iter().find(|step| !new.steps.contains(step)) {
        return Err(refuse(&app, &asker, Reason::CommissioningUnfinished { step }).await);
    }
    let runs = app.store.stops_measured_since(&begun).await?;
    let machine = &app.config.machine;
    let braking_mps2 = match judge(&runs, &machine.limits(), &machine.travel()) {
        Ok(braking_mps2) => braking_mps2,
        Err(why) => return Err(refuse(&app, &asker, why).await),
    };
    let commissioning = Commissioning {
        id: 0,
        author: asker.author().into(),
        created_at: wall_now(),
        load_kg: new.load_kg,
        braking_mps2,
        runs,
        hardware: app.calibrations.hardware(&app.control.published()),
        changed: Vec::new(),
    };
    let commissioning = app.commissionings.add(&app.store, commissioning).await?;
    let [x, y] = braking_mps2;
    let words = format!(
        "{asker} commissioned the machine: under {:.1} kg its brake does {x:.2} and {y:.2} m/s2",
        new.load_kg
    );
    let detail =
        json!({ "commissioning": commissioning.id, "load_kg": new.load_kg, "braking_mps2": braking_mps2 });
    app.recorder.record("machine_commissioned", words, asker.sign(detail));
    app.recorder.settled().await;
    Ok((StatusCode::CREATED, Json(commissioning)))
}

async fn refuse(app: &App, asker: &Asker, why: Reason) -> Problem {
    let detail = json!({ "detail": why.to_string(), "why": why });
    app.recorder.record(
        "commissioning_refused",
        format!("commissioning by {asker}: refused: {why}"),
        asker.sign(detail),
    );
    app.recorder.settled().await;
    Problem::refused(why)
}

const MOST_LOAD_KG: f64 = 500.0;
