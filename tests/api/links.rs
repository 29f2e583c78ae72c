//! What dashboards and metrics say of the links to VR clients, over real sockets.

use covr_tests::client::VrClient;
use covr_tests::dashboard::Dashboard;
use covr_tests::eventually;
use covr_tests::server::TestServer;
use covr_wire::client::Encoding;
use covr_wire::dashboard::{Client, ToDashboard};

async fn shown(server: &TestServer, what: &str, is_it: impl Fn(&Client) -> bool) -> Client {
    eventually(what, || async { server.app.clients.list().into_iter().find(&is_it) }).await
}

#[tokio::test]
async fn age_jitter_and_loss_of_a_link_are_shown_and_start_afresh_with_a_connection() {
    let server = TestServer::start().await;
    let mut client = VrClient::greeted(&server.host, "lossy", Encoding::Json).await;
    client.enter("ada").await;
    let quiet = shown(&server, "ada has entered", |client| !client.persons.is_empty()).await;
    assert_eq!((quiet.pose_age_millis, quiet.jitter_millis, quiet.loss_percent), (None, None, None));

    // Of 40 poses, one after the wrap is missing.
    for step in (0..40_u32).filter(|step| *step != 30) {
        let mut message = client.pose_message("ada", 1.0, 1.0, (u32::MAX - 20).wrapping_add(step));
        // The client's clock says that every pose was on its way for 8 ms more than the one before, or less.
        let shift = if step % 2 == 0 { 8_000 } else { 0 };
        message["client_time_micros"] = (message["client_time_micros"].as_i64().unwrap() - shift).into();
        client.say(&message).await;
    }
    // The age is that of the last second: on a busy host it is gone by the time that the last pose is counted.
    let aged = shown(&server, "an age", |client| client.pose_age_millis.is_some()).await;
    assert!(aged.pose_age_millis.is_some_and(|age| (28.0..5_000.0).contains(&age)), "{aged:?}");
    let told = shown(&server, "all poses", |client| client.poses == 39).await;
    assert_eq!(told.loss_percent, Some(2.5));
    assert!(told.jitter_millis.is_some_and(|jitter| (3.0..1_000.0).contains(&jitter)), "{told:?}");
    eventually("the loss among the metrics", || async {
        let text = server.call("GET", "/metrics", None).await.text().await.unwrap();
        text.contains(r#"covr_client_loss_ratio{client="lossy"} 0.025"#).then_some(())
    })
    .await;

    let is_silent = |client: &Client| client.pose_age_millis.is_none() && client.pose_rate_hz < 1.0;
    shown(&server, "a silent client has no age and no rate", is_silent).await;

    drop(client);
    eventually("the client is gone", || async { server.app.clients.list().is_empty().then_some(()) }).await;
    let mut client = VrClient::greeted(&server.host, "lossy", Encoding::Json).await;
    client.enter("ada").await;
    client.pose("ada", 1.0, 1.0).await;
    let afresh = shown(&server, "a first pose", |client| client.poses == 1).await;
    assert_eq!((afresh.loss_percent, afresh.jitter_millis), (Some(0.0), None));
}

#[tokio::test]
async fn a_dashboard_is_told_the_configured_thresholds() {
    let server = TestServer::start_with(|config| config.links.loss_percent.weak = 2.5).await;
    let mut dashboard = Dashboard::connect(&server.host).await;
    let told = dashboard
        .hear("a welcome", |message| match message {
            ToDashboard::Welcome { link_thresholds, .. } => Some(*link_thresholds),
            _ => None,
        })
        .await;
    assert_eq!(told, server.app.config.links);
}

#[tokio::test]
async fn requests_stops_and_steps_are_measured() {
    let server = TestServer::start().await;
    server.good("POST", "/api/v1/stop", None).await;
    server.good("GET", "/api/v1/scenes", None).await;
    let text = server.call("GET", "/metrics", None).await.text().await.unwrap();
    let value = |line: &str| -> f64 {
        let found = text.lines().find_map(|found| found.strip_prefix(line));
        found.unwrap_or_else(|| panic!("no {line} in\n{text}")).trim().parse().unwrap()
    };
    assert!(value(r#"covr_stops_pressed_total{lane="http"}"#) >= 1.0);
    assert!(value("covr_stop_to_drive_seconds_count") >= 1.0);
    assert!(value("covr_control_lateness_seconds_count") >= 1.0);
    let scenes =
        r#"covr_http_request_duration_seconds_count{method="GET",route="/api/v1/scenes",status="200"}"#;
    assert!(value(scenes) >= 1.0);
    assert!(text.contains("# HELP covr_pose_age_seconds"), "{text}");
}
