//! Moving the column by hand over a dashboard's socket: one hand at a time, and it goes with its dashboard.

use covr_tests::dashboard::Dashboard;
use covr_tests::server::TestServer;
use covr_wire::dashboard::{
    Activity, FromDashboard, JogAim, MachineRequest, Mode, Outcome, Snapshot, ToDashboard,
};

const ALONG: Option<JogAim> = Some(JogAim::Along([1.0, 1.0]));

async fn answer(dashboard: &mut Dashboard, wanted: u32) -> (Outcome, String) {
    dashboard
        .hear("the answer", |m| match m {
            ToDashboard::Answer { request_id, outcome, detail, .. } if *request_id == wanted => {
                Some((*outcome, detail.clone()))
            }
            _ => None,
        })
        .await
}

async fn jog(dashboard: &mut Dashboard, request_id: u32, to: Option<JogAim>) -> (Outcome, String) {
    dashboard.say(&FromDashboard::Jog { request_id, to, speed_mps: 0.1 }).await;
    answer(dashboard, request_id).await
}

async fn state(dashboard: &mut Dashboard, what: &str, is: impl Fn(&Snapshot) -> bool) {
    dashboard.hear(what, |m| matches!(m, ToDashboard::Snapshot(s) if is(s)).then_some(())).await;
}

async fn ready(dashboard: &mut Dashboard) {
    dashboard
        .say(&FromDashboard::Request { request_id: 1, request: MachineRequest::Home, reason: None })
        .await;
    assert_eq!(answer(dashboard, 1).await.0, Outcome::Accepted);
    state(dashboard, "ready", |s| s.mode == Mode::Ready).await;
}

/// Order until one is taken: in the first second of `ready` none is.
async fn hold(dashboard: &mut Dashboard, from: u32) -> u32 {
    for request_id in from.. {
        if jog(dashboard, request_id, ALONG).await.0 == Outcome::Accepted {
            return request_id;
        }
    }
    unreachable!("numbers do not end")
}

#[tokio::test]
async fn one_hand_at_a_time_moves_the_column_and_it_rests_when_orders_stay_away() {
    let server = TestServer::start().await;
    let (mut ada, mut bob) = (Dashboard::connect(&server.host).await, Dashboard::connect(&server.host).await);
    let (outcome, why) = jog(&mut ada, 2, ALONG).await;
    assert!(outcome == Outcome::Refused && why.contains("home first"), "{why}");
    ready(&mut ada).await;
    let last = hold(&mut ada, 10).await;
    let (outcome, why) = jog(&mut bob, 3, ALONG).await;
    assert!(outcome == Outcome::Refused && why.contains("moves the column now"), "{why}");
    state(&mut ada, "jogged", |s| s.column.activity == Activity::Jogged).await;
    state(&mut ada, "at rest", |s| s.column.activity == Activity::Ready && s.column.velocity_mps == [0.0; 2])
        .await;
    assert_eq!(jog(&mut bob, 4, ALONG).await.0, Outcome::Accepted);
    assert_eq!(jog(&mut bob, 5, None).await.0, Outcome::Accepted);
    assert_eq!(jog(&mut ada, last + 1, ALONG).await.0, Outcome::Accepted, "let go, it is anybody's");
}

#[tokio::test]
async fn a_hand_goes_with_its_dashboard() {
    let server = TestServer::start().await;
    let (mut ada, mut bob) = (Dashboard::connect(&server.host).await, Dashboard::connect(&server.host).await);
    ready(&mut ada).await;
    hold(&mut ada, 10).await;
    drop(ada);
    bob.hear("the end of it", |m| match m {
        ToDashboard::Event(e) if e.kind == "jog_ended" => Some(()),
        _ => None,
    })
    .await;
    state(&mut bob, "at rest", |s| s.column.velocity_mps == [0.0; 2]).await;
}

#[tokio::test]
async fn what_is_no_order_is_refused_in_words() {
    let server = TestServer::start().await;
    let mut dashboard = Dashboard::connect(&server.host).await;
    ready(&mut dashboard).await;
    for (request_id, order, expected) in [
        (20, r#"{"along": [0, 0]}, "speed_mps": 0.1"#, "a way or a place"),
        (21, r#"{"along": [1, 0]}, "speed_mps": 9"#, "up to 1.10 m/s"),
        (22, r#"{"place": [9, 9]}, "speed_mps": 0.1"#, "outside the travel"),
        (23, r#"{"towards": [1, 0]}, "speed_mps": 0.1"#, "towards"),
    ] {
        dashboard.say_text(&format!(r#"{{"type": "jog", "request_id": {request_id}, "to": {order}}}"#)).await;
        let (outcome, why) = answer(&mut dashboard, request_id).await;
        assert!(outcome == Outcome::Refused && why.contains(expected), "{order}: {why}");
    }
}

#[tokio::test]
async fn an_arena_is_confirmed_clear_by_somebody_who_looked() {
    let server = TestServer::start().await;
    let first = server.good("POST", "/api/v1/arena/clear", None).await;
    assert_eq!(first["outcome"], "accepted");
    assert_eq!(server.good("POST", "/api/v1/arena/clear", None).await["outcome"], "already_so");
    let state = server.good("GET", "/api/v1/state", None).await;
    assert_eq!(state["rules"][15]["why"]["id"], "arena_accounted_for");
}
