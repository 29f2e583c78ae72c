//! Who asks, and whether they may: before any handler, and by the table alone. What the table does not have is
//! answered to nobody. It holds up no stop: a stop waits for no hash and no database, and needs no name.

use std::sync::Arc;

use axum::extract::{MatchedPath, Request, State};
use axum::http::{HeaderMap, HeaderValue, Method, StatusCode, Uri, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};
use cookie::Cookie;

use super::access::LOGIN_COOKIE;
use super::limits::peer;
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
        let is_new = bearer(request.headers()).is_some_and(|token| app.roster.at_once(token).is_none());
        let hashes = app.roster.asks() && (is_new || key == SIGN_IN);
        if hashes && let Err(too_much) = app.limits.try_token(peer(&request)) {
            return too_much.into_response();
        }
        match identify(&app, &path, request.uri(), request.headers()).await {
            Ok(caller) => caller,
            Err(_) if who == Who::Anybody => Caller::Stranger,
            Err(problem) => {
                tracing::info!(key, why = problem.detail, from = %peer(&request), "refused");
                return refused(problem);
            }
        }
    };
    if !app.roster.allows(&caller, &key) {
        let why = app.roster.why_not(&caller, &key);
        tracing::info!(key, why, "refused");
        return match caller.holder() {
            None => refused(Problem::unauthorized(why)),
            Some(_) => Problem::forbidden(why).into_response(),
        };
    }
    if !is_proven(&caller, &key, request.headers()) {
        let why = "a page that is signed in by a cookie sends the `csrf` of GET /api/v1/me as X-Covr-Csrf";
        return Problem::forbidden(why).into_response();
    }
    request.extensions_mut().insert(caller);
    next.run(request).await
}

/// By a token in the headers, by a ticket for a socket, by a cookie; without any, nobody.
async fn identify(app: &App, path: &str, uri: &Uri, headers: &HeaderMap) -> Result<Caller, Problem> {
    if !app.roster.asks() {
        return Ok(Caller::Unasked);
    }
    match bearer(headers) {
        Some(token) => match app.roster.by_token(token).await {
            Ok(holder) => Ok(Caller::Known(holder)),
            Err(why) => Err(why.into()),
        },
        None if path.starts_with(SOCKETS) => match ticket(uri) {
            Some(ticket) => app.roster.by_ticket(ticket).ok_or_else(|| {
                Problem::unauthorized("the ticket is not known, was used before, or is older than 30 s")
            }),
            None => Ok(by_cookie(app, headers)),
        },
        None => Ok(by_cookie(app, headers)),
    }
}

/// Whoever can be known without waiting.
fn at_once(app: &App, headers: &HeaderMap) -> Caller {
    let holder = bearer(headers).and_then(|token| app.roster.at_once(token)?.ok());
    holder.map_or_else(|| by_cookie(app, headers), Caller::Known)
}

fn by_cookie(app: &App, headers: &HeaderMap) -> Caller {
    let cookies = headers.get_all(header::COOKIE).iter().filter_map(|cookies| cookies.to_str().ok());
    let login = cookies
        .flat_map(Cookie::split_parse)
        .find_map(|cookie| cookie.ok().filter(|cookie| cookie.name() == LOGIN_COOKIE));
    let holder = login.and_then(|cookie| app.roster.by_cookie(cookie.value()));
    holder.map_or_else(|| app.roster.nobody(), Caller::Known)
}

fn ticket(uri: &Uri) -> Option<&str> {
    uri.query()?.split('&').find_map(|pair| pair.strip_prefix("ticket="))
}

/// Whether it is plain that a page of this server asked, and not another site by way of a browser's cookie. Sockets have
/// their `Origin` for that (see `guard`). The stop asks for no proof.
fn is_proven(caller: &Caller, key: &str, headers: &HeaderMap) -> bool {
    let Some(holder) = caller.holder() else { return true };
    let Some(csrf) = holder.csrf() else { return true };
    let shown = headers.get(CSRF_HEADER).map(|shown| shown.as_bytes());
    key.starts_with("GET ") || key == STOP || shown == Some(csrf.as_bytes())
}

fn bearer(headers: &HeaderMap) -> Option<&str> {
    let (scheme, token) = headers.get(header::AUTHORIZATION)?.to_str().ok()?.split_once(' ')?;
    scheme.eq_ignore_ascii_case("bearer").then_some(token.trim())
}

fn refused(problem: Problem) -> Response {
    let mut response = problem.into_response();
    if response.status() == StatusCode::UNAUTHORIZED {
        response.headers_mut().insert(header::WWW_AUTHENTICATE, HeaderValue::from_static("Bearer"));
    }
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

const CSRF_HEADER: &str = "x-covr-csrf";
const SOCKETS: &str = "/ws/";
const SIGN_IN: &str = "POST /api/v1/login";
const STOP: &str = "POST /api/v1/stop";
/// What answers 404 below `/api`.
const NOTHING_HERE: &str = "/api/{*rest}";
