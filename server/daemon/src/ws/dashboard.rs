//! `/ws/v1/dashboard`: whole snapshots to those who keep up, every event to those who do not fall behind.
//!
//! A slow reader skips snapshots. One that falls behind with events is disconnected, and starts afresh from a
//! whole snapshot: nothing is ever patched.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use axum::body::Bytes;
use axum::extract::ws::{Message, WebSocket, WebSocketUpgrade, close_code};
use axum::extract::{Extension, State};
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use covr_engine::Answer;
use covr_engine::mode::RequestKind;
use covr_engine::observation::PersonId;
use covr_engine::time::Span;
use covr_wire::dashboard::{FromDashboard, MachineRequest, MachineShape, Outcome, Snapshot, ToDashboard};
use covr_wire::reason::Reason;
use futures_util::StreamExt;
use futures_util::stream::{SplitSink, SplitStream};
use tokio::sync::broadcast::error::RecvError;
use tokio::sync::{OwnedSemaphorePermit, mpsc, watch};
use tokio::time::MissedTickBehavior;

use super::attendance::{PING_EVERY, attend};
use super::{Gone, TAKEN_BACK, close, send, why_closing};
use crate::access::table::dashboard_key;
use crate::access::{Caller, Standing};
use crate::app::{App, Asker};
use crate::control::{NotDelivered, StopLaneName};
use crate::hand::Ordered;
use crate::live::wire_snapshot;

/// Accept a dashboard.
pub async fn upgrade(
    State(app): State<Arc<App>>,
    Extension(caller): Extension<Caller>,
    upgrade: WebSocketUpgrade,
) -> Response {
    let Ok(seat) = app.dashboard_seats.clone().try_acquire_owned() else {
        let why = "as many dashboards as the server takes are connected";
        return (StatusCode::SERVICE_UNAVAILABLE, why).into_response();
    };
    upgrade.max_message_size(MOST_MESSAGE_BYTES).on_upgrade(move |socket| serve(app, socket, caller, seat))
}

async fn serve(app: Arc<App>, socket: WebSocket, caller: Caller, _seat: OwnedSemaphorePermit) {
    let (sink, stream) = socket.split();
    let (answers, answers_out) = mpsc::channel(ANSWER_QUEUE);
    let heard = watch::Sender::new(Instant::now());
    let heard_last = heard.subscribe();
    tokio::select! {
        _ = write(app.clone(), sink, caller.clone(), answers_out) => {}
        () = read(app.clone(), stream, caller.clone(), answers, heard) => {}
        () = attend(&app, &caller, &heard_last) => {}
    }
}

/// Lets go of the column when its dashboard is gone.
struct LetsGo {
    app: Arc<App>,
    socket: u64,
}

impl Drop for LetsGo {
    fn drop(&mut self) {
        self.app.hand.gone(&self.app.control, self.socket);
    }
}

/// Answers first, then events, then the newest snapshot.
async fn write(
    app: Arc<App>,
    mut sink: SplitSink<WebSocket, Message>,
    caller: Caller,
    mut answers: mpsc::Receiver<ToDashboard>,
) -> Result<(), Gone> {
    let mut events = app.recorder.live();
    let mut frames = app.frames.clone();
    let mut stage = app.stage.watch();
    let mut closing = app.closing.clone();
    let mut roster = app.roster.watch();
    say(&mut sink, &welcome(&app)).await?;
    say(&mut sink, &scene(&app)).await?;
    stage.mark_unchanged();
    let first: Snapshot = wire_snapshot(&app, &app.control.published()).await;
    say(&mut sink, &ToDashboard::Snapshot(Box::new(first))).await?;
    let mut ping_due = tokio::time::interval(PING_EVERY);
    ping_due.set_missed_tick_behavior(MissedTickBehavior::Delay);
    loop {
        tokio::select! {
            biased;
            reason = why_closing(&mut closing) => {
                return close(&mut sink, close_code::AWAY, &reason).await;
            }
            Ok(()) = roster.changed() => {
                if app.roster.standing(&caller) == Standing::TakenBack {
                    return close(&mut sink, close_code::POLICY, TAKEN_BACK).await;
                }
            }
            _ = ping_due.tick() => send(&mut sink, Message::Ping(Bytes::new())).await?,
            Some(answer) = answers.recv() => say(&mut sink, &answer).await?,
            Ok(()) = stage.changed() => say(&mut sink, &scene(&app)).await?,
            event = events.recv() => match event {
                Ok(event) => say(&mut sink, &ToDashboard::Event((*event).clone())).await?,
                Err(RecvError::Lagged(missed)) => {
                    let reason = format!("{missed} events behind; connect again");
                    return close(&mut sink, close_code::AGAIN, &reason).await;
                }
                Err(RecvError::Closed) => return Ok(()),
            },
            Ok(()) = frames.changed() => {
                let text = frames.borrow_and_update().to_string();
                send(&mut sink, Message::Text(text.into())).await?;
            }
        }
    }
}

/// A stop waits for nothing that came before it: each message is handled on a task of its own. Orders to jog are put to the
/// machine here, in the order in which they came: letting go is overtaken by none.
async fn read(
    app: Arc<App>,
    mut stream: SplitStream<WebSocket>,
    caller: Caller,
    answers: mpsc::Sender<ToDashboard>,
    heard: watch::Sender<Instant>,
) {
    let hand = LetsGo { app: app.clone(), socket: NEXT_SOCKET.fetch_add(1, Ordering::Relaxed) };
    while let Some(Ok(message)) = stream.next().await {
        let received_at = Instant::now();
        heard.send_replace(received_at);
        let text = match message {
            Message::Text(text) => text.to_string(),
            Message::Binary(_) => "\"a binary frame\"".into(),
            Message::Ping(_) | Message::Pong(_) => continue,
            Message::Close(_) => return,
        };
        let said = Said::new(&app, caller.clone(), &text, hand.socket);
        let (app, answers) = (app.clone(), answers.clone());
        tokio::spawn(async move {
            let answer = said.answer(&app, received_at).await;
            // The connection may have gone meanwhile; then nobody waits for this.
            let _ = answers.send(answer).await;
        });
    }
}

/// A message, read.
enum Said {
    Stop {
        request_id: u32,
        reason: Option<String>,
        asker: Asker,
    },
    Request {
        request_id: u32,
        request: MachineRequest,
        reason: Option<String>,
        asker: Asker,
    },
    /// An order to jog, put to the machine already.
    Jog {
        request_id: u32,
        ordered: Result<Ordered, Reason>,
        asker: Asker,
    },
    /// Not understood, or not for this caller.
    Refused(ToDashboard),
}

impl Said {
    fn new(app: &App, caller: Caller, text: &str, socket: u64) -> Self {
        // A page that is asked for no token has no other name.
        let name = caller.holder().is_none().then(|| "dashboard".into());
        let asker = Asker { by: "dashboard", given: name, caller };
        match serde_json::from_str(text) {
            Ok(message) if !app.roster.allows(&asker.caller, dashboard_key(&message)) => {
                let why = app.roster.why_not(&asker.caller, dashboard_key(&message));
                Self::Refused(refused_in_words(message.request_id(), why))
            }
            Ok(FromDashboard::Stop { request_id, reason }) => {
                Self::Stop { request_id, reason: given(reason), asker }
            }
            Ok(FromDashboard::Request { request_id, request, reason }) => {
                Self::Request { request_id, request, reason: given(reason), asker }
            }
            Ok(FromDashboard::Jog { request_id, to, speed_mps }) => {
                let order = to.map(|aim| aim.order(speed_mps));
                let ordered = app.hand.order(&app.control, socket, asker.author(), order);
                Self::Jog { request_id, ordered, asker }
            }
            Err(error) => {
                // Answer the request that was meant, where it can be told.
                let meant = serde_json::from_str::<serde_json::Value>(text).ok();
                let id =
                    meant.and_then(|m| m.get("request_id")?.as_u64()).and_then(|id| u32::try_from(id).ok());
                Self::Refused(refused_in_words(id.unwrap_or(0), format!("not understood: {error}")))
            }
        }
    }

    async fn answer(self, app: &App, received_at: Instant) -> ToDashboard {
        match self {
            Self::Refused(answer) => answer,
            Self::Stop { request_id, reason, asker } => {
                match app.stop(&asker, StopLaneName::Dashboard, reason, received_at).await {
                    Ok(to_drive) => {
                        let micros = to_drive.as_micros() as u64;
                        ToDashboard::answer(request_id, Outcome::Accepted, Reason::Stopped, Some(micros))
                    }
                    Err(why) => refused(request_id, why.reason()),
                }
            }
            Self::Request { request_id, request, reason, asker } => {
                answered(app, request_id, ask(app, &asker, request, reason).await)
            }
            Self::Jog { request_id, ordered, asker } => {
                let answer = match ordered {
                    Ok(ordered) => app.jogged(&asker, ordered).await.map_err(NotDelivered::reason),
                    Err(why) => Err(why),
                };
                answered(app, request_id, answer)
            }
        }
    }
}

fn answered(app: &App, request_id: u32, answer: Result<Answer, Reason>) -> ToDashboard {
    match answer {
        Ok(answer) => ToDashboard::answer(request_id, answer.outcome.into(), app.reason(&answer), None),
        Err(why) => refused(request_id, why),
    }
}

async fn ask(
    app: &App,
    asker: &Asker,
    request: MachineRequest,
    reason: Option<String>,
) -> Result<Answer, Reason> {
    let done = match request {
        MachineRequest::Home => app.request(asker, RequestKind::Home, reason).await,
        MachineRequest::Arm => app.request(asker, RequestKind::Arm, reason).await,
        MachineRequest::Disarm => app.request(asker, RequestKind::Disarm, reason).await,
        MachineRequest::Reset if reason.is_none() => return Err(Reason::ResetNeedsReason),
        MachineRequest::Reset => app.request(asker, RequestKind::Reset, reason).await,
        MachineRequest::ConfirmClear => app.confirm_clear(asker).await,
        MachineRequest::ArmContact { person, secs } => {
            app.arm_contact(asker, PersonId(person), Span::from_secs(secs)).await
        }
        MachineRequest::DisarmContact => app.disarm_contact(asker).await,
        MachineRequest::ConfirmFree => app.confirm_free(asker).await,
        MachineRequest::Cue(name) => app.cue(asker, name).await,
        MachineRequest::SkipTo(_) | MachineRequest::Rewind if reason.is_none() => {
            return Err(Reason::SkipNeedsReason);
        }
        MachineRequest::SkipTo(state) => app.skip_to(asker, state, reason.unwrap_or_default()).await,
        MachineRequest::Rewind => app.rewind(asker, reason.unwrap_or_default()).await,
        MachineRequest::ConfirmOrigin(person) if app.persons.is_inside(PersonId(person)) => {
            app.confirm_origin(asker, PersonId(person)).await
        }
        MachineRequest::ConfirmLeft(person) if app.persons.is_inside(PersonId(person)) => {
            app.confirm_left(asker, PersonId(person)).await
        }
        MachineRequest::ConfirmOrigin(person) | MachineRequest::ConfirmLeft(person) => {
            return Err(Reason::PersonNotInside { person: app.persons.name(PersonId(person)) });
        }
    };
    done.map_err(NotDelivered::reason)
}

fn refused(request_id: u32, why: Reason) -> ToDashboard {
    ToDashboard::answer(request_id, Outcome::Refused, why, None)
}

fn refused_in_words(request_id: u32, detail: String) -> ToDashboard {
    let outcome = Outcome::Refused;
    ToDashboard::Answer { request_id, outcome, detail, why: None, to_drive_micros: None }
}

fn given(reason: Option<String>) -> Option<String> {
    reason.map(|words| words.trim().to_owned()).filter(|words| !words.is_empty())
}

fn welcome(app: &App) -> ToDashboard {
    let machine = &app.config.machine;
    ToDashboard::Welcome {
        version: env!("CARGO_PKG_VERSION").into(),
        machine: machine.kind.name().into(),
        machine_shape: MachineShape::new(&machine.travel(), &machine.limits()),
        link_thresholds: app.config.links,
    }
}

fn scene(app: &App) -> ToDashboard {
    let active = app.stage.active();
    ToDashboard::Scene { id: active.id, version: active.version, scene: active.document.clone() }
}

async fn say(sink: &mut SplitSink<WebSocket, Message>, message: &ToDashboard) -> Result<(), Gone> {
    let text = serde_json::to_string(message).map_err(|_| Gone)?;
    send(sink, Message::Text(text.into())).await
}

/// Numbers the sockets of dashboards.
static NEXT_SOCKET: AtomicU64 = AtomicU64::new(0);

/// The longest message from a dashboard; longer ones end the connection.
pub const MOST_MESSAGE_BYTES: usize = 64 * 1024;
const ANSWER_QUEUE: usize = 64;
