//! What survives: kill -9 of the real program in the middle of a session, the latch, the command line's refusals.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the report")]

mod tokens;

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
async fn after_kill_9_in_a_recording_everything_up_to_the_last_second_is_there() {
    let dir = TempDir::new().unwrap();
    let server = Process::serve(dir.path()).await;
    server.good("POST", "/api/v1/home", None).await;
    eventually_within(HOMED, "homed", || async {
        let state = server.good("GET", "/api/v1/state", None).await;
        (state["mode"] == "ready").then_some(())
    })
    .await;
    server.good("POST", "/api/v1/arm", None).await;
    let last_seen = eventually_within(HOMED, "four seconds are recorded", || async {
        let state = server.good("GET", "/api/v1/state", None).await;
        let sessions = server.good("GET", "/api/v1/sessions", None).await;
        (sessions[0]["recorded_frames"].as_u64()? >= 120).then_some(state["at_micros"].as_i64().unwrap())
    })
    .await;
    server.kill_9();

    let server = Process::serve(dir.path()).await;
    let session = server.good("GET", "/api/v1/sessions/1", None).await;
    assert_eq!(session["how"], "interrupted");
    let frames = server.good("GET", "/api/v1/sessions/1/frames", None).await;
    let at: Vec<i64> =
        frames["frames"].as_array().unwrap().iter().map(|f| f["at_micros"].as_i64().unwrap()).collect();
    assert!(at.len() >= 120 && at.is_sorted(), "{at:?}");
    let (first, last) = (session["first_micros"].as_i64().unwrap(), session["last_micros"].as_i64().unwrap());
    // One chunk of a second may be in the making, and one on its way to the disk.
    let missing = last_seen - at.last().unwrap();
    assert!(missing < 2_500_000, "{missing} us of the recording are missing");
    assert_eq!(last, *at.last().unwrap(), "nothing was heard later");
    let length = session["length_secs"].as_f64().unwrap();
    assert!((length - (last - first) as f64 * 1e-6).abs() < 1e-5, "{length} s, {first} to {last} us");
    let gaps = at.windows(2).map(|two| two[1] - two[0]).max();
    let dropped = session["dropped_frames"].as_u64().unwrap();
    assert!(gaps < Some(1_000_000) || dropped > 0, "a gap of {gaps:?} us that nobody counted");
    // The next session of the same database is recorded as its own.
    assert_eq!(server.good("GET", "/api/v1/sessions/1/events", None).await[0]["detail"]["to"], "following");
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
    std::fs::write(&scene, "{\n \"schema\": \"covr.scene.v2\",\n \"name\": 3\n}").unwrap();
    let (code, words) = run(&["check", scene.to_str().unwrap()]);
    assert_eq!(code, Some(1));
    assert!(words.contains("line 3") && words.contains("$.name"), "{words}");
}
