//! A real server in this process, on a free port, with a database of its own.

use std::sync::Arc;
use std::time::Duration;

use covr_engine::mode::Mode;
use covr_gantry::sim::SimulatedMachine;
use covr_gantry::sim::parameters::MachineParameters;
use covr_server::access::{Role, Token};
use covr_server::app::App;
use covr_server::config::Config;
use covr_server::control::Published;
use covr_server::http::Problem;
use covr_server::serve::Server;
use covr_server::store::StoredToken;
use reqwest::{Client, Method, RequestBuilder, Response};
use serde_json::Value;
use tempfile::TempDir;
use tokio::sync::{OnceCell, oneshot};
use tokio::task::JoinHandle;

use crate::contract::Contract;
use crate::{HOMED, SOON};

/// A running server.
pub struct TestServer {
    /// `127.0.0.1:port`.
    pub host: String,
    /// What its handlers share.
    pub app: Arc<App>,
    http: Client,
    contract: OnceCell<Contract>,
    dir: TempDir,
    end: oneshot::Sender<String>,
    runs: JoinHandle<Result<(), String>>,
}

/// The defaults, but a machine that homes quickly and a free port.
pub fn test_config(dir: &TempDir) -> Config {
    let mut config = Config::default();
    config.server.bind = ([127, 0, 0, 1], 0).into();
    config.server.database = dir.path().join("covr.sqlite");
    config.machine.travel_m = [0.0, 0.0, 1.0, 1.0];
    config
}

impl TestServer {
    /// Start with a fresh database.
    pub async fn start() -> Self {
        Self::start_with(|_| {}).await
    }

    /// Start with a fresh database and another configuration.
    pub async fn start_with(change: impl FnOnce(&mut Config)) -> Self {
        Self::start_in(TempDir::new().unwrap(), change).await
    }

    /// Start on what an earlier server left.
    pub async fn start_in(dir: TempDir, change: impl FnOnce(&mut Config)) -> Self {
        let mut config = test_config(&dir);
        change(&mut config);
        let server = Server::start(config).await.unwrap();
        Self::run(dir, server)
    }

    /// The same, driving the simulated machine while it takes it for the one of the configuration.
    pub async fn start_on_a_simulation(dir: TempDir, change: impl FnOnce(&mut Config)) -> Self {
        let mut config = test_config(&dir);
        change(&mut config);
        let limits = config.machine.limits();
        let parameters = MachineParameters { limits, ..MachineParameters::paper(config.machine.travel()) };
        let machine = SimulatedMachine::new(parameters).unwrap();
        let server = Server::start_with(config, Box::new(machine)).await.unwrap();
        Self::run(dir, server)
    }

    fn run(dir: TempDir, server: Server) -> Self {
        let host = server.address().to_string();
        let app = server.app().clone();
        let (end, told) = oneshot::channel();
        let runs = tokio::spawn(async move {
            let told = async { told.await.unwrap_or_else(|_| "the test ended".into()) };
            server.run_until(told).await.map_err(|why| format!("{why:#}"))
        });
        Self { host, app, http: Client::new(), contract: OnceCell::new(), dir, end, runs }
    }

    /// Shut down, and give the database's folder back.
    pub async fn shutdown(self) -> TempDir {
        self.end.send("test shutdown".into()).unwrap();
        tokio::time::timeout(SOON, self.runs).await.expect("shutdown in time").unwrap().unwrap();
        self.dir
    }

    /// One HTTP call.
    pub async fn call(&self, method: &str, path: &str, body: Option<&str>) -> Response {
        self.call_as(None, method, path, body).await
    }

    /// One HTTP call of an author.
    pub async fn call_as(
        &self,
        author: Option<&str>,
        method: &str,
        path: &str,
        body: Option<&str>,
    ) -> Response {
        let mut request = self.request(method, path, body);
        if let Some(author) = author {
            request = request.header("X-Covr-Author", author);
        }
        request.send().await.unwrap()
    }

    /// A token of this role, in force at once. From the first one on, the server asks everybody who they are.
    pub async fn token(&self, role: Role) -> String {
        self.token_until(role, None).await
    }

    /// The same with an end, RFC 3339.
    pub async fn token_until(&self, role: Role, expires: Option<&str>) -> String {
        let token = Token::new().unwrap();
        let stored = StoredToken {
            id: token.id().into(),
            name: format!("{} {}", role.in_words(), token.id()),
            role,
            hash: token.hash().unwrap(),
            created: "2026-01-01T00:00:00Z".into(),
            expires: expires.map(Into::into),
            revoked: None,
        };
        assert!(self.app.store.add_token(&stored).await.unwrap());
        self.app.roster.refresh().await.unwrap();
        token.to_string()
    }

    /// One HTTP call with a token, or without.
    pub async fn call_with(
        &self,
        token: Option<&str>,
        method: &str,
        path: &str,
        body: Option<&str>,
    ) -> Response {
        let mut request = self.request(method, path, body);
        if let Some(token) = token {
            request = request.bearer_auth(token);
        }
        request.send().await.unwrap()
    }

    fn request(&self, method: &str, path: &str, body: Option<&str>) -> RequestBuilder {
        let method = Method::from_bytes(method.as_bytes()).unwrap();
        let request = self.http.request(method, format!("http://{}{path}", self.host));
        match body {
            Some(body) => request.header("Content-Type", "application/json").body(body.to_owned()),
            None => request,
        }
    }

    /// A call that succeeds; its JSON, which is as documented.
    pub async fn good(&self, method: &str, path: &str, body: Option<&str>) -> Value {
        let response = self.call(method, path, body).await;
        let status = response.status();
        let text = response.text().await.unwrap();
        assert!(status.is_success(), "{method} {path}: {status} {text}");
        let value = serde_json::from_str(&text).unwrap_or(Value::String(text));
        self.contract().await.judge(method, path, status.as_u16(), &value);
        value
    }

    /// A call that is refused with this status; its problem document, whose form is checked and which is as documented.
    pub async fn refused(&self, status: u16, method: &str, path: &str, body: Option<&str>) -> Problem {
        let problem = problem(status, path, self.call(method, path, body).await).await;
        self.contract().await.judge(method, path, status, &serde_json::to_value(&problem).unwrap());
        problem
    }

    /// What the server says of itself.
    pub async fn contract(&self) -> &Contract {
        let ask = async || {
            let document = self.call("GET", "/api/v1/openapi.json", None).await;
            Contract(document.json().await.unwrap())
        };
        self.contract.get_or_init(ask).await
    }

    /// Wait for a published state.
    pub async fn published(
        &self,
        what: &str,
        longest: Duration,
        is_it: impl FnMut(&Arc<Published>) -> bool,
    ) -> Arc<Published> {
        let mut published = self.app.control.watch_published();
        let found = tokio::time::timeout(longest, published.wait_for(is_it)).await;
        found.unwrap_or_else(|_| panic!("{what}: not within {longest:?}")).unwrap().clone()
    }

    /// Wait for a mode.
    pub async fn mode(&self, mode: Mode) -> Arc<Published> {
        self.published(mode.name(), HOMED, |p| p.snapshot.mode == mode).await
    }

    /// Home and arm.
    pub async fn arm(&self) {
        self.good("POST", "/api/v1/home", None).await;
        self.mode(Mode::Ready).await;
        self.good("POST", "/api/v1/arm", None).await;
        assert_eq!(self.good("GET", "/api/v1/state", None).await["mode"], "following");
    }
}

/// Check that a response is a problem document of this status and path.
pub async fn problem(status: u16, path: &str, response: Response) -> Problem {
    let found = response.status().as_u16();
    let kind = response.headers().get("content-type").map(|kind| kind.to_str().unwrap().to_owned());
    let text = response.text().await.unwrap();
    assert_eq!(found, status, "{path}: {text}");
    assert_eq!(kind.as_deref(), Some("application/problem+json"), "{path}: {text}");
    let problem: Problem = serde_json::from_str(&text).unwrap_or_else(|why| panic!("{why}: {text}"));
    assert_eq!(problem.status, status);
    assert_eq!(&*problem.instance, path.split('?').next().unwrap());
    assert!(problem.kind.starts_with("urn:covr:problem:") && !problem.title.is_empty(), "{text}");
    assert!(!problem.detail.is_empty(), "{text}");
    problem
}
