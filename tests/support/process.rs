//! The real `covr` program as a process of its own.

use std::net::{SocketAddr, TcpListener};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;

use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use reqwest::Client;
use serde_json::Value;

use crate::{HOMED, SOON, eventually, eventually_within};

/// A running `covr serve`, killed when dropped.
pub struct Process {
    /// Where it listens.
    pub address: SocketAddr,
    child: Child,
    http: Client,
}

/// How the program is started.
#[derive(Debug, Clone, Copy, Default)]
pub struct Start<'a> {
    /// Variables of its environment.
    pub env: &'a [(&'a str, &'a str)],
    /// Limits of the operating system, as `prlimit` takes them: `--fsize=1000000`.
    pub limits: &'a [&'a str],
}

/// The program, built once for these tests if need be; `COVR_BUILT` names one that is built already.
pub fn program() -> &'static Path {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    PROGRAM.get_or_init(|| {
        if let Some(built) = std::env::var_os("COVR_BUILT") {
            return built.into();
        }
        // This test runs from TARGET/PROFILE/deps.
        let test = std::env::current_exe().unwrap();
        let profile = test.parent().and_then(Path::parent).unwrap();
        let built = Command::new(env!("CARGO"))
            .args(["build", "--quiet", "-p", "covr-server", "--bin", "covr", "--target-dir"])
            .arg(profile.parent().unwrap())
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .status()
            .unwrap();
        assert!(built.success(), "covr does not build");
        profile.join("covr")
    })
}

impl Process {
    /// Start on a database in this folder, and wait until it answers.
    pub async fn serve(dir: &Path) -> Self {
        Self::serve_with(dir, Start::default()).await
    }

    /// The same under these circumstances.
    pub async fn serve_with(dir: &Path, start: Start<'_>) -> Self {
        // The port is free now; should somebody else take it meanwhile, the start fails and says so.
        let address = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap();
        let mut command = if start.limits.is_empty() {
            Command::new(program())
        } else {
            // A file that must not grow is an error to write, not the end of the process.
            let mut shell = Command::new("sh");
            shell
                .args(["-c", "trap '' XFSZ; exec prlimit \"$@\"", "prlimit"])
                .args(start.limits)
                .arg(program());
            shell
        };
        let child = command
            .args(["serve", "--bind", &address.to_string(), "--database"])
            .arg(dir.join("covr.sqlite"))
            .envs(start.env.iter().copied())
            .env("COVR_MACHINE__TRAVEL_M", "[0.0, 0.0, 1.0, 1.0]")
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let process = Self { address, child, http: Client::new() };
        eventually("the server answers", || async {
            let answered = process.http.get(process.url("/healthz")).send().await;
            answered.ok().filter(|response| response.status().is_success())
        })
        .await;
        process
    }

    /// A call; its status and text. None when the server is gone.
    pub async fn call(&self, method: &str, path: &str, body: Option<&str>) -> Option<(u16, String)> {
        let method = reqwest::Method::from_bytes(method.as_bytes()).unwrap();
        let request = self.http.request(method, self.url(path)).body(body.unwrap_or_default().to_owned());
        let response = request.send().await.ok()?;
        Some((response.status().as_u16(), response.text().await.ok()?))
    }

    /// Press the stop over HTTP; panics when it is not acknowledged.
    pub async fn stop(&self) {
        let pressed = self.call("POST", "/api/v1/stop", None);
        let answered = tokio::time::timeout(SOON, pressed).await.expect("the stop is answered in time");
        let (status, text) = answered.expect("the stop is answered");
        assert_eq!(status, 200, "{text}");
        assert!(text.contains("\"acknowledged\":true"), "{text}");
    }

    /// Wait for a mode.
    pub async fn mode(&self, mode: &str) {
        eventually_within(HOMED, mode, || async {
            let (_, text) = self.call("GET", "/api/v1/state", None).await?;
            let state: Value = serde_json::from_str(&text).unwrap();
            (state["mode"] == mode).then_some(())
        })
        .await;
    }

    /// Home and arm.
    pub async fn arm(&self) {
        self.good("POST", "/api/v1/home", None).await;
        self.mode("ready").await;
        self.good("POST", "/api/v1/arm", None).await;
    }

    /// A number of `GET /metrics`, by its name with its labels.
    pub async fn metric(&self, name: &str) -> f64 {
        let (_, text) = self.call("GET", "/metrics", None).await.expect("metrics");
        let value = text.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(' '));
        value.unwrap_or_else(|| panic!("{name} is not in\n{text}")).parse().unwrap()
    }

    /// A line of `/proc/PID/status` in kB, such as `VmRSS`.
    pub fn memory_kb(&self, line: &str) -> f64 {
        let status = std::fs::read_to_string(format!("/proc/{}/status", self.child.id())).unwrap();
        let found = status.lines().find_map(|found| found.strip_prefix(line)?.strip_prefix(':'));
        found.unwrap().trim().trim_end_matches(" kB").parse().unwrap()
    }

    /// `127.0.0.1:port`.
    pub fn host(&self) -> String {
        self.address.to_string()
    }

    /// A call that succeeds; its JSON.
    pub async fn good(&self, method: &str, path: &str, body: Option<&str>) -> Value {
        let method = reqwest::Method::from_bytes(method.as_bytes()).unwrap();
        let request = self.http.request(method, self.url(path)).header("X-Covr-Author", "game master");
        let response = request.body(body.unwrap_or_default().to_owned()).send().await.unwrap();
        let status = response.status();
        let text = response.text().await.unwrap();
        assert!(status.is_success(), "{path}: {status} {text}");
        serde_json::from_str(&text).unwrap()
    }

    /// Kill it as the kernel does when memory runs out: no handler runs.
    pub fn kill_9(mut self) {
        self.child.kill().unwrap();
        self.child.wait().unwrap();
    }

    /// Send a signal.
    pub fn signal(&self, signal: Signal) {
        kill(Pid::from_raw(self.child.id().cast_signed()), signal).unwrap();
    }

    /// Wait for its end; its exit code.
    pub async fn exit_code(mut self) -> Option<i32> {
        let child = &mut self.child;
        let ended = std::cell::RefCell::new(child);
        let status =
            eventually("the process ends", || async { ended.borrow_mut().try_wait().unwrap() }).await;
        status.code()
    }

    fn url(&self, path: &str) -> String {
        format!("http://{}{path}", self.address)
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
