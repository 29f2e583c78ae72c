//! The server's public API, as the visitor uses it.

use std::time::Duration;

use anyhow::{Context, bail, ensure};
use covr_wire::answers::SceneSummary;
use covr_wire::dashboard::{Mode, Snapshot, ToDashboard};
use covr_wire::scene::SceneDocument;
use futures_util::StreamExt;
use reqwest::{Client, RequestBuilder, Response};
use tokio::time::Instant;

use super::credentials::Credentials;
use crate::http::{Problem, SceneStored};

/// The server's HTTP side.
pub struct Api {
    http: Client,
    base: String,
    sockets: String,
    credentials: Credentials,
}

impl Api {
    /// Of the server at this `ws://` or `wss://` address.
    pub fn new(url: &str, credentials: Credentials) -> anyhow::Result<Self> {
        let sockets = url.trim_end_matches('/').to_owned();
        let base = match sockets.split_once("://") {
            Some(("ws", host)) => format!("http://{host}"),
            Some(("wss", host)) => format!("https://{host}"),
            _ => bail!("--url: found {url}, expected ws://HOST:PORT or wss://HOST:PORT"),
        };
        let http = credentials.http().timeout(LONGEST_CALL).build()?;
        Ok(Self { http, base, sockets, credentials })
    }

    /// What it shows and trusts.
    pub fn credentials(&self) -> &Credentials {
        &self.credentials
    }

    /// Wait until the server answers, for ever.
    pub async fn wait_until_healthy(&self) {
        loop {
            let answered = self.http.get(format!("{}/healthz", self.base)).send().await;
            if answered.is_ok_and(|response| response.status().is_success()) {
                return;
            }
            tokio::time::sleep(BETWEEN_TRIES).await;
        }
    }

    /// Home the machine, if it is the simulated one, and wait until it is ready. False: it is in a stop that only
    /// somebody at the dashboard ends.
    pub async fn home_simulated_machine(&self) -> anyhow::Result<bool> {
        let machine = self.machine().await?;
        ensure!(
            machine == "simulated",
            "--arm is for the simulated machine alone; this server drives \"{machine}\""
        );
        let deadline = Instant::now() + LONGEST_HOMING;
        let mut asked = false;
        loop {
            let state = self.state().await?;
            match state.mode {
                Mode::Ready | Mode::Following | Mode::ProtectiveStop => return Ok(true),
                Mode::Disarmed if !asked => {
                    self.post("home").await?;
                    asked = true;
                }
                Mode::Disarmed | Mode::Homing if Instant::now() < deadline => {
                    tokio::time::sleep(BETWEEN_TRIES).await
                }
                Mode::LatchedStop | Mode::Faulted => {
                    let why = state.stop.map_or_else(String::new, |stop| stop.reason);
                    tracing::warn!(why, "the machine is stopped: reset, home and arm it on the dashboard");
                    return Ok(false);
                }
                mode => bail!("the machine did not get ready: it is still {mode:?}"),
            }
        }
    }

    /// Arm the machine.
    pub async fn arm(&self) -> anyhow::Result<()> {
        match self.state().await?.mode {
            Mode::Following | Mode::ProtectiveStop => Ok(()),
            _ => self.post("arm").await,
        }
    }

    /// Store a scene, as a new version of the one of the same name if there is one, and activate it.
    pub async fn show_scene(&self, scene: &SceneDocument, author: &str) -> anyhow::Result<()> {
        let scenes = format!("{}/api/v1/scenes", self.base);
        let known: Vec<SceneSummary> = good(self.http.get(&scenes).send().await?).await?.json().await?;
        let id = match known.into_iter().find(|known| known.name == scene.name) {
            None => self.store(self.http.post(&scenes), scene, author).await?,
            Some(known) => {
                let stored = format!("{scenes}/{}", known.id);
                let before: SceneDocument = good(self.http.get(&stored).send().await?).await?.json().await?;
                if before == *scene {
                    known.id
                } else {
                    self.store(self.http.put(&stored), scene, author).await?
                }
            }
        };
        let activate = self.http.put(format!("{scenes}/{id}/activate")).header(AUTHOR_HEADER, author);
        good(activate.send().await?).await?;
        tracing::info!(scene = scene.name, id, "scene activated");
        Ok(())
    }

    async fn store(
        &self,
        request: RequestBuilder,
        scene: &SceneDocument,
        author: &str,
    ) -> anyhow::Result<i64> {
        let response = request.header(AUTHOR_HEADER, author).json(scene).send().await?;
        Ok(good(response).await?.json::<SceneStored>().await?.id)
    }

    /// The machine's name, as the server tells its dashboards.
    async fn machine(&self) -> anyhow::Result<String> {
        let request = self.credentials.request(&format!("{}/ws/v1/dashboard", self.sockets))?;
        let mut socket = self.credentials.connect(request).await?;
        let first = tokio::time::timeout(LONGEST_CALL, socket.next())
            .await?
            .context("the dashboard socket closed")??;
        match serde_json::from_str(first.to_text()?)? {
            ToDashboard::Welcome { machine, .. } => Ok(machine),
            _ => bail!("the dashboard socket did not begin with a welcome"),
        }
    }

    async fn state(&self) -> anyhow::Result<Snapshot> {
        Ok(good(self.http.get(format!("{}/api/v1/state", self.base)).send().await?).await?.json().await?)
    }

    async fn post(&self, request: &str) -> anyhow::Result<()> {
        good(self.http.post(format!("{}/api/v1/{request}", self.base)).send().await?)
            .await
            .with_context(|| request.to_owned())?;
        tracing::info!("{request}");
        Ok(())
    }
}

/// The answer, or the server's own words why not.
async fn good(response: Response) -> anyhow::Result<Response> {
    if response.status().is_success() {
        return Ok(response);
    }
    let status = response.status();
    match response.json::<Problem>().await {
        Ok(problem) => bail!("{}: {}", problem.title, problem.detail),
        Err(_) => bail!("the server answered {status}"),
    }
}

const AUTHOR_HEADER: &str = "X-Covr-Author";
const LONGEST_CALL: Duration = Duration::from_secs(10);
const LONGEST_HOMING: Duration = Duration::from_secs(120);
const BETWEEN_TRIES: Duration = Duration::from_millis(200);
