//! How late the control loop wakes, against a bare thread that sleeps at the same rate beside it.
//!
//! The server's histogram has the exact mean of the lateness; the machine's notes have every wake, but not the
//! deadline. The deadlines lie on a lattice of whole periods, so the mean places the lattice, and with it every wake.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use covr_server::control::real_time;
use covr_tests::dashboard::Dashboard;
use futures_util::StreamExt;

use crate::bed::{Bed, Tick};
use crate::samples::Samples;
use crate::table::Row;
use crate::{Effort, Known};

/// The rows with nobody watching, and with twenty dashboards.
pub async fn measure(effort: Effort, known: &mut Known) -> Vec<Row> {
    let mut rows = Vec::new();
    for dashboards in [0, 20] {
        let (row, p999) = beside_a_thread(dashboards, effort).await;
        if dashboards == 0 {
            known.lateness_p999_micros = Some(p999);
        }
        rows.push(row);
    }
    rows
}

async fn beside_a_thread(dashboards: usize, effort: Effort) -> (Row, f64) {
    let length = Duration::from_secs(effort.of(60, 2));
    let bed = Bed::start(|_| {}).await;
    bed.arm().await;
    let readers = watch(&bed, dashboards).await;
    tokio::time::sleep(Duration::from_secs(1)).await;

    let (period, priority) = (bed.period(), bed.app.config.control.priority);
    let quit = Arc::new(AtomicBool::new(false));
    let bare = std::thread::spawn({
        let quit = quit.clone();
        move || sleeper(period, priority, &quit)
    });
    while bed.ticks.try_recv().is_ok() {}
    let before = lateness_so_far(&bed);
    tokio::time::sleep(length).await;
    let ticks: Vec<Tick> = bed.ticks.try_iter().collect();
    let after = lateness_so_far(&bed);
    quit.store(true, Ordering::Release);
    let bare = tokio::task::spawn_blocking(move || bare.join().unwrap()).await.unwrap();
    for reader in &readers {
        reader.abort();
    }
    let scheduling = bed.app.control.published().control_loop.scheduling.clone();
    bed.end().await;

    let mean_secs = (after.0 - before.0) / (after.1 - before.1);
    let wakes = latenesses(&ticks, period.as_secs_f64(), mean_secs);
    let (p999, beside) = (wakes.percentile(0.999), bare.percentile(0.999));
    let row = Row {
        what: format!("lateness of the control loop, {dashboards} dashboards"),
        figure: format!("99.9th percentile {p999:.0} us, median {:.0} us", wakes.median()),
        beside: format!(
            "bare sleeping thread: 99.9th percentile {beside:.0} us, median {:.0} us",
            bare.median()
        ),
        ratio: format!("{:.2}", p999 / beside),
        limit: "within 2 times the bare thread".into(),
        met: Some(p999 <= 2.0 * beside),
        how: format!("{} and {} wakes in the same {length:?}; {scheduling}", wakes.count(), bare.count()),
    };
    (row, p999)
}

/// Dashboards that read everything.
async fn watch(bed: &Bed, dashboards: usize) -> Vec<tokio::task::JoinHandle<()>> {
    let mut readers = Vec::new();
    for _ in 0..dashboards {
        let mut dashboard = Dashboard::connect(&bed.host).await;
        readers.push(tokio::spawn(async move { while let Some(Ok(_)) = dashboard.socket.next().await {} }));
    }
    readers
}

/// The same waiting as the control loop's, scheduled alike, and nothing else; half a period aside from nothing.
fn sleeper(period: Duration, priority: u8, quit: &AtomicBool) -> Samples {
    real_time::ask(Some(priority));
    let mut late = Samples::default();
    let mut deadline = Instant::now() + period;
    while !quit.load(Ordering::Acquire) {
        std::thread::sleep(deadline.saturating_duration_since(Instant::now()));
        let by = Instant::now().saturating_duration_since(deadline);
        late.add(by.as_secs_f64() * 1e6);
        deadline += period;
        if by > period {
            deadline += period * (by.as_nanos() / period.as_nanos()) as u32;
        }
    }
    late
}

/// Sum in seconds and count of the server's histogram.
fn lateness_so_far(bed: &Bed) -> (f64, f64) {
    let text = bed.app.prometheus.render();
    let value = |name: &str| -> f64 {
        let line = text.lines().find_map(|line| line.strip_prefix(name)).expect("the histogram is there");
        line.trim().parse().unwrap()
    };
    (value("covr_control_lateness_seconds_sum "), value("covr_control_lateness_seconds_count "))
}

/// Each wake's lateness, us, with the lattice placed so that the mean is the given one.
fn latenesses(ticks: &[Tick], period_secs: f64, mean_secs: f64) -> Samples {
    let Some(first) = ticks.first() else { return Samples::default() };
    let mut at = 0.0;
    let mut offsets = Vec::with_capacity(ticks.len());
    for tick in ticks {
        let mut offset = (tick.read - first.read).as_secs_f64() - at;
        // After a stall the loop skips whole periods; the wake that stalled is late by all of them.
        offsets.push(offset);
        while offset > period_secs {
            offset -= period_secs;
            at += period_secs;
        }
        at += period_secs;
    }
    let shift = mean_secs - offsets.iter().sum::<f64>() / offsets.len() as f64;
    offsets.into_iter().map(|offset| (offset + shift).max(0.0) * 1e6).collect()
}
