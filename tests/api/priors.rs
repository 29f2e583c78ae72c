//! Priors: all or nothing, recorded with their author, in force after a restart.

use covr_tests::client::VrClient;
use covr_tests::server::TestServer;
use covr_wire::client::Encoding;
use serde_json::{Value, json};

fn prior(state: &serde_json::Value, object: &str) -> f64 {
    let objects = state["objects"].as_array().unwrap();
    objects.iter().find(|o| o["id"] == object).unwrap()["prior"].as_f64().unwrap()
}

#[tokio::test]
async fn a_prior_change_takes_effect_and_is_recorded() {
    let server = TestServer::start().await;
    let body = "{\"lamp\": 0.9, \"globe\": 0.1}";
    let response = server.call_as(Some("Ada"), "PATCH", "/api/v1/priors", Some(body)).await;
    assert!(response.status().is_success());
    let state = server.good("GET", "/api/v1/state", None).await;
    assert_eq!((prior(&state, "lamp"), prior(&state, "globe"), prior(&state, "desk")), (0.9, 0.1, 0.5));
    let changes = server.good("GET", "/api/v1/priors/changes", None).await;
    let lamp = changes.as_array().unwrap().iter().find(|c| c["object"] == "lamp").unwrap();
    assert_eq!((&lamp["author"], &lamp["from"], &lamp["to"]), (&"Ada".into(), &0.5.into(), &0.9.into()));
    assert_eq!((&lamp["scene_id"], &lamp["scene_version"]), (&1.into(), &1.into()));
    assert!(lamp["at"].as_str().unwrap().ends_with('Z'));

    let dir = server.shutdown().await;
    let again = TestServer::start_in(dir, |_| {}).await;
    let state = again.good("GET", "/api/v1/state", None).await;
    assert_eq!(prior(&state, "lamp"), 0.9, "in force after a restart");
    again.good("PUT", "/api/v1/scenes/1/activate", None).await;
    let state = again.good("GET", "/api/v1/state", None).await;
    assert_eq!(prior(&state, "lamp"), 0.5, "an activation starts from the document");
}

#[tokio::test]
async fn of_a_bad_change_nothing_is_done_and_all_that_is_bad_is_named() {
    let server = TestServer::start().await;
    let body = "{\"lamp\": 0.9, \"ghost\": 0.5, \"desk\": 1.5, \"door\": \"high\"}";
    let problem = server.refused(422, "PATCH", "/api/v1/priors", Some(body)).await;
    let named: Vec<&str> = problem.errors.iter().map(|error| error.path.as_str()).collect();
    assert_eq!(named, ["desk", "door", "ghost"]);
    let state = server.good("GET", "/api/v1/state", None).await;
    assert_eq!(prior(&state, "lamp"), 0.5);
    assert_eq!(server.good("GET", "/api/v1/priors/changes", None).await.as_array().unwrap().len(), 0);
    server.refused(400, "PATCH", "/api/v1/priors", Some("[0.4]")).await;
    server.refused(400, "PATCH", "/api/v1/priors", Some("{\"lamp\": NaN}")).await;
    server.refused(422, "GET", "/api/v1/priors/changes?limit=0", None).await;
}

#[tokio::test]
async fn a_preview_tells_what_priors_would_do_and_changes_nothing() {
    let server = TestServer::start().await;
    let preview = async |body: &str| server.good("POST", "/api/v1/priors/preview", Some(body)).await;
    let alone = preview("{}").await;
    assert_eq!(
        (&alone["target_m"], &alone["serves"], &alone["planned_path_m"]),
        (&Value::Null, &Value::Null, &json!([]))
    );

    server.arm().await;
    let mut client = VrClient::greeted(&server.host, "headset", Encoding::Json).await;
    client.enter("Ada").await;
    let served = async |client: &mut VrClient| {
        client.pose("Ada", 2.0, 2.0).await;
        let state = server.good("GET", "/api/v1/state", None).await;
        (state["column"]["target_m"] != Value::Null).then_some(state)
    };
    let state = loop {
        if let Some(state) = served(&mut client).await {
            break state;
        }
    };
    assert_ne!(state["column"]["reason"], "");
    // All but one object have no prior: there it goes.
    let objects = state["objects"].as_array().unwrap();
    let chosen = objects.last().unwrap();
    let body: serde_json::Map<String, Value> =
        objects.iter().map(|o| (o["id"].as_str().unwrap().into(), json!(0.0))).collect();
    let mut body = Value::Object(body);
    body[chosen["id"].as_str().unwrap()] = json!(0.7);
    client.pose("Ada", 2.0, 2.0).await;
    let previewed = preview(&body.to_string()).await;
    assert_eq!(previewed["target_m"], chosen["column_place_m"]);
    assert_eq!(previewed["serves"], state["persons"][0]["id"]);
    let last = previewed["objects"].as_array().unwrap().last().unwrap();
    assert_eq!((&last["id"], &last["prior"]), (&chosen["id"], &json!(0.7)));
    let others = &previewed["objects"].as_array().unwrap()[..objects.len() - 1];
    assert!(others.iter().all(|other| other["probability"] == json!(0.0)), "{previewed}");
    // What is left is "none of them".
    assert!(last["probability"].as_f64().unwrap() > 0.9, "{last}");
    assert!(!previewed["planned_path_m"].as_array().unwrap().is_empty());
    let after = server.good("GET", "/api/v1/state", None).await;
    assert_eq!(prior(&after, "lamp"), 0.5, "nothing is changed");
    assert!(server.good("GET", "/api/v1/priors/changes", None).await.as_array().unwrap().is_empty());
}

#[tokio::test]
async fn a_bad_preview_is_refused_like_a_bad_change() {
    let server = TestServer::start().await;
    let body = "{\"lamp\": 0.9, \"ghost\": 0.5, \"desk\": 1.5}";
    let problem = server.refused(422, "POST", "/api/v1/priors/preview", Some(body)).await;
    let named: Vec<&str> = problem.errors.iter().map(|error| error.path.as_str()).collect();
    assert_eq!(named, ["desk", "ghost"]);
    server.refused(400, "POST", "/api/v1/priors/preview", Some("[0.4]")).await;
}
