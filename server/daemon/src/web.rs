//! The dashboard's pages, embedded in the binary.

use axum::body::Body;
use axum::http::{HeaderValue, Method, StatusCode, Uri, header};
use axum::response::{IntoResponse, Response};
use rust_embed::{EmbeddedFile, RustEmbed};

/// What the build made of `web`, or one page that says how to build it.
#[derive(RustEmbed)]
#[folder = "$OUT_DIR/web"]
struct Bundle;

/// A file of the bundle; any other path without a file's ending is the dashboard's own, and gets its page.
pub async fn page(method: Method, uri: Uri) -> Response {
    if method != Method::GET && method != Method::HEAD {
        return StatusCode::METHOD_NOT_ALLOWED.into_response();
    }
    let path = uri.path().trim_start_matches('/');
    if let Some(file) = Bundle::get(path).filter(|_| !path.is_empty()) {
        return respond(path, file);
    }
    let names_a_file = path.rsplit('/').next().is_some_and(|name| name.contains('.'));
    match Bundle::get(INDEX) {
        Some(file) if !names_a_file => respond(INDEX, file),
        _ => StatusCode::NOT_FOUND.into_response(),
    }
}

/// The rendered reference of the API; without it, the page that says how to build it.
pub async fn docs() -> Response {
    match Bundle::get(DOCS) {
        Some(file) => respond(DOCS, file),
        None => page(Method::GET, Uri::from_static("/")).await,
    }
}

fn respond(path: &str, file: EmbeddedFile) -> Response {
    // Vite puts a hash of the content into the names under assets.
    let cache = if path.starts_with("assets/") { "public, max-age=31536000, immutable" } else { "no-cache" };
    let mime = file.metadata.mimetype().to_owned();
    let mut response = Body::from(file.data.into_owned()).into_response();
    let headers = response.headers_mut();
    let mime = if mime.starts_with("text/") { format!("{mime}; charset=utf-8") } else { mime };
    if let Ok(mime) = mime.parse() {
        headers.insert(header::CONTENT_TYPE, mime);
    }
    headers.insert(header::CACHE_CONTROL, HeaderValue::from_static(cache));
    headers.insert(header::CONTENT_SECURITY_POLICY, HeaderValue::from_static(POLICY));
    headers.insert(header::X_CONTENT_TYPE_OPTIONS, HeaderValue::from_static("nosniff"));
    headers.insert(header::REFERRER_POLICY, HeaderValue::from_static("no-referrer"));
    response
}

const INDEX: &str = "index.html";
const DOCS: &str = "docs.html";
/// Nothing from elsewhere, no inline scripts; inline styles are set by the drawing code.
const POLICY: &str = "default-src 'self'; connect-src 'self' ws: wss:; img-src 'self' data: blob:; \
    style-src 'self' 'unsafe-inline'; object-src 'none'; base-uri 'none'; frame-ancestors 'none'; form-action 'self'";

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn a_path_of_the_dashboard_gets_its_page_and_a_missing_file_does_not() {
        for path in ["/", "/scenes/3"] {
            let response = page(Method::GET, path.parse().unwrap()).await;
            assert_eq!(response.status(), StatusCode::OK, "{path}");
            assert_eq!(response.headers()[header::CONTENT_TYPE], "text/html; charset=utf-8");
            assert_eq!(response.headers()[header::CACHE_CONTROL], "no-cache");
        }
        let response = page(Method::GET, "/assets/gone.js".parse().unwrap()).await;
        assert_eq!(response.status(), StatusCode::NOT_FOUND);
    }
}
