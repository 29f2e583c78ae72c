//! `covr commission` walks a real machine through its first motion; without that it is not armed.

use std::io::Write;
use std::process::{Command, Output, Stdio};

use covr_engine::mode::Mode;
use covr_server::config::{GameMasterNeeded, MachineKind};
use covr_tests::process::program;
use covr_tests::server::TestServer;
use serde_json::json;
use tempfile::TempDir;

/// A server that takes its simulated machine for a real one.
async fn real_machine() -> TestServer {
    TestServer::start_on_a_simulation(TempDir::new().unwrap(), |config| {
        config.machine.kind = MachineKind::RoboClaw;
        config.safety.game_master = GameMasterNeeded::Never;
    })
    .await
}

/// `covr commission` with these answers.
async fn commission(server: &TestServer, answers: &str) -> Output {
    let (url, answers) = (format!("http://{}", server.host), answers.to_owned());
    let walk = move || {
        let mut child = Command::new(program())
            .args(["commission", "--url", &url])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        // A program that ended before the last question reads no further.
        let _ = child.stdin.take().unwrap().write_all(answers.as_bytes());
        child.wait_with_output().unwrap()
    };
    tokio::task::spawn_blocking(walk).await.unwrap()
}

#[tokio::test]
async fn a_real_machine_is_armed_after_it_was_walked_through_its_first_motion() {
    let server = real_machine().await;
    let refused = server.refused(409, "POST", "/api/v1/arm", None).await;
    assert!(refused.detail.contains("not commissioned"), "{refused:?}");
    let done = commission(&server, &format!("Ada\n12.5\n{}", "yes\n".repeat(15))).await;
    let said = String::from_utf8_lossy(&done.stdout);
    assert!(done.status.success(), "{said}\n{}", String::from_utf8_lossy(&done.stderr));
    let stored = server.good("GET", "/api/v1/commissionings", None).await;
    assert_eq!((&stored[0]["author"], &stored[0]["load_kg"]), (&json!("Ada"), &json!(12.5)));
    for braking_mps2 in stored[0]["braking_mps2"].as_array().unwrap() {
        let braking_mps2 = braking_mps2.as_f64().unwrap();
        assert!((2.3..2.9).contains(&braking_mps2), "the simulated brake does 2.5 m/s2: {stored}");
    }
    server.good("POST", "/api/v1/arm", None).await;
    server.mode(Mode::Following).await;
}

#[tokio::test]
async fn a_no_ends_it_nothing_is_stored_and_nothing_moves() {
    let server = real_machine().await;
    for (answers, expected) in [
        ("", "nobody answers"),
        ("Ada\nheavy\n", "expected a number of kilograms"),
        ("Ada\n12\nno\n", "the wired stop"),
        ("Ada\n12\nyes\nmaybe\n", "the look into the arena"),
    ] {
        let done = commission(&server, answers).await;
        let complaint = String::from_utf8_lossy(&done.stderr);
        assert!(!done.status.success() && complaint.contains(expected), "{answers:?}: {complaint}");
    }
    assert_eq!(server.good("GET", "/api/v1/commissionings", None).await, json!([]));
    assert_eq!(server.good("GET", "/api/v1/state", None).await["column"]["velocity_mps"], json!([0.0, 0.0]));
}

#[tokio::test]
async fn what_is_handed_in_without_the_motion_is_refused() {
    let server = real_machine().await;
    let all = ["wired_stop", "arena_clear", "link", "home", "directions", "stop_lanes", "brake"];
    let body = |steps: &[&str], load_kg: f64, begun_at: &str| {
        json!({ "begun_at": begun_at, "load_kg": load_kg, "steps": steps }).to_string()
    };
    let begun = "2026-01-01T00:00:00Z";
    let post = "/api/v1/commissionings";
    let refused = server.refused(409, "POST", post, Some(&body(&all[1..], 12.0, begun))).await;
    assert!(refused.detail.contains("the wired stop is missing"), "{refused:?}");
    let refused = server.refused(409, "POST", post, Some(&body(&all, 12.0, begun))).await;
    assert!(refused.detail.contains("no stop from"), "{refused:?}");
    assert_eq!(
        server.refused(422, "POST", post, Some(&body(&all, -1.0, begun))).await.errors[0].path,
        "load_kg"
    );
    let refused = server.refused(422, "POST", post, Some(&body(&all, 12.0, "yesterday"))).await;
    assert_eq!(refused.errors[0].path, "begun_at");
    assert_eq!(server.good("GET", post, None).await, json!([]));
}
