//! The real program for a long time, with everything going on at once and faults on: `make soak`. A walker whose link is
//! cut now and then, dashboards that come and go or read nothing, an operator who stops by every lane, resets, arms,
//! changes scenes and priors. Afterwards: no stop was missed, every acknowledged write is there, and memory stays.
//!
//! `COVR_SOAK_SECS` says for how long; without it, long enough to see that everything runs.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the report")]

mod memory;
mod operator;
mod visitors;

use std::time::{Duration, Instant};

use covr_tests::SOON;
use covr_tests::process::{Process, Start};
use nix::sys::signal::Signal;
use sqlx::{Connection, SqliteConnection};
use tempfile::TempDir;

use memory::Memory;
use operator::{Button, Operator};

#[tokio::test(flavor = "multi_thread")]
async fn with_faults_on_no_stop_is_missed_no_acknowledged_write_is_lost_and_memory_stays() {
    let secs: f64 = std::env::var("COVR_SOAK_SECS").map_or(SHORT_SECS, |text| {
        text.parse().unwrap_or_else(|_| panic!("COVR_SOAK_SECS: found {text}, expected a number of seconds"))
    });
    let dir = TempDir::new().unwrap();
    let button = Button::new(dir.path());
    let inputs = button.configuration();
    let env = [("COVR_SAFETY__INPUTS", inputs.as_str()), ("COVR_DASHBOARDS__MOST", "64")];
    let server = Process::serve_with(dir.path(), Start { env: &env, ..Start::default() }).await;
    let others = [
        tokio::spawn(visitors::walk(server.host())),
        tokio::spawn(visitors::look_on(server.host())),
        tokio::spawn(visitors::look_away(server.host())),
    ];

    let mut operator = Operator::new(&server, button);
    let mut memory = Memory::default();
    let began = Instant::now();
    while began.elapsed().as_secs_f64() < secs {
        operator.act().await;
        memory.note(began.elapsed(), server.memory_kb("VmRSS"));
    }
    let operator = operator.done();
    for other in &others {
        other.abort();
    }
    eprintln!(
        "{secs:.0} s: stops {:?}, {} scenes stored, {} priors set; {memory}",
        operator.stops,
        operator.scenes.len(),
        operator.priors
    );
    let dropped = server.metric("covr_events_dropped_total").await;
    assert_eq!(dropped, 0.0, "events were dropped");
    assert_eq!(server.metric("covr_stops_unacknowledged_total").await, 0.0);
    server.kill_9();

    let url = format!("sqlite:{}", dir.path().join("covr.sqlite").display());
    let mut store = SqliteConnection::connect(&url).await.unwrap();
    for (id, name) in &operator.scenes {
        let (document,): (String,) =
            sqlx::query_as("SELECT document FROM scene_versions WHERE scene_id = ? AND version = 1")
                .bind(id)
                .fetch_one(&mut store)
                .await
                .unwrap_or_else(|why| panic!("the acknowledged scene {id} is not there: {why}"));
        assert!(document.contains(name.as_str()), "scene {id} is another: {document}");
    }
    let (changes,): (i64,) =
        sqlx::query_as("SELECT count(*) FROM prior_changes").fetch_one(&mut store).await.unwrap();
    assert!(changes >= operator.priors, "{changes} changes of priors, {} acknowledged", operator.priors);
    for (lane, pressed) in &operator.stops {
        let (stored,): (i64,) = sqlx::query_as(
            "SELECT count(*) FROM events WHERE kind = 'stop_pressed' AND json_extract(detail, '$.by') = ?",
        )
        .bind(*lane)
        .fetch_one(&mut store)
        .await
        .unwrap();
        assert!(stored >= *pressed, "{stored} stops by {lane} in the record, {pressed} pressed");
    }
    assert!(operator.stops.values().sum::<i64>() > 0, "nobody stopped anything");
    drop(store);

    // It comes back as it ended.
    let server = Process::serve_with(dir.path(), Start { env: &env, ..Start::default() }).await;
    server.mode("latched_stop").await;
    server.signal(Signal::SIGTERM);
    let ended = tokio::time::timeout(SOON, server.exit_code()).await.expect("it ends");
    assert_eq!(ended, Some(0));
    memory.judge();
}

/// In `make test`.
const SHORT_SECS: f64 = 30.0;
/// Between looks that wait for nothing else.
const BREATH: Duration = Duration::from_millis(100);
