//! The dashboard's socket: whole snapshots, events, requests and the stop's own lane.

use covr_tests::SOON;
use covr_tests::dashboard::Dashboard;
use covr_tests::server::TestServer;
use covr_wire::dashboard::{FromDashboard, MachineRequest, Mode, Outcome, ToDashboard};
use futures_util::StreamExt;
use tokio_tungstenite::tungstenite::Message;
use tokio_tungstenite::tungstenite::protocol::frame::coding::CloseCode;

async fn answer(dashboard: &mut Dashboard, wanted: u32) -> (Outcome, String, Option<u64>) {
    dashboard
        .hear("the answer", |m| match m {
            ToDashboard::Answer { request_id, outcome, detail, to_drive_micros, .. }
                if *request_id == wanted =>
            {
                Some((*outcome, detail.clone(), *to_drive_micros))
            }
            _ => None,
        })
        .await
}

#[tokio::test]
async fn a_dashboard_is_welcomed_and_follows_what_happens() {
    let server = TestServer::start().await;
    let mut dashboard = Dashboard::connect(&server.host).await;
    let machine = dashboard
        .hear("the welcome", |m| match m {
            ToDashboard::Welcome { machine, machine_shape, .. } => {
                Some((machine.clone(), machine_shape.travel_m))
            }
            _ => None,
        })
        .await;
    assert_eq!(machine, ("simulated".into(), [0.0, 0.0, 1.0, 1.0]));
    dashboard.hear("the scene", |m| matches!(m, ToDashboard::Scene { id: 1, .. }).then_some(())).await;
    let mut last = 0;
    for _ in 0..5 {
        last = dashboard
            .hear("a newer snapshot", |m| match m {
                ToDashboard::Snapshot(s) if s.generation > last => Some(s.generation),
                _ => None,
            })
            .await;
    }
    server.good("POST", "/api/v1/stop", None).await;
    dashboard
        .hear("the event", |m| matches!(m, ToDashboard::Event(e) if e.kind == "stop_pressed").then_some(()))
        .await;
    dashboard
        .hear("the mode", |m| {
            matches!(m, ToDashboard::Snapshot(s) if s.mode == Mode::LatchedStop).then_some(())
        })
        .await;
}

#[tokio::test]
async fn a_dashboards_stop_reaches_the_drive_and_says_how_fast() {
    let server = TestServer::start().await;
    let mut dashboard = Dashboard::connect(&server.host).await;
    dashboard.say(&FromDashboard::Stop { request_id: 7, reason: Some("look out".into()) }).await;
    let (outcome, _, micros) = answer(&mut dashboard, 7).await;
    assert_eq!(outcome, Outcome::Accepted);
    assert!(micros.is_some_and(|micros| micros > 0 && micros < 1_000_000), "{micros:?}");
    let state = server.good("GET", "/api/v1/state", None).await;
    assert!(state["stop"]["reason"].as_str().unwrap().contains("look out"), "{state}");
}

#[tokio::test]
async fn requests_are_answered_each_by_its_number() {
    let server = TestServer::start().await;
    let mut dashboard = Dashboard::connect(&server.host).await;
    let request = |request_id, request| FromDashboard::Request { request_id, request, reason: None };
    dashboard.say(&request(1, MachineRequest::Arm)).await;
    assert_eq!(answer(&mut dashboard, 1).await.0, Outcome::Refused);
    dashboard.say(&request(2, MachineRequest::Home)).await;
    assert_eq!(answer(&mut dashboard, 2).await.0, Outcome::Accepted);
    dashboard.say(&request(3, MachineRequest::Reset)).await;
    assert!(answer(&mut dashboard, 3).await.1.contains("reason"));
    dashboard.say(&request(4, MachineRequest::ConfirmOrigin(9))).await;
    assert!(answer(&mut dashboard, 4).await.1.contains("not in the arena"));
    dashboard.say_text("{\"type\": \"request\", \"request_id\": 5, \"request\": \"dance\"}").await;
    let (outcome, detail, _) = answer(&mut dashboard, 5).await;
    assert!(outcome == Outcome::Refused && detail.contains("dance"), "{detail}");
    dashboard.say_text("nonsense").await;
    assert_eq!(answer(&mut dashboard, 0).await.0, Outcome::Refused);
}

#[tokio::test]
async fn a_dashboard_that_falls_behind_with_events_is_sent_away_to_start_afresh() {
    let server = TestServer::start_with(|config| config.dashboards.event_queue = 16).await;
    let mut dashboard = Dashboard::connect(&server.host).await;
    dashboard.hear("the welcome", |m| matches!(m, ToDashboard::Welcome { .. }).then_some(())).await;
    // More than the socket's buffers hold, while nobody reads.
    let ballast = "x".repeat(100_000);
    for _ in 0..200 {
        server.app.recorder.record("scene_event", "ballast", serde_json::json!({ "ballast": ballast }));
    }
    server.app.recorder.settled().await;
    let closed = tokio::time::timeout(SOON, async {
        loop {
            match dashboard.socket.next().await {
                Some(Ok(Message::Close(frame))) => return frame,
                Some(Ok(_)) => {}
                other => panic!("ended without a word: {other:?}"),
            }
        }
    });
    let frame = closed.await.expect("closed in time").expect("a close frame");
    assert_eq!(frame.code, CloseCode::Again);
    assert!(frame.reason.contains("behind"), "{}", frame.reason);
    // A fresh one is welcome.
    let mut fresh = Dashboard::connect(&server.host).await;
    fresh.hear("a snapshot", |m| matches!(m, ToDashboard::Snapshot(_)).then_some(())).await;
}

#[tokio::test]
async fn a_server_full_of_dashboards_takes_no_more_and_frees_the_place() {
    let server = TestServer::start_with(|config| config.dashboards.most = 1).await;
    let first = Dashboard::connect(&server.host).await;
    let url = format!("ws://{}/ws/v1/dashboard", server.host);
    assert!(tokio_tungstenite::connect_async(&url).await.is_err());
    drop(first);
    covr_tests::eventually("the place is free", || async {
        tokio_tungstenite::connect_async(&url).await.ok().map(drop)
    })
    .await;
}
