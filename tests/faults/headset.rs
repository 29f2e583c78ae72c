//! Headsets that freeze, jump, or are claimed twice.

use std::time::Duration;

use covr_engine::mode::Mode;
use covr_tests::client::VrClient;
use covr_tests::server::TestServer;
use covr_wire::client::{Encoding, ErrorCode};
use serde_json::Value;

async fn armed_with_ada() -> (TestServer, VrClient) {
    let server = TestServer::start().await;
    let mut client = VrClient::greeted(&server.host, "quest", Encoding::Json).await;
    client.enter("ada").await;
    client.pose("ada", 3.0, 3.0).await;
    server.good("POST", "/api/v1/home", None).await;
    until_mode(&server, &mut client, Mode::Ready, |client, sequence| good(client, 3.0, sequence)).await;
    server.good("POST", "/api/v1/arm", None).await;
    (server, client)
}

/// A pose of now.
fn good(client: &VrClient, x_m: f64, sequence: u32) -> Value {
    client.pose_message("ada", x_m, 3.0, sequence)
}

/// Send these poses at 90 Hz until the machine is in this mode.
async fn until_mode(
    server: &TestServer,
    client: &mut VrClient,
    mode: Mode,
    pose: impl Fn(&VrClient, u32) -> Value,
) {
    let reached = server.mode(mode);
    tokio::pin!(reached);
    let mut beat = tokio::time::interval(Duration::from_secs_f64(1.0 / 90.0));
    loop {
        tokio::select! {
            _ = &mut reached => return,
            _ = beat.tick() => {
                let sequence = next_sequence();
                let message = pose(client, sequence);
                client.say(&message).await;
            }
        }
    }
}

/// Newer than every sequence before it in this process.
fn next_sequence() -> u32 {
    static SEQUENCE: std::sync::atomic::AtomicU32 = std::sync::atomic::AtomicU32::new(10);
    SEQUENCE.fetch_add(1, std::sync::atomic::Ordering::Relaxed)
}

async fn stop(server: &TestServer) {
    assert_eq!(server.good("POST", "/api/v1/stop", None).await["acknowledged"], true);
}

#[tokio::test]
async fn a_frozen_headset_that_repeats_its_last_pose_and_time_is_lost_tracking() {
    let (server, mut client) = armed_with_ada().await;
    let frozen = good(&client, 3.0, 0);
    until_mode(&server, &mut client, Mode::ProtectiveStop, |_, sequence| {
        let mut pose = frozen.clone();
        pose["sequence"] = sequence.into();
        pose
    })
    .await;
    let state = server.good("GET", "/api/v1/state", None).await;
    assert_eq!(state["stop"]["rule"], "R2", "{}", state["stop"]);
    assert_eq!(state["stop"]["why"]["id"], "pose_too_old", "{}", state["stop"]);
    stop(&server).await;
}

#[tokio::test]
async fn a_headset_that_gives_its_last_pose_new_times_is_kept_from_as_somebody_who_stands_there() {
    let (server, mut client) = armed_with_ada().await;
    let since = server.app.control.published().snapshot.at;
    let later =
        server.published("two seconds of it", covr_tests::SOON, |p| (p.snapshot.at - since).secs() > 2.0);
    tokio::pin!(later);
    let mut beat = tokio::time::interval(Duration::from_secs_f64(1.0 / 90.0));
    let published = loop {
        tokio::select! {
            published = &mut later => break published,
            _ = beat.tick() => {
                let message = good(&client, 3.0, next_sequence());
                client.say(&message).await;
            }
        }
    };
    // Nothing tells it from a person who stands still: no rule of this version watches for it.
    assert_eq!(published.snapshot.mode, Mode::Following);
    assert!(published.snapshot.persons[0].tracked);
    stop(&server).await;
}

#[tokio::test]
async fn a_teleporting_headset_is_lost_tracking_until_its_poses_hold_together() {
    let (server, mut client) = armed_with_ada().await;
    until_mode(&server, &mut client, Mode::ProtectiveStop, |client, sequence| {
        good(client, if sequence % 20 < 10 { 3.0 } else { 1.6 }, sequence)
    })
    .await;
    let state = server.good("GET", "/api/v1/state", None).await;
    assert_eq!(state["stop"]["why"]["id"], "pose_jumped", "{}", state["stop"]);
    until_mode(&server, &mut client, Mode::Following, |client, sequence| good(client, 3.0, sequence)).await;
    stop(&server).await;
}

#[tokio::test]
async fn of_two_clients_that_claim_the_same_person_the_first_keeps_them() {
    let server = TestServer::start().await;
    let mut first = VrClient::greeted(&server.host, "quest", Encoding::Json).await;
    first.enter("ada").await;
    first.pose("ada", 3.0, 3.0).await;
    server
        .published("ada", covr_tests::SOON, |p| p.snapshot.persons.iter().any(|person| person.tracked))
        .await;
    let mut second = VrClient::greeted(&server.host, "quest", Encoding::Json).await;
    second.enter("ada").await;
    assert_eq!(second.error().await.code, ErrorCode::AlreadyEntered);
    second.pose("ada", 1.0, 1.0).await;
    assert_eq!(second.error().await.code, ErrorCode::UnknownPerson);
    first.pose("ada", 3.1, 3.0).await;
    let moved = |p: &covr_server::control::Published| {
        p.snapshot.persons[0].pose.is_some_and(|pose| (pose.position.x() - 3.1).abs() < 1e-6)
    };
    let published = server.published("the first one's pose", covr_tests::SOON, |p| moved(p)).await;
    assert_eq!(published.snapshot.persons.len(), 1);
    stop(&server).await;
}
