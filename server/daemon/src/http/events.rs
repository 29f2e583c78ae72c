//! What happened: events, newest first, page by page.

use std::sync::Arc;

use axum::Json;
use axum::extract::{OriginalUri, Query, State};
use axum::http::{HeaderMap, HeaderValue, Uri, header};
use covr_wire::dashboard::Event;
use serde::Deserialize;
use utoipa::IntoParams;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::input::{Limit, invalid_item};
use super::problem::Problem;
use crate::app::App;
use crate::store::EventFilter;

/// Which events. What is not given does not restrict.
#[derive(Debug, Clone, Deserialize, IntoParams)]
#[into_params(parameter_in = Query)]
struct Asked {
    /// Most rows, 1 to 10000; 100 when not given.
    limit: Option<u32>,
    /// Of one session alone.
    session: Option<i64>,
    /// Where a page begins: take it from the `Link` header of the page before.
    before: Option<i64>,
    /// Kinds, separated by commas: `stop_pressed,rule_breached`.
    kind: Option<String>,
    /// Text in the summary, 1 to 200 characters.
    search: Option<String>,
    /// About the person of this name, 1 to 64 characters.
    person: Option<String>,
}

/// The route.
pub fn routes() -> OpenApiRouter<Arc<App>> {
    OpenApiRouter::new().routes(routes!(events))
}

/// Events, newest first. With older ones behind them, the `Link` header names the next page (`rel="next"`, RFC 8288).
#[utoipa::path(get, path = "/events", tag = "record", params(Asked),
    responses((status = 200, description = "Events", body = ref("#/components/schemas/EventList"),
            headers(("Link" = Option<String>, description = "The next page; absent on the last"))),
        (status = 422, body = Problem, description = "Bad limit, unknown kind, or a text of another length")))]
async fn events(
    State(app): State<Arc<App>>,
    OriginalUri(uri): OriginalUri,
    Query(asked): Query<Asked>,
) -> Result<(HeaderMap, Json<Vec<Event>>), Problem> {
    let limit = Limit { limit: asked.limit }.rows()?;
    let page = app.store.events(limit, &asked.filter()?).await?;
    let mut headers = HeaderMap::new();
    if let Some(next) = page.next.and_then(|before| next_page(&uri, before)) {
        headers.insert(header::LINK, next);
    }
    Ok((headers, Json(page.events)))
}

impl Asked {
    fn filter(self) -> Result<EventFilter, Problem> {
        let kinds = self.kind.map(|kinds| kinds.split(',').map(known_kind).collect()).transpose()?;
        let search = self.search.map(|text| short("search", text, MOST_SEARCH_CHARS)).transpose()?;
        let person = self.person.map(|name| short("person", name, MOST_NAME_CHARS)).transpose()?;
        Ok(EventFilter { session: self.session, before: self.before, kinds, search, person })
    }
}

fn known_kind(kind: &str) -> Result<String, Problem> {
    if Event::KINDS.contains(&kind) {
        return Ok(kind.into());
    }
    Err(invalid_item("kind", format!("\"{kind}\""), &format!("some of {}", Event::KINDS.join(", "))))
}

fn short(field: &str, text: String, most: usize) -> Result<String, Problem> {
    match text.chars().count() {
        chars if (1..=most).contains(&chars) => Ok(text),
        chars => Err(invalid_item(field, format!("{chars} characters"), &format!("1 to {most} characters"))),
    }
}

/// The same question from a row on, as a link header.
fn next_page(uri: &Uri, before: i64) -> Option<HeaderValue> {
    let kept = uri.query().unwrap_or_default().split('&').filter(|pair| !pair.starts_with("before="));
    let mut pairs: Vec<String> = kept.filter(|pair| !pair.is_empty()).map(Into::into).collect();
    pairs.push(format!("before={before}"));
    HeaderValue::from_str(&format!("<{}?{}>; rel=\"next\"", uri.path(), pairs.join("&"))).ok()
}

const MOST_SEARCH_CHARS: usize = 200;
const MOST_NAME_CHARS: usize = 64;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_next_page_asks_the_same_from_further_on() {
        let uri: Uri = "/api/v1/events?kind=served&before=90&limit=10".parse().unwrap();
        let link = next_page(&uri, 40).unwrap();
        assert_eq!(link, "</api/v1/events?kind=served&limit=10&before=40>; rel=\"next\"");
        let bare: Uri = "/api/v1/events".parse().unwrap();
        assert_eq!(next_page(&bare, 7).unwrap(), "</api/v1/events?before=7>; rel=\"next\"");
    }
}
