//! A running server, as `covr commission` works with it: its dashboard's socket, and HTTP.

use std::time::Duration;

use anyhow::{Context, bail};
use covr_wire::dashboard::{Event, FromDashboard, JogAim, MachineShape, Outcome, Snapshot, ToDashboard};
use futures_util::stream::{SplitSink, SplitStream};
use futures_util::{SinkExt, StreamExt};
use percent_encoding::{NON_ALPHANUMERIC, utf8_percent_encode};
use reqwest::Client;
use serde_json::Value;
use tokio::sync::{mpsc, watch};
use tokio::time::{Instant, MissedTickBehavior, interval, timeout};
use tokio_tungstenite::tungstenite::Message;

use crate::visitor::credentials::{Credentials, Socket};

/// The connection.
pub struct Desk {
    /// The machine's name.
    pub machine: String,
    /// Who walks through it.
    pub author: String,
    /// Its travel and limits.
    pub shape: MachineShape,
    http: Client,
    base: String,
    sink: SplitSink<Socket, Message>,
    snapshot: watch::Receiver<Option<Box<Snapshot>>>,
    events: mpsc::UnboundedReceiver<Event>,
    answers: mpsc::UnboundedReceiver<(u32, Outcome, String)>,
    last_id: u32,
}

/// What the socket brings, sorted.
struct Sorter {
    snapshot: watch::Sender<Option<Box<Snapshot>>>,
    events: mpsc::UnboundedSender<Event>,
    answers: mpsc::UnboundedSender<(u32, Outcome, String)>,
}

impl Desk {
    /// Connect to the server at this `http://` or `https://` address.
    pub async fn connect(url: &str, credentials: &Credentials) -> anyhow::Result<Self> {
        let base = url.trim_end_matches('/').to_owned();
        let sockets = match base.split_once("://") {
            Some(("http", host)) => format!("ws://{host}"),
            Some(("https", host)) => format!("wss://{host}"),
            _ => bail!("--url: found {url}, expected http://HOST:PORT or https://HOST:PORT"),
        };
        let request = credentials.request(&format!("{sockets}/ws/v1/dashboard"))?;
        let socket = credentials.connect(request).await.with_context(|| format!("{base} does not answer"))?;
        let (sink, mut stream) = socket.split();
        let first = next(&mut stream).await.context("the server said nothing")?;
        let ToDashboard::Welcome { machine, machine_shape: shape, .. } = first else {
            bail!("the server did not begin with a welcome");
        };
        let (snapshot_in, snapshot) = watch::channel(None);
        let (events_in, events) = mpsc::unbounded_channel();
        let (answers_in, answers) = mpsc::unbounded_channel();
        let sorter = Sorter { snapshot: snapshot_in, events: events_in, answers: answers_in };
        tokio::spawn(sorter.run(stream));
        let http = credentials.http().timeout(LONGEST_CALL).build()?;
        Ok(Self {
            machine,
            author: String::new(),
            shape,
            http,
            base,
            sink,
            snapshot,
            events,
            answers,
            last_id: 0,
        })
    }

    /// The newest state.
    pub async fn state(&mut self) -> anyhow::Result<Snapshot> {
        self.wait("a state", LONGEST_CALL, |_| true).await
    }

    /// Wait until the state is so.
    pub async fn wait(
        &mut self,
        what: &str,
        patience: Duration,
        is: impl Fn(&Snapshot) -> bool,
    ) -> anyhow::Result<Snapshot> {
        let so = self.snapshot.wait_for(|snapshot| snapshot.as_deref().is_some_and(&is));
        match timeout(patience, so).await {
            Ok(Ok(snapshot)) => Ok(snapshot.as_deref().cloned().context("no state")?),
            Ok(Err(_)) => bail!("the server closed the connection"),
            Err(_) => bail!("{what}: not within {} s", patience.as_secs()),
        }
    }

    /// Call the API; the server's own words where it refuses.
    pub async fn post(&self, path: &str, body: Option<Value>) -> anyhow::Result<Value> {
        let author = utf8_percent_encode(&self.author, NON_ALPHANUMERIC).to_string();
        let request = self.http.post(format!("{}/api/v1/{path}", self.base));
        let request = request.header(AUTHOR_HEADER, author);
        let request = match body {
            Some(body) => request.json(&body),
            None => request,
        };
        self.call(request).await.with_context(|| path.to_owned())
    }

    /// Read from the API.
    pub async fn get(&self, path: &str) -> anyhow::Result<Value> {
        self.call(self.http.get(format!("{}/api/v1/{path}", self.base)))
            .await
            .with_context(|| path.to_owned())
    }

    /// Stop by the socket, and wait for the acknowledgement.
    pub async fn stop_by_socket(&mut self) -> anyhow::Result<()> {
        let request_id = self.new_id();
        let stop = FromDashboard::Stop { request_id, reason: Some(STOP_REASON.into()) };
        self.say(&stop).await?;
        self.answer(request_id).await?.map_err(anyhow::Error::msg)
    }

    /// Stop by HTTP; from reception to the drive, microseconds.
    pub async fn stop_by_http(&self) -> anyhow::Result<u64> {
        let answer = self.post("stop", Some(serde_json::json!({ "reason": STOP_REASON }))).await?;
        answer["to_drive_micros"].as_u64().context("the stop was not acknowledged")
    }

    /// Hold the jog button until the state is so, and keep holding it: `let_go`, a stop, or the end of this program ends it.
    pub async fn jog(
        &mut self,
        aim: JogAim,
        speed_mps: f64,
        patience: Duration,
        is: impl Fn(&Snapshot) -> bool,
    ) -> anyhow::Result<()> {
        let give_up = Instant::now() + patience;
        let mut due = interval(ORDER_EVERY);
        due.set_missed_tick_behavior(MissedTickBehavior::Delay);
        let mut refused = String::new();
        loop {
            tokio::select! {
                _ = due.tick() => {
                    let request_id = self.new_id();
                    self.say(&FromDashboard::Jog { request_id, to: Some(aim), speed_mps }).await?;
                    refused = self.answer(request_id).await?.err().unwrap_or_default();
                }
                changed = self.snapshot.changed() => changed.context("the server closed the connection")?,
            }
            if self.snapshot.borrow().as_deref().is_some_and(&is) {
                return Ok(());
            }
            if Instant::now() > give_up {
                bail!("it did not get there within {} s. {refused}", patience.as_secs());
            }
        }
    }

    /// Let go of the jog button.
    pub async fn let_go(&mut self) -> anyhow::Result<()> {
        let request_id = self.new_id();
        self.say(&FromDashboard::Jog { request_id, to: None, speed_mps: 0.0 }).await?;
        self.answer(request_id).await?.map_err(anyhow::Error::msg)
    }

    /// Forget the events so far.
    pub fn forget_events(&mut self) {
        while self.events.try_recv().is_ok() {}
    }

    /// The next event of this kind.
    pub async fn event(&mut self, kind: &str, patience: Duration) -> anyhow::Result<Event> {
        let found = async {
            loop {
                let event = self.events.recv().await.context("the server closed the connection")?;
                if event.kind == kind {
                    return anyhow::Ok(event);
                }
            }
        };
        timeout(patience, found).await.with_context(|| format!("no event {kind}"))?
    }

    fn new_id(&mut self) -> u32 {
        self.last_id += 1;
        self.last_id
    }

    async fn say(&mut self, message: &FromDashboard) -> anyhow::Result<()> {
        let text = serde_json::to_string(message)?;
        self.sink.send(Message::Text(text.into())).await.context("the server closed the connection")
    }

    /// The answer to a request: accepted, or why not.
    async fn answer(&mut self, request_id: u32) -> anyhow::Result<Result<(), String>> {
        let found = async {
            loop {
                let (id, outcome, detail) =
                    self.answers.recv().await.context("the server closed the connection")?;
                if id == request_id {
                    return anyhow::Ok(if outcome == Outcome::Refused { Err(detail) } else { Ok(()) });
                }
            }
        };
        timeout(LONGEST_CALL, found).await.context("no answer")?
    }

    async fn call(&self, request: reqwest::RequestBuilder) -> anyhow::Result<Value> {
        let response = request.send().await?;
        let (is_good, body) = (response.status().is_success(), response.json::<Value>().await?);
        if is_good {
            return Ok(body);
        }
        bail!("{}", body["detail"].as_str().unwrap_or("refused"))
    }
}

impl Sorter {
    /// Until the socket closes, or nobody listens.
    async fn run(self, mut stream: SplitStream<Socket>) {
        while let Ok(message) = next(&mut stream).await {
            let heard = match message {
                ToDashboard::Snapshot(snapshot) => self.snapshot.send(Some(snapshot)).is_ok(),
                ToDashboard::Event(event) => self.events.send(event).is_ok(),
                ToDashboard::Answer { request_id, outcome, detail, .. } => {
                    self.answers.send((request_id, outcome, detail)).is_ok()
                }
                ToDashboard::Welcome { .. } | ToDashboard::Scene { .. } => true,
            };
            if !heard {
                return;
            }
        }
    }
}

async fn next(stream: &mut SplitStream<Socket>) -> anyhow::Result<ToDashboard> {
    loop {
        match stream.next().await.context("closed")?? {
            Message::Text(text) => return Ok(serde_json::from_str(&text)?),
            Message::Close(_) => bail!("closed"),
            _ => {}
        }
    }
}

const AUTHOR_HEADER: &str = "X-Covr-Author";
const STOP_REASON: &str = "commissioning";
const ORDER_EVERY: Duration = Duration::from_millis(100);
const LONGEST_CALL: Duration = Duration::from_secs(10);
