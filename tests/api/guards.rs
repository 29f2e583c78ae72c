//! Other sites, other networks, the embedded page.

use std::os::unix::fs::PermissionsExt;
use std::path::PathBuf;

use covr_server::access::Role;
use covr_server::cert_command::{self, CertCommand};
use covr_server::config::Config;
use covr_server::serve::Server;
use covr_tests::SOON;
use covr_tests::server::{TestServer, problem, test_config};
use reqwest::Client;
use tempfile::TempDir;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;

#[tokio::test]
async fn pages_of_other_sites_may_stop_and_nothing_else() {
    let server = TestServer::start().await;
    let post = |path: &str| {
        let url = format!("http://{}{path}", server.host);
        Client::new().post(url).header("Origin", "http://elsewhere.example").send()
    };
    let refused = problem(403, "/api/v1/home", post("/api/v1/home").await.unwrap()).await;
    assert!(refused.detail.contains("elsewhere.example"), "{refused:?}");
    assert!(post("/api/v1/stop").await.unwrap().status().is_success());
    let url = format!("http://{}/ws/v1/dashboard", server.host);
    let upgrade = Client::new()
        .get(url)
        .header("Origin", "http://elsewhere.example")
        .header("Connection", "upgrade")
        .header("Upgrade", "websocket")
        .header("Sec-WebSocket-Version", "13")
        .header("Sec-WebSocket-Key", "dGhlIHNhbXBsZSBub25jZQ==");
    assert_eq!(upgrade.send().await.unwrap().status(), 403);
}

#[tokio::test]
async fn the_network_is_refused_without_tls_and_a_token_or_a_word() {
    let dir = TempDir::new().unwrap();
    let mut config = test_config(&dir);
    config.server.bind = ([0, 0, 0, 0], 0).into();
    let refused = async |config: &Config| format!("{:#}", Server::start(config.clone()).await.err().unwrap());
    let words = refused(&config).await;
    assert!(words.contains("--insecure-lan") && words.contains("covr cert"), "{words}");
    (config.server.tls_certificate, config.server.tls_key) = certificate(&dir);
    let words = refused(&config).await;
    assert!(words.contains("covr token create"), "{words}");
    assert!(!config.server.database.exists(), "refused before anything was touched");
    let mut insecure = config.clone();
    (insecure.server.tls_certificate, insecure.server.tls_key) = (None, None);
    insecure.server.insecure_lan = true;
    assert!(Server::start(insecure).await.is_ok(), "with the simulated machine it may");
    let words = refused(&config).await;
    assert!(words.contains("covr token create"), "a database without a token: {words}");
    config.server.tls_key = None;
    let words = refused(&config).await;
    assert!(words.contains("belong together"), "{words}");
    let missing = TempDir::new().unwrap();
    let mut config = test_config(&missing);
    (config.server.tls_certificate, config.server.tls_key) =
        (Some("none.pem".into()), Some("none.key".into()));
    let words = refused(&config).await;
    assert!(words.contains("none.pem") && !config.server.database.exists(), "before anything: {words}");
}

/// A certificate and its key, made as `covr cert` does.
fn certificate(dir: &TempDir) -> (Option<PathBuf>, Option<PathBuf>) {
    let out = dir.path().join("tls");
    let made =
        cert_command::run(&CertCommand { names: vec!["lab.local".into()], out: out.clone(), days: 30 });
    assert!(made.unwrap().contains("authority.pem"));
    (Some(out.join("server.pem")), Some(out.join("server.key")))
}

#[tokio::test]
async fn with_tls_the_page_the_cookie_and_the_socket_are_secure() {
    let dir = TempDir::new().unwrap();
    let (tls_certificate, tls_key) = certificate(&dir);
    let again = std::fs::read(dir.path().join("tls/authority.pem")).unwrap();
    certificate(&dir);
    assert_eq!(std::fs::read(dir.path().join("tls/authority.pem")).unwrap(), again, "the authority stays");
    let mode =
        |name: &str| std::fs::metadata(dir.path().join("tls").join(name)).unwrap().permissions().mode();
    assert_eq!([mode("authority.key") & 0o777, mode("server.key") & 0o777], [0o600; 2]);

    let server = TestServer::start_with(|config| {
        (config.server.tls_certificate, config.server.tls_key) = (tls_certificate, tls_key);
    })
    .await;
    let token = server.token(Role::Observer).await;
    let authority = reqwest::Certificate::from_pem(&again).unwrap();
    let client = Client::builder().add_root_certificate(authority).build().unwrap();
    let url = format!("https://{}", server.host);
    let body = serde_json::json!({ "token": token });
    let response = client.post(format!("{url}/api/v1/login")).json(&body).send().await.unwrap();
    assert_eq!(response.status(), 200);
    assert!(response.headers()["set-cookie"].to_str().unwrap().contains("; Secure"));
    assert!(response.headers().contains_key("strict-transport-security"));
    let stranger = Client::new().get(&url).send().await;
    assert!(stranger.unwrap_err().is_connect(), "whoever does not know the authority connects to nobody");
    assert!(
        Client::new().get(format!("http://{}", server.host)).send().await.is_err(),
        "nor does plain HTTP"
    );
}

#[tokio::test]
async fn every_answer_has_the_headers_that_keep_browsers_apart() {
    let server = TestServer::start().await;
    for path in ["/", "/api/v1/state", "/api/v1/nothing", "/healthz", "/api/docs"] {
        let response = server.call("GET", path, None).await;
        let has = |name: &str| response.headers().get(name).map(|value| value.to_str().unwrap().to_owned());
        assert_eq!(has("x-content-type-options").as_deref(), Some("nosniff"), "{path}");
        assert_eq!(has("x-frame-options").as_deref(), Some("DENY"), "{path}");
        assert_eq!(has("referrer-policy").as_deref(), Some("no-referrer"), "{path}");
        assert_eq!(has("cross-origin-resource-policy").as_deref(), Some("same-origin"), "{path}");
        assert_eq!(has("strict-transport-security"), None, "{path}: not without TLS");
    }
}

#[tokio::test]
async fn an_address_that_asks_too_often_is_told_when_to_go_on_and_stops_all_the_same() {
    let server = TestServer::start_with(|config| config.server.requests_per_sec = 2).await;
    let mut refused = None;
    for _ in 0..20 {
        let response = server.call("GET", "/api/v1/state", None).await;
        if response.status() == 429 {
            refused = Some(response);
        }
        assert_eq!(server.call("POST", "/api/v1/stop", None).await.status(), 200);
    }
    let refused = refused.unwrap();
    assert_eq!(refused.headers()["retry-after"], "1");
    problem(429, "/api/v1/state", refused).await;
}

#[tokio::test]
async fn whoever_guesses_tokens_is_slowed_down_and_whoever_is_known_is_not() {
    let server = TestServer::start().await;
    let token = server.token(Role::Observer).await;
    assert_eq!(server.call_with(Some(&token), "GET", "/api/v1/state", None).await.status(), 200);
    let guess = format!("{}{}", &token[..14], "0".repeat(64));
    let mut statuses = Vec::new();
    for _ in 0..15 {
        statuses.push(server.call_with(Some(&guess), "GET", "/api/v1/state", None).await.status().as_u16());
    }
    assert!(statuses.starts_with(&[401; 5]) && statuses.ends_with(&[429; 2]), "{statuses:?}");
    assert_eq!(server.call_with(Some(&token), "GET", "/api/v1/state", None).await.status(), 200);
    assert_eq!(server.call_with(Some(&guess), "POST", "/api/v1/stop", None).await.status(), 200);
}

#[tokio::test]
async fn a_program_whose_token_has_ended_keeps_nobody_beside_it_from_signing_in() {
    let server = TestServer::start().await;
    let ended = server.token_until(Role::Observer, Some("2026-01-02T00:00:00Z")).await;
    let token = server.token(Role::GameMaster).await;
    for _ in 0..30 {
        assert_eq!(server.call_with(Some(&ended), "GET", "/api/v1/state", None).await.status(), 401);
    }
    let body = serde_json::json!({ "token": token }).to_string();
    assert_eq!(server.call_with(None, "POST", "/api/v1/login", Some(&body)).await.status(), 200);
}

#[tokio::test]
async fn connections_that_say_nothing_or_little_by_little_are_ended() {
    let server = TestServer::start_with(|config| config.server.header_timeout_secs = 0.3).await;
    let mut silent = Vec::new();
    for _ in 0..300 {
        silent.push(TcpStream::connect(&server.host).await.unwrap());
    }
    let mut slow = TcpStream::connect(&server.host).await.unwrap();
    slow.write_all(b"GET /api/v1/state HTTP/1.1\r\nHost: 127").await.unwrap();
    assert_eq!(server.call("POST", "/api/v1/stop", None).await.status(), 200, "a stop finds its way");
    silent.push(slow);
    for mut connection in silent {
        let mut rest = Vec::new();
        let ended = tokio::time::timeout(SOON, connection.read_to_end(&mut rest)).await;
        assert!(ended.is_ok(), "a connection that asks nothing is still open");
    }
}

#[tokio::test]
async fn the_dashboards_page_is_served_with_a_policy() {
    let server = TestServer::start().await;
    for path in ["/", "/some/view"] {
        let response = server.call("GET", path, None).await;
        assert_eq!(response.status(), 200);
        assert_eq!(response.headers()["content-type"], "text/html; charset=utf-8");
        let policy = response.headers()["content-security-policy"].to_str().unwrap().to_owned();
        assert!(policy.starts_with("default-src 'self'"), "{policy}");
        assert!(response.headers().contains_key("x-request-id"));
    }
    assert_eq!(server.call("GET", "/assets/none.js", None).await.status(), 404);
}

#[tokio::test]
async fn a_page_that_the_configuration_names_may_be_a_vr_client_and_nothing_else() {
    let server = TestServer::start_with(|config| config.clients.allowed_origins = vec!["null".into()]).await;
    let upgrade = |path: &str, origin: &str| {
        let request = Client::new().get(format!("http://{}{path}", server.host)).header("Origin", origin);
        let request = request.header("Connection", "upgrade").header("Upgrade", "websocket");
        let request = request.header("Sec-WebSocket-Version", "13");
        request.header("Sec-WebSocket-Key", "dGhlIHNhbXBsZSBub25jZQ==").send()
    };
    assert_eq!(upgrade("/ws/v1/client", "null").await.unwrap().status(), 101);
    assert_eq!(upgrade("/ws/v1/client", "http://elsewhere.example").await.unwrap().status(), 403);
    assert_eq!(upgrade("/ws/v1/dashboard", "null").await.unwrap().status(), 403);
    let home = Client::new().post(format!("http://{}/api/v1/home", server.host)).header("Origin", "null");
    problem(403, "/api/v1/home", home.send().await.unwrap()).await;
}
