//! Priors: what they would do, their change, and who changed them.

use std::collections::BTreeMap;
use std::sync::Arc;

use axum::Json;
use axum::body::Bytes;
use axum::extract::{Query, State};
use covr_engine::frames::Floor;
use covr_wire::answers::PriorChange;
use covr_wire::reason::Reason;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use ts_rs::TS;
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::input::{Limit, json as read_json};
use super::problem::{Problem, ProblemItem};
use crate::app::{App, Asker};
use crate::stage::{BadPrior, PriorsRefused, read_priors};

/// What became of priors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
#[schema(example = json!({ "changed": ["lamp"] }))]
pub struct PriorsChanged {
    /// Objects whose prior is another now.
    pub changed: Vec<String>,
}

/// What other priors would do now.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema, TS)]
#[schema(example = json!({
    "target_m": [1.2, 3.4], "serves": 1, "committed": "lamp", "planned_path_m": [[2.0, 2.0], [1.95, 2.08]],
    "objects": [{ "id": "lamp", "weight": 0.36, "probability": 0.8, "prior": 0.4 },
                { "id": "globe", "weight": 0.09, "probability": 0.2, "prior": 0.1 }]
}))]
pub struct PriorsPreview {
    /// Where the column would be wanted, room frame; null when nobody would be served.
    pub target_m: Option<[f64; 2]>,
    /// Id of the person who would be served.
    pub serves: Option<u32>,
    /// Id of the object that the rule would be committed to.
    pub committed: Option<String>,
    /// Where the column would go if everybody walked on for a moment and then stood, 0.1 s apart; empty when it would go
    /// nowhere.
    pub planned_path_m: Vec<[f64; 2]>,
    /// Every object of the active scene, in its order.
    pub objects: Vec<ObjectPreview>,
}

/// An object under other priors.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema, TS)]
pub struct ObjectPreview {
    /// The scene's id of the object.
    pub id: String,
    /// W of the rule, prior included.
    pub weight: f64,
    /// Its share of the weight.
    pub probability: f64,
    /// The prior: as given, or as it is.
    pub prior: f64,
}

/// The routes.
pub fn routes() -> OpenApiRouter<Arc<App>> {
    OpenApiRouter::new().routes(routes!(change)).routes(routes!(preview)).routes(routes!(changes))
}

/// Change priors of the active scene, all or none: `{"object id": 0.4}`.
#[utoipa::path(patch, path = "/priors", tag = "priors",
    request_body(content = BTreeMap<String, f64>, example = json!({ "lamp": 0.4 })),
    responses((status = 200, body = PriorsChanged), (status = 400, description = "Not a JSON object", body = Problem),
        (status = 422, description = "An unknown object, or not from 0 to 1; nothing is changed", body = Problem)))]
async fn change(
    State(app): State<Arc<App>>,
    asker: Asker,
    body: Bytes,
) -> Result<Json<PriorsChanged>, Problem> {
    let wanted: BTreeMap<String, Value> = read_json(&body)?;
    let done = app.stage.change_priors(&app.control, &app.store, asker.author(), &wanted).await;
    let changes = done.map_err(|why| match why {
        PriorsRefused::Invalid(bad) => invalid(bad),
        PriorsRefused::Refused(why) => Problem::refused(Reason::new(&why, &app.persons.names())),
        PriorsRefused::NotDelivered(why) => why.into(),
        PriorsRefused::Store(why) => why.into(),
    })?;
    for change in &changes {
        app.recorder.record(
            "prior_changed",
            format!("{asker} set the prior of {} from {} to {}", change.object, change.from, change.to),
            asker.sign(json!({ "object": change.object, "from": change.from, "to": change.to })),
        );
    }
    Ok(Json(PriorsChanged { changed: changes.into_iter().map(|change| change.object).collect() }))
}

/// What the column would do now with these priors. Nothing is changed by it.
#[utoipa::path(post, path = "/priors/preview", tag = "priors",
    request_body(content = BTreeMap<String, f64>, example = json!({ "lamp": 0.4 })),
    responses((status = 200, body = PriorsPreview), (status = 400, description = "Not a JSON object", body = Problem),
        (status = 422, description = "An unknown object, or not from 0 to 1", body = Problem)))]
async fn preview(State(app): State<Arc<App>>, body: Bytes) -> Result<Json<PriorsPreview>, Problem> {
    let wanted: BTreeMap<String, Value> = read_json(&body)?;
    let published = app.control.published();
    let outlook = published.outlook.clone();
    let known = |id: &str| outlook.scene().spec().objects.iter().position(|object| object.id == id);
    let mut priors = outlook.priors().to_vec();
    for (index, prior) in read_priors(&wanted, known).map_err(invalid)? {
        priors[index] = prior;
    }
    // Milliseconds of arithmetic: not on a thread that serves others.
    let found = tokio::task::spawn_blocking(move || {
        let preview = outlook.with_priors(&priors);
        let id = |index: usize| outlook.scene().spec().objects.get(index).map(|object| object.id.clone());
        let objects = preview.objects.iter().enumerate().filter_map(|(index, object)| {
            let (weight, probability, prior) = (object.weight, object.probability, object.prior);
            Some(ObjectPreview { id: id(index)?, weight, probability, prior })
        });
        PriorsPreview {
            target_m: preview.target.map(floor),
            serves: preview.serves.map(|person| person.0),
            committed: preview.committed.and_then(id),
            planned_path_m: preview.path.iter().copied().map(floor).collect(),
            objects: objects.collect(),
        }
    });
    found.await.map(Json).map_err(|_| Problem::unavailable(Reason::PreviewUnfinished))
}

/// Who changed which prior when, newest first.
#[utoipa::path(get, path = "/priors/changes", tag = "priors", params(Limit),
    responses((status = 200, description = "Changes, newest first", body = ref("#/components/schemas/PriorChangeList")), (status = 422, body = Problem, description = "Bad limit")))]
async fn changes(
    State(app): State<Arc<App>>,
    Query(limit): Query<Limit>,
) -> Result<Json<Vec<PriorChange>>, Problem> {
    Ok(Json(app.store.prior_changes(limit.rows()?).await?))
}

fn invalid(bad: Vec<BadPrior>) -> Problem {
    let words = bad.iter().map(|b| format!("{}: found {}, expected {}", b.object, b.found, b.expected));
    let detail = words.collect::<Vec<_>>().join("; ");
    let items = bad.into_iter().map(|b| ProblemItem::new(b.object, b.found, b.expected));
    Problem::invalid(detail, items.collect())
}

const fn floor(at: Floor) -> [f64; 2] {
    [at.x, at.y]
}
