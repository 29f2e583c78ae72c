//! A VR client for tests: it can say anything, also what no client should.

use covr_wire::client::{ClientError, Encoding, ToClient, decode_from_server};
use futures_util::{SinkExt, StreamExt};
use serde_json::{Value, json};
use tokio_tungstenite::connect_async_with_config;
use tokio_tungstenite::tungstenite::Message;
use tokio_tungstenite::tungstenite::client::IntoClientRequest;
use tokio_tungstenite::tungstenite::protocol::CloseFrame;

use crate::{SOON, Socket, close_frame};

/// A connected client.
pub struct VrClient {
    /// The raw socket.
    pub socket: Socket,
    encoding: Encoding,
    sequence: u32,
    started: std::time::Instant,
}

impl VrClient {
    /// Connect and say nothing yet.
    pub async fn connect(host: &str, encoding: Encoding) -> Self {
        let mut request = format!("ws://{host}/ws/v1/client").into_client_request().unwrap();
        let name = match encoding {
            Encoding::Json => "covr.v1.json",
            Encoding::MessagePack => "covr.v1.msgpack",
        };
        request.headers_mut().insert("Sec-WebSocket-Protocol", name.parse().unwrap());
        let (socket, response) = connect_async_with_config(request, None, true).await.unwrap();
        assert_eq!(response.headers()["sec-websocket-protocol"], name);
        Self { socket, encoding, sequence: 0, started: std::time::Instant::now() }
    }

    /// Connect, say hello, hear the welcome.
    pub async fn greeted(host: &str, name: &str, encoding: Encoding) -> Self {
        let mut client = Self::connect(host, encoding).await;
        client.say(&json!({"type": "hello", "name": name, "convention": "openxr"})).await;
        client.hear("a welcome", |m| matches!(m, ToClient::Welcome(_)).then_some(())).await;
        client
    }

    /// Say a message in this client's encoding.
    pub async fn say(&mut self, message: &Value) {
        let frame = match self.encoding.encode(message).unwrap() {
            covr_wire::client::Frame::Text(text) => Message::Text(text.into()),
            covr_wire::client::Frame::Binary(bytes) => Message::Binary(bytes.into()),
        };
        self.socket.send(frame).await.unwrap();
    }

    /// The person enters.
    pub async fn enter(&mut self, person: &str) {
        self.say(&json!({"type": "enter", "person": person})).await;
    }

    /// A good pose, standing at room (x, y), of now.
    pub async fn pose(&mut self, person: &str, x_m: f64, y_m: f64) {
        self.sequence += 1;
        let message = self.pose_message(person, x_m, y_m, self.sequence);
        self.say(&message).await;
    }

    /// This client's clock, microseconds.
    pub fn now_micros(&self) -> i64 {
        self.started.elapsed().as_micros() as i64
    }

    /// A good pose as a message. OpenXR: right is room -y, back is room -x.
    pub fn pose_message(&self, person: &str, x_m: f64, y_m: f64, sequence: u32) -> Value {
        json!({
            "type": "pose", "person": person, "sequence": sequence,
            "client_time_micros": self.now_micros(),
            "position": [-y_m, 1.7, -x_m], "orientation": [0.0, 0.0, 0.0, 1.0],
            "tracked": true, "worn": true,
        })
    }

    /// The next message that is what is looked for.
    pub async fn hear<T>(&mut self, what: &str, mut is_it: impl FnMut(&ToClient) -> Option<T>) -> T {
        let found = tokio::time::timeout(SOON, async {
            loop {
                let message = match self.socket.next().await {
                    Some(Ok(Message::Text(text))) => decode_from_server(Encoding::Json, text.as_bytes()),
                    Some(Ok(Message::Binary(bytes))) => decode_from_server(Encoding::MessagePack, &bytes),
                    Some(Ok(Message::Ping(_) | Message::Pong(_))) => continue,
                    other => panic!("{what}: the connection ended with {other:?}"),
                };
                if let Some(found) = is_it(&message.unwrap()) {
                    return found;
                }
            }
        });
        found.await.unwrap_or_else(|_| panic!("{what}: not heard within {SOON:?}"))
    }

    /// The next error.
    pub async fn error(&mut self) -> ClientError {
        self.hear("an error", |m| if let ToClient::Error(error) = m { Some(error.clone()) } else { None })
            .await
    }

    /// How the server closes the connection.
    pub async fn closed(&mut self) -> Option<CloseFrame> {
        close_frame(&mut self.socket).await
    }
}
