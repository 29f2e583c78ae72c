//! `/ws/v1/client`: VR clients. A reader takes messages in and never waits for the writer; the writer sends
//! column, prediction, stop and scene as they change.

mod guest;

use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use axum::extract::ws::{Message, WebSocket, WebSocketUpgrade, close_code};
use axum::extract::{ConnectInfo, Extension, State};
use axum::http::{HeaderMap, StatusCode, header};
use axum::response::{IntoResponse, Response};
use covr_engine::time::{Span, Time};
use covr_wire::client::{
    ActiveScene, ClientHello, ColumnNow, Encoding, Frame, Prediction, ScenarioNow, StopState, ToClient,
};
use covr_wire::convention::ClientFrame;
use futures_util::StreamExt;
use futures_util::stream::{SplitSink, SplitStream};
use tokio::sync::mpsc;
use tokio::time::{Instant, timeout_at};

use self::guest::{Guest, Newcomer, Place, Reply};
use super::{Gone, close, send, why_closing};
use crate::access::Caller;
use crate::app::App;

/// Accept a VR client.
pub async fn upgrade(
    State(app): State<Arc<App>>,
    Extension(caller): Extension<Caller>,
    ConnectInfo(peer): ConnectInfo<SocketAddr>,
    headers: HeaderMap,
    upgrade: WebSocketUpgrade,
) -> Response {
    let offered: Vec<&str> = headers
        .get_all(header::SEC_WEBSOCKET_PROTOCOL)
        .iter()
        .filter_map(|value| value.to_str().ok())
        .flat_map(|value| value.split(','))
        .collect();
    // Who names no subprotocol speaks JSON; who names others alone is not understood.
    let (encoding, upgrade) = if offered.is_empty() {
        (Encoding::Json, upgrade)
    } else {
        match Encoding::negotiate(offered.iter().copied()) {
            Some((encoding, name)) => (encoding, upgrade.protocols([name])),
            None => {
                let why = "none of the offered subprotocols is spoken here: covr.v1.json, covr.v1.msgpack";
                return (StatusCode::BAD_REQUEST, why).into_response();
            }
        }
    };
    // Whoever may not speak for visitors, or has yet to say who they are, takes no seat from those who may.
    let place = if app.roster.allows(&caller, "client hello") {
        app.clients.take_seat().map(Place::Seat)
    } else {
        app.doorstep.clone().try_acquire_owned().ok().map(|permit| Place::Doorstep { _permit: permit })
    };
    let Some(place) = place else {
        let why = "as many VR clients as the server takes are connected";
        return (StatusCode::SERVICE_UNAVAILABLE, why).into_response();
    };
    upgrade
        .max_message_size(MOST_READ_BYTES)
        .on_upgrade(move |socket| serve(app, socket, encoding, Newcomer { caller, peer: peer.ip(), place }))
}

async fn serve(app: Arc<App>, socket: WebSocket, encoding: Encoding, newcomer: Newcomer) {
    let (sink, stream) = socket.split();
    let (replies, replies_out) = mpsc::channel(REPLY_QUEUE);
    let guest = Guest::new(app.clone(), encoding, newcomer, replies.clone());
    let writer = write(app.clone(), sink, encoding, replies_out);
    tokio::pin!(writer);
    tokio::select! {
        _ = &mut writer => {}
        // The reader's last words are still sent.
        () = read(app, stream, guest, replies) => { let _ = writer.await; }
    }
}

/// Take messages in until the client goes, falls silent, or makes too much trouble.
async fn read(
    app: Arc<App>,
    mut stream: SplitStream<WebSocket>,
    mut guest: Guest,
    replies: mpsc::Sender<Reply>,
) {
    let wait = |secs: f64| Instant::now() + Duration::from_secs_f64(secs);
    let mut deadline = wait(app.config.clients.hello_timeout_secs);
    let mut roster = app.roster.watch();
    loop {
        let next_show = app.clock.instant_of(guest.next_show()).into();
        let next = tokio::select! {
            biased;
            // First, so that whoever says a lot is not let go on for it.
            Ok(()) = roster.changed() => {
                if let Some(reply) = guest.taken_back() {
                    let _ = replies.try_send(reply);
                    return;
                }
                continue;
            }
            next = timeout_at(deadline.min(next_show), stream.next()) => next,
        };
        let message = match next {
            Ok(Some(Ok(message))) => message,
            Ok(Some(Err(_)) | None) => return,
            // A silent client is shown as it stands now, not as it stood when it last spoke.
            Err(_) if Instant::now() < deadline => {
                guest.show(app.clock.now());
                continue;
            }
            Err(_) => {
                let _ = replies.try_send(guest.silent());
                return;
            }
        };
        let received = app.clock.now();
        let reply = match &message {
            Message::Text(text) => guest.take_frame(Encoding::Json, text.as_bytes(), received).await,
            Message::Binary(bytes) => guest.take_frame(Encoding::MessagePack, bytes, received).await,
            Message::Ping(_) | Message::Pong(_) => None,
            Message::Close(_) => return,
        };
        if guest.has_greeted() {
            deadline = wait(app.config.clients.silence_timeout_secs);
        }
        if let Some(reply) = reply {
            let is_last = matches!(reply, Reply::LastWords(_));
            // A client that does not read its answers is not served.
            if replies.try_send(reply).is_err() || is_last {
                return;
            }
        }
    }
}

/// Answers first, then what changes. Ends with the reader.
async fn write(
    app: Arc<App>,
    mut sink: SplitSink<WebSocket, Message>,
    encoding: Encoding,
    mut replies: mpsc::Receiver<Reply>,
) -> Result<(), Gone> {
    let mut published = app.control.watch_published();
    let mut stage = app.stage.watch();
    let mut closing = app.closing.clone();
    let mut rooms = app.calibrations.watch();
    let mut hello: Option<Box<ClientHello>> = None;
    let mut frame: Option<ClientFrame> = None;
    let mut next_prediction = Time::ZERO;
    let mut last_stop: Option<StopState> = None;
    let mut last_scenario: Option<ScenarioNow> = None;
    loop {
        tokio::select! {
            biased;
            reply = replies.recv() => match reply {
                None => return close(&mut sink, close_code::NORMAL, "").await,
                Some(Reply::Say(message)) => say(&mut sink, encoding, &message).await?,
                Some(Reply::Welcome(its_hello, its_frame, welcome)) => {
                    (hello, frame) = (Some(its_hello), Some(its_frame));
                    stage.mark_unchanged();
                    say(&mut sink, encoding, &ToClient::Welcome(welcome)).await?;
                    published.mark_changed();
                }
                Some(Reply::LastWords(error)) => {
                    let reason = error.message.clone();
                    say(&mut sink, encoding, &ToClient::Error(error)).await?;
                    return close(&mut sink, close_code::POLICY, &reason).await;
                }
            },
            reason = why_closing(&mut closing) => {
                return close(&mut sink, close_code::AWAY, &reason).await;
            }
            Ok(()) = stage.changed(), if frame.is_some() => {
                let active = stage.borrow_and_update().clone();
                if let Some(frame) = &frame {
                    let scene = ActiveScene::new(active.id, active.version, active.document.clone(), frame);
                    say(&mut sink, encoding, &ToClient::Scene(Box::new(scene))).await?;
                }
            }
            Ok(()) = rooms.changed() => {
                let Some(hello) = &hello else { continue };
                let anew = app.calibrations.frame(&hello.name, hello.convention);
                if frame.replace(anew) != Some(anew) {
                    // With the scene comes how to find it in the client's space.
                    stage.mark_changed();
                }
            }
            Ok(()) = published.changed(), if frame.is_some() => {
                let Some(frame) = &frame else { continue };
                let now = published.borrow_and_update().clone();
                let stop = StopState::from(&now.snapshot);
                if last_stop.as_ref() != Some(&stop) {
                    say(&mut sink, encoding, &ToClient::Stop(stop.clone())).await?;
                    last_stop = Some(stop);
                }
                let scenario = ScenarioNow::new(&now.snapshot);
                if last_scenario != scenario {
                    last_scenario.clone_from(&scenario);
                    if let Some(scenario) = scenario {
                        say(&mut sink, encoding, &ToClient::Scenario(scenario)).await?;
                    }
                }
                let column = ColumnNow::new(&now.snapshot, &now.scene, frame);
                say(&mut sink, encoding, &ToClient::Column(column)).await?;
                if now.snapshot.at >= next_prediction
                    && let Some(prediction) = Prediction::new(&now.snapshot, frame)
                {
                    next_prediction = now.snapshot.at + PREDICT_EVERY;
                    say(&mut sink, encoding, &ToClient::Prediction(prediction)).await?;
                }
            }
        }
    }
}

async fn say(
    sink: &mut SplitSink<WebSocket, Message>,
    encoding: Encoding,
    message: &ToClient,
) -> Result<(), Gone> {
    match encoding.encode(message) {
        Ok(Frame::Text(text)) => send(sink, Message::Text(text.into())).await,
        Ok(Frame::Binary(bytes)) => send(sink, Message::Binary(bytes.into())).await,
        Err(error) => {
            tracing::error!(%error, "a message to a client was not sent");
            Ok(())
        }
    }
}

/// Frames up to here are read, to be refused in words; longer ones end the connection.
pub const MOST_READ_BYTES: usize = 1024 * 1024;
const REPLY_QUEUE: usize = 64;
const PREDICT_EVERY: Span = Span::from_millis(95);
