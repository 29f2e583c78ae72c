//! The client protocol over a real socket: conversation in both encodings, and every kind of bad input.

use covr_engine::mode::Mode;
use covr_tests::SOON;
use covr_tests::client::VrClient;
use covr_tests::server::TestServer;
use covr_wire::client::{Encoding, ErrorCode, ToClient};
use futures_util::SinkExt;
use serde_json::json;
use tokio_tungstenite::tungstenite::Message;
use tokio_tungstenite::tungstenite::client::IntoClientRequest;
use tokio_tungstenite::tungstenite::protocol::frame::coding::CloseCode;

#[tokio::test]
async fn a_conversation_in_json() {
    conversation(Encoding::Json).await;
}

#[tokio::test]
async fn a_conversation_in_messagepack() {
    conversation(Encoding::MessagePack).await;
}

async fn conversation(encoding: Encoding) {
    let server = TestServer::start().await;
    let mut client = VrClient::connect(&server.host, encoding).await;
    client.say(&json!({"type": "hello", "name": "quest", "convention": "openxr"})).await;
    let welcome =
        client.hear("a welcome", |m| if let ToClient::Welcome(w) = m { Some(w.clone()) } else { None }).await;
    assert_eq!(welcome.scene.as_ref().map(|scene| scene.places.len()), Some(5));
    client.hear("the stop state", |m| matches!(m, ToClient::Stop(s) if !s.stopped).then_some(())).await;
    client.say(&json!({"type": "clock_ping", "id": 4, "client_time_micros": 17})).await;
    let pong = client.hear("a pong", |m| if let ToClient::ClockPong(p) = m { Some(*p) } else { None }).await;
    assert_eq!((pong.id, pong.client_time_micros), (4, 17));
    assert!(pong.server_sent_micros >= pong.server_received_micros);

    client.enter("ada").await;
    client.pose("ada", 2.0, 1.5).await;
    let published = server
        .published("ada's pose", SOON, |p| p.snapshot.persons.first().is_some_and(|p| p.pose.is_some()))
        .await;
    let position = published.snapshot.persons[0].pose.unwrap().position;
    assert!((position.x() - 2.0).abs() < 1e-9 && (position.y() - 1.5).abs() < 1e-9, "{position:?}");
    let column =
        client.hear("the column", |m| if let ToClient::Column(c) = m { Some(c.clone()) } else { None }).await;
    assert_eq!(column.prop_at.len(), 5);

    client
        .say(&json!({"type": "touch_began", "person": "ada", "object": "lamp", "client_time_micros": 20}))
        .await;
    client
        .say(&json!({"type": "touch_ended", "person": "ada", "object": "lamp", "client_time_micros": 30}))
        .await;
    client.say(&json!({"type": "scene_event", "name": "door_opened", "detail": {"by": "ada"}})).await;
    client.say(&json!({"type": "leave", "person": "ada"})).await;
    server.published("ada left", SOON, |p| p.snapshot.persons.is_empty()).await;
    client.socket.close(None).await.unwrap();
    let events = covr_tests::eventually("the client's end is recorded", || async {
        let events = server.good("GET", "/api/v1/events?limit=50", None).await;
        events.as_array().unwrap().iter().any(|e| e["kind"] == "client_gone").then_some(events)
    })
    .await;
    let kinds: Vec<_> =
        events.as_array().unwrap().iter().rev().map(|e| e["kind"].as_str().unwrap()).collect();
    for kind in
        ["client_connected", "person_entered", "touch_began", "touch_ended", "scene_event", "person_left"]
    {
        assert!(kinds.contains(&kind), "{kind} is missing in {kinds:?}");
    }
}

#[tokio::test]
async fn each_bad_message_is_answered_by_its_field_and_changes_nothing() {
    let server = TestServer::start().await;
    let mut client = VrClient::greeted(&server.host, "quest", Encoding::Json).await;
    client.enter("ada").await;
    let good = client.pose_message("ada", 1.0, 1.0, 1);
    let with = |key: &str, value: serde_json::Value| {
        let mut message = good.clone();
        message[key] = value;
        message
    };
    let cases = [
        (json!({"type": "teleport"}), ErrorCode::UnknownMessage, "type"),
        (json!({"person": "ada"}), ErrorCode::MissingField, "type"),
        (with("sequence", json!("one")), ErrorCode::WrongType, "sequence"),
        (with("position", json!([0.0, 1.0])), ErrorCode::WrongType, "position"),
        (with("position", json!([0.0, "up", 0.0])), ErrorCode::WrongType, "position[1]"),
        (with("orientation", json!([0.0, 0.0, 0.0, 0.5])), ErrorCode::NotUnit, "orientation"),
        (with("person", json!("bob")), ErrorCode::UnknownPerson, "person"),
        (with("velocity", json!([0, 0, 0])), ErrorCode::UnknownField, "velocity"),
        (
            json!({"type": "touch_began", "person": "ada", "object": "ghost", "client_time_micros": 1}),
            ErrorCode::UnknownObject,
            "object",
        ),
        (json!({"type": "leave"}), ErrorCode::MissingField, "person"),
    ];
    for (message, code, field) in cases {
        client.say(&message).await;
        let error = client.error().await;
        assert_eq!((error.code, error.field.as_deref()), (code, Some(field)), "{message} got {error:?}");
        assert!(!error.fatal);
    }
    client.socket.send(Message::Text("{\"type\": \"pose\", \"position\": [NaN]}".into())).await.unwrap();
    assert_eq!(client.error().await.code, ErrorCode::Malformed);
    client.socket.send(Message::Binary(vec![0x80].into())).await.unwrap();
    assert_eq!(client.error().await.code, ErrorCode::WrongFrame);
    client.socket.send(Message::Text("x".repeat(20_000).into())).await.unwrap();
    assert_eq!(client.error().await.code, ErrorCode::FrameTooLarge);
    client.say(&json!({"type": "hello", "name": "quest", "convention": "openxr"})).await;
    assert_eq!(client.error().await.code, ErrorCode::AlreadyGreeted);
    client.enter("ada").await;
    assert_eq!(client.error().await.code, ErrorCode::AlreadyEntered);

    client.say(&client.pose_message("ada", 1.0, 1.0, 9)).await;
    client.say(&client.pose_message("ada", 3.0, 3.0, 8)).await;
    assert_eq!(client.error().await.code, ErrorCode::OutOfOrder);
    let published = server
        .published("a pose", SOON, |p| p.snapshot.persons.first().is_some_and(|p| p.pose.is_some()))
        .await;
    let position = published.snapshot.persons[0].pose.unwrap().position;
    assert!((position.x() - 1.0).abs() < 1e-9, "no refused pose was taken: {position:?}");
}

#[tokio::test]
async fn nan_in_messagepack_is_refused_by_its_field() {
    let server = TestServer::start().await;
    let mut client = VrClient::greeted(&server.host, "quest", Encoding::MessagePack).await;
    client.enter("ada").await;
    let message = client.pose_message("ada", 1.0, 1.0, 1);
    let covr_wire::client::Frame::Binary(mut bytes) = Encoding::MessagePack.encode(&message).unwrap() else {
        panic!("MessagePack frames are binary")
    };
    // The height, the one 1.7 of the message, becomes NaN.
    let at = bytes.windows(8).position(|eight| eight == 1.7_f64.to_be_bytes()).unwrap();
    bytes[at..at + 8].copy_from_slice(&f64::NAN.to_be_bytes());
    client.socket.send(Message::Binary(bytes.into())).await.unwrap();
    let error = client.error().await;
    assert_eq!(error.code, ErrorCode::NotFinite);
    assert!(error.message.contains("position"), "{error:?}");
}

#[tokio::test]
async fn repeated_abuse_closes_with_a_reason() {
    let server = TestServer::start().await;
    let mut client = VrClient::greeted(&server.host, "rogue", Encoding::Json).await;
    for _ in 0..60 {
        client.socket.feed(Message::Text("{}".into())).await.unwrap();
    }
    // The server may close while the rest is still on its way.
    let _ = client.socket.flush().await;
    let frame = client.closed().await.expect("a close frame");
    assert_eq!(frame.code, CloseCode::Policy);
    assert!(!frame.reason.is_empty());
}

#[tokio::test]
async fn a_flood_of_good_messages_closes_as_well() {
    let server = TestServer::start().await;
    let mut client = VrClient::greeted(&server.host, "flood", Encoding::Json).await;
    client.enter("ada").await;
    for sequence in 1..5_000 {
        let message = client.pose_message("ada", 1.0, 1.0, sequence).to_string();
        if client.socket.feed(Message::Text(message.into())).await.is_err() {
            break;
        }
    }
    let _ = client.socket.flush().await;
    client.closed().await;
    let events = covr_tests::eventually("the abuse is recorded", || async {
        let events = server.good("GET", "/api/v1/events?limit=50", None).await;
        let closed = |e: &serde_json::Value| e["kind"] == "client_error" && e["detail"]["closed"] == true;
        events.as_array().unwrap().iter().any(closed).then_some(events)
    })
    .await;
    assert!(events.to_string().contains("too_many_messages"), "{events}");
}

#[tokio::test]
async fn hello_comes_first_and_soon() {
    let server = TestServer::start_with(|config| config.clients.hello_timeout_secs = 0.3).await;
    let mut client = VrClient::connect(&server.host, Encoding::Json).await;
    client.enter("ada").await;
    assert_eq!(client.error().await.code, ErrorCode::HelloExpected);
    let error = client.error().await;
    assert!(error.fatal && error.code == ErrorCode::HelloExpected, "{error:?}");
    assert_eq!(client.closed().await.map(|frame| frame.code), Some(CloseCode::Policy));
}

#[tokio::test]
async fn a_client_that_falls_silent_is_gone() {
    let server = TestServer::start_with(|config| config.clients.silence_timeout_secs = 0.5).await;
    let mut client = VrClient::greeted(&server.host, "quest", Encoding::Json).await;
    assert!(client.error().await.fatal);
    assert!(client.closed().await.is_some());
}

#[tokio::test]
async fn an_unknown_subprotocol_is_refused_and_none_means_json() {
    let server = TestServer::start().await;
    let url = format!("ws://{}/ws/v1/client", server.host);
    let mut request = url.as_str().into_client_request().unwrap();
    request.headers_mut().insert("Sec-WebSocket-Protocol", "covr.v9.cbor".parse().unwrap());
    assert!(tokio_tungstenite::connect_async(request).await.is_err());
    let (mut socket, response) = tokio_tungstenite::connect_async(&url).await.unwrap();
    assert!(!response.headers().contains_key("sec-websocket-protocol"));
    socket
        .send(Message::Text("{\"type\": \"hello\", \"name\": \"plain\", \"convention\": \"ros\"}".into()))
        .await
        .unwrap();
    covr_tests::eventually("the plain client is known", || async {
        server.app.clients.list().into_iter().find(|client| client.name == "plain")
    })
    .await;
}

#[tokio::test]
async fn no_message_of_a_client_moves_a_machine_that_is_not_armed() {
    let server = TestServer::start().await;
    let mut client = VrClient::greeted(&server.host, "quest", Encoding::Json).await;
    client.enter("ada").await;
    for _ in 0..50 {
        client.pose("ada", 0.5, 0.5).await;
    }
    let published =
        server.published("poses", SOON, |p| p.snapshot.persons.first().is_some_and(|p| p.tracked)).await;
    assert_eq!(published.snapshot.mode, Mode::Disarmed);
    assert!(published.snapshot.column.velocity.norm() < 1e-6);
}

#[tokio::test]
async fn somebody_whose_client_is_gone_can_be_said_to_have_left() {
    let server = TestServer::start().await;
    let mut client = VrClient::greeted(&server.host, "quest", Encoding::Json).await;
    client.enter("ada").await;
    client.pose("ada", 0.5, 0.5).await;
    let there =
        server.published("ada", SOON, |p| p.snapshot.persons.iter().any(|person| person.tracked)).await;
    let left = format!("/api/v1/persons/{}/left", there.snapshot.persons[0].person.0);
    drop(client);
    server.published("ada is lost", SOON, |p| p.snapshot.persons.iter().all(|person| !person.tracked)).await;
    server.good("POST", &left, None).await;
    server.published("ada has left", SOON, |p| p.snapshot.persons.is_empty()).await;
    let problem = server.refused(404, "POST", &left, None).await;
    assert!(problem.detail.contains("not in the arena"), "{problem:?}");
}
