//! A scenario over the wire: cues, skips, client events, what everybody is told; and scenes of the version before.

use covr_engine::mode::Mode;
use covr_tests::SOON;
use covr_tests::client::VrClient;
use covr_tests::dashboard::Dashboard;
use covr_tests::server::TestServer;
use covr_wire::client::{Encoding, ToClient};
use covr_wire::dashboard::{FromDashboard, MachineRequest, Outcome, ToDashboard};
use covr_wire::reason::Reason;
use serde_json::{Value, json};
use sqlx::Connection;

const ESCAPE: &str = include_str!("../../deploy/scenes/escape-room.json");

async fn playing() -> TestServer {
    let server = TestServer::start().await;
    let stored = server.good("POST", "/api/v1/scenes", Some(ESCAPE)).await;
    // The tests' machine has a travel of a metre: what it cannot serve is told, and nothing of the scenario.
    let warned = stored["warnings"].as_array().unwrap();
    assert!(warned.iter().all(|w| w["path"].as_str().unwrap().starts_with("$.objects[")), "{warned:?}");
    assert!(warned.iter().any(|w| w["found"].as_str().unwrap().starts_with("never served")), "{warned:?}");
    server.good("PUT", &format!("/api/v1/scenes/{}/activate", stored["id"]), Some("{}")).await;
    server
}

async fn scenario(server: &TestServer) -> Value {
    server.good("GET", "/api/v1/state", None).await["scenario"].clone()
}

/// Ask, and hear the answer.
async fn asked(dashboard: &mut Dashboard, message: FromDashboard) -> (Outcome, Option<Reason>) {
    dashboard.say(&message).await;
    let answer = |m: &ToDashboard| match m {
        ToDashboard::Answer { outcome, why, .. } => Some((*outcome, why.clone())),
        _ => None,
    };
    dashboard.hear("an answer", answer).await
}

fn cue(name: &str) -> String {
    json!({ "name": name }).to_string()
}

#[tokio::test]
async fn a_game_master_leads_the_scenario_on_and_everybody_is_told() {
    let server = playing().await;
    let problem = server.refused(409, "POST", "/api/v1/scenario/cue", Some(&cue("lights on"))).await;
    assert_eq!(problem.why.as_deref(), Some(&Reason::ScenarioStands));
    server.arm().await;
    let mut dashboard = Dashboard::connect(&server.host).await;
    let mut client = VrClient::greeted(&server.host, "headset", Encoding::Json).await;
    let told = |message: &ToClient| match message {
        ToClient::Scenario(now) => Some((now.state.clone(), now.runs)),
        _ => None,
    };
    assert_eq!(client.hear("the state", told).await, ("dark".into(), true));

    let answer = server.good("POST", "/api/v1/scenario/cue", Some(&cue("lights on"))).await;
    assert_eq!(answer["detail"], "the scenario is in the state lit");
    assert_eq!(client.hear("the next state", told).await, ("lit".into(), true));
    let event = dashboard
        .hear("the event", |m| match m {
            ToDashboard::Event(event) if event.kind == "state_entered" => Some(event.clone()),
            _ => None,
        })
        .await;
    assert_eq!(event.detail["state"], "lit");
    assert_eq!((&event.detail["by"], &event.detail["cue"]), (&json!("cue"), &json!("lights on")));
    let now = scenario(&server).await;
    assert_eq!(now["variables"], json!({"lights": true, "wall": 0}));
    assert_eq!((&now["before"], &now["runs"]), (&json!("dark"), &json!(true)));

    let problem = server.refused(409, "POST", "/api/v1/scenario/cue", Some(&cue("thunder"))).await;
    assert!(
        problem.detail.contains("there is no cue thunder") && problem.detail.contains("walls"),
        "{problem:?}"
    );
    let problem = server.refused(409, "POST", "/api/v1/scenario/cue", Some(&cue("forest"))).await;
    assert_eq!(
        problem.why.as_deref(),
        Some(&Reason::NotAwaited { name: "forest".into(), state: "lit".into() })
    );
    server.refused(400, "POST", "/api/v1/scenario/cue", Some("{\"cue\": \"walls\"}")).await;
}

#[tokio::test]
async fn skipping_and_going_back_need_a_reason_and_are_on_record() {
    let server = playing().await;
    server.arm().await;
    let skip = |to: &str, reason: &str| json!({ "to": to, "reason": reason }).to_string();
    server.refused(422, "POST", "/api/v1/scenario/skip", Some(&skip("walls", " "))).await;
    server.refused(422, "POST", "/api/v1/scenario/rewind", None).await;
    server.refused(409, "POST", "/api/v1/scenario/skip", Some(&skip("attic", "why not"))).await;
    server.good("POST", "/api/v1/scenario/skip", Some(&skip("walls", "the carpet was missed"))).await;
    let state = server.good("GET", "/api/v1/state", None).await;
    let enabled: Vec<_> = state["objects"].as_array().unwrap().iter().map(|o| o["enabled"].clone()).collect();
    assert_eq!(enabled, [json!(false), json!(true), json!(true), json!(true), json!(false)]);
    assert_eq!((&state["objects"][0]["prior"], &state["objects"][2]["prior"]), (&json!(1.0), &json!(0.34)));

    let mut dashboard = Dashboard::connect(&server.host).await;
    let ask = |request_id, request, reason: Option<&str>| FromDashboard::Request {
        request_id,
        request,
        reason: reason.map(Into::into),
    };
    let (outcome, why) = asked(&mut dashboard, ask(1, MachineRequest::Rewind, None)).await;
    assert_eq!((outcome, why), (Outcome::Refused, Some(Reason::SkipNeedsReason)));
    let (outcome, why) = asked(&mut dashboard, ask(2, MachineRequest::Rewind, Some("too far"))).await;
    assert_eq!((outcome, why), (Outcome::Accepted, Some(Reason::NowInState { state: "dark".into() })));
    let (outcome, _) = asked(&mut dashboard, ask(3, MachineRequest::Cue("lights on".into()), None)).await;
    assert_eq!(outcome, Outcome::Accepted);

    let events = server.good("GET", "/api/v1/events", None).await.to_string();
    assert!(events.contains("the scenario is in walls: skipped: the carpet was missed"), "{events}");
    assert!(events.contains("rewind by dashboard: accepted"), "{events}");
}

#[tokio::test]
async fn a_game_masters_prior_counts_until_the_state_is_left() {
    let server = playing().await;
    server.arm().await;
    let prior = async || server.good("GET", "/api/v1/state", None).await["objects"][0]["prior"].clone();
    server.good("PATCH", "/api/v1/priors", Some("{\"bulb\": 0.25}")).await;
    assert_eq!(prior().await, 0.25);
    server.good("POST", "/api/v1/scenario/cue", Some(&cue("lights on"))).await;
    assert_eq!(prior().await, 1.0);
    server.good("PATCH", "/api/v1/priors", Some("{\"bulb\": 0.75}")).await;
    let changes = server.good("GET", "/api/v1/priors/changes", None).await;
    assert_eq!(
        (&changes[0]["from"], &changes[0]["to"]),
        (&json!(1.0), &json!(0.75)),
        "from what was in force"
    );
}

#[tokio::test]
async fn clients_touch_and_say_events_and_are_answered() {
    let server = playing().await;
    server.arm().await;
    let mut client = VrClient::greeted(&server.host, "headset", Encoding::Json).await;
    client.enter("ada").await;
    // Poses at the pace of the answers, until ada is tracked and the scenario runs.
    let runs = async {
        loop {
            client.pose("ada", 3.0, 3.0).await;
            let state = server.good("GET", "/api/v1/state", None).await;
            if state["persons"][0]["tracked"] == true && state["scenario"]["runs"] == true {
                return;
            }
        }
    };
    tokio::time::timeout(SOON, runs).await.expect("ada is tracked and the scenario runs");
    let touch = json!({"type": "touch_began", "person": "ada", "object": "bulb", "client_time_micros": client.now_micros()});
    client.say(&touch).await;
    let lit = |m: &ToClient| matches!(m, ToClient::Scenario(now) if now.state == "lit").then_some(());
    client.hear("the touch leads on", lit).await;

    let answer = |m: &ToClient| match m {
        ToClient::EventAnswered(answer) => Some((answer.outcome, answer.detail.clone())),
        _ => None,
    };
    client.say(&json!({"type": "scene_event", "name": "dust settled"})).await;
    let (outcome, detail) = client.hear("an answer", answer).await;
    assert_eq!(outcome, Outcome::Refused);
    assert!(!detail.is_empty());
}

#[tokio::test]
async fn disarming_ends_the_run_and_the_next_begins_where_a_skip_says() {
    let server = playing().await;
    server.arm().await;
    server.good("POST", "/api/v1/scenario/cue", Some(&cue("lights on"))).await;
    server.good("POST", "/api/v1/disarm", None).await;
    let now = scenario(&server).await;
    assert_eq!(
        (&now["state"], &now["left_in"], &now["runs"]),
        (&json!("dark"), &json!("lit"), &json!(false))
    );
    let skip = json!({ "to": "lit", "reason": "where we were" }).to_string();
    server.good("POST", "/api/v1/scenario/skip", Some(&skip)).await;
    server.good("POST", "/api/v1/arm", None).await;
    server.mode(Mode::Following).await;
    let now = scenario(&server).await;
    assert_eq!((&now["state"], &now["left_in"]), (&json!("lit"), &Value::Null));
    let frames = server.good("GET", "/api/v1/sessions/1/frames", None).await;
    assert_eq!(frames["frames"][0]["scenario"]["state"], "dark", "what is recorded has the scenario");
}

#[tokio::test]
async fn a_contact_is_armed_for_who_is_there_while_the_machine_follows_and_everything_is_on_record() {
    let server = playing().await;
    let contact = |person: u32, secs: f64| json!({ "person": person, "secs": secs }).to_string();
    let problem = server.refused(409, "POST", "/api/v1/contact/arm", Some(&contact(1, 30.0))).await;
    assert_eq!(problem.why.as_deref(), Some(&Reason::ScenarioStands));
    server.arm().await;
    let problem = server.refused(409, "POST", "/api/v1/contact/arm", Some(&contact(1, 0.2))).await;
    assert_eq!(problem.why.as_deref(), Some(&Reason::ContactSecs { least: 1.0, most: 300.0 }));
    let problem = server.refused(409, "POST", "/api/v1/contact/arm", Some(&contact(9, 30.0))).await;
    assert!(matches!(problem.why.as_deref(), Some(Reason::PersonNotInside { .. })), "{problem:?}");
    server.refused(400, "POST", "/api/v1/contact/arm", Some("{\"person\": 1}")).await;
    let answer = server.good("POST", "/api/v1/contact/disarm", None).await;
    assert_eq!(
        (&answer["outcome"], &answer["detail"]),
        (&json!("already_so"), &json!("no contact is armed"))
    );
    let answer = server.good("POST", "/api/v1/contact/free", None).await;
    assert_eq!(answer["outcome"], "already_so");
    let state = server.good("GET", "/api/v1/state", None).await;
    assert_eq!(
        (&state["interaction"], &state["contact"], &state["bears"]),
        (&json!(null), &json!(null), &json!(null))
    );
    let events = server.good("GET", "/api/v1/events", None).await.to_string();
    assert!(events.contains("arm_contact by"), "{events}");
}

#[tokio::test]
async fn a_check_tells_what_is_worth_a_second_look() {
    let server = TestServer::start().await;
    let lonely = ESCAPE.replace("\"final\": true", "\"final\": false");
    let checked = server.good("POST", "/api/v1/scenes/check", Some(&lonely)).await;
    let warned = checked["warnings"].as_array().unwrap();
    let of_scenario = warned.iter().find(|w| w["path"] == "$.scenario.states[5]").unwrap();
    assert!(of_scenario["line"].as_u64().unwrap() > 60, "{checked}");
    let bad = ESCAPE.replace("\"initial\": \"dark\"", "\"initial\": \"light\"");
    let problem = server.refused(422, "POST", "/api/v1/scenes/check", Some(&bad)).await;
    assert_eq!(problem.errors[0].path, "$.scenario.initial");
    server.refused(409, "POST", "/api/v1/scenario/cue", Some(&cue("lights on"))).await;
}

#[tokio::test]
async fn a_stored_scene_of_the_version_before_is_read_as_one_of_this() {
    let server = TestServer::start().await;
    let kitchen = include_str!("../../deploy/scenes/kitchen.json").replace("covr.scene.v2", "covr.scene.v1");
    server.good("POST", "/api/v1/scenes", Some(&kitchen)).await;
    server.good("PUT", "/api/v1/scenes/2/activate", Some("{}")).await;
    let dir = server.shutdown().await;
    let file = format!("sqlite:{}", dir.path().join("covr.sqlite").display());
    let mut database = sqlx::SqliteConnection::connect(&file).await.unwrap();
    let as_before =
        "UPDATE scene_versions SET document = replace(document, 'covr.scene.v2', 'covr.scene.v1')";
    assert_eq!(sqlx::query(as_before).execute(&mut database).await.unwrap().rows_affected(), 2);
    database.close().await.unwrap();

    let server = TestServer::start_in(dir, |_| {}).await;
    let state = server.good("GET", "/api/v1/state", None).await;
    assert_eq!((&state["scene_id"], &state["scenario"]), (&json!(2), &Value::Null));
    for scene in ["/api/v1/scenes/1", "/api/v1/scenes/2"] {
        assert_eq!(server.good("GET", scene, None).await["schema"], "covr.scene.v2");
    }
}
