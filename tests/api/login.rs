//! A browser signs in and out: cookie, proof against other sites, tickets, and what the end of a login leaves.

use covr_server::access::Role;
use covr_tests::dashboard::Dashboard;
use covr_tests::eventually;
use covr_tests::server::{TestServer, problem};
use covr_wire::dashboard::{FromDashboard, MachineRequest, Outcome, ToDashboard};
use reqwest::{Client, Method, Response};
use serde_json::{Value, json};

/// A browser that is signed in.
struct Browser<'a> {
    server: &'a TestServer,
    cookie: String,
    csrf: String,
}

impl<'a> Browser<'a> {
    async fn signed_in(server: &'a TestServer, token: &str) -> Self {
        let body = json!({ "token": token }).to_string();
        let response = server.call_with(None, "POST", "/api/v1/login", Some(&body)).await;
        assert_eq!(response.status(), 200);
        let set = response.headers()["set-cookie"].to_str().unwrap().to_owned();
        for attribute in ["HttpOnly", "SameSite=Strict", "Path=/", "Max-Age="] {
            assert!(set.contains(attribute), "{set}");
        }
        let me: Value = response.json().await.unwrap();
        Self {
            server,
            cookie: set.split(';').next().unwrap().to_owned(),
            csrf: me["csrf"].as_str().unwrap().to_owned(),
        }
    }

    async fn ask(&self, method: &str, path: &str, csrf: Option<&str>) -> Response {
        let method = Method::from_bytes(method.as_bytes()).unwrap();
        let mut request = Client::new().request(method, format!("http://{}{path}", self.server.host));
        request = request.header("Cookie", format!("theme=dark; {}", self.cookie));
        if let Some(csrf) = csrf {
            request = request.header("X-Covr-Csrf", csrf);
        }
        request.send().await.unwrap()
    }
}

#[tokio::test]
async fn a_browser_signs_in_changes_something_with_its_proof_alone_and_signs_out() {
    let server = TestServer::start().await;
    let token = server.token(Role::GameMaster).await;
    let browser = Browser::signed_in(&server, &token).await;
    let me: Value = browser.ask("GET", "/api/v1/me", None).await.json().await.unwrap();
    assert_eq!(
        (&me["asks"], &me["role"], &me["csrf"]),
        (&json!(true), &json!("game_master"), &json!(browser.csrf))
    );
    assert!(me["may"].as_array().unwrap().contains(&json!("dashboard arm")), "{me}");

    let other = Browser::signed_in(&server, &token).await.csrf;
    for wrong in [None, Some(""), Some(other.as_str())] {
        problem(403, "/api/v1/home", browser.ask("POST", "/api/v1/home", wrong).await).await;
    }
    assert_eq!(browser.ask("POST", "/api/v1/stop", None).await.status(), 200, "a stop needs no proof");
    assert_eq!(browser.ask("POST", "/api/v1/disarm", Some(&browser.csrf)).await.status(), 200);

    problem(403, "/api/v1/logout", browser.ask("POST", "/api/v1/logout", None).await).await;
    assert_eq!(browser.ask("POST", "/api/v1/logout", Some(&browser.csrf)).await.status(), 200);
    problem(401, "/api/v1/state", browser.ask("GET", "/api/v1/state", None).await).await;
    assert_eq!(browser.ask("POST", "/api/v1/stop", None).await.status(), 200, "and none who is signed out");
    let events = server.app.store.events(100, &Default::default()).await.unwrap().events;
    let of = |kind: &str| events.iter().find(|event| event.kind == kind).unwrap();
    assert_eq!(of("signed_in").detail["actor"]["role"], "game_master");
    assert_eq!(of("signed_out").detail["actor"]["token_id"], token[5..13]);
    let stops: Vec<_> = events.iter().filter(|event| event.kind == "stop_pressed").collect();
    assert_eq!(stops[0].detail.get("actor"), None, "newest first: pressed by somebody who was signed out");
    assert_eq!(stops[1].detail["actor"]["role"], "game_master");
}

#[tokio::test]
async fn a_wrong_token_signs_nobody_in_and_a_server_without_tokens_asks_nobody() {
    let server = TestServer::start().await;
    let me = server.good("GET", "/api/v1/me", None).await;
    assert_eq!((&me["asks"], &me["role"]), (&json!(false), &json!(null)));
    server.refused(409, "POST", "/api/v1/login", Some("{\"token\": \"covr_\"}")).await;
    server.token(Role::Observer).await;
    server.refused(401, "POST", "/api/v1/login", Some("{\"token\": \"covr_\"}")).await;
    server.refused(400, "POST", "/api/v1/login", Some("{\"password\": \"covr_\"}")).await;
}

#[tokio::test]
async fn a_login_survives_a_restart_and_not_its_token() {
    let server = TestServer::start().await;
    let token = server.token(Role::GameMaster).await;
    let Browser { cookie, csrf, .. } = Browser::signed_in(&server, &token).await;
    let server = TestServer::start_in(server.shutdown().await, |_| {}).await;
    let browser = Browser { server: &server, cookie, csrf };
    assert_eq!(browser.ask("GET", "/api/v1/state", None).await.status(), 200);
    let administrator = server.token(Role::Administrator).await;
    let path = format!("/api/v1/tokens/{}", &token[5..13]);
    problem(403, &path, server.call_with(Some(&token), "DELETE", &path, None).await).await;
    assert_eq!(server.call_with(Some(&administrator), "DELETE", &path, None).await.status(), 200);
    problem(401, "/api/v1/state", browser.ask("GET", "/api/v1/state", None).await).await;
    problem(404, &path, server.call_with(Some(&administrator), "DELETE", &path, None).await).await;
}

#[tokio::test]
async fn when_a_login_ends_its_page_still_sees_and_stops_and_does_nothing_else() {
    let server = TestServer::start_with(|config| config.access.login_hours = 0.5 / 3_600.0).await;
    let token = server.token(Role::GameMaster).await;
    let browser = Browser::signed_in(&server, &token).await;
    let mut dashboard = Dashboard::connect_with_cookie(&server.host, &browser.cookie).await.ok().unwrap();
    let answer = async |dashboard: &mut Dashboard, message: FromDashboard| {
        dashboard.say(&message).await;
        let is_it = |m: &ToDashboard| match m {
            ToDashboard::Answer { outcome, detail, .. } => Some((*outcome, detail.clone())),
            _ => None,
        };
        dashboard.hear("an answer", is_it).await
    };
    eventually("the login has ended", || async {
        (browser.ask("GET", "/api/v1/state", None).await.status() == 401).then_some(())
    })
    .await;
    let arm = FromDashboard::Request { request_id: 1, request: MachineRequest::Arm, reason: None };
    let (outcome, detail) = answer(&mut dashboard, arm).await;
    assert!(outcome == Outcome::Refused && detail.contains("sign in again"), "{detail}");
    let (outcome, _) = answer(&mut dashboard, FromDashboard::Stop { request_id: 2, reason: None }).await;
    assert_eq!(outcome, Outcome::Accepted);
    dashboard.hear("the state goes on", |m| matches!(m, ToDashboard::Snapshot(_)).then_some(())).await;
}

#[tokio::test]
async fn a_ticket_opens_one_socket() {
    let server = TestServer::start().await;
    let token = server.token(Role::Observer).await;
    problem(401, "/api/v1/tickets", server.call_with(None, "POST", "/api/v1/tickets", None).await).await;
    let ticket: Value =
        server.call_with(Some(&token), "POST", "/api/v1/tickets", None).await.json().await.unwrap();
    let host = format!("{}/ws/v1/dashboard?ticket={}", server.host, ticket["ticket"].as_str().unwrap());
    let mut first = Dashboard::connect_to(&host).await.ok().unwrap();
    first.hear("the state", |m| matches!(m, ToDashboard::Snapshot(_)).then_some(())).await;
    assert_eq!(Dashboard::connect_to(&host).await.err(), Some(401), "it is good once");
}
