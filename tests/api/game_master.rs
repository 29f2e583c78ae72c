//! R11 over HTTP and WebSockets: a game master's dashboard must be connected to arm.

use covr_engine::mode::Mode;
use covr_server::access::Role;
use covr_server::config::GameMasterNeeded;
use covr_tests::dashboard::Dashboard;
use covr_tests::eventually;
use covr_tests::server::TestServer;
use covr_wire::dashboard::{FromDashboard, MachineRequest, Outcome, ToDashboard};

async fn homed_server() -> TestServer {
    let server = TestServer::start_with(|config| config.safety.game_master = GameMasterNeeded::Always).await;
    server.good("POST", "/api/v1/home", None).await;
    server.mode(Mode::Ready).await;
    server
}

/// Wait for the status of R11.
async fn rule_11(server: &TestServer, status: &str) {
    eventually(&format!("R11 is {status}"), || async {
        let state = server.good("GET", "/api/v1/state", None).await;
        (state["rules"][10]["status"] == status).then_some(())
    })
    .await;
}

#[tokio::test]
async fn arming_needs_a_game_masters_dashboard_and_one_that_goes_is_recorded() {
    let server = homed_server().await;
    rule_11(&server, "limiting").await;
    let refused = server.refused(409, "POST", "/api/v1/arm", None).await;
    assert!(refused.detail.contains("game master"), "{refused:?}");
    let state = server.good("GET", "/api/v1/state", None).await;
    let arm = state["requests"].as_array().unwrap().iter().find(|r| r["request"] == "arm").unwrap();
    assert_eq!(arm["why"]["id"], "game_master_absent", "the button says why: {arm}");

    let mut dashboard = Dashboard::connect(&server.host).await;
    rule_11(&server, "clear").await;
    dashboard
        .say(&FromDashboard::Request { request_id: 1, request: MachineRequest::Arm, reason: None })
        .await;
    let outcome = dashboard
        .hear("the answer", |m| match m {
            ToDashboard::Answer { request_id: 1, outcome, .. } => Some(*outcome),
            _ => None,
        })
        .await;
    assert_eq!(outcome, Outcome::Accepted);
    drop(dashboard);
    rule_11(&server, "breached").await;
    assert_eq!(server.good("GET", "/api/v1/state", None).await["mode"], "following");
    let event = eventually("the event", || async {
        let events = server.good("GET", "/api/v1/events?kind=rule_breached", None).await;
        events.as_array().unwrap().iter().find(|event| event["detail"]["rule"] == "R11").cloned()
    })
    .await;
    assert_eq!(event["detail"]["why"]["id"], "game_master_absent", "{event}");
    let refusals = server.good("GET", "/api/v1/events?kind=request_refused", None).await;
    assert_eq!(refusals[0]["detail"]["why"]["id"], "game_master_absent", "{refusals}");
}

#[tokio::test]
async fn a_dashboard_that_answers_no_ping_is_no_game_master() {
    let server = homed_server().await;
    // It reads nothing, so that no ping is answered.
    let silent = Dashboard::connect(&server.host).await;
    rule_11(&server, "clear").await;
    rule_11(&server, "limiting").await;
    server.refused(409, "POST", "/api/v1/arm", None).await;
    drop(silent);
}

#[tokio::test]
async fn whoever_may_not_arm_is_no_game_master() {
    let server = homed_server().await;
    let (observer, master) = (server.token(Role::Observer).await, server.token(Role::GameMaster).await);
    let mut looks_on = Dashboard::connect_with(&server.host, Some(&observer)).await.unwrap();
    looks_on.hear("a snapshot", |m| matches!(m, ToDashboard::Snapshot(_)).then_some(())).await;
    let arm = async || server.call_with(Some(&master), "POST", "/api/v1/arm", None).await.status().as_u16();
    assert_eq!(arm().await, 409);
    let _runs = Dashboard::connect_with(&server.host, Some(&master)).await.unwrap();
    eventually("armed", || async { (arm().await == 200).then_some(()) }).await;
}
