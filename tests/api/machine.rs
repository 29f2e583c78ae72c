//! State, requests, stop, health, the API's own description.

use covr_engine::mode::Mode;
use covr_server::config::{Input, InputKind, Level};
use covr_tests::server::{TestServer, problem};
use covr_tests::{SOON, eventually};

#[tokio::test]
async fn a_new_server_is_disarmed_and_says_what_may_be_asked() {
    let server = TestServer::start().await;
    let state = server.good("GET", "/api/v1/state", None).await;
    assert_eq!(state["mode"], "disarmed");
    assert_eq!(state["rules"].as_array().unwrap().len(), 16);
    assert_eq!(state["objects"].as_array().unwrap().len(), 5);
    let refused = |name: &str| {
        let requests = state["requests"].as_array().unwrap();
        requests.iter().find(|r| r["request"] == name).unwrap()["refused_because"].clone()
    };
    assert!(refused("home").is_null() && refused("stop").is_null());
    assert!(refused("arm").is_string() && refused("reset").is_string());
}

#[tokio::test]
async fn the_machine_goes_from_home_to_arm_to_disarm() {
    let server = TestServer::start().await;
    let early = server.refused(409, "POST", "/api/v1/arm", None).await;
    assert!(early.detail.contains("home"), "{early:?}");
    let homing = server.good("POST", "/api/v1/home", Some("{\"reason\": \"morning\"}")).await;
    assert_eq!(homing["outcome"], "accepted");
    server.mode(Mode::Ready).await;
    assert_eq!(server.good("POST", "/api/v1/arm", None).await["outcome"], "accepted");
    assert_eq!(server.good("POST", "/api/v1/arm", None).await["outcome"], "already_so");
    let state = server.good("GET", "/api/v1/state", None).await;
    assert_eq!(state["mode"], "following", "an answered request shows in the next state");
    assert!(state["session_id"].is_i64());
    assert_eq!(server.good("POST", "/api/v1/disarm", None).await["outcome"], "accepted");
    server.mode(Mode::Disarmed).await;
}

#[tokio::test]
async fn a_stop_is_acknowledged_with_its_time_and_latches_until_a_reset_with_a_reason() {
    let server = TestServer::start().await;
    let stopped = server.good("POST", "/api/v1/stop", Some("{\"reason\": \"hand in the way\"}")).await;
    assert_eq!(stopped["acknowledged"], true);
    let micros = stopped["to_drive_micros"].as_u64().unwrap();
    assert!(micros > 0 && micros < 1_000_000, "{micros}");
    let state = server.good("GET", "/api/v1/state", None).await;
    assert_eq!(state["mode"], "latched_stop");
    assert_eq!(state["stop"]["rule"], "R4");
    assert!(state["stop"]["reason"].as_str().unwrap().contains("hand in the way"), "{}", state["stop"]);

    server.refused(409, "POST", "/api/v1/home", None).await;
    for body in [None, Some("{}"), Some("{\"reason\": \"  \"}")] {
        let problem = server.refused(422, "POST", "/api/v1/reset", body).await;
        assert_eq!(problem.errors[0].path, "reason");
    }
    eventually("the reset is accepted", || async {
        let reset = server.call("POST", "/api/v1/reset", Some("{\"reason\": \"looked\"}")).await;
        reset.status().is_success().then_some(())
    })
    .await;
    assert_eq!(server.good("GET", "/api/v1/state", None).await["mode"], "disarmed");
}

#[tokio::test]
async fn no_body_and_no_header_keeps_a_stop_from_stopping() {
    let server = TestServer::start().await;
    let long = format!("{{\"reason\": \"{}\"}}", "x".repeat(100_000));
    for body in ["not json", "{\"reason\": 3}", "[]", "{\"reasn\": \"typo\"}", &long] {
        assert_eq!(server.good("POST", "/api/v1/stop", Some(body)).await["acknowledged"], true);
    }
    let author = "x".repeat(200);
    let response = server.call_as(Some(&author), "POST", "/api/v1/stop", None).await;
    assert!(response.status().is_success());
    assert_eq!(server.good("GET", "/api/v1/state", None).await["mode"], "latched_stop");
}

#[tokio::test]
async fn bad_requests_are_problems_with_their_place() {
    let server = TestServer::start().await;
    let malformed = server.refused(400, "POST", "/api/v1/home", Some("{\n \"reason\": }")).await;
    assert_eq!((malformed.errors[0].line, malformed.errors[0].column), (Some(2), Some(12)));
    let typed = server.refused(400, "POST", "/api/v1/home", Some("{\"reason\": 3}")).await;
    assert_eq!(typed.errors[0].path, "reason");
    server.refused(400, "POST", "/api/v1/arm", Some("{\"reasn\": \"x\"}")).await;
    let long = format!("{{\"reason\": \"{}\"}}", "x".repeat(501));
    server.refused(422, "POST", "/api/v1/arm", Some(&long)).await;
    server.refused(404, "GET", "/api/v1/nothing", None).await;
    server.refused(404, "POST", "/api/v2/stop", None).await;
    server.refused(405, "DELETE", "/api/v1/state", None).await;
    server.refused(405, "GET", "/api/v1/stop", None).await;
    server.refused(404, "POST", "/api/v1/persons/7/confirm", None).await;
    server.refused(404, "POST", "/api/v1/persons/ada/confirm", None).await;
    let author = "x".repeat(65);
    let response = server.call_as(Some(&author), "POST", "/api/v1/arm", None).await;
    let refused = problem(422, "/api/v1/arm", response).await;
    assert_eq!(refused.errors[0].path, "x-covr-author");
    assert_eq!(
        server.good("GET", "/api/v1/state", None).await["mode"],
        "disarmed",
        "nothing came of all that"
    );
}

#[tokio::test]
async fn the_server_says_how_it_is() {
    let server = TestServer::start().await;
    assert_eq!(server.good("GET", "/healthz", None).await, "ok");
    assert_eq!(server.good("GET", "/readyz", None).await["ready"], true);
    let metrics = server.call("GET", "/metrics", None).await.text().await.unwrap();
    for name in [
        "covr_control_steps_total",
        "covr_control_missed_deadlines_total",
        "covr_control_lateness_p99_seconds",
        "covr_mode{mode=\"disarmed\"}",
        "covr_events_dropped_total",
        "covr_poses_total",
        "covr_client_errors_total",
        "covr_clients",
        "covr_dashboards",
    ] {
        assert!(metrics.contains(name), "{name} is not among the metrics:\n{metrics}");
    }
    server.app.store.close().await;
    let readiness = server.call("GET", "/readyz", None).await;
    assert_eq!(readiness.status(), 503, "without a store the server is not ready");
}

#[tokio::test]
async fn the_openapi_document_describes_every_route_and_leaves_no_reference_open() {
    let server = TestServer::start().await;
    let document = server.good("GET", "/api/v1/openapi.json", None).await;
    let paths = document["paths"].as_object().unwrap();
    for (path, methods) in [
        ("/api/v1/state", &["get"][..]),
        ("/api/v1/home", &["post"]),
        ("/api/v1/arm", &["post"]),
        ("/api/v1/disarm", &["post"]),
        ("/api/v1/stop", &["post"]),
        ("/api/v1/reset", &["post"]),
        ("/api/v1/persons/{id}/confirm", &["post"]),
        ("/api/v1/scenes", &["get", "post"]),
        ("/api/v1/scenes/{id}", &["get", "put"]),
        ("/api/v1/scenes/check", &["post"]),
        ("/api/v1/scenes/{id}/activate", &["put"]),
        ("/api/v1/priors", &["patch"]),
        ("/api/v1/priors/changes", &["get"]),
        ("/api/v1/sessions", &["get"]),
        ("/api/v1/sessions/{id}", &["get"]),
        ("/api/v1/sessions/{id}/frames", &["get"]),
        ("/api/v1/sessions/{id}/events", &["get"]),
        ("/api/v1/sessions/{id}/export", &["get"]),
        ("/api/v1/config", &["get"]),
        ("/api/v1/events", &["get"]),
        ("/api/v1/scene.schema.json", &["get"]),
        ("/healthz", &["get"]),
        ("/readyz", &["get"]),
        ("/metrics", &["get"]),
    ] {
        for method in methods {
            assert!(paths.get(path).is_some_and(|p| p.get(*method).is_some()), "{method} {path} is missing");
        }
    }
    let text = document.to_string();
    for reference in text.split("\"$ref\":\"").skip(1).map(|rest| rest.split('"').next().unwrap()) {
        let pointer =
            reference.strip_prefix('#').unwrap_or_else(|| panic!("{reference} leaves the document"));
        assert!(document.pointer(pointer).is_some(), "{reference} points nowhere");
    }
}

#[tokio::test]
async fn a_shutdown_brings_an_armed_machine_to_rest_and_ends_the_session() {
    let server = TestServer::start().await;
    server.arm().await;
    let dir = server.shutdown().await;
    let again = TestServer::start_in(dir, |_| {}).await;
    let sessions = again.good("GET", "/api/v1/sessions", None).await;
    assert_eq!(
        sessions[0]["how"], "disarmed",
        "the machine came to rest before the session ended: {sessions}"
    );
    assert_eq!(again.good("GET", "/api/v1/state", None).await["mode"], "disarmed");
}

#[tokio::test]
async fn snapshots_come_at_the_configured_rate_while_nobody_asks() {
    let server = TestServer::start().await;
    let first = server.app.control.published().generation;
    server.published("ten more snapshots", SOON, |p| p.generation >= first + 10).await;
}

#[tokio::test]
async fn an_intruder_input_is_a_protective_stop_and_a_stop_input_latches_until_it_is_let_go() {
    let folder = tempfile::TempDir::new().unwrap();
    let level = |name: &str, text: &str| {
        let next = folder.path().join("next");
        std::fs::write(&next, text).unwrap();
        std::fs::rename(&next, folder.path().join(name)).unwrap();
    };
    let input = |name: &str, kind| Input {
        name: name.into(),
        kind,
        source: folder.path().join(name),
        active: Level::Low,
        heartbeat_timeout_secs: 10.0,
    };
    level("curtain", "1\n");
    level("button", "1\n");
    let inputs = vec![input("curtain", InputKind::Intruder), input("button", InputKind::Stop)];
    let server = TestServer::start_with(|config| config.safety.inputs = inputs).await;
    server.good("POST", "/api/v1/home", None).await;
    server.mode(Mode::Ready).await;
    server.good("POST", "/api/v1/arm", None).await;

    level("curtain", "0\n");
    server.mode(Mode::ProtectiveStop).await;
    let state = server.good("GET", "/api/v1/state", None).await;
    assert_eq!(state["stop"]["rule"], "R12");
    assert_eq!(state["stop"]["why"]["id"], "intruder");
    level("curtain", "1\n");
    server.mode(Mode::Following).await;

    level("button", "0\n");
    server.mode(Mode::LatchedStop).await;
    let state = server.good("GET", "/api/v1/state", None).await;
    assert_eq!(state["stop"]["rule"], "R4");
    assert_eq!(state["stop"]["why"]["input"], "button");
    let event = eventually("the stop's event", || async {
        let page = server.good("GET", "/api/v1/events?kind=stop_pressed", None).await;
        page.as_array().unwrap().first().cloned()
    })
    .await;
    let detail = &event["detail"];
    assert_eq!((&detail["by"], &detail["author"]), (&"input".into(), &"button".into()), "{event}");
    assert_eq!(detail["why"]["id"], "stop_input");
    assert!(detail["to_drive_micros"].as_u64().is_some_and(|micros| micros < 1_000_000), "{event}");
    let metrics = server.call("GET", "/metrics", None).await.text().await.unwrap();
    // The recorder of metrics is the process's, and so are the stops of other tests in it.
    let counted =
        metrics.lines().find_map(|line| line.strip_prefix("covr_stops_pressed_total{lane=\"input\"} "));
    assert!(counted.is_some_and(|count| count.parse::<u64>().unwrap() >= 1), "{metrics}");
    let refused = server.refused(409, "POST", "/api/v1/reset", Some("{\"reason\": \"looked\"}")).await;
    assert!(refused.detail.contains("button"), "{refused:?}");
    level("button", "1\n");
    eventually("the reset is accepted", || async {
        let reset = server.call("POST", "/api/v1/reset", Some("{\"reason\": \"looked\"}")).await;
        reset.status().is_success().then_some(())
    })
    .await;
    server.mode(Mode::Disarmed).await;
}
