//! The WebSockets: VR clients and dashboards.

mod attendance;
pub mod client;
pub mod dashboard;

use std::time::Duration;

use axum::extract::ws::{CloseFrame, Message};
use futures_util::{Sink, SinkExt};
use tokio::sync::watch;

/// The other side is gone, or takes nothing any more.
#[derive(Debug, Clone, Copy)]
struct Gone;

/// Send one message; who takes nothing for five seconds is gone.
async fn send(sink: &mut (impl Sink<Message> + Unpin), message: Message) -> Result<(), Gone> {
    match tokio::time::timeout(LONGEST_SEND, sink.send(message)).await {
        Ok(Ok(())) => Ok(()),
        _ => Err(Gone),
    }
}

/// Close with a reason, cut to what a close frame can carry.
async fn close(sink: &mut (impl Sink<Message> + Unpin), code: u16, reason: &str) -> Result<(), Gone> {
    let end = (0..=MOST_REASON_BYTES.min(reason.len())).rev().find(|at| reason.is_char_boundary(*at));
    let reason = reason[..end.unwrap_or(0)].to_owned();
    send(sink, Message::Close(Some(CloseFrame { code, reason: reason.into() }))).await
}

/// Wait until the server closes; why it does.
async fn why_closing(closing: &mut watch::Receiver<Option<String>>) -> String {
    match closing.wait_for(Option::is_some).await.map(|reason| reason.clone()) {
        Ok(reason) => reason.unwrap_or_default(),
        Err(_) => "the server is gone".into(),
    }
}

/// Why a socket is closed whose token was taken back.
const TAKEN_BACK: &str = "the token was taken back";
const LONGEST_SEND: Duration = Duration::from_secs(5);
/// A control frame carries 125 bytes, two of them the code.
const MOST_REASON_BYTES: usize = 123;
