//! The real program as a process of its own: its memory over minutes with a walking person and a running recording,
//! and the processor time that dashboards cost it.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use covr_tests::client::VrClient;
use covr_tests::dashboard::Dashboard;
use covr_wire::client::Encoding;
use futures_util::{SinkExt, StreamExt};
use reqwest::Client;
use serde_json::{Value, json};
use tempfile::TempDir;
use tokio::task::JoinHandle;
use tokio_tungstenite::tungstenite::Message;

use crate::Effort;
use crate::samples::Samples;
use crate::table::Row;

/// A running `covr serve`, killed when dropped.
pub struct Covr {
    /// `127.0.0.1:port`.
    pub host: String,
    child: Child,
    http: Client,
    _dir: TempDir,
}

/// The rows of memory and processor time.
pub async fn measure(effort: Effort) -> Vec<Row> {
    let Some(program) = program() else {
        let why = "covr is not built: `cargo build --release --package covr-server`, or COVR_BENCH_BIN";
        return vec![
            Row::skipped("resident memory after an hour", MEMORY_LIMIT, why),
            Row::skipped("server's processor time a dashboard", CPU_LIMIT, why),
        ];
    };
    let covr = Covr::serve(&program).await;
    covr.home_and_arm().await;
    let walker = walk(&covr.host, 1).await;
    let rows = vec![
        memory(&covr, effort).await,
        processor(&covr, effort, 1).await,
        processor(&covr, effort, MANY_DASHBOARDS).await,
    ];
    walker.abort();
    rows
}

async fn memory(covr: &Covr, effort: Effort) -> Row {
    let minutes = match std::env::var("COVR_BENCH_MINUTES") {
        Ok(text) => {
            text.parse().unwrap_or_else(|_| panic!("COVR_BENCH_MINUTES: found {text}, expected a number"))
        }
        Err(_) => effort.of(10.0, 0.1),
    };
    let began = Instant::now();
    let mut samples: Vec<(f64, f64)> = Vec::new();
    while began.elapsed().as_secs_f64() < minutes * 60.0 {
        tokio::time::sleep(Duration::from_secs_f64((minutes * 0.3).clamp(0.1, 2.0))).await;
        samples.push((began.elapsed().as_secs_f64() / 60.0, covr.resident_mb()));
    }
    let session = covr.get("/api/v1/state").await["session_id"].clone();
    // Caches and queues fill in the first fifth.
    let settled: Vec<(f64, f64)> = samples.iter().copied().filter(|(at, _)| *at > 0.2 * minutes).collect();
    let (start, slope) = line(&settled);
    let after_an_hour = start + slope * 60.0;
    Row {
        what: "resident memory after an hour".into(),
        figure: format!("{after_an_hour:.1} MB"),
        beside: format!(
            "slope {:+.2} MB an hour; {:.1} MB at the end",
            slope * 60.0,
            settled.last().map_or(f64::NAN, |s| s.1)
        ),
        ratio: format!("{:.2}", after_an_hour / 60.0),
        limit: MEMORY_LIMIT.into(),
        met: Some(after_an_hour < 60.0),
        how: format!(
            "line through {} samples of the last four fifths of {minutes} minutes; one person at 90 Hz, session {session}",
            settled.len()
        ),
    }
}

/// What looks ahead is paid once however many look: one dashboard costs most.
async fn processor(covr: &Covr, effort: Effort, dashboards: usize) -> Row {
    let (rounds, length) = effort.of((3, Duration::from_secs(15)), (1, Duration::from_secs(2)));
    let (mut alone, mut watched) = (Samples::default(), Samples::default());
    for _ in 0..rounds {
        alone.add(covr.cores_over(length).await);
        let mut readers = Vec::new();
        for _ in 0..dashboards {
            let mut dashboard = Dashboard::connect(&covr.host).await;
            readers
                .push(tokio::spawn(async move { while let Some(Ok(_)) = dashboard.socket.next().await {} }));
        }
        tokio::time::sleep(Duration::from_millis(500)).await;
        watched.add(covr.cores_over(length).await);
        for reader in readers {
            reader.abort();
        }
        tokio::time::sleep(Duration::from_millis(500)).await;
    }
    let each = 100.0 * (watched.mean() - alone.mean()) / dashboards as f64;
    Row {
        what: format!("server's processor time a dashboard, {dashboards} connected"),
        figure: format!("{each:.2} % of a core"),
        beside: format!(
            "whole process: {:.1} % with none, {:.1} % with them",
            100.0 * alone.mean(),
            100.0 * watched.mean()
        ),
        ratio: format!("{:.2}", each / 5.0),
        limit: CPU_LIMIT.into(),
        met: Some(each < 5.0),
        how: format!(
            "{rounds} turns of {length:?} with none and with {dashboards} that read everything; one person at 90 Hz, default rule and motion"
        ),
    }
}

impl Covr {
    /// Start with a fresh database, and wait until it answers.
    pub async fn serve(program: &Path) -> Self {
        let dir = TempDir::new().unwrap();
        // Free now; should somebody take it meanwhile, the start fails and says so.
        let port = std::net::TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
        let host = format!("127.0.0.1:{port}");
        let child = Command::new(program)
            .args(["serve", "--bind", &host, "--database"])
            .arg(dir.path().join("covr.sqlite"))
            .current_dir(dir.path())
            .env("COVR_CLIENTS__PERSONS_EACH", "5")
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let covr = Self { host, child, http: Client::new(), _dir: dir };
        covr_tests::eventually("the server answers", || async {
            let answer = covr.http.get(format!("http://{}/readyz", covr.host)).send().await;
            answer.ok().filter(|answer| answer.status().is_success())
        })
        .await;
        covr
    }

    /// The simulated machine takes some seconds to find its switches.
    pub async fn home_and_arm(&self) {
        self.post("/api/v1/home", "").await;
        covr_tests::eventually_within(Duration::from_secs(120), "the machine is homed", || async {
            (self.get("/api/v1/state").await["mode"] == "ready").then_some(())
        })
        .await;
        self.post("/api/v1/arm", "").await;
    }

    /// A call that must succeed; its JSON.
    pub async fn get(&self, path: &str) -> Value {
        self.http.get(format!("http://{}{path}", self.host)).send().await.unwrap().json().await.unwrap()
    }

    /// A call that must succeed; its JSON.
    pub async fn post(&self, path: &str, body: &str) -> Value {
        let request = self.http.post(format!("http://{}{path}", self.host)).body(body.to_owned());
        let answer = request.header("Content-Type", "application/json").send().await.unwrap();
        let status = answer.status();
        let text = answer.text().await.unwrap();
        assert!(status.is_success(), "{path}: {status} {text}");
        serde_json::from_str(&text).unwrap()
    }

    /// Put another scene's version in force.
    pub async fn activate(&self, id: i64) {
        let url = format!("http://{}/api/v1/scenes/{id}/activate", self.host);
        let answer = self.http.put(url).send().await.unwrap();
        assert!(answer.status().is_success(), "{}", answer.text().await.unwrap());
    }

    fn resident_mb(&self) -> f64 {
        let status = std::fs::read_to_string(format!("/proc/{}/status", self.child.id())).unwrap();
        let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).unwrap();
        line.trim().trim_end_matches(" kB").parse::<f64>().unwrap() * 1024.0 / 1e6
    }

    /// Processor seconds a second.
    async fn cores_over(&self, length: Duration) -> f64 {
        let (from, began) = (self.processor_secs(), Instant::now());
        tokio::time::sleep(length).await;
        (self.processor_secs() - from) / began.elapsed().as_secs_f64()
    }

    /// User and system time so far, s.
    fn processor_secs(&self) -> f64 {
        let stat = std::fs::read_to_string(format!("/proc/{}/stat", self.child.id())).unwrap();
        let (_, after_name) = stat.rsplit_once(") ").unwrap();
        // Fields 14 and 15 of proc(5), counted from 1; field 3 comes first here.
        let ticks: f64 =
            after_name.split(' ').skip(11).take(2).map(|field| field.parse::<f64>().unwrap()).sum();
        ticks / USER_HZ
    }
}

impl Drop for Covr {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The program that goes with this benchmark: COVR_BENCH_BIN, or the one built beside it.
pub fn program() -> Option<PathBuf> {
    if let Some(path) = std::env::var_os("COVR_BENCH_BIN") {
        return Some(path.into());
    }
    let here = std::env::current_exe().ok()?;
    Some(here.parent()?.parent()?.join("covr")).filter(|path| path.exists())
}

/// People of one client who walk in circles, each at 90 poses a second, until the task is aborted.
pub async fn walk(host: &str, persons: usize) -> JoinHandle<()> {
    let mut client = VrClient::greeted(host, "walkers", Encoding::Json).await;
    for person in 0..persons {
        client.enter(&format!("person {person}")).await;
    }
    let (mut sink, mut stream) = client.socket.split();
    tokio::spawn(async move {
        let reads = async { while let Some(Ok(_)) = stream.next().await {} };
        let walks = async {
            let began = Instant::now();
            let mut beat = tokio::time::interval(Duration::from_secs_f64(1.0 / 90.0));
            for sequence in 0_u32.. {
                beat.tick().await;
                let at = began.elapsed();
                for person in 0..persons {
                    if sink.send(pose(person, persons, sequence, at)).await.is_err() {
                        return;
                    }
                }
            }
        };
        tokio::join!(reads, walks);
    })
}

/// On a circle of 1.4 m about the middle of the room, half a turn every 12 s.
fn pose(person: usize, persons: usize, sequence: u32, at: Duration) -> Message {
    let turn = std::f64::consts::TAU * (at.as_secs_f64() / 24.0 + person as f64 / persons as f64);
    let (x_m, y_m) = (2.0 + 1.4 * turn.cos(), 2.0 + 1.4 * turn.sin());
    Message::text(
        json!({
            "type": "pose", "person": format!("person {person}"), "sequence": sequence,
            "client_time_micros": at.as_micros() as i64,
            "position": [-y_m, 1.7, -x_m], "orientation": [0.0, (0.5 * turn).sin(), 0.0, (0.5 * turn).cos()],
            "tracked": true, "worn": true,
        })
        .to_string(),
    )
}

/// The straight line of least squares: its value at 0 and its slope.
fn line(points: &[(f64, f64)]) -> (f64, f64) {
    let count = points.len() as f64;
    let mean_x = points.iter().map(|p| p.0).sum::<f64>() / count;
    let mean_y = points.iter().map(|p| p.1).sum::<f64>() / count;
    let across = points.iter().map(|p| (p.0 - mean_x) * (p.1 - mean_y)).sum::<f64>();
    let along = points.iter().map(|p| (p.0 - mean_x).powi(2)).sum::<f64>();
    let slope = across / along;
    (mean_y - slope * mean_x, slope)
}

/// Ticks a second in /proc: part of the interface of Linux to programs, whatever the kernel's own rate.
const USER_HZ: f64 = 100.0;
const MANY_DASHBOARDS: usize = 20;
const MEMORY_LIMIT: &str = "under 60 MB";
const CPU_LIMIT: &str = "at most 5 % of a core";
