//! Support shared by the test suites: a real server on a free port, a VR client, a dashboard, a real process.

#![allow(clippy::unwrap_used, reason = "in a test a panic is the report")]

pub mod boards;
pub mod client;
pub mod contract;
pub mod dashboard;
pub mod process;
pub mod server;

use std::time::Duration;

use futures_util::StreamExt;
use tokio::net::TcpStream;
use tokio_tungstenite::tungstenite::Message;
use tokio_tungstenite::tungstenite::protocol::CloseFrame;
use tokio_tungstenite::{MaybeTlsStream, WebSocketStream};

/// A connected socket of a client or a dashboard.
pub type Socket = WebSocketStream<MaybeTlsStream<TcpStream>>;

/// Longest that a test waits for anything but homing.
pub const SOON: Duration = Duration::from_secs(10);
/// Longest that a test waits for the simulated machine to home.
pub const HOMED: Duration = Duration::from_secs(60);

/// Ask again and again until there is an answer; panics with `what` after [`SOON`].
pub async fn eventually<T, F: Future<Output = Option<T>>>(what: &str, ask: impl FnMut() -> F) -> T {
    eventually_within(SOON, what, ask).await
}

/// Ask again and again until there is an answer; panics with `what` after `longest`.
pub async fn eventually_within<T, F: Future<Output = Option<T>>>(
    longest: Duration,
    what: &str,
    mut ask: impl FnMut() -> F,
) -> T {
    let answered = tokio::time::timeout(longest, async {
        loop {
            if let Some(answer) = ask().await {
                return answer;
            }
            tokio::time::sleep(Duration::from_millis(20)).await;
        }
    });
    answered.await.unwrap_or_else(|_| panic!("{what}: not within {longest:?}"))
}

/// How the server closes the connection.
async fn close_frame(socket: &mut Socket) -> Option<CloseFrame> {
    let closed = tokio::time::timeout(SOON, async {
        loop {
            match socket.next().await {
                Some(Ok(Message::Close(frame))) => return frame,
                Some(Ok(_)) => {}
                Some(Err(_)) | None => return None,
            }
        }
    });
    closed.await.expect("the connection is closed in time")
}
