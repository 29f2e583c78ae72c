//! Too little processor time, or memory.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use covr_tests::dashboard::Dashboard;
use covr_tests::eventually;
use covr_tests::process::{Process, Start};
use nix::sys::signal::Signal;
use tempfile::TempDir;

#[tokio::test]
async fn a_process_that_was_halted_counts_its_missed_steps_and_stops_when_it_goes_on() {
    let dir = TempDir::new().unwrap();
    let server = Process::serve(dir.path()).await;
    server.arm().await;
    let missed = server.metric("covr_control_missed_deadlines_total").await;
    server.signal(Signal::SIGSTOP);
    let pressed = server.stop();
    let halted = async {
        // As long as the fault lasts: three quarters of what the stop's lane waits for.
        tokio::time::sleep(Duration::from_millis(750)).await;
        server.signal(Signal::SIGCONT);
    };
    tokio::join!(pressed, halted);
    server.mode("latched_stop").await;
    assert!(server.metric("covr_control_missed_deadlines_total").await > missed);
}

#[tokio::test]
async fn stops_are_acknowledged_while_busy_threads_take_every_core() {
    let dir = TempDir::new().unwrap();
    let server = Process::serve(dir.path()).await;
    let enough = Arc::new(AtomicBool::new(false));
    let cores = std::thread::available_parallelism().unwrap().get();
    let busy: Vec<_> = (0..4 * cores)
        .map(|_| {
            let enough = enough.clone();
            std::thread::spawn(move || {
                while !enough.load(Ordering::Relaxed) {
                    std::hint::spin_loop();
                }
            })
        })
        .collect();
    for _ in 0..10 {
        server.stop().await;
        server.mode("latched_stop").await;
        eventually("the reset is accepted", || async {
            let (status, _) = server.call("POST", "/api/v1/reset", Some("{\"reason\": \"looked\"}")).await?;
            (status == 200).then_some(())
        })
        .await;
    }
    enough.store(true, Ordering::Relaxed);
    for thread in busy {
        thread.join().unwrap();
    }
}

#[tokio::test]
async fn with_little_memory_it_stops_or_ends_and_is_never_armed_again_by_itself() {
    let dir = TempDir::new().unwrap();
    let server = Process::serve(dir.path()).await;
    let usual_kb = server.memory_kb("VmPeak");
    server.kill_9();
    let little = format!("--as={}", (usual_kb * 1024.0) as u64 + 64_000_000);
    let env = [("COVR_DASHBOARDS__MOST", "300")];
    let server = Process::serve_with(dir.path(), Start { limits: &[&little], env: &env }).await;
    server.arm().await;
    let mut deaf = Vec::new();
    for _ in 0..60 {
        deaf.push(Dashboard::connect(&server.host()).await);
    }
    let long = format!("{{\"reason\": \"{}\"}}", "x".repeat(500_000));
    for _ in 0..20 {
        // Refused or not: what matters is what it does with the memory meanwhile.
        server.call("POST", "/api/v1/home", Some(&long)).await;
    }
    // Where the allocator found nothing the process is gone, and the controller's own timeout has stopped the machine.
    let survived = server.call("GET", "/healthz", None).await.is_some();
    if survived {
        server.stop().await;
        server.mode("latched_stop").await;
    }
    server.kill_9();
    let server = Process::serve(dir.path()).await;
    server.mode(if survived { "latched_stop" } else { "disarmed" }).await;
}
