//! Who am I, signing in and out, tickets for WebSockets, and the tokens themselves.

use std::sync::Arc;

use axum::Json;
use axum::body::Bytes;
use axum::extract::{Extension, Path, State};
use axum::http::header::{CACHE_CONTROL, SET_COOKIE};
use axum::http::{HeaderValue, StatusCode};
use axum::response::{IntoResponse, Response};
use cookie::{Cookie, SameSite};
use serde::{Deserialize, Serialize};
use serde_json::json;
use ts_rs::TS;
use utoipa::ToSchema;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::input::json as read_json;
use super::problem::Problem;
use crate::access::{Caller, Holder, NotLetIn, Role, TICKET_LASTS, table};
use crate::app::{App, Asker};
use crate::clock::wall_now;
use crate::store::StoredToken;

/// Whom the server takes the asker for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema, TS)]
pub struct Me {
    /// Whether the server asks anybody: false until the first token is made.
    pub asks: bool,
    /// The token's name; null for nobody.
    pub name: Option<String>,
    /// The token's role; null for nobody.
    pub role: Option<Role>,
    /// What a page that is signed in by a cookie sends as `X-Covr-Csrf` with everything that changes something; null
    /// for others.
    pub csrf: Option<String>,
    /// Routes (`POST /api/v1/arm`) and messages (`dashboard arm`) that are open to the asker.
    pub may: Vec<String>,
}

/// A token to sign in with.
#[derive(Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct SignIn {
    /// As `covr token create` printed it.
    pub token: String,
}

/// Good for one WebSocket, as `?ticket=` of its address.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema, TS)]
pub struct Ticket {
    /// The ticket.
    pub ticket: String,
    /// How long it can be used, s.
    pub lasts_secs: u64,
}

/// A token without its secret.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct TokenRow {
    /// Its public part.
    pub id: String,
    /// What its holder is called.
    pub name: String,
    /// What its holder may do.
    pub role: Role,
    /// When it was made, RFC 3339.
    pub created_at: String,
    /// When it ends by itself; null: never.
    pub expires_at: Option<String>,
    /// When it was taken back.
    pub revoked_at: Option<String>,
}

/// The routes.
pub fn routes() -> OpenApiRouter<Arc<App>> {
    OpenApiRouter::new()
        .routes(routes!(me))
        .routes(routes!(sign_in))
        .routes(routes!(sign_out))
        .routes(routes!(ticket))
        .routes(routes!(tokens))
        .routes(routes!(revoke))
}

/// Who am I, and what may I?
#[utoipa::path(get, path = "/me", tag = "access", responses((status = 200, body = Me)))]
async fn me(State(app): State<Arc<App>>, Extension(caller): Extension<Caller>) -> Response {
    private(Json(who_is(&app, &caller)))
}

/// Sign a browser in: the answer sets a cookie that no script can read.
#[utoipa::path(post, path = "/login", tag = "access", request_body = SignIn,
    responses((status = 200, body = Me), (status = 401, description = "Not a token in force", body = Problem),
        (status = 409, description = "This server asks nobody: it has no token", body = Problem),
        (status = 503, description = "The database did not answer", body = Problem)))]
async fn sign_in(State(app): State<Arc<App>>, asker: Asker, body: Bytes) -> Result<Response, Problem> {
    let SignIn { token } = read_json(&body)?;
    if !app.roster.asks() {
        return Err(Problem::new(
            StatusCode::CONFLICT,
            "refused",
            "Refused",
            "this server asks nobody who they are: no token was made yet",
        ));
    }
    let signed_in = app.roster.sign_in(token.trim()).await?;
    let caller = Caller::Known(signed_in.holder);
    let asker = Asker { caller, ..asker };
    app.recorder.record("signed_in", format!("{asker} signed in"), asker.sign(json!({})));
    let cookie = cookie(&app, signed_in.cookie, signed_in.lasts.as_secs());
    Ok(with_cookie(private(Json(who_is(&app, &asker.caller))), &cookie))
}

/// Sign out. What the page has open is closed.
#[utoipa::path(post, path = "/logout", tag = "access",
    responses((status = 200, body = Me), (status = 503, description = "The database did not answer", body = Problem)))]
async fn sign_out(State(app): State<Arc<App>>, asker: Asker) -> Result<Response, Problem> {
    if let Some(holder) = asker.caller.holder().filter(|holder| holder.came_by_cookie()) {
        app.roster.sign_out(holder).await?;
        app.recorder.record("signed_out", format!("{asker} signed out"), asker.sign(json!({})));
    }
    let forgotten = cookie(&app, String::new(), 0);
    Ok(with_cookie(private(Json(who_is(&app, &app.roster.nobody()))), &forgotten))
}

/// A ticket for one WebSocket: for those who can send neither a header nor a cookie with its upgrade.
#[utoipa::path(post, path = "/tickets", tag = "access", responses((status = 200, body = Ticket)))]
async fn ticket(
    State(app): State<Arc<App>>,
    Extension(caller): Extension<Caller>,
) -> Result<Response, Problem> {
    let ticket = app.roster.ticket(caller).map_err(NotLetIn::from)?;
    Ok(private(Json(Ticket { ticket, lasts_secs: TICKET_LASTS.as_secs() })))
}

/// Every token, without its secret, oldest first. New ones are made by `covr token create` alone.
#[utoipa::path(get, path = "/tokens", tag = "access",
    responses((status = 200, description = "Tokens", body = Vec<TokenRow>), (status = 503, description = "The database did not answer", body = Problem)))]
async fn tokens(State(app): State<Arc<App>>) -> Result<Json<Vec<TokenRow>>, Problem> {
    Ok(Json(app.store.tokens().await?.into_iter().map(TokenRow::from).collect()))
}

/// Take a token back. Whatever its holder has open is closed.
#[utoipa::path(delete, path = "/tokens/{id}", tag = "access", params(("id" = String, Path, description = "The token's id", example = "3f9a01bc")),
    responses((status = 200, body = TokenRow), (status = 404, description = "No such token in use", body = Problem),
        (status = 503, description = "The database did not answer", body = Problem)))]
async fn revoke(
    State(app): State<Arc<App>>,
    asker: Asker,
    Path(id): Path<String>,
) -> Result<Json<TokenRow>, Problem> {
    let revoked = app.store.revoke_token(&id, &wall_now()).await?;
    let token = revoked.ok_or_else(|| {
        let detail = format!("there is no token {id} in use");
        Problem::new(StatusCode::NOT_FOUND, "not-found", "Not found", detail)
    })?;
    let summary = format!("{asker} took back the token {} ({})", token.name, token.role.in_words());
    let detail = json!({ "token": token.name, "token_id": token.id, "role": token.role });
    app.recorder.record("token_taken_back", summary, asker.sign(detail));
    app.follow_tokens().await;
    Ok(Json(token.into()))
}

impl From<StoredToken> for TokenRow {
    fn from(token: StoredToken) -> Self {
        let StoredToken { id, name, role, created, expires, revoked, .. } = token;
        Self { id, name, role, created_at: created, expires_at: expires, revoked_at: revoked }
    }
}

fn who_is(app: &App, caller: &Caller) -> Me {
    let holder = caller.holder();
    let may = table::keys().filter(|key| app.roster.allows(caller, key));
    Me {
        asks: app.roster.asks(),
        name: holder.map(|holder| holder.name.clone()),
        role: holder.map(|holder| holder.role),
        csrf: holder.and_then(Holder::csrf),
        may: may.map(Into::into).collect(),
    }
}

fn cookie(app: &App, value: String, lasts_secs: u64) -> Cookie<'static> {
    let lasts = time::Duration::seconds(i64::try_from(lasts_secs).unwrap_or(i64::MAX));
    Cookie::build((LOGIN_COOKIE, value))
        .path("/")
        .http_only(true)
        .secure(app.config.server.is_encrypted())
        .same_site(SameSite::Strict)
        .max_age(lasts)
        .build()
}

fn with_cookie(mut response: Response, cookie: &Cookie<'_>) -> Response {
    if let Ok(cookie) = cookie.to_string().parse() {
        response.headers_mut().insert(SET_COOKIE, cookie);
    }
    response
}

/// Never kept by a browser or a proxy.
fn private(answer: impl IntoResponse) -> Response {
    (StatusCode::OK, [(CACHE_CONTROL, HeaderValue::from_static("no-store"))], answer).into_response()
}

/// The cookie of a browser that is signed in.
pub const LOGIN_COOKIE: &str = "covr_login";
