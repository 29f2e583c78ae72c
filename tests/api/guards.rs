//! Other sites, other networks, the embedded page.

use covr_server::serve::{Reach, Server};
use covr_tests::server::{TestServer, problem, test_config};
use reqwest::Client;
use tempfile::TempDir;

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
async fn the_network_is_refused_without_a_word() {
    let dir = TempDir::new().unwrap();
    let mut config = test_config(&dir);
    config.server.bind = ([0, 0, 0, 0], 0).into();
    let refused = Server::start(config.clone(), Reach::ThisMachine).await.err().unwrap();
    assert!(format!("{refused:#}").contains("--insecure-lan"), "{refused:#}");
    assert!(!config.server.database.exists(), "refused before anything was touched");
    assert!(Server::start(config, Reach::InsecureLan).await.is_ok(), "with the simulated machine it may");
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
