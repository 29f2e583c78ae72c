//! The real `covr` program as a process of its own.

use std::net::{SocketAddr, TcpListener};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::OnceLock;

use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use reqwest::Client;
use serde_json::Value;

use crate::eventually;

/// A running `covr serve`, killed when dropped.
pub struct Process {
    /// Where it listens.
    pub address: SocketAddr,
    child: Child,
    http: Client,
}

/// The program, built once for these tests if need be.
pub fn program() -> &'static Path {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    PROGRAM.get_or_init(|| {
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
        // The port is free now; should somebody else take it meanwhile, the start fails and says so.
        let address = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap();
        let child = Command::new(program())
            .args(["serve", "--bind", &address.to_string(), "--database"])
            .arg(dir.join("covr.sqlite"))
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
