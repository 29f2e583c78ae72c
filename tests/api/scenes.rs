//! Scenes: upload, versions, refusals by JSON path, activation.

use covr_tests::dashboard::Dashboard;
use covr_tests::server::TestServer;
use covr_wire::dashboard::ToDashboard;

const KITCHEN: &str = r#"{
  "schema": "covr.scene.v2", "name": "Kitchen",
  "arena": { "min": [0, 0], "max": [4, 4] },
  "objects": [
    { "id": "kettle", "position": [1, 1, 1], "shape": { "kind": "sphere", "radius": 0.1 }, "prior": 0.5 },
    { "id": "tap", "position": [3, 2, 1], "shape": { "kind": "sphere", "radius": 0.1 } }
  ]
}"#;

#[tokio::test]
async fn a_scene_is_stored_edited_and_activated() {
    let server = TestServer::start().await;
    let response = server.call_as(Some("Ada"), "POST", "/api/v1/scenes", Some(KITCHEN)).await;
    assert_eq!(response.status(), 201);
    assert_eq!(response.headers()["location"], "/api/v1/scenes/2");
    let stored: serde_json::Value = serde_json::from_str(&response.text().await.unwrap()).unwrap();
    assert_eq!((&stored["id"], &stored["version"]), (&2.into(), &1.into()));

    let edited = KITCHEN.replace("Kitchen", "Kitchen at night");
    let response = server.call_as(Some("J%C3%BCrgen"), "PUT", "/api/v1/scenes/2", Some(&edited)).await;
    assert!(response.status().is_success());
    let list = server.good("GET", "/api/v1/scenes", None).await;
    assert_eq!(list[1]["name"], "Kitchen at night");
    assert_eq!((&list[1]["version"], &list[1]["author"]), (&2.into(), &"Jürgen".into()));
    assert_eq!((&list[0]["active"], &list[1]["active"]), (&true.into(), &false.into()));
    assert_eq!(server.good("GET", "/api/v1/scenes/2?version=1", None).await["name"], "Kitchen");
    assert_eq!(server.good("GET", "/api/v1/scenes/2", None).await["name"], "Kitchen at night");

    let mut dashboard = Dashboard::connect(&server.host).await;
    let activated = server.good("PUT", "/api/v1/scenes/2/activate", Some("{}")).await;
    assert_eq!(activated["version"], 2);
    let state = server.good("GET", "/api/v1/state", None).await;
    assert_eq!(state["scene_id"], 2);
    assert_eq!(state["objects"][0]["id"], "kettle");
    let shown = dashboard
        .hear("the new scene", |m| match m {
            ToDashboard::Scene { id: 2, version, scene } => Some((*version, scene.name.clone())),
            _ => None,
        })
        .await;
    assert_eq!(shown, (2, "Kitchen at night".into()));

    let dir = server.shutdown().await;
    let again = TestServer::start_in(dir, |_| {}).await;
    assert_eq!(again.good("GET", "/api/v1/state", None).await["scene_id"], 2, "it is active after a restart");
}

#[tokio::test]
async fn a_bad_scene_is_refused_with_path_line_found_and_expected() {
    let server = TestServer::start().await;
    let bad = KITCHEN.replace("\"radius\": 0.1 }, \"prior\": 0.5", "\"radius\": -1 }, \"prior\": 7");
    for (method, path) in
        [("POST", "/api/v1/scenes"), ("POST", "/api/v1/scenes/check"), ("PUT", "/api/v1/scenes/1")]
    {
        let problem = server.refused(422, method, path, Some(&bad)).await;
        let paths: Vec<&str> = problem.errors.iter().map(|error| error.path.as_str()).collect();
        assert!(paths.contains(&"$.objects[0].shape.radius"), "{paths:?}");
        assert!(paths.contains(&"$.objects[0].prior"), "{paths:?}");
        assert!(problem.errors.iter().all(|error| error.line == Some(5)), "{problem:?}");
        assert!(problem.errors.iter().any(|error| error.found.contains("-1")), "{problem:?}");
    }
    let typed = server.refused(422, "POST", "/api/v1/scenes", Some("{\"schema\": 3}")).await;
    assert_eq!(typed.errors[0].path, "$.schema");
    let syntax = server.refused(400, "POST", "/api/v1/scenes", Some("{\n  nonsense")).await;
    assert_eq!(syntax.errors[0].line, Some(2));
    assert_eq!(server.good("GET", "/api/v1/scenes", None).await.as_array().unwrap().len(), 1);
}

#[tokio::test]
async fn a_good_scene_passes_the_check_and_is_not_stored() {
    let server = TestServer::start().await;
    let checked = server.good("POST", "/api/v1/scenes/check", Some(KITCHEN)).await;
    assert_eq!((&checked["valid"], &checked["objects"]), (&true.into(), &2.into()));
    assert_eq!(server.good("GET", "/api/v1/scenes", None).await.as_array().unwrap().len(), 1);
}

#[tokio::test]
async fn every_version_is_listed_newest_first_and_the_active_one_is_marked() {
    let server = TestServer::start().await;
    server.call_as(Some("Ada"), "POST", "/api/v1/scenes", Some(KITCHEN)).await;
    let two = server.good("GET", "/api/v1/scenes/2", None).await;
    let mut one_object = two.clone();
    one_object["objects"].as_array_mut().unwrap().pop();
    server.call_as(Some("Bo"), "PUT", "/api/v1/scenes/2", Some(&one_object.to_string())).await;
    server.good("PUT", "/api/v1/scenes/2/activate?version=1", None).await;

    let versions = server.good("GET", "/api/v1/scenes/2/versions", None).await;
    let row = |row: &serde_json::Value| {
        let (author, active) = (row["author"].clone(), row["active"].clone());
        (row["version"].as_i64(), author, active, row["objects"].as_i64())
    };
    let rows: Vec<_> = versions.as_array().unwrap().iter().map(row).collect();
    let expected =
        vec![(Some(2), "Bo".into(), false.into(), Some(1)), (Some(1), "Ada".into(), true.into(), Some(2))];
    assert_eq!(rows, expected);
    let [newest, oldest] = [0, 1].map(|row| versions[row]["created_at"].as_str().unwrap().to_owned());
    assert!(newest >= oldest, "{newest} is not before {oldest}");
    let demo = server.good("GET", "/api/v1/scenes/1/versions", None).await;
    assert_eq!(demo[0]["active"], false, "a version 1 of another scene is not the active one");
}

#[tokio::test]
async fn a_scene_that_is_not_there_is_said_so() {
    let server = TestServer::start().await;
    server.refused(404, "GET", "/api/v1/scenes/99", None).await;
    server.refused(404, "GET", "/api/v1/scenes/kitchen", None).await;
    server.refused(404, "GET", "/api/v1/scenes/1?version=9", None).await;
    server.refused(404, "GET", "/api/v1/scenes/99/versions", None).await;
    server.refused(404, "PUT", "/api/v1/scenes/99", Some(KITCHEN)).await;
    server.refused(404, "PUT", "/api/v1/scenes/99/activate", None).await;
}

#[tokio::test]
async fn a_scene_larger_than_the_limit_is_refused_unread() {
    let server = TestServer::start().await;
    let large = format!("{{\"description\": \"{}\"}}", "x".repeat(5 * 1024 * 1024));
    server.refused(413, "POST", "/api/v1/scenes", Some(&large)).await;
}

#[tokio::test]
async fn no_scene_is_activated_while_the_machine_homes() {
    let server = TestServer::start().await;
    server.good("POST", "/api/v1/home", None).await;
    server.refused(409, "PUT", "/api/v1/scenes/1/activate", None).await;
}

#[tokio::test]
async fn the_schema_of_a_scene_is_served() {
    let server = TestServer::start().await;
    let response = server.call("GET", "/api/v1/scene.schema.json", None).await;
    assert_eq!(response.headers()["content-type"], "application/schema+json");
    let schema: serde_json::Value = serde_json::from_str(&response.text().await.unwrap()).unwrap();
    assert!(schema["properties"]["objects"].is_object());
}
