//! What is kept: acts with their authors, sessions, limits.

use covr_tests::client::VrClient;
use covr_tests::eventually;
use covr_tests::server::TestServer;
use covr_wire::client::Encoding;

#[tokio::test]
async fn who_asked_what_is_in_the_record_before_the_answer() {
    let server = TestServer::start().await;
    server.call_as(Some("Ada"), "POST", "/api/v1/arm", None).await;
    server.call_as(Some("Bo"), "POST", "/api/v1/stop", Some("{\"reason\": \"drill\"}")).await;
    let events = server.good("GET", "/api/v1/events?limit=50", None).await;
    let find = |kind: &str| {
        let events = events.as_array().unwrap();
        events.iter().find(|e| e["kind"] == kind).unwrap_or_else(|| panic!("no {kind} in {events:?}")).clone()
    };
    let refused = find("request_refused");
    assert_eq!((&refused["detail"]["request"], &refused["detail"]["author"]), (&"arm".into(), &"Ada".into()));
    let stop = find("stop_pressed");
    assert_eq!((&stop["detail"]["author"], &stop["detail"]["reason"]), (&"Bo".into(), &"drill".into()));
    assert!(stop["detail"]["to_drive_micros"].is_u64());
    let changed = find("mode_changed");
    assert_eq!(
        (&changed["detail"]["from"], &changed["detail"]["to"]),
        (&"disarmed".into(), &"latched_stop".into())
    );
}

#[tokio::test]
async fn a_session_lasts_from_arming_to_the_stop_and_holds_its_events() {
    let server = TestServer::start().await;
    server.arm().await;
    let sessions = server.good("GET", "/api/v1/sessions", None).await;
    assert_eq!((&sessions[0]["ended_at"], &sessions[0]["scene_id"]), (&serde_json::Value::Null, &1.into()));
    server.good("POST", "/api/v1/stop", None).await;
    let sessions = server.good("GET", "/api/v1/sessions", None).await;
    assert_eq!(sessions[0]["how"], "latched_stop");
    let id = sessions[0]["id"].as_i64().unwrap();
    let events = server.good("GET", &format!("/api/v1/events?session={id}"), None).await;
    let events = events.as_array().unwrap();
    let to = |event: &serde_json::Value| event["detail"]["to"].clone();
    let changes: Vec<_> = events.iter().filter(|e| e["kind"] == "mode_changed").map(to).collect();
    // On a busy machine R9 may put a protective stop between.
    assert_eq!(changes.first(), Some(&"latched_stop".into()), "the session's last change: {changes:?}");
    assert_eq!(changes.last(), Some(&"following".into()), "the session's first change: {changes:?}");
}

#[tokio::test]
async fn events_are_paged_and_filtered() {
    let server = TestServer::start().await;
    for number in 0..7 {
        let body = format!("{{\"reason\": \"drill {number}\"}}");
        server.call_as(Some("Bo"), "POST", "/api/v1/stop", Some(&body)).await;
    }
    let mut path = "/api/v1/events?kind=stop_pressed&limit=3".to_owned();
    let mut pages: Vec<Vec<String>> = Vec::new();
    loop {
        let response = server.call("GET", &path, None).await;
        assert!(response.status().is_success());
        let link = response.headers().get("link").map(|link| link.to_str().unwrap().to_owned());
        let events: Vec<serde_json::Value> = response.json().await.unwrap();
        pages.push(events.iter().map(|e| e["detail"]["reason"].as_str().unwrap().to_owned()).collect());
        let Some(link) = link else { break };
        path = link.strip_prefix('<').unwrap().strip_suffix(">; rel=\"next\"").unwrap().to_owned();
    }
    let expected: [&[&str]; 3] =
        [&["drill 6", "drill 5", "drill 4"], &["drill 3", "drill 2", "drill 1"], &["drill 0"]];
    assert_eq!(pages, expected, "each once, newest first, and the last page says that it is the last");

    let found =
        server.good("GET", "/api/v1/events?search=SOFTWARE%20stop&kind=mode_changed,served", None).await;
    assert!(!found.as_array().unwrap().is_empty());
    assert!(found.as_array().unwrap().iter().all(|event| event["kind"] == "mode_changed"), "{found}");
    assert_eq!(server.good("GET", "/api/v1/events?search=100%25", None).await, serde_json::json!([]));
}

#[tokio::test]
async fn events_of_one_person_leave_out_the_others() {
    let server = TestServer::start().await;
    let mut client = VrClient::greeted(&server.host, "two", Encoding::Json).await;
    client.enter("Ada").await;
    client.enter("Bo").await;
    let left = eventually("both are in the record", || async {
        let ada = server.good("GET", "/api/v1/events?person=Ada", None).await;
        let bo = server.good("GET", "/api/v1/events?person=Bo", None).await;
        let both = ada.as_array().unwrap().len() == 1 && bo.as_array().unwrap().len() == 1;
        both.then_some(ada)
    })
    .await;
    assert_eq!((&left[0]["kind"], &left[0]["detail"]["name"]), (&"person_entered".into(), &"Ada".into()));
    assert_eq!(server.good("GET", "/api/v1/events?person=two", None).await, serde_json::json!([]));
}

#[tokio::test]
async fn limits_are_checked() {
    let server = TestServer::start().await;
    for path in ["/api/v1/events?limit=0", "/api/v1/sessions?limit=10001"] {
        let problem = server.refused(422, "GET", path, None).await;
        assert_eq!(problem.errors[0].path, "limit");
    }
    server.refused(400, "GET", "/api/v1/events?limit=many", None).await;
    for (query, field) in [("kind=stop_presed", "kind"), ("search=", "search"), ("person=", "person")] {
        let problem = server.refused(422, "GET", &format!("/api/v1/events?{query}"), None).await;
        assert_eq!(problem.errors[0].path, field);
    }
}
