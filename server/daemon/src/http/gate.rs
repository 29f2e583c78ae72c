//! Who asks, and whether they may: before any handler, and by the table alone. What the table does not have is
//! answered to nobody. It holds up no stop: a stop waits for no hash and no database, and needs no name.

use std::sync::Arc;

use axum::extract::{MatchedPath, Request, State};
use axum::http::{HeaderMap, HeaderValue, Method, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

use super::problem::Problem;
use crate::access::{Caller, Who, table};
use crate::app::App;

/// Let a request in with its caller, or refuse it.
pub async fn pass(State(app): State<Arc<App>>, mut request: Request, next: Next) -> Response {
    let path = request.extensions().get::<MatchedPath>().map(|path| path.as_str().to_owned());
    // The dashboard's own pages hold nothing that is not public.
    let Some(path) = path.filter(|path| path != NOTHING_HERE) else { return next.run(request).await };
    let method = if request.method() == Method::HEAD { Method::GET } else { request.method().clone() };
    let key = format!("{method} {path}");
    let Some(who) = table::who_may(&key) else { return not_in_table(&path) };
    let caller = if key == STOP {
        at_once(&app, request.headers())
    } else {
        match identify(&app, request.headers()).await {
            Ok(caller) => caller,
            Err(_) if who == Who::Anybody => Caller::Stranger,
            Err(problem) => return unauthorized(problem),
        }
    };
    if !app.roster.allows(&caller, &key) {
        let why = app.roster.why_not(&caller, &key);
        return match caller.holder() {
            None => unauthorized(Problem::unauthorized(why)),
            Some(_) => Problem::forbidden(why).into_response(),
        };
    }
    request.extensions_mut().insert(caller);
    next.run(request).await
}

/// By a token in the headers; without one, nobody.
async fn identify(app: &App, headers: &HeaderMap) -> Result<Caller, Problem> {
    if !app.roster.asks() {
        return Ok(Caller::Unasked);
    }
    match bearer(headers) {
        Some(token) => match app.roster.by_token(token).await {
            Ok(holder) => Ok(Caller::Known(holder)),
            Err(why) => Err(Problem::unauthorized(why.to_string())),
        },
        None => Ok(app.roster.nobody()),
    }
}

/// Whoever can be known without waiting.
fn at_once(app: &App, headers: &HeaderMap) -> Caller {
    let holder = bearer(headers).and_then(|token| app.roster.matched_before(token));
    holder.map_or_else(|| app.roster.nobody(), Caller::Known)
}

fn bearer(headers: &HeaderMap) -> Option<&str> {
    let (scheme, token) = headers.get(header::AUTHORIZATION)?.to_str().ok()?.split_once(' ')?;
    scheme.eq_ignore_ascii_case("bearer").then_some(token.trim())
}

fn unauthorized(problem: Problem) -> Response {
    let mut response = problem.into_response();
    response.headers_mut().insert(header::WWW_AUTHENTICATE, HeaderValue::from_static("Bearer"));
    response
}

/// Another method of a path that is there, or a route that somebody forgot.
fn not_in_table(path: &str) -> Response {
    let methods: Vec<&str> = table::keys()
        .filter_map(|key| key.split_once(' ').filter(|(_, known)| *known == path).map(|(method, _)| method))
        .collect();
    if methods.is_empty() {
        return Problem::forbidden("the table of who may do what does not have this route").into_response();
    }
    let mut response = StatusCode::METHOD_NOT_ALLOWED.into_response();
    if let Ok(allow) = methods.join(",").parse() {
        response.headers_mut().insert(header::ALLOW, allow);
    }
    response
}

const STOP: &str = "POST /api/v1/stop";
/// What answers 404 below `/api`.
const NOTHING_HERE: &str = "/api/{*rest}";
