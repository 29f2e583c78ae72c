//! A person's client goes and comes back; the origin changes and is confirmed.

use covr_tests::SOON;
use covr_tests::client::VrClient;
use covr_tests::server::TestServer;
use covr_wire::client::{Encoding, ErrorCode};
use serde_json::json;

#[tokio::test]
async fn a_lost_client_leaves_its_person_inside_and_finds_them_again() {
    let server = TestServer::start().await;
    let mut client = VrClient::greeted(&server.host, "quest", Encoding::Json).await;
    client.enter("ada").await;
    client.pose("ada", 2.0, 2.0).await;
    let published = server.published("ada", SOON, |p| p.snapshot.persons.len() == 1).await;
    let id = published.snapshot.persons[0].person;

    let mut second = VrClient::greeted(&server.host, "quest", Encoding::Json).await;
    second.enter("ada").await;
    let taken = second.error().await;
    assert_eq!(
        taken.code,
        ErrorCode::AlreadyEntered,
        "a second live client may not speak for the same person"
    );
    drop(second);

    drop(client);
    covr_tests::eventually("the client's end is recorded", || async {
        let events = server.good("GET", "/api/v1/events?limit=20", None).await;
        let gone =
            |e: &serde_json::Value| e["kind"] == "client_gone" && e["detail"]["persons"] == json!(["ada"]);
        events.as_array().unwrap().iter().any(gone).then_some(())
    })
    .await;
    assert_eq!(server.app.control.published().snapshot.persons.len(), 1, "the person is still there");

    let mut back = VrClient::greeted(&server.host, "quest", Encoding::Json).await;
    back.enter("ada").await;
    back.pose("ada", 2.0, 2.1).await;
    let published = server
        .published("ada's new pose", SOON, |p| {
            p.snapshot
                .persons
                .iter()
                .any(|p| p.pose.is_some_and(|pose| (pose.position.y() - 2.1).abs() < 1e-9))
        })
        .await;
    assert_eq!(published.snapshot.persons.len(), 1);
    assert_eq!(published.snapshot.persons[0].person, id, "the same number as before");
}

#[tokio::test]
async fn a_changed_origin_waits_for_the_game_master() {
    let server = TestServer::start().await;
    let mut client = VrClient::greeted(&server.host, "quest", Encoding::Json).await;
    client.enter("ada").await;
    client.pose("ada", 2.0, 2.0).await;
    client.say(&json!({"type": "origin_changed", "person": "ada"})).await;
    let awaits = |p: &std::sync::Arc<covr_server::control::Published>| {
        p.snapshot.persons.first().is_some_and(|person| person.awaits_confirmation)
    };
    let published = server.published("ada awaits confirmation", SOON, awaits).await;
    client.pose("ada", 2.0, 2.0).await;
    let id = published.snapshot.persons[0].person.0;
    let confirmed = server.good("POST", &format!("/api/v1/persons/{id}/confirm"), None).await;
    assert_eq!(confirmed["outcome"], "accepted", "{confirmed}");
    server.published("ada is confirmed", SOON, |p| !awaits(p)).await;
}

#[tokio::test]
async fn several_clients_at_once_each_with_its_own_convention() {
    let server = TestServer::start_with(|config| config.clients.most = 2).await;
    let mut quest = VrClient::greeted(&server.host, "quest", Encoding::Json).await;
    let mut vive = VrClient::connect(&server.host, Encoding::MessagePack).await;
    vive.say(&json!({"type": "hello", "name": "vive", "convention": "unreal"})).await;
    quest.enter("ada").await;
    vive.enter("bo").await;
    quest.pose("ada", 1.0, 1.0).await;
    // Unreal: x forward, y right, z up, centimetres.
    vive.say(&json!({"type": "pose", "person": "bo", "sequence": 1, "client_time_micros": 0,
        "position": [300.0, -200.0, 170.0], "orientation": [0, 0, 0, 1], "tracked": true, "worn": true}))
        .await;
    let published = server
        .published("both", SOON, |p| p.snapshot.persons.iter().filter(|p| p.pose.is_some()).count() == 2)
        .await;
    let mut places: Vec<[f64; 2]> = published
        .snapshot
        .persons
        .iter()
        .map(|p| {
            let position = p.pose.unwrap().position;
            [position.x(), position.y()]
        })
        .collect();
    places.sort_by(|a, b| a[0].total_cmp(&b[0]));
    assert!((places[0][0] - 1.0).abs() < 1e-9 && (places[1][0] - 3.0).abs() < 1e-9, "{places:?}");
    assert!((places[1][1] - 2.0).abs() < 1e-9, "{places:?}");
    let url = format!("ws://{}/ws/v1/client", server.host);
    assert!(tokio_tungstenite::connect_async(url).await.is_err(), "a third client is one too many");
}
