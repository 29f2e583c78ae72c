//! A dashboard for tests.

use covr_wire::dashboard::{FromDashboard, ToDashboard};
use futures_util::{SinkExt, StreamExt};
use tokio_tungstenite::connect_async;
use tokio_tungstenite::tungstenite::client::IntoClientRequest;
use tokio_tungstenite::tungstenite::protocol::CloseFrame;
use tokio_tungstenite::tungstenite::{Error, Message};

use crate::{SOON, Socket, close_frame};

/// A connected dashboard.
pub struct Dashboard {
    /// The raw socket.
    pub socket: Socket,
}

impl Dashboard {
    /// Connect.
    pub async fn connect(host: &str) -> Self {
        let (socket, _) = connect_async(format!("ws://{host}/ws/v1/dashboard")).await.unwrap();
        Self { socket }
    }

    /// Connect with a token; the status of a refusal otherwise.
    pub async fn connect_with(host: &str, token: Option<&str>) -> Result<Self, u16> {
        let bearer = token.map(|token| ("Authorization", format!("Bearer {token}")));
        Self::upgraded(&format!("{host}/ws/v1/dashboard"), bearer).await
    }

    /// Connect as a browser that is signed in.
    pub async fn connect_with_cookie(host: &str, cookie: &str) -> Result<Self, u16> {
        Self::upgraded(&format!("{host}/ws/v1/dashboard"), Some(("Cookie", cookie.to_owned()))).await
    }

    /// Connect to an address without its scheme.
    pub async fn connect_to(address: &str) -> Result<Self, u16> {
        Self::upgraded(address, None).await
    }

    async fn upgraded(address: &str, header: Option<(&'static str, String)>) -> Result<Self, u16> {
        let mut request = format!("ws://{address}").into_client_request().unwrap();
        if let Some((name, value)) = header {
            request.headers_mut().insert(name, value.parse().unwrap());
        }
        match connect_async(request).await {
            Ok((socket, _)) => Ok(Self { socket }),
            Err(Error::Http(response)) => Err(response.status().as_u16()),
            Err(why) => panic!("{why}"),
        }
    }

    /// Say a message.
    pub async fn say(&mut self, message: &FromDashboard) {
        self.say_text(&serde_json::to_string(message).unwrap()).await;
    }

    /// Say anything.
    pub async fn say_text(&mut self, text: &str) {
        self.socket.send(Message::Text(text.into())).await.unwrap();
    }

    /// The next message that is what is looked for.
    pub async fn hear<T>(&mut self, what: &str, mut is_it: impl FnMut(&ToDashboard) -> Option<T>) -> T {
        let found = tokio::time::timeout(SOON, async {
            loop {
                match self.socket.next().await {
                    Some(Ok(Message::Text(text))) => {
                        if let Some(found) = is_it(&serde_json::from_str(&text).unwrap()) {
                            return found;
                        }
                    }
                    Some(Ok(Message::Ping(_) | Message::Pong(_))) => {}
                    other => panic!("{what}: the connection ended with {other:?}"),
                }
            }
        });
        found.await.unwrap_or_else(|_| panic!("{what}: not heard within {SOON:?}"))
    }

    /// How the server closes the connection.
    pub async fn closed(&mut self) -> Option<CloseFrame> {
        close_frame(&mut self.socket).await
    }
}
