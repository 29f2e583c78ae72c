//! The dashboard's pages, embedded in the binary.

use axum::body::Body;
use axum::http::{HeaderMap, HeaderValue, Method, StatusCode, Uri, header};
use axum::response::{IntoResponse, Response};
use rust_embed::{EmbeddedFile, RustEmbed};

/// What the build made of `web`, or one page that says how to build it.
#[derive(RustEmbed)]
#[folder = "$OUT_DIR/web"]
struct Bundle;

/// A file of the bundle; any other path without a file's ending is the dashboard's own, and gets its page.
pub async fn page(method: Method, uri: Uri, headers: HeaderMap) -> Response {
    if method != Method::GET && method != Method::HEAD {
        return StatusCode::METHOD_NOT_ALLOWED.into_response();
    }
    let path = uri.path().trim_start_matches('/');
    let asked = Asked { gzip: takes_gzip(&headers) };
    if let Some(answer) = asked.file(path).filter(|_| !path.is_empty()) {
        return answer;
    }
    let names_a_file = path.rsplit('/').next().is_some_and(|name| name.contains('.'));
    match asked.file(INDEX) {
        Some(answer) if !names_a_file => answer,
        _ => StatusCode::NOT_FOUND.into_response(),
    }
}

/// The rendered reference of the API; without it, the page that says how to build it.
pub async fn docs(headers: HeaderMap) -> Response {
    match (Asked { gzip: takes_gzip(&headers) }).file(DOCS) {
        Some(answer) => answer,
        None => page(Method::GET, Uri::from_static("/"), headers).await,
    }
}

/// What the asker takes.
#[derive(Clone, Copy)]
struct Asked {
    gzip: bool,
}

impl Asked {
    /// A file of the bundle, as the build has compressed it where it has and the asker takes that.
    fn file(self, path: &str) -> Option<Response> {
        let file = Bundle::get(path)?;
        let mime = file.metadata.mimetype().to_owned();
        let compressed = Bundle::get(&format!("{path}.gz"));
        let varies = compressed.is_some();
        let gzip = compressed.filter(|_| self.gzip);
        let encoded = gzip.is_some();
        let mut response = respond(path, &mime, gzip.unwrap_or(file));
        let headers = response.headers_mut();
        if varies {
            headers.insert(header::VARY, HeaderValue::from_static("accept-encoding"));
        }
        if encoded {
            headers.insert(header::CONTENT_ENCODING, HeaderValue::from_static("gzip"));
        }
        Some(response)
    }
}

/// Whether `Accept-Encoding` names gzip and does not rule it out.
fn takes_gzip(headers: &HeaderMap) -> bool {
    let encodings = headers.get_all(header::ACCEPT_ENCODING).iter().filter_map(|value| value.to_str().ok());
    encodings.flat_map(|value| value.split(',')).any(|encoding| {
        let (name, weight) = encoding.split_once(';').unwrap_or((encoding, ""));
        let refused = weight.trim().strip_prefix("q=").is_some_and(|q| q.trim().parse() == Ok(0.0));
        name.trim().eq_ignore_ascii_case("gzip") && !refused
    })
}

fn respond(path: &str, mime: &str, file: EmbeddedFile) -> Response {
    // Vite puts a hash of the content into the names under assets.
    let cache = if path.starts_with("assets/") { "public, max-age=31536000, immutable" } else { "no-cache" };
    let mut response = Body::from(file.data.into_owned()).into_response();
    let headers = response.headers_mut();
    let mime = if mime.starts_with("text/") { format!("{mime}; charset=utf-8") } else { mime.to_owned() };
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
    use flate2::read::GzDecoder;
    use std::io::Read as _;

    #[tokio::test]
    async fn a_path_of_the_dashboard_gets_its_page_and_a_missing_file_does_not() {
        for path in ["/", "/scenes/3"] {
            let response = page(Method::GET, path.parse().unwrap(), HeaderMap::new()).await;
            assert_eq!(response.status(), StatusCode::OK, "{path}");
            assert_eq!(response.headers()[header::CONTENT_TYPE], "text/html; charset=utf-8");
            assert_eq!(response.headers()[header::CACHE_CONTROL], "no-cache");
        }
        let response = page(Method::GET, "/assets/gone.js".parse().unwrap(), HeaderMap::new()).await;
        assert_eq!(response.status(), StatusCode::NOT_FOUND);
    }

    #[test]
    fn what_is_compressed_is_what_stands_beside_it() {
        for path in Bundle::iter().filter(|path| path.ends_with(".gz")) {
            let compressed = Bundle::get(&path).unwrap();
            let mut text = Vec::new();
            GzDecoder::new(&*compressed.data).read_to_end(&mut text).unwrap();
            let plain = Bundle::get(path.trim_end_matches(".gz")).unwrap();
            assert!(text == *plain.data, "{path}");
        }
    }

    #[test]
    fn gzip_is_for_those_who_take_it() {
        let takes = |value: &'static str| {
            takes_gzip(&HeaderMap::from_iter([(header::ACCEPT_ENCODING, HeaderValue::from_static(value))]))
        };
        assert!(takes("gzip") && takes("br, GZIP") && takes("deflate, gzip;q=0.5"));
        assert!(!takes("br") && !takes("gzip;q=0") && !takes("gzipped") && !takes(""));
        assert!(!takes_gzip(&HeaderMap::new()));
    }
}
