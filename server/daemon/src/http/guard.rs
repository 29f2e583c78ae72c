//! Browsers on other sites may not move the machine: a request that says where it comes from must come from
//! this server's own pages. Programs send no `Origin` and are not concerned. The stop is open to everybody.
//! Pages that the configuration names (`clients.allowed_origins`) may connect as VR clients, and nothing else.

use std::net::IpAddr;
use std::sync::Arc;

use axum::extract::{Request, State};
use axum::http::uri::Authority;
use axum::http::{HeaderMap, Uri, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

use super::STOP_PATH;
use super::problem::Problem;
use crate::app::App;

/// Refuse what comes from another site.
pub async fn same_host(State(app): State<Arc<App>>, request: Request, next: Next) -> Response {
    if request.uri().path() == STOP_PATH {
        return next.run(request).await;
    }
    let loopback_only = app.config.server.bind.ip().is_loopback();
    let allowed: &[String] =
        if request.uri().path() == CLIENTS { &app.config.clients.allowed_origins } else { &[] };
    match refusal(request.headers(), request.uri(), loopback_only, allowed) {
        Some(why) => Problem::forbidden(why).into_response(),
        None => next.run(request).await,
    }
}

/// Why these headers are refused. On a server that only this machine reaches, the host must be this machine:
/// a name of someone's own that resolves to it would be another site in disguise.
fn refusal(headers: &HeaderMap, uri: &Uri, loopback_only: bool, allowed: &[String]) -> Option<String> {
    let named = headers.get(header::HOST).and_then(|host| host.to_str().ok());
    // HTTP/2, which browsers speak over TLS, says the host in the address and has no header of it.
    let host = named.or_else(|| uri.authority().map(Authority::as_str));
    if let Some(host) = host
        && loopback_only
        && !is_this_machine(host)
    {
        return Some(format!("host {host} is not this machine"));
    }
    let origin = headers.get(header::ORIGIN)?.to_str().unwrap_or("an unreadable origin");
    if allowed.iter().any(|allowed| allowed.eq_ignore_ascii_case(origin)) {
        return None;
    }
    let origin_host = origin.split_once("://").map(|(_, host)| host);
    (origin_host.is_none() || origin_host != host).then(|| {
        format!("requests from pages of {origin} are refused; this is {}", host.unwrap_or("nameless"))
    })
}

fn is_this_machine(host: &str) -> bool {
    let name = match host.rsplit_once(':') {
        Some((name, port)) if port.bytes().all(|b| b.is_ascii_digit()) => name,
        _ => host,
    };
    let address = name.trim_start_matches('[').trim_end_matches(']');
    name.eq_ignore_ascii_case("localhost") || address.parse::<IpAddr>().is_ok_and(|ip| ip.is_loopback())
}

const CLIENTS: &str = "/ws/v1/client";

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(host: &str, origin: Option<&str>, loopback_only: bool) -> bool {
        refused_but_for(&[], host, origin, loopback_only)
    }

    fn refused_but_for(allowed: &[&str], host: &str, origin: Option<&str>, loopback_only: bool) -> bool {
        let allowed: Vec<String> = allowed.iter().map(|&origin| origin.into()).collect();
        let mut headers = HeaderMap::new();
        headers.insert(header::HOST, host.parse().unwrap());
        if let Some(origin) = origin {
            headers.insert(header::ORIGIN, origin.parse().unwrap());
        }
        refusal(&headers, &Uri::from_static("/"), loopback_only, &allowed).is_some()
    }

    #[test]
    fn a_host_in_the_address_alone_is_looked_at_as_well() {
        let refused = |address: &'static str, origin: &'static str, loopback_only| {
            let mut headers = HeaderMap::new();
            headers.insert(header::ORIGIN, origin.parse().unwrap());
            refusal(&headers, &Uri::from_static(address), loopback_only, &[]).is_some()
        };
        let login = "https://lab.local:7878/api/v1/login";
        assert!(!refused(login, "https://lab.local:7878", false));
        assert!(refused(login, "https://elsewhere.example", false));
        assert!(refused("https://rebound.example/", "https://rebound.example", true));
    }

    #[test]
    fn own_pages_and_programs_pass() {
        assert!(!refused("127.0.0.1:7878", None, true));
        assert!(!refused("localhost:7878", Some("http://localhost:7878"), true));
        assert!(!refused("[::1]:7878", Some("http://[::1]:7878"), true));
        assert!(!refused("lab.local:7878", Some("http://lab.local:7878"), false));
    }

    #[test]
    fn other_sites_do_not() {
        assert!(refused("127.0.0.1:7878", Some("http://elsewhere.example"), true));
        assert!(refused("127.0.0.1:7878", Some("http://127.0.0.1:3000"), true));
        assert!(refused("127.0.0.1:7878", Some("null"), true));
        assert!(refused("rebound.example:7878", Some("http://rebound.example:7878"), true));
    }

    #[test]
    fn an_origin_that_is_allowed_passes_alone_and_the_host_is_still_looked_at() {
        let allowed = ["null", "http://localhost:5173"];
        assert!(!refused_but_for(&allowed, "127.0.0.1:7878", Some("null"), true));
        assert!(!refused_but_for(&allowed, "127.0.0.1:7878", Some("http://localhost:5173"), true));
        assert!(refused_but_for(&allowed, "127.0.0.1:7878", Some("http://localhost:5174"), true));
        assert!(refused_but_for(&allowed, "rebound.example:7878", Some("null"), true));
    }
}
