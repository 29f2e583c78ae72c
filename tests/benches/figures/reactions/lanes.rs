//! Stops by every lane, through the real server, with somebody walking and dashboards looking on.

use std::fs::File;
use std::io::Write as _;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use covr_engine::mode::{Mode, RequestKind};
use covr_server::config::{Input, InputKind, Level};
use covr_server::serve::{stop_at_signal, stop_signal};
use covr_study::random::Random;
use covr_tests::dashboard::Dashboard;
use covr_wire::dashboard::FromDashboard;
use futures_util::{SinkExt, StreamExt};
use nix::pty::openpty;
use nix::sys::signal::{Signal, kill};
use nix::unistd::{Pid, ttyname};
use tokio_tungstenite::tungstenite::Message;

use super::row;
use crate::Effort;
use crate::bed::{Bed, Tick};
use crate::process::walk;
use crate::samples::Samples;
use crate::table::Row;

/// A row for each lane.
pub async fn measure(effort: Effort) -> Vec<Row> {
    let (warm_up, stops) = effort.of((10, 1_000), (2, 10));
    let line = openpty(None, None).unwrap();
    let source: PathBuf = ttyname(&line.slave).unwrap();
    let mut button = File::from(line.master);
    button.write_all(b"1\n").unwrap();
    let bed = Bed::start(|config| {
        let (name, kind, active) = ("button".into(), InputKind::Stop, Level::Low);
        config.safety.inputs = vec![Input { name, kind, source, active, heartbeat_timeout_secs: 10.0 }];
    })
    .await;
    button.write_all(b"1\n").unwrap();
    tokio::spawn(stop_at_signal(bed.app.clone(), stop_signal().unwrap()));
    bed.arm().await;
    bed.ask(RequestKind::Disarm, None).await;
    let walker = walk(&bed.host, 1).await;
    let mut readers = Vec::new();
    for _ in 0..DASHBOARDS {
        let mut dashboard = Dashboard::connect(&bed.host).await;
        readers.push(tokio::spawn(async move { while let Some(Ok(_)) = dashboard.socket.next().await {} }));
    }
    let http = reqwest::Client::new();
    let url = format!("http://{}/api/v1/stop", bed.host);
    // What it is sent is read, or it would be let go.
    let (mut page, mut told) = Dashboard::connect(&bed.host).await.socket.split();
    readers.push(tokio::spawn(async move { while let Some(Ok(_)) = told.next().await {} }));
    let words = serde_json::to_string(&FromDashboard::Stop { request_id: 1, reason: None }).unwrap();

    let mut rows = Vec::new();
    for lane in ["WebSocket, also of the dashboard's key", "HTTP", "SIGUSR1", "digital input (serial line)"] {
        let mut random = Random::seeded(2);
        let (mut took, mut loop_late) = (Samples::default(), LoopLateness::new(bed.period()));
        for stop in 0..(warm_up + stops) {
            // The heartbeat, too.
            button.write_all(b"1\n").unwrap();
            // Homed it stays; homing anew would wait for the walker.
            bed.ask(RequestKind::Arm, None).await;
            bed.mode(Mode::Following).await;
            tokio::time::sleep(Duration::from_micros(random.between(0.0, 8_000.0) as u64)).await;
            bed.ticks.try_iter().for_each(|tick| loop_late.note(&tick));
            let pressed = Instant::now();
            match lane {
                "HTTP" => assert!(http.post(&url).send().await.unwrap().status().is_success()),
                "SIGUSR1" => kill(Pid::this(), Signal::SIGUSR1).unwrap(),
                "digital input (serial line)" => button.write_all(b"0\n").unwrap(),
                _ => page.send(Message::text(&words)).await.unwrap(),
            }
            bed.mode(Mode::LatchedStop).await;
            let brakes = |tick: &Tick| tick.brakes && tick.written > pressed;
            let mut noted = bed.ticks.try_iter().inspect(|tick| loop_late.note(tick));
            let braked = noted.find(brakes).expect("it is latched after the braking command");
            if stop >= warm_up {
                took.add((braked.written - pressed).as_secs_f64() * 1e6);
            }
            button.write_all(b"1\n").unwrap();
            bed.ask(RequestKind::Reset, Some("benchmark")).await;
            bed.mode(Mode::Disarmed).await;
        }
        let period = bed.period().as_secs_f64() * 1e6;
        let how = format!(
            "{stops} stops at random moments, {warm_up} to warm up; ideal machine, one person at 90 Hz, {DASHBOARDS} dashboards that \
             read everything, recording on; load average of the whole computer {}",
            load_average()
        );
        let late = loop_late.micros.percentile(0.999);
        let limit = "2 periods and the loop's own lateness";
        let mut row = row(&format!("stop: {lane}"), &took, 2.0 * period + late, limit, how);
        row.beside = format!("lateness of the control loop in the same run: 99.9th percentile {late:.0} us");
        rows.push(row);
    }
    walker.abort();
    readers.iter().for_each(tokio::task::JoinHandle::abort);
    bed.end().await;
    rows
}

/// Of the last minute, by everything that runs here: other programs' share is part of the load.
fn load_average() -> String {
    let load = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
    load.split(' ').next().unwrap_or("unknown").to_owned()
}

/// How much later than a period each period began after the one before.
struct LoopLateness {
    period: Duration,
    before: Option<Instant>,
    micros: Samples,
}

impl LoopLateness {
    fn new(period: Duration) -> Self {
        Self { period, before: None, micros: Samples::default() }
    }

    fn note(&mut self, tick: &Tick) {
        if let Some(before) = self.before.replace(tick.read) {
            let late = tick.read.saturating_duration_since(before).saturating_sub(self.period);
            self.micros.add(late.as_secs_f64() * 1e6);
        }
    }
}

const DASHBOARDS: usize = 4;
