//! What survives: kill -9 of the real program in the middle of a session, the latch, the command line's refusals.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the report")]

use std::process::Command;
use std::time::Duration;

use covr_tests::process::{Process, program};
use covr_tests::{HOMED, eventually_within};
use nix::sys::signal::Signal;
use tempfile::TempDir;

#[tokio::test]
async fn after_kill_9_in_a_session_everything_acknowledged_is_there_and_the_machine_is_disarmed() {
    let dir = TempDir::new().unwrap();
    let server = Process::serve(dir.path()).await;
    server.good("POST", "/api/v1/home", None).await;
    eventually_within(HOMED, "homed", || async {
        let state = server.good("GET", "/api/v1/state", None).await;
        (state["mode"] == "ready").then_some(())
    })
    .await;
    server.good("POST", "/api/v1/arm", None).await;
    server.good("PATCH", "/api/v1/priors", Some("{\"lamp\": 0.25}")).await;
    let scene = server.good("GET", "/api/v1/scenes/1", None).await.to_string();
    let stored = server.good("POST", "/api/v1/scenes", Some(&scene)).await;
    server.kill_9();

    let server = Process::serve(dir.path()).await;
    let state = server.good("GET", "/api/v1/state", None).await;
    assert_eq!(state["mode"], "disarmed");
    let lamp = state["objects"].as_array().unwrap().iter().find(|o| o["id"] == "lamp").unwrap().clone();
    assert_eq!(lamp["prior"], 0.25);
    let sessions = server.good("GET", "/api/v1/sessions", None).await;
    assert_eq!(sessions.as_array().unwrap().len(), 1);
    assert_eq!(sessions[0]["how"], "interrupted");
    assert!(sessions[0]["ended_at"].is_string());
    let changes = server.good("GET", "/api/v1/priors/changes", None).await;
    assert_eq!((&changes[0]["author"], &changes[0]["to"]), (&"game master".into(), &0.25.into()));
    let path = format!("/api/v1/scenes/{}", stored["id"]);
    assert_eq!(server.good("GET", &path, None).await["name"], "Four corners and a desk");
    let events = server.good("GET", "/api/v1/events", None).await.to_string();
    assert!(events.contains("arm by game master"), "{events}");
}

#[tokio::test]
async fn a_latched_stop_survives_kill_9_and_its_reset_does_too() {
    let dir = TempDir::new().unwrap();
    let server = Process::serve(dir.path()).await;
    server.good("POST", "/api/v1/stop", Some("{\"reason\": \"smoke\"}")).await;
    server.kill_9();

    let server = Process::serve(dir.path()).await;
    let state = server.good("GET", "/api/v1/state", None).await;
    assert_eq!(state["mode"], "latched_stop");
    assert!(state["stop"]["reason"].as_str().unwrap().contains("smoke"), "{}", state["stop"]);
    server.good("POST", "/api/v1/reset", Some("{\"reason\": \"only steam\"}")).await;
    server.kill_9();

    let server = Process::serve(dir.path()).await;
    assert_eq!(server.good("GET", "/api/v1/state", None).await["mode"], "disarmed");
}

#[tokio::test]
async fn sigusr1_stops_and_sigterm_ends_with_code_0() {
    let dir = TempDir::new().unwrap();
    let server = Process::serve(dir.path()).await;
    server.signal(Signal::SIGUSR1);
    eventually_within(Duration::from_secs(10), "stopped by the signal", || async {
        let state = server.good("GET", "/api/v1/state", None).await;
        (state["mode"] == "latched_stop").then_some(())
    })
    .await;
    server.signal(Signal::SIGTERM);
    assert_eq!(server.exit_code().await, Some(0));
}

#[test]
fn the_command_line_refuses_what_it_must() {
    let dir = TempDir::new().unwrap();
    let file = dir.path().join("covr.toml");
    std::fs::write(&file, "[control]\nrate_herz = 250\n").unwrap();
    let run = |arguments: &[&str]| {
        let done = Command::new(program()).args(arguments).current_dir(dir.path()).output().unwrap();
        (done.status.code(), String::from_utf8(done.stderr).unwrap())
    };
    let (code, words) = run(&["serve", "--config", file.to_str().unwrap()]);
    assert_eq!(code, Some(2));
    assert!(words.contains("unknown key `control.rate_herz`; did you mean `control.rate_hz`?"), "{words}");
    let (code, words) = run(&["serve", "--bind", "0.0.0.0:7878"]);
    assert_eq!(code, Some(2));
    assert!(words.contains("--insecure-lan"), "{words}");
    assert!(!dir.path().join("covr.sqlite").exists());

    let scene = dir.path().join("scene.json");
    std::fs::write(&scene, "{\n \"schema\": \"covr.scene.v1\",\n \"name\": 3\n}").unwrap();
    let (code, words) = run(&["check", scene.to_str().unwrap()]);
    assert_eq!(code, Some(1));
    assert!(words.contains("line 3") && words.contains("$.name"), "{words}");
}
