//! One connected client: what it has said so far, and what each next message does.
//!
//! A refused message changes nothing. When a guest goes, its persons stay: nobody has said that they left.

mod arriving;

use std::collections::{BTreeMap, VecDeque};
use std::net::IpAddr;
use std::sync::Arc;

use covr_engine::Request;
use covr_engine::observation::{Observation, PersonId, PoseSample};
use covr_engine::time::{Span, Time};
use covr_wire::client::{
    AbuseGauge, ClientError, ClientHello, Encoding, ErrorCode, EventAnswered, FromClient, HeadPose,
    Sequencer, ToClient, Touch, Verdict, Welcome, decode,
};
use covr_wire::clock::ClientClock;
use covr_wire::convention::ClientFrame;
use covr_wire::dashboard::Client;
use covr_wire::link::{Link, LinkFigures};
use serde_json::json;
use tokio::sync::{OwnedSemaphorePermit, mpsc, watch};

use crate::access::table::client_key;
use crate::access::{Caller, Holder, Standing};
use crate::app::App;
use crate::calibrations::Rooms;
use crate::clients::Seat;
use crate::control::PoseSlot;
use crate::meters::ClientMeters;
use crate::ws::TAKEN_BACK;

/// What the client is to hear.
#[derive(Debug)]
pub enum Reply {
    /// A message.
    Say(ToClient),
    /// The answer to its hello, and how to speak to it from now on.
    Welcome(Box<ClientHello>, ClientFrame, Box<Welcome>),
    /// Why the connection is closed.
    LastWords(ClientError),
}

/// What a connection holds.
#[derive(Debug)]
pub enum Place {
    /// A place among the clients.
    Seat(Seat),
    /// A place to wait in until it has said who it is.
    Doorstep {
        /// Given back when dropped.
        _permit: OwnedSemaphorePermit,
    },
}

/// Somebody at the door.
#[derive(Debug)]
pub struct Newcomer {
    /// Who they are.
    pub caller: Caller,
    /// Where they come from.
    pub peer: IpAddr,
    /// What they hold.
    pub place: Place,
}

/// A connected client.
pub struct Guest {
    app: Arc<App>,
    encoding: Encoding,
    who: Newcomer,
    /// For answers that come later.
    replies: mpsc::Sender<Reply>,
    gauge: AbuseGauge,
    clock: ClientClock,
    greeted: Option<Greeted>,
    persons: BTreeMap<String, Present>,
    poses: u64,
    errors: u64,
    pose_times: VecDeque<Time>,
    meters: ClientMeters,
    next_show: Time,
    rooms: watch::Receiver<Arc<Rooms>>,
}

/// Who it is.
struct Greeted {
    hello: ClientHello,
    frame: ClientFrame,
}

/// A person that it speaks for.
struct Present {
    id: PersonId,
    slot: PoseSlot,
    sequencer: Sequencer,
    link: Link,
}

impl Guest {
    /// A client that has said nothing yet.
    pub fn new(app: Arc<App>, encoding: Encoding, who: Newcomer, replies: mpsc::Sender<Reply>) -> Self {
        let gauge = AbuseGauge::new(app.config.clients.persons_each);
        let rooms = app.calibrations.watch();
        Self {
            app,
            encoding,
            who,
            replies,
            gauge,
            clock: ClientClock::new(),
            greeted: None,
            persons: BTreeMap::new(),
            poses: 0,
            errors: 0,
            pose_times: VecDeque::new(),
            meters: ClientMeters::default(),
            next_show: Time::ZERO,
            rooms,
        }
    }

    /// Take one frame in.
    pub async fn take_frame(&mut self, sent_as: Encoding, frame: &[u8], received: Time) -> Option<Reply> {
        let done = match self.gauge.message(received) {
            Verdict::Fine => match self.understand(sent_as, frame) {
                Ok(message) => self.take(message, received).await,
                Err(error) => Err(error),
            },
            Verdict::Warn => Err(too_many()),
            Verdict::Close => Err(too_many().fatal()),
        };
        let reply = match done {
            Ok(reply) => reply,
            Err(error) => Some(self.refuse(error, received)),
        };
        if received >= self.next_show {
            self.show(received);
        }
        reply
    }

    /// Nothing came for too long.
    pub fn silent(&mut self) -> Reply {
        let error = if self.greeted.is_some() {
            let secs = self.app.config.clients.silence_timeout_secs;
            ClientError::plain(ErrorCode::Malformed, format!("nothing was said for {secs} s"))
        } else {
            let secs = self.app.config.clients.hello_timeout_secs;
            ClientError::plain(ErrorCode::HelloExpected, format!("no hello came within {secs} s"))
        };
        Reply::LastWords(error.fatal())
    }

    /// Its last words, if its token was taken back meanwhile.
    pub fn taken_back(&self) -> Option<Reply> {
        let is_taken_back = self.app.roster.standing(&self.who.caller) == Standing::TakenBack;
        is_taken_back.then(|| Reply::LastWords(unauthorized(TAKEN_BACK.into())))
    }

    /// When it is to be shown next.
    pub fn next_show(&self) -> Time {
        self.next_show
    }

    /// It has said who it is.
    pub fn has_greeted(&self) -> bool {
        self.greeted.is_some()
    }

    fn understand(&self, sent_as: Encoding, frame: &[u8]) -> Result<FromClient, ClientError> {
        if sent_as != self.encoding {
            let name = |encoding| match encoding {
                Encoding::Json => "a text frame (covr.v1.json)",
                Encoding::MessagePack => "a binary frame (covr.v1.msgpack)",
            };
            return Err(ClientError::at(ErrorCode::WrongFrame, "", name(sent_as), name(self.encoding)));
        }
        decode(self.encoding, frame)
    }

    async fn take(&mut self, message: FromClient, received: Time) -> Result<Option<Reply>, ClientError> {
        let key = client_key(&message);
        if let FromClient::Hello(ClientHello { token: Some(token), .. }) = &message {
            self.introduce(token.expose()).await?;
        }
        // A visitor in the arena is not cut off because a token ends by itself meanwhile.
        let was_let_in = self.greeted.is_some();
        if !was_let_in && !self.app.roster.allows(&self.who.caller, key) {
            return Err(unauthorized(self.app.roster.why_not(&self.who.caller, key)));
        }
        if self.greeted.is_none() && !matches!(message, FromClient::Hello(_) | FromClient::ClockPing(_)) {
            return Err(ClientError::plain(ErrorCode::HelloExpected, "the first message must be a hello"));
        }
        match message {
            FromClient::Hello(hello) => return self.greet(hello, received).map(Some),
            FromClient::ClockPing(ping) => {
                let pong = self.clock.ping(&ping, received, self.app.clock.now());
                return Ok(Some(Reply::Say(ToClient::ClockPong(pong))));
            }
            FromClient::Pose(pose) => self.pose(&pose, received)?,
            FromClient::Enter(who) => self.enter(&who.person)?,
            FromClient::Leave(who) => {
                let id = self.present(&who.person)?.id;
                self.tell(Observation::PersonLeft(id))?;
                self.app.persons.leave(id);
                self.persons.remove(&who.person);
            }
            FromClient::OriginChanged(who) => {
                let id = self.present(&who.person)?.id;
                self.tell(Observation::OriginChanged(id))?;
                let summary = format!("the tracking origin of {} changed", who.person);
                self.record("origin_changed", summary, json!({ "person": id.0, "name": who.person }));
            }
            FromClient::TouchBegan(touch) => self.touch("touch_began", "touched", &touch, received)?,
            FromClient::TouchEnded(touch) => self.touch("touch_ended", "let go of", &touch, received)?,
            FromClient::SceneEvent(event) => {
                let summary = format!("scene event {}", event.name);
                self.record("scene_event", summary, json!({ "name": event.name, "detail": event.detail }));
                self.client_event(event.name)?;
            }
        }
        Ok(None)
    }

    /// Tell the scenario, where there is one. The answer comes after the next control step; poses do not wait for it.
    fn client_event(&self, name: String) -> Result<(), ClientError> {
        if self.app.stage.active().scene.scenario().is_none() {
            return Ok(());
        }
        let answer = self.app.control.put(Request::ClientEvent(name.clone())).map_err(busy)?;
        let (app, replies) = (self.app.clone(), self.replies.clone());
        tokio::spawn(async move {
            // Without a control thread the connection is about to end.
            let Ok(answer) = answer.await else { return };
            let detail = app.reason(&answer).to_string();
            let answered = EventAnswered { name, outcome: answer.outcome.into(), detail };
            // Whoever does not read is let go of by the reader.
            let _ = replies.try_send(Reply::Say(ToClient::EventAnswered(answered)));
        });
        Ok(())
    }

    fn pose(&mut self, pose: &HeadPose, received: Time) -> Result<(), ClientError> {
        let Some(greeted) = &mut self.greeted else { return Ok(()) };
        if self.rooms.has_changed().unwrap_or(false) {
            self.rooms.mark_unchanged();
            greeted.frame = self.app.calibrations.frame(&greeted.hello.name, greeted.hello.convention);
        }
        let bench = &self.app.calibrations.bench;
        let Some(present) = self.persons.get_mut(&pose.person) else {
            // A headset on the column is nobody: the column could not move for it. It is heard where it measures, and nowhere else.
            if bench.measures_with(&greeted.hello.name) {
                bench.hear(&greeted.hello.name, greeted.hello.convention, pose);
                return Ok(());
            }
            return Err(unknown_person(&pose.person));
        };
        present.sequencer.accept(pose.sequence).map_err(|wrong| {
            let expected = format!("more than {}", wrong.last);
            ClientError::at(ErrorCode::OutOfOrder, "sequence", wrong.found.to_string(), expected)
        })?;
        bench.hear(&greeted.hello.name, greeted.hello.convention, pose);
        let taken_at = self.clock.server_time(pose.client_time_micros, received);
        present.slot.put(PoseSample {
            taken_at,
            pose: greeted.frame.room_pose(pose.position, pose.orientation),
            tracked: pose.tracked,
            worn: pose.worn,
            hands: greeted.frame.room_hands(pose.hands),
        });
        present.link.pose(pose.sequence, pose.client_time_micros, taken_at, received);
        self.poses += 1;
        self.pose_times.push_back(received);
        self.meters.poses.increment(1);
        self.meters.pose_age.record((received - taken_at).secs());
        Ok(())
    }

    fn touch(&mut self, kind: &str, verb: &str, touch: &Touch, received: Time) -> Result<(), ClientError> {
        let id = self.present(&touch.person)?.id;
        if !self.app.stage.active().document.objects.iter().any(|object| object.id == touch.object) {
            let found = format!("\"{}\"", touch.object);
            return Err(ClientError::at(
                ErrorCode::UnknownObject,
                "object",
                found,
                "an object of the active scene",
            ));
        }
        let at = self.clock.server_time(touch.client_time_micros, received);
        let mut detail =
            json!({ "person": id.0, "name": touch.person, "object": touch.object, "at_micros": at.micros() });
        if kind == "touch_began" {
            let column = self.app.recording.past().at_touch(&touch.object, at);
            detail["served"] = column.is_some_and(|column| column.served).into();
            detail["column_off_m"] = column.map(|column| column.off_m).into();
            detail["column_speed_mps"] = column.map(|column| column.speed_mps).into();
        }
        self.record(kind, format!("{} {verb} {}", touch.person, touch.object), detail);
        let object = touch.object.as_str().into();
        self.app.persons.touches(id, &touch.object, kind == "touch_began");
        self.tell(if kind == "touch_began" {
            Observation::TouchBegan(id, object)
        } else {
            Observation::TouchEnded(id, object)
        })
    }

    fn refuse(&mut self, error: ClientError, received: Time) -> Reply {
        self.errors += 1;
        self.meters.errors.increment(1);
        let closes = error.fatal || self.gauge.error(received) == Verdict::Close;
        // The first error is recorded, and the one that ends it; those between are counted.
        if self.errors == 1 || closes {
            let summary = format!("client {}: {}", self.name(), error.message);
            let detail = json!({ "client": self.name(), "code": error.code, "field": error.field,
                "message": error.message, "errors": self.errors, "closed": closes });
            self.record("client_error", summary, detail);
        }
        if closes { Reply::LastWords(error.fatal()) } else { Reply::Say(ToClient::Error(error)) }
    }

    /// Show how it stands to dashboards and metrics; due every [`SHOW_EVERY`], also while nothing comes.
    pub fn show(&mut self, now: Time) {
        self.next_show = now + SHOW_EVERY;
        let Some(greeted) = &self.greeted else { return };
        while self.pose_times.front().is_some_and(|oldest| now - *oldest > Span::from_millis(1_000)) {
            self.pose_times.pop_front();
        }
        let link = LinkFigures::of(self.persons.values().map(|present| &present.link), now);
        let Place::Seat(seat) = &self.who.place else { return };
        seat.show(Client {
            name: greeted.hello.name.clone(),
            convention: greeted.hello.convention.name().into(),
            poses: self.poses,
            pose_rate_hz: self.pose_times.len() as f64,
            rtt_millis: self.clock.rtt().map(|rtt| rtt.secs() * 1e3),
            persons: self.persons.values().map(|present| present.id.0).collect(),
            pose_age_millis: link.pose_age_millis,
            jitter_millis: link.jitter_millis,
            loss_percent: link.loss_percent,
            errors: self.errors,
        });
    }

    fn present(&self, person: &str) -> Result<&Present, ClientError> {
        self.persons.get(person).ok_or_else(|| unknown_person(person))
    }

    fn tell(&self, observation: Observation) -> Result<(), ClientError> {
        self.app.control.tell(observation).map_err(busy)
    }

    fn record(&self, kind: &str, summary: String, mut detail: serde_json::Value) {
        if let Some(actor) = self.who.caller.holder().map(Holder::actor) {
            detail["actor"] = actor;
        }
        self.app.recorder.record(kind, summary, detail);
    }

    fn name(&self) -> &str {
        self.greeted.as_ref().map_or("without a hello", |greeted| &greeted.hello.name)
    }
}

impl Drop for Guest {
    fn drop(&mut self) {
        for (name, present) in &self.persons {
            self.app.persons.disconnect(present.id);
            if let Err(error) = self.app.control.tell(Observation::ClientGone(present.id)) {
                // Its poses age all the same, which stops the machine as well (R2).
                tracing::error!(%error, person = name, "the control loop was not told of a lost client");
            }
        }
        if let Some(greeted) = &self.greeted {
            let client = &greeted.hello.name;
            let left_behind: Vec<&String> = self.persons.keys().collect();
            tracing::info!(client, ?left_behind, "VR client gone");
            let detail = json!({ "client": client, "persons": left_behind, "poses": self.poses, "errors": self.errors });
            self.record("client_gone", format!("client {client} is gone"), detail);
        }
    }
}

fn unauthorized(why: String) -> ClientError {
    ClientError::plain(ErrorCode::Unauthorized, why).fatal()
}

fn unknown_person(person: &str) -> ClientError {
    ClientError::at(ErrorCode::UnknownPerson, "person", format!("\"{person}\""), "a person who has entered")
}

fn too_many() -> ClientError {
    ClientError::plain(ErrorCode::TooManyMessages, "more messages than the protocol allows")
}

fn busy(error: crate::control::NotDelivered) -> ClientError {
    ClientError::plain(ErrorCode::Full, error.to_string())
}

const SHOW_EVERY: Span = Span::from_millis(250);
