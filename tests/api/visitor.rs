//! `covr visitor` against a real server: made up, and recorded.

use covr_engine::mode::Mode;
use covr_server::cli::Visitor;
use covr_server::visitor;
use covr_tests::server::TestServer;
use covr_tests::{HOMED, SOON};

fn options(server: &TestServer) -> Visitor {
    Visitor {
        token: None,
        authority: None,
        trace: None,
        speed: 1.0,
        url: format!("ws://{}", server.host),
        name: "visitor".into(),
        seed: 3,
        trial: None,
        wait_for_server: true,
        arm: false,
    }
}

#[tokio::test]
async fn a_made_up_visitor_homes_arms_and_is_followed() {
    let server = TestServer::start().await;
    let runs = visitor::run(Visitor { arm: true, ..options(&server) });
    let mut runs = std::pin::pin!(runs);
    let served = server.published("the visitor is followed", HOMED, |p| {
        p.snapshot.mode == Mode::Following && p.snapshot.persons.iter().any(|person| person.tracked)
    });
    let served = tokio::select! {
        served = served => served,
        ended = &mut runs => panic!("the visitor ended: {ended:?}"),
    };
    assert!(served.snapshot.persons[0].pose_age_secs < 0.2, "{:?}", served.snapshot.persons[0]);
    let client = covr_tests::eventually("its clock is known", || async {
        server.app.clients.list().into_iter().find(|client| client.rtt_millis.is_some())
    });
    let client = tokio::select! {
        client = client => client,
        ended = &mut runs => panic!("the visitor ended: {ended:?}"),
    };
    assert_eq!((client.name.as_str(), client.convention.as_str(), client.errors), ("visitor", "openxr", 0));
}

#[tokio::test]
async fn a_recorded_visitor_brings_the_scene_of_its_targets() {
    let server = TestServer::start().await;
    let dir = tempfile::TempDir::new().unwrap();
    let trace = dir.path().join("two.jsonl");
    let line = |trial: &str, x_mm: i32| {
        let frames: Vec<String> =
            (0..60).map(|i| format!("[{},{},{},1700,1571,0]", i * 33, x_mm, i * 10)).collect();
        format!(
            r#"{{"dataset":"lab","trial":"{trial}","user":"u1","hz":30,"arena":{{"x":[-2,2],"y":[-2,2]}},"cols":["t_ms","x_mm","y_mm","z_mm","yaw_mrad","pitch_mrad"],"targets":[{{"id":"cup","label":"","x":0.5,"y":1.0,"z":1.0,"r":0.1}}],"goal":"cup","events":{{"reach":1.9}},"frames":[{}]}}"#,
            frames.join(",")
        )
    };
    std::fs::write(&trace, format!("{}\n{}\n", line("T1", -500), line("T2", 500))).unwrap();
    let wanted = Visitor { trace: Some(trace), trial: Some("T2".into()), ..options(&server) };
    let runs = tokio::spawn(visitor::run(wanted));
    let shown = server
        .published("the recorded person", SOON, |p| {
            p.snapshot.objects[0].id == "cup" && p.snapshot.persons.iter().any(|person| person.pose.is_some())
        })
        .await;
    let position = shown.snapshot.persons[0].pose.unwrap().position;
    assert!(
        (position.x() - 2.5).abs() < 1e-6,
        "trial T2 walks at x = 0.5 from the arena's corner: {position:?}"
    );
    // T2 is the last; the programme goes on with T1.
    server
        .published("the next trial", SOON, |p| {
            p.snapshot
                .persons
                .iter()
                .any(|person| person.pose.is_some_and(|pose| (pose.position.x() - 1.5).abs() < 1e-6))
        })
        .await;
    let scenes = server.good("GET", "/api/v1/scenes", None).await;
    assert_eq!(scenes.as_array().unwrap().len(), 2, "the same targets are stored once: {scenes}");
    runs.abort();
}

#[tokio::test]
async fn a_visitor_of_a_stopped_machine_walks_and_leaves_the_stop_to_people() {
    let server = TestServer::start().await;
    server.good("POST", "/api/v1/stop", None).await;
    let runs = tokio::spawn(visitor::run(Visitor { arm: true, ..options(&server) }));
    let seen = server
        .published("the visitor is there", SOON, |p| p.snapshot.persons.iter().any(|person| person.tracked))
        .await;
    assert_eq!(seen.snapshot.mode, Mode::LatchedStop);
    assert!(!runs.is_finished());
    runs.abort();
}
