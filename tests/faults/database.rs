//! A database that is full, read-only, locked, or takes nothing for a while.

use std::io::{Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::process::Command;

use covr_tests::process::{Process, Start, program};
use covr_tests::{HOMED, eventually, eventually_within};
use nix::sys::signal::Signal;
use sqlx::{Connection, SqliteConnection};
use tempfile::TempDir;

/// A database that a server has made and left.
async fn made() -> TempDir {
    let dir = TempDir::new().unwrap();
    let server = Process::serve(dir.path()).await;
    server.signal(Signal::SIGTERM);
    assert_eq!(server.exit_code().await, Some(0));
    dir
}

/// Another program holds the database for itself until this is dropped or rolled back.
async fn locked(dir: &Path) -> SqliteConnection {
    let url = format!("sqlite:{}", dir.join("covr.sqlite").display());
    let mut other = SqliteConnection::connect(&url).await.unwrap();
    sqlx::query("BEGIN EXCLUSIVE").execute(&mut other).await.unwrap();
    other
}

#[tokio::test]
async fn on_a_full_disk_writes_are_refused_a_stop_is_not_and_everything_acknowledged_is_there() {
    let dir = made().await;
    let size = std::fs::metadata(dir.path().join("covr.sqlite")).unwrap().len();
    // No file may grow beyond this, the database's log included.
    let full = format!("--fsize={}", size + 150_000);
    let server = Process::serve_with(dir.path(), Start { limits: &[&full], ..Start::default() }).await;
    let mut scene = server.good("GET", "/api/v1/scenes/1", None).await;
    let mut acknowledged = Vec::new();
    let refusal = loop {
        let name = format!("scene {}", acknowledged.len());
        scene["name"] = name.clone().into();
        let (status, text) = server.call("POST", "/api/v1/scenes", Some(&scene.to_string())).await.unwrap();
        if status != 201 && status != 200 {
            break (status, text);
        }
        let stored: serde_json::Value = serde_json::from_str(&text).unwrap();
        acknowledged.push((stored["id"].as_i64().unwrap(), name));
        assert!(acknowledged.len() < 2_000, "the disk never filled");
    };
    assert!(refusal.0 >= 500 && refusal.1.contains("urn:covr:problem:"), "{refusal:?}");
    server.stop().await;
    server.mode("latched_stop").await;
    server.kill_9();

    let server = Process::serve(dir.path()).await;
    let mode = server.good("GET", "/api/v1/state", None).await["mode"].clone();
    assert!(mode == "disarmed" || mode == "latched_stop", "{mode}");
    for (id, name) in acknowledged {
        assert_eq!(server.good("GET", &format!("/api/v1/scenes/{id}"), None).await["name"], name);
    }
}

#[tokio::test]
async fn with_a_read_only_database_it_does_not_start_and_says_which() {
    let dir = made().await;
    let path = dir.path().join("covr.sqlite");
    // File format write version 3: for SQLite a database that may be read and not written, whoever opens it (a file
    // mode would not keep root from writing).
    let mut file = std::fs::OpenOptions::new().read(true).write(true).open(&path).unwrap();
    let mut head = [0; 16];
    file.read_exact(&mut head).unwrap();
    assert_eq!(&head, b"SQLite format 3\0");
    file.seek(SeekFrom::Start(18)).unwrap();
    file.write_all(&[3]).unwrap();
    drop(file);
    let mut command = Command::new("timeout");
    command.arg("20").arg(program());
    let ended = command.args(["serve", "--bind", "127.0.0.1:0", "--database"]).arg(path).output().unwrap();
    let words = String::from_utf8_lossy(&ended.stderr).into_owned();
    assert_eq!(ended.status.code(), Some(2), "{words}");
    assert!(words.contains("database") && words.contains("readonly"), "{words}");
}

#[tokio::test]
async fn with_a_locked_database_it_stops_and_the_record_catches_up() {
    let dir = TempDir::new().unwrap();
    let server = Process::serve(dir.path()).await;
    let mut other = locked(dir.path()).await;
    server.stop().await;
    server.mode("latched_stop").await;
    let steps = server.metric("covr_control_steps_total").await;
    eventually("the control loop goes on", || async {
        (server.metric("covr_control_steps_total").await > steps + 250.0).then_some(())
    })
    .await;
    sqlx::query("ROLLBACK").execute(&mut other).await.unwrap();
    eventually("the stop is in the record", || async {
        let events = server.good("GET", "/api/v1/events?kind=stop_pressed", None).await;
        (!events.as_array().unwrap().is_empty()).then_some(())
    })
    .await;
    server.kill_9();
    let server = Process::serve(dir.path()).await;
    server.mode("latched_stop").await;
}

#[tokio::test]
async fn a_stalled_writer_in_a_session_costs_records_that_are_counted_and_neither_stop_nor_memory() {
    let dir = TempDir::new().unwrap();
    let server = Process::serve(dir.path()).await;
    server.arm().await;
    let before_kb = server.memory_kb("VmRSS");
    let mut other = locked(dir.path()).await;
    eventually_within(HOMED, "a write is given up and counted", || async {
        (server.metric("covr_store_errors_total").await > 0.0
            || server.metric("covr_recording_dropped_frames_total").await > 0.0)
            .then_some(())
    })
    .await;
    server.stop().await;
    server.mode("latched_stop").await;
    let grown_kb = server.memory_kb("VmRSS") - before_kb;
    assert!(grown_kb < 50_000.0, "{grown_kb} kB more while nothing could be written");
    sqlx::query("ROLLBACK").execute(&mut other).await.unwrap();
    eventually_within(HOMED, "it is written again", || async {
        let (status, _) = server.call("GET", "/readyz", None).await?;
        (status == 200).then_some(())
    })
    .await;
    server.good("PATCH", "/api/v1/priors", Some("{\"lamp\": 0.5}")).await;
}
