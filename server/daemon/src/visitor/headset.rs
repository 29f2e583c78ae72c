//! A headset in software: OpenXR convention, JSON frames, a clock of its own that it lets the server estimate.

use std::time::{Duration, Instant};

use anyhow::Context;
use covr_engine::frames::{Pose, RigidMap, Room, Tracking};
use covr_engine::observation::Hands;
use covr_wire::client::{
    ActiveScene, ClientHello, ClockPing, Convention, Encoding, Frame, FromClient, HeadPose, JSON_SUBPROTOCOL,
    PersonName, PongReceived, ToClient, Touch, decode_from_server,
};
use covr_wire::convention::ClientFrame;
use covr_wire::scene::SceneDocument;
use futures_util::{SinkExt, StreamExt};
use tokio_tungstenite::tungstenite::Message;
use tokio_tungstenite::tungstenite::http::header::SEC_WEBSOCKET_PROTOCOL;

use super::credentials::{Credentials, Socket};

/// The connection was lost.
#[derive(Debug, thiserror::Error)]
#[error("the connection to the server was lost: {0}")]
pub struct Lost(String);

/// A connected headset.
pub struct Headset {
    socket: Socket,
    started: Instant,
    frame: ClientFrame,
    scene: Option<Box<ActiveScene>>,
    sequence: u32,
    pings: u32,
    next_ping: tokio::time::Instant,
    pong: Option<PongReceived>,
}

impl Headset {
    /// Connect, say hello, and wait for the welcome.
    pub async fn connect(url: &str, name: &str, credentials: &Credentials) -> anyhow::Result<Self> {
        let mut request = credentials.request(&format!("{}/ws/v1/client", url.trim_end_matches('/')))?;
        request.headers_mut().insert(SEC_WEBSOCKET_PROTOCOL, JSON_SUBPROTOCOL.parse()?);
        let socket = credentials.connect(request).await.map_err(|why| Lost(why.to_string()))?;
        let mut headset = Self {
            socket,
            started: Instant::now(),
            frame: ClientFrame::new(Convention::Openxr, RigidMap::from_yaw(0.0, [0.0; 3].into())),
            scene: None,
            sequence: 0,
            pings: 0,
            next_ping: tokio::time::Instant::now(),
            pong: None,
        };
        let hello =
            ClientHello { name: name.into(), convention: Convention::Openxr, token: None, hands: true };
        headset.say(&FromClient::Hello(hello)).await?;
        let deadline = tokio::time::Instant::now() + LONGEST_WELCOME;
        while headset.scene.is_none() {
            let message =
                tokio::time::timeout_at(deadline, headset.socket.next()).await.context("no welcome")?;
            headset.hear(message).await?;
        }
        Ok(headset)
    }

    /// The person enters, and where they are goes out with it: a person inside whose place is unknown stops the machine.
    pub async fn enter(&mut self, person: &str, pose: &Pose<Room>, hands: &Hands) -> anyhow::Result<()> {
        self.sequence = 0;
        let enter = frame_of(&FromClient::Enter(PersonName { person: person.into() }))?;
        self.socket.feed(enter).await.map_err(lost)?;
        self.send_pose(person, pose, hands).await
    }

    /// The person leaves.
    pub async fn leave(&mut self, person: &str) -> anyhow::Result<()> {
        self.say(&FromClient::Leave(PersonName { person: person.into() })).await
    }

    /// Send where head and hands are now.
    pub async fn send_pose(&mut self, person: &str, pose: &Pose<Room>, hands: &Hands) -> anyhow::Result<()> {
        let (position, orientation) = self.frame.client_pose(pose);
        self.sequence = self.sequence.wrapping_add(1);
        let pose = HeadPose {
            person: person.into(),
            sequence: self.sequence,
            client_time_micros: self.now_micros(),
            position,
            orientation,
            tracked: true,
            worn: true,
            hands: self.frame.client_hands(hands),
        };
        self.say(&FromClient::Pose(pose)).await
    }

    /// The person's hand is at an object.
    pub async fn touch(&mut self, person: &str, object: &str) -> anyhow::Result<()> {
        let touch = self.touch_now(person, object);
        self.say(&FromClient::TouchBegan(touch)).await
    }

    /// The person's hand leaves an object.
    pub async fn let_go(&mut self, person: &str, object: &str) -> anyhow::Result<()> {
        let touch = self.touch_now(person, object);
        self.say(&FromClient::TouchEnded(touch)).await
    }

    fn touch_now(&self, person: &str, object: &str) -> Touch {
        Touch { person: person.into(), object: object.into(), client_time_micros: self.now_micros() }
    }

    /// Hear what the server says, and exchange clocks, until a moment.
    pub async fn listen_until(&mut self, moment: tokio::time::Instant) -> anyhow::Result<()> {
        loop {
            tokio::select! {
                biased;
                () = tokio::time::sleep_until(moment.min(self.next_ping)) => {
                    if self.next_ping <= tokio::time::Instant::now() {
                        self.ping().await?;
                    }
                    if moment <= tokio::time::Instant::now() {
                        return Ok(());
                    }
                }
                message = self.socket.next() => self.hear(message).await?,
            }
        }
    }

    /// The active scene.
    pub fn scene(&self) -> Option<&SceneDocument> {
        self.scene.as_ref().map(|scene| &scene.document)
    }

    /// Which version of which scene that is.
    pub fn scene_version(&self) -> Option<(i64, i64)> {
        self.scene.as_ref().map(|scene| (scene.id, scene.version))
    }

    async fn hear(
        &mut self,
        message: Option<Result<Message, tokio_tungstenite::tungstenite::Error>>,
    ) -> anyhow::Result<()> {
        let text = match message {
            Some(Ok(Message::Text(text))) => text,
            Some(Ok(Message::Close(frame))) => {
                let reason =
                    frame.map(|frame| format!("{} ({})", frame.reason, frame.code)).unwrap_or_default();
                return Err(Lost(format!("closed: {reason}")).into());
            }
            Some(Ok(_)) => return Ok(()),
            Some(Err(why)) => return Err(Lost(why.to_string()).into()),
            None => return Err(Lost("ended".into()).into()),
        };
        match decode_from_server(Encoding::Json, text.as_bytes())? {
            ToClient::Welcome(welcome) => {
                tracing::info!(version = welcome.server_version, "the server welcomes");
                if let Some(scene) = welcome.scene {
                    self.take_scene(Box::new(scene));
                }
            }
            ToClient::Scene(scene) => self.take_scene(scene),
            ToClient::ClockPong(pong) => {
                self.pong =
                    Some(PongReceived { id: pong.id, received_client_time_micros: self.now_micros() });
            }
            ToClient::Stop(stop) if stop.stopped => {
                tracing::warn!(mode = ?stop.mode, rule = stop.rule, reason = stop.reason, "the machine is stopped");
            }
            ToClient::Stop(stop) => tracing::info!(mode = ?stop.mode, "the machine is not stopped"),
            ToClient::Error(error) => tracing::warn!(%error, "the server refused a message"),
            ToClient::Scenario(now) => tracing::info!(state = now.state, runs = now.runs, "the scenario"),
            ToClient::Column(_) | ToClient::Prediction(_) | ToClient::EventAnswered(_) => {}
        }
        Ok(())
    }

    /// The map from the room into this headset's space, as the server has it calibrated.
    fn take_scene(&mut self, scene: Box<ActiveScene>) {
        let [[ax, _, _, ox], [ay, _, _, oy], [az, _, _, oz]] = scene.client_from_room;
        let tracking = |point| Convention::Openxr.point_to_tracking(point);
        let (origin, along_x) = (tracking([ox, oy, oz]), tracking([ax, ay, az]));
        let yaw_rad = along_x.y().atan2(along_x.x());
        let tracking_from_room = RigidMap::<Room, Tracking>::from_yaw(yaw_rad, origin.vector());
        self.frame = ClientFrame::new(Convention::Openxr, tracking_from_room.inverse());
        self.scene = Some(scene);
    }

    async fn ping(&mut self) -> anyhow::Result<()> {
        self.pings = self.pings.wrapping_add(1);
        // Quickly at first, so that the server knows the clock soon.
        let pause = if self.pings < FIRST_PINGS { FIRST_PING_EVERY } else { PING_EVERY };
        self.next_ping = tokio::time::Instant::now() + pause;
        let ping =
            ClockPing { id: self.pings, client_time_micros: self.now_micros(), previous: self.pong.take() };
        self.say(&FromClient::ClockPing(ping)).await
    }

    async fn say(&mut self, message: &FromClient) -> anyhow::Result<()> {
        self.socket.send(frame_of(message)?).await.map_err(lost)
    }

    fn now_micros(&self) -> i64 {
        self.started.elapsed().as_micros() as i64
    }
}

fn frame_of(message: &FromClient) -> anyhow::Result<Message> {
    Ok(match Encoding::Json.encode(message)? {
        Frame::Text(text) => Message::Text(text.into()),
        Frame::Binary(bytes) => Message::Binary(bytes.into()),
    })
}

fn lost(why: tokio_tungstenite::tungstenite::Error) -> anyhow::Error {
    Lost(why.to_string()).into()
}

const LONGEST_WELCOME: Duration = Duration::from_secs(10);
const PING_EVERY: Duration = Duration::from_secs(1);
const FIRST_PING_EVERY: Duration = Duration::from_millis(100);
const FIRST_PINGS: u32 = 10;
