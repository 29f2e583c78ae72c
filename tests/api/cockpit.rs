//! The game master's own: notes in the record, the checklist before a start; and no scene under somebody's hand.

use covr_tests::client::VrClient;
use covr_tests::eventually;
use covr_tests::server::TestServer;
use covr_wire::client::Encoding;
use covr_wire::reason::Reason;
use serde_json::{Value, json};

const SCENE: &str = r#"{
  "schema": "covr.scene.v2", "name": "With a list",
  "arena": { "min": [0, 0], "max": [4, 4] },
  "objects": [
    { "id": "wall", "position": [1, 1, 1], "shape": { "kind": "sphere", "radius": 0.1 } },
    { "id": "door", "position": [3, 1, 1], "shape": { "kind": "sphere", "radius": 0.1 } }
  ],
  "checklist": ["The fan is on", "The door is shut"]
}"#;

async fn ticked(server: &TestServer) -> Vec<(bool, Value)> {
    let list = server.good("GET", "/api/v1/checklist", None).await;
    let items = list["items"].as_array().unwrap().clone();
    items.into_iter().map(|item| (!item["ticked_by"].is_null(), item["text"].clone())).collect()
}

async fn known(server: &TestServer, touches: bool) {
    eventually("the touch is known", || async {
        (server.app.persons.touch().is_some() == touches).then_some(())
    })
    .await;
}

async fn stored(server: &TestServer) -> Value {
    server.good("POST", "/api/v1/scenes", Some(SCENE)).await["id"].clone()
}

#[tokio::test]
async fn a_note_is_an_event_of_its_session_with_who_and_when() {
    let server = TestServer::start().await;
    let note = |text: &str| json!({ "text": text }).to_string();
    let before = server.good("POST", "/api/v1/notes", Some(&note("between two"))).await;
    assert_eq!(before["session"], Value::Null);
    server.arm().await;
    let response =
        server.call_as(Some("Ada"), "POST", "/api/v1/notes", Some(&note(" laughed at the wall "))).await;
    assert_eq!(response.status(), 201);
    let session = serde_json::from_str::<Value>(&response.text().await.unwrap()).unwrap()["session"].clone();
    assert!(session.is_i64(), "{session}");
    let events = server.good("GET", &format!("/api/v1/sessions/{session}/events"), None).await;
    let noted = events.as_array().unwrap().iter().find(|event| event["kind"] == "note").unwrap();
    assert_eq!(
        (&noted["detail"]["text"], &noted["detail"]["author"]),
        (&json!("laughed at the wall"), &json!("Ada"))
    );
    assert_eq!(noted["summary"], "Ada: laughed at the wall");
    for (status, body) in
        [(422, note("  ")), (422, note(&"x".repeat(1001))), (400, "{}".into()), (400, "x".into())]
    {
        server.refused(status, "POST", "/api/v1/notes", Some(&body)).await;
    }
    let kept = server.good("GET", "/api/v1/events?kind=note", None).await;
    assert_eq!(kept.as_array().unwrap().len(), 2);
}

#[tokio::test]
async fn the_checklist_is_one_for_all_and_ends_with_the_session() {
    let server = TestServer::start().await;
    let usual = server.good("GET", "/api/v1/checklist", None).await;
    assert_eq!((&usual["of_scene"], &usual["items"][0]["id"]), (&json!(false), &json!("stop_in_reach")));
    let id = stored(&server).await;
    server.good("PUT", &format!("/api/v1/scenes/{id}/activate"), Some("{}")).await;
    assert_eq!(ticked(&server).await, [(false, json!("The fan is on")), (false, json!("The door is shut"))]);

    let yes = json!({ "ticked": true }).to_string();
    let response = server.call_as(Some("Ada"), "PUT", "/api/v1/checklist/1", Some(&yes)).await;
    assert!(response.status().is_success());
    let list = server.good("GET", "/api/v1/checklist", None).await;
    assert_eq!(list["items"][1]["ticked_by"], "Ada");
    assert!(list["items"][1]["ticked_at"].as_str().unwrap().ends_with('Z'), "{list}");
    for item in ["2", "-1", "door"] {
        let problem = server.refused(422, "PUT", &format!("/api/v1/checklist/{item}"), Some(&yes)).await;
        assert_eq!(problem.errors[0].path, "item");
    }
    server.arm().await;
    assert!(ticked(&server).await[1].0, "it was looked at for this session");
    server.good("POST", "/api/v1/disarm", None).await;
    server.app.recorder.settled().await;
    assert!(ticked(&server).await.iter().all(|(ticked, _)| !ticked), "the next start is looked at anew");
    let events = server.good("GET", "/api/v1/events?kind=checklist_ticked", None).await;
    assert_eq!(events[0]["summary"], "Ada ticked \"The door is shut\"");
}

#[tokio::test]
async fn no_scene_changes_under_a_hand_while_the_machine_is_armed() {
    let server = TestServer::start().await;
    let id = stored(&server).await;
    let activate = format!("/api/v1/scenes/{id}/activate");
    server.good("PUT", &activate, Some("{}")).await;
    server.arm().await;
    let mut ada = VrClient::greeted(&server.host, "quest", Encoding::Json).await;
    ada.enter("ada").await;
    ada.pose("ada", 3.5, 3.5).await;
    let touch =
        |kind: &str| json!({ "type": kind, "person": "ada", "object": "wall", "client_time_micros": 1 });
    ada.say(&touch("touch_began")).await;
    known(&server, true).await;
    let problem = server.refused(409, "PUT", &activate, Some("{}")).await;
    let why = Reason::TouchGoesOn { person: "ada".into(), object: "wall".into() };
    assert_eq!(problem.why.as_deref(), Some(&why), "{problem:?}");
    ada.say(&touch("touch_ended")).await;
    known(&server, false).await;
    server.good("PUT", &activate, Some("{}")).await;

    ada.say(&touch("touch_began")).await;
    known(&server, true).await;
    server.good("POST", "/api/v1/disarm", None).await;
    server.good("PUT", &activate, Some("{}")).await;
    assert_eq!(server.app.persons.touch(), None, "what was touched is there no more");
}

#[tokio::test]
async fn a_check_says_how_long_column_and_people_need_between_objects() {
    let server = TestServer::start().await;
    let pairs = server.good("POST", "/api/v1/scenes/check", Some(SCENE)).await["pairs"].clone();
    assert_eq!(pairs["objects"], json!(["wall", "door"]));
    let secs = |table: &str, from: usize, to: usize| pairs[table][from][to].as_f64().unwrap();
    assert_eq!((secs("serve_secs", 0, 0), secs("walk_secs", 1, 1)), (0.0, 0.0));
    assert!((secs("walk_secs", 0, 1) - 1.875 * 2.0 / 0.8).abs() < 0.01, "{pairs}");
    assert!(secs("serve_secs", 0, 1) > 1.5 && secs("serve_secs", 0, 1) < 4.0, "{pairs}");
    assert_eq!(secs("serve_secs", 0, 1), secs("serve_secs", 1, 0));
}
